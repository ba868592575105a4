(** What the checker refutes, visit by visit, no robot has done: whichever alternatives are chosen of its visits, their
    walk is impossible in every start. *)

From Coq Require Import BinNat FMapPositive.
From Coq Require List Nnat.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Parts Verdicts Checker Moves CheckerTables CheckerSteps.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Longer tables *)

Lemma table_of_rcons A (s : seq A) a : table_of (rcons s a) = put (table_of s) (length s) a.
Proof.
rewrite /table_of -cats1 foldl_cat /=; congr put.
rewrite /length; elim: s (empty : table A) N0 => //= b s IH t n; exact: IH.
Qed.

Lemma length_rcons A (s : seq A) a : length (rcons s a) = N.succ (length s).
Proof. by rewrite /length -cats1 foldl_cat. Qed.

(** * Longer walks *)

Definition longer (text : walk_text) (i : N) (seen : N * sighting_word) : walk_text :=
  WalkText (rcons (see_lines text) seen) (rcons (door_lines text) i).

Lemma next_visitE w text i seen :
  in_order w = walked_of text -> in_order (next_visit w i seen) = walked_of (longer text i seen).
Proof.
case: w text => [[sees doors] percepts taken n m] [sees' doors'] [<- <- -> -> -> ->].
by rewrite /in_order /walked_of /longer /= !rev_cons !table_of_rcons !length_rcons.
Qed.

(** Nothing else depends on the order of the lines. *)
Lemma after_in_order marker w k s : after marker (in_order w) k s = after marker w k s.
Proof. by []. Qed.

Lemma not_contradictory_in_order marker w k c :
  not_contradictory marker (walk_for c w) k c = not_contradictory marker (in_order w) k c.
Proof. by case: c. Qed.

Section Choices.

Variable marker : marker_word.

Let M := marker_of marker.

Section Walks.

Variables (V : start) (q : V).

Let end_of (text : walk_text) : V := walk q (doors_of (door_lines text)).

(** What is known says nothing of later visits. *)
Definition no_later (text : walk_text) (k : knowledge) := forall v, ~~ (is_visit text v) -> find (labels k) v = None.

Lemma is_visit_longer text i seen v : is_visit text v -> is_visit (longer text i seen) v.
Proof. by rewrite /is_visit !size_map size_rcons; apply: leqW. Qed.

Lemma visit_pose_longer text i seen v :
  is_visit text v -> visit_pose (longer text i seen) q v = visit_pose text q v.
Proof. by rewrite /is_visit /visit_pose /longer /doors_of /= map_rcons -cats1 => le; rewrite takel_cat. Qed.

Lemma knows_longer text i seen k :
  knows text q k -> no_later text k -> knows (longer text i seen) q k /\ no_later (longer text i seen) k.
Proof.
move=> known later; split=> v.
  case: (boolP (is_visit text v)) => [v_in _|/later none v_in].
    have [s_in poseE] := known v v_in; split; first exact: is_visit_longer.
    by rewrite /walked_dart !visit_pose_longer.
  by rewrite /label none.
by move=> v_out; apply: later; apply: contra v_out => /is_visit_longer.
Qed.

Lemma no_later_relabel text w k to from :
  is_visit text from.1 -> no_later text k -> no_later text (relabel w k to from).
Proof.
case: to from => [r a] [s b] s_in later; rewrite /relabel.
case: (class k r) => count visits; case: (class k s) => count' visits'.
set shift := N.add _ _; set move := fun labels' visit => _.
suff all_later labels' : (forall v, ~~ is_visit text v -> find labels' v = None) ->
    forall v, ~~ is_visit text v -> find (foldl move labels' visits') v = None by apply: all_later.
