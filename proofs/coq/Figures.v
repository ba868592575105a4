(** The worlds of the figures, as lists from their world files, and facts about them that are checked by
    computation: Figure 1 of the paper, the smallest simple pair, those of degree at most three and in the plane,
    two cycles, and a pair for marks on an edge and for two markers that look alike. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Markers Walks Bisimulation.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Worlds from lists *)

(** A simple world as in its file: for each vertex, in the order of their numbers, its neighbours
    clockwise. *)
Definition world_file := seq (seq nat).

(** The dart at vertex [v] whose edge leads to vertex [w] is the pair of both. *)
Definition name := (nat * nat)%type.

(** Everything that the steps reach from some elements, in a number of rounds. *)
Fixpoint explore (T : eqType) (steps : seq (T -> T)) (rounds : nat) (found : seq T) : seq T :=
  if rounds is fewer.+1 then
    explore steps fewer (undup (found ++ [seq step x | step <- steps, x <- found]))
  else found.

Lemma explore_ind (T : eqType) (steps : seq (T -> T)) (P : pred T) rounds found :
  all P found -> (forall x, P x -> all (fun step => P (step x)) steps) ->
  forall x, x \in explore steps rounds found -> P x.
Proof.
move=> P_found P_steps; elim: rounds found P_found => [|n IH] found P_found x; first exact: (allP P_found).
apply: IH; apply/allP => y; rewrite mem_undup mem_cat => /orP[|]; first exact: (allP P_found).
elim: steps P_steps => //= step steps IHs P_steps; rewrite mem_cat => /orP[/mapP[z z_found ->]|].
  by have /P_steps/andP[] := allP P_found _ z_found.
by apply: IHs => z /P_steps /andP[].
Qed.

Section File.

Variable file : world_file.

Definition neighbours (v : nat) : seq nat := nth [::] file v.

Definition names : seq name := [seq (v, w) | v <- iota 0 (size file), w <- neighbours v].

Definition flip (d : name) : name := (d.2, d.1).

Definition around (d : name) : name := (d.1, next (neighbours d.1) d.2).

(** A valid file: no neighbour twice, no vertex its own neighbour, neighbours mutual, and the graph
    connected. *)
Definition sound : bool :=
  [&& all uniq file,
      all (fun d => (flip d \in names) && (d.1 != d.2)) names
    & all (fun d => all (mem (explore [:: flip; around] (size names) [:: d])) names) names].

Lemma mem_names d : (d \in names) = (d.2 \in neighbours d.1).
Proof.
case: d => v w; apply/allpairsPdep/idP => [[v' [w' [_ w'_v' [-> ->]]]] // | /= w_v].
exists v, w; split; rewrite // mem_iota; rewrite /neighbours in w_v.
by case: ltnP => // /(nth_default [::]) empty; rewrite empty in w_v.
Qed.

Hypothesis file_sound : sound.

Lemma uniq_neighbours v : uniq (neighbours v).
Proof.
case/andP: file_sound => /allP all_uniq _; rewrite /neighbours.
by case: (ltnP v (size file)) => [/(mem_nth [::])/all_uniq | /(nth_default [::])->].
Qed.

Lemma flip_names d : d \in names -> flip d \in names.
Proof. by case/and3P: file_sound => _ /allP ok _ /ok /andP[]. Qed.

Lemma around_names d : d \in names -> around d \in names.
Proof. by rewrite !mem_names mem_next. Qed.

Definition file_dart := seq_sub names.

Definition file_opposite (d : file_dart) : file_dart := SeqSub (flip_names (ssvalP d)).
Definition file_clockwise (d : file_dart) : file_dart := SeqSub (around_names (ssvalP d)).

Lemma file_oppositeK : involutive file_opposite.
Proof. by move=> d; apply: val_inj; case: d => -[]. Qed.

Lemma file_opposite_neq d : file_opposite d != d.
Proof.
case/and3P: file_sound => _ /allP ok _; have /andP[_] := ok _ (ssvalP d).
by apply: contra => /eqP/(congr1 val) /= /(congr1 snd) /= ->.
Qed.

