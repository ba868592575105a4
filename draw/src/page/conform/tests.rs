//! What stands on the page, and what cannot get out of its place there.

use std::collections::BTreeSet;

use toposlam_conform::{
    Allowed, CheckedKind, ConformVerdict, CoveredCase, DivergenceCause, DivergenceReport,
    EventPose, EventSource, Facts, FaultClass, FoldedReport, LogReport, MessagePlace, OpenDoor,
    PoseName, ReportedEvent, RequiredCoverage, SmallestFound, SourceFile, ToleratedQuirk,
    UnreadLog, UnseenPlace, WorldFact,
};
use toposlam_logs::{error::OffsetUnit, record::Arrival};
use toposlam_model::{
    folding::fold,
    format::{named_world::NamedWorld, world_file},
    percept::{Door, Percept, Sighting},
    trace::MisfitReason,
};

use super::*;
use crate::page::template::checks::places_of;

fn page_of(reports: &[LogReport]) -> String {
    let command = "toposlam conform logs/shape-6.mcap --html report.html".to_owned();
    page_with(&ConformReports { logs: reports.to_vec(), ..ConformReports::default() }, command)
}

fn page_with(reports: &ConformReports, command: String) -> String {
    conform_page(reports, &ReportOrigin { version: "0.1.0".to_owned(), command })
}

fn arrival(degree: u32) -> CheckedKind {
    let sighting = Some(Sighting::Nothing);
    let arrival = Arrival { number: None, degree, sighting, form: None, entry: None };
    CheckedKind::Arrival { arrival, entry_off: None, hallway: None }
}

fn event(number: usize) -> ReportedEvent {
    let door = CheckedKind::Door { number: None, door: Door(1), off: None };
    ReportedEvent {
        number,
        source: EventSource::default(),
        time: number as f64 / 2.0,
        kind: if number % 2 == 1 { arrival(3) } else { door },
        pose: None,
        then: Some(EventPose::Candidates(12)),
    }
}

fn world() -> NamedWorld {
    world_file::read(include_bytes!("../../../../worlds/shape-6.toml")).unwrap()
}

fn known(name: &str) -> WorldFact {
    WorldFact {
        name: name.to_owned(),
        start: None,
        candidates_at_start: 12,
        candidates_left: Some(2),
        pose: None,
        world: world(),
    }
}

fn conforming(events: usize) -> LogReport {
    LogReport {
        log: "logs/shape-6.mcap".to_owned(),
        verdict: ConformVerdict::Conforms,
        begun: Some(1_700_000_000_000_000_000),
        sources: vec![SourceFile {
            role: "log",
            path: "logs/shape-6.mcap".to_owned(),
            sha256: "9f86d081884c7d65".repeat(4),
        }],
        events: (1..=events).map(event).collect(),
        coverage: [("new-vertex", 9, true), ("confirmed", 0, true), ("marker-missed", 0, false)]
            .map(|(case, count, can)| CoveredCase {
                case,
                count,
                reachable: Some(can),
                expected: false,
            })
            .into(),
        ..LogReport::default()
    }
}

fn allowed(vertex: &str, degree: u32) -> Allowed {
    let pose = PoseName { vertex: vertex.to_owned(), from: "corner".to_owned() };
    let expected = Percept { degree, sighting: Sighting::Nothing };
    Allowed::InWorld(pose, MisfitReason::Percept { expected })
}

fn diverged(events: usize, at: usize) -> LogReport {
    LogReport {
        verdict: ConformVerdict::Diverged,
        divergence: Some(DivergenceReport {
            event: at,
            time: Some(at as f64 / 2.0),
            message: Some(MessagePlace { number: 4711, offset: 1_234_567, unit: OffsetUnit::Byte }),
            fault: FaultClass::Perception,
            cause: DivergenceCause::WrongMap,
            found: Some(arrival(4)),
            allowed: vec![allowed("tee", 3), allowed("end", 1)],
            allowed_total: 2,
        }),
        shorter: vec![arrival(2)],
        command: Some("toposlam conform shorter.mcap --world shape-6.toml".to_owned()),
        image: Some(b"\xff\xd8\xff\xe0".to_vec()),
        facts: Facts { world: Some(known("shape-6")), ..Facts::default() },
        ..conforming(events)
    }
}

