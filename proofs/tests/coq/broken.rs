//! The development with one thing changed does not hold, and the script reports it: a check that no fault
//! can fail says nothing.

use std::{fs, path::PathBuf};

use super::{Compiled, check, compiled, folder, source, text};

/// The development with something changed in one file.
struct Changed {
    /// Its sources.
    sources: PathBuf,
    /// Where it is compiled, as far as nothing has changed.
    compiled: PathBuf,
}

impl Changed {
    fn new(name: &str, file: &str, change: impl Fn(&str) -> String, whole: &Compiled) -> Self {
        let sources = folder(&format!("{name}/sources"));
        let compiled = whole.copy(&format!("{name}/compiled"));
        for entry in fs::read_dir(source("")).unwrap() {
            let entry = entry.unwrap();
            if entry.path().extension().is_some_and(|kind| kind == "v") {
                fs::copy(entry.path(), sources.join(entry.file_name())).unwrap();
            }
        }
        for other in ["_CoqProject", "statements.txt"] {
            fs::copy(source(other), sources.join(other)).unwrap();
        }
        fs::write(sources.join(file), change(&fs::read_to_string(source(file)).unwrap())).unwrap();
        Self { sources, compiled }
    }

    /// What the script prints, on standard output and on standard error: it does not hold.
    #[track_caller]
    fn violated(&self) -> (String, String) {
        let said = check(&self.sources, &self.compiled);
        let (stdout, stderr) = (text(&said.stdout), text(&said.stderr));
        assert_eq!(said.status.code(), Some(1), "{stderr}\n{stdout}");
        assert!(stdout.lines().last().unwrap().starts_with("violated: "), "{stdout}");
        (stdout, stderr)
    }
}

/// With another definition, which is accepted, what was proved does not hold.
#[track_caller]
fn assert_matters(name: &str, file: &str, from: &str, to: &str) {
    let whole = compiled();
    let change = |text: &str| {
        assert_eq!(text.matches(from).count(), 1, "{from}");
        text.replace(from, to)
    };
    let (stdout, stderr) = Changed::new(name, file, change, whole).violated();
    assert_eq!(stdout, "violated: Coq does not accept the development");
    let mistaken: Vec<_> = stderr.lines().filter(|line| line.starts_with("File \"./")).collect();
    assert!(!mistaken.is_empty() && mistaken.iter().all(|line| !line.contains(file)), "{stderr}");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_percept_without_the_degree_where_the_marker_lies_is_not_enough() {
    assert_matters(
        "degree",
        "Spec.v",
        "percept := (degree pose, M W pose).",
        "percept := (if same_vertex pose (facing W) then 0 else degree pose, M W pose).",
    );
}

/// A program may do what is impossible, if nothing forbids it.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn what_always_holds_includes_that_each_action_is_possible() {
    assert_matters("possible", "Program.v", "possible s e /\\", "true /\\");
}

