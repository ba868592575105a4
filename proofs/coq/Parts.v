(** A map of darts that keeps what is around a pose keeps its percept. And a way to show that a graph is
    connected. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Walks.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Turns come back after the degree *)

Section Turns.

Variables (G : embedded_graph) (p : G).

Lemma findex_turn i : i < degree p -> findex clockwise p (turn p i) = i.
Proof. exact: findex_iter. Qed.

Lemma turn_period i : (turn p i == p) = (degree p %| i).
Proof.
rewrite -turn_mod /dvdn; have lt : i %% degree p < degree p by rewrite ltn_mod degree_gt0.
apply/eqP/eqP => [back|->] //.
by rewrite -(findex_turn lt) back findex0.
Qed.

Lemma turn_eq i j : turn p i = turn p j -> i = j %[mod degree p].
Proof.
rewrite -(turn_mod p i) -(turn_mod p j) => same.
have lt k : k %% degree p < degree p by rewrite ltn_mod degree_gt0.
by rewrite -(findex_turn (lt i)) same findex_turn.
Qed.

End Turns.

(** * Around one pose *)

Section Around.

Variables (G H : embedded_graph) (f : G -> H) (p : G).
Hypothesis f_turn : forall i, f (turn p i) = turn (f p) i.
Hypothesis f_one : forall i, f (turn p i) = f p -> turn p i = p.

Lemma part_degree : degree (f p) = degree p.
Proof.
apply/eqP; rewrite eqn_dvd -!turn_period -f_turn turn_degree eqxx /=.
by apply/eqP/f_one; rewrite f_turn turn_degree.
Qed.

Lemma part_findex q : same_vertex p q -> findex clockwise (f p) (f q) = findex clockwise p q.
Proof.
move=> pq; have [lt <-] : findex clockwise p q < degree p /\ turn p (findex clockwise p q) = q.
  by split; [apply: findex_max | apply: iter_findex].
by rewrite f_turn !findex_turn ?part_degree.
Qed.

Lemma part_same_vertex q : same_vertex p q -> same_vertex (f p) (f q).
Proof. by case/same_vertexP=> i ->; rewrite f_turn same_vertex_turn. Qed.

End Around.

(** The percept with a directional marker. *)
Lemma part_perceive (V W : start) (f : V -> W) (p : V) :
  (forall i, f (turn p i) = turn (f p) i) -> (forall i, f (turn p i) = f p -> turn p i = p) ->
  f (facing V) = facing W -> (same_vertex (f p) (facing W) -> same_vertex p (facing V)) ->
  perceive directional (f p) = perceive directional p.
Proof.
move=> f_turn f_one f_facing marked; rewrite /perceive (part_degree f_turn f_one) /directional.
case: ifP => [/marked near|away].
  by rewrite near -f_facing (part_findex f_turn f_one).
by case: ifP => // /(part_same_vertex f_turn); rewrite f_facing away.
Qed.

(** * Connected *)

Section Connected.

Variables (T : finType) (opp cw : T -> T) (root : T).
Hypotheses (oppK : involutive opp) (cw_inj : injective cw).

Let step x y := (y == opp x) || (y == cw x).

Lemma connect_opp x : connect step x (opp x).
Proof. by apply: connect1; rewrite /step eqxx. Qed.

Lemma connect_cw x : connect step x (cw x).
Proof. by apply: connect1; rewrite /step eqxx orbT. Qed.

Lemma connect_iter_cw x i : connect step x (iter i cw x).
Proof. by elim: i => [|i IH]; [apply: connect0 | apply: connect_trans IH (connect_cw _)]. Qed.

Lemma connect_back x y : connect step x y -> connect step y x.
Proof.
case/connectP=> s; elim: s x => [|z s IH] x /=; first by move=> _ ->; apply: connect0.
case/andP=> xz /IH zy /zy{zy}/connect_trans; apply.
case/orP: xz => /eqP->; first by rewrite -{2}(oppK x) connect_opp.
have := fconnect1 cw x; rewrite (fconnect_sym cw_inj) => /iter_findex back.
by rewrite -[X in connect _ _ X]back connect_iter_cw.
Qed.

