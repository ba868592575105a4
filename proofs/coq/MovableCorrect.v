(** The algorithm with one movable marker maps every simple world, with any choices: the results of place
    validation and back-link validation are right. Section 2.3, after Dudek, Jenkin, Milios and Wilkes
    (1991). *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Always Paths Embedding Rounds Complete.
From toposlam Require Import Maps Correct MovableMarker.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** Moves by doors that exist, wherever the marker is. *)
Lemma handling_moves (W : start) doors (pose : W) lying : passable pose doors ->
  always (handling W) (moves doors) (pose, lying) (fun _ s _ => s = (walk pose doors, lying)).
Proof. by elim: doors pose => [|i doors IH] pose //= /andP[open_i open_doors]; split=> //; apply: IH. Qed.

(** * Within the known map *)

Section Correct.

Variable allowed : partial_map -> seq nat -> bool.

(** The allowed paths include the short ones, so that there is always one. *)
Hypothesis allowed_short : forall S path, size path < known_vertices S -> allowed S path.

Variable W : start.
Hypothesis simple_W : simple W.

Section OneRound.

Variables (S : partial_map) (place : nat -> W).
Hypothesis em : embeds S place.

Let wf := em_wf em.

Lemma choose_path_spec pose d (s : state (handling W)) : pose < size S -> d < size S ->
  always (handling W) (choose_path allowed S pose (vertex S d)) s
    (fun path t _ => leads S (vertex S pose) path (vertex S d) /\ t = s).
Proof.
move=> pose_lt d_lt; have root := vertex_vertex wf pose_lt; have root_lt := vertex_lt wf pose_lt.
split; first by rewrite /= from_root_leads //=; apply/allowed_short/from_root_short.
by move=> path /andP[].
Qed.

Lemma travel_spec pose d lying : pose < size S -> d < size S ->
  always (handling W) (travel allowed S pose (vertex S d)) (place pose, lying)
    (fun p s _ => [/\ p < size S, vertex S p = vertex S d & s = (place p, lying)]).
Proof.
move=> pose_lt d_lt; apply: always_then (choose_path_spec _ pose_lt d_lt) _ => path _ _ [path_ok ->].
have [p_lt at_d walked open_doors] := walk_known em pose_lt path_ok.
by apply: always_then (handling_moves _ open_doors) _ => _ _ _ ->; rewrite walked.
Qed.

(** A move over any edge of a known vertex: the door exists, and leads to the other end. *)
Lemma leave_by pose e : pose < size S -> e < size S -> vertex S pose = vertex S e ->
  door_to S pose e < degree (place pose) /\
  traverse (place pose) (door_to S pose e) = opposite (place e).
Proof.
move=> pose_lt e_lt same; rewrite -(em_doors em) // (door_to_lt em) //.
by rewrite /traverse (turn_door_to em).
Qed.

(** And back by door 0. *)
Lemma traverse_opposite0 e : traverse (opposite (place e)) 0 = place e.
Proof. exact: oppositeK. Qed.

(** The map has no parallel edges. *)
Lemma no_parallel_known d e : d < size S -> e < size S -> vertex S d = vertex S e ->
  same_vertex (opposite (place d)) (opposite (place e)) -> d = e.
Proof.
move=> d_lt e_lt same far; apply: (em_inj em) => //; have [_ no_parallel] := simple_W.
by apply: no_parallel far; rewrite (same_vertex_known em) // same.
Qed.

(** ** The search for the marker *)

Section Search.

(** The place of the marker. *)
Variable spot : W.

(** If its vertex is known, it is among these candidates. *)
Definition enough_candidates (C : seq nat) :=
  forall d, d < size S -> same_vertex (place d) spot -> vertex S d \in C.

(** The robot sees the marker, or knows the remaining candidates. *)
Definition found_well p := p < size S /\ same_vertex (place p) spot.

Definition missed_well p C := [/\ p < size S, ~~ same_vertex (place p) spot & enough_candidates C].

(** A vertex at which the marker does not lie need not be a candidate. *)
Lemma enough_without p C : p < size S -> ~~ same_vertex (place p) spot ->
  enough_candidates C -> enough_candidates [seq v <- C | v != vertex S p].
