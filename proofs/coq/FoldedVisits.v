(** What the folding explorer computes from its trail is true: darts that it makes one are one dart of the world,
    if its assumption holds; and its ways lead where it expects. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Folding FoldingExplorer Walks Arithmetic Parts.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma turnDC (G : embedded_graph) (p : G) i j : turn p (i + j) = turn (turn p j) i.
Proof. by rewrite addnC turnD. Qed.

Section Visits.

Variables (W : start) (trail : seq visit) (spots : seq W).

(** The dart of the world for which a dart of the trail stands, from the poses of the visits. *)
Definition spot (k : nat) : W := nth (facing W) spots k.
Definition image (x : trail_dart) : W := turn (spot x.1) x.2.

(** The world explains the trail. *)
Record explains : Prop := Explains {
  ex_size : size spots = size trail;
  ex_some : 0 < size trail;
  ex_facing : spot 0 = facing W;
  ex_seen : forall k, k < size trail -> perceived trail k = perceive directional (spot k);
  ex_came : forall k, 0 < k < size trail ->
    (came_from trail k).1 < size trail /\ spot k = opposite (image (came_from trail k))
}.

(** Visits that are taken for one place are one place. *)
Record right_classes (f : classes) : Prop := RightClasses {
  rc_size : size f = size trail;
  rc_class : forall k, k < size trail -> (nth (0, 0) f k).1 < size trail /\ spot k = image (nth (0, 0) f k)
}.

Hypothesis ex : explains.

Let deg k : k < size trail -> (perceived trail k).1 = degree (spot k).
Proof. by move=> lt; rewrite ex_seen. Qed.

Section Right.

Variable f : classes.
Hypothesis right : right_classes f.

Lemma standing_for_right x : x.1 < size trail ->
  [/\ (standing_for trail f x).1 < size trail, image (standing_for trail f x) = image x
    & (standing_for trail f x).2 < degree (spot (standing_for trail f x).1)].
Proof.
move=> lt; have [r_lt atE] := rc_class right lt; rewrite /standing_for.
case: (nth _ f x.1) r_lt atE => r i /= r_lt atE; rewrite deg // ltn_mod degree_gt0; split=> //.
by rewrite /image /= turn_mod atE /image /= -turnD addnC.
Qed.

Lemma unite_right x y : x.1 < size trail -> y.1 < size trail -> image x = image y ->
  exists2 f', unite trail f x y = Some f' & right_classes f'.
Proof.
move=> x_lt y_lt same; have [r_lt xE a_lt] := standing_for_right x_lt.
have [s_lt yE b_lt] := standing_for_right y_lt; move: xE yE; rewrite -{}same {x_lt y_lt} /unite.
case: (standing_for _ _ x) (standing_for _ _ y) r_lt s_lt a_lt b_lt => r a [s b] /= r_lt s_lt a_lt b_lt <-.
rewrite /image /= => same; case: eqP => [rs|_].
  move: same b_lt; rewrite -rs => /turn_eq same b_lt; move: same; rewrite !modn_small // => ->.
  by rewrite eqxx; exists f.
have degrees : degree (spot r) = degree (spot s).
  by rewrite -(degree_turn (spot r) a) -same degree_turn.
have -> : agree (perceived trail r) (perceived trail s) a b.
  rewrite /agree !ex_seen //= degrees eqxx /= /directional.
  have near_eq : same_vertex (spot r) (facing W) = same_vertex (spot s) (facing W).
    have near p q : same_vertex p q -> same_vertex q (facing W) -> same_vertex p (facing W).
      exact: same_vertex_trans.
    have rs : same_vertex (spot r) (spot s).
      apply: same_vertex_trans (same_vertex_turn _ a) _.
      by rewrite -same same_vertex_sym same_vertex_turn.
    by apply/idP/idP; apply: near => //; rewrite same_vertex_sym.
  rewrite near_eq; case: ifP => // near_s; apply/eqP; rewrite -?degrees; apply: (@turn_eq _ (spot r)).
  have at_r : turn (spot r) (findex clockwise (spot r) (facing W)) = facing W.
    by apply: iter_findex; rewrite -/(same_vertex _ _) near_eq.
  have at_s : turn (spot s) (findex clockwise (spot s) (facing W)) = facing W by apply: iter_findex.
  by rewrite (turnD _ _ b) at_r (turnDC _ _ a) -same -turnDC turnD at_s.
eexists; first by []; split=> [|k lt]; first by rewrite size_map rc_size.
have [c_lt atE] := rc_class right lt; rewrite (nth_map (0, 0)) ?(rc_size right) //.
case: eqP => [cs|//] /=; split=> //; rewrite atE /image cs /= deg // turn_mod.
have -> : (nth (0, 0) f k).2 + (a + degree (spot r) - b) = a + (degree (spot r) - b) + (nth (0, 0) f k).2.
  by rewrite addnC addnBA // degrees ltnW.
rewrite turnD turnD -same -(turnD _ b) degrees subnKC; last exact: ltnW.
by rewrite turn_degree.
Qed.

End Right.

(** * Edges of the trail *)

Lemma passage_ends p : is_passage trail p ->
  [/\ (from_dart trail p).1 < size trail, (to_dart trail p).1 < size trail
    & image (to_dart trail p) = opposite (image (from_dart trail p))].
Proof.
move=> ok; case/andP: (ok) => _ lt; have [came atE] := ex_came ex ok.
rewrite /from_dart /to_dart; case: ifP => _; split=> //=.
by rewrite {2}/image /= atE oppositeK.
Qed.

Lemma mem_passages p : p \in passages trail -> is_passage trail p.
Proof.
rewrite mem_cat => /orP[]/mapP[k]; rewrite mem_iota => /andP[k_gt k_lt] ->; rewrite /is_passage /= k_gt /=;
  by move: k_lt; rewrite add1n prednK // ex_some.
Qed.

Lemma first_conflict_in ends x' y' : first_conflict ends = Some (x', y') ->
  exists x, (x, x') \in ends /\ (x, y') \in ends.
Proof.
elim: ends => //= -[z z'] others IH.
case found: [seq _ | _ <- _ & _] => [|w s].
  by move/IH=> [x [in_x in_y]]; exists x; rewrite !inE in_x in_y !orbT.
case=> <- <-; exists z; rewrite inE eqxx; split=> //; rewrite inE.
have : w \in [seq y.2 | y <- others & (y.1 == z) && (y.2 != z')] by rewrite found mem_head.
case/mapP=> -[u u']; rewrite mem_filter => /andP[/= /andP[/eqP-> _] in_u] ->.
by rewrite in_u orbT.
Qed.

Lemma close_right fuel f : right_classes f ->
  exists2 f', close trail fuel f = Some f' & right_classes f'.
Proof.
elim: fuel f => [|fuel IH] f right /=; case found: (first_conflict _) => [[x y]|]; try by exists f.
have [z [in_x in_y]] := first_conflict_in found.
have end_at w w' : (w, w') \in [seq (standing_for trail f (from_dart trail p),
      standing_for trail f (to_dart trail p)) | p <- passages trail] ->
    w'.1 < size trail /\ image w' = opposite (image w).
  case/mapP=> p /mem_passages/passage_ends[from_lt to_lt edge] [-> ->].
  have [_ fromE _] := standing_for_right right from_lt; have [lt toE _] := standing_for_right right to_lt.
  by rewrite fromE toE.
have [x_lt xE] := end_at _ _ in_x; have [y_lt yE] := end_at _ _ in_y.
have [|f' -> right'] := unite_right right x_lt y_lt; first by rewrite xE yE.
exact: IH.
Qed.

Lemma fold_with_right f x y : right_classes f -> x.1 < size trail -> y.1 < size trail -> image x = image y ->
  exists2 f', fold_with trail f x y = Some f' & right_classes f'.
Proof.
move=> right x_lt y_lt same; rewrite /fold_with.
by have [f' -> right'] := unite_right right x_lt y_lt same; apply: close_right.
Qed.

(** * Ways along the trail *)

Section Ways.

Variable f : classes.
Hypothesis right : right_classes f.

Lemma between_right x y i g : x.1 < size trail -> y.1 < size trail -> between trail f x y = Some (i, g) ->
  [/\ turn (image x) i = image y, i < degree (image x) & g = degree (image x)].
Proof.
move=> x_lt y_lt; have [r_lt <- a_lt] := standing_for_right right x_lt.
have [s_lt <- b_lt] := standing_for_right right y_lt; rewrite /between.
case: (standing_for _ _ x) (standing_for _ _ y) r_lt s_lt a_lt b_lt => r a [s b] /= r_lt s_lt a_lt b_lt.
rewrite deg //; case: eqP => // rs [<- <-]; move: b_lt; rewrite -rs => b_lt.
rewrite /image /= degree_turn ltn_mod degree_gt0; split=> //.
by rewrite -turnD -turn_mod modnDmr subnKC ?modnDr ?turn_mod // (leq_trans (ltnW a_lt)) ?leq_addl.
Qed.

Lemma doors_through_right here way x front last : here.1 < size trail -> x.1 < size trail ->
  doors_through trail f here way x = Some (front, last) ->
  let doors := unzip1 (rcons front last) in
  [/\ walk (image here) doors = opposite (image x), passable (image here) doors,
      taken (image here) doors = rcons front last & size front = size way].
Proof.
elim: way here front last => [|p way IH] here front last here_lt x_lt /=.
  case step: between => [[i g]|//] [<- <-] /=; have [out i_lt ->] := between_right here_lt x_lt step.
  by rewrite /traverse out i_lt.
case: ifP => // ok; have [from_lt to_lt edge] := passage_ends ok.
case step: between => [[i g]|//]; have [out i_lt ->] := between_right here_lt from_lt step.
case rest: doors_through => [[front' last']|//] [<- <-] /=.
have [walked open_doors took sizes] := IH _ _ _ to_lt x_lt rest.
have -> : traverse (image here) i = image (to_dart trail p) by rewrite /traverse out edge.
by rewrite walked open_doors took i_lt sizes.
Qed.

End Ways.

End Visits.

(** * One more visit *)

Section MoreVisits.

Variables (W : start) (trail : seq visit) (spots : seq W).
Hypothesis ex : explains trail spots.

Variables (x : trail_dart) (q : W).
Hypotheses (x_lt : x.1 < size trail) (arrives : q = opposite (image spots x)).

Let trail' := rcons trail (x, perceive directional q).
Let spots' := rcons spots q.

Lemma spot_rcons k : k < size trail -> spot spots' k = spot spots k.
Proof. by move=> lt; rewrite /spot nth_rcons (ex_size ex) lt. Qed.

Lemma spot_new : spot spots' (size trail) = q.
Proof. by rewrite /spot nth_rcons (ex_size ex) ltnn eqxx. Qed.

Lemma image_rcons y : y.1 < size trail -> image spots' y = image spots y.
Proof. by move=> lt; rewrite /image spot_rcons. Qed.

Lemma image_new i : image spots' (size trail, i) = turn q i.
Proof. by rewrite /image spot_new. Qed.

Lemma explains_rcons : explains trail' spots'.
Proof.
have some := ex_some ex; split; rewrite ?size_rcons ?(ex_size ex) //.
- by rewrite spot_rcons // (ex_facing ex).
- move=> k; rewrite ltnS leq_eqVlt => /predU1P[->|lt].
    by rewrite spot_new /perceived nth_rcons ltnn eqxx.
  by rewrite spot_rcons // /perceived nth_rcons lt; apply: ex_seen ex k lt.
move=> k /andP[k_gt]; rewrite ltnS leq_eqVlt => /predU1P[->|lt].
  by rewrite spot_new /came_from nth_rcons ltnn eqxx /= image_rcons // ltnW.
rewrite spot_rcons // /came_from nth_rcons lt -/(came_from trail k).
have [|came ->] := ex_came ex (k := k); first by rewrite k_gt.
by rewrite image_rcons // ltnW.
Qed.

Lemma right_rcons f : right_classes trail spots f -> right_classes trail' spots' (rcons f (size trail, 0)).
Proof.
move=> right; split; rewrite !size_rcons ?(rc_size right) // => k.
rewrite ltnS leq_eqVlt nth_rcons (rc_size right) => /predU1P[->|lt].
  by rewrite ltnn eqxx /= spot_new image_new.
rewrite lt; have [c_lt atE] := rc_class right lt; rewrite spot_rcons // atE image_rcons //.
by rewrite ltnW.
Qed.

Lemma arrived_right K base' strayed' moves : FoldingExplorer.trail K = trail ->
  right_classes trail spots (folding K) ->
  right_classes trail' spots' (folding (arrived K x (perceive directional q) base' strayed' moves)).
Proof.
move=> trailE right; rewrite /arrived trailE /= -/trail'; have right' := right_rcons right.
have ex' := explains_rcons.
case seen: (directional q) => [||j|||||||];
  try by have [f' -> //] := close_right ex' (size trail') right'.
have near : same_vertex q (facing W) /\ turn q j = facing W.
  by move: seen; rewrite /directional; case: ifP => // near [<-]; rewrite /turn iter_findex.
have [|||f' -> //] := fold_with_right ex' (x := (0, 0)) (y := (size trail, j)) right'.
- by rewrite size_rcons.
- by rewrite size_rcons /=.
by rewrite image_new near.2; apply: (ex_facing ex').
Qed.

End MoreVisits.