Lemma file_clockwise_inj : injective file_clockwise.
Proof.
move=> [d d_in] [e e_in] /(congr1 val) /= [same_v same_next]; apply: val_inj => /=.
case: d e same_v same_next {d_in e_in} => [v w] [v' w'] /= <- /(congr1 (prev (neighbours v))).
by rewrite !(prev_next (uniq_neighbours v)) => ->.
Qed.

Lemma file_connected (d e : file_dart) :
  connect (fun x y => (y == file_opposite x) || (y == file_clockwise x)) d e.
Proof.
set step := fun x y => _.
pose reached (x : name) := [exists y : file_dart, (val y == x) && connect step d y].
suff /existsP[y /andP[/eqP/val_inj<-]] : reached (val e) by [].
case/and3P: file_sound => _ _ /allP/(_ _ (ssvalP d)) /allP/(_ _ (ssvalP e)).
apply: explore_ind => [|x /existsP[y /andP[/eqP<- d_y]]] /=.
  by rewrite andbT; apply/existsP; exists d; rewrite eqxx connect0.
rewrite andbT; apply/andP; split; apply/existsP.
  exists (file_opposite y); rewrite eqxx; apply: connect_trans d_y (connect1 _).
  by rewrite /step eqxx.
exists (file_clockwise y); rewrite eqxx; apply: connect_trans d_y (connect1 _).
by rewrite /step eqxx orbT.
Qed.

Definition world : embedded_graph :=
  EmbeddedGraph file_oppositeK file_opposite_neq file_clockwise_inj file_connected.

Implicit Types d e : world.

(** ** Facts that follow from the names *)

Lemma val_turn d i : val (turn d i) = iter i around (val d).
Proof. by elim: i => //= i <-. Qed.

Lemma iter_around i x : iter i around x = (x.1, iter i (next (neighbours x.1)) x.2).
Proof. by elim: i => [|i IH] /=; [case: x | rewrite IH]. Qed.

Lemma iter_next (T : eqType) (s : seq T) x y :
  uniq s -> x \in s -> y \in s -> exists i, y = iter i (next s) x.
Proof.
move=> s_uniq /rot_to[k t rot_s] y_s.
have : y \in x :: t by rewrite -rot_s mem_rot.
have : fcycle (next s) (x :: t) by rewrite -rot_s rot_cycle; apply: cycle_next.
rewrite /= rcons_path => /andP[/fpathP[n ->] _].
by rewrite -/(traject _ _ n.+1) => /trajectP[i _ ->]; exists i.
Qed.

Lemma world_same_vertex d e : same_vertex d e = ((val d).1 == (val e).1).
Proof.
apply/same_vertexP/eqP => [[i ->] | same_v].
  by rewrite val_turn iter_around.
have d_in := ssvalP d; have e_in := ssvalP e; rewrite !mem_names -same_v in d_in e_in.
have [i e_i] := iter_next (uniq_neighbours _) d_in e_in.
by exists i; apply: val_inj; rewrite val_turn iter_around -e_i same_v -surjective_pairing.
Qed.

Lemma world_degree d : degree d = size (neighbours (val d).1).
Proof.
rewrite /degree /order cardE -(size_map val) -[RHS](size_map (pair (val d).1)).
apply/perm_size/uniq_perm; first by rewrite (map_inj_uniq val_inj) enum_uniq.
  by rewrite map_inj_uniq ?uniq_neighbours // => ? ? [].
move=> x; apply/mapP/mapP => [[e] | [w w_v ->]].
  rewrite mem_enum [_ \in _]world_same_vertex => /eqP-> ->; exists (val e).2.
    by have := ssvalP e; rewrite mem_names.
  by case: (val e).
have vw : ((val d).1, w) \in names by rewrite mem_names.
by exists (SeqSub vw); rewrite // mem_enum [_ \in _]world_same_vertex.
Qed.

Definition name_walk (x : name) (doors : seq door) : name :=
  foldl (fun x i => flip (iter i around x)) x doors.

Lemma val_walk d doors : val (walk d doors) = name_walk (val d) doors.
Proof. by elim: doors d => // i doors IH d; rewrite [LHS]IH /= -val_turn. Qed.

