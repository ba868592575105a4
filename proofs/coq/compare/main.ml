(* Runs the extracted algorithms in each start that stands on a line of standard input, and prints their
   runs, a line each, on standard output.

   A start is the kind of marker and two lists of darts: what is opposite to dart 0, 1, 2, ..., and what is
   clockwise from it. The facing dart is dart 0. Then come the choices: [default]; [all], for a run with each
   sequence of choices, of which the last one changes fastest; or the choices of one run, each the number of an
   option, from 0, among those that Coq lists. Semicolons stand between these parts.

   The output is what the robot did, in its order, the doors that it took as numbers; its choices, each with the
   number of options, if they were not the default ones; of each dart of its map the first dart of its vertex,
   the degree of its vertex, and the other end of its edge; and the robot's pose:

     movable; opposite 1 0; clockwise 0 1; choices 0
     did pick-up 0; chose 0/1; first 0 1; degree 1 1; other 1 0; robot 1

   The folding explorer has actions instead of choices, with commas between them. Numbers are darts of its map,
   and after [by] the doors that the robot took: it explored a dart; it tested whether two darts are the ends of one
   edge; it found without a move that they are; it added the place behind a dart to its map. Its output ends with
   the number of moves:

     folding; opposite 1 0; clockwise 0 1; actions explore 0 by 0, add 0
     did 0; chose; first 0 1; degree 1 1; other 1 0; robot 1; moves 1

   Here the world is: what stands in [Spec.v] and in [MovableMarker.v] on finite types is written again, on
   arrays. *)

open Mappings

let rec nat n = if n = 0 then O else S (nat (n - 1))
let rec int = function O -> 0 | S n -> 1 + int n

type start = { opposite : int array; clockwise : int array }

let facing = 0

(* The pose behind a door. *)
let traverse start pose door =
  let rec turn dart doors = if doors = 0 then dart else turn start.clockwise.(dart) (doors - 1) in
  start.opposite.(turn pose door)

(* The darts behind the doors of a robot with this pose. *)
let doors start pose =
  let rec from dart =
    let next = start.clockwise.(dart) in
    dart :: (if next = pose then [] else from next)
  in
  from pose

(* What a directional marker along the facing dart adds to the percept, where these are doors [door],
   [door + 1], ... *)
let rec pointing door = function
  | [] -> Nothing
  | dart :: others -> if dart = facing then Pointing (nat door) else pointing (door + 1) others

(* What an undirected marker adds that lies at the vertex of a dart, if it is not carried. *)
let lying spot doors =
  match spot with Some dart when List.mem dart doors -> Lying | _ -> Nothing

let percept start sighting pose =
  let doors = doors start pose in
  (nat (List.length doors), sighting doors)

type choices = Default | All | These of int list

(* Where a robot is in a run: its pose; the marker, which lies at the vertex of the dart [spot], or nowhere, if
   the robot carries it; and what it did and chose, the last of it first. *)
type state = { pose : int; spot : int option; did : string list; chose : string list }

(* Calls [ended] with the answer of each run, and the state in which it ends. *)
let rec run start sighting choices state ended deeds =
  let go_on = run start sighting in
  match deeds with
  | Answers answer -> (
      match choices with
      | These (_ :: _) -> failwith "there are more choices than the run makes"
      | _ -> ended answer state)
  | Leaves (door, go) ->
      let door = int door in
      let pose = traverse start state.pose door in
      let seen = percept start (sighting state.spot) pose in
      go_on choices { state with pose; did = string_of_int door :: state.did } ended (go seen)
  | PicksUp go -> (
      match state.spot with
      | Some dart when List.mem dart (doors start state.pose) ->
          let seen = percept start (sighting None) state.pose in
          go_on choices { state with spot = None; did = "pick-up" :: state.did } ended (go seen)
      | _ -> failwith "a marker was picked up where none lies")
  | Drops go ->
      if state.spot <> None then failwith "a marker was dropped that is not carried";
      let spot = Some state.pose in
      let seen = percept start (sighting spot) state.pose in
      go_on choices { state with spot; did = "drop" :: state.did } ended (go seen)
  | Chooses (options, go) -> (
      let options = int options in
      let choose choice choices =
        if choice >= options then failwith "a choice is too high";
        let chose = Printf.sprintf "%d/%d" choice options :: state.chose in
        go_on choices { state with chose } ended (go (Some (nat choice)))
      in
      match choices with
      | Default -> go_on choices state ended (go None)
      | All -> List.iter (fun choice -> choose choice All) (List.init options Fun.id)
      | These (choice :: later) -> choose choice (These later)
      | These [] -> failwith "there are fewer choices than the run makes")

