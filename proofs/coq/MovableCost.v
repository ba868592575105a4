(** The algorithm with one movable marker ends within a bound on decisions: moves, and pick-ups and drops of the
    marker. Section 2.3, after Dudek, Jenkin, Milios and Wilkes (1991). *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Maps Paths Embedding Rounds Complete.
From toposlam Require Import Always Correct MovableMarker MovableCorrect.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * The number of actions *)

Section Within.

Variables (E : Type) (I : environment E).
Implicit Type s : state I.

(** For all choices, the program ends within a number of actions, whether they are possible or not. *)
Fixpoint within A (actions : nat) (p : program_of E A) s : Prop :=
  match p with
  | Return _ => True
  | Do e go =>
      if actions is others.+1 then within others (go (sense (next_state s e))) (next_state s e) else False
  | Choose T allowed _ go => forall x, allowed x -> within actions (go x) s
  end.

Lemma within_le A k k' (p : program_of E A) s : k <= k' -> within k p s -> within k' p s.
Proof.
by elim: p k k' s => [a|e go IH|T ok default go IH] [|k] [|k'] s //= le; try exact: IH; move=> all x /all; apply: IH.
Qed.

Lemma always_within A k (p : program_of E A) s Q :
  always I p s Q -> within k p s -> always I p s (fun a t l => Q a t l /\ l <= k).
Proof.
elim: p k s Q => [a|e go IH|T ok default go IH] k s Q //=.
- by case: k => // k [can all] p_k; split=> //; apply: alwaysW (IH _ _ _ _ all p_k) => a t l.
- by case=> okd all p_k; split=> // x ok_x; apply: IH; [apply: all | apply: p_k].
Qed.

Section Bind.

Variables A B : Type.
Implicit Types (p : program_of E A) (next : A -> program_of E B).

