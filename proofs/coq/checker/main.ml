(* Checks proofs of verdicts with the program that is extracted from Checker.v. This file reads the format of
   docs/proofs-of-verdicts.md, and refuses everything else.

     toposlam-proof-check FILE...               each claim that is proved, and FILE:LINE: and why a file is refused
     toposlam-proof-check --verdicts FILE...    of each file whether it is accepted or refused

   - is the standard input. Exit codes: 0 every claim is proved, 1 one is not, or a file is malformed, 2 bad usage, or a
   file cannot be read. *)

open Checker

(* The number of a line, and what is wrong there. *)
exception Wrong of int * string

(* Numbers *)

let rec positive i = if i = 1 then XH else if i land 1 = 0 then XO (positive (i lsr 1)) else XI (positive (i lsr 1))
let number i = if i = 0 then N0 else Npos (positive i)
let rec int_of = function XH -> 1 | XO p -> 2 * int_of p | XI p -> (2 * int_of p) + 1
let int = function N0 -> 0 | Npos p -> int_of p

(* Lines *)

type reader = { channel : in_channel; mutable line : int; mutable words : string list option }

let malformed r what = raise (Wrong (r.line, "malformed: " ^ what))

(* Goes to the next line that is no remark; at the end of the file there are no words. *)
let rec advance r =
  let before = pos_in r.channel in
  match input_line r.channel with
  | exception End_of_file -> r.line <- r.line + 1; r.words <- None
  | text ->
      r.line <- r.line + 1;
      if pos_in r.channel - before = String.length text then malformed r "the last line does not end";
      if not (String.for_all (fun c -> ' ' <= c && c <= '~') text) then malformed r "a line is printable ASCII";
      if text <> "" && text.[0] = '#' then advance r else r.words <- Some (String.split_on_char ' ' text)

(* The number of a line that was read, when the reader goes on to the next. *)
let taken r = let at = r.line in advance r; at

let number_of r word =
  let digits = String.length word in
  let is_digit c = '0' <= c && c <= '9' in
  if digits = 0 || not (String.for_all is_digit word) || (digits > 1 && word.[0] = '0') then
    malformed r (Printf.sprintf "%S is no number" word);
  if digits > 18 then malformed r ("the number " ^ word ^ " is too large");
  number (int_of_string word)

let numbers r words = List.rev (List.rev_map (number_of r) words)

let read_words read r = match r.words with Some words -> read words | None -> None

(* A line, with its number, as a function reads its words; or all lines that it reads. *)
let line r what read =
  match read_words read r with Some item -> (item, taken r) | None -> malformed r (what ^ " is expected here")

let lines r read =
  let rec go found =
    match read_words read r with Some item -> go ((item, taken r) :: found) | None -> List.rev found
  in
  go []

let expect r text = ignore (line r text (fun words -> if String.concat " " words = text then Some () else None))
let items found = List.rev (List.rev_map fst found)
let places found = Array.of_list (List.rev (List.rev_map snd found))

(* The parts of a proof *)

let world r =
  let at = taken r in
  let vertices = lines r (function "vertex" :: (_ :: _ as darts) -> Some (numbers r darts) | _ -> None) in
  let edges = lines r (function [ "edge"; d; e ] -> Some (number_of r d, number_of r e) | _ -> None) in
  let facing_line, _ =
    line r "vertex D..., edge D E or facing D" (function [ "facing"; d ] -> Some (number_of r d) | _ -> None) in
  ({ vertex_lines = items vertices; edge_lines = items edges; facing_line }, at)

let markers =
  [ ("none", WordNone); ("undirected", WordUndirected); ("directional", WordDirectional);
    ("undirected-edge", WordUndirectedEdge); ("directed-edge", WordDirectedEdge);
    ("two-identical", WordTwoIdentical); ("two-distinct", WordTwoDistinct) ]

let sightings =
  [ ("nothing", WordNothing); ("lying", WordLying); ("two", WordTwo); ("first", WordFirst); ("second", WordSecond);
    ("both", WordBoth); ("passed", WordPassed); ("along", WordAlong); ("against", WordAgainst) ]

let percept r degree = function
  | [ "pointing"; i ] -> Some (number_of r degree, WordPointing (number_of r i))
  | [ word ] when List.mem_assoc word sightings -> Some (number_of r degree, List.assoc word sightings)
  | _ -> None

let see r = function "see" :: degree :: sighting -> percept r degree sighting | _ -> None

let door r = function [ "door"; i ] -> Some (number_of r i) | _ -> None

