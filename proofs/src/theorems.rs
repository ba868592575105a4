//! The theorems that are proved in Coq, for every world. They are read from `coq/Theorems.v`, where each
//! follows a comment with its statement in words.

use serde::Serialize;

/// A theorem that is proved in Coq. `toposlam proofs --json` prints it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Theorem {
    #[serde(rename = "theorem")]
    pub name: &'static str,
    /// Its statement in words.
    pub sentence: String,
    /// Its place in the paper.
    pub paper: String,
    /// Its file, relative to the root of the workspace.
    pub file: &'static str,
    pub coq: Coq,
}

/// The check of a theorem by Coq.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Coq {
    /// The bound, in words: there is none.
    pub bound: &'static str,
}

impl Theorem {
    /// A theorem of this name, with its statement and its place in the paper.
    pub fn new(name: &'static str, sentence: String, paper: String) -> Self {
        let (file, coq) = ("proofs/coq/Theorems.v", Coq { bound: "every world" });
        Self { name, sentence, paper, file, coq }
    }

    /// The place in the paper, the file, and the bound of Coq, each after its label.
    pub fn details(&self) -> Vec<(&'static str, String)> {
        vec![
            ("paper", self.paper.clone()),
            ("file", self.file.to_owned()),
            ("Coq", self.coq.bound.to_owned()),
        ]
    }
}

const SOURCE: &str = include_str!("../coq/Theorems.v");

/// All theorems, in their order.
pub fn all() -> impl Iterator<Item = Theorem> {
    SOURCE.split("(**").filter_map(theorem)
}

/// The theorem after a comment, `(** SENTENCES Paper: PLACE. *)`, that begins here.
fn theorem(text: &'static str) -> Option<Theorem> {
    let (comment, code) = text.split_once("*)")?;
    let code = code.trim_start().strip_prefix("Theorem ")?;
    let name = code.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).next()?;
    let (sentence, paper) = comment.rsplit_once("Paper:").unwrap_or((comment, ""));
    // A comment of Coq sets code in brackets, and is broken into lines.
    let plain =
        |text: &str| text.replace(['[', ']'], "").split_whitespace().collect::<Vec<_>>().join(" ");
    let paper = plain(paper).trim_end_matches('.').to_owned();
    Some(Theorem::new(name, plain(sentence), paper))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_theorem_has_its_sentence_and_its_place() {
        let stated = SOURCE.lines().filter(|line| line.trim_start().starts_with("Theorem "));
        assert_eq!(all().count(), stated.count());
        assert!(all().count() > 0);
        for Theorem { name, sentence, paper, .. } in all() {
            assert!(sentence.ends_with('.') && !paper.is_empty(), "{name}: {sentence} {paper}");
        }
    }

    #[test]
    fn a_comment_is_read_as_it_flows() {
        let read = theorem(
            " The way [f] back\n    is one. Paper: 2.3;\n  line 15. *)\nTheorem way (f : nat).",
        );
        let (name, sentence, paper) =
            ("way", "The way f back is one.".into(), "2.3; line 15".into());
        assert_eq!(read, Some(Theorem::new(name, sentence, paper)));
        assert_eq!(
            theorem(" What is proved. *)\nFrom mathcomp Require Import all_ssreflect."),
            None
        );
    }
}
