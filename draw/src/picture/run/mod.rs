//! A run on the floor: the plan, the marker, the robot's path, and the junctions as the robot saw them.
//! Section 6, Figure 11.
//!
//! Elements of a frame or a move have the attribute `data-rounds` or `data-moves`, so that the page of a
//! run can show the drawing at any time.

mod calls;
#[cfg(test)]
pub(crate) mod example;
mod ground;
mod passes;
mod trajectory;

use super::{
    geometry::{Extent, Point},
    svg::{NORTH, Page, Sheet},
};
use crate::run_page_data::{PageFrame, RunPageData};
pub(super) use trajectory::{pieces, ramp};

use calls::Badges;
pub(crate) use ground::BODY;
use ground::Ground;

/// The picture of a run as an SVG document. The same run gives the same bytes.
pub fn run_svg(run_data: &RunPageData) -> String {
    let drawing = RunDrawing::new(run_data);
    let extent = drawing.extent();
    let metre = Some(drawing.ground.metre);
    let (title, caption) = (&run_data.world.name, &run_data.ending);
    let sheet = Sheet { title, caption, extent, metre, up: NORTH };
    let legend = sheet.legend(legend(run_data));
    sheet.document(&legend, None, |page| drawing.write(page))
}

/// The drawing alone, with the positions of the frames.
pub(crate) fn run_drawing(run_data: &RunPageData) -> Drawn {
    let drawing = RunDrawing::new(run_data);
    let extent = drawing.extent();
    let sheet = Sheet { title: "", caption: "", extent, metre: None, up: NORTH };
    let (mut places, mut aids) = (Vec::new(), Vec::new());
    let svg = sheet.document(&[], None, |page| {
        drawing.write(page);
        let at = |round: &PageFrame| page.at(drawing.ground.at(round.pose.position));
        places = run_data.rounds.iter().map(at).collect();
        let of_aid = |round: &PageFrame| {
            let (at, direction) = drawing.ground.aid_at(run_data.aid, round.aid?);
            Some((page.at(at), direction.angle()))
        };
        aids = run_data.rounds.iter().map(of_aid).collect();
    });
    Drawn { svg, places, aids, metre: drawing.ground.metre }
}

pub(crate) struct Drawn {
    pub(crate) svg: String,
    /// The position of each frame, in units of the drawing, x to the right and y down.
    pub(crate) places: Vec<Point>,
    /// That of the marking aid at each frame, and its direction on the screen in radians; `None` if the robot carries it.
    pub(crate) aids: Vec<Option<(Point, f64)>>,
    /// Units of the drawing per metre.
    pub(crate) metre: f64,
}

/// Draws everything.
struct RunDrawing<'a> {
    run_data: &'a RunPageData,
    ground: Ground<'a>,
    badges: Badges,
}

impl<'a> RunDrawing<'a> {
    fn new(run_data: &'a RunPageData) -> Self {
        let ground = Ground::new(&run_data.plan);
        let badges = Badges::new(&ground, &run_data.calls);
        Self { run_data, ground, badges }
    }

    fn extent(&self) -> Extent {
        let mut extent = self.ground.extent().joined(self.badges.extents());
        for round in &self.run_data.rounds {
            extent.include(self.ground.at(round.pose.position));
        }
        extent
    }

    fn write(&self, page: &mut Page) {
        let Self { run_data, ground, badges } = self;
        ground.write(page);
        passes::write(page, ground, &run_data.rounds);
        trajectory::write(page, ground, &run_data.rounds);
        ground.write_aid(page, run_data.aid, run_data.facing);
        calls::write(page, ground, &run_data.calls);
        badges.write(page);
    }
}

fn legend(run_data: &RunPageData) -> Vec<String> {
    let mut lines = vec![
        "line: the robot's path, from light at the start to dark at the end".to_owned(),
        "along a hallway: the numbers of the moves through it".to_owned(),
        "in a circle: the number of doors that the robot counted there".to_owned(),
    ];
    if run_data.calls.iter().any(|call| !call.conforms) {
        lines.push("a red cross: not as specified".to_owned());
    }
    lines
}

#[cfg(test)]
mod tests {
    use resvg::usvg::roxmltree::{Document, Node};
    use toposlam_model::embedded_graph::Dart;

    use super::{
        super::reading::{number, numbers, of_class},
        *,
    };

    /// The points of a list or of path data.
    fn points(list: &str) -> Vec<Point> {
        numbers(list).chunks(2).map(|two| Point::new(two[0], two[1])).collect()
    }

