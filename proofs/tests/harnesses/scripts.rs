//! That the scripts accept Kani's result only where it proves something, and ask it for every harness.

use std::{
    env, fs,
    io::Write,
    process::{Command, Output, Stdio},
};

use super::{here, scratch, table};

const NAME: &str = "lemmas::arithmetic::doors_stay_in_their_range::kani";

/// What Kani says of a harness that it verified.
const VERIFIED: &str = "\
Kani Rust Verifier 0.68.0 (cargo plugin)
CBMC 6.11.0
    Finished `dev` profile [unoptimized + debuginfo] target(s) in 9.45s
Checking harness lemmas::arithmetic::doors_stay_in_their_range::kani...
CBMC version 6.11.0 (cbmc-6.11.0) 64-bit x86_64 linux
Reading GOTO program from file
Generating GOTO Program
Runtime decision procedure: 0.0123s

RESULTS:
Check 1: lemmas::arithmetic::doors_stay_in_their_range::kani.assertion.1
\t - Status: SUCCESS
\t - Description: \"assertion failed: holds\"
\t - Location: proofs/src/lemmas/arithmetic.rs:17:1 in function kani

Check 2: lemmas::arithmetic::doors_stay_in_their_range::kani.cover.1
\t - Status: SATISFIED
\t - Description: \"there is a case\"
\t - Location: proofs/src/lemmas/arithmetic.rs:17:1 in function kani


SUMMARY:
 ** 0 of 98 failed (1 unreachable)

 ** 1 of 1 cover properties satisfied


VERIFICATION:- SUCCESSFUL
Verification Time: 2.0123s

Manual Harness Summary:
Complete - 1 successfully verified harnesses, 0 failures, 1 total.
";

/// Gives a script this to read.
fn script(name: &str, arguments: &[&str], input: &str) -> Output {
    let mut child = Command::new("bash")
        .arg(here("kani").join(name))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    child.wait_with_output().unwrap()
}

/// Why the gate refuses what Kani says, if it does.
fn refusal(said: &str) -> Option<String> {
    let output = script("gate", &["run", NAME], said);
    assert_eq!(String::from_utf8(output.stdout).unwrap(), said, "it is passed on");
    let why = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.success(), why.is_empty(), "{why}");
    (!output.status.success()).then_some(why)
}

#[track_caller]
fn assert_refused(said: &str, reasons: &[&str]) {
    let given = refusal(said).expect("this is no proof");
    let given: Vec<_> = given.lines().map(|line| line.rsplit_once(": ").unwrap().1).collect();
    assert_eq!(given, reasons);
}

const CHECKED: &str = "not this harness was checked, or not it alone";
const CHECKS: &str = "not every check passed";
const COVERS: &str = "not every cover is satisfied, or there is none";
const VERDICT: &str = "the verdict is not that it is verified";
const COMPLETE: &str = "Kani did not complete, or not with one success";

#[test]
fn a_verified_harness_whose_covers_are_satisfied_is_accepted() {
    assert_eq!(refusal(VERIFIED), None);
}

#[test]
fn colours_do_not_matter() {
    let coloured = "VERIFICATION:- \u{1b}[32mSUCCESSFUL\u{1b}[0m";
    assert_eq!(refusal(&VERIFIED.replace("VERIFICATION:- SUCCESSFUL", coloured)), None);
}

/// Changes of [`VERIFIED`], and why the gate then refuses it.
type Refused = (&'static [[&'static str; 2]], &'static [&'static str]);

