(** Definitions only: the checker of proofs of verdicts, a program without any search. It is extracted with binary
    numbers and tables of the standard library, and its functions on long lists call themselves last, so that it
    checks long walks fast. What an accepted claim says is in [Verdicts.v]. *)

From Coq Require Import BinNat FMapPositive.
From mathcomp Require Import all_ssreflect.
From toposlam Require Import Verdicts.

Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.

(** * Tables by number *)

Definition table := PositiveMap.t.

Definition empty {A} : table A := PositiveMap.empty A.
Definition find A (t : table A) (n : N) : option A := PositiveMap.find (N.succ_pos n) t.
Definition put A (t : table A) (n : N) (a : A) : table A := PositiveMap.add (N.succ_pos n) a t.

Definition has_entry A (t : table A) (n : N) : bool := if find t n is Some _ then true else false.

(** A table of a list, by the places in it. *)
Definition table_of A (s : seq A) : table A :=
  (foldl (fun t_n a => (put t_n.1 t_n.2 a, N.succ t_n.2)) (empty, N0) s).1.

Definition length A (s : seq A) : N := foldl (fun n _ => N.succ n) N0 s.

(** Whether something is true of all numbers from [i] on and below [n]. Not more of them are tried than a list is
    long. *)
Fixpoint all_below T (fuel : seq T) (i n : N) (test : N -> bool) : bool :=
  if N.eqb i n then true
  else if fuel is _ :: fuel then if test i then all_below fuel (N.succ i) n test else false else false.

(** * Why something is not proved *)

(** The vertices and edges of a world, by the number of the world; a visit of the walk; a part of the claim, in the
    order of its lines; or the claim. *)
Inductive place := InWorld of N | AtVisit of N | AtPart of N | InClaim.

Inductive reason :=
  (* A world. *)
  | NoEdge | DartTwice of N | NoDart of N | EdgesDiffer of N | NotConnected of N | TablesWrong
  (* What a claim needs. *)
  | WrongParts | OnlyDirectional | NothingClaimed
  (* A walk. *)
  | DegreeIs of N | SightingDiffers | DoorMissing of N | LengthsDiffer | GivesAll of N
  (* Steps. *)
  | NoVisit of N | NoMove of N | NoDoor of N & N | NotPointing of N | NotOne | TwoDoors | OtherDegree
  | Open of N & N
  (* Contradictions. *)
  | NoContradiction | NotOneVertex
  (* Pairs, images and poses. *)
  | PerceptsDiffer of N & N | NoPair of N & N | PerceptsSame | NoImage of N | NotKept of N
  | ImageShared of N | ImageTwice | WalksTooMany
  | PosesLeftOut of N | OtherPose of N
  (* Visits. *)
  | NoAlternative of N | NotSo | VisitsMade | ChoiceMissing.

Inductive outcome := Accepted | Refused of place & reason.

(** * Worlds *)

Record tables := Tables {
  (* Of each dart: the dart at the other end of its edge; the next dart clockwise; and where it stands in the
     list of all darts, vertex by vertex: the first place of its vertex, the degree, its own place from there. *)
  opposite_of : table N;
  next_of : table N;
  stand_of : table (N * N * N);
  (* The dart at each place of this list. *)
  dart_at : table N;
  (* The darts in any order, also as a table. *)
  dart_list : seq N;
  dart_set : table unit;
  facing_dart : N
}.

Definition opposite_in (T : tables) (d : N) : N := odflt d (find (opposite_of T) d).
Definition stand_in (T : tables) (d : N) : N * N * N := odflt (N0, N0, N0) (find (stand_of T) d).
Definition degree_in (T : tables) (d : N) : N := (stand_in T d).1.2.

Definition turn_in (T : tables) (d i : N) : N :=
  let: (first, degree, j) := stand_in T d in
  odflt d (find (dart_at T) (N.add first (N.modulo (N.add j i) degree))).

Definition traverse_in (T : tables) (d i : N) : N := opposite_in T (turn_in T d i).

(** For each pair of a dart and the next one clockwise in a line. *)
Fixpoint fold_around_from A (f : A -> N -> N -> A) (first d : N) (others : seq N) (a : A) : A :=
  if others is e :: others then fold_around_from f first e others (f a d e) else f a d first.
Definition fold_around A (f : A -> N -> N -> A) (a : A) (line : seq N) : A :=
  if line is d :: others then fold_around_from f d d others a else a.

Definition numbers_in (lines : seq (seq N)) : seq N := foldl (fun s line => catrev line s) [::] lines.

Definition set_of (s : seq N) : table unit := foldl (fun t d => put t d tt) empty s.

Definition opposites_of (edges : seq (N * N)) : table N :=
  foldl (fun t edge => put (put t edge.1 edge.2) edge.2 edge.1) empty edges.

Definition nexts_of (lines : seq (seq N)) : table N := foldl (fold_around (fun t d e => put t d e)) empty lines.

(** The tables [stand_of] and [dart_at]. *)
Definition stands_of (lines : seq (seq N)) : table (N * N * N) * table N :=
  let place_line state line :=
    let: (stands, at_places, first) := state in
    let degree := length line in
    let: (stands, at_places, _) :=
      foldl (fun '(stands, at_places, j) d =>
               (put stands d (first, degree, j), put at_places (N.add first j) d, N.succ j))
            (stands, at_places, N0) line in
    (stands, at_places, N.add first degree) in
  (foldl place_line (empty, empty, N0) lines).1.

Definition tables_of (t : world_text) : tables :=
  let darts := numbers_in (vertex_lines t) in
  let: (stands, at_places) := stands_of (vertex_lines t) in
  Tables (opposites_of (edge_lines t)) (nexts_of (vertex_lines t)) stands at_places darts (set_of darts)
    (facing_line t).

