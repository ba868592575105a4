(** A world whose text the checker accepts exists: a start that the text describes. *)

From Coq Require Import BinNat FMapPositive.
From Coq Require Nnat.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Walks Parts Verdicts Checker CheckerTables.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma first_notP test s : first_not test s = None -> forall n, n \in s -> test n.
Proof.
elim: s => //= d s IH; case: ifP => // test_d /IH later n; rewrite inE.
by case/predU1P=> [->|] //; apply: later.
Qed.

(** What is found from some darts has any property that these have and the steps keep. *)
Lemma reach_ind (P : N -> Prop) T fuel found next :
  (forall d, P d -> P (opposite_in T d) /\ P (odflt d (find (next_of T) d))) ->
  (forall d, has_entry found d -> P d) -> (forall d, d \in next -> P d) ->
  forall d, has_entry (reach T fuel found next) d -> P d.
Proof.
move=> kept; elim: fuel found next => [|_ fuel IH] found next //= found_P next_P.
case: next next_P => [|e next] // next_P; case: ifP => _.
  by apply: IH => // d d_next; apply: next_P; rewrite inE d_next orbT.
have P_e : P e by apply: next_P; rewrite mem_head.
have [P_o P_n] := kept e P_e; apply: IH => d.
  by rewrite /has_entry find_put; case: eqP => [->|_ /found_P].
by rewrite !inE => /or3P[/eqP->|/eqP->|d_next] //; apply: next_P; rewrite inE d_next orbT.
Qed.

Section World.

Variable t : world_text.

Let T := tables_of t.
Hypothesis right : wrong_world t T = None.

Let listE : dart_list T = numbers_in (vertex_lines t).
Proof. by rewrite /T /tables_of; case: (stands_of _). Qed.
Let setE : dart_set T = set_of (numbers_in (vertex_lines t)).
Proof. by rewrite /T /tables_of; case: (stands_of _). Qed.
Let facingE : facing_dart T = facing_line t.
Proof. by rewrite /T /tables_of; case: (stands_of _). Qed.
Let oppositesE : opposite_of T = opposites_of (edge_lines t).
Proof. by rewrite /T /tables_of; case: (stands_of _). Qed.
Let nextsE : next_of T = nexts_of (vertex_lines t).
Proof. by rewrite /T /tables_of; case: (stands_of _). Qed.

Lemma accepted_world : [/\ facing_line t \in dart_list T, tables_right t T
  & forall d, d \in dart_list T -> has_entry (reached T) d].
Proof.
move: right; rewrite /wrong_world; case: (foldl _ _ _) => [|d s] //.
case: (first_twice _ _) => //; case: (first_not _ _) => //; case: (first_twice _ _) => //.
case: (first_not _ _) => //; case: (first_not _ _) => //.
case: ifP => // /negbFE; rewrite setE has_entry_set_of -listE => facing_in.
case: ifP => // /negbFE tables_ok; case reached_all: (first_not _ _) => [//|] _.
by split=> //; apply: first_notP reached_all.
Qed.

Let T_right : tables_right t T. Proof. by case: accepted_world. Qed.

Let right_list d : d \in dart_list T -> right_at T d.
Proof. by move: T_right => /and4P[_ /allP all_right _ _] /all_right. Qed.

Let opposite_list d : d \in dart_list T ->
  [/\ opposite_in T d \in dart_list T, opposite_in T (opposite_in T d) = d, opposite_in T d != d
    & find (opposite_of T) d = Some (opposite_in T d)].
Proof.
move=> /right_list; rewrite /right_at /opposite_in; case: (find (stand_of T) d) => // -[[f g] j].
case: (find _ d) => // o; case: (find _ d) => // e; case: (find _ e) => // -[[f' g'] j'].
case/and5P=> _ _ _ _ /and5P[_ _ /eqP oppE neq]; rewrite setE has_entry_set_of -listE => o_in.
by split=> //=; rewrite oppE.
Qed.

Let next_in d := odflt d (find (next_of T) d).

