//! Results for CI systems: JUnit XML, SARIF 2.1.0, and the annotations of GitHub Actions.
//!
//! A SARIF log has what code scanning of GitHub accepts: it takes each result for a problem, refuses a file in which a
//! result has no place, and shows a limited number of results and of letters.

use std::{
    env,
    fmt::Write as _,
    path::{Path, PathBuf},
    time::Instant,
};

use serde_json::{Value, json};
use sha2::{Digest, Sha256};
use toposlam_logs::hexadecimal;

use super::{CliError, Outcome, output, terminal, text::counted, version};

/// More results are not shown. Limits of code scanning.
const MOST_RESULTS: usize = 5_000;
/// More letters of a message are not shown. Limits of code scanning: 1,024.
const MOST_LETTERS: usize = 1_000;

/// The options of a verb that gives verdicts.
#[derive(clap::Args, Debug, Default)]
pub(super) struct CiOptions {
    /// Write the verdicts for CI systems: .xml as a JUnit report, .sarif or .json as a SARIF log (repeatable)
    #[arg(long, value_name = "FILE", help_heading = "Reports for CI")]
    report: Vec<PathBuf>,
}

/// One verdict.
#[derive(Clone, Debug)]
pub(super) struct CiCase {
    /// What was checked.
    pub(super) name: String,
    pub(super) outcome: Outcome,
    /// The result in a sentence.
    pub(super) message: String,
    /// The file that was checked, if there is one.
    pub(super) file: Option<PathBuf>,
    /// The time that the check took, if it was measured.
    pub(super) seconds: Option<f64>,
}

impl CiCase {
    /// Adds what was not checked because something before it does not hold.
    pub(super) fn add_not_checked(
        cases: &mut Vec<Self>,
        names: impl Iterator<Item = String>,
        file: Option<&Path>,
    ) {
        let after = cases.last().map(|case| case.name.clone()).unwrap_or_default();
        cases.extend(names.map(|name| Self {
            name,
            outcome: Outcome::Incomplete,
            message: format!("not checked after {after}; --keep-going checks it"),
            file: file.map(Path::to_owned),
            seconds: None,
        }));
    }

    /// With the time since the check began.
    #[must_use]
    pub(super) fn begun(self, begun: Instant) -> Self {
        Self { seconds: Some(begun.elapsed().as_secs_f64()), ..self }
    }
}

impl CiOptions {
    /// Checks that the reports can be written, before long work begins.
    pub(super) fn check_places(&self) -> Result<(), CliError> {
        let mut paths = self.report.iter();
        paths.try_for_each(|path| output::check_place(path, &["xml", "sarif", "json"]))
    }

    /// Writes the reports. In a workflow of GitHub Actions, each case that does not hold becomes an
    /// annotation, on standard error. In a SARIF log, the place of a case without a file is `written`, a file that the
    /// command writes, or the log itself.
    pub(super) fn write(
        &self,
        verb: &str,
        cases: &[CiCase],
        written: Option<&Path>,
    ) -> Result<(), CliError> {
        for path in &self.report {
            let text = match path.extension() {
                Some(ending) if ending == "xml" => junit(verb, cases),
                _ => {
                    let open = cases.iter().filter(|case| case.outcome != Outcome::Holds).count();
                    if open > MOST_RESULTS {
                        let left_out = counted(open - MOST_RESULTS, "result");
                        remark!(
                            "{}: without {left_out}, for code scanning shows no more",
                            path.display()
                        );
                    }
                    format!("{:#}\n", sarif(verb, cases, written.unwrap_or(path)))
                }
            };
            output::write_whole(path, text.as_bytes())?;
        }
        if env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true") {
            terminal::print_message(&annotations(verb, cases));
        }
        Ok(())
    }
}

/// A JUnit report. What is not known is an error: the test did not come to a result. Its times were measured; all else
/// is the same for the same cases.
fn junit(verb: &str, cases: &[CiCase]) -> String {
    let time = |seconds: Option<f64>| {
        seconds.map_or(String::new(), |seconds| format!(" time=\"{seconds:.3}\""))
    };
    let measured = cases.iter().filter_map(|case| case.seconds);
    let total = time(measured.reduce(|sum, seconds| sum + seconds));
    let count = |outcome| cases.iter().filter(|case| case.outcome == outcome).count();
    let (all, failures, errors) =
        (cases.len(), count(Outcome::Violated), count(Outcome::Incomplete));
    let counts = format!("tests=\"{all}\" failures=\"{failures}\" errors=\"{errors}\"{total}");
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"toposlam\" {counts}>\n  \
         <testsuite name=\"toposlam {verb}\" {counts}>\n"
    );
    for CiCase { name, outcome, message, file, seconds } in cases {
        let file = file.as_deref().map_or(String::new(), |file| {
            format!(" file=\"{}\"", attribute(&file.display().to_string()))
        });
        let (name, message) = (attribute(name), attribute(message));
        let time = time(*seconds);
        // Jenkins shows the attribute, and GitLab the content.
        let end = |element: &str, kind: &str| {
            format!(
                ">\n      <{element} type=\"{kind}\" message=\"{message}\">{message}</{element}>\n    \
                 </testcase>"
            )
        };
        let end = match outcome {
            Outcome::Holds => "/>".to_owned(),
            Outcome::Violated => end("failure", "violated"),
            Outcome::Incomplete => end("error", "not known"),
        };
        let _ = writeln!(
            xml,
            "    <testcase classname=\"toposlam.{verb}\" name=\"{name}\"{file}{time}{end}"
        );
    }
    xml + "  </testsuite>\n</testsuites>\n"
}

