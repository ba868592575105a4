//! The page of conformance reports: what cannot get out of its place there, and what few logs show. Other facts are in
//! `tests/facts/page.txt`.

use std::fs;

use toposlam_conform::{
    Allowed, ConformReports, ConformVerdict, DivergenceCause, DivergenceReport, EventPose,
    EventSource, Facts, FaultClass, LogReport, OpenDoor, PoseName, ReportedEvent, SourceFile,
    ToleratedQuirk, WorldFact,
};
use toposlam_draw::page::{ReportOrigin, conform_page};
use toposlam_model::{
    format::world_file,
    percept::{Door, Percept, Sighting},
    trace::MisfitReason,
};

use crate::repository;

fn page_of(reports: &[LogReport]) -> String {
    let command = "toposlam conform logs/shape-6.mcap --html report.html".to_owned();
    let reports = ConformReports { logs: reports.to_vec(), ..ConformReports::default() };
    conform_page(&reports, &ReportOrigin { version: "0.1.0".to_owned(), command })
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

fn allowed(vertex: &str) -> Allowed {
    let pose = PoseName { vertex: vertex.to_owned(), from: "corner".to_owned() };
    Allowed::InWorld(pose, MisfitReason::Percept { expected: percept(3) })
}

/// The report of a log with some events that diverges at one of them, and in which other events were allowed.
fn diverged(events: usize, at: usize, allowed: Vec<Allowed>) -> LogReport {
    LogReport {
        log: "logs/shape-6.mcap".to_owned(),
        verdict: ConformVerdict::Diverged,
        events: (1..=events).map(event).collect(),
        divergence: Some(DivergenceReport {
            event: at,
            time: Some(at as f64 / 2.0),
            message: None,
            fault: FaultClass::Perception,
            cause: DivergenceCause::WrongMap,
            found: Some(percept(4).into()),
            allowed_total: allowed.len(),
            allowed,
        }),
        ..LogReport::default()
    }
}

#[test]
fn the_texts_of_a_log_are_escaped_everywhere() {
    let nasty = || "</script><script>alert('1')</script><i a=\"&{{logs}}".to_owned();
    let mut report = diverged(3, 2, vec![allowed(&nasty()); 20]);
    report.log = nasty();
    let shape_6 = fs::read(repository("worlds/shape-6.toml")).unwrap();
    report.facts = Facts {
        world: Some(WorldFact {
            name: nasty(),
            start: None,
            candidates_at_start: 12,
            candidates_left: Some(2),
            pose: None,
            world: world_file::read(&shape_6).unwrap(),
        }),
        never_followed: Some(vec![OpenDoor { vertex: nasty(), door: 0, toward: Some(nasty()) }]),
        ..Facts::default()
    };
    let pose = PoseName { vertex: nasty(), from: nasty() };
    report.events[0].then = Some(EventPose::At(pose));
    report.tolerated = vec![ToleratedQuirk { name: nasty(), reason: nasty(), events: vec![1] }];
    report.command = Some(nasty());
    report.sources = vec![SourceFile { role: "log", path: nasty(), sha256: "9f86".to_owned() }];
    let quiet = LogReport { log: nasty(), ..LogReport::default() };
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
fn an_event_can_be_missing_at_the_end_or_in_an_empty_log() {
    let missing = page_of(&[diverged(4, 5, Vec::new())]);
    assert!(missing.contains(">After all 4 events</a>"));
    let (_, before) = missing.split_once("Events before it").unwrap();
    assert!(before.split_once("</table>").unwrap().0.contains("<tr><td>4<td>0:02.0"));
    let empty = page_of(&[diverged(0, 1, Vec::new())]);
    for (page, id) in [(missing, " id=event-1-5>"), (empty, " id=event-1-1>")] {
        assert_eq!(page.matches(id).count(), 1);
    }
    // A tolerated event that is missing at the end is no line to lead to.
    let (name, reason) = ("glare".to_owned(), "the sun stands low".to_owned());
    let tolerated = vec![ToleratedQuirk { name, reason, events: vec![2, 6] }];
    let page = page_of(&[LogReport { tolerated, ..diverged(5, 4, Vec::new()) }]);
    assert!(page.contains("#event-1-2") && !page.contains("#event-1-6"));
}

#[test]
fn an_image_is_a_jpeg_or_a_png() {
    let with = |image: Option<&[u8]>| {
        let image = image.map(<[u8]>::to_vec);
        page_of(&[LogReport { image, ..diverged(2, 1, Vec::new()) }])
    };
    assert!(with(Some(b"\xff\xd8\xff\xe0")).contains("src=\"data:image/jpeg;base64,/9j/4A==\""));
    assert!(with(Some(b"\x89PNG\r\n\x1a\n")).contains("src=\"data:image/png;base64,"));
    assert_eq!(with(Some(b"GIF89a")), with(None));
}

#[test]
fn a_long_list_is_folded() {
    for (count, folds) in [(13, false), (40, true)] {
        let page = page_of(&[diverged(3, 2, vec![allowed("x"); count])]);
        assert_eq!(page.matches("<li>at x, ").count(), count);
        assert_eq!(page.contains(" more</summary>"), folds);
        assert_eq!(page.contains("<summary>28 more</summary>"), folds);
    }
}
