(** Distances from the marker, and edges that hang. Beyond Section 2.3. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Certificate Walks Arithmetic Parts Complete ShortTours.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Near.

Variable W : start.
Implicit Types (x y : W) (far : pred W).

(** * What is near without some edges *)

Lemma near_facing far : near_without far (facing W).
Proof. exact: connect0. Qed.

Lemma near_clockwise far x : near_without far x -> near_without far (clockwise x).
Proof. by move=> near; apply: connect_trans near (connect1 _); rewrite eqxx. Qed.

Lemma near_opposite far x : ~~ far x -> near_without far x -> near_without far (opposite x).
Proof. by move=> not_far near; apply: connect_trans near (connect1 _); rewrite eqxx not_far orbT. Qed.

Lemma near_turn far x i : near_without far x -> near_without far (turn x i).
Proof. by elim: i => //= i IH /IH; apply: near_clockwise. Qed.

Lemma near_same far x y : same_vertex x y -> near_without far x = near_without far y.
Proof.
move=> xy; apply/idP/idP => near.
  by have /same_vertexP[i ->] := xy; apply: near_turn.
by move: xy; rewrite same_vertex_sym => /same_vertexP[i ->]; apply: near_turn.
Qed.

Lemma near_edge far x : ~~ far x -> ~~ far (opposite x) -> near_without far (opposite x) = near_without far x.
Proof.
move=> not_far not_far'; apply/idP/idP; last exact: near_opposite.
by move/(near_opposite not_far'); rewrite oppositeK.
Qed.

Lemma near_ind far (P : W -> Prop) :
  P (facing W) ->
  (forall x, near_without far x -> P x -> P (clockwise x)) ->
  (forall x, near_without far x -> P x -> ~~ far x -> P (opposite x)) ->
  forall x, near_without far x -> P x.
Proof.
move=> P0 Pcw Popp x /connectP[s path_s ->]; elim/last_ind: s path_s => [|s y IH] //.
rewrite rcons_path last_rcons => /andP[path_s step].
have near : near_without far (last (facing W) s) by apply/connectP; exists s.
have {}IH := IH path_s; case/orP: step => [/eqP->|/andP[/eqP->]]; [exact: Pcw | exact: Popp].
Qed.

Lemma near_sub far far' x : (forall y, far' y -> far y) -> near_without far x -> near_without far' x.
Proof.
move=> sub near; elim/near_ind: near => [|y _|y _ near not_far]; [exact: near_facing | exact: near_clockwise |].
by apply: near_opposite near; apply: contra not_far; apply: sub.
Qed.

Lemma dart_ind (P : W -> Prop) :
  P (facing W) -> (forall x, P x -> P (clockwise x)) -> (forall x, P x -> P (opposite x)) -> forall x, P x.
Proof.
move=> P0 Pcw Popp x; have /connectP[s path_s ->] := connected (facing W) x.
elim/last_ind: s path_s => [|s y IH] //; rewrite rcons_path last_rcons => /andP[/IH{}IH /orP[]/eqP->]; auto.
Qed.

Lemma edge_of_oppositel x : edge_of (opposite x) =1 edge_of x.
Proof. by move=> y; rewrite /edge_of oppositeK orbC. Qed.

Lemma edge_of_oppositer x y : edge_of x (opposite y) = edge_of x y.
Proof. by rewrite /edge_of (inv_eq (@oppositeK W)) (inj_eq (@opposite_inj W)) orbC. Qed.

End Near.

Section Distance.

Variable W : start.
Implicit Types (x y : W).

(** * Distances *)

Lemma reached_same k x y : same_vertex x y -> reached k x = reached k y.
Proof.
move=> xy; case: k => [|k] /=.
  apply/idP/idP => near; first exact: same_vertex_trans near xy.
  by apply: same_vertex_trans near _; rewrite same_vertex_sym.
apply: eq_existsb => e; congr (_ && _); apply/idP/idP; last exact: same_vertex_trans.
by apply: same_vertex_trans; rewrite same_vertex_sym.
Qed.

Lemma reached_step k x : reached k x -> reached k.+1 (opposite x).
Proof.
by move=> reached_x; apply/existsP; exists (opposite x); rewrite same_vertex_refl oppositeK.
Qed.

Lemma reached_walk (doors : seq door) : reached (size doors) (walk (facing W) doors).
Proof.
elim/last_ind: doors => [|doors i IH]; first exact: same_vertex_refl.
rewrite size_rcons walk_rcons; apply: reached_step.
by rewrite -(reached_same _ (same_vertex_turn _ i)).
Qed.

Lemma distance_le k x : reached k x -> distance x <= k.
Proof.
move=> reached_x; rewrite leqNgt; apply/negP => lt; have := before_find 0 lt.
have short : k < #|W| by apply: leq_trans lt _; rewrite -[X in _ <= X](size_iota 0 #|W|) find_size.
by rewrite nth_iota ?add0n ?reached_x.
Qed.

Lemma reached_distance x : reached (distance x) x.
Proof.
have [doors /andP[near short]] := way_exists x.
have reached_x : reached (size doors) x by rewrite -(reached_same _ near) reached_walk.
have lt : size doors < #|W| by apply: leq_trans short (max_card _).
have some : has (fun k => reached k x) (iota 0 #|W|) by apply/hasP; exists (size doors); rewrite ?mem_iota.
have := nth_find 0 some; rewrite nth_iota //.
by move: some; rewrite has_find size_iota.
Qed.

Lemma distance_same x y : same_vertex x y -> distance x = distance y.
Proof. by move=> xy; apply: eq_find => k; apply: reached_same. Qed.

Lemma distance_facing : distance (facing W) = 0.
Proof. by apply/eqP; rewrite -leqn0; apply: (distance_le (k := 0)); apply: same_vertex_refl. Qed.

Lemma distance0 x : distance x = 0 -> same_vertex (facing W) x.
Proof. by move=> at_marker; have := reached_distance x; rewrite at_marker. Qed.

Lemma distance_step x : distance (opposite x) <= (distance x).+1.
Proof. exact/distance_le/reached_step/reached_distance. Qed.

(** The next vertex on a shortest way to the marker. *)
Lemma distance_parent x : 0 < distance x -> exists2 y, same_vertex x y & distance x = (distance (opposite y)).+1.
Proof.
have := reached_distance x; case dE: (distance x) => [|k] //= /existsP[y /andP[xy at_y]] _; exists y => //.
apply/eqP; rewrite eqSS eqn_leq (distance_le at_y) -ltnS -dE (distance_same xy) andbT.
by have := distance_step (opposite y); rewrite oppositeK.
Qed.

(** * Hanging edges *)

Let trees (H : {set W}) :=
  [set d | ~~ same_vertex (facing W) d & [forall e, same_vertex d e && (e != d) ==> (opposite e \in H)]].

Let trees_homo : {homo trees : H H' / H \subset H'}.
Proof.
move=> H H' /subsetP sub; apply/subsetP=> d; rewrite !inE => /andP[-> /forallP all]; apply/forallP=> e.
by apply/implyP=> other; apply: sub; have := all e; rewrite other.
Qed.

Lemma hangingP (h : W) :
  reflect (~~ same_vertex (facing W) h /\ forall e, same_vertex h e -> e != h -> opposite e \in hanging W)
    (h \in hanging W).
Proof.
have fixed : trees (hanging W) = hanging W := fixsetK trees_homo.
rewrite -{2}fixed inE; apply: (iffP andP) => -[away all]; split=> //.
  by move=> e he eh; have /forallP/(_ e) := all; rewrite he eh.
by apply/forallP=> e; apply/implyP=> /andP[]; apply: all.
Qed.

Lemma hanging_ind (P : W -> Prop) :
  (forall h, h \in hanging W ->
     (forall e, same_vertex h e -> e != h -> opposite e \in hanging W /\ P (opposite e)) -> P h) ->
  forall h, h \in hanging W -> P h.
Proof.
move=> step h; rewrite {1}/hanging /fixset -/trees => in_iter.
suff: forall k g, g \in iter k trees set0 -> P g by apply; apply: in_iter.
elim=> [|k IH] g /=; first by rewrite inE.
move=> in_k; have g_hangs : g \in hanging W.
  have /subsetP := iter_sub_fix trees_homo k.+1; exact.
apply: (step _ g_hangs) => e ge eg; have /hangingP[_ all] := g_hangs; split; first exact: all.
by apply: IH; move: in_k; rewrite inE => /andP[_ /forallP/(_ e)]; rewrite ge eg.
Qed.

(** A hanging edge is a bridge: without it, its far end is not near. *)
Lemma hanging_bridge h : h \in hanging W -> ~~ near_without (edge_of h) h.
Proof.
elim/hanging_ind=> {}h h_hangs all; apply/negP => near; have /hangingP[away _] := h_hangs.
pose around : pred W := fun x => same_vertex h x || same_vertex h (opposite x).
suff: forall x, near_without (edge_of h) x -> near_without around x && ~~ same_vertex h x.
  by move/(_ h near); rewrite same_vertex_refl andbF.
apply: near_ind => [|x _ /andP[{}near apart]|x _ /andP[{}near apart] other].
- by rewrite near_facing same_vertex_sym.
- rewrite near_clockwise //=; apply: contra apart => /same_vertex_trans; apply.
  by rewrite same_vertex_sym (same_vertex_turn x 1).
have [at_h|apart'] := boolP (same_vertex h (opposite x)); last first.
  by rewrite near_opposite //= /around negb_or apart.
have [|_] := all (opposite x) at_h.
  by apply: contra other => /eqP <-; rewrite /edge_of oppositeK eqxx orbT.
rewrite oppositeK => /negP[]; apply: near_sub near => y; rewrite /around.
by case/orP=> /eqP->; rewrite ?oppositeK at_h ?orbT.
Qed.

Lemma hanging_near h : h \in hanging W -> near_without (edge_of h) (opposite h).
Proof.
move=> h_hangs; have away := hanging_bridge h_hangs.
suff: forall x, near_without (edge_of h) x \/ near_without (edge_of h) (opposite h).
  by case/(_ h) => // near; rewrite near in away.
apply: dart_ind => [|x [near|near]|x [near|near]]; try by right.
- by left; apply: near_facing.
- by left; apply: near_clockwise.
have [/orP[]/eqP xE|other] := boolP (edge_of h x); last by left; apply: near_opposite.
  by move: near; rewrite xE (negPf away).
by right; rewrite -xE.
Qed.

Lemma hanging_once h : h \in hanging W -> opposite h \notin hanging W.
Proof.
move=> h_hangs; apply/negP => /hanging_bridge/negP[]; apply: near_sub (hanging_near h_hangs) => x.
by rewrite edge_of_oppositel.
Qed.

Definition hanging_edge x := (x \in hanging W) || (opposite x \in hanging W).

Lemma hanging_edge_opposite x : hanging_edge (opposite x) = hanging_edge x.
Proof. by rewrite /hanging_edge oppositeK orbC. Qed.

(** ** How many there are between a vertex and the marker *)

Lemma above_same x y : same_vertex x y -> hanging_above x = hanging_above y.
Proof. by move=> xy; apply: eq_card => h; rewrite !inE (near_same _ xy). Qed.

Lemma above_edge x : ~~ hanging_edge x -> hanging_above (opposite x) = hanging_above x.
Proof.
rewrite negb_or => /andP[x_not x'_not]; apply: eq_card => h; rewrite !inE; case h_hangs: (h \in _) => //=.
have other : ~~ edge_of h x.
  apply/norP; split; apply/eqP => xE; first by rewrite xE h_hangs in x_not.
  by rewrite xE oppositeK h_hangs in x'_not.
by rewrite near_edge // edge_of_oppositer.
Qed.

Lemma above_hanging h : h \in hanging W -> hanging_above h = (hanging_above (opposite h)).+1.
Proof.
move=> h_hangs; rewrite /hanging_above (cardsD1 h) inE h_hangs hanging_bridge //= add1n; congr _.+1.
apply: eq_card => g; rewrite !inE; have [->|gh] := eqVneq g h; first by rewrite hanging_near // andbF.
case g_hangs: (g \in _) => //=; have other : ~~ edge_of g h.
  rewrite /edge_of eq_sym negb_or gh; apply/eqP => hE.
  by have := hanging_once g_hangs; rewrite -hE h_hangs.
by rewrite near_edge // edge_of_oppositer.
Qed.

Lemma above_facing : hanging_above (facing W) = 0.
Proof. by apply/eqP; rewrite cards_eq0; apply/eqP/setP=> h; rewrite !inE near_facing andbF. Qed.

Lemma above_le_step x : hanging_above x <= (hanging_above (opposite x)).+1.
Proof.
have [x_hangs|x_not] := boolP (x \in hanging W); first by rewrite above_hanging.
have [x'_hangs|x'_not] := boolP (opposite x \in hanging W).
  by rewrite (above_hanging x'_hangs) oppositeK -addn2 leq_addr.
by rewrite above_edge // /hanging_edge negb_or x_not.
Qed.

Lemma above_le_distance x : hanging_above x <= distance x.
Proof.
move dE: (distance x) => k; elim: k x dE => [|k IH] x dE.
  by rewrite -(above_same (distance0 dE)) above_facing.
have [|y xy] := @distance_parent x; first by rewrite dE.
rewrite dE => -[/esym/IH le]; rewrite (above_same xy); exact: leq_trans (above_le_step y) _.
Qed.

(** The vertices below a hanging edge are the far ends of hanging edges. *)
Lemma above_hangs x : 0 < hanging_above x -> exists2 h, h \in hanging W & same_vertex x h.
Proof.
case/card_gt0P=> h; rewrite inE => /andP[h_hangs].
pose below (g y : W) := connect (fun x y => (y == clockwise x) || (y == opposite x) && ~~ edge_of g x) g y.
have next (g y : W) : below g y -> below g (clockwise y).
  by move=> at_y; apply: connect_trans at_y (connect1 _); rewrite eqxx.
have over (g y : W) : below g y -> ~~ edge_of g y -> below g (opposite y).
  by move=> at_y other; apply: connect_trans at_y (connect1 _); rewrite eqxx other orbT.
have in_below : forall y, near_without (edge_of h) y \/ below h y.
  apply: dart_ind => [|y [near|at_y]|y [near|at_y]].
  - by left; apply: near_facing.
  - by left; apply: near_clockwise.
  - by right; apply: next.
  - have [/orP[]/eqP yE|other] := boolP (edge_of h y); last by left; apply: near_opposite.
      by move: near; rewrite yE (negPf (hanging_bridge h_hangs)).
    by right; rewrite yE oppositeK; apply: connect0.
  have [/orP[]/eqP yE|other] := boolP (edge_of h y); last by right; apply: over.
    by left; rewrite yE; apply: hanging_near.
  by right; rewrite yE oppositeK; apply: connect0.
move=> away; have [near|{away in_below}] := in_below x; first by rewrite near in away.
elim/hanging_ind: {h} h_hangs x => h h_hangs all x /connectP[s path_s ->].
have : same_vertex h (last h s) \/
    exists e, [/\ same_vertex h e, e != h & below (opposite e) (last h s)].
  elim/last_ind: s path_s => [_|s y IH]; first by left; apply: same_vertex_refl.
  rewrite rcons_path last_rcons => /andP[/IH{}IH]; set z := last h s in IH *.
  case/orP=> [/eqP->|/andP[/eqP-> other]].
    case: IH => [at_h|[e [he eh at_z]]]; last by right; exists e; split=> //; apply: next.
    by left; apply: same_vertex_trans at_h (same_vertex_turn z 1).
  case: IH => [at_h|[e [he eh at_z]]].
    right; exists z; split=> //; last exact: connect0.
    by apply: contra other => /eqP->; rewrite /edge_of eqxx.
  have [/orP[]/eqP zE|other'] := boolP (edge_of (opposite e) z).
  - by left; rewrite zE oppositeK.
  - by right; exists e; split=> //; rewrite zE !oppositeK; apply: connect0.
  by right; exists e; split=> //; apply: over.
case=> [at_h|[e [he eh at_x]]]; first by exists h; rewrite // same_vertex_sym.
by have [_] := all e he eh; apply.
Qed.

(** At a vertex below a hanging edge all edges hang. *)
Lemma above_edge0 x : ~~ hanging_edge x -> hanging_above x = 0.
Proof.
move=> not_hangs; apply/eqP; rewrite -leqn0 leqNgt; apply: contra not_hangs => /above_hangs[h h_hangs xh].
have [<-|other] := eqVneq h x; first by rewrite /hanging_edge h_hangs.
have /hangingP[_ all] := h_hangs; rewrite /hanging_edge all ?orbT // ?(same_vertex_sym h) //.
by rewrite eq_sym.
Qed.

Lemma distance_hanging h : h \in hanging W -> distance h = (distance (opposite h)).+1.
Proof.
move=> h_hangs; apply/eqP; rewrite eqn_leq; have := distance_step (opposite h); rewrite oppositeK => -> /=.
suff: forall k x, reached k x -> ~~ near_without (edge_of h) x -> distance (opposite h) < k.
  by apply; [apply: reached_distance | apply: hanging_bridge].
elim=> [|k IH] x /=; first by move=> at_marker; rewrite -(near_same _ at_marker) near_facing.
case/existsP=> y /andP[xy at_y]; rewrite (near_same _ xy) => away.
have [near|away'] := boolP (near_without (edge_of h) (opposite y)); last exact: leq_trans (IH _ at_y away') _.
have [/orP[]/eqP yE|other] := boolP (edge_of h (opposite y)).
- by move: near; rewrite yE (negPf (hanging_bridge h_hangs)).
- by rewrite ltnS -yE; apply: distance_le.
by have := near_opposite other near; rewrite oppositeK (negPf away).
Qed.

(** ** Leaves *)

Lemma hanging_leaf h : h \in hanging W ->
  exists2 leaf, (leaf \in hanging W) && (degree leaf == 1)
  & 2 * hanging_above h - distance h <= 2 * hanging_above leaf - distance leaf.
Proof.
elim/hanging_ind=> {}h h_hangs all; have [leaf|branch] := eqVneq (clockwise h) h.
  exists h => //; rewrite h_hangs /= -dvdn1 -turn_period; exact/eqP.
have at_h : same_vertex h (clockwise h) := same_vertex_turn h 1.
have [e_hangs [leaf is_leaf le]] := all _ at_h branch; exists leaf => //; apply: leq_trans le.
rewrite (above_hanging e_hangs) (distance_hanging e_hangs) oppositeK.
by rewrite -(above_same at_h) -(distance_same at_h); arithmetic.
Qed.

End Distance.
