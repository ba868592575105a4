(** The tables of the checker are right: those of lists, and those of a world in each start that its text
    describes. *)

From Coq Require Import BinNat FMapPositive.
From Coq Require PeanoNat Nnat.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Parts Verdicts Checker.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Binary numbers *)

Lemma succ_pos_inj : injective N.succ_pos.
Proof. by move=> m n /(congr1 N.pos); rewrite !N.succ_pos_spec => /N.succ_inj. Qed.

Lemma to_nat_inj : injective N.to_nat.
Proof. exact: Nnat.N2Nat.inj. Qed.

Lemma to_natD m n : N.to_nat (N.add m n) = N.to_nat m + N.to_nat n.
Proof. by rewrite Nnat.N2Nat.inj_add. Qed.

Lemma to_natB m n : N.to_nat (N.sub m n) = N.to_nat m - N.to_nat n.
Proof. by rewrite Nnat.N2Nat.inj_sub. Qed.

Lemma to_natS n : N.to_nat (N.succ n) = (N.to_nat n).+1.
Proof. exact: Nnat.N2Nat.inj_succ. Qed.

Lemma ltbP m n : N.ltb m n = (N.to_nat m < N.to_nat n).
Proof.
apply/idP/idP => [/N.ltb_lt|/ltP] lt; last first.
  by apply/N.ltb_lt; rewrite /N.lt Nnat.N2Nat.inj_compare; apply/PeanoNat.Nat.compare_lt_iff.
by apply/ltP/PeanoNat.Nat.compare_lt_iff; rewrite -Nnat.N2Nat.inj_compare.
Qed.

Lemma lebP m n : N.leb m n = (N.to_nat m <= N.to_nat n).
Proof. by rewrite N.leb_antisym ltbP -leqNgt. Qed.

Lemma eqbP m n : (m == n) = (N.to_nat m == N.to_nat n).
Proof. by rewrite (inj_eq to_nat_inj). Qed.

Lemma to_nat_mod m n : N.to_nat (N.modulo m n) = N.to_nat m %% N.to_nat n.
Proof.
case: (eqVneq n N0) => [->|n_neq0]; first by case: m => //= p; rewrite modn0.
have n_gt0 : 0 < N.to_nat n.
  by rewrite lt0n; apply: contra n_neq0; rewrite eqbP.
