(* Checks proofs of verdicts with the program that is extracted from Checker.v. This file reads the format of
   docs/proofs-of-verdicts.md, and refuses everything else.

     toposlam-proof-check FILE...      (- is the standard input)

   Prints a line for each claim that is proved, or FILE:LINE: and why it is not. Exit codes: 0 every claim is proved,
   1 one is not, or a file is malformed, 2 bad usage, or a file cannot be read. *)

open Checker

exception Malformed of int * string

(* Numbers *)

let rec positive i = if i = 1 then XH else if i land 1 = 0 then XO (positive (i lsr 1)) else XI (positive (i lsr 1))
let number i = if i = 0 then N0 else Npos (positive i)
let rec int_of = function XH -> 1 | XO p -> 2 * int_of p | XI p -> (2 * int_of p) + 1
let int = function N0 -> 0 | Npos p -> int_of p

(* Lines *)

type reader = { channel : in_channel; mutable line : int; mutable words : string list option; mutable last : int }

let malformed r what = raise (Malformed (r.line, what))

(* Goes to the next line that is no remark; at the end of the file there are no words. *)
let rec advance r =
  let before = pos_in r.channel in
  match input_line r.channel with
  | exception End_of_file -> r.line <- r.line + 1; r.words <- None
  | text ->
      r.line <- r.line + 1;
      if pos_in r.channel - before = String.length text then malformed r "the last line does not end";
      if text <> "" && text.[0] = '#' then advance r
      else r.words <- Some (String.split_on_char ' ' text)

(* The number of a line that was read, when the reader goes on to the next. *)
let taken r = r.last <- r.line; advance r; r.last

let number_of r word =
  let digits = String.length word in
  let is_digit c = '0' <= c && c <= '9' in
  if digits = 0 || not (String.for_all is_digit word) || (digits > 1 && word.[0] = '0') then
    malformed r (Printf.sprintf "%S is no number" word);
  if digits > 18 then malformed r ("the number " ^ word ^ " is too large");
  number (int_of_string word)

let numbers r words = List.rev (List.rev_map (number_of r) words)

let expect r words =
  if r.words <> Some words then malformed r (Printf.sprintf "%S is expected here" (String.concat " " words));
  ignore (taken r)

(* The lines as long as they are of one kind, each with its number. *)
let lines r line =
  let rec go found =
    match r.words with
    | None -> List.rev found
    | Some words -> (
        match line words with
        | None -> List.rev found
        | Some item -> let at = taken r in go ((item, at) :: found))
  in
  go []

let items found = List.rev (List.rev_map (fun (item, _) -> item) found)
let places found = Array.of_list (List.rev (List.rev_map (fun (_, at) -> at) found))

(* The parts of a proof *)

let world r =
  let at = taken r in
  let vertices =
    lines r (function "vertex" :: (_ :: _ as darts) -> Some (numbers r darts) | _ -> None) in
  let edges =
    lines r (function [ "edge"; d; e ] -> Some (number_of r d, number_of r e) | _ -> None) in
  match r.words with
  | Some [ "facing"; d ] ->
      let facing_line = number_of r d in
      ignore (taken r);
      ({ vertex_lines = items vertices; edge_lines = items edges; facing_line }, at)
  | _ -> malformed r "a world has the lines vertex D..., edge D E and facing D"

let markers =
  [ ("none", WordNone); ("undirected", WordUndirected); ("directional", WordDirectional);
    ("undirected-edge", WordUndirectedEdge); ("directed-edge", WordDirectedEdge);
    ("two-identical", WordTwoIdentical); ("two-distinct", WordTwoDistinct) ]

let sightings =
  [ ("nothing", WordNothing); ("lying", WordLying); ("two", WordTwo); ("first", WordFirst); ("second", WordSecond);
    ("both", WordBoth); ("passed", WordPassed); ("along", WordAlong); ("against", WordAgainst) ]

