(** Whether a world is drawn in the plane, by Euler's formula, and the facts about the pair of worlds of which that is
    said. Section 2.1. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Figures.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** All cycles of a permutation, each as a list. *)
Definition cycles_of (T : finType) (f : T -> T) (cycles : seq (seq T)) : Prop :=
  [/\ all (fun c => (c != [::]) && fcycle f c) cycles, uniq (flatten cycles) & forall x, x \in flatten cycles].

(** There are as many vertices and faces as edges, and two more. A face is a way along which a robot comes back that
    leaves by door 1 each time. *)
Definition in_the_plane (G : embedded_graph) : Prop :=
  exists vertices faces : seq (seq G),
    [/\ cycles_of clockwise vertices, cycles_of (fun d : G => clockwise (opposite d)) faces
      & size vertices + size faces = edges G + 2].

Section File.

Variables (file : world_file) (ok : sound file).

Notation W := (world ok).

(** The cycles of darts by their names, as a computation finds them. *)
Fixpoint ring (step : name -> name) (rounds : nat) (first x : name) : seq name :=
  if rounds is fewer.+1 then
    x :: (if step x == first then [::] else ring step fewer first (step x))
  else [::].

Definition rings (step : name -> name) : seq (seq name) :=
  foldl (fun found x => if x \in flatten found then found else rcons found (ring step (size (names file)) x x))
    [::] (names file).

Definition are_cycles (step : name -> name) (cs : seq (seq name)) : bool :=
  [&& all (fun c => (c != [::]) && fcycle step c) cs, uniq (flatten cs), all (mem (names file)) (flatten cs)
    & all (mem (flatten cs)) (names file)].

Lemma are_cycles_of (f : W -> W) (step : name -> name) (cs : seq (seq name)) :
  (forall d, val (f d) = step (val d)) -> are_cycles step cs ->
  cycles_of f [seq pmap insub c | c <- cs].
Proof.
move=> f_val /and4P[/allP cycles cs_uniq /allP in_names /allP all_in].
have val_cycle c : c \in cs -> map val (pmap (insub : name -> option W) c) = c.
  move=> c_in; rewrite (pmap_filter (insubK _)); apply/all_filterP/allP => x x_c.
  rewrite /= isSome_insub; apply: in_names; apply/flattenP; by exists c.
have val_flatten : map val (flatten [seq pmap (insub : name -> option W) c | c <- cs]) = flatten cs.
  rewrite map_flatten -map_comp; congr flatten; rewrite -[RHS]map_id; apply/eq_in_map => c; exact: val_cycle.
split.
- apply/allP => _ /mapP[c c_in ->]; have /andP[c_some c_cycle] := cycles _ c_in.
  rewrite -size_eq0 -(size_map val) val_cycle // size_eq0 c_some /=.
  have := c_cycle; rewrite -[X in cycle _ X](val_cycle _ c_in) cycle_map.
  apply: sub_cycle => x y /= /eqP xy; apply/eqP/val_inj; by rewrite f_val.
- by rewrite -(map_inj_uniq val_inj) val_flatten.
by move=> x; rewrite -(mem_map val_inj) val_flatten; apply: all_in; apply: ssvalP.
Qed.

(** Computes whether Euler's formula holds. *)
Definition file_in_the_plane : bool :=
  let vs := rings (around file) in
  let fs := rings (fun d => around file (flip d)) in
  [&& uniq (names file), are_cycles (around file) vs, are_cycles (fun d => around file (flip d)) fs
    & size vs + size fs == (size (names file))./2 + 2].

Lemma world_in_the_plane : file_in_the_plane -> in_the_plane W.
Proof.
case/and4P=> names_uniq vs fs /eqP euler.
exists [seq pmap insub c | c <- rings (around file)].
exists [seq pmap insub c | c <- rings (fun d => around file (flip d))].
split; [exact: are_cycles_of vs | exact: are_cycles_of fs |].
by rewrite !size_map euler /edges card_seq_sub.
Qed.

End File.

Lemma planar_in_the_plane : in_the_plane planar_a /\ in_the_plane planar_b.
Proof. by split; apply: world_in_the_plane; vm_compute. Qed.
