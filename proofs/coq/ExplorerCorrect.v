(** The folding explorer maps every world, whatever its choices. Beyond Section 2.3. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Folding FoldingExplorer Walks Arithmetic Always Parts Maps Paths
  Embedding Complete Rounds Correct FoldedVisits.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Explorer.

Variables (allowed : nat -> nat -> bool) (patience : partial_map -> nat).
Hypothesis allowed_short : forall k l, k <= l -> allowed k l.

Variable W : start.

(** What the robot believes is true: [place] maps the darts of its map to darts of the world, [spots] are the poses
    of the visits, and [q] is its pose. *)
Record believes (K : knowledge) (place : nat -> W) (spots : seq W) (q : W) : Prop := Believes {
  be_map : embeds (known_map K) place;
  be_explains : explains (trail K) spots;
  be_classes : right_classes (trail K) spots (folding K);
  be_size : size (in_trail K) = size (known_map K);
  be_in_trail : forall d, d < size (known_map K) ->
    (dart_in_trail K d).1 < size (trail K) /\ image spots (dart_in_trail K d) = place d;
  be_far : forall e x, (e, x) \in far_ends K ->
    [/\ e < size (known_map K), x.1 < size (trail K) & image spots x = opposite (place e)];
  be_far_uniq : uniq (unzip1 (far_ends K));
  be_refuted : forall i j, (i, j) \in refuted K ->
    [/\ i < j, j < size (known_map K) & place i <> opposite (place j)];
  be_refuted_uniq : uniq (refuted K);
  be_here : (here K).1 < size (trail K) /\ image spots (here K) = q;
  be_base : base K < size (known_map K);
  be_strayed : strayed K = taken (place (base K)) (unzip1 (strayed K));
  be_pose : q = walk (place (base K)) (unzip1 (strayed K));
  be_made : size (strayed K) <= made K;
  be_visits : size (trail K) <= (made K).+1
}.

(** What moves alone do not change. *)
Definition kept (K K' : knowledge) :=
  [/\ known_map K' = known_map K, far_ends K' = far_ends K & refuted K' = refuted K].

Section Known.

Variables (K : knowledge) (place : nat -> W) (spots : seq W) (q : W).
Hypothesis be : believes K place spots q.

Let S := known_map K.
Let em : embeds S place := be_map be.
Let wf := em_wf em.

Lemma far_endP e x : far_end K e = Some x ->
  [/\ e < size S, x.1 < size (trail K) & image spots x = opposite (place e)].
Proof.
rewrite /far_end; case found: [seq _ | _ <- _ & _] => [|y s] // [yx]; apply: (be_far be).
have : y \in [seq z.2 | z <- far_ends K & z.1 == e] by rewrite found mem_head.
by case/mapP=> -[e' x']; rewrite mem_filter -yx => /andP[/= /eqP-> in_far] ->.
Qed.

Lemma far_end_none e : far_end K e = None -> e \notin unzip1 (far_ends K).
Proof.
rewrite /far_end => none; apply/mapP=> -[[e' x] in_far /= eE]; move: none; rewrite eE.
by case found: [seq _ | _ <- _ & _] => [|//] _;
   have : x \in [seq z.2 | z <- far_ends K & z.1 == e'];
   [apply/mapP; exists (e', x); rewrite // mem_filter /= eqxx | rewrite found].
Qed.

Lemma turned_right d i : d < size S ->
  [/\ turned K d i < size S, vertex S (turned K d i) = vertex S d & place (turned K d i) = turn (place d) i].
Proof.
move=> lt; have [bounds out] := wf_bounds wf lt; case/andP: (bounds) => le lt_d.
rewrite /turned -/S; set e := vertex S d + _.
have near : vertex S d <= e < vertex S d + doors S d.
  by rewrite leq_addr ltn_add2l ltn_pmod ?(doors_gt0 em).
have e_lt : e < size S by case/andP: near => _ e_lt; apply: leq_trans e_lt out.
have [same _] := wf_same wf lt near; split=> //.
rewrite (em_turn em e_lt) same (em_turn em lt) -turn_add addKn.
by rewrite -(degree_vertex em) // turn_mod.
Qed.

Lemma pose_at_base_right :
  pose_at_base K < size S /\ walk q (way_back (strayed K)) = place (pose_at_base K).
Proof.
have := retrace_walk (place (base K)) (unzip1 (strayed K)); rewrite -(be_strayed be) -(be_pose be) => ->.
have base_lt := be_base be; rewrite /pose_at_base; case: (strayed K) => [|step others] //=.
by have [lt _ ->] := turned_right step.1 base_lt.
Qed.

Lemma size_way_back steps : size (way_back steps) = size steps.
Proof. by case: steps => //= step steps; rewrite size_rev size_map. Qed.

Lemma passable_cat (G : embedded_graph) (p : G) ds es :
  passable p (ds ++ es) = passable p ds && passable (walk p ds) es.
Proof. by elim: ds p => //= i ds IH p; rewrite IH andbA. Qed.

Lemma doors_by_right w e front last : e < size S -> doors_by K w e = Some (front, last) ->
  [/\ walk q (rcons front last) = opposite (place e), passable q (rcons front last)
    & size front = way_moves K w].
Proof.
move=> e_lt; case: w => [path|way] /=.
  case: ifP => // path_ok [<- <-]; have [lt back] := pose_at_base_right.
  have [lt' at_e walked open_doors] := walk_known em lt path_ok.
  rewrite walk_rcons passable_rcons walk_cat passable_cat back walked open_doors andbT.
  have -> : passable q (way_back (strayed K)).
    by rewrite (be_pose be) [in way_back _](be_strayed be) way_back_passable.
  rewrite /= -(em_doors em lt') (door_to_lt em) // size_cat size_way_back size_doors_along.
  by split=> //; rewrite /traverse (turn_door_to em lt' e_lt at_e).
case found: doors_through => [[steps step]|//] [<- <-].
have [here_lt hereE] := be_here be; have [at_lt atE] := be_in_trail be e_lt.
have := doors_through_right (be_explains be) (be_classes be) here_lt at_lt found.
by rewrite hereE atE /unzip1 map_rcons size_map => -[].
Qed.

(** The robot goes out by a dart of the trail. *)
Lemma arrived_believes x q' base' strayed' k :
  x.1 < size (trail K) -> q' = opposite (image spots x) -> base' < size S ->
  strayed' = taken (place base') (unzip1 strayed') -> q' = walk (place base') (unzip1 strayed') ->
  size strayed' <= made K + k -> 0 < k ->
  believes (arrived K x (perceive directional q') base' strayed' k) place (rcons spots q') q'.
Proof.
move=> x_lt q'E base_lt took at_q' short some.
have ex := be_explains be; have imageE := image_rcons ex q'.
split=> //=; rewrite ?size_rcons.
- exact: explains_rcons.
- by have := arrived_right ex x_lt q'E base' strayed' k (erefl (trail K)) (be_classes be); rewrite /= size_rcons.
- exact: be_size be.
- move=> d lt; have [at_lt atE] := be_in_trail be lt; rewrite -[dart_in_trail _ d]/(dart_in_trail K d).
  by rewrite imageE // atE leqW.
- by move=> e y /(be_far be)[e_lt y_lt yE]; rewrite imageE // yE leqW.
- exact: be_far_uniq be.
- exact: be_refuted be.
- exact: be_refuted_uniq be.
- by rewrite (image_new ex).
by rewrite ltnS; apply: leq_trans (be_visits be) _; rewrite -addn1 leq_add2l.
Qed.

(** Ways through the map. *)
Lemma default_way e : e < size S -> doors_by K (way_home K e) e != None.
Proof.
move=> e_lt; rewrite /way_home /= -/S; have [lt _] := pose_at_base_right.
have root_lt := vertex_lt wf lt; have root := vertex_idem wf lt.
by rewrite from_root_leads.
Qed.

Lemma way_home_moves e : e < size S -> way_moves K (way_home K e) < size (strayed K) + vertices W.
Proof.
move=> e_lt; rewrite /= ltn_add2l; have [lt _] := pose_at_base_right.
have root_lt := vertex_lt wf lt; have root := vertex_idem wf lt.
apply: leq_trans (known_vertices_le em); exact: from_root_short.
Qed.

Lemma default_path h : h < size S -> allowed_path allowed S h (to_root S (tree_from S 0) (vertex S h)).
Proof.
move=> h_lt; rewrite /allowed_path allowed_short // andbT.
by apply: to_root_leads; rewrite ?(wf_first wf) ?(wf_some wf).
Qed.

Lemma path_moves h : h < size S -> size (to_root S (tree_from S 0) (vertex S h)) < vertices W.
Proof.
move=> h_lt; apply: leq_trans (known_vertices_le em).
by apply: to_root_short; rewrite ?(wf_first wf) ?(wf_some wf).
Qed.

(** ** Conclusions *)

Lemma same_image x y : x.1 < size (trail K) -> y.1 < size (trail K) -> stands_for K x = stands_for K y ->
  image spots x = image spots y.
Proof.
move=> x_lt y_lt same; have right := be_classes be.
have [_ <- _] := standing_for_right (be_explains be) right x_lt.
by have [_ <- _] := standing_for_right (be_explains be) right y_lt; rewrite -/(stands_for K _) same.
Qed.

Lemma contradicts_right x h : h < size S -> x.1 < size (trail K) -> contradicts K x h -> image spots x <> place h.
Proof.
move=> h_lt x_lt contra same; have [at_lt atE] := be_in_trail be h_lt.
have [f folded_f right] := fold_with_right (be_explains be) (be_classes be) x_lt at_lt (etrans same (esym atE)).
move: contra; rewrite /contradicts folded_f => /negP; apply; rewrite map_inj_in_uniq ?filter_uniq ?iota_uniq //.
move=> d e; rewrite !mem_filter !mem_iota => /andP[/eqP d_first d_lt] /andP[/eqP e_first e_lt] same_root.
rewrite -d_first -e_first; apply/eqP; rewrite -(same_vertex_known em d_lt e_lt).
have [d_at <-] := be_in_trail be d_lt; have [e_at <-] := be_in_trail be e_lt.
have [_ <- _] := standing_for_right (be_explains be) right d_at.
have [_ <- _] := standing_for_right (be_explains be) right e_at.
rewrite /image same_root; apply: same_vertex_trans (same_vertex_turn _ _).
by rewrite same_vertex_sym same_vertex_turn.
Qed.

Lemma confirms_right far h x entry : h < size S -> entry < size S -> far.1 < size (trail K) ->
  x.1 < size (trail K) -> confirms K far h x entry -> place entry = opposite (image spots x) ->
  image spots far = place h.
Proof.
move=> h_lt entry_lt far_lt x_lt /hasP[p /(mem_passages (be_explains be)) ok /andP[/eqP same proves]] enters.
have [from_lt to_lt edgeE] := passage_ends (be_explains be) ok.
have [entry_at entryE] := be_in_trail be entry_lt; have [h_at hE] := be_in_trail be h_lt.
have x_to : image spots x = image spots (to_dart (trail K) p).
  by rewrite edgeE (same_image from_lt entry_at same) entryE enters opposite_involutive.
have [f folded_f right] := fold_with_right (be_explains be) (be_classes be) x_lt to_lt x_to.
move: proves; rewrite folded_f => /eqP same_f.
have [_ <- _] := standing_for_right (be_explains be) right far_lt; rewrite same_f.
by have [_ -> _] := standing_for_right (be_explains be) right h_at.
Qed.

Lemma predicts_right far h x entry : h < size S -> entry < size S -> far.1 < size (trail K) ->
  x.1 < size (trail K) -> predicts K far h x entry -> image spots far = place h ->
  place entry = opposite (image spots x).
Proof.
move=> h_lt entry_lt far_lt x_lt proves same.
have [entry_at entryE] := be_in_trail be entry_lt; have [h_at hE] := be_in_trail be h_lt.
have [f folded_f right] := fold_with_right (be_explains be) (be_classes be) far_lt h_at (etrans same (esym hE)).
move: proves; rewrite /predicts folded_f => /hasP[p /(mem_passages (be_explains be)) ok /andP[/eqP out /eqP enters]].
have [from_lt to_lt edgeE] := passage_ends (be_explains be) ok.
have one y z : y.1 < size (trail K) -> z.1 < size (trail K) ->
    standing_for (trail K) f y = standing_for (trail K) f z -> image spots y = image spots z.
  move=> y_lt z_lt yz; have [_ <- _] := standing_for_right (be_explains be) right y_lt; rewrite yz.
  by have [_ -> _] := standing_for_right (be_explains be) right z_lt.
by rewrite -entryE -(one _ _ to_lt entry_at enters) edgeE (one _ _ from_lt x_lt out).
Qed.

(** The far end of an edge is a dart of the map. *)
Lemma with_loop_believes e h : e \in unexplored S -> h \in unexplored S -> place h = opposite (place e) ->
  believes (with_loop K e h) place spots q /\
  size (unexplored S) = (size (unexplored (known_map (with_loop K e h)))).+2.
Proof.
move=> eU hU placed; have he : h != e.
  by apply/eqP=> same; have := opposite_moves (place e); rewrite -placed same eqxx.
have := eU; rewrite mem_unexplored => /andP[e_lt _]; have := hU; rewrite mem_unexplored => /andP[h_lt _].
split; last exact: size_unexplored_with_edge.
have sz : size (with_edge S e h) = size S := size_with_edge e_lt h_lt.
by case: be => *; split; rewrite //= -?/S ?sz //; apply: embeds_with_edge.
Qed.

Lemma refuted_right e h : e < size S -> h < size S -> is_refuted K e h -> place h <> opposite (place e).
Proof.
move=> e_lt h_lt /(be_refuted be)[_ _ differ] same; apply: differ; rewrite /minn /maxn.
by case: ifP => _; rewrite same ?opposite_involutive.
Qed.

Lemma with_place_believes e x : e \in unexplored S -> far_end K e = Some x ->
  all (fun h => [|| h == e, is_refuted K e h | contradicts K x h]) (unexplored S) ->
  exists2 place', believes (with_place K e x) place' spots q
  & (size S + size (unexplored (known_map (with_place K e x)))).+2 =
    size (known_map (with_place K e x)) + size (unexplored S).
Proof.
move=> eU far_e /allP none; have [e_lt x_lt xE] := far_endP far_e; set t := opposite (place e) in xE.
have degE : (perceived (trail K) x.1).1 = degree t.
  by rewrite (ex_seen (be_explains be) x_lt) -xE degree_turn.
have new d : d < size S -> place d <> t.
  move=> d_lt placed; have /andP[dU de] := unexplored_opposite em eU d_lt placed.
  case/or3P: (none d dU) => [|ref|contra]; first by rewrite (negPf de).
    by have := refuted_right e_lt d_lt ref; rewrite placed.
  by have := contradicts_right d_lt x_lt contra; rewrite xE placed.
have em' := embeds_with_vertex em eU new; set place' := fun d => _ in em'.
have sz : size (with_edge (with_vertex S (degree t)) e (size S)) = size S + degree t.
  by rewrite size_with_place ?degree_gt0.
have old d : d < size S -> place' d = place d by rewrite /place' => ->.
exists place'; last first.
  by rewrite /= -/S degE; apply: unexplored_with_place (degree_gt0 t).
have base_lt := be_base be.
split; rewrite /= -?/S ?degE ?sz ?old //; try by case: be.
- by rewrite size_cat size_map size_iota (be_size be).
- move=> d; rewrite /dart_in_trail /= degE nth_cat (be_size be) -/S; case: (ltnP d (size S)) => [lt _|ge lt].
    by rewrite old //; apply: (be_in_trail be).
  have lt' : d - size S < degree t by rewrite ltn_subLR.
  rewrite (nth_map 0) ?size_iota // nth_iota // add0n /=; split=> //.
  by rewrite /place' ltnNge ge /= -[opposite (place e)]/t -xE /image /= turn_add.
- move=> e' x' /(be_far be)[e'_lt x'_lt ->]; rewrite old //.
  by split=> //; apply: leq_trans e'_lt (leq_addr _ _).
- move=> i j /(be_refuted be)[ij j_lt differ]; rewrite !old //; last exact: ltn_trans ij j_lt.
  by split=> //; apply: leq_trans j_lt (leq_addr _ _).
exact: leq_trans base_lt (leq_addr _ _).
Qed.

End Known.

Arguments far_endP {K place spots q} be {e x}.
Arguments turned_right {K place spots q} be {d} i.
Arguments default_way {K place spots q} be {e}.
Arguments way_home_moves {K place spots q} be {e}.
Arguments default_path {K place spots q} be {h}.
Arguments path_moves {K place spots q} be {h}.
Arguments same_image {K place spots q} be {x y}.
Arguments confirms_right {K place spots q} be {far h x entry}.
Arguments predicts_right {K place spots q} be {far h x entry}.
Arguments with_loop_believes {K place spots q} be {e h}.
Arguments with_place_believes {K place spots q} be {e x}.

(** * Walks *)

(** It goes to a dart of the map and over its edge. *)
Lemma go_over_spec K place spots q w e :
  believes K place spots q -> e < size (known_map K) -> doors_by K w e != None ->
  always directional (go_over K w e) q
    (fun after r k => exists spots',
       [/\ believes after.1 place spots' r, kept K after.1, after.2 = perceive directional r,
           r = opposite (place e) & [/\ k = (way_moves K w).+1, made after.1 = made K + k & size (strayed after.1) = 1]]).
Proof.
move=> be e_lt; rewrite /go_over; case found: doors_by => [[front last]|//] _ /=.
have [walked open_doors sizes] := doors_by_right be e_lt found.
move: walked open_doors; rewrite walk_rcons passable_rcons => walked /andP[open_front open_last].
apply: always_moves_bind => //=; rewrite walked; split=> //.
have [at_lt atE] := be_in_trail be e_lt; exists (rcons spots (opposite (place e))); split=> //.
  apply: (arrived_believes be) => //=; rewrite ?atE //; last by rewrite addnS.
    by rewrite (em_doors (be_map be) e_lt).
by rewrite /= -sizes addn1.
Qed.

(** It goes along edges of the trail and out by a dart of it. *)
Lemma go_through_spec K place spots q way x :
  believes K place spots q -> x.1 < size (trail K) ->
  doors_through (trail K) (folding K) (here K) way x != None ->
  always directional (go_through K way x) q
    (fun after r k => exists spots',
       [/\ believes after.1 place spots' r, kept K after.1, after.2 = perceive directional r,
           r = opposite (image spots x) & k = (size way).+1 /\ made after.1 = made K + k]).
Proof.
move=> be x_lt; rewrite /go_through; case found: doors_through => [[front last]|//] _ /=.
have [here_lt hereE] := be_here be.
have := doors_through_right (be_explains be) (be_classes be) here_lt x_lt found; rewrite hereE /= => -[].
rewrite /unzip1 map_rcons walk_rcons passable_rcons -/unzip1 => walked /andP[open_front open_last] took sizes.
apply: always_moves_bind => //=; rewrite walked; split=> //.
have strayedE : unzip1 (rcons (strayed K ++ front) last) = unzip1 (strayed K) ++ rcons (unzip1 front) last.1.
  by rewrite /unzip1 map_rcons map_cat rcons_cat.
exists (rcons spots (opposite (image spots x))); split=> //; last by rewrite size_map sizes addn1.
apply: (arrived_believes be) => //.
- exact: be_base be.
- by rewrite strayedE taken_cat -(be_strayed be) -(be_pose be) took rcons_cat.
- by rewrite strayedE walk_cat -(be_pose be) walk_rcons walked.
by rewrite size_rcons size_cat addnS ltnS leq_add2r (be_made be).
Qed.

Lemma kept_trans K K' K'' : kept K K' -> kept K' K'' -> kept K K''.
Proof. by move=> [m f r] [m' f' r']; split; [rewrite m' | rewrite f' | rewrite r']. Qed.

(** It walks to the marker as if it had come in by a dart of the map: it comes there as expected exactly if it
    had. *)
Lemma try_spec K place spots q pose seen darts :
  believes K place spots q -> pose < size (known_map K) ->
  leads (known_map K) (vertex (known_map K) pose) darts 0 -> seen = perceive directional q ->
  always directional (try K pose seen darts) q
    (fun ended r k => exists spots',
       [/\ believes ended.1 place spots' r, kept K ended.1, k <= size darts, made ended.1 = made K + k
         & size (strayed ended.1) = size (strayed K) + k /\
           match ended.2 with
           | Some pose' => [/\ place pose = q, pose' < size (known_map K) & place pose' = r]
           | None => place pose <> q
           end]).
Proof.
elim: darts K spots q pose seen => [|d darts IH] K spots q pose seen be lt path seenE; have em := be_map be.
  rewrite /=; case: eqP => [fits|unlike] /=; exists spots; rewrite !addn0; split=> //; split=> //.
    have at_q : place pose = q.
      by apply: (sighting_tells_pose em lt); [apply/eqP | rewrite -seenE].
    by split.
  by move=> at_q; apply: unlike; rewrite (expected_is_perceived em) // at_q.
move: path => /=; case/andP=> /eqP same; case dd': (other _ d) => [d'|//] /= path.
case: eqP => [fits|unlike] /=; last first.
  exists spots; rewrite !addn0; split=> //; split=> // at_q.
  by apply: unlike; rewrite (expected_is_perceived em) // at_q.
have [d'_lt _ _] := wf_other (em_wf em) dd'; set i := door_to _ pose d.
have degE : seen.1 = degree q by rewrite seenE.
have i_lt : i < degree q.
  have -> : degree q = doors (known_map K) pose by rewrite -degE fits.
  exact: (door_to_lt em).
split=> //; have [here_lt hereE] := be_here be.
set q' := traverse q i; set K' := arrived _ _ _ _ _ _.
have be' : believes K' place (rcons spots q') q'.
  apply: (arrived_believes be) => //.
  - by rewrite /q' /traverse -hereE /image /= turn_add.
  - exact: be_base be.
  - by rewrite /unzip1 map_rcons taken_rcons -/unzip1 -(be_strayed be) -(be_pose be) degE.
  - by rewrite /unzip1 map_rcons walk_rcons -/unzip1 -(be_pose be).
  by rewrite size_rcons addn1 ltnS (be_made be).
apply: always_weaken (IH K' _ q' d' _ be' d'_lt path (erefl _)).
move=> [K'' came] r k [spots' [be'' kept' k_le madeE [strayedE result]]]; exists spots'; split=> //.
- by rewrite madeE /= addnAC -addnA addn1 addnS.
split; first by rewrite strayedE /= size_rcons addnS.
case: came result {be'' kept' madeE strayedE} => [pose'|].
  move=> [at_d' lt' at_r]; split=> //; apply: (@traverse_inj _ i); rewrite -/q' -at_d'.
  exact: traverse_known.
by move=> wrong at_q; apply: wrong; rewrite -(traverse_known em lt dd' same) at_q.
Qed.

(** * What is left to do *)

Let m := edges W.
Let n := vertices W.

(** The pairs of darts that can be refuted. *)
Definition pairs := 'C(2 * m, 2).

(** [left] edges are not explored. *)
Definition edges_left (K : knowledge) (left : nat) :=
  size (known_map K) + 2 * left = 2 * m + size (unexplored (known_map K)).

(** The actions that are left, and the greatest cost of those that are strict. *)
Definition actions_left (K : knowledge) left := (2 * m - size (far_ends K)) + (left + (pairs - size (refuted K))).
Definition cost_left (K : knowledge) left :=
  (2 * m - size (far_ends K)) * (n + 1) + (left + (pairs - size (refuted K))) * (3 * n).

Section Bounds.

Variables (K : knowledge) (place : nat -> W) (spots : seq W) (q : W).
Hypothesis be : believes K place spots q.

Lemma far_ends_le : size (far_ends K) <= 2 * m.
Proof.
apply: leq_trans (size_known (be_map be)); rewrite -[size (far_ends K)](size_map fst) -[X in _ <= X](size_iota 0).
apply: uniq_leq_size => [|_ /mapP[[e x] /(be_far be)[e_lt _ _] ->]]; first exact: be_far_uniq be.
by rewrite mem_iota.
Qed.

Lemma refuted_le : size (refuted K) <= pairs.
Proof.
have known := size_known (be_map be).
pose all := [seq (i, j) | j <- iota 0 (2 * m), i <- iota 0 j].
have <- : size all = pairs.
  rewrite /all size_allpairs_dep /pairs -triangular_sum /index_iota subn0 sumnE big_map.
  by apply: eq_bigr => j _; rewrite size_iota.
apply: uniq_leq_size => [|[i j] /(be_refuted be)[ij j_lt _]]; first exact: be_refuted_uniq be.
apply/allpairsPdep; exists j, i; rewrite !mem_iota; split=> //.
by rewrite add0n; apply: leq_trans j_lt known.
Qed.

End Bounds.

(** * One action *)

Definition only_short := forall k l, allowed k l -> k <= l.

(** An action makes progress. If it is strict, its cost and what the robot then has strayed is paid; otherwise it
    costs not much more than all moves before. *)
Definition progress K left (K' : knowledge) left' k :=
  [/\ edges_left K' left', actions_left K' left' < actions_left K left, made K' = made K + k,
      cost_left K' left' <= cost_left K left
    & only_short ->
      size (strayed K') + cost_left K' left' + k <= size (strayed K) + cost_left K left \/
      made K <= patience (known_map K) /\ k <= made K + n + 1].


(** One edge more is explored, after a test of some moves, or none. *)
Lemma edge_progress K K' left :
  edges_left K left -> size (known_map K) <= 2 * m ->
  (size (known_map K) + size (unexplored (known_map K'))).+2 = size (known_map K') + size (unexplored (known_map K)) ->
  size (known_map K') <= 2 * m ->
  edges_left K' left.-1 /\ 0 < left.
Proof.
rewrite /edges_left => count known explored known'.
have left_gt0 : 0 < left by arithmetic.
by split=> //; arithmetic.
Qed.

Lemma actions_left_edge K K' left :
  far_ends K' = far_ends K -> refuted K' = refuted K -> 0 < left ->
  (actions_left K' left.-1).+1 = actions_left K left /\ cost_left K' left.-1 + 3 * n = cost_left K left.
Proof.
rewrite /actions_left /cost_left => -> ->; case: left => //= left _.
by split; [rewrite addSn addnS | rewrite addSn mulSn -addnA; congr (_ + _); rewrite addnC].
Qed.

Lemma actions_left_far K e x left : (size (far_ends K)).+1 <= 2 * m ->
  (actions_left (with_far K e x) left).+1 = actions_left K left /\
  cost_left (with_far K e x) left + (n + 1) = cost_left K left.
Proof.
rewrite /actions_left /cost_left /= => lt; rewrite -[2 * m - size _](subnSK lt); split; first by [].
by rewrite mulSn -[RHS]addnA [RHS]addnC.
Qed.

Lemma actions_left_refuted K e h left : (size (refuted K)).+1 <= pairs ->
  (actions_left (with_refuted K e h) left).+1 = actions_left K left /\
  cost_left (with_refuted K e h) left + 3 * n = cost_left K left.
Proof.
rewrite /actions_left /cost_left /= => lt; rewrite -[pairs - size _](subnSK lt); split; first by rewrite !addnS.
by rewrite [left + _.+1]addnS mulSn -addnA; congr (_ + _); rewrite addnC.
Qed.

(** The end of a test. *)
Lemma conclude_spec K place spots q left e h (t : W) k0 K1 came :
  edges_left K left -> kept K K1 -> believes K1 place spots q -> made K1 = made K + k0 ->
  e \in unexplored (known_map K) -> h \in unexplored (known_map K) -> h != e -> ~~ is_refuted K e h ->
  (forall pose, came = Some pose -> [/\ place h = opposite (place e), pose < size (known_map K) & place pose = q]) ->
  (came = None -> place h <> opposite (place e)) ->
  let K' := conclude e h (K1, came) in
  exists left', [/\ believes K' place spots q, edges_left K' left', actions_left K' left' < actions_left K left,
    made K' = made K + k0 & size (strayed K') <= size (strayed K1) /\ cost_left K' left' + 3 * n = cost_left K left].
Proof.
move=> count [mapE farE refutedE] be madeE eU hU he fresh.
have := eU; rewrite mem_unexplored => /andP[e_lt _]; have := hU; rewrite mem_unexplored => /andP[h_lt _].
have known := size_known (be_map be); rewrite mapE in known.
move=> confirmed rejected; case: came confirmed rejected => [pose|] /=.
  move=> /(_ pose erefl)[placed pose_lt at_q] _; set K2 := located_at K1 pose 0.
  have be2 : believes K2 place spots q.
    have pose_lt1 : pose < size (known_map K1) by rewrite mapE.
    have [at_lt atE] := be_in_trail be pose_lt1.
    by rewrite at_q in atE; case: (be) => *; split; rewrite //= ?addn0 ?at_q.
  have eU2 : e \in unexplored (known_map K2) by rewrite /= mapE.
  have hU2 : h \in unexplored (known_map K2) by rewrite /= mapE.
  have [be' sizeU] := with_loop_believes be2 eU2 hU2 placed.
  have known' := size_known (be_map be').
  have [|count' left_gt0] := edge_progress count known _ known'.
    move: sizeU; rewrite /= mapE => ->.
    by rewrite size_with_edge // -addnS -addnS.
  have [actionsE costE] := actions_left_edge (K' := with_loop K2 e h) farE refutedE left_gt0.
  exists left.-1; split=> //; first by rewrite -actionsE.
  by rewrite /= addn0.
move=> _ /(_ erefl) differ; have be' : believes (with_refuted K1 e h) place spots q.
  case: (be) => *; split=> //= [i j|]; last by rewrite refutedE fresh -refutedE.
  rewrite inE => /predU1P[[-> ->]|/(be_refuted be)//].
  have low : minn e h < maxn e h by rewrite gtn_min !leq_max; case: (ltngtP e h) he => //; rewrite ?orbT.
  split=> //; first by rewrite mapE gtn_max e_lt h_lt.
  rewrite /minn /maxn; case: ifP => _ same; apply: differ; rewrite ?same ?opposite_involutive //.
have lt := refuted_le be'; have [actionsE costE] := actions_left_refuted e h left lt.
exists left; split=> //.
- by rewrite /edges_left /= mapE.
- suff -> : actions_left K left = actions_left K1 left by rewrite -actionsE.
  by rewrite /actions_left farE refutedE.
split=> //; suff -> : cost_left K left = cost_left K1 left by [].
by rewrite /cost_left farE refutedE.
Qed.

Lemma strict_cost w s p k s' c l :
  w.+1 <= s + l -> p.+1 <= l -> k <= p -> s' <= 1 + k -> s' + c + (w.+1 + k) <= s + (c + 3 * l).
Proof. by move=> *; arithmetic. Qed.

Lemma free_cost w v d p k l : w <= v -> v <= d.+1 -> k <= p -> p.+1 <= l -> w.+1 + k <= d + l + 1.
Proof. by move=> *; arithmetic. Qed.

Lemma perform_spec K place spots q left a :
  believes K place spots q -> edges_left K left -> allowed_action allowed patience K a ->
  always directional (perform K a) q
    (fun K' r k => exists place' spots' left', believes K' place' spots' r /\ progress K left K' left' k).
Proof.
move=> be count; have em := be_map be; have known := size_known em.
have known_lt e : e \in unexplored (known_map K) -> e < size (known_map K).
  by rewrite mem_unexplored => /andP[].
have way_le w e : only_short -> e < size (known_map K) -> allowed_way allowed K w e ->
    (way_moves K w).+1 <= size (strayed K) + n.
  move=> short e_lt /andP[_ /short le]; apply: leq_ltn_trans le _; exact: (way_home_moves be e_lt).
have path_le h path : only_short -> h < size (known_map K) -> allowed_path allowed (known_map K) h path ->
    (size path).+1 <= n.
  by move=> short h_lt /andP[_ /short le]; apply: leq_ltn_trans le _; apply: (path_moves be h_lt).
case: a => [e p|e h|e|e w|e h t] /=.
- case/and4P=> eU /eqP none ok /eqP same; exists place, spots, left; have e_lt := known_lt e eU.
  have [from_lt to_lt edgeE] := passage_ends (be_explains be) ok; have [at_lt atE] := be_in_trail be e_lt.
  have be' : believes (with_far K e (to_dart (trail K) p)) place spots q.
    case: (be) => *; split=> //= [e' x|]; last by rewrite far_end_none.
    rewrite inE => /predU1P[[-> ->]|/(be_far be)//].
    by rewrite edgeE (same_image be from_lt at_lt same) atE.
  have [actionsE costE] := actions_left_far e (to_dart (trail K) p) left (far_ends_le be').
  split=> //; split=> //; rewrite ?addn0 //; [by rewrite -actionsE | by rewrite -costE leq_addr |].
  by move=> _; left; rewrite -costE leq_add2l leq_addr.
- case far_e: far_end => [x|//] /and3P[eU hU /eqP same]; have [e_lt x_lt xE] := far_endP be far_e.
  have h_lt := known_lt h hU; have [at_lt atE] := be_in_trail be h_lt.
  have placed : place h = opposite (place e) by rewrite -atE -(same_image be x_lt at_lt same).
  have [be' sizeU] := with_loop_believes be eU hU placed; exists place, spots, left.-1; split=> //.
  have [|count' left_gt0] := edge_progress count known _ (size_known (be_map be')).
    by rewrite sizeU /= size_with_edge // -addnS -addnS.
  have [actionsE costE] := actions_left_edge (K := K) (K' := with_loop K e h) erefl erefl left_gt0.
  split; rewrite ?addn0 //; [by rewrite -actionsE | by rewrite -costE leq_addr |].
  by move=> _; left; rewrite -costE leq_add2l leq_addr.
- case far_e: far_end => [x|//] /andP[eU none].
  have [place' be' explored] := with_place_believes be eU far_e none.
  exists place', spots, left.-1; split=> //.
  have [count' left_gt0] := edge_progress count known explored (size_known (be_map be')).
  have [actionsE costE] := actions_left_edge (K := K) (K' := with_place K e x) erefl erefl left_gt0.
  split; rewrite ?addn0 //; [by rewrite -actionsE | by rewrite -costE leq_addr |].
  by move=> _; left; rewrite -costE leq_add2l leq_addr.
- case/and3P=> eU /eqP none way_ok; have e_lt := known_lt e eU; have /andP[leads_there _] := way_ok.
  apply: always_bind; apply: always_weaken (go_over_spec be e_lt leads_there) => -[K1 seen] r k /=.
  move=> [spots' [be1 [mapE farE refutedE] _ rE [kE madeE strayedE]]]; rewrite addn0.
  exists place, spots', left; set x := here K1.
  have be' : believes (with_far K1 e x) place spots' r.
    have [here_lt hereE] := be_here be1.
    case: (be1) => *; split=> //= [e' x'|]; last by rewrite farE (far_end_none none) -farE.
    rewrite inE => /predU1P[[-> ->]|/(be_far be1)//].
    by rewrite mapE hereE rE.
  have [actionsE costE] := actions_left_far e x left (far_ends_le be').
  have actions1 : actions_left K1 left = actions_left K left by rewrite /actions_left farE refutedE.
  have cost1 : cost_left K1 left = cost_left K left by rewrite /cost_left farE refutedE.
  split=> //; split=> //.
  - by rewrite /edges_left /= mapE.
  - by rewrite -actions1 -actionsE.
  - by rewrite -cost1 -costE leq_addr.
  move=> short; left; have := way_le w e short e_lt way_ok.
  by rewrite -cost1 -costE /= strayedE kE => le; arithmetic.
case far_e: far_end => [x|//] /and5P[eU hU he fresh]; have [e_lt x_lt xE] := far_endP be far_e.
have h_lt := known_lt h hU; case: t => [w path|way y entry path] /=.
  case/andP=> way_ok path_ok; have /andP[leads_there _] := way_ok.
  have /andP[path_leads _] := path_ok.
  apply: always_bind; apply: always_weaken (go_over_spec be e_lt leads_there) => -[K1 seen] r k /=.
  move=> [spots1 [be1 kept1 seenE rE [kE madeE strayedE]]]; have [mapE _ _] := kept1.
  apply: always_bind; rewrite -mapE in h_lt path_leads.
  apply: always_weaken (try_spec be1 h_lt path_leads seenE) => -[K2 came] r2 k2 /=.
  move=> [spots2 [be2 kept2 k2_le made2 [strayed2 result]]].
  have confirmed pose : came = Some pose ->
      [/\ place h = opposite (place e), pose < size (known_map K) & place pose = r2].
    by move=> cameE; move: result; rewrite cameE -rE -mapE.
  have rejected : came = None -> place h <> opposite (place e).
    by move=> cameE; move: result; rewrite cameE -rE.
  have made2' : made K2 = made K + (k + k2) by rewrite made2 madeE addnA.
  have [left' [be' count' less madeE' [short' costE]]] :=
    conclude_spec r count (kept_trans kept1 kept2) be2 made2' eU hU he fresh confirmed rejected.
  exists place, spots2, left'; rewrite addn0; split=> //; split=> //; first by rewrite -costE leq_addr.
  move=> short; left.
  rewrite mapE in h_lt; rewrite strayed2 strayedE in short'; rewrite -costE kE.
  exact: strict_cost (way_le w e short e_lt way_ok) (path_le h path short h_lt path_ok) k2_le short'.
case/and5P=> early entry_lt leads_there y_lt /and4P[way_ok path_ok predicted proves].
have /andP[path_leads _] := path_ok.
apply: always_bind; apply: always_weaken (go_through_spec be y_lt leads_there) => -[K1 seen] r k /=.
move=> [spots1 [be1 kept1 seenE rE [kE madeE]]]; have [mapE _ _] := kept1.
apply: always_bind; rewrite -mapE in entry_lt path_leads.
apply: always_weaken (try_spec be1 entry_lt path_leads seenE) => -[K2 came] r2 k2 /=.
move=> [spots2 [be2 kept2 k2_le made2 [strayed2 result]]].
have confirmed pose : came = Some pose ->
    [/\ place h = opposite (place e), pose < size (known_map K) & place pose = r2].
  move=> cameE; move: result; rewrite cameE mapE => -[at_r lt at_r2]; split=> //.
  rewrite mapE in entry_lt.
  by rewrite -xE; apply/esym/(confirms_right be h_lt entry_lt x_lt y_lt proves); rewrite at_r.
have rejected : came = None -> place h <> opposite (place e).
  move=> cameE; move: result; rewrite cameE => differ true_h; apply: differ; rewrite rE.
  rewrite mapE in entry_lt.
  by apply: (predicts_right be h_lt entry_lt x_lt y_lt predicted); rewrite xE true_h.
have made2' : made K2 = made K + (k + k2) by rewrite made2 madeE addnA.
have [left' [be' count' less madeE' [short' costE]]] :=
  conclude_spec r count (kept_trans kept1 kept2) be2 made2' eU hU he fresh confirmed rejected.
exists place, spots2, left'; rewrite addn0; split=> //; split=> //; first by rewrite -costE leq_addr.
move=> short; right; split=> //.
rewrite mapE in entry_lt; have := path_le entry path short entry_lt path_ok; have := short _ _ way_ok.
have visits := be_visits be; rewrite kE => way_short path_short; exact: free_cost way_short visits k2_le path_short.
Qed.

(** There is always an allowed action. *)
Lemma default_allowed K place spots q : believes K place spots q -> unexplored (known_map K) != [::] ->
  allowed_action allowed patience K (default_action K).
Proof.
move=> be some; rewrite /default_action; set U := unexplored _; set e := head 0 U.
have eU : e \in U by move: some; rewrite /e -/U; case: (U) => // d s _; apply: mem_head.
have e_lt : e < size (known_map K) by move: eU; rewrite mem_unexplored => /andP[].
have way_ok : allowed_way allowed K (way_home K e) e.
  by rewrite /allowed_way (default_way be e_lt) allowed_short.
case far_e: far_end => [x|] /=; last by rewrite eU far_e way_ok.
case left: [seq _ <- _ | _] => [|h hs] /=; rewrite far_e eU /=.
  apply/allP=> h hU; apply: contraT; rewrite !negb_or => /and3P[he fresh _].
  have : h \in [seq h <- U | (h != e) && ~~ is_refuted K e h] by rewrite mem_filter he fresh.
  by rewrite left.
have : h \in [seq h <- U | (h != e) && ~~ is_refuted K e h] by rewrite left mem_head.
rewrite mem_filter => /andP[/andP[-> ->] hU]; rewrite hU way_ok /=; apply: (default_path be).
by move: hU; rewrite mem_unexplored => /andP[].
Qed.

(** The robot's pose in a complete map. *)
Lemma pose_in_map_right K place spots q : believes K place spots q -> unexplored (known_map K) = [::] ->
  pose_in_map K < size (known_map K) /\ place (pose_in_map K) = q.
Proof.
move=> be explored; rewrite (be_pose be) /pose_in_map; have em := be_map be.
elim: (strayed K) (base K) (be_base be) => //= step steps IH pose lt.
have [lt' _ turnedE] := turned_right be step.1 lt; have [d dd'] := all_explored explored lt'.
have [d_lt _ _] := wf_other (em_wf em) dd'; rewrite dd' /=.
have [-> ->] := IH d d_lt; split=> //; congr (walk _ _).
by rewrite (em_other em dd') turnedE.
Qed.

(** * All actions *)

(** The moves before the last test that is not strict, and what the robot has then strayed, are few; what comes
    after is paid. *)
Variable early : nat.
Definition soon_strict := forall S (place : nat -> W), embeds S place -> patience S <= early.

Definition cost all := all + 4 * early + 2 * (n + 1).

Lemma explorer_actions_spec all bound K place spots q left :
  believes K place spots q -> edges_left K left ->
  always directional (explorer_actions allowed patience bound K) q
    (fun answer r k =>
       (right_answer answer r \/ answer = None /\ bound < actions_left K left) /\
       (only_short -> soon_strict -> cost_left K left <= all -> size (strayed K) + cost_left K left + made K <= cost all ->
        made K + k <= cost all)).
Proof.
have done K' place' spots' q' : believes K' place' spots' q' -> unexplored (known_map K') = [::] ->
    right_answer (Some (known_map K', pose_in_map K')) q'.
  move=> be explored; have [lt at_q] := pose_in_map_right be explored.
  have [L drawn_L iso] := drawn_isomorphic (be_map be) explored lt; rewrite at_q in iso.
  by exists (known_map K'), (pose_in_map K'), L; split.
have ended K' : made K' + 0 <= size (strayed K') + made K' by rewrite addn0 leq_addl.
elim: bound K place spots q left => [|bound IH] K place spots q left be count;
  rewrite [explorer_actions _ _ _ _]/=; case UE: (unexplored _) => [|e U] /=.
- split; first by left; apply: done be UE.
  by move=> _ _ _; rewrite addn0; apply: leq_trans; rewrite leq_addl.
- split; last by move=> _ _ _; rewrite addn0; apply: leq_trans; rewrite leq_addl.
  have known := size_known (be_map be); right; split=> //.
  by rewrite /actions_left; move: count; rewrite /edges_left UE /= => count; arithmetic.
- split; first by left; apply: done be UE.
  by move=> _ _ _; rewrite addn0; apply: leq_trans; rewrite leq_addl.
have some : unexplored (known_map K) != [::] by rewrite UE.
split; first exact: default_allowed be some.
move=> a a_ok; apply: always_bind; apply: always_weaken (perform_spec be count a_ok) => K' r k.
move=> [place' [spots' [left' [be' [count' less madeE cost_less paid]]]]].
apply: always_weaken (IH K' place' spots' r left' be' count') => answer r' k' [right cost'].
split.
  case: right => [right|[none few]]; [by left | right; split=> //].
  exact: leq_ltn_trans few less.
move=> short patience_le cost_le in_all; rewrite addnA -madeE; have in_all' := leq_trans cost_less cost_le.
apply: (cost' short patience_le in_all'); case: (paid short) => [strict|[soon k_le]].
  by rewrite madeE; arithmetic.
have soon' := leq_trans soon (patience_le _ _ (be_map be)); have made_le := be_made be'.
by rewrite /cost; arithmetic.
Qed.

(** * From the start *)

Lemma folding_explorer_spec bound :
  always directional (folding_explorer allowed patience bound (perceive directional (facing W))) (facing W)
    (fun answer r k =>
       (right_answer answer r \/ answer = None /\ bound < 2 * m * (m + 1)) /\
       (only_short -> soon_strict -> k <= cost (6 * n * m * m + 2 * n * m + 2 * m))).
Proof.
rewrite /folding_explorer; set K := Knowledge _ _ _ _ _ _ _ _ _ _.
set g := degree (facing W).
have sz : size (with_vertex [::] g) = g by rewrite size_with_vertex.
have g_gt0 : 0 < g := degree_gt0 _.
have ex : explains (trail K) [:: facing W].
  by split=> //= [[|k]|[|k]] //; rewrite andbF.
have be : believes K (turn (facing W)) [:: facing W] (facing W).
  split=> //=; rewrite ?sz ?size_map ?size_iota //.
  - exact: embeds_at_start.
  - by split=> // -[|k].
  by move=> d lt; rewrite /dart_in_trail /= (nth_map 0) ?size_iota // nth_iota // add0n.
have count : edges_left K m.
  by rewrite /edges_left /= unexplored_at_start sz size_iota addnC.
have pairsE : m + pairs = 2 * m * m.
  rewrite /pairs bin2 -[2 * m]/(2 * m) mul2n -doubleMl doubleK.
  case: (m) => [|m'] //; rewrite doubleS /= -mul2n; arithmetic.
have actionsE : actions_left K m = 2 * m * (m + 1).
  by rewrite /actions_left /= !subn0 pairsE mulnDr muln1 addnC.
have costE : cost_left K m = 6 * n * m * m + 2 * n * m + 2 * m.
  by rewrite /cost_left /= !subn0 pairsE; arithmetic.
have := explorer_actions_spec (6 * n * m * m + 2 * n * m + 2 * m) bound be count.
rewrite actionsE costE; apply: always_weaken => answer r k [right cost_k]; split=> // short patience_le.
apply: cost_k short patience_le (leqnn _) _; rewrite -[size (strayed K)]/0 -[made K]/0 add0n addn0 /cost; apply: leq_trans (leq_addr _ _) (leq_addr _ _).
Qed.

End Explorer.

(** With the patience of the running explorer. *)
Lemma folding_explorer_cost (W : start) bound :
  always directional (folding_explorer no_longer usual_patience bound (perceive directional (facing W))) (facing W)
    (fun _ _ k => k <= 6 * vertices W * edges W ^ 2 + 18 * vertices W * edges W + 2 * edges W + 2 * vertices W + 802).
Proof.
have short k l : k <= l -> no_longer k l by [].
pose early := 4 * vertices W * edges W + 200.
apply: always_weaken (folding_explorer_spec usual_patience short W early bound) => answer r k [_ cost_k].
apply: leq_trans (cost_k _ _) _ => // [S place em|].
  rewrite /usual_patience /early leq_add2r; have known := size_known em; have placed := known_vertices_le em.
  have -> : 4 * vertices W * edges W = 2 * vertices W * (2 * edges W) by arithmetic.
  by apply: leq_mul known; rewrite leq_mul2l.
rewrite /cost /early -mulnn; move: (vertices W) (edges W) => n m; arithmetic.
Qed.
