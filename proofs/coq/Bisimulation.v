(** No robot can distinguish bisimilar starts: its percepts and its answer are the same in both. Section
    2.2 of the paper. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Walks.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Bisimilar is indistinguishable *)

Lemma bisimilarP M V W : bisimilar (moving M) V W <-> indistinguishable M V W.
Proof.
split=> [[R [start_R R_step]] doors | same].
  have {}R_step (p : V) (q : W) : R p q -> perceive M p = perceive M q /\ forall i, R (traverse p i) (traverse q i).
    exact: R_step.
  have {}start_R : R (facing V : V) (facing W : W) by [].
  elim: doors (facing V) (facing W) start_R => [|i doors IH] p q /R_step[pq next] /=; rewrite pq //.
  by rewrite (IH _ _ (next i)).
exists (fun p q => forall doors, percepts M p doors = percepts M q doors); split=> // p q pq.
split=> [|i doors]; first by rewrite /= /perceive; have [-> ->] := pq [::].
by have [_ _ ->] := pq (i :: doors).
Qed.

Lemma indistinguishable_sym M V W : indistinguishable M V W -> indistinguishable M W V.
Proof. by move=> same doors; rewrite same. Qed.

Lemma indistinguishable_trans M U V W :
  indistinguishable M U V -> indistinguishable M V W -> indistinguishable M U W.
Proof. by move=> UV VW doors; rewrite UV. Qed.

(** * Robots in bisimilar starts *)

Section Runs.

Variables (O E A : Type) (robot : robot_of O E A).

Lemma historyS (I : environment_of O E) n :
  history robot I n.+1 =
    if robot (history robot I n) is Act e then
      rcons (history robot I n) (sense (next_state (situation robot I n).2 e))
    else history robot I n.
Proof. by rewrite /history /=; case: (situation _ _ n) => past s /=; case: (robot past). Qed.

Lemma bisimilar_history (I : start -> environment_of O E) V W :
  bisimilar I V W -> forall n, history robot (I V) n = history robot (I W) n.
Proof.
move=> [R [start_R R_step]] n.
suff [] : history robot (I V) n = history robot (I W) n /\
          R (situation robot (I V) n).2 (situation robot (I W) n).2 by [].
rewrite /history; elim: n => [|n] /=; first by have [-> _] := R_step _ _ start_R.
case: (situation _ (I V) n) (situation _ (I W) n) => [past s] [past' t] /= [<- st].
have [_ next] := R_step _ _ st; case: (robot past) => //= e.
by have [-> _] := R_step _ _ (next e).
Qed.

Lemma bisimilar_answers (I : start -> environment_of O E) V W :
  bisimilar I V W -> forall a, answers robot (I V) a <-> answers robot (I W) a.
Proof.
by move=> /bisimilar_history same a; split=> -[n answered]; exists n; rewrite -answered same.
Qed.

Variable I : environment_of O E.

(** A robot that has answered stays where it is. *)
Lemma history_answered a n k : robot (history robot I n) = Answer a -> history robot I (n + k) = history robot I n.
Proof.
by move=> answered; elim: k => [|k IH]; rewrite ?addn0 // addnS historyS IH answered.
Qed.

Lemma answers_inj a b : answers robot I a -> answers robot I b -> a = b.
Proof.
move=> [n robot_a] [k robot_b].
have := robot_a; rewrite -(history_answered k robot_a) addnC (history_answered n robot_b) robot_b.
by case.
Qed.

End Runs.

(** * The same *)

Section Isomorphisms.

Variables (G H : embedded_graph) (f : G -> H).
Hypothesis iso : isomorphism f.

Let f_inj : injective f. Proof. by case: iso => /bij_inj. Qed.

Lemma isomorphism_turn p i : f (turn p i) = turn (f p) i.
Proof. by case: iso => _ _ f_cw; elim: i => //= i <-. Qed.

Lemma isomorphism_traverse p i : f (traverse p i) = traverse (f p) i.
Proof. by case: iso => _ f_opp _; rewrite /traverse f_opp isomorphism_turn. Qed.

Lemma isomorphism_walk p doors : f (walk p doors) = walk (f p) doors.
Proof. by elim: doors p => //= i doors IH p; rewrite IH isomorphism_traverse. Qed.

Lemma isomorphism_same_vertex p q : same_vertex (f p) (f q) = same_vertex p q.
Proof.
apply/same_vertexP/same_vertexP => -[i]; last by move=> ->; exists i; rewrite isomorphism_turn.
by rewrite -isomorphism_turn => /f_inj->; exists i.
Qed.

Lemma isomorphism_degree p : degree (f p) = degree p.
Proof.
have [[g _ gK] _ _] := iso.
rewrite -[RHS](card_image f_inj); apply: eq_card => q.
by rewrite -(gK q) (mem_image f_inj) [LHS]isomorphism_same_vertex.
Qed.

Lemma isomorphism_findex p q : findex clockwise (f p) (f q) = findex clockwise p q.
Proof.
rewrite /findex; suff -> : orbit clockwise (f p) = map f (orbit clockwise p) by exact: index_map.
rewrite /orbit [order _ _](isomorphism_degree p) -/(degree p); have [_ _ f_cw] := iso.
by move: (degree p) => n; elim: n p => //= n IH p; rewrite -f_cw IH.
Qed.

End Isomorphisms.

Lemma isomorphism_id (G : embedded_graph) : isomorphism (@id G).
Proof. by split=> //; exists id. Qed.

Lemma isomorphism_comp (G H K : embedded_graph) (f : G -> H) (g : H -> K) :
  isomorphism f -> isomorphism g -> isomorphism (g \o f).
Proof.
move=> [f_bij f_opp f_cw] [g_bij g_opp g_cw]; split=> [|d|d]; first exact: bij_comp.
  by rewrite /= f_opp g_opp.
by rewrite /= f_cw g_cw.
Qed.

Lemma isomorphism_inv (G H : embedded_graph) (f : G -> H) (g : H -> G) :
  isomorphism f -> cancel f g -> cancel g f -> isomorphism g.
Proof.
move=> [f_bij f_opp f_cw] fK gK; split=> [|d|d]; first by exists f.
  by rewrite -{1}(gK d) -f_opp fK.
by rewrite -{1}(gK d) -f_cw fK.
Qed.

Lemma isomorphic_refl G : isomorphic G G.
Proof. by exists id; apply: isomorphism_id. Qed.

Lemma isomorphic_sym G H : isomorphic G H -> isomorphic H G.
Proof. by move=> [f iso]; have [[g fK gK] _ _] := iso; exists g; apply: isomorphism_inv iso fK gK. Qed.

Lemma isomorphic_trans G H K : isomorphic G H -> isomorphic H K -> isomorphic G K.
Proof. by move=> [f f_iso] [g g_iso]; exists (g \o f); apply: isomorphism_comp. Qed.

Lemma isomorphic_starts_refl W : isomorphic_starts W W.
Proof. by exists id; split; first apply: isomorphism_id. Qed.

Lemma isomorphic_starts_sym V W : isomorphic_starts V W -> isomorphic_starts W V.
Proof.
move=> [f [iso start_f]]; have [[g fK gK] _ _] := iso.
by exists g; split; [apply: isomorphism_inv iso fK gK | rewrite -start_f fK].
Qed.

Lemma isomorphic_starts_trans U V W :
  isomorphic_starts U V -> isomorphic_starts V W -> isomorphic_starts U W.
Proof.
move=> [f [f_iso start_f]] [g [g_iso start_g]]; exists (g \o f).
by split; [apply: isomorphism_comp | rewrite /= start_f].
Qed.