elim: visits' labels' => //= u visits' IH labels' labels_later; apply: IH => v v_out.
rewrite /move; case labelE: (odflt _ (find labels' u)) => [s' o]; case: eqP => [s'E|_]; last exact: labels_later.
rewrite find_put; case: eqP => [vu|_]; last exact: labels_later.
by move: labelE; rewrite -vu labels_later //= => -[vs' _]; rewrite vs' s'E s_in in v_out.
Qed.

(** The robot has made a walk, about which this is known. *)
Definition walks_so text (w : walked) (k : knowledge) : Prop :=
  [/\ in_order w = walked_of text, percepts M q (doors_of (door_lines text)) = seen_of text,
      passable q (doors_of (door_lines text)), knows text q k & no_later text k].

Lemma no_later_after text w k s k' : walks_so text w k -> after marker w k s = inl k' -> no_later text k'.
Proof.
move=> [wE sees _ known later]; rewrite -after_in_order /after; case showsE: (shows _ _ _ _) => [[x y]|] //.
have [x_in y_in _] := showsP wE sees known showsE.
have [rx_in _ _] := name_ofP wE sees known x_in; have [ry_in _ _] := name_ofP wE sees known y_in.
case: ifP => // _; case: ifP => // _ [<-].
by case: ifP => // _; case: ifP => _; apply: no_later_relabel.
Qed.

Lemma walks_unite_all text w k lines k' rest :
  walks_so text w k -> unite_all marker w k lines = inl (k', rest) -> walks_so text w k'.
Proof.
elim: lines k => [|line lines IH] k walked; first by case=> <-.
case: line => [n d|s|contra|]; [by case=> <- | | by case=> <- | by case=> <-].
rewrite /= -after_in_order; case afterE: (after _ _ _ _) => [k1|] //; apply: IH.
have [wE sees exist known later] := walked; split=> //; first exact: (knows_after wE sees known afterE).
by apply: no_later_after walked _; rewrite -after_in_order; apply: afterE.
Qed.

Lemma walks_first seen :
  perceive M q = percept_of seen -> walks_so (WalkText [:: seen] [::]) (first_visit seen) nothing_known.
Proof.
by move=> sees; split=> //; [rewrite /seen_of /= -sees | apply: knows_nothing | move=> v _; apply: find_empty].
Qed.

Lemma walks_next text w k i seen : walks_so text w k -> N.to_nat i < degree (end_of text) ->
  perceive M (traverse (end_of text) (N.to_nat i)) = percept_of seen ->
  walks_so (longer text i seen) (next_visit w i seen) k.
Proof.
move=> [wE sees exist known later] lt here; have [known' later'] := knows_longer i seen known later.
split=> //; first exact: next_visitE wE.
  rewrite /longer /seen_of /doors_of /= !map_rcons -/(seen_of text) -/(doors_of (door_lines text)).
  by rewrite percepts_rcons sees walk_rcons here.
by rewrite /longer /doors_of /= map_rcons passable_rcons exist.
Qed.

(** ** Back at the last vertex *)

Lemma seen_again_turn (p : V) turn_ seen seen' : perceive M p = percept_of seen ->
  perceive M (turn p (N.to_nat turn_) : V) = percept_of seen' -> seen_again marker turn_ seen seen'.
Proof.
case: seen seen' => [g s] [g' s'] [gE sE] [g'E s'E]; rewrite /seen_again /= eqbP -gE -g'E degree_turn eqxx /=.
have near d : same_vertex (turn p (N.to_nat turn_)) d = same_vertex p d.
  apply/idP/idP => [|near]; first exact: same_vertex_trans (same_vertex_turn _ _).
  by apply: same_vertex_trans near; rewrite same_vertex_sym same_vertex_turn.
have same : M p = M (turn p (N.to_nat turn_)) -> same_sighting s s' by rewrite same_sightingP -sE -s'E => ->.
move: sE s'E same; rewrite {}/M; case: marker => //=.
- by move=> sE s'E /(_ erefl); move: sE; case: (s).
- rewrite /undirected near => sE s'E /(_ erefl); move: sE; case: ifP => _; case: (s) => //.
- rewrite /directional near; case: ifP => [p_near|_] sE s'E; last first.
    by move=> /(_ erefl); move: sE; case: (s).
  have [i -> iE] := sighting_of_pointing (esym sE); have [j -> jE] := sighting_of_pointing (esym s'E) => _.
  rewrite eqbP !to_nat_mod to_natD -gE; apply/eqP/turn_eq; rewrite turnD jE iE /turn !iter_findex //.
  exact: etrans (near _) p_near.
- rewrite /two_identical !near => sE s'E /(_ erefl); move: sE; by case: ifP => _; case: ifP => _; case: (s).
- rewrite /two_distinct /two_looks !near => sE s'E /(_ erefl); move: sE; by case: ifP => _; case: ifP => _; case: (s).
Qed.

End Walks.

(** ** The next visit *)

(** The robot has made its walk. *)
Definition walked_so (V : start) (c : choice_walk) : Prop :=
  if c is Leaves turned i w k then exists (q : V) text, walks_so q text w k else True.

(** With this pose it can come to the next vertex. *)
Definition comes_so (V : start) (c : choice_walk) (p : V) : Prop :=
  if c is Leaves turned i w k then
    exists (q : V) text, walks_so q text w k /\ let d : V := walk q (doors_of (door_lines text)) in
      N.to_nat i < degree d /\ p = if turned then turn d (N.to_nat i) else traverse d (N.to_nat i)
  else True.

Lemma last_percept (V : start) (q : V) text w k : walks_so q text w k ->
  perceive M (walk q (doors_of (door_lines text)) : V) =
  percept_of (degree_at w (N.pred (visits w)), sighting_at w (N.pred (visits w))).
Proof.
move=> [wE sees _ _ _]; set last := N.pred _.
have lastE : N.to_nat last = size (doors_of (door_lines text)).
  rewrite /last Nnat.N2Nat.inj_pred -[visits w]/(visits (in_order w)) wE lengthE.
  by rewrite -(size_map percept_of) -/(seen_of text) -sees size_percepts.
have last_in : is_visit text last by rewrite /is_visit lastE.
rewrite /percept_of /= (degree_atE wE sees last_in) (sighting_atE wE sees last_in).
by rewrite /visit_pose lastE take_size.
Qed.

(** Whether the door is known, where one is taken. *)
Definition door_chosen (last : bool) (a : alternative) : bool := if a is Junction _ None then last else true.

Lemma with_choiceP (V : start) back last a c (p p' : V) : comes_so c p -> visits_by M back last a p p' ->
  door_chosen last a ->
  exists c', [/\ with_choice marker back a c = Some c', walked_so V c' & ~~ last -> comes_so c' p'].
Proof.
case: a => [|seen door] p_so p_p' known.
  case: c p_so => [|turned i w k] /= p_so; first by exists Begins.
  exists (Leaves (back (+) turned) i w k); case: p_so => q [text [walked [lt pE]]].
  split=> // [|_]; first by exists q, text.
  exists q, text; split=> //; split=> //; rewrite p_p' pE.
  by case: (back); case: (turned); rewrite /= ?/traverse ?oppositeK.
have [here p'E] : perceive M p = percept_of seen /\
    (~~ last -> N.to_nat (odflt N0 door) < degree p /\ p' = traverse p (N.to_nat (odflt N0 door))).
  by case: door p_p' known => [j [seenE lt ->]|/= [seenE _] ->].
case: c p_so => [|[] i w k] /= p_so.
- exists (Leaves false (odflt N0 door) (first_visit seen) nothing_known); split=> //=.
    by exists p, (WalkText [:: seen] [::]); apply: walks_first.
  by move/p'E=> [lt ->]; exists p, (WalkText [:: seen] [::]); split=> //; apply: walks_first.
- case: p_so => q [text [walked [lt pE]]]; have lastE := last_percept walked.
  set g := degree_at _ _ in lastE *; have gE : N.to_nat g = degree (walk q (doors_of (door_lines text)) : V).
    by case: lastE.
  have -> : seen_again marker i (g, sighting_at w (N.pred (visits w))) seen.
    by apply: seen_again_turn lastE _; rewrite -pE.
  exists (Leaves false (N.modulo (N.add i (odflt N0 door)) g) w k); split=> //=; first by exists q, text.
  move/p'E=> [lt' ->]; exists q, text; split=> //; rewrite to_nat_mod to_natD gE ltn_mod degree_gt0; split=> //.
  by rewrite /traverse turn_mod turnD pE.
case: p_so => q [text [walked [lt pE]]]; rewrite pE in here.
have walked' := walks_next walked lt here.
exists (Leaves false (odflt N0 door) (next_visit w i seen) k); split=> //=; first by exists q, (longer text i seen).
move/p'E=> [lt' ->]; exists q, (longer text i seen); split=> //.
by rewrite /longer /doors_of /= map_rcons walk_rcons -pE.
Qed.

(** ** All choices *)

Lemma numbers_belowP T (fuel : seq T) n js : numbers_below fuel N0 n = Some js ->
  forall i, i < N.to_nat n -> List.In (N.of_nat i) js.
Proof.
move=> jsE i; suff: forall j js, numbers_below fuel j n = Some js -> N.to_nat j <= i < N.to_nat n ->
    List.In (N.of_nat i) js by move=> /(_ _ _ jsE); rewrite leq0n.
elim: fuel {js jsE} => [|a fuel IH] j js /=; rewrite eqbP; case: eqP => [->|neq].
- by move=> _ /andP[le lt]; rewrite ltnNge le in lt.
- by [].
- by move=> _ /andP[le lt]; rewrite ltnNge le in lt.
case jsE: (numbers_below _ _ _) => [js'|] //= [<-] /andP[]; rewrite leq_eqVlt => /predU1P[<- _|lt lt'].
  by left; rewrite Nnat.N2Nat.id.
by right; apply: IH jsE _; rewrite to_natS lt.
Qed.

Lemma all_choicesP T (fuel : seq T) (V : start) back last number s choices a (p p' : V) :
  all_choices fuel last number s = Some choices -> List.In a s -> visits_by M back last a p p' ->
  exists n door a', [/\ List.In (n, door, a') choices, visits_by M back last a' p p'
    & door_chosen last a'].
Proof.
move=> choicesE a_in p_p'; elim: s number choices choicesE a_in => //= b s IH number choices.
case laterE: (all_choices _ _ _ _) => [later|] //; set here := match b with NoVertex => _ | _ => _ end.
move=> hereE; case=> [bE|/(IH _ _ laterE)]; last first.
  case=> n [door [a' [a'_in p_a' known]]]; exists n, door, a'; split=> //.
  move: hereE; rewrite /here.
  case: (b) => [|seen [i|]]; [by case=> <-; right | by case=> <-; right | case: (last); first by case=> <-; right].
  case: (numbers_below _ _ _) => //= js [<-]; apply/List.in_or_app; by right.
rewrite {}bE in here hereE; move: hereE p_p'; rewrite /here; case: (a) => [|seen [i|]] /=.
- by case=> <-; exists number, None, NoVertex; split=> //; left.
- by case=> <-; exists number, None, (Junction seen (Some i)); split=> //; left.
case: (last); first by case=> <- p_p'; exists number, None, (Junction seen None); split=> //; left.
case jsE: (numbers_below _ _ _) => [js|] //= [<-] [seenE [i lt ->]].
exists number, (Some (N.of_nat i)), (Junction seen (Some (N.of_nat i))); rewrite /= Nnat.Nat2N.id; split=> //.
apply/List.in_or_app; left; apply/List.in_map_iff; exists (N.of_nat i); split=> //.
by apply: numbers_belowP jsE _ _; have -> : N.to_nat seen.1 = degree p by case: seenE.
Qed.

Lemma refuteP vs c lines rest : refute marker vs c lines = inl rest ->
  forall (V : start) (p : V), comes_so c p -> ~ makes M p vs.
Proof.
elim: vs c lines rest => [|v others IH] c lines rest //=.
case choicesE: (all_choices _ _ _ _) => [choices|] //.
set each := (X in X choices lines = _).
suff eachP choices' lines' rest' : each choices' lines' = inl rest' ->
    forall n door a (V : start) (p p' : V), List.In (n, door, a) choices' -> comes_so c p ->
      visits_by M (turned_back v) (nilp others) a p p' -> door_chosen (nilp others) a ->
      ~ makes M p' others.
  move=> /eachP refuted V p p_so [a [p' [a_in p_p' p'_makes]]].
  have [n [door [a' [a'_in p_a' known]]]] := all_choicesP choicesE a_in p_p'.
  exact: (refuted _ _ _ V p p' a'_in p_so p_a' known p'_makes).
elim: choices' lines' rest' {choices choicesE lines rest} => //= -[[n door] a] choices IHc lines rest.
case: lines => [|[n' door'|s|contra|] after_choice] //; case: ifP => // _.
match goal with |- match ?closed with inl _ => _ | inr _ => _ end = _ -> _ =>
  case closedE: closed => [rest1|wrong] end; last by [].
move/IHc=> later n0 door0 a0 V p p'.
case=> [[_ _ <-]|a0_in]; last exact: (later _ _ _ V p p' a0_in).
move=> p_so p_p' known p'_makes; have [c' [c'E c'_so next]] := with_choiceP p_so p_p' known.
move: closedE; rewrite c'E; case: c' c'_so next {c'E} => [_ _|turned i w k [q [text walked]] next].
  by move/IH/(_ V p' I).
case uniteE: (unite_all _ _ _ _) => [[k' lines]|] //.
have go_on : refute marker others (Leaves turned i w k') lines = inl rest1 -> False.
  case: others next p'_makes IH {each IHc later p_p' known} => // v' others next p'_makes IH /IH/(_ V p') refuted.
  apply: refuted p'_makes; have [q' [text' [walked' comes]]] := next isT; exists q', text'; split=> //.
  exact: walks_unite_all walked' uniteE.
case: lines uniteE go_on => [|[n1 d1|s|contra|] lines] uniteE go_on //; rewrite not_contradictory_in_order.
case contraE: (not_contradictory _ _ _ _) => // _.
have [wE sees exist known' _] := walks_unite_all walked uniteE.
exact: (contradicted wE sees known' exist contraE).
Qed.

End Choices.

(** The claim. *)
Lemma impossible_sound marker visits lines : check_impossible marker visits lines = Accepted ->
  forall (V : start) (p : V), ~ makes (marker_of marker) p visits.
Proof.
rewrite /check_impossible; case refuteE: (refute _ _ _ _) => [rest|[rest reason]] // _ V p.
exact: refuteP refuteE V p I.
Qed.
