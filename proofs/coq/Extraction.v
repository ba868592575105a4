(** Algorithm 1 as a program of OCaml, which [compare/main.ml] runs and a test compares with the one of
    toposlam, on every small start.

    Trusted is what Coq's extraction does, and that booleans, options, pairs and lists are OCaml's own.
    Numbers are not replaced: they are Coq's [nat], with Coq's arithmetic. *)

From Coq Require Extraction ExtrOcamlBasic.
From toposlam Require Import Spec Program Algorithm1.

(** The program has its choices left open; [compare/main.ml] takes the defaults. *)
Definition mapping := algorithm1 any_path.

Extraction Language OCaml.
(* That the proofs of comparisons are looked into, and some names of theirs, is of no account: no value
   depends on them. *)
Set Warnings "-extraction-opaque-accessed,-extraction-reserved-identifier".
Extraction "algorithm1.ml" mapping.