let walk r =
  ignore (taken r);
  let rec go seen doors =
    let seen = line r "see DEGREE SIGHTING" (see r) :: seen in
    match read_words (door r) r with
    | Some i -> ignore (taken r); go seen (i :: doors)
    | None ->
        let seen = List.rev seen in
        ({ see_lines = items seen; door_lines = List.rev doors }, places seen)
  in
  go [] []

(* Visits with alternatives. *)
let alternative r = function
  | [ "none" ] -> Some NoVertex
  | "junction" :: degree :: door :: sighting -> (
      let door = if door = "any" then None else Some (number_of r door) in
      match (percept r degree sighting, door) with
      | Some (degree, _), Some i when not (N.ltb i degree) -> malformed r "the door is not below the degree"
      | Some seen, door -> Some (Junction (seen, door))
      | None, _ -> None)
  | _ -> None

let visit r = function [ "visit"; "through" ] -> Some false | [ "visit"; "back" ] -> Some true | _ -> None

let visits r =
  ignore (taken r);
  let rec go found =
    if found <> [] && read_words (visit r) r = None then List.rev found
    else
      let turned_back, _ = line r "visit through or visit back" (visit r) in
      go ({ turned_back; alternatives = items (lines r (alternative r)) } :: found)
  in
  go []

(* A run of a robot with an aid: what it did, each time with what it then perceived, if that is known. *)
let aids = [ ("movable", WordMovable); ("movable-directional", WordMovableDirectional) ]

let deed r = function
  | [ "door"; i ] -> Some (DeedDoor (number_of r i))
  | [ "do"; "pick-up" ] -> Some DeedPickUp
  | [ "do"; "drop" ] -> Some DeedDrop
  | _ -> None

let run r aid_line =
  expect r "run";
  let first_see, first_at = line r "see DEGREE SIGHTING" (see r) in
  let rec go found =
    match read_words (deed r) r with
    | None -> List.rev found
    | Some d ->
        let at = taken r in
        let seen = read_words (see r) r in
        if seen <> None then ignore (taken r);
        go (((d, seen), at) :: found)
  in
  let deeds = go [] in
  ({ aid_line; first_see; deed_lines = items deeds }, Array.append [| first_at |] (places deeds))

let choice r = function
  | [ "choose"; k ] -> Some (number_of r k, None)
  | [ "choose"; k; i ] -> Some (number_of r k, Some (number_of r i))
  | _ -> None

let passage r word =
  let move () = number_of r (String.sub word 1 (String.length word - 1)) in
  match if word = "" then ' ' else word.[0] with
  | '+' -> Along (move ())
  | '-' -> Against (move ())
  | _ -> malformed r (Printf.sprintf "%S is no passage" word)

let step r = function
  | [ "mark"; a; b ] -> Some (Mark (number_of r a, number_of r b))
  | [ "beyond"; p; q ] -> Some (Beyond (passage r p, passage r q))
  | _ -> None

let contradiction r = function
  | "contradiction" :: what ->
      Some
        (match what with
        | [ "sightings"; a; b ] -> BySightings (number_of r a, number_of r b)
        | [ "edge"; m ] -> ByEdge (number_of r m)
        | [ "percept"; a ] -> ByPercept (number_of r a)
        | [ "door"; m ] -> ByDoor (number_of r m)
        | [ "unmarked" ] -> ByNoMarker
        | _ -> (
            match step r what with Some s -> ByStep s | None -> malformed r "this is no contradiction"))
  | _ -> None

let choice_line r = function
  | [ "contradiction"; "back" ] -> Some CloseBack
  | words -> (
      match (choice r words, step r words) with
      | Some (number, door), _ -> Some (Choose (number, door))
      | None, Some s -> Some (Unite s)
      | None, None -> Option.map (fun found -> Close found) (contradiction r words))

let pair r word = function [ first; p; q ] when first = word -> Some (number_of r p, number_of r q) | _ -> None

let from_dart r = fst (line r "from D" (function [ "from"; d ] -> Some (number_of r d) | _ -> None))

let poses r = function
  | [ "from"; "any" ] -> Some None
  | "from" :: (_ :: _ as poses) -> Some (Some (numbers r poses))
  | _ -> None

(* Walks from two poses. *)
let walks r =
  let rec go found =
    match read_words (pair r "from") r with
    | Some poses -> let at = taken r in go (((poses, items (lines r (door r))), at) :: found)
    | None -> List.rev found
  in
  go []

