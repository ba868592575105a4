(** A world with one more vertex in the middle of an edge: a walk that does not go over this edge has the
    same percepts. So a robot that maps every world goes over every edge. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Bisimulation Parts Complete.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Subdivided.

Variables (W : start) (e : W).

(** The darts of the new vertex: [inr true] faces [e], [inr false] its opposite. *)
Definition sub_opposite (x : W + bool) : W + bool :=
  match x with
  | inl d => if d == e then inr true else if d == opposite e then inr false else inl (opposite d)
  | inr true => inl e
  | inr false => inl (opposite e)
  end.

Definition sub_clockwise (x : W + bool) : W + bool :=
  match x with inl d => inl (clockwise d) | inr b => inr (~~ b) end.

Lemma sub_oppositeK : involutive sub_opposite.
Proof.
case=> [d|[]] /=; last by rewrite (negPf (opposite_neq e)) eqxx.
  case: eqP => [->|/eqP de] //=; case: eqP => [->|/eqP doe] //=.
  by rewrite (inv_eq (@oppositeK W)) (negPf doe) (inj_eq (@opposite_inj W)) (negPf de) oppositeK.
by rewrite eqxx.
Qed.

Lemma sub_opposite_neq x : sub_opposite x != x.
Proof.
case: x => [d|[]] //=; case: ifP => // _; case: ifP => // _.
by apply: contra (opposite_neq d) => /eqP[->].
Qed.

Lemma sub_clockwise_inj : injective sub_clockwise.
Proof. by move=> [d|b] [d'|b'] //= [] => [/(@clockwise_inj W)->|/negb_inj->]. Qed.

Let step x y := (y == sub_opposite x) || (y == sub_clockwise x).

Lemma sub_connected x y : connect step x y.
Proof.
apply: (all_connected (root := inl (facing W))); [exact: sub_oppositeK | exact: sub_clockwise_inj |].
have old d : connect step (inl (facing W)) (inl d).
  have /connectP[s path_s ->] := connected (facing W) d; elim/last_ind: s path_s => [|s r IH] /=.
    by move=> _; apply: connect0.
  rewrite rcons_path last_rcons => /andP[/IH to_d /orP[]/eqP->]; apply: connect_trans to_d _.
    set p := last _ _; have := connect_opp sub_opposite sub_clockwise (inl p); rewrite /=.
    case: eqP => [->|_].
      move/connect_trans; apply; apply: connect_trans (connect_cw _ _ _) _.
      exact: (connect_opp sub_opposite sub_clockwise (inr false)).
    case: eqP => [->|_] //; rewrite oppositeK.
    move/connect_trans; apply; apply: connect_trans (connect_cw _ _ _) _.
    exact: (connect_opp sub_opposite sub_clockwise (inr true)).
  exact: (connect_cw sub_opposite sub_clockwise (inl _)).
case=> [d|[]] //.
  have := connect_opp sub_opposite sub_clockwise (inl e); rewrite /= eqxx; exact: connect_trans.
have := connect_opp sub_opposite sub_clockwise (inl (opposite e)).
by rewrite /= (negPf (opposite_neq e)) eqxx; apply: connect_trans.
Qed.

Definition subdivided_graph : embedded_graph :=
  @EmbeddedGraph [finType of W + bool] _ _ sub_oppositeK sub_opposite_neq sub_clockwise_inj sub_connected.

Definition subdivided : start := @Start subdivided_graph (inl (facing W)).

Let old : W -> subdivided := inl.

Lemma old_inj : injective old. Proof. by move=> d d' []. Qed.

Lemma old_turn d i : old (turn d i) = turn (old d) i.
Proof. by elim: i => //= i <-. Qed.

Lemma old_traverse d i : turn d i != e -> traverse d i != e -> old (traverse d i) = traverse (old d) i.
Proof.
rewrite {2 3}/traverse -old_turn /= => /negPf ->.
by rewrite (inv_eq (@oppositeK W)) => /negPf ->.
Qed.

Lemma old_same_vertex d d' : same_vertex (old d) (old d') -> same_vertex d d'.
Proof. by case/same_vertexP=> i; rewrite -old_turn => /old_inj->; apply: same_vertex_turn. Qed.

