(** The checker accepts only claims that are true. *)

From Coq Require Import BinNat FMapPositive.
From Coq Require Nnat.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Parts Bisimulation Separates Verdicts Checker CheckerTables
  CheckerWorlds CheckerSteps CheckerChoices CheckerRuns.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma doors_of_cons i doors : doors_of (i :: doors) = N.to_nat i :: doors_of doors.
Proof. by []. Qed.

(** * Poses from which everything looks alike *)

Lemma alike_walk M (V W : start) (p : V) (q : W) ds :
  alike M p q -> alike M (walk p ds : V) (walk q ds : W).
Proof.
move=> same es; elim: ds p q same => //= i ds IH p q same; apply: IH => fs.
by have := same (i :: fs) => -[].
Qed.

(** With a directional marker, an isomorphism leads from one to the other. *)
Lemma alike_isomorphism (V W : start) (p : V) (q : W) : alike directional p q ->
  exists f : V -> W, [/\ isomorphism f, f (facing V) = facing W & f p = q].
Proof.
move=> same; have [ds dsE] := connected_walk p (facing V).
have to_facing (r : W) : alike directional p r -> walk r ds = facing W.
  move=> same_r; apply/pointing0P; have := alike_walk ds same_r [::]; rewrite dsE => -[_ <-].
  exact/pointing0P.
have [f [iso f_facing]] : isomorphic_starts V W.
  apply: indistinguishable_directional => es.
  by have := alike_walk ds same es; rewrite dsE to_facing.
have same_f : alike directional p (f p).
  apply: eq_percepts => es; rewrite -isomorphism_walk // /perceive isomorphism_degree //.
  by rewrite (directional_invariant iso f_facing).
by exists f; split=> //; apply: (@walk_inj _ ds); rewrite /= !to_facing.
Qed.

(** * Determined *)

Lemma covers_alike text w k (V W : start) (p : V) (q : W) :
  w = walked_of text ->
  percepts directional p (doors_of (door_lines text)) = seen_of text ->
  percepts directional q (doors_of (door_lines text)) = seen_of text ->
  knows text p k -> knows text q k -> covers text w k -> alike directional p q.
Proof.
move=> wE p_sees q_sees p_knows q_knows all_covered.
have := percepts_eq_walk (etrans p_sees (esym q_sees)); set doors := doors_of _ => perceive_eq.
suff alike_at v i : is_visit text v -> alike directional (turn (visit_pose text p v) i) (turn (visit_pose text q v) i).
  move=> ds; have := alike_at N0 0 (leq0n _) ds.
  by rewrite /visit_pose !take0.
move=> v_in ds; elim: ds v i v_in => [|j ds IH] v i v_in /=; rewrite (perceive_turn i (perceive_eq _ v_in)) //.
congr (_ :: _); rewrite /traverse -!turnD.
have [m [x [y [mE nameE]]]] := all_covered v (N.of_nat (i + j)) v_in.
have [x_in y_in p_xy] := ends_ofP wE p mE; have [_ _ q_xy] := ends_ofP wE q mE.
have one := @eq_name_of WordDirectional _ _ wE.
have p_one := one _ p p_sees k p_knows (v, N.of_nat (i + j)) x v_in x_in nameE.
have q_one := one _ q q_sees k q_knows (v, N.of_nat (i + j)) x v_in x_in nameE.
move: p_one q_one; rewrite {1 3}/walked_dart /= Nnat.Nat2N.id => -> ->; rewrite p_xy q_xy.
exact: IH.
Qed.

(** * What a walk gives in a world *)

Section World.

Variables (T : tables) (W : start) (number : W -> N) (marker : marker_word).
Hypothesis T_fits : fits T number.

Let M := marker_of marker.

Lemma perceive_in (d : W) degree s :
  (degree == degree_in T (number d)) && same_sighting s (sighting_in T marker (number d)) =
  (percept_of (degree, s) == perceive M d).
Proof. by rewrite /percept_of /perceive xpair_eqE /= eqbP degree_inE // same_sightingP sighting_inE. Qed.

Lemma differsP visit (d : W) seen doors : differs T marker visit (number d) seen doors = None ->
  percepts M d (doors_of doors) = map percept_of seen /\ passable d (doors_of doors).
Proof.
elim: doors seen d visit => [|i doors IH] [|[g s] seen] d visit //=; case: ifP => // /negbFE degreeE;
  case: ifP => // /negbFE sightE; have /eqP <- : percept_of (g, s) == perceive M d by rewrite -perceive_in degreeE.
  by case: seen.
