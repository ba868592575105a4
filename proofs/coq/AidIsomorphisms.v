(** The aids that move show nothing that an isomorphism does not keep. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Aids Walks Bisimulation.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** An isomorphism acts on the states of an aid, so that what robots see and do is kept. *)
Definition keeps_isomorphisms (X : aid) : Prop :=
  forall (V W : start) (f : V -> W), isomorphism f ->
  exists g : placed X V -> placed X W,
    (forall p, g (first_placed X p) = first_placed X (f p)) /\
    forall p x,
      [/\ shows (f p) (g x) = shows p x,
          forall a, can_act (f p) (g x) a = can_act p x a /\ g (act p x a) = act (f p) (g x) a
        & can_leave (g x) (f p) = can_leave x p /\ g (leave x p) = leave (g x) (f p)].

Lemma isomorphic_bisimilar (X : aid) (V W : start) :
  keeps_isomorphisms X -> isomorphic_starts V W -> bisimilar (with_aid X) V W.
Proof.
move=> keeps [f [iso facing_f]]; have [g [g_first g_step]] := keeps _ _ _ iso.
exists (fun s t => t = (f s.1, g s.2)); split; first by rewrite /= g_first facing_f.
move=> [p x] t -> /=; rewrite isomorphism_degree //; have [-> acts _] := g_step p x; split=> // -[i|a].
  rewrite -isomorphism_turn //; have [_ _ [-> <-]] := g_step (turn p i) x.
  by case: ifP => //= _; rewrite isomorphism_traverse.
by have [-> <-] := acts a; case: ifP.
Qed.

Section Places.

Variables (V W : start) (f : V -> W).
Hypothesis iso : isomorphism f.

Lemma lies_at_omap p l : lies_at (f p) (omap f l) = lies_at p l.
Proof. by case: l => //= spot; rewrite isomorphism_same_vertex. Qed.

Lemma carried_omap l : is_carried (omap f l) = is_carried l.
Proof. by case: l. Qed.

Lemma map_set_nth (A B : Type) (h : A -> B) x s i y : map h (set_nth x s i y) = set_nth (h x) (map h s) i (h y).
Proof.
elim: s i => [|z s IH] [|i] //=; last by rewrite IH.
by congr (_ :: _); elim: i => //= i ->.
Qed.

End Places.

Lemma alike_keeps_isomorphisms number : keeps_isomorphisms (markers_alike number).
Proof.
move=> V W f iso; exists (map (omap f)); split=> [p|p x /=]; first by rewrite /= map_nseq.
have here : preim (omap f) (lies_at (f p)) =1 lies_at p by move=> l; apply: lies_at_omap.
have held : preim (omap f) (@is_carried W) =1 @is_carried V by move=> l; apply: carried_omap.
rewrite count_map (eq_count here); split=> // -[]; rewrite has_map find_map.
  by rewrite (eq_has here) (eq_find here) map_set_nth.
by rewrite (eq_has held) (eq_find held) map_set_nth.
Qed.

Lemma distinct_keeps_isomorphisms number : keeps_isomorphisms (markers_distinct number).
Proof.
move=> V W f iso; exists (map (omap f)); split=> [p|p x /=]; first by rewrite /= map_nseq.
have here : map (lies_at (f p)) (map (omap f) x) = map (lies_at p) x.
  by rewrite -map_comp; apply: eq_map => l; apply: lies_at_omap.
have held : map (@is_carried W) (map (omap f) x) = map (@is_carried V) x.
  by rewrite -map_comp; apply: eq_map => l; apply: carried_omap.
by rewrite here; split=> // -[i|i]; rewrite ?here ?held map_set_nth.
Qed.

Lemma directional_keeps_isomorphisms : keeps_isomorphisms movable_directional.
Proof.
move=> V W f iso; exists (omap f); split=> // p [along|] /=; last by split=> // -[].
by rewrite isomorphism_same_vertex // isomorphism_findex //; split=> // -[] /=; rewrite ?isomorphism_same_vertex.
Qed.

Lemma directional_and_movable_keeps_isomorphisms : keeps_isomorphisms directional_and_movable.
Proof.
move=> V W f iso; exists (fun x => (f x.1, omap f x.2)); split=> // p [along spot] /=.
by rewrite isomorphism_same_vertex // isomorphism_findex // lies_at_omap // carried_omap; split=> // -[].
Qed.

Lemma team_keeps_isomorphisms heading others : keeps_isomorphisms (team heading others).
Proof.
move=> V W f iso; exists (map f); split=> [p|p x /=]; first by rewrite /= map_nseq.
have nth_f q i : nth (f q) (map f x) i = f (nth q x i).
  by elim: x i => [|y x IH] [|i] //=; rewrite ?nth_nil.
rewrite size_map; split=> // [|[i d]]; last first.
  by rewrite nth_f isomorphism_degree // map_set_nth isomorphism_traverse.
apply: eq_mkseq => i; rewrite /companion_seen nth_f isomorphism_same_vertex //.
have along q r : stands_along heading (f q) (f r) = stands_along heading q r.
  by rewrite /stands_along isomorphism_findex.
rewrite along -map_take find_map nth_f along isomorphism_degree //.
rewrite (eq_find (a2 := same_vertex (nth p x i))) // => q; exact: isomorphism_same_vertex.
Qed.

Lemma string_keeps_isomorphisms length : keeps_isomorphisms (string length).
Proof.
move=> V W f iso; have [/bij_inj f_inj f_opp _] := iso.
exists (fun x => StringPlace (f (fixed_end x)) (map f (string_way x)) (omap f (free_end x))).
split=> // p [fixed way free] /=.
have behind_f : string_behind (StringPlace (f fixed) (map f way) (omap f free)) =
    omap f (string_behind (StringPlace fixed way free)).
  by rewrite /string_behind /=; case: (way) => //= d _; rewrite f_opp.
have behind_eq d : (omap f (string_behind (StringPlace fixed way free)) == Some (f d)) =
    (string_behind (StringPlace fixed way free) == Some d).
  by case: string_behind => //= e; rewrite !(inj_eq (@Some_inj _)) (inj_eq f_inj).
have over d : runs_over (StringPlace (f fixed) (map f way) (omap f free)) (f d) =
    runs_over (StringPlace fixed way free) d.
  rewrite /runs_over /= has_map; apply: eq_has => e /=.
  by rewrite -f_opp !(inj_eq f_inj).
split=> [|a|].
- rewrite isomorphism_same_vertex // lies_at_omap // isomorphism_degree // carried_omap behind_f.
  congr StringView; first by apply: eq_in_filter => i _; rewrite -isomorphism_turn // over.
  by case: ifP => // _; case: string_behind => //= d; rewrite isomorphism_findex.
- by rewrite lies_at_omap // carried_omap; case: a.
rewrite carried_omap behind_f behind_eq size_map; split=> //.
by case: ifP => //= _; case: ifP => //= _; rewrite behead_map.
Qed.
