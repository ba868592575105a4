(* Runs the extracted Algorithm 1, with its default choices, in each start that stands on a line of
   standard input, and tells on a line of standard output what it did.

   A start is two lists of darts with a semicolon between them: what is opposite to dart 0, 1, 2, ..., and
   what is clockwise from it. The facing dart is dart 0. Told are the doors that the robot took, in their
   order; of each dart of its map the first dart of its vertex, the degree of its vertex, and the other
   end of its edge; and the robot's pose:

     opposite 1 0; clockwise 1 0
     doors 1; first 0 0; degree 2 2; other 1 0; robot 0

   Here the world is: what stands in [Spec.v] on finite types is written again, on arrays. *)

open Algorithm1

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
let rec sighting door = function
  | [] -> Nothing
  | dart :: others -> if dart = facing then Pointing (nat door) else sighting (door + 1) others

let percept start pose =
  let doors = doors start pose in
  (nat (List.length doors), sighting 0 doors)

(* What the program answers, and the doors that it took, the last one first. *)
let rec run start pose taken = function
  | Return answer -> (answer, taken)
  | Choose (_, default, go) -> run start pose taken (go default)
  | Move (door, go) ->
      let door = int door in
      let pose = traverse start pose door in
      run start pose (door :: taken) (go (percept start pose))

let listed numbers = String.concat "" (List.map (fun n -> " " ^ string_of_int n) numbers)

let told start =
  let edges = nat (Array.length start.opposite / 2) in
  let answer, taken = run start facing [] (mapping edges (percept start facing)) in
  let doors = "doors" ^ listed (List.rev taken) in
  match answer with
  | None -> doors ^ "; it has not come to an end"
  | Some (map, robot) ->
      let of_each what = listed (List.map what map) in
      Printf.sprintf "%s; first%s; degree%s; other%s; robot %d" doors
        (of_each (fun dart -> int dart.first_of))
        (of_each (fun dart -> int dart.doors_of))
        (of_each (fun dart -> match dart.other_of with None -> -1 | Some other -> int other))
        (int robot)

let read line =
  match List.map (String.split_on_char ' ') (String.split_on_char ';' line) with
  | [ "opposite" :: opposite; "" :: "clockwise" :: clockwise ] ->
      let darts numbers = Array.of_list (List.map int_of_string numbers) in
      { opposite = darts opposite; clockwise = darts clockwise }
  | _ -> failwith ("this is no start: " ^ line)

let () =
  try
    while true do
      print_endline (told (read (input_line stdin)))
    done
  with End_of_file -> ()