(* A claim, with the numbers of the lines of its parts. *)
let claim r = function
  | "determined" ->
      let from = from_dart r in
      let steps = lines r (step r) in
      (Determined (from, items steps), places steps)
  | "unexplained" ->
      let steps = lines r (step r) in
      let last, at = line r "a step or a contradiction" (contradiction r) in
      (Unexplained (items steps, last), Array.append (places steps) [| at |])
  | "conforms" -> (Conforms (from_dart r), [||])
  | "diverges" -> (Diverges (fst (line r "from D... or from any" (poses r))), [||])
  | "fits" ->
      let from = from_dart r in
      let choices = lines r (choice r) in
      (Fits (from, items choices), places choices)
  | "misfits" -> (Misfits (fst (line r "from D... or from any" (poses r))), [||])
  | "impossible" -> let found = lines r (choice_line r) in (Impossible (items found), places found)
  | "indistinguishable" -> let pairs = lines r (pair r "pair") in (Indistinguishable (items pairs), places pairs)
  | "distinguishable" -> let walks = walks r in (Distinguishable (items walks), places walks)
  | "isomorphic" -> let images = lines r (pair r "image") in (Isomorphic (items images), places images)
  | "not-isomorphic" -> let walks = walks r in (NotIsomorphic (items walks), places walks)
  | kind -> malformed r (Printf.sprintf "there is no claim %S" kind)

(* What is said *)

let say = Printf.sprintf

let why = function
  | NoEdge -> "a world has an edge"
  | DartTwice d -> say "dart %d stands in two places of the vertices" (int d)
  | NoDart d -> say "there is no dart %d: the darts are the numbers from 0 on, each in one vertex" (int d)
  | EdgesDiffer d -> say "dart %d does not stand in one edge" (int d)
  | NotConnected d -> say "dart %d is not reached from the facing dart" (int d)
  | TablesWrong -> "this is no world"
  | WrongParts -> "the claim needs other parts before it"
  | OnlyDirectional -> "this needs a directional marker"
  | NothingClaimed -> "nothing is claimed"
  | DegreeIs degree -> say "here the degree is %d" (int degree)
  | SightingDiffers -> "here the sighting is another one"
  | DoorMissing i -> say "there is no door %d" (int i)
  | LengthsDiffer -> "something is missing, or too much: a door of the walk, or a choice of a visit"
  | GivesAll d -> say "from dart %d the walk gives these percepts" (int d)
  | NoVisit k -> say "there is no visit %d" (int k)
  | NoMove m -> say "there is no move %d" (int m)
  | NoDoor (k, i) -> say "there is no door %d at visit %d" (int i) (int k)
  | NotPointing k -> say "at visit %d no directional marker was seen" (int k)
  | NotOne -> "the darts from which these passages leave are not known to be one"
  | TwoDoors -> "these darts are two doors of one vertex: this would be a contradiction"
  | OtherDegree -> "these darts were seen at vertices of different degrees: this would be a contradiction"
  | Open (k, i) -> say "the trail is not complete: door %d of visit %d is open" (int i) (int k)
  | NoContradiction -> "this is no contradiction"
  | NotOneVertex -> "these visits are not known to be one vertex"
  | PerceptsDiffer (p, q) -> say "the percepts of darts %d and %d differ" (int p) (int q)
  | NoPair (p, q) -> say "some door leads from darts %d and %d to no pair" (int p) (int q)
  | PerceptsSame -> "the percepts at the end are the same"
  | NoImage d -> say "dart %d has no image" (int d)
  | NotKept d -> say "the edges, or the order clockwise, are not kept at dart %d" (int d)
  | ImageShared d -> say "another dart has the image of dart %d" (int d)
  | ImageTwice -> "a dart has an image twice"
  | WalksTooMany -> "a dart of the second world has two walks"
  | PosesLeftOut d -> say "dart %d of the second world is left out" (int d)
  | NoAlternative n -> say "there is no alternative %d" (int n)
  | NotSo -> "the robot does not do or perceive this"
  | VisitsMade -> "a robot from one of these poses makes these visits"
  | ChoiceMissing -> "the next alternative has to be chosen, or a contradiction has to end this choice"
  | OtherPose d -> say "the pose %d in the first world is not that of the first walk" (int d)

