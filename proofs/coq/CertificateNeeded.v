(** A walk that determines its world is not shorter than the formula of the certificate. Beyond Section 2.3. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Certificate Walks Arithmetic Parts Complete Moves Subdivision Trail Determined
  Returns Hanging.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Sums *)

Lemma sum_below N k : \sum_(t < N) (t < k : nat) = minn k N.
Proof.
elim: N => [|N IH]; first by rewrite big_ord0 minn0.
by rewrite big_ord_recr /= IH !minnE; case: ltnP => le /=; arithmetic.
Qed.

Lemma card_sum (T : finType) (P Q : pred T) : #|[set x | P x && Q x]| = \sum_(x | P x) (Q x : nat).
Proof. by rewrite -sum1dep_card big_mkcondr; apply: eq_bigr => x _; case: (Q x). Qed.

Section Sums.

Variable W : start.

Lemma edge_root (d : W) : froot opposite d = d \/ froot opposite d = opposite d.
Proof.
have /iter_findex <- : fconnect opposite d (froot opposite d) by apply: connect_root.
elim: (findex _ _ _) => [|k /= [->|->]]; [by left | by right | left; exact: oppositeK].
Qed.

Lemma edge_root_opposite (d : W) : froot opposite (opposite d) = froot opposite d.
Proof.
have sym := fconnect_sym (@opposite_inj W).
by apply/eqP; rewrite root_connect // sym fconnect1.
Qed.

(** All darts are the two ends of edges. *)
Lemma sum_edges (g : W -> nat) :
  \sum_(d : W) g d = \sum_(d : W | froot opposite d == d) (g d + g (opposite d)).
Proof.
rewrite (bigID (fun d => froot opposite d == d)) big_split /=; congr (_ + _).
rewrite (reindex_inj (@opposite_inj W)); apply: eq_bigl => d; rewrite edge_root_opposite.
case: (edge_root d) => ->; rewrite ?eqxx; first by rewrite eq_sym opposite_neq.
by rewrite (negPf (opposite_neq d)).
Qed.

Lemma sum_edges1 : \sum_(d : W | froot opposite d == d) 1 = edges W.
Proof. by rewrite sum1dep_card -card_edge_roots. Qed.

End Sums.

Section Weights.

Variable W : start.
Implicit Types (x y h : W).

(** * Distances over edges that do not hang *)

Definition core x := distance x - hanging_above x.

Lemma core_above x : core x + hanging_above x = distance x.
Proof. exact/subnK/above_le_distance. Qed.

Lemma core_same x y : same_vertex x y -> core x = core y.
Proof. by move=> xy; rewrite /core (distance_same xy) (above_same xy). Qed.

Lemma core_facing : core (facing W) = 0.
Proof. by rewrite /core distance_facing. Qed.

Lemma core_hanging x : hanging_edge x -> core (opposite x) = core x.
Proof.
case/orP=> hangs; rewrite /core; first by rewrite (distance_hanging hangs) (above_hanging hangs) subSS.
by rewrite (distance_hanging hangs) (above_hanging hangs) subSS oppositeK.
Qed.

Lemma core_step x : core (opposite x) <= core x + ~~ hanging_edge x.
Proof.
have [hangs|not_hangs] := boolP (hanging_edge x); first by rewrite core_hanging // addn0.
by have := distance_step x; rewrite /core above_edge0 ?hanging_edge_opposite // above_edge0 // !subn0 addn1.
Qed.

(** What a closed walk needs that goes over an edge. *)
Definition weight x := core x + core (opposite x) + ~~ hanging_edge x.

Lemma weight_opposite x : weight (opposite x) = weight x.
Proof. by rewrite /weight hanging_edge_opposite oppositeK (addnC (core (opposite x))). Qed.

Definition heavy t : pred W := fun x => t < weight x.

Lemma core_near t x : 2 * core x <= t -> near_without (heavy t) x.
Proof.
move dE: (distance x) => k; elim: k x dE => [|k IH] x dE light.
  by rewrite -(near_same _ (distance0 dE)) near_facing.
