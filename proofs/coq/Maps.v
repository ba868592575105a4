(** Invariants of every map that Algorithm 1 builds, in any world. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Arithmetic Program Algorithm1.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The darts of a vertex are consecutive, from the first; [other] is an involution where it is known; and
    every vertex can be reached from the start vertex. *)
Record well_formed (S : partial_map) : Prop := WellFormed {
  wf_some : 0 < size S;
  wf_first : vertex S 0 = 0;
  wf_bounds : forall d, d < size S ->
    vertex S d <= d < vertex S d + doors S d /\ vertex S d + doors S d <= size S;
  wf_same : forall d e, d < size S -> vertex S d <= e < vertex S d + doors S d ->
    vertex S e = vertex S d /\ doors S e = doors S d;
  wf_other : forall d d', other S d = Some d' -> [/\ d' < size S, d' != d & other S d' = Some d];
  wf_connected : forall P : nat -> bool, P 0 ->
    (forall d d', other S d = Some d' -> P (vertex S d) -> P (vertex S d')) ->
    forall d, d < size S -> P (vertex S d)
}.

Lemma mem_unexplored S d : (d \in unexplored S) = (d < size S) && (other S d == None).
Proof. by rewrite mem_filter mem_iota add0n andbC. Qed.

Lemma other_known S d d' : other S d = Some d' -> d < size S.
Proof. by rewrite ltnNge; apply: contra_eqN => big; rewrite /other nth_default. Qed.

Section WellFormed.

Variable S : partial_map.
Hypothesis wf : well_formed S.

Lemma vertex_lt d : d < size S -> vertex S d < size S.
Proof. by move=> lt; have [/andP[le _] _] := wf_bounds wf lt; apply: leq_ltn_trans le lt. Qed.

Lemma vertex_vertex d : d < size S -> vertex S (vertex S d) = vertex S d.
Proof.
move=> lt; have [/andP[le lt'] _] := wf_bounds wf lt.
by have [|-> //] := wf_same wf (e := vertex S d) lt; rewrite leqnn (leq_ltn_trans le).
Qed.

End WellFormed.

(** * One more edge *)

Section SetOther.

Variable S : partial_map.

Lemma vertex_set_other d d' x : vertex (set_other S d d') x = vertex S x.
Proof. by rewrite /vertex nth_set_nth /=; case: eqP => [->|]. Qed.

Lemma doors_set_other d d' x : doors (set_other S d d') x = doors S x.
Proof. by rewrite /doors nth_set_nth /=; case: eqP => [->|]. Qed.

Lemma other_set_other d d' x : other (set_other S d d') x = if x == d then Some d' else other S x.
Proof. by rewrite /other nth_set_nth /=; case: eqP. Qed.

End SetOther.

Section WithEdge.

Variables (S : partial_map) (e h : nat).
Hypotheses (e_known : e < size S) (h_known : h < size S).

Lemma size_with_edge : size (with_edge S e h) = size S.
Proof.
rewrite /with_edge /set_other !size_set_nth.
by rewrite (maxn_idPr e_known) (maxn_idPr h_known).
Qed.

Lemma vertex_with_edge d : vertex (with_edge S e h) d = vertex S d.
Proof. by rewrite /with_edge !vertex_set_other. Qed.

Lemma doors_with_edge d : doors (with_edge S e h) d = doors S d.
Proof. by rewrite /with_edge !doors_set_other. Qed.

Lemma other_with_edge d :
  other (with_edge S e h) d = if d == h then Some e else if d == e then Some h else other S d.
Proof. by rewrite /with_edge !other_set_other. Qed.

End WithEdge.

Lemma well_formed_with_edge S e h :
  well_formed S -> e \in unexplored S -> h \in unexplored S -> h != e ->
  well_formed (with_edge S e h).
Proof.
rewrite !mem_unexplored => wf /andP[e_lt /eqP e_free] /andP[h_lt /eqP h_free] he.
have sz := size_with_edge e_lt h_lt.
split; rewrite ?sz.
- exact: wf_some wf.
- by rewrite vertex_with_edge; apply: wf_first.
- by move=> d d_lt; rewrite !vertex_with_edge !doors_with_edge; apply: wf_bounds.
- by move=> d d' d_lt; rewrite !vertex_with_edge !doors_with_edge; apply: wf_same.
- move=> d d'; rewrite other_with_edge; case: eqP => [->|/eqP dh].
    case=> <-; split=> //; first by rewrite eq_sym.
    by rewrite other_with_edge eq_sym (negPf he) eqxx.
  case: eqP => [->|/eqP de]; first by case=> <-; split=> //; rewrite other_with_edge eqxx.
  move=> dd'; have [lt ne back] := wf_other wf dd'; split=> //.
  rewrite other_with_edge.
  case: eqP => [d'h|_]; first by rewrite -d'h back in h_free.
  by case: eqP => [d'e|_]; first by rewrite -d'e back in e_free.
- move=> P P0 closed d d_lt; rewrite vertex_with_edge.
  apply: (wf_connected wf) P0 _ d d_lt => d d' dd' Pd.
  have := closed d d'; rewrite other_with_edge !vertex_with_edge; apply=> //.
  case: eqP => [dh|_]; first by rewrite -dh dd' in h_free.
  by case: eqP => [de|//]; rewrite -de dd' in e_free.
Qed.

Lemma size_unexplored_with_edge S e h :
  e \in unexplored S -> h \in unexplored S -> h != e ->
  size (unexplored S) = (size (unexplored (with_edge S e h))).+2.
Proof.
move=> eU hU he; set U' := unexplored (with_edge _ _ _).
suff /perm_size -> : perm_eq (unexplored S) [:: e, h & U'] by [].
have := eU; rewrite mem_unexplored => /andP[e_lt _].
have := hU; rewrite mem_unexplored => /andP[h_lt _].
have inU' d : (d \in U') = [&& d != h, d != e & d \in unexplored S].
  rewrite !mem_unexplored size_with_edge // other_with_edge.
  by case: (d == h); case: (d == e); rewrite ?andbF.
apply: uniq_perm; first by rewrite filter_uniq ?iota_uniq.
  by rewrite /= !inE !inU' !eqxx ?andbF orbF eq_sym he filter_uniq ?iota_uniq.
move=> d; rewrite !inE inU'; case: eqP => [->|_] /=; first by rewrite eU.
by case: eqP => [->|_] /=; rewrite ?hU.
Qed.

(** * One more vertex *)

Section WithVertex.

Variables (S : partial_map) (g : nat).

Lemma size_with_vertex : size (with_vertex S g) = size S + g.
Proof. by rewrite size_cat size_nseq. Qed.

Lemma old_with_vertex d : d < size S ->
  [/\ vertex (with_vertex S g) d = vertex S d, doors (with_vertex S g) d = doors S d
    & other (with_vertex S g) d = other S d].
Proof. by move=> lt; rewrite /vertex /doors /other nth_cat lt. Qed.

Lemma new_with_vertex d : size S <= d < size S + g ->
  [/\ vertex (with_vertex S g) d = size S, doors (with_vertex S g) d = g
    & other (with_vertex S g) d = None].
Proof.
case/andP=> ge lt; rewrite /vertex /doors /other nth_cat ltnNge ge /= nth_nseq.
by rewrite ltn_subLR // lt.
Qed.

Lemma unexplored_with_vertex :
  unexplored (with_vertex S g) = unexplored S ++ iota (size S) g.
Proof.
rewrite /unexplored size_with_vertex iotaD filter_cat add0n; congr (_ ++ _).
  by apply: eq_in_filter => d; rewrite mem_iota => /old_with_vertex[_ _ ->].
by apply/all_filterP/allP => d; rewrite mem_iota => /new_with_vertex[_ _ ->].
Qed.

End WithVertex.

Lemma size_with_place S e g : e < size S -> 0 < g ->
  size (with_edge (with_vertex S g) e (size S)) = size S + g.
Proof.
move=> e_lt g_gt0; rewrite size_with_edge size_with_vertex //; first exact: ltn_addr.
by rewrite -[X in X < _]addn0 ltn_add2l.
Qed.

(** A new vertex makes one more edge explored. *)
Lemma unexplored_with_place S e g : e \in unexplored S -> 0 < g ->
  let S' := with_edge (with_vertex S g) e (size S) in
  (size S + size (unexplored S')).+2 = size S' + size (unexplored S).
Proof.
move=> eU g_gt0; have := eU; rewrite mem_unexplored => /andP[e_lt _].
have eU' : e \in unexplored (with_vertex S g) by rewrite unexplored_with_vertex mem_cat eU.
have sU' : size S \in unexplored (with_vertex S g).
  by rewrite unexplored_with_vertex mem_cat mem_iota leqnn -[X in X < _]addn0 ltn_add2l g_gt0 orbT.
have se : size S != e by rewrite gtn_eqF.
have := size_unexplored_with_edge eU' sU' se; rewrite unexplored_with_vertex size_cat size_iota /=.
by rewrite size_with_place // => sizes; arithmetic.
Qed.

Lemma well_formed_start g : 0 < g -> well_formed (with_vertex [::] g).
Proof.
move=> g_gt0; have sz := size_with_vertex [::] g; rewrite /= add0n in sz.
have new d (lt : d < g) := @new_with_vertex [::] g d lt.
split; rewrite ?sz //.
- by have [] := new 0 g_gt0.
- by move=> d lt; have [-> -> _] := new d lt; rewrite add0n.
- move=> d d' lt; have [-> -> _] := new d lt; rewrite add0n => lt'.
  by have [-> -> _] := new d' lt'.
- move=> d d' dd'; have := other_known dd'; rewrite sz => lt.
  by have [_ _] := new d lt; rewrite dd'.
- by move=> P P0 _ d lt; have [-> _ _] := new d lt.
Qed.

Lemma well_formed_with_vertex S e g :
  well_formed S -> e \in unexplored S -> 0 < g ->
  well_formed (with_edge (with_vertex S g) e (size S)).
Proof.
move=> wf; rewrite mem_unexplored => /andP[e_lt /eqP e_free] g_gt0.
set T := with_vertex S g.
have szT : size T = size S + g := size_with_vertex S g.
have e_ltT : e < size T by rewrite szT ltn_addr.
have s_ltT : size S < size T by rewrite szT -addn1 leq_add2l.
have es : e == size S = false by rewrite ltn_eqF.
have sz := size_with_edge e_ltT s_ltT.
have [vs _ _] : [/\ vertex T (size S) = size S, doors T (size S) = g & other T (size S) = None].
  by apply: new_with_vertex; rewrite leqnn -szT.
have parts d : d < size T -> d < size S \/ size S <= d < size S + g.
  by rewrite szT => lt; case: (ltnP d (size S)); [left | right].
split; rewrite ?sz.
- exact: leq_ltn_trans s_ltT.
- by rewrite vertex_with_edge; have [-> _ _] := old_with_vertex g (wf_some wf); apply: wf_first.
- move=> d /parts[]; rewrite !vertex_with_edge !doors_with_edge szT => lt.
    have [-> -> _] := old_with_vertex g lt; have [in_ out] := wf_bounds wf lt.
    by split=> //; apply: leq_trans out (leq_addr _ _).
  by have [-> -> _] := new_with_vertex lt.
- move=> d d' /parts[]; rewrite !vertex_with_edge !doors_with_edge => lt.
    have [-> -> _] := old_with_vertex g lt => near.
    have [_ out] := wf_bounds wf lt; case/andP: (near) => _ lt'.
    have [-> -> _] := old_with_vertex g (leq_trans lt' out); exact: wf_same near.
  have [-> -> _] := new_with_vertex lt => near.
  by have [-> -> _] := new_with_vertex near.
- move=> d d'; rewrite other_with_edge.
  case: eqP => [->|/eqP ds']; first by case=> <-; split; rewrite ?es // other_with_edge es eqxx.
  case: eqP => [->|/eqP de].
    by case=> <-; split; rewrite 1?eq_sym ?es // other_with_edge eqxx.
  move=> dd'; have /parts[lt|lt] := other_known dd'; last first.
    by have [_ _] := new_with_vertex lt; rewrite -/T dd'.
  move: dd'; have [_ _ ->] := old_with_vertex g lt => dd'.
  have [lt' ne back] := wf_other wf dd'; split=> //; first by rewrite szT ltn_addr.
  rewrite other_with_edge (ltn_eqF lt').
  case: eqP => [d'e|_]; first by rewrite -d'e back in e_free.
  by have [_ _ ->] := old_with_vertex g lt'.
- move=> P P0 closed.
  have old d : d < size S -> P (vertex S d).
    apply: (wf_connected wf) P0 _ d => d d' dd' Pd.
    have lt := other_known dd'; have [lt' _ _] := wf_other wf dd'.
    have := closed d d'; rewrite other_with_edge !vertex_with_edge.
    have [-> _ ->] := old_with_vertex g lt; have [-> _ _] := old_with_vertex g lt'.
    rewrite (ltn_eqF lt); case: eqP => [de|_]; first by rewrite -de dd' in e_free.
    exact.
  move=> d /parts[] lt; rewrite vertex_with_edge.
    by have [-> _ _] := old_with_vertex g lt; apply: old.
  have [-> _ _] := new_with_vertex lt.
  have := closed e (size S); rewrite other_with_edge es eqxx !vertex_with_edge -/T vs; apply=> //.
  by have [-> _ _] := old_with_vertex g e_lt; apply: old.
Qed.