let proved s c =
  let visits_made () = match s.visits_line with Some visits -> List.length visits | None -> 0 in
  let edges () = match s.worlds with t :: _ -> List.length t.edge_lines | [] -> 0 in
  let visits () = match s.walk_line with Some w -> List.length w.see_lines | None -> 0 in
  let way () =
    match s.run_line with
    | Some r -> say "%d actions" (List.length r.deed_lines)
    | None -> say "%d visits" (visits ()) in
  match c with
  | Determined _ -> say "determined: %d edges, %d visits" (edges ()) (visits ())
  | Unexplained (steps, _) -> say "unexplained: %d visits, %d steps" (visits ()) (List.length steps)
  | Conforms _ -> say "conforms: %d edges, %s" (edges ()) (way ())
  | Diverges None -> say "diverges: %d edges, %s, from any pose" (edges ()) (way ())
  | Diverges (Some poses) -> say "diverges: %s, from %d poses" (way ()) (List.length poses)
  | Fits _ -> say "fits: %d edges, %d visits" (edges ()) (visits_made ())
  | Misfits _ -> say "misfits: %d edges, %d visits" (edges ()) (visits_made ())
  | Impossible found -> say "impossible: %d visits, %d lines" (visits_made ()) (List.length found)
  | Indistinguishable pairs -> say "indistinguishable: %d pairs" (List.length pairs)
  | Distinguishable walks -> say "distinguishable: %d walks" (List.length walks)
  | Isomorphic _ -> say "isomorphic: %d edges" (edges ())
  | NotIsomorphic walks -> say "not-isomorphic: %d walks" (List.length walks)

let not_proved line what = raise (Wrong (line, "not proved: " ^ what))

(* A proof: reads it, and checks each claim when it is read. Returns the number of claims. *)
let proof print r =
  expect r "toposlam-proof 1";
  let rec worlds found =
    if r.words = Some [ "world" ] then
      if List.length found = 2 then malformed r "there are at most two worlds" else worlds (world r :: found)
    else List.rev found
  in
  let worlds = worlds [] in
  let (marker_line, aid_line), _ =
    line r "world, marker KIND or aid KIND" (function
      | [ "marker"; kind ] -> Option.map (fun marker -> (marker, None)) (List.assoc_opt kind markers)
      | [ "aid"; kind ] -> Option.map (fun aid -> (WordNone, Some aid)) (List.assoc_opt kind aids)
      | _ -> None) in
  let ran = Option.map (run r) aid_line in
  let walked = if aid_line = None && r.words = Some [ "walk" ] then Some (walk r) else None in
  let visits_line = if aid_line = None && r.words = Some [ "visits" ] then Some (visits r) else None in
  let walk_line = Option.map fst walked and run_line = Option.map fst ran in
  (* The lines of what was perceived, or done. *)
  let followed = match (walked, ran) with Some (_, at), _ | None, Some (_, at) -> Some at | None, None -> None in
  let s = { worlds = items worlds; marker_line; walk_line; visits_line; run_line } in
  let prepared = prepare s in
  let rec claims count =
    match r.words with
    | Some [ "claim"; kind ] ->
        let at = taken r in
        let c, parts = claim r kind in
        expect r "end";
        (match check prepared c with
        | Accepted -> print ("proved: " ^ proved s c)
        | Refused (place, reason) ->
            let line =
              match (place, followed) with
              | InWorld i, _ -> (places worlds).(int i)
              | AtVisit k, Some at when int k < Array.length at -> at.(int k)
              | AtPart k, _ when int k < Array.length parts -> parts.(int k)
              | _ -> at
            in
            not_proved line (why reason));
        claims (count + 1)
    | _ when count = 0 -> malformed r "claim KIND is expected here"
    | _ -> count
  in
  claims 0

(* The number of claims of a file, or what is wrong first. *)
let file print name =
  let channel = if name = "-" then stdin else open_in_bin name in
  let r = { channel; line = 0; words = None } in
  let rec proofs count = if r.words = None then count else proofs (count + proof print r) in
  let read () =
    match advance r; proofs 0 with
    | 0 -> Error (1, "not proved: there is no claim")
    | count -> Ok count
    | exception Wrong (line, what) -> Error (line, what)
  in
  Fun.protect read ~finally:(fun () -> if name <> "-" then close_in_noerr channel)

let check_all files =
  let claims (count, all) name =
    match file print_endline name with
    | Ok claims -> (count + claims, all)
    | Error (line, what) -> Printf.printf "%s:%d: %s\n" name line what; (count, false)
  in
  let count, all = List.fold_left claims (0, true) files in
  if all then Printf.printf "proved: %d claim%s\n" count (if count = 1 then "" else "s");
  all

let verdicts files =
  let accepted name =
    let accepted = Result.is_ok (file ignore name) in
    print_endline ((if accepted then "accepted " else "refused ") ^ name);
    accepted
  in
  List.fold_left (fun all name -> accepted name && all) true files

let () =
  let usage = "usage: toposlam-proof-check [--verdicts] FILE...   (- is the standard input)" in
  try
    match List.tl (Array.to_list Sys.argv) with
    | [ ("-h" | "--help") ] -> print_endline usage
    | [] | [ "--verdicts" ] -> prerr_endline usage; exit 2
    | "--verdicts" :: files -> if not (verdicts files) then exit 1
    | files -> if not (check_all files) then exit 1
  with Sys_error what -> prerr_endline ("error: " ^ what); exit 2