    #[test]
    fn the_line_goes_through_the_place_of_every_image() {
        let run_data = example::run_page_data();
        let drawn = run_drawing(&run_data);
        let document = Document::parse(&drawn.svg).unwrap();
        let mut way = Vec::new();
        for line in of_class(&document, "trajectory") {
            let piece = points(line.attribute("points").unwrap());
            // Each piece begins where the last one ends.
            assert!(way.pop().is_none_or(|end| end == piece[0]));
            way.extend(piece);
        }
        assert_eq!(way.len(), run_data.rounds.len());
        for (on_line, place) in way.iter().zip(&drawn.places) {
            assert!(on_line.distance(*place) < 0.1);
        }
        let metres = (way[0] - way[3]) * (1.0 / drawn.metre);
        assert!(metres.distance(Point::new(0.0, 4.0)) < 0.01, "the first move went 4 m north");
    }

    #[test]
    fn every_call_is_marked_and_the_wrong_ones_with_a_cross() {
        let svg = run_svg(&example::run_page_data());
        let document = Document::parse(&svg).unwrap();
        let rounds = |class| {
            let signs = of_class(&document, class);
            signs.iter().map(|sign| sign.attribute("data-rounds").unwrap()).collect::<Vec<_>>()
        };
        assert_eq!(rounds("call"), ["1", "4"]);
        assert_eq!(rounds("call wrong"), ["7"]);
        let degrees = of_class(&document, "degree");
        let degrees: Vec<_> = degrees.iter().filter_map(Node::text).collect();
        assert_eq!(degrees, ["2", "3", "1"], "at the corner twice, rightly and wrongly");
        assert!(svg.contains("a red cross"));
        let mut right = example::run_page_data();
        right.calls.iter_mut().for_each(|call| call.conforms = true);
        assert!(!run_svg(&right).contains("a red cross"));
    }

    #[test]
    fn the_marker_lies_on_the_turning_point_and_points_along_its_hallway() {
        for (facing, ahead) in [(Dart(0), Point::new(0.0, -1.0)), (Dart(1), Point::new(1.0, 0.0))] {
            let run_data = RunPageData { facing, ..example::run_page_data() };
            let drawn = run_drawing(&run_data);
            let document = Document::parse(&drawn.svg).unwrap();
            let signs = of_class(&document, "marker");
            let shape = |sign: usize| points(signs[sign].attribute("d").unwrap());
            let place = drawn.places[0];
            let corners = Extent::from_points(shape(0));
            assert!(corners.centre().distance(place) < 0.1);
            let long = Point::new(ahead.x.abs(), ahead.y.abs());
            assert!((corners.size().dot(long) - 0.60 * drawn.metre).abs() < 0.2);
            let wide = Point::new(long.y, long.x);
            assert!((corners.size().dot(wide) - 0.18 * drawn.metre).abs() < 0.2);
            let tip = shape(1)[0] - place;
            assert!(tip.dot(ahead) > 0.5 * drawn.metre && tip.cross(ahead).abs() < 0.1);
        }
    }

    #[test]
    fn the_numbers_of_moves_are_on_the_right_of_the_path() {
        let drawn = run_drawing(&example::run_page_data());
        let document = Document::parse(&drawn.svg).unwrap();
        let east_of_hallway = |text: &Node| number(*text, "x") > drawn.places[0].x;
        let passes = of_class(&document, "passes");
        let numbers: Vec<_> = passes
            .iter()
            .map(|text| (text.first_element_child().unwrap().text(), east_of_hallway(text)))
            .collect();
        assert_eq!(numbers, [(Some("1"), true), (Some("2"), false)]);
    }

    #[test]
    fn the_same_run_gives_the_same_bytes_and_any_name_is_text() {
        let nasty = "<i>&\"";
        let mut run_data = example::run_page_data();
        for text in [&mut run_data.world.name, &mut run_data.ending] {
            nasty.clone_into(text);
        }
        let svg = run_svg(&run_data);
        assert_eq!(svg, run_svg(&run_data.clone()));
        let document = Document::parse(&svg).unwrap();
        for class in ["title", "caption"] {
            assert_eq!(of_class(&document, class)[0].text(), Some(nasty));
        }
    }

    #[test]
    fn a_run_that_never_began_is_drawn() {
        let run_data = RunPageData {
            rounds: Vec::new(),
            calls: Vec::new(),
            steps: Vec::new(),
            ..example::run_page_data()
        };
        let svg = run_svg(&run_data);
        assert!(Document::parse(&svg).is_ok());
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }
}
