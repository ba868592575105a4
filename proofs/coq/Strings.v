(** A string in place of a directional marker. The robot lays it over the edge behind it at the start, and comes
    back. If that edge is a loop, it takes the free end again at each visit, to see which of the two doors is
    which. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Walks Parts Imitation.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * How the robot looks at its string *)

Notation string_look := (look (nat * string_view) (action_with holding) percept).

(** When the string is laid. If it runs through two doors here, the robot picks up the free end, sees through which of
    them it runs, and drops it again. *)
Definition look_at_string (seen : nat * string_view) : string_look :=
  if fixed_here seen.2 then
    if runs_through seen.2 is [:: i] then Know (seen.1, Pointing i) else
    Try (Use PickUp) (fun held =>
      let others := [seq i <- runs_through held.2 | from_hand held.2 != Some i] in
      Try (Use Drop) (fun=> Know (held.1, Pointing (head 0 others))))
  else Know (seen.1, Nothing).

(** At first it lays the string: it goes by door 0, drops the end, and comes back. *)
Definition lay_string (_ : nat * string_view) : string_look :=
  Try (Take 0) (fun=> Try (Use Drop) (fun=> Try (Take 0) look_at_string)).

Section Laid.

Variables (length : nat) (W : start).
Hypothesis length_gt0 : 0 < length.

Let f := facing W.

(** The string lies over the facing edge. *)
Definition laid (free : option W) : string_place W := StringPlace f [:: f] free.

(** * What the robot sees then *)

Lemma turn_is (p d : W) i : same_vertex p d -> i < degree p -> (turn p i == d) = (i == findex clockwise p d).
Proof.
move=> pd lt; apply/eqP/eqP => [<-|->]; first by rewrite findex_turn.
exact: iter_findex.
Qed.

Lemma doors_to (p d : W) : same_vertex p d ->
  [seq i <- iota 0 (degree p) | turn p i == d] = [:: findex clockwise p d].
Proof.
move=> pd; rewrite -(@filter_pred1_uniq _ (iota 0 (degree p))) ?iota_uniq ?mem_iota ?findex_max //.
by apply: eq_in_filter => i; rewrite mem_iota => /andP[_ lt]; rewrite turn_is.
Qed.

Lemma over_facing free d : runs_over (laid free) d = (d == f) || (d == opposite f).
Proof. by rewrite /runs_over /= orbF. Qed.

(** If the edge is no loop, it runs through one door of the start vertex. *)
Lemma one_door (p : W) free : same_vertex p f -> ~~ same_vertex f (opposite f) ->
  [seq i <- iota 0 (degree p) | runs_over (laid free) (turn p i)] = [:: findex clockwise p f].
Proof.
move=> pf not_loop; rewrite -(doors_to pf); apply: eq_filter => i; rewrite over_facing.
case: (turn p i =P opposite f) => [back|_]; last exact: orbF.
have := not_loop; rewrite -back (same_vertex_trans _ (same_vertex_turn p i)) //.
by rewrite same_vertex_sym.
Qed.

(** If it is a loop, through two, one of which is that of the other end. *)
Lemma two_doors (p : W) free i : same_vertex p f -> same_vertex f (opposite f) ->
  [seq i <- iota 0 (degree p) | runs_over (laid free) (turn p i)] <> [:: i].
Proof.
move=> pf loop one; have pb := same_vertex_trans pf loop.
have there (d : W) : same_vertex p d -> (d == f) || (d == opposite f) -> findex clockwise p d = i.
  move=> pd on; apply/eqP; rewrite -mem_seq1 -one mem_filter over_facing mem_iota /= findex_max // andbT.
  by rewrite /turn iter_findex.
have f_i : findex clockwise p f = i by apply: there; rewrite ?eqxx.
have b_i : findex clockwise p (opposite f) = i by apply: there; rewrite ?eqxx ?orbT.
have /eqP[] := opposite_neq f; rewrite -[LHS](iter_findex pb) -[RHS](iter_findex pf) f_i b_i.
by [].
Qed.

Lemma other_door (p : W) free : same_vertex p f -> same_vertex f (opposite f) ->
  [seq i <- [seq i <- iota 0 (degree p) | runs_over (laid free) (turn p i)]
     | Some (findex clockwise p (opposite f)) != Some i] = [:: findex clockwise p f].
