(** The poses of indistinguishable starts form classes that no walk distinguishes. All classes have the same
    size, which divides the degree of the marked vertex. So starts that an undirected marker cannot tell
    apart have equally many edges and vertices. Beyond Section 2.2. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Walks Bisimulation.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Poses that are alike *)

Section Alike.

Variables (M : marker) (V W : start).
Implicit Types (p : V) (q : W) (doors : seq door).

Lemma alike_perceive p q : alike M p q -> perceive M p = perceive M q.
Proof. by move=> /(_ [::]) /(congr1 (head (0, Nothing))). Qed.

Lemma alike_walk p q doors : alike M p q -> alike M (walk p doors : V) (walk q doors : W).
Proof.
move=> pq more; apply: eq_percepts => ds; rewrite -!walk_cat -!(last_percepts _ (0, Nothing)).
by rewrite pq.
Qed.

Lemma indistinguishable_alike p : indistinguishable M V W -> exists q, alike M p q.
Proof.
move=> same; have [doors <-] := connected_walk (facing V) p.
by exists (walk (facing W) doors); apply: alike_walk.
Qed.

(** It is decidable whether two poses are alike, because only finitely many pairs of poses can be reached.
    *)
Definition both_step (x y : V * W) :=
  (y == (opposite x.1, opposite x.2)) || (y == (clockwise x.1, clockwise x.2)).

Definition alikeb p q : bool :=
  [forall x : V * W, connect both_step (p, q) x ==> (perceive M x.1 == perceive M x.2)].

Lemma alikeP p q : reflect (alike M p q) (alikeb p q).
Proof.
apply: (iffP forallP) => [same | pq [p' q']].
  apply: eq_percepts => doors; apply/eqP.
  apply: (implyP (same (walk p doors, walk q doors))); elim/last_ind: doors => [|doors i IH].
    exact: connect0.
  rewrite !walk_rcons; apply: connect_trans IH _; set x := walk p doors; set y := walk q doors.
  apply: (@connect_trans _ _ (turn x i, turn y i)).
    elim: i => [|i IH]; first exact: connect0.
    by apply: connect_trans IH (connect1 _); rewrite /both_step eqxx orbT.
  by apply: connect1; rewrite /both_step eqxx.
apply/implyP => /connectP[s]; elim: s p q pq => [|[p1 q1] s IH] p q pq /=.
  by move=> _ [-> ->]; apply/eqP/alike_perceive.
case/andP=> step s_path; apply: IH s_path; case/orP: step => /eqP[-> ->].
  exact: (alike_walk [:: 0] pq).
by have := alike_walk [:: 1; 0] pq; rewrite !walk_clockwise.
Qed.

(** The poses of [W] that are alike to a pose of [V]. *)
Definition class p : pred W := [pred q : W | alikeb p q].

End Alike.

Arguments class M {V} W p.

Lemma alikeb_equiv M (W : start) : equivalence_rel (@alikeb M W W).
Proof.
move=> p q r; split=> [|/alikeP pq]; first exact/alikeP.
by apply/alikeP/alikeP => [pr | qr] doors; [rewrite -pq | rewrite pq].
Qed.

(** Poses that are alike have the same class. *)
Lemma eq_class M (U V W : start) (p : U) (q : V) : alike M p q -> class M W p =1 class M W q.
Proof.
by move=> pq r; apply/alikeP/alikeP => [pr | qr] doors; [rewrite -pq | rewrite pq].
Qed.

(** * All classes have one size *)

