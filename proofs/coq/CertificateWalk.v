(** A walk that is as long as the formula of the certificate, and determines its world: for each edge outside a
    breadth-first tree there and back, on the way along each edge that hangs, and last to a hanging leaf. Beyond
    Section 2.3. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Certificate Walks Arithmetic Parts Complete Trail Hanging
  CertificateNeeded.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Tree.

Variable W : start.
Implicit Types (x y h p e : W) (s t : seq W).

Notation marked x := (same_vertex (facing W) x).

(** * A breadth-first tree *)

(** The dart at a vertex that leads toward the marker. *)
Definition up x : W :=
  odflt x [pick y | same_vertex (froot clockwise x) y && (distance y == (distance (opposite y)).+1)].

Let sym := fconnect_sym (@clockwise_inj W).

Lemma up_same x y : same_vertex x y -> ~~ marked x -> up x = up y.
Proof.
move=> xy away; have same : froot clockwise x = froot clockwise y by apply/eqP; rewrite root_connect.
rewrite /up same; case: pickP => // none; case: (posnP (distance x)) => [/distance0|]; first by rewrite (negPf away).
case/distance_parent=> z xz dE; have := none z; rewrite -(distance_same xz) dE eqxx andbT -same.
by rewrite (same_vertex_trans _ xz) // same_vertex_sym; apply: connect_root.
Qed.

Lemma upP x : ~~ marked x -> same_vertex x (up x) /\ distance (up x) = (distance (opposite (up x))).+1.
Proof.
move=> away; rewrite /up; case: pickP => [y /andP[near /eqP ->]|none] /=.
  by split=> //; apply: same_vertex_trans near; apply: connect_root.
case: (posnP (distance x)) => [/distance0|]; first by rewrite (negPf away).
case/distance_parent=> z xz dE; have := none z; rewrite -(distance_same xz) dE eqxx andbT.
by rewrite (same_vertex_trans _ xz) // same_vertex_sym; apply: connect_root.
Qed.

Definition leads_up x := ~~ marked x && (up x == x).
Definition in_tree x := leads_up x || leads_up (opposite x).

Lemma in_tree_opposite x : in_tree (opposite x) = in_tree x.
Proof. by rewrite /in_tree oppositeK orbC. Qed.

Lemma leads_up_distance x : leads_up x -> distance x = (distance (opposite x)).+1.
Proof. by case/andP=> away /eqP upE; have [_] := upP away; rewrite upE. Qed.

Lemma leads_up_once x : leads_up x -> ~~ leads_up (opposite x).
Proof.
move/leads_up_distance=> dE; apply/negP=> /leads_up_distance; rewrite oppositeK dE.
by move/eqP; rewrite -addn2 -{1}[distance _]addn0 eqn_add2l.
Qed.

Lemma leads_up_up x : ~~ marked x -> leads_up (up x).
Proof.
move=> away; have [near _] := upP away; have away' : ~~ marked (up x).
  by apply: contra away => at_up; apply: same_vertex_trans at_up _; rewrite same_vertex_sym.
by rewrite /leads_up away' -(up_same near away) eqxx.
Qed.

Lemma leads_up_same x y : leads_up x -> leads_up y -> same_vertex x y -> x = y.
Proof. by case/andP=> away /eqP {2}<- /andP[_ /eqP {2}<-] near; apply: up_same. Qed.

Lemma hanging_leads_up h : h \in hanging W -> leads_up h.
Proof.
move=> h_hangs; have /hangingP[away all] := h_hangs; rewrite /leads_up away /=.
have [near dE] := upP away; apply: contraT => other; have := distance_hanging (all _ near other).
rewrite oppositeK dE => /eqP; rewrite -addn2 -{1}[distance _]addn0 eqn_add2l //.
Qed.

(** * Walks as sequences of darts *)

Fixpoint valid p s := if s is e :: s' then same_vertex p e && valid (opposite e) s' else true.
Definition end_of p s := last p (map opposite s).
Fixpoint doors_of p s := if s is e :: s' then findex clockwise p e :: doors_of (opposite e) s' else [::].

Lemma size_doors_of p s : size (doors_of p s) = size s.
Proof. by elim: s p => //= e s IH p; rewrite IH. Qed.

Lemma end_of_cat p s t : end_of p (s ++ t) = end_of (end_of p s) t.
Proof. by rewrite /end_of map_cat last_cat. Qed.

Lemma valid_cat p s t : valid p (s ++ t) = valid p s && valid (end_of p s) t.
Proof. by elim: s p => //= e s IH p; rewrite IH andbA. Qed.

Lemma valid_same p q s : same_vertex p q -> valid p s = valid q s.
Proof.
move=> pq; case: s => //= e s; congr (_ && _); apply/idP/idP; last exact: same_vertex_trans.
by apply: same_vertex_trans; rewrite same_vertex_sym.
Qed.

Lemma end_of_same p q s : same_vertex p q -> same_vertex (end_of p s) (end_of q s).
Proof. by case: s => //= e s _; apply: same_vertex_refl. Qed.

Lemma walk_doors_of p s k : valid p s -> walk p (take k (doors_of p s)) = end_of p (take k s).
Proof.
elim: s p k => [|e s IH] p [|k] //= /andP[pe ok].
by rewrite /traverse /turn iter_findex // IH.
Qed.

Lemma out_doors_of p s k : valid p s -> k < size s ->
  turn (walk p (take k (doors_of p s))) (nth 0 (doors_of p s) k) = nth p s k.
Proof.
elim: s p k => [|e s IH] p [|k] //= /andP[pe ok]; first by rewrite /turn iter_findex.
rewrite ltnS => lt; rewrite /traverse /turn iter_findex // -/(turn _ _) IH //.
exact: set_nth_default.
Qed.

(** Each part between edges outside the tree comes by the marker. *)
Fixpoint anchored (b : bool) p s :=
  if s is e :: s' then
    if in_tree e then anchored (b || marked p) (opposite e) s'
    else (b || marked p) && anchored false (opposite e) s'
  else b || marked p.

Lemma anchored_le (b b' : bool) p s : b ==> b' -> anchored b p s -> anchored b' p s.
Proof.
elim: s b b' p => [|e s IH] b b' p /implyP le /=; first by case/orP=> [/le->|->]; rewrite ?orbT.
case: ifP => _; last by case/andP=> /orP[/le->|->]; rewrite ?orbT.
by apply: IH; apply/implyP=> /orP[/le->|->]; rewrite ?orbT.
Qed.

Lemma marked_same p q : same_vertex p q -> marked p = marked q.
Proof.
move=> pq; apply/idP/idP => near; first exact: same_vertex_trans near pq.
by apply: same_vertex_trans near _; rewrite same_vertex_sym.
Qed.

Lemma anchored_same b p q s : same_vertex p q -> anchored b p s = anchored b q s.
Proof. by move=> pq; case: s => [|e s] /=; rewrite (marked_same pq). Qed.

Lemma anchored_marked b p s : marked p -> anchored b p s = anchored true p s.
Proof. by move=> at_p; case: s => [|e s] /=; rewrite at_p orbT. Qed.

Lemma anchored_tree b p t s : all in_tree t -> anchored b (end_of p t) s -> anchored b p (t ++ s).
Proof.
elim: t b p => //= e t IH b p /andP[-> all_t] ok; apply: IH => //.
by apply: anchored_le ok; apply/implyP=> ->.
Qed.

(** * An excursion along an edge of the tree *)

Lemma anchored_excursion b p s s' e : in_tree e -> same_vertex (end_of p s) e ->
  anchored b p (s ++ s') -> anchored b p (s ++ e :: opposite e :: s').
Proof.
move=> tree_e; elim: s b p => [|f s IH] b p /=.
  move=> near ok; rewrite tree_e in_tree_opposite tree_e oppositeK (anchored_same _ _ near) in ok *.
  by apply: anchored_le ok; apply/implyP=> ->.
by move=> near; case: ifP => _; [apply: IH | case/andP=> -> /=; apply: IH].
Qed.

Lemma valid_excursion p s s' e : same_vertex (end_of p s) e ->
  valid p (s ++ s') -> valid p (s ++ e :: opposite e :: s').
Proof.
move=> near; rewrite !valid_cat => /andP[-> /=]; rewrite near same_vertex_refl oppositeK /=.
by rewrite (valid_same _ near).
Qed.

Definition covers s e := (e \in s) || (opposite e \in s).

Lemma covers_opposite s e : covers s (opposite e) = covers s e.
Proof. by rewrite /covers oppositeK orbC. Qed.

Definition uncovered s : {set W} := [set h | leads_up h && ~~ covers s h].

(** Both ends of an edge of the walk are visited. *)
Lemma visited p s e : valid p s -> covers s e ->
  exists s1 s2, s = s1 ++ s2 /\ same_vertex (end_of p s1) e.
Proof.
move=> ok /orP[]/splitPr s_split; case: s_split ok => s1 s2; rewrite valid_cat /= => /and3P[_ near _].
  by exists s1, (e :: s2).
exists (rcons s1 (opposite e)), s2; rewrite cat_rcons; split=> //.
by rewrite /end_of map_rcons last_rcons oppositeK same_vertex_refl.
Qed.

Lemma excursions s : valid (facing W) s -> anchored false (facing W) s ->
  exists s', [/\ valid (facing W) s', anchored false (facing W) s',
    size s' = size s + 2 * #|uncovered s|, {subset s <= s'} & forall h, leads_up h -> covers s' h].
Proof.
move dE: #|uncovered s| => k; elim: k s dE => [|k IH] s dE ok anch.
  exists s; rewrite muln0 addn0; split=> // h up_h; apply: contraT => none.
  by have : h \in uncovered s; [rewrite inE up_h | rewrite (cards0_eq dE) inE].
have [h h_un least] : exists2 h, h \in uncovered s & forall g, g \in uncovered s -> distance h <= distance g.
  have /card_gt0P[h0 h0_un] : 0 < #|uncovered s| by rewrite dE.
  by case: (arg_minnP (fun h : W => distance h) h0_un) => h h_un least; exists h.
have := h_un; rewrite inE => /andP[up_h none]; set e := opposite h.
have [s1 [s2 [sE near]]] : exists s1 s2, s = s1 ++ s2 /\ same_vertex (end_of (facing W) s1) e.
  have [at_marker|away] := boolP (marked e); first by exists [::], s.
  have up_e := leads_up_up away; have [near_e d_up] := upP away.
  have : covers s (up e).
    apply: contraT => not_covered; have := least (up e); rewrite inE up_e not_covered => /(_ isT).
    by rewrite (leads_up_distance up_h) -/e (distance_same near_e) ltnn.
  case/(visited ok)=> s1 [s2 [sE near]]; exists s1, s2; split=> //.
  by apply: same_vertex_trans near _; rewrite same_vertex_sym.
pose s' := s1 ++ e :: opposite e :: s2.
have tree_e : in_tree e by rewrite in_tree_opposite /in_tree up_h.
have in_s' g : (g \in s') = [|| g \in s, g == e | g == h].
  rewrite /s' sE !mem_cat !inE /e oppositeK.
  by case: (g \in s1); case: (g \in s2); case: (g == opposite h); case: (g == h).