rewrite [in RHS](N.div_mod' m n) to_natD Nnat.N2Nat.inj_mul multE mulnC modnMDl modn_small //.
by rewrite -ltbP; apply/N.ltb_lt/N.mod_lt/eqP.
Qed.

(** * Tables *)

Lemma find_empty A n : find (@empty A) n = None.
Proof. by rewrite /find PositiveMap.gempty. Qed.

Lemma find_put A (t : table A) n a m : find (put t n a) m = if m == n then Some a else find t m.
Proof.
rewrite /find /put; case: eqP => [->|neq]; first by rewrite PositiveMap.gss.
by rewrite PositiveMap.gso // => /succ_pos_inj.
Qed.

Lemma has_entryP A (t : table A) n : reflect (exists a, find t n = Some a) (has_entry t n).
Proof. by rewrite /has_entry; case: (find t n) => [a|]; constructor; [exists a | case]. Qed.

Lemma find_table_of A (s : seq A) n x0 :
  find (table_of s) n = if N.to_nat n < size s then Some (nth x0 s (N.to_nat n)) else None.
Proof.
rewrite /table_of; suff -> : forall (t : table A) (i : N),
    find (foldl (fun t_n b => (put t_n.1 t_n.2 b, N.succ t_n.2)) (t, i) s).1 n =
    if N.to_nat i <= N.to_nat n < N.to_nat i + size s then Some (nth x0 s (N.to_nat n - N.to_nat i)) else find t n.
  by rewrite find_empty leq0n add0n subn0.
elim: s => [|b s IH] t i /=; first by rewrite addn0 ltnNge andbN.
rewrite IH to_natS find_put eqbP addSnnS.
case: (ltngtP (N.to_nat i) (N.to_nat n)) => [lt|//|->].
  by case: ifP => // _; rewrite -(subnSK lt).
by rewrite subnn addnS ltnS leq_addr.
Qed.

Lemma lengthE A (s : seq A) : N.to_nat (length s) = size s.
Proof.
rewrite /length; suff: forall n, N.to_nat (foldl (fun n _ => N.succ n) n s) = N.to_nat n + size s by move=> ->.
elim: s => [|a s IH] n /=; first by rewrite addn0.
by rewrite IH to_natS addSnnS.
Qed.

Lemma all_belowP T (fuel : seq T) n test :
  all_below fuel N0 n test -> forall i, N.to_nat i < N.to_nat n -> test i.
Proof.
move=> all_test i; suff: forall j, all_below fuel j n test ->
    N.to_nat j <= N.to_nat n -> N.to_nat j <= N.to_nat i -> N.to_nat i < N.to_nat n -> test i.
  by move=> /(_ N0 all_test); apply.
move=> {all_test} j; elim: fuel j => [|a fuel IH] j /=; case: N.eqb_spec => [-> _ _ le|neq] //.
- by rewrite ltnNge le.
- by rewrite ltnNge le.
case: ifP => // test_j /IH later j_le le lt.
have j_lt : N.to_nat j < N.to_nat n.
  by rewrite ltn_neqAle j_le andbT; apply/eqP => /to_nat_inj.
case: (ltngtP (N.to_nat j) (N.to_nat i)) le => // [j_i|/to_nat_inj<-] // _.
by apply: later; rewrite ?to_natS.
Qed.

(** * The lists of a world *)

Lemma mem_numbers_in lines n : (n \in numbers_in lines) = (n \in flatten lines).
Proof.
rewrite /numbers_in -[RHS]/((n \in [::]) || _).
elim: lines [::] => [|line lines IH] s /=; first by rewrite orbF.
by rewrite IH catrevE !mem_cat mem_rev orbA [(n \in s) || _]orbC.
Qed.

Lemma has_entry_set_of s n : has_entry (set_of s) n = (n \in s).
Proof.
suff: forall t, has_entry (foldl (fun t d => put t d tt) t s) n = has_entry t n || (n \in s).
  by move=> ->; rewrite /has_entry find_empty.
elim: s => [|d s IH] t /=; first by rewrite orbF.
by rewrite IH /has_entry find_put inE; case: eqP => //=; rewrite orbT.
Qed.

Lemma find_opposites_of edges d e :
  find (opposites_of edges) d = Some e -> (d, e) \in edges \/ (e, d) \in edges.
Proof.
suff: forall t, find (foldl (fun t edge => put (put t edge.1 edge.2) edge.2 edge.1) t edges) d = Some e ->
    find t d = Some e \/ (d, e) \in edges \/ (e, d) \in edges.
  by move=> /(_ empty) H /H; rewrite find_empty => -[].
elim: edges => [|[a b] edges IH] t /=; first by left.
case/IH => [|[in_edges|in_edges]]; last by rewrite !inE in_edges !orbT; right; right.
  rewrite !find_put !inE; case: eqP => [-> [->]|_]; first by right; right; rewrite eqxx.
  by case: eqP => [-> [->]|_]; [right; left; rewrite eqxx | left].
by rewrite !inE in_edges !orbT; right; left.
Qed.

Lemma fold_aroundE A (f : A -> N -> N -> A) a line :
  fold_around f a line = foldl (fun a pair => f a pair.1 pair.2) a (clockwise_pairs line).
Proof.
case: line => [|d others] //=; rewrite /clockwise_pairs rot1_cons.
suff: forall d a first, fold_around_from f first d others a =
    foldl (fun a pair => f a pair.1 pair.2) a (zip (d :: others) (rcons others first)) by move->.
by elim: others => [|e others IH] d' a' first //=; rewrite IH.
Qed.

Lemma fold_linesE A (f : A -> N -> N -> A) a lines :
  foldl (fold_around f) a lines =
  foldl (fun a pair => f a pair.1 pair.2) a (flatten (map clockwise_pairs lines)).
Proof. by elim: lines a => //= line lines IH a; rewrite foldl_cat -fold_aroundE. Qed.

Lemma find_nexts_of lines d e :
  find (nexts_of lines) d = Some e -> (d, e) \in flatten (map clockwise_pairs lines).
Proof.
rewrite /nexts_of fold_linesE; set pairs := flatten _.
suff: forall t, find (foldl (fun t pair => put t pair.1 pair.2) t pairs) d = Some e ->
    find t d = Some e \/ (d, e) \in pairs.
  by move=> /(_ empty) H /H; rewrite find_empty => -[].
elim: pairs => [|[a b] pairs IH] t /=; first by left.
case/IH => [|in_pairs]; last by right; rewrite inE in_pairs orbT.
by rewrite find_put !inE; case: eqP => [-> [->]|_]; [right; rewrite eqxx | left].
Qed.

Lemma fold_allE T (test : pred T) s : foldl (fun right x => if right then test x else false) true s = all test s.
Proof.
elim: s => //= x s IH; case: (test x) => //=.
by elim: s {IH}.
Qed.

Lemma mem_clockwise_pairs line d e : (d, e) \in clockwise_pairs line -> d \in line /\ e \in line.
Proof.
rewrite /clockwise_pairs => in_zip; split.
  have := map_f (@fst N N) in_zip; rewrite -/unzip1 unzip1_zip //; by rewrite size_rot.
have := map_f (@snd N N) in_zip; rewrite -/unzip2 unzip2_zip ?size_rot //.
by rewrite mem_rot.
Qed.

(** * The tables of a world *)

(** They fit a start with numbered darts. *)
Record fits (T : tables) (W : start) (number : W -> N) : Prop := Fits {
  number_inj : injective number;
  find_opposite d : find (opposite_of T) (number d) = Some (number (opposite d));
  find_next d : find (next_of T) (number d) = Some (number (clockwise d));
  right_dart d : right_at T (number d);
  dart_listP n : n \in dart_list T <-> exists d, number d = n;
  dart_setP n : has_entry (dart_set T) n <-> exists d, number d = n;
  facing_dartE : facing_dart T = number (facing W)
}.

Lemma right_nexts t T : tables_right t T ->
  all (fun pair => find (next_of T) pair.1 == Some pair.2) (flatten (map clockwise_pairs (vertex_lines t))).
Proof.
case/and4P=> _ _ _; rewrite (fold_linesE (fun right d e => if right then find (next_of T) d == Some e else false)).
by rewrite fold_allE.
Qed.

Lemma fits_described t (W : start) (number : W -> N) :
  describes t number -> tables_right t (tables_of t) -> fits (tables_of t) number.
Proof.
set T := tables_of t => -[num_inj nums nexts opps facingE] right; have next_right := right_nexts right.
have listE : dart_list T = numbers_in (vertex_lines t) by rewrite /T /tables_of; case: (stands_of _).
have setE : dart_set T = set_of (numbers_in (vertex_lines t)) by rewrite /T /tables_of; case: (stands_of _).
have facing_T : facing_dart T = facing_line t by rewrite /T /tables_of; case: (stands_of _).
have [_ /allP all_right /allP opp_right _] := and4P right.
have listP n : n \in dart_list T <-> exists d, number d = n by rewrite listE mem_numbers_in.
split=> //.
- by move=> d; have [/opp_right|/opp_right] := opps d; case/andP=> /eqP ? /eqP.
- by move=> d; apply/eqP; exact: (allP next_right _ (nexts d)).
- by move=> d; apply/all_right/listP; exists d.
- by move=> n; rewrite setE has_entry_set_of -listE.
by rewrite facing_T.
Qed.

Lemma fits_facing T (W : start) (number : W -> N) (p : W) :
  fits T number -> fits (W := Start p) (facing_at T (number p)) number.
Proof. by case=> *; split. Qed.

Section Fits.

Variables (T : tables) (W : start) (number : W -> N).
Hypothesis T_fits : fits T number.

Implicit Types d e : W.

Lemma opposite_inE d : opposite_in T (number d) = number (opposite d).
Proof. by rewrite /opposite_in (find_opposite T_fits). Qed.

Let stand_next d : exists f g j,
  [/\ find (stand_of T) (number d) = Some (f, g, j), N.to_nat j < N.to_nat g,
      find (stand_of T) (number (clockwise d)) = Some (f, g, N.modulo (N.succ j) g),
      find (dart_at T) (N.add f j) = Some (number d)
    & find (dart_at T) (N.add f (N.modulo (N.succ j) g)) = Some (number (clockwise d))].
Proof.
have := right_dart T_fits d; rewrite /right_at find_opposite // find_next //.
case: (find (stand_of T) _) => // -[[f g] j]; case: (find _ (number (clockwise d))) => // -[[f' g'] j'].
case/and5P=> lt /eqP-> /eqP-> /eqP-> /and3P[/eqP at_d /eqP at_e _]; exists f, g, j; split=> //.
by rewrite -ltbP.
Qed.

Lemma stand_turn d : exists f g j,
  [/\ find (stand_of T) (number d) = Some (f, g, j), N.to_nat j < N.to_nat g
    & forall i, let k := N.of_nat ((N.to_nat j + i) %% N.to_nat g) in
        find (stand_of T) (number (turn d i)) = Some (f, g, k) /\
        find (dart_at T) (N.add f k) = Some (number (turn d i))].
Proof.
have [f [g [j [standE lt _ atE _]]]] := stand_next d; exists f, g, j; split=> // i /=.
elim: i => [|i [stand_i at_i]].
  by rewrite addn0 modn_small // Nnat.N2Nat.id.
have [f' [g' [j' [stand_i' lt' stand_S _ at_S]]]] := stand_next (turn d i).
move: stand_i'; rewrite stand_i => -[fE gE jE]; move: stand_S at_S; rewrite -fE -gE -jE.
suff -> : N.modulo (N.succ (N.of_nat ((N.to_nat j + i) %% N.to_nat g))) g =
          N.of_nat ((N.to_nat j + i.+1) %% N.to_nat g) by [].
apply: to_nat_inj; rewrite to_nat_mod to_natS !Nnat.Nat2N.id.
by rewrite -addn1 modnDml addn1 addnS.
Qed.

Lemma turn_inE d i : turn_in T (number d) i = number (turn d (N.to_nat i)).
Proof.
have [f [g [j [standE lt around]]]] := stand_turn d; rewrite /turn_in /stand_in standE /=.
have [_] := around (N.to_nat i).
by rewrite -to_natD -to_nat_mod Nnat.N2Nat.id => ->.
Qed.

Lemma traverse_inE d i : traverse_in T (number d) i = number (traverse d (N.to_nat i)).
Proof. by rewrite /traverse_in turn_inE opposite_inE. Qed.

Lemma degree_inE d : N.to_nat (degree_in T (number d)) = degree d.
Proof.
have [f [g [j [standE lt around]]]] := stand_turn d; rewrite /degree_in /stand_in standE /=.
have period i : (turn d i == d) = (N.to_nat g %| i).
  have [stand_i at_i] := around i; have [stand_0 at_0] := around 0; apply/eqP/idP => [back|dvd].
    move: stand_i; rewrite back standE => -[/(congr1 N.to_nat)]; rewrite Nnat.Nat2N.id => jE.
    by rewrite /dvdn -(mod0n (N.to_nat g)) -(eqn_modDl (N.to_nat j)) addn0 -jE modn_small.
  apply: (number_inj T_fits); suff [] : Some (number (turn d i)) = Some (number (turn d 0)) by [].
  by rewrite -at_i -at_0 -modnDmr (eqP dvd).
apply/eqP; rewrite eqn_dvd -period turn_degree eqxx /=.
by rewrite -turn_period period.
Qed.

Lemma same_vertex_inE d e : same_vertex_in T (number d) (number e) = same_vertex d e.
Proof.
have [f [g [j [standE lt around]]]] := stand_turn d.
have [f' [g' [j' [standE' lt' around']]]] := stand_turn e.
rewrite /same_vertex_in /stand_in standE standE' /=; apply/eqP/idP => [fE|/same_vertexP[i eE]]; last first.
  by have [+ _] := around i; rewrite -eE standE' => -[].
have close (x y : W) f0 g0 j0 g1 j1 :
    find (dart_at T) (N.add f0 j1) = Some (number y) -> N.to_nat j0 < N.to_nat g0 -> N.to_nat j1 < N.to_nat g1 ->
    N.to_nat j1 < N.to_nat g0 ->
    (forall i, let k := N.of_nat ((N.to_nat j0 + i) %% N.to_nat g0) in
        find (stand_of T) (number (turn x i)) = Some (f0, g0, k) /\
        find (dart_at T) (N.add f0 k) = Some (number (turn x i))) -> same_vertex x y.
  move=> at_y lt0 lt1 lt10 turns; have [_] := turns (N.to_nat j1 + (N.to_nat g0 - N.to_nat j0)).
  rewrite addnCA subnKC ?(ltnW lt0) // modnDr modn_small // Nnat.N2Nat.id at_y => -[/(number_inj T_fits)->].
  exact: same_vertex_turn.
have at_self (x : W) f0 g0 j0 : N.to_nat j0 < N.to_nat g0 ->
    (forall i, let k := N.of_nat ((N.to_nat j0 + i) %% N.to_nat g0) in
        find (stand_of T) (number (turn x i)) = Some (f0, g0, k) /\
        find (dart_at T) (N.add f0 k) = Some (number (turn x i))) ->
    find (dart_at T) (N.add f0 j0) = Some (number x).
  by move=> lt0 /(_ 0)[_]; rewrite addn0 modn_small // Nnat.N2Nat.id.
case: (ltnP (N.to_nat j') (N.to_nat g)) => [small|large].
  apply: (close d e f g j g' j') => //; rewrite fE; exact: at_self around'.
rewrite same_vertex_sym; apply: (close e d f' g' j' g j) => //; first by rewrite -fE; apply: at_self around.
exact: ltn_trans (leq_trans lt large) lt'.
Qed.

Lemma door_inE d e : same_vertex d e -> N.to_nat (door_in T (number d) (number e)) = findex clockwise d e.
Proof.
case/same_vertexP=> i ->; rewrite -(turn_mod d i); have lt : i %% degree d < degree d by rewrite ltn_mod degree_gt0.
move: (i %% _) lt => {}i lt; rewrite findex_turn //.
have := degree_inE d; have [f [g [j [standE lt_j around]]]] := stand_turn d; have [stand_i _] := around i.
rewrite /door_in /degree_in /stand_in standE stand_i /= => gE.
rewrite to_nat_mod to_natD to_natB Nnat.Nat2N.id modnDml addnAC subnKC ?(ltnW lt_j) //.
by rewrite addnC modnDr modn_small // gE.
Qed.

Lemma sighting_inE word d : sighting_of (sighting_in T word (number d)) = marker_of word d.
Proof.
have num_eq (x y : W) : (number x == number y) = (x == y) by rewrite (inj_eq (number_inj T_fits)).
have oppE : opposite_in T (facing_dart T) = number (opposite (facing W)).
  by rewrite (facing_dartE T_fits) opposite_inE.
case: word; rewrite //= ?oppE (facing_dartE T_fits) ?num_eq ?same_vertex_inE //.
- by rewrite /undirected; case: ifP.
- by rewrite /directional; case: ifP => // near /=; rewrite door_inE.
- by rewrite /undirected_edge; case: ifP.
- by rewrite /directed_edge; case: ifP => // _; case: ifP.
- by rewrite /two_identical; do 2!case: (same_vertex _ _).
by rewrite /two_distinct /two_looks; do 2!case: (same_vertex _ _).
Qed.

End Fits.
