//! A run on the floor: the plan, the marker, where the robot was, and what it made of each junction.
//! Section 6, Figure 11.
//!
//! What belongs to a picture or a move says so (`data-rounds`, `data-moves`), so that the page of a run
//! can show the drawing as it was at any time.

mod calls;
mod ground;
mod passes;
mod trajectory;

use super::{
    geometry::{Extent, Point},
    svg::{Page, Sheet},
};
use crate::journal::Journal;
use calls::Badges;
use ground::Ground;

/// The picture of a run as an SVG document. The same run gives the same bytes.
#[must_use]
pub fn run_svg(journal: &Journal) -> String {
    let drawing = RunDrawing::of(journal);
    let extent = drawing.extent();
    let metre = Some(drawing.ground.metre);
    let sheet = Sheet { title: &journal.name, caption: &journal.ending, extent, metre };
    let legend = sheet.legend(says(journal));
    sheet.document(&legend, None, |page, shift| drawing.write(page, shift))
}

/// The drawing alone, and where each picture was taken in it.
pub(crate) fn run_drawing(journal: &Journal) -> Drawn {
    let drawing = RunDrawing::of(journal);
    let sheet = Sheet { title: "", caption: "", extent: drawing.extent(), metre: None };
    let mut moved = Point::default();
    let svg = sheet.document(&[], None, |page, shift| {
        moved = shift;
        drawing.write(page, shift);
    });
    let places = journal.rounds.iter().map(|round| {
        let at = drawing.ground.at(round.pose.position) + moved;
        [at.x, at.y]
    });
    Drawn { svg, places: places.collect(), metre: drawing.ground.metre }
}

/// A run as it is drawn.
pub(crate) struct Drawn {
    /// The SVG document.
    pub(crate) svg: String,
    /// Where each picture was taken, in units of the drawing, x to the right and y down.
    pub(crate) places: Vec<[f64; 2]>,
    /// Units of the drawing in a metre.
    pub(crate) metre: f64,
}

/// Everything at its place.
struct RunDrawing<'a> {
    journal: &'a Journal,
    ground: Ground<'a>,
    badges: Badges,
}

impl<'a> RunDrawing<'a> {
    fn of(journal: &'a Journal) -> Self {
        let ground = Ground::of(&journal.plan);
        let badges = Badges::of(&ground, &journal.calls);
        Self { journal, ground, badges }
    }

    fn extent(&self) -> Extent {
        let mut extent = self.ground.extent();
        extent.join(self.badges.extent());
        for round in &self.journal.rounds {
            extent.include(self.ground.at(round.pose.position));
        }
        extent
    }

    fn write(&self, page: &mut Page, shift: Point) {
        let Self { journal, ground, badges } = self;
        ground.write(page, shift);
        passes::write(page, ground, &journal.rounds, shift);
        trajectory::write(page, ground, &journal.rounds, shift);
        ground.write_marker(page, journal.facing, shift);
        calls::write(page, ground, &journal.calls, shift);
        badges.write(page, shift);
    }
}

/// What the signs mean.
fn says(journal: &Journal) -> Vec<String> {
    let mut says = vec![
        "line: where the robot was, light at first and dark at last".to_owned(),
        "along a hallway: the moves through it, on the right of their way".to_owned(),
        "in a circle: the doors that the robot counted at the junction".to_owned(),
    ];
    if journal.calls.iter().any(|call| !call.conforms) {
        says.push("a red cross: not as the specification says".to_owned());
    }
    says
}
