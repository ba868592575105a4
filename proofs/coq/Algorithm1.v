(** Algorithm 1: mapping with one directional marker that stays at the start. Section 2.3.

    The numbers are those of the printed lines. Coq needs the inner parts first, so read from the end:
    [algorithm1] is lines 1 to 3, [rounds] line 4, [explore] 5 to 23, [try_all] 8 to 17, [validate] 11 to 17.
    U is computed from S: the darts whose other end is not known. So lines 5, 20 and 23 change U by changing
    S. The open choices of the paper stay open: the edge of line 5, the hypothesis of line 9, the paths of
    lines 6 and 10; so does the test of a hypothesis at lines 7 and 13. The defaults are those of toposlam.
    Definitions only. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * The map S *)

(** A known dart: the first dart of its vertex, by which the robot first came there; the degree of its
    vertex; and the other end of its edge, if that is explored.

    Darts are numbered as they become known: those of a vertex together, clockwise from the first. The
    start vertex has the first numbers, from the facing dart, which is dart 0. A vertex is named by its
    first dart. *)
Record known := Known { first_of : nat; doors_of : nat; other_of : option nat }.

Definition partial_map := seq known.

Section Map.

Variable S : partial_map.

Definition nowhere := Known 0 0 None.
Definition vertex d := first_of (nth nowhere S d).
Definition doors d := doors_of (nth nowhere S d).
Definition other d := other_of (nth nowhere S d).

(** U, the unexplored darts. *)
Definition unexplored := [seq d <- iota 0 (size S) | other d == None].

(** The number of known vertices. *)
Definition known_vertices := count (fun d => vertex d == d) (iota 0 (size S)).

(** The door that leads to the dart [d] for a robot that came in by [pose], at the same vertex. *)
Definition door_to pose d : door := (d + doors pose - pose) %% doors pose.

(** The percept that the robot expects after it comes in by this dart. *)
Definition expected pose : percept :=
  (doors pose, if vertex pose == 0 then Pointing (door_to pose 0) else Nothing).

(** Whether these darts, one after the other, lead from one vertex to another. *)
Fixpoint leads v darts v' :=
  if darts is d :: darts' then
    (vertex d == v) && (if other d is Some d' then leads (vertex d') darts' v' else false)
  else v == v'.

(** The dart that is this number of doors clockwise from [d]. *)
Definition turned_to d (i : door) := vertex d + (d - vertex d + i) %% doors d.

(** The pose behind these darts. *)
Definition pose_behind pose darts := foldl (fun pose d => odflt pose (other d)) pose darts.

(** The doors for these darts, for a robot with this pose. *)
Fixpoint doors_along pose darts : seq door :=
  if darts is d :: darts' then door_to pose d :: doors_along (odflt pose (other d)) darts' else [::].

(** The map with one more vertex, whose darts are all unexplored. *)
Definition with_vertex degree : partial_map := S ++ nseq degree (Known (size S) degree None).

Definition set_other d d' : partial_map := set_nth nowhere S d (Known (vertex d) (doors d) (Some d')).

(** * Shortest paths *)

(** A tree of shortest paths, breadth-first: for each vertex reached the dart there that leads towards the
    root, in the order in which they were reached; at its head stands the root itself. *)
Definition look_around (tree : seq nat) v :=
  foldl (fun tree d =>
           if other d is Some d' then
             if vertex d' \in map vertex tree then tree else rcons tree d'
           else tree)
    tree (iota v (doors v)).

Fixpoint grow fuel i tree :=
  if fuel is fuel'.+1 then
    if i < size tree then grow fuel' i.+1 (look_around tree (vertex (nth 0 tree i))) else tree
  else tree.

Definition tree_from root := grow (size S) 0 [:: root].

(** The darts of the path from [v] to the root. *)
Fixpoint up fuel tree v :=
  if fuel is fuel'.+1 then
    let i := index v (map vertex tree) in
    if i == 0 then [::]
    else let d := nth 0 tree i in d :: up fuel' tree (vertex (odflt 0 (other d)))
  else [::].

Definition to_root tree v := up (size tree) tree v.

(** The darts of the path from the root to [v]. *)
Definition from_root tree v := rev [seq odflt 0 (other d) | d <- to_root tree v].

(** The dart whose vertex is the fewest edges from the root; the first one of several. *)
Definition nearest tree darts :=
  foldl (fun best d =>
           if size (to_root tree (vertex d)) < size (to_root tree (vertex best)) then d else best)
    (head 0 darts) darts.

End Map.

(** The map with two darts as the ends of one edge. *)
Definition with_edge (S : partial_map) d d' : partial_map := set_other (set_other S d d') d' d.

(** * The test of a hypothesis *)

