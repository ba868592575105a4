//! The harnesses for Kani, where there is no Kani: that they compile against a stand-in for its
//! library, that they are those of the table, and that the scripts believe Kani only where it
//! proves something. Nothing here says that a lemma holds.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

use std::{
    collections::{BTreeMap, BTreeSet},
    env, fs,
    io::Write,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::LazyLock,
};

use toposlam_proofs::Lemma;

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A folder of ours under the target directory.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("harnesses").join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The harnesses of the table, as Kani names them, each with its unwinding.
fn table() -> BTreeSet<String> {
    let harnesses = Lemma::all().filter_map(|lemma| lemma.kani.as_ref());
    harnesses.map(|kani| format!("{} {}", within(kani.harness), kani.unwind)).collect()
}

/// A path within the crate: Kani leaves its name out.
fn within(path: &str) -> &str {
    path.strip_prefix("toposlam_proofs::").expect("it is in this crate")
}

mod types {
    use super::*;

    fn rustc() -> Command {
        let mut rustc = Command::new(env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
        rustc.args(["--edition", "2024", "-D", "warnings"]);
        rustc
    }

    /// Runs the compiler, and answers what it says if it refuses.
    fn run(rustc: &mut Command) -> Result<(), String> {
        let Output { status, stderr, .. } = rustc.output().unwrap();
        if status.success() { Ok(()) } else { Err(String::from_utf8(stderr).unwrap()) }
    }

    /// The folder of the stand-in, and what cargo made of the model.
    static DEPENDENCIES: LazyLock<(PathBuf, PathBuf)> = LazyLock::new(|| {
        let folder = scratch("stand_in");
        let crates = [
            ("kani_macros", "macros.rs", "proc-macro", "proc_macro"),
            ("kani", "kani.rs", "lib", "kani_macros"),
        ];
        for (name, source, kind, dependency) in crates {
            let made = run(rustc()
                .args(["--crate-name", name, "--crate-type", kind, "--extern", dependency])
                .args(["--out-dir".as_ref(), folder.as_os_str(), "-L".as_ref(), folder.as_os_str()])
                .arg(here("kani").join(source)));
            assert_eq!(made, Ok(()));
        }
        // Only the last crate is compiled for Kani: others have `cfg(kani)` of their own.
        let cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| env!("CARGO").into()))
            .args(["check", "--lib", "-p", "toposlam-model", "--locked", "--offline"])
            .args(["--message-format", "json", "--target-dir"])
            .arg(scratch("model"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        assert!(cargo.status.success(), "{}", String::from_utf8(cargo.stderr).unwrap());
        let messages = String::from_utf8(cargo.stdout).unwrap();
        let model = messages
            .split('"')
            .find(|word| word.contains("libtoposlam_model-") && word.contains(".rmeta"))
            .expect("cargo says what it made");
        (folder, model.into())
    });

    /// Checks the types of the library in this folder as Kani would have it compiled, and answers
    /// its harnesses with their unwindings.
    fn compile(library: &Path, output: &Path) -> Result<BTreeSet<String>, String> {
        let (stand_in, model) = &*DEPENDENCIES;
        let others = model.parent().unwrap();
        run(rustc()
            .args(["--crate-name", "toposlam_proofs", "--crate-type", "lib", "-F", "unsafe_code"])
            .args(["--cfg", "kani", "--check-cfg", "cfg(kani, test)", "--extern", "kani"])
            .arg("-L")
            .arg(stand_in)
            .arg("--extern")
            .arg(format!("toposlam_model={}", model.display()))
            .arg("-L")
            .arg(format!("dependency={}", others.display()))
            .args(["--emit", "dep-info,metadata", "--out-dir"])
            .arg(output)
            .arg(library.join("lib.rs")))?;
        let noted = fs::read_to_string(output.join("toposlam_proofs.d")).unwrap();
        let marks = |mark: &'static str| {
            noted
                .lines()
                .filter_map(move |line| line.strip_prefix("# env-dep:")?.strip_prefix(mark))
        };
        let proofs: BTreeSet<_> = marks("kani::proof ").collect();
        let unwound: BTreeMap<_, _> =
            marks("kani::unwind ").map(|mark| mark.rsplit_once(' ').unwrap()).collect();
        assert_eq!(proofs, unwound.keys().copied().collect(), "each harness has its unwinding");
        Ok(unwound.iter().map(|(path, times)| format!("{} {times}", within(path))).collect())
    }

    /// Compiles a copy of the library in which one file is otherwise.
    fn compile_with(
        name: &str,
        file: &str,
        change: impl FnOnce(&str) -> String,
    ) -> Result<BTreeSet<String>, String> {
        let copy = scratch(name);
        let source = here("src");
        for folder in ["", "lemmas"] {
            fs::create_dir_all(copy.join(folder)).unwrap();
            for entry in fs::read_dir(source.join(folder)).unwrap() {
                let entry = entry.unwrap();
                if entry.file_type().unwrap().is_file() {
                    fs::copy(entry.path(), copy.join(folder).join(entry.file_name())).unwrap();
                }
            }
        }
        let text = fs::read_to_string(source.join(file)).unwrap();
        let changed = change(&text);
        assert_ne!(changed, text, "there is something to change");
        fs::write(copy.join(file), changed).unwrap();
        compile(&copy, &copy)
    }

