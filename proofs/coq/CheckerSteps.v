(** The steps of a proof are right: what the checker knows of a walk is true in every start, and from every pose, that
    gives the percepts of the walk. *)

From Coq Require Import BinNat FMapPositive.
From Coq Require Nnat.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Parts Verdicts Checker CheckerTables.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma sighting_of_pointing s i : sighting_of s = Pointing i -> exists2 n, s = WordPointing n & N.to_nat n = i.
Proof. by case: s => // n [<-]; exists n. Qed.

Lemma same_sightingP s s' : same_sighting s s' = (sighting_of s == sighting_of s').
Proof.
case: s => [||i|||||||]; case: s' => [||j|||||||] //=; rewrite eqbP.
by apply/eqP/eqP => [->|[]].
Qed.

Lemma passable_nth (G : embedded_graph) (p : G) ds k :
  passable p ds -> k < size ds -> nth 0 ds k < degree (walk p (take k ds)).
Proof. by elim: ds p k => [|i ds IH] p [|k] //= /andP[lt]; last exact: IH. Qed.

Lemma nth_doors_of doors k : nth 0 (doors_of doors) k = N.to_nat (nth N0 doors k).
Proof.
case: (ltnP k (size doors)) => [lt|le]; first by rewrite (nth_map N0).
by rewrite !nth_default // size_map.
Qed.

Section Steps.

Variables (marker : marker_word) (text : walk_text) (w : walked).
Hypothesis wE : w = walked_of text.

Let doors := doors_of (door_lines text).

(** Whether there is a visit with this number. *)
Definition is_visit (v : N) := N.to_nat v <= size doors.

Variables (V : start) (q : V).

Definition visit_pose (v : N) : V := walk q (take (N.to_nat v) doors).
Definition walked_dart (x : N * N) : V := turn (visit_pose x.1) (N.to_nat x.2).

Hypothesis same : percepts (marker_of marker) q doors = seen_of text.

Let size_seen : size (see_lines text) = (size doors).+1.
Proof. by rewrite -(size_percepts (marker_of marker) q) same size_map. Qed.

Let percept_atE v : is_visit v -> exists g s,
  [/\ find (percept_at w) v = Some (g, s), N.to_nat g = degree (visit_pose v)
    & sighting_of s = marker_of marker (visit_pose v)].
Proof.
rewrite wE => le; have lt : N.to_nat v < size (see_lines text) by rewrite size_seen.
have := nth_percepts (marker_of marker) q le; rewrite same (nth_map (N0, WordNothing)) //.
case nthE: (nth _ _ _) => [g s] [gE sE]; exists g, s; split=> //.
by rewrite (find_table_of _ _ (N0, WordNothing)) lt nthE.
Qed.

Lemma degree_atE v : is_visit v -> N.to_nat (degree_at w v) = degree (visit_pose v).
Proof. by case/percept_atE=> g [s [findE gE _]]; rewrite /degree_at findE. Qed.

Lemma degree_at_gt0 v : is_visit v -> 0 < N.to_nat (degree_at w v).
Proof. by move=> /degree_atE ->; apply: degree_gt0. Qed.

Lemma sighting_atE v : is_visit v -> sighting_of (sighting_at w v) = marker_of marker (visit_pose v).
Proof. by case/percept_atE=> g [s [findE _ sE]]; rewrite /sighting_at findE. Qed.

Lemma sighting_at_visit v : sighting_at w v <> WordNothing -> is_visit v.
Proof.
rewrite /sighting_at wE (find_table_of _ _ (N0, WordNothing)) size_seen ltnS -/(is_visit v).
by case: ifP.
Qed.

Lemma visited_visit v : visited w v -> is_visit v.
Proof. by rewrite /visited wE /= ltbP lengthE size_seen ltnS. Qed.

(** ** Moves *)

Lemma ends_of_along m i : find (door_at w) m = Some i ->
  [/\ N.to_nat m < size doors, nth 0 doors (N.to_nat m) = N.to_nat i
    & visit_pose (N.succ m) = opposite (walked_dart (m, i))].
Proof.
rewrite wE (find_table_of _ _ N0); case: ifP => // lt [iE].
have lt' : N.to_nat m < size doors by rewrite size_map.
have nthE : nth 0 doors (N.to_nat m) = N.to_nat i by rewrite nth_doors_of iE.
by split=> //; rewrite /visit_pose to_natS (take_nth 0 lt') walk_rcons nthE.
Qed.

Lemma ends_ofP p x y : ends_of w p = Some (x, y) ->
  [/\ is_visit x.1, is_visit y.1 & opposite (walked_dart x) = walked_dart y].
Proof.
by case: p => m /=; case doorE: (find _ m) => [i|] // [<- <-]; have [lt _ poseE] := ends_of_along doorE;
   rewrite /is_visit /= to_natS lt (ltnW lt) /walked_dart /= poseE ?oppositeK.
Qed.

(** ** What is known *)

Definition knows (k : knowledge) := forall v, is_visit v ->
  is_visit (label k v).1 /\ visit_pose v = walked_dart (label k v).

Lemma knows_nothing : knows nothing_known.
Proof. by move=> v v_in; rewrite /label find_empty. Qed.

Section Known.

Variable k : knowledge.
Hypothesis known : knows k.

Lemma name_ofE x : name_of w k x =
  ((label k x.1).1, N.modulo (N.add (label k x.1).2 x.2) (degree_at w (label k x.1).1)).
Proof. by rewrite /name_of; case: (label _ _). Qed.

Lemma name_ofP x : is_visit x.1 ->
  [/\ is_visit (name_of w k x).1, N.to_nat (name_of w k x).2 < N.to_nat (degree_at w (name_of w k x).1)
    & walked_dart (name_of w k x) = walked_dart x].
Proof.
move=> v_in; have [] := known v_in; rewrite name_ofE; case: (label k x.1) => r o r_in poseE.
split=> //; first by rewrite to_nat_mod ltn_mod degree_at_gt0.
rewrite [RHS]/walked_dart poseE /walked_dart [(_, _).1]/= [(_, _).2]/= [X in turn _ X = _]to_nat_mod to_natD.
by rewrite degree_atE // turn_mod turnD.
Qed.

Lemma name_of_inj x y : is_visit x.1 -> is_visit y.1 -> walked_dart x = walked_dart y ->
  two_doors (name_of w k x) (name_of w k y) || other_degree w (name_of w k x) (name_of w k y) = false.
Proof.
move=> /name_ofP[x_in x_lt xE] /name_ofP[y_in y_lt yE] xy.
rewrite -{}xE -{}yE in xy; move: (name_of w k x) (name_of w k y) x_in x_lt y_in y_lt xy => [r a] [s b] /=.
move=> r_in a_lt s_in b_lt xy; rewrite /two_doors /other_degree /=.
have -> : degree_at w r = degree_at w s.
  apply: to_nat_inj; rewrite !degree_atE //.
  by move: (congr1 (@degree _) xy); rewrite /walked_dart !degree_turn.
rewrite eqxx orbF; case: eqP => //= rs; subst s; move: xy; rewrite /walked_dart /= => /turn_eq.
by rewrite -degree_atE // !modn_small // => /to_nat_inj->; rewrite eqxx.
Qed.

Lemma eq_name_of x y : is_visit x.1 -> is_visit y.1 -> name_of w k x = name_of w k y -> walked_dart x = walked_dart y.
Proof. by move=> /name_ofP[_ _ <-] /name_ofP[_ _ <-] ->. Qed.

Lemma knows_relabel to from : is_visit to.1 -> is_visit from.1 -> N.to_nat from.2 < N.to_nat (degree_at w from.1) ->
  walked_dart to = walked_dart from -> knows (relabel w k to from).
Proof.
case: to from => [r a] [s b] r_in s_in b_lt one; rewrite /relabel.
case: (class k r) => count visits; case: (class k s) => count' visits'.
set shift := N.add _ _; set move := fun labels' visit => _.
have shifted o : turn (visit_pose s) o = turn (visit_pose r) (o + N.to_nat shift).
  rewrite /shift to_natD to_natB degree_atE // addnC turnD turnD [turn (visit_pose r) _]one /walked_dart.
  by rewrite -!turnD addnA subnKC ?turnD ?turn_degree // -degree_atE // ltnW.
pose right labels' := forall v, is_visit v -> let: (s', o) := odflt (v, N0) (find labels' v) in
  is_visit s' /\ visit_pose v = walked_dart (s', o).