Lemma world_simple : simple world.
Proof.
split=> [d | d e]; rewrite !world_same_vertex.
  by case/and3P: file_sound => _ /allP/(_ _ (ssvalP d)) /andP[].
by move=> /eqP v /eqP w; apply: val_inj; move: v w => /=; case: (ssval d) (ssval e) => [? ?] [? ?] /= -> ->.
Qed.

End File.

Definition start_at (file : world_file) (ok : sound file) (d : name) (d_in : d \in names file) : start :=
  @Start (world ok) (SeqSub d_in).

(** * Bisimilar, by computation *)

Section Pair.

Variables (file1 file2 : world_file) (ok1 : sound file1) (ok2 : sound file2).
Variables (d1 d2 : name) (in1 : d1 \in names file1) (in2 : d2 \in names file2).

Let V := start_at ok1 in1.
Let W := start_at ok2 in2.

(** Through an edge, or on to the next dart, in both worlds at once. *)
Definition together : seq (name * name -> name * name) :=
  [:: fun both => (flip both.1, flip both.2);
      fun both => (around file1 both.1, around file2 both.2)].

(** The pairs of darts that the same steps reach, if the rounds suffice to find them all. *)
Definition pairs (rounds : nat) := explore together rounds [:: (d1, d2)].

Definition closed (found : seq (name * name)) :=
  ((d1, d2) \in found) && all (fun both => all (fun step => step both \in found) together) found.

Definition same_degree (both : name * name) :=
  size (neighbours file1 both.1.1) == size (neighbours file2 both.2.1).

Definition same_mark (both : name * name) := (both.1.1 == d1.1) == (both.2.1 == d2.1).

Let closed_bisimilar M found :
  closed found -> (forall (p : V) (q : W), (val p, val q) \in found -> perceive M p = perceive M q) ->
  bisimilar (moving M) V W.
Proof.
case/andP=> start_found /allP found_closed same.
exists (fun p q => (val p, val q) \in found); split=> // p q pq; split=> [|i]; first exact: same.
have {}pq : (val (turn p i), val (turn q i)) \in found.
  by elim: i => //= i /found_closed /and3P[].
by have /andP[] := found_closed _ pq.
Qed.

Lemma no_marker_bisimilar rounds :
  let found := pairs rounds in closed found && all same_degree found -> bisimilar (moving no_marker) V W.
Proof.
move=> found /andP[found_closed /allP degrees]; apply: closed_bisimilar found_closed _ => p q pq.
by rewrite /perceive !world_degree (eqP (degrees _ pq)).
Qed.

Lemma undirected_bisimilar rounds :
  let found := pairs rounds in closed found && all (fun both => same_degree both && same_mark both) found ->
  bisimilar (moving undirected) V W.
Proof.
move=> found /andP[found_closed /allP same]; apply: closed_bisimilar found_closed _ => p q pq.
have /andP[/eqP degrees /eqP marks] := same _ pq.
by rewrite /perceive /undirected !world_degree !world_same_vertex /= degrees [_ == d1.1]marks.
Qed.

(** For any marker whose sighting is computed from names. *)
Lemma marker_bisimilar M (sighted : world_file -> name -> name -> sighting) rounds :
  (forall file (ok : sound file) d (d_in : d \in names file) (p : start_at ok d_in),
     M (start_at ok d_in) p = sighted file d (val p)) ->
  let found := pairs rounds in
  let same both := same_degree both && (sighted file1 d1 both.1 == sighted file2 d2 both.2) in
  closed found && all same found -> bisimilar (moving M) V W.
Proof.
move=> M_sighted found same /andP[found_closed /allP all_same].
apply: closed_bisimilar found_closed _ => p q pq; have /andP[/eqP degrees /eqP sightings] := all_same _ pq.
by rewrite /perceive !world_degree degrees !M_sighted sightings.
Qed.

(** * Not isomorphic, by computation *)

(** A walk that is closed in one world, and in the other world from no pose. *)
Lemma round_walk_not_isomorphic doors :
  has (fun d => name_walk file1 d doors == d) (names file1) ->
  ~~ has (fun d => name_walk file2 d doors == d) (names file2) ->
  ~ isomorphic V W.
