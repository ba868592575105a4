(** The folding explorer maps every world, whatever its choices, and what that costs. Beyond Section 2.3. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Folding FoldingExplorer Walks Arithmetic Always Parts Maps Paths
  Embedding Complete Rounds Correct FoldedVisits
  ExplorerWalks.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

Section Explorer.

Variables (allowed : nat -> nat -> bool) (patience : partial_map -> nat).
Hypothesis allowed_short : forall k l, k <= l -> allowed k l.

Variable W : start.

Notation believes := (@believes W).

(** * What is left to do *)

Let m := edges W.
Let n := vertices W.

(** The pairs of darts that can be refuted. *)
Definition pairs := 'C(2 * m, 2).

(** [left] edges are not explored. *)
Definition edges_left (K : knowledge) (left : nat) :=
  size (known_map K) + 2 * left = 2 * m + size (unexplored (known_map K)).

(** The actions that are left, and the greatest cost of those that are strict. *)
Definition actions_left (K : knowledge) left := (2 * m - size (far_ends K)) + (left + (pairs - size (refuted K))).
Definition cost_left (K : knowledge) left :=
  (2 * m - size (far_ends K)) * (n + 1) + (left + (pairs - size (refuted K))) * (3 * n).

Section Bounds.

Variables (K : knowledge) (place : nat -> W) (spots : seq W) (q : W).
Hypothesis be : believes K place spots q.

Lemma far_ends_le : size (far_ends K) <= 2 * m.
Proof.
apply: leq_trans (size_known (be_map be)); rewrite -[size (far_ends K)](size_map fst) -[X in _ <= X](size_iota 0).
apply: uniq_leq_size => [|_ /mapP[[e x] /(be_far be)[e_lt _ _] ->]]; first exact: be_far_uniq be.
by rewrite mem_iota.
Qed.

Lemma refuted_le : size (refuted K) <= pairs.
Proof.
have known := size_known (be_map be).
pose all := [seq (i, j) | j <- iota 0 (2 * m), i <- iota 0 j].
have <- : size all = pairs.
  rewrite /all size_allpairs_dep /pairs -triangular_sum /index_iota subn0 sumnE big_map.
  by apply: eq_bigr => j _; rewrite size_iota.
apply: uniq_leq_size => [|[i j] /(be_refuted be)[ij j_lt _]]; first exact: be_refuted_uniq be.
apply/allpairsPdep; exists j, i; rewrite !mem_iota; split=> //.
by rewrite add0n; apply: leq_trans j_lt known.
Qed.

End Bounds.

(** * One action *)

Definition only_short := forall k l, allowed k l -> k <= l.

(** An action makes progress. If it is strict, its cost and what the robot then has strayed is paid; otherwise it
    costs not much more than all moves before. *)
Definition progress K left (K' : knowledge) left' k :=
  [/\ edges_left K' left', actions_left K' left' < actions_left K left, made K' = made K + k,
      cost_left K' left' <= cost_left K left
    & only_short ->
      size (strayed K') + cost_left K' left' + k <= size (strayed K) + cost_left K left \/
      made K <= patience (known_map K) /\ k <= made K + n + 1].


(** One edge more is explored. *)
Lemma edge_progress K K' left :
  edges_left K left -> size (known_map K) <= 2 * m ->
  (size (known_map K) + size (unexplored (known_map K'))).+2 =
    size (known_map K') + size (unexplored (known_map K)) ->
  size (known_map K') <= 2 * m ->
  edges_left K' left.-1 /\ 0 < left.
Proof.
rewrite /edges_left => count known explored known'.
have left_gt0 : 0 < left by arithmetic.
by split=> //; arithmetic.
Qed.

Lemma actions_left_edge K K' left :
  far_ends K' = far_ends K -> refuted K' = refuted K -> 0 < left ->
  (actions_left K' left.-1).+1 = actions_left K left /\ cost_left K' left.-1 + 3 * n = cost_left K left.
Proof.
rewrite /actions_left /cost_left => -> ->; case: left => //= left _.
by split; [rewrite addSn addnS | rewrite addSn mulSn -addnA; congr (_ + _); rewrite addnC].
Qed.

Lemma actions_left_far K e x left : (size (far_ends K)).+1 <= 2 * m ->
  (actions_left (with_far K e x) left).+1 = actions_left K left /\
  cost_left (with_far K e x) left + (n + 1) = cost_left K left.
Proof.
rewrite /actions_left /cost_left /= => lt; rewrite -[2 * m - size _](subnSK lt); split; first by [].
by rewrite mulSn -[RHS]addnA [RHS]addnC.
Qed.

Lemma actions_left_refuted K e h left : (size (refuted K)).+1 <= pairs ->
  (actions_left (with_refuted K e h) left).+1 = actions_left K left /\
  cost_left (with_refuted K e h) left + 3 * n = cost_left K left.
Proof.
rewrite /actions_left /cost_left /= => lt; rewrite -[pairs - size _](subnSK lt); split; first by rewrite !addnS.
by rewrite [left + _.+1]addnS mulSn -addnA; congr (_ + _); rewrite addnC.
Qed.

(** The end of a test. *)
Lemma conclude_spec K place spots q left e h (t : W) k0 K1 came :
  edges_left K left -> kept K K1 -> believes K1 place spots q -> made K1 = made K + k0 ->
  e \in unexplored (known_map K) -> h \in unexplored (known_map K) -> h != e -> ~~ is_refuted K e h ->
  (forall pose, came = Some pose -> [/\ place h = opposite (place e), pose < size (known_map K) & place pose = q]) ->
  (came = None -> place h <> opposite (place e)) ->
  let K' := conclude e h (K1, came) in
  exists left', [/\ believes K' place spots q, edges_left K' left', actions_left K' left' < actions_left K left,
    made K' = made K + k0 & size (strayed K') <= size (strayed K1) /\ cost_left K' left' + 3 * n = cost_left K left].
Proof.
move=> count [mapE farE refutedE] be madeE eU hU he fresh.
have := eU; rewrite mem_unexplored => /andP[e_lt _]; have := hU; rewrite mem_unexplored => /andP[h_lt _].
have known := size_known (be_map be); rewrite mapE in known.
move=> confirmed rejected; case: came confirmed rejected => [pose|] /=.
  move=> /(_ pose erefl)[placed pose_lt at_q] _; set K2 := located_at K1 pose 0.
  have be2 : believes K2 place spots q.
    have pose_lt1 : pose < size (known_map K1) by rewrite mapE.
    have [at_lt atE] := be_in_trail be pose_lt1.
    by rewrite at_q in atE; case: (be) => *; split; rewrite //= ?addn0 ?at_q.
  have eU2 : e \in unexplored (known_map K2) by rewrite /= mapE.
  have hU2 : h \in unexplored (known_map K2) by rewrite /= mapE.
  have [be' sizeU] := with_loop_believes be2 eU2 hU2 placed.
  have known' := size_known (be_map be').
  have [|count' left_gt0] := edge_progress count known _ known'.
    move: sizeU; rewrite /= mapE => ->.
    by rewrite size_with_edge // -addnS -addnS.
  have [actionsE costE] := actions_left_edge (K' := with_loop K2 e h) farE refutedE left_gt0.
  exists left.-1; split=> //; first by rewrite -actionsE.
  by rewrite /= addn0.
move=> _ /(_ erefl) differ; have be' : believes (with_refuted K1 e h) place spots q.
  case: (be) => *; split=> //= [i j|]; last by rewrite refutedE fresh -refutedE.
  rewrite inE => /predU1P[[-> ->]|/(be_refuted be)//].
  have low : minn e h < maxn e h by rewrite gtn_min !leq_max; case: (ltngtP e h) he => //; rewrite ?orbT.
  split=> //; first by rewrite mapE gtn_max e_lt h_lt.
  rewrite /minn /maxn; case: ifP => _ same; apply: differ; rewrite ?same ?oppositeK //.
have lt := refuted_le be'; have [actionsE costE] := actions_left_refuted e h left lt.
exists left; split=> //.
- by rewrite /edges_left /= mapE.
- suff -> : actions_left K left = actions_left K1 left by rewrite -actionsE.
  by rewrite /actions_left farE refutedE.
split=> //; suff -> : cost_left K left = cost_left K1 left by [].
by rewrite /cost_left farE refutedE.
Qed.

Lemma strict_cost w s p k s' c l :
  w.+1 <= s + l -> p.+1 <= l -> k <= p -> s' <= 1 + k -> s' + c + (w.+1 + k) <= s + (c + 3 * l).
Proof. by move=> *; arithmetic. Qed.

Lemma free_cost w v d p k l : w <= v -> v <= d.+1 -> k <= p -> p.+1 <= l -> w.+1 + k <= d + l + 1.
Proof. by move=> *; arithmetic. Qed.

Lemma perform_spec K place spots q left a :
  believes K place spots q -> edges_left K left -> allowed_action allowed patience K a ->
  always (moving directional W) (perform K a) q
    (fun K' r k => exists place' spots' left', believes K' place' spots' r /\ progress K left K' left' k).
Proof.
move=> be count; have em := be_map be; have known := size_known em.
have known_lt e : e \in unexplored (known_map K) -> e < size (known_map K).
  by rewrite mem_unexplored => /andP[].
have way_le w e : only_short -> e < size (known_map K) -> allowed_way allowed K w e ->
    (way_moves K w).+1 <= size (strayed K) + n.
  move=> short e_lt /andP[_ /short le]; apply: leq_ltn_trans le _; exact: (way_home_moves be e_lt).
have path_le h path : only_short -> h < size (known_map K) -> allowed_path allowed (known_map K) h path ->
    (size path).+1 <= n.
  by move=> short h_lt /andP[_ /short le]; apply: leq_ltn_trans le _; apply: (path_moves be h_lt).
case: a => [e p|e h|e|e w|e h t] /=.
- case/and4P=> eU /eqP none ok /eqP same; exists place, spots, left; have e_lt := known_lt e eU.
  have [from_lt to_lt edgeE] := passage_ends (be_explains be) ok; have [at_lt atE] := be_in_trail be e_lt.
  have be' : believes (with_far K e (to_dart (trail K) p)) place spots q.
    case: (be) => *; split=> //= [e' x|]; last by rewrite far_end_none.
    rewrite inE => /predU1P[[-> ->]|/(be_far be)//].
    by rewrite edgeE (eq_image be from_lt at_lt same) atE.
  have [actionsE costE] := actions_left_far e (to_dart (trail K) p) left (far_ends_le be').
  split=> //; split=> //; rewrite ?addn0 //; [by rewrite -actionsE | by rewrite -costE leq_addr |].
  by move=> _; left; rewrite -costE leq_add2l leq_addr.
- case far_e: far_end => [x|//] /and3P[eU hU /eqP same]; have [e_lt x_lt xE] := far_endP be far_e.
  have h_lt := known_lt h hU; have [at_lt atE] := be_in_trail be h_lt.
  have placed : place h = opposite (place e) by rewrite -atE -(eq_image be x_lt at_lt same).
  have [be' sizeU] := with_loop_believes be eU hU placed; exists place, spots, left.-1; split=> //.
  have [|count' left_gt0] := edge_progress count known _ (size_known (be_map be')).
    by rewrite sizeU /= size_with_edge // -addnS -addnS.
  have [actionsE costE] := actions_left_edge (K := K) (K' := with_loop K e h) erefl erefl left_gt0.
  split; rewrite ?addn0 //; [by rewrite -actionsE | by rewrite -costE leq_addr |].
  by move=> _; left; rewrite -costE leq_add2l leq_addr.
- case far_e: far_end => [x|//] /andP[eU none].
  have [place' be' explored] := with_place_believes be eU far_e none.
  exists place', spots, left.-1; split=> //.
  have [count' left_gt0] := edge_progress count known explored (size_known (be_map be')).
  have [actionsE costE] := actions_left_edge (K := K) (K' := with_place K e x) erefl erefl left_gt0.
  split; rewrite ?addn0 //; [by rewrite -actionsE | by rewrite -costE leq_addr |].
  by move=> _; left; rewrite -costE leq_add2l leq_addr.
- case/and3P=> eU /eqP none way_ok; have e_lt := known_lt e eU; have /andP[leads_there _] := way_ok.
  apply: always_bind; apply: alwaysW (go_over_spec be e_lt leads_there) => -[K1 seen] r k /=.
  move=> [spots' [be1 [mapE farE refutedE] _ rE [kE madeE strayedE]]]; rewrite addn0.
  exists place, spots', left; set x := here K1.
  have be' : believes (with_far K1 e x) place spots' r.
    have [here_lt hereE] := be_here be1.
    case: (be1) => *; split=> //= [e' x'|]; last by rewrite farE (far_end_none none) -farE.
    rewrite inE => /predU1P[[-> ->]|/(be_far be1)//].
    by rewrite mapE hereE rE.
  have [actionsE costE] := actions_left_far e x left (far_ends_le be').
  have actions1 : actions_left K1 left = actions_left K left by rewrite /actions_left farE refutedE.
  have cost1 : cost_left K1 left = cost_left K left by rewrite /cost_left farE refutedE.
  split=> //; split=> //.
  - by rewrite /edges_left /= mapE.
  - by rewrite -actions1 -actionsE.
  - by rewrite -cost1 -costE leq_addr.
  move=> short; left; have := way_le w e short e_lt way_ok.
  by rewrite -cost1 -costE /= strayedE kE => le; arithmetic.
case far_e: far_end => [x|//] /and5P[eU hU he fresh]; have [e_lt x_lt xE] := far_endP be far_e.
have h_lt := known_lt h hU; case: t => [w path|way y entry path] /=.
  case/andP=> way_ok path_ok; have /andP[leads_there _] := way_ok.
  have /andP[path_leads _] := path_ok.
  apply: always_bind; apply: alwaysW (go_over_spec be e_lt leads_there) => -[K1 seen] r k /=.
  move=> [spots1 [be1 kept1 seenE rE [kE madeE strayedE]]]; have [mapE _ _] := kept1.
  apply: always_bind; rewrite -mapE in h_lt path_leads.
  apply: alwaysW (try_spec be1 h_lt path_leads seenE) => -[K2 came] r2 k2 /=.
  move=> [spots2 [be2 kept2 k2_le made2 [strayed2 result]]].
  have confirmed pose : came = Some pose ->
      [/\ place h = opposite (place e), pose < size (known_map K) & place pose = r2].
    by move=> cameE; move: result; rewrite cameE -rE -mapE.
  have rejected : came = None -> place h <> opposite (place e).
    by move=> cameE; move: result; rewrite cameE -rE.
  have made2' : made K2 = made K + (k + k2) by rewrite made2 madeE addnA.
  have [left' [be' count' less madeE' [short' costE]]] :=
    conclude_spec r count (kept_trans kept1 kept2) be2 made2' eU hU he fresh confirmed rejected.
  exists place, spots2, left'; rewrite addn0; split=> //; split=> //; first by rewrite -costE leq_addr.
  move=> short; left.
  rewrite mapE in h_lt; rewrite strayed2 strayedE in short'; rewrite -costE kE.
  exact: strict_cost (way_le w e short e_lt way_ok) (path_le h path short h_lt path_ok) k2_le short'.
case/and5P=> early entry_lt leads_there y_lt /and4P[way_ok path_ok predicted proves].
have /andP[path_leads _] := path_ok.
apply: always_bind; apply: alwaysW (go_through_spec be y_lt leads_there) => -[K1 seen] r k /=.
move=> [spots1 [be1 kept1 seenE rE [kE madeE]]]; have [mapE _ _] := kept1.
apply: always_bind; rewrite -mapE in entry_lt path_leads.
apply: alwaysW (try_spec be1 entry_lt path_leads seenE) => -[K2 came] r2 k2 /=.
move=> [spots2 [be2 kept2 k2_le made2 [strayed2 result]]].
have confirmed pose : came = Some pose ->
    [/\ place h = opposite (place e), pose < size (known_map K) & place pose = r2].
  move=> cameE; move: result; rewrite cameE mapE => -[at_r lt at_r2]; split=> //.
  rewrite mapE in entry_lt.
  by rewrite -xE; apply/esym/(confirms_right be h_lt entry_lt x_lt y_lt proves); rewrite at_r.
have rejected : came = None -> place h <> opposite (place e).
  move=> cameE; move: result; rewrite cameE => differ true_h; apply: differ; rewrite rE.
  rewrite mapE in entry_lt.
  by apply: (predicts_right be h_lt entry_lt x_lt y_lt predicted); rewrite xE true_h.
have made2' : made K2 = made K + (k + k2) by rewrite made2 madeE addnA.
have [left' [be' count' less madeE' [short' costE]]] :=
  conclude_spec r count (kept_trans kept1 kept2) be2 made2' eU hU he fresh confirmed rejected.
exists place, spots2, left'; rewrite addn0; split=> //; split=> //; first by rewrite -costE leq_addr.
move=> short; right; split=> //.
rewrite mapE in entry_lt; have := path_le entry path short entry_lt path_ok; have := short _ _ way_ok.
have visits := be_visits be; rewrite kE => way_short path_short; exact: free_cost way_short visits k2_le path_short.
Qed.

(** There is always an allowed action. *)
Lemma default_allowed K place spots q : believes K place spots q -> unexplored (known_map K) != [::] ->
  allowed_action allowed patience K (default_action K).
Proof.
move=> be some; rewrite /default_action; set U := unexplored _; set e := head 0 U.
have eU : e \in U by move: some; rewrite /e -/U; case: (U) => // d s _; apply: mem_head.
have e_lt : e < size (known_map K) by move: eU; rewrite mem_unexplored => /andP[].
have way_ok : allowed_way allowed K (way_home K e) e.
  by rewrite /allowed_way (default_way be e_lt) allowed_short.
case far_e: far_end => [x|] /=; last by rewrite eU far_e way_ok.
case left: [seq _ <- _ | _] => [|h hs] /=; rewrite far_e eU /=.
  apply/allP=> h hU; apply: contraT; rewrite !negb_or => /and3P[he fresh _].
  have : h \in [seq h <- U | (h != e) && ~~ is_refuted K e h] by rewrite mem_filter he fresh.
  by rewrite left.
have : h \in [seq h <- U | (h != e) && ~~ is_refuted K e h] by rewrite left mem_head.
rewrite mem_filter => /andP[/andP[-> ->] hU]; rewrite hU way_ok /=; apply: (default_path allowed_short be).
by move: hU; rewrite mem_unexplored => /andP[].
Qed.

(** The robot's pose in a complete map. *)
Lemma pose_in_map_right K place spots q : believes K place spots q -> unexplored (known_map K) = [::] ->
  pose_in_map K < size (known_map K) /\ place (pose_in_map K) = q.
Proof.
move=> be explored; rewrite (be_pose be) /pose_in_map; have em := be_map be.
elim: (strayed K) (base K) (be_base be) => //= step steps IH pose lt.
have [lt' _ turnedE] := turned_right be step.1 lt; have [d dd'] := all_explored explored lt'.
have [d_lt _ _] := wf_other (em_wf em) dd'; rewrite dd' /=.
have [-> ->] := IH d d_lt; split=> //; congr (walk _ _).
by rewrite (em_other em dd') turnedE.
Qed.

(** * All actions *)

(** The moves before the last test that is not strict, and what the robot has then strayed, are few; what comes
    after is paid. *)
Variable early : nat.
Definition soon_strict := forall S (place : nat -> W), embeds S place -> patience S <= early.

Definition cost all := all + 4 * early + 2 * (n + 1).

Lemma explorer_actions_spec all bound K place spots q left :
  believes K place spots q -> edges_left K left ->
  always (moving directional W) (explorer_actions allowed patience bound K) q
    (fun answer r k =>
       (right_answer answer r \/ answer = None /\ bound < actions_left K left) /\
       (only_short -> soon_strict -> cost_left K left <= all ->
        size (strayed K) + cost_left K left + made K <= cost all -> made K + k <= cost all)).
Proof.
have done K' place' spots' q' : believes K' place' spots' q' -> unexplored (known_map K') = [::] ->
    right_answer (Some (known_map K', pose_in_map K')) q'.
  move=> be explored; have [lt at_q] := pose_in_map_right be explored.
  have [L drawn_L iso] := drawn_isomorphic (be_map be) explored lt; rewrite at_q in iso.
  by exists (known_map K'), (pose_in_map K'), L; split.
have ended K' : made K' + 0 <= size (strayed K') + made K' by rewrite addn0 leq_addl.
elim: bound K place spots q left => [|bound IH] K place spots q left be count;
  rewrite [explorer_actions _ _ _ _]/=; case UE: (unexplored _) => [|e U] /=.
- split; first by left; apply: done be UE.
  by move=> _ _ _; rewrite addn0; apply: leq_trans; rewrite leq_addl.
- split; last by move=> _ _ _; rewrite addn0; apply: leq_trans; rewrite leq_addl.
  have known := size_known (be_map be); right; split=> //.
  by rewrite /actions_left; move: count; rewrite /edges_left UE /= => count; arithmetic.
- split; first by left; apply: done be UE.
  by move=> _ _ _; rewrite addn0; apply: leq_trans; rewrite leq_addl.
have some : unexplored (known_map K) != [::] by rewrite UE.
split; first exact: default_allowed be some.
move=> a a_ok; apply: always_bind; apply: alwaysW (perform_spec be count a_ok) => K' r k.
move=> [place' [spots' [left' [be' [count' less madeE cost_less paid]]]]].
apply: alwaysW (IH K' place' spots' r left' be' count') => answer r' k' [right cost'].
split.
  case: right => [right|[none few]]; [by left | right; split=> //].
  exact: leq_ltn_trans few less.
move=> short patience_le cost_le in_all; rewrite addnA -madeE; have in_all' := leq_trans cost_less cost_le.
apply: (cost' short patience_le in_all'); case: (paid short) => [strict|[soon k_le]].
  by rewrite madeE; arithmetic.
have soon' := leq_trans soon (patience_le _ _ (be_map be)); have made_le := be_made be'.
by rewrite /cost; arithmetic.
Qed.

(** * From the start *)

Lemma folding_explorer_spec bound :
  always (moving directional W) (folding_explorer allowed patience bound (perceive directional (facing W))) (facing W)
    (fun answer r k =>
       (right_answer answer r \/ answer = None /\ bound < 2 * m * (m + 1)) /\
       (only_short -> soon_strict -> k <= cost (6 * n * m * m + 2 * n * m + 2 * m))).
Proof.
rewrite /folding_explorer /known_at_start; set K := Knowledge _ _ _ _ _ _ _ _ _ _.
set g := degree (facing W).
have sz : size (with_vertex [::] g) = g by rewrite size_with_vertex.
have g_gt0 : 0 < g := degree_gt0 _.
have ex : explains (trail K) [:: facing W].
  by split=> //= [[|k]|[|k]] //; rewrite andbF.
have be : believes K (turn (facing W)) [:: facing W] (facing W).
  split=> //=; rewrite ?sz ?size_map ?size_iota //.
  - exact: embeds_at_start.
  - by split=> // -[|k].
  by move=> d lt; rewrite /dart_in_trail /= (nth_map 0) ?size_iota // nth_iota // add0n.
have count : edges_left K m.
  by rewrite /edges_left /= unexplored_at_start sz size_iota addnC.
have pairsE : m + pairs = 2 * m * m.
  rewrite /pairs bin2 -[2 * m]/(2 * m) mul2n -doubleMl doubleK.
  case: (m) => [|m'] //; rewrite doubleS /= -mul2n; arithmetic.
have actionsE : actions_left K m = 2 * m * (m + 1).
  by rewrite /actions_left /= !subn0 pairsE mulnDr muln1 addnC.
have costE : cost_left K m = 6 * n * m * m + 2 * n * m + 2 * m.
  by rewrite /cost_left /= !subn0 pairsE; arithmetic.
have := explorer_actions_spec (6 * n * m * m + 2 * n * m + 2 * m) bound be count.
rewrite actionsE costE; apply: alwaysW => answer r k [right cost_k]; split=> // short patience_le.
apply: cost_k short patience_le (leqnn _) _.
rewrite -[size (strayed K)]/0 -[made K]/0 add0n addn0 /cost; apply: leq_trans (leq_addr _ _) (leq_addr _ _).
Qed.

End Explorer.

(** With the patience of the running explorer. *)
Lemma folding_explorer_cost (W : start) bound :
  always (moving directional W) (folding_explorer no_longer usual_patience bound (perceive directional (facing W)))
    (facing W)
    (fun _ _ k => k <= 6 * vertices W * edges W ^ 2 + 18 * vertices W * edges W + 2 * edges W + 2 * vertices W + 802).
Proof.
have short k l : k <= l -> no_longer k l by [].
pose early := 4 * vertices W * edges W + 200.
apply: alwaysW (folding_explorer_spec usual_patience short W early bound) => answer r k [_ cost_k].
apply: leq_trans (cost_k _ _) _ => // [S place em|].
  rewrite /usual_patience /early leq_add2r; have known := size_known em; have placed := known_vertices_le em.
  have -> : 4 * vertices W * edges W = 2 * vertices W * (2 * edges W) by arithmetic.
  by apply: leq_mul known; rewrite leq_mul2l.
rewrite /cost /early -mulnn; move: (vertices W) (edges W) => n m; arithmetic.
Qed.