let walk r =
  ignore (taken r);
  let rec go seen doors places =
    let degree, sighting =
      match r.words with
      | Some [ "see"; degree; "pointing"; i ] -> (number_of r degree, WordPointing (number_of r i))
      | Some [ "see"; degree; word ] when List.mem_assoc word sightings ->
          (number_of r degree, List.assoc word sightings)
      | _ -> malformed r "what was perceived is expected here: see DEGREE SIGHTING"
    in
    let seen = (degree, sighting) :: seen and places = taken r :: places in
    match r.words with
    | Some [ "door"; i ] ->
        let i = number_of r i in
        ignore (taken r);
        go seen (i :: doors) places
    | _ -> ({ see_lines = List.rev seen; door_lines = List.rev doors }, Array.of_list (List.rev places))
  in
  go [] [] []

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

let pair r word = function [ first; p; q ] when first = word -> Some (number_of r p, number_of r q) | _ -> None

let from_dart r =
  match r.words with
  | Some [ "from"; d ] -> let d = number_of r d in ignore (taken r); d
  | _ -> malformed r "the pose is expected here: from D"

(* Walks from two poses. *)
let walks r =
  let rec go found =
    match r.words with
    | Some [ "from"; p; q ] ->
        let pose = (number_of r p, number_of r q) in
        let at = taken r in
        let doors = lines r (function [ "door"; i ] -> Some (number_of r i) | _ -> None) in
        go (((pose, items doors), at) :: found)
    | _ -> List.rev found
  in
  go []

(* A claim, with the numbers of the lines of its parts. *)
let claim r kind =
  match kind with
  | "determined" ->
      let from = from_dart r in
      let steps = lines r (step r) in
      (Determined (from, items steps), places steps)
  | "unexplained" ->
      let steps = lines r (step r) in
      let last = match r.words with Some words -> contradiction r words | None -> None in
      (match last with
      | None -> malformed r "a step or a contradiction is expected here"
      | Some last -> let at = taken r in (Unexplained (items steps, last), Array.append (places steps) [| at |]))
  | "conforms" -> (Conforms (from_dart r), [||])
  | "diverges" -> (
      match r.words with
      | Some [ "from"; "any" ] -> ignore (taken r); (Diverges None, [||])
      | Some ("from" :: (_ :: _ as poses)) ->
          let poses = numbers r poses in
          ignore (taken r); (Diverges (Some poses), [||])
      | _ -> malformed r "the poses are expected here: from D... or from any")
  | "indistinguishable" -> let pairs = lines r (pair r "pair") in (Indistinguishable (items pairs), places pairs)
  | "distinguishable" -> let walks = walks r in (Distinguishable (items walks), places walks)
  | "isomorphic" -> let images = lines r (pair r "image") in (Isomorphic (items images), places images)
  | "not-isomorphic" -> let walks = walks r in (NotIsomorphic (items walks), places walks)
  | _ -> malformed r (Printf.sprintf "there is no claim %S" kind)

(* What is said *)

let say = Printf.sprintf

let why = function
  | NoEdge -> "a world has an edge"
  | DartTwice d -> say "dart %d stands in two places of the vertices" (int d)
  | NoDart d -> say "there is no dart %d: the darts are the numbers from 0 on, each in one vertex" (int d)
  | EdgesDiffer d -> say "dart %d does not stand in one edge" (int d)
  | NotConnected d -> say "dart %d is not reached from the facing dart" (int d)
  | TablesWrong -> "this is no world"
  | WrongParts -> "the claim needs another number of worlds, or a walk"
  | OnlyDirectional -> "this needs a directional marker"
  | NothingClaimed -> "nothing is claimed"
  | DegreeIs degree -> say "here the degree is %d" (int degree)
  | SightingDiffers -> "here the sighting is another one"
  | DoorMissing i -> say "there is no door %d" (int i)
  | LengthsDiffer -> "a walk has a door between any two percepts"
  | GivesAll d -> say "from dart %d the walk gives these percepts" (int d)
  | NoVisit k -> say "there is no visit %d" (int k)
  | NoMove m -> say "there is no move %d" (int m)
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
  | PosesLeftOut d -> say "dart %d of the second world is left out" (int d)
  | OtherPose d -> say "the pose %d in the first world is not that of the first walk" (int d)

