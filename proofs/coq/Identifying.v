(** Markers with which a robot can do what it does with a directional one. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Parts Simulation Mapper.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma identifying_suffices M near beyond :
  exists robot : strategy start, forall W : start, identifies M near beyond W -> maps_start (moving M) robot W.
Proof.
exists (simulating near beyond mapper) => W identifies_W.
have [map [n answered] iso] := mapper_maps W; exists map => //.
have small (d : W) : degree d <= #|W| by apply: max_card.
by have [n' _ answered'] := simulating_answers identifies_W small answered; exists n'.
Qed.

Section Kinds.

Variable W : start.

Lemma directed_edge_identifies : identifies directed_edge predT (fun seen => seen.2 == PassedAlong) W.
Proof.
move=> p d _ /=; rewrite /directed_edge; case: (opposite d =P facing W) => [back|_].
  by rewrite -back [d == _]eq_sym (negPf (opposite_neq d)).
by rewrite (inj_eq (@opposite_inj W)); case: (d =P facing W).
Qed.

Lemma two_distinct_identifies : simple W ->
  identifies two_distinct (fun seen => seen.2 == First) (fun seen => seen.2 == Second) W.
Proof.
move=> [no_loop no_parallel] p d pd /=; rewrite /two_distinct /two_looks.
have apart (q : W) : same_vertex q (facing W) -> same_vertex q (opposite (facing W)) = false.
  move=> near; apply: contraNF (no_loop (facing W)); apply: same_vertex_trans.
  by rewrite same_vertex_sym.
apply/idP/eqP => [|dE].
  case: ifP => near; last by case: ifP.
  rewrite (apart _ near) /=; case: ifP => near'; first by rewrite (apart _ near').
  case: ifP => // far _; apply: no_parallel far; apply: same_vertex_trans near.
  by rewrite same_vertex_sym.
rewrite dE in pd *; rewrite pd (apart _ pd) same_vertex_refl.
by rewrite same_vertex_sym (negPf (no_loop _)).
Qed.

Lemma dead_end_identifies : degree (facing W) = 1 ->
  identifies undirected (fun seen => seen == (1, Lying)) predT W.
Proof.
move=> one p d pd; rewrite andbT /perceive /undirected; apply/eqP/eqP => [[one_p]|dE].
  case: ifP => // near _; have /same_vertexP[i ->] : same_vertex d (facing W).
    by apply: same_vertex_trans near; rewrite same_vertex_sym.
  by rewrite -turn_mod -(same_vertex_degree pd) one_p modn1.
by rewrite -dE pd (same_vertex_degree pd) dE one.
Qed.

End Kinds.