(** A walk maps a class into a class, and is injective. *)
Lemma card_class M (V W : start) (p p' : V) : #|class M W p| = #|class M W p'|.
Proof.
suff leq (r r' : V) : #|class M W r| <= #|class M W r'| by apply/eqP; rewrite eqn_leq !leq.
have [doors <-] := connected_walk r r'.
rewrite -(card_image (@walk_inj W doors)); apply/subset_leq_card/subsetP => _ /imageP[q /alikeP rq ->].
exact/alikeP/alike_walk.
Qed.

Lemma class_gt0 M (W : start) (p : W) : 0 < #|class M W p|.
Proof. by apply/card_gt0P; exists p; apply/alikeP. Qed.

(** ** The size divides the degree of the marked vertex *)

Lemma alike_marked (V W : start) (p : V) (q : W) :
  alike undirected p q -> same_vertex p (facing V) = same_vertex q (facing W).
Proof.
move=> /alike_perceive [_]; rewrite /undirected.
by case: (same_vertex p _); case: (same_vertex q _).
Qed.

Lemma card_class_dvd_degree (W : start) (p : W) : #|class undirected W p| %| degree (facing W).
Proof.
pose marked := [set q : W | same_vertex (facing W) q].
have -> : degree (facing W) = #|marked| by rewrite cardsE.
have parts : partition (equivalence_partition (@alikeb undirected W W) marked) marked.
  by apply: equivalence_partitionP => q r s _ _ _; apply: alikeb_equiv.
rewrite (@card_uniform_partition _ #|class undirected W p| _ _ _ parts); first exact: dvdn_mull.
move=> _ /imsetP[q q_marked ->]; rewrite (card_class undirected W p q) cardsE.
apply: eq_card => r; rewrite !inE; apply: andb_idl => /alikeP /alike_marked same.
by move: q_marked; rewrite !inE same_vertex_sym same same_vertex_sym.
Qed.

(** ** Two starts that an undirected marker cannot distinguish *)

Lemma count_both_ways (T U : finType) (R : T -> U -> bool) (A : pred T) (B : pred U) k l :
  (forall x y, R x y -> A x = B y) ->
  (forall x, #|[pred y | R x y]| = k) -> (forall y, #|[pred x | R x y]| = l) ->
  #|A| * k = #|B| * l.
Proof.
move=> same R_k R_l; rewrite -!sum_nat_const.
transitivity (\sum_(x in A) \sum_(y | R x y) 1).
  by apply: eq_bigr => x _; rewrite sum1_card -(R_k x).
rewrite (exchange_big_dep B) /= => [|x y A_x /same <- //].
apply: eq_bigr => y B_y; rewrite sum1_card -(R_l y); apply: eq_card => x; rewrite !inE /=.
by apply: andb_idl => /same A_x; rewrite [x \in A]A_x.
Qed.

Lemma indistinguishable_degree (V W : start) :
  indistinguishable undirected V W -> degree (facing V) = degree (facing W).
Proof. by move=> same; have [] := alike_perceive same. Qed.

Lemma card_class_across M (V W : start) (p : V) (q : W) :
  indistinguishable M V W -> #|class M W p| = #|class M W q|.
Proof.
move=> /(indistinguishable_alike p)[r /eq_class pr].
by rewrite (eq_card (pr _)) (card_class M W r q).
Qed.

(** A vertex has as many darts as its degree. *)
Lemma verticesE (G : embedded_graph) bound :
  (forall d : G, degree d < bound) ->
  vertices G = \sum_(i < bound) #|[pred d : G | degree d == i]| %/ i.
Proof.
move=> small; rewrite /vertices /n_comp_mem -sum1_card.
rewrite (partition_big (fun d : G => Ordinal (small d)) predT) //=; apply: eq_bigr => i _.
rewrite sum1_card; case: (posnP i) => [i0 | i_gt0].
  rewrite i0 divn0; apply: eq_card0 => d; rewrite unfold_in /= -val_eqE /= i0.
  by rewrite -leqn0 leqNgt degree_gt0 andbF.
rewrite -(@fcard_order_set _ _ (@clockwise_inj G) i [pred d : G | degree d == i]).
- by rewrite mulnK //; apply: eq_card => d; rewrite unfold_in -val_eqE /= !inE andbT.
- by apply/subsetP.
by move=> d e /eqP<-; rewrite !inE (degree_turn d 1).
Qed.

Section Indistinguishable.

Variables V W : start.
Hypothesis same : indistinguishable undirected V W.

Let k := #|class undirected V (facing V)|.
Let l := #|class undirected W (facing W)|.

Let count_alike (A : pred V) (B : pred W) :
  (forall p q, alike undirected p q -> A p = B q) -> #|A| * l = #|B| * k.
Proof.
move=> A_B; apply: (@count_both_ways _ _ (@alikeb undirected V W)) => [p q /alikeP /A_B // | p | q].
  exact: card_class_across.
rewrite /k -(card_class_across q (facing V) (indistinguishable_sym same)); apply: eq_card => p.
by apply/alikeP/alikeP => pq doors; rewrite pq.
Qed.

Let same_size : k = l.
Proof.
have : degree (facing V) * l = degree (facing W) * k.
  apply: (@count_alike (same_vertex (facing V)) (same_vertex (facing W))) => p q /alike_marked.
  by rewrite ![same_vertex _ (facing _)]same_vertex_sym.
by move/eqP; rewrite -(indistinguishable_degree same) eqn_pmul2l ?degree_gt0 // => /eqP.
Qed.

(** One size for all classes: within each start, and of the poses of one start that are alike to a pose of
    the other. *)
Lemma indistinguishable_classes :
  exists size, [/\ size %| degree (facing V),
    forall p : V, #|class undirected V p| = size, forall q : W, #|class undirected W q| = size,
    forall p : V, #|class undirected W p| = size & forall q : W, #|class undirected V q| = size].
Proof.
exists k; split=> [|p|q|p|q].
- exact: card_class_dvd_degree.
- exact: card_class.
- by rewrite same_size; apply: card_class.
- by rewrite same_size; apply: card_class_across.
exact: card_class_across (indistinguishable_sym same).
Qed.

(** For any percept, equally many poses of both starts give it: so they have equally many edges and
    vertices. *)
Lemma indistinguishable_card (A : pred percept) :
  #|[pred p : V | A (perceive undirected p)]| = #|[pred q : W | A (perceive undirected q)]|.
Proof.
apply/eqP; rewrite -(eqn_pmul2r (class_gt0 undirected (facing V))) -/k {1}same_size.
by apply/eqP/count_alike => p q /alike_perceive /= ->.
Qed.

Corollary indistinguishable_edges : edges V = edges W.
Proof. by congr _./2; exact: (indistinguishable_card predT). Qed.

Corollary indistinguishable_vertices : vertices V = vertices W.
Proof.
pose bound := (maxn #|V| #|W|).+1.
rewrite !(@verticesE _ bound) => [|q|p]; rewrite ?ltnS ?leq_max ?max_card ?orbT //.
by apply: eq_bigr => i _; congr (_ %/ _); exact: (indistinguishable_card (fun seen => seen.1 == i)).
Qed.

End Indistinguishable.
