//! A recorded run of a robot with a laser scanner: what its scans hit, its way, and the junctions that it visited,
//! in the frame of odometry.

use std::{
    collections::{BTreeMap, BTreeSet, HashMap},
    fmt::Write as _,
};

use toposlam_logs::{
    entries::{Content, Entry},
    record::{EventId, EventKind, Frame},
};
use toposlam_model::driving::odometry::Odometry;
use toposlam_vision::geometry::from_robot;

use super::{
    geometry::{Extent, Point},
    run::{pieces, ramp},
    svg::{FAINT, INK, MARKER, PAPER, Page, Sheet, short},
};

/// A recorded run, to be drawn.
#[derive(Clone, Debug, Default)]
pub struct LaserRunPicture {
    /// Above the drawing.
    pub title: String,
    /// Below it.
    pub caption: String,
    pub hits: ScanHits,
    /// The robot's positions, in metres.
    pub way: Vec<[f64; 2]>,
    pub visits: Vec<DrawnVisit>,
    /// Where free space is wider than a corridor, in metres, if the building is no network of corridors because of it.
    pub wide: Vec<[f64; 2]>,
    /// The position of a marker in metres, and the direction in which it points in radians.
    pub marker: Option<([f64; 2], Option<f64>)>,
}

/// A visit of a junction.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnVisit {
    /// The centre of the junction, in metres.
    pub centre: [f64; 2],
    /// The directions of the doors, in radians; none if nothing is known of them.
    pub doors: Vec<f64>,
    /// Those of what may be doors.
    pub possible: Vec<f64>,
    /// Whether the percept is certain.
    pub is_certain: bool,
    /// Whether it has more doors than a junction of corridors, and the building is no network of them because of that.
    pub is_hall: bool,
    /// The direction in which the robot left, in radians.
    pub exit: Option<f64>,
}

impl LaserRunPicture {
    /// Adds what a scan hit, and where the robot was. An entry without a scan, or without a finite pose, adds nothing.
    ///
    /// In a log without odometry, the pose of each scan is that of its message.
    pub fn add(&mut self, entry: Entry, poses: &BTreeMap<EventId, Odometry>) {
        let pose = poses.get(&entry.id).copied();
        if pose.is_none() && !poses.is_empty() {
            return;
        }
        let Content::Event(EventKind::Frame(Frame { scan: Some(scan), odometry, .. })) =
            entry.content
        else {
            return;
        };
        let odometry = pose.unwrap_or(odometry);
        let [east, north] = odometry.position;
        if [east, north, odometry.heading].iter().all(|number| number.is_finite()) {
            self.way.push(odometry.position);
            let odometry_from_robot = from_robot(&odometry);
            for hit in scan.hits() {
                self.hits.add((odometry_from_robot * hit).into());
            }
        }
    }
}

/// The cells of a square grid that scans have hit.
#[derive(Clone, Debug, Default)]
pub struct ScanHits {
    counts: HashMap<[i32; 2], u32>,
}

impl ScanHits {
    /// The side of a cell, in metres.
    const CELL: f64 = 0.2;
    /// The most cells that are kept.
    const MOST: usize = 1 << 20;

    /// Adds a point, in metres. Beyond a million cells no new ones are added.
    pub(crate) fn add(&mut self, point: [f64; 2]) {
        let cell = point.map(|part| (part / Self::CELL).floor() as i32);
        if self.counts.len() < Self::MOST {
            self.counts.entry(cell).or_default();
        }
        if let Some(count) = self.counts.get_mut(&cell) {
            *count = count.saturating_add(1);
        }
    }

