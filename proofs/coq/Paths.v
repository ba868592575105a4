(** The shortest paths that Algorithm 1 takes by default lead to their goals, and have fewer darts than
    there are known vertices. Section 2.3, lines 6 and 10. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Maps.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * The nearest dart *)

Lemma mem_nearest S tree l : l != [::] -> nearest S tree l \in l.
Proof.
have in_l darts best : best \in l -> {subset darts <= l} ->
    foldl (fun best d => if size (to_root S tree (vertex S d)) < size (to_root S tree (vertex S best))
                         then d else best) best darts \in l.
  elim: darts best => //= d darts IH best mem_best mem_l; apply: IH => [|e mem_e].
    by case: ifP => // _; apply/mem_l/mem_head.
  by apply: mem_l; rewrite inE mem_e orbT.
by case: l in_l => // d l in_l _; apply: in_l; first exact: mem_head.
Qed.

(** * Paths *)

Lemma leads_cat S u p v q w : leads S u p v -> leads S v q w -> leads S u (p ++ q) w.
Proof.
elim: p u => [|d p IH] u /= => [/eqP->//|/andP[->]].
by case: (other S d) => // d'; apply: IH.
Qed.

Lemma leads_rev S v p v' : well_formed S ->
  leads S v p v' -> leads S v' (rev [seq odflt 0 (other S d) | d <- p]) v.
Proof.
move=> wf_S; elim: p v => [|d p IH] v /= => [|/andP[/eqP <-]]; first by rewrite eq_sym.
case other_d: (other S d) => [d'|] // /IH leads_back; have [_ _ other_d'] := wf_other wf_S other_d.
by rewrite rev_cons -cats1; apply: leads_cat leads_back _; rewrite /= other_d' !eqxx.
Qed.

(** * The tree *)

Section Tree.

Variables (S : partial_map) (root : nat).
Hypotheses (wf_S : well_formed S) (root_lt : root < size S) (vertex_root : vertex S root = root).

Notation reached t := (map (vertex S) t).

Lemma mem_darts_of d : d < size S -> d \in iota (vertex S d) (doors S (vertex S d)).
Proof.
move=> d_lt; have [/andP[le_d lt_d] _] := wf_bounds wf_S d_lt.
have [|_ ->] := wf_same wf_S (e := vertex S d) d_lt; first by rewrite leqnn (leq_ltn_trans le_d).
by rewrite mem_iota le_d.
Qed.

(** The dart of every vertex of the tree except the root leads to an earlier vertex. *)
Record is_tree (t : seq nat) : Prop := IsTree {
  tree_root : index root (reached t) = 0;
  tree_some : 0 < size t;
  tree_uniq : uniq (reached t);
  tree_bounds : {in t, forall d, d < size S};
  tree_up : forall i, 0 < i < size t ->
    exists2 d', other S (nth 0 t i) = Some d' & index (vertex S d') (reached t) < i
}.

Lemma mem_root t : is_tree t -> root \in reached t.
Proof. by case=> t_root t_some _ _ _; rewrite -index_mem t_root size_map. Qed.

Lemma is_tree_root : is_tree [:: root].
Proof.
split=> //=; first by rewrite vertex_root eqxx.
  by move=> d; rewrite inE => /eqP->.
by case.
Qed.

Lemma is_tree_rcons t d d' : is_tree t -> other S d = Some d' ->
  vertex S d \in reached t -> vertex S d' \notin reached t -> is_tree (rcons t d').
Proof.
move=> t_tree; have root_in := mem_root t_tree.
case: t_tree => [t_root t_some t_uniq t_bounds t_up] other_d mem_d notin_d'.
have [d'_lt _ other_d'] := wf_other wf_S other_d.
split; rewrite ?map_rcons ?size_rcons ?rcons_uniq ?notin_d' //.
- by rewrite -cats1 index_cat root_in.
- by move=> e; rewrite mem_rcons inE => /predU1P[->|/t_bounds].
move=> i /andP[i_gt]; rewrite ltnS leq_eqVlt => /predU1P[->|i_lt].
  exists d; first by rewrite nth_rcons ltnn eqxx.
  by rewrite -cats1 index_cat mem_d -(size_map (vertex S)) index_mem.
have [|e other_e e_lt] := t_up i; first by rewrite i_gt.
exists e; first by rewrite nth_rcons i_lt.
by rewrite -cats1 index_cat -index_mem size_map (ltn_trans e_lt i_lt).
Qed.

Lemma size_tree t : is_tree t -> size t <= known_vertices S.
Proof.
move=> t_tree; rewrite -(size_map (vertex S)) /known_vertices -size_filter.
apply: uniq_leq_size => [|_ /mapP[d /(tree_bounds t_tree) d_lt ->]]; first exact: tree_uniq.
by rewrite mem_filter mem_iota (vertex_vertex wf_S) // eqxx (vertex_lt wf_S).
Qed.

Lemma known_vertices_le_size : known_vertices S <= size S.
Proof. by rewrite /known_vertices -[leqRHS](size_iota 0) count_size. Qed.

(** The effect of [look_around], for any darts of vertices of the tree. *)
Lemma look_at t darts : is_tree t -> {in darts, forall d, vertex S d \in reached t} ->
  let look tree d :=
    if other S d is Some d' then if vertex S d' \in reached tree then tree else rcons tree d'
    else tree in
  exists t', [/\ foldl look t darts = t ++ t', is_tree (t ++ t')
    & {in darts, forall d d', other S d = Some d' -> vertex S d' \in reached (t ++ t')}].