Lemma old_perceive d : perceive directional (old d) = perceive directional d.
Proof.
apply: part_perceive => //; [exact: old_turn | by move=> i /old_inj | exact: old_same_vertex].
Qed.

(** A walk that does not go over the edge goes the same way. *)
Lemma old_walk p doors : ~~ traverses p doors e -> old (walk p doors) = walk (old p) doors.
Proof.
elim: doors p => //= i doors IH p; rewrite !negb_or => /and3P[de doe /IH->].
by rewrite old_traverse.
Qed.

Lemma traverses_take p doors i : traverses p (take i doors) e -> traverses p doors e.
Proof.
elim: doors p i => [|j doors IH] p [|i] //= /or3P[->|->|/IH->] //; by rewrite ?orbT.
Qed.

Lemma subdivided_percepts p doors : ~~ traverses p doors e ->
  percepts directional (old p) doors = percepts directional p doors.
Proof.
move=> avoids; apply: eq_percepts_walk => i _; rewrite -old_walk ?old_perceive //.
by apply: contra avoids; apply: traverses_take.
Qed.

Lemma subdivided_not_isomorphic : ~ isomorphic subdivided W.
Proof.
move=> [f [f_bij _ _]]; have := bij_eq_card f_bij.
by rewrite card_sum card_bool -[X in _ = X]addn0 => /addnI.
Qed.

(** ** The class of the world *)

Lemma new_same_vertex b (y : subdivided) : same_vertex (inr b : subdivided) y -> exists b', y = inr b'.
Proof.
by case/same_vertexP=> i ->; elim: i => [|i [b' /= ->]]; [exists b | exists (~~ b')].
Qed.

Lemma subdivided_simple : simple W -> simple subdivided.
Proof.
move=> [no_loop no_parallel].
have apart b b' : same_vertex (sub_opposite (inr b) : subdivided) (sub_opposite (inr b') : subdivided) -> b = b'.
  by case: b b' => -[] //= /old_same_vertex; rewrite ?(negPf (no_loop e)) // same_vertex_sym (negPf (no_loop e)).
split=> [[d|b]|].
- apply/negP; rewrite /=; case: ifP => _; first by rewrite same_vertex_sym => /new_same_vertex[].
  case: ifP => _; first by rewrite same_vertex_sym => /new_same_vertex[].
  by move/old_same_vertex; apply/negP.
- by apply/negP=> /new_same_vertex[b']; case: b.
move=> [d|b] [d'|b'].
- move=> /old_same_vertex near; have := @no_parallel d d' near; rewrite /=.
  case: (d =P e) => [de|_]; case: (d' =P e) => [de'|_]; rewrite ?de ?de' //.
  + by case: ifP => [/eqP doe'|_ _ /new_same_vertex[] //]; move: near; rewrite de doe' (negPf (no_loop e)).
  + by case: ifP => [/eqP doe|_ _]; [move: near; rewrite de' doe same_vertex_sym (negPf (no_loop e)) |
      rewrite same_vertex_sym => /new_same_vertex[]].
  case: (d =P opposite e) => [doe|_]; case: (d' =P opposite e) => [doe'|_]; rewrite ?doe ?doe' //.
  + by move=> _ /new_same_vertex[].
  + by move=> _; rewrite same_vertex_sym => /new_same_vertex[].
  by move=> same /old_same_vertex /same->.
- by rewrite same_vertex_sym => /new_same_vertex[].
- by move=> /new_same_vertex[].
by move=> _ /apart->.
Qed.

Lemma subdivided_degree bound : 2 <= bound -> (forall d : W, degree d <= bound) ->
  forall x : subdivided, degree x <= bound.
Proof.
move=> two small [d|b].
  by rewrite (part_degree (f := old) (old_turn d)) // => i /old_inj.
apply: leq_trans two; rewrite -[2]card_bool.
rewrite -(card_codom (f := (inr : bool -> subdivided))); last by move=> ? ? [].
by apply/subset_leq_card/subsetP=> y /new_same_vertex[b' ->]; apply: codom_f.
Qed.

End Subdivided.
