//! The ground of a run: floor, walls, the names of the junctions, and the marker. Section 2.4.

use toposlam_model::{
    aid::AidKind,
    driving::WAITING,
    embedded_graph::{Dart, Vertex},
    floor_plan::{Direction, FloorPlan, walls},
    marker::MarkerLook,
};
use toposlam_vision::params::{MARKER_LENGTH, MARKER_WIDTH};

use super::super::{
    geometry::{Extent, Point},
    signs::{ARROW, Sign},
    svg::{INK, Page},
    text,
};

/// The radius of a robot's body, in metres.
pub(crate) const BODY: f64 = 0.41 / 2.0;
/// The longer side of a drawing, in units, and the bounds of the scale, in units per metre.
const SIDE: f64 = 620.0;
const METRE: [f64; 2] = [36.0, 70.0];
/// The bounds of the font size of names, and their distance from the wall.
const NAME: [f64; 2] = [11.0, 16.0];
const AWAY: f64 = 5.0;

/// A floor plan at a scale.
pub(super) struct Ground<'a> {
    pub(super) plan: &'a FloorPlan,
    /// Units of the drawing per metre.
    pub(super) metre: f64,
}

impl<'a> Ground<'a> {
    pub(super) fn new(plan: &'a FloorPlan) -> Self {
        let corners = plan.floor().flat_map(|floor| [floor.least, floor.greatest]);
        let sides = Extent::from_points(corners.map(|[x, y]| Point::new(x, y))).size();
        Self { plan, metre: (SIDE / sides.x.max(sides.y)).clamp(METRE[0], METRE[1]) }
    }

    /// A position of the plan in the drawing.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> Point {
        Point::new(x * self.metre, -y * self.metre)
    }

    pub(super) fn turning_point(&self, vertex: Vertex) -> Point {
        self.at(self.plan.junction(vertex).position)
    }

    /// Half the width of a hallway.
    pub(super) fn half(&self) -> f64 {
        self.plan.hallway_width() / 2.0 * self.metre
    }

    /// The sides of a junction on which it has no door.
    pub(super) fn closed(&self, vertex: Vertex) -> impl Iterator<Item = Direction> + '_ {
        let graph = self.plan.graph();
        let open = move |side: &Direction| {
            graph.darts_of(vertex).any(|dart| self.plan.direction(dart) == *side)
        };
        Direction::ALL.into_iter().filter(move |side| !open(side))
    }

    /// The floor of each hallway.
    fn hallways(&self) -> impl Iterator<Item = Extent> + '_ {
        self.plan
            .floor()
            .map(|floor| Extent::from_points([floor.least, floor.greatest].map(|it| self.at(it))))
    }

    /// The name of each junction: outside, at a side without a door, above or below if possible.
    fn names(&self) -> impl Iterator<Item = Name<'_>> {
        // So that it can be read when the whole of a large picture is seen.
        let size = (self.floor().size().x / 90.0).clamp(NAME[0], NAME[1]);
        self.plan.graph().vertices().filter_map(move |vertex| {
            let rank = |side: &Direction| match side {
                Direction::North => 0,
                Direction::South => 1,
                Direction::East => 2,
                Direction::West => 3,
            };
            let out = along(self.closed(vertex).min_by_key(rank)?);
            let text = self.plan.junction(vertex).name.as_str();
            let at = self.turning_point(vertex) + out * (self.half() + AWAY);
            Some(Name { text, at, out, size })
        })
    }

    /// The bounding box of the floor.
    fn floor(&self) -> Extent {
        Extent::EMPTY.joined(self.hallways())
    }

    pub(super) fn extent(&self) -> Extent {
        self.floor().joined(self.names().map(|name| name.extent())).widened(2.0)
    }

    pub(super) fn write(&self, page: &mut Page) {
        page.hallways(self.hallways());
        let walls = walls(self.plan);
        let ends = walls.iter().map(|wall| wall.span.map(|end| page.at(self.at(wall.foot(end)))));
        let line = |[from, to]: [Point; 2]| format!("M{from}L{to}");
        let lines: String = ends.map(line).collect();
        let stroke =
            format!("fill=\"none\" stroke=\"{INK}\" stroke-width=\"2\" stroke-linecap=\"square\"");
        page.path("class=\"walls\"", &lines, &stroke);
        page.line("<g class=\"names\">");
        for name in self.names() {
            name.write(page);
        }
        page.line("</g>");
    }

    /// The middle of a marker that lies at a dart, or of a robot that waits there, and the unit vector along the dart.
    pub(super) fn aid_at(&self, aid: AidKind, dart: Dart) -> (Point, Point) {
        let ahead = along(self.plan.direction(dart));
        let turning_point = self.turning_point(self.plan.graph().vertex(dart));
        let off = if matches!(aid, AidKind::Team(_)) { WAITING } else { 0.0 };
        (turning_point + ahead * (off * self.metre), ahead)
    }

    /// The marker: a rectangle, centred on the turning point, that points along a hallway, if it does; or another robot, which
    /// waits in its hallway.
    pub(super) fn write_aid(&self, page: &mut Page, aid: AidKind, facing: Dart) {
        let (middle, ahead) = self.aid_at(aid, facing);
        let length = ahead * (MARKER_LENGTH / 2.0 * self.metre);
        let width = ahead.quarter_turn() * (MARKER_WIDTH / 2.0 * self.metre);
        page.line("<g class=\"aid\">");
        if matches!(aid, AidKind::Team(_)) {
            let radius = BODY * self.metre;
            page.sign(&Sign::Ring { centre: middle, radius, look: MarkerLook::One });
        }
        page.bar(middle, width, length);
        if !matches!(aid, AidKind::Markers(_)) {
            page.sign(&Sign::Arrow {
                at: middle + length,
                direction: ahead.angle(),
                scale: 0.26 * self.metre / ARROW,
            });
        }
        page.line("</g>");
    }
}

/// A junction's name, beside its wall.
struct Name<'a> {
    text: &'a str,
    at: Point,
    /// The unit vector away from the wall.
    out: Point,
    size: f64,
}

impl Name<'_> {
    fn extent(&self) -> Extent {
        let half = Point::new(text::width(self.text, self.size) / 2.0, self.size * 0.6);
        let away = Point::new(self.out.x * half.x, self.out.y * half.y);
        Extent::around(self.at + away, half.x, half.y)
    }

    fn write(&self, page: &mut Page) {
        let anchor = match self.out.x {
            x if x > 0.5 => "start",
            x if x < -0.5 => "end",
            _ => "middle",
        };
        let baseline = self.at.y + self.size * (0.36 + 0.5 * self.out.y);
        let at = Point::new(self.at.x, baseline);
        page.anchored_text(self.text, at, self.size, INK, ["name", anchor]);
    }
}

/// The unit vector of a direction of the plan.
pub(super) fn along(direction: Direction) -> Point {
    let [x, y] = direction.vector();
    Point::new(x, -y)
}
