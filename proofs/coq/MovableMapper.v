(** The algorithm with one movable marker as a robot: a strategy that depends only on its percepts. So there is
    a robot that maps every simple world with a movable marker. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Complete Always Obeying Mapper.
From toposlam Require Import MovableMarker MovableCorrect MovableCost.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The robot runs the algorithm with its default choices. It has made fewer rounds than it has percepts. *)
Definition movable_mapper : strategy_of handling_action located := fun past =>
  if past is first :: later then drawing Drop (obey (movable short_paths (size past) first) later) else Act Drop.

(** * The limit makes no difference before it is reached *)

Lemma finish_choose_among E A (T : eqType) (xs : seq T) default (next : T -> program_of E A) past :
  finish (let* x := choose_among xs default in next x) past = finish (next default) past.
Proof. by []. Qed.

(** Every round has a percept. *)
Lemma explore_edge_moves allowed S pose past a later :
  finish (explore_edge allowed S pose) past = inr (a, later) -> size later < size past.
Proof.
rewrite /explore_edge finish_choose_among finish_bind.
case went: (finish (travel _ _ _ _) past) => [//|[near past']] ended.
by apply: leq_trans (finish_le went); apply: finish_do_lt ended.
Qed.

Lemma explore_edgesS allowed bound S pose :
  explore_edges allowed bound.+1 S pose =
  if unexplored S is [::] then Return (Some (S, pose))
  else let* after := explore_edge allowed S pose in
       if after is Some (S', pose') then explore_edges allowed bound S' pose' else Return None.
Proof. by []. Qed.

Lemma eq_explore_edges allowed b b' S pose past : size past < b -> size past < b' ->
  obey (explore_edges allowed b S pose) past = obey (explore_edges allowed b' S pose) past.
Proof.
elim: b b' S pose past => // b IH [//|b'] S pose past le le'.
rewrite !explore_edgesS; case: (unexplored S) => // _ _.
rewrite !obey_bind; case explored: finish => [//|[[[S' pose']|] later]] //.
by have lt := explore_edge_moves explored; apply: IH; apply: leq_trans lt _.
Qed.

Lemma eq_movable b b' first past : size past < b -> size past < b' ->
  obey (movable short_paths b first) past = obey (movable short_paths b' first) past.
Proof.
by case: past => // seen past lt lt'; apply: eq_explore_edges; apply: leq_trans (leqnSn _) _.
Qed.

(** * The strategy does what the program does *)

Lemma movable_mapper_maps (W : start) : simple W ->
  exists map n,
    let: (pose, lying) := (situation movable_mapper (handling W) n).2 in
    [/\ movable_mapper (history movable_mapper (handling W) n) = Answer map, lying = None,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (robot map) = pose],
        forall j e, movable_mapper (history movable_mapper (handling W) j) = Act e ->
          can_handle (situation movable_mapper (handling W) j).2 e
      & n <= 1 + edges W * round_cost W].
Proof.
move=> simple_W; have short S path : size path < known_vertices S -> short_paths S path by [].
pose K := 1 + edges W * round_cost W; pose bound := edges W + K.+1.
pose first := sense (first_state (handling W)).
have right := movable_marker_correct short simple_W (leq_addr K.+1 (edges W)).
have {right} spec := always_within right (movable_within short simple_W (fun S path => id) bound).
have [_ [_ [_ heard_le]]] := always_heard spec.
have at_first : situation movable_mapper (handling W) 0 = ([:: first], first_state (handling W)) by [].
have [//|later later_le|answer s k [[_ [T [p [map [-> _ drawn_map _]]]]] _]|] :=
  obedient (report := drawing Drop) (robot := movable_mapper) _ at_first spec.
- rewrite -[LHS]/(drawing Drop (obey (movable short_paths (size later).+1 first) later)).
  rewrite (@eq_movable _ bound) //.
  by rewrite /bound addnS ltnS (leq_trans later_le) // (leq_trans heard_le) ?leq_addl.
- by exists map; rewrite /= drawn_map.
move=> answer [n [answered [[lying [T [p [map [answerE _ drawn_map iso]]]]] n_le] only]]; exists map, n.
case: (situation _ _ n).2 lying iso => pose l /= -> iso; split=> //.
  by rewrite answered answerE /= drawn_map.
by move=> j e; apply: only.
Qed.
