(** The invariant of Algorithm 1: the known map is a part of the world. Section 2.3, line 4. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Maps.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** [place] maps each dart of the map to a dart of the world. It maps facing to facing, is injective, and
    keeps degrees, the order around each vertex, and the explored edges. *)
Record embeds (S : partial_map) (W : start) (place : nat -> W) : Prop := Embeds {
  em_wf : well_formed S;
  em_facing : place 0 = facing W;
  em_inj : forall d e, d < size S -> e < size S -> place d = place e -> d = e;
  em_doors : forall d, d < size S -> doors S d = degree (place d);
  em_turn : forall d, d < size S -> place d = turn (place (vertex S d)) (d - vertex S d);
  em_other : forall d d', other S d = Some d' -> place d' = opposite (place d)
}.

Section Embedding.

Variables (S : partial_map) (W : start) (place : nat -> W).
Hypothesis em : embeds S place.

Let wf := em_wf em.

Lemma doors_gt0 d : d < size S -> 0 < doors S d.
Proof. by move=> lt; rewrite (em_doors em) // degree_gt0. Qed.

Lemma door_to_lt d e : d < size S -> door_to S d e < doors S d.
Proof. by move=> lt; rewrite ltn_pmod // doors_gt0. Qed.

(** The degree of a vertex, from any of its darts. *)
Lemma degree_vertex d : d < size S -> degree (place (vertex S d)) = doors S d.
Proof. by move=> lt; rewrite (em_doors em lt) [in RHS](em_turn em lt) degree_turn. Qed.

(** Doors in the map are doors in the world. *)
Lemma turn_door_to d e : d < size S -> e < size S -> vertex S d = vertex S e ->
  turn (place d) (door_to S d e) = place e.
Proof.
move=> d_lt e_lt same; have [/andP[le_d lt_d] _] := wf_bounds wf d_lt.
have [/andP[le_e lt_e] _] := wf_bounds wf e_lt.
rewrite /door_to (em_turn em d_lt) (em_turn em e_lt) -same -turnD; rewrite -same in le_e.
rewrite -(turn_mod _ (e - _)) -(turn_mod _ (_ + _)) degree_vertex //; congr (turn _ _).
rewrite modnDmr -[RHS]modnDr; congr (_ %% _).
have le : d <= e + doors S d by rewrite (leq_trans (ltnW lt_d)) // leq_add2r.
by rewrite addnC addnBA // subnK // addnBAC.
Qed.

(** Every turn from a known dart leads to a known dart of the same vertex. *)
Lemma turn_known d i : d < size S ->
  exists e, [/\ e < size S, vertex S e = vertex S d & place e = turn (place d) i].
Proof.
move=> lt; have [bounds out] := wf_bounds wf lt; case/andP: (bounds) => le lt_d.
pose e := vertex S d + (d - vertex S d + i) %% doors S d.
have near : vertex S d <= e < vertex S d + doors S d.
  by rewrite leq_addr ltn_add2l ltn_pmod ?doors_gt0.
have e_lt : e < size S by case/andP: near => _ e_lt; apply: leq_trans e_lt out.
have [same _] := wf_same wf lt near; exists e; split=> //.
rewrite (em_turn em e_lt) same (em_turn em lt) -turnD addKn.
by rewrite -degree_vertex // turn_mod.
Qed.

(** Darts at the same vertex in the world are at the same vertex in the map. *)
Lemma same_vertex_known d e : d < size S -> e < size S ->
  same_vertex (place d) (place e) = (vertex S d == vertex S e).
Proof.
move=> d_lt e_lt; apply/same_vertexP/eqP=> [[i]|same].
  have [e' [e'_lt <- <-]] := turn_known i d_lt.
  by move/(em_inj em e_lt e'_lt) => ->.
by exists (door_to S d e); rewrite turn_door_to.
Qed.

(** The percepts in the world are those expected in the map. *)
Lemma expectedE d : d < size S -> expected S d = perceive directional (place d).
Proof.
move=> lt; have S_gt0 := wf_some wf.
rewrite /expected /perceive /directional (em_doors em lt) -(em_facing em) same_vertex_known //.
rewrite (wf_first wf); case: eqP => // at_start; congr (_, Pointing _).
have -> : place 0 = turn (place d) (door_to S d 0) by rewrite turn_door_to // (wf_first wf).
by rewrite /turn findex_iter // -/(degree _) -(em_doors em lt) door_to_lt.
Qed.

(** A move over an explored edge. *)
Lemma traverse_known pose d d' : pose < size S -> other S d = Some d' -> vertex S d = vertex S pose ->
  traverse (place pose) (door_to S pose d) = place d'.
Proof.
move=> lt dd' same; rewrite /traverse turn_door_to ?(em_other em dd') //.
exact: other_known dd'.
Qed.

(** A path through the map is a walk in the world. *)
Lemma walk_known darts pose v' : pose < size S -> leads S (vertex S pose) darts v' ->
  let pose' := pose_behind S pose darts in
  [/\ pose' < size S, vertex S pose' = v', walk (place pose) (doors_along S pose darts) = place pose'
    & passable (place pose) (doors_along S pose darts)].
Proof.
elim: darts pose => [|d darts IH] pose lt /=; first by move/eqP.
case/andP=> /eqP same; case dd': (other S d) => [d'|//] /= path.
have [lt' _ _] := wf_other wf dd'.
rewrite (traverse_known lt dd' same) -(em_doors em lt) door_to_lt //; exact: IH.
Qed.

(** A robot that has the expected sighting at the marked vertex of the map is where it believes it is. *)
Lemma expected_inj pose (q : W) : pose < size S -> vertex S pose = 0 ->
  perceive directional q = expected S pose -> place pose = q.
Proof.
move=> lt at_start; rewrite expectedE // /perceive /directional => -[_].
have at_marker : same_vertex (place pose) (facing W).
  by rewrite -(em_facing em) same_vertex_known ?(wf_some wf) // (wf_first wf) at_start.
rewrite at_marker; case: ifP => // near [same].
apply: (@turn_inj _ (findex clockwise q (facing W))).
by rewrite /turn [RHS]iter_findex // same iter_findex.
Qed.

End Embedding.