    /// Sees that the library with this change is refused, for this reason, in this file.
    fn refused(name: &str, file: &str, old: &str, new: &str, reason: &str) {
        let said = compile_with(name, file, |text| text.replacen(old, new, 1)).unwrap_err();
        let place = format!("--> {}:", scratch(name).join(file).display());
        let lines: Vec<_> = said.lines().collect();
        let there = |pair: &[&str]| pair[0] == reason && pair[1].trim().starts_with(&place);
        assert!(lines.windows(2).any(there), "{said}");
    }

    #[test]
    fn the_harnesses_of_the_table_compile_and_there_are_no_others() {
        assert_eq!(compile(&here("src"), &scratch("library")), Ok(table()));
    }

    #[test]
    fn a_lemma_that_does_not_fit_its_harness_is_noticed() {
        let lemmas = here("src/lemmas");
        let mut files: Vec<_> =
            fs::read_dir(&lemmas).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        files.sort();
        let harness = "        kani \"";
        let file = files
            .into_iter()
            .find(|file| fs::read_to_string(lemmas.join(file)).unwrap().contains(harness))
            .expect("some lemma has a harness");
        let file = format!("lemmas/{}", file.to_str().unwrap());
        let said = compile_with("unfit_lemma", &file, |text| {
            let (before, clause) = text.split_once(harness).unwrap();
            let (bound, rest) = clause.split_once("unwind").unwrap();
            let (unwind, rest) = rest.split_once(':').unwrap();
            let (_, after) = rest.split_once(';').unwrap();
            format!("{before}{harness}{bound}unwind{unwind}: crate::draw::byte;{after}")
        })
        .unwrap_err();
        assert!(said.starts_with("error[E0308]: mismatched types\n"), "{said}");
        let place = format!("::: {}:", scratch("unfit_lemma").join(file).display());
        assert!(said.contains(&place), "{said}");
    }

    #[test]
    fn a_harness_that_does_not_come_up_is_missed() {
        let without = |text: &str| text.replace("#[kani::proof]", "#[cfg(any())]");
        assert_eq!(compile_with("lost", "lemma.rs", without), Ok(BTreeSet::new()));
    }

    #[test]
    fn a_harness_with_an_argument_is_refused() {
        let reason = "error: functions used as harnesses cannot have any arguments";
        refused("argument", "lemma.rs", "fn kani() {", "fn kani(_given: u8) {", reason);
    }

    #[test]
    fn a_generic_harness_is_refused() {
        let reason = "error: the `proof` attribute cannot be applied to generic functions";
        refused("generic", "lemma.rs", "fn kani() {", "fn kani<const N: u8>() {", reason);
    }

    #[test]
    fn an_unwinding_that_is_no_integer_is_refused() {
        let reason = "error: invalid argument for `unwind` attribute, expected an integer";
        refused("unwind", "lemma.rs", "::unwind($unwind)", "::unwind(-$unwind)", reason);
    }

    #[test]
    fn a_cover_without_a_condition_is_refused() {
        refused(
            "cover",
            "lemma.rs",
            "cover!(holds,",
            "cover!(1,",
            "error[E0308]: mismatched types",
        );
    }

    #[test]
    fn a_symbol_of_a_type_that_kani_has_no_symbols_of_is_refused() {
        let reason = "error[E0277]: the trait bound `String: Arbitrary` is not satisfied";
        let string = "kani::any::<String>().len() as u8";
        refused("arbitrary", "symbolic.rs", "kani::any()", string, reason);
    }

    #[test]
    fn what_the_library_of_kani_does_not_have_is_refused() {
        let reason = "error[E0425]: cannot find function `suppose` in crate `kani`";
        refused("unknown", "symbolic.rs", "kani::assume(", "kani::suppose(", reason);
    }

    #[test]
    fn a_warning_in_a_harness_is_refused() {
        let reason = "error: unused variable: `unused`";
        let driver = "let unused = 0; kani::assume(";
        refused("warning", "symbolic.rs", "kani::assume(", driver, reason);
    }
}

mod scripts {
    use super::*;

    const NAME: &str = "lemmas::retracing::the_way_back_retraces_the_path::kani";

