//! The legends of the pictures of sensing: what each sign and colour means, and the scale.

use image::Rgb;

use super::{BLUE, BODY, CLUSTERS, CYAN, GREEN, ORANGE, RED, WHITE, shade};
use crate::{colour::PixelClass, ground_view::GroundView};

#[derive(Clone, Debug, PartialEq)]
pub struct StageLegend {
    pub entries: Vec<(LegendSign, &'static str)>,
    /// The length of a metre, in pixels; `None` if the picture has no uniform scale.
    pub metre: Option<f64>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LegendSign {
    Areas(Vec<Rgb<u8>>),
    Dot(Rgb<u8>),
    Ring(Rgb<u8>),
    Line(Rgb<u8>),
    Thick(Rgb<u8>),
    Robot { body: Rgb<u8>, outline: Rgb<u8> },
}

/// The legend of the picture of a step, by the step's name; empty for any other name.
pub fn legend(stage: &str) -> StageLegend {
    use LegendSign::{Areas, Dot, Line, Ring, Robot, Thick};
    let area = |class| Areas(vec![shade(class)]);
    let entered = (Thick(GREEN), "centre line of the hallway in which the robot is");
    let entries = match stage {
        "1-classes" => vec![
            (area(PixelClass::Floor), "floor"),
            (area(PixelClass::Stripe), "boundary stripe"),
            (area(PixelClass::Marker), "marker"),
            (area(PixelClass::Other), "something else"),
            (area(PixelClass::Unknown), "unknown colour"),
            (area(PixelClass::Unseen), "not seen"),
        ],
        "2-boundary" => vec![
            (Line(super::REACH), "floor, up to the farthest seen"),
            (Dot(WHITE), "end of the floor"),
            (Dot(ORANGE), "possible end of the floor"),
        ],
        "3-clusters" => {
            vec![(Areas(CLUSTERS[..3].to_vec()), "boundary points, each cluster in its own colour")]
        }
        "4-lines" => vec![
            (Line(CLUSTERS[0]), "straight piece, in its cluster's colour"),
            (Thick(CLUSTERS[0]), "wall"),
            (Dot(WHITE), "end of a wall"),
        ],
        "5-scene" => vec![
            (Thick(super::WALL), "wall"),
            (Ring(CYAN), "corner that bends inwards"),
            (Ring(ORANGE), "corner that bends outwards"),
            entered,
            (Thick(RED), "centre lines of the other hallways"),
            (Dot(WHITE), "turning point"),
            (Areas(vec![BLUE]), "marker"),
        ],
        "6-image" => vec![
            entered,
            (Thick(RED), "centre lines of the other hallways, 1.6 m from the turning point"),
            (Line(BLUE), "marker"),
        ],
        _ => Vec::new(),
    };
    let mut legend = StageLegend { entries, metre: None };
    if !legend.entries.is_empty() && stage != "6-image" {
        let robot = Robot { body: BODY, outline: WHITE };
        legend.entries.push((robot, "robot, facing up"));
        legend.metre = Some(1.0 / GroundView::SCALE);
    }
    legend
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{annotate, sensing::SensingTrace};

    #[test]
    fn a_metre_is_as_long_as_the_legend_shows() {
        let picture = annotate::boundary(&SensingTrace::default());
        let metre = legend("2-boundary").metre.unwrap();
        // The robot is a disc with a radius of 0.205 m.
        let area = std::f64::consts::PI * (0.205 * metre).powi(2);
        let robot = |pixel: &&Rgb<u8>| [BODY, WHITE].contains(pixel);
        let drawn = picture.pixels().filter(robot).count() as f64;
        assert!((drawn / area - 1.0).abs() < 0.05, "{drawn} of {area}");
    }

    #[test]
    fn every_stage_has_a_legend_and_each_ground_view_a_scale() {
        for stage in annotate::STAGES {
            let legend = legend(stage);
            assert!(legend.entries.len() > 1, "{stage}");
            assert_eq!(legend.metre.is_some(), stage != "6-image", "{stage}");
        }
    }
}
