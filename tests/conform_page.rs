//! The page of conformance reports: what stands on it, and what cannot get out of its place there.

use std::{collections::BTreeSet, fs};

use toposlam_conform::{
    Allowed, ConformReports, ConformVerdict, CoveredCase, DivergenceCause, DivergenceReport,
    EventPose, EventSource, Facts, FaultClass, FoldedReport, LogReport, MessagePlace, OpenDoor,
    PoseName, ReportedEvent, RequiredCoverage, SmallestFound, SourceFile, ToleratedQuirk,
    UndecidedCause, UnreadLog, WorldFact,
};
use toposlam_draw::page::{ReportOrigin, conform_page};
use toposlam_logs::error::OffsetUnit;
use toposlam_model::{
    folding::fold,
    format::{named_world::NamedWorld, world_file},
    percept::{Door, Percept, Sighting},
    trace::MisfitReason,
};

use crate::repository;

fn page_of(reports: &[LogReport]) -> String {
    page_with(&ConformReports { logs: reports.to_vec(), ..ConformReports::default() })
}

fn page_with(reports: &ConformReports) -> String {
    let command = "toposlam conform logs/shape-6.mcap --html report.html".to_owned();
    conform_page(reports, &ReportOrigin { version: "0.1.0".to_owned(), command })
}

#[track_caller]
fn assert_has(page: &str, parts: &[&str]) {
    for part in parts {
        assert!(page.contains(part), "{part}");
    }
}

fn percept(degree: u32) -> Percept {
    Percept { degree, sighting: Sighting::Nothing }
}

fn event(number: usize) -> ReportedEvent {
    ReportedEvent {
        number,
        source: EventSource::default(),
        time: number as f64 / 2.0,
        kind: if number % 2 == 1 { percept(3).into() } else { Door(1).into() },
        pose: None,
        then: Some(EventPose::Candidates(12)),
    }
}

fn world(name: &str) -> NamedWorld {
    world_file::read(&fs::read(repository("worlds").join(name)).unwrap()).unwrap()
}

fn known(name: &str) -> WorldFact {
    WorldFact {
        name: name.to_owned(),
        start: None,
        candidates_at_start: 12,
        candidates_left: Some(2),
        pose: None,
        world: world("shape-6.toml"),
    }
}

fn cases(cases: &[(&'static str, u64, Option<bool>)]) -> Vec<CoveredCase> {
    let case = |&(case, count, reachable)| CoveredCase {
        case,
        count,
        reachable,
        expected: case == "expected",
    };
    cases.iter().map(case).collect()
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
        coverage: cases(&[
            ("new-vertex", 9, Some(true)),
            ("confirmed", 0, Some(true)),
            ("marker-missed", 0, Some(false)),
        ]),
        ..LogReport::default()
    }
}

fn allowed(vertex: &str, degree: u32) -> Allowed {
    let pose = PoseName { vertex: vertex.to_owned(), from: "corner".to_owned() };
    Allowed::InWorld(pose, MisfitReason::Percept { expected: percept(degree) })
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
            found: Some(percept(4).into()),
            allowed: vec![allowed("tee", 3), allowed("end", 1)],
            allowed_total: 2,
        }),
        shorter: vec![percept(2).into()],
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
    let good = ConformReports { logs: vec![conforming(3)], ..ConformReports::default() };
    let page = page_with(&ConformReports { unread: vec![unread], ..good.clone() });
    assert_has(
        &page,
        &[
            "<title>2 logs: 1 conforms, 1 not checked</title>",
            "<th scope=\"row\">bad.mcap</th>",
            "it is &lt;not&gt; a log",
            "<div class=\"verdict incomplete\">",
        ],
    );
    for (not_covered, verdict, text) in [
        (&["l-left"][..], "incomplete", "2 required cases: not covered: l-left."),
        (&[], "conforms", "2 required cases: all are covered."),
    ] {
        let [required, not_covered] = [&["tee", "l-left"][..], not_covered]
            .map(|names| names.iter().map(|name| (*name).to_owned()).collect());
        let required = RequiredCoverage { required, not_covered, ..RequiredCoverage::default() };
        let page = page_with(&ConformReports { required: Some(required), ..good.clone() });
        assert!(page.contains(text), "{page}");
        let first = page.split_once("<div class=\"verdict ").unwrap().1;
        assert!(first.starts_with(verdict), "{page}");
    }
}