case: seen => // seen1 seen; case: ifP => // lt; rewrite traverse_inE // => /IH[<- ->]; split=> //.
by rewrite andbT -(degree_inE T_fits) -(eqP degreeE) -ltbP.
Qed.

Lemma mem_fold_filter (S : eqType) (R : eqType) (test : pred S) (f : S -> R) s x t :
  x \in s -> test x -> f x \in foldl (fun left y => if test y then f y :: left else left) t s.
Proof.
move=> x_in test_x; have keeps t' : f x \in t' ->
    f x \in foldl (fun left y => if test y then f y :: left else left) t' s.
  by elim: (s) t' => //= y s' IH t' in_t; apply: IH; case: ifP; rewrite ?inE ?in_t ?orbT.
elim: s t x_in {keeps} => //= y s IH t; rewrite inE => /predU1P[<-|]; last exact: IH.
rewrite test_x; elim: s {IH} (f x :: t) (mem_head (f x) t) => //= z s IH t' in_t; apply: IH.
by case: ifP; rewrite ?inE ?in_t ?orbT.
Qed.

Lemma remainP poses seen doors x (d : W) : (x, number d) \in poses ->
  percepts M d (doors_of doors) = map percept_of seen -> passable d (doors_of doors) ->
  remain T marker poses seen doors <> [::].
Proof.
elim: doors poses seen d => [|i doors IH] [|pose poses] [|[g s] seen] d //=;
  set all_poses := pose :: poses => in_poses [degreeE sightE].
  move=> _ _ empty; pose fits_pose (y : N * N) :=
    (g == degree_in T y.2) && same_sighting s (sighting_in T marker y.2).
  have fits_d : fits_pose (x, number d).
    by rewrite /fits_pose /= perceive_in; apply/eqP; rewrite /percept_of /perceive -degreeE -sightE.
  by have := mem_fold_filter id [::] in_poses fits_d; rewrite [foldl _ _ _]empty.
move=> later /andP[lt doors_exist]; apply: IH later doors_exist; rewrite -(traverse_inE T_fits).
pose fits_pose (y : N * N) :=
  (g == degree_in T y.2) && same_sighting s (sighting_in T marker y.2) && N.ltb i g.
apply: (mem_fold_filter (test := fits_pose) (fun y : N * N => (y.1, traverse_in T y.2 i)) [::] in_poses).
rewrite /fits_pose /= perceive_in ltbP -degreeE lt andbT; apply/eqP.
by rewrite /percept_of /perceive -degreeE -sightE.
Qed.

End World.

(** * Visits *)

Section Visits.

Variables (T : tables) (W : start) (number : W -> N) (marker : marker_word).
Hypothesis T_fits : fits T number.

Let M := marker_of marker.

Lemma has_perceptP (d : W) seen : has_percept T marker (number d) seen = (percept_of seen == perceive M d).
Proof. by case: seen => g s; rewrite -(perceive_in marker T_fits). Qed.

Lemma degree_dart_list (d : W) : degree d <= size (dart_list T).
Proof.
apply: leq_trans (max_card _) _; rewrite cardE -(size_map number); apply: uniq_leq_size.
  by rewrite (map_inj_uniq (number_inj T_fits)) enum_uniq.
by move=> _ /mapP[e _ ->]; apply/(dart_listP T_fits); exists e.
Qed.

Lemma mem_behind_doors fuel i n d poses x : x \in poses \/
    (exists2 j, N.to_nat i <= N.to_nat j < N.to_nat n & x = traverse_in T d j) ->
  N.to_nat n - N.to_nat i <= size fuel -> x \in behind_doors T fuel i n d poses.
Proof.
elim: fuel i poses => [|a fuel IH] i poses /=; rewrite eqbP; case: eqP => [->|neq] found.
- by move=> _; case: found => // -[j /andP[le lt]]; rewrite ltnNge le in lt.
- rewrite leqn0 subn_eq0 => le; case: found => // -[j /andP[i_j j_n]].
  by have := leq_trans j_n (leq_trans le i_j); rewrite ltnn.
- by move=> _; case: found => // -[j /andP[le lt]]; rewrite ltnNge le in lt.
move=> le; apply: IH; last by rewrite to_natS subnS -ltnS; case: (_ - _) le.
case: found => [in_poses|[j /andP[i_j j_n] ->]]; first by left; rewrite inE in_poses orbT.
case: (ltngtP (N.to_nat i) (N.to_nat j)) i_j => // [lt|/to_nat_inj<-] _; last by left; rewrite mem_head.
by right; exists j; rewrite // to_natS lt.
Qed.

Lemma onwardP back last a (p q : W) : visits_by M back last a p q ->
  number q \in onward T marker back last a (number p).
