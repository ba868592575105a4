//! The coverage of the cases.

use toposlam_conform::CoveredCase;

use super::each;
use crate::picture::escaped;

/// The number of reachable cases that were reached, and a table of the cases; nothing without a case.
pub(super) fn content(cases: &[CoveredCase]) -> String {
    if cases.is_empty() {
        return String::new();
    }
    let met = cases.iter().filter(|case| case.count > 0).count();
    let beyond = cases.iter().filter(|case| case.count == 0 && case.reachable == Some(false));
    let beyond = beyond.count();
    let of = cases.len() - beyond;
    let besides = match beyond {
        0 => String::new(),
        _ => format!("; {beyond} cannot be reached in the known world"),
    };
    let most = cases.iter().map(|case| case.count).max().unwrap_or(0).max(1);
    format!(
        "<p class=\"faint\">{met} of {of} cases reached{besides}.</p>\n\
         <table class=\"coverage\">\n<thead class=\"unseen\"><tr><th scope=\"col\">Case</th>\
         <th scope=\"col\">Count</th><th scope=\"col\">Share</th></tr></thead>\n<tbody>\n{}</tbody>\n\
         </table>\n",
        each(cases, |case| row(case, most))
    )
}

fn row(case: &CoveredCase, most: u64) -> String {
    let name = escaped(case.case);
    let not = |what: &str| format!("<td colspan=\"2\">{what}</td>");
    let (class, cells) = match (case.count, case.reachable) {
        (0, Some(false)) => ("beyond", not("not reachable")),
        (0, _) if case.expected => ("missed", not("expected, but not reached")),
        (0, _) => ("beyond", not("not reached")),
        (count, reachable) => {
            let part = 100.0 * count as f64 / most as f64;
            let bar = format!("<span class=\"bar\" style=\"--part:{part:.1}%\"></span>");
            // A run that diverged may cover cases that its world does not have.
            let note = match reachable {
                Some(false) => "<span class=\"faint\">not in the known world</span>",
                _ => "",
            };
            let cells = format!(
                "<td class=\"right number\">{count}</td><td class=\"many\">{bar}{note}</td>"
            );
            ("met", cells)
        }
    };
    format!("<tr class=\"{class}\"><th scope=\"row\">{name}</th>{cells}</tr>\n")
}