have covers' g : covers s' g = [|| covers s g, g == h | g == opposite h].
  have -> : (g == opposite h) = (g == e) by [].
  have to_e : (opposite g == e) = (g == h) by rewrite /e (inj_eq (@opposite_inj W)).
  have to_h : (opposite g == h) = (g == e) by rewrite (inv_eq (@oppositeK W)).
  rewrite /covers !in_s' to_e to_h.
  by case: (g \in s); case: (opposite g \in s); case: (g == e); case: (g == h).
have un' : uncovered s' = uncovered s :\ h.
  apply/setP=> g; rewrite !inE covers' !negb_or; case: (eqVneq g h) => [->|_]; rewrite ?andbF //=.
  case up_g: (leads_up g) => //=; case: (eqVneq g (opposite h)) => [gE|]; rewrite ?andbT //.
  by have := leads_up_once up_h; rewrite -gE up_g.
have [|||s'' [ok'' anch'' size'' sub all_up]] := IH s'.
- by apply: succn_inj; rewrite -dE (cardsD1 h (uncovered s)) h_un un'.
- by apply: valid_excursion near _; rewrite -sE.
- by apply: anchored_excursion tree_e near _; rewrite -sE.
exists s''; split=> //; last by move=> g g_s; apply: sub; rewrite in_s' g_s.
rewrite size'' sE !size_cat /= mulnS; by arithmetic.
Qed.