fn incomplete() -> LogReport {
    let facts = Facts { lacks_end: true, ..Facts::default() };
    LogReport { verdict: ConformVerdict::Incomplete, facts, ..conforming(5) }
}

#[test]
fn an_unreadable_log_and_a_missing_case_are_on_the_page() {
    let unread = UnreadLog { log: "bad.mcap".to_owned(), cause: "it is <not> a log".to_owned() };
    let good = || vec![conforming(3)];
    let reports =
        ConformReports { logs: good(), unread: vec![unread], ..ConformReports::default() };
    let page = page_with(&reports, String::new());
    assert!(page.contains("<title>2 logs: 1 conforms, 1 not checked</title>"), "{page}");
    assert!(page.contains("<th scope=\"row\">bad.mcap</th>"), "{page}");
    assert!(page.contains("it is &lt;not&gt; a log"), "{page}");
    assert!(page.contains("<div class=\"verdict incomplete\">"), "{page}");
    let cases = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    for (not_covered, verdict, text) in [
        (cases(&["l-left"]), "incomplete", "2 required cases: not covered: l-left."),
        (cases(&[]), "conforms", "2 required cases: all are covered."),
    ] {
        let required = cases(&["tee", "l-left"]);
        let required = RequiredCoverage { required, not_covered, ..RequiredCoverage::default() };
        let reports =
            ConformReports { logs: good(), required: Some(required), ..ConformReports::default() };
        let page = page_with(&reports, String::new());
        assert!(page.contains(text), "{page}");
        let first = page.split_once("<div class=\"verdict ").unwrap().1;
        assert!(first.starts_with(verdict), "{page}");
    }
}

/// The table of the steps that led to the divergence.
fn led_there(page: &str) -> &str {
    let (_, from) = page.split_once("Events before it").unwrap();
    from.split_once("</table>").unwrap().0
}

#[test]
fn every_place_of_the_template_is_filled() {
    let known = ["command", "icon", "logs", "script", "style", "title", "together", "version"];
    assert_eq!(places_of(PAGE), known);
}

#[test]
fn the_texts_of_a_log_are_escaped_everywhere() {
    let nasty = || "</script><script>alert('1')</script><i a=\"&{{logs}}".to_owned();
    let mut report = diverged(3, 2);
    report.log = nasty();
    report.facts.world = Some(known(&nasty()));
    let door = OpenDoor { vertex: nasty(), door: 0, toward: Some(nasty()) };
    report.facts.never_followed = Some(vec![door]);
    let pose = PoseName { vertex: nasty(), from: nasty() };
    report.events[0].then = Some(EventPose::At(pose));
    report.tolerated = vec![ToleratedQuirk { name: nasty(), reason: nasty(), events: vec![1] }];
    report.command = Some(nasty());
    report.sources[0].path = nasty();
    if let Some(divergence) = &mut report.divergence {
        divergence.allowed = vec![allowed(&nasty(), 3); 20];
    }
    let quiet = LogReport { log: nasty(), ..conforming(0) };
    for reports in [vec![report.clone()], vec![report, quiet]] {
        let page = page_of(&reports);
        assert_eq!(page.matches("<script").count(), 1, "the template's own");
        assert_eq!(page.matches("</script").count(), 1);
        assert!(!page.contains("<i "));
        // Inserted text is not searched for placeholders.
        assert!(page.contains("{{logs}}"));
        assert_eq!(page.matches("<main>").count(), 1);
    }
}