    /// The cells that show walls: those that were hit more than once, and at least half as often as a usual one
    /// of these; and those beside them that were hit half as often again.
    fn walls(&self) -> BTreeSet<[i32; 2]> {
        let mut again: Vec<u32> =
            self.counts.values().copied().filter(|&count| count > 1).collect();
        again.sort_unstable();
        let enough = again.get(again.len() / 2).map_or(2, |usual| usual.div_ceil(2).max(2));
        let count = |cell: [i32; 2]| self.counts.get(&cell).copied().unwrap_or_default();
        let is_wall = |[x, y]: [i32; 2]| {
            let around = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [1, -1], [-1, 1]];
            let beside = || around.iter().any(|[dx, dy]| count([x + dx, y + dy]) >= enough);
            count([x, y]) >= enough || 2 * count([x, y]) >= enough && beside()
        };
        self.counts.keys().copied().filter(|&cell| is_wall(cell)).collect()
    }
}

const SIDE: f64 = 600.0;
/// The bounds of the scale, in units per metre.
const METRE: [f64; 2] = [1.0, 40.0];
/// The radius of the disc of a junction, and the length of its arms beyond it.
const DISC: f64 = 8.5;
const ARM: f64 = 12.0;
/// The sizes of the fonts.
const DEGREE: f64 = 12.0;
const NUMBER: f64 = 11.0;
const SMALL: f64 = 8.0;
/// The dashes of what is only possible.
const DASHED: &str = " stroke-dasharray=\"3 2\"";
/// Visits of junctions with centres nearer than this, in metres, are drawn as one: certain ones with as many doors, and those
/// of which several percepts are possible, with the doors of the first.
const SAME: f64 = 3.0;
const WALL: &str = "#9aa1ab";
/// The colour and the radius of the dots where free space is wider than a corridor.
const HALL: &str = "#e08a1e";
const WIDE: f64 = 4.0;

/// Visits of one junction.
struct VisitedPlace<'v> {
    visit: &'v DrawnVisit,
    /// The number of each visit, from 1, and the direction in which the robot left.
    numbers: Vec<(usize, Option<f64>)>,
}

/// The picture of a recorded run as an SVG document. The same run gives the same bytes.
pub fn laser_run_svg(picture: &LaserRunPicture) -> String {
    let walls = picture.hits.walls();
    let metres = extent(picture, &walls);
    let sides = metres.size();
    let metre = (SIDE / sides.x.max(sides.y).max(1e-3)).clamp(METRE[0], METRE[1]);
    let at = |[x, y]: [f64; 2]| Point::new(x * metre, -y * metre);
    let places = places(&picture.visits);
    let room = DISC + ARM + 2.0 * NUMBER;
    let discs = places.iter().map(|place| Extent::around(at(place.visit.centre), room, room));
    let drawn = Extent { least: metres.least * metre, most: metres.most * metre };
    let extent = drawn.widened(2.0).joined(discs);
    let sheet = Sheet {
        title: &picture.title,
        caption: &picture.caption,
        extent,
        metre: Some(metre),
        up: "the y axis of odometry is up",
    };
    let legend = sheet.legend(legend(picture));
    sheet.document(&legend, None, |page| {
        write_walls(page, &walls, metre);
        write_way(page, &picture.way.iter().map(|&point| page.at(at(point))).collect::<Vec<_>>());
        write_wide(page, picture.wide.iter().map(|&point| at(point)));
        // What is certain lies over what is only possible.
        let (certain, others): (Vec<_>, Vec<_>) =
            places.iter().partition(|place| place.visit.is_certain);
        for place in others.into_iter().chain(certain) {
            place.write(page, at(place.visit.centre));
        }
        if let Some((position, heading)) = picture.marker {
            write_marker(page, at(position), heading);
        }
    })
}

/// The box around everything, in metres, with y down.
fn extent(picture: &LaserRunPicture, walls: &BTreeSet<[i32; 2]>) -> Extent {
    let cells = walls.iter().flat_map(|[x, y]| {
        let corner = |x: i32, y: i32| [x, y].map(|part| f64::from(part) * ScanHits::CELL);
        [corner(*x, *y), corner(x + 1, y + 1)]
    });
    let visits = picture.visits.iter().map(|visit| visit.centre);
    let all = cells.chain(picture.way.iter().copied()).chain(visits);
    let extent = Extent::from_points(all.map(|[x, y]| Point::new(x, -y)));
    if extent.least.x.is_finite() { extent } else { Extent::from_points([Point::default()]) }
}

