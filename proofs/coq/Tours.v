(** Maps that can be checked: a walk whose folded trail in a map is complete has the percepts of the map only
    where the map is right. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Separates Bisimulation Parts Figures Trail Determined.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma tour_checks_the_map (T : start) tour : complete tour (sees T tour) ->
  forall (W : start) (q : W),
    percepts directional q tour = sees T tour <-> q = facing W /\ isomorphic_starts T W.
Proof.
move=> complete_T W q; split=> [same|[-> iso]]; last exact/esym/isomorphic_sees.
have at_start : q = facing W.
  apply/pointing0P; have := percepts_eq_walk same (leq0n _); rewrite !take0 /= /perceive => -[_ ->].
  exact/pointing0P.
split=> //; apply: isomorphic_starts_sym; rewrite at_start in same.
exact: complete_folding_determines complete_T.
Qed.

Lemma false_percepts_eq0 right perceived :
  size perceived = size right -> false_percepts right perceived = 0 -> perceived = right.
Proof.
rewrite /false_percepts => same_size none; apply/esym.
elim: right perceived same_size none => [|x right IH] [|y perceived] //= [same_size].
by case: eqP => //= -> none; rewrite (IH perceived).
Qed.

Lemma k_false_percepts (T W : start) tour k (q : 'I_k.+1 -> W) (perceived : 'I_k.+1 -> seq percept) :
  complete tour (sees T tour) ->
  (forall j, perceived j = sees T tour) ->
  \sum_j false_percepts (percepts directional (q j) tour) (perceived j) <= k ->
  isomorphic_starts T W.
Proof.
move=> complete_T agree few.
have [j /eqP none] : exists j, false_percepts (percepts directional (q j) tour) (perceived j) == 0.
  apply/existsP; apply: contraLR few => /existsPn some; rewrite -ltnNge.
  have {1}-> : k.+1 = \sum_(j < k.+1) 1 by rewrite sum1_card card_ord.
  by apply: leq_sum => j _; rewrite lt0n.
have same_size : size (perceived j) = size (percepts directional (q j) tour).
  by rewrite agree /sees !size_percepts.
have [_ iso] := (tour_checks_the_map complete_T (q j)).1 (etrans (esym (false_percepts_eq0 same_size none)) (agree j)).
exact: iso.
Qed.

(** * One false percept in an audit *)

(** A chain of two vertices and one of three. *)
Definition chain_2_file : world_file := [:: [:: 1]; [:: 0]].
Definition chain_3_file : world_file := [:: [:: 1]; [:: 0; 2]; [:: 1]].

Lemma chain_2_sound : sound chain_2_file. Proof. by vm_compute. Qed.
Lemma chain_3_sound : sound chain_3_file. Proof. by vm_compute. Qed.

Definition chain_2 : start := start_at chain_2_sound (erefl : (0, 1) \in names chain_2_file).
Definition chain_3 : start := start_at chain_3_sound (erefl : (0, 1) \in names chain_3_file).

Lemma chain_2_sees : sees chain_2 [:: 0] = [:: (1, Pointing 0); (1, Nothing)].
Proof.
rewrite /sees /= /perceive !world_degree /directional !world_same_vertex /=.
by rewrite findex0.
Qed.

Lemma chain_3_sees : sees chain_3 [:: 0] = [:: (1, Pointing 0); (2, Nothing)].
Proof.
rewrite /sees /= /perceive !world_degree /directional !world_same_vertex /=.
by rewrite findex0.
Qed.

Lemma chain_2_complete : complete [:: 0] (sees chain_2 [:: 0]).
Proof.
rewrite chain_2_sees => -[|[|visit]] [|i] //= _ _.
  by exists (0, 0), (1, 0); split; [apply: Same | apply: (@Onward [:: 0] 0)].
by exists (1, 0), (0, 0); split; [apply: Same | apply: (@Backward [:: 0] 0)].
Qed.

Lemma one_false_percept :
  [/\ complete [:: 0] (sees chain_2 [:: 0]), ~ isomorphic chain_2 chain_3
    & false_percepts (sees chain_3 [:: 0]) (sees chain_2 [:: 0]) = 1].
Proof.
split; [exact: chain_2_complete | | by rewrite chain_2_sees chain_3_sees].
move=> [f [f_bij _ _]]; have := bij_eq_card f_bij.
by rewrite /= !card_seq_sub.
Qed.