(** How a robot decides about a hypothesis.
    - [raised S h seen]: line 7, whether there is a hypothesis that it came in by the dart [h], if it perceives
      [seen].
    - [matches S pose ends seen]: line 13, whether [seen] matches the percept expected after it comes in by the
      dart [pose]; [ends] means that the path ends there.
    - [goes_on]: whether it goes on after a percept that does not match, as far as the doors of the path exist;
      otherwise it turns back there. *)
Record hypothesis_test := HypothesisTest {
  raised : partial_map -> nat -> percept -> bool;
  matches : partial_map -> nat -> bool -> percept -> bool;
  goes_on : bool
}.

(** As printed: a hypothesis for each edge in U. The robot traverses the path if it can, and compares the
    degrees along it. At the end it also compares the marker with its direction. *)
Definition as_printed : hypothesis_test :=
  HypothesisTest (fun _ _ _ => true)
    (fun S pose ends seen => if ends then seen == expected S pose else seen.1 == (expected S pose).1) true.

(** As in toposlam: whole percepts are compared, so the marker must also be absent where it is expected to be
    absent. The percept on arrival is the first to be compared: a hypothesis that it contradicts is not raised.
    The robot turns back at the first mismatch. *)
Definition step_by_step : hypothesis_test :=
  HypothesisTest (fun S h seen => seen == expected S h) (fun S pose _ seen => seen == expected S pose) false.

(** A test is valid if it accepts what is expected, and at the end of a path nothing else. *)
Record valid (test : hypothesis_test) : Prop := Valid {
  raises_expected : forall S h, raised test S h (expected S h);
  matches_expected : forall S pose ends, matches test S pose ends (expected S pose);
  matches_at_end : forall S pose seen, matches test S pose true seen -> seen = expected S pose
}.

(** * The algorithm *)

Section Algorithm1.

Variable test : hypothesis_test.

(** The paths through the map that may be chosen at lines 6 and 10, among those that lead to their goals.
    *)
Variable allowed : partial_map -> seq nat -> bool.

(** The end of a hypothesis: confirmed, and the robot has this pose in the map; or rejected, and the robot is
    back, turned by this door. *)
Inductive verdict := Confirmed of nat | Rejected of door.

(** The robot's new place: the dart of a confirmed hypothesis, and the robot's pose; or a new vertex, where
    the robot stands, turned by this door. *)
Inductive outcome := Loop of nat & nat | New of door.

(** Lines 11 to 17, on the way. The robot should be at [pose], and leaves by these darts. [matched]: all
    percepts have matched so far. It stands at a vertex of this degree, turned by [turned]; [taken] are the
    doors of the path so far, with the degrees of their vertices. *)
Fixpoint follow (S : partial_map) (matched : bool) degree turned pose darts taken : program verdict :=
  (* 14, 15: reject the hypothesis, retrace the path. *)
  let reject := moves (way_back taken) ;; Return (Rejected (head (turned, 0) taken).1) in
  if darts is d :: darts' then
    let i := door_to S pose d in
    let pose' := odflt 0 (other S d) in
    if (matched || goes_on test) && (i < degree) then
      (* 11: try to traverse the path. *)
      let* seen := move ((i + degree - turned) %% degree) in
      (* 12, 13: compare the percept with the expected one. *)
      let matched' := matched && matches test S pose' (nilp darts') seen in
      follow S matched' seen.1 0 pose' darts' (rcons taken (i, degree))
    else reject
  (* 16, 17: confirm the hypothesis, if the percepts match throughout. *)
  else if matched then Return (Confirmed (turned_to S pose turned)) else reject.

(** Lines 11 to 17: the hypothesis [h] and its path. The robot perceived [seen] when it came to the place, and
    has turned by [turned] since. *)
Definition validate (S : partial_map) (seen : percept) turned h path : program verdict :=
  follow S (matches test S h (nilp path) seen) seen.1 turned h path [::].

(** Lines 8 to 17, for hypotheses [H]; each is the unexplored dart by which the robot would have come in.
    [fuel], the number of hypotheses, shows Coq that this ends. *)
Fixpoint try_all fuel (S : partial_map) (seen : percept) turned H : program outcome :=
  let tree := tree_from S 0 in
  (* 8: while H is not empty. *)
  if H is [::] then Return (New turned) else
  if fuel is fuel'.+1 then
    (* 9: remove a hypothesis from H. *)
    let* h := choose_among H (nearest S tree H) in
    (* 10: a path to v0; the percepts along it should be [expected]. *)
    let* path := choose (fun path => leads S (vertex S h) path 0 && allowed S path)
                   (to_root S tree (vertex S h)) in
    (* 11 to 17. *)
    let* ended := validate S seen turned h path in
    match ended with
    | Confirmed pose => Return (Loop h pose)
    | Rejected turned' => try_all fuel' S seen turned' (rem h H)
    end
  else Return (New turned).

(** Lines 5 to 23: one round. The robot is at [pose] in the map [S]. *)
Definition explore (S : partial_map) pose : program (partial_map * nat) :=
  let U := unexplored S in
  let tree := tree_from S (vertex S pose) in
  (* 5: remove an unexplored edge from U. *)
  let* e := choose_among U (nearest S tree U) in
  (* 6: traverse S to its known end, then follow it to its unknown end. *)
  let* path := choose (fun path => leads S (vertex S pose) path (vertex S e) && allowed S path)
                 (from_root S tree (vertex S e)) in
  moves (doors_along S pose path) ;;
  let* seen := move (door_to S (pose_behind S pose path) e) in
  (* 7: the hypotheses. *)
  let H := [seq h <- U | (h != e) && raised test S h seen] in
  (* 8 to 17. *)
  let* became := try_all (size H) S seen 0 H in
  match became with
  (* 18, 19, 20: a known vertex. *)
  | Loop h pose' => Return (with_edge S e h, pose')
  (* 21, 22, 23: a new vertex. *)
  | New turned => Return (with_edge (with_vertex S seen.1) e (size S), size S + turned)
  end.

