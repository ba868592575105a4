(** A robot of a team without headings in place of a directional marker, in worlds without loops and parallel
    edges. The other robot stays at the start. To see along which door it stands, the robot sends it through that
    door, looks for it behind all doors, and calls it back. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Walks Parts Imitation.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Notation seen_with_team := (nat * seq companion)%type.
Notation team_look := (look seen_with_team (action_with sending) percept).

Definition first_is_here (seen : seen_with_team) : bool := if seen.2 is Here _ :: _ then true else false.

(** Comes back from door [i], where the other robot is, and calls it. At the end the robot leaves by its entry door
    and returns, to come in by that door again. *)
Definition call_back (degree : nat) (i : door) : team_look :=
  Try (Take 0) (fun=> Try (Use (Send 0 0)) (fun=>
    Try (Take (inverse_door degree i)) (fun=> Try (Take 0) (fun=> Know (degree, Pointing i))))).

(** Looks behind so many doors, from door [i] on; the robot has looked behind those before. *)
Fixpoint look_behind (degree fuel : nat) (i : door) : team_look :=
  if fuel is fuel'.+1 then
    Try (Take (if i is 0 then 0 else 1)) (fun seen =>
      if first_is_here seen then call_back degree i
      else Try (Take 0) (fun=> look_behind degree fuel' i.+1))
  else Know (degree, Nothing).

Definition look_at_team (seen : seen_with_team) : team_look :=
  if first_is_here seen then Try (Use (Send 0 0)) (fun=> look_behind seen.1 seen.1 0) else Know (seen.1, Nothing).

Section Team.

Variables (others : nat) (W : start).
Hypothesis simple_W : simple W.

Let X := team false others.+1.
Let f := facing W.

(** The first of the other robots is here; the rest stay where they are. *)
Let with_first (first : W) : seq W := first :: nseq others f.
Let at_pose (p first : W) : state (with_aid X W) := (p, with_first first).

Lemma first_seen p first : first_is_here (sense (at_pose p first)) = same_vertex p first.
Proof. by rewrite /first_is_here /= /companion_seen /=; case: ifP. Qed.

(** In a simple world only one door leads to the vertex where the other robot is. *)
Lemma behind_facing (p : W) i : same_vertex p f ->
  same_vertex (opposite (turn p i)) (opposite f) = (turn p i == f).
Proof.
move=> pf; have [_ no_parallel] := simple_W; apply/idP/eqP => [|->]; last exact: same_vertex_refl.
by apply: no_parallel; apply: same_vertex_trans pf; rewrite same_vertex_sym same_vertex_turn.
Qed.

Lemma call_back_ends (p : W) i : i < degree p -> turn p i = f ->
  ends (call_back (degree p) i) (at_pose (opposite f) (opposite f)) (fun o s k m =>
    [/\ o = (degree p, Pointing i), s = at_pose p f, k <= 4 & m <= 3]).
Proof.
move=> lt turn_i; rewrite /call_back /= !degree_gt0 /=; split=> //; split=> //.
rewrite /traverse /= !oppositeK; have back : turn f (inverse_door (degree p) i) = p by rewrite -turn_i inverse_doorK.
rewrite back andbT; split; last by split.
by rewrite -turn_i degree_turn ltn_pmod // degree_gt0.
Qed.

Lemma look_behind_ends (p : W) fuel i :
  same_vertex p f -> i + fuel = degree p -> (forall j, j < i -> turn p j != f) ->
  ends (look_behind (degree p) fuel i) (at_pose (turn p i.-1) (opposite f)) (fun o s k m =>
    [/\ o = (degree p, Pointing (findex clockwise p f)), s = at_pose p f, k <= 2 * fuel + 3 & m <= 2 * fuel + 2]).
Proof.
move=> pf; elim: fuel i => [|fuel IH] i enough none.
  have := none (findex clockwise p f); rewrite addn0 in enough.
  by rewrite enough findex_max // /turn iter_findex // eqxx => /(_ isT).
have lt : i < degree p by rewrite -enough addnS ltnS leq_addr.
have go : turn (turn p i.-1) (if i is 0 then 0 else 1) = turn p i by case: (i).
have can : (if i is 0 then 0 else 1) < degree (turn p i.-1).
  by rewrite degree_turn; case: (i) lt => // j /(leq_trans _) ->.
set s := at_pose (turn p i.-1) (opposite f).
have next : next_state s (Take (if i is 0 then 0 else 1)) = at_pose (opposite (turn p i)) (opposite f).
  by rewrite /= /traverse go.
rewrite [look_behind _ _ _]/=; split; first by rewrite /= can.
rewrite next first_seen behind_facing //; case: eqP => [found|/eqP not_i].
  rewrite found; apply: endsW (call_back_ends lt found) _ => o s' k m [-> -> k_le m_le].
  rewrite -found findex_turn //; split=> //; rewrite mulnS addnAC.
    exact: leq_trans (k_le : k < 5) (leq_addr _ _).
  exact: leq_trans (m_le : m < 4) (leq_addr _ _).
split; first by rewrite /= degree_gt0.
have -> : next_state (at_pose (opposite (turn p i)) (opposite f)) (Take 0) = at_pose (turn p i.+1.-1) (opposite f).
  by rewrite /= /traverse /= oppositeK.
have {}none j : j < i.+1 -> turn p j != f by rewrite ltnS leq_eqVlt => /predU1P[->|/none].
have {}enough : i.+1 + fuel = degree p by rewrite addSnnS.
apply: endsW (IH i.+1 enough none) _ => o s' k m [-> -> k_le m_le]; split=> //.
  by rewrite mulnS.
by rewrite mulnS; case: (i).
Qed.

(** The other robots are as at the start. *)
Definition team_waits (p : W) (s : state (with_aid X W)) : Prop := s = at_pose p f.

Lemma waits_pose p s : team_waits p s -> s.1 = p.
Proof. by move->. Qed.

Variable bound : nat.
Hypothesis small : forall d : W, degree d <= bound.

Lemma look_at_team_ends (p : W) :
  ends (look_at_team (sense (at_pose p f))) (at_pose p f) (fun o s k m =>
    [/\ o = perceive directional p, team_waits p s, k <= 2 * bound + 4 & m <= 2 * bound + 2]).
Proof.
rewrite /look_at_team first_seen /perceive /directional -/f; case: ifP => // pf.
split; first by rewrite /= degree_gt0.
have -> : next_state (at_pose p f) (Use (Send 0 0)) = at_pose (turn p 0.-1) (opposite f) by rewrite /= degree_gt0.
apply: endsW (look_behind_ends pf (add0n _) _) _ => // o s k m [-> -> k_le m_le].
have le : 2 * degree p <= 2 * bound by rewrite leq_mul2l small.
split=> //; first by rewrite addnS ltnS (leq_trans k_le) // leq_add2r.
by rewrite add0n (leq_trans m_le) // leq_add2r.
Qed.

Lemma waits_first :
  ends (look_at_team (sense (first_state (with_aid X W)))) (first_state (with_aid X W)) (fun o s k m =>
    [/\ o = perceive directional (facing W), team_waits (facing W) s, k <= 2 * bound + 4 & m <= 2 * bound + 2]).
Proof. exact: look_at_team_ends. Qed.

Lemma waits_next p s i : team_waits p s -> i < degree p ->
  possible s (Take i) /\
  ends (look_at_team (sense (next_state s (Take i)))) (next_state s (Take i)) (fun o s' k m =>
    [/\ o = perceive directional (traverse p i), team_waits (traverse p i) s',
        k <= 2 * bound + 4 & m <= 2 * bound + 2]).
Proof. by move=> -> lt; split; [rewrite /= lt | apply: look_at_team_ends]. Qed.

End Team.
