(** A robot that maps every world comes back to the marker m - n + 1 times. Otherwise a world of twice the size
    has the same percepts: a double cover in which each return ends on the sheet of the marker. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Bisimulation Parts Complete Moves.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * The double cover *)

Section Cover.

Variables (W : start) (c : W -> bool).

(** The edges that lead to the other sheet. *)
Hypothesis c_opposite : forall d, c (opposite d) = c d.

Definition cover_opposite (x : W * bool) : W * bool := (opposite x.1, x.2 (+) c x.1).
Definition cover_clockwise (x : W * bool) : W * bool := (clockwise x.1, x.2).

Lemma cover_involutive : involutive cover_opposite.
Proof.
by case=> d b; rewrite /cover_opposite /= opposite_involutive c_opposite -addbA addbb addbF.
Qed.

Lemma cover_moves x : cover_opposite x != x.
Proof. by case: x => d b; apply/eqP=> -[/eqP]; rewrite (negPf (opposite_moves d)). Qed.

Lemma cover_injective : injective cover_clockwise.
Proof. by move=> [d b] [d' b'] [/(@clockwise_injective W)-> ->]. Qed.

Let step x y := (y == cover_opposite x) || (y == cover_clockwise x).
Let reach x y := connect step x y.

Lemma cover_back x y : reach x y -> reach y x.
Proof. exact: (connect_back cover_involutive cover_injective). Qed.

(** The other sheet looks the same. *)
Lemma cover_swap x y : reach x y -> reach (x.1, ~~ x.2) (y.1, ~~ y.2).
Proof.
case/connectP=> s; elim: s x => [|z s IH] x /=; first by move=> _ ->; apply: connect0.
case/andP=> xz /IH zy /zy{zy}; apply: connect_trans; apply: connect1.
by case/orP: xz => /eqP->; rewrite /step /cover_opposite /cover_clockwise /= ?addNb eqxx ?orbT.
Qed.

Let origin : W * bool := (facing W, false).

Lemma cover_above d : exists b, reach origin (d, b).
Proof.
have /connectP[s path_s ->] := connected (facing W) d; elim/last_ind: s path_s => [|s r IH].
  by exists false; apply: connect0.
rewrite rcons_path last_rcons => /andP[/IH[b to_b] /orP[]/eqP->].
  by exists (b (+) c (last (facing W) s)); apply: connect_trans to_b (connect_opp _ _ (_, b)).
by exists b; apply: connect_trans to_b (connect_cw _ _ (_, b)).
Qed.

Lemma cover_connected : reach origin (facing W, true) -> forall x y, reach x y.
Proof.
move=> crossed; apply: (all_connected (root := origin)); [exact: cover_involutive | exact: cover_injective |].
case=> d b; have [b' to_d] := cover_above d; case: (b =P b') => [->//|/eqP differ].
have -> : b = ~~ b' by move: differ; case: (b) (b') => -[].
exact: connect_trans crossed (cover_swap to_d).
Qed.

(** If the sheets are not connected, the edges that change the sheet are those between two classes of
    vertices. *)
Definition sheet d := reach origin (d, true).

Lemma sheet_clockwise d : sheet (clockwise d) = sheet d.
Proof.
have go : reach (d, true) (clockwise d, true) by apply: (connect_cw _ _ (d, true)).
by apply/idP/idP => to_d; apply: connect_trans to_d _; [apply: cover_back | ].
Qed.

Hypothesis apart : ~~ reach origin (facing W, true).

Lemma sheet_one d b : reach origin (d, b) -> sheet d = b.
Proof.
case: b => // to_false; apply: contraNF apart => to_true.
exact: connect_trans to_true (cover_back (cover_swap to_false)).
Qed.

Lemma sheet_facing : sheet (facing W) = false.
Proof. exact: negbTE. Qed.

Lemma sheet_opposite d : c d = sheet d (+) sheet (opposite d).
Proof.
have [b to_d] := cover_above d; rewrite (sheet_one to_d).
rewrite (sheet_one (connect_trans to_d (connect_opp cover_opposite cover_clockwise (d, b)))) /=.
by rewrite addbA addbb.
Qed.

End Cover.

Section CoverWorld.

Variables (W : start) (c : W -> bool).
Hypothesis c_opposite : forall d, c (opposite d) = c d.
Hypothesis one_piece :
  forall x y, connect (fun x y => (y == cover_opposite c x) || (y == cover_clockwise x)) x y.

