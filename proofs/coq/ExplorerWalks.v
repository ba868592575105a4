(** What the folding explorer believes is true, and stays true on its walks. Beyond Section 2.3. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Folding FoldingExplorer Walks Arithmetic Always Parts Maps Paths
  Embedding Complete Rounds Correct FoldedVisits.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Explorer.

Variable allowed : nat -> nat -> bool.
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
rewrite (em_turn em e_lt) same (em_turn em lt) -turnD addKn.
by rewrite -(degree_vertex em) // turn_mod.
Qed.

Lemma pose_at_base_right :
  pose_at_base K < size S /\ walk q (way_back (strayed K)) = place (pose_at_base K).
Proof.
have := way_backK (place (base K)) (unzip1 (strayed K)); rewrite -(be_strayed be) -(be_pose be) => ->.
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
have root_lt := vertex_lt wf lt; have root := vertex_vertex wf lt.
by rewrite from_root_leads.
Qed.

Lemma way_home_moves e : e < size S -> way_moves K (way_home K e) < size (strayed K) + vertices W.
Proof.
move=> e_lt; rewrite /= ltn_add2l; have [lt _] := pose_at_base_right.
have root_lt := vertex_lt wf lt; have root := vertex_vertex wf lt.
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

Lemma eq_image x y : x.1 < size (trail K) -> y.1 < size (trail K) -> stands_for K x = stands_for K y ->
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
move: contra; rewrite /contradicts folded_f.
move=> /orP[/negP|/hasP[p /(mem_passages (be_explains be)) ok /eqP own]]; last first.
  have [from_lt to_lt edgeE] := passage_ends (be_explains be) ok.
  have [_ fromE _] := standing_for_right (be_explains be) right from_lt.
  have [_ toE _] := standing_for_right (be_explains be) right to_lt.
  have := opposite_neq (image spots (from_dart (trail K) p)).
  by rewrite -edgeE -toE -own fromE eqxx.
apply; rewrite map_inj_in_uniq ?filter_uniq ?iota_uniq //.
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
  by rewrite edgeE (eq_image from_lt entry_at same) entryE enters oppositeK.
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
  by apply/eqP=> same; have := opposite_neq (place e); rewrite -placed same eqxx.
have := eU; rewrite mem_unexplored => /andP[e_lt _]; have := hU; rewrite mem_unexplored => /andP[h_lt _].
split; last exact: size_unexplored_with_edge.
have sz : size (with_edge S e h) = size S := size_with_edge e_lt h_lt.
by case: be => *; split; rewrite //= -?/S ?sz //; apply: embeds_with_edge.
Qed.

Lemma refuted_right e h : e < size S -> h < size S -> is_refuted K e h -> place h <> opposite (place e).
Proof.
move=> e_lt h_lt /(be_refuted be)[_ _ differ] same; apply: differ; rewrite /minn /maxn.
by case: ifP => _; rewrite same ?oppositeK.
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
  by rewrite /place' ltnNge ge /= -[opposite (place e)]/t -xE /image /= turnD.
- move=> e' x' /(be_far be)[e'_lt x'_lt ->]; rewrite old //.
  by split=> //; apply: leq_trans e'_lt (leq_addr _ _).
- move=> i j /(be_refuted be)[ij j_lt differ]; rewrite !old //; last exact: ltn_trans ij j_lt.
  by split=> //; apply: leq_trans j_lt (leq_addr _ _).
exact: leq_trans base_lt (leq_addr _ _).
Qed.

End Known.


(** * Walks *)

(** It goes to a dart of the map and over its edge. *)
Lemma go_over_spec K place spots q w e :
  believes K place spots q -> e < size (known_map K) -> doors_by K w e != None ->
  always (moving directional W) (go_over K w e) q
    (fun after r k => exists spots',
       [/\ believes after.1 place spots' r, kept K after.1, after.2 = perceive directional r,
           r = opposite (place e)
         & [/\ k = (way_moves K w).+1, made after.1 = made K + k & size (strayed after.1) = 1]]).
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
  always (moving directional W) (go_through K way x) q
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
  always (moving directional W) (try K pose seen darts) q
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
      by apply: (expected_inj em lt); [apply/eqP | rewrite -seenE].
    by split.
  by move=> at_q; apply: unlike; rewrite (expectedE em) // at_q.
move: path => /=; case/andP=> /eqP same; case dd': (other _ d) => [d'|//] /= path.
case: eqP => [fits|unlike] /=; last first.
  exists spots; rewrite !addn0; split=> //; split=> // at_q.
  by apply: unlike; rewrite (expectedE em) // at_q.
have [d'_lt _ _] := wf_other (em_wf em) dd'; set i := door_to _ pose d.
have degE : seen.1 = degree q by rewrite seenE.
have i_lt : i < degree q.
  have -> : degree q = doors (known_map K) pose by rewrite -degE fits.
  exact: (door_to_lt em).
split=> //; have [here_lt hereE] := be_here be.
set q' := traverse q i; set K' := arrived _ _ _ _ _ _.
have be' : believes K' place (rcons spots q') q'.
  apply: (arrived_believes be) => //.
  - by rewrite /q' /traverse -hereE /image /= turnD.
  - exact: be_base be.
  - by rewrite /unzip1 map_rcons taken_rcons -/unzip1 -(be_strayed be) -(be_pose be) degE.
  - by rewrite /unzip1 map_rcons walk_rcons -/unzip1 -(be_pose be).
  by rewrite size_rcons addn1 ltnS (be_made be).
apply: alwaysW (IH K' _ q' d' _ be' d'_lt path (erefl _)).
move=> [K'' came] r k [spots' [be'' kept' k_le madeE [strayedE result]]]; exists spots'; split=> //.
- by rewrite madeE /= addnAC -addnA addn1 addnS.
split; first by rewrite strayedE /= size_rcons addnS.
case: came result {be'' kept' madeE strayedE} => [pose'|].
  move=> [at_d' lt' at_r]; split=> //; apply: (@traverse_inj _ i); rewrite -/q' -at_d'.
  exact: traverse_known.
by move=> wrong at_q; apply: wrong; rewrite -(traverse_known em lt dd' same) at_q.
Qed.

End Explorer.

Arguments far_endP {W K place spots q} be {e x}.
Arguments turned_right {W K place spots q} be {d} i.
Arguments default_way {W K place spots q} be {e}.
Arguments way_home_moves {W K place spots q} be {e}.
Arguments default_path {allowed} allowed_short {W K place spots q} be {h}.
Arguments path_moves {W K place spots q} be {h}.
Arguments eq_image {W K place spots q} be {x y}.
Arguments confirms_right {W K place spots q} be {far h x entry}.
Arguments predicts_right {W K place spots q} be {far h x entry}.
Arguments with_loop_believes {W K place spots q} be {e h}.
Arguments with_place_believes {W K place spots q} be {e x}.
