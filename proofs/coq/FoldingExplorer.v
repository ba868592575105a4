(** The folding explorer: mapping with one directional marker that stays at the start, in fewer moves than
    Algorithm 1. Beyond Section 2.3; the terms are those of [docs/folding.md].

    The robot keeps a map of places that are distinct, as Algorithm 1 does, and a trail: a tree with a visit for
    each dart that it took when it did not know what is behind it. Visits are folded: it computes which of them
    are one place. Everything that the running explorer decides is an open choice here: the order of its
    conclusions, which dart it explores, which hypothesis it tests, by which walk, and the ways through the map
    and the trail. Definitions only; read from the end. *)

From mathcomp Require Import all_ssreflect.
From toposlam Require Import Spec Program Algorithm1 Folding.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * The trail, and how it is folded *)

(** A visit: the dart of an earlier visit over which the robot came, and what it perceived. The first visit is
    the start. A dart of the trail is the number of a visit and a door: see [Folding.v]. *)
Definition visit := (trail_dart * percept)%type.

(** For each visit the dart of the trail that stands for its entry dart: the same for visits that are one place,
    except for the door. *)
Definition classes := seq trail_dart.

(** An edge of the trail, by the visit that it leads to; and whether it is followed to that visit, or back. *)
Definition passage := (nat * bool)%type.

Section Trail.

Variable trail : seq visit.

Definition came_from (k : nat) : trail_dart := (nth ((0, 0), (0, Nothing)) trail k).1.
Definition perceived (k : nat) : percept := (nth ((0, 0), (0, Nothing)) trail k).2.

(** The darts at the two ends of an edge of the trail. *)
Definition from_dart (p : passage) : trail_dart := if p.2 then came_from p.1 else (p.1, 0).
Definition to_dart (p : passage) : trail_dart := if p.2 then (p.1, 0) else came_from p.1.

Definition is_passage (p : passage) : bool := 0 < p.1 < size trail.
Definition passages : seq passage :=
  [seq (k, true) | k <- iota 1 (size trail).-1] ++ [seq (k, false) | k <- iota 1 (size trail).-1].

(** The dart that stands for a dart. *)
Definition standing_for (f : classes) (x : trail_dart) : trail_dart :=
  let: (r, i) := nth (0, 0) f x.1 in (r, (x.2 + i) %% (perceived r).1).

(** Whether two percepts can be of one place, where door [a] of the one is door [b] of the other. *)
Definition agree (p q : percept) (a b : door) : bool :=
  (p.1 == q.1) &&
  match p.2, q.2 with
  | Nothing, Nothing => true
  | Pointing i, Pointing j => (i + b) %% p.1 == (j + a) %% p.1
  | _, _ => false
  end.

(** Makes two darts one, and so the visits at which they are; nothing, if that is a contradiction: the degrees
    or sightings differ, or a place would be turned onto itself. *)
Definition unite (f : classes) (x y : trail_dart) : option classes :=
  let: (r, a) := standing_for f x in
  let: (s, b) := standing_for f y in
  if r == s then if a == b then Some f else None
  else if agree (perceived r) (perceived s) a b then
    let g := (perceived r).1 in
    Some [seq if c.1 == s then (r, (c.2 + (a + g - b)) %% g) else c | c <- f]
  else None.