(** * Ways along the tree *)

Fixpoint back_by k x := if k is k'.+1 then up x :: back_by k' (opposite (up x)) else [::].
Fixpoint way_by k x :=
  if k is k'.+1 then rcons (way_by k' (opposite (up x))) (opposite (up x)) else [::].

Definition back x := back_by (distance x) x.
Definition way x := way_by (distance x) x.

Lemma size_back_by k x : size (back_by k x) = k.
Proof. by elim: k x => //= k IH x; rewrite IH. Qed.

Lemma size_way_by k x : size (way_by k x) = k.
Proof. by elim: k x => //= k IH x; rewrite size_rcons IH. Qed.

Lemma way_back_by k x : way_by k x = rev (map opposite (back_by k x)).
Proof. by elim: k x => //= k IH x; rewrite rev_cons IH. Qed.

Let away_of k x : distance x = k.+1 -> ~~ marked x.
Proof. by move=> dE; apply/negP=> /distance_same; rewrite distance_facing dE. Qed.

Let next_of k x : distance x = k.+1 ->
  [/\ same_vertex x (up x), leads_up (up x) & distance (opposite (up x)) = k].
Proof.
move=> dE; have away := away_of dE; have [near d_up] := upP away; split=> //; first exact: leads_up_up.
by apply: succn_inj; rewrite -d_up -(distance_same near).
Qed.

