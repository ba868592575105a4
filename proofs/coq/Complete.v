(** A map in which nothing is unexplored is the whole world. Section 2.3, the end of Algorithm 1. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Maps Embedding.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** Edges have two ends. *)
Lemma order_opposite (G : embedded_graph) (d : G) : order opposite d = 2.
Proof.
have cycle_d : fcycle opposite [:: d; opposite d] by rewrite /= oppositeK !eqxx.
have uniq_d : uniq [:: d; opposite d] by rewrite /= inE eq_sym opposite_neq.
by rewrite (order_cycle cycle_d uniq_d) ?mem_head.
Qed.

Lemma card_edge_orbits (G : embedded_graph) : fcard (@opposite G) G * 2 = #|G|.
Proof.
apply: (fcard_order_set (inv_inj (@oppositeK G))) => //.
by apply/subsetP=> d _; rewrite inE order_opposite.
Qed.

Lemma edges_orbits (G : embedded_graph) : edges G = fcard (@opposite G) G.
Proof. by rewrite /edges -card_edge_orbits muln2 doubleK. Qed.

Lemma card_darts (G : embedded_graph) : #|G| = 2 * edges G.
Proof. by rewrite edges_orbits -card_edge_orbits mulnC. Qed.

Section Embedded.

Variables (S : partial_map) (W : start) (place : nat -> W).
Hypothesis em : embeds S place.

Let wf := em_wf em.

Lemma uniq_placed (l : seq nat) : uniq l -> (forall d, d \in l -> d < size S) -> uniq (map place l).
Proof.
move=> uniq_l lt; rewrite map_inj_in_uniq // => d e /lt d_lt /lt e_lt; exact: (em_inj em d_lt e_lt).
Qed.

(** The map has at most as many darts as the world. *)
Lemma size_known : size S <= 2 * edges W.
Proof.
rewrite -card_darts.
have /card_uniqP : uniq (map place (iota 0 (size S))).
  by apply: uniq_placed => [|d]; [apply: iota_uniq | rewrite mem_iota].
by rewrite size_map size_iota => <-; apply: max_card.
Qed.

Lemma known_vertices_le : known_vertices S <= vertices W.
Proof.
rewrite /known_vertices -size_filter; set firsts := [seq d <- _ | _].
have known d : d \in firsts -> d < size S /\ vertex S d = d.
  by rewrite mem_filter mem_iota => /andP[/eqP]. 
pose roots := [seq froot clockwise (place d) | d <- firsts].
have : uniq roots.
  rewrite map_inj_in_uniq ?filter_uniq ?iota_uniq // => d e /known[d_lt dv] /known[e_lt ev].
  move/eqP; rewrite root_connect; last exact: fconnect_sym (@clockwise_inj W).
  by rewrite -/(same_vertex _ _) (same_vertex_known em) // dv ev => /eqP.
move/card_uniqP; rewrite size_map => <-; apply: subset_leq_card; apply/subsetP=> _ /mapP[d _ ->].
by rewrite inE andbT; apply: roots_root; apply: fconnect_sym (@clockwise_inj W).
Qed.

Hypothesis explored : unexplored S = [::].

Lemma all_explored d : d < size S -> exists d', other S d = Some d'.
Proof.
move=> lt; have := mem_unexplored S d; rewrite explored lt /=.
by case: (other S d) => // d' _; exists d'.
Qed.

(** Every dart of the world is in the map. *)
Lemma place_onto (q : W) : exists2 d, d < size S & place d = q.
Proof.
have /connectP[s path_s ->] := connected (facing W) q.
have : exists2 d, d < size S & place d = facing W.
  by exists 0; [apply: wf_some wf | apply: em_facing em].
elim: s (facing W) path_s => [|r s IH] p //= /andP[step path_s] [d lt dp]; apply: IH path_s _.
case/orP: step => /eqP->; last first.
  by have [e [e_lt _ placed]] := turn_known em 1 lt; exists e; rewrite // placed dp.