Lemma all_connected : (forall x, connect step root x) -> forall x y, connect step x y.
Proof. by move=> from_root x y; apply: connect_trans (connect_back (from_root x)) (from_root y). Qed.

End Connected.

(** * The percepts of a walk *)

Lemma percepts_take M (W : start) (p : W) doors :
  percepts M p doors = [seq perceive M (walk p (take i doors) : W) | i <- iota 0 (size doors).+1].
Proof.
elim: doors p => [|i doors IH] p //; rewrite [LHS]/= IH.
by rewrite [size _]/= -[in RHS](add1n (size doors).+1) iotaD map_cat (iotaDl 1 0) -map_comp.
Qed.

Lemma size_percepts M (W : start) (p : W) doors : size (percepts M p doors) = (size doors).+1.
Proof. by rewrite percepts_take size_map size_iota. Qed.

Lemma nth_percepts M (W : start) (p : W) doors i : i <= size doors ->
  nth (0, Nothing) (percepts M p doors) i = perceive M (walk p (take i doors) : W).
Proof.
by move=> le; rewrite percepts_take (nth_map 0) ?size_iota // nth_iota.
Qed.

Lemma eq_percepts_walk M (V W : start) (p : V) (q : W) doors :
  (forall i, i <= size doors ->
     perceive M (walk p (take i doors) : V) = perceive M (walk q (take i doors) : W)) ->
  percepts M p doors = percepts M q doors.
Proof.
move=> same; rewrite !percepts_take; apply/eq_in_map => i; rewrite mem_iota add0n ltnS => /andP[_].
exact: same.
Qed.

Lemma percepts_eq_walk M (V W : start) (p : V) (q : W) doors i :
  percepts M p doors = percepts M q doors -> i <= size doors ->
  perceive M (walk p (take i doors) : V) = perceive M (walk q (take i doors) : W).
Proof. by move=> same le; rewrite -!(nth_percepts _ _ le) same. Qed.

(** * Percepts with a directional marker *)

(** Two percepts are equal if the same doors lead to the facing dart. *)
Lemma perceive_directionalP (V W : start) (p : V) (q : W) :
  perceive directional p = perceive directional q <->
  degree p = degree q /\ forall t, (turn p t == facing V) = (turn q t == facing W).
Proof.
have marked (X : start) (r : X) t : same_vertex r (facing X) ->
    (turn r t == facing X) = (t == findex clockwise r (facing X) %[mod degree r]).
  move=> near; have {1}<- : turn r (findex clockwise r (facing X)) = facing X by apply: iter_findex.
  by apply/eqP/eqP => [/turn_eq //|same]; rewrite -turn_mod same turn_mod.
have away (X : start) (r : X) t : same_vertex r (facing X) = false -> (turn r t == facing X) = false.
  by apply: contraFF => /eqP<-; apply: same_vertex_turn.
split=> [[degrees]|[degrees same]].
  rewrite /directional; case: ifP => near; case: ifP => // near'; last first.
    by move=> _; split=> // t; rewrite !away.
  by case=> index; split=> // t; rewrite !marked // index degrees.
congr (_, _) => //; rewrite /directional.
have near_eq : same_vertex p (facing V) = same_vertex q (facing W).
  by apply/same_vertexP/same_vertexP => -[t /esym/eqP];
     [rewrite same | rewrite -same] => /eqP <-; exists t.
rewrite -near_eq; case: ifP => // near; congr Pointing.
have : turn p (findex clockwise p (facing V)) == facing V by apply/eqP/iter_findex.
rewrite same => /eqP <-; rewrite findex_turn // -degrees; exact: findex_max.
Qed.

Lemma perceive_turn (V W : start) (p : V) (q : W) i :
  perceive directional p = perceive directional q ->
  perceive directional (turn p i : V) = perceive directional (turn q i : W).
Proof.
case/perceive_directionalP=> degrees same; apply/perceive_directionalP; rewrite !degree_turn.
by split=> // t; rewrite -!turnD.
Qed.
