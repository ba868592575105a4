(** The algorithm with one movable marker ends within a bound on decisions: moves, and pick-ups and drops of the
    marker. Section 2.3, after Dudek, Jenkin, Milios and Wilkes (1991). *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Maps Paths Embedding Rounds Complete.
From toposlam Require Import Correct MovableMarker MovableCorrect.
From toposlam Require Handling.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Notation within := Handling.within.

Lemma within_le (W : start) A k k' (p : handling_program A) (pose : W) (l : option W) :
  k <= k' -> within k p pose l -> within k' p pose l.
Proof.
elim: p k k' pose l => [a|[i||] go IH|T ok default go IH] [|k] [|k'] pose l //= le;
  try exact: IH; by move=> all x /all; apply: IH.
Qed.

Section Within.

Variables (W : start) (A B : Type).
Implicit Types (p : handling_program A) (pose : W) (l : option W).

Lemma within_bind (Q : A -> W -> option W -> Prop) k k' p (next : A -> handling_program B) pose l :
  within k p pose l -> always_handling p pose l Q ->
  (forall a q l, Q a q l -> within k' (next a) q l) -> within (k + k') (let* a := p in next a) pose l.
Proof.
move=> p_k pQ nextQ; elim: p k pose l p_k pQ => [a|[i||] go IH|T ok default go IH] k pose l /=.
- by move=> _ /nextQ; apply: within_le; apply: leq_addl.
- by case: k => // k p_k [_ pQ]; apply: IH.
- by case: k l => // k [spot|] //= p_k [here pQ]; rewrite here in p_k *; apply: (IH _ _ _ _ p_k pQ).
- by case: k l => // k [spot|] // p_k pQ; apply: IH.
by move=> p_k [_ pQ] x ok_x; apply: IH; [apply: p_k | apply: pQ].
Qed.

(** If the second part ends within its bound wherever the first part ends. *)
Lemma within_then k k' p (next : A -> handling_program B) pose l :
  within k p pose l -> (forall a q l, within k' (next a) q l) -> within (k + k') (let* a := p in next a) pose l.
