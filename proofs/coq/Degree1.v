(** At a vertex with one door, an undirected marker is as good as a directional one, which could only
    point along that door. Beyond Section 2.2. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Walks Bisimulation Separates.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** The sighting of a directional marker at the place of an undirected one. *)
Definition point (seen : percept) : percept :=
  (seen.1, if seen.2 is Lying then Pointing 0 else seen.2).

Section Degree1.

Variable W : start.
Hypothesis one_door : degree (facing W) = 1.
Implicit Types p : W.

Lemma same_vertex_facing p : same_vertex p (facing W) -> p = facing W.
Proof. by rewrite same_vertex_sym => /same_vertexP[i ->]; rewrite -turn_mod one_door modn1. Qed.

Lemma perceive_point p : perceive directional p = point (perceive undirected p).
Proof.
rewrite /perceive /directional /undirected /point /=; case: ifP => // /same_vertex_facing->.
by rewrite findex0.
Qed.

Lemma percepts_point p doors : percepts directional p doors = map point (percepts undirected p doors).
Proof. by elim: doors p => [|i doors IH] p /=; rewrite perceive_point ?IH. Qed.

(** A robot with the undirected marker can do what a robot with a directional one does. *)
Definition pointing A (robot : strategy A) : strategy A := robot \o map point.

Lemma situation_point A (robot : strategy A) n :
  situation robot directional W n =
    let: (past, pose) := situation (pointing robot) undirected W n in (map point past, pose).
Proof.
elim: n => [|n /= ->]; first by rewrite /= perceive_point.
case: (situation _ _ _ n) => past pose; rewrite /pointing /=; case: (robot _) => //= i.
by rewrite map_rcons perceive_point.
Qed.

Lemma history_point A (robot : strategy A) n :
  history robot directional W n = map point (history (pointing robot) undirected W n).
Proof. by rewrite /history situation_point; case: (situation _ _ _ n). Qed.

Lemma answers_point A (robot : strategy A) a :
  answers (pointing robot) undirected W a <-> answers robot directional W a.
Proof. by split=> -[n answered]; exists n; rewrite -answered history_point. Qed.

End Degree1.

Lemma degree_1_marker_separates (V W : start) :
  degree (facing V) = 1 -> degree (facing W) = 1 ->
  indistinguishable undirected V W -> isomorphic_starts V W.
Proof.
move=> V_one W_one same; apply: directional_marker_separates => doors.
by rewrite !percepts_point // same.
Qed.

Lemma degree_1_marker_suffices A (robot : strategy A) :
  exists robot' : strategy A, forall W : start, degree (facing W) = 1 ->
    forall a, answers robot' undirected W a <-> answers robot directional W a.
Proof. by exists (pointing robot) => W one_door a; apply: answers_point. Qed.