(** The far ends of the first two edges that begin at one dart and end at different ones. *)
Fixpoint first_conflict (ends : seq (trail_dart * trail_dart)) : option (trail_dart * trail_dart) :=
  if ends is (x, x') :: others then
    if [seq y.2 | y <- others & (y.1 == x) && (y.2 != x')] is y' :: _ then Some (x', y')
    else first_conflict others
  else None.

(** What follows: the far ends of one dart are one dart. Each union leaves one place less, so [fuel], the number
    of visits, suffices. *)
Fixpoint close fuel (f : classes) : option classes :=
  let ends := [seq (standing_for f (from_dart p), standing_for f (to_dart p)) | p <- passages] in
  if first_conflict ends is Some (x, y) then
    if fuel is fuel'.+1 then
      if unite f x y is Some f' then close fuel' f' else None
    else Some f
  else Some f.

(** Two darts become one, with all that follows. *)
Definition fold_with (f : classes) (x y : trail_dart) : option classes :=
  if unite f x y is Some f' then close (size trail) f' else None.

(** The door, with the degree, from one dart of the trail to another at the same place. *)
Definition between (f : classes) (x y : trail_dart) : option (door * nat) :=
  let: (r, a) := standing_for f x in
  let: (s, b) := standing_for f y in
  let g := (perceived r).1 in
  if r == s then Some ((b + g - a) %% g, g) else None.

(** The doors along some edges of the trail, and then out by the dart [x], for a robot with the pose [here]. *)
Fixpoint doors_through (f : classes) (here : trail_dart) (way : seq passage) (x : trail_dart) :
    option (seq (door * nat) * (door * nat)) :=
  if way is p :: way' then
    if (is_passage p, between f here (from_dart p)) is (true, Some step) then
      if doors_through f (to_dart p) way' x is Some (front, last) then Some (step :: front, last) else None
    else None
  else if between f here x is Some step then Some ([::], step) else None.

End Trail.

(** * What the robot knows *)

Record knowledge := Knowledge {
  (** The map: places that are distinct. *)
  known_map : partial_map;
  (** Each dart of the map, as a dart of the trail. *)
  in_trail : seq trail_dart;
  (** Darts of the map, with the far ends of their edges. *)
  far_ends : seq (nat * trail_dart);
  (** Pairs of darts of the map that are not the two ends of an edge, the lower one first. *)
  refuted : seq (nat * nat);
  trail : seq visit;
  folding : classes;
  (** The robot's pose, as a dart of the trail. *)
  here : trail_dart;
  (** The robot has come from this pose in the map, by these doors, each with the degree of its vertex. *)
  base : nat;
  strayed : seq (door * nat);
  (** The moves made so far. *)
  made : nat
}.

Section Knowledge.

Variable K : knowledge.

Let S := known_map K.

Definition dart_in_trail (d : nat) : trail_dart := nth (0, 0) (in_trail K) d.
Definition stands_for (x : trail_dart) : trail_dart := standing_for (trail K) (folding K) x.
Definition far_end (e : nat) : option trail_dart :=
  if [seq y.2 | y <- far_ends K & y.1 == e] is x :: _ then Some x else None.
Definition is_refuted (e h : nat) : bool := (minn e h, maxn e h) \in refuted K.

(** Whether the far end [x] of an edge can not be the dart [h] of the map: that would be a contradiction, or
    would make two places of the map one, or a dart its own opposite. *)
Definition contradicts (x : trail_dart) (h : nat) : bool :=
  if fold_with (trail K) (folding K) x (dart_in_trail h) is Some f then
    let same := fun y z => standing_for (trail K) f y == standing_for (trail K) f z in
    ~~ uniq [seq (standing_for (trail K) f (dart_in_trail d)).1 | d <- iota 0 (size S) & vertex S d == d]
    || has (fun p => same (from_dart (trail K) p) (to_dart (trail K) p)) (passages (trail K))
  else true.

(** Whether it follows that the dart [x] of the trail is opposite to the dart [entry] of the map if the far end
    [far] is the dart [h] of the map. *)
Definition predicts (far : trail_dart) (h : nat) (x : trail_dart) (entry : nat) : bool :=
  if fold_with (trail K) (folding K) far (dart_in_trail h) is Some f then
    let same := fun y z => standing_for (trail K) f y == standing_for (trail K) f z in
    has (fun p => same (from_dart (trail K) p) x && same (to_dart (trail K) p) (dart_in_trail entry))
      (passages (trail K))
  else false.

(** Whether it follows that the far end is that dart, if [x] is opposite to [entry]. *)
Definition confirms (far : trail_dart) (h : nat) (x : trail_dart) (entry : nat) : bool :=
  has (fun p =>
         (stands_for (from_dart (trail K) p) == stands_for (dart_in_trail entry)) &&
         (if fold_with (trail K) (folding K) x (to_dart (trail K) p) is Some f then
            standing_for (trail K) f far == standing_for (trail K) f (dart_in_trail h)
          else false))
    (passages (trail K)).

(** The pose in the map, after as many doors clockwise. *)
Definition turned (d : nat) (i : door) : nat := vertex S d + (d - vertex S d + i) %% doors S d.

(** The robot's pose when it has gone back to the map. *)
Definition pose_at_base : nat := if strayed K is step :: _ then turned (base K) step.1 else base K.

(** The robot's pose in a complete map. *)
Definition pose_in_map : nat :=
  foldl (fun pose step => let d := turned pose step.1 in odflt d (other S d)) (base K) (strayed K).

(** A way to a dart of the map: back to the map and then through it, by these darts; or along edges of the
    trail. *)
Inductive way := Home of seq nat | Through of seq passage.

(** The default. *)
Definition way_home (e : nat) : way :=
  Home (from_root S (tree_from S (vertex S pose_at_base)) (vertex S e)).

(** The number of moves. *)
Definition way_moves (w : way) : nat :=
  match w with Home path => size (strayed K) + size path | Through way => size way end.

(** The doors of a way, and the door out by the dart [e] of the map; nothing, if it does not lead there. *)
Definition doors_by (w : way) (e : nat) : option (seq door * door) :=
  match w with
  | Home path =>
      if leads S (vertex S pose_at_base) path (vertex S e) then
        Some (way_back (strayed K) ++ doors_along S pose_at_base path,
              door_to S (pose_behind S pose_at_base path) e)
      else None
  | Through way =>
      if doors_through (trail K) (folding K) (here K) way (dart_in_trail e) is Some (front, last)
      then Some (unzip1 front, last.1) else None
  end.

(** ** Conclusions *)

Definition with_far e x : knowledge :=
  Knowledge S (in_trail K) ((e, x) :: far_ends K) (refuted K) (trail K) (folding K) (here K) (base K) (strayed K)
    (made K).

Definition with_refuted e h : knowledge :=
  Knowledge S (in_trail K) (far_ends K) ((minn e h, maxn e h) :: refuted K) (trail K) (folding K) (here K) (base K)
    (strayed K) (made K).

(** The two darts are the ends of one edge. *)
Definition with_loop e h : knowledge :=
  Knowledge (with_edge S e h) (in_trail K) (far_ends K) (refuted K) (trail K) (folding K) (here K) (base K)
    (strayed K) (made K).

(** The far end [x] of an edge is a place that the map does not have. *)
Definition with_place e x : knowledge :=
  let g := (perceived (trail K) x.1).1 in
  Knowledge (with_edge (with_vertex S g) e (size S)) (in_trail K ++ [seq (x.1, x.2 + i) | i <- iota 0 g])
    (far_ends K) (refuted K) (trail K) (folding K) (here K) (base K) (strayed K) (made K).

(** The robot has made some moves: it has this pose in the map. *)
Definition located_at pose moves : knowledge :=
  Knowledge S (in_trail K) (far_ends K) (refuted K) (trail K) (folding K) (dart_in_trail pose) pose [::]
    (made K + moves).

(** The robot has gone out by the dart [x] of the trail, and perceives [seen]. If that is the marker, the visit
    is one of the marked vertex. *)
Definition arrived (x : trail_dart) seen base' strayed' moves : knowledge :=
  let k := size (trail K) in
  let trail' := rcons (trail K) (x, seen) in
  let f := rcons (folding K) (k, 0) in
  let folded' :=
    if seen.2 is Pointing j then fold_with trail' f (0, 0) (k, j) else close trail' (size trail') f in
  Knowledge S (in_trail K) (far_ends K) (refuted K) trail' (odflt f folded') (k, 0) base' strayed' (made K + moves).

End Knowledge.

(** * The explorer *)

(** The walk of a test: to the place that is tested, over its edge, and by a path of the map to the marker, as
    Algorithm 1 does; or along edges of the trail and out by a dart of it, and then to the marker as if the
    robot had come in by a dart of the map. *)
Inductive test :=
  | Strict of way & seq nat
  | Free of seq passage & trail_dart & nat & seq nat.

(** What the robot does next: it finds in its trail the far end of the edge of a dart of the map; or that two
    darts are the ends of one edge; or that a far end is a new place; it explores a dart; or it tests whether two
    darts are the ends of one edge. *)
Inductive action :=
  | Notice of nat & passage
  | Join of nat & nat
  | Add of nat
  | Explore of nat & way
  | Test of nat & nat & test.

Section Explorer.

(** Whether a way of so many moves may be taken, if there is one of so many. *)
Variable allowed : nat -> nat -> bool.

(** After so many moves all tests are strict. *)
Variable patience : partial_map -> nat.

Definition allowed_way (K : knowledge) (w : way) (e : nat) : bool :=
  (doors_by K w e != None) && allowed (way_moves K w) (way_moves K (way_home K e)).

Definition allowed_path (S : partial_map) (entry : nat) (path : seq nat) : bool :=
  leads S (vertex S entry) path 0 &&
  allowed (size path) (size (to_root S (tree_from S 0) (vertex S entry))).

Definition allowed_test (K : knowledge) (far : trail_dart) (e h : nat) (t : test) : bool :=
  match t with
  | Strict w path => allowed_way K w e && allowed_path (known_map K) h path
  | Free way x entry path =>
      [&& made K <= patience (known_map K), entry < size (known_map K),
          doors_through (trail K) (folding K) (here K) way x != None,
          x.1 < size (trail K), allowed (size way) (size (trail K)), allowed_path (known_map K) entry path,
          predicts K far h x entry & confirms K far h x entry]
  end.

Definition allowed_action (K : knowledge) (a : action) : bool :=
  let S := known_map K in
  let U := unexplored S in
  match a with
  | Notice e p =>
      [&& e \in U, far_end K e == None, is_passage (trail K) p
        & stands_for K (from_dart (trail K) p) == stands_for K (dart_in_trail K e)]
  | Join e h =>
      if far_end K e is Some x then
        [&& e \in U, h \in U & stands_for K x == stands_for K (dart_in_trail K h)]
      else false
  | Add e =>
      if far_end K e is Some x then
        (e \in U) && all (fun h => [|| h == e, is_refuted K e h | contradicts K x h]) U
      else false
  | Explore e w => [&& e \in U, far_end K e == None & allowed_way K w e]
  | Test e h t =>
      if far_end K e is Some x then
        [&& e \in U, h \in U, h != e, ~~ is_refuted K e h & allowed_test K x e h t]
      else false
  end.

(** An allowed action: the first dart of the map that is not explored is explored; or its far end is tested, with
    the first hypothesis that is left; or it is a new place. *)
Definition default_action (K : knowledge) : action :=
  let S := known_map K in
  let U := unexplored S in
  let e := head 0 U in
  if far_end K e is Some x then
    if [seq h <- U | (h != e) && ~~ is_refuted K e h] is h :: _ then
      Test e h (Strict (way_home K e) (to_root S (tree_from S 0) (vertex S h)))
    else Add e
  else Explore e (way_home K e).

(** The robot has come in, as it supposes, by the dart [pose] of the map, and perceives [seen]. It goes on by
    these darts of the map, until it perceives what it does not expect. *)
Fixpoint try (K : knowledge) pose seen darts : program (knowledge * option nat) :=
  let S := known_map K in
  if seen != expected S pose then Return (K, None)
  else if darts is d :: darts' then
    let i := door_to S pose d in
    let out := ((here K).1, (here K).2 + i) in
    let* seen' := move i in
    try (arrived K out seen' (base K) (rcons (strayed K) (i, seen.1)) 1) (odflt 0 (other S d)) seen' darts'
  else Return (K, Some pose).

(** Goes to a dart of the map and over its edge. *)
Definition go_over (K : knowledge) (w : way) (e : nat) : program (knowledge * percept) :=
  let: (front, last) := odflt ([::], 0) (doors_by K w e) in
  moves front ;;
  let* seen := move last in
  Return (arrived K (dart_in_trail K e) seen e [:: (0, doors (known_map K) e)] (size front).+1, seen).

(** Goes along edges of the trail, and out by a dart of it. *)
Definition go_through (K : knowledge) (way : seq passage) (x : trail_dart) : program (knowledge * percept) :=
  let: (front, last) := odflt ([::], (0, 0)) (doors_through (trail K) (folding K) (here K) way x) in
  moves (unzip1 front) ;;
  let* seen := move last.1 in
  Return (arrived K x seen (base K) (rcons (strayed K ++ front) last) (size front).+1, seen).

(** The end of a test: if the robot came to the marker as it expected, the hypothesis is true. *)
Definition conclude (e h : nat) (ended : knowledge * option nat) : knowledge :=
  let: (K, came_to) := ended in
  if came_to is Some pose then with_loop (located_at K pose 0) e h else with_refuted K e h.

Definition perform (K : knowledge) (a : action) : program knowledge :=
  match a with
  | Notice e p => Return (with_far K e (to_dart (trail K) p))
  | Join e h => Return (with_loop K e h)
  | Add e => if far_end K e is Some x then Return (with_place K e x) else Return K
  | Explore e w => let* after := go_over K w e in Return (with_far after.1 e (here after.1))
  | Test e h (Strict w path) =>
      let* after := go_over K w e in
      let* ended := try after.1 h after.2 path in
      Return (conclude e h ended)
  | Test e h (Free way x entry path) =>
      let* after := go_through K way x in
      let* ended := try after.1 entry after.2 path in
      Return (conclude e h ended)
  end.

(** Until the map is complete. The number of actions is limited; the answer is [None] if they do not suffice. *)
Fixpoint explorer_actions bound (K : knowledge) : program (option (partial_map * nat)) :=
  if unexplored (known_map K) is [::] then Return (Some (known_map K, pose_in_map K)) else
  if bound is bound'.+1 then
    let* a := choose (allowed_action K) (default_action K) in
    let* K' := perform K a in
    explorer_actions bound' K'
  else Return None.

(** At the marker the robot perceives [seen]: the map is its vertex, the trail one visit. *)
Definition known_at_start (seen : percept) : knowledge :=
  Knowledge (with_vertex [::] seen.1) [seq (0, i) | i <- iota 0 seen.1] [::] [::] [:: ((0, 0), seen)] [:: (0, 0)]
    (0, 0) 0 [::] 0.

(** The answer is the map and the robot's pose in it. *)
Definition folding_explorer bound (seen : percept) : program (option (partial_map * nat)) :=
  explorer_actions bound (known_at_start seen).

End Explorer.

(** Any ways; and ways that are not longer than necessary. *)
Definition any_length : nat -> nat -> bool := fun _ _ => true.
Definition no_longer : nat -> nat -> bool := fun moves necessary => moves <= necessary.

(** After 4 n m + 200 moves, for a map with n vertices and 2 m darts, all tests are strict. *)
Definition usual_patience : partial_map -> nat := fun S => 2 * known_vertices S * size S + 200.
