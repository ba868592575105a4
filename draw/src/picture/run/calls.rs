//! The junctions as the robot saw them: a dot where it stood, a cross if the arrival is not as specified,
//! and beside the junction the number of doors that it counted.

use std::collections::BTreeMap;

use toposlam_model::embedded_graph::Vertex;

use super::{
    super::{
        geometry::{Extent, Point},
        svg::{INK, MARKER, Page},
    },
    ground::{Ground, along},
};
use crate::run_page_data::PageArrival;

/// The radius of a badge, and the distance between two badges.
const BADGE: f64 = 8.0;
const APART: f64 = 17.5;

/// The numbers of doors counted at each junction: each number once, and once more if it was wrong.
pub(super) struct Badges(Vec<Badge>);

struct Badge {
    at: Point,
    degree: u32,
    conforms: bool,
    /// The number of frames before it was first counted.
    rounds: usize,
}

impl Badges {
    pub(super) fn new(ground: &Ground, calls: &[PageArrival]) -> Self {
        let mut counted: BTreeMap<_, BTreeMap<_, PageArrival>> = BTreeMap::new();
        for (number, call) in calls.iter().enumerate() {
            // What is at no junction stands for itself.
            let place = junction(ground, call).ok_or(number);
            let there = counted.entry(place).or_default();
            there.entry((!call.conforms, call.percept.degree)).or_insert_with(|| call.clone());
        }
        let mut badges = Vec::new();
        for (place, there) in &counted {
            for (number, call) in there.values().enumerate() {
                let at = match place {
                    Ok(vertex) => beside(ground, *vertex, number as f64),
                    Err(_) => ground.at(call.pose.position) + Point::new(1.0, -1.0) * (1.4 * BADGE),
                };
                let PageArrival { rounds, percept, conforms, .. } = *call;
                badges.push(Badge { at, degree: percept.degree, conforms, rounds });
            }
        }
        Self(badges)
    }

    pub(super) fn extents(&self) -> impl Iterator<Item = Extent> + '_ {
        self.0.iter().map(|badge| Extent::around(badge.at, BADGE + 1.0, BADGE + 1.0))
    }

    pub(super) fn write(&self, page: &mut Page) {
        for &Badge { at, degree, conforms, rounds } in &self.0 {
            let (class, fill, edge, ink) = if conforms {
                ("badge", "#ffffff", INK, INK)
            } else {
                ("badge wrong", MARKER, MARKER, "#ffffff")
            };
            page.line(&format!("<g class=\"{class}\" data-rounds=\"{rounds}\">"));
            let look = format!("fill=\"{fill}\" stroke=\"{edge}\" stroke-width=\"1.2\"");
            page.circle("", at, BADGE, &look);
            page.text(&degree.to_string(), at + Point::new(0.0, 4.0), 11.0, ink, "degree");
            page.line("</g>");
        }
    }
}

/// Draws where the robot stood at each call.
pub(super) fn write(page: &mut Page, ground: &Ground, calls: &[PageArrival]) {
    for call in calls {
        let (at, rounds) = (ground.at(call.pose.position), call.rounds);
        if call.conforms {
            let class = format!("class=\"call\" data-rounds=\"{rounds}\"");
            let look = format!("fill=\"#ffffff\" stroke=\"{INK}\" stroke-width=\"1.1\"");
            page.circle(&class, at, 2.4, &look);
        } else {
            let class = format!("class=\"call wrong\" data-rounds=\"{rounds}\"");
            let cross = format!("M{}m-5 -5l10 10m0 -10l-10 10", page.at(at));
            let stroke = format!("fill=\"none\" stroke=\"{MARKER}\" stroke-width=\"2.6\"");
            page.path(&class, &cross, &stroke);
        }
    }
}

/// The junction at which the robot stood.
fn junction(ground: &Ground, call: &PageArrival) -> Option<Vertex> {
    let at = ground.at(call.pose.position);
    let off = |vertex: Vertex| {
        let off = at - ground.turning_point(vertex);
        off.x.abs().max(off.y.abs())
    };
    ground.plan.graph().vertices().find(|&vertex| off(vertex) <= ground.half())
}

/// The position of a junction's n-th badge: along its walls, away from its doors.
fn beside(ground: &Ground, vertex: Vertex, number: f64) -> Point {
    let closed: Vec<_> = ground.closed(vertex).map(along).collect();
    let whole = closed.iter().fold(Point::default(), |sum, &side| sum + side);
    let away = (ground.half() - BADGE - 3.0).min(2.0 * BADGE + 4.0);
    let at = ground.turning_point(vertex) + whole * away;
    // Further ones follow along the wall, towards the middle.
    let on = if closed.len() == 2 { closed[0] * -1.0 } else { whole.quarter_turn() };
    at + on * (APART * number)
}
