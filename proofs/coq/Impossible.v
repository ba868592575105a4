(** No robot maps both of two worlds that it cannot distinguish: without a marker the cycles of 3 and 4
    edges, with an undirected one the two worlds of Figure 1. Section 2.2. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Bisimulation Figures.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The robot gives the same map in both. *)
Lemma bisimilar_maps O E (I : start -> environment_of O E) (robot : robot_of O E embedded_graph) V W :
  bisimilar I V W -> maps I robot V -> maps I robot W -> isomorphic V W.
Proof.
move=> /(bisimilar_answers robot) same [map /same answers_map map_V] [map' answers_map' map_W].
by apply: isomorphic_trans (isomorphic_sym map_V) _; rewrite (answers_inj answers_map answers_map').
Qed.

(** And if the map contains the start, it is the same start in both. *)
Lemma bisimilar_maps_start O E (I : start -> environment_of O E) (robot : robot_of O E start) V W :
  bisimilar I V W -> maps_start I robot V -> maps_start I robot W -> isomorphic_starts V W.
Proof.
move=> /(bisimilar_answers robot) same [map /same answers_map map_V] [map' answers_map' map_W].
apply: isomorphic_starts_trans (isomorphic_starts_sym map_V) _.
by rewrite (answers_inj answers_map answers_map').
Qed.

Corollary bisimilar_impossible O E (I : start -> environment_of O E) V W :
  bisimilar I V W -> ~ isomorphic V W ->
  forall robot : robot_of O E embedded_graph, ~ (maps I robot V /\ maps I robot W).
Proof. by move=> VW not_iso robot [/(bisimilar_maps VW) both /both]. Qed.

Lemma no_marker_impossible (robot : strategy embedded_graph) :
  ~ (maps (moving no_marker) robot cycle_3 /\ maps (moving no_marker) robot cycle_4).
Proof. exact: bisimilar_impossible cycles_bisimilar cycles_not_isomorphic robot. Qed.

Lemma undirected_marker_impossible (robot : strategy embedded_graph) :
  ~ (maps (moving undirected) robot figure_1a /\ maps (moving undirected) robot figure_1b) /\
  ~ (maps (moving undirected) robot smallest_a /\ maps (moving undirected) robot smallest_b).
Proof.
split; first exact: bisimilar_impossible figure_1_bisimilar figure_1_not_isomorphic robot.
exact: bisimilar_impossible smallest_bisimilar smallest_not_isomorphic robot.
Qed.