/// The visits by their junctions, in the order of the first visits.
fn places(visits: &[DrawnVisit]) -> Vec<VisitedPlace<'_>> {
    let mut places: Vec<VisitedPlace> = Vec::new();
    for (number, visit) in (1..).zip(visits) {
        let [x, y] = visit.centre;
        let is_here = |place: &&mut VisitedPlace| {
            let [u, v] = place.visit.centre;
            let is_same = place.visit.is_certain == visit.is_certain
                && (!visit.is_certain || place.visit.doors.len() == visit.doors.len());
            (x - u).hypot(y - v) < SAME && is_same
        };
        let exit = visit.exit;
        match places.iter_mut().find(is_here) {
            Some(place) => place.numbers.push((number, exit)),
            None => places.push(VisitedPlace { visit, numbers: vec![(number, exit)] }),
        }
    }
    places
}

fn legend(picture: &LaserRunPicture) -> Vec<String> {
    let mut lines = vec![
        "grey: what the scans hit; line: the robot's way, from light to dark".to_owned(),
        "in a circle: the number of doors, with a stroke towards each".to_owned(),
        "at a stroke: the numbers of the visits after which the robot left there".to_owned(),
    ];
    let any = |what: fn(&DrawnVisit) -> bool| picture.visits.iter().any(what);
    if any(|visit| !visit.possible.is_empty()) {
        lines.push("a dashed stroke: what may be a door".to_owned());
    }
    if any(|visit| !visit.is_certain) {
        lines.push("a dashed circle: a visit of which several percepts are possible".to_owned());
    }
    if any(|visit| visit.is_hall) {
        lines.push("a red circle: more doors than a junction of corridors has".to_owned());
    }
    if !picture.wide.is_empty() {
        lines.push("orange: free space is wider than a corridor".to_owned());
    }
    if picture.marker.is_some() {
        lines.push("red arrow or ring: the marker".to_owned());
    }
    lines
}

/// The cells, in runs along x.
fn write_walls(page: &mut Page, walls: &BTreeSet<[i32; 2]>, metre: f64) {
    let mut rows: Vec<[i32; 2]> = walls.iter().map(|&[x, y]| [y, x]).collect();
    rows.sort_unstable();
    let mut path = String::new();
    for run in rows.chunk_by(|one, next| one[0] == next[0] && one[1] + 1 == next[1]) {
        let ([y, x], length) = (run[0], run.len());
        // Writing to a string does not fail.
        let _ = write!(path, "M{x} {}h{length}v1h-{length}z", -1 - y);
    }
    let scale = (metre * ScanHits::CELL * 1e4).round() / 1e4;
    let origin = page.at(Point::default());
    let class = format!("class=\"hits\" transform=\"translate({origin}) scale({scale})\"");
    page.path(&class, &path, &format!("fill=\"{WALL}\""));
}

/// The robot's way: one piece for each colour, each from the end of the last.
fn write_way(page: &mut Page, points: &[Point]) {
    page.line(
        "<g fill=\"none\" stroke-width=\"2\" stroke-linejoin=\"round\" stroke-linecap=\"round\">",
    );
    for (first, last, share) in pieces(points.len()) {
        let mut line = String::new();
        let mut before = None;
        for at in points.get(first..=last).unwrap_or_default() {
            let place = format!("{},{} ", short(at.x), short(at.y));
            // A robot that stands adds nothing.
            if before.as_ref() != Some(&place) {
                line.push_str(&place);
                before = Some(place);
            }
        }
        page.line(&format!(
            "<polyline class=\"way\" points=\"{}\" stroke=\"{}\"/>",
            line.trim_end(),
            ramp(share)
        ));
    }
    page.line("</g>");
}

