(** The folded trail of the walk of [CertificateWalk.v] is complete, and the walk is as long as the formula of the
    certificate. Beyond Section 2.3. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Certificate Walks Arithmetic Parts Complete Trail Hanging
  CertificateNeeded CertificateWalk.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Visits that are joined to the marker along the tree *)

Section Linked.

Variables (W : start) (doors : seq door).
Implicit Types (x y : trail_dart) (d e : W).

Notation n := (size doors).
Notation seen := (sees W doors).
Notation marked d := (same_vertex (facing W) d).
Let pos k : W := walk (facing W) (take k doors).
Let out k : W := turn (pos k) (nth 0 doors k).
Let same := folded doors seen.

Let pos_next k : k < n -> pos k.+1 = opposite (out k).
Proof. exact: pose_step. Qed.

Lemma around k i j : k <= n -> i = j %[mod degree (pos k)] -> same (k, i) (k, j).
Proof.
move=> le; have periods t j' : same (k, j' + t * degree (pos k)) (k, j').
  elim: t => [|t IH]; first by rewrite mul0n addn0; apply: Same.
  apply: Linked IH; rewrite mulSn addnCA addnC -(degree_seenE _ le); exact: Around.
rewrite (divn_eq i (degree (pos k))) (divn_eq j (degree (pos k))) !modnMDl !modn_mod => ->.
rewrite ![_ * _ + _]addnC; apply: Linked (periods _ _) _; apply/Swapped/periods.
Qed.

Lemma turned t x y : same x y -> same (x.1, x.2 + t) (y.1, y.2 + t).
Proof.
move=> xy; elim: t => [|t IH]; first by rewrite !addn0 -!surjective_pairing.
by rewrite !addnS; apply: (Turned IH).
Qed.

(** One dart of two visits is the same: then all are. *)
Lemma same_visits k l i j i' j' : k <= n -> l <= n -> same (k, i) (l, j) ->
  turn (pos k) i' = turn (pos l) j' -> same (k, i') (l, j').
Proof.
move=> k_le l_le kl same_dart; have := folding_sound kl; rewrite /dart_of /= -/(pos k) -/(pos l) => same_ij.
pose t := i' + i * (degree (pos k)).-1.
have it : i + t = i' %[mod degree (pos k)].
  have -> : i + t = i * degree (pos k) + i'.
    by rewrite /t addnCA -mulnS prednK ?degree_gt0 // addnC.
  by rewrite modnMDl.
have kt := turned t kl; rewrite /= in kt.
apply: Linked (around k_le (esym it)) (Linked kt (around l_le _)).
by apply: turn_eq; rewrite turnD -same_ij -turnD -same_dart -(turn_mod _ (i + t)) it turn_mod.
Qed.

(** The edge of one dart of the trail is that of another, as far as the folded trail shows. *)
Definition across x y := exists a b, [/\ same x a, one_edge doors a b & same b y].

Lemma across_sym x y : across x y -> across y x.
Proof.
move=> [a [b [xa ab byy]]]; exists b, a; split; [exact: Swapped | | exact: Swapped].
by case: ab => k lt; [apply: Backward | apply: Onward].
Qed.

Lemma across_same x y x' y' : across x y -> across x' y' -> same x x' -> same y y'.
Proof.
move=> [a [b [xa ab byy]]] [a' [b' [xa' ab' byy']]] xx'.
apply: Linked (Swapped byy) (Linked _ byy'); apply: Beyond ab ab' _.
exact: Linked (Swapped xa) (Linked xx' xa').
Qed.

Lemma across_from x x' y : same x' x -> across x y -> across x' y.
Proof. by move=> xx' [a [b [xa ab byy]]]; exists a, b; split=> //; apply: Linked xa. Qed.

Inductive linked : nat -> nat -> Prop :=
  | AtMarker k : k <= n -> marked (pos k) -> linked 0 k
  | Forth m k : k < n -> in_tree (out k) -> linked m k.+1 -> linked m.+1 k
  | Back m k : k < n -> in_tree (out k) -> linked m k -> linked m.+1 k.+1.

Lemma linked_le m k : linked m k -> k <= n.
Proof. by case=> // m' k' /ltnW. Qed.

Lemma across_edge x y : one_edge doors x y -> across x y.
Proof. by move=> edge; exists x, y; split=> //; apply: Same. Qed.

Lemma linked_edge m k : linked m k -> marked (pos k) \/
  exists m' k' i i', [/\ m = m'.+1, linked m' k', in_tree (turn (pos k) i),
    turn (pos k') i' = opposite (turn (pos k) i) & one_edge doors (k, i) (k', i')].
Proof.
case=> [k0|m' k0 lt tree_e link|m' k0 lt tree_e link]; first by left.
- right; exists m', k0.+1, (nth 0 doors k0), 0; split=> //; [exact: pos_next | exact: Onward].
right; exists m', k0, 0, (nth 0 doors k0); split=> //; last exact: Backward.
  by rewrite -[turn _ 0]/(pos k0.+1) pos_next // in_tree_opposite.
by rewrite -[turn _ 0]/(pos k0.+1) pos_next // oppositeK.
Qed.

(** From a visit that is joined, the trail leads up the tree, to a visit that is joined. *)
Lemma linked_up m k : linked m k -> ~~ marked (pos k) ->
  exists m' l, [/\ m' < m, linked m' l
    & exists i j, [/\ turn (pos k) i = up (pos k), turn (pos l) j = opposite (up (pos k)) & across (k, i) (l, j)]].
Proof.
have [b] := ubnP m; elim: b m k => // b IH m k; rewrite ltnS => m_le link_k away.
have [at_k|] := linked_edge link_k; first by rewrite at_k in away.
case=> m' [k' [i [i' [mE link_k' tree_e turn_i' edge]]]].
have m'_lt : m' < b by rewrite mE in m_le.
have k_e : same_vertex (pos k) (turn (pos k) i) := same_vertex_turn _ i.
have [up_e|down_e] := orP tree_e.
  have upE : up (pos k) = turn (pos k) i by rewrite (up_same k_e away); have /andP[_ /eqP] := up_e.
  exists m', k'; split=> //; first by rewrite mE.
  by exists i, i'; rewrite upE; split=> //; apply: across_edge.
have k'_e : same_vertex (pos k') (opposite (turn (pos k) i)) by rewrite -turn_i' same_vertex_turn.
have away' : ~~ marked (pos k') by have /andP[] := down_e; rewrite (marked_same k'_e).
have upE' : up (pos k') = opposite (turn (pos k) i) by rewrite (up_same k'_e away'); have /andP[_ /eqP] := down_e.
have [m2 [l [m2_lt link_l [j [j' [turn_j turn_j' cross]]]]]] := IH m' k' m'_lt link_k' away'.
rewrite upE' ?oppositeK in turn_j turn_j'.
have same_kl : same (k, i) (l, j').
  have back : one_edge doors (k', i') (k, i) by case: edge => t lt; [apply: Backward | apply: Onward].
  apply: across_same (across_edge back) cross _; apply: (around (linked_le link_k')).
  by apply: turn_eq; rewrite -/(pos k') turn_i' turn_j.
have l_e : same_vertex (pos l) (turn (pos k) i) by rewrite -turn_j' same_vertex_turn.
have l_k : same_vertex (pos l) (pos k) by apply: same_vertex_trans l_e _; rewrite same_vertex_sym.
have away_l : ~~ marked (pos l) by rewrite (marked_same l_k).
have [m3 [l3 [m3_lt link_l3 [j3 [j3' [turn_j3 turn_j3' cross3]]]]]] := IH m2 l (ltn_trans m2_lt m'_lt) link_l away_l.
rewrite (up_same l_k away_l) in turn_j3 turn_j3'.
exists m3, l3; split=> //; first by rewrite mE ltnS ltnW // (ltn_trans m3_lt).
have [near _] := upP away; exists (findex clockwise (pos k) (up (pos k))), j3'.
have turn_up : turn (pos k) (findex clockwise (pos k) (up (pos k))) = up (pos k) by apply: iter_findex.
split=> //; apply: across_from cross3.
by apply: (same_visits (linked_le link_k) (linked_le link_l) same_kl); rewrite turn_up.
Qed.

(** So visits of one place that are joined are one. *)
Lemma linked_same depth k l m m' i j : distance (pos k) = depth -> linked m k -> linked m' l ->
  turn (pos k) i = turn (pos l) j -> same (k, i) (l, j).
Proof.
have l_k_of : forall k l i j, turn (pos k) i = turn (pos l) j -> same_vertex (pos l) (pos k).
  move=> k0 l0 i0 j0 turns; apply: same_vertex_trans (same_vertex_turn _ j0) _.
  by rewrite -turns same_vertex_sym same_vertex_turn.
elim: depth k l m m' i j => [|depth IH] k l m m' i j dE link_k link_l turns;
  have k_le := linked_le link_k; have l_le := linked_le link_l; have l_k := l_k_of _ _ _ _ turns.
  have sees_marker t : t <= n -> marked (pos t) ->
      sighting_seen seen t = Pointing (findex clockwise (pos t) (facing W)).
    by move=> le at_t; rewrite /sighting_seen nth_percepts //= /directional -/(pos t) same_vertex_sym at_t.
  have at_k := distance0 dE; have at_l : marked (pos l) by rewrite (marked_same l_k).
  apply: (same_visits k_le l_le _ turns); first exact: Marked (sees_marker k k_le at_k) (sees_marker l l_le at_l).
have away : ~~ marked (pos k) by apply/negP=> /distance_same; rewrite distance_facing dE.
have away_l : ~~ marked (pos l) by rewrite (marked_same l_k).
have [m1 [k1 [_ link_k1 [i1 [j1 [turn_i1 turn_j1 cross_k]]]]]] := linked_up link_k away.
have [m2 [l1 [_ link_l1 [i2 [j2 [turn_i2 turn_j2 cross_l]]]]]] := linked_up link_l away_l.
rewrite (up_same l_k away_l) in turn_i2 turn_j2.
have [near d_up] := upP away; have d1 : distance (pos k1) = depth.
  apply: succn_inj; rewrite -dE (distance_same near) d_up; congr _.+1; apply: distance_same.
  by rewrite -turn_j1 same_vertex_turn.
have same_up : same (k1, j1) (l1, j2) by apply: IH d1 link_k1 link_l1 _; rewrite turn_j1.
have same_kl := across_same (across_sym cross_k) (across_sym cross_l) same_up.
exact: same_visits k_le l_le same_kl turns.
Qed.

Lemma linked_complete :
  (forall k, k <= n -> exists m, linked m k) -> (forall d, exists2 t, t < n & edge_of d (out t)) ->
  complete doors seen.
Proof.
move=> all_linked all_crossed k i; rewrite size_sees ltnS => k_le _.
have [m link_k] := all_linked k k_le; have [t lt] := all_crossed (turn (pos k) i).
have [m1 link_t] := all_linked t (ltnW lt); have [m2 link_t'] := all_linked t.+1 lt.
case/orP=> /eqP outE.
  exists (t, nth 0 doors t), (t.+1, 0); split; last exact: Onward.
  by apply: linked_same link_k link_t _; rewrite // -outE.
exists (t.+1, 0), (t, nth 0 doors t); split; last exact: Backward.
apply: linked_same link_k link_t' _ => //.
by rewrite -[turn (pos t.+1) 0]/(pos t.+1) pos_next // outE oppositeK.
Qed.

End Linked.

(** * Walks as sequences of darts *)

Section Darts.

Variables (W : start) (s : seq W).
Hypotheses (s_valid : valid (facing W) s) (s_anchored : anchored false (facing W) s).

Let doors := doors_of (facing W) s.

Lemma anchored_linked k : k <= size doors -> exists m, linked W doors m k.
Proof.
have sizeE : size doors = size s := size_doors_of _ _.
have pos_end t : walk (facing W) (take t doors) = end_of (facing W) (take t s) by apply: walk_doors_of.
suff: forall s2 t (b : bool), drop t s = s2 -> t <= size s -> (b -> exists m, linked W doors m t) ->
    anchored b (end_of (facing W) (take t s)) s2 -> forall j, t <= j <= size s -> exists m, linked W doors m j.
  rewrite sizeE => all k_le; apply: (all s 0 false); rewrite ?drop0 //; by rewrite take0.
elim=> [|e s2 IH] t b dropE t_le begun /=.
  have {dropE} tE : size s <= t by rewrite -subn_eq0 -size_drop dropE.
  move=> anch j /andP[tj j_le]; have -> : j = t by apply/eqP; rewrite eqn_leq tj (leq_trans j_le tE).
  by case/orP: anch => [/begun //|at_t]; exists 0; apply: AtMarker; rewrite ?sizeE ?pos_end.
have lt : t < size s by rewrite -subn_gt0 -size_drop dropE.
have [eE s2E] : nth (facing W) s t = e /\ drop t.+1 s = s2.
  by move: dropE; rewrite (drop_nth (facing W) lt) => -[].
have outE : turn (walk (facing W) (take t doors)) (nth 0 doors t) = e by rewrite out_doors_of.
have here : b || same_vertex (facing W) (end_of (facing W) (take t s)) -> exists m, linked W doors m t.
  by case/orP=> [/begun //|at_t]; exists 0; apply: AtMarker; rewrite ?sizeE ?pos_end.
have next : end_of (facing W) (take t.+1 s) = opposite e.
  by rewrite (take_nth (facing W) lt) eE /end_of map_rcons last_rcons.
case: ifP => [tree_e anch|_ /andP[/here link_t anch]] j /andP[]; last first.
  rewrite leq_eqVlt => /predU1P[<- //|tj j_le]; apply: (IH t.+1 false) => //; last by rewrite tj.
  by rewrite next.
have later i : t.+1 <= i <= size s -> exists m, linked W doors m i.
  apply: (IH t.+1 _ s2E lt _ _) => [/here[m link_t]|]; last by rewrite next; apply: anch.
  by exists m.+1; apply: Back; rewrite ?sizeE ?outE.
rewrite leq_eqVlt => /predU1P[<- _|tj j_le]; last by apply: later; rewrite tj.
have [|m link_t'] := later t.+1; first by rewrite leqnn.
by exists m.+1; apply: Forth; rewrite ?sizeE ?outE.
Qed.

Lemma anchored_complete : (forall d, covers s d) -> complete doors (sees W doors).
Proof.
move=> all_covered; apply: linked_complete => [|d]; first exact: anchored_linked.
have at_index e : e \in s -> exists2 t, t < size doors & turn (walk (facing W) (take t doors)) (nth 0 doors t) = e.
  move=> e_s; have lt : index e s < size s by rewrite index_mem.
  by exists (index e s); rewrite ?size_doors_of // out_doors_of // nth_index.
case/orP: (all_covered d) => /at_index[t lt outE]; exists t => //; rewrite outE /edge_of eqxx ?orbT //.
Qed.

End Darts.

(** * The walk *)

Section Tour.

Variable W : start.
Implicit Types (e h v : W).

Definition outside : seq W := enum [pred e : W | (froot opposite e == e) && ~~ in_tree e].
Definition round e := way e ++ e :: back (opposite e).
Definition tour v := flatten [seq round e | e <- outside] ++ way v.

Lemma size_round e : size (round e) = distance e + distance (opposite e) + 1.
Proof. by rewrite size_cat /= size_way_by size_back_by addn1 addnS. Qed.

Lemma size_tour v :
  size (tour v) = \sum_(e : W | (froot opposite e == e) && ~~ in_tree e) (distance e + distance (opposite e) + 1)
    + distance v.
Proof.
rewrite size_cat size_way_by -big_enum /=; congr (_ + _); rewrite -/outside.
by elim: outside => [|e es IH]; rewrite ?big_nil // big_cons /= size_cat IH size_round.
Qed.

Lemma rounds_ok es t : all (fun e => ~~ in_tree e) es -> valid (facing W) t -> anchored false (facing W) t ->
  valid (facing W) (flatten [seq round e | e <- es] ++ t) /\
  anchored false (facing W) (flatten [seq round e | e <- es] ++ t).
Proof.
elim: es => //= e es IH /andP[out_e all_es] t_ok t_anch; have [ok anch] := IH all_es t_ok t_anch.
have [way_ok way_end way_tree] := wayP (erefl (distance e)).
have [back_ok back_end back_up] := backP (erefl (distance (opposite e))).
rewrite -catA; set rest := flatten _ ++ t in ok anch *.
have -> : round e ++ rest = way e ++ e :: back (opposite e) ++ rest by rewrite /round -catA.
split.
  by rewrite valid_cat way_ok /= way_end valid_cat back_ok -(valid_same _ back_end).
rewrite anchored_marked ?same_vertex_refl //; apply: anchored_tree way_tree _.
rewrite /= (negPf out_e) /=; apply: anchored_tree; last by rewrite -(anchored_same _ _ back_end).
by apply: sub_all back_up => h up_h; rewrite /in_tree up_h.
Qed.

Lemma tour_ok v : valid (facing W) (tour v) /\ anchored false (facing W) (tour v).
Proof.
have [way_ok _ way_tree] := wayP (erefl (distance v)); apply: rounds_ok => //.
  by apply/allP=> e; rewrite mem_enum => /andP[].
rewrite anchored_marked ?same_vertex_refl // -[way v]cats0.
exact: anchored_tree way_tree _.
Qed.

(** ** What it goes over *)

Lemma outside_covered v e : ~~ in_tree e -> covers (tour v) e.
Proof.
have in_tour f : froot opposite f == f -> ~~ in_tree f -> f \in tour v.
  move=> root_f out_f; rewrite mem_cat; apply/orP; left; apply/flattenP; exists (round f).
    by apply: map_f; rewrite mem_enum inE root_f.
  by rewrite mem_cat mem_head orbT.
move=> out_e; rewrite /covers; have [rootE|rootE] := edge_root e; first by rewrite in_tour ?rootE ?eqxx.
by rewrite orbC in_tour ?in_tree_opposite // edge_root_opposite rootE.
Qed.

Definition in_rounds h := [exists e, ~~ in_tree e && (h \in back e)].

Lemma in_rounds_covered v h : in_rounds h -> covers (tour v) h.
Proof.
have in_tour f g : froot opposite f == f -> ~~ in_tree f -> g \in round f -> g \in tour v.
  move=> root_f out_f g_in; rewrite mem_cat; apply/orP; left; apply/flattenP; exists (round f) => //.
  by apply: map_f; rewrite mem_enum inE root_f.
case/existsP=> e /andP[out_e h_in]; rewrite /covers; have [rootE|rootE] := edge_root e.
  rewrite orbC (in_tour e) ?rootE // mem_cat [way e]way_back_by mem_rev.
  by rewrite (map_f _ (h_in : h \in back_by (distance e) e)).
rewrite (in_tour (opposite e)) ?in_tree_opposite // ?edge_root_opposite ?rootE //.
by rewrite mem_cat inE oppositeK h_in !orbT.
Qed.

(** An edge of the tree that no round goes over hangs. *)
Lemma not_in_rounds h : leads_up h -> ~~ in_rounds h -> h \in hanging W.
Proof.
have far (x : W) : distance x <= #|W| by rewrite -[X in _ <= X](size_iota 0 #|W|) find_size.
have [k] : exists k, #|W| < distance h + k by exists #|W|.+1; rewrite addnS ltnS leq_addl.
elim: k h => [|k IH] h bound up_h none; first by move: bound; rewrite addn0 ltnNge far.
have /andP[away /eqP upE] := up_h; apply/hangingP; split=> // e he eh.
have away_e : ~~ same_vertex (facing W) e by rewrite -(marked_same he).
have up_eE : up e = h by rewrite -(up_same he away).
have tree_e : in_tree e.
  apply: contraR none => out_e; apply/existsP; exists e; rewrite out_e /back -(distance_same he).
  by rewrite (leads_up_distance up_h) /= up_eE mem_head.
have down_e : leads_up (opposite e).
  case/orP: tree_e => // /andP[_]; rewrite up_eE eq_sym (negPf eh) //.
apply: IH => //.
  rewrite (leads_up_distance down_e) oppositeK -(distance_same he).
  by move: bound; rewrite addnS addSn.
apply: contra none => /existsP[f /andP[out_f in_f]]; apply/existsP; exists f; rewrite out_f /=.
by have := back_closed erefl in_f; rewrite oppositeK up_eE => ->.
Qed.

Lemma crossing_covered (p : W) s h : valid p s ->
  near_without (edge_of h) p -> ~~ near_without (edge_of h) (end_of p s) -> covers s h.
Proof.
elim: s p => [|e s IH] p /=; first by move=> _ ->.
case/andP=> pe ok near away; have [/orP[]/eqP eE|other] := boolP (edge_of h e).
- by rewrite /covers eE mem_head.
- by rewrite /covers eE mem_head orbT.
have near_e : near_without (edge_of h) (opposite e).
  by apply: near_opposite other _; rewrite -(near_same _ pe).
by have := IH _ ok near_e away; rewrite /covers !inE => /orP[]->; rewrite !orbT.
Qed.

Lemma uncovered_few v : #|uncovered (tour v)| + hanging_above v <= #|hanging W|.
Proof.
pose above := [set h in hanging W | ~~ near_without (edge_of h) v].
have above_sub : above \subset hanging W by apply/subsetP=> h; rewrite inE => /andP[].
have : uncovered (tour v) \subset hanging W :\: above.
  apply/subsetP=> h; rewrite !inE => /andP[up_h none].
  have h_hangs : h \in hanging W.
    by apply: not_in_rounds => //; apply: contra none; apply: in_rounds_covered.
  rewrite h_hangs andbT /= negbK; apply: contraR none => away.
  have [way_ok way_end _] := wayP (erefl (distance v)).
  have : covers (way v) h.
    by apply: crossing_covered way_ok (near_facing _) _; rewrite (near_same _ way_end).
  by rewrite /covers !mem_cat => /orP[]->; rewrite !orbT.
move/subset_leq_card; rewrite cardsD (setIidPr above_sub) => le.
have above_le := subset_leq_card above_sub; rewrite -[hanging_above v]/(#|above|); arithmetic.
Qed.

(** ** Its length *)

Lemma sum_tree :
  \sum_(e : W | (froot opposite e == e) && in_tree e) (distance e + distance (opposite e) + 1) =
  2 * \sum_(d : W | froot clockwise d == d) distance d.
Proof.
have sym := fconnect_sym (@clockwise_inj W); pose ups : {set W} := [set h | leads_up h].
have -> : \sum_(e : W | (froot opposite e == e) && in_tree e) (distance e + distance (opposite e) + 1) =
    \sum_(h in ups) 2 * distance h.
  rewrite [RHS]big_mkcond sum_edges big_mkcondr; apply: eq_bigr => e _; rewrite !inE /in_tree.
  case up_e: (leads_up e).
    by rewrite (negPf (leads_up_once up_e)) addn0 /= (leads_up_distance up_e); arithmetic.
  case up_e': (leads_up (opposite e)) => //.
  by rewrite (leads_up_distance up_e') oppositeK /=; arithmetic.
pose f (h : W) := froot clockwise h.
have same_f h : same_vertex (f h) h by rewrite same_vertex_sym; apply: connect_root.
have f_inj : {in ups &, injective f}.
  move=> h h'; rewrite !inE => up_h up_h' same; apply: (leads_up_same up_h up_h').
  by rewrite /same_vertex -(root_connect sym); apply/eqP.
under eq_bigr => h _ do rewrite -(distance_same (same_f h)).
rewrite -(big_imset (fun d => 2 * distance d) f_inj) /= big_distrr /=.
rewrite [RHS](bigID (mem (f @: ups))) /= [X in _ = _ + X]big1 ?addn0.
  apply: eq_bigl => d; apply/idP/andP=> [in_f|[] //]; split=> //.
  by case/imsetP: in_f => h _ ->; rewrite /f (root_root sym).
move=> d /andP[/eqP root_d none]; have [at_d|away] := boolP (same_vertex (facing W) d).
  by rewrite -(distance_same at_d) distance_facing.
case/negP: none; apply/imsetP; exists (up d); first by rewrite inE leads_up_up.
have [near _] := upP away; have /eqP same : froot clockwise d == froot clockwise (up d) by rewrite (root_connect sym).
by rewrite /f -same root_d.
Qed.

Lemma size_outside :
  \sum_(e : W | (froot opposite e == e) && ~~ in_tree e) (distance e + distance (opposite e) + 1)
    + 2 * (\sum_(d : W | froot clockwise d == d) distance d) = edges W + \sum_(d : W) distance d.
Proof.
rewrite -sum_tree sum_edges -sum_edges1 -big_split /= addnC [RHS](bigID (@in_tree W)) /=.
by congr (_ + _); apply: eq_bigr => e _; rewrite addnC.
Qed.

Lemma certificate_shortest doors : complete doors (sees W doors) -> certificate_moves W <= size doors.
Proof. by move=> whole; apply: certificate_needed => V same; apply: complete_folding_determines same whole. Qed.

Lemma certificate_attained :
  exists2 doors, complete doors (sees W doors) & size doors = certificate_moves W.
Proof.
pose save v := 2 * hanging_above v - distance v.
have [v [saveE most]] : exists v, distance v + save v = 2 * hanging_above v /\ forall v', save v' <= save v.
  case: (@arg_maxnP W (facing W) predT save isT) => v _ most.
  have [none|some] := posnP (save v); last first.
    by exists v; split=> [|v']; [rewrite /save in some *; arithmetic | apply: most].
  exists (facing W); rewrite /save distance_facing above_facing; split=> // v'.
  by have := most v' isT; rewrite none.
have [ok anch] := tour_ok v; have [s [s_ok s_anch s_size sub ups]] := excursions ok anch.
pose doors := doors_of (facing W) s; have whole : complete doors (sees W doors).
  apply: anchored_complete s_ok s_anch _ => d; have [/orP[up_d|up_d]|out_d] := boolP (in_tree d).
  - exact: ups.
  - by rewrite -covers_opposite ups.
  by have /orP[/sub d_in|/sub d_in] := outside_covered v out_d; rewrite /covers d_in ?orbT.
exists doors => //; apply/eqP; rewrite eqn_leq certificate_shortest // andbT.
rewrite size_doors_of s_size size_tour /certificate_moves -size_outside addnK.
set saved := \max_(_ in _ | _) _; have saved_le : saved <= save v by apply/bigmax_leqP=> h _; apply: most.
have few := uncovered_few v; set b := \sum_(_ | _) _.
rewrite -/(save v) in saveE saved_le *; clearbody saved b; arithmetic.
Qed.

End Tour.