Proof.
case/hasP=> d d_in /eqP round no_round [f iso]; case/hasP: no_round.
exists (val (f (SeqSub d_in))); first exact: ssvalP.
rewrite -val_walk; apply/eqP; congr val; rewrite -(isomorphism_walk iso); congr f.
by apply: val_inj; rewrite val_walk.
Qed.

End Pair.

(** * The cycles *)

Definition cycle_3_file : world_file := [:: [:: 1; 2]; [:: 2; 0]; [:: 0; 1]].

Definition cycle_4_file : world_file := [:: [:: 1; 3]; [:: 2; 0]; [:: 3; 1]; [:: 0; 2]].

Lemma cycle_3_sound : sound cycle_3_file. Proof. by vm_compute. Qed.
Lemma cycle_4_sound : sound cycle_4_file. Proof. by vm_compute. Qed.

Definition cycle_3 : start := start_at cycle_3_sound (erefl : (0, 1) \in names cycle_3_file).
Definition cycle_4 : start := start_at cycle_4_sound (erefl : (0, 1) \in names cycle_4_file).

Lemma cycles_not_isomorphic : ~ isomorphic cycle_3 cycle_4.
Proof. by apply: (@round_walk_not_isomorphic _ _ _ _ _ _ _ _ [:: 1; 1; 1]); vm_compute. Qed.

Lemma cycles_bisimilar : bisimilar (moving no_marker) cycle_3 cycle_4.
Proof. by apply: (@no_marker_bisimilar _ _ _ _ _ _ _ _ 12); vm_compute. Qed.

(** * Figure 1 *)

(** The planar wheel: Figure 1(a). The hub x and its four neighbours, a at the top left. *)
Definition figure_1a_file : world_file :=
  let x := 0 in let a := 1 in let b := 2 in let c := 3 in let d := 4 in
  [:: (* x *) [:: a; b; d; c];
      (* a *) [:: b; x; c];
      (* b *) [:: d; x; a];
      (* c *) [:: a; x; d];
      (* d *) [:: b; c; x]].

(** The same wheel on the torus: Figure 1(b). The order of every rim vertex is reversed, the order of the
    hub is not. *)
Definition figure_1b_file : world_file :=
  let X := 0 in let A := 1 in let B := 2 in let C := 3 in let D := 4 in
  [:: (* X *) [:: A; B; D; C];
      (* A *) [:: C; X; B];
      (* B *) [:: A; X; D];
      (* C *) [:: D; X; A];
      (* D *) [:: X; C; B]].

Lemma figure_1a_sound : sound figure_1a_file. Proof. by vm_compute. Qed.
Lemma figure_1b_sound : sound figure_1b_file. Proof. by vm_compute. Qed.

(** At x, facing a. *)
Definition figure_1a : start := start_at figure_1a_sound (erefl : (0, 1) \in names figure_1a_file).
Definition figure_1b : start := start_at figure_1b_sound (erefl : (0, 1) \in names figure_1b_file).

(** One of them has a triangle around which the robot goes by door 1 three times. *)
Lemma figure_1_not_isomorphic : ~ isomorphic figure_1a figure_1b.
Proof. by apply: (@round_walk_not_isomorphic _ _ _ _ _ _ _ _ [:: 1; 1; 1]); vm_compute. Qed.

Lemma figure_1_bisimilar : bisimilar (moving undirected) figure_1a figure_1b.
Proof. by apply: (@undirected_bisimilar _ _ _ _ _ _ _ _ 12); vm_compute. Qed.

(** * The smallest simple pair *)

(** Two triangles at the marked vertex: the darts of each stand together, or cross. They are
    undirected-simple-1 and -2 in the atlas; that none is smaller is not proved here. *)
Definition smallest_a_file : world_file :=
  [:: (* 0 *) [:: 1; 2; 3; 4];
      (* 1 *) [:: 0; 2];
      (* 2 *) [:: 0; 1];
      (* 3 *) [:: 0; 4];
      (* 4 *) [:: 0; 3]].