Definition cover : start :=
  @Start (@EmbeddedGraph [finType of W * bool] _ _ (cover_involutive c_opposite) (cover_moves c)
    (@cover_injective W) one_piece) (facing W, false).

(** How often a walk changes the sheet, modulo 2. *)
Fixpoint crossings (c : W -> bool) (p : W) (doors : seq door) : bool :=
  if doors is i :: others then c (turn p i) (+) crossings c (traverse p i) others else false.

Lemma cover_turn (x : cover) i : turn x i = (turn (x.1 : W) i, x.2).
Proof. by elim: i => [|i IH] /=; [case: x | rewrite IH]. Qed.

Lemma cover_walk (x : cover) doors : walk x doors = (walk (x.1 : W) doors, x.2 (+) crossings c x.1 doors).
Proof.
elim: doors x => [|i doors IH] x /=; first by rewrite addbF; case: x.
by rewrite [LHS](IH (traverse x i)) /traverse cover_turn /= addbA.
Qed.

Lemma cover_sees doors :
  (forall k, k < size doors -> same_vertex (walk (facing W) (take k.+1 doors)) (facing W) ->
     ~~ crossings c (facing W) (take k.+1 doors)) ->
  sees cover doors = sees W doors.
Proof.
move=> on_sheet; apply: eq_percepts_walk => k le; set z := walk _ _.
have zE : z = (walk (facing W) (take k doors), crossings c (facing W) (take k doors)) by exact: cover_walk.
pose below (x : cover) : W := x.1; have -> : walk (facing W) (take k doors) = below z by rewrite zE.
apply/esym/part_perceive => // [i|i|near]; first by rewrite /below cover_turn.
  by rewrite /below cover_turn => same; case: (z) same => d b /= ->.