#[test]
fn the_page_shows_how_it_was_made() {
    let page = page_of(&[conforming(3)]);
    let hash = format!("<code class=\"hash\">{}</code>", "9f86d081884c7d65".repeat(4));
    for part in [
        "Made by toposlam 0.1.0 with this command.",
        "<code>toposlam conform logs/shape-6.mcap --html report.html</code>",
        "<tr><th scope=\"row\">first message</th><td>2023-11-14 22:13:20.000 UTC</td></tr>",
        "<tr><th scope=\"row\">log file</th><td>logs/shape-6.mcap<br>",
        &hash,
    ] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn each_verdict_has_its_word_sign_and_colour() {
    let pages = [conforming(4), diverged(4, 3), incomplete()].map(|report| page_of(&[report]));
    for (page, [name, word, why]) in pages.iter().zip([
        ["conforms", "Conforms", "<p>All 4 events fit.</p>"],
        ["diverged", "Diverged", "The map is not the known world.</p>"],
        ["incomplete", "Incomplete", "The log does not record how the run ended.</p>"],
    ]) {
        assert!(page.contains(&format!("<div class=\"verdict {name}\">\n<h1><svg class=\"sign\"")));
        assert!(page.contains(&format!("<strong>{word}</strong>")));
        assert!(page.contains(&format!("<title>logs/shape-6.mcap: {name}</title>")));
        assert!(page.contains(why), "{why}");
    }
    let paths = pages.each_ref().map(|page| {
        let (_, from) = page.split_once("<path d=\"").unwrap();
        from.split_once('"').unwrap().0
    });
    assert_eq!(BTreeSet::from(paths).len(), 3);
}

#[test]
fn a_divergence_is_shown_with_the_events_before_it_and_what_is_allowed() {
    let page = page_of(&[diverged(9, 7)]);
    for part in [
        "<b>Percept: 4 doors.</b>",
        "<span class=\"chip\">perception</span>",
        "<a href=\"#event-1-7\">Event 7 of 9</a> \u{b7} 0:03.5 min \u{b7} message 4,711 of the log, \
         at byte 1,234,567 \u{b7} cause <code>wrong-map</code>",
        "<li>at tee, having come from corner: 3 doors</li>",
        "src=\"data:image/jpeg;base64,/9j/4A==\"",
        "src=\"data:image/svg+xml;base64,",
        "<code>toposlam conform shorter.mcap --world shape-6.toml</code>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    let steps = led_there(&page);
    assert_eq!(steps.matches("<tr>").count() - 1, 3, "the head's besides");
    assert!(steps.contains("<tr><td>4<td>0:02.0") && !steps.contains("<tr><td>3<"));
    assert!(steps.contains("<tr class=off><td>7<td>0:03.5<td>percept: 4 doors<td>"));
    assert_eq!(page.matches(" id=event-1-7>").count(), 1);
}

#[test]
fn a_divergence_may_be_the_first_event_or_missing_at_the_end() {
    let first = page_of(&[diverged(4, 1)]);
    assert!(led_there(&first).contains("<tbody>\n<tr class=off><td>1<"));
    let missing = page_of(&[diverged(4, 5)]);
    assert!(missing.contains(">After all 4 events</a>"));
    assert!(led_there(&missing).contains("<tr><td>4<td>0:02.0"));
    assert_eq!(missing.matches(" id=event-1-5>").count(), 1);
    let nothing = page_of(&[diverged(0, 1)]);
    assert_eq!(nothing.matches(" id=event-1-1>").count(), 1);
}

#[test]
fn what_there_is_not_takes_no_room() {
    let page = page_of(&[conforming(2)]);
    assert!(!page.contains("<img"));
    for name in ["What the camera saw", "Events before it", "tolerated", "A shorter log"] {
        assert!(!page.contains(name), "{name}");
    }
    let odd = LogReport { image: Some(b"GIF89a".to_vec()), ..conforming(2) };
    assert_eq!(page_of(&[odd]), page);
    let png = LogReport { image: Some(b"\x89PNG\r\n\x1a\n".to_vec()), ..conforming(2) };
    assert!(page_of(&[png]).contains("src=\"data:image/png;base64,"));
}

/// The robot stood at a junction with three doors, went to a dead end and came back.
#[test]
fn what_the_log_proves_is_drawn_with_its_open_doors() {
    let percept = |degree, sighting| Percept { degree, sighting };
    let [here, back] = [Door(0), Door(2)].map(|door| percept(3, Sighting::Pointing(door)));
    let trail = fold(&[here, percept(1, Sighting::Nothing), back], &[Door(1), Door(0)]).unwrap();
    let entries = trail.first_entries(&[Door(1), Door(0)]);
    let folded = Some(FoldedReport { trail, entries });
    let (world, door) = (world(), |door| OpenDoor { vertex: "v0".to_owned(), door, toward: None });
    let facts = Facts {
        smallest: Some(SmallestFound { vertices: 2, edges: 2, least: true, world }),
        never_followed: Some(vec![door(0), door(2)]),
        ..Facts::default()
    };
    let open = LogReport { facts, folded: folded.clone(), ..conforming(2) };
    let page = page_of(std::slice::from_ref(&open));
    for part in [
        "<h2>What the log proves about its world</h2>",
        "<span class=\"open-door\"></span> 2 doors that were never followed. Of the 2 places, some may be one.",
        "<h2>The smallest world that explains the log</h2>",
        "<p>This log does not determine its world: 2 doors were never followed: v0 door 0, v0 door 2.</p>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(page.matches("src=\"data:image/svg+xml;base64,").count(), 2);
    let only = page_of(&[LogReport { folded: None, ..open }]);
    assert!(only.contains("<h2>The only world that explains the log</h2>"));
    assert!(!only.contains("that were never followed."));
    let page = page_of(&[LogReport { folded, ..diverged(4, 3) }]);
    assert!(page.contains("<h2>What the log proves before it diverges</h2>"));
}

#[test]
fn what_is_tolerated_leads_to_its_events() {
    let (name, reason) = ("glare".to_owned(), "the sun stands low".to_owned());
    let quirk = ToleratedQuirk { name, reason, events: vec![2, 4, 6] };
    let page = page_of(&[LogReport { tolerated: vec![quirk], ..conforming(5) }]);
    assert!(page.contains("<b>glare</b>, 3 times: The sun stands low."));
    assert!(page.contains("<p>All 5 events fit, except 3 that are tolerated.</p>"));
    for event in [2, 4] {
        assert!(page.contains(&format!("<a href=\"#event-1-{event}\">{event}</a>")));
        assert!(page.contains(&format!("<tr class=let id=event-1-{event}>")));
    }
    // One that is missing at the end is no line to lead to.
    assert!(!page.contains("#event-1-6"));
}

#[test]
fn many_events_make_a_page_that_is_not_large() {
    let page = page_of(&[diverged(10_000, 7_000)]);
    assert!(page.len() < 2_000_000, "{} bytes", page.len());
    assert!(page.contains("<summary>All 10,000 events</summary>"));
    assert_eq!(page.matches("<div class=\"leaf\">").count(), 100);
}

#[test]
fn several_logs_are_summed_up_above() {
    let lost = Facts { unrecognised: Some((4, UnseenPlace::Junction)), ..Facts::default() };
    let lost = LogReport { facts: lost, ..incomplete() };
    let logs = [conforming(3), diverged(9, 7), lost];
    let page = page_of(&logs);
    assert!(page.contains("<title>3 logs: 1 diverged, 1 incomplete, 1 conforms</title>"));
    assert!(page.contains("<div class=\"verdict diverged\">\n<h1>"), "the worst of all");
    assert_eq!(page.matches("<h1>").count(), 1);
    for number in 1..=3 {
        assert!(page.contains(&format!("<a href=\"#log-{number}\">")));
        assert!(page.contains(&format!("<section id=\"log-{number}\">")));
    }
    let (above, _) = page.split_once("<section id=\"log-1\">").unwrap();
    assert!(above.contains(">27</td>"), "what all of them cover");
    assert!(above.contains("<td>the junction of event 4 was not recognised: "), "{above}");
    assert!(page.contains("#event-2-7"));
    assert_eq!(page, page_of(&logs));
}

#[test]
fn no_log_does_not_conform() {
    let page = page_of(&[]);
    assert!(page.contains("<div class=\"verdict incomplete\">"));
    assert!(page.contains("<strong>No log was checked</strong>"));
}

#[test]
fn a_long_list_is_folded() {
    let mut report = diverged(3, 2);
    for (count, summary) in [(13, None), (40, Some("<summary>28 more</summary>"))] {
        if let Some(divergence) = &mut report.divergence {
            (divergence.allowed, divergence.allowed_total) = (vec![allowed("x", 3); count], count);
        }
        let page = page_of(std::slice::from_ref(&report));
        assert_eq!(page.matches("<li>at x, ").count(), count);
        assert_eq!(summary.is_some_and(|summary| page.contains(summary)), summary.is_some());
        assert_eq!(page.contains(" more</summary>"), summary.is_some());
    }
}
