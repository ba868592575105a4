(** Several movable markers in place of one: the robot picks up all but one at the start, and keeps them. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Walks Imitation.
From toposlam Require MovableMarker.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Import MovableMarker(handling, handling_action, LeaveBy, can_handle).

(** * Lists of places *)

Lemma nseq_cons (T : Type) a (x : T) s : nseq a x ++ x :: s = nseq a.+1 x ++ s.
Proof. by elim: a => //= a ->. Qed.

Lemma set_nth_nseq (T : Type) (x0 y z w : T) a s : set_nth x0 (nseq a y ++ z :: s) a w = nseq a y ++ w :: s.
Proof. by elim: a => //= a ->. Qed.

Lemma nth_nseq_cat (T : Type) (x0 y z : T) a s : nth x0 (nseq a y ++ z :: s) a = z.
Proof. by elim: a. Qed.

Section Places.

Variables (W : start) (p : W).

Definition nobody_lies a : has (lies_at p) (nseq a None) = false.
Proof. by elim: a. Qed.

Lemma count_places a b (lying : option W) :
  count (lies_at p) (nseq a None ++ lying :: nseq b None) = lies_at p lying.
Proof. by rewrite count_cat /= !count_nseq !mul0n addn0. Qed.

Lemma find_lying a (spot : W) s : same_vertex p spot -> find (lies_at p) (nseq a None ++ Some spot :: s) = a.
Proof. by move=> here; rewrite find_cat nobody_lies size_nseq /= here addn0. Qed.

Lemma has_lying a (spot : W) s : same_vertex p spot -> has (lies_at p) (nseq a None ++ Some spot :: s).
Proof. by move=> here; rewrite has_cat /= here orbT. Qed.

End Places.

Section Held.

Variables (held : nat) (W : start).
Let f := facing W.

(** * Markers that look alike *)

Definition do_with_alike (e : handling_action) : action_with holding :=
  match e with
  | LeaveBy i => Take i
  | MovableMarker.PickUp => Use PickUp
  | MovableMarker.Drop => Use Drop
  end.

Definition look_at_alike (seen : nat * nat) : look (nat * nat) (action_with holding) percept :=
  Know (seen.1, if 0 < seen.2 then Lying else Nothing).

(** Picks up so many markers first. *)
Fixpoint pick_up_alike (more : nat) (seen : nat * nat) : look (nat * nat) (action_with holding) percept :=
  if more is fewer.+1 then Try (Use PickUp) (pick_up_alike fewer) else look_at_alike seen.

(** All but one are carried, and that one lies where the single marker does. *)
Definition one_of_alike (s : state (handling W)) (t : state (with_aid (markers_alike held.+1) W)) : Prop :=
  exists a b, a + b = held /\ t = (s.1, nseq a None ++ s.2 :: nseq b None).

Lemma look_at_one_of_alike (s : state (handling W)) a b : a + b = held ->
  let t : state (with_aid (markers_alike held.+1) W) := (s.1, nseq a None ++ s.2 :: nseq b None) in
  ends (look_at_alike (sense t)) t (fun o t' k m => [/\ o = sense s, one_of_alike s t', k <= 0 & m <= 0]).
Proof.
case: s => p lying ab /=; rewrite count_places; split=> //; last by exists a, b.
by rewrite /= /MovableMarker.perceive_lying /lies_at; case: lying => // spot; case: same_vertex.
Qed.

Lemma alike_first :
  ends (pick_up_alike held (sense (first_state (with_aid (markers_alike held.+1) W))))
    (first_state (with_aid (markers_alike held.+1) W)) (fun o t k m =>
      [/\ o = sense (first_state (handling W)), one_of_alike (first_state (handling W)) t, k <= held & m <= 0]).
