(** Worlds with loops or parallel edges that other markers cannot distinguish. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Bisimulation Parts Figures.
From toposlam Require MovableMarker.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Two loops at one vertex *)

(** Four darts, clockwise: (0, 0), (0, 1), (1, 1), (1, 0). *)
Definition next_of_4 (d : bool * bool) : bool * bool := (d.2, ~~ d.1).

(** In the plane the two darts of a loop stand together; on the torus the loops cross. *)
Definition together (d : bool * bool) : bool * bool := (d.1, ~~ d.2).
Definition across (d : bool * bool) : bool * bool := (~~ d.1, ~~ d.2).

Lemma next_of_4_inj : injective next_of_4.
Proof. by move=> [[] []] [[] []]. Qed.

Lemma togetherK : involutive together. Proof. by move=> [[] []]. Qed.
Lemma together_neq d : together d != d. Proof. by case: d => [[] []]. Qed.
Lemma acrossK : involutive across. Proof. by move=> [[] []]. Qed.
Lemma across_neq d : across d != d. Proof. by case: d => [[] []]. Qed.

Lemma loops_connected (opp : bool * bool -> bool * bool) d e :
  connect (fun x y => (y == opp x) || (y == next_of_4 x)) d e.
Proof.
have go i : connect (fun x y => (y == opp x) || (y == next_of_4 x)) d (iter i next_of_4 d).
  exact: connect_iter_cw.
by case: d e go => [[] []] [[] []] go; solve [apply: (go 0) | apply: (go 1) | apply: (go 2) | apply: (go 3)].
Qed.

(** In the world files they are two-loops-plane and two-loops-torus; the facing dart is on a loop. *)
Definition two_loops_plane : start :=
  @Start (@EmbeddedGraph [finType of bool * bool] _ _ togetherK together_neq next_of_4_inj
    (loops_connected together)) (false, false).
Definition two_loops_torus : start :=
  @Start (@EmbeddedGraph [finType of bool * bool] _ _ acrossK across_neq next_of_4_inj
    (loops_connected across)) (false, false).

(** All darts are at one vertex. *)
Definition one_vertex (W : start) := forall p q : W, same_vertex p q.

Lemma loops_one_vertex : one_vertex two_loops_plane /\ one_vertex two_loops_torus.
Proof.
by split=> p q; apply/same_vertexP; case: p q => [[] []] [[] []];
   solve [exists 0; reflexivity | exists 1; reflexivity | exists 2; reflexivity | exists 3; reflexivity].
Qed.

Lemma one_vertex_degree (W : start) (p : W) : one_vertex W -> degree p = #|W|.
Proof. by move=> one; apply: eq_card => q; rewrite !inE [LHS]one. Qed.

Lemma loops_not_isomorphic : ~ isomorphic two_loops_plane two_loops_torus.
Proof.
move=> [f iso]; have := isomorphism_walk iso ((false, false) : two_loops_plane) [:: 1].
by rewrite /=; case: (f _) => [[] []].
Qed.

Lemma loops_two_distinct : bisimilar (moving two_distinct) two_loops_plane two_loops_torus.
Proof.
have [plane torus] := loops_one_vertex; exists (fun _ _ => True); split=> // p q _; split=> //.
by rewrite /= /perceive !one_vertex_degree // /two_distinct /two_looks !plane !torus.
Qed.

(** * Three parallel edges *)