let list name words = String.concat " " (name :: words)

let print_parts state parts =
  let did = [ list "did" (List.rev state.did); list "chose" (List.rev state.chose) ] in
  print_endline (String.concat "; " (did @ parts))

let known (map, robot) =
  let of_each name what = list name (List.map (fun dart -> string_of_int (what dart)) map) in
  [
    of_each "first" (fun dart -> int dart.first_of);
    of_each "degree" (fun dart -> int dart.doors_of);
    of_each "other" (fun dart -> match dart.other_of with None -> -1 | Some other -> int other);
    list "robot" [ string_of_int (int robot) ];
  ]

let not_ended = "it has not come to an end"

let print_end answer state =
  print_parts state (match answer with None -> [ not_ended ] | Some answer -> known answer)

let begun = { pose = facing; spot = Some facing; did = []; chose = [] }

let run_from marker start choices =
  let mapping, sighting =
    match marker with
    | "directional" -> (directional_mapping, fun _ -> pointing 0)
    | "movable" -> (movable_mapping, lying)
    | _ -> failwith ("there is no marker " ^ marker)
  in
  let edges = nat (Array.length start.opposite / 2) in
  let seen = percept start (sighting begun.spot) facing in
  run start sighting choices begun print_end (mapping edges seen)

(* What the running folding explorer did. *)
type given =
  | Explored of nat * nat list
  | Tested of nat * nat * nat list
  | Joined of nat * nat
  | Added of nat

(* The edge of the trail that begins at a dart of the trail, if the robot has gone over it. *)
let passage knowledge dart =
  let dart = stands_for knowledge dart in
  let begins passage = stands_for knowledge (from_dart knowledge.trail passage) = dart in
  List.find_opt begins (passages knowledge.trail)

(* The edges of the trail that the robot goes along by these doors, and the first dart that it goes out by
   without having done so before. *)
let rec walk knowledge (visit, door) = function
  | [] -> failwith "the walk goes along known edges only"
  | next :: later -> (
      let rec plus = function O -> door | S n -> S (plus n) in
      let out = (visit, plus next) in
      match passage knowledge out with
      | None -> ([], out)
      | Some found ->
          let way, out = walk knowledge (to_dart knowledge.trail found) later in
          (found :: way, out))

(* The edges of the trail that the robot goes along by these doors until it goes out by a dart. *)
let rec way_to knowledge dart (visit, door) = function
  | [] -> failwith "the walk does not lead over the edge"
  | next :: later -> (
      let rec plus = function O -> door | S n -> S (plus n) in
      let out = (visit, plus next) in
      if stands_for knowledge out = stands_for knowledge dart then []
      else
        match passage knowledge out with
        | None -> failwith "the way to the edge is not known"
        | Some found -> found :: way_to knowledge dart (to_dart knowledge.trail found) later)