Proof.
move=> pf loop; have pb := same_vertex_trans pf loop; rewrite -filter_predI -(doors_to pf).
apply: eq_in_filter => i; rewrite mem_iota /= over_facing => lt.
rewrite (inj_eq (@Some_inj _)) [_ == i]eq_sym -(turn_is pb lt); case: (turn p i =P opposite f) => [->|_].
  by rewrite (negPf (opposite_neq f)).
by rewrite orbF.
Qed.

(** * What it then knows *)

Lemma look_at_string_ends (p d : W) : same_vertex d (opposite f) ->
  let s : state (with_aid (string length) W) := (p, laid (Some d)) in
  ends (look_at_string (sense s)) s (fun o s' k m =>
    [/\ o = perceive directional p,
        exists2 d', same_vertex d' (opposite f) & s' = (p, laid (Some d')), k <= 2 & m <= 0]).
Proof.
move=> free; rewrite /look_at_string /= -/f /perceive /directional -/f.
have here : exists2 d', same_vertex d' (opposite f) & (p, laid (Some d)) = (p, laid (Some d')) by exists d.
case: ifP => pf //; case: (boolP (same_vertex f (opposite f))) => [loop|not_loop]; last by rewrite one_door.
have pb := same_vertex_trans pf loop; have pd : same_vertex p d.
  by apply: same_vertex_trans pb _; rewrite same_vertex_sym.
have several := @two_doors p (Some d) _ pf loop; have other := @other_door p None pf loop.
have {other} looked : ends
    (Try (Use PickUp) (fun held : nat * string_view =>
      let others := [seq i <- runs_through held.2 | from_hand held.2 != Some i] in
      Try (Use Drop) (fun=> Know (held.1, Pointing (head 0 others)))) : string_look)
    ((p, laid (Some d)) : state (with_aid (string length) W))
    (fun o s' k m => [/\ o = (degree p, Pointing (findex clockwise p f)),
        exists2 d', same_vertex d' (opposite f) & s' = (p, laid (Some d')), k <= 2 & m <= 0]).
  by rewrite /= pd -/(laid None) other; split=> //; split=> //; split=> //; exists p.
by case: filter several => [|i [|j doors]] several; [exact: looked | case: (several i) | exact: looked].
Qed.

(** The string lies over the facing edge, and its free end is at the other end of that edge. *)
Definition string_is_laid (p : W) (s : state (with_aid (string length) W)) : Prop :=
  exists2 d, same_vertex d (opposite f) & s = (p, laid (Some d)).

Lemma laid_pose p s : string_is_laid p s -> s.1 = p.
Proof. by move=> [d _ ->]. Qed.

Lemma laid_first :
  ends (lay_string (sense (first_state (with_aid (string length) W)))) (first_state (with_aid (string length) W))
    (fun o s k m => [/\ o = perceive directional (facing W), string_is_laid (facing W) s, k <= 5 & m <= 2]).
Proof.
have go : next_state (first_state (with_aid (string length) W)) (Take 0) = (opposite f, laid None).
  by rewrite /= length_gt0.
split; first by rewrite /= degree_gt0 length_gt0.
rewrite go; split; first by [].
split; first by rewrite /= degree_gt0.
have -> : next_state (next_state ((opposite f, laid None) : state (with_aid (string length) W)) (Use Drop)) (Take 0) =
    (f, laid (Some (opposite f))) by rewrite /= /traverse /= oppositeK.
apply: endsW (look_at_string_ends f (same_vertex_refl _)) _ => o s k m.
by move=> [-> laid_s k_le m_le]; split.
Qed.

Lemma laid_next p s i : string_is_laid p s -> i < degree p ->
  possible s (Take i) /\
  ends (look_at_string (sense (next_state s (Take i)))) (next_state s (Take i)) (fun o s' k m =>
    [/\ o = perceive directional (traverse p i), string_is_laid (traverse p i) s', k <= 2 & m <= 0]).
Proof. by move=> [d free ->] lt; split; [rewrite /= lt | apply: look_at_string_ends]. Qed.

End Laid.