(** The darts that are found from those of a list over edges and around vertices. *)
Fixpoint reach (T : tables) (fuel : seq N) (found : table unit) (next : seq N) : table unit :=
  if fuel is _ :: fuel then
    if next is d :: next then
      if has_entry found d then reach T fuel found next
      else reach T fuel (put found d tt)
             (opposite_in T d :: odflt d (find (next_of T) d) :: next)
    else found
  else found.

(** As long as the darts twice, and one more. *)
Definition reached (T : tables) : table unit :=
  reach T (facing_dart T :: catrev (dart_list T) (dart_list T)) empty [:: facing_dart T].

(** Whether the tables are right at a dart. *)
Definition right_at (T : tables) (d : N) : bool :=
  match find (stand_of T) d, find (opposite_of T) d, find (next_of T) d with
  | Some (first, degree, j), Some o, Some e =>
      let next := N.modulo (N.succ j) degree in
      if find (stand_of T) e is Some (first', degree', j') then
        [&& N.ltb j degree, first' == first, degree' == degree, j' == next,
            find (dart_at T) (N.add first j) == Some d,
            find (dart_at T) (N.add first next) == Some e,
            find (opposite_of T) o == Some d, o != d & has_entry (dart_set T) o]
      else false
  | _, _, _ => false
  end.

Definition tables_right (t : world_text) (T : tables) : bool :=
  [&& has_entry (dart_set T) (facing_dart T),
      all (right_at T) (dart_list T),
      all (fun edge => (find (opposite_of T) edge.1 == Some edge.2) && (find (opposite_of T) edge.2 == Some edge.1))
        (edge_lines t)
    & foldl (fold_around (fun right d e => if right then find (next_of T) d == Some e else false)) true
        (vertex_lines t)].

(** The first dart of a list without a property. *)
Fixpoint first_not (test : N -> bool) (s : seq N) : option N :=
  if s is d :: s then if test d then first_not test s else Some d else None.

Fixpoint first_twice (seen : table unit) (s : seq N) : option N :=
  if s is d :: s then if has_entry seen d then Some d else first_twice (put seen d tt) s else None.

(** What is wrong with a world, if anything. *)
Definition wrong_world (t : world_text) (T : tables) : option reason :=
  let n := length (dart_list T) in
  let edge_darts := foldl (fun s edge => edge.1 :: edge.2 :: s) [::] (edge_lines t) in
  if edge_darts is [::] then Some NoEdge
  else if first_twice empty (dart_list T) is Some d then Some (DartTwice d)
  else if first_not (fun d => N.ltb d n) (dart_list T) is Some d then Some (NoDart d)
  else if first_twice empty edge_darts is Some d then Some (EdgesDiffer d)
  else if first_not (has_entry (set_of edge_darts)) (dart_list T) is Some d then Some (EdgesDiffer d)
  else if first_not (has_entry (dart_set T)) edge_darts is Some d then Some (NoDart d)
  else if ~~ has_entry (dart_set T) (facing_line t) then Some (NoDart (facing_line t))
  else if ~~ tables_right t T then Some TablesWrong
  else if first_not (has_entry (reached T)) (dart_list T) is Some d then Some (NotConnected d)
  else None.

(** * Percepts in a world *)

Definition same_vertex_in (T : tables) (d e : N) : bool := (stand_in T d).1.1 == (stand_in T e).1.1.

(** The door by which a dart leads to another one of its vertex. *)
Definition door_in (T : tables) (d e : N) : N :=
  N.modulo (N.add (stand_in T e).2 (N.sub (degree_in T d) (stand_in T d).2)) (degree_in T d).

Definition sighting_in (T : tables) (marker : marker_word) (d : N) : sighting_word :=
  let facing := facing_dart T in
  let beyond := opposite_in T facing in
  match marker with
  | WordNone => WordNothing
  | WordUndirected => if same_vertex_in T d facing then WordLying else WordNothing
  | WordDirectional => if same_vertex_in T d facing then WordPointing (door_in T d facing) else WordNothing
  | WordUndirectedEdge => if (d == facing) || (d == beyond) then WordPassed else WordNothing
  | WordDirectedEdge => if d == facing then WordAgainst else if d == beyond then WordAlong else WordNothing
  | WordTwoIdentical =>
      match same_vertex_in T d facing, same_vertex_in T d beyond with
      | true, true => WordTwo
      | true, false | false, true => WordLying
      | false, false => WordNothing
      end
  | WordTwoDistinct =>
      match same_vertex_in T d facing, same_vertex_in T d beyond with
      | true, true => WordBoth
      | true, false => WordFirst
      | false, true => WordSecond
      | false, false => WordNothing
      end
  end.

Definition same_sighting (s s' : sighting_word) : bool :=
  match s, s' with
  | WordPointing i, WordPointing j => i == j
  | WordNothing, WordNothing | WordLying, WordLying | WordTwo, WordTwo | WordFirst, WordFirst
  | WordSecond, WordSecond | WordBoth, WordBoth | WordPassed, WordPassed | WordAlong, WordAlong
  | WordAgainst, WordAgainst => true
  | _, _ => false
  end.

(** The first visit at which a walk from a dart has another percept, or takes a door that does not exist. *)
Fixpoint differs (T : tables) (marker : marker_word) (visit d : N) (seen : seq (N * sighting_word)) (doors : seq N) :
    option (N * reason) :=
  match seen, doors with
  | (degree, sighting) :: seen, _ =>
      if degree != degree_in T d then Some (visit, DegreeIs (degree_in T d))
      else if ~~ same_sighting sighting (sighting_in T marker d) then Some (visit, SightingDiffers)
      else match seen, doors with
           | _ :: _, i :: doors =>
               if N.ltb i degree then differs T marker (N.succ visit) (traverse_in T d i) seen doors
               else Some (visit, DoorMissing i)
           | [::], [::] => None
           | _, _ => Some (visit, LengthsDiffer)
           end
  | _, _ => Some (visit, LengthsDiffer)
  end.

(** Those of some poses, each with the dart at which it began, that have the percepts of a walk from here on. *)
Fixpoint remain (T : tables) (marker : marker_word) (poses : seq (N * N)) (seen : seq (N * sighting_word))
    (doors : seq N) : seq (N * N) :=
  match poses, seen with
  | [::], _ => [::]
  | _, [::] => poses
  | _, (degree, sighting) :: seen =>
      let fits d := (degree == degree_in T d) && same_sighting sighting (sighting_in T marker d) in
      match doors with
      | [::] => foldl (fun left pose => if fits pose.2 then pose :: left else left) [::] poses
      | i :: doors =>
          remain T marker
            (foldl (fun left pose =>
                      if fits pose.2 && N.ltb i degree then (pose.1, traverse_in T pose.2 i) :: left else left)
               [::] poses)
            seen doors
      end
  end.

(** * Runs with a marker that is carried *)

Section Runs.

Variables (T : tables) (aid : aid_word).

(** Whether the marker lies where the robot is. It lies at the vertex of a dart, or the robot carries it. *)
Definition lies_in (d : N) (place : option N) : bool := if place is Some spot then same_vertex_in T d spot else false.

Definition aid_seen_in (d : N) (place : option N) : sighting_word :=
  if place is Some spot then
    if same_vertex_in T d spot then
      match aid with WordMovable => WordLying | WordMovableDirectional => WordPointing (door_in T d spot) end
    else WordNothing
  else WordNothing.

Definition senses_in (d : N) (place : option N) (seen : N * sighting_word) : bool :=
  (seen.1 == degree_in T d) && same_sighting seen.2 (aid_seen_in d place).

(** The pose, and the place of the marker, after what was done, if that is possible. *)
Definition after_deed (d : N) (place : option N) (done : deed) : option (N * option N) :=
  match done with
  | DeedDoor i => if N.ltb i (degree_in T d) then Some (traverse_in T d i, place) else None
  | DeedPickUp => if lies_in d place then Some (d, None) else None
  | DeedDrop => if place is None then Some (d, Some d) else None
  end.

(** The first deed from here on, with its number, that is not possible, or after which the robot perceives something
    else. *)
Fixpoint wrong_deed (number : N) (d : N) (place : option N) (deeds : seq (deed * option (N * sighting_word))) :
    option N :=
  if deeds is (done, seen) :: others then
    if after_deed d place done is Some (e, place') then
      if (if seen is Some seen then senses_in e place' seen else true) then wrong_deed (N.succ number) e place' others
      else Some number
    else Some number
  else None.

(** From this pose: the number of the first thing in the run that is wrong, where 0 is what it perceived at first. *)
Definition wrong_in_run (r : run_text) (d : N) : option N :=
  let place := Some (facing_dart T) in
  if senses_in d place (first_see r) then wrong_deed 1%num d place (deed_lines r) else Some N0.

End Runs.

(** * Visits *)

Section Visits.

Variables (T : tables) (marker : marker_word).

Definition has_percept (d : N) (seen : N * sighting_word) : bool :=
  (seen.1 == degree_in T d) && same_sighting seen.2 (sighting_in T marker d).

(** The poses behind the doors from [i] on and below [n]. *)
Fixpoint behind_doors (fuel : seq N) (i n d : N) (poses : seq N) : seq N :=
  if i == n then poses
  else if fuel is _ :: fuel then behind_doors fuel (N.succ i) n d (traverse_in T d i :: poses)
  else poses.

(** The poses with which a robot can come to the next vertex. *)
Definition onward (back last : bool) (a : alternative) (d : N) : seq N :=
  match a with
  | NoVertex => [:: if back then opposite_in T d else d]
  | Junction seen door =>
      if ~~ has_percept d seen then [::]
      else if door is Some i then if N.ltb i seen.1 then [:: traverse_in T d i] else [::]
      else if last then [:: d]
      else behind_doors (dart_list T) N0 seen.1 d [::]
  end.

(** A list without repetition, with the table of what is in it. *)
Definition add_pose (poses : seq N * table unit) (d : N) : seq N * table unit :=
  if has_entry poses.2 d then poses else (d :: poses.1, put poses.2 d tt).

(** The poses after a visit of a robot with one of some poses. *)
Definition after_visit (v : visit_text) (last : bool) (poses : seq N) : seq N :=
  (foldl (fun found d =>
            foldl (fun found a => foldl add_pose found (onward (turned_back v) last a d)) found (alternatives v))
     ([::], empty) poses).1.

Fixpoint after_visits (visits : seq visit_text) (poses : seq N) : seq N :=
  if visits is v :: others then
    if poses is [::] then [::] else after_visits others (after_visit v (nilp others) poses)
  else poses.

(** The pose after a visit, with what was chosen for it. *)
Definition chosen (back last : bool) (a : alternative) (door : option N) (d : N) : option N :=
  match a, door with
  | NoVertex, None => Some (if back then opposite_in T d else d)
  | Junction seen known, _ =>
      if ~~ has_percept d seen then None
      else
        match known, door with
        | Some i, None => if N.ltb i seen.1 then Some (traverse_in T d i) else None
        | None, Some i => if last then None else if N.ltb i seen.1 then Some (traverse_in T d i) else None
        | None, None => if last then Some d else None
        | _, _ => None
        end
  | _, _ => None
  end.

Fixpoint alternative_at (alternatives : seq alternative) (n : N) : option alternative :=
  if alternatives is a :: others then if n == N0 then Some a else alternative_at others (N.pred n) else None.

Fixpoint wrong_choice (part : N) (visits : seq visit_text) (choices : seq (N * option N)) (d : N) :
    option (N * reason) :=
  match visits, choices with
  | v :: visits, (n, door) :: choices =>
      if alternative_at (alternatives v) n is Some a then
        if chosen (turned_back v) (nilp visits) a door d is Some e then wrong_choice (N.succ part) visits choices e
        else Some (part, NotSo)
      else Some (part, NoAlternative n)
  | [::], [::] => None
  | _, _ => Some (part, LengthsDiffer)
  end.

End Visits.

(** * Steps *)

(** A dart of the walk: a visit, and the door that leads to the dart. *)
Notation walk_dart := (N * N)%type.

(** The walk as tables. *)
Record walked := Walked {
  walk_of : walk_text;
  percept_at : table (N * sighting_word);
  door_at : table N;
  visits : N;
  moves : N
}.

Definition walked_of (w : walk_text) : walked :=
  Walked w (table_of (see_lines w)) (table_of (door_lines w)) (length (see_lines w)) (length (door_lines w)).

(** What is known: each visit's label, which is another visit and the door that leads from there to the entry dart of
    this one; and the visits of each vertex, by the visit that stands for it, with their number. A visit without an
    entry stands for itself. *)
Record knowledge := Knowledge {
  labels : table walk_dart;
  members : table (N * seq N)
}.

Definition nothing_known := Knowledge empty empty.

Section Steps.

Variables (marker : marker_word) (w : walked).

Definition degree_at (visit : N) : N := if find (percept_at w) visit is Some (degree, _) then degree else N0.
Definition sighting_at (visit : N) : sighting_word :=
  if find (percept_at w) visit is Some (_, sighting) then sighting else WordNothing.

Definition label (k : knowledge) (visit : N) : walk_dart := odflt (visit, N0) (find (labels k) visit).

Definition class (k : knowledge) (visit : N) : N * seq N := odflt (1%num, [:: visit]) (find (members k) visit).

(** Darts of the walk that are known to be one have the same name. *)
Definition name_of (k : knowledge) (x : walk_dart) : walk_dart :=
  let: (visit, turned) := label k x.1 in (visit, N.modulo (N.add turned x.2) (degree_at visit)).

(** Whether the door of a dart of the walk is below the degree that was perceived. *)
Definition door_exists (x : walk_dart) : bool := N.ltb x.2 (degree_at x.1).

(** The darts from which a passage leaves, and to which it leads. *)
Definition ends_of (p : passage) : option (walk_dart * walk_dart) :=
  match p with
  | Along m => if find (door_at w) m is Some i then Some ((m, i), (N.succ m, N0)) else None
  | Against m => if find (door_at w) m is Some i then Some ((N.succ m, N0), (m, i)) else None
  end.

Definition move_of (p : passage) : N := match p with Along m => m | Against m => m end.

(** Two darts, if their doors exist. *)
Definition existing (x y : walk_dart) : walk_dart * walk_dart + reason :=
  if ~~ door_exists x then inr (NoDoor x.1 x.2)
  else if ~~ door_exists y then inr (NoDoor y.1 y.2)
  else inl (x, y).

(** The darts that a step shows to be one, or why it does not. *)
Definition shows (k : knowledge) (s : step) : walk_dart * walk_dart + reason :=
  match s with
  | Mark a b =>
      if marker is WordDirectional then
        match sighting_at a, sighting_at b with
        | WordPointing i, WordPointing j => existing (a, i) (b, j)
        | WordPointing _, _ => inr (NotPointing b)
        | _, _ => inr (NotPointing a)
        end
      else inr OnlyDirectional
  | Beyond p q =>
      match ends_of p, ends_of q with
      | Some (x, x'), Some (y, y') =>
          if existing x y is inr reason then inr reason
          else if name_of k x == name_of k y then existing x' y' else inr NotOne
      | None, _ => inr (NoMove (move_of p))
      | _, None => inr (NoMove (move_of q))
      end
  end.

(** The visits of [from] get labels of [to]: the first has the door [at_from] where the other has [at_to]. *)
Definition relabel (k : knowledge) (to from : walk_dart) : knowledge :=
  let: (r, at_to) := to in
  let: (s, at_from) := from in
  let shift := N.add at_to (N.sub (degree_at s) at_from) in
  let: (count, visits) := class k r in
  let: (count', visits') := class k s in
  let move labels' visit :=
    let: (s', turned) := odflt (visit, N0) (find labels' visit) in
    if s' == s then put labels' visit (r, N.modulo (N.add turned shift) (degree_at r)) else labels' in
  Knowledge (foldl move (labels k) visits')
    (put (members k) r (N.add count count', catrev visits' visits)).

(** Whether two names are those of two doors of one vertex, or of vertices with different degrees. *)
Definition two_doors (x y : walk_dart) : bool := (x.1 == y.1) && (x.2 != y.2).
Definition other_degree (x y : walk_dart) : bool := degree_at x.1 != degree_at y.1.

(** What is known after a step. *)
Definition after (k : knowledge) (s : step) : knowledge + reason :=
  match shows k s with
  | inr reason => inr reason
  | inl (x, y) =>
      let x := name_of k x in
      let y := name_of k y in
      if two_doors x y then inr TwoDoors
      else if other_degree x y then inr OtherDegree
      else inl (if x.1 == y.1 then k
                else if N.ltb (class k x.1).1 (class k y.1).1 then relabel k y x else relabel k x y)
  end.

(** What is known after some steps, the first of which has the number [part]. *)
Fixpoint after_all (k : knowledge) (part : N) (steps : seq step) : knowledge + N * reason :=
  if steps is s :: steps then
    match after k s with
    | inl k => after_all k (N.succ part) steps
    | inr reason => inr (part, reason)
    end
  else inl k.

(** The names of the ends of all moves, if their doors exist. *)
Fixpoint names_of_ends (k : knowledge) (ends : table (table unit)) (visit : N) (doors : seq N) : table (table unit) :=
  let add ends x :=
    if door_exists x then
      let: (visit, i) := name_of k x in put ends visit (put (odflt empty (find ends visit)) i tt)
    else ends in
  if doors is i :: doors then names_of_ends k (add (add ends (visit, i)) (N.succ visit, N0)) (N.succ visit) doors
  else ends.

(** As many numbers as moves have ends, and one more. *)
Definition ends_fuel : seq N := N0 :: catrev (door_lines (walk_of w)) (door_lines (walk_of w)).

(** Whether each door of a vertex is known to be an end of some move; for each visit, of that which stands for it. *)
Definition covered (k : knowledge) (fuel : seq N) (ends : table (table unit)) (visit : N) : bool :=
  let stands := (label k visit).1 in
  if N.ltb stands (visits w) then
    if (label k stands).1 == stands then
      if stands == visit then
        let its := odflt empty (find ends visit) in
        all_below fuel N0 (degree_at visit) (has_entry its)
      else true
    else false
  else false.

Definition complete (k : knowledge) : bool :=
  let ends := names_of_ends k empty N0 (door_lines (walk_of w)) in
  all_below (see_lines (walk_of w)) N0 (visits w) (covered k ends_fuel ends).

(** An open door, for the message. *)
Definition open_door (k : knowledge) : reason :=
  let ends := names_of_ends k empty N0 (door_lines (walk_of w)) in
  let ends_fuel := ends_fuel in
  let fix first_open (fuel : seq (N * sighting_word)) visit :=
    if fuel is _ :: fuel then
      if covered k ends_fuel ends visit then first_open fuel (N.succ visit)
      else
        let its := odflt empty (find ends visit) in
        let fix first_missing (fuel : seq N) i :=
          if fuel is _ :: fuel then if has_entry its i then first_missing fuel (N.succ i) else i else i in
        Open visit (first_missing (door_lines (walk_of w)) N0)
    else Open N0 N0 in
  first_open (see_lines (walk_of w)) N0.

(** Whether a marker of this kind can be seen so, at a vertex of this degree. *)
Definition can_see (degree : N) (s : sighting_word) : bool :=
  match marker, s with
  | _, WordNothing => true
  | WordDirectional, WordPointing i => N.ltb i degree
  | WordUndirected, WordLying => true
  | WordUndirectedEdge, WordPassed => true
  | WordDirectedEdge, (WordAlong | WordAgainst) => true
  | WordTwoIdentical, (WordLying | WordTwo) => true
  | WordTwoDistinct, (WordFirst | WordSecond | WordBoth) => true
  | _, _ => false
  end.

Definition visited (visit : N) : bool := N.ltb visit (visits w).

(** Whether the first visit saw a directional marker along a dart, and the second not along the same. *)
Definition points_elsewhere (k : knowledge) (a b : N) : bool :=
  match sighting_at a, sighting_at b with
  | WordPointing i, WordPointing j => name_of k (a, i) != name_of k (b, j)
  | WordPointing _, _ => true
  | _, _ => false
  end.

Definition pointed_door_exists (a : N) : bool :=
  if sighting_at a is WordPointing i then door_exists (a, i) else true.

Definition is_seen (seen : N * sighting_word) : bool := if seen.2 is WordNothing then false else true.

(** Why a contradiction is none. *)
Definition not_contradictory (k : knowledge) (c : contradiction) : option reason :=
  let by_test test := if test then None else Some NoContradiction in
  match c with
  | ByStep s =>
      match shows k s with
      | inr reason => Some reason
      | inl (x, y) =>
          let x := name_of k x in let y := name_of k y in by_test (two_doors x y || other_degree x y)
      end
  | BySightings a b =>
      if ~~ visited a then Some (NoVisit a) else if ~~ visited b then Some (NoVisit b)
      else if (label k a).1 != (label k b).1 then Some NotOneVertex
      else
        match marker with
        | WordNone => Some NoContradiction
        | WordDirectional =>
            by_test [&& pointed_door_exists a, pointed_door_exists b & points_elsewhere k a b || points_elsewhere k b a]
        | WordUndirectedEdge | WordDirectedEdge =>
            by_test ((name_of k (a, N0) == name_of k (b, N0)) && ~~ same_sighting (sighting_at a) (sighting_at b))
        | _ => by_test (~~ same_sighting (sighting_at a) (sighting_at b))
        end
  | ByEdge m =>
      if ends_of (Along m) is Some (x, y) then
        by_test [&& door_exists x, door_exists y & name_of k x == name_of k y]
      else Some (NoMove m)
  | ByPercept a =>
      if ~~ visited a then Some (NoVisit a)
      else by_test ((degree_at a == N0) || ~~ can_see (degree_at a) (sighting_at a))
  | ByDoor m =>
      if find (door_at w) m is Some i then by_test (N.leb (degree_at m) i) else Some (NoMove m)
  | ByNoMarker =>
      if marker is WordDirectional then
        if has is_seen (see_lines (walk_of w)) then Some NoContradiction
        else if complete k then None else Some (open_door k)
      else Some OnlyDirectional
  end.

End Steps.

(** * Choices of visits in any world *)

(** A walk of the alternatives that are chosen of the visits so far. A robot begins without a percept. Then it leaves
    the last vertex of the walk by a door, and perhaps it turns back in the corridor behind it. *)
Inductive choice_walk := Begins | Leaves of bool & N & walked & knowledge.

(** A walk with one percept; and the same walk with one more move. Its lines are in reverse order, so that longer walks
    share them. *)
Definition first_visit (seen : N * sighting_word) : walked := walked_of (WalkText [:: seen] [::]).

Definition next_visit (w : walked) (door : N) (seen : N * sighting_word) : walked :=
  Walked (WalkText (seen :: see_lines (walk_of w)) (door :: door_lines (walk_of w)))
    (put (percept_at w) (visits w) seen) (put (door_at w) (moves w) door) (N.succ (visits w)) (N.succ (moves w)).

Definition in_order (w : walked) : walked :=
  Walked (WalkText (rev (see_lines (walk_of w))) (rev (door_lines (walk_of w))))
    (percept_at w) (door_at w) (visits w) (moves w).

(** Only one contradiction is about the lines. *)
Definition walk_for (c : contradiction) (w : walked) : walked := if c is ByNoMarker then in_order w else w.

Section Choices.

Variable marker : marker_word.

(** Whether a vertex can have both percepts: with some pose, and with that which is [turn] doors further. *)
Definition seen_again (turn : N) (seen seen' : N * sighting_word) : bool :=
  (seen.1 == seen'.1) &&
  match marker, seen.2, seen'.2 with
  | (WordUndirectedEdge | WordDirectedEdge), _, _ => true
  | _, WordPointing i, WordPointing j => N.modulo (N.add turn j) seen.1 == N.modulo i seen.1
  | _, s, s' => same_sighting s s'
  end.

(** The walk with an alternative of the next visit: none, if the robot has turned back to a vertex with another percept.
    At the last visit the door is of no account. *)
Definition with_choice (back : bool) (a : alternative) (c : choice_walk) : option choice_walk :=
  match a, c with
  | NoVertex, Begins => Some Begins
  | NoVertex, Leaves turned i w k => Some (Leaves (back (+) turned) i w k)
  | Junction seen door, Begins => Some (Leaves false (odflt N0 door) (first_visit seen) nothing_known)
  | Junction seen door, Leaves false i w k => Some (Leaves false (odflt N0 door) (next_visit w i seen) k)
  | Junction seen door, Leaves true i w k =>
      let last := N.pred (visits w) in
      let degree := degree_at w last in
      if seen_again i (degree, sighting_at w last) seen
      then Some (Leaves false (N.modulo (N.add i (odflt N0 door)) degree) w k) else None
  end.

(** The numbers from [i] on and below [n], if a list is as long. *)
Fixpoint numbers_below T (fuel : seq T) (i n : N) : option (seq N) :=
  if i == n then Some [::]
  else if fuel is _ :: fuel then omap (cons i) (numbers_below fuel (N.succ i) n) else None.

(** What can be chosen of some alternatives, from this number on: each with its number, and the door that is chosen, if
    it is not known. *)
Fixpoint all_choices T (fuel : seq T) (last : bool) (number : N) (alternatives : seq alternative) :
    option (seq (N * option N * alternative)) :=
  if alternatives is a :: others then
    if all_choices fuel last (N.succ number) others is Some later then
      match a, last with
      | Junction seen None, false =>
          omap (fun doors => map (fun i => (number, Some i, Junction seen (Some i))) doors ++ later)
            (numbers_below fuel N0 seen.1)
      | _, _ => Some ((number, None, a) :: later)
      end
    else None
  else Some [::].

(** What is known after the lines that unite darts, and the other lines; or the lines from the first that does not. *)
Fixpoint unite_all (w : walked) (k : knowledge) (lines : seq choice_line) :
    knowledge * seq choice_line + seq choice_line * reason :=
  if lines is Unite s :: others then
    match after marker w k s with
    | inl k => unite_all w k others
    | inr reason => inr (lines, reason)
    end
  else inl (k, lines).

(** The lines after those which show that no choice of the visits goes on a walk; or the lines from the first that is
    wrong. *)
Fixpoint refute (vs : seq visit_text) (c : choice_walk) (lines : seq choice_line) :
    seq choice_line + seq choice_line * reason :=
  if vs is v :: others then
    let fix refute_each choices lines :=
      match choices, lines with
      | [::], _ => inl lines
      | (n, door, a) :: choices, Choose n' door' :: after_choice =>
          if (n, door) != (n', door') then inr (lines, ChoiceMissing)
          else
            let closed :=
              match with_choice (turned_back v) a c, after_choice with
              | None, CloseBack :: rest => inl rest
              | None, _ => inr (after_choice, ChoiceMissing)
              | Some Begins, _ => refute others Begins after_choice
              | Some (Leaves turned i w k), _ =>
                  match unite_all w k after_choice with
                  | inr wrong => inr wrong
                  | inl (k, Close contra :: rest) =>
                      if not_contradictory marker (walk_for contra w) k contra is Some reason
                      then inr (Close contra :: rest, reason)
                      else inl rest
                  | inl (k, rest) => refute others (Leaves turned i w k) rest
                  end
              end in
            match closed with inl rest => refute_each choices rest | inr wrong => inr wrong end
      | _, _ => inr (lines, ChoiceMissing)
      end in
    if all_choices lines (nilp others) N0 (alternatives v) is Some choices then refute_each choices lines
    else inr ([::], LengthsDiffer)
  else inr (lines, ChoiceMissing).

End Choices.

(** * Pairs, images and walks from two poses *)

(** Two worlds with their markers. *)
Section Pairs.

Variables (T U : tables) (marker marker' : marker_word).

Definition same_percept (p q : N) : bool :=
  (degree_in T p == degree_in U q) && same_sighting (sighting_in T marker p) (sighting_in U marker' q).

Definition pair_table (pairs : seq (N * N)) : table (table unit) :=
  foldl (fun t pair => put t pair.1 (put (odflt empty (find t pair.1)) pair.2 tt)) empty pairs.

Definition is_pair (t : table (table unit)) (p q : N) : bool :=
  if find t p is Some qs then has_entry qs q else false.

(** The first pair with different percepts, or with a door that leads out of the pairs. *)
Fixpoint wrong_pair (t : table (table unit)) (part : N) (pairs : seq (N * N)) : option (N * reason) :=
  if pairs is (p, q) :: pairs then
    if ~~ has_entry (dart_set T) p then Some (part, NoDart p)
    else if ~~ has_entry (dart_set U) q then Some (part, NoDart q)
    else if ~~ same_percept p q then Some (part, PerceptsDiffer p q)
    else if all_below (dart_list T) N0 (degree_in T p)
              (fun i => is_pair t (traverse_in T p i) (traverse_in U q i))
    then wrong_pair t (N.succ part) pairs
    else Some (part, NoPair p q)
  else None.

(** Whether a walk's doors exist from both poses, and its last percepts differ. *)
Fixpoint not_distinguished (p q : N) (doors : seq N) : option reason :=
  if doors is i :: doors then
    if N.ltb i (degree_in T p) && N.ltb i (degree_in U q)
    then not_distinguished (traverse_in T p i) (traverse_in U q i) doors
    else Some (DoorMissing i)
  else if same_percept p q then Some PerceptsSame else None.

Fixpoint not_all_distinguished (part : N) (walks : seq (N * N * seq N)) : option (N * reason) :=
  if walks is (p, q, doors) :: walks then
    if ~~ has_entry (dart_set T) p then Some (part, NoDart p)
    else if ~~ has_entry (dart_set U) q then Some (part, NoDart q)
    else if not_distinguished p q doors is Some reason then Some (part, reason)
    else not_all_distinguished (N.succ part) walks
  else None.

(** The first line of a map of darts that has no dart, or where the map does not keep both permutations. *)
Fixpoint wrong_image (images : table N) (part : N) (pairs : seq (N * N)) : option (N * reason) :=
  if pairs is (p, q) :: pairs then
    if ~~ has_entry (dart_set T) p then Some (part, NoDart p)
    else if ~~ has_entry (dart_set U) q then Some (part, NoDart q)
    else if [&& find images p == Some q,
                find images (opposite_in T p) == Some (opposite_in U q)
              & find images (odflt p (find (next_of T) p)) == Some (odflt q (find (next_of U) q))]
    then wrong_image images (N.succ part) pairs
    else Some (part, NotKept p)
  else None.

Definition image_table (pairs : seq (N * N)) : table N :=
  foldl (fun t pair => put t pair.1 pair.2) empty pairs.

End Pairs.

(** * Claims *)

Definition refused_at (wrong : option (N * reason)) : outcome :=
  if wrong is Some (part, reason) then Refused (AtPart part) reason else Accepted.

(** A setting with its tables, which are made once for all its claims. *)
Record prepared := Prepared {
  set : setting;
  world_tables : seq (world_text * tables);
  world_wrong : option (N * reason);
  walk_tables : option walked
}.

Fixpoint first_wrong (i : N) (ts : seq (world_text * tables)) : option (N * reason) :=
  if ts is (t, T) :: ts then
    if wrong_world t T is Some reason then Some (i, reason) else first_wrong (N.succ i) ts
  else None.

Definition prepare (s : setting) : prepared :=
  let ts := map (fun t => (t, tables_of t)) (worlds s) in
  Prepared s ts (first_wrong N0 ts) (omap walked_of (walk_line s)).

(** The same world with its marker at a dart. *)
Definition facing_at (T : tables) (d : N) : tables :=
  Tables (opposite_of T) (next_of T) (stand_of T) (dart_at T) (dart_list T) (dart_set T) d.

(** For the world of [U], as [not_all_distinguished], with directional markers by these poses, which for the world of
    [T] are always the same. *)
Fixpoint not_all_refuted (T U : tables) (p : N) (part : N) (walks : seq (N * N * seq N)) : option (N * reason) :=
  if walks is (p', q, doors) :: walks then
    if p' != p then Some (part, OtherPose p')
    else if ~~ has_entry (dart_set U) q then Some (part, NoDart q)
    else if not_distinguished (facing_at T p) (facing_at U q) WordDirectional WordDirectional p q doors
      is Some reason then Some (part, reason)
    else not_all_refuted T U p (N.succ part) walks
  else None.

Definition check_determined (marker : marker_word) (T : tables) (w : walked) (from : N) (steps : seq step) : outcome :=
  if marker isn't WordDirectional then Refused InClaim OnlyDirectional
  else if ~~ has_entry (dart_set T) from then Refused InClaim (NoDart from)
  else if differs T marker N0 from (see_lines (walk_of w)) (door_lines (walk_of w)) is Some (visit, reason) then
    Refused (AtVisit visit) reason
  else
    match after_all marker w nothing_known N0 steps with
    | inr (part, reason) => Refused (AtPart part) reason
    | inl k => if complete w k then Accepted else Refused InClaim (open_door w k)
    end.

Definition check_unexplained (marker : marker_word) (w : walked) (steps : seq step) (c : contradiction) : outcome :=
  if N.succ (moves w) != visits w then Refused InClaim LengthsDiffer
  else
    match after_all marker w nothing_known N0 steps with
    | inr (part, reason) => Refused (AtPart part) reason
    | inl k =>
        if not_contradictory marker w k c is Some reason then Refused (AtPart (length steps)) reason else Accepted
    end.

Definition check_conforms (marker : marker_word) (T : tables) (w : walked) (from : N) : outcome :=
  if ~~ has_entry (dart_set T) from then Refused InClaim (NoDart from)
  else if differs T marker N0 from (see_lines (walk_of w)) (door_lines (walk_of w)) is Some (visit, reason) then
    Refused (AtVisit visit) reason
  else Accepted.

Definition check_diverges (marker : marker_word) (T : tables) (w : walked) (from : option (seq N)) : outcome :=
  let poses := odflt (dart_list T) from in
  if first_not (has_entry (dart_set T)) poses is Some d then Refused InClaim (NoDart d)
  else
    let both := foldl (fun s d => (d, d) :: s) [::] poses in
    if remain T marker both (see_lines (walk_of w)) (door_lines (walk_of w)) is (d, _) :: _ then
      Refused InClaim (GivesAll d)
    else Accepted.

Definition check_runs (T : tables) (r : run_text) (from : N) : outcome :=
  if ~~ has_entry (dart_set T) from then Refused InClaim (NoDart from)
  else if wrong_in_run T (aid_line r) r from is Some n then Refused (AtVisit n) NotSo
  else Accepted.

Definition check_runs_nowhere (T : tables) (r : run_text) (from : option (seq N)) : outcome :=
  let poses := odflt (dart_list T) from in
  if first_not (has_entry (dart_set T)) poses is Some d then Refused InClaim (NoDart d)
  else if first_not (fun d => if wrong_in_run T (aid_line r) r d is Some _ then true else false) poses is Some d then
    Refused InClaim (GivesAll d)
  else Accepted.

Definition check_isomorphic (T U : tables) (pairs : seq (N * N)) : outcome :=
  let images := image_table pairs in
  let origins := foldl (fun t pair => put t pair.2 pair.1) empty pairs in
  if wrong_image T U images N0 pairs is Some (part, reason) then Refused (AtPart part) reason
  else if length pairs != length (dart_list T) then Refused InClaim ImageTwice
  else if first_not (has_entry images) (dart_list T) is Some d then Refused InClaim (NoImage d)
  else if first_not (fun p => if find images p is Some q then find origins q == Some p else false) (dart_list T)
    is Some d then Refused InClaim (ImageShared d)
  else if first_not (has_entry origins) (dart_list U) is Some d then Refused InClaim (PosesLeftOut d)
  else Accepted.

Definition check_not_isomorphic (T U : tables) (walks : seq (N * N * seq N)) : outcome :=
  if walks is (p, _, _) :: _ then
    if ~~ has_entry (dart_set T) p then Refused (AtPart N0) (NoDart p)
    else if not_all_refuted T U p N0 walks is Some (part, reason) then Refused (AtPart part) reason
    else
      let compared := set_of (foldl (fun s walk => walk.1.2 :: s) [::] walks) in
      if first_not (has_entry compared) (dart_list U) is Some d then Refused InClaim (PosesLeftOut d)
      else if length walks != length (dart_list U) then Refused InClaim WalksTooMany
      else Accepted
  else Refused InClaim NothingClaimed.

Definition check_fits (marker : marker_word) (T : tables) (visits : seq visit_text) (from : N)
    (choices : seq (N * option N)) : outcome :=
  if ~~ has_entry (dart_set T) from then Refused InClaim (NoDart from)
  else refused_at (wrong_choice T marker N0 visits choices from).

Definition check_misfits (marker : marker_word) (T : tables) (visits : seq visit_text) (from : option (seq N)) :
    outcome :=
  let poses := odflt (dart_list T) from in
  if first_not (has_entry (dart_set T)) poses is Some d then Refused InClaim (NoDart d)
  else if after_visits T marker visits poses is [::] then Accepted
  else Refused InClaim VisitsMade.

Definition check_impossible (marker : marker_word) (visits : seq visit_text) (lines : seq choice_line) : outcome :=
  match refute marker visits Begins lines with
  | inl [::] => Accepted
  | inl rest => Refused (AtPart (N.sub (length lines) (length rest))) ChoiceMissing
  | inr (rest, reason) => Refused (AtPart (N.sub (length lines) (length rest))) reason
  end.

(** The checker. *)
Definition check (p : prepared) (c : claim) : outcome :=
  let marker := marker_line (set p) in
  if world_wrong p is Some (i, reason) then Refused (InWorld i) reason
  else
    match c, world_tables p, walk_tables p, visits_line (set p), run_line (set p) with
    | Determined from steps, [:: (_, T)], Some w, None, None => check_determined marker T w from steps
    | Unexplained steps c, [::], Some w, None, None => check_unexplained marker w steps c
    | Conforms from, [:: (_, T)], Some w, None, None => check_conforms marker T w from
    | Diverges from, [:: (_, T)], Some w, None, None => check_diverges marker T w from
    | Indistinguishable pairs, [:: (_, T); (_, U)], None, None, None =>
        if pairs is [::] then Refused InClaim NothingClaimed
        else refused_at (wrong_pair T U marker marker (pair_table pairs) N0 pairs)
    | Distinguishable walks, [:: (_, T); (_, U)], None, None, None =>
        if walks is [::] then Refused InClaim NothingClaimed
        else refused_at (not_all_distinguished T U marker marker N0 walks)
    | Isomorphic pairs, [:: (_, T); (_, U)], None, None, None => check_isomorphic T U pairs
    | NotIsomorphic walks, [:: (_, T); (_, U)], None, None, None => check_not_isomorphic T U walks
    | Fits from choices, [:: (_, T)], None, Some visits, None => check_fits marker T visits from choices
    | Misfits from, [:: (_, T)], None, Some visits, None => check_misfits marker T visits from
    | Impossible lines, [::], None, Some visits, None => check_impossible marker visits lines
    | Conforms from, [:: (_, T)], None, None, Some r => check_runs T r from
    | Diverges from, [:: (_, T)], None, None, Some r => check_runs_nowhere T r from
    | _, _, _, _, _ => Refused InClaim WrongParts
    end.
