//! The section of one log.

use toposlam_conform::{
    DivergenceReport, FoldedReport, LogReport, SourceFile, ToleratedQuirk, words,
};

use super::{
    Level, coverage, data_address, each, events, heading, panel, paragraph, sentence, short_list,
    sign,
};
use crate::{
    moment::{clock, grouped, moment},
    picture::{OpenGraph, WorldPicture, escaped, open_svg, svg},
    text::counted,
};

/// The number of items of a list that are not folded.
const FEW: usize = 12;
/// The largest folded trail that is drawn, in vertices.
const DRAWN: usize = 400;

pub(super) fn section(report: &LogReport, number: usize, level: Level) -> String {
    let beneath = match level {
        Level::First => Level::Second,
        Level::Second | Level::Third => Level::Third,
    };
    let panel = |class: &str, name: &str, content: &str| panel(beneath, class, name, content);
    let covered = if report.has_coverage() {
        panel("late", "Coverage", &coverage::content(&report.coverage))
    } else {
        String::new()
    };
    let judged = panel("late", "What was checked", &facts(report))
        + &panel("late", "Tolerated divergences", &tolerated(report, number));
    let proved = match report.divergence {
        Some(_) => "What the log proves before it diverges",
        None => "What the log proves about its world",
    };
    let another = "Another world that explains the log as well";
    let seen = [
        panel("camera", "What the camera saw", &image(report)),
        panel("folded", proved, &report.folded.as_ref().map(folded).unwrap_or_default()),
        panel("", world_name(report), &world(report)),
        panel("", another, &twin(report)),
    ];
    let seen = seen.concat();
    // Without a divergence there is room on the left.
    let (left, right) = if report.divergence.is_some() {
        let led = [
            panel("allowed", "What is allowed here", &allowed(report)),
            panel("before", "Events before it", &events::before(report, number)),
            panel("late", "A shorter log with the same divergence", &shorter(report)),
        ];
        (led.concat() + &judged, seen + &covered)
    } else {
        (judged + &covered, seen)
    };
    // An empty column leaves its room to the other.
    format!(
        "<section id=\"log-{number}\">\n{}<div class=\"columns\">\n<div>{left}</div>\n<div>{right}</div>\n\
         </div>\n{}</section>\n",
        verdict(report, number, level),
        events::all(report, number),
    )
}

fn verdict(report: &LogReport, log: usize, level: Level) -> String {
    let name = report.verdict.name();
    let heading = heading(
        level,
        &format!(
            "{}<strong>{}</strong> <span class=\"of\">{}</span>",
            sign(report.verdict),
            sentence(report.verdict.in_words()).trim_end_matches('.'),
            escaped(&report.log),
        ),
    );
    let because = match &report.divergence {
        Some(divergence) => because(divergence, report, log),
        None => each(words::fits(report), |fits| format!("<p>{fits}</p>\n")),
    };
    let unique = each(words::unique(&report.facts), |unique| paragraph(&unique));
    let remarks = each(words::remarks(report), |remark| paragraph(&remark));
    format!(
        "<div class=\"verdict {name}\">\n{heading}<div class=\"because\">{because}{unique}\
         {remarks}</div>\n</div>\n"
    )
}

/// The divergence: where, why, and the class of the fault.
fn because(divergence: &DivergenceReport, report: &LogReport, log: usize) -> String {
    let DivergenceReport { event, time, message, fault, cause, .. } = divergence;
    let of = report.events.len();
    let [number, all] = [*event, of].map(|number| grouped(number as u128));
    let place = if *event > of {
        format!("After all {all} events")
    } else {
        format!("Event {number} of {all}")
    };
    let time = time.map_or_else(String::new, |time| format!(" \u{b7} {} min", clock(time)));
    let message = each(message, |place| format!(" \u{b7} {}", words::message_place(place)));
    format!(
        "<p class=\"what\"><b>{}</b> {}</p>\n\
         <p><span class=\"chip\">{fault}</span> {}</p>\n\
         <p class=\"faint\">{}{time}{message} \u{b7} cause <code>{}</code></p>\n",
        escaped(&sentence(&words::found(divergence))),
        escaped(&sentence(&cause.to_string())),
        sentence(words::fault(*fault)),
        events::link(log, *event, &place),
        cause.name(),
    )
}

fn allowed(report: &LogReport) -> String {
    let allowed = report.divergence.as_ref().map(words::allowed).unwrap_or_default();
    if allowed.is_empty() {
        return String::new();
    }
    short_list(&allowed, FEW, |it| format!("<li>{}</li>\n", escaped(it)))
}

fn shorter(report: &LogReport) -> String {
    let events =
        each(&report.shorter, |event| format!("<li>{}</li>\n", escaped(&words::event(event))));
    let events = match report.shorter.len() {
        0 => String::new(),
        1..=FEW => format!("<ol class=\"shorter\">\n{events}</ol>\n"),
        count => format!(
            "<details><summary>{}</summary>\n<ol class=\"shorter\">\n{events}</ol>\n</details>\n",
            counted(count, "event")
        ),
    };
    events + &report.command.as_deref().map_or_else(String::new, super::command)
}

