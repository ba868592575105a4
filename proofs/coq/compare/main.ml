(* Runs the extracted algorithms, with their default choices, in each start that stands on a line of
   standard input, and prints their runs, a line each, on standard output.

   A start is the kind of marker and two lists of darts, with semicolons between them: what is opposite to
   dart 0, 1, 2, ..., and what is clockwise from it. The facing dart is dart 0. The output is what the robot
   did, in its order, the doors that it took as numbers; of each dart of its map the first dart of its
   vertex, the degree of its vertex, and the other end of its edge; and the robot's pose:

     movable; opposite 1 0; clockwise 0 1
     did pick-up 0; first 0 1; degree 1 1; other 1 0; robot 1

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

(* What the robot answers, and what it did, the last of it first. The marker lies at the vertex of the dart
   [spot]; or nowhere, if the robot carries it. *)
let rec run start sighting pose spot did = function
  | Answers answer -> (answer, did)
  | Leaves (door, go) ->
      let door = int door in
      let pose = traverse start pose door in
      let seen = percept start (sighting spot) pose in
      run start sighting pose spot (string_of_int door :: did) (go seen)
  | PicksUp go -> (
      match spot with
      | Some dart when List.mem dart (doors start pose) ->
          run start sighting pose None ("pick-up" :: did) go
      | _ -> failwith "a marker was picked up where none lies")
  | Drops go ->
      if spot <> None then failwith "a marker was dropped that is not carried";
      run start sighting pose (Some pose) ("drop" :: did) go

let run_line marker start =
  let mapping, sighting =
    match marker with
    | "directional" -> (directional_mapping, fun _ -> pointing 0)
    | "movable" -> (movable_mapping, lying)
    | _ -> failwith ("there is no marker " ^ marker)
  in
  let edges = nat (Array.length start.opposite / 2) and spot = Some facing in
  let seen = percept start (sighting spot) facing in
  let answer, did = run start sighting facing spot [] (mapping edges seen) in
  let did = String.concat " " ("did" :: List.rev did) in
  match answer with
  | None -> did ^ "; it has not come to an end"
  | Some (map, robot) ->
      let of_each what = String.concat "" (List.map (fun dart -> Printf.sprintf " %d" (what dart)) map) in
      Printf.sprintf "%s; first%s; degree%s; other%s; robot %d" did
        (of_each (fun dart -> int dart.first_of))
        (of_each (fun dart -> int dart.doors_of))
        (of_each (fun dart -> match dart.other_of with None -> -1 | Some other -> int other))
        (int robot)

let answer line =
  match List.map (String.split_on_char ' ') (String.split_on_char ';' line) with
  | [ [ marker ]; "" :: "opposite" :: opposite; "" :: "clockwise" :: clockwise ] ->
      let darts numbers = Array.of_list (List.map int_of_string numbers) in
      run_line marker { opposite = darts opposite; clockwise = darts clockwise }
  | _ -> failwith ("this is no start: " ^ line)

let () =
  try
    while true do
      print_endline (answer (input_line stdin))
    done
  with End_of_file -> ()
