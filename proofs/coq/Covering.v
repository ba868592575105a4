(** A covering in which one dart has one preimage is an isomorphism: a complete folded trail is the world. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Covering.

Variables (V W : start) (f : V -> W).
Hypothesis f_opposite : forall d, f (opposite d) = opposite (f d).
Hypothesis f_clockwise : forall d, f (clockwise d) = clockwise (f d).
Hypothesis f_facing : forall d, f d = facing W <-> d = facing V.

(** Along a way from its image to the facing dart, two darts with one image stay two. *)
Lemma f_inj : injective f.
Proof.
move=> d e; have /connectP[s path_s last_s] := connected (f d) (facing W).
elim: s d e path_s last_s => [|r s IH] d e /=.
  move=> _ at_d same; have /f_facing-> := esym at_d.
  by apply/esym/f_facing; rewrite -same.
case/andP=> step path_s last_s same; case/orP: step => /eqP rE.
  apply: (inv_inj (@oppositeK V)); apply: IH; first by rewrite f_opposite -rE.
    by rewrite f_opposite -rE.
  by rewrite !f_opposite same.
apply: (@clockwise_inj V); apply: IH; first by rewrite f_clockwise -rE.
  by rewrite f_clockwise -rE.
by rewrite !f_clockwise same.
Qed.

Lemma f_onto (q : W) : q \in codom f.
Proof.
have /connectP[s path_s ->] := connected (facing W) q.
have : facing W \in codom f by apply/codomP; exists (facing V); apply/esym/f_facing.
elim: s (facing W) path_s => [|r s IH] p //= /andP[step path_s] /codomP[d dp].
apply: IH path_s _; apply/codomP; case/orP: step => /eqP->.
  by exists (opposite d); rewrite f_opposite dp.
by exists (clockwise d); rewrite f_clockwise dp.
Qed.

Lemma covering_isomorphic : isomorphic_starts V W.
Proof.
exists f; split; last exact/f_facing; split => //.
apply: inj_card_bij f_inj _; rewrite -(card_codom f_inj).
by apply/subset_leq_card/subsetP=> q _; apply: f_onto.
Qed.

End Covering.