Proof.
move=> p_lt away enough d d_lt here; rewrite mem_filter enough // andbT.
apply: contra away => /eqP same; apply: same_vertex_trans here.
by rewrite (same_vertex_known em) // same.
Qed.

Lemma look_along_spec darts p v C : leads S (vertex S p) darts v -> missed_well p C ->
  always (handling W) (look_along S p darts C) (place p, Some spot)
    (fun sought s _ =>
       match sought with
       | Found p' => found_well p' /\ s = (place p', Some spot)
       | Missed p' C' => [/\ missed_well p' C', subseq C' C, v \notin C' & s = (place p', Some spot)]
       end).
Proof.
elim: darts p C => [|d darts IH] p C /= path [p_lt away enough].
  split=> //; last by rewrite -(eqP path) mem_filter eqxx.
    by split=> //; apply: enough_without.
  exact: filter_subseq.
case/andP: path => /eqP same; case dd': (other S d) => [d'|//] /= path.
have [d'_lt _ _] := wf_other wf dd'.
have [open_d ->] := leave_by p_lt (other_known dd') (esym same).
rewrite -(em_other em dd'); split=> //; case: ifP => // unseen.
have away' : ~~ same_vertex (place d') spot by rewrite unseen.
apply: alwaysW (IH d' _ path _) => [[p'|p' C'] s k //|].
  by case=> well sub v_C' ->; split=> //; apply: subseq_trans sub (filter_subseq _ _).
by split=> //; apply: enough_without.
Qed.

Lemma look_for_marker_spec n p C : size C <= n ->
  {in C, forall v, v < size S /\ vertex S v = v} -> missed_well p C ->
  always (handling W) (look_for_marker allowed n S p C) (place p, Some spot)
    (fun sought s _ =>
       match sought with
       | Found p' => found_well p' /\ s = (place p', Some spot)
       | Missed p' _ => missed_well p' [::] /\ s = (place p', Some spot)
       end).
Proof.
elim: n p C => [|n IH] p C /=; first by rewrite leqn0 => /nilP->.
case: C => // c C0; set C := c :: C0 => size_C known_C well; have [p_lt _ _] := well.
split; first exact: mem_head.
move=> v vC; have [v_lt vv] := known_C v vC; rewrite -vv.
apply: always_then (choose_path_spec _ p_lt v_lt) _ => path _ _ [path_ok ->].
apply: always_then (look_along_spec path_ok well) _ => -[p'|p' C'] s k; first by case.
case=> well' sub; rewrite vv => v_C' ->.
apply: IH => [|w /(mem_subseq sub)/known_C//|//].
rewrite -ltnS; apply: leq_trans size_C; have [le eq] := size_subseq_leqif sub.
by rewrite ltn_neqAle le andbT eq; apply: contra v_C' => /eqP->.
Qed.

End Search.

(** ** An edge is explored *)

Variable e : nat.
Hypothesis eU : e \in unexplored S.

Let e_lt : e < size S.
Proof. by move: eU; rewrite mem_unexplored => /andP[]. Qed.

(** Where the edge leads. *)
Let t : W := opposite (place e).

Lemma end_elsewhere : ~~ same_vertex (place e) t.
Proof. by have [no_loop _] := simple_W; apply: no_loop. Qed.

(** If the unknown end is at a known vertex, then the dart there is known, and unexplored. *)
Lemma end_known d : d < size S -> same_vertex (place d) t ->
  exists2 h, h \in back_links S (vertex S d) & h != e /\ place h = t.
Proof.
move=> d_lt /same_vertexP[i tE]; have [h [h_lt same placed]] := turn_known em i d_lt.
have /andP[hU he] := unexplored_opposite em eU h_lt (etrans placed (esym tE)).
by exists h; [rewrite mem_filter same eqxx | rewrite placed -tE].
Qed.

Lemma candidates_enough : enough_candidates t (candidates S e (degree t)).
Proof.
move=> d d_lt here; have [h h_link [he placed]] := end_known d_lt here.
move: h_link; rewrite mem_filter => /andP[/eqP same hU].
rewrite mem_sort mem_filter mem_undup -{4}same map_f // andbT; apply/and3P; split.
- by rewrite (em_doors em) ?vertex_lt // (degree_vertex em) // (em_doors em) //
    (same_vertex_degree here).
- apply: contra end_elsewhere => /eqP de; apply: same_vertex_trans here.
  by rewrite (same_vertex_known em) // de.
apply/hasP=> -[f _ /andP[/eqP fe]]; case ff': (other S f) => [f'|//] /eqP f'd.
have [f'_lt _ _] := wf_other wf ff'.
have fE : f = e.
  apply: no_parallel_known (other_known ff') e_lt fe _; rewrite -(em_other em ff').
  by apply: same_vertex_trans here; rewrite (same_vertex_known em) // f'd.
by move: eU; rewrite mem_unexplored -fE ff' andbF.
Qed.

Lemma candidates_known n : {in candidates S e n, forall v, v < size S /\ vertex S v = v}.
Proof.
move=> v; rewrite mem_sort mem_filter mem_undup => /andP[_ /mapP[d]].
by rewrite mem_unexplored => /andP[d_lt _] ->; rewrite vertex_lt // vertex_vertex.
Qed.

Lemma no_dart_there : enough_candidates t [::] -> forall d, d < size S -> place d <> t.
Proof.
by move=> none d d_lt placed; have := none d d_lt; rewrite placed => /(_ (same_vertex_refl _)).
Qed.

(** Place validation: a vertex that it reports as new is new; a marker that it finds is at the vertex
    where it was dropped. *)
Lemma validate_place_spec :
  always (handling W) (validate_place allowed S e (degree t)) (t, None)
    (fun came s _ =>
       match came with
       | NewPlace => (forall d, d < size S -> place d <> t) /\ s = (t, None)
       | KnownPlace p => found_well t p /\ s = (place p, Some t)
       end).
Proof.
rewrite /validate_place; have := candidates_enough; have := @candidates_known (degree t).
case: (candidates _ _ _) => [_ none|c C]; first by split=> //; apply: no_dart_there.
move: (c :: C) => {c}C known_C enough; do 2!split=> //=; first exact: degree_gt0.
have well : missed_well t e C by split=> //; apply: end_elsewhere.
rewrite traverse_opposite0.
apply: always_then (look_for_marker_spec (leqnn _) known_C well) _ => -[p|p C'] s k //.
case=> -[p_lt _ none] ->.
apply: always_then (travel_spec _ p_lt e_lt) _ => near _ _ [near_lt at_e ->] /=.
have [open_e ->] := leave_by near_lt e_lt at_e; rewrite same_vertex_refl; do 3!split=> //.
exact: no_dart_there.
Qed.

(** Back-link validation: the marker is behind the dart [h] that is the other end of [e] and, because
    there are no parallel edges, behind no other. *)
Lemma try_back_links_spec n p links (spot : W) h : size links <= n -> p < size S ->
  {in links, forall g, g < size S /\ vertex S g = vertex S p} ->
  same_vertex (place e) spot -> h \in links -> place h = t ->
  always (handling W) (try_back_links n S p links) (place p, Some spot)
    (fun found s _ => found = Some h /\ s = (place e, Some spot)).
Proof.
move=> size_l p_lt links_p here h_in placed.
have back : opposite (place h) = place e by rewrite placed /t oppositeK.
elim: n p links size_l p_lt links_p h_in => [|n IH] p links /=.
  by rewrite leqn0 => /nilP-> _ _.
case: links => // g0 links0; set links := g0 :: links0 => size_l p_lt links_p h_in.
split=> [|g g_in]; first exact: mem_head.
clearbody links; have [g_lt g_p] := links_p g g_in; have [h_lt h_p] := links_p h h_in.
have [open_g /= ->] := leave_by p_lt g_lt (esym g_p); split=> //; case: ifP => seen /=.
  suff -> : g = h by rewrite back.
  apply: no_parallel_known => //; first by rewrite g_p.
  by rewrite back; apply: same_vertex_trans seen _; rewrite same_vertex_sym.
split; first exact: degree_gt0.
rewrite traverse_opposite0; apply: IH => //.
- by rewrite size_rem // -subn1 leq_subLR.
- by move=> f /mem_rem/links_p[f_lt ->].
have := h_in; rewrite (perm_mem (perm_to_rem g_in)) inE => /predU1P[hg|//].
by rewrite -hg back here in seen.
Qed.

(** The right dart is found, the robot is where it believes it is, and carries the marker. *)
Definition linked_well (link : option (nat * nat)) (s : state (handling W)) :=
  exists h p, [/\ link = Some (h, p), h \in unexplored S, h != e, place h = t & p < size S /\ s = (place p, None)].

Lemma back_links_of p h : h \in back_links S (vertex S p) ->
  [/\ h < size S, vertex S h = vertex S p & h \in unexplored S].
Proof. by rewrite mem_filter mem_unexplored => /and3P[/eqP-> -> ->]. Qed.

Lemma find_back_link_spec p : p < size S -> same_vertex (place p) t ->
  always (handling W) (find_back_link allowed S p e (back_links S (vertex S p))) (place p, None)
    (fun link s _ => linked_well link s).
Proof.
move=> p_lt here; have [h h_in [he placed]] := end_known p_lt here.
apply: always_then (travel_spec _ p_lt e_lt) _ => near _ _ [near_lt at_e ->]; split=> //=.
apply: always_then (travel_spec _ near_lt p_lt) _ => far _ _ [far_lt at_p ->].
have e_near : same_vertex (place e) (place near) by rewrite (same_vertex_known em) // at_e.
have links_far : {in back_links S (vertex S p), forall g, g < size S /\ vertex S g = vertex S far}.
  by move=> g /back_links_of[g_lt -> _].
have tried := try_back_links_spec (leqnn _) far_lt links_far e_near h_in placed.
apply: always_then tried _ => _ _ _ [-> ->] /=; rewrite e_near; split=> //.
by have [_ _ hU] := back_links_of h_in; exists h, e.
Qed.

Lemma validate_back_link_spec p : p < size S -> same_vertex (place p) t ->
  always (handling W) (validate_back_link allowed S p e) (place p, Some t)
    (fun link s _ => linked_well link s).
Proof.
move=> p_lt here; split=> //=; rewrite here; have [h h_in [he placed]] := end_known p_lt here.
have [_ _ hU] := back_links_of h_in.
move: h_in (find_back_link_spec p_lt here); case: (back_links _ _) => // g [|g' links] //.
by rewrite inE => /eqP <- _; exists h, p.
Qed.

End OneRound.

(** * All rounds *)

(** A round explores one more edge: the map is still a part of the world, and the marker is in hand. *)
Lemma explore_edge_spec S (place : nat -> W) pose :
  embeds S place -> pose < size S -> unexplored S != [::] ->
  always (handling W) (explore_edge allowed S pose) (place pose, None)
    (fun after s _ => exists S' pose' (place' : nat -> W),
       [/\ after = Some (S', pose'), embeds S' place', pose' < size S', s = (place' pose', None)
         & (size S + size (unexplored S')).+2 = size S' + size (unexplored S)]).
Proof.
move=> em pose_lt some_left; split=> [|e /= eU]; first exact: mem_nearest.
have := eU; rewrite mem_unexplored => /andP[e_lt _].
apply: always_then (travel_spec em _ pose_lt e_lt) _ => near _ _ [near_lt at_e ->] /=.
have [open_e ->] := leave_by em near_lt e_lt at_e; split=> //.
apply: always_then (validate_place_spec em eU) _ => -[|p] s k.
  case=> new ->; do 3!eexists; split; [by [] | exact: (embeds_with_vertex em eU new) | | |].
  - by rewrite size_with_place ?degree_gt0 // -addn1 leq_add2l degree_gt0.
  - by rewrite /= ltnn subnn.
  exact: unexplored_with_place (degree_gt0 _).
case=> -[p_lt here] ->.
apply: always_then (validate_back_link_spec em eU p_lt here) _ => link s' k'.
case=> h [p' [-> hU he placed [p'_lt ->]]]; exists (with_edge S e h), p', place.
have := hU; rewrite mem_unexplored => /andP[h_lt _].
rewrite !size_with_edge //; split=> //; first exact: embeds_with_edge.
by rewrite (size_unexplored_with_edge eU hU he) !addnS.
Qed.

(** The answer is a map in which nothing is unexplored, and the robot is where it believes it is. *)
Definition explored_well (answer : option (partial_map * nat)) (s : state (handling W)) :=
  exists S p (place : nat -> W),
    [/\ answer = Some (S, p), embeds S place, unexplored S = [::], p < size S & s = (place p, None)].

(** As many rounds suffice as there are unexplored edges. *)
Lemma explore_edges_spec bound S (place : nat -> W) pose :
  embeds S place -> pose < size S -> 2 * edges W + size (unexplored S) <= size S + 2 * bound ->
  always (handling W) (explore_edges allowed bound S pose) (place pose, None)
    (fun answer s _ => explored_well answer s).
Proof.
elim: bound S place pose => [|bound IH] S place pose em pose_lt enough.
  have none : unexplored S = [::] by have known := size_known em; apply: size0nil; arithmetic.
  by rewrite /= none; exists S, pose, place.
rewrite /explore_edges -/explore_edges; case UE: (unexplored S) => [|d U].
  by exists S, pose, place.
have some_left : unexplored S != [::] by rewrite UE.
apply: always_then (explore_edge_spec em pose_lt some_left) _ => after s k.
case=> S' [pose' [place' [-> em' pose'_lt -> sizes]]].
by apply: IH => //; arithmetic.
Qed.

(** With any limit the rounds end with such a map, or without an answer. *)
Lemma explore_edges_sound bound S (place : nat -> W) pose : embeds S place -> pose < size S ->
  always (handling W) (explore_edges allowed bound S pose) (place pose, None)
    (fun answer s _ => (answer = None /\ s.2 = None) \/ explored_well answer s).
Proof.
elim: bound S place pose => [|bound IH] S place pose em pose_lt.
  by rewrite /=; case UE: (unexplored S) => [|d U]; [right; exists S, pose, place | left].
rewrite /explore_edges -/explore_edges; case UE: (unexplored S) => [|d U].
  by right; exists S, pose, place.
have some_left : unexplored S != [::] by rewrite UE.
apply: always_then (explore_edge_spec em pose_lt some_left) _ => after s k.
by case=> S' [pose' [place' [-> em' pose'_lt -> _]]]; apply: IH.
Qed.

Let begin := first_state (handling W).

(** From the place of the marker, the algorithm ends with a map of the whole world. The robot is where it
    believes it is, with the marker in hand. *)
Lemma movable_spec bound : edges W <= bound ->
  always (handling W) (movable allowed bound (sense begin)) begin (fun answer s _ => explored_well answer s).
Proof.
move=> enough; split; first exact: same_vertex_refl.
rewrite /= same_vertex_refl.
apply: (explore_edges_spec (embeds_at_start W) (pose := 0)); rewrite size_with_vertex ?degree_gt0 //.
by rewrite unexplored_at_start size_iota; arithmetic.
Qed.

(** The same for the world that the map describes. *)
Lemma explored_well_right answer s : explored_well answer s -> s.2 = None /\ right_answer answer s.1.
Proof.
case=> S [p [place [-> em explored p_lt ->]]]; split=> //.
by have [map drawn_map iso] := drawn_isomorphic em explored p_lt; exists S, p, map.
Qed.

Lemma movable_marker_correct bound : edges W <= bound ->
  always (handling W) (movable allowed bound (sense begin)) begin
    (fun answer s _ => s.2 = None /\ right_answer answer s.1).
Proof. by move/movable_spec; apply: alwaysW => answer s _; apply: explored_well_right. Qed.

(** With any limit on rounds, it answers nothing or rightly. *)
Lemma movable_marker_sound bound :
  always (handling W) (movable allowed bound (sense begin)) begin
    (fun answer s _ => s.2 = None /\ (answer = None \/ right_answer answer s.1)).
Proof.
split; first exact: same_vertex_refl.
have some_known : 0 < size (with_vertex [::] (degree (facing W))) by rewrite size_with_vertex degree_gt0.
rewrite /= same_vertex_refl.
apply: alwaysW (explore_edges_sound bound (embeds_at_start W) some_known) => answer s _.
by case=> [[-> ->]|/explored_well_right[-> right]]; split=> //; [left | right].
Qed.

End Correct.