Definition next_of_3 (i : 'I_3) : 'I_3 := inord (i.+1 %% 3).

Lemma next_of_3K i : next_of_3 (next_of_3 (next_of_3 i)) = i.
Proof. by case: i => [[|[|[|i]]] lt] //; apply: val_inj; rewrite /next_of_3 /= !inordK. Qed.

Lemma next_of_3_inj : injective next_of_3.
Proof. exact: (can_inj (g := fun i => next_of_3 (next_of_3 i)) next_of_3K). Qed.

Lemma next_of_3_neq i : next_of_3 i != i.
Proof. by case: i => [[|[|[|i]]] lt] //; rewrite -val_eqE /= inordK. Qed.

(** Darts are pairs of an end and an edge. At both ends of the edges their order is the same on the torus, and
    opposite in the plane. *)
Definition other_end (d : bool * 'I_3) : bool * 'I_3 := (~~ d.1, d.2).
Definition around_torus (d : bool * 'I_3) : bool * 'I_3 := (d.1, next_of_3 d.2).
Definition around_plane (d : bool * 'I_3) : bool * 'I_3 :=
  (d.1, if d.1 then next_of_3 (next_of_3 d.2) else next_of_3 d.2).

Lemma other_endK : involutive other_end.
Proof. by move=> [[] i]. Qed.
Lemma other_end_neq d : other_end d != d.
Proof. by case: d => [[] i]. Qed.

Lemma around_torusK d : around_torus (around_torus (around_torus d)) = d.
Proof. by case: d => b i; rewrite /around_torus /= next_of_3K. Qed.
Lemma around_planeK d : around_plane (around_plane (around_plane d)) = d.
Proof. by case: d => [[] i]; rewrite /around_plane /= !next_of_3K. Qed.

Lemma around_torus_inj : injective around_torus.
Proof. exact: (can_inj (g := fun d => around_torus (around_torus d)) around_torusK). Qed.
Lemma around_plane_inj : injective around_plane.
Proof. exact: (can_inj (g := fun d => around_plane (around_plane d)) around_planeK). Qed.

Lemma turn_to (cw : bool * 'I_3 -> bool * 'I_3) (b : bool) (i j : 'I_3) :
  cw = around_torus \/ cw = around_plane -> exists k, iter k cw (b, i) = (b, j).
Proof.
have third x y : y = x \/ y = next_of_3 x \/ y = next_of_3 (next_of_3 x).
  case: x y => [[|[|[|x]]] ltx] [[|[|[|y]]] lty] //;
    solve [left; apply: val_inj; rewrite /next_of_3 /= ?inordK //
         | right; left; apply: val_inj; rewrite /next_of_3 /= ?inordK //
         | right; right; apply: val_inj; rewrite /next_of_3 /= ?inordK //].
move=> kind; case: (third i j) => [->|[->|->]]; first by exists 0; case: kind => ->.
  case: kind => ->; first by exists 1.
  case: b; last by exists 1.
  by exists 2; rewrite /= /around_plane /= next_of_3K.
case: kind => ->; first by exists 2.
case: b; first by exists 1.
by exists 2.
Qed.

Lemma dipole_connected cw d e : injective cw -> cw = around_torus \/ cw = around_plane ->
  connect (fun x y => (y == other_end x) || (y == cw x)) d e.
Proof.
move=> cw_inj kind; move: d e; apply: (all_connected (root := (false, ord0))) => // [|[b i]].
  exact: other_endK.
have [k <-] := turn_to b ord0 i kind; apply: connect_trans (connect_iter_cw _ _ _ k).
case: b; last exact: connect0.
exact: (connect_opp other_end cw (false, ord0)).
Qed.

(** In the world files they are theta-plane and theta-torus. *)
Definition theta_plane : start :=
  @Start (@EmbeddedGraph [finType of bool * 'I_3] _ _ other_endK other_end_neq around_plane_inj
    (fun d e => dipole_connected d e around_plane_inj (or_intror erefl))) (false, ord0).
Definition theta_torus : start :=
  @Start (@EmbeddedGraph [finType of bool * 'I_3] _ _ other_endK other_end_neq around_torus_inj
    (fun d e => dipole_connected d e around_torus_inj (or_introl erefl))) (false, ord0).

Lemma plane_turn1 (p : theta_plane) k : (iter k around_plane p).1 = p.1.
Proof. by elim: k. Qed.

Lemma torus_turn1 (p : theta_torus) k : (iter k around_torus p).1 = p.1.
Proof. by elim: k. Qed.

(** A vertex is an end of the edges. *)
Lemma plane_same_vertex (p q : theta_plane) : same_vertex p q = (p.1 == q.1).
Proof.
apply/same_vertexP/eqP => [[k ->]|]; first by rewrite plane_turn1.
case: p q => [b i] [b' j] /= <-; have [k same] := turn_to b i j (or_intror erefl : _ \/ around_plane = around_plane).
by exists k; rewrite /turn same.
Qed.

Lemma torus_same_vertex (p q : theta_torus) : same_vertex p q = (p.1 == q.1).
Proof.
apply/same_vertexP/eqP => [[k ->]|]; first by rewrite torus_turn1.
case: p q => [b i] [b' j] /= <-; have [k same] := turn_to b i j (or_introl erefl : around_torus = around_torus \/ _).
by exists k; rewrite /turn same.
Qed.

(** Both have the same vertices, and a robot goes from one to the other by any door. *)
Lemma theta_traverse (p : theta_plane) (q : theta_torus) i : p.1 = q.1 -> (traverse p i).1 = (traverse q i).1.
Proof. by move=> pq; rewrite /traverse /= /other_end /turn plane_turn1 torus_turn1 pq. Qed.

Lemma theta_degree (p : theta_plane) (q : theta_torus) : p.1 = q.1 -> degree p = degree q.
Proof.
move=> pq; have same (x : bool * 'I_3) : fconnect around_plane p x = fconnect around_torus q x.
  have := plane_same_vertex p x; have := torus_same_vertex q x; rewrite /same_vertex /= => -> ->.
  by rewrite pq.
exact: eq_card same.
Qed.

Lemma theta_two_distinct : bisimilar (moving two_distinct) theta_plane theta_torus.
Proof.
exists (fun p q => p.1 = q.1); split=> // p q pq; split=> [|i]; last exact: theta_traverse.
rewrite /= /perceive (theta_degree pq) /two_distinct /two_looks !plane_same_vertex !torus_same_vertex.
by rewrite pq.
Qed.

(** In the plane a robot that always goes on by door 1 comes back after two moves, and nowhere on the torus. *)
Lemma theta_not_isomorphic : ~ isomorphic theta_plane theta_torus.
Proof.
move=> [f iso]; have := isomorphism_walk iso ((false, ord0) : theta_plane) [:: 1; 1].
have -> : walk ((false, ord0) : theta_plane) [:: 1; 1] = (false, ord0).
  by rewrite /= /traverse /= /other_end /around_plane /= next_of_3K.
case: (f _) => b i; rewrite /= /traverse /= /other_end /around_torus /= negbK => -[] same.
by have := next_of_3_neq i; rewrite {1}same next_of_3K eqxx.
Qed.

(** * Two markers that are not adjacent *)

(** Two vertices that are joined by three paths of two edges, in the plane and on the torus. *)
Definition paths_a_file : world_file :=
  [:: (* 0 *) [:: 2; 3; 4];
      (* 1 *) [:: 4; 3; 2];
      (* 2 *) [:: 0; 1];
      (* 3 *) [:: 0; 1];
      (* 4 *) [:: 0; 1]].

Definition paths_b_file : world_file :=
  [:: (* 0 *) [:: 2; 3; 4];
      (* 1 *) [:: 2; 3; 4];
      (* 2 *) [:: 0; 1];
      (* 3 *) [:: 0; 1];
      (* 4 *) [:: 0; 1]].

Lemma paths_a_sound : sound paths_a_file. Proof. by vm_compute. Qed.
Lemma paths_b_sound : sound paths_b_file. Proof. by vm_compute. Qed.

(** At vertex 0, facing vertex 2; the second marker lies at vertex 1. *)
Definition paths_a : start := start_at paths_a_sound (erefl : (0, 2) \in names paths_a_file).
Definition paths_b : start := start_at paths_b_sound (erefl : (0, 2) \in names paths_b_file).

Lemma paths_simple : simple paths_a /\ simple paths_b.
Proof. by split; apply: world_simple. Qed.

Lemma paths_not_isomorphic : ~ isomorphic paths_a paths_b.
Proof. by apply: (@round_walk_not_isomorphic _ _ _ _ _ _ _ _ [:: 1; 1; 1; 1]); vm_compute. Qed.

Lemma paths_two_distant : bisimilar (moving two_distant) paths_a paths_b.
Proof.
pose sighted (file : world_file) (d x : name) :=
  match x.1 == d.1, x.1 == (name_walk file d [:: 0; 1]).1 with
  | true, true => Both
  | true, false => First
  | false, true => Second
  | false, false => Nothing
  end.
apply: (@marker_bisimilar _ _ _ _ _ _ _ _ _ sighted 24) => [file ok d d_in p|]; last by vm_compute.
by rewrite /two_distant /two_looks !world_same_vertex val_walk.
Qed.

(** * A movable marker *)

Section Handling.

Variables (V W : start) (R : V -> W -> Prop).
Hypotheses (R_start : R (facing V) (facing W)) (R_degree : forall p q, R p q -> degree p = degree q).
Hypothesis R_traverse : forall p q i, R p q -> R (traverse p i) (traverse q i).
Hypothesis R_vertex : forall p q s t, R p q -> R s t -> same_vertex p s = same_vertex q t.

Let R_place (l : option V) (l' : option W) : Prop :=
  match l, l' with Some s, Some t => R s t | None, None => True | _, _ => False end.

Let R_perceive p q l l' : R p q -> R_place l l' ->
  MovableMarker.perceive_lying l p = MovableMarker.perceive_lying l' q.
Proof.
move=> pq; rewrite /MovableMarker.perceive_lying (R_degree pq).
by case: l l' => [s|] [t|] //= st; rewrite (R_vertex pq st).
Qed.

(** Such starts are bisimilar for a robot that handles the marker. *)
Lemma handling_bisimilar : bisimilar MovableMarker.handling V W.
Proof.
exists (fun s t => R s.1 t.1 /\ R_place s.2 t.2); split=> // -[p l] [q l'] [/= pq same_l].
split=> [|e]; first exact: R_perceive.
case: e l l' same_l => [i||] [s|] [t|] //= st; first by split; [apply: R_traverse|].
- by split; first exact: R_traverse.
- by rewrite (R_vertex pq st); case: ifP.
Qed.

End Handling.

Lemma loops_handling : bisimilar MovableMarker.handling two_loops_plane two_loops_torus.
Proof.
have [plane torus] := loops_one_vertex.
apply: (handling_bisimilar (R := fun _ _ => True)) => // [p q _|p q s t _ _].
  by rewrite !one_vertex_degree.
by rewrite plane torus.
Qed.

Lemma theta_handling : bisimilar MovableMarker.handling theta_plane theta_torus.
Proof.
apply: (@handling_bisimilar theta_plane theta_torus (fun p q => p.1 = q.1)) => // [p q|p q i|p q s t].
- exact: theta_degree.
- exact: theta_traverse.
by rewrite plane_same_vertex torus_same_vertex => -> ->.
Qed.
