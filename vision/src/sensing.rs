//! The whole of sensing: from an image to a scene. Section 3, Figure 5.

use image::RgbImage;
use thiserror::Error;
use toposlam_model::driving::scene::{Place, Reason, Scene};

use crate::{
    annotate,
    boundary::{Bearings, Boundary},
    camera::Camera,
    cluster::{Cluster, clusters},
    colour::{ColourModel, ColourTable, FloorRing, Stripe, StripeKind},
    corner::{Corner, corners},
    ground_view::{GroundView, Unwrapping},
    hallway::{Hallway, hallway},
    junction::{Finding, Junction, junction},
    line::{Line, lines},
    marker::marker,
    wall::{Frame, Wall},
};

/// Sensing with one camera in one building: its tables, made once.
#[derive(Clone, Debug)]
pub struct Sensor {
    camera: Camera,
    unwrapping: Unwrapping,
    ring: FloorRing,
    bearings: Bearings,
    model: ColourModel,
    colours: ColourTable,
    view: GroundView,
}

/// An image that this camera did not take.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "the image has {} x {} pixels; those of the calibrated camera have {} x {}",
    .found[0], .found[1], .expected[0], .expected[1]
)]
pub struct WrongSize {
    /// The image's width and height.
    pub found: [u32; 2],
    /// The camera's.
    pub expected: [u32; 2],
}

/// All that was made out on the way to a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// What is seen on each bearing.
    pub boundary: Option<Boundary>,
    /// The pieces of wall.
    pub clusters: Vec<Cluster>,
    /// Their straight pieces.
    pub lines: Vec<Line>,
    /// The axes along which they run.
    pub frame: Option<Frame>,
    /// Those of them that run along the axes.
    pub walls: Vec<Wall>,
    /// Where they meet or end.
    pub corners: Vec<Corner>,
    /// The hallway, if it is one.
    pub hallway: Option<Hallway>,
    /// The junction, if one was looked for and found.
    pub junction: Option<Junction>,
}