Let next_list d : d \in dart_list T -> next_in d \in dart_list T /\ find (next_of T) d = Some (next_in d).
Proof.
move=> /right_list; rewrite /right_at /next_in; case: (find (stand_of T) d) => // -[[f g] j].
case: (find (opposite_of T) d) => // o; case nextE: (find _ d) => [e|] // _; split=> //=.
move: nextE; rewrite nextsE => /find_nexts_of /flattenP[_ /mapP[line line_in ->] in_line].
have [_ e_in] := mem_clockwise_pairs in_line.
by rewrite listE mem_numbers_in; apply/flattenP; exists line.
Qed.

Let next_inj d e : d \in dart_list T -> e \in dart_list T -> next_in d = next_in e -> d = e.
Proof.
have stand x : x \in dart_list T -> exists f g j,
    [/\ find (stand_of T) (next_in x) = Some (f, g, N.modulo (N.succ j) g), N.to_nat j < N.to_nat g
      & find (dart_at T) (N.add f j) = Some x].
  move=> x_in; have [_ nextE] := next_list x_in; have := right_list x_in; rewrite /right_at nextE.
  case: (find (stand_of T) x) => // -[[f g] j]; case: (find _ x) => // o.
  case: (find _ (next_in x)) => // -[[f' g'] j'] /and5P[lt /eqP-> /eqP-> /eqP-> /andP[/eqP at_x _]].
  by exists f, g, j; split=> //; rewrite -ltbP.
