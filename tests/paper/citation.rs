//! Citations of the paper in source text.

/// Whether the requirement is implemented or tested at the citation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum CitationKind {
    /// In code.
    Code,
    /// In a test: in a file `tests.rs`, under a folder `tests`, in a lemma under a folder `lemmas`,
    /// below the line `#[cfg(test)]` of a file, or in a Coq file, at a theorem.
    Test,
}

/// A place in the sources that cites a requirement of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Citation<'a> {
    /// The id of the requirement, as written.
    pub(super) id: &'a str,
    /// The file, relative to the root of the workspace, with `/` between folders.
    pub(super) file: &'a str,
    /// The line in the file; the first is 1.
    pub(super) line: usize,
    /// Code or a test.
    pub(super) kind: CitationKind,
}

/// The citations in the text of a file, in their order. A citation is a comment of its own or at
/// the end of a line: `// paper: id`, or several ids separated by commas; in a Coq file,
/// `(* paper: id *)`.
pub(super) fn citations<'a>(file: &'a str, text: &'a str) -> impl Iterator<Item = Citation<'a>> {
    let in_coq = file.rsplit('.').next() == Some("v");
    let tested = file.split('/').any(|part| ["tests", "tests.rs", "lemmas"].contains(&part));
    let mut kind = if tested || in_coq { CitationKind::Test } else { CitationKind::Code };
    let comment = if in_coq { in_coq_comment } else { in_rust_comment };
    text.lines().zip(1..).flat_map(move |(source, line)| {
        if source.starts_with("#[cfg(test)]") {
            kind = CitationKind::Test;
        }
        let kind = kind;
        cited(comment(source)).map(move |id| Citation { id, file, line, kind })
    })
}

/// The ids that a comment cites.
fn cited(comment: Option<&str>) -> impl Iterator<Item = &str> {
    comment
        .and_then(|comment| comment.strip_prefix(" paper:"))
        .into_iter()
        .flat_map(|ids| ids.split(','))
        .map(str::trim)
}

/// The comment at the end of a line of Rust.
fn in_rust_comment(source: &str) -> Option<&str> {
    let (before, comment) = source.split_once("//")?;
    (!is_in_string(before)).then_some(comment)
}

/// The comment at the end of a line of Coq.
fn in_coq_comment(source: &str) -> Option<&str> {
    source.split_once("(*")?.1.strip_suffix("*)")
}

/// Whether a string begins in this text and does not end in it.
fn is_in_string(text: &str) -> bool {
    (text.matches('"').count() - text.matches(r#"\""#).count()) % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found<'a>(file: &'a str, text: &'a str) -> Vec<(&'a str, usize, CitationKind)> {
        citations(file, text).map(|citation| (citation.id, citation.line, citation.kind)).collect()
    }

    #[test]
    fn a_comment_cites_one_id_or_several() {
        let text = "fn f() {\n    // paper: alg1.4, alg1.5\n    g(); // paper: alg1.6\n}\n";
        assert_eq!(
            found("src/mapping.rs", text),
            [
                ("alg1.4", 2, CitationKind::Code),
                ("alg1.5", 2, CitationKind::Code),
                ("alg1.6", 3, CitationKind::Code)
            ]
        );
    }

    #[test]
    fn below_cfg_test_under_tests_and_in_a_lemma_a_citation_is_a_test() {
        let text = "// paper: world.graph\n#[cfg(test)]\nmod tests {\n    // paper: world.graph\n}";
        let kinds = |file| citations(file, text).map(|c| c.kind).collect::<Vec<_>>();
        assert_eq!(kinds("model/src/a.rs"), [CitationKind::Code, CitationKind::Test]);
        assert_eq!(kinds("model/tests/a.rs"), [CitationKind::Test, CitationKind::Test]);
        assert_eq!(kinds("model/src/a/tests.rs"), [CitationKind::Test, CitationKind::Test]);
        assert_eq!(kinds("proofs/src/lemmas/a.rs"), [CitationKind::Test, CitationKind::Test]);
        assert_eq!(kinds("src/latests/a.rs"), [CitationKind::Code, CitationKind::Test]);
    }

    #[test]
    fn what_a_theorem_cites_is_checked() {
        let text = "Theorem walk_inj : True. (* paper: motion.path, alg1.10 *)\nProof. by []. Qed.";
        let ids = [("motion.path", 1, CitationKind::Test), ("alg1.10", 1, CitationKind::Test)];
        assert_eq!(found("proofs/coq/Theorems.v", text), ids);
        for none in ["(** Paper: 2.1. *)", "(* the paper: alg1.1 *)", "(* paper: alg1.1"] {
            assert_eq!(found("proofs/coq/Theorems.v", none), [], "{none}");
        }
    }

    #[test]
    fn strings_and_docs_cite_nothing() {
        for text in [
            "let text = \"// paper: alg1.1\";",
            "/// Written `// paper: alg1.1`.",
            "//! paper: alg1.1",
            "// the paper: alg1.1",
        ] {
            assert_eq!(found("src/a.rs", text), [], "{text}");
        }
    }

    #[test]
    fn a_sloppy_citation_is_found_and_so_can_be_refused() {
        assert_eq!(
            found("a.rs", "// paper: alg1.1 and more"),
            [("alg1.1 and more", 1, CitationKind::Code)]
        );
        assert_eq!(found("a.rs", "// paper:"), [("", 1, CitationKind::Code)]);
    }
}
