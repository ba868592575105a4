(* Runs the extracted aids in each start that stands on a line of standard input, and prints what a robot perceives
   there and can do, a line each, on standard output.

   A line has the name of an aid; two lists of darts: what is opposite to dart 0, 1, 2, ..., and what is clockwise
   from it; actions that may be possible; and actions of the robot, as toposlam writes both. The facing dart is dart 0.
   The output is, at the start and after each action, the degree, what the robot sees of the aid, and which of the
   listed actions are possible:

     movable; opposite 1 0; clockwise 0 1; listed 0 1 pick-up drop; did pick-up 0
     1, 1: 0 pick-up; 1, 0: 0 drop; 1, 0: 0 drop

   Of markers it sees how many there are; of those that look different, the numbers; of a directional marker and of
   other robots along which doors; of a string through which doors it runs, its ends, and the door from the hand. *)

open Aids

let rec nat n = if n = 0 then O else S (nat (n - 1))
let rec int = function O -> 0 | S n -> 1 + int n

let door name = function None -> [ name ] | Some door -> [ name; string_of_int (int door) ]
let words = List.map string_of_int

(* How the actions of an aid are read, and how what it shows is written: a number of markers, markers that look
   different, a directional marker, one beside a movable marker, other robots, a string. *)

let holding = function
  | "pick-up" -> PickUp
  | "drop" -> Drop
  | other -> failwith other

let holding_one action =
  try Scanf.sscanf action "pick-up-%d%!" (fun number -> PickUpMarker (nat (number - 1)))
  with Scanf.Scan_failure _ -> Scanf.sscanf action "drop-%d%!" (fun number -> DropMarker (nat (number - 1)))

let sending action = Scanf.sscanf action "send-%d:%d%!" (fun robot door -> Send (nat (robot - 2), nat door))

let alike (count : nat) = [ string_of_int (int count) ]
let distinct shown = words (List.concat (List.mapi (fun at here -> if here then [ at + 1 ] else []) shown))
let directional (along : nat option) = if along = None then [] else door "along" along

let both (along, is_here) = directional along @ if is_here then [ "movable" ] else []

let team shown =
  let robot = function
    | Here along -> door "here" along
    | With (earlier, along) -> ("with" :: words [ int earlier + 2 ]) @ directional along
    | Elsewhere degree -> "elsewhere" :: words [ int degree ]
  in
  List.concat_map robot shown

let laid { runs_through; fixed_here; free_here; from_hand } =
  let shown name is_here = if is_here then [ name ] else [] in
  words (List.map int runs_through)
  @ shown "fixed" fixed_here @ shown "free" free_here
  @ if from_hand = None then [] else door "hand" from_hand

(* The types of the actions and of what is seen depend on the aid, which OCaml cannot express. *)
let along run action shows start listed actions =
  let read text =
    match int_of_string_opt text with
    | Some door -> Take (nat door)
    | None -> Use (Obj.magic (action text) : aid_action)
  in
  let situation ((degree, seen), possible) =
    let can = List.filter_map (fun (text, is_possible) -> if is_possible then Some text else None) in
    Printf.sprintf "%s: %s"
      (String.concat " " (List.map (fun n -> n ^ ",") (words [ int degree ]) @ shows (Obj.magic seen)))
      (String.concat " " (can (List.combine listed possible)))
  in
  String.concat "; " (List.map situation (run start (List.map read listed) (List.map read actions)))

let of_aid name =
  match String.split_on_char '-' name with
  | [ "movable" ] -> along (along_alike (nat 1)) holding alike
  | [ "movable"; "directional" ] -> along along_directional holding directional
  | [ "movable+directional" ] -> along along_both holding both
  | [ "movable"; count ] -> along (along_alike (nat (int_of_string count))) holding alike
  | [ "movable"; count; "distinct" ] -> along (along_distinct (nat (int_of_string count))) holding_one distinct
  | [ "string"; length ] -> along (along_string (nat (int_of_string length))) holding laid
  | [ "team"; robots ] -> along (along_team true (nat (int_of_string robots - 1))) sending team
  | [ "team"; robots; "round" ] -> along (along_team false (nat (int_of_string robots - 1))) sending team
  | _ -> failwith name

let part line name =
  match String.split_on_char ' ' (String.trim line) with
  | first :: others when first = name -> others
  | _ -> failwith line

let run line =
  match String.split_on_char ';' line with
  | [ aid; opposite; clockwise; listed; did ] ->
      let permutation text name = Array.of_list (List.map int_of_string (part text name)) in
      let opposite, clockwise = (permutation opposite "opposite", permutation clockwise "clockwise") in
      let map darts dart = nat darts.(int dart) in
      let start = start_of (nat (Array.length opposite - 1)) (map opposite) (map clockwise) in
      of_aid aid start (part listed "listed") (part did "did")
  | _ -> failwith line

let () =
  try
    while true do
      print_endline (run (read_line ()))
    done
  with End_of_file -> ()