have sheet_z : z.2 = false.
  rewrite zE /=; move: near le; rewrite /below zE; case: (k) => [|k'] near le; first by rewrite take0.
  exact/negbTE/on_sheet.
have /same_vertexP[i facing_i] := near; apply/same_vertexP; exists i.
by rewrite cover_turn sheet_z /=; congr (_, _); apply: facing_i.
Qed.

Lemma cover_not_isomorphic : ~ isomorphic cover W.
Proof.
move=> [f [f_bij _ _]]; have := bij_eq_card f_bij; rewrite card_prod card_bool muln2 -addnn.
move/eqP; rewrite -[X in _ == X]addn0 eqn_add2l; apply/negP; rewrite -lt0n.
by apply/card_gt0P; exists (facing W).
Qed.

End CoverWorld.

Lemma crossings_add (W : start) (c c' : W -> bool) p doors :
  crossings (fun d => c d (+) c' d) p doors = crossings c p doors (+) crossings c' p doors.
Proof. by elim: doors p => //= i doors IH p; rewrite IH addbACA. Qed.

(** * Counting *)

Section Counting.

Variables (robot : strategy start) (W : start) (n : nat) (answer : start).
Hypothesis maps_all : forall W, maps_start directional robot W.
Hypothesis answered : robot (history robot directional W n) = Answer answer.

Let doors := doors_taken robot directional W n.

Definition coming_back : {set 'I_(size doors)} :=
  [set k : 'I_(size doors) | same_vertex (walk (facing W) (take k.+1 doors)) (facing W)].

Lemma card_coming_back : #|coming_back| = returns W doors.
Proof.
rewrite cardsE cardE size_filter /returns -val_enum_ord count_map enumT.
by apply: eq_count.
Qed.

(** Edges, and vertices except the marked one, by one of their darts. *)
Definition edge_roots : {set W} := [set d | froot opposite d == d].
Definition vertex_roots : {set W} := [set d | froot clockwise d == d] :\ froot clockwise (facing W).

Lemma card_edge_roots : #|edge_roots| = edges W.
Proof. by rewrite edges_orbits cardsE; apply: eq_card => d; rewrite !inE andbT. Qed.

Lemma card_vertex_roots : #|vertex_roots|.+1 = vertices W.
Proof.
pose roots := [set d : W | froot clockwise d == d].
have sym := fconnect_sym (@clockwise_injective W).
have in_roots : froot clockwise (facing W) \in roots by rewrite inE; apply: roots_root.
have := cardsD1 (froot clockwise (facing W)) roots; rewrite in_roots add1n => <-.
by rewrite cardsE; apply: eq_card => d; rewrite !inE andbT.
Qed.

(** The edges of a set change the sheet. *)
Let cross (g : {set W}) (d : W) := froot opposite d \in g.

Lemma cross_opposite g d : cross g (opposite d) = cross g d.
Proof.
have sym := fconnect_sym (inv_inj (@opposite_involutive W)).
by congr (_ \in g); apply/eqP; rewrite root_connect // sym fconnect1.
Qed.

Let odd_returns (g : {set W}) : {set 'I_(size doors)} :=
  [set k in coming_back | crossings (cross g) (facing W) (take k.+1 doors)].

(** Two sets that change the sheet on the same returns differ by a set of vertices. *)
Lemma differ_by_vertices (g h : {set W}) : odd_returns g = odd_returns h ->
  exists2 F : {set W}, F \subset vertex_roots
  & forall d, cross g d = cross h d (+) (froot clockwise d \in F) (+) (froot clockwise (opposite d) \in F).
Proof.
move=> same; pose c d := cross g d (+) cross h d.
have c_opposite d : c (opposite d) = c d by rewrite /c !cross_opposite.
have [crossed|apart] := boolP (connect (fun x y => (y == cover_opposite c x) || (y == cover_clockwise x))
  (facing W, false) (facing W, true)).
  have one_piece := cover_connected c_opposite crossed.
  have [f [iso _]] : isomorphic_starts (cover c_opposite one_piece) W.
    apply: mapped_alike answered _ => //; apply: cover_sees => k lt near.
    have := congr1 (fun s : {set _} => Ordinal lt \in s) same; rewrite !inE /= near /= => same_k.
    by rewrite crossings_add same_k addbb.
  by case: (cover_not_isomorphic (ex_intro _ f iso)).
have sym := fconnect_sym (@clockwise_injective W).
have sheet_root d : sheet c (froot clockwise d) = sheet c d.
  have /iter_findex <- : fconnect clockwise d (froot clockwise d) by apply: connect_root.
  by elim: (findex _ _ _) => //= k; rewrite sheet_clockwise.
exists [set d in vertex_roots | sheet c d]; first by apply/subsetP=> d; rewrite inE => /andP[].
move=> d; have in_F e : (froot clockwise e \in [set d in vertex_roots | sheet c d]) = sheet c e.
  rewrite !inE sheet_root (root_root sym) eqxx andbT; case: eqP => // same_root.
  by rewrite -sheet_root same_root sheet_root sheet_facing.
by rewrite !in_F -addbA -(sheet_opposite c_opposite apart) /c addbC -addbA addbb addbF.
Qed.

Lemma returns_needed : edges W < vertices W + returns W doors.
Proof.
pose rep (s : {set 'I_(size doors)}) : {set W} := odflt set0 [pick h | odd_returns h == s].
have repP g : odd_returns g = odd_returns (rep (odd_returns g)).
  by rewrite /rep; case: pickP => [h /eqP->//|/(_ g)]; rewrite eqxx.
have exF g : exists F : {set W}, (F \subset vertex_roots) &&
    [forall d, cross g d == cross (rep (odd_returns g)) d (+) (froot clockwise d \in F)
                             (+) (froot clockwise (opposite d) \in F)].
  have [F F_sub F_g] := differ_by_vertices (repP g); exists F; rewrite F_sub /=.
  by apply/forallP=> d; apply/eqP.
pose code g := (odd_returns g, xchoose (exF g)).
have code_inj : {in powerset edge_roots &, injective code}.
  move=> g g'; rewrite !powersetE => /subsetP g_roots /subsetP g'_roots [same_odd same_F].
  have same_cross d : cross g d = cross g' d.
    have /andP[_ /forallP/(_ d)/eqP->] := xchooseP (exF g).
    have /andP[_ /forallP/(_ d)/eqP->] := xchooseP (exF g').
    by rewrite same_F same_odd.
  apply/setP=> d; apply/idP/idP=> [d_g|d_g'].
    by have := g_roots d d_g; rewrite inE => /eqP root_d; have := same_cross d; rewrite /cross root_d d_g.
  by have := g'_roots d d_g'; rewrite inE => /eqP root_d; have := same_cross d; rewrite /cross root_d d_g'.
have : #|powerset edge_roots| <= #|setX (powerset coming_back) (powerset vertex_roots)|.
  rewrite -(card_in_imset code_inj); apply/subset_leq_card/subsetP=> _ /imsetP[g _ ->].
  rewrite !inE /=; apply/andP; split; first by apply/subsetP=> k; rewrite inE => /andP[].
  by have /andP[] := xchooseP (exF g).
rewrite cardsX !card_powerset card_edge_roots card_coming_back -expnD leq_exp2l //.
by rewrite -card_vertex_roots addSn ltnS addnC.
Qed.

End Counting.