/// What Kani may say instead.
const REFUSED: [Refused; 10] = [
    // The harness fails.
    (
        &[
            ["Status: SUCCESS\n", "Status: FAILURE\n"],
            ["0 of 98 failed (1 unreachable)", "1 of 98 failed"],
            ["- SUCCESSFUL", "- FAILED"],
            ["- 1 successfully", "- 0 successfully"],
            ["0 failures", "1 failures"],
        ],
        &[CHECKS, VERDICT, COMPLETE],
    ),
    // A cover is not satisfied, though the verdict is success.
    (&[["SATISFIED", "UNSATISFIABLE"], ["1 of 1 cover", "0 of 1 cover"]], &[COVERS]),
    (&[["1 of 1 cover", "1 of 2 cover"]], &[COVERS]),
    (
        &[
            ["SATISFIED", "UNREACHABLE"],
            ["1 of 1 cover", "0 of 1 cover"],
            ["properties satisfied\n", "properties satisfied (1 unreachable)\n"],
        ],
        &[COVERS],
    ),
    (&[[" ** 1 of 1 cover properties satisfied\n", ""]], &[COVERS]),
    // There are no checks, or open ones.
    (&[["0 of 98 failed", "0 of 0 failed"]], &[CHECKS]),
    (&[["1 unreachable", "1 undetermined"]], &[CHECKS]),
    // A panic was expected.
    (&[["SUCCESSFUL", "SUCCESSFUL (encountered one or more panics as expected)"]], &[VERDICT]),
    // Another harness was checked.
    (&[[NAME, "lemmas::other::kani"]], &[CHECKED]),
    (&[["::kani...", "::kani_too..."]], &[CHECKED]),
];

#[test]
fn the_gate_refuses_what_proves_nothing() {
    for (changes, reasons) in REFUSED {
        let said = changes.iter().fold(VERIFIED.to_owned(), |said, [from, to]| {
            assert!(said.contains(from), "{from}");
            said.replace(from, to)
        });
        assert_refused(&said, reasons);
    }
    let (one, end) = VERIFIED.split_once("Manual").unwrap();
    let two = format!("{one}{one}Manual{end}").replace("Complete - 1 ", "Complete - 2 ");
    let unmatched = format!(
        "Kani Rust Verifier 0.68.0 (cargo plugin)\nManual Harness Summary:\n\
         error: no harnesses matched the harness filter: `{NAME}`\n"
    );
    let none = "No proof harnesses (functions with #[kani::proof]) were found to verify.\n";
    for said in [&two, &unmatched, none] {
        assert_refused(said, &[CHECKED, CHECKS, COVERS, VERDICT, COMPLETE]);
    }
}

#[test]
fn a_run_that_was_cut_short_is_refused_wherever_it_was_cut() {
    assert_refused("", &[CHECKED, CHECKS, COVERS, VERDICT, COMPLETE]);
    let lines: Vec<_> = VERIFIED.split_inclusive('\n').collect();
    for kept in 1..lines.len() {
        assert!(refusal(&lines[..kept].concat()).is_some(), "after {kept} lines");
    }
}

#[test]
fn the_list_of_names_is_that_of_the_table() {
    let listed = fs::read_to_string(here("kani/harnesses.txt")).unwrap();
    let row = |(name, unwind)| format!("{name} {unwind}\n");
    let rows: String = table().into_iter().map(row).collect();
    assert!(listed == rows, "kani/harnesses.txt must be:\n{rows}");
    let output = script("verify", &["--list"], "");
    assert!(String::from_utf8(output.stdout).unwrap().lines().eq(table().into_keys()));
}

/// What `cargo kani list --format json` writes of these harnesses.
fn list(names: &[&str]) -> String {
    let names = names.iter().map(|name| format!("      \"{name}\"")).collect::<Vec<_>>();
    format!(
        "{{\n  \"kani-version\": \"0.68.0\",\n  \"file-version\": \"0.1\",\n  \
         \"standard-harnesses\": {{\n    \"proofs/src/lemmas/all.rs\": [\n{}\n    ]\n  }},\n  \
         \"contract-harnesses\": {{}},\n  \"contracts\": [],\n  \"totals\": {{\n    \
         \"standard-harnesses\": {},\n    \"contract-harnesses\": 0,\n    \
         \"functions-under-contract\": 0,\n    \"contracts\": 0\n  }}\n}}",
        names.join(",\n"),
        names.len(),
    )
}

