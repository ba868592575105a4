//! Results for CI systems: JUnit XML, SARIF 2.1.0, and the annotations of GitHub Actions.

use std::{
    env,
    fmt::Write as _,
    path::{Path, PathBuf},
};

use serde_json::{Value, json};

use super::{CliError, Outcome, output, terminal, version};

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
        }));
    }
}

impl CiOptions {
    /// Checks that the reports can be written, before long work begins.
    pub(super) fn check_places(&self) -> Result<(), CliError> {
        let mut paths = self.report.iter();
        paths.try_for_each(|path| output::check_place(path, &["xml", "sarif", "json"]))
    }

    /// Writes the reports. In a workflow of GitHub Actions, each case that does not hold becomes an
    /// annotation, on standard error.
    pub(super) fn write(&self, verb: &str, cases: &[CiCase]) -> Result<(), CliError> {
        for path in &self.report {
            let text = match path.extension() {
                Some(ending) if ending == "xml" => junit(verb, cases),
                _ => format!("{:#}\n", sarif(verb, cases)),
            };
            output::write_whole(path, text.as_bytes())?;
        }
        if env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true") {
            terminal::print_message(&annotations(verb, cases));
        }
        Ok(())
    }
}

/// A JUnit report. What is not known is an error: the test did not come to a result.
fn junit(verb: &str, cases: &[CiCase]) -> String {
    let count = |outcome| cases.iter().filter(|case| case.outcome == outcome).count();
    let (all, failures, errors) =
        (cases.len(), count(Outcome::Violated), count(Outcome::Incomplete));
    let counts = format!("tests=\"{all}\" failures=\"{failures}\" errors=\"{errors}\"");
    let mut xml = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"toposlam\" {counts}>\n  \
         <testsuite name=\"toposlam {verb}\" {counts}>\n"
    );
    for CiCase { name, outcome, message, file } in cases {
        let file = file.as_deref().map_or(String::new(), |file| {
            format!(" file=\"{}\"", attribute(&file.display().to_string()))
        });
        let (name, message) = (attribute(name), attribute(message));
        let end = |element: &str, kind: &str| {
            format!(">\n      <{element} type=\"{kind}\" message=\"{message}\"/>\n    </testcase>")
        };
        let end = match outcome {
            Outcome::Holds => "/>".to_owned(),
            Outcome::Violated => end("failure", "violated"),
            Outcome::Incomplete => end("error", "not known"),
        };
        let _ =
            writeln!(xml, "    <testcase classname=\"toposlam.{verb}\" name=\"{name}\"{file}{end}");
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

/// A SARIF log. What is not known has the kind `open`: there was not enough information to decide.
fn sarif(verb: &str, cases: &[CiCase]) -> Value {
    let result = |case: &CiCase| {
        let (kind, level) = match case.outcome {
            Outcome::Holds => ("pass", "none"),
            Outcome::Violated => ("fail", "error"),
            Outcome::Incomplete => ("open", "none"),
        };
        let mut result = json!({
            "ruleId": verb,
            "kind": kind,
            "level": level,
            "message": { "text": format!("{}: {}", case.name, case.message) },
        });
        if let Some(file) = &case.file {
            let uri = json!({ "uri": uri(file) });
            result["locations"] = json!([{ "physicalLocation": { "artifactLocation": uri } }]);
        }
        result
    };
    json!({
        "$schema": "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json",
        "version": "2.1.0",
        "runs": [{
            "tool": { "driver": {
                "name": "toposlam",
                "semanticVersion": version::version(),
                "rules": [{ "id": verb, "shortDescription": { "text": rule(verb) } }],
            } },
            "results": cases.iter().map(result).collect::<Vec<_>>(),
        }],
    })
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

/// A path as a relative reference: bytes that a URI does not allow are percent-encoded.
fn uri(path: &Path) -> String {
    let mut uri = String::new();
    for byte in path.to_string_lossy().replace('\\', "/").bytes() {
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
    for CiCase { name, outcome, message, file } in cases {
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
            "<failure type=\"violated\" message=\"50 % of &quot;b&quot; are",
            "<error type=\"not known\" message=\"a limit was reached\"/>",
        ] {
            assert!(xml.contains(part), "{part}: {xml}");
        }
        assert_eq!(attribute("a\u{1}b\u{ffff}&"), "a\u{fffd}b\u{fffd}&amp;");
    }

    #[test]
    fn a_sarif_log_has_three_kinds() {
        let log = sarif("conform", &cases());
        let kinds: Vec<_> = (0..3).map(|index| &log["runs"][0]["results"][index]["kind"]).collect();
        assert_eq!(kinds, ["pass", "fail", "open"]);
        let location = &log["runs"][0]["results"][1]["locations"][0]["physicalLocation"];
        assert_eq!(location["artifactLocation"]["uri"], "a%20b/c%2Cd.mcap");
    }

    #[test]
    fn each_verb_has_a_rule_of_its_own() {
        let text =
            |verb| sarif(verb, &cases())["runs"][0]["tool"]["driver"]["rules"][0].to_string();
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
