(** The folded trail maps into every start with its percepts; if it is complete, this start is determined.
    *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Separates Bisimulation Parts Moves.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Lemma size_sees (W : start) doors : size (sees W doors) = (size doors).+1.
Proof. exact: size_percepts. Qed.

Lemma pose_step (W : start) doors k : k < size doors ->
  walk (facing W) (take k.+1 doors) = traverse (walk (facing W) (take k doors)) (nth 0 doors k).
Proof. by move=> lt; rewrite (take_nth 0 lt) walk_rcons. Qed.

Section Seen.

Variables (W : start) (doors : seq door).

Notation pose_at k := (walk (facing W) (take k doors)).
Notation seen := (sees W doors).

Lemma degree_seenE k : k <= size doors -> degree_seen seen k = degree (pose_at k).
Proof. by move=> le; rewrite /degree_seen nth_percepts. Qed.

Lemma sighting_seenP k i :
  sighting_seen seen k = Pointing i ->
  [/\ k <= size doors, turn (pose_at k) i = facing W & same_vertex (pose_at k) (facing W)].
Proof.
rewrite /sighting_seen; case: (leqP k (size doors)) => [le|gt]; last first.
  by rewrite nth_default // size_sees.
rewrite nth_percepts //= /directional; case: ifP => // near [<-].
by split=> //; rewrite /turn iter_findex.
Qed.

(** ** It maps into the start *)

Lemma one_edge_dart x y : one_edge doors x y -> dart_of W doors y = opposite (dart_of W doors x).
Proof.
case=> k lt; rewrite /dart_of /= pose_step // /traverse //.
by rewrite oppositeK.
Qed.

Lemma folding_sound x y : folded doors seen x y -> dart_of W doors x = dart_of W doors y.
Proof.
elim=> {x y} //.
- by move=> x y z _ -> _ ->.
- move=> k i; case: (leqP k (size doors)) => [le|gt].
    by rewrite degree_seenE // /dart_of /= addnC turnD turn_degree.
  by rewrite /degree_seen nth_default ?size_sees // addn0.
- by move=> k i l j /sighting_seenP[_ ki _] /sighting_seenP[_ lj _]; rewrite /dart_of /= ki lj.
- by move=> x y _; rewrite /dart_of /= => ->.
by move=> x x' y y' /one_edge_dart xx' /one_edge_dart yy' _ xy; rewrite xx' yy' xy.
Qed.

(** Locally one to one: the darts of one visit are different. *)
Lemma visit_inj k i j : k < size seen -> i < degree_seen seen k -> j < degree_seen seen k ->
  dart_of W doors (k, i) = dart_of W doors (k, j) -> i = j.
Proof.
rewrite size_sees ltnS => le; rewrite degree_seenE // => i_lt j_lt /turn_eq.
by rewrite !modn_small.
Qed.

(** The degree is that which the robot has perceived, and where it saw the marker, the facing dart is the one that
    the marker points to. *)
Lemma degree_dart_of k i : k < size seen -> degree (dart_of W doors (k, i)) = degree_seen seen k.
Proof. by rewrite size_sees ltnS => le; rewrite degree_seenE // /dart_of degree_turn. Qed.

Lemma dart_of_pointing k i : sighting_seen seen k = Pointing i -> dart_of W doors (k, i) = facing W.
Proof. by case/sighting_seenP. Qed.

(** All darts of the start are reached, if nothing is open. *)
Lemma followed_opposite x : followed doors seen x ->
  exists2 y, opposite (dart_of W doors x) = dart_of W doors y & y.1 <= size doors.
Proof.
move=> [y [z [/folding_sound-> yz]]]; exists z; first by rewrite (one_edge_dart yz).
by case: yz => k lt //=; apply: ltnW.
Qed.

End Seen.

(** So a complete folded trail maps onto the start. *)
Lemma complete_folding_onto (W : start) doors : complete doors (sees W doors) ->
  forall d : W, exists2 x, x.1 < size (sees W doors) & dart_of W doors x = d.
Proof.
move=> none_open d; have [ds <-] := connected_walk (facing W) d; rewrite size_sees.
elim/last_ind: ds => [|ds i [[k a] /= k_le kE]]; first by exists (0, 0); rewrite // /dart_of take0.
rewrite walk_rcons -kE /traverse -[turn _ i]/(turn (turn _ a) i) -turnD.
set g := degree_seen (sees W doors) k; have k_lt : k < size (sees W doors) by rewrite size_sees.
have gE : g = degree (walk (facing W) (take k doors)) by apply: degree_seenE.
have [|y yE y_le] := @followed_opposite W doors (k, (a + i) %% g).
  by apply: none_open; rewrite //= -/g ltn_mod gE degree_gt0.
by exists y; rewrite ?ltnS // -yE /dart_of /= gE turn_mod.
Qed.

Section Two.

Variables (V W : start) (doors : seq door).
Hypothesis same : sees V doors = sees W doors.

Lemma complete_folding_determines : complete doors (sees W doors) -> isomorphic_starts V W.
Proof.
move=> none_open; apply: indistinguishable_directional; apply/bisimilarP.
exists (fun p q => exists2 x, x.1 <= size doors & p = dart_of V doors x /\ q = dart_of W doors x).
split=> [|_ _ [[k i] /= le [-> ->]]].
  by exists (0, 0); rewrite // /dart_of !take0.
have alike := percepts_eq_walk same le; split=> [|j]; first exact: perceive_turn.
have le_seen : k < size (sees W doors) by rewrite size_sees.
have degree_W : degree_seen (sees W doors) k = degree (walk (facing W) (take k doors)).
  exact: degree_seenE.
have degree_V : degree (walk (facing V) (take k doors)) = degree (walk (facing W) (take k doors)).
  by case: alike.
pose i' := (i + j) %% degree_seen (sees W doors) k.
have [|y [z [yz edge]]] := none_open k i' le_seen _.
  by rewrite ltn_mod degree_W degree_gt0.
exists z; first by case: edge => l lt //=; apply: ltnW.
rewrite !(one_edge_dart _ edge) -(folding_sound yz); rewrite -same in yz.
rewrite -(folding_sound yz) /dart_of /= /traverse -!turnD /i' degree_W.
by rewrite turn_mod -degree_V turn_mod.
Qed.

End Two.
