(** A walk that checks a map, of order m n: for each dart a round over its edge, on short paths. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Folding Walks Separates Bisimulation Parts Complete Covering.
From toposlam Require Import Moves Trail Unfolding Determined.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Short paths *)

Section Paths.

Variable T : start.

Notation root := (froot (@clockwise T)).
Let sym := fconnect_sym (@clockwise_inj T).

Let same_root (p q : T) : (root p == root q) = same_vertex p q.
Proof. exact: root_connect. Qed.

(** From a vertex to the next, both by their roots. *)
Let step (x y : T) := [exists d, same_vertex x d && (y == root (opposite d))].

Lemma roots_connected (d : T) : connect step (root (facing T)) (root d).
Proof.
have /connectP[s path_s ->] := connected (facing T) d; elim/last_ind: s path_s => [|s r IH].
  by move=> _; apply: connect0.
rewrite rcons_path last_rcons => /andP[/IH to_p /orP[]/eqP->]; set p := last _ _ in to_p *.
  apply: connect_trans to_p (connect1 _); apply/existsP; exists p; rewrite eqxx andbT.
  by rewrite -same_root (root_root sym).
by have /eqP <- : root p == root (clockwise p) by rewrite same_root (same_vertex_turn p 1).
Qed.

Lemma steps_walk s (x p : T) : path step x s -> same_vertex x p ->
  exists2 doors, size doors = size s & same_vertex (last x s) (walk p doors).
Proof.
elim: s x p => [|y s IH] x p /=; first by exists [::].
case/andP=> /existsP[d /andP[xd /eqP yE]] path_s xp.
have /same_vertexP[i dE] : same_vertex p d by apply: same_vertex_trans xd; rewrite same_vertex_sym.
have near : same_vertex y (traverse p i) by rewrite /traverse -dE yE -same_root (root_root sym).
by have [doors size_doors at_end] := IH y (traverse p i) path_s near; exists (i :: doors); rewrite /= ?size_doors.
Qed.

Lemma way_exists (d : T) :
  exists doors, same_vertex (walk (facing T) doors) d && (size doors < vertices T).
Proof.
have /connectP[s path_s] := roots_connected d; case/shortenP: path_s => s' path_s' uniq_s' _ last_s'.
have [|doors size_doors at_end] := steps_walk path_s' (p := facing T).
  by rewrite -same_root (root_root sym).
exists doors; apply/andP; split.
  by rewrite same_vertex_sym; apply: same_vertex_trans at_end; rewrite -last_s' -same_root (root_root sym).
