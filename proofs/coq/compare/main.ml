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
          go_on choices { state with spot = None; did = "pick-up" :: state.did } ended go
      | _ -> failwith "a marker was picked up where none lies")
  | Drops go ->
      if state.spot <> None then failwith "a marker was dropped that is not carried";
      go_on choices { state with spot = Some state.pose; did = "drop" :: state.did } ended go
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

let print_end answer state =
  let list name words = String.concat " " (name :: words) in
  let parts = [ list "did" (List.rev state.did); list "chose" (List.rev state.chose) ] in
  let known =
    match answer with
    | None -> [ "it has not come to an end" ]
    | Some (map, robot) ->
        let of_each name what = list name (List.map (fun dart -> string_of_int (what dart)) map) in
        [
          of_each "first" (fun dart -> int dart.first_of);
          of_each "degree" (fun dart -> int dart.doors_of);
          of_each "other" (fun dart -> match dart.other_of with None -> -1 | Some other -> int other);
          list "robot" [ string_of_int (int robot) ];
        ]
  in
  print_endline (String.concat "; " (parts @ known))

let run_from marker start choices =
  let mapping, sighting =
    match marker with
    | "directional" -> (directional_mapping, fun _ -> pointing 0)
    | "movable" -> (movable_mapping, lying)
    | _ -> failwith ("there is no marker " ^ marker)
  in
  let edges = nat (Array.length start.opposite / 2) and spot = Some facing in
  let seen = percept start (sighting spot) facing in
  run start sighting choices { pose = facing; spot; did = []; chose = [] } print_end (mapping edges seen)

let run_line line =
  match List.map (String.split_on_char ' ') (String.split_on_char ';' line) with
  | [ [ marker ]; "" :: "opposite" :: opposite; "" :: "clockwise" :: clockwise; "" :: "choices" :: choices ] ->
      let darts numbers = Array.of_list (List.map int_of_string numbers) in
      run_from marker
        { opposite = darts opposite; clockwise = darts clockwise }
        (match choices with
        | [ "default" ] -> Default
        | [ "all" ] -> All
        | _ -> These (List.map int_of_string choices))
  | _ -> failwith ("this is no start: " ^ line)

(* A run that is not possible is a line of its own, with the reason. *)
let () =
  try
    while true do
      let line = input_line stdin in
      try run_line line with Failure reason -> print_endline reason
    done
  with End_of_file -> ()