/// Where free space is wider than a corridor: a dot at each place that is some way from the last one.
fn write_wide(page: &mut Page, places: impl Iterator<Item = Point>) {
    let mut last: Option<Point> = None;
    for place in places {
        if last.is_some_and(|last| (last.x - place.x).hypot(last.y - place.y) < WIDE) {
            continue;
        }
        last = Some(place);
        page.circle(
            "class=\"wide\"",
            place,
            WIDE,
            &format!("fill=\"{HALL}\" fill-opacity=\"0.55\""),
        );
    }
}

/// The marker: an arrow, or a ring if it points nowhere.
fn write_marker(page: &mut Page, at: Point, heading: Option<f64>) {
    let Some(heading) = heading else {
        let stroke = format!("fill=\"none\" stroke=\"{MARKER}\" stroke-width=\"2.6\"");
        return page.circle("class=\"marker\"", at, DISC + 3.5, &stroke);
    };
    let along = Point::polar(-heading, 1.0);
    let across = along.quarter_turn();
    // Beside the stroke of the door, whose end may have numbers.
    let beside = at + across * 9.0;
    let [tip, base] = [DISC + ARM + 6.0, DISC].map(|length| beside + along * length);
    page.marker(&[tip, base + across * 5.5, base - across * 5.5]);
}

impl VisitedPlace<'_> {
    fn write(&self, page: &mut Page, at: Point) {
        let Self { visit, numbers } = self;
        let certain = visit.doors.iter().map(|&door| (door, "arm", ""));
        let possible = visit.possible.iter().map(|&door| (door, "possible", DASHED));
        for (door, class, dashes) in certain.chain(possible) {
            let along = Point::polar(-door, 1.0);
            let [from, to] = [DISC, DISC + ARM].map(|length| page.at(at + along * length));
            let ink = if dashes.is_empty() { INK } else { FAINT };
            let stroke = format!("stroke=\"{ink}\" stroke-width=\"2.4\"{dashes}");
            page.path(&format!("class=\"{class}\""), &format!("M{from}L{to}"), &stroke);
        }
        let least = visit.doors.len();
        let sign = match visit.possible.len() {
            _ if visit.is_certain => least.to_string(),
            0 => "?".to_owned(),
            more => format!("{least}–{}", least + more),
        };
        let (ink, dashes) = match visit.is_certain {
            _ if visit.is_hall => (MARKER, ""),
            true => (INK, ""),
            false => (FAINT, DASHED),
        };
        let look = format!("fill=\"{PAPER}\" stroke=\"{ink}\" stroke-width=\"1.8\"{dashes}");
        page.circle("class=\"junction\"", at, DISC, &look);
        let size = if sign.chars().count() > 1 { SMALL } else { DEGREE };
        page.text(&sign, at + Point::new(0.0, size * 0.36), size, ink, "degree");
        let all: Vec<f64> = visit.doors.iter().chain(&visit.possible).copied().collect();
        let ends = all.iter().map(|&door| (Some(door), at + Point::polar(-door, DISC + ARM)));
        for (door, end) in ends.chain([(None, at + Point::new(0.0, DISC + 2.0))]) {
            let left = numbers.iter().filter(|(_, exit)| nearest(&all, *exit) == door);
            let list: Vec<_> = left.map(|(number, _)| number.to_string()).collect();
            if list.is_empty() {
                continue;
            }
            let text = list.join(", ");
            // Beside the end of the stroke, so that the way stays visible.
            let along = Point::polar(door.map_or(std::f64::consts::FRAC_PI_2, |door| -door), 1.0);
            let half = super::text::width(&text, NUMBER) / 2.0;
            let off = along.x.abs() * half + along.y.abs() * NUMBER * 0.5 + 3.0;
            let middle = end + along * off;
            let room = Extent::around(middle, half + 1.5, NUMBER * 0.55);
            let look = format!("rx=\"2\" fill=\"{PAPER}\" fill-opacity=\"0.85\"");
            page.rectangle("", room, &look);
            let fill = if door.is_some() { INK } else { FAINT };
            page.text(&text, middle + Point::new(0.0, NUMBER * 0.36), NUMBER, fill, "visits");
        }
    }
}