Definition smallest_b_file : world_file :=
  [:: (* 0 *) [:: 1; 2; 3; 4];
      (* 1 *) [:: 0; 3];
      (* 2 *) [:: 0; 4];
      (* 3 *) [:: 0; 1];
      (* 4 *) [:: 0; 2]].

Lemma smallest_a_sound : sound smallest_a_file. Proof. by vm_compute. Qed.
Lemma smallest_b_sound : sound smallest_b_file. Proof. by vm_compute. Qed.

(** At vertex 0, facing vertex 1. *)
Definition smallest_a : start := start_at smallest_a_sound (erefl : (0, 1) \in names smallest_a_file).
Definition smallest_b : start := start_at smallest_b_sound (erefl : (0, 1) \in names smallest_b_file).

Lemma smallest_not_isomorphic : ~ isomorphic smallest_a smallest_b.
Proof. by apply: (@round_walk_not_isomorphic _ _ _ _ _ _ _ _ [:: 1; 1; 1]); vm_compute. Qed.

Lemma smallest_bisimilar : bisimilar (moving undirected) smallest_a smallest_b.
Proof. by apply: (@undirected_bisimilar _ _ _ _ _ _ _ _ 24); vm_compute. Qed.

Lemma figure_1_simple : simple figure_1a /\ simple figure_1b.
Proof. by split; apply: world_simple. Qed.

Lemma smallest_simple : simple smallest_a /\ simple smallest_b.
Proof. by split; apply: world_simple. Qed.

(** * Pairs of degree at most three, and in the plane *)

(** Four vertices, each joined to each, in the plane and on the torus. They are undirected-corridor-1 and -2 in
    the atlas. *)
Definition corridor_a_file : world_file :=
  [:: (* 0 *) [:: 1; 2; 3];
      (* 1 *) [:: 0; 2; 3];
      (* 2 *) [:: 0; 3; 1];
      (* 3 *) [:: 0; 1; 2]].

Definition corridor_b_file : world_file :=
  [:: (* 0 *) [:: 1; 2; 3];
      (* 1 *) [:: 0; 3; 2];
      (* 2 *) [:: 0; 1; 3];
      (* 3 *) [:: 0; 2; 1]].

(** Two triangles and two dead ends at the marked vertex, all in the plane: the triangles side by side, or one
    around the other. They are undirected-planar-1 and -2 in the atlas. *)
Definition planar_a_file : world_file :=
  [:: (* 0 *) [:: 1; 2; 3; 4; 5; 6];
      (* 1 *) [:: 0; 2];
      (* 2 *) [:: 0; 1];
      (* 3 *) [:: 0];
      (* 4 *) [:: 0; 5];
      (* 5 *) [:: 0; 4];
      (* 6 *) [:: 0]].

Definition planar_b_file : world_file :=
  [:: (* 0 *) [:: 1; 2; 3; 4; 5; 6];
      (* 1 *) [:: 0; 5];
      (* 2 *) [:: 0; 4];
      (* 3 *) [:: 0];
      (* 4 *) [:: 0; 2];
      (* 5 *) [:: 0; 1];
      (* 6 *) [:: 0]].

Lemma corridor_a_sound : sound corridor_a_file. Proof. by vm_compute. Qed.
Lemma corridor_b_sound : sound corridor_b_file. Proof. by vm_compute. Qed.
Lemma planar_a_sound : sound planar_a_file. Proof. by vm_compute. Qed.
Lemma planar_b_sound : sound planar_b_file. Proof. by vm_compute. Qed.

(** At vertex 0, facing vertex 1. *)
Definition corridor_a : start := start_at corridor_a_sound (erefl : (0, 1) \in names corridor_a_file).
Definition corridor_b : start := start_at corridor_b_sound (erefl : (0, 1) \in names corridor_b_file).
Definition planar_a : start := start_at planar_a_sound (erefl : (0, 1) \in names planar_a_file).
Definition planar_b : start := start_at planar_b_sound (erefl : (0, 1) \in names planar_b_file).

Lemma corridor_simple : simple corridor_a /\ simple corridor_b.
Proof. by split; apply: world_simple. Qed.

