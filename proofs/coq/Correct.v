(** Algorithm 1 maps every world, within its bound on moves, with any valid test of hypotheses. Section 2.3;
    the bound is that of toposlam, with its constant. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Always Maps Embedding.
From toposlam Require Import Rounds Complete.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Correct.

Variable test : hypothesis_test.
Hypothesis test_valid : valid test.

Variable allowed : partial_map -> seq nat -> bool.
Hypothesis allowed_short : forall S path, size path < known_vertices S -> allowed S path.

Variable W : start.

(** The greatest cost of [left] rounds, with paths shorter than the number of vertices. *)
Definition cost left := left * vertices W + 2 * (left * left) * (vertices W).-1.

Lemma costS_le left k l u :
  k <= (vertices W).-1 + 1 + u.-1 * (2 * (vertices W).-1) -> u <= 2 * left.+1 -> l <= cost left ->
  0 < vertices W -> k + l <= cost left.+1.
Proof.
rewrite /cost; case: (vertices W) => // n /= k_le u_le l_le _.
have {}k_le : k <= n + 1 + (2 * left + 1) * (2 * n).
  apply: leq_trans k_le _; rewrite leq_add2l leq_mul2r; apply/orP; right.
  by arithmetic.
by arithmetic.
Qed.

(** The allowed paths are shorter than the number of known vertices. *)
Definition only_short := forall S path, allowed S path -> size path < known_vertices S.

Lemma vertices_gt0 : 0 < vertices W.
Proof.
apply/card_gt0P; exists (froot clockwise (facing W)); rewrite !inE andbT.
exact/roots_root/fconnect_sym/clockwise_inj.
Qed.

Lemma roundsS bound S pose :
  rounds test allowed bound.+1 S pose =
  if unexplored S is [::] then Return (Some (S, pose))
  else let* after := explore test allowed S pose in rounds test allowed bound after.1 after.2.
Proof. by []. Qed.

Lemma rounds_spec left bound S (place : nat -> W) pose :
  embeds S place -> pose < size S -> size S + 2 * left = 2 * edges W + size (unexplored S) ->
  left <= bound ->
  always (moving directional W) (rounds test allowed bound S pose) (place pose)
    (fun answer r k =>
       (exists T pose' (place' : nat -> W),
          [/\ answer = Some (T, pose'), embeds T place', unexplored T = [::], pose' < size T
            & r = place' pose']) /\
       (only_short -> k <= cost left)).
Proof.
elim: bound left S place pose => [|bound IH] left S place pose em lt count le.
  have none : unexplored S = [::].
    by have known := size_known em; apply: size0nil; arithmetic.
  by rewrite /= none; split=> //; exists S, pose, place.
rewrite roundsS; case UE: (unexplored S) => [|e U]; first by split=> //; exists S, pose, place.
have some_left : unexplored S != [::] by rewrite UE.
apply: always_bind; apply: alwaysW (explore_spec test_valid allowed_short em lt some_left).
move=> [T pose'] r k [[place' [/= em' lt' -> counted]] cost_k].
have known := size_known em.
have left_gt0 : 0 < left by move: count; rewrite UE /= => count; arithmetic.
have count' : size T + 2 * left.-1 = 2 * edges W + size (unexplored T) by arithmetic.
have le' : left.-1 <= bound by arithmetic.
apply: alwaysW (IH left.-1 T place' pose' em' lt' count' le').
move=> answer r' l [right cost_l]; split=> // short; rewrite -(prednK left_gt0).
apply: (@costS_le _ _ _ (size (unexplored S))) (cost_l short) vertices_gt0.
  apply: cost_k => path /short path_lt; rewrite -ltnS prednK ?vertices_gt0 //.
  exact: leq_trans path_lt (known_vertices_le em).
by rewrite prednK //; arithmetic.
Qed.