Proof.
case: a => [->|seen [i|]] /=; first by case: back; rewrite ?opposite_inE // mem_head.
  case=> seenE lt ->; rewrite has_perceptP seenE eqxx /= ltbP.
  have -> : N.to_nat seen.1 = degree p by case: seenE.
  by rewrite lt traverse_inE // mem_head.
case=> seenE; rewrite has_perceptP seenE eqxx /=; case: last => [->|[i lt ->]]; first exact: mem_head.
have gE : N.to_nat seen.1 = degree p by case: seenE.
apply: mem_behind_doors; last by rewrite subn0 gE degree_dart_list.
by right; exists (N.of_nat i); rewrite ?traverse_inE // Nnat.Nat2N.id // gE.
Qed.

Let consistent (found : seq N * table unit) := forall x, has_entry found.2 x -> x \in found.1.

Lemma add_posesP poses found : consistent found -> let found' := foldl (@add_pose) found poses in
  consistent found' /\ forall x, x \in found.1 \/ x \in poses -> x \in found'.1.
Proof.
elim: poses found => [|y poses IH] found ok /=; first by split=> // x [].
have [ok' [here there]] : consistent (add_pose found y) /\
    y \in (add_pose found y).1 /\ forall x, x \in found.1 -> x \in (add_pose found y).1.
  rewrite /add_pose; case: ifP => [/ok y_in|_] /=; first by [].
  split=> [x|]; last by split=> [|x x_in]; rewrite ?mem_head // inE x_in orbT.
  by rewrite /has_entry find_put inE /=; case: eqP => //= _ /ok ->.
have [ok2 mem2] := IH _ ok'; split=> // x [x_in|]; first by apply: mem2; left; apply: there.
by rewrite inE => /predU1P[->|x_in]; apply: mem2; [left | right].
Qed.

Lemma fold_keeps (S : Type) (f : seq N * table unit -> S -> seq N * table unit) (s : seq S) found :
  (forall found a, consistent found ->
     consistent (f found a) /\ forall x, x \in found.1 -> x \in (f found a).1) ->
  consistent found -> let found' := foldl f found s in
  [/\ consistent found', forall x, x \in found.1 -> x \in found'.1
    & forall a x, List.In a s -> (forall found, consistent found -> x \in (f found a).1) -> x \in found'.1].
Proof.
move=> keeps; elim: s found => [|a s IH] found ok //=; have [ok' sub] := keeps found a ok.
have [ok2 sub2 mem2] := IH _ ok'; split=> // [x /sub /sub2 //|b x [<- in_b|]]; last exact: mem2.
by apply/sub2/in_b.
Qed.

Lemma after_visitP v last a poses (p q : W) : number p \in poses -> List.In a (alternatives v) ->
  visits_by M (turned_back v) last a p q -> number q \in after_visit T marker v last poses.
Proof.
move=> p_in a_in /onwardP q_onward; rewrite /after_visit.
pose by_alternative d found a := foldl add_pose found (onward T marker (turned_back v) last a d).
pose by_pose found d := foldl (by_alternative d) found (alternatives v).
have one d found a' : consistent found -> consistent (by_alternative d found a') /\
    forall x, x \in found.1 -> x \in (by_alternative d found a').1.
  move=> ok; have [ok' mem'] := add_posesP (onward T marker (turned_back v) last a' d) ok.
  by split=> // x x_in; apply: mem'; left.
have each d found ok := @fold_keeps _ (by_alternative d) (alternatives v) found (one d) ok.
have none_consistent : consistent ([::], empty) by move=> x; rewrite /has_entry find_empty.
have poses_in : List.In (number p) poses.
  by elim: poses p_in => //= d poses IH; rewrite inE => /predU1P[->|/IH]; [left | right].
have [_ _ all_in] := @fold_keeps _ by_pose poses ([::], empty)
  (fun found d ok => let: And3 ok' sub _ := each d found ok in conj ok' sub) none_consistent.
apply: all_in poses_in _ => found ok; have [_ _ in_each] := each (number p) found ok.
by apply: in_each a_in _ => found' ok'; apply: (add_posesP _ ok').2; right.
Qed.

Lemma after_visitsP visits poses (p : W) : makes M p visits -> number p \in poses ->
  after_visits T marker visits poses <> [::].
Proof.
elim: visits p poses => [|v visits IH] p poses /=; first by case: poses.
move=> [a [q [a_in p_q q_makes]]] p_in; case: poses p_in => // d poses p_in.
exact: IH q_makes (after_visitP p_in a_in p_q).
Qed.

Lemma alternative_atP s n a : alternative_at s n = Some a -> List.In a s.
Proof. by elim: s n => //= b s IH n; case: ifP => [_ [->]|_ /IH]; [left | right]. Qed.

Lemma wrong_choiceP part visits choices (p : W) : wrong_choice T marker part visits choices (number p) = None ->
  makes M p visits.
Proof.
elim: visits choices part p => [|v visits IH] [|[n door] choices] part p //=.
case aE: (alternative_at _ _) => [a|] //; case chosenE: (chosen _ _ _ _ _ _ _) => [e|] //.
suff [q qE p_q] : exists2 q, number q = e & visits_by M (turned_back v) (nilp visits) a p q.
  by rewrite -qE => /IH q_makes; exists a, q; split=> //; apply: alternative_atP aE.
move: chosenE; case: a {aE} => [|seen known] /=.
  case: door => // -[<-]; exists (if turned_back v then opposite p else p) => //.
  by case: (turned_back v); rewrite ?opposite_inE.
rewrite has_perceptP; case: eqP => //= seenE; have gE : N.to_nat seen.1 = degree p by case: seenE.
case: known door => [i|] [j|] //; rewrite ?ltbP ?gE.
- by case: ifP => // lt [<-]; exists (traverse p (N.to_nat i)); rewrite ?traverse_inE.
- case: (nilp visits) => //; case: ifP => // lt [<-]; exists (traverse p (N.to_nat j)); rewrite ?traverse_inE //.
  by split=> //; exists (N.to_nat j).
by case: (nilp visits) => // -[<-]; exists p.
Qed.

End Visits.

(** * Two worlds *)

Section Pairs.

Variables (T U : tables) (V W : start) (number : V -> N) (number' : W -> N) (marker : marker_word).
Hypotheses (T_fits : fits T number) (U_fits : fits U number').

Let M := marker_of marker.

Lemma same_perceptP (p : V) (q : W) :
  same_percept T U marker marker (number p) (number' q) = (perceive M p == perceive M q).
Proof.
by rewrite /same_percept /perceive xpair_eqE eqbP !degree_inE // same_sightingP !sighting_inE.
Qed.

Lemma is_pair_table pairs x y : is_pair (pair_table pairs) x y -> (x, y) \in pairs.
Proof.
rewrite /pair_table; suff: forall t, is_pair (foldl (fun t pair => put t pair.1
      (put (odflt empty (find t pair.1)) pair.2 tt)) t pairs) x y -> is_pair t x y || ((x, y) \in pairs).
  by move=> /(_ empty) H /H; rewrite /is_pair find_empty.
elim: pairs => [|[a b] pairs IH] t /=; first by rewrite orbF.
move/IH/orP=> [|in_pairs]; last by rewrite inE in_pairs !orbT.
rewrite /is_pair find_put inE xpair_eqE; case: eqP => [->|_ -> //] /=; rewrite /has_entry find_put.
by case: eqP => [->|_]; rewrite ?eqxx ?orbT //; case: (find t a) => [ys|] /=; rewrite ?find_empty // => ->.
Qed.

Lemma wrong_pairP t part pairs : wrong_pair T U marker marker t part pairs = None ->
  forall x y, (x, y) \in pairs -> exists (p : V) (q : W), [/\ number p = x, number' q = y,
    perceive M p = perceive M q
    & forall i, i < degree p -> is_pair t (number (traverse p i)) (number' (traverse q i))].
Proof.
elim: pairs part => //= -[x y] pairs IH part; case: ifP => // /negbFE/(dart_setP T_fits)[p <-].
case: ifP => // /negbFE/(dart_setP U_fits)[q <-]; case: ifP => // /negbFE; rewrite same_perceptP => /eqP same.
case: ifP => // /all_belowP closed /IH later x' y'; rewrite inE => /predU1P[[-> ->]|]; last exact: later.
exists p, q; split=> // i lt; have := closed (N.of_nat i); rewrite !traverse_inE // degree_inE // Nnat.Nat2N.id.
exact.
Qed.

Lemma pairs_alike pairs part : wrong_pair T U marker marker (pair_table pairs) part pairs = None ->
  forall x y, (x, y) \in pairs -> exists (p : V) (q : W), [/\ number p = x, number' q = y & alike M p q].
Proof.
move/wrong_pairP=> right; have all_alike ds (p : V) (q : W) : (number p, number' q) \in pairs ->
    percepts M p ds = percepts M q ds.
  elim: ds p q => [|i ds IH] p q /right[p' [q' [/(number_inj T_fits)-> /(number_inj U_fits)-> same next]]] /=.
    by rewrite same.
  rewrite same; congr (_ :: _); apply: IH; apply: is_pair_table.
  have := next (i %% degree p); rewrite ltn_mod degree_gt0 /traverse turn_mod.
  have -> : degree p = degree q by case: same.
  by rewrite turn_mod; apply.
move=> x y in_pairs; have [p [q [pE qE _ _]]] := right x y in_pairs; exists p, q; split=> // ds.
by apply: all_alike; rewrite pE qE.
Qed.

Lemma not_distinguishedP (p : V) (q : W) doors :
  not_distinguished T U marker marker (number p) (number' q) doors = None ->
  [/\ passable p (doors_of doors), passable q (doors_of doors)
    & percepts M p (doors_of doors) <> percepts M q (doors_of doors)].
Proof.
elim: doors p q => [|i doors IH] p q /=.
  by rewrite same_perceptP; case: eqP => // neq _; split=> // -[degrees sights]; apply: neq; congr (_, _).
rewrite !ltbP !degree_inE //; case: ifP => // /andP[-> ->]; rewrite !traverse_inE // => /IH[-> -> neq].
by split=> // -[].
Qed.

Lemma not_all_distinguishedP part walks : not_all_distinguished T U marker marker part walks = None ->
  forall pair doors, (pair, doors) \in walks -> exists (p : V) (q : W), [/\ number p = pair.1, number' q = pair.2
    & [/\ passable p (doors_of doors), passable q (doors_of doors)
        & percepts M p (doors_of doors) <> percepts M q (doors_of doors)]].
Proof.
elim: walks part => //= -[[x y] ds] walks IH part; case: ifP => // /negbFE/(dart_setP T_fits)[p <-].
case: ifP => // /negbFE/(dart_setP U_fits)[q <-]; case apart: (not_distinguished _ _ _ _ _ _ _) => // /IH later.
move=> pair doors; rewrite inE => /predU1P[[-> ->]|]; last exact: later.
by exists p, q; split=> //; apply: not_distinguishedP.
Qed.

End Pairs.

Section Images.

Variables (T U : tables) (V W : start) (number : V -> N) (number' : W -> N).
Hypotheses (T_fits : fits T number) (U_fits : fits U number').

Lemma find_fold_pairs (S : Type) (f g : N * N -> N) (pairs : seq (N * N)) x y :
  find (foldl (fun t pair => put t (f pair) (g pair)) empty pairs) x = Some y ->
  exists2 pair, pair \in pairs & f pair = x /\ g pair = y.
Proof.
suff: forall t, find (foldl (fun t pair => put t (f pair) (g pair)) t pairs) x = Some y ->
    find t x = Some y \/ exists2 pair, pair \in pairs & f pair = x /\ g pair = y.
  by move=> /(_ empty) H /H; rewrite find_empty => -[].
elim: pairs => [|pair pairs IH] t /=; first by left.
case/IH => [|[pair' in_pairs found]]; last by right; exists pair'; rewrite ?inE ?in_pairs ?orbT.
rewrite find_put; case: eqP => [-> [<-]|_]; last by left.
by right; exists pair; rewrite ?mem_head.
Qed.

Lemma wrong_imageP images part pairs : wrong_image T U images part pairs = None ->
  forall x y, (x, y) \in pairs -> exists (p : V) (q : W), [/\ number p = x, number' q = y
    & [/\ find images x = Some y,
          find images (number (opposite p)) = Some (number' (opposite q))
        & find images (number (clockwise p)) = Some (number' (clockwise q))]].
Proof.
elim: pairs part => //= -[x y] pairs IH part; case: ifP => // /negbFE/(dart_setP T_fits)[p <-].
case: ifP => // /negbFE/(dart_setP U_fits)[q <-]; rewrite !opposite_inE // (find_next T_fits) (find_next U_fits) /=.
case: ifP => // /and3P[/eqP here /eqP opp /eqP cw] /IH later x' y'.
rewrite inE => /predU1P[[-> ->]|]; last exact: later.
by exists p, q.
Qed.

Lemma images_isomorphic pairs : check_isomorphic T U pairs = Accepted -> isomorphic V W.
Proof.
rewrite /check_isomorphic; case wrongE: (wrong_image _ _ _ _ _) => [[part reason]|] //; case: ifP => // _.
set images := image_table pairs in wrongE *; set origins := foldl _ _ _.
case: (first_not (has_entry images) _) (@first_notP (has_entry images) (dart_list T)) => // /(_ erefl) imaged.
set back := fun p => _; case: (first_not back _) (@first_notP back (dart_list T)) => // /(_ erefl) backs.
case: (first_not _ _) (@first_notP (has_entry origins) (dart_list U)) => // /(_ erefl) all_origins _.
have right := wrong_imageP wrongE.
have in_T (d : V) : number d \in dart_list T by apply/(dart_listP T_fits); exists d.
have in_U (e : W) : number' e \in dart_list U by apply/(dart_listP U_fits); exists e.
have image (d : V) : exists e, find images (number d) == Some (number' e).
  have /has_entryP[y findE] := imaged _ (in_T d).
  have [[x y'] in_pairs /= [xE yE]] := find_fold_pairs N findE; rewrite xE yE in in_pairs.
  by have [p [q [_ <- [-> _ _]]]] := right _ _ in_pairs; exists q.
pose f d := xchoose (image d).
have fE d : find images (number d) = Some (number' (f d)) := eqP (xchooseP (image d)).
have fP d e : find images (number d) = Some (number' e) -> f d = e.
  by rewrite fE => -[/(number_inj U_fits)].
have f_kept d : f (opposite d) = opposite (f d) /\ f (clockwise d) = clockwise (f d).
  have [[x y] in_pairs /= [xE yE]] := find_fold_pairs N (fE d); rewrite xE yE in in_pairs.
  have [p [q [/(number_inj T_fits)-> /(number_inj U_fits)-> [_ opp cw]]]] := right _ _ in_pairs.
  by split; apply: fP.
have f_inj : injective f.
  move=> d d' same; have := backs _ (in_T d); have := backs _ (in_T d'); rewrite /back !fE same.
  by case: (find origins _) => // x /eqP[->] /eqP[/(number_inj T_fits)].
have f_onto e : exists d, f d == e.
  have /has_entryP[x findE] := all_origins _ (in_U e).
  have [[x' y'] in_pairs /= [yE xE]] := find_fold_pairs N findE; rewrite xE yE in in_pairs.
  have [d [e' [dE /(number_inj U_fits)<- [here _ _]]]] := right _ _ in_pairs.
  by exists d; apply/eqP/fP; rewrite dE here.
have f_onto' e : f (xchoose (f_onto e)) = e := eqP (xchooseP (f_onto e)).
exists f; split=> [|d|d]; [|by have [] := f_kept d|by have [] := f_kept d].
by exists (fun e => xchoose (f_onto e)) => // d; apply: f_inj.
Qed.

Lemma not_all_refutedP (p : V) part walks : not_all_refuted T U (number p) part walks = None ->
  forall x y doors, ((x, y), doors) \in walks -> exists q : W, number' q = y /\
    ~ indistinguishable directional (Start p) (Start q).
Proof.
elim: walks part => //= -[[x' y'] ds] walks IH part; case: ifP => // _.
case: ifP => // /negbFE/(dart_setP U_fits)[q <-]; case apart: (not_distinguished _ _ _ _ _ _ _) => // /IH later.
move=> x y doors; rewrite inE => /predU1P[[_ -> _]|]; last exact: later.
exists q; split=> // same; have [_ _] := not_distinguishedP (fits_facing p T_fits) (fits_facing q U_fits) apart.
by apply; apply: same.
Qed.

Lemma walks_not_isomorphic walks : check_not_isomorphic T U walks = Accepted -> ~ isomorphic V W.
Proof.
case: walks => // -[[x y] ds] walks; rewrite /check_not_isomorphic; set all_walks := _ :: _.
case: ifP => // /negbFE/(dart_setP T_fits)[p <-]; case wrongE: (not_all_refuted _ _ _ _ _) => [[part reason]|] //.
set compared := set_of _.
case: (first_not _ _) (@first_notP (has_entry compared) (dart_list U)) => // /(_ erefl) all_compared _ [f iso].
have /all_compared : number' (f p) \in dart_list U by apply/(dart_listP U_fits); exists (f p).
rewrite has_entry_set_of => in_compared.
have [[[x' y'] doors] in_walks yE] : exists2 walk, walk \in all_walks & walk.1.2 = number' (f p).
  move: in_compared; suff: forall s, number' (f p) \in foldl (fun s walk => walk.1.2 :: s) s all_walks ->
      number' (f p) \in s \/ exists2 walk, walk \in all_walks & walk.1.2 = number' (f p).
    by move=> /(_ [::]) H /H[].
  elim: all_walks {wrongE compared all_compared} => [|walk rest IH] s /=; first by left.
  case/IH=> [|[walk' in_rest walkE]]; last by right; exists walk'; rewrite ?inE ?in_rest ?orbT.
  by rewrite inE => /predU1P[->|]; [right; exists walk; rewrite ?mem_head | left].
have [q [qE]] := not_all_refutedP wrongE in_walks; case.
apply: isomorphic_starts_indistinguishable directional_invariant _; exists f; split=> //.
by apply: (number_inj U_fits); rewrite /= qE -yE.
Qed.

End Images.

(** * The claims *)

Lemma first_wrongP i ts : first_wrong i ts = None -> forall j, j < size ts ->
  forall t0 T0, let: (t, T) := nth (t0, T0) ts j in wrong_world t T = None.
Proof.
elim: ts i => //= -[t T] ts IH i; case wrongE: (wrong_world t T) => // /IH later [|j] //= lt t0 T0.
exact: later.
Qed.

Lemma checker_sound (s : setting) (c : claim) : check (prepare s) c = Accepted -> claim_true s c.
Proof.
rewrite /check; case wrongE: (world_wrong _) => [[i reason]|] //.
case: s wrongE => ts marker walk visits run /= /first_wrongP right.
have right_t t us : ts = t :: us -> wrong_world t (tables_of t) = None.
  by move=> tsE; have := right 0; rewrite tsE => /(_ isT t (tables_of t)).
have right_u t u us : ts = [:: t, u & us] -> wrong_world u (tables_of u) = None.
  by move=> tsE; have := right 1; rewrite tsE => /(_ isT t (tables_of t)).
case: c => [from steps|steps contra|from|from|pairs|walks|pairs|walks|from choices|from|lines] /=.
- case: ts right_t {right right_u} => [|t [|? ?]] //= /(_ _ _ erefl) t_right; case: walk => [text|] //=.
  case: visits run => [?|] [?|] //=; rewrite /check_determined; case: marker => //; case: ifP => // /negbFE from_in.
  case differsE: (differs _ _ _ _ _ _) => [[visit reason]|] //.
  case knowsE: (after_all _ _ _ _ _) => [k|[? ?]] //; case: ifP => // complete_k _.
  apply: in_worldP => // W number T_fits; have /(dart_setP T_fits)[p pE] := from_in.
  rewrite -pE in differsE; have [p_sees p_passable] := differsP T_fits differsE.
  have knows_at (V : start) (q : V) : percepts directional q (doors_of (door_lines text)) = seen_of text ->
      knows text q k.
    by move=> sees; apply: (@knows_after_all WordDirectional _ _ erefl _ q sees _ _ _ _ (knows_nothing q) knowsE).
  exists p => //; split=> // V q q_sees; apply: alike_isomorphism.
  apply: (covers_alike (w := walked_of text) (k := k)) => //; try exact: knows_at.
  by apply: (@complete_covers WordDirectional _ _ erefl _ p p_sees) => //; apply: knows_at.
- case: ts {right right_u right_t} => //=; case: walk => [text|] //=.
  case: visits run => [?|] [?|] //=; rewrite /check_unexplained; case: ifP => // _.
  case knowsE: (after_all _ _ _ _ _) => [k|[? ?]] //.
  case contraE: (not_contradictory _ _ _ _) => // _ V q [sees doors_exist].
  have known := knows_after_all erefl sees (knows_nothing q) knowsE.
  exact: (contradicted erefl sees known doors_exist contraE).
- case: ts right_t {right right_u} => [|t [|? ?]] //= /(_ _ _ erefl) t_right; case: walk => [text|] //=; last first.
    case: visits run => [?|] [r|] //=; rewrite /check_runs; case: ifP => // /negbFE from_in.
    case wrongE: (wrong_in_run _ _ _ _) => // _.
    apply: in_worldP => // W number T_fits; have /(dart_setP T_fits)[p pE] := from_in.
    by exists p => //; rewrite -pE in wrongE; apply/(wrong_in_runE r p T_fits).
  case: visits run => [?|] [?|] //=; rewrite /check_conforms; case: ifP => // /negbFE from_in.
  case differsE: (differs _ _ _ _ _ _) => [[visit reason]|] // _.
  apply: in_worldP => // W number T_fits; have /(dart_setP T_fits)[p pE] := from_in.
  by exists p => //; rewrite -pE in differsE; apply: differsP differsE.
- case: ts right_t {right right_u} => [|t [|? ?]] //= /(_ _ _ erefl) t_right; case: walk => [text|] //=; last first.
    case: visits run => [?|] [r|] //=; rewrite /check_runs_nowhere; set poses := odflt _ _; case: (first_not _ _) => //.
    set differs_from := (X in first_not X).
    case: (first_not _ _) (@first_notP differs_from poses) => // /(_ erefl) all_differ _.
    apply: in_worldP => // W number T_fits p p_in /(wrong_in_runE r p T_fits) runs_p.
    have p_poses : number p \in poses.
      by rewrite /poses; case: from p_in {poses all_differ} => //= _; apply/(dart_listP T_fits); exists p.
    by have := all_differ _ p_poses; rewrite /differs_from runs_p.
  case: visits run => [?|] [?|] //=; rewrite /check_diverges; set poses := odflt _ _; case: (first_not _ _) => //.
  set both := foldl _ _ _.
  case remainE: (remain _ _ _ _ _) => [|[? ?] ?] // _.
  apply: in_worldP => // W number T_fits p p_in [sees doors_exist].
  suff in_both : (number p, number p) \in both by apply: (remainP T_fits in_both sees doors_exist remainE).
  have p_poses : number p \in poses.
    by rewrite /poses; case: from p_in {poses both remainE} => //= _; apply/(dart_listP T_fits); exists p.
  exact: (mem_fold_filter (test := xpredT) (fun d => (d, d)) [::] p_poses).
- case: ts right_t right_u {right} => [|t [|u [|? ?]]] //= /(_ _ _ erefl) t_right /(_ _ _ _ erefl) u_right.
  case: walk => [?|] //=; case: visits run => [?|] [?|] //=.
  case: pairs => // pair pairs; set all_pairs := pair :: pairs; rewrite /refused_at.
  case wrongE: (wrong_pair _ _ _ _ _ _ _) => [[? ?]|] // _.
  apply: in_worldP => // V number T_fits; apply: in_worldP => // W number' U_fits [x y] in_pairs.
  have [p [q [pE qE same]]] := pairs_alike T_fits U_fits wrongE in_pairs.
  by exists p => //; exists q.
- case: ts right_t right_u {right} => [|t [|u [|? ?]]] //= /(_ _ _ erefl) t_right /(_ _ _ _ erefl) u_right.
  case: walk => [?|] //=; case: visits run => [?|] [?|] //=.
  case: walks => // first walks; set all_walks := first :: walks; rewrite /refused_at.
  case wrongE: (not_all_distinguished _ _ _ _ _ _) => [[? ?]|] // _.
  apply: in_worldP => // V number T_fits; apply: in_worldP => // W number' U_fits pair doors in_walks.
  have [p [q [pE qE apart]]] := not_all_distinguishedP T_fits U_fits wrongE in_walks.
  by exists p => //; exists q.
- case: ts right_t right_u {right} => [|t [|u [|? ?]]] //= /(_ _ _ erefl) t_right /(_ _ _ _ erefl) u_right.
  case: walk => [?|] //=; case: visits run => [?|] [?|] //= accepted.
  apply: in_worldP => // V number T_fits; apply: in_worldP => // W number' U_fits.
  exact: (images_isomorphic T_fits U_fits accepted).
- case: ts right_t right_u {right} => [|t [|u [|? ?]]] //= /(_ _ _ erefl) t_right /(_ _ _ _ erefl) u_right.
  case: walk => [?|] //=; case: visits run => [?|] [?|] //= accepted.
  apply: in_worldP => // V number T_fits; apply: in_worldP => // W number' U_fits.
  exact: (walks_not_isomorphic T_fits U_fits accepted).
- case: ts right_t {right right_u} => [|t [|? ?]] //= /(_ _ _ erefl) t_right; case: walk => [?|] //=.
  case: visits run => [visits|] [?|] //=; rewrite /check_fits; case: ifP => // /negbFE from_in; rewrite /refused_at.
  case wrongE: (wrong_choice _ _ _ _ _ _) => [[? ?]|] // _.
  apply: in_worldP => // W number T_fits; have /(dart_setP T_fits)[p pE] := from_in.
  by exists p => //; rewrite -pE in wrongE; apply: wrong_choiceP wrongE.
- case: ts right_t {right right_u} => [|t [|? ?]] //= /(_ _ _ erefl) t_right; case: walk => [?|] //=.
  case: visits run => [visits|] [?|] //=; rewrite /check_misfits; set poses := odflt _ _; case: (first_not _ _) => //.
  case afterE: (after_visits _ _ _ _) => [|? ?] // _.
  apply: in_worldP => // W number T_fits p p_in p_makes.
  suff p_poses : number p \in poses by apply: (after_visitsP T_fits p_makes p_poses afterE).
  by rewrite /poses; case: from p_in {poses afterE} => //= _; apply/(dart_listP T_fits); exists p.
case: ts {right right_u right_t} => //=; case: walk => [?|] //=; case: visits run => [visits|] [?|] //= accepted V p.
exact: impossible_sound accepted V p.
Qed.