Lemma corridor_degree : (forall d : corridor_a, degree d = 3) /\ (forall d : corridor_b, degree d = 3).
Proof.
have three file (ok : sound file) :
    all (fun x => size (neighbours file x.1) == 3) (names file) -> forall d : world ok, degree d = 3.
  by move=> /allP all_3 d; rewrite world_degree; apply/eqP/all_3/(ssvalP d).
by split; apply: three; vm_compute.
Qed.

Lemma planar_simple : simple planar_a /\ simple planar_b.
Proof. by split; apply: world_simple. Qed.

Lemma corridor_not_isomorphic : ~ isomorphic corridor_a corridor_b.
Proof. by apply: (@round_walk_not_isomorphic _ _ _ _ _ _ _ _ [:: 1; 1; 2]); vm_compute. Qed.

Lemma planar_not_isomorphic : ~ isomorphic planar_a planar_b.
Proof. by apply: (@round_walk_not_isomorphic _ _ _ _ _ _ _ _ [:: 1; 1; 1]); vm_compute. Qed.

Lemma corridor_bisimilar : bisimilar (moving undirected) corridor_a corridor_b.
Proof. by apply: (@undirected_bisimilar _ _ _ _ _ _ _ _ 24); vm_compute. Qed.

Lemma planar_bisimilar : bisimilar (moving undirected) planar_a planar_b.
Proof. by apply: (@undirected_bisimilar _ _ _ _ _ _ _ _ 32); vm_compute. Qed.

(** * A pair for two more kinds of markers *)

(** The marked edge joins two triangles, or two opposite vertices of a cycle of 6. They are
    undirected-edge-corridor-1 and -2 in the atlas, and two-identical-corridor-1 and -2. *)
Definition edge_a_file : world_file :=
  [:: (* 0 *) [:: 1; 2; 3];
      (* 1 *) [:: 0; 4; 5];
      (* 2 *) [:: 0; 3];
      (* 3 *) [:: 0; 2];
      (* 4 *) [:: 1; 5];
      (* 5 *) [:: 1; 4]].

Definition edge_b_file : world_file :=
  [:: (* 0 *) [:: 1; 2; 3];
      (* 1 *) [:: 0; 4; 5];
      (* 2 *) [:: 0; 5];
      (* 3 *) [:: 0; 4];
      (* 4 *) [:: 1; 3];
      (* 5 *) [:: 1; 2]].

Lemma edge_a_sound : sound edge_a_file. Proof. by vm_compute. Qed.
Lemma edge_b_sound : sound edge_b_file. Proof. by vm_compute. Qed.

(** At vertex 0, facing vertex 1. *)
Definition edge_a : start := start_at edge_a_sound (erefl : (0, 1) \in names edge_a_file).
Definition edge_b : start := start_at edge_b_sound (erefl : (0, 1) \in names edge_b_file).

Lemma edge_simple : simple edge_a /\ simple edge_b.
Proof. by split; apply: world_simple. Qed.

Lemma edge_not_isomorphic : ~ isomorphic edge_a edge_b.
Proof. by apply: (@round_walk_not_isomorphic _ _ _ _ _ _ _ _ [:: 2; 1; 1]); vm_compute. Qed.

Lemma edge_undirected_edge : bisimilar (moving undirected_edge) edge_a edge_b.
Proof.
pose sighted (file : world_file) (d x : name) := if (x == d) || (x == flip d) then Passed else Nothing.
by apply: (@marker_bisimilar _ _ _ _ _ _ _ _ _ sighted 24) => //; vm_compute.
Qed.

Lemma edge_two_identical : bisimilar (moving two_identical) edge_a edge_b.
Proof.
pose sighted (file : world_file) (d x : name) :=
  match x.1 == d.1, x.1 == d.2 with
  | true, true => Two
  | true, false | false, true => Lying
  | false, false => Nothing
  end.
apply: (@marker_bisimilar _ _ _ _ _ _ _ _ _ sighted 24) => [file ok d d_in p|]; last by vm_compute.
by rewrite /two_identical !world_same_vertex.
Qed.
