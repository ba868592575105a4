//! Requirements and their citations, and whether they agree.

use super::{Citation, CitationKind, Requirement, Status};

/// A requirement, and where it is cited.
#[derive(Clone, Debug)]
pub struct TracedRequirement<'a> {
    /// The requirement.
    pub requirement: &'a Requirement,
    /// Where it is implemented.
    pub code: Vec<Citation<'a>>,
    /// Where it is tested.
    pub tests: Vec<Citation<'a>>,
}

impl TracedRequirement<'_> {
    /// Whether the requirement is done, but no code cites it.
    #[must_use]
    pub fn lacks_code(&self) -> bool {
        self.requirement.status == Status::Done && self.code.is_empty()
    }

    /// Whether the requirement is done, but no test cites it.
    #[must_use]
    pub fn lacks_tests(&self) -> bool {
        self.requirement.status == Status::Done && self.tests.is_empty()
    }
}

/// Every requirement with its citations, and the citations of unknown ids.
#[derive(Clone, Debug)]
pub struct PaperTrace<'a> {
    /// The requirements, in the order of their table.
    pub rows: Vec<TracedRequirement<'a>>,
    /// The citations whose id is not in the table.
    pub unknown: Vec<Citation<'a>>,
}

impl<'a> PaperTrace<'a> {
    /// Matches requirements and citations.
    #[must_use]
    pub fn new(requirements: &'a [Requirement], citations: &[Citation<'a>]) -> Self {
        let cited = |requirement: &Requirement, kind| {
            citations
                .iter()
                .filter(|citation| citation.kind == kind && citation.id == requirement.id)
                .copied()
                .collect()
        };
        let rows = requirements
            .iter()
            .map(|requirement| TracedRequirement {
                requirement,
                code: cited(requirement, CitationKind::Code),
                tests: cited(requirement, CitationKind::Test),
            })
            .collect();
        let unknown = citations
            .iter()
            .filter(|citation| requirements.iter().all(|r| r.id != citation.id))
            .copied()
            .collect();
        Self { rows, unknown }
    }

    /// The faults, one line each: unknown ids first, then done requirements without code or tests.
    pub fn faults(&self) -> impl Iterator<Item = String> {
        let unknown = self.unknown.iter().map(|Citation { id, file, line, .. }| {
            format!("{file}:{line}: `{id}` is not a requirement of the paper")
        });
        let lacking = self.rows.iter().filter_map(|row| {
            let what = match (row.lacks_code(), row.lacks_tests()) {
                (false, false) => return None,
                (true, false) => "code",
                (false, true) => "test",
                (true, true) => "code and no test",
            };
            Some(format!("{}: done, but no {what} cites it", row.requirement.id))
        });
        unknown.chain(lacking)
    }

    /// Whether every citation is of a requirement, and every done requirement is cited by code and by a
    /// test.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.faults().next().is_none()
    }
}
