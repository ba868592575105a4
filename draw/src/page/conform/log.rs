//! The section of one log.

use toposlam_conform::{
    DivergenceReport, FoldedReport, LogReport, SourceFile, ToleratedQuirk, words,
};

use super::{Level, coverage, each, events, panel, short_list, wording};
use crate::{
    moment::{clock, grouped, moment},
    picture::{OpenGraph, WorldPicture, escaped, open_svg, svg},
    text::counted,
};

/// The number of items of a list that are not folded.
const FEW: usize = 12;
/// The largest folded trail that is drawn, in vertices.
const DRAWN: usize = 400;

/// The section of a log.
pub(super) fn section(report: &LogReport, number: usize, level: Level) -> String {
    let beneath = level.beneath();
    let covered = covered(report, beneath);
    let judged = [facts(report, beneath), tolerated(report, number, beneath)].concat();
    let seen = [
        image(report, beneath),
        folded(report, beneath),
        world(report, beneath),
        twin(report, beneath),
    ];
    let seen = seen.concat();
    // Without a divergence there is room on the left.
    let (left, right) = if report.divergence.is_some() {
        let led =
            [allowed(report, beneath), before(report, number, beneath), shorter(report, beneath)];
        (led.concat() + &judged, seen + &covered)
    } else {
        (judged + &covered, seen)
    };
    // An empty column leaves its room to the other.
    let column = |panels: &str| format!("<div>{panels}</div>\n");
    format!(
        "<section id=\"log-{number}\">\n{}<div class=\"columns\">\n{}{}</div>\n{}</section>\n",
        verdict(report, number, level),
        column(&left),
        column(&right),
        events::all(report, number),
    )
}

/// The verdict and why.
fn verdict(report: &LogReport, log: usize, level: Level) -> String {
    let name = report.verdict.name();
    let heading = level.heading(&format!(
        "{}<strong>{}</strong> <span class=\"of\">{}</span>",
        wording::sign(report.verdict),
        wording::sentence(name).trim_end_matches('.'),
        escaped(&report.log),
    ));
    let because = match &report.divergence {
        Some(divergence) => because(divergence, report, log),
        None => format!("<p>{}</p>\n", words::fits(report)),
    };
    let unique =
        words::unique(&report.facts).map(|unique| format!("<p>{}</p>\n", escaped(&unique)));
    let unique = unique.unwrap_or_default();
    let remarks = each(words::remarks(report), |remark| {
        format!("<p>{}</p>\n", escaped(&wording::sentence(&remark)))
    });
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
    let message = message.as_ref().map(|place| format!(" \u{b7} {}", words::message_place(place)));
    let message = message.unwrap_or_default();
    format!(
        "<p class=\"what\"><b>{}</b> {}</p>\n\
         <p><span class=\"chip\">{fault}</span> {}</p>\n\
         <p class=\"faint\">{}{time}{message} \u{b7} cause <code>{}</code></p>\n",
        escaped(&wording::sentence(&words::found(divergence))),
        escaped(&wording::sentence(&cause.to_string())),
        wording::sentence(words::fault(*fault)),
        events::link(log, *event, &place),
        cause.name(),
    )
}

fn allowed(report: &LogReport, level: Level) -> String {
    let allowed = report.divergence.as_ref().map(words::allowed).unwrap_or_default();
    if allowed.is_empty() {
        return String::new();
    }
    let list = short_list(&allowed, FEW, |it| format!("<li>{}</li>\n", escaped(it)));
    panel(level, "allowed", "What is allowed here", &list)
}

fn before(report: &LogReport, log: usize, level: Level) -> String {
    let Some(table) = events::before(report) else {
        return String::new();
    };
    let all = match &report.divergence {
        Some(divergence) => events::link(log, divergence.event, "among all events"),
        None => String::new(),
    };
    let more = format!("<p class=\"faint\">{all}</p>\n");
    panel(level, "before", "Events before it", &(table + &more))
}

fn shorter(report: &LogReport, level: Level) -> String {
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
    let command = report.command.as_deref().map_or_else(String::new, super::command);
    if events.is_empty() && command.is_empty() {
        return String::new();
    }
    panel(level, "late", "A shorter log with the same divergence", &(events + &command))
}

fn tolerated(report: &LogReport, log: usize, level: Level) -> String {
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
        let places = if places.is_empty() {
            "not used".to_owned()
        } else {
            format!("at {} {}", if at.len() == 1 { "event" } else { "events" }, places.join(", "))
        };
        format!(
            "<li><b>{}</b>, {}: {} <span class=\"faint\">{places}</span></li>\n",
            escaped(name),
            words::times(at.len()),
            escaped(&wording::sentence(reason)),
        )
    };
    let list = format!("<ul>\n{}</ul>\n", each(&report.tolerated, quirk));
    panel(level, "late", "Tolerated divergences", &list)
}

