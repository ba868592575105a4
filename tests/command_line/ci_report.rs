//! SARIF logs of each verb that has verdicts: by the schema of the standard, and by what code scanning of GitHub asks
//! for beyond it (*SARIF support for code scanning*): it refuses a file in which a result has no place, and takes each
//! result for a problem.

use std::fs;

use serde_json::Value;

use super::Scratch;
use crate::repository;

/// A command, its exit code, and the kind and the place of its results.
type Reported = (&'static str, i32, &'static [(&'static str, &'static str)]);

const REPORTS: &[Reported] = &[
    ("check --edges 1..=2", 0, &[]),
    (
        "check --edges 1..=3 --explorer 'sh always.sh'",
        1,
        &[("fail", "always.sh"), ("open", "always.sh"), ("open", "always.sh")],
    ),
    ("check --edges 1 --explorer cat --failed f.toml", 1, &[("fail", "f.toml")]),
    ("check --edges 1 --explorer cat", 1, &[("fail", "c.sarif")]),
    (
        "check --from worlds/figure-1a.toml --limit 3moves --explorer 'sh forever.sh'",
        3,
        &[("open", "worlds/figure-1a.toml")],
    ),
    ("counterexample --max-edges 4 --marker directional --expect none", 0, &[]),
    ("counterexample --max-edges 4 --marker none --expect none", 1, &[("fail", "c.sarif")]),
    (
        "counterexample --max-edges 4 --marker none --expect none --html p.html",
        1,
        &[("fail", "p.html")],
    ),
    (
        "counterexample --max-edges 4 --marker none --expect none --out-dir w",
        1,
        &[("fail", "w/none-simple-1.toml")],
    ),
    ("proofs --run the_way_back", 0, &[]),
    ("conform run.jsonl ./run.jsonl", 0, &[]),
    ("conform run.jsonl wrong.jsonl", 1, &[("fail", "wrong.jsonl")]),
    ("conform run.jsonl --require-coverage dead-end", 3, &[("open", "run.jsonl")]),
];

/// A robot that goes around a ring of 3, and at its end.
const RING: &str = "\
    {\"degree\":2,\"marker\":0,\"door\":1}\n\
    {\"degree\":2,\"marker\":-1,\"door\":1}\n\
    {\"degree\":2,\"marker\":-1,\"door\":1}\n\
    {\"degree\":2,\"marker\":0,\"door\":null}\n";

#[test]
fn sarif_logs_fit_the_standard_and_code_scanning() {
    let schema = fs::read(repository("tests/sarif/sarif-schema-2.1.0.json")).unwrap();
    let mut schema: Value = serde_json::from_slice(&schema).unwrap();
    // The pattern of languages, which the logs do not have, is no regular expression: `]?` follows a `]`.
    for with_language in ["run", "toolComponent"] {
        schema["definitions"][with_language]["properties"]["language"] = Value::Bool(true);
    }
    let schema = jsonschema::validator_for(&schema).unwrap();
    let scratch = Scratch::new("ci_report");
    scratch.write("always.sh", "while read line; do echo '{\"door\":7}'; done");
    scratch.write("forever.sh", "while read line; do echo '{\"door\":0}'; done");
    scratch.write("run.jsonl", RING);
    scratch.write(
        "wrong.jsonl",
        RING.replacen("\"degree\":2,\"marker\":-1", "\"degree\":1,\"marker\":-1", 1),
    );
    for (line, code, expected) in REPORTS {
        let driver = if line.starts_with("conform") { " --driver anyone" } else { "" };
        scratch.out(&format!("{line}{driver} --report c.sarif"), *code);
        let log: Value = serde_json::from_str(&scratch.text("c.sarif")).unwrap();
        let misfit = schema.validate(&log).err().map(|misfit| misfit.to_string());
        assert_eq!(misfit, None, "{line}");
        let results = log["runs"][0]["results"].as_array().unwrap();
        let place = |result: &Value| {
            let place = &result["locations"][0]["physicalLocation"];
            assert_eq!(place["region"]["startLine"], 1, "{line}: {result}");
            place["artifactLocation"]["uri"].as_str().unwrap().to_owned()
        };
        let found: Vec<_> = results
            .iter()
            .map(|result| (result["kind"].as_str().unwrap(), place(result)))
            .collect();
        let expected: Vec<_> =
            expected.iter().map(|&(kind, place)| (kind, place.to_owned())).collect();
        assert_eq!(found, expected, "{line}");
        for (_, place) in found {
            assert!(scratch.path(&place).exists(), "{line}: {place}");
        }
    }
}