/// The door nearest to a direction; `None` without a direction.
fn nearest(doors: &[f64], direction: Option<f64>) -> Option<f64> {
    let direction = direction?;
    let off = |door: f64| super::geometry::wrapped(door - direction).abs();
    doors.iter().copied().min_by(|one, other| off(*one).total_cmp(&off(*other)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use resvg::usvg::roxmltree::{Document, Node};

    use super::{
        super::reading::{number, of_class},
        *,
    };

    /// A corridor along x with a T in its middle, driven there and into the stem and back.
    fn picture() -> LaserRunPicture {
        let mut hits = ScanHits::default();
        for step in 0..100 {
            for _ in 0..2 {
                let middle = 0.2 * f64::from(step) + 0.1;
                hits.add([middle, 1.1]);
                hits.add([middle, -1.1]);
            }
        }
        // A person: nothing else was hit near them.
        hits.add([5.0, 0.0]);
        let visit = |centre, exit| DrawnVisit {
            centre,
            doors: vec![PI, FRAC_PI_2, 0.0],
            possible: Vec::new(),
            is_certain: true,
            is_hall: false,
            exit,
        };
        LaserRunPicture {
            title: "a <log>".to_owned(),
            caption: "conforms".to_owned(),
            hits,
            way: vec![[1.0, 0.0], [10.0, 0.0], [10.0, 5.0], [10.0, 0.0], [19.0, 0.0]],
            visits: vec![
                visit([10.0, 0.0], Some(FRAC_PI_2)),
                visit([10.5, 0.5], Some(0.1)),
                DrawnVisit { doors: Vec::new(), is_certain: false, ..visit([14.0, 0.0], None) },
                DrawnVisit {
                    doors: vec![PI, 0.0],
                    possible: vec![FRAC_PI_2],
                    is_certain: false,
                    is_hall: true,
                    ..visit([18.0, 0.0], Some(0.0))
                },
            ],
            wide: vec![[2.0, 0.0], [2.01, 0.0], [4.0, 0.0]],
            marker: Some(([10.0, 0.0], Some(PI))),
        }
    }

    #[test]
    fn each_visited_junction_is_one_disc_with_its_doors_and_its_visits() {
        let svg = laser_run_svg(&picture());
        assert_eq!(svg, laser_run_svg(&picture()));
        let document = Document::parse(&svg).unwrap();
        let texts =
            |class| of_class(&document, class).iter().filter_map(Node::text).collect::<Vec<_>>();
        assert_eq!(texts("degree"), ["?", "2–3", "3"]);
        assert_eq!(texts("visits"), ["3", "4", "1", "2"]);
        assert_eq!(of_class(&document, "arm").len(), 5);
        // What is only possible is dashed.
        let dashed = |node: &Node<'_, '_>| node.attribute("stroke-dasharray").is_some();
        let possible = of_class(&document, "possible");
        assert!(possible.len() == 1 && possible.iter().all(dashed));
        let discs: Vec<_> = of_class(&document, "junction").iter().map(dashed).collect();
        assert_eq!(discs, [true, false, false]);
        assert_eq!(of_class(&document, "wide").len(), 2);
        assert_eq!(of_class(&document, "marker").len(), 1);
        assert_eq!(texts("title"), ["a <log>"]);
        // The first visit left by the stem, which is above the disc.
        let disc = of_class(&document, "junction")[2];
        let first = of_class(&document, "visits")[2];
        assert!(number(first, "y") < number(disc, "cy"));
        assert!((number(first, "x") - number(disc, "cx")).abs() < 1.0);
    }

    #[test]
    fn what_was_hit_once_is_no_wall() {
        let walls = picture().hits.walls();
        assert_eq!(walls.len(), 200);
        assert!(walls.iter().all(|[_, y]| [5, -6].contains(y)));
    }

    #[test]
    fn a_run_without_anything_is_drawn() {
        let svg = laser_run_svg(&LaserRunPicture::default());
        assert!(Document::parse(&svg).is_ok() && !svg.contains("NaN") && !svg.contains("inf"));
    }
}
