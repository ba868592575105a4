(** Algorithm 1 as a robot of Section 2.1: a strategy that depends only on its percepts. So there is a
    robot that maps every world with one directional marker. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Always Obeying Correct.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** What a robot does that runs a mapping algorithm: at the end it answers with the world of its map, and its pose
    in it. If there is no such world, it does something else. *)
Definition drawing E (otherwise : E) (d : decision E (option (partial_map * nat))) : decision E located :=
  match d with
  | Act e => Act e
  | Answer (Some (T, pose)) => if drawn T pose is Some map then Answer map else Act otherwise
  | Answer None => Act otherwise
  end.

(** The robot runs Algorithm 1 with its default choices. It has made fewer rounds than it has percepts, so
    their number is a sufficient limit, and it need not know the size of the world. *)
Definition locating_mapper : strategy located := fun past =>
  if past is first :: later then drawing 0 (obey (algorithm1 step_by_step short_paths (size past) first) later)
  else Act 0.

(** The same robot, which answers without its pose. *)
Definition mapper : strategy start := fun past =>
  match locating_mapper past with Act i => Act i | Answer map => Answer (world map) end.

(** * The limit makes no difference before it is reached *)

(** Every round has a percept. *)
Lemma explore_moves test allowed S pose past a later :
  finish (explore test allowed S pose) past = inr (a, later) -> size later < size past.
Proof.
rewrite /explore /= finish_bind; case moved: finish => [//|[u past']] /=.
case: past' moved => // seen past' moved ended.
exact: leq_ltn_trans (finish_le ended) (finish_le moved).
Qed.

Lemma eq_rounds test allowed b b' S pose past : size past < b -> size past < b' ->
  obey (rounds test allowed b S pose) past = obey (rounds test allowed b' S pose) past.
Proof.
elim: b b' S pose past => // b IH [//|b'] S pose past le le'.
rewrite !roundsS; case: (unexplored S) => // _ _; rewrite !obey_bind.
case explored: finish => [//|[after later]]; have lt := explore_moves explored.
by apply: IH; apply: leq_trans lt _.
Qed.

(** * The strategy does what the program does *)

(** One directional marker suffices, for the pose as well, and within the bound of Algorithm 1. *)
Lemma locating_mapper_maps W :
  let robot := locating_mapper in
  exists map n,
    [/\ robot (history robot (moving directional W) n) = Answer map,
        exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W
          & f (Algorithm1.robot map) = (situation robot (moving directional W) n).2],
        forall j i, robot (history robot (moving directional W) j) = Act i ->
          i < degree (situation robot (moving directional W) j).2
      & n <= cost W (edges W)].
Proof.
move=> robot; have short S path : size path < known_vertices S -> short_paths S path by [].
pose first := perceive directional (facing W).
pose bound := (edges W + cost W (edges W)).+1.
have le : edges W <= bound by rewrite /bound -addnS leq_addr.
have spec := algorithm1_spec step_by_step_valid short le.
have [_ [_ [_ cost_le]]] := always_heard spec.
have {cost_le} moves_le := cost_le (fun S path => id).
have at_first : situation robot (moving directional W) 0 = ([:: first], facing W) by [].
have [//|later later_le|answer r k [[T [p [map [-> _ drawn_map _]]]] _]|] :=
  obedient (report := drawing 0) (robot := robot) _ at_first spec.
- rewrite /robot /= (@eq_rounds _ _ _ bound) //.
  by rewrite /bound !ltnS (leq_trans later_le) // (leq_trans moves_le) // leq_addl.
- by exists map; rewrite /= drawn_map.
move=> answer [n [answered [right cost_n] doors]]; move: right => [T [p [map [answerE _ drawn_map iso]]]].
exists map, n; split=> //; last exact: cost_n (fun S path => id).
  by rewrite answered answerE /= drawn_map.
by move=> j i; apply: doors.
Qed.

Lemma situation_mapper W n :
  situation mapper (moving directional W) n = situation locating_mapper (moving directional W) n.
Proof.
elim: n => //= n ->; case: (situation _ _ n) => past pose; rewrite /mapper.
by case: (locating_mapper past).
Qed.

Lemma mapper_maps W : maps_start (moving directional) mapper W.
Proof.
have [map [n [answered [f [iso facing_f _]] _ _]]] := locating_mapper_maps W.
exists (world map); last by exists f.
by exists n; move: answered; rewrite /history situation_mapper /mapper => ->.
Qed.