have [d' dd'] := all_explored lt; have [lt' _ _] := wf_other wf dd'.
by exists d'; rewrite // (em_other em dd') dp.
Qed.

Lemma size_complete : size S = 2 * edges W.
Proof.
apply/eqP; rewrite eqn_leq size_known -card_darts /=.
apply: leq_trans (_ : size (map place (iota 0 (size S))) <= _).
  apply: leq_trans (card_size _); apply/subset_leq_card/subsetP=> q _.
  by have [d lt <-] := place_onto q; rewrite map_f // mem_iota.
by rewrite size_map size_iota.
Qed.

(** * The world that the map describes *)

Let f (d : 'I_(size S)) : W := place d.

Lemma f_inj : injective f.
Proof. by move=> d e /(em_inj em (ltn_ord d) (ltn_ord e)) /val_inj. Qed.

Lemma f_opposite d : f (drawn_opposite d) = opposite (f d).
Proof.
have [d' dd'] := all_explored (ltn_ord d); have [lt _ _] := wf_other wf dd'.
by rewrite /f /drawn_opposite dd' /= insubdK // (em_other em dd').
Qed.

Lemma f_clockwise d : f (drawn_clockwise d) = clockwise (f d).
Proof.
have lt := ltn_ord d; have [bounds out] := wf_bounds wf lt; case/andP: (bounds) => le lt_d.
set e := vertex S d + (d - vertex S d).+1 %% doors S d.
have near : vertex S d <= e < vertex S d + doors S d.
  by rewrite leq_addr ltn_add2l ltn_pmod // (doors_gt0 em).
have e_lt : e < size S by case/andP: near => _ e_lt; apply: leq_trans e_lt out.
have [same _] := wf_same wf lt near.
rewrite /f /drawn_clockwise insubdK // (em_turn em e_lt) same addKn -(degree_vertex em lt) turn_mod.
by rewrite [in RHS](em_turn em lt).
Qed.

Lemma f_bij : bijective f.
Proof.
apply: inj_card_bij f_inj _; by rewrite card_ord size_complete card_darts.
Qed.

Lemma explored_is_drawn : is_drawn S.
Proof.
apply/and4P; split.
- by apply/forallP=> d; apply/eqP/f_inj; rewrite !f_opposite oppositeK.
- apply/forallP=> d; apply/eqP=> /(congr1 f); rewrite f_opposite => /eqP.
  by rewrite (negPf (opposite_neq _)).
- by apply/injectiveP=> d e /(congr1 f); rewrite !f_clockwise => /(@clockwise_inj W)/f_inj.
apply/forallP=> d; apply/forallP=> e.
have /connectP[s path_s fe] := connected (f d) (f e).
elim: s d path_s fe => [|r s IH] d /=; first by move=> _ /f_inj->; apply: connect0.
case/andP=> step path_s fe; have [d' rd'] : exists d', r = f d'.
  by case/orP: step => /eqP->; [exists (drawn_opposite d); rewrite f_opposite |
                                 exists (drawn_clockwise d); rewrite f_clockwise].
move: step; rewrite rd' -f_opposite -f_clockwise !(inj_eq f_inj) => step.
have : connect (fun x y => (y == drawn_opposite x) || (y == drawn_clockwise x)) d' e.
  by apply: IH; rewrite -rd'.
by apply: connect_trans; apply: connect1.
Qed.

(** The map is isomorphic to the world as a start, and the robot is where it believes it is. *)
Lemma drawn_isomorphic pose : pose < size S ->
  exists2 L : located, drawn S pose = Some L
  & exists f : L -> W, [/\ isomorphism f, f (facing L) = facing W & f (robot L) = place pose].
Proof.
move=> lt; rewrite /drawn; case: {-}_ / idP => [ok|]; last by rewrite explored_is_drawn.
case: {-}_ / idP => [begun|]; last by rewrite (wf_some wf).
eexists; first by [].
exists f; split; rewrite /= /f ?insubdK //; last exact: em_facing em.
split; [exact: f_bij | exact: f_opposite | exact: f_clockwise].
Qed.

End Embedded.