#[test]
fn a_case_is_reached_or_not_or_cannot_be() {
    let coverage = cases(&[
        ("reached", 4, Some(true)),
        ("foreign", 8, Some(false)),
        ("open", 0, None),
        ("missed", 0, Some(true)),
        ("expected", 0, Some(true)),
        ("beyond", 0, Some(false)),
    ]);
    let page = page_of(&[LogReport { coverage, ..conforming(3) }]);
    for (case, class, part) in [
        ("reached", "met", "--part:50.0%"),
        ("foreign", "met", "not in the known world"),
        ("open", "beyond", ">not reached<"),
        ("missed", "beyond", ">not reached<"),
        ("expected", "missed", ">expected, but not reached<"),
        ("beyond", "beyond", ">not reachable<"),
    ] {
        let row = format!("<tr class=\"{class}\"><th scope=\"row\">{case}</th>");
        let (_, row) = page.split_once(&row).expect(case);
        assert!(row.split_once('\n').unwrap().0.contains(part), "{case}: {row}");
    }
    assert_has(&page, &["2 of 5 cases reached; 1 cannot be reached"]);
}

/// The table of the steps that led to the divergence.
fn led_there(page: &str) -> &str {
    let (_, from) = page.split_once("Events before it").unwrap();
    from.split_once("</table>").unwrap().0
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
fn each_verdict_has_its_word_sign_and_colour() {
    let mut paths = BTreeSet::new();
    for (report, name, word, why) in [
        (conforming(4), "conforms", "Conforms", "<p>All 4 events fit.</p>"),
        (diverged(4, 3), "diverged", "Diverged", "The map is not the known world.</p>"),
        (
            incomplete(),
            "incomplete",
            "Incomplete",
            "The log does not record how the run ended.</p>",
        ),
    ] {
        let page = page_of(&[report]);
        assert_has(
            &page,
            &[
                &format!("<div class=\"verdict {name}\">\n<h1><svg class=\"sign\""),
                &format!("<strong>{word}</strong>"),
                &format!("<title>logs/shape-6.mcap: {name}</title>"),
                why,
            ],
        );
        let (_, from) = page.split_once("<path d=\"").unwrap();
        paths.insert(from.split_once('"').unwrap().0.to_owned());
    }
    assert_eq!(paths.len(), 3);
}

#[test]
fn a_divergence_is_shown_with_the_events_before_it_and_what_is_allowed() {
    let page = page_of(&[diverged(9, 7)]);
    assert_has(
        &page,
        &[
            "<b>Percept: 4 doors.</b>",
            "<span class=\"chip\">perception</span>",
            "<a href=\"#event-1-7\">Event 7 of 9</a> \u{b7} 0:03.5 min \u{b7} message 4,711 of the log, \
             at byte 1,234,567 \u{b7} cause <code>wrong-map</code>",
            "<li>at tee, having come from corner: 3 doors</li>",
            "src=\"data:image/jpeg;base64,/9j/4A==\"",
            "src=\"data:image/svg+xml;base64,",
            "<code>toposlam conform shorter.mcap --world shape-6.toml</code>",
        ],
    );
    let steps = led_there(&page);
    assert_eq!(steps.matches("<tr>").count() - 1, 3, "the head's besides");
    assert!(steps.contains("<tr><td>4<td>0:02.0") && !steps.contains("<tr><td>3<"));
    assert!(steps.contains("<tr class=off><td>7<td>0:03.5<td>percept: 4 doors<td>"));
    assert_eq!(page.matches(" id=event-1-7>").count(), 1);
    // It may be the first event, or missing at the end.
    let first = page_of(&[diverged(4, 1)]);
    assert!(led_there(&first).contains("<tbody>\n<tr class=off><td>1<"));
    let missing = page_of(&[diverged(4, 5)]);
    assert!(missing.contains(">After all 4 events</a>"));
    assert!(led_there(&missing).contains("<tr><td>4<td>0:02.0"));
    for (page, id) in [(missing, " id=event-1-5>"), (page_of(&[diverged(0, 1)]), " id=event-1-1>")]
    {
        assert_eq!(page.matches(id).count(), 1);
    }
}

#[test]
fn what_there_is_not_takes_no_room() {
    let with = |image: &[u8]| page_of(&[LogReport { image: Some(image.into()), ..conforming(2) }]);
    let page = page_of(&[conforming(2)]);
    for name in ["<img", "What the camera saw", "Events before it", "tolerated", "A shorter log"] {
        assert!(!page.contains(name), "{name}");
    }
    assert_eq!(with(b"GIF89a"), page);
    assert!(with(b"\x89PNG\r\n\x1a\n").contains("src=\"data:image/png;base64,"));
}

/// The robot stood at a junction with three doors, went to a dead end and came back.
#[test]
fn what_the_log_proves_is_drawn_with_its_open_doors() {
    let [here, back] =
        [Door(0), Door(2)].map(|door| Percept { sighting: Sighting::Pointing(door), ..percept(3) });
    let trail = fold(&[here, percept(1), back], &[Door(1), Door(0)]).unwrap();
    let entries = trail.first_entries(&[Door(1), Door(0)]);
    let folded = Some(FoldedReport { trail, entries });
    let door = |door| OpenDoor { vertex: "v0".to_owned(), door, toward: None };
    let world = world("shape-6.toml");
    let facts = Facts {
        smallest: Some(SmallestFound { vertices: 2, edges: 2, least: true, world }),
        never_followed: Some(vec![door(0), door(2)]),
        ..Facts::default()
    };
    let open = LogReport { facts, folded: folded.clone(), ..conforming(2) };
    let page = page_of(std::slice::from_ref(&open));
    assert_has(
        &page,
        &[
            "<h2>What the log proves about its world</h2>",
            "<span class=\"open-door\"></span> 2 doors that were never followed. Of the 2 places, some may be one.",
            "<h2>The smallest world that explains the log</h2>",
            "<p>This log does not determine its world: 2 doors were never followed: v0 door 0, v0 door 2.</p>",
        ],
    );
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
    assert_has(
        &page,
        &[
            "<b>glare</b>, 3 times: The sun stands low.",
            "<p>All 5 events fit, except 3 that are tolerated.</p>",
            "<a href=\"#event-1-2\">2</a>",
            "<tr class=let id=event-1-2>",
            "<a href=\"#event-1-4\">4</a>",
            "<tr class=let id=event-1-4>",
        ],
    );
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
    let lost = Facts { unrecognised: Some((4, UndecidedCause::Unclear)), ..Facts::default() };
    let lost = LogReport { facts: lost, ..incomplete() };
    let page = page_of(&[conforming(3), diverged(9, 7), lost]);
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
    assert_has(
        &page_of(&[]),
        &["<div class=\"verdict incomplete\">", "<strong>No log was checked</strong>"],
    );
}

#[test]
fn a_long_list_is_folded() {
    let mut report = diverged(3, 2);
    for (count, folds) in [(13, false), (40, true)] {
        if let Some(divergence) = &mut report.divergence {
            (divergence.allowed, divergence.allowed_total) = (vec![allowed("x", 3); count], count);
        }
        let page = page_of(std::slice::from_ref(&report));
        assert_eq!(page.matches("<li>at x, ").count(), count);
        assert_eq!(page.contains(" more</summary>"), folds);
        assert_eq!(page.contains("<summary>28 more</summary>"), folds);
    }
}