#[test]
fn kani_must_see_the_harnesses_of_the_table_and_no_others() {
    let accepted = |names: &[&str]| script("gate", &["names"], &list(names)).status.success();
    let mut names: Vec<_> = table().into_keys().collect();
    assert!(accepted(&names));
    names.reverse();
    assert!(accepted(&names));
    assert!(!accepted(&names[1..]));
    names.push("lemmas::other::kani");
    assert!(!accepted(&names));
    assert!(!script("gate", &["names"], "").status.success());
}

/// Runs a copy of `verify` where there is a Kani that says this of every harness it is asked
/// for, and ends with this code.
#[cfg(unix)]
fn verify(name: &str, arguments: &[&str], said: &str, code: u8) -> (Option<i32>, String) {
    use std::os::unix::fs::PermissionsExt;

    let folder = scratch(name);
    fs::create_dir_all(folder.join("kani")).unwrap();
    for file in ["verify", "gate", "harnesses.txt"] {
        fs::copy(here("kani").join(file), folder.join("kani").join(file)).unwrap();
    }
    let names: Vec<_> = table().into_keys().collect();
    let cargo = format!(
        "#!/usr/bin/env bash\n\
         case \"$*\" in\n\
         'kani --version') echo 'Kani Rust Verifier 0.68.0 (cargo plugin)' ;;\n\
         'kani list --format json') echo '{}' >kani-list.json ;;\n\
         'kani --exact --harness '*) sed \"s/NAME/$4/\" <<'END'\n{}END\nexit {code} ;;\n\
         *) exit 9 ;;\n\
         esac\n",
        list(&names),
        said.replace(NAME, "NAME"),
    );
    fs::write(folder.join("cargo"), cargo).unwrap();
    fs::set_permissions(folder.join("cargo"), fs::Permissions::from_mode(0o755)).unwrap();
    let output = Command::new("bash")
        .arg(folder.join("kani/verify"))
        .args(arguments)
        .env("PATH", format!("{}:{}", folder.display(), env::var("PATH").unwrap()))
        .output()
        .unwrap();
    (output.status.code(), String::from_utf8([output.stdout, output.stderr].concat()).unwrap())
}

#[cfg(unix)]
#[test]
fn the_script_asks_kani_for_every_harness_and_accepts_its_result_only_through_the_gate() {
    let table = table();
    let count = table.len();
    let (&one, _) = table.first_key_value().unwrap();
    let (code, said) = verify("verified", &[], VERIFIED, 0);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.ends_with(&format!("\n{count} of {count} harnesses verified\n")), "{said}");
    let (code, said) = verify("one", &[one], VERIFIED, 0);
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = verify("names", &["--names"], "", 0);
    assert_eq!(code, Some(0), "{said}");

    let vacuous = VERIFIED.replace("1 of 1 cover", "0 of 1 cover");
    let (code, said) = verify("vacuous", &[], &vacuous, 0);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains(&format!("\n0 of {count} harnesses verified\n")), "{said}");
    assert_eq!(verify("vacuous_one", &[one], &vacuous, 0).0, Some(1));
    assert_eq!(verify("exit_code", &[one], VERIFIED, 1).0, Some(1));
    assert_eq!(verify("no_such_name", &["kani"], VERIFIED, 0).0, Some(2));
}

#[test]
fn the_workflow_runs_the_version_and_the_harnesses_that_the_script_names() {
    let workflow = fs::read_to_string(here("../.github/workflows/kani.yml")).unwrap();
    let script = fs::read_to_string(here("kani/verify")).unwrap();
    let version = |text: &str, key: &str| {
        let (_, rest) = text.split_once(key).expect("it says the version");
        rest.split_whitespace().next().unwrap().to_owned()
    };
    assert_eq!(version(&workflow, "KANI: "), version(&script, "\nversion="));
    for command in ["verify --list", "verify --names", "verify \"$HARNESS\""] {
        assert!(workflow.contains(&format!("proofs/kani/{command}")), "{command}");
    }
}
