(** A chain of edges from the marker to a vertex with loops: worlds in which every robot that maps every world
    makes of order m n moves. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Parts Complete Returns.
From toposlam Require Figures.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Lollipop.

(** The numbers of edges of the chain, less one, and of loops. *)
Variables (chain loops : nat).

(** The ends of the loops, and those of the edges of the chain, each the nearer one to the marker first. *)
Definition lollipop_dart := ('I_loops * bool + 'I_chain.+1 * bool)%type.

Implicit Types d e : lollipop_dart.

Definition place d : nat :=
  match d with inl _ => chain.+1 | inr (i, far_end) => i + far_end end.

Definition lollipop_opposite d : lollipop_dart :=
  match d with inl (i, b) => inl (i, ~~ b) | inr (i, b) => inr (i, ~~ b) end.

Definition at_place (v : nat) : seq lollipop_dart := [seq d <- enum [finType of lollipop_dart] | place d == v].

Definition lollipop_clockwise d : lollipop_dart := next (at_place (place d)) d.

Lemma mem_at_place v d : (d \in at_place v) = (place d == v).
Proof. by rewrite mem_filter mem_enum andbT. Qed.

Lemma uniq_at_place v : uniq (at_place v).
Proof. by rewrite filter_uniq ?enum_uniq. Qed.

Lemma place_clockwise d : place (lollipop_clockwise d) = place d.
Proof. by apply/eqP; rewrite -mem_at_place mem_next mem_at_place. Qed.

Lemma lollipop_oppositeK : involutive lollipop_opposite.
Proof. by case=> [[i b]|[i b]] /=; rewrite negbK. Qed.

Lemma lollipop_opposite_neq d : lollipop_opposite d != d.
Proof. by apply/eqP; case: d => [[i []]|[i []]]. Qed.

Lemma lollipop_clockwise_inj : injective lollipop_clockwise.
Proof.
move=> d e same; have same_place : place d = place e by rewrite -place_clockwise same place_clockwise.
move: same => /(congr1 (prev (at_place (place d)))).
by rewrite {2}same_place /lollipop_clockwise !prev_next ?uniq_at_place // same_place prev_next ?uniq_at_place.
Qed.

Lemma turn_place d e : place d = place e -> exists i, e = iter i lollipop_clockwise d.
Proof.
move=> same; have d_in : d \in at_place (place d) by rewrite mem_at_place.
have e_in : e \in at_place (place d) by rewrite mem_at_place same.
have [i eE] := Figures.iter_next (uniq_at_place _) d_in e_in; exists i; rewrite eE.
have at_j j : place (iter j lollipop_clockwise d) = place d by elim: j => //= j <-; rewrite place_clockwise.
by elim: i {eE} => //= i ->; rewrite /lollipop_clockwise at_j.
Qed.

Let step := fun x y : lollipop_dart => (y == lollipop_opposite x) || (y == lollipop_clockwise x).
Let near := fun x y : lollipop_dart =>
  (y == lollipop_clockwise x) || (y == lollipop_opposite x) && ~~ (if x is inl _ then true else false).

Definition lollipop_facing : lollipop_dart := inr (ord0, false).

(** Every vertex is reached over the chain. *)
Lemma near_all d : connect near lollipop_facing d.
Proof.
have around e e' : place e = place e' -> connect near e e'.
  case/turn_place=> i ->; elim: i => [|i IH] /=; first exact: connect0.
  by apply: connect_trans IH (connect1 _); rewrite /near eqxx.
have along (i : 'I_chain.+1) : connect near lollipop_facing (inr (i, false)).
  case: i => k; elim: k => [|k IH] lt.
    by rewrite (_ : inr _ = lollipop_facing) ?connect0 //; congr (inr (_, _)); apply: val_inj.
  apply: connect_trans (IH (ltnW lt)) (connect_trans (_ : connect near _ (inr (Ordinal (ltnW lt), true))) _).
    by apply: connect1; rewrite /near /= eqxx orbT.
  by apply: around; rewrite /= addn1 addn0.
have far (i : 'I_chain.+1) : connect near lollipop_facing (inr (i, true)).
  by apply: connect_trans (along i) (connect1 _); rewrite /near /= eqxx orbT.
case: d => [[i b]|[i []]] //.
apply: connect_trans (far ord_max) (around _ _ _); by rewrite /= addn1.
Qed.

Lemma lollipop_connected d e : connect step d e.
Proof.
apply: (all_connected (root := lollipop_facing)) => [||x].
- exact: lollipop_oppositeK.
- exact: lollipop_clockwise_inj.
apply: connect_sub (near_all x) => y z /orP[/eqP->|/andP[/eqP-> _]]; [exact: connect_cw | exact: connect_opp].
Qed.

Definition lollipop : start :=
  @Start (@EmbeddedGraph [finType of lollipop_dart] _ _ lollipop_oppositeK lollipop_opposite_neq lollipop_clockwise_inj
    lollipop_connected) lollipop_facing.

Lemma lollipop_same_vertex (d e : lollipop) : same_vertex d e = (place d == place e).
Proof.
apply/same_vertexP/eqP => [[i ->]|/turn_place[i ->]]; last by exists i.
by elim: i => //= i ->; rewrite place_clockwise.
Qed.

Definition on_loop : pred lollipop := fun d => if d is inl _ then true else false.

Lemma on_loop_opposite (d : lollipop) : on_loop (opposite d) = on_loop d.
Proof. by case: d => [[i b]|[i b]]. Qed.

Lemma place_walk doors : place (walk (facing lollipop) doors) <= size doors.
Proof.
elim/last_ind: doors => [|doors i IH] //; rewrite walk_rcons size_rcons.
have same : place (turn (walk (facing lollipop) doors) i) = place (walk (facing lollipop) doors).
  by apply/eqP; rewrite -lollipop_same_vertex same_vertex_sym same_vertex_turn.
rewrite -{}same in IH; rewrite /traverse; move: (turn _ _) IH => d; case: d => [[k b]|[k b]] /= le.
  exact: leq_trans le (leqnSn _).
move: le; case: b => /=; rewrite addn0 addn1 // => lt; exact: leq_trans (ltnW lt) (leqnSn _).
Qed.

Lemma loops_deep doors (d : lollipop) :
  same_vertex (walk (facing lollipop) doors) d -> on_loop d -> chain.+1 <= size doors.
Proof.
rewrite lollipop_same_vertex => /eqP same; case: d same => // -[i b] /= <- _.
exact: place_walk.
Qed.

Lemma lollipop_edges : edges lollipop = chain.+1 + loops.
Proof.
by rewrite /edges card_sum !card_prod !card_ord card_bool !muln2 -doubleD doubleK addnC.
Qed.

Lemma lollipop_far_edges : far_edges (W := lollipop) on_loop = loops.
Proof.
apply/eqP; rewrite -(eqn_pmul2r (m := 2)) //; apply/eqP.
have two : {subset on_loop <= order_set (@opposite lollipop) 2}.
  by move=> d _; rewrite inE order_opposite.
have closed_loops : fclosed (@opposite lollipop) on_loop.
  by move=> x y /eqP<-; rewrite -!topredE /= on_loop_opposite.
have := fcard_order_set (inv_inj (@oppositeK lollipop)) (introT subsetP two) closed_loops.
have -> : #|on_loop| = loops * 2.
  have inl_inj : injective (inl : 'I_loops * bool -> lollipop) by move=> x y [].
  transitivity #|codom (inl : 'I_loops * bool -> lollipop)|; last by rewrite card_codom // card_prod card_ord card_bool.
  apply: eq_card => -[x|x]; first by rewrite codom_f.
  by apply/esym/negbTE/codomP => -[].
by move=> <-; congr (_ * 2); rewrite /far_edges cardsE; apply: eq_card => d; rewrite !inE.
Qed.

Lemma lollipop_far_vertices : far_vertices (W := lollipop) on_loop = 0.
Proof.
apply: eq_card0 => d; rewrite !inE; apply/negbTE; rewrite negb_and negbK; apply/orP; right.
exact: near_all.
Qed.

Lemma place_lt (d : lollipop) : place d < chain.+2.
Proof.
case: d => [[i b]|[i b]] //=; have := ltn_ord i; case: b; rewrite ?addn1 ?addn0 // => lt; exact: ltnW.
Qed.

Lemma lollipop_vertices : vertices lollipop = chain.+2.
Proof.
have sym := fconnect_sym (@clockwise_inj lollipop).
pose roots := [set d : lollipop | froot clockwise d == d].
have -> : vertices lollipop = #|roots| by rewrite cardsE; apply: eq_card => d; rewrite !inE andbT.
pose f (d : lollipop) := Ordinal (place_lt d).
have f_inj : {in roots &, injective f}.
  move=> d e; rewrite !inE => /eqP root_d /eqP root_e /(congr1 val) /= same.
  have one_vertex : same_vertex d e by rewrite lollipop_same_vertex same.
  by rewrite -root_d -root_e; apply/eqP; rewrite root_connect.
rewrite -(card_in_imset f_inj) -[RHS]card_ord -cardsT; apply: eq_card => v; rewrite inE.
have [d place_d] : exists d : lollipop, place d = v.
  case: v => -[|v] lt; first by exists lollipop_facing.
  by exists (inr (Ordinal (lt : v < chain.+1), true)); rewrite /= addn1.
apply/imsetP; exists (froot clockwise d); first by rewrite inE root_root.
apply: val_inj; rewrite /= -place_d; apply/eqP; rewrite -lollipop_same_vertex.
exact: connect_root.
Qed.

Lemma lollipop_cost (robot : strategy start) n answer :
  (forall W, maps_start (moving directional) robot W) ->
  robot (history robot (moving directional lollipop) n) = Answer answer ->
  (2 * chain.+1 + 1) * loops <= size (doors_taken robot directional lollipop n).
Proof.
move=> maps_all answered.
have := far_cycles_cost maps_all answered on_loop_opposite loops_deep.
by rewrite lollipop_far_edges lollipop_far_vertices subn0.
Qed.

End Lollipop.
