//! The estimate of a junction from the images of one approach. Sections 3 and 5.1.
//!
//! One image can be wrong. A visit is decided when two agree on the junction's form; the marker is taken
//! from the best view of the approach, for beside the turning point the robot's body hides it. Images in which
//! the junction is only possible do not count: they all show the same furniture.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::ops::RangeInclusive;

use super::scene::{JunctionView, MarkerView, Place, Scene, undirected, wrapped};
use crate::percept::{Door, Percept, Sighting};

/// What a junction looks like from its entry: which of the four directions, clockwise from the entry
/// door, are doors. The first always is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JunctionShape(pub [bool; 4]);

/// The shapes of junctions in a building with dead ends, L and T, and their names.
pub const JUNCTION_SHAPES: [(JunctionShape, &str); 6] = [
    (JunctionShape([true, false, false, false]), "dead-end"),
    (JunctionShape([true, true, false, false]), "l-left"),
    (JunctionShape([true, false, false, true]), "l-right"),
    (JunctionShape([true, true, false, true]), "t-by-stem"),
    (JunctionShape([true, true, true, false]), "t-stem-left"),
    (JunctionShape([true, false, true, true]), "t-stem-right"),
];

/// The marker for which a robot looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SoughtMarker {
    /// It points along a door of an L, and lies at no other junction.
    #[default]
    Pointing,
    /// It lies at any junction, and points along no door.
    Lying,
    /// The robot looks for none on its way.
    Nothing,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JunctionEstimate {
    sought: SoughtMarker,
    /// The number of images of each shape, by its [`JunctionShape::code`].
    shapes: [u32; 8],
    marker: Option<Glimpse>,
    /// Whether an image was taken from where a marker would be seen well.
    looked: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Glimpse {
    /// By how much its distance was off the best, in metres.
    off: f64,
    /// Whether it lay along the hallway by which the robot came.
    along_entry: bool,
}

const AGREEING: u32 = 2;
/// From where before its middle the marker is seen well, in metres.
const APPROACH: RangeInclusive<f64> = 0.2..=0.8;
const BEST: f64 = 0.5;

impl JunctionShape {
    /// Its name, if it is one of [`JUNCTION_SHAPES`].
    pub fn name(self) -> Option<&'static str> {
        JUNCTION_SHAPES.iter().find(|(shape, _)| *shape == self).map(|(_, name)| *name)
    }

    /// The form of a junction as one image shows it; `None` where its doors are not at right angles
    /// to each other.
    pub fn from_view(junction: &JunctionView) -> Option<Self> {
        let entry = junction.doors.first()?.direction;
        let mut doors = [false; 4];
        for door in &junction.doors {
            let quarters = wrapped(entry - door.direction).rem_euclid(4.0 * FRAC_PI_2) / FRAC_PI_2;
            let known = &mut doors[quarters.round() as usize % 4];
            if *known {
                return None;
            }
            *known = true;
        }
        Some(Self(doors))
    }

    fn code(self) -> usize {
        let [_, left, ahead, right] = self.0;
        usize::from(left) | usize::from(ahead) << 1 | usize::from(right) << 2
    }

    /// The form with a number below 8.
    fn with_code(code: usize) -> Self {
        Self([true, code & 1 != 0, code & 2 != 0, code & 4 != 0])
    }

    /// The quarter turns clockwise from the entry door to each door, in the order of the doors.
    pub fn quarters(self) -> Vec<u32> {
        (0..4).filter(|&quarter| self.0[quarter as usize]).collect()
    }

    pub fn degree(self) -> u32 {
        self.0.iter().map(|&door| u32::from(door)).sum()
    }

    /// Whether there are two doors, at a right angle.
    pub fn is_l(self) -> bool {
        self.degree() == 2 && !self.0[2]
    }
}

impl JunctionEstimate {
    /// The visit of a robot that knows the junction at which it stands, and whether the marker lies
    /// there.
    pub fn decided(shape: JunctionShape, sighting: Sighting) -> Self {
        let marker = match sighting {
            Sighting::Pointing(door) => Some(Glimpse { off: 0.0, along_entry: door == Door::BACK }),
            Sighting::Lying(_) => Some(Glimpse { off: 0.0, along_entry: true }),
            _ => None,
        };
        let mut visit = Self { marker, looked: true, ..Self::default() };
        visit.shapes[shape.code()] = AGREEING;
        visit
    }

    /// The visit of a robot that has put down the marker where it stands, along its entry door.
    pub fn at_marker() -> Self {
        let marker = Some(Glimpse { off: 0.0, along_entry: true });
        Self { marker, looked: true, ..Self::default() }
    }

    /// The same visit of a robot that looks for this marker.
    #[must_use]
    pub fn with_sought(self, sought: SoughtMarker) -> Self {
        Self { sought, ..self }
    }

    /// The visit of the same robot at the next junction.
    #[must_use]
    pub fn next(&self) -> Self {
        Self::default().with_sought(self.sought)
    }