fn tolerated(report: &LogReport, log: usize) -> String {
    if report.tolerated.is_empty() {
        return String::new();
    }
    let last = report.events.last().map_or(0, |line| line.number);
    let quirk = |ToleratedQuirk { name, reason, events: at }: &ToleratedQuirk| {
        let (first, rest) = at.split_at(at.len().min(FEW));
        let place = |&event: &usize| {
            let words = event.to_string();
            if event > last { words } else { events::link(log, event, &words) }
        };
        let mut places: Vec<_> = first.iter().map(place).collect();
        if !rest.is_empty() {
            places.push(format!("{} more", grouped(rest.len() as u128)));
        }
        let places = match at.len() {
            0 => "not used".to_owned(),
            1 => format!("at event {}", places.join(", ")),
            _ => format!("at events {}", places.join(", ")),
        };
        format!(
            "<li><b>{}</b>, {}: {} <span class=\"faint\">{places}</span></li>\n",
            escaped(name),
            words::times(at.len()),
            escaped(&sentence(reason)),
        )
    };
    format!("<ul>\n{}</ul>\n", each(&report.tolerated, quirk))
}

fn facts(report: &LogReport) -> String {
    let row = |name: &str, content: &str| {
        format!("<tr><th scope=\"row\">{name}</th><td>{content}</td></tr>\n")
    };
    let begun = report.begun.map(|begun| ("first message", date_text(begun)));
    let facts = words::facts(report).into_iter().chain(begun);
    let source = |SourceFile { role, path, sha256 }: &SourceFile| {
        let content = format!(
            "{}<br><span class=\"faint\">SHA-256</span> <code class=\"hash\">{}</code>",
            escaped(path),
            escaped(sha256)
        );
        row(&format!("{role} file"), &content)
    };
    let rows = each(facts, |(name, fact)| row(name, &escaped(&fact)));
    let sources = each(&report.sources, source);
    format!("<table class=\"facts\">\n<tbody>\n{rows}{sources}</tbody>\n</table>\n")
}

/// The image of the camera, if it is a JPEG or PNG file.
fn image(report: &LogReport) -> String {
    let file = report.image.as_deref().unwrap_or_default();
    let kind = if file.starts_with(b"\xff\xd8\xff") {
        "jpeg"
    } else if file.starts_with(b"\x89PNG\r\n\x1a\n") {
        "png"
    } else {
        return String::new();
    };
    let address = data_address(kind, file);
    format!("<img alt=\"The image of the robot's camera\" src=\"{address}\">\n")
}

/// What the log proves about its world, with the doors that were never followed.
fn folded(FoldedReport { trail, entries }: &FoldedReport) -> String {
    let (vertices, open_doors) = (trail.vertex_count(), trail.open_count());
    let is_small = vertices <= DRAWN;
    let drawing = is_small.then(|| open_svg(&OpenGraph::of_trail(trail, entries))).flatten();
    let image = match drawing {
        Some(svg) => drawn(&svg, "A drawing of the folded trail"),
        None => "<p class=\"faint\">It is too large to be drawn.</p>\n".to_owned(),
    };
    if open_doors == 0 {
        return image;
    }
    let doors = counted(open_doors, "door");
    let were = if open_doors == 1 { "was" } else { "were" };
    let places = match vertices {
        1 => String::new(),
        count => format!(" Of the {} places, some may be one.", grouped(count as u128)),
    };
    format!(
        "{image}<p class=\"legend\"><span class=\"open-door\"></span> {doors} that {were} never \
         followed.{places}</p>\n"
    )
}

fn world_name(report: &LogReport) -> &'static str {
    match (&report.facts.world, &report.folded) {
        (Some(_), _) => "The known world",
        (None, Some(_)) => "The smallest world that explains the log",
        (None, None) => "The only world that explains the log",
    }
}

/// The known world, or the smallest one that explains the log.
fn world(report: &LogReport) -> String {
    let facts = &report.facts;
    let known = facts.world.as_ref().map(|known| &known.world);
    let Some(world) = known.or(facts.smallest.as_ref().map(|smallest| &smallest.world)) else {
        return String::new();
    };
    let mut picture = WorldPicture::from(world);
    if let Some(twin) = facts.twin.as_ref().filter(|_| known.is_some()) {
        (picture.marker, picture.start) = (twin.marker.into(), Some(twin.first_marker));
    }
    drawn(&svg(&picture), "A drawing of the world")
}

/// Another world that the marker does not distinguish from the first.
fn twin(report: &LogReport) -> String {
    let Some(twin) = &report.facts.twin else { return String::new() };
    let caption = twin.figure.map_or(String::new(), |figure| format!("{figure} of the paper"));
    let picture = WorldPicture { marker: twin.marker.into(), ..WorldPicture::from(&twin.world) };
    let drawing = svg(&WorldPicture { title: "another world", caption: &caption, ..picture });
    drawn(&drawing, "A drawing of another world")
}

/// The date of a message, or the time on a clock that starts with the robot or the simulation.
fn date_text(nanoseconds: u64) -> String {
    let text = moment(nanoseconds);
    if text.ends_with("UTC") { text } else { format!("no date: {text} on the clock of the log") }
}

/// A drawing in an SVG document. The stylesheet keeps its names readable with its own width, in pixels.
fn drawn(svg: &str, what: &str) -> String {
    let address = data_address("svg+xml", svg.as_bytes());
    let width = svg.split_once(" width=\"").and_then(|(_, width)| width.split_once('"'));
    let width = width.and_then(|(width, _)| width.parse::<u32>().ok());
    let own = width.map_or_else(String::new, |width| format!(" style=\"--own:{width}px\""));
    format!(
        "<div class=\"drawing\" tabindex=\"0\"><img class=\"world\" alt=\"{what}\" \
         src=\"{address}\"{own}></div>\n"
    )
}
