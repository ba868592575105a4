(** An undirected marker determines the start, if its degree and the number of darts have no common divisor. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Walks Bisimulation Classes.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma alike_turn M (V W : start) (p : V) (q : W) i :
  alike M p q -> alike M (turn p i : V) (turn q i : W).
Proof.
move=> pq; elim: i => //= i IH.
by have := alike_walk [:: 1; 0] IH; rewrite !walk_clockwise.
Qed.

(** All classes have one size, and the number of darts is a multiple of it. *)
Lemma card_class_dvd_darts M (W : start) (p : W) : #|class M W p| %| #|W|.
Proof.
have parts : partition (equivalence_partition (@alikeb M W W) setT) setT.
  by apply: equivalence_partitionP => q r s _ _ _; apply: alikeb_equiv.
rewrite -cardsT (@card_uniform_partition _ #|class M W p| _ _ _ parts); first exact: dvdn_mull.
move=> _ /imsetP[q _ ->]; rewrite (card_class M W p q) cardsE.
by apply: eq_card => r; rewrite [LHS]unfold_in in_setT.
Qed.

Lemma coprime_degree_determines (V W : start) :
  coprime (degree (facing W)) #|W| -> indistinguishable undirected V W -> isomorphic_starts V W.
Proof.
move=> coprime_W same.
have [size [size_degree V_V W_W V_W W_V]] := indistinguishable_classes same.
have size1 : size = 1.
  apply/eqP; rewrite -dvdn1 -(eqP coprime_W) dvdn_gcd -(indistinguishable_degree same) size_degree.
  by rewrite -(W_W (facing W)) card_class_dvd_darts.
have partner (p : V) : exists q : W, alikeb undirected p q.
  by have [q /alikeP pq] := indistinguishable_alike p same; exists q.
pose f (p : V) : W := xchoose (partner p).
have fP p : alike undirected p (f p) by apply/alikeP/(xchooseP (partner p)).
have f_one p q : alike undirected p q -> f p = q.
  move=> pq; have := V_W p; rewrite size1 => /mem_card1[r class_r].
  have in_class s : alike undirected p s -> s = r.
    by move=> ps; apply/eqP; have := class_r s; rewrite !inE => <-; apply/alikeP.
  by rewrite (in_class _ pq); apply: in_class.
exists f; split; last exact: f_one same.
split=> [|p|p]; last 2 first.
- by apply: f_one; apply: (alike_walk [:: 0] (fP p)).
- by apply: f_one; apply: (alike_turn 1 (fP p)).
have f_inj : injective f.
  move=> p p' pp'; have := W_V (f p); rewrite size1 => /mem_card1[r class_r].
  have in_class s : alike undirected s (f p) -> s = r.
    move=> sp; apply/eqP; have := class_r s; rewrite !inE => <-.
    by apply/alikeP => doors; rewrite sp.
  by rewrite (in_class _ (fP p)) [RHS](in_class p') // pp'.
apply: inj_card_bij f_inj _.
by have := indistinguishable_card same predT; rewrite (eq_card (B := V)) // [X in _ = X](eq_card (B := W)) // => ->.
Qed.
