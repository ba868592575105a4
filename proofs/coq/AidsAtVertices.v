(** Markers and robots without a heading show only at which vertices they are, so some worlds with loops or parallel
    edges look alike with any number of them. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Walks Bisimulation Multigraphs.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma aids_at_vertices_bisimilar (X : aid) (V W : start) (R : V -> W -> Prop) :
  shows_only_vertices X -> same_vertices R -> bisimilar (with_aid X) V W.
Proof.
move=> only RP; have [S [S_first S_step]] := only _ _ _ RP; have [R_facing R_degree R_traverse _] := RP.
exists (fun s t => R s.1 t.1 /\ S s.2 t.2); split=> // -[p x] [q y] [/= pq xy].
have [same_shown acts leaves] := S_step _ _ _ _ pq xy.
split=> [|[i|a]] /=; first by rewrite (R_degree _ _ pq) same_shown.
  by have [-> xy'] := leaves i; case: ifP => // _; split; first exact: R_traverse.
by have [<- xy'] := acts a; case: ifP => // /xy'.
Qed.

(** * Places that correspond *)

Section Pairwise.

Variables (A B : Type) (R : A -> B -> Prop).

(** Lists whose elements correspond one by one. *)
Fixpoint pairwise_related (s : seq A) (t : seq B) : Prop :=
  match s, t with
  | [::], [::] => True
  | x :: s', y :: t' => R x y /\ pairwise_related s' t'
  | _, _ => False
  end.

Lemma related_nseq k x y : R x y -> pairwise_related (nseq k x) (nseq k y).
Proof. by move=> xy; elim: k. Qed.

Lemma related_size s t : pairwise_related s t -> size s = size t.
Proof. by elim: s t => [|x s IH] [|y t] //= [_ /IH ->]. Qed.

Lemma related_nth x y s t i : R x y -> pairwise_related s t -> R (nth x s i) (nth y t i).
Proof. by move=> xy; elim: s t i => [|a s IH] [|b t] [|i] //= [ab /IH]. Qed.

Lemma related_set_nth x y a b s t i : i < size s -> R a b -> pairwise_related s t ->
  pairwise_related (set_nth x s i a) (set_nth y t i b).
Proof. by move=> lt ab; elim: s t i lt => [|c s IH] [|d t] [|i] //= lt [cd st]; split=> //; apply: IH. Qed.

Lemma related_map (f : A -> bool) (g : B -> bool) s t :
  (forall x y, R x y -> f x = g y) -> pairwise_related s t -> map f s = map g t.
Proof. by move=> fg; elim: s t => [|x s IH] [|y t] //= [/fg -> /IH ->]. Qed.

Lemma related_has (f : A -> bool) (g : B -> bool) s t :
  (forall x y, R x y -> f x = g y) -> pairwise_related s t ->
  [/\ has f s = has g t, find f s = find g t & count f s = count g t].
Proof. by move=> fg; elim: s t => [|x s IH] [|y t] //= [/fg -> /IH[-> -> ->]]. Qed.

Lemma related_take i s t : pairwise_related s t -> pairwise_related (take i s) (take i t).
Proof. by elim: s t i => [|x s IH] [|y t] [|i] //= [xy /IH]. Qed.

End Pairwise.

(** * Aids that show only vertices *)

Section Aids.

Variables (V W : start) (R : V -> W -> Prop).
Hypothesis RP : same_vertices R.

Definition related_places (l : option V) (l' : option W) : Prop :=
  match l, l' with Some s, Some t => R s t | None, None => True | _, _ => False end.

Lemma related_lies_at p q l l' : R p q -> related_places l l' -> lies_at p l = lies_at q l'.
Proof. by case: RP => _ _ _ same pq; case: l l' => [s|] [t|] //=; apply: same. Qed.

Lemma related_carried l l' : related_places l l' -> is_carried l = is_carried l'.
Proof. by case: l l' => [s|] [t|]. Qed.

Lemma related_companion p q s t i : R p q -> pairwise_related R s t ->
  companion_seen false p s i = companion_seen false q t i.
Proof.
move=> pq st; have [_ same_degree _ same] := RP; have other := related_nth i pq st.
rewrite /companion_seen (same _ _ _ _ pq other) (same_degree _ _ other); case: ifP => // _.
by have [_ ->] := related_has (fun x y xy => same _ _ _ _ other xy) (related_take i st).
Qed.

End Aids.

Lemma markers_alike_at_vertices k : shows_only_vertices (markers_alike k).
Proof.
move=> V W R RP; have [R_facing _ _ _] := RP.
exists (pairwise_related (related_places R)); split; first exact: related_nseq.
move=> p q x y pq xy /=; have [here first_here count_here] := related_has (fun l l' => related_lies_at RP pq) xy.
have [held first_held _] := related_has (@related_carried _ _ R) xy.
split=> // -[]; split=> //; rewrite has_find => lt.
  by rewrite -first_here; apply: related_set_nth.
by rewrite -first_held; apply: related_set_nth.
Qed.

Lemma markers_distinct_at_vertices k : shows_only_vertices (markers_distinct k).
Proof.
move=> V W R RP; have [R_facing _ _ _] := RP.
exists (pairwise_related (related_places R)); split; first exact: related_nseq.
move=> p q x y pq xy /=; have here := related_map (fun l l' => related_lies_at RP pq) xy.
have held := related_map (@related_carried _ _ R) xy.
have small (b : option V -> bool) i : nth false (map b x) i -> i < size x.
  by case: (ltnP i (size x)) => // le; rewrite nth_default // size_map.
by split=> // -[] i; rewrite ?here ?held; split=> // can; apply: related_set_nth => //;
   [apply: (small (lies_at p)) | apply: (small (@is_carried V))]; rewrite ?here ?held.
Qed.

Lemma team_at_vertices k : shows_only_vertices (team false k).
Proof.
move=> V W R RP; have [R_facing R_degree R_traverse _] := RP.
exists (pairwise_related R); split; first exact: related_nseq.
move=> p q x y pq xy /=; rewrite (related_size xy); split=> // [|[i d]].
  by apply: eq_mkseq => i; exact: (related_companion RP i pq xy).
have other := related_nth i pq xy; rewrite (R_degree _ _ other); split=> // /andP[lt _].
by apply: related_set_nth => //; rewrite ?(related_size xy) //; apply: R_traverse.
Qed.

(** * Worlds whose vertices correspond *)

Lemma bouquets_same_vertices (V W : start) : one_vertex V -> one_vertex W -> #|V| = #|W| ->
  same_vertices (fun (_ : V) (_ : W) => True).
Proof.
move=> one_V one_W same; split=> // [p q _|p q p' q' _ _]; first by rewrite !one_vertex_degree.
by rewrite one_V one_W.
Qed.

Lemma loops_same_vertices : same_vertices (fun (_ : two_loops_plane) (_ : two_loops_torus) => True).
Proof. by have [plane torus] := loops_one_vertex; apply: bouquets_same_vertices. Qed.

Lemma theta_same_vertices : same_vertices (fun (p : theta_plane) (q : theta_torus) => p.1 = q.1).
Proof.
split=> // [p q|p q i|p q p' q']; first exact: theta_degree.
  exact: theta_traverse.
by rewrite plane_same_vertex torus_same_vertex => -> ->.
Qed.