let proved s c =
  let edges () = match s.worlds with t :: _ -> List.length t.edge_lines | [] -> 0 in
  let visits () = match s.walk_line with Some w -> List.length w.see_lines | None -> 0 in
  match c with
  | Determined _ -> say "determined: %d edges, %d visits" (edges ()) (visits ())
  | Unexplained (steps, _) -> say "unexplained: %d visits, %d steps" (visits ()) (List.length steps)
  | Conforms _ -> say "conforms: %d edges, %d visits" (edges ()) (visits ())
  | Diverges None -> say "diverges: %d edges, %d visits, from any pose" (edges ()) (visits ())
  | Diverges (Some poses) -> say "diverges: %d visits, from %d poses" (visits ()) (List.length poses)
  | Indistinguishable pairs -> say "indistinguishable: %d pairs" (List.length pairs)
  | Distinguishable walks -> say "distinguishable: %d walks" (List.length walks)
  | Isomorphic _ -> say "isomorphic: %d edges" (edges ())
  | NotIsomorphic walks -> say "not-isomorphic: %d walks" (List.length walks)

exception Not_proved of int * string

(* A proof: reads it, and checks each claim when it is read. Returns the number of claims. *)
let proof r =
  expect r [ "toposlam-proof"; "1" ];
  let rec worlds found =
    if r.words = Some [ "world" ] then
      if List.length found = 2 then malformed r "there are at most two worlds" else worlds (world r :: found)
    else List.rev found
  in
  let worlds = worlds [] in
  let marker_line =
    match r.words with
    | Some [ "marker"; kind ] when List.mem_assoc kind markers -> ignore (taken r); List.assoc kind markers
    | _ -> malformed r "a world, or the kind of the marker, is expected here"
  in
  let walked = if r.words = Some [ "walk" ] then Some (walk r) else None in
  let walk_line = match walked with Some (w, _) -> Some w | None -> None in
  let s = { worlds = items worlds; marker_line; walk_line } in
  let prepared = prepare s in
  let rec claims count =
    match r.words with
    | Some [ "claim"; kind ] ->
        let at = taken r in
        let c, parts = claim r kind in
        expect r [ "end" ];
        (match check prepared c with
        | Accepted -> print_endline ("proved: " ^ proved s c)
        | Refused (place, reason) ->
            let line =
              match (place, walked) with
              | InWorld i, _ -> (places worlds).(int i)
              | AtVisit k, Some (_, seen) when int k < Array.length seen -> seen.(int k)
              | AtPart k, _ when int k < Array.length parts -> parts.(int k)
              | _ -> at
            in
            raise (Not_proved (line, why reason)));
        claims (count + 1)
    | _ when count = 0 -> malformed r "a claim is expected here"
    | _ -> count
  in
  claims 0

let file name =
  let channel = if name = "-" then stdin else open_in_bin name in
  if name = "-" then set_binary_mode_in stdin true;
  let r = { channel; line = 0; words = None; last = 0 } in
  let refused line what = Printf.printf "%s:%d: %s\n" name line what; exit 1 in
  try
    advance r;
    let rec proofs count = if r.words = None then count else proofs (count + proof r) in
    let count = proofs 0 in
    if count = 0 then raise (Not_proved (1, "there is no claim"));
    if name <> "-" then close_in channel;
    count
  with
  | Malformed (line, what) -> refused line ("malformed: " ^ what)
  | Not_proved (line, what) -> refused line ("not proved: " ^ what)

let () =
  let usage = "usage: toposlam-proof-check FILE...   (- is the standard input)" in
  match List.tl (Array.to_list Sys.argv) with
  | [] -> prerr_endline usage; exit 2
  | [ ("-h" | "--help") ] -> print_endline usage
  | names -> (
      try
        let count = List.fold_left (fun count name -> count + file name) 0 names in
        Printf.printf "proved: %d claims\n" count
      with Sys_error what -> prerr_endline ("error: " ^ what); exit 2)
