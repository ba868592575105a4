(** A walk that determines its world comes back to the marker m - n + 1 times, and so does a robot that maps every
    world. Otherwise a world of twice the size has the same percepts: a double cover in which each return ends on the
    sheet of the marker. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Arithmetic Bisimulation Parts Complete Moves.

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

Lemma cover_oppositeK : involutive cover_opposite.
Proof.
by case=> d b; rewrite /cover_opposite /= oppositeK c_opposite -addbA addbb addbF.
Qed.

Lemma cover_opposite_neq x : cover_opposite x != x.
Proof. by case: x => d b; apply/eqP=> -[/eqP]; rewrite (negPf (opposite_neq d)). Qed.

Lemma cover_clockwise_inj : injective cover_clockwise.
Proof. by move=> [d b] [d' b'] [/(@clockwise_inj W)-> ->]. Qed.

Let step x y := (y == cover_opposite x) || (y == cover_clockwise x).
Let reach x y := connect step x y.

Lemma cover_back x y : reach x y -> reach y x.
Proof. exact: (connect_back cover_oppositeK cover_clockwise_inj). Qed.

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
move=> crossed; apply: (all_connected (root := origin)); [exact: cover_oppositeK | exact: cover_clockwise_inj |].
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
  @Start (@EmbeddedGraph [finType of W * bool] _ _ (cover_oppositeK c_opposite) (cover_opposite_neq c)
    (@cover_clockwise_inj W) one_piece) (facing W, false).

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

Lemma crossingsD (W : start) (c c' : W -> bool) p doors :
  crossings (fun d => c d (+) c' d) p doors = crossings c p doors (+) crossings c' p doors.
Proof. by elim: doors p => //= i doors IH p; rewrite IH addbACA. Qed.

(** * Counting *)

Section Counting.

(** A walk that determines its world. *)
Variables (W : start) (doors : seq door).
Hypothesis determined : forall V : start, sees V doors = sees W doors -> isomorphic_starts V W.

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
have sym := fconnect_sym (@clockwise_inj W).
have in_roots : froot clockwise (facing W) \in roots by rewrite inE; apply: roots_root.
have := cardsD1 (froot clockwise (facing W)) roots; rewrite in_roots add1n => <-.
by rewrite cardsE; apply: eq_card => d; rewrite !inE andbT.
Qed.

(** The edges of a set change the sheet. *)
Let cross (g : {set W}) (d : W) := froot opposite d \in g.

Lemma cross_opposite g d : cross g (opposite d) = cross g d.
Proof.
have sym := fconnect_sym (inv_inj (@oppositeK W)).
by congr (_ \in g); apply/eqP; rewrite root_connect // sym fconnect1.
Qed.

(** Some edges are far; a return is far if the walk has gone over such an edge since the return before it. *)
Variable far : pred W.
Hypothesis far_opposite : forall d, far (opposite d) = far d.

Let leaving k : W := turn (walk (facing W) (take k doors)) (nth 0 doors k).

Definition from_far (k j : 'I_(size doors)) : bool :=
  [&& j <= k, far (leaving j) & [forall i : 'I_(size doors), (j <= i < k) ==> (i \notin coming_back)]].

Definition far_returns : {set 'I_(size doors)} := [set k in coming_back | [exists j, from_far k j]].

Let crossed g k := crossings (cross g) (facing W) (take k doors).

Lemma crossings_cat (c : W -> bool) p ds es :
  crossings c p (ds ++ es) = crossings c p ds (+) crossings c (walk p ds) es.
Proof. by elim: ds p => //= i ds IH p; rewrite IH addbA. Qed.

Lemma crossed_next g k : k < size doors -> crossed g k.+1 = crossed g k (+) cross g (leaving k).
Proof. by move=> lt; rewrite /crossed (take_nth 0 lt) -cats1 crossings_cat /= addbF. Qed.

Let far_sets : {set {set W}} := powerset [set d in edge_roots | far d].

Lemma far_set_near g d : g \in far_sets -> ~~ far d -> cross g d = false.
Proof.
rewrite powersetE => /subsetP g_far near; apply/negbTE; apply: contra near => /g_far.
rewrite inE => /andP[_]; have sym := fconnect_sym (inv_inj (@oppositeK W)).
have /iter_findex <- : fconnect opposite d (froot opposite d) by apply: connect_root.
by elim: (findex _ _ _) => //= k IH; rewrite far_opposite.
Qed.

Let odd_returns (g : {set W}) : {set 'I_(size doors)} :=
  [set k in far_returns | crossings (cross g) (facing W) (take k.+1 doors)].

(** The far returns decide on which sheet all returns are. *)
Lemma odd_returns_all g h : g \in far_sets -> h \in far_sets -> odd_returns g = odd_returns h ->
  forall k, k < size doors -> same_vertex (walk (facing W) (take k.+1 doors)) (facing W) ->
  crossed g k.+1 = crossed h k.+1.
Proof.
move=> g_far h_far same k; have [m] := ubnP k; elim: m k => // m IH k; rewrite ltnS => le lt near.
have [is_far|not_far] := boolP (Ordinal lt \in far_returns).
  by have := congr1 (fun s : {set _} => Ordinal lt \in s) same; rewrite !inE /= in is_far *; rewrite is_far.
have {}not_far j : ~~ from_far (Ordinal lt) j.
  by move: not_far; rewrite inE inE /= near /= => /existsPn.
pose back_at i := same_vertex (walk (facing W) (take i.+1 doors)) (facing W).
have steps x l : x \in far_sets -> l <= k.+1 -> (forall i, l <= i < k -> ~~ back_at i) ->
    crossed x k.+1 = crossed x l.
  move=> x_far l_le none; have : forall j, l <= j <= k.+1 -> crossed x j = crossed x l; last first.
    by apply; rewrite l_le leqnn.
  elim=> [|j IHj] /andP[l_j j_k]; first by move: l_j; rewrite leqn0 => /eqP->.
  move: l_j; rewrite leq_eqVlt => /predU1P[->//|]; rewrite ltnS => l_j.
  have j_lt : j < size doors by apply: leq_trans j_k lt.
  rewrite crossed_next // IHj ?l_j ?(ltnW j_k) // far_set_near ?addbF //.
  apply: contra (not_far (Ordinal j_lt)) => far_j; apply/and3P; split=> //.
  apply/forallP=> i; apply/implyP=> /andP[/= j_i i_k]; rewrite inE; apply: none.
  by rewrite i_k (leq_trans l_j j_i).
have [some|none] := boolP [exists i : 'I_k, back_at i].
  have exi : exists i, (i < k) && back_at i.
    by have /existsP[i back_i] := some; exists i; rewrite ltn_ord.
  have small i : (i < k) && back_at i -> i <= k by case/andP=> /ltnW.
  case: (ex_maxnP exi small) => i /andP[i_k back_i] largest.
  have gap x : x \in far_sets -> crossed x k.+1 = crossed x i.+1.
    move=> x_far; apply: steps => //; first by rewrite ltnS ltnW.
    move=> j /andP[i_j j_k]; apply/negP=> back_j.
    by have := largest j; rewrite j_k back_j => /(_ erefl); rewrite leqNgt i_j.
  rewrite (gap g) // (gap h) //; apply: IH back_i; [exact: leq_trans i_k le | exact: ltn_trans i_k lt].
have gap x : x \in far_sets -> crossed x k.+1 = crossed x 0.
  move=> x_far; apply: steps => // i /andP[_ i_k]; move: none => /existsPn/(_ (Ordinal i_k)).
  by [].
by rewrite (gap g) // (gap h) // /crossed take0.
Qed.

(** Two sets of far edges that change the sheet on the same far returns differ by a set of vertices, none of
    which is near. *)
Let far_roots : {set W} := [set d : W | (froot clockwise d == d) && ~~ near_without far d].

Lemma differ_by_vertices (g h : {set W}) :
  g \in far_sets -> h \in far_sets -> odd_returns g = odd_returns h ->
  exists2 F : {set W}, F \subset far_roots
  & forall d, cross g d = cross h d (+) (froot clockwise d \in F) (+) (froot clockwise (opposite d) \in F).
Proof.
move=> g_far h_far same; pose c d := cross g d (+) cross h d.
have c_opposite d : c (opposite d) = c d by rewrite /c !cross_opposite.
have [crossed_over|apart] := boolP (connect (fun x y => (y == cover_opposite c x) || (y == cover_clockwise x))
  (facing W, false) (facing W, true)).
  have one_piece := cover_connected c_opposite crossed_over.
  have [f [iso _]] : isomorphic_starts (cover c_opposite one_piece) W.
    apply/determined/cover_sees => k lt near.
    by rewrite crossingsD -!/(crossed _ _) (odd_returns_all g_far h_far same lt near) addbb.
  by case: (cover_not_isomorphic (ex_intro _ f iso)).
have sym := fconnect_sym (@clockwise_inj W).
have sheet_root d : sheet c (froot clockwise d) = sheet c d.
  have /iter_findex <- : fconnect clockwise d (froot clockwise d) by apply: connect_root.
  by elim: (findex _ _ _) => //= k; rewrite sheet_clockwise.
have sheet_near d : near_without far d -> sheet c d = false.
  case/connectP=> s path_s ->; elim/last_ind: s path_s => [|s r IH]; first by move=> _; apply: sheet_facing.
  rewrite rcons_path last_rcons => /andP[/IH at_p /orP[/eqP->|/andP[/eqP-> near]]].
    by rewrite sheet_clockwise.
  have := sheet_opposite c_opposite apart (last (facing W) s).
  by rewrite at_p /c !far_set_near //= => <-.
exists [set d in far_roots | sheet c d]; first by apply/subsetP=> d; rewrite inE => /andP[].
move=> d; have in_F e : (froot clockwise e \in [set d in far_roots | sheet c d]) = sheet c e.
  rewrite !inE sheet_root (root_root sym) eqxx /=; case near: (near_without far _) => //=.
  by rewrite -sheet_root sheet_near.
by rewrite !in_F -addbA -(sheet_opposite c_opposite apart) /c addbC -addbA addbb addbF.
Qed.

Lemma far_returns_needed : far_edges far <= far_vertices far + #|far_returns|.
Proof.
pose rep (s : {set 'I_(size doors)}) : {set W} :=
  odflt set0 [pick h | (h \in far_sets) && (odd_returns h == s)].
have repP g : g \in far_sets -> rep (odd_returns g) \in far_sets /\ odd_returns g = odd_returns (rep (odd_returns g)).
  by rewrite /rep => g_far; case: pickP => [h /andP[h_far /eqP->]|/(_ g)] //; rewrite g_far eqxx.
pose fits g (F : {set W}) := (F \subset far_roots) &&
    [forall d, cross g d == cross (rep (odd_returns g)) d (+) (froot clockwise d \in F)
                             (+) (froot clockwise (opposite d) \in F)].
pose code g := (odd_returns g, odflt set0 [pick F | fits g F]).
have code_fits g : g \in far_sets -> fits g (code g).2.
  move=> g_far; have [rep_far same] := repP g g_far.
  have [F F_sub F_g] := differ_by_vertices g_far rep_far same.
  rewrite /code /=; case: pickP => //= /(_ F); rewrite /fits F_sub /= => /negbT/forallPn[d].
  by rewrite -F_g eqxx.
have code_inj : {in far_sets &, injective code}.
  move=> g g' g_far g'_far same_code.
  have [same_odd same_F] : odd_returns g = odd_returns g' /\ (code g).2 = (code g').2.
    by rewrite same_code; case: same_code.
  have same_cross d : cross g d = cross g' d.
    have /andP[_ /forallP/(_ d)/eqP->] := code_fits g g_far.
    have /andP[_ /forallP/(_ d)/eqP->] := code_fits g' g'_far.
    by rewrite same_F same_odd.
  move: g_far g'_far; rewrite !powersetE => /subsetP g_roots /subsetP g'_roots.
  apply/setP=> d; apply/idP/idP=> [d_g|d_g'].
    by have := g_roots d d_g; rewrite !inE => /andP[/eqP root_d _]; have := same_cross d; rewrite /cross root_d d_g.
  by have := g'_roots d d_g'; rewrite !inE => /andP[/eqP root_d _]; have := same_cross d; rewrite /cross root_d d_g'.
have : #|far_sets| <= #|setX (powerset far_returns) (powerset far_roots)|.
  rewrite -(card_in_imset code_inj); apply/subset_leq_card/subsetP=> _ /imsetP[g g_far ->].
  rewrite !inE /=; apply/andP; split; first by apply/subsetP=> k; rewrite inE => /andP[].
  by have /andP[] := code_fits g g_far.
rewrite cardsX !card_powerset -expnD leq_exp2l // [X in _ <= X]addnC; congr (_ <= _).
by congr (#|pred_of_set _|); apply/setP=> d; rewrite !inE.
Qed.

End Counting.

(** The walk of a robot that maps every world determines its world. *)
Lemma robot_determined (robot : strategy start) (W : start) n answer :
  (forall W, maps_start (moving directional) robot W) ->
  robot (history robot (moving directional W) n) = Answer answer ->
  let doors := doors_taken robot directional W n in
  forall V : start, sees V doors = sees W doors -> isomorphic_starts V W.
Proof. by move=> maps_all answered doors V; apply: mapped_iso answered. Qed.

(** With all edges: the marked vertex is near, and all returns may be far. *)
Lemma returns_needed (robot : strategy start) (W : start) n answer :
  (forall W, maps_start (moving directional) robot W) ->
  robot (history robot (moving directional W) n) = Answer answer ->
  edges W < vertices W + returns W (doors_taken robot directional W n).
Proof.
move=> maps_all answered; have determined := robot_determined maps_all answered.
set doors := doors_taken _ _ _ _ in determined *.
have needed := @far_returns_needed W doors determined predT (fun=> erefl).
have all_edges : far_edges (W := W) predT = edges W.
  by rewrite -card_edge_roots; apply: eq_card => d; rewrite !inE andbT.
have some_returns : #|far_returns doors (W := W) predT| <= returns W doors.
  by rewrite -card_coming_back; apply/subset_leq_card/subsetP=> k; rewrite inE => /andP[].
have others : far_vertices (W := W) predT <= #|vertex_roots W|.
  apply/subset_leq_card/subsetP=> d; rewrite !inE => /andP[-> away]; rewrite andbT.
  apply: contra away => /eqP ->; set r := froot _ _.
  have /iter_findex <- : fconnect clockwise (facing W) r by apply: connect_root.
  elim: (findex _ _ _) => [|k IH]; first exact: connect0.
  by apply: connect_trans IH (connect1 _); rewrite eqxx.
rewrite -card_vertex_roots addSn ltnS -all_edges; apply: leq_trans needed _.
exact: leq_add others some_returns.
Qed.

(** * Far cycles cost much *)

(** From the vertex of the marker a walk with as many doors leads from the facing dart to the same vertex. *)
Lemma walk_from_marker (W : start) (p : W) ds : same_vertex (facing W) p ->
  exists2 es, size es = size ds & same_vertex (walk (facing W) es) (walk p ds).
Proof.
case/same_vertexP=> t ->; case: ds => [|i ds]; first by exists [::]; rewrite //= same_vertex_turn.
exists (t + i :: ds) => //=; suff -> : traverse (turn (facing W) t) i = traverse (facing W) (t + i).
  exact: same_vertex_refl.
by rewrite /traverse turnD.
Qed.

Section Cost.

Variables (W : start) (doors : seq door) (far : pred W) (depth : nat).
Hypothesis far_opposite : forall d, far (opposite d) = far d.
Hypothesis far_deep : forall ds d, same_vertex (walk (facing W) ds) d -> far d -> depth <= size ds.

Let far_from_marker (p : W) ds d :
  same_vertex (facing W) p -> same_vertex (walk p ds) d -> far d -> depth <= size ds.
Proof.
move=> at_marker near far_d; have [es <- same] := walk_from_marker ds at_marker.
exact: far_deep (same_vertex_trans same near) far_d.
Qed.

Let size_way_back (p : W) ds : size (way_back (taken p ds)) = size ds.
Proof. by case: ds => //= i ds; rewrite size_rev size_map size_taken. Qed.

Let walk_between a b : a <= b ->
  walk (facing W) (take b doors) = walk (walk (facing W) (take a doors)) (drop a (take b doors)).
Proof. by move=> le; rewrite -walk_cat -[take a doors](take_take le) cat_take_drop. Qed.

Lemma far_return_apart (k : 'I_(size doors)) : k \in far_returns doors far ->
  2 * depth <= k /\ forall k' : 'I_(size doors), k' \in coming_back W doors -> k' < k -> k' + (2 * depth).+1 <= k.
Proof.
rewrite inE => /andP[]; rewrite inE => back_k /existsP[j /and3P[j_k far_j /forallP none]].
have late : depth <= k - j.
  set q := walk (facing W) (take j.+1 doors).
  have size_end : size (drop j.+1 (take k.+1 doors)) = k - j.
    by rewrite size_drop size_takel ?subSS.
  rewrite -size_end -(size_way_back q).
  apply: (far_from_marker (p := walk (facing W) (take k.+1 doors)) (d := q)).
  - by rewrite same_vertex_sym.
  - rewrite (walk_between (a := j.+1)) // -/q way_backK same_vertex_sym; exact: same_vertex_turn.
  by rewrite /q (take_nth 0 (ltn_ord j)) walk_rcons far_opposite.
have early a : a <= j -> same_vertex (facing W) (walk (facing W) (take a doors)) -> depth <= j - a.
  move=> a_j at_a; have size_middle : size (drop a (take j doors)) = j - a.
    by rewrite size_drop size_takel // ltnW.
  rewrite -size_middle; apply: far_from_marker at_a _ far_j.
  by rewrite -walk_between // same_vertex_turn.
have first : depth <= j by have := early 0 (leq0n _); rewrite take0 subn0 => -> //; apply: same_vertex_refl.
split=> [|k' back_k' k'_k].
  by rewrite mul2n -addnn -(subnKC j_k) leq_add.
have k'_j : k' < j.
  by rewrite ltnNge; apply/negP=> le; have := none k'; rewrite le k'_k back_k'.
have := early k'.+1 k'_j; rewrite same_vertex_sym; move: back_k'; rewrite inE => -> /(_ erefl) middle.
by rewrite mul2n -addnn; arithmetic.
Qed.

Lemma far_returns_cost : (2 * depth).+1 * #|far_returns doors far| <= size doors.
Proof.
pose f (x : 'I_(size doors) * 'I_(2 * depth).+1) : 'I_(size doors) :=
  Ordinal (leq_ltn_trans (leq_subr x.2 x.1) (ltn_ord x.1)).
have apart (k k' : 'I_(size doors)) (i i' : 'I_(2 * depth).+1) :
    k \in far_returns doors far -> k' \in far_returns doors far -> k' < k -> k - i <> k' - i'.
  move=> /far_return_apart[_ gap] far_k' lt same; have := gap k'; rewrite lt.
  have -> : k' \in coming_back W doors by move: far_k'; rewrite inE => /andP[].
  have i_lt := ltn_ord i; move=> /(_ erefl erefl) le; have le' := leq_subr i' k'.
  by arithmetic.
have f_inj : {in setX (far_returns doors far) setT &, injective f}.
  move=> [k i] [k' i'] /setXP[/= far_k _] /setXP[/= far_k' _] /(congr1 val) /= same.
  have [lt|lt|eq_k] := ltngtP k k'.
  - by case: (apart k' k i' i far_k' far_k lt).
  - by case: (apart k k' i i' far_k far_k' lt).
  have eq_k' : k = k' by apply: val_inj.
  rewrite -eq_k' in same *; congr (_, _); apply: val_inj => /=.
  have [deep _] := far_return_apart far_k; have i_lt := ltn_ord i; have i'_lt := ltn_ord i'.
  by arithmetic.
rewrite -[X in _ <= X]card_ord -[(2 * depth).+1]card_ord -cardsT mulnC -cardsX -(card_in_imset f_inj).
exact: max_card.
Qed.

End Cost.

Lemma far_cycles_cost (robot : strategy start) (W : start) n answer (far : pred W) depth :
  (forall W, maps_start (moving directional) robot W) ->
  robot (history robot (moving directional W) n) = Answer answer ->
  (forall d, far (opposite d) = far d) ->
  (forall ds d, same_vertex (walk (facing W) ds) d -> far d -> depth <= size ds) ->
  (2 * depth + 1) * (far_edges far - far_vertices far) <= size (doors_taken robot directional W n).
Proof.
move=> maps_all answered far_opposite far_deep.
set doors := doors_taken _ _ _ _.
apply: leq_trans (@far_returns_cost W doors far depth far_opposite far_deep); rewrite addn1 leq_mul2l leq_subLR /=.
exact: (far_returns_needed (robot_determined maps_all answered) far_opposite).
Qed.