move=> /stand[f [g [j [standE lt at_d]]]] /stand[f' [g' [j' [standE' lt' at_e]]]] same.
move: standE'; rewrite -same standE => -[fE gE /(congr1 N.to_nat)]; rewrite !to_nat_mod !to_natS -gE.
rewrite -gE in lt'; move=> jE; suff j_eq : j = j' by move: at_e; rewrite -fE -j_eq at_d => -[].
apply: to_nat_inj; move/eqP: jE; rewrite -(add1n (N.to_nat j)) -(add1n (N.to_nat j')) eqn_modDl => /eqP.
by rewrite !modn_small.
Qed.

Definition names := map N.to_nat (dart_list T).
Definition text_dart := seq_sub names.

Definition number (d : text_dart) : N := N.of_nat (val d).

Lemma number_in d : number d \in dart_list T.
Proof. by have /mapP[n n_in valE] := ssvalP d; rewrite /number /= valE Nnat.N2Nat.id. Qed.

Lemma number_text_inj : injective number.
Proof. by move=> d e /Nnat.Nat2N.inj /val_inj. Qed.

Lemma name_in n : n \in dart_list T -> N.to_nat n \in names.
Proof. exact: map_f. Qed.

Definition text_opposite d : text_dart := SeqSub (name_in (let: And4 i _ _ _ := opposite_list (number_in d) in i)).
Definition text_clockwise d : text_dart := SeqSub (name_in (proj1 (next_list (number_in d)))).

Lemma number_opposite d : number (text_opposite d) = opposite_in T (number d).
Proof. by rewrite {1}/number /= Nnat.N2Nat.id. Qed.

Lemma number_clockwise d : number (text_clockwise d) = next_in (number d).
Proof. by rewrite {1}/number /= Nnat.N2Nat.id. Qed.

Lemma text_oppositeK : involutive text_opposite.
Proof.
move=> d; apply: number_text_inj; rewrite !number_opposite.
by have [] := opposite_list (number_in d).
Qed.

Lemma text_opposite_neq d : text_opposite d != d.
Proof.
apply/eqP => /(congr1 number); rewrite number_opposite => same.
by have [_ _ /eqP] := opposite_list (number_in d).
Qed.

Lemma text_clockwise_inj : injective text_clockwise.
Proof.
move=> d e /(congr1 number); rewrite !number_clockwise => /(next_inj (number_in d) (number_in e)).
exact: number_text_inj.
Qed.

Lemma numbered n : n \in dart_list T -> {d | number d = n}.
Proof. by move=> n_in; exists (SeqSub (name_in n_in)); rewrite /number /= Nnat.N2Nat.id. Qed.

Lemma text_connected (d e : text_dart) :
  connect (fun x y => (y == text_opposite x) || (y == text_clockwise x)) d e.
Proof.
set step := fun x y => _; have [facing_in _ all_reached] := accepted_world.
have [root rootE] := numbered facing_in.
apply: (all_connected text_oppositeK text_clockwise_inj (root := root)) => {d e} x.
pose P n := exists2 y, number y = n & connect step root y.
suff [y /number_text_inj-> //] : P (number x).
have P_root n : n \in [:: facing_dart T] -> P n.
  by rewrite inE facingE => /eqP->; exists root => //; apply: connect0.
have := all_reached _ (number_in x); rewrite /reached; apply: reach_ind P_root _ => [n [y <- root_y]|n].
  split; first exists (text_opposite y); rewrite ?number_opposite //.
    exact: connect_trans root_y (connect_opp _ _ _).
  exists (text_clockwise y); first by rewrite number_clockwise.
  exact: connect_trans root_y (connect_cw _ _ _).
by rewrite /has_entry find_empty.
Qed.

Definition text_world : embedded_graph :=
  EmbeddedGraph text_oppositeK text_opposite_neq text_clockwise_inj text_connected.

Lemma world_exists : exists (W : start) (number : W -> N), describes t number.
Proof.
have [facing_in _ _] := accepted_world; have [root rootE] := numbered facing_in.
exists (@Start text_world root), number; split=> //.
- exact: number_text_inj.
- move=> n; rewrite -mem_numbers_in -listE; split=> [/numbered[d <-]|[d <-]]; last exact: number_in.
  by exists d.
- move=> d; rewrite number_clockwise; apply: find_nexts_of; rewrite -nextsE.
  by have [] := next_list (number_in d).
move=> d; rewrite number_opposite; apply: find_opposites_of; rewrite -oppositesE.
by have [] := opposite_list (number_in d).
Qed.

End World.

(** And it is the only one, apart from what its darts are. *)
Lemma described_once t (V W : start) (number : V -> N) (number' : W -> N) :
  wrong_world t (tables_of t) = None -> describes t number -> describes t number' ->
  exists f : V -> W, [/\ isomorphism f, f (facing V) = facing W & forall d, number' (f d) = number d].
Proof.
move=> right; have [_ T_right _] := accepted_world right.
move=> /fits_described/(_ T_right) V_fits /fits_described/(_ T_right) W_fits.
have also (V' W' : start) (num : V' -> N) (num' : W' -> N) :
    fits (tables_of t) num -> fits (tables_of t) num' -> forall d, exists e, num' e == num d.
  move=> fits_num fits_num' d; have /(dart_listP fits_num) : exists d', num d' = num d by exists d.
  by case/(dart_listP fits_num')=> e eE; exists e; apply/eqP.
have onto := also _ _ _ _ W_fits V_fits; have {}also := also _ _ _ _ V_fits W_fits.
pose f d := xchoose (also d); have fE d : number' (f d) = number d := eqP (xchooseP (also d)).
pose g e := xchoose (onto e); have gE e : number (g e) = number' e := eqP (xchooseP (onto e)).
have fP d e : number' e = number d -> f d = e by rewrite -fE => /(number_inj W_fits).
exists f; split=> //; last by apply: fP; rewrite -(facing_dartE V_fits) -(facing_dartE W_fits).
split=> [|d|d].
- exists g => [d|e]; last by apply: fP; rewrite gE.
  by apply: (number_inj V_fits); rewrite gE fE.
- apply: fP; have := find_opposite W_fits (f d).
  by rewrite fE (find_opposite V_fits) => -[].
apply: fP; have := find_next W_fits (f d).
by rewrite fE (find_next V_fits) => -[].
Qed.

(** What is shown with the tables of a world is true in it. *)
Lemma in_worldP t (claimed : forall W : start, (W -> N) -> Prop) :
  wrong_world t (tables_of t) = None ->
  (forall (W : start) (number : W -> N), fits (tables_of t) number -> claimed W number) ->
  in_world t claimed.
Proof.
move=> right shown; split=> [|W num described]; first exact: world_exists.
by apply: shown; apply: fits_described described _; case: (accepted_world right).
Qed.