have [|y xy] := @distance_parent _ x; first by rewrite dE.
rewrite dE => -[kE]; rewrite (near_same _ xy); move: light; rewrite (core_same xy) => light.
have [w_le core_le] : weight y <= 2 * core y /\ core (opposite y) <= core y.
  rewrite /weight; have [hangs|not_hangs] := boolP (hanging_edge y).
    by rewrite core_hanging // addn0 mul2n -addnn.
  rewrite /core -(distance_same xy) dE -kE !above_edge0 ?hanging_edge_opposite // !subn0.
  by split=> //=; arithmetic.
have near : near_without (heavy t) (opposite y).
  by apply: IH; [rewrite kE | apply: leq_trans light; rewrite leq_mul2l].
have := near_opposite _ near; rewrite oppositeK; apply.
by rewrite /heavy weight_opposite -leqNgt; apply: leq_trans light.
Qed.

End Weights.

Section Walk.

Variables (W : start) (doors : seq door).
Implicit Types (x y h : W).

Notation n := (size doors).
Let pos k : W := walk (facing W) (take k doors).
Let out k : W := turn (pos k) (nth 0 doors k).

Let pos_next k : k < n -> pos k.+1 = opposite (out k).
Proof. exact: pose_step. Qed.

Let pos0 : pos 0 = facing W. Proof. by rewrite /pos take0. Qed.

(** * Moves over edges that do not hang *)

Let paid k : nat := ~~ hanging_edge (out k).

Let core_out k : core (out k) = core (pos k).
Proof. by apply/esym/core_same; apply: same_vertex_turn. Qed.

Lemma core_walk i j : i <= j <= n ->
  core (pos j) <= core (pos i) + \sum_(i <= k < j) paid k /\ core (pos i) <= core (pos j) + \sum_(i <= k < j) paid k.
Proof.
case/andP; elim: j => [|j IH]; first by rewrite leqn0 => /eqP-> _; rewrite big_geq // addn0.
rewrite leq_eqVlt => /predU1P[-> _|]; first by rewrite big_geq // addn0.
rewrite ltnS => ij j_lt; have [up down] := IH ij (ltnW j_lt); rewrite big_nat_recr //= pos_next //.
have step := core_step (out j); have step' := core_step (opposite (out j)).
rewrite hanging_edge_opposite oppositeK in step'; rewrite core_out -/(paid j) in step step'.
by split; arithmetic.
Qed.

(** The move after the last return before a move. *)
Let back k := same_vertex (pos k.+1) (facing W).

Fixpoint since k := if k is k'.+1 then if back k' then k else since k' else 0.

Lemma since_le k : since k <= k.
Proof. by elim: k => //= k IH; case: ifP => // _; apply: leqW. Qed.

Lemma since_marker k : same_vertex (facing W) (pos (since k)).
Proof.
elim: k => [|k IH] /=; first by rewrite pos0 same_vertex_refl.
by case: ifP => // near; rewrite same_vertex_sym.
Qed.

Lemma since_before k j : j <= k -> (forall i, j <= i < k -> ~~ back i) -> since k <= j.
Proof.
elim: k => [|k IH] /=; first by [].
rewrite leq_eqVlt => /predU1P[-> _|]; first by case: ifP => // _; apply: leqW (since_le k).
rewrite ltnS => jk none; rewrite (negPf (none k _)) ?jk ?leqnn //; apply: IH jk _ => i /andP[ji ik].
by apply: none; rewrite ji leqW.
Qed.

Let loop k := \sum_(since k <= l < k.+1) paid l.

Lemma loops_sum k : \sum_(0 <= i < k | back i) loop i + \sum_(since k <= l < k) paid l = \sum_(0 <= l < k) paid l.
Proof.
elim: k => [|k IH]; first by rewrite !big_geq.
rewrite [RHS]big_nat_recr //= -IH big_mkcond big_nat_recr //= -big_mkcond /=.
case: ifP => _; last by rewrite addn0 (big_nat_recr k (since k)) ?since_le //= addnA.
by rewrite (big_geq (leqnn _)) addn0 /loop (big_nat_recr k (since k)) ?since_le //= addnA.
Qed.

Let at_marker x : same_vertex (facing W) x -> core x = 0.
Proof. by move/core_same <-; apply: core_facing. Qed.