/// Without an allowed choice anything would hold for all of them.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn what_always_holds_includes_that_a_choice_is_allowed() {
    assert_matters("default", "Program.v", "allowed default /\\ forall x", "true /\\ forall x");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn what_always_holds_counts_the_actions() {
    assert_matters("count", "Program.v", "Q a s' actions.+1)", "Q a s' actions)");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_program_goes_on_with_the_percept_after_its_action() {
    let after = "always (go (sense (next_state s e)))";
    assert_matters("after", "Program.v", after, "always (go (sense s))");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_robot_that_obeys_a_program_uses_each_percept_once() {
    let later = "then obey (go seen) later else";
    assert_matters("obeys/later", "Program.v", later, "then obey (go seen) past else");
    // The program depends on the first one.
    assert_matters("obeys/first", "Program.v", "(behead past).", "past.");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_history_has_the_percepts_after_the_actions() {
    let after = "rcons past (sense (next_state s e))";
    assert_matters("history", "Spec.v", after, "rcons past (sense s)");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn every_action_preserves_a_bisimulation() {
    let every = "forall e, R (next_state s e)";
    assert_matters("bisimulation", "Spec.v", every, "exists e, R (next_state s e)");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn isomorphic_starts_have_the_same_facing_dart_not_only_the_same_vertex() {
    let dart = "isomorphism f /\\ f (facing V) = facing W.";
    let vertex = "isomorphism f /\\ same_vertex (f (facing V)) (facing W).";
    assert_matters("facing", "Spec.v", dart, vertex);
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_marker_is_picked_up_only_where_it_lies() {
    let here = "(pose, if same_vertex pose spot then None else lying)";
    assert_matters("picked-up", "MovableMarker.v", here, "(pose, None)");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_marker_that_was_dropped_at_a_new_vertex_has_to_be_fetched() {
    let fetched = "      pick_up ;;\n      Return NewPlace";
    assert_matters("fetched", "MovableMarker.v", fetched, "      Return NewPlace");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_marker_without_a_direction_is_not_enough() {
    let pointing = "Pointing (findex clockwise pose (facing W))";
    assert_matters("direction", "Spec.v", pointing, "Pointing 0");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn the_way_back_needs_its_first_turn() {
    assert_matters("way-back", "Spec.v", "then 0 :: rev [", "then rev [");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_hypothesis_is_not_validated_by_degrees_alone() {
    let compared = "if ends then seen == expected S pose else";
    let degrees = "if ends then seen.1 == (expected S pose).1 else";
    assert_matters("validation", "Algorithm1.v", compared, degrees);
}

/// It may have turned: a hypothesis about the marked vertex can be the second that it tests, as printed.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_robot_that_confirms_a_hypothesis_counts_its_turns() {
    let turned = "(Confirmed (turned_to S pose turned))";
    assert_matters("turned", "Algorithm1.v", turned, "(Confirmed pose)");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_folded_trail_with_an_open_entry_dart_is_not_complete() {
    let followed = "i < degree_seen visit -> followed";
    assert_matters("complete", "Folding.v", followed, &format!("0 < i -> {followed}"));
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn darts_at_the_marker_are_folded_by_its_direction() {
    let folded = "folded (visit, i) (visit', j)";
    assert_matters("folded", "Folding.v", folded, "folded (visit, j) (visit', i)");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn an_edge_is_traversed_in_either_direction() {
    let either = "[|| turn pose i == d, traverse pose i == d |";
    assert_matters("traversed", "Folding.v", either, "[|| turn pose i == d |");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn an_arrow_needs_its_sense() {
    let along = "(facing W) then PassedAlong";
    assert_matters("sense", "Markers.v", along, "(facing W) then PassedAgainst");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn what_is_left_out_or_assumed_is_refused() {
    let whole = compiled();
    for (name, added, found) in [
        ("admitted", "Lemma absurd : False. Admitted.", "Admitted"),
        ("admit", "Lemma absurd : False. Proof. admit. Qed.", "admit"),
        ("axiom", "Axiom absurd : False.", "Axiom"),
        ("parameter", "(* (* *) \" *) \" *) Parameter absurd : False.", "Parameter"),
        ("variable", "Section S. End S. Variable absurd : False.", "Variable outside a section"),
        ("guard", "Unset Guard Checking.", "Guard Checking"),
    ] {
        let change = |text: &str| format!("{text}\n{added}\n");
        let changed = Changed::new(name, "Program.v", change, whole);
        let line = fs::read_to_string(changed.sources.join("Program.v")).unwrap().lines().count();
        let (stdout, _) = changed.violated();
        let why = "violated: a proof is left out, or something is assumed";
        assert_eq!(stdout, format!("Program.v:{line}: {found}\n\n{why}"));
    }
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_theorem_that_rests_on_an_axiom_of_a_library_is_not_closed() {
    let whole = compiled();
    let middle = "From Coq Require Classical_Prop. (* Axiom: *)\n\
                  Theorem middle (P : Prop) : P \\/ ~ P.\nProof. exact: Classical_Prop.classic. Qed.\n";
    let changed =
        Changed::new("classical", "Theorems.v", |text| format!("{text}\n{middle}"), whole);
    let (stdout, _) = changed.violated();
    let (before, after) = stdout.split_once("\nmiddle ").unwrap();
    assert!(before.lines().all(|line| line.ends_with(" closed")), "{stdout}");
    assert!(after.trim_start().starts_with("not closed\n  Axioms:\n"), "{stdout}");
}

/// A theorem with a weaker statement, or about less with the same statement, is another theorem.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn statements_and_their_definitions_are_pinned() {
    let whole = compiled();
    let weaker = |text: &str| {
        let (before, rest) = text.split_once("\nTheorem algorithm1_correct ").unwrap();
        let (_, after) = rest.split_once("Qed.").unwrap();
        format!("{before}\nTheorem algorithm1_correct : True.\nProof. by []. Qed.{after}")
    };
    let fewer = |text: &str| {
        let (any, short) = ("fun _ _ => true.", "fun S path => size path < known_vertices S.");
        assert_eq!(text.matches(any).count(), 1);
        text.replace(any, short)
    };
    for (changed, line) in [
        (Changed::new("weaker", "Theorems.v", weaker, whole), ">      : True"),
        (
            Changed::new("fewer", "Algorithm1.v", fewer, whole),
            "< Algorithm1.any_path = fun=> xpredT",
        ),
    ] {
        let (stdout, _) = changed.violated();
        let why = "violated: a statement, or a definition on which it depends, \
                   is not that of statements.txt";
        assert!(stdout.contains(line) && stdout.ends_with(why), "{stdout}");
    }
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn without_a_theorem_nothing_holds() {
    let whole = compiled();
    let none = |_: &str| "(* Theorem none : False. *)\n".to_owned();
    let (stdout, _) = Changed::new("none", "Theorems.v", none, whole).violated();
    assert_eq!(stdout, "violated: there is no theorem in Theorems.v");
}

/// A test of the folding explorer that is not strict proves its hypothesis and refutes it; each needs a check.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_free_test_has_to_prove_and_to_refute() {
    let both = "predicts K far h x entry & confirms K far h x entry";
    let explorer = "FoldingExplorer.v";
    assert_matters(
        "free/proves",
        explorer,
        both,
        "predicts K far h x entry & predicts K far h x entry",
    );
    assert_matters(
        "free/refutes",
        explorer,
        both,
        "confirms K far h x entry & confirms K far h x entry",
    );
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_place_of_the_folding_explorer_joins_the_map_only_without_hypotheses() {
    assert_matters(
        "place",
        "FoldingExplorer.v",
        "[|| h == e, is_refuted K e h |",
        "[|| true, is_refuted K e h |",
    );
}

/// A robot comes to a hanging leaf at the end and not back, so it saves each hanging edge twice.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_certificate_saves_what_leads_to_a_leaf() {
    let saved = "(2 * hanging_above leaf - distance leaf)";
    assert_matters("leaf", "Certificate.v", saved, "(hanging_above leaf - distance leaf)");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_certificate_goes_over_each_hanging_edge_twice() {
    assert_matters("hanging", "Certificate.v", "+ 2 * #|hanging| -", "+ #|hanging| -");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_robot_can_turn_before_each_move_of_a_shortest_walk() {
    let turned = "[exists e, same_vertex d e && reached";
    assert_matters("distance", "Certificate.v", turned, "[exists e, (d == e) && reached");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn the_folding_explorer_joins_only_what_its_trail_shows_to_be_one_edge() {
    let shown = "h \\in U & stands_for K x == stands_for K (dart_in_trail K h)]";
    assert_matters("joined", "FoldingExplorer.v", shown, "h \\in U & true]");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn a_failed_test_of_the_folding_explorer_refutes_its_hypothesis() {
    let both = "else with_refuted K e h.";
    assert_matters("refuted", "FoldingExplorer.v", both, "else with_refuted K h h.");
}

#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn an_action_from_outside_has_to_be_allowed() {
    let allowed = "if allowed_action allowed patience K a then guided_by";
    assert_matters(
        "given",
        "GivenActions.v",
        allowed,
        "if allowed_action allowed patience K a || true then guided_by",
    );
}
