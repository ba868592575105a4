//! The ground of a run: floor, walls, the names of the junctions, and the marker. Section 2.4.

use toposlam_robot::simulator::walls;
use toposlam_vision::marker;

use super::super::{
    geometry::{Extent, Point},
    labels::{Kind, Label},
    signs::{ARROW, Sign},
    svg::{FLOOR, INK, Page, short},
};
use crate::model::{
    embedded_graph::{Dart, Vertex},
    floor_plan::{Direction, FloorPlan},
};

/// The longer side that a plan is given, in units, and the bounds of a metre.
const SIDE: f64 = 620.0;
const METRE: [f64; 2] = [36.0, 70.0];
/// The font size of names, and how far from the wall they stand.
const NAME: f64 = 11.0;
const AWAY: f64 = 5.0;

/// A floor plan at a scale.
pub(super) struct Ground<'a> {
    pub(super) plan: &'a FloorPlan,
    /// Units of the picture in a metre.
    pub(super) metre: f64,
}

impl<'a> Ground<'a> {
    pub(super) fn of(plan: &'a FloorPlan) -> Self {
        let corners = plan.floor().flat_map(|floor| [floor.least, floor.greatest]);
        let sides = Extent::of(corners.map(|[x, y]| Point::new(x, y))).size();
        Self { plan, metre: (SIDE / sides.x.max(sides.y)).clamp(METRE[0], METRE[1]) }
    }

    /// Where a position of the plan is in the picture.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> Point {
        Point::new(x * self.metre, -y * self.metre)
    }

    /// The turning point of a junction.
    pub(super) fn turning_point(&self, vertex: Vertex) -> Point {
        self.at(self.plan.junction(vertex).position)
    }

    /// From the middle of a hallway to its walls.
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
            .map(|floor| Extent::of([floor.least, floor.greatest].map(|it| self.at(it))))
    }

    /// The name of each junction: outside, at a side without a door, above or below if there is such.
    fn names(&self) -> impl Iterator<Item = Label> + '_ {
        self.plan.graph().vertices().filter_map(|vertex| {
            let rank = |side: &Direction| match side {
                Direction::North => 0,
                Direction::South => 1,
                Direction::East => 2,
                Direction::West => 3,
            };
            let side = self.closed(vertex).min_by_key(rank)?;
            let lines = vec![self.plan.junction(vertex).name.clone()];
            let centre = self.turning_point(vertex);
            let mut label = Label { lines, centre, size: NAME, kind: Kind::Inside };
            let text = label.extent().size() * 0.5;
            let out = along(side);
            let away = self.half() + AWAY + (out.x * text.x).abs() + (out.y * text.y).abs();
            label.centre = centre + out * away;
            Some(label)
        })
    }

    pub(super) fn extent(&self) -> Extent {
        let mut extent = Extent::EMPTY;
        for part in self.hallways().chain(self.names().map(|name| name.extent())) {
            extent.join(part);
        }
        extent.widened(2.0)
    }

    pub(super) fn write(&self, page: &mut Page, shift: Point) {
        page.line(&format!("<g fill=\"{FLOOR}\">"));
        for hallway in self.hallways() {
            page.rectangle("class=\"hallway\"", hallway, shift);
        }
        page.line("</g>");
        let walls = walls(self.plan);
        let lines = walls.iter().map(|wall| wall.span.map(|end| self.at(wall.foot(end)) + shift));
        let lines = lines.map(|[from, to]| {
            format!("M{} {}L{} {}", short(from.x), short(from.y), short(to.x), short(to.y))
        });
        page.line(&format!(
            "<path class=\"walls\" d=\"{}\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"2\" \
             stroke-linecap=\"square\"/>",
            lines.collect::<String>()
        ));
        page.line("<g class=\"names\">");
        for name in self.names() {
            page.label(&name, shift);
        }
        page.line("</g>");
    }

    /// The marker: a rectangle that is centred on the turning point and points along a hallway.
    // paper: hardware.marker
    pub(super) fn write_marker(&self, page: &mut Page, facing: Dart, shift: Point) {
        let ahead = along(self.plan.direction(facing));
        let middle = self.turning_point(self.plan.graph().vertex(facing)) + shift;
        let length = ahead * (marker::LENGTH / 2.0 * self.metre);
        let width = ahead.quarter_turn() * (marker::WIDTH / 2.0 * self.metre);
        page.marker(&[
            middle + length + width,
            middle - length + width,
            middle - length - width,
            middle + length - width,
        ]);
        let arrow = Sign::Arrow {
            at: middle + length,
            direction: ahead.angle(),
            scale: 0.26 * self.metre / ARROW,
        };
        page.sign(&arrow);
    }
}

/// The step of length 1 in a direction of the plan.
pub(super) fn along(direction: Direction) -> Point {
    let [x, y] = direction.vector();
    Point::new(x, -y)
}