    pub fn add_scene(&mut self, scene: &Scene) {
        let entry = match &scene.place {
            Place::Hallway(hallway) => Some(hallway.heading),
            Place::Junction(junction) if junction.is_certain() => {
                if let Some(shape) = JunctionShape::from_view(junction) {
                    self.shapes[shape.code()] += 1;
                }
                self.looked |= APPROACH.contains(&junction.distance());
                junction.doors.first().map(|entry| entry.direction)
            }
            Place::Junction(_) | Place::Unknown(_) => None,
        };
        if let (Some(entry), Some(marker)) = (entry, &scene.marker) {
            self.glimpse(entry, marker);
        }
    }

    fn glimpse(&mut self, entry: f64, marker: &MarkerView) {
        let ahead = marker.position[0].hypot(marker.position[1]);
        let off = (ahead - BEST).abs();
        let better = self.marker.is_none_or(|best| off < best.off);
        if APPROACH.contains(&ahead) && marker.position[0] > 0.0 && better {
            let along_entry = undirected(marker.axis - entry).abs() < FRAC_PI_4;
            self.marker = Some(Glimpse { off, along_entry });
        }
    }

    /// The form of the junction, once two images agree on it and fewer on any other.
    pub fn shape(&self) -> Option<JunctionShape> {
        let most = self.shapes.into_iter().max().filter(|&most| most >= AGREEING)?;
        let mut leading = (0..8).filter(|&code| self.shapes[code] == most);
        let code = leading.next()?;
        leading.next().is_none().then(|| JunctionShape::with_code(code))
    }