Proof.
move=> t_tree mem_t look; elim: darts t t_tree mem_t => [|d darts IH] t t_tree mem_t /=.
  by exists [::]; rewrite cats0.
have [t1 [look_d t1_tree mem_d]]: exists t1, [/\ look t d = t ++ t1, is_tree (t ++ t1)
    & forall d', other S d = Some d' -> vertex S d' \in reached (t ++ t1)].
  rewrite /look; case other_d: (other S d) => [d'|]; last by exists [::]; rewrite cats0.
  case: ifPn => mem_d'; first by exists [::]; rewrite cats0; split=> // _ [<-].
  exists [:: d']; rewrite cats1; split=> // [|_ [<-]]; last by rewrite map_rcons mem_rcons mem_head.
  by apply: is_tree_rcons other_d _ mem_d' => //; apply: mem_t; apply: mem_head.
have [|t2] := IH _ t1_tree.
  by move=> e mem_e; rewrite map_cat mem_cat mem_t // inE mem_e orbT.
rewrite look_d -catA => -[-> t2_tree mem_darts]; exists (t1 ++ t2); split=> // e.
rewrite inE => /predU1P[-> d' /mem_d|/mem_darts//].
by rewrite catA !map_cat !mem_cat => ->.
Qed.

(** The first [i] vertices of the tree have all their neighbours in it. *)
Definition closed_to i (t : seq nat) := forall d d', other S d = Some d' ->
  index (vertex S d) (reached t) < i -> vertex S d' \in reached t.

Lemma look_around_tree i t : is_tree t -> closed_to i t -> i < size t ->
  let t' := look_around S t (vertex S (nth 0 t i)) in
  [/\ is_tree t', closed_to i.+1 t' & i < size t'].
Proof.
move=> t_tree t_closed i_lt; set v := vertex S _.
have mem_v: v \in reached t by apply/map_f/mem_nth.
have lt_v: nth 0 t i < size S by apply: tree_bounds (mem_nth _ _).
have vertex_v: vertex S v = v := vertex_vertex wf_S lt_v.
have index_v: index v (reached t) = i.
  by rewrite /v -(nth_map _ 0) // index_uniq ?size_map //; apply: tree_uniq.
have [e|t' [look t'_tree mem_t']] := look_at (darts := iota v (doors S v)) t_tree.
  by rewrite mem_iota -{1 2}vertex_v => /(wf_same wf_S (vertex_lt wf_S lt_v))[->]; rewrite vertex_v.
rewrite /= /look_around look; split=> //; last by rewrite size_cat ltn_addr.
move=> d d' other_d; rewrite map_cat index_cat size_map; case: ifPn => [mem_d|_]; last first.
  by rewrite ltnS leqNgt ltn_addr.
rewrite ltnS leq_eqVlt => /predU1P[index_d|/(t_closed _ _ other_d)]; last by rewrite mem_cat => ->.
rewrite -map_cat; apply: mem_t' (other_d).
have -> : v = vertex S d by rewrite -(nth_index 0 mem_v) index_v -index_d nth_index.
exact/mem_darts_of/(other_known other_d).
Qed.

Lemma grow_tree fuel i t : is_tree t -> closed_to i t -> i <= size t -> size S <= i + fuel ->
  let t' := grow S fuel i t in is_tree t' /\ closed_to (size t') t'.
Proof.
elim: fuel i t => [|fuel IH] i t t_tree t_closed i_le enough /=.
  rewrite addn0 in enough; split=> //; suff -> : size t = i by [].
  apply/eqP; rewrite eqn_leq i_le (leq_trans _ enough) //.
  exact: leq_trans (size_tree t_tree) known_vertices_le_size.
case: ltnP => [i_lt|le_i]; last first.
  by split=> //; suff -> : size t = i by []; apply/eqP; rewrite eqn_leq le_i.
have [t'_tree t'_closed i'_lt] := look_around_tree t_tree t_closed i_lt.
by apply: IH => //; rewrite addSnnS.
Qed.

Lemma tree_from_ok :
  is_tree (tree_from S root) /\ closed_to (size (tree_from S root)) (tree_from S root).
Proof. by apply: grow_tree => //; apply: is_tree_root. Qed.

Lemma tree_from_closed d d' : other S d = Some d' ->
  (vertex S d \in reached (tree_from S root)) = (vertex S d' \in reached (tree_from S root)).
Proof.
have [_ t_closed] := tree_from_ok.
have closed e e' : other S e = Some e' ->
    vertex S e \in reached (tree_from S root) -> vertex S e' \in reached (tree_from S root).
  by move=> other_e; rewrite -index_mem size_map; apply: t_closed.
by move=> other_d; have [_ _ other_d'] := wf_other wf_S other_d; apply/idP/idP; apply: closed.
Qed.

Lemma mem_tree_from d : d < size S -> vertex S d \in reached (tree_from S root).
Proof.
set t := reached _; have [t_tree _] := tree_from_ok; have root_in := mem_root t_tree.
have same b : (0 \in t) = b -> forall e, e < size S -> (vertex S e \in t) == b.
  move=> mem_0; apply: (wf_connected wf_S (P := fun v => (v \in t) == b)); first exact/eqP.
  by move=> e e' other_e; rewrite (tree_from_closed other_e).
by move=> d_lt; rewrite (eqP (same _ erefl _ d_lt)) -(eqP (same _ erefl _ root_lt)) vertex_root.
Qed.

Lemma up_leads t fuel v : is_tree t -> index v (reached t) < minn fuel (size t) ->
  leads S v (up S fuel t v) root /\ size (up S fuel t v) <= index v (reached t).
Proof.
move=> t_tree; elim: fuel v => [|fuel IH] v; rewrite leq_min //= => /andP[fuel_lt v_lt].
have mem_v: v \in reached t by rewrite -index_mem size_map.
case: ifPn => [/eqP index_v|v_gt /=].
  suff -> : v = root by rewrite /= eqxx.
  by rewrite -(nth_index 0 mem_v) index_v -[in LHS](tree_root t_tree) nth_index // mem_root.
have [|d' other_d d'_lt] := tree_up t_tree (i := index v (reached t)); first by rewrite lt0n v_gt.
rewrite other_d /= -(nth_map _ 0) // nth_index // eqxx.
have [|-> size_up] := IH (vertex S d'); last by split=> //; apply: leq_ltn_trans d'_lt.
by rewrite leq_min (leq_trans d'_lt) // (ltn_trans d'_lt).
Qed.

Lemma to_root_ok d : d < size S ->
  let path := to_root S (tree_from S root) (vertex S d) in
  leads S (vertex S d) path root /\ size path < known_vertices S.
Proof.
have [t_tree _] := tree_from_ok.
move=> d_lt; have index_lt: index (vertex S d) (reached (tree_from S root)) < size (tree_from S root).
  by rewrite -(size_map (vertex S)) index_mem mem_tree_from.
have [|to_leads to_size] := @up_leads _ (size (tree_from S root)) (vertex S d) t_tree.
  by rewrite minnn.
split=> //; apply: leq_ltn_trans to_size _.
exact: leq_trans index_lt (size_tree t_tree).
Qed.

End Tree.

(** * The paths through it *)

Lemma to_root_leads S root d : well_formed S -> root < size S -> vertex S root = root -> d < size S ->
  leads S (vertex S d) (to_root S (tree_from S root) (vertex S d)) root.
Proof. by move=> wf_S root_lt vertex_root /(to_root_ok wf_S root_lt vertex_root)[]. Qed.

Lemma to_root_short S root d : well_formed S -> root < size S -> vertex S root = root -> d < size S ->
  size (to_root S (tree_from S root) (vertex S d)) < known_vertices S.
Proof. by move=> wf_S root_lt vertex_root /(to_root_ok wf_S root_lt vertex_root)[]. Qed.

Lemma from_root_leads S root d : well_formed S -> root < size S -> vertex S root = root -> d < size S ->
  leads S root (from_root S (tree_from S root) (vertex S d)) (vertex S d).
Proof. by move=> wf_S *; apply: leads_rev => //; apply: to_root_leads. Qed.

Lemma from_root_short S root d : well_formed S -> root < size S -> vertex S root = root -> d < size S ->
  size (from_root S (tree_from S root) (vertex S d)) < known_vertices S.
Proof. by move=> *; rewrite size_rev size_map; apply: to_root_short. Qed.