(** If the second part ends within its bound wherever the first part ends. *)
Lemma within_bind k k' p next s Q :
  within k p s -> always I p s Q -> (forall a t l, Q a t l -> within k' (next a) t) ->
  within (k + k') (let* a := p in next a) s.
Proof.
elim: p k s Q => [a|e go IH|T ok default go IH] k s Q /=.
- by move=> _ q next_k'; apply: within_le (next_k' _ _ _ q); apply: leq_addl.
- by case: k => // k p_k [_ pQ] next_k'; apply: IH p_k pQ _ => a t l; apply: next_k'.
by move=> p_k [_ pQ] next_k' x ok_x; apply: IH (p_k x ok_x) (pQ x ok_x) next_k'.
Qed.

Lemma within_then k k' p next s :
  within k p s -> (forall a t, within k' (next a) t) -> within (k + k') (let* a := p in next a) s.
Proof.
move=> p_k next_k'; elim: p k s p_k => [a|e go IH|T ok default go IH] k s /=.
- by move=> _; apply: within_le (next_k' _ _); apply: leq_addl.
- by case: k => // k p_k; apply: IH.
by move=> p_k x ok_x; apply/IH/p_k.
Qed.

Lemma within_do k e (next : percept -> program_of E B) s :
  (forall seen t, within k (next seen) t) -> within k.+1 (let* seen := do_action e in next seen) s.
Proof. by move=> all; apply: all. Qed.

Lemma within_choose_among k (T : eqType) (xs : seq T) default (next : T -> program_of E B) s :
  (forall x, x \in xs -> within k (next x) s) -> within k (let* x := choose_among xs default in next x) s.
Proof. by []. Qed.

End Bind.

Lemma within_all es s : within (size es) (do_all es) s.
Proof. by elim: es s => //= e es IH s; apply: IH. Qed.

End Within.

Section Cost.

Variables (allowed : partial_map -> seq nat -> bool) (W : start).
Hypothesis allowed_short : forall S path, size path < known_vertices S -> allowed S path.
Hypothesis simple_W : simple W.

Section Longest.

(** The allowed paths in this map have at most so many edges. *)
Variables (S : partial_map) (longest : nat).
Hypothesis short : forall path, allowed S path -> size path <= longest.

Implicit Types (pose : nat) (s : state (handling W)).

Lemma travel_within pose v s : within longest (travel allowed S pose v) s.
Proof.
move=> path /andP[_ /short le]; apply: (within_le (k := size path + 0)) => /=; first by rewrite addn0.
rewrite -(size_doors_along S pose path) -(size_map LeaveBy).
apply: within_then => //.
exact: within_all.
Qed.

Lemma look_along_within pose darts C s : within (size darts) (look_along S pose darts C) s.
Proof.
elim: darts pose C s => //= d darts IH pose C s; case: (if _ is Some _ then _ else _); try by [].
all: by move=> *; apply: IH.
Qed.

Lemma look_for_marker_within fuel pose C s :
  within (fuel * longest) (look_for_marker allowed fuel S pose C) s.
Proof.
elim: fuel pose C s => [|fuel IH] pose [|c C] s //= v _ path /andP[_ /short le].
rewrite mulSn; apply: within_then => [|[p|p C'] t] //.
exact: within_le le (look_along_within _ _ _ _).
Qed.

Lemma validate_place_within e degree s :
  within (2 + (size (candidates S e degree) * longest + (longest + 2))) (validate_place allowed S e degree) s.
Proof.
rewrite /validate_place; case: (candidates S e degree) => // c C; move: (c :: C) => {c}C.
apply: within_do => _ s1; apply: within_do => _ s2.
apply: within_then => [|[p|p C'] s3]; [exact: look_for_marker_within | by [] |].
by apply: within_then => [|p' s4]; first exact: travel_within.
Qed.

Lemma try_back_links_within fuel pose links s : within (2 * fuel) (try_back_links fuel S pose links) s.
Proof.
elim: fuel pose links s => [|fuel IH] pose [|h links] s //; rewrite mulnS => g _ /=.
by case: (if _ is Some _ then _ else _) => * //=; apply: IH.
Qed.

Lemma validate_back_link_within pose e s :
  within (1 + (longest + (1 + (longest + (2 * size (back_links S (vertex S pose)) + 1)))))
    (validate_back_link allowed S pose e) s.
Proof.
have long links t : within (longest + (1 + (longest + (2 * size links + 1))))
    (find_back_link allowed S pose e links) (t : state (handling W)).
  rewrite /find_back_link; apply: within_then => [|near t1]; first exact: travel_within.
  apply: within_do => _ t2; apply: within_then => [|far t3]; first exact: travel_within.
  by apply: within_then => [|[h|] t4]; first exact: try_back_links_within.
rewrite /validate_back_link; move: (back_links S _) => links; apply: within_do => _ t.
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

Lemma explore_edge_within (S : partial_map) (place : nat -> W) pose (s : state (handling W)) :
  embeds S place -> within round_cost (explore_edge allowed S pose) s.
Proof.
move=> em; have shortest := path_short em; set B := (vertices W).-1 in shortest *.
have place_cost e degree (t : state (handling W)) :
    within (2 + (vertices W * B + (B + 2))) (validate_place allowed S e degree) t.
  apply: within_le (validate_place_within shortest e degree t).
  by rewrite leq_add2l leq_add2r leq_mul2r (size_candidates _ _ em) orbT.
have link_cost p e (t : state (handling W)) :
    within (1 + (B + (1 + (B + (4 * edges W + 1))))) (validate_back_link allowed S p e) t.
  apply: within_le (validate_back_link_within shortest p e t).
  rewrite !leq_add2l leq_add2r; have := size_back_links (vertex S p) em.
  by rewrite -[4]/(2 * 2) -mulnA leq_mul2l.
apply: (within_le (k := B + ((2 + (vertices W * B + (B + 2))) +
                             (1 + (B + (1 + (B + (4 * edges W + 1)))))).+1)).
  by rewrite /round_cost -/B mulnDl; arithmetic.
apply: within_choose_among => e _; apply: within_then => [|near t]; first exact: travel_within.
apply: within_do => seen t'; apply: within_then => [|[|p] t1]; [exact: place_cost | by [] |].
by rewrite -[1 + _]addn0; apply: within_then => [|link t2]; first exact: link_cost.
Qed.

Lemma explore_edges_within left bound (S : partial_map) (place : nat -> W) pose :
  embeds S place -> pose < size S -> size S + 2 * left = 2 * edges W + size (unexplored S) ->
  within (left * round_cost) (explore_edges allowed bound S pose) ((place pose, None) : state (handling W)).
Proof.
elim: bound left S place pose => [|bound IH] left S place pose em lt count.
  by rewrite /=; case: (unexplored S).
rewrite /explore_edges -/explore_edges; case UE: (unexplored S) => [|d U] //.
have some_left : unexplored S != [::] by rewrite UE.
have known := size_known em.
have left_gt0 : 0 < left by move: count; rewrite UE /= => count; arithmetic.
rewrite -(prednK left_gt0) mulSn.
have spec := explore_edge_spec allowed_short simple_W em lt some_left.
apply: (within_bind (@explore_edge_within S place pose _ em) spec) => after s k.
case=> S' [pose' [place' [-> em' lt' -> sizes]]].
by apply: IH => //; arithmetic.
Qed.

Lemma movable_within bound :
  within (1 + edges W * round_cost) (movable allowed bound (sense (first_state (handling W))))
    (first_state (handling W)).
Proof.
have sz : size (with_vertex [::] (degree (facing W))) = degree (facing W) by rewrite size_with_vertex.
rewrite add1n /= same_vertex_refl.
apply: (explore_edges_within bound (embeds_at_start W)); first by rewrite sz degree_gt0.
by rewrite unexplored_at_start sz size_iota addnC.
Qed.

(** All of it, for any limit on rounds: the answer, if there is one, and the number of actions. *)
Lemma movable_cost bound :
  always (handling W) (movable allowed bound (sense (first_state (handling W)))) (first_state (handling W))
    (fun _ _ actions => actions <= 1 + edges W * round_cost).
Proof.
have spec := movable_marker_sound allowed_short simple_W bound.
by apply: alwaysW (always_within spec (movable_within bound)) => a s k [].
Qed.

End Cost.