(* The action that the robot took; or, before it, that it finds the far end of an edge in its trail. *)
let action_of is_strict knowledge given =
  let noticed edge action =
    match (far_end knowledge edge, passage knowledge (dart_in_trail knowledge edge)) with
    | Some far, _ -> (action far, true)
    | None, Some found -> (Notice (edge, found), false)
    | None, None -> failwith (Printf.sprintf "what is behind dart %d is not known" (int edge))
  in
  match given with
  | Explored (edge, doors) ->
      let way, _ = walk knowledge knowledge.here doors in
      (Explore (edge, Through way), true)
  | Joined (edge, other) -> noticed edge (fun _ -> Join (edge, other))
  | Added edge -> noticed edge (fun _ -> Add edge)
  | Tested (edge, other, doors) when is_strict ->
      noticed edge (fun _ ->
          let way = way_to knowledge (dart_in_trail knowledge edge) knowledge.here doors in
          Test (edge, other, Strict (Through way, path_to_marker knowledge.known_map other)))
  | Tested (edge, other, doors) ->
      noticed edge (fun far ->
          let way, out = walk knowledge knowledge.here doors in
          let map = knowledge.known_map in
          let darts = List.init (List.length map) nat in
          match List.find_opt (predicts knowledge far other out) darts with
          | None -> failwith "a test does not predict where the robot comes in"
          | Some entry ->
              Test (edge, other, Free (way, out, entry, path_to_marker map entry)))

let rec run_given is_strict start (last, given) state = function
  | Complete knowledge ->
      if given <> [] then failwith "there are more actions than the run needs";
      let moves = [ list "moves" [ string_of_int (int knowledge.made) ] ] in
      print_parts state (known (knowledge.known_map, pose_in_map knowledge) @ moves)
  | OutOfActions -> print_parts state [ not_ended ]
  | NotAllowed -> failwith ("this is not allowed: " ^ last)
  | Leaving (door, go) ->
      let door = int door in
      let pose = traverse start state.pose door in
      let state = { state with pose; did = string_of_int door :: state.did } in
      run_given is_strict start (last, given) state (go (percept start (pointing 0) pose))
  | Asking (knowledge, ask) -> (
      match given with
      | [] -> failwith "there are fewer actions than the run needs"
      | (text, next) :: later ->
          let action, is_all = action_of is_strict knowledge next in
          run_given is_strict start (text, if is_all then later else given) state (ask action))

let run_folding is_strict start given =
  let edges = Array.length start.opposite / 2 in
  let seen = percept start (pointing 0) facing in
  let mapping = if is_strict then strict_folding_mapping else folding_mapping in
  run_given is_strict start ("", given) begun (mapping (nat (2 * edges * (edges + 1))) seen)

let words text = List.filter (( <> ) "") (String.split_on_char ' ' text)

let given text =
  let number word = nat (int_of_string word) in
  let text = String.trim text in
  (text,
  match words text with
  | "explore" :: edge :: "by" :: doors -> Explored (number edge, List.map number doors)
  | "test" :: edge :: other :: "by" :: doors ->
      Tested (number edge, number other, List.map number doors)
  | [ "join"; edge; other ] -> Joined (number edge, number other)
  | [ "add"; edge ] -> Added (number edge)
  | _ -> failwith ("this is no action: " ^ text))

let run_line line =
  let darts numbers = Array.of_list (List.map int_of_string numbers) in
  match List.map words (String.split_on_char ';' line) with
  | [ [ algorithm ]; "opposite" :: opposite; "clockwise" :: clockwise; last :: rest ] -> (
      let start = { opposite = darts opposite; clockwise = darts clockwise } in
      match (algorithm, last, rest) with
      | ("folding" | "strict-folding"), "actions", _ ->
          run_folding (algorithm = "strict-folding") start
            (List.map given (String.split_on_char ',' (String.concat " " rest)))
      | _, "choices", [ "default" ] -> run_from algorithm start Default
      | _, "choices", [ "all" ] -> run_from algorithm start All
      | _, "choices", _ -> run_from algorithm start (These (List.map int_of_string rest))
      | _ -> failwith ("this is no start: " ^ line))
  | _ -> failwith ("this is no start: " ^ line)

(* A run that is not possible is a line of its own, with the reason. *)
let () =
  try
    while true do
      let line = input_line stdin in
      try run_line line with Failure reason -> print_endline reason
    done
  with End_of_file -> ()