/// The value of an XML attribute. Characters that XML does not allow are replaced.
fn attribute(text: &str) -> String {
    let mut value = String::new();
    for character in text.chars() {
        match character {
            '&' => value += "&amp;",
            '<' => value += "&lt;",
            '>' => value += "&gt;",
            '"' => value += "&quot;",
            '\n' | '\r' | '\t' => value.push(' '),
            '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => value.push('\u{fffd}'),
            other => value.push(other),
        }
    }
    value
}

/// A SARIF log of what does not hold. What is not known has the kind `open`: there was not enough information to
/// decide. A case without a file has the place `elsewhere`.
fn sarif(verb: &str, cases: &[CiCase], elsewhere: &Path) -> Value {
    let result = |case: &CiCase, kind: &str, level: &str| {
        let place = json!({
            "artifactLocation": { "uri": uri(case.file.as_deref().unwrap_or(elsewhere)) },
            "region": { "startLine": 1 },
        });
        let message = format!("{}: {}", case.name, case.message);
        json!({
            "ruleId": verb,
            "kind": kind,
            "level": level,
            "message": { "text": shortened(message) },
            "locations": [{ "physicalLocation": place }],
            "partialFingerprints": { "primaryLocationLineHash": fingerprint(verb, &case.name) },
        })
    };
    let with = |outcome, kind: &'static str, level: &'static str| {
        let of_kind = cases.iter().filter(move |case| case.outcome == outcome);
        of_kind.map(move |case| result(case, kind, level))
    };
    let results =
        with(Outcome::Violated, "fail", "error").chain(with(Outcome::Incomplete, "open", "none"));
    json!({
        "$schema": "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "toposlam",
                "semanticVersion": version::version(),
                "rules": [{ "id": verb, "shortDescription": { "text": rule(verb) } }],
            } },
            "results": results.take(MOST_RESULTS).collect::<Vec<_>>(),
        }],
    })
}

fn shortened(message: String) -> String {
    if message.chars().count() <= MOST_LETTERS {
        return message;
    }
    message.chars().take(MOST_LETTERS - 1).chain(['…']).collect()
}

/// Identifies a case: the same in the next report, whatever its message.
fn fingerprint(verb: &str, name: &str) -> String {
    let digest = Sha256::digest(format!("{verb}\n{name}"));
    hexadecimal(&digest[..8]) + ":1"
}

/// What a verb checks.
fn rule(verb: &str) -> &'static str {
    match verb {
        "check" => "Every map is isomorphic to its world, within the bound on moves.",
        "counterexample" => "No two worlds are indistinguishable.",
        "proofs" => "Every lemma holds in every case within its bound.",
        _ => "The log conforms to the specification.",
    }
}

/// A path as a reference that is relative to the working folder, if it is in there: bytes that a URI does not allow are
/// percent-encoded.
fn uri(path: &Path) -> String {
    let folder = env::current_dir().unwrap_or_default();
    let path: PathBuf = path.strip_prefix(folder).unwrap_or(path).components().collect();
    let path = path.strip_prefix(".").unwrap_or(&path);
    let text = path.to_string_lossy().replace('\\', "/");
    let mut uri = match (path.is_absolute(), text.starts_with('/')) {
        (false, _) => String::new(),
        (true, true) => "file://".to_owned(),
        (true, false) => "file:///".to_owned(),
    };
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            let _ = write!(uri, "%{byte:02X}");
        }
    }
    uri
}