(** With any limit the rounds end with such a map, or without an answer. *)
Lemma rounds_sound bound S (place : nat -> W) pose : embeds S place -> pose < size S ->
  always (moving directional W) (rounds test allowed bound S pose) (place pose)
    (fun answer r _ => answer = None \/ exists T pose' (place' : nat -> W),
       [/\ answer = Some (T, pose'), embeds T place', unexplored T = [::], pose' < size T
         & r = place' pose']).
Proof.
elim: bound S place pose => [|bound IH] S place pose em lt.
  by rewrite /=; case UE: (unexplored S) => [|e U]; [right; exists S, pose, place | left].
rewrite roundsS; case UE: (unexplored S) => [|e U]; first by right; exists S, pose, place.
have some_left : unexplored S != [::] by rewrite UE.
apply: always_bind; apply: alwaysW (explore_spec test_valid allowed_short em lt some_left).
by move=> [T pose'] r k [[place' [/= em' lt' -> _]] _]; apply: IH.
Qed.

(** * From the start *)

Let g := degree (facing W).
Let at_start : nat -> W := turn (facing W).

Lemma unexplored_at_start : unexplored (with_vertex [::] g) = iota 0 g.
Proof. by rewrite unexplored_with_vertex. Qed.

Lemma embeds_at_start : embeds (with_vertex [::] g) at_start.
Proof.
have sz : size (with_vertex [::] g) = g by rewrite size_with_vertex.
have new d (lt : d < g) := @new_with_vertex [::] g d lt.
split; rewrite ?sz //.
- exact: well_formed_start (degree_gt0 _).
- move=> d e d_lt e_lt same.
  by rewrite -(findex_iter d_lt) -(findex_iter e_lt) -!/(turn _ _) -/(at_start d) same.
- by move=> d lt; have [_ -> _] := new d lt; rewrite degree_turn.
- by move=> d lt; have [-> _ _] := new d lt; rewrite subn0.
- by move=> d d' dd'; have := other_known dd'; rewrite sz => lt; have [_ _] := new d lt; rewrite dd'.
Qed.

Lemma algorithm1_spec bound : edges W <= bound ->
  always (moving directional W) (algorithm1 test allowed bound (perceive directional (facing W))) (facing W)
    (fun answer pose k => right_answer answer pose /\ (only_short -> k <= cost (edges W))).
Proof.
move=> le; have sz : size (with_vertex [::] g) = g by rewrite size_with_vertex.
have count : size (with_vertex [::] g) + 2 * edges W = 2 * edges W + size (unexplored (with_vertex [::] g)).
  by rewrite unexplored_at_start sz size_iota addnC.
have lt : 0 < size (with_vertex [::] g) by rewrite sz degree_gt0.
apply: alwaysW (rounds_spec embeds_at_start lt count le) => answer r k [[T [p [place]]]].
case=> -> em explored p_lt -> cost_k; split=> //.
have [L drawn_L iso] := drawn_isomorphic em explored p_lt; by exists T, p, L; split.
Qed.

(** With any limit on rounds, Algorithm 1 answers nothing or rightly. *)
Lemma algorithm1_sound bound :
  always (moving directional W) (algorithm1 test allowed bound (perceive directional (facing W))) (facing W)
    (fun answer pose _ => answer = None \/ right_answer answer pose).
Proof.
have lt : 0 < size (with_vertex [::] g) by rewrite size_with_vertex degree_gt0.
apply: alwaysW (rounds_sound bound embeds_at_start lt) => answer r k [->|]; first by left.
case=> T [p [place [-> em explored p_lt ->]]]; right.
have [L drawn_L iso] := drawn_isomorphic em explored p_lt; by exists T, p, L; split.
Qed.

End Correct.

(** * Two tests *)

Lemma as_printed_valid : valid as_printed.
Proof. by split=> [//|S pose ends|S pose seen /eqP//] /=; rewrite !eqxx if_same. Qed.

Lemma step_by_step_valid : valid step_by_step.
Proof. by split=> [S h|S pose ends|S pose seen /eqP//] /=. Qed.