Proof.
move=> p_k next_k'; elim: p k pose l p_k => [a|[i||] go IH|T ok default go IH] k pose l /=.
- by move=> _; apply: within_le (next_k' _ _ _); apply: leq_addl.
- by case: k => // k p_k; apply: IH.
- by case: k => // k p_k; apply: IH.
- by case: k => // k p_k; apply: IH.
by move=> p_k x ok_x; apply/IH/p_k.
Qed.

Lemma within_move k i (next : percept -> handling_program B) pose l :
  (forall seen (q : W), within k (next seen) q l) -> within k.+1 (let* seen := move i in next seen) pose l.
Proof. by move=> all; apply: all. Qed.

Lemma within_choose_among k (T : eqType) (xs : seq T) default (next : T -> handling_program B) pose l :
  (forall x, x \in xs -> within k (next x) pose l) ->
  within k (let* x := choose_among xs default in next x) pose l.
Proof. by []. Qed.

Lemma within_drop k (next : handling_program B) pose l :
  (forall (q : W) m, within k next q m) -> within k.+1 (drop ;; next) pose l.
Proof. by move=> all; apply: all. Qed.

Lemma within_pick_up k (next : handling_program B) pose l :
  (forall (q : W) m, within k next q m) -> within k.+1 (pick_up ;; next) pose l.
Proof. by move=> all; apply: all. Qed.

End Within.

Lemma within_moves (W : start) doors (pose : W) l : within (size doors) (moves doors) pose l.
Proof. by elim: doors pose => //= i doors IH pose; apply: IH. Qed.

Section Cost.

Variables (allowed : partial_map -> seq nat -> bool) (W : start).
Hypothesis allowed_short : forall S path, size path < known_vertices S -> allowed S path.
Hypothesis simple_W : simple W.

Section Longest.

(** The allowed paths in this map have at most so many edges. *)
Variables (S : partial_map) (longest : nat).
Hypothesis short : forall path, allowed S path -> size path <= longest.

Implicit Types (pose : nat) (q : W) (l : option W).

Lemma travel_within pose v q l : within longest (travel allowed S pose v) q l.
Proof.
move=> path /andP[_ /short le]; apply: (within_le (k := size path + 0)) => /=; first by rewrite addn0.
rewrite -(size_doors_along S pose path).
apply: within_then => //.
exact: within_moves.
Qed.

Lemma look_along_within pose darts C q l : within (size darts) (look_along S pose darts C) q l.
Proof.
elim: darts pose C q l => //= d darts IH pose C q [spot|] /=; last exact: IH.
by case: ifP => _ //=; apply: IH.
Qed.

Lemma look_for_marker_within fuel pose C q l :
  within (fuel * longest) (look_for_marker allowed fuel S pose C) q l.
Proof.
elim: fuel pose C q l => [|fuel IH] pose [|c C] q l //= v _ path /andP[_ /short le].
rewrite mulSn; apply: within_then => [|[p|p C'] r m] //.
exact: within_le le (look_along_within _ _ _ _ _).
Qed.

Lemma validate_place_within e degree q l :
  within (2 + (size (candidates S e degree) * longest + (longest + 2)))
    (validate_place allowed S e degree) q l.
Proof.
rewrite /validate_place; case: (candidates S e degree) => // c C; move: (c :: C) => {c}C.
apply: within_drop => q' m; apply: within_move => _ r.
apply: within_then => [|[p|p C'] r' m']; [exact: look_for_marker_within | by [] |].
by apply: within_then => [|p' r'' m'']; first exact: travel_within.
Qed.

Lemma try_back_links_within fuel pose links q l :
  within (2 * fuel) (try_back_links fuel S pose links) q l.
Proof.
elim: fuel pose links q l => [|fuel IH] pose [|h links] q [spot|] //; rewrite mulnS => g _ /=; last exact: IH.
by case: ifP => _ //=; apply: IH.
Qed.

Lemma validate_back_link_within pose e q l :
  within (1 + (longest + (1 + (longest + (2 * size (back_links S (vertex S pose)) + 1)))))
    (validate_back_link allowed S pose e) q l.
Proof.
have long links (r : W) m : within (longest + (1 + (longest + (2 * size links + 1))))
    (find_back_link allowed S pose e links) r m.
  rewrite /find_back_link; apply: within_then => [|near r1 m1]; first exact: travel_within.
  apply: within_drop => r2 m2; apply: within_then => [|far r3 m3]; first exact: travel_within.
  by apply: within_then => [|[h|] r4 m4]; first exact: try_back_links_within.
rewrite /validate_back_link; move: (back_links S _) => links; apply: within_pick_up => r m.
by case: links => [|h [|h' links]] //; apply: long.
Qed.

End Longest.

(** The greatest number of decisions in a round. *)
Definition round_cost := (vertices W + 4) * (vertices W).-1 + 8 + 4 * edges W.

Definition only_short := forall S path, allowed S path -> size path < known_vertices S.
Hypothesis short : only_short.

Lemma path_short (S : partial_map) (place : nat -> W) : embeds S place ->
  forall path, allowed S path -> size path <= (vertices W).-1.
Proof.
move=> em path /short lt; rewrite -ltnS (prednK (vertices_gt0 W)).
exact: leq_trans lt (known_vertices_le em).
Qed.

Lemma size_candidates (S : partial_map) (place : nat -> W) e degree : embeds S place ->
  size (candidates S e degree) <= vertices W.
Proof.
move=> em; apply: leq_trans (known_vertices_le em); rewrite /known_vertices -size_filter.
apply: uniq_leq_size => [|v]; first by rewrite sort_uniq filter_uniq ?undup_uniq.
by case/(candidates_known em) => v_lt vv; rewrite mem_filter mem_iota vv eqxx.
Qed.

Lemma size_back_links (S : partial_map) (place : nat -> W) v : embeds S place ->
  size (back_links S v) <= 2 * edges W.
Proof.
move=> em; apply: leq_trans (size_known em); rewrite !size_filter.
by apply: leq_trans (count_size _ _) _; rewrite size_filter (leq_trans (count_size _ _)) ?size_iota.
Qed.

Lemma explore_edge_within (S : partial_map) (place : nat -> W) pose (q : W) l :
  embeds S place -> within round_cost (explore_edge allowed S pose) q l.
Proof.
move=> em; have shortest := path_short em; set B := (vertices W).-1 in shortest *.
have place_cost e degree (q' : W) l' :
    within (2 + (vertices W * B + (B + 2))) (validate_place allowed S e degree) q' l'.
  apply: within_le (validate_place_within shortest e degree q' l').
  by rewrite leq_add2l leq_add2r leq_mul2r (size_candidates _ _ em) orbT.
have link_cost p e (q' : W) l' :
    within (1 + (B + (1 + (B + (4 * edges W + 1))))) (validate_back_link allowed S p e) q' l'.
  apply: within_le (validate_back_link_within shortest p e q' l').
  rewrite !leq_add2l leq_add2r; have := size_back_links (vertex S p) em.
  by rewrite -[4]/(2 * 2) -mulnA leq_mul2l.
apply: (within_le (k := B + ((2 + (vertices W * B + (B + 2))) +
                             (1 + (B + (1 + (B + (4 * edges W + 1)))))).+1)).
  by rewrite /round_cost -/B mulnDl; arithmetic.
apply: within_choose_among => e _; apply: within_then => [|near r m]; first exact: travel_within.
apply: within_move => seen r'; apply: within_then => [|[|p] r1 m1]; [exact: place_cost | by [] |].
by rewrite -[1 + _]addn0; apply: within_then => [|link r2 m2]; first exact: link_cost.
Qed.

Lemma explore_edges_within left bound (S : partial_map) (place : nat -> W) pose :
  embeds S place -> pose < size S -> size S + 2 * left = 2 * edges W + size (unexplored S) ->
  within (left * round_cost) (explore_edges allowed bound S pose) (place pose) None.
Proof.
elim: bound left S place pose => [|bound IH] left S place pose em lt count.
  by rewrite /=; case: (unexplored S).
rewrite /explore_edges -/explore_edges; case UE: (unexplored S) => [|d U] //.
have some_left : unexplored S != [::] by rewrite UE.
have known := size_known em.
have left_gt0 : 0 < left by move: count; rewrite UE /= => count; arithmetic.
rewrite -(prednK left_gt0) mulSn.
have spec := explore_edge_spec allowed_short simple_W em lt some_left.
apply: (within_bind (@explore_edge_within S place pose (place pose) None em) spec) => after r l [->].
case=> S' [pose' [place' [-> em' lt' -> sizes]]].
by apply: IH => //; arithmetic.
Qed.

Lemma movable_within bound :
  within (1 + edges W * round_cost) (movable allowed bound (perceive_lying (Some (facing W)) (facing W)))
    (facing W) (Some (facing W)).
Proof.
have sz : size (with_vertex [::] (degree (facing W))) = degree (facing W) by rewrite size_with_vertex.
rewrite add1n; suff: within (edges W * round_cost)
    (explore_edges allowed bound (with_vertex [::] (degree (facing W))) 0) (facing W) None.
  by rewrite /= same_vertex_refl.
apply: (explore_edges_within bound (embeds_at_start W)); first by rewrite sz degree_gt0.
by rewrite unexplored_at_start sz size_iota addnC.
Qed.

End Cost.