Lemma backP k x : distance x = k ->
  [/\ valid x (back_by k x), marked (end_of x (back_by k x)) & all leads_up (back_by k x)].
Proof.
elim: k x => [|k IH] x dE; first by split=> //; apply: distance0.
have [near up_up d_next] := next_of dE; have [ok at_end all_up] := IH _ d_next.
by split=> //=; rewrite ?near ?up_up.
Qed.

Lemma wayP k x : distance x = k -> [/\ valid (facing W) (way_by k x), same_vertex (end_of (facing W) (way_by k x)) x
    & all in_tree (way_by k x)].
Proof.
elim: k x => [|k IH] x dE; first by split=> //; apply: distance0.
have [near up_up d_next] := next_of dE; have [ok at_end all_tree] := IH _ d_next => /=.
rewrite -cats1 valid_cat ok all_cat all_tree /= at_end in_tree_opposite /in_tree up_up; split=> //.
by rewrite /end_of cats1 map_rcons last_rcons oppositeK same_vertex_sym.
Qed.

(** If the way back has the edge above a vertex, it goes on from the next one. *)
Lemma back_closed k x g : distance x = k -> g \in back_by k x -> ~~ marked (opposite g) ->
  up (opposite g) \in back_by k x.
Proof.
elim: k x => [|k IH] x dE //=; have [_ _ d_next] := next_of dE; rewrite !inE => /predU1P[->|g_in] away.
  case: k {IH} d_next dE => [/distance0|k d_next _]; first by rewrite (negPf away).
  by rewrite /= !inE eqxx orbT.
by rewrite IH ?orbT.
Qed.

End Tree.
