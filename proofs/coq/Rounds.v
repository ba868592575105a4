(** One round of Algorithm 1, and all rounds, for any choices. Section 2.3, lines 4 to 23. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Walks Arithmetic Always Maps Paths Embedding.
From toposlam Require Import Validation.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Rounds.

Variable test : hypothesis_test.
Hypothesis test_valid : valid test.

Variable allowed : partial_map -> seq nat -> bool.

(** The allowed paths include the short ones, so that there is always one. *)
Hypothesis allowed_short : forall S path, size path < known_vertices S -> allowed S path.

Variable W : start.

Lemma size_doors_along S pose path : size (doors_along S pose path) = size path.
Proof. by elim: path pose => //= d path IH pose; rewrite IH. Qed.

Section OneRound.

Variables (S : partial_map) (place : nat -> W).
Hypothesis em : embeds S place.

Let wf := em_wf em.

(** The greatest length of an allowed path. *)
Definition longest B := forall path, allowed S path -> size path <= B.

(** Lines 8 to 17, for a robot that came to [t]. *)
Lemma try_all_spec (t : W) n turned H :
  size H = n -> {subset H <= unexplored S} -> turned < degree t ->
  always (moving directional W) (try_all test allowed n S (perceive directional t) turned H) (turn t turned)
    (fun became r k =>
       (forall B, longest B -> k <= n * (2 * B)) /\
       match became with
       | Loop h pose => [/\ h \in H, place h = t, pose < size S & r = place pose]
       | New i => [/\ r = turn t i, i < degree t & forall h, h \in H -> place h <> t]
       end).
Proof.
elim: n turned H => [|n IH] turned H /=; first by move/size0nil=> -> _ lt /=; split.
case: H => // h0 H0; set H := h0 :: H0 => sizeH sub turned_lt; split.
  exact: mem_nearest.
move=> h inH; have := sub h inH; rewrite mem_unexplored => /andP[h_lt _].
have v_lt := vertex_lt wf h_lt; split.
  rewrite /= to_root_leads ?wf_first ?wf_some //=.
  by apply/allowed_short/to_root_short; rewrite ?wf_first ?wf_some.
move=> path /andP[path_ok path_allowed]; apply: always_bind.
apply: alwaysW (validate_spec em test_valid h_lt path_ok turned_lt).
case=> [pose|i] r k [].
  move=> placed pose_lt -> k_le /=; rewrite addn0; split=> // B /(_ path path_allowed) le.
  by rewrite mulSn mul2n -addnn -addnA; apply: leq_trans k_le (leq_trans le (leq_addr _ _)).
move=> wrong -> i_lt k_le.
have rest_sub : {subset rem h H <= unexplored S} by move=> g /mem_rem/sub.
have rest_size : size (rem h H) = n by rewrite size_rem // sizeH.
apply: alwaysW (IH i _ rest_size rest_sub i_lt) => became r' l [bound came]; split.
  move=> B longest; have le := longest path path_allowed; have := bound B longest.
  by move=> l_le; rewrite mulSn; apply: leq_add l_le; apply: leq_trans k_le _; rewrite leq_mul2l.
case: became came {bound} => [g pose|j] [].
  by move/mem_rem.
move=> -> j_lt none; split=> // g.
by rewrite (perm_mem (perm_to_rem inH)) inE => /predU1P[-> //|/none].
Qed.

(** If the opposite of an unexplored dart is known, it is unexplored too, and is another dart. *)
Lemma unexplored_opposite e d : e \in unexplored S -> d < size S ->
  place d = opposite (place e) -> (d \in unexplored S) && (d != e).
Proof.
rewrite !mem_unexplored => /andP[e_lt /eqP e_free] d_lt placed; rewrite d_lt /=.
apply/andP; split; last first.
  by apply/eqP=> de; have := opposite_neq (place e); rewrite -placed de eqxx.
case dd': (other S d) => [d'|//].
have [d'_lt _ back] := wf_other wf dd'.
have /(em_inj em d'_lt e_lt) d'e : place d' = place e.
  by rewrite (em_other em dd') placed oppositeK.
by rewrite d'e e_free in back.
Qed.

End OneRound.

(** An edge between known vertices is added. *)
Lemma embeds_with_edge S place e h :
  embeds S place -> e \in unexplored S -> h \in unexplored S -> h != e ->
  place h = opposite (place e) -> @embeds (with_edge S e h) W place.
Proof.
move=> em eU hU he placed; have wf := em_wf em.
have := eU; rewrite mem_unexplored => /andP[e_lt _].
have := hU; rewrite mem_unexplored => /andP[h_lt _].
split; rewrite ?size_with_edge //; first exact: well_formed_with_edge.
- exact: em_facing em.
- exact: em_inj em.
- by move=> d lt; rewrite doors_with_edge; apply: em_doors em d lt.
- by move=> d lt; rewrite vertex_with_edge; apply: em_turn em d lt.
- move=> d d'; rewrite other_with_edge; case: eqP => [->|_].
    by case=> <-; rewrite placed oppositeK.
  by case: eqP => [->|_]; [case=> <- | apply: em_other em d d'].
Qed.

(** A new vertex is added. *)
Lemma embeds_with_vertex S place e :
  embeds S place -> e \in unexplored S ->
  let t := opposite (place e) in
  (forall d, d < size S -> place d <> t) ->
  @embeds (with_edge (with_vertex S (degree t)) e (size S)) W
    (fun d => if d < size S then place d else turn t (d - size S)).
Proof.
move=> em eU t new; have wf := em_wf em.
have := eU; rewrite mem_unexplored => /andP[e_lt _].
set T := with_vertex S (degree t); have szT : size T = size S + degree t := size_with_vertex _ _.
have e_ltT : e < size T by rewrite szT ltn_addr.
have s_ltT : size S < size T by rewrite szT -[X in X < _]addn0 ltn_add2l degree_gt0.
have parts d : d < size T -> d < size S \/ size S <= d < size S + degree t.
  by rewrite szT => lt; case: (ltnP d (size S)); [left | right].
have old_new d i : d < size S -> place d <> turn t i.
  move=> lt placed; have [d' [d'_lt _]] := turn_known em (inverse_door (degree t) i) lt.
  by rewrite placed inverse_doorK => /new; apply.
split; rewrite ?size_with_edge //; first exact: (well_formed_with_vertex wf eU (degree_gt0 t)).
- by rewrite (wf_some wf); apply: em_facing em.
- move=> d d' /parts[lt|/andP[ge lt]] /parts[lt'|/andP[ge' lt']].
  + by rewrite lt lt'; apply: em_inj em d d' lt lt'.
  + by rewrite lt ltnNge ge' /= => /(old_new _ _ lt).
  + by rewrite lt' ltnNge ge /= => /esym/(old_new _ _ lt').
  rewrite !ltnNge ge ge' /= => same.
  have : d - size S = d' - size S.
    have small x : size S <= x -> x < size S + degree t -> x - size S < degree t.
      by move=> ? ?; rewrite ltn_subLR.
    by rewrite -(findex_iter (small d ge lt)) -(findex_iter (small d' ge' lt')) -!/(turn _ _) same.
  by move/(congr1 (addn^~ (size S))); rewrite /= !subnK.
- move=> d /parts[lt|range]; rewrite doors_with_edge.
    by have [_ -> _] := old_with_vertex (degree t) lt; rewrite lt; apply: em_doors em d lt.
  have [_ -> _] := new_with_vertex range; case/andP: range => ge _.
  by rewrite ltnNge ge degree_turn.
- move=> d /parts[lt|range]; rewrite vertex_with_edge.
    have [-> _ _] := old_with_vertex (degree t) lt.
    by rewrite lt (vertex_lt wf lt); apply: em_turn em d lt.
  have [-> _ _] := new_with_vertex range; case/andP: range => ge _.
  by rewrite ltnn subnn ltnNge ge.
- move=> d d'; rewrite other_with_edge; case: eqP => [->|_].
    by case=> <-; rewrite ltnn subnn e_lt /t oppositeK.
  case: eqP => [->|_]; first by case=> <-; rewrite ltnn subnn e_lt.
  move=> dd'; have /parts[lt|range] := other_known dd'; last first.
    by have [_ _] := new_with_vertex range; rewrite -/T dd'.
  move: dd'; have [_ _ ->] := old_with_vertex (degree t) lt => dd'.
  by have [lt' _ _] := wf_other wf dd'; rewrite lt lt'; apply: em_other em d d' dd'.
Qed.

(** Lines 5 to 23: a round explores one more edge, and the map is still a part of the world. *)
Lemma explore_spec S place pose :
  embeds S place -> pose < size S -> unexplored S != [::] ->
  always (moving directional W) (explore test allowed S pose) (place pose)
    (fun after r k =>
       (exists place' : nat -> W,
          [/\ embeds after.1 place', after.2 < size after.1, r = place' after.2
            & (size S + size (unexplored after.1)).+2 = size after.1 + size (unexplored S)]) /\
       forall B, longest S B -> k <= B + 1 + (size (unexplored S)).-1 * (2 * B)).
Proof.
move=> em pose_lt some; have wf := em_wf em; split; first exact: mem_nearest.
move=> e /= eU; have := eU; rewrite mem_unexplored => /andP[e_lt _].
have root_lt := vertex_lt wf pose_lt; have root := vertex_vertex wf pose_lt; split.
  by rewrite from_root_leads //=; apply/allowed_short/from_root_short.
move=> path /andP[path_ok path_allowed].
have [lt at_e walked open_doors] := walk_known em pose_lt path_ok.
apply: always_moves_bind => //; rewrite {}walked; set near := pose_behind S pose path in lt at_e *.
rewrite /= -/near; split; first by rewrite -(em_doors em lt) (door_to_lt em).
have -> : traverse (place near) (door_to S near e) = opposite (place e).
  by rewrite /traverse (turn_door_to em).
set t := opposite (place e); set H := [seq h <- _ | _].
have inH h : (h \in H) = [&& h != e, raised test S h (perceive directional t) & h \in unexplored S].
  by rewrite mem_filter andbA.
apply: always_bind.
have sub : {subset H <= unexplored S} by move=> h; rewrite inH => /and3P[].
have := try_all_spec em (erefl (size H)) sub (degree_gt0 t).
apply: alwaysW => became r k [cost came].
have sizeH : size H <= (size (unexplored S)).-1.
  rewrite -(size_rem eU); apply: uniq_leq_size => [|h]; first by rewrite !filter_uniq ?iota_uniq.
  by rewrite inH (mem_rem_uniq _ (filter_uniq _ (iota_uniq _ _))) inE => /and3P[he _ hU]; rewrite he.
have total B : longest S B ->
    size (doors_along S pose path) + (k + 0).+1 <= B + 1 + (size (unexplored S)).-1 * (2 * B).
  move=> longest; rewrite size_doors_along addn0.
  have := longest path path_allowed; have := cost B longest.
  by have := leq_mul sizeH (leqnn (2 * B)); move=> *; arithmetic.
case: became came {cost} => [h pose'|i] [].
  move=> hH placed pose'_lt ->; have hU := sub h hH; split=> //; exists place => /=.
  have he : h != e by move: hH; rewrite inH => /andP[].
  have := hU; rewrite mem_unexplored => /andP[h_lt _].
  split=> //; rewrite ?size_with_edge //; first exact: embeds_with_edge.
  by rewrite (size_unexplored_with_edge eU hU he) addnS addnS.
move=> -> i_lt none /=.
have new d : d < size S -> place d <> t.
  move=> d_lt placed; have /andP[dU de] := unexplored_opposite em eU d_lt placed.
  by case: (none d) => //; rewrite inH de dU -placed -(expectedE em) // raises_expected.
split=> //; eexists; split; first exact: embeds_with_vertex.
- by rewrite /= size_with_place ?degree_gt0 // ltn_add2l.
- by rewrite /= ltnNge leq_addr /= addKn.
exact: unexplored_with_place (degree_gt0 _).
Qed.

End Rounds.
