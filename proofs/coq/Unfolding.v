(** The folded trail as a world: with a dead end behind each open dart it has the percepts of the walk. So
    has the world with one more vertex before such a dead end, and a walk whose folded trail has an open dart
    does not determine its world. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Bisimulation Parts Complete Subdivision Trail.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Unfolding.

Variables (W : start) (doors : seq door).

Let n := size doors.
Let visit := 'I_n.+1.

Notation seen := (sees W doors).

Definition pose_at (i : visit) : W := walk (facing W) (take i doors).

(** The dart by which the robot leaves. *)
Definition leaving (i : visit) : W := turn (pose_at i) (nth 0 doors i).

Lemma pose_next (i j : visit) : j = i.+1 :> nat -> pose_at j = opposite (leaving i).
Proof.
move=> ji; rewrite /pose_at ji pose_step //.
by have := ltn_ord j; rewrite ji ltnS.
Qed.

(** The walk goes between these visits, over the edge of this dart of the first of them. *)
Definition went (i j : visit) (d : W) : bool :=
  (j == i.+1 :> nat) && (d == leaving i) || (i == j.+1 :> nat) && (d == pose_at i).

Lemma went_back i j d : went i j d -> went j i (opposite d).
Proof.
case/orP=> /andP[/eqP ij /eqP ->]; rewrite /went.
  by rewrite -(pose_next ij) ij !eqxx orbT.
by rewrite (pose_next ij) oppositeK ij !eqxx.
Qed.

Lemma went_at i j d : went i j d -> same_vertex (pose_at i) d.
Proof.
by case/orP=> /andP[_ /eqP->]; [apply: same_vertex_turn | apply: same_vertex_refl].
Qed.

(** * The visits of one vertex, as far as the folded trail shows *)

Definition at_marker (i : visit) := same_vertex (pose_at i) (facing W).

Definition fold_step (R : {set visit * visit}) : {set visit * visit} :=
  [set x | [|| x.1 == x.2, at_marker x.1 && at_marker x.2, (x.2, x.1) \in R,
            [exists z, ((x.1, z) \in R) && ((z, x.2) \in R)]
          | [exists i, exists j, exists d, [&& (i, j) \in R, went i x.1 d & went j x.2 d]]]].

Lemma fold_step_mono : {homo fold_step : R R' / R \subset R'}.
Proof.
move=> R R' /subsetP sub; apply/subsetP=> -[i j]; rewrite !inE /=.
case/orP=> [->//|]; case/orP=> [->|]; first by rewrite orbT.
case/orP=> [/sub->|]; first by rewrite !orbT.
case/orP=> [/existsP[z /andP[/sub iz /sub zj]]|/existsP[k /existsP[l /existsP[d /and3P[/sub kl ki lj]]]]].
  by apply/orP; right; apply/orP; right; apply/orP; right; apply/orP; left; apply/existsP; exists z; rewrite iz.
do 4!(apply/orP; right); apply/existsP; exists k; apply/existsP; exists l; apply/existsP; exists d.
by rewrite kl ki.
Qed.

Definition one (i j : visit) : bool := (i, j) \in fixset fold_step.

Lemma oneE i j :
  one i j = [|| i == j, at_marker i && at_marker j, one j i, [exists z, one i z && one z j]
            | [exists k, exists l, exists d, [&& one k l, went k i d & went l j d]]].
Proof. by rewrite {1}/one -(fixsetK fold_step_mono) inE. Qed.

Lemma one_refl i : one i i. Proof. by rewrite oneE eqxx. Qed.

Lemma one_marked i j : at_marker i -> at_marker j -> one i j.
Proof. by rewrite oneE => -> ->; rewrite orbT. Qed.

Lemma one_sym i j : one i j -> one j i.
Proof. by move=> ij; rewrite oneE ij !orbT. Qed.

Lemma one_trans i j k : one i j -> one j k -> one i k.
Proof.
move=> ij jk; rewrite oneE; do 3!(apply/orP; right); apply/orP; left.
by apply/existsP; exists j; rewrite ij.
Qed.

Lemma one_went i j k l d : one k l -> went k i d -> went l j d -> one i j.
Proof.
move=> kl ki lj; rewrite oneE; do 4!(apply/orP; right); apply/existsP; exists k.
by apply/existsP; exists l; apply/existsP; exists d; rewrite kl ki.
Qed.

Lemma one_ind (P : visit -> visit -> Prop) :
  (forall i, P i i) -> (forall i j, at_marker i -> at_marker j -> P i j) ->
  (forall i j, P i j -> P j i) -> (forall i j k, one i j -> P i j -> P j k -> P i k) ->
  (forall i j k l d, P k l -> went k i d -> went l j d -> P i j) ->
  forall i j, one i j -> P i j.
Proof.
move=> P_refl P_marked P_sym P_trans P_went; rewrite /one /fixset.
elim: #|_| => [|m IH] i j; first by rewrite inE.
rewrite /= inE /= => /orP[/eqP-> | /orP[/andP[mi mj] | /orP[ji | /orP[/existsP[z /andP[iz zj]] |]]]].
- exact: P_refl.
- exact: P_marked.
- exact/P_sym/IH.
- apply: P_trans (IH _ _ iz) (IH _ _ zj); rewrite /one.
  by apply: (subsetP (iter_sub_fix fold_step_mono m)).
case/existsP=> k /existsP[l /existsP[d /and3P[kl]]]; exact: P_went (IH _ _ kl).
Qed.

Lemma one_same_vertex i j : one i j -> same_vertex (pose_at i) (pose_at j).
Proof.
move: i j; apply: one_ind => [i|i j|i j|i j k _|i j k l d _].
- exact: same_vertex_refl.
- by move=> mi mj; apply: same_vertex_trans mi _; rewrite same_vertex_sym.
- by rewrite same_vertex_sym.
- exact: same_vertex_trans.
move=> /went_back/went_at i_d /went_back/went_at j_d; apply: same_vertex_trans i_d _.
by rewrite same_vertex_sym.
Qed.

(** * It is the relation of the definition *)

Notation dart := (dart_of W doors).

Lemma dart_ofE (i : visit) a : dart (i : nat, a) = turn (pose_at i) a.
Proof. by []. Qed.

Lemma folded_around (i : visit) a b : dart (i : nat, a) = dart (i : nat, b) ->
  folded doors seen (i : nat, a) (i : nat, b).
Proof.
have le : i <= size doors by rewrite -ltnS.
rewrite !dart_ofE => /turn_eq; rewrite -(degree_seenE _ le) => same.
have mod c : folded doors seen (i : nat, c) (i : nat, c %% degree_seen seen i).
  rewrite {1}(divn_eq c (degree_seen seen i)) addnC.
  elim: (c %/ _) => [|k IH]; first by rewrite addn0; apply: Same.
  by rewrite mulSn addnCA addnC; apply: Linked (Around _ _ _ _) IH.
by apply: Linked (mod a) _; rewrite same; apply: Swapped.
Qed.

Lemma folded_shift x y k : folded doors seen x y -> folded doors seen (x.1, x.2 + k) (y.1, y.2 + k).
Proof.
move=> xy; elim: k => [|k IH]; first by rewrite !addn0 -!surjective_pairing.
by rewrite !addnS; apply: (Turned IH).
Qed.

(** If one dart of two visits is one dart, then all darts of these visits are. *)
Lemma folded_vertex (i j : visit) a b :
  folded doors seen (i : nat, a) (j : nat, b) ->
  forall c d, dart (i : nat, c) = dart (j : nat, d) -> folded doors seen (i : nat, c) (j : nat, d).
Proof.
move=> ab c d cd; have same := folding_sound ab.
have /same_vertexP[k cE] : same_vertex (dart (i : nat, a)) (dart (i : nat, c)).
  rewrite !dart_ofE; apply: same_vertex_trans _ (same_vertex_turn _ _).
  by rewrite same_vertex_sym same_vertex_turn.
apply: Linked (_ : folded _ _ _ (i : nat, a + k)) _.
  by apply: folded_around; rewrite cE !dart_ofE turnD.
apply: Linked (folded_shift k ab) _; apply: folded_around.
by rewrite -cd cE same !dart_ofE /= turnD.
Qed.

(** The trail's edges are those that the walk goes over. *)
Lemma went_one_edge i j d : went i j d ->
  exists a b, [/\ dart (i : nat, a) = d, dart (j : nat, b) = opposite d
                & one_edge doors (i : nat, a) (j : nat, b)].
Proof.
case/orP=> /andP[/eqP ij /eqP->].
  have lt : i < size doors by have := ltn_ord j; rewrite ij ltnS.
  by exists (nth 0 doors i), 0; rewrite !dart_ofE -(pose_next ij) ij; split=> //; apply: Onward.
have lt : j < size doors by have := ltn_ord i; rewrite ij ltnS.
exists 0, (nth 0 doors j); rewrite !dart_ofE (pose_next ij) oppositeK ij.
by split=> //; apply: Backward.
Qed.

Lemma one_edge_went x y : one_edge doors x y ->
  exists i j : visit, [/\ x.1 = i, y.1 = j & went i j (dart x)].
Proof.
case=> k lt; have lt1 : k < n.+1 by apply: ltnW.
  exists (Ordinal lt1), (Ordinal (lt : k.+1 < n.+1)); split=> //.
  by rewrite /went /= eqxx /dart_of /= eqxx.
exists (Ordinal (lt : k.+1 < n.+1)), (Ordinal lt1); split=> //.
by rewrite /went /= !eqxx orbT.
Qed.

Lemma one_folded i j : one i j ->
  forall a b, dart (i : nat, a) = dart (j : nat, b) -> folded doors seen (i : nat, a) (j : nat, b).
Proof.
move: i j; apply: one_ind => [i|i j mi mj|i j IH|i j k ij IH1 IH2|i j k l d IH ki lj] a b.
- exact: folded_around.
- have pointing (k : visit) : at_marker k ->
      sighting_seen seen k = Pointing (findex clockwise (pose_at k) (facing W)).
    move=> mk; have le : k <= size doors by rewrite -ltnS.
    by rewrite /sighting_seen nth_percepts //= /directional; case: ifP => // /negP[].
  exact: (folded_vertex (@Marked doors _ _ _ _ _ (pointing i mi) (pointing j mj))).
- by move=> ab; apply/Swapped/IH.
- have /same_vertexP[c cE] : same_vertex (pose_at j) (dart (i : nat, a)).
    apply: same_vertex_trans (same_vertex_turn (pose_at i) a).
    by rewrite same_vertex_sym one_same_vertex.
  by move=> ab; apply: Linked (IH1 a c cE) (IH2 c b _); rewrite -ab cE.
have [a1 [b1 [aE bE edge]]] := went_one_edge ki.
have [a2 [b2 [aE' bE' edge']]] := went_one_edge lj.
apply: folded_vertex (Beyond edge edge' (IH _ _ _)) _ _ => //.
by rewrite aE aE'.
Qed.

Lemma folded_one x y : folded doors seen x y ->
  x = y \/ exists i j : visit, [/\ x.1 = i, y.1 = j & one i j].
Proof.
elim=> {x y} [x|x y _|x y z _ xy _ yz|k i|k i l j|x y _|x x' y y' xx' yy' xy].
- by left.
- by case=> [->|[i [j [xi yj ij]]]]; [left | right; exists j, i; rewrite one_sym].
- case: xy yz => [->//|[i [j [xi yj ij]]]] [<-|[j' [k [yj' zk jk]]]]; right; first by exists i, j.
  exists i, k; split=> //; apply: one_trans ij _; suff -> : j = j' by [].
  by apply: val_inj; rewrite /= -yj.
- case: (ltnP k n.+1) => [lt|gt]; first by right; exists (Ordinal lt), (Ordinal lt); rewrite one_refl.
  by left; rewrite /degree_seen nth_default ?addn0 // size_sees.
- move=> /sighting_seenP[k_le _ mk] /sighting_seenP[l_le _ ml]; right.
  by exists (Ordinal (k_le : k < n.+1)), (Ordinal (l_le : l < n.+1)); rewrite one_marked.
- by case=> [->|[i [j [xi yj ij]]]]; [left | right; exists i, j].
move=> same; right; have dxy := folding_sound xy.
have [i [i' [xi x'i' ii']]] := one_edge_went xx'; have [j [j' [yj y'j' jj']]] := one_edge_went yy'.
exists i', j'; split=> //; have ij : one i j.
  case: same => [xy'|[k [l [xk yl]]]].
    have -> : i = j by apply: val_inj; rewrite /= -xi -yj xy'.
    exact: one_refl.
  suff [-> ->] : k = i /\ l = j by [].
  by split; apply: val_inj; rewrite /= -?xk -?xi -?yl -?yj.
by apply: one_went ij ii' _; rewrite dxy.
Qed.

(** One visit stands for all visits of a vertex. *)
Definition first_visit (i : visit) : visit := odflt i [pick j | one i j].

Lemma one_first i : one i (first_visit i).
Proof. by rewrite /first_visit; case: pickP => //= _; apply: one_refl. Qed.

Lemma first_eq i j : one i j -> first_visit i = first_visit j.
Proof.
move=> ij; rewrite /first_visit.
have -> : [pick k | one i k] = [pick k | one j k].
  apply: eq_pick => k /=; apply/idP/idP; [exact: one_trans (one_sym ij) | exact: one_trans].
by case: pickP => // /(_ j); rewrite one_refl.
Qed.

Lemma first_first i : first_visit (first_visit i) = first_visit i.
Proof. exact/esym/first_eq/one_first. Qed.

(** Where a dart of a vertex leads, if the walk has gone over its edge. *)
Definition link (i : visit) (d : W) : option visit :=
  omap (fun kl => first_visit kl.2) [pick kl : visit * visit | one i kl.1 && went kl.1 kl.2 d].

Lemma link_went i k l d : one i k -> went k l d -> link i d = Some (first_visit l).
Proof.
move=> ik kl; rewrite /link; case: pickP => [[k' l'] /= /andP[ik' kl']|/(_ (k, l))]; last by rewrite /= ik kl.
congr Some; apply: first_eq; apply: one_went kl' kl; exact: one_trans (one_sym ik') ik.
Qed.

Lemma link_some i d j : link i d = Some j -> exists k l, [/\ one i k, went k l d & j = first_visit l].
Proof.
by rewrite /link; case: pickP => [[k l] /andP[ik kl] [<-]|//]; exists k, l.
Qed.

Lemma link_back i d j : first_visit i = i -> link i d = Some j -> link j (opposite d) = Some i.
Proof.
move=> ii /link_some[k [l [ik /went_back kl ->]]].
by rewrite (link_went (one_sym (one_first l)) kl) -ii; congr Some; apply/esym/first_eq.
Qed.

Lemma link_at i d j : link i d = Some j -> first_visit j = j /\ same_vertex (pose_at j) (opposite d).
Proof.
move=> /link_some[k [l [_ /went_back/went_at l_d ->]]]; split; first exact: first_first.
by apply: same_vertex_trans l_d; rewrite same_vertex_sym one_same_vertex // one_first.
Qed.

Lemma followedP (i : visit) a :
  followed doors seen (i : nat, a) <-> link (first_visit i) (dart (i : nat, a)) != None.
Proof.
split=> [[y [z [xy yz]]]|].
  have [k [l [yk zl kl]]] := one_edge_went yz; rewrite (folding_sound xy).
  rewrite (link_went _ kl) //; apply: one_trans (one_sym (one_first i)) _.
  case: (folded_one xy) => [xy'|[i' [k' [/= ii' yk' ik]]]].
    have -> : i = k by apply: val_inj; rewrite /= -yk -xy'.
    exact: one_refl.
  suff [-> ->] : i = i' /\ k = k' by [].
  by split; apply: val_inj => //=; rewrite -yk.
case linked: (link _ _) => [j|//] _; have [k [l [ik kl _]]] := link_some linked.
have [b [c [kb _ edge]]] := went_one_edge kl.
exists (k : nat, b), (l : nat, c); split=> //; apply: one_folded; last by rewrite kb.
exact: one_trans (one_first i) ik.
Qed.

(** * The folded trail with dead ends *)

(** A dart is one of a first visit, or the dead end behind it, if it is open. *)
Definition raw_dart := (visit * W * bool)%type.

Definition is_dart (z : raw_dart) : bool :=
  [&& first_visit z.1.1 == z.1.1, same_vertex (pose_at z.1.1) z.1.2 & z.2 ==> (link z.1.1 z.1.2 == None)].

Definition raw_opposite (z : raw_dart) : raw_dart :=
  let: (i, d, dead_end) := z in
  if dead_end then (i, d, false)
  else if link i d is Some j then (j, opposite d, false) else (i, d, true).

Definition raw_clockwise (z : raw_dart) : raw_dart :=
  let: (i, d, dead_end) := z in if dead_end then z else (i, clockwise d, false).

Lemma is_dart_opposite z : is_dart z -> is_dart (raw_opposite z).
Proof.
case: z => [[i d] []] /and3P[/= first near open]; first by rewrite /is_dart /= first near.
case linked: (link i d) => [j|]; last by rewrite /is_dart /= first near linked.
by have [first_j near_j] := link_at linked; rewrite /is_dart /= first_j eqxx near_j.
Qed.

Lemma is_dart_clockwise z : is_dart z -> is_dart (raw_clockwise z).
Proof.
case: z => [[i d] []] // /and3P[/= first near open]; rewrite /is_dart /= first andbT /=.
exact: same_vertex_trans near (same_vertex_turn d 1).
Qed.

Definition unfolded_dart := {z : raw_dart | is_dart z}.

Definition pack z (ok : is_dart z) : unfolded_dart := exist _ z ok.

Definition unfolded_opposite (z : unfolded_dart) : unfolded_dart :=
  pack (is_dart_opposite (valP z)).

Definition unfolded_clockwise (z : unfolded_dart) : unfolded_dart :=
  pack (is_dart_clockwise (valP z)).

Lemma unfolded_oppositeK : involutive unfolded_opposite.
Proof.
case=> [[[i d] dead_end] ok]; apply: val_inj => /=; case/and3P: ok => /= /eqP first _.
case: dead_end => /= [/eqP->//|_].
case linked: (link i d) => [j|] //=.
by rewrite (link_back first linked) oppositeK.
Qed.

Lemma unfolded_opposite_neq z : unfolded_opposite z != z.
Proof.
apply/eqP=> /(congr1 val); case: z => [[[i d] []] ok] //=.
by case: (link i d) => [j [_ /eqP]|//]; rewrite (negPf (opposite_neq d)).
Qed.

Lemma unfolded_clockwise_inj : injective unfolded_clockwise.
Proof.
move=> [[[i d] b] ok] [[[i' d'] b'] ok'] /(congr1 val) /= same; apply: val_inj => /=.
by case: b b' same {ok ok'} => -[] //= [-> /(@clockwise_inj W)->].
Qed.

Definition root_visit : visit := ord0.

Lemma facing_is_dart : is_dart (first_visit root_visit, facing W, false).
Proof.
apply/and3P; split=> //=; first by rewrite first_first.
have -> : facing W = pose_at root_visit by rewrite /pose_at take0.
by rewrite same_vertex_sym one_same_vertex // one_first.
Qed.

Definition unfolded_facing : unfolded_dart := pack facing_is_dart.

(** The dart of a visit. *)
Lemma visit_is_dart (i : visit) d : same_vertex (pose_at i) d -> is_dart (first_visit i, d, false).
Proof.
move=> near; apply/and3P; split=> //=; first by rewrite first_first.
by apply: same_vertex_trans near; rewrite same_vertex_sym one_same_vertex // one_first.
Qed.

Definition at_visit i d (near : same_vertex (pose_at i) d) : unfolded_dart := pack (visit_is_dart near).

Let step x y := (y == unfolded_opposite x) || (y == unfolded_clockwise x).

Lemma connect_around (z : unfolded_dart) (i : visit) d :
  val z = (first_visit i, d, false) -> same_vertex (pose_at i) d ->
  forall e (near : same_vertex (pose_at i) e), connect step z (at_visit near).
Proof.
move=> zE id e near; have /same_vertexP[k eE] : same_vertex d e.
  by apply: same_vertex_trans near; rewrite same_vertex_sym.
suff -> : at_visit near = iter k unfolded_clockwise z by apply: connect_iter_cw.
apply: val_inj; rewrite /= eE; elim: k {eE} => [|k /= <-] //.
Qed.

Lemma unfolded_connected x y : connect step x y.
Proof.
apply: (all_connected (root := unfolded_facing)); [exact: unfolded_oppositeK | exact: unfolded_clockwise_inj |].
have visited k : forall i : visit, i = k :> nat ->
    forall d (near : same_vertex (pose_at i) d), connect step unfolded_facing (at_visit near).
  elim: k => [|k IH] i ik d near.
    apply: connect_around => //; first by rewrite (_ : i = root_visit) //; apply: val_inj.
    by rewrite /pose_at ik take0 same_vertex_refl.
  have lt : k < n.+1 by rewrite -ik ltnW.
  pose j : visit := Ordinal lt; have ji : i = j.+1 :> nat by [].
  have near_j : same_vertex (pose_at j) (leaving j) by apply: same_vertex_turn.
  have go : went j i (leaving j) by rewrite /went ji !eqxx.
  apply: connect_trans (IH j erefl _ near_j) (connect_trans (connect_opp unfolded_opposite unfolded_clockwise _) _).
  apply: (@connect_around _ i (opposite (leaving j))); last exact: went_at (went_back go).
  by rewrite /= (link_went (one_sym (one_first j)) go).
case=> [[[i d] dead_end] ok]; case/and3P: (ok) => /= /eqP first near open.
have to_i := visited i i erefl d near.
have plain (ok' : is_dart (i, d, false)) : connect step unfolded_facing (pack ok').
  by congr (connect step _ _): to_i; apply: val_inj; rewrite /= first.
case: dead_end ok open => ok /=; last by move=> _; apply: plain.
move/eqP=> open; have ok' : is_dart (i, d, false) by rewrite /is_dart /= first eqxx near.
apply: connect_trans (plain ok') _.
have same : pack ok = unfolded_opposite (pack ok') by apply: val_inj; rewrite /= open.
rewrite -[exist _ _ _]/(pack ok) same; exact: connect_opp.
Qed.

Definition unfolded_graph : embedded_graph :=
  @EmbeddedGraph [finType of unfolded_dart] _ _ unfolded_oppositeK unfolded_opposite_neq unfolded_clockwise_inj
    unfolded_connected.

Definition unfolded : start := @Start unfolded_graph unfolded_facing.

(** ** The walk has the same percepts there *)

Let below (z : unfolded) : W := (val z).1.2.

Lemma turn_dart (z : unfolded) i : ~~ (val z).2 ->
  val (turn z i) = ((val z).1.1, turn (below z) i, false).
Proof.
rewrite /below; case: z => [[[j d] []] ok] //= _; elim: i => [|i IH] //=.
by rewrite IH.
Qed.

Lemma turn_dead_end (z : unfolded) i : (val z).2 -> turn z i = z.
Proof.
move=> dead; elim: i => //= i ->; apply: val_inj; rewrite /=.
by case: z dead => [[[j d] []] ok].
Qed.

Lemma below_turn (z : unfolded) : ~~ (val z).2 -> forall i, below (turn z i) = turn (below z) i.
Proof. by move=> plain i; rewrite {1}/below turn_dart. Qed.

Lemma below_one (z : unfolded) : ~~ (val z).2 -> forall i, below (turn z i) = below z -> turn z i = z.
Proof.
move=> plain i; rewrite below_turn // => same; apply: val_inj; rewrite turn_dart // same /below.
by case: z plain {same} => [[[j d] []] ok].
Qed.

Let nth_visit k : visit := inord k.

Lemma nth_visitK k : k <= n -> nth_visit k = k :> nat.
Proof. exact: inordK. Qed.

Lemma went_next k : k < n -> went (nth_visit k) (nth_visit k.+1) (leaving (nth_visit k)).
Proof. by move=> lt; rewrite /went !nth_visitK ?eqxx // ltnW. Qed.

Lemma pose_atE k : k <= n -> pose_at (nth_visit k) = walk (facing W) (take k doors).
Proof. by move=> le; rewrite /pose_at nth_visitK. Qed.

Lemma leavingE k : k <= n -> leaving (nth_visit k) = turn (walk (facing W) (take k doors)) (nth 0 doors k).
Proof. by move=> le; rewrite /leaving pose_atE // nth_visitK. Qed.

Lemma unfolded_walk k : k <= n ->
  val (walk (facing unfolded) (take k doors)) =
  (first_visit (nth_visit k), walk (facing W) (take k doors), false).
Proof.
elim: k => [|k IH] le; first by rewrite !take0 /=; congr (first_visit _, _, _); apply: val_inj; rewrite /= nth_visitK.
have {}IH := IH (ltnW le); rewrite !pose_step //; set z := walk _ _ in IH *.
have zE : val (turn z (nth 0 doors k)) = (first_visit (nth_visit k), leaving (nth_visit k), false).
  have plain : ~~ (val z).2 by rewrite IH.
  by rewrite turn_dart // /below IH leavingE ?(ltnW le).
rewrite [val _]/(raw_opposite (val (turn z (nth 0 doors k)))) zE /=.
rewrite (link_went (one_sym (one_first _)) (went_next le)) leavingE ?(ltnW le) //.
Qed.

Lemma unfolded_sees : sees unfolded doors = seen.
Proof.
apply: eq_percepts_walk => k le; have at_k := unfolded_walk le.
set z := walk _ _ in at_k *; have plain : ~~ (val z).2 by rewrite at_k.
have belowE : below z = walk (facing W) (take k doors) by rewrite /below at_k.
rewrite -belowE; apply/esym/part_perceive => //; [exact: below_turn | exact: below_one |].
move=> near; have marked : at_marker (nth_visit k) by rewrite /at_marker pose_atE // -belowE.
apply/same_vertexP; exists (findex clockwise (below z) (facing W)).
apply: val_inj; rewrite turn_dart // at_k /=; congr (_, _, _); last by rewrite /turn iter_findex.
apply/esym/first_eq/one_marked => //; rewrite /at_marker /pose_at take0; exact: same_vertex_refl.
Qed.

(** ** An open dart *)

Lemma traversesP (G : embedded_graph) (p : G) ds d : traverses p ds d ->
  exists2 k, k < size ds & turn (walk p (take k ds)) (nth 0 ds k) = d \/ walk p (take k.+1 ds) = d.
Proof.
elim: ds p => //= i ds IH p /or3P[/eqP<-|/eqP<-|/IH[k lt at_k]].
- by exists 0 => //; left.
- by exists 0 => //; right; rewrite take0.
by exists k.+1.
Qed.

Section Open.

Variables (i : visit) (d : W).
Hypotheses (near : same_vertex (pose_at i) d) (open : link (first_visit i) d = None).

Let e : unfolded := at_visit near.

Lemma open_avoided : ~~ traverses (facing unfolded) doors e.
Proof.
apply/negP=> /traversesP[k lt at_k].
suff [j [l [went_jl same]]] : exists j l, went j l d /\ first_visit j = first_visit i.
  have oj : one (first_visit i) j by rewrite -same one_sym // one_first.
  by have := link_went oj went_jl; rewrite open.
have le := ltnW lt; have here := unfolded_walk le; have there := unfolded_walk lt.
case: at_k => [out|back].
  exists (nth_visit k), (nth_visit k.+1); split.
    have := went_next lt; rewrite leavingE //.
    by have := congr1 below out; rewrite below_turn ?here // /below here /= => ->.
  by have := congr1 val out; rewrite turn_dart here //= => -[].
exists (nth_visit k.+1), (nth_visit k); split; last by have := congr1 val back; rewrite there => -[].
have step_k : nth_visit k.+1 = (nth_visit k).+1 :> nat by rewrite !nth_visitK.
have := went_back (went_next lt); rewrite -(pose_next step_k) pose_atE //.
by have := congr1 below back; rewrite /below there /= => ->.
Qed.

Lemma open_sees : sees (subdivided e) doors = seen.
Proof. by rewrite -unfolded_sees; apply: subdivided_percepts open_avoided. Qed.

End Open.

(** ** The class of the world *)

Lemma near_dart (x y : unfolded) : same_vertex x y -> ~~ (val x).2 ->
  [/\ (val y).1.1 = (val x).1.1, ~~ (val y).2 & same_vertex (below x) (below y)].
Proof.
case/same_vertexP=> i -> plain; rewrite turn_dart // below_turn //.
by split=> //; apply: same_vertex_turn.
Qed.

Lemma near_dead_end (x y : unfolded) : same_vertex x y -> (val x).2 -> y = x.
Proof. by case/same_vertexP=> i -> /turn_dead_end. Qed.

Lemma below_opposite (x : unfolded) : ~~ (val x).2 -> ~~ (val (opposite x)).2 ->
  below (opposite x) = opposite (below x).
Proof.
rewrite /below; case: x => [[[i d] []] ok] //= _; by case: (link i d).
Qed.

(** Behind a dart that the walk has not left open. *)
Lemma linked_dart (x : unfolded) : ~~ (val x).2 -> ~~ (val (opposite x)).2 ->
  exists k l a b, [/\ (val x).1.1 = first_visit k, (val (opposite x)).1.1 = first_visit l,
    dart (k : nat, a) = below x & one_edge doors (k : nat, a) (l : nat, b)].
Proof.
rewrite /below; case: x => [[[i d] []] ok] //= _; case/and3P: ok => /= /eqP first near _.
case linked: (link i d) => [j|] //= _; have [k [l [ik kl ->]]] := link_some linked.
have [a [b [aE _ edge]]] := went_one_edge kl; exists k, l, a, b; split=> //.
by rewrite -first; apply: first_eq.
Qed.

Lemma one_of_first (i j : visit) : first_visit i = first_visit j -> one i j.
Proof. by move=> same; apply: one_trans (one_first i) _; rewrite same one_sym // one_first. Qed.

Lemma one_at_vertex (i j : visit) a b : one i j -> at_vertex_of doors seen (i : nat, a) (j : nat, b).
Proof.
move=> ij; have /same_vertexP[c cE] : same_vertex (pose_at i) (dart (j : nat, b)).
  by apply: same_vertex_trans (one_same_vertex ij) _; apply: same_vertex_turn.
by exists c; apply: one_folded.
Qed.

Lemma unfolded_simple : simple_trail doors seen -> simple unfolded.
Proof.
move=> [no_loop no_parallel]; split=> [x|x y near far].
  apply/negP=> near; case dead: (val x).2.
    by have /eqP := near_dead_end near dead; rewrite (negPf (unfolded_opposite_neq x)).
  have plain : ~~ (val x).2 by rewrite dead.
  have [same plain' _] := near_dart near plain.
  have [k [l [a [b [kE lE _ edge]]]]] := linked_dart plain plain'.
  by apply: (no_loop _ _ edge); apply: one_at_vertex; apply: one_of_first; rewrite -kE -lE.
case dead: (val x).2; first by rewrite (near_dead_end near dead).
have plain : ~~ (val x).2 by rewrite dead.
have [same_first plain_y same] := near_dart near plain.
case end_x: (val (opposite x)).2.
  by apply: (inv_inj (@oppositeK unfolded)); rewrite (near_dead_end far end_x).
have plain_ox : ~~ (val (opposite x)).2 by rewrite end_x.
have [same_far plain_oy _] := near_dart far plain_ox.
have [k [l [a [b [kE lE aE edge]]]]] := linked_dart plain plain_ox.
have [k' [l' [a' [b' [k'E l'E a'E edge']]]]] := linked_dart plain_y plain_oy.
have same_below : below x = below y.
  rewrite -aE -a'E; apply/folding_sound/(no_parallel _ _ _ _ edge edge').
    by apply: one_at_vertex; apply: one_of_first; rewrite -kE -k'E same_first.
  by apply: one_at_vertex; apply: one_of_first; rewrite -lE -l'E same_far.
apply: val_inj; move: same_first plain plain_y same_below; rewrite /below.
by case: (val x) (val y) => [[j c] []] [[k2 e] []] //= -> _ _ ->.
Qed.

Lemma unfolded_degree bound : 0 < bound -> (forall k, k < size seen -> degree_seen seen k <= bound) ->
  forall x : unfolded, degree x <= bound.
Proof.
move=> some small x; case dead: (val x).2; last first.
  rewrite -(part_degree (f := below)); [|by apply: below_turn; rewrite dead|by apply: below_one; rewrite dead].
  have near : same_vertex (pose_at (val x).1.1) (below x) by have /and3P[] := valP x.
  have le : (val x).1.1 <= size doors by rewrite -ltnS.
  by rewrite -(same_vertex_degree near) -(degree_seenE _ le) small // size_sees.
apply: leq_trans some; rewrite -[1](card1 x); apply: subset_leq_card; apply/subsetP=> y near.
by rewrite inE (near_dead_end near dead).
Qed.

(** ** A complete folded trail is its world *)

Lemma dart_of_unfolded (i : visit) a :
  val (dart_of unfolded doors (i : nat, a)) = (first_visit i, dart (i : nat, a), false).
Proof.
have le : i <= n by rewrite -ltnS.
have at_i := unfolded_walk le; rewrite /dart_of /= turn_dart ?at_i //.
by rewrite /below at_i /=; congr (first_visit _, _, _); apply: val_inj; rewrite /= nth_visitK.
Qed.

Lemma complete_folding_inj : complete doors seen -> forall x y, x.1 < size seen -> y.1 < size seen ->
  dart x = dart y -> folded doors seen x y.
Proof.
move=> whole [k a] [l b] /=; rewrite size_sees => k_lt l_lt same.
have [f [iso f_facing]] : isomorphic_starts unfolded W.
  by apply: complete_folding_determines whole; apply: unfolded_sees.
have f_dart x : f (dart_of unfolded doors x) = dart x.
  by rewrite /dart_of (isomorphism_turn iso) (isomorphism_walk iso) f_facing.
have [f_bij _ _] := iso; have f_inj := bij_inj f_bij.
pose i : visit := Ordinal k_lt; pose j : visit := Ordinal l_lt.
have : dart_of unfolded doors (i : nat, a) = dart_of unfolded doors (j : nat, b).
  by apply: f_inj; rewrite !f_dart.
move/(congr1 val); rewrite !dart_of_unfolded => -[first_same _].
by apply: (@one_folded i j) => //; apply: one_of_first.
Qed.

End Unfolding.

(** If a dart of the folded trail is open, the walk does not determine its world, not even in a class. *)
Lemma open_folding_ambiguous (W : start) doors k i :
  k < size (sees W doors) -> ~ followed doors (sees W doors) (k, i) ->
  exists V V' : start,
    [/\ sees V doors = sees W doors, sees V' doors = sees W doors, ~ isomorphic V V',
        simple_trail doors (sees W doors) -> simple V /\ simple V'
      & forall bound, 2 <= bound ->
          (forall visit, visit < size (sees W doors) -> degree_seen (sees W doors) visit <= bound) ->
          (forall d : V, degree d <= bound) /\ (forall d : V', degree d <= bound)].
Proof.
move=> k_lt not_followed; have lt : k < (size doors).+1 by rewrite -(size_sees W).
pose j : 'I_(size doors).+1 := Ordinal lt.
pose d := dart_of W doors (k, i); have near : same_vertex (pose_at W (j : 'I__)) d by apply: same_vertex_turn.
have open : link (first_visit W j) d = None.
  case linked: (link _ _) => [l|//]; case: not_followed; apply/(followedP W j i).
  by rewrite -/d linked.
exists (unfolded W doors), (subdivided (at_visit near : unfolded W doors)).
split.
- exact: unfolded_sees.
- exact: open_sees open.
- by move/isomorphic_sym; apply: subdivided_not_isomorphic.
- by move=> simple_S; have simple_V := unfolded_simple simple_S; split=> //; apply: subdivided_simple.
move=> bound two small; have small_V : forall x : unfolded W doors, degree x <= bound.
  exact: unfolded_degree (ltnW two) small.
by split=> //; apply: subdivided_degree.
Qed.

(** The folded trail is as simple as the world. *)
Lemma simple_folding (W : start) doors : simple W -> simple_trail doors (sees W doors).
Proof.
move=> [no_loop no_parallel].
have near x y : at_vertex_of doors (sees W doors) x y -> same_vertex (dart_of W doors x) (dart_of W doors y).
  case=> i /folding_sound <-; apply: same_vertex_trans _ (same_vertex_turn _ _).
  by rewrite same_vertex_sym same_vertex_turn.
split=> [x y edge here|x y x' y' edge edge' here there].
  by have := near _ _ here; rewrite (one_edge_dart W edge) (negPf (no_loop _)).
have yy' := near _ _ there; have xx' := near _ _ here; have same : dart_of W doors x = dart_of W doors x'.
  by apply: no_parallel xx' _; rewrite -(one_edge_dart W edge) -(one_edge_dart W edge').
case: here => i ix'; have le : x.1 < (size doors).+1 by case: edge => k lt //=; apply: ltnW.
have xi : folded doors (sees W doors) (x.1, x.2) (x.1, i).
  apply: (@folded_around W doors (Ordinal le)).
  by rewrite /= -surjective_pairing same -(folding_sound ix').
by rewrite [x]surjective_pairing; apply: Linked xi ix'.
Qed.

(** It is decidable whether a dart is open. *)
Lemma followed_orN (W : start) doors k i : k < size (sees W doors) ->
  followed doors (sees W doors) (k, i) \/ ~ followed doors (sees W doors) (k, i).
Proof.
rewrite size_sees => lt; have := followedP W (Ordinal lt : 'I_(size doors).+1) i.
by case: (link _ _ != None) => H; [left | right]; rewrite H.
Qed.