(** Lines 4 to 23: while U is not empty. With wrong percepts the loop could be endless, so the number of
    rounds is limited; the answer is [None] if they do not suffice. *)
Fixpoint rounds bound (S : partial_map) pose : program (option (partial_map * nat)) :=
  (* return S. *)
  if unexplored S is [::] then Return (Some (S, pose)) else
  if bound is bound'.+1 then
    let* after := explore S pose in
    rounds bound' after.1 after.2
  else Return None.

(** The marker lies at v0 (line 1), where the robot perceives [seen]: S is v0 (line 2), U its edges (line
    3). The answer is the map S and the robot's pose in it. *)
Definition algorithm1 bound (seen : percept) : program (option (partial_map * nat)) :=
  rounds bound (with_vertex [::] seen.1) 0.

End Algorithm1.

(** Any path is allowed. *)
Definition any_path : partial_map -> seq nat -> bool := fun _ _ => true.

(** Paths with fewer darts than there are known vertices. *)
Definition short_paths : partial_map -> seq nat -> bool := fun S path => size path < known_vertices S.

(** * The map as a world *)

(** A world, and the robot's pose in it. *)
Record located := Located { world :> start; robot : world }.

Section Drawn.

Variable S : partial_map.

Definition drawn_opposite (d : 'I_(size S)) : 'I_(size S) := insubd d (odflt (d : nat) (other S d)).
Definition drawn_clockwise (d : 'I_(size S)) : 'I_(size S) :=
  insubd d (vertex S d + (d - vertex S d).+1 %% doors S d).

(** Whether the known darts are all the darts of some world. *)
Definition is_drawn :=
  [&& [forall d, drawn_opposite (drawn_opposite d) == d], [forall d, drawn_opposite d != d],
      injectiveb drawn_clockwise
    & [forall d, forall e,
        connect (fun x y => (y == drawn_opposite x) || (y == drawn_clockwise x)) d e]].

Lemma drawn_oppositeK : is_drawn -> involutive drawn_opposite.
Proof. by case/and4P=> /forallP H _ _ _ d; apply/eqP. Qed.

Lemma drawn_opposite_neq : is_drawn -> forall d, drawn_opposite d != d.
Proof. by case/and4P=> _ /forallP. Qed.

Lemma drawn_clockwise_inj : is_drawn -> injective drawn_clockwise.
Proof. by case/and4P=> _ _ /injectiveP. Qed.

Lemma drawn_connected : is_drawn -> forall d e,
  connect (fun x y => (y == drawn_opposite x) || (y == drawn_clockwise x)) d e.
Proof. by case/and4P=> _ _ _ /forallP H d; apply/forallP. Qed.

Definition drawn_graph (ok : is_drawn) : embedded_graph :=
  EmbeddedGraph (drawn_oppositeK ok) (drawn_opposite_neq ok) (drawn_clockwise_inj ok) (drawn_connected ok).

(** The world that a map describes, if it describes one, and the robot where it believes it is. *)
Definition drawn (pose : nat) : option located :=
  match @idP is_drawn, @idP (0 < size S) with
  | ReflectT ok, ReflectT begun =>
      let facing : drawn_graph ok := Ordinal begun in
      Some (@Located (@Start (drawn_graph ok) facing) (insubd facing pose))
  | _, _ => None
  end.

End Drawn.

(** The answer is a map isomorphic to the world as a start, and the robot is where it believes it is. *)
Definition right_answer (W : start) (answer : option (partial_map * nat)) (pose : W) :=
  exists S p map, [/\ answer = Some (S, p), p < size S, drawn S p = Some map
    & exists f : map -> W, [/\ isomorphism f, f (facing map) = facing W & f (robot map) = pose]].