/// The workflow commands of GitHub Actions for the cases that do not hold.
fn annotations(verb: &str, cases: &[CiCase]) -> String {
    let data = |text: &str| text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A");
    let property = |text: &str| data(text).replace(':', "%3A").replace(',', "%2C");
    let mut lines = String::new();
    for CiCase { name, outcome, message, file, .. } in cases {
        let level = match outcome {
            Outcome::Holds => continue,
            Outcome::Violated => "error",
            Outcome::Incomplete => "warning",
        };
        let file = file.as_deref().map_or(String::new(), |file| {
            format!("file={},", property(&file.display().to_string()))
        });
        let title = property(&format!("toposlam {verb}: {name}"));
        let _ = writeln!(lines, "::{level} {file}title={title}::{}", data(message));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cases() -> [CiCase; 3] {
        let case = |name: &str, outcome, message: &str, file: Option<&str>| CiCase {
            name: name.to_owned(),
            outcome,
            message: message.to_owned(),
            file: file.map(PathBuf::from),
            seconds: None,
        };
        [
            case("a", Outcome::Holds, "holds", None),
            case("b < c", Outcome::Violated, "50 % of \"b\"\nare wrong", Some("a b/c,d.mcap")),
            case("d", Outcome::Incomplete, "a limit was reached", None),
        ]
    }

    #[test]
    fn a_junit_report_has_a_failure_and_an_error_and_escapes_its_texts() {
        let xml = junit("check", &cases());
        for part in [
            "tests=\"3\" failures=\"1\" errors=\"1\"",
            "name=\"b &lt; c\" file=\"a b/c,d.mcap\"",
            "<failure type=\"violated\" message=\"50 % of &quot;b&quot; are wrong\">50 % of &quot;b&quot; are wrong</failure>",
            "<error type=\"not known\" message=\"a limit was reached\">a limit was reached</error>",
        ] {
            assert!(xml.contains(part), "{part}: {xml}");
        }
        assert_eq!(attribute("a\u{1}b\u{ffff}&"), "a\u{fffd}b\u{fffd}&amp;");
        assert!(!xml.contains(" time="), "{xml}");
    }

    #[test]
    fn a_junit_report_has_the_times_that_were_measured_and_their_sum() {
        let mut cases = cases();
        (cases[0].seconds, cases[1].seconds) = (Some(1.25), Some(70.5004));
        let xml = junit("check", &cases);
        for part in [
            "<testsuites name=\"toposlam\" tests=\"3\" failures=\"1\" errors=\"1\" time=\"71.750\">",
            "<testsuite name=\"toposlam check\" tests=\"3\" failures=\"1\" errors=\"1\" time=\"71.750\">",
            "name=\"a\" time=\"1.250\"/>",
            "file=\"a b/c,d.mcap\" time=\"70.500\">",
            "name=\"d\">",
        ] {
            assert!(xml.contains(part), "{part}: {xml}");
        }
    }

    #[test]
    fn a_sarif_log_has_what_does_not_hold_each_with_a_place() {
        let log = sarif("conform", &cases(), Path::new("c.sarif"));
        let results = log["runs"][0]["results"].as_array().unwrap();
        let kinds: Vec<_> = results.iter().map(|result| &result["kind"]).collect();
        assert_eq!(kinds, ["fail", "open"]);
        let place = |at: usize| &results[at]["locations"][0]["physicalLocation"];
        assert_eq!(place(0)["artifactLocation"]["uri"], "a%20b/c%2Cd.mcap");
        assert_eq!(place(1)["artifactLocation"]["uri"], "c.sarif");
        let fingerprints = |name| {
            let mut cases = cases();
            cases[1].name = String::from(name);
            sarif("check", &cases, Path::new(""))["runs"][0]["results"][0]["partialFingerprints"]
                .clone()
        };
        assert_eq!(fingerprints("b"), fingerprints("b"));
        assert_ne!(fingerprints("b"), fingerprints("c"));
    }

    #[test]
    fn a_sarif_log_keeps_the_limits_of_code_scanning() {
        let [_, violated, open] = cases();
        let long = CiCase { message: "ä".repeat(2_000), ..violated };
        let cases = [vec![open; MOST_RESULTS], vec![long]].concat();
        let log = sarif("check", &cases, Path::new("c.sarif"));
        let results = log["runs"][0]["results"].as_array().unwrap();
        // What is violated comes first.
        assert_eq!((results.len(), &results[0]["kind"]), (MOST_RESULTS, &json!("fail")));
        let text = results[0]["message"]["text"].as_str().unwrap();
        assert!(text.chars().count() == MOST_LETTERS && text.ends_with("ä…"), "{text}");
    }

    #[test]
    fn a_place_is_relative_to_the_working_folder_or_absolute() {
        let here = env::current_dir().unwrap();
        for (path, expected) in [
            (Path::new("./a/./b c.toml"), "a/b%20c.toml"),
            (&here.join("logs/a.mcap"), "logs/a.mcap"),
            (Path::new("../a.mcap"), "../a.mcap"),
            #[cfg(unix)]
            (Path::new("/nowhere/a.mcap"), "file:///nowhere/a.mcap"),
        ] {
            assert_eq!(uri(path), expected);
        }
    }

    #[test]
    fn each_verb_has_a_rule_of_its_own() {
        let text = |verb| {
            sarif(verb, &cases(), Path::new(""))["runs"][0]["tool"]["driver"]["rules"][0]
                .to_string()
        };
        for (verb, what) in [
            ("check", "map"),
            ("counterexample", "worlds"),
            ("proofs", "lemma"),
            ("conform", "log"),
        ] {
            assert!(text(verb).contains(what), "{}", text(verb));
        }
    }

    #[test]
    fn an_annotation_is_one_line() {
        assert_eq!(
            annotations("conform", &cases()),
            "::error file=a b/c%2Cd.mcap,title=toposlam conform%3A b < c::50 %25 of \"b\"%0Aare \
             wrong\n::warning title=toposlam conform%3A d::a limit was reached\n"
        );
    }
}