suff all_right labels' : right labels' -> right (foldl move labels' visits').
  move=> v v_in; have : right (labels k).
    by move=> u /known; rewrite /label; case: (odflt _ _).
  by move/all_right/(_ v v_in); rewrite /label /=; case: (odflt _ _).
elim: visits' labels' => //= u visits' IH labels' labels_right; apply: IH => v v_in.
have := labels_right v v_in; rewrite /move; case labelE: (odflt _ (find labels' u)) => [s' o].
case: eqP => [s'E|_] //; rewrite find_put; case: eqP => //= vu; rewrite vu labelE s'E => -[_ ->].
split=> //; rewrite /walked_dart to_nat_mod to_natD degree_atE // turn_mod.
exact: shifted.
Qed.

End Known.

Lemma existingP x y x' y' : existing w x y = inl (x', y') -> x = x' /\ y = y'.
Proof. by rewrite /existing; case: ifP => // _; case: ifP => // _ [-> ->]. Qed.

Lemma showsP k s x y : knows k -> shows marker w k s = inl (x, y) ->
  [/\ is_visit x.1, is_visit y.1 & walked_dart x = walked_dart y].
Proof.
move=> known; case: s => [a b|p p'] /=.
  case markerE: marker => //; case aE: (sighting_at w a) => [||i|||||||] //.
  case bE: (sighting_at w b) => [||j|||||||] // /existingP[<- <-].
  have a_in : is_visit a by apply: sighting_at_visit; rewrite aE.
  have b_in : is_visit b by apply: sighting_at_visit; rewrite bE.
  split=> //; have := sighting_atE a_in; have := sighting_atE b_in; rewrite aE bE markerE /= /directional /walked_dart.
  by case: ifP => // near [jE]; case: ifP => // near' [iE] /=; rewrite /turn iE jE !iter_findex.
case pE: (ends_of w p) => [[z x']|] //; case p'E: (ends_of w p') => [[z' y']|] //; case: (existing _ _ _) => // _.
case: eqP => // one /existingP[<- <-].
have [z_in x_in <-] := ends_ofP pE; have [z'_in y_in <-] := ends_ofP p'E.
by split=> //; rewrite (eq_name_of known z_in z'_in one).
Qed.

Lemma knows_after k s k' : knows k -> after marker w k s = inl k' -> knows k'.
Proof.
move=> known; rewrite /after; case showsE: (shows _ _ _ _) => [[x y]|] //.
have [x_in y_in one] := showsP known showsE.
have [rx_in x_lt xE] := name_ofP known x_in; have [ry_in y_lt yE] := name_ofP known y_in.
rewrite -xE -yE in one; case: ifP => // _; case: ifP => // _ [<-].
by case: ifP => // _; case: ifP => _; apply: knows_relabel.
Qed.

Lemma knows_after_all k part steps k' : knows k -> after_all marker w k part steps = inl k' -> knows k'.
Proof.
elim: steps k part => [|s steps IH] k part known /=; first by case=> <-.
by case afterE: (after _ _ _ _) => [k1|] // /IH; apply; apply: knows_after afterE.
Qed.

(** ** A complete trail *)

(** Each dart of the walk is known to be one with an end of a move. *)
Definition covers (k : knowledge) := forall v i, is_visit v ->
  exists p x y, ends_of w p = Some (x, y) /\ name_of w k (v, i) = name_of w k x.

Let is_end k (x : N * N) := exists p y z, ends_of w p = Some (y, z) /\ x = name_of w k y.

Lemma names_of_endsP k ends u ds :
  (forall m, m < size ds -> find (door_at w) (N.of_nat (N.to_nat u + m)) = Some (nth N0 ds m)) ->
  (forall r a, has_entry (odflt empty (find ends r)) a -> is_end k (r, a)) ->
  forall r a, has_entry (odflt empty (find (names_of_ends w k ends u ds) r)) a -> is_end k (r, a).
Proof.
have adds ends' x : is_end k (name_of w k x) ->
    (forall r a, has_entry (odflt empty (find ends' r)) a -> is_end k (r, a)) ->
    forall r a,
      has_entry (odflt empty (find (if door_exists w x then
                                      let: (visit, i) := name_of w k x in
                                      put ends' visit (put (odflt empty (find ends' visit)) i tt)
                                    else ends') r)) a ->
      is_end k (r, a).
  move=> x_end ends'_ends r a; case: ifP => _; last exact: ends'_ends.
  move: x_end; case: (name_of w k x) => s b x_end.
  rewrite find_put; case: eqP => [->|_] /=; last exact: ends'_ends.
  rewrite /has_entry find_put; case: eqP => [-> //|_]; exact: ends'_ends.
elim: ds u ends => [|i ds IH] u ends //= door_atE ends_ends; apply: IH => [m lt|].
  rewrite to_natS addSnnS; exact: (door_atE m.+1).
have doorE : find (door_at w) u = Some i by rewrite -(door_atE 0) // addn0 Nnat.N2Nat.id.
apply: (adds); first by exists (Against u), (N.succ u, N0), (u, i); rewrite /= doorE.
by apply: (adds) ends_ends; exists (Along u), (u, i), (N.succ u, N0); rewrite /= doorE.
Qed.

Lemma complete_covers k : knows k -> complete w k -> covers k.
Proof.
move=> known /all_belowP covered_all v i v_in.
have size_visits : N.to_nat (visits w) = (size doors).+1 by rewrite wE lengthE size_seen.
have covered_visit u : is_visit u -> covered w k (ends_fuel w) (names_of_ends w k empty 0 (door_lines (walk_of w))) u.
  by move=> u_in; apply: covered_all; rewrite size_visits ltnS.
set ends := names_of_ends _ _ _ _ _ in covered_visit.
have [r_in _] := known v v_in; have [_ lt _] := @name_ofP k known (v, i) v_in; move: lt; rewrite name_ofE /=.
set r := (label k v).1; set a := N.modulo _ _ => lt.
have := covered_visit v v_in; rewrite /covered -/r; case: ifP => // _; case: eqP => // stands _.
have := covered_visit r r_in; rewrite /covered !stands eqxx; case: ifP => // _.
move/all_belowP/(_ a lt) => in_ends; suff [p [x [y [pE xE]]]] : is_end k (r, a) by exists p, x, y.
apply: names_of_endsP in_ends => [m m_lt|r' a']; last by rewrite find_empty /has_entry find_empty.
rewrite wE in m_lt *; rewrite (find_table_of _ _ N0) !Nnat.Nat2N.id.
by rewrite m_lt.
Qed.

Lemma covers_opposite k v i : knows k -> covers k -> is_visit v ->
  exists z, is_visit z.1 /\ opposite (walked_dart (v, i)) = walked_dart z.
Proof.
move=> known all_covered v_in; have [p [x [z [pE nameE]]]] := all_covered v i v_in.
have [x_in z_in xz] := ends_ofP pE; exists z; split=> //.
by rewrite (eq_name_of known _ x_in nameE).
Qed.

(** So every dart is one of the walk. *)
Lemma covers_all k : knows k -> covers k -> forall d : V, exists2 v, is_visit v & same_vertex (visit_pose v) d.
Proof.
move=> known all_covered d; have [ds <-] := connected_walk q d.
elim/last_ind: ds => [|ds i [v v_in /same_vertexP[j dE]]].
  by exists N0 => //; rewrite /visit_pose take0 same_vertex_refl.
rewrite walk_rcons dE /traverse -turnD.
have [[u j'] [u_in uE]] := covers_opposite (N.of_nat (j + i)) known all_covered v_in.
exists u => //; move: uE; rewrite /walked_dart /= Nnat.Nat2N.id => ->.
exact: same_vertex_turn.
Qed.

(** ** Contradictions *)

Lemma one_vertexP k a b : knows k -> is_visit a -> is_visit b -> (label k a).1 = (label k b).1 ->
  same_vertex (visit_pose a) (visit_pose b).
Proof.
move=> known /known[_ ->] /known[_ ->] one; rewrite /walked_dart one.
apply: (same_vertex_trans (q := visit_pose (label k b).1)); last exact: same_vertex_turn.
by rewrite same_vertex_sym same_vertex_turn.
Qed.

Lemma can_seeP v : is_visit v -> can_see marker (degree_at w v) (sighting_at w v).
Proof.
move=> v_in; have := sighting_atE v_in; have degreeE := degree_atE v_in.
case: (sighting_at w v) => [||i|||||||]; case: marker => //=; try by rewrite /undirected /directional
  /undirected_edge /directed_edge /two_identical /two_distinct /two_looks;
  do ?case: ifP => //; do ?case: (same_vertex _ _).
rewrite /directional; case: ifP => // near [iE]; rewrite ltbP iE degreeE.
exact: findex_max.
Qed.

Lemma points_elsewhereF k a b : marker = WordDirectional -> knows k -> is_visit a -> is_visit b ->
  (label k a).1 = (label k b).1 -> points_elsewhere w k a b = false.
Proof.
move=> markerE known a_in b_in one; have near := one_vertexP known a_in b_in one; rewrite /points_elsewhere.
have := sighting_atE a_in; have := sighting_atE b_in; rewrite markerE /= /directional.
case: (sighting_at w a) => //= i; move=> b_sees; case: ifP => // a_near [iE].
have b_near : same_vertex (visit_pose b) (facing V).
  by apply: same_vertex_trans a_near; rewrite same_vertex_sym.
rewrite b_near in b_sees; case/sighting_of_pointing: b_sees => j -> jE; apply/negbTE; rewrite negbK.
have dartE v n : N.to_nat n = findex clockwise (visit_pose v) (facing V) -> same_vertex (visit_pose v) (facing V) ->
    walked_dart (v, n) = facing V.
  by move=> nE v_near; rewrite /walked_dart /= nE /turn iter_findex.
have := name_of_inj known (x := (a, i)) (y := (b, j)) a_in b_in; rewrite !dartE // => /(_ erefl).
rewrite !name_ofE /two_doors /= one eqxx /= => /norP[/negbNE/eqP-> _].
exact: eqxx.
Qed.

Lemma is_seen_pointing v i : marker_of marker (visit_pose v) = Pointing i -> is_visit v ->
  has is_seen (see_lines text).
Proof.
move=> pointing v_in; have := sighting_atE v_in; rewrite pointing => /sighting_of_pointing[n].
rewrite /sighting_at wE (find_table_of _ _ (N0, WordNothing)) size_seen ltnS -/(is_visit v) v_in.
case nthE: (nth _ _ _) => [g s] sE _; apply/(has_nthP (N0, WordNothing)).
by exists (N.to_nat v); rewrite ?size_seen ?ltnS // nthE sE.
Qed.

Lemma contradicted k c : knows k -> passable q doors -> not_contradictory marker w k c <> None.
Proof.
move=> known doors_exist; case: c => [s|a b|m|a|m|] /=.
- case showsE: (shows _ _ _ _) => [[x y]|] //; have [x_in y_in one] := showsP known showsE.
  by rewrite (name_of_inj known x_in y_in one).
- case: ifP => // /negbFE/visited_visit a_in; case: ifP => // /negbFE/visited_visit b_in.
  case: eqP => // one; have near := one_vertexP known a_in b_in one.
  have same_at : marker_of marker (visit_pose a) = marker_of marker (visit_pose b) ->
      same_sighting (sighting_at w a) (sighting_at w b).
    by rewrite same_sightingP !sighting_atE // => ->.
  have near_eq (d : V) : same_vertex (visit_pose a) d = same_vertex (visit_pose b) d.
    apply/idP/idP => [a_d|b_d]; last exact: same_vertex_trans near b_d.
    by apply: same_vertex_trans a_d; rewrite same_vertex_sym.
  case markerE: marker; rewrite ?(points_elsewhereF markerE) ?andbF //; try
    (rewrite same_at // markerE /= /no_marker /undirected /two_identical /two_distinct /two_looks ?near_eq //).
  + case: eqP => //= names; rewrite same_at //.
    by have := eq_name_of known (x := (a, N0)) (y := (b, N0)) a_in b_in names; rewrite /walked_dart /= => ->.
  case: eqP => //= names; rewrite same_at //.
  by have := eq_name_of known (x := (a, N0)) (y := (b, N0)) a_in b_in names; rewrite /walked_dart /= => ->.
- case doorE: (find _ m) => [i|] //; have [lt _ poseE] := ends_of_along doorE.
  case: and3P => // -[_ _ /eqP names]; have := eq_name_of known (x := (m, i)) (y := (N.succ m, N0)) (ltnW lt) _ names.
  rewrite /is_visit /= to_natS => /(_ lt); rewrite {2}/walked_dart /= poseE => /esym/eqP.
  by rewrite (negbTE (opposite_neq _)).
- case: ifP => // /negbFE/visited_visit a_in; rewrite can_seeP // orbF; case: eqP => // degree0.
  by have := degree_at_gt0 a_in; rewrite degree0.
- case doorE: (find _ m) => [i|] //; have [lt nthE _] := ends_of_along doorE.
  have m_in : is_visit m := ltnW lt.
  have := passable_nth doors_exist lt; rewrite nthE -/(visit_pose m) -degree_atE // ltnNge -lebP.
  by case: ifP.
case markerE: marker => //; case pointing: (has _ _) => //; case completeE: (complete w k) => // _.
have [v v_in near] := covers_all known (complete_covers known completeE) (facing V).
have : marker_of marker (visit_pose v) = Pointing (findex clockwise (visit_pose v) (facing V)).
  by rewrite markerE /= /directional near.
by move/is_seen_pointing/(_ v_in); move: pointing; rewrite wE => /= ->.
Qed.

End Steps.
