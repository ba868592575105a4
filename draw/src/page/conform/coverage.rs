//! The coverage of the cases.

use toposlam_conform::CoveredCase;

use super::each;
use crate::picture::escaped;

/// A table of the cases.
pub(super) fn table(cases: &[CoveredCase]) -> String {
    let most = cases.iter().map(|case| case.count).max().unwrap_or(0).max(1);
    format!(
        "<table class=\"coverage\">\n<thead class=\"unseen\"><tr><th scope=\"col\">Case</th>\
         <th scope=\"col\">Count</th><th scope=\"col\">Share</th></tr></thead>\n<tbody>\n{}</tbody>\n\
         </table>\n",
        each(cases, |case| row(case, most))
    )
}

fn row(case: &CoveredCase, most: u64) -> String {
    let name = escaped(case.case);
    let (class, cells) = match (case.count, case.reachable) {
        (0, Some(false)) => ("beyond", "<td colspan=\"2\">not reachable</td>".to_owned()),
        (0, _) if case.expected => {
            ("missed", "<td colspan=\"2\">expected, but not reached</td>".to_owned())
        }
        (0, _) => ("beyond", "<td colspan=\"2\">not reached</td>".to_owned()),
        (count, reachable) => {
            let part = 100.0 * count as f64 / most as f64;
            let bar = format!("<span class=\"bar\" style=\"--part:{part:.1}%\"></span>");
            // A run that diverged may cover cases that its world does not have.
            let note = match reachable {
                Some(false) => "<span class=\"faint\">not in the known world</span>",
                _ => "",
            };
            let cells = format!(
                "<td class=\"right number\">{count}</td><td class=\"many\">{bar}{note}</td>"
            );
            ("met", cells)
        }
    };
    format!("<tr class=\"{class}\"><th scope=\"row\">{name}</th>{cells}</tr>\n")
}

/// The number of reachable cases that were reached.
pub(super) fn summary(cases: &[CoveredCase]) -> String {
    let met = cases.iter().filter(|case| case.count > 0).count();
    let beyond = cases.iter().filter(|case| case.count == 0 && case.reachable == Some(false));
    let beyond = beyond.count();
    let of = cases.len() - beyond;
    let besides = match beyond {
        0 => String::new(),
        _ => format!("; {beyond} cannot be reached in the known world"),
    };
    format!("<p class=\"faint\">{met} of {of} cases reached{besides}.</p>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(case: &'static str, count: u64, reachable: Option<bool>) -> CoveredCase {
        CoveredCase { case, count, reachable, expected: false }
    }

    #[test]
    fn unreachable_cases_are_not_counted() {
        let sum = [case("a", 5, Some(true)), case("b", 0, None), case("c", 0, Some(false))];
        assert!(summary(&sum).contains("1 of 2 cases reached; 1 cannot be reached"));
    }

    #[test]
    fn a_case_is_reached_or_not_or_cannot_be() {
        let of = |count, reachable| row(&case("x", count, reachable), 8);
        assert!(of(4, Some(true)).contains("--part:50.0%"));
        let grey = "<tr class=\"beyond\">";
        for reachable in [None, Some(true)] {
            let row = of(0, reachable);
            assert!(row.starts_with(grey) && row.contains(">not reached<"), "{row}");
        }
        let expected = CoveredCase { expected: true, ..case("x", 0, Some(true)) };
        let row = row(&expected, 8);
        assert!(row.starts_with("<tr class=\"missed\">"), "{row}");
        assert!(row.contains(">expected, but not reached<"), "{row}");
        assert!(of(0, Some(false)).contains(">not reachable<"));
        assert!(of(8, Some(false)).contains("not in the known world"));
    }
}
