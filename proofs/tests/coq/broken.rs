//! The development with one thing changed does not hold, and the script reports it: a check that no fault
//! can fail says nothing.

use std::{fs, path::PathBuf};

use super::{Compiled, check, compiled, folder, source, text};

/// The development with something changed in one file.
struct Changed {
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

/// A test for each fact: with one definition changed, Coq accepts that definition, but not what was proved about
/// it.
macro_rules! each_definition_matters {
    ($($(#[$about:meta])* $fact:ident, $file:literal: $from:literal => $to:literal;)*) => {$(
        $(#[$about])*
        #[test]
        #[ignore = "it needs Coq: `.ci/run --all`"]
        fn $fact() {
            assert_matters(stringify!($fact), $file, $from, $to);
        }
    )*};
}

each_definition_matters! {
    a_percept_without_the_degree_where_the_marker_lies_is_not_enough, "Spec.v":
        "percept := (degree pose, M W pose)."
        => "percept := (if same_vertex pose (facing W) then 0 else degree pose, M W pose).";
    /// A program may do what is impossible, if nothing forbids it.
    what_always_holds_includes_that_each_action_is_possible, "Program.v":
        "possible s e /\\" => "true /\\";
    /// Without an allowed choice anything would hold for all of them.
    what_always_holds_includes_that_a_choice_is_allowed, "Program.v":
        "allowed default /\\ forall x" => "true /\\ forall x";
    what_always_holds_counts_the_actions, "Program.v":
        "Q a s' actions.+1)" => "Q a s' actions)";
    a_program_goes_on_with_the_percept_after_its_action, "Program.v":
        "always (go (sense (next_state s e)))" => "always (go (sense s))";
    a_robot_that_obeys_a_program_uses_each_percept_once, "Program.v":
        "then obey (go seen) later else" => "then obey (go seen) past else";
    a_program_depends_on_the_first_percept, "Program.v": "(behead past)." => "past.";
    a_history_has_the_percepts_after_the_actions, "Spec.v":
        "rcons past (sense (next_state s e))" => "rcons past (sense s)";
    every_action_preserves_a_bisimulation, "Spec.v":
        "forall e, R (next_state s e)" => "exists e, R (next_state s e)";
    isomorphic_starts_have_the_same_facing_dart_not_only_the_same_vertex, "Spec.v":
        "isomorphism f /\\ f (facing V) = facing W."
        => "isomorphism f /\\ same_vertex (f (facing V)) (facing W).";
    a_marker_is_picked_up_only_where_it_lies, "MovableMarker.v":
        "(pose, if same_vertex pose spot then None else lying)" => "(pose, None)";
    a_marker_that_was_dropped_at_a_new_vertex_has_to_be_fetched, "MovableMarker.v":
        "      pick_up ;;\n      Return NewPlace" => "      Return NewPlace";
    a_marker_without_a_direction_is_not_enough, "Spec.v":
        "Pointing (findex clockwise pose (facing W))" => "Pointing 0";
    the_way_back_needs_its_first_turn, "Spec.v": "then 0 :: rev [" => "then rev [";
    a_hypothesis_is_not_validated_by_degrees_alone, "Algorithm1.v":
        "if ends then seen == expected S pose else"
        => "if ends then seen.1 == (expected S pose).1 else";
    /// It may have turned: a hypothesis about the marked vertex can be the second that it tests, as printed.
    a_robot_that_confirms_a_hypothesis_counts_its_turns, "Algorithm1.v":
        "(Confirmed (turned_to S pose turned))" => "(Confirmed pose)";
    a_folded_trail_with_an_open_entry_dart_is_not_complete, "Folding.v":
        "i < degree_seen visit -> followed" => "0 < i -> i < degree_seen visit -> followed";
    darts_at_the_marker_are_folded_by_its_direction, "Folding.v":
        "folded (visit, i) (visit', j)" => "folded (visit, j) (visit', i)";
    an_edge_is_traversed_in_either_direction, "Folding.v":
        "[|| turn pose i == d, traverse pose i == d |" => "[|| turn pose i == d |";
    an_arrow_needs_its_sense, "Markers.v":
        "(facing W) then PassedAlong" => "(facing W) then PassedAgainst";
    a_robot_that_shows_no_heading_shows_only_its_vertex, "Aids.v":
        "if heading then Some (findex clockwise pose other) else None."
        => "Some (findex clockwise pose other).";
    a_string_over_a_loop_needs_the_hand, "Aids.v":
        "then omap (findex clockwise pose) (string_behind x) else None" => "then None else None";
    a_marker_lies_where_it_was_dropped, "Aids.v":
        "DropMarker i => set_nth None places i (Some pose)"
        => "DropMarker i => set_nth None places i None";
    /// A test of the folding explorer that is not strict proves its hypothesis and refutes it.
    a_free_test_has_to_prove, "FoldingExplorer.v":
        "predicts K far h x entry & confirms K far h x entry"
        => "predicts K far h x entry & predicts K far h x entry";
    a_free_test_has_to_refute, "FoldingExplorer.v":
        "predicts K far h x entry & confirms K far h x entry"
        => "confirms K far h x entry & confirms K far h x entry";
    a_place_of_the_folding_explorer_joins_the_map_only_without_hypotheses, "FoldingExplorer.v":
        "[|| h == e, is_refuted K e h |" => "[|| true, is_refuted K e h |";
    /// A robot comes to a hanging leaf at the end and not back, so it saves each hanging edge twice.
    a_certificate_saves_what_leads_to_a_leaf, "Certificate.v":
        "(2 * hanging_above leaf - distance leaf)" => "(hanging_above leaf - distance leaf)";
    a_certificate_goes_over_each_hanging_edge_twice, "Certificate.v":
        "+ 2 * #|hanging| -" => "+ #|hanging| -";
    a_robot_can_turn_before_each_move_of_a_shortest_walk, "Certificate.v":
        "[exists e, same_vertex d e && reached" => "[exists e, (d == e) && reached";
    the_folding_explorer_joins_only_what_its_trail_shows_to_be_one_edge, "FoldingExplorer.v":
        "h \\in U & stands_for K x == stands_for K (dart_in_trail K h)]" => "h \\in U & true]";
    a_failed_test_of_the_folding_explorer_refutes_its_hypothesis, "FoldingExplorer.v":
        "else with_refuted K e h." => "else with_refuted K h h.";
    an_action_from_outside_has_to_be_allowed, "GivenActions.v":
        "if allowed_action allowed patience K a then guided_by"
        => "if allowed_action allowed patience K a || true then guided_by";
    the_checker_follows_two_passages_only_from_one_dart, "Checker.v":
        "if name_of k x == name_of k y then existing" => "if true then existing";
    the_checker_turns_the_visits_that_it_joins, "Checker.v":
        "N.add at_to (N.sub (degree_at s) at_from)" => "N.add at_to at_from";
    a_step_alone_is_no_contradiction, "Checker.v":
        "by_test (two_doors x y || other_degree x y)" => "by_test true";
    a_marker_along_another_door_of_a_turned_robot_is_no_contradiction, "Checker.v":
        "name_of k (a, i) != name_of k (b, j)" => "i != j";
    the_checker_asks_for_every_door_of_a_vertex, "Checker.v":
        "N0 (degree_at visit) (has_entry its)" => "(N.succ N0) (degree_at visit) (has_entry its)";
    the_checker_refuses_worlds_that_are_not_connected, "Checker.v":
        "first_not (has_entry (reached T)) (dart_list T)"
        => "first_not (has_entry (dart_set T)) (dart_list T)";
    the_checker_refuses_edges_with_one_dart, "Checker.v":
        "o != d & has_entry (dart_set T) o" => "true & has_entry (dart_set T) o";
    the_checker_looks_whether_doors_exist, "Checker.v":
        "if N.ltb i degree then differs" => "if true then differs";
    the_checker_follows_every_pair_of_poses_behind_the_doors, "Checker.v":
        "(fun i => is_pair t (traverse_in T p i) (traverse_in U q i))"
        => "(fun i => is_pair t (turn_in T p i) (turn_in U q i))";
    the_checker_compares_every_pose_of_the_second_world, "Checker.v":
        "first_not (has_entry compared) (dart_list U)" => "first_not (has_entry compared) [::]";
    the_checker_follows_every_door_that_is_not_known, "Checker.v":
        "else if last then [:: d]" => "else if true then [:: d]";
    the_checker_chooses_every_door_that_is_not_known, "Checker.v":
        "(numbers_below fuel N0 seen.1)" => "(numbers_below fuel (N.succ N0) seen.1)";
    the_checker_asks_for_the_marker_as_seen_by_a_robot_that_comes_back, "Checker.v":
        "N.modulo (N.add turn j) seen.1 == N.modulo i seen.1"
        => "N.modulo (N.add turn i) seen.1 == N.modulo j seen.1";
    a_robot_that_turned_round_comes_back, "Checker.v":
        "Leaves (back (+) turned) i w k" => "Leaves turned i w k";
    the_checker_lets_a_robot_drop_only_what_it_carries, "Checker.v":
        "DeedDrop => if place is None then Some (d, Some d) else None" => "DeedDrop => Some (d, Some d)";
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
        ("schemes", "Unset Elimination Schemes.", "Unset Elimination"),
        ("instance", "Declare Instance absurd : False.", "Declare Instance"),
        ("load", "Load \"absurd\".", "Load"),
    ] {
        let change = |text: &str| format!("{text}\n{added}\n");
        let changed = Changed::new(name, "Program.v", change, whole);
        let line = fs::read_to_string(changed.sources.join("Program.v")).unwrap().lines().count();
        let (stdout, _) = changed.violated();
        let why = "violated: a proof is left out, or something is assumed";
        assert_eq!(stdout, format!("Program.v:{line}: {found}\n\n{why}"));
    }
}

/// What was compiled with other options is compiled again: without Coq's own library nothing is accepted.
#[test]
#[ignore = "it needs Coq: `.ci/run --all`"]
fn what_was_compiled_with_other_options_is_not_kept() {
    let other = |options: &str| format!("{options}-arg -noinit\n");
    let (stdout, _) = Changed::new("options", "_CoqProject", other, compiled()).violated();
    assert_eq!(stdout, "violated: Coq does not accept the development");
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