Lemma heavy_loop t (k : 'I_n) : k \in far_returns doors (@heavy W t) -> (k \in coming_back W doors) && (t < loop k).
Proof.
rewrite inE => /andP[back_k]; rewrite back_k /= => /existsP[j /and3P[jk far_j /forallP none]].
have start_le : since k <= j.
  apply: since_before jk _ => i /andP[ji ik]; have i_lt : i < n := ltn_trans ik (ltn_ord k).
  by have := none (Ordinal i_lt); rewrite /= ji ik inE.
have [|up _] := @core_walk (since k) j; first by rewrite start_le ltnW.
have [|_ down] := @core_walk j.+1 k.+1; first by rewrite ltnS jk ltn_ord.
have back_k' : back k by move: back_k; rewrite inE.
rewrite (at_marker (since_marker k)) add0n in up.
rewrite [core (pos k.+1)]at_marker ?add0n in down; last by rewrite same_vertex_sym.
apply: leq_trans far_j _; rewrite /loop (big_cat_nat _ _ _ start_le) ?leqW //=.
rewrite (big_cat_nat _ _ _ (leqnSn j)) ?ltnS //= big_nat1 /weight -/(out j) core_out -pos_next //.
by rewrite /paid in up down *; arithmetic.
Qed.

Hypothesis determined : forall V : start, sees V doors = sees W doors -> isomorphic_starts V W.

Lemma loops_needed :
  \sum_(d : W | froot opposite d == d) weight d <=
  \sum_(d : W | froot clockwise d == d) 2 * core d + \sum_(0 <= i < n | back i) loop i.
Proof.
pose N := \max_(d : W) weight d.
have -> : \sum_(d : W | froot opposite d == d) weight d = \sum_(t < N) far_edges (@heavy W t).
  under [RHS]eq_bigr => t _ do rewrite /far_edges card_sum.
  rewrite exchange_big; apply: eq_bigr => d _ /=; rewrite sum_below; apply/esym/minn_idPl.
  exact: (leq_bigmax (F := fun d : W => weight d)).
have vertices_le t : far_vertices (@heavy W t) <= \sum_(d : W | froot clockwise d == d) (t < 2 * core d : nat).
  rewrite -card_sum; apply/subset_leq_card/subsetP=> d; rewrite !inE => /andP[-> away] /=.
  by rewrite ltnNge; apply: contra away; apply: core_near.
have returns_le t : #|far_returns doors (@heavy W t)| <= \sum_(k : 'I_n | back k) (t < loop k : nat).
  by rewrite -card_sum; apply/subset_leq_card/subsetP=> k /heavy_loop; rewrite !inE.
have sum_le (I : finType) (P : pred I) (F : I -> nat) :
    \sum_(t < N) \sum_(i | P i) (t < F i : nat) <= \sum_(i | P i) F i.
  by rewrite exchange_big; apply: leq_sum => i _ /=; rewrite sum_below geq_minl.
rewrite big_mkord; apply: leq_trans (leq_add (sum_le _ _ _) (sum_le _ _ _)); rewrite -big_split /=.
apply: leq_sum => t _; apply: leq_trans (leq_add (vertices_le t) (returns_le t)).
by apply: (far_returns_needed determined) => d; rewrite /heavy weight_opposite.
Qed.

(** * Moves over hanging edges *)

Let crosses h k : nat := edge_of h (out k).
Let near h k := near_without (edge_of h) (pos k).

Lemma crossed h i j : i <= j <= n -> near h i != near h j -> 0 < \sum_(i <= k < j) crosses h k.
Proof.
case/andP; elim: j => [|j IH]; first by rewrite leqn0 => /eqP->; rewrite eqxx.
rewrite leq_eqVlt => /predU1P[->|]; first by rewrite eqxx.
rewrite ltnS => ij j_lt differ; rewrite big_nat_recr //=; have [//|other] := boolP (edge_of h (out j)).
  by rewrite /crosses => ->; rewrite addn1.
rewrite ltn_addr // IH ?(ltnW j_lt) //; apply: contra differ => /eqP->; apply/eqP.
rewrite /near pos_next // near_edge ?edge_of_oppositer //; apply: near_same; exact: same_vertex_turn.
Qed.

Lemma traversedP (p : W) ds d : traverses p ds d ->
  exists2 k, k < size ds & edge_of d (turn (walk p (take k ds)) (nth 0 ds k)).
Proof.
elim: ds p => //= i ds IH p /or3P[/eqP pE|/eqP pE|/IH[k lt at_k]]; last by exists k.+1.
  by exists 0; rewrite //= pE /edge_of eqxx.
by exists 0; rewrite //= /edge_of -pE /traverse oppositeK eqxx orbT.
Qed.

Lemma hanging_crossed h : h \in hanging W -> 1 + near h n <= \sum_(0 <= k < n) crosses h k.
Proof.
move=> h_hangs; have away := hanging_bridge h_hangs.
have [k lt at_k] : exists2 k, k < n & edge_of h (out k).
  apply: traversedP; apply: contraT => avoids.
  have [f [iso _]] : isomorphic_starts (subdivided h) W by apply/determined/subdivided_percepts.
  by case: (@subdivided_not_isomorphic W h); exists f.
have [j j_le far_j] : exists2 j, j <= n & ~~ near h j.
  case/orP: at_k => /eqP outE; last by exists k.+1; rewrite // /near pos_next // outE oppositeK.
  have same : near_without (edge_of h) (pos k) = near_without (edge_of h) (out k).
    exact/near_same/same_vertex_turn.
  by exists k; [apply: ltnW | rewrite /near same outE].
have near0 : near h 0 by rewrite /near pos0 near_facing.
rewrite (big_cat_nat _ _ _ (leq0n j)) //= leq_add //; first by apply: crossed; rewrite // near0 (negPf far_j).
by case near_n: (near h n) => //; apply: crossed; rewrite ?j_le ?leqnn // near_n (negPf far_j).
Qed.

Lemma hanging_one x : \sum_(h in hanging W) (edge_of h x : nat) <= hanging_edge x.
Proof.
rewrite -card_sum; have [hangs|none] := boolP (hanging_edge x).
  pose h := if x \in hanging W then x else opposite x.
  apply: (@leq_trans #|[set h]|); last by rewrite cards1.
  apply/subset_leq_card/subsetP=> g; rewrite !inE => /andP[g_hangs].
  case/orP=> /eqP xE; rewrite /h xE; first by rewrite g_hangs.
  by rewrite (negPf (hanging_once g_hangs)) oppositeK.
rewrite leqn0 cards_eq0; apply/eqP/setP=> g; rewrite !inE; apply: contraNF none => /andP[g_hangs].
by case/orP=> /eqP->; rewrite /hanging_edge ?oppositeK g_hangs ?orbT.
Qed.

Lemma hanging_needed :
  2 * #|hanging W| <= hanging_above (pos n) + \sum_(0 <= k < n) hanging_edge (out k).
Proof.
have moves_le : \sum_(h in hanging W) (1 + near h n) <= \sum_(0 <= k < n) hanging_edge (out k).
  apply: (@leq_trans (\sum_(h in hanging W) \sum_(0 <= k < n) crosses h k)).
    by apply: leq_sum => h; apply: hanging_crossed.
  by rewrite exchange_big; apply: leq_sum => k _; apply: hanging_one.
apply: leq_trans (leq_add (leqnn _) moves_le).
rewrite /hanging_above card_sum -big_split /= -sum1_card big_distrr /=; apply: leq_sum => h _.
by rewrite -/(near h n); case: (near h n).
Qed.

(** * The length *)

(** The sums with all distances differ from those over edges that do not hang by the same number. *)
Lemma sum_above :
  \sum_(d : W | froot opposite d == d) (hanging_above d + hanging_above (opposite d) + hanging_edge d) =
  \sum_(d : W | froot clockwise d == d) 2 * hanging_above d.
Proof.
have sym := fconnect_sym (@clockwise_inj W).
have -> : \sum_(d : W | froot opposite d == d) (hanging_above d + hanging_above (opposite d) + hanging_edge d) =
    \sum_(h in hanging W) 2 * hanging_above h.
  rewrite [RHS]big_mkcond sum_edges; apply: eq_bigr => d _.
  case: (boolP (d \in _)) => [hangs|not_hangs].
    rewrite (negPf (hanging_once hangs)) /hanging_edge hangs (above_hanging hangs) addn0 mul2n -addnn.
    by rewrite -addnA addn1.
  case: (boolP (opposite d \in _)) => [hangs|not_hangs'].
    rewrite /hanging_edge hangs orbT (above_hanging hangs) oppositeK add0n mul2n -addnn.
    by rewrite addnC addnA add1n.
  have none : ~~ hanging_edge d by rewrite /hanging_edge negb_or not_hangs.
  by rewrite (negPf none) !above_edge0 // hanging_edge_opposite.
pose f (h : W) := froot clockwise h.
have same_f h : same_vertex (f h) h by rewrite same_vertex_sym; apply: connect_root.
have f_inj : {in hanging W &, injective f}.
  move=> h h' h_hangs h'_hangs same; apply/eqP; apply: contraT => other.
  have at_h : same_vertex h h' by rewrite /same_vertex -(root_connect sym); apply/eqP.
  have /hangingP[_ all] := h_hangs; have := all h' at_h; rewrite eq_sym => /(_ other).
  by rewrite (negPf (hanging_once h'_hangs)).
under eq_bigr => h _ do rewrite -(above_same (same_f h)).
rewrite -(big_imset (fun d => 2 * hanging_above d) f_inj) /=.
rewrite [RHS](bigID (mem (f @: hanging W))) /= [X in _ = _ + X]big1 ?addn0.
  apply: eq_bigl => d; apply/idP/andP=> [in_f|[] //]; split=> //.
  by case/imsetP: in_f => h _ ->; rewrite /f (root_root sym).
move=> d /andP[/eqP root_d]; case above: (hanging_above d) => [|k] // /negP[].
have [|h h_hangs at_h] := @above_hangs _ d; first by rewrite above.
apply/imsetP; exists h => //; rewrite -root_d; apply/eqP.
by rewrite /f (root_connect sym).
Qed.

Lemma certificate_needed : certificate_moves W <= n.
Proof.
have all_moves : n = \sum_(0 <= k < n) paid k + \sum_(0 <= k < n) hanging_edge (out k).
  rewrite -big_split /= -[LHS]subn0 -[LHS]muln1 -sum_nat_const_nat; apply: eq_bigr => k _.
  by rewrite /paid; case: hanging_edge.
have loops := loops_needed; have ways := loops_sum n.
have [|tail _] := @core_walk (since n) n; first by rewrite since_le leqnn.
rewrite (at_marker (since_marker n)) add0n in tail.
have over := hanging_needed.
pose sum_d := \sum_(d : W | froot clockwise d == d) distance d.
have edges_sum : edges W + \sum_(d : W) distance d = \sum_(d : W | froot opposite d == d) weight d +
    \sum_(d : W | froot opposite d == d) (hanging_above d + hanging_above (opposite d) + hanging_edge d).
  rewrite sum_edges -sum_edges1 -!big_split /=; apply: eq_bigr => d _; rewrite /weight.
  rewrite -(core_above d) -(core_above (opposite d)); case: hanging_edge => /=; arithmetic.
have vertices_sum : 2 * sum_d = \sum_(d : W | froot clockwise d == d) 2 * core d +
    \sum_(d : W | froot clockwise d == d) 2 * hanging_above d.
  by rewrite /sum_d big_distrr -big_split /=; apply: eq_bigr => d _; rewrite -mulnDr core_above.
rewrite /certificate_moves edges_sum sum_above -/sum_d vertices_sum.
set saved := \max_(_ in _ | _) _.
have saves : 2 * hanging_above (pos n) - distance (pos n) <= saved.
  have [none|] := posnP (hanging_above (pos n)); first by rewrite none.
  case/above_hangs=> h h_hangs near_h; rewrite (above_same near_h) (distance_same near_h).
  have [leaf /andP[leaf_hangs leaf_1] le] := hanging_leaf h_hangs; apply: leq_trans le _.
  by apply: (leq_bigmax_cond (F := fun d : W => 2 * hanging_above d - distance d)); rewrite leaf_hangs.
have distanceE := core_above (pos n).
move: loops ways tail over saves all_moves distanceE {edges_sum vertices_sum}.
set w := \sum_(d : W | _) weight d; set c := \sum_(d : W | _) 2 * core d; set a := \sum_(d : W | _) 2 * _.
set l := \sum_(0 <= k < n | _) _; set p := \sum_(0 <= k < n) paid k; set o := \sum_(0 <= k < n) _.
set t := \sum_(since n <= k < n) _; clearbody w c a l p o t saved => loops ways tail over saves all_moves distanceE.
arithmetic.
Qed.

End Walk.