have <- : #|[set x : T | root x == x]| = vertices T by rewrite cardsE; apply: eq_card => x; rewrite !inE andbT.
rewrite size_doors -ltnS -[(size s').+1]/(size (root (facing T) :: s')) -(card_uniqP uniq_s') ltnS.
apply/subset_leq_card/subsetP => x; rewrite !inE => /predU1P[->|x_s]; first by rewrite (root_root sym).
have : all (fun y => root y == y) s'.
  elim: s' (root (facing T)) path_s' {uniq_s' last_s' size_doors at_end x_s} => //= y l IH z /andP[zy /IH->].
  by case/existsP: zy => e /andP[_ /eqP->]; rewrite (root_root sym) eqxx.
by move/allP; apply.
Qed.

(** The doors of a short path to the vertex of a dart, and the door for the dart at its end. *)
Definition way (d : T) : seq door := xchoose (way_exists (root d)).
Definition last_door (d : T) : door := findex clockwise (walk (facing T) (way d)) d.

Lemma way_at d : same_vertex (walk (facing T) (way d)) d.
Proof.
have /andP[near _] := xchooseP (way_exists (root d)); apply: same_vertex_trans near _.
by rewrite -same_root (root_root sym).
Qed.

Lemma size_way d : size (way d) < vertices T.
Proof. by have /andP[] := xchooseP (way_exists (root d)). Qed.

Lemma turn_last_door d : turn (walk (facing T) (way d)) (last_door d) = d.
Proof. exact: iter_findex (way_at d). Qed.

Lemma way_same d e : same_vertex d e -> way d = way e.
Proof. by rewrite -same_root => /eqP; rewrite /way => ->. Qed.

(** The way back from a dart to the marker, and how far the robot is turned there. *)
Definition back (e : T) : seq door :=
  if way_back (taken (facing T) (way e)) is _ :: others then inverse_door (degree e) (last_door e) :: others
  else [::].
Definition turned_back (e : T) : door := if way e is i :: _ then i else last_door e.

(** In any start in which the path has the same degrees. *)
Lemma walk_back (W : start) (e : T) :
  taken (facing W) (way e) = taken (facing T) (way e) ->
  degree (walk (facing W) (way e)) = degree e ->
  walk (turn (walk (facing W) (way e)) (last_door e)) (back e) = turn (facing W) (turned_back e).
Proof.
rewrite /back /turned_back => <- degree_e; have := way_backK (facing W) (way e).
case: (way e) degree_e => // i doors; set p := walk _ _ => degree_e /= <-.
by rewrite /traverse -degree_e inverse_doorK.
Qed.

Lemma size_back e : size (back e) < vertices T.
Proof.
apply: leq_ltn_trans (size_way e); rewrite /back -(size_taken (facing T) (way e)).
case: (taken _ _) => // t others.
suff: size (rev [seq inverse_door step.2 step.1 | step <- others]) <= size others by [].
by rewrite size_rev size_map.
Qed.

(** A round over the edge of a dart. *)
Definition round (d : T) : seq door := rcons (way d) (last_door d) ++ back (opposite d).

Lemma walk_round_out (d : T) : walk (facing T) (rcons (way d) (last_door d)) = opposite d.
Proof. by rewrite walk_rcons /traverse turn_last_door. Qed.

Lemma walk_round (d : T) : walk (facing T) (round d) = turn (facing T) (turned_back (opposite d)).
Proof.
rewrite /round walk_cat walk_round_out -{1}(turn_last_door (opposite d)) walk_back //.
by rewrite (same_vertex_degree (way_at (opposite d))).
Qed.

Lemma size_round (d : T) : size (round d) <= 2 * vertices T - 1.
Proof.
rewrite size_cat size_rcons; have lt := size_way d; have lt' := size_back (opposite d).
by rewrite mul2n -addnn -addnBA ?(leq_trans _ lt) // leq_add // -ltnS subn1 prednK // (leq_trans _ lt).
Qed.

(** The rounds of some darts, one after the other, for a robot that is turned at the marker. *)
Definition turned_doors (t : door) (doors : seq door) : seq door :=
  if doors is i :: others then (inverse_door (degree (facing T)) t + i) :: others else [::].

Fixpoint rounds (t : door) (darts : seq T) : seq door :=
  if darts is d :: others then turned_doors t (round d) ++ rounds (turned_back (opposite d)) others
  else [::].

Lemma size_rounds t darts : size (rounds t darts) <= size darts * (2 * vertices T - 1).
Proof.
elim: darts t => //= d darts IH t; rewrite size_cat mulSn leq_add //.
by apply: leq_trans (size_round d); case: (round d).
Qed.

End Paths.

(** * Rounds with the same percepts *)

Section Rounds.

Variables (T W : start).

Lemma percepts_cat (X : start) (p : X) ds es : percepts directional p (ds ++ es) =
  percepts directional p ds ++ behead (percepts directional (walk p ds : X) es).
Proof. by elim: ds p => [|i ds IH] p /=; [case: es | rewrite IH]. Qed.

Lemma percepts_prefix (p : T) (q : W) ds es :
  percepts directional p (ds ++ es) = percepts directional q (ds ++ es) ->
  percepts directional p ds = percepts directional q ds.
Proof.
rewrite !percepts_cat => /eqP; rewrite eqseq_cat ?size_percepts // => /andP[/eqP] //.
Qed.

Lemma percepts_end (p : T) (q : W) ds : percepts directional p ds = percepts directional q ds ->
  perceive directional (walk p ds : T) = perceive directional (walk q ds : W).
Proof. by move=> same; rewrite -!(last_percepts _ (0, Nothing)) same. Qed.

Lemma percepts_suffix (p : T) (q : W) ds es :
  percepts directional p (ds ++ es) = percepts directional q (ds ++ es) ->
  percepts directional (walk p ds : T) es = percepts directional (walk q ds : W) es.
Proof.
move=> same; have := percepts_end (percepts_prefix same).
move: same; rewrite !percepts_cat => /eqP; rewrite eqseq_cat ?size_percepts // => /andP[_ /eqP].
by case: es => [|i es] /= same first; rewrite first ?same.
Qed.

Lemma taken_percepts (p : T) (q : W) ds : percepts directional p ds = percepts directional q ds ->
  taken p ds = taken q ds.
Proof.
elim: ds p q => //= i ds IH p q [degrees _ /IH->]; by rewrite degrees.
Qed.

(** At the marker the percept shows how far the robot is turned. *)
Lemma turned_at_marker t (q : W) :
  perceive directional (turn (facing T) t : T) = perceive directional q -> q = turn (facing W) t.
Proof.
case/perceive_directionalP; rewrite degree_turn => degrees /(_ (inverse_door (degree (facing T)) t)).
rewrite inverse_doorK eqxx => /esym/eqP back.
rewrite -[LHS](turn_degree q) -degrees.
apply: (@turn_inj _ (inverse_door (degree (facing T)) t)); rewrite -turnD addnC turnD back.
have degree_W : degree (facing W) = degree (facing T) by rewrite -back degree_turn.
by rewrite -{1}degree_W turn_degree -degree_W inverse_doorK.
Qed.

Lemma percepts_turned (X : start) t doors : degree (facing X) = degree (facing T) ->
  behead (percepts directional (turn (facing X) t : X) (turned_doors T t doors)) =
  behead (percepts directional (facing X) doors) /\
  (doors <> [::] -> walk (turn (facing X) t) (turned_doors T t doors) = walk (facing X) doors).
Proof.
move=> degree_X; case: doors => [|i doors] /=; first by split.
have -> : traverse (turn (facing X) t) (inverse_door (degree (facing T)) t + i) = traverse (facing X) i.
  by rewrite /traverse turnD -degree_X inverse_doorK.
by split.
Qed.

Lemma same_rounds (darts : seq T) t :
  percepts directional (turn (facing T) t : T) (rounds t darts) =
  percepts directional (turn (facing W) t : W) (rounds t darts) ->
  perceive directional (facing T) = perceive directional (facing W) ->
  forall d : T, d \in darts -> percepts directional (facing T) (round d) = percepts directional (facing W) (round d).
Proof.
elim: darts t => // d darts IH t /= same at_start e.
have degree_W : degree (facing W) = degree (facing T) by case: at_start.
have some : round d <> [::] by rewrite /round; case: (way d).
have [T_percepts T_walk] := percepts_turned t (round d) (erefl (degree (facing T))).
have [W_percepts W_walk] := percepts_turned t (round d) degree_W.
have same_d : percepts directional (facing T) (round d) = percepts directional (facing W) (round d).
  have := congr1 behead (percepts_prefix same); rewrite T_percepts W_percepts.
  by case: (round d) some => //= i doors _ ->; rewrite at_start.
rewrite inE => /predU1P[-> //|]; apply: IH (turned_back (opposite d)) _ at_start e.
have := percepts_suffix same; rewrite T_walk // W_walk // walk_round.
by have /turned_at_marker -> : perceive directional (turn (facing T) (turned_back (opposite d)) : T) =
     perceive directional (walk (facing W) (round d) : W) by rewrite -walk_round; apply: percepts_end.
Qed.

(** If all rounds have the same percepts, the starts are isomorphic. *)
Hypothesis same : forall d : T,
  percepts directional (facing T) (round d) = percepts directional (facing W) (round d).

Let f (d : T) : W := turn (walk (facing W) (way d)) (last_door d).

Let same_way (d : T) : percepts directional (facing T) (way d) = percepts directional (facing W) (way d).
Proof. by have := same d; rewrite /round cat_rcons => /percepts_prefix. Qed.

Let degree_way (d : T) : degree (walk (facing W) (way d)) = degree d.
Proof. by have [<- _] := percepts_end (same_way d); apply: same_vertex_degree (way_at d). Qed.

Let f_perceive (d : T) : perceive directional d = perceive directional (f d).
Proof. by have := perceive_turn (last_door d) (percepts_end (same_way d)); rewrite turn_last_door. Qed.

Let f_clockwise d : f (clockwise d) = clockwise (f d).
Proof.
have way_d : way (clockwise d) = way d by apply: way_same; rewrite same_vertex_sym (same_vertex_turn d 1).
rewrite /f way_d -[RHS]/(turn (walk (facing W) (way d)) (last_door d).+1).
have : turn (walk (facing T) (way d)) (last_door (clockwise d)) = turn (walk (facing T) (way d)) (last_door d).+1.
  rewrite -[in LHS]way_d turn_last_door.
  by rewrite -[RHS]/(clockwise (turn (walk (facing T) (way d)) (last_door d))) turn_last_door.
move/turn_eq => mod_eq; rewrite -[LHS]turn_mod -[RHS]turn_mod degree_way.
by move: mod_eq; rewrite (same_vertex_degree (way_at d)) => ->.
Qed.

Let f_opposite d : f (opposite d) = opposite (f d).
Proof.
apply: (@walk_inj _ (back (opposite d))); rewrite /= walk_back ?degree_way //; last first.
  by rewrite (taken_percepts (same_way _)).
apply/esym; have end_T := percepts_end (same d); rewrite walk_round in end_T.
have := turned_at_marker end_T; rewrite /round walk_cat walk_rcons => <-.
by [].
Qed.

Lemma rounds_isomorphic : isomorphic_starts T W.
Proof.
apply: (covering_isomorphic f_opposite f_clockwise) => d.
by rewrite -!pointing0P; have [_ ->] := f_perceive d.
Qed.

End Rounds.

(** * The walk *)

Definition tour_of_map (T : start) :
  {tour : seq door | complete tour (sees T tour) & size tour <= 2 * edges T * (2 * vertices T - 1)}.
Proof.
pose tour := rounds 0 (enum T); exists tour; last first.
  by rewrite -card_darts cardE; apply: size_rounds.
have determined W : sees W tour = sees T tour -> isomorphic_starts T W.
  move=> /esym same; apply: rounds_isomorphic => d.
  have start : perceive directional (facing T) = perceive directional (facing W).
    by have := percepts_eq_walk same (leq0n _); rewrite !take0.
  by apply: (same_rounds (t := 0) same start); rewrite mem_enum.
move=> k i lt _; case: (followed_orN i lt) => // open.
have [V [V' [V_T V'_T differ _ _]]] := open_folding_ambiguous lt open; case: differ.
have [f [f_iso _]] := isomorphic_starts_trans (isomorphic_starts_sym (determined V V_T)) (determined V' V'_T).
by exists f.
Qed.