/// The name of each step, and its picture.
pub type Stages = [(&'static str, RgbImage); 6];

/// Fewer boundary points than these tell of no place.
const FEW: usize = 40;
/// Less floor than this around the robot is no floor: a part of all bearings.
const FLOOR: usize = crate::boundary::BEARINGS / 5;

impl Sensor {
    /// Sensing with a camera in a building with these colours.
    #[must_use]
    pub fn new(camera: &Camera, colours: &ColourModel) -> Self {
        Self {
            camera: camera.clone(),
            unwrapping: Unwrapping::new(camera),
            ring: FloorRing::new(camera),
            bearings: Bearings::new(colours.stripe, camera.eye_height()),
            colours: colours.table(),
            model: colours.clone(),
            view: GroundView::unseen(),
        }
    }

    /// The scene in an image.
    ///
    /// # Errors
    /// [`WrongSize`] for an image that is not of the calibrated camera's size.
    pub fn sense(&mut self, image: &RgbImage) -> Result<Scene, WrongSize> {
        self.trace(image).map(|(scene, _)| scene)
    }

    /// The scene in an image, and all that was made out on the way to it.
    ///
    /// # Errors
    /// As [`Self::sense`].
    pub fn trace(&mut self, image: &RgbImage) -> Result<(Scene, Trace), WrongSize> {
        let found = [image.width(), image.height()];
        if found != self.camera.image {
            return Err(WrongSize { found, expected: self.camera.image });
        }
        let Some(gain) = self.model.gain(&self.ring.colours(image)) else {
            self.view = GroundView::unseen();
            let scene = Scene { place: Place::Unknown(Reason::NoFloor), marker: None };
            return Ok((scene, Trace::default()));
        };
        self.unwrapping.view(image, &self.colours.lit(gain), &mut self.view);
        Ok(interpreted(&self.view, &self.bearings, self.model.stripe))
    }

    /// The scene in an image, and a picture of each step on the way to it, with its name.
    ///
    /// # Errors
    /// As [`Self::sense`].
    pub fn stages(&mut self, image: &RgbImage) -> Result<(Scene, Stages), WrongSize> {
        let (scene, trace) = self.trace(image)?;
        let stages = [
            ("1-classes", annotate::classes(&self.view)),
            ("2-boundary", annotate::boundary(&trace)),
            ("3-clusters", annotate::clusters(&trace)),
            ("4-lines", annotate::lines(&trace)),
            ("5-scene", annotate::scene(&scene, &trace)),
            ("6-image", annotate::over(image, &self.camera, &scene)),
        ];
        Ok((scene, stages))
    }
}

/// The scene in a ground view, and all that was made out on the way to it.
// paper: sense.hallway.first
#[must_use]
pub fn interpreted(view: &GroundView, bearings: &Bearings, stripe: Stripe) -> (Scene, Trace) {
    let mut boundary = bearings.look(view);
    let clusters = clusters(&boundary);
    let lines = lines(&clusters);
    let frame = Frame::of(&lines);
    let walls = frame.map_or_else(Vec::new, |frame| frame.walls(&lines));
    if let Some(frame) = &frame {
        boundary.make_sure(&walls, frame);
    }
    let hallway = frame.and_then(|frame| hallway(&walls, &boundary, &frame));
    let mut trace = Trace { clusters, lines, frame, walls, hallway, ..Trace::default() };
    let place = place(&mut trace, &boundary, margin(stripe));
    let junction = match &place {
        Place::Junction(junction) => Some(junction),
        Place::Hallway(_) | Place::Unknown(_) => None,
    };
    let scene = Scene { marker: marker(view, &boundary, junction), place };
    trace.boundary = Some(boundary);
    (scene, trace)
}

/// From the edge that is seen, where the floor ends at the stripe, to the wall plane, in metres.
fn margin(stripe: Stripe) -> f64 {
    match stripe.kind {
        StripeKind::OnFloor => stripe.width,
        StripeKind::OnWall => 0.0,
    }
}

/// Where the robot is: a hallway is looked for first, and a junction where there is none.
fn place(trace: &mut Trace, boundary: &Boundary, margin: f64) -> Place {
    if boundary.sights.iter().filter(|sight| sight.floor > 0.0).count() < FLOOR {
        return Place::Unknown(Reason::NoFloor);
    }
    let Some(frame) = trace.frame.filter(|_| boundary.points().count() >= FEW) else {
        return Place::Unknown(Reason::FewWalls);
    };
    let in_hallway = |hallway: &Hallway| Place::Hallway(hallway.view(margin));
    if let Some(hallway) = trace.hallway.as_ref().filter(|hallway| hallway.is_sure()) {
        return in_hallway(hallway);
    }
    trace.corners = corners(&trace.walls);
    let otherwise = |reason| match &trace.hallway {
        Some(hallway) => in_hallway(hallway),
        None => Place::Unknown(reason),
    };
    match junction(&trace.corners, &trace.walls, boundary, &frame) {
        Finding::Nothing => otherwise(Reason::NothingFits),
        Finding::Ambiguous => otherwise(Reason::Ambiguous),
        Finding::Junction(junction) => {
            trace.junction = Some(junction);
            if junction.is_here() {
                return Place::Junction(junction.view());
            }
            trace.hallway = junction.hallway(&trace.walls);
            match &trace.hallway {
                Some(hallway) => in_hallway(hallway),
                None => Place::Unknown(Reason::NothingFits),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use toposlam_model::driving::scene::wrapped;

    use super::*;
    use crate::{
        colour::Class,
        drawn::{self, Place as Drawn},
    };

    /// Each kind of junction, by the doors that it has ahead, to the left, behind and to the right.
    const KINDS: [[bool; 4]; 6] = [
        [false, false, true, false],
        [false, true, true, false],
        [false, false, true, true],
        [false, true, true, true],
        [true, true, true, false],
        [true, false, true, true],
    ];
    /// Half the width of the hallway, offset to the left, heading.
    const VIEWS: [(f64, f64, f64); 3] = [(0.8, 0.0, 0.0), (0.7, 0.2, 0.3), (1.0, -0.3, 0.4)];

    fn scene(doors: [bool; 4], before: f64, view: usize) -> Place {
        let (half, left, heading) = VIEWS[view % VIEWS.len()];
        let drawn = Drawn::junction(doors, half).seen_from([-before, left], heading);
        interpreted(&drawn, &drawn::bearings(), drawn::STRIPE).0.place
    }

    // paper: sense.junction.type
    // paper: sense.junction.entry
    // paper: sense.centre-lines
    // paper: sense.place
    // paper: drive.junction
    // paper: alg2.6
    #[test]
    fn every_junction_is_made_out_from_half_a_metre_before_it_to_beyond_it() {
        for (number, doors) in KINDS.into_iter().enumerate() {
            for (step, before) in [0.5, 0.2, 0.0, -0.1].into_iter().enumerate() {
                let view = number + step;
                let (_, left, heading) = VIEWS[view % VIEWS.len()];
                let Place::Junction(junction) = scene(doors, before, view) else {
                    panic!("{doors:?} {before} before");
                };
                let found: Vec<f64> = junction.doors.iter().map(|door| door.direction).collect();
                let ideal: Vec<f64> = [2_u32, 1, 0, 3]
                    .into_iter()
                    .filter(|&number| doors[number as usize])
                    .map(|number| f64::from(number) * FRAC_PI_2 - heading)
                    .collect();
                assert_eq!(found.len(), ideal.len(), "{doors:?} {before} before");
                for (found, ideal) in found.iter().zip(&ideal) {
                    assert!(wrapped(found - ideal).abs() < 0.01, "{found} is not {ideal}");
                }
                let [x, y] = junction.turning_point;
                let along = x * heading.cos() - y * heading.sin();
                let across = x * heading.sin() + y * heading.cos();
                assert!((along - before).abs() < 0.01, "{along} is not {before}");
                assert!((across + left).abs() < 0.01, "{across} is not {left}");
            }
        }
    }

    // paper: sense.hallway.first
    // paper: sense.distances
    // paper: sense.parallel
    // paper: sense.opposite
    // paper: sense.hallway.two-clusters
    #[test]
    fn a_metre_and_a_half_before_a_junction_is_a_hallway() {
        for (number, doors) in KINDS.into_iter().enumerate() {
            for (step, before) in [1.5, 2.5].into_iter().enumerate() {
                let view = number + step;
                let (half, left, heading) = VIEWS[view % VIEWS.len()];
                let Place::Hallway(hallway) = scene(doors, before, view) else {
                    panic!("{doors:?} {before} before");
                };
                assert!((hallway.heading + heading).abs() < 0.01, "{hallway:?}");
                assert!((hallway.left - half + left).abs() < 0.01, "{hallway:?}");
                assert!((hallway.right - half - left).abs() < 0.01, "{hallway:?}");
            }
        }
    }

    #[test]
    fn nothing_and_floor_without_walls_are_unknown_with_their_reason() {
        let reason = |class| {
            let mut view = GroundView::unseen();
            view.classes.fill(class);
            interpreted(&view, &drawn::bearings(), drawn::STRIPE).0.place
        };
        assert_eq!(reason(Class::Other), Place::Unknown(Reason::NoFloor));
        assert_eq!(reason(Class::Stripe), Place::Unknown(Reason::NoFloor));
        assert_eq!(reason(Class::Unseen), Place::Unknown(Reason::NoFloor));
        assert_eq!(reason(Class::Floor), Place::Unknown(Reason::FewWalls));
    }
}