    // paper: marker-sense.place
    /// What the robot perceives at the junction, once the visit is decided. A marker that points lies only at
    /// junctions that are Ls. That no marker lies here is known once it would have been seen.
    pub fn percept(&self) -> Option<Percept> {
        let shape = self.shape()?;
        let may_lie_here = match self.sought {
            SoughtMarker::Pointing => shape.is_l(),
            SoughtMarker::Lying => true,
            SoughtMarker::Nothing => false,
        };
        let sighting = match (self.marker.filter(|_| may_lie_here), self.sought) {
            (None, _) if may_lie_here && !self.looked => return None,
            (None, _) | (_, SoughtMarker::Nothing) => Sighting::Nothing,
            (Some(_), SoughtMarker::Lying) => Sighting::Lying(1),
            (Some(Glimpse { along_entry: true, .. }), SoughtMarker::Pointing) => {
                Sighting::Pointing(Door::BACK)
            }
            (Some(_), SoughtMarker::Pointing) => Sighting::Pointing(Door(1)),
        };
        Some(Percept { degree: shape.degree(), sighting })
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::driving::scene::{CERTAIN, CentreLine, HallwayStatus, HallwayView, Reason};

    fn junction(doors: &[f64], distance: f64) -> Place {
        let through = [distance, 0.0];
        let doors = doors.iter().map(|&direction| CentreLine { through, direction }).collect();
        Place::Junction(JunctionView { doors, turning_point: through, confidence: 1.0 })
    }

    fn seen(places: &[Place], marker: Option<MarkerView>) -> JunctionEstimate {
        let mut visit = JunctionEstimate::default();
        for place in places {
            visit.add_scene(&Scene { place: place.clone(), marker });
        }
        visit
    }

    #[test]
    fn each_kind_and_entry_has_a_form_of_its_own() {
        let left = FRAC_PI_2;
        let seen: [&[f64]; 6] = [
            &[PI],
            &[PI, left],
            &[PI, -left],
            &[PI, left, -left],
            &[PI, left, 0.0],
            &[PI, 0.0, -left],
        ];
        for (doors, (shape, name)) in seen.into_iter().zip(JUNCTION_SHAPES) {
            for turned in [0.0, 0.4, -0.4] {
                let doors: Vec<f64> = doors.iter().map(|door| wrapped(door + turned)).collect();
                let Place::Junction(view) = junction(&doors, 0.3) else { unreachable!() };
                assert_eq!(JunctionShape::from_view(&view), Some(shape), "{name}");
            }
        }
    }

    #[test]
    fn two_images_must_agree() {
        let (l, t) = (junction(&[PI, FRAC_PI_2], 0.3), junction(&[PI, FRAC_PI_2, 0.0], 0.3));
        let unknown = Place::Unknown(Reason::NothingFits);
        for undecided in [vec![&unknown], vec![&l, &unknown], vec![&l, &t], vec![&l, &t, &t, &l]] {
            let places: Vec<Place> = undecided.into_iter().cloned().collect();
            assert_eq!(seen(&places, None).percept(), None);
        }
        let decided = seen(&[l.clone(), t, unknown, l], None).percept();
        assert_eq!(decided, Some(Percept { degree: 2, sighting: Sighting::Nothing }));
    }

    #[test]
    fn images_in_which_a_junction_is_only_possible_decide_nothing() {
        let certain = junction(&[PI], 0.3);
        let mut possible = certain.clone();
        if let Place::Junction(view) = &mut possible {
            view.confidence = CERTAIN - 0.01;
        }
        assert_ne!(possible, certain);
        assert_eq!(seen(&vec![possible.clone(); 9], None), JunctionEstimate::default());
        assert_eq!(seen(&[certain.clone(), possible.clone()], None).shape(), None);
        assert!(seen(&[certain.clone(), possible, certain], None).shape().is_some());
    }

    // paper: marker-sense.place
    #[test]
    fn the_marker_lies_along_the_entry_or_along_the_other_door_of_an_l() {
        let (l, dead_end): (&[_], &[_]) = (&[PI, FRAC_PI_2], &[PI]);
        for (doors, position, axis, sighting) in [
            (l, [0.5, 0.0], 0.1, Sighting::Pointing(Door::BACK)),
            (l, [0.5, 0.0], -1.5, Sighting::Pointing(Door(1))),
            (dead_end, [0.5, 0.0], 0.1, Sighting::Nothing),
            // Off the way.
            (l, [0.1, 0.0], 0.0, Sighting::Nothing),
            (l, [0.9, 0.0], 0.0, Sighting::Nothing),
            (l, [-0.5, 0.0], 0.0, Sighting::Nothing),
        ] {
            let marker = MarkerView { position, axis, door: None };
            let here = junction(doors, 0.5);
            let percept = seen(&[here.clone(), here], Some(marker)).percept().unwrap();
            assert_eq!(percept.sighting, sighting, "{position:?} {axis}");
        }
    }

    #[test]
    fn an_l_is_not_decided_without_a_view_from_where_the_marker_would_be_seen() {
        let l = |distance| junction(&[PI, -FRAC_PI_2], distance);
        assert_eq!(seen(&[l(0.1), l(0.1)], None).percept(), None);
        assert_eq!(seen(&[l(0.9), l(0.9)], None).percept(), None);
        for from in [0.2, 0.5, 0.8] {
            assert_ne!(seen(&[l(0.1), l(from)], None).percept(), None);
        }
        // No marker lies anywhere else.
        assert_ne!(seen(&[junction(&[PI], 0.1), junction(&[PI], 0.1)], None).percept(), None);
    }

    #[test]
    fn a_marker_that_points_along_no_door_lies_at_any_junction() {
        let marker = MarkerView { position: [0.5, 0.0], axis: 1.5, door: None };
        let shapes: [&[f64]; 3] = [&[PI], &[PI, FRAC_PI_2], &[PI, FRAC_PI_2, 0.0]];
        for doors in shapes {
            let percept = |distance, marker| {
                let mut visit = JunctionEstimate::default().with_sought(SoughtMarker::Lying).next();
                let place = junction(doors, distance);
                (0..2).for_each(|_| visit.add_scene(&Scene { place: place.clone(), marker }));
                visit.percept().map(|percept| percept.sighting)
            };
            assert_eq!(percept(0.5, Some(marker)), Some(Sighting::Lying(1)));
            assert_eq!(percept(0.5, None), Some(Sighting::Nothing));
            // Nothing was seen from where it would be.
            assert_eq!(percept(0.1, None), None);
        }
    }

    #[test]
    fn what_a_robot_knows_of_where_it_stands_is_decided() {
        for code in 0..8 {
            let shape = JunctionShape::with_code(code);
            let degree = shape.degree();
            let mut sightings = vec![Sighting::Nothing];
            if shape.is_l() {
                sightings.extend([Door::BACK, Door(1)].map(Sighting::Pointing));
            }
            for sighting in sightings {
                let visit = JunctionEstimate::decided(shape, sighting);
                assert_eq!(visit.shape(), Some(shape));
                assert_eq!(visit.percept(), Some(Percept { degree, sighting }));
            }
        }
    }

    #[test]
    fn at_the_marker_two_images_decide_and_it_lies_along_the_entry_door() {
        let mut visit = JunctionEstimate::at_marker();
        let here = junction(&[PI, FRAC_PI_2], 0.0);
        for expected in
            [None, Some(Percept { degree: 2, sighting: Sighting::Pointing(Door::BACK) })]
        {
            // A marker under the robot that seems to lie otherwise does not change it.
            let marker = MarkerView { position: [0.5, 0.0], axis: 1.5, door: None };
            visit.add_scene(&Scene { place: here.clone(), marker: Some(marker) });
            assert_eq!(visit.percept(), expected);
        }
    }

    #[test]
    fn the_best_view_of_the_marker_counts() {
        let hallway = Place::Hallway(HallwayView {
            heading: 0.0,
            left: 0.8,
            right: 0.8,
            status: HallwayStatus::Clear,
            confidence: 1.0,
        });
        let mut visit = JunctionEstimate::default();
        let mut see = |place: &Place, distance, axis| {
            let marker = MarkerView { position: [distance, 0.0], axis, door: None };
            visit.add_scene(&Scene { place: place.clone(), marker: Some(marker) });
        };
        see(&hallway, 0.75, 1.5);
        see(&junction(&[PI, -FRAC_PI_2], 0.5), 0.5, 0.0);
        see(&junction(&[PI, -FRAC_PI_2], 0.1), 0.1, 1.5);
        let percept = visit.percept().unwrap();
        assert_eq!(percept.sighting, Sighting::Pointing(Door::BACK));
    }
}