    /// What Kani says of a harness that it verified.
    const VERIFIED: &str = "\
Kani Rust Verifier 0.68.0 (cargo plugin)
CBMC 6.11.0
    Finished `dev` profile [unoptimized + debuginfo] target(s) in 9.45s
Checking harness lemmas::retracing::the_way_back_retraces_the_path::kani...
CBMC version 6.11.0 (cbmc-6.11.0) 64-bit x86_64 linux
Reading GOTO program from file
Generating GOTO Program
Runtime decision procedure: 0.0123s

RESULTS:
Check 1: lemmas::retracing::the_way_back_retraces_the_path::kani.assertion.1
\t - Status: SUCCESS
\t - Description: \"assertion failed: holds\"
\t - Location: proofs/src/lemmas/retracing.rs:15:1 in function kani

Check 2: lemmas::retracing::the_way_back_retraces_the_path::kani.cover.1
\t - Status: SATISFIED
\t - Description: \"there is a case\"
\t - Location: proofs/src/lemmas/retracing.rs:15:1 in function kani


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
    fn a_verified_harness_whose_covers_are_satisfied_is_believed() {
        assert_eq!(refusal(VERIFIED), None);
    }

    #[test]
    fn colours_do_not_matter() {
        let coloured = "VERIFICATION:- \u{1b}[32mSUCCESSFUL\u{1b}[0m";
        assert_eq!(refusal(&VERIFIED.replace("VERIFICATION:- SUCCESSFUL", coloured)), None);
    }

    #[test]
    fn a_failed_harness_is_refused() {
        let failed = VERIFIED
            .replace("Status: SUCCESS\n", "Status: FAILURE\n")
            .replace("0 of 98 failed (1 unreachable)", "1 of 98 failed")
            .replace("- SUCCESSFUL", "- FAILED")
            .replace("- 1 successfully", "- 0 successfully")
            .replace("0 failures", "1 failures");
        assert_refused(&failed, &[CHECKS, VERDICT, COMPLETE]);
    }

    #[test]
    fn a_cover_that_is_not_satisfied_is_refused_though_the_verdict_is_success() {
        let unsatisfiable = VERIFIED
            .replace("SATISFIED", "UNSATISFIABLE")
            .replace("1 of 1 cover properties satisfied", "0 of 1 cover properties satisfied");
        assert_refused(&unsatisfiable, &[COVERS]);
        let one_of_two = VERIFIED.replace("1 of 1 cover", "1 of 2 cover");
        assert_refused(&one_of_two, &[COVERS]);
        let unreachable = VERIFIED.replace("SATISFIED", "UNREACHABLE").replace(
            "1 of 1 cover properties satisfied",
            "0 of 1 cover properties satisfied (1 unreachable)",
        );
        assert_refused(&unreachable, &[COVERS]);
        let none = VERIFIED.replace(" ** 1 of 1 cover properties satisfied\n", "");
        assert_refused(&none, &[COVERS]);
    }

    #[test]
    fn a_harness_without_checks_is_refused() {
        assert_refused(&VERIFIED.replace("0 of 98 failed", "0 of 0 failed"), &[CHECKS]);
    }

    #[test]
    fn a_panic_that_was_expected_is_refused() {
        let expected = "SUCCESSFUL (encountered one or more panics as expected)";
        assert_refused(&VERIFIED.replace("SUCCESSFUL", expected), &[VERDICT]);
    }

    #[test]
    fn no_harness_is_refused() {
        let all = [CHECKED, CHECKS, COVERS, VERDICT, COMPLETE];
        let none = format!(
            "Kani Rust Verifier 0.68.0 (cargo plugin)\nManual Harness Summary:\n\
             error: no harnesses matched the harness filter: `{NAME}`\n"
        );
        assert_refused(&none, &all);
        let none = "No proof harnesses (functions with #[kani::proof]) were found to verify.\n";
        assert_refused(none, &all);
    }

    #[test]
    fn another_harness_or_two_are_refused() {
        let other = VERIFIED.replace(NAME, "lemmas::other::kani");
        assert_refused(&other, &[CHECKED]);
        let longer = VERIFIED.replace(NAME, &format!("{NAME}_too"));
        assert_refused(&longer, &[CHECKED]);
        let (one, end) = VERIFIED.split_once("Manual").unwrap();
        let two = format!("{one}{one}Manual{end}").replace("Complete - 1 ", "Complete - 2 ");
        assert_refused(&two, &[CHECKED, CHECKS, COVERS, VERDICT, COMPLETE]);
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
        let table = table().into_iter().map(|row| row + "\n").collect::<String>();
        assert!(listed == table, "kani/harnesses.txt must be:\n{table}");
        let output = script("verify", &["--list"], "");
        let names: Vec<_> = table.lines().map(|row| row.split_once(' ').unwrap().0).collect();
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().collect::<Vec<_>>(), names);
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
        let table = table();
        let mut names: Vec<_> = table.iter().map(|row| row.split_once(' ').unwrap().0).collect();
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
        let table = table();
        let names: Vec<_> = table.iter().map(|row| row.split_once(' ').unwrap().0).collect();
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
    fn the_script_asks_kani_for_every_harness_and_believes_it_only_through_the_gate() {
        let table = table();
        let count = table.len();
        let one = table.first().unwrap().split_once(' ').unwrap().0;
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
}