Proof.
have general more a : a + more = held ->
    let t : state (with_aid (markers_alike held.+1) W) := (f, nseq a None ++ Some f :: nseq more (Some f)) in
    ends (pick_up_alike more (sense t)) t (fun o t' k m =>
      [/\ o = sense (first_state (handling W)), one_of_alike (first_state (handling W)) t', k <= more & m <= 0]).
  elim: more a => [|more IH] a sum; first exact: (@look_at_one_of_alike (first_state (handling W)) a 0 sum).
  have here := same_vertex_refl f; split; first exact: has_lying.
  rewrite [next_state _ _]/= has_lying // find_lying // set_nth_nseq nseq_cons.
  have {}sum : a.+1 + more = held by rewrite addSnnS.
  by apply: endsW (IH _ sum) _ => o t k m [-> fits k_le m_le].
exact: (general held 0).
Qed.

Lemma alike_next s t e : one_of_alike s t -> can_handle s e ->
  possible t (do_with_alike e) /\
  ends (look_at_alike (sense (next_state t (do_with_alike e)))) (next_state t (do_with_alike e)) (fun o t' k m =>
    [/\ o = sense (next_state (e := handling W) s e), one_of_alike (next_state (e := handling W) s e) t',
        k <= 0 & m <= 0]).
Proof.
case: s => p lying [a [b [ab ->]]]; case: e => [i||] can.
- split; first by rewrite /= andbT.
  by apply: (@look_at_one_of_alike (traverse p i, lying)).
- case: lying can => // spot can; have here : same_vertex p spot := can; split; first exact: has_lying.
  have -> : next_state (e := handling W) (p, Some spot) MovableMarker.PickUp = (p, None) by rewrite /= here.
  rewrite [next_state _ (do_with_alike _)]/= has_lying // find_lying // set_nth_nseq.
  exact: (@look_at_one_of_alike (p, None)).
case: lying can => // _; rewrite [nseq a _ ++ _]nseq_cons -nseqD addSn ab; split=> //.
exact: (@look_at_one_of_alike (p, Some p) 0 held erefl).
Qed.

(** * Markers that look different *)

Definition do_with_first (e : handling_action) : action_with holding_one :=
  match e with
  | LeaveBy i => Take i
  | MovableMarker.PickUp => Use (PickUpMarker 0)
  | MovableMarker.Drop => Use (DropMarker 0)
  end.

Definition look_at_first (seen : nat * seq bool) : look (nat * seq bool) (action_with holding_one) percept :=
  Know (seen.1, if head false seen.2 then Lying else Nothing).

(** Picks up the markers with numbers up to this one first, the highest first, except marker 0. *)
Fixpoint pick_up_others (number : nat) (seen : nat * seq bool) :
    look (nat * seq bool) (action_with holding_one) percept :=
  if number is fewer.+1 then Try (Use (PickUpMarker number)) (pick_up_others fewer) else look_at_first seen.

(** All but marker 0 are carried, and that one lies where the single marker does. *)
Definition first_of_distinct (s : state (handling W)) (t : state (with_aid (markers_distinct held.+1) W)) : Prop :=
  t = (s.1, s.2 :: nseq held None).

Lemma look_at_first_of (s : state (handling W)) :
  let t : state (with_aid (markers_distinct held.+1) W) := (s.1, s.2 :: nseq held None) in
  ends (look_at_first (sense t)) t (fun o t' k m => [/\ o = sense s, first_of_distinct s t', k <= 0 & m <= 0]).
Proof.
case: s => p lying /=; split=> //.
by rewrite /= /MovableMarker.perceive_lying /lies_at; case: lying.
Qed.

Lemma distinct_first :
  ends (pick_up_others held (sense (first_state (with_aid (markers_distinct held.+1) W))))
    (first_state (with_aid (markers_distinct held.+1) W)) (fun o t k m =>
      [/\ o = sense (first_state (handling W)), first_of_distinct (first_state (handling W)) t, k <= held & m <= 0]).
Proof.
have general more b : more + b = held ->
    let t : state (with_aid (markers_distinct held.+1) W) := (f, Some f :: nseq more (Some f) ++ nseq b None) in
    ends (pick_up_others more (sense t)) t (fun o t' k m =>
      [/\ o = sense (first_state (handling W)), first_of_distinct (first_state (handling W)) t', k <= more & m <= 0]).
  elim: more b => [|more IH] b sum.
    by rewrite add0n in sum; rewrite sum; exact: (look_at_first_of (first_state (handling W))).
  have can : nth false (map (lies_at f) (Some f :: nseq more.+1 (Some f) ++ nseq b None)) more.+1.
    by rewrite -nseq_cons [map _ _]/= map_cat map_nseq [nth _ _ _]/= nth_nseq_cat /= same_vertex_refl.
  split; first exact: can.
  rewrite [next_state _ _]/= [nth _ _ _]can -[Some f :: nseq more _ ++ _]/(nseq more.+1 (Some f) ++ nseq b None).
  rewrite -nseq_cons set_nth_nseq.
  have {}sum : more + b.+1 = held by rewrite -addSnnS.
  by apply: endsW (IH _ sum) _ => o t k m [-> fits k_le m_le].
by have := general held 0; rewrite addn0 cats0; apply.
Qed.

Lemma distinct_next s t e : first_of_distinct s t -> can_handle s e ->
  possible t (do_with_first e) /\
  ends (look_at_first (sense (next_state t (do_with_first e)))) (next_state t (do_with_first e)) (fun o t' k m =>
    [/\ o = sense (next_state (e := handling W) s e), first_of_distinct (next_state (e := handling W) s e) t',
        k <= 0 & m <= 0]).
Proof.
case: s => p lying ->; case: e => [i||] can.
- by split; [rewrite /= andbT | apply: (@look_at_first_of (traverse p i, lying))].
- case: lying can => // spot can; have here : same_vertex p spot := can; split; first exact: here.
  have -> : next_state (e := handling W) (p, Some spot) MovableMarker.PickUp = (p, None) by rewrite /= here.
  by rewrite [next_state _ (do_with_first _)]/= here; apply: (@look_at_first_of (p, None)).
by case: lying can => //= _; split=> //; apply: (@look_at_first_of (p, Some p)).
Qed.

End Held.
