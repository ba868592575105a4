(** The checker of proofs of verdicts as an OCaml program, which [checker/main.ml] runs. This trusts Coq's extraction,
    and its mapping of booleans, options, pairs and lists to OCaml's own. Numbers are not mapped: they are Coq's binary
    ones, with Coq's arithmetic. *)

From mathcomp Require Import all_ssreflect.
From Coq Require Extraction ExtrOcamlBasic.
From toposlam Require Import Checker.

Extraction Language OCaml.
Set Warnings "-extraction-opaque-accessed,-extraction-reserved-identifier".
Extraction "checker.ml" prepare check.