fn facts(report: &LogReport, level: Level) -> String {
    let row = |(name, fact): (&str, String)| {
        format!("<tr><th scope=\"row\">{name}</th><td>{}</td></tr>\n", escaped(&fact))
    };
    let begun = report.begun.map(|begun| ("first message", date_text(begun)));
    let source = |SourceFile { role, path, sha256 }: &SourceFile| {
        format!(
            "<tr><th scope=\"row\">{role} file</th><td>{}<br><span class=\"faint\">SHA-256</span> \
             <code class=\"hash\">{}</code></td></tr>\n",
            escaped(path),
            escaped(sha256)
        )
    };
    let rows =
        each(words::facts(report).into_iter().chain(begun), row) + &each(&report.sources, source);
    let table = format!("<table class=\"facts\">\n<tbody>\n{rows}</tbody>\n</table>\n");
    panel(level, "late", "What was checked", &table)
}

fn image(report: &LogReport, level: Level) -> String {
    let Some(address) = report.image.as_deref().and_then(wording::image_address) else {
        return String::new();
    };
    let image = format!("<img alt=\"The image of the robot's camera\" src=\"{address}\">\n");
    panel(level, "camera", "What the camera saw", &image)
}

/// What the log proves about its world, with the doors that were never followed.
fn folded(report: &LogReport, level: Level) -> String {
    let Some(FoldedReport { trail, entries }) = &report.folded else {
        return String::new();
    };
    let (vertices, open_doors) = (trail.vertex_count(), trail.open_count());
    let is_small = vertices <= DRAWN;
    let drawing = is_small.then(|| open_svg(&OpenGraph::of_trail(trail, entries))).flatten();
    let image = match drawing {
        Some(svg) => drawn(&svg, "A drawing of the folded trail"),
        None => "<p class=\"faint\">It is too large to be drawn.</p>\n".to_owned(),
    };
    let doors = counted(open_doors, "door");
    let were = if open_doors == 1 { "was" } else { "were" };
    let places = match vertices {
        1 => String::new(),
        count => format!(" Of the {} places, some may be one.", grouped(count as u128)),
    };
    let legend = format!(
        "<p class=\"legend\"><span class=\"open-door\"></span> {doors} that {were} never followed.{places}\
         </p>\n"
    );
    let name = match report.divergence {
        Some(_) => "What the log proves before it diverges",
        None => "What the log proves about its world",
    };
    panel(level, "folded", name, &(image + if open_doors > 0 { &legend } else { "" }))
}

/// The known world, or the smallest one that explains the log.
fn world(report: &LogReport, level: Level) -> String {
    let facts = &report.facts;
    let known = facts.world.as_ref().map(|known| &known.world);
    let Some(world) = known.or(facts.smallest.as_ref().map(|smallest| &smallest.world)) else {
        return String::new();
    };
    let picture = WorldPicture::from(world);
    let picture = match facts.twin.as_ref().filter(|_| known.is_some()) {
        Some(twin) => {
            WorldPicture { marker: twin.marker, start: Some(twin.first_marker), ..picture }
        }
        None => picture,
    };
    let name = match (known, &report.folded) {
        (Some(_), _) => "The known world",
        (None, Some(_)) => "The smallest world that explains the log",
        (None, None) => "The only world that explains the log",
    };
    panel(level, "", name, &drawn(&svg(&picture), "A drawing of the world"))
}

/// Another world that the marker does not distinguish from the first.
fn twin(report: &LogReport, level: Level) -> String {
    let Some(twin) = &report.facts.twin else { return String::new() };
    let caption = twin.figure.map_or(String::new(), |figure| format!("{figure} of the paper"));
    let picture = WorldPicture { marker: twin.marker, ..WorldPicture::from(&twin.world) };
    let drawing = svg(&WorldPicture { title: "another world", caption: &caption, ..picture });
    let name = "Another world that explains the log as well";
    panel(level, "", name, &drawn(&drawing, "A drawing of another world"))
}

/// The date of a message, or the time on a clock that starts with the robot or the simulation.
fn date_text(nanoseconds: u64) -> String {
    let text = moment(nanoseconds);
    if text.ends_with("UTC") { text } else { format!("no date: {text} on the clock of the log") }
}

/// A drawing in an SVG document.
fn drawn(svg: &str, what: &str) -> String {
    let address = wording::svg_address(svg);
    let own = wording::svg_width(svg).map_or_else(String::new, |width| {
        // The stylesheet keeps the names readable with it.
        format!(" style=\"--own:{width}px\"")
    });
    format!(
        "<div class=\"drawing\" tabindex=\"0\"><img class=\"world\" alt=\"{what}\" \
         src=\"{address}\"{own}></div>\n"
    )
}

fn covered(report: &LogReport, level: Level) -> String {
    if report.coverage.is_empty() {
        return String::new();
    }
    let content = coverage::summary(&report.coverage) + &coverage::table(&report.coverage);
    panel(level, "late", "Coverage", &content)
}
