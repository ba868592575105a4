//! Random views. Each follows from its number alone.

use std::{f64::consts::FRAC_PI_2, sync::Arc};

use image::RgbImage;
use nalgebra::Vector2;
use rand::{Rng, RngExt, SeedableRng, seq::IndexedRandom};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::{
    driving::{pose::Pose, scene::MarkerView, visit::JUNCTION_SHAPES},
    embedded_graph::{Dart, Vertex},
    floor_plan::{Direction, FloorPlan, Hallway, JunctionKind},
    format::world_file::WorldFileError,
};
use toposlam_robot::superscout::{CLEARANCE, RADIUS};
use toposlam_vision::geometry::unit;

use super::{
    plans::{NamedPlan, plans},
    random_plan::random_plan,
};
use crate::{
    Building, BuildingLook, EffectSettings, Effects, Rig, render,
    truth::{LyingMarker, Truth, angle},
};

/// Views of a junction lie from this distance before its turning point to this distance behind it,
/// in metres.
const APPROACH: [f64; 2] = [1.5, -0.3];
/// The greatest distance of the robot from the middle of the hallway, in metres.
const ASIDE: f64 = 0.3;
/// The least distance from a wall, in metres: the robot's radius, and the distance at which its
/// sonars stop it.
const CLEAR: f64 = RADIUS + CLEARANCE;
/// The greatest angle between the robot's heading and its hallway, in degrees.
const TURNED: f64 = 25.0;
/// The share of views at junctions. The others are anywhere in hallways.
const AT_JUNCTIONS: f64 = 0.6;
/// The shares of views with a marker at the L in view, and with a marker elsewhere.
const MARKED: [f64; 2] = [0.5, 0.2];

/// Distances of the first and the last image of a visit from the turning point, in metres.
const VISIT: [f64; 2] = [1.5, -0.1];
/// Least and greatest distance between images of a visit, in metres.
const STEP: [f64; 2] = [0.22, 0.28];
/// The greatest angle between the robot's heading and its hallway during a visit, in degrees.
const SWAY: f64 = 12.0;
/// The greatest sideways movement between two images of a visit, in metres.
const DRIFT: f64 = 0.04;

/// A pose in a building, and all that its image depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderedView {
    /// Its number among the views of the seed.
    pub number: u64,
    pub plan_name: String,
    pub plan: Arc<FloorPlan>,
    pub look: &'static BuildingLook,
    pub effects: Effects,
    pub marker: Option<Dart>,
    pub pose: Pose,
    /// Width and height of the image, in pixels.
    pub image: [u32; 2],
    /// Random seeds of the building and of the image.
    pub seeds: [u64; 2],
}

impl RenderedView {
    /// The ground truth; `None` if the pose is not on the floor.
    pub fn truth(&self) -> Option<Truth> {
        Truth::at(&self.plan, self.pose)
    }

    /// The marker's true place, relative to the robot.
    pub fn marker(&self) -> Option<MarkerView> {
        let marker = self.marker.map(|dart| LyingMarker::along(&self.plan, dart));
        marker.map(|marker| marker.seen_from(&self.plan, self.pose))
    }

    pub fn building(&self) -> Building {
        Building::new(&self.plan, self.look, self.marker, &self.effects, self.seeds[0])
    }

    pub fn render(&self, rig: &Rig, building: &Building) -> RgbImage {
        render(rig, building, self.pose, &self.effects, self.seeds[1])
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "evaluate", derive(clap::ValueEnum))]
pub enum WhichEffects {
    /// Draw each effect from its default range
    Default,
    /// No effects
    None,
}

/// Each purpose of views has its own random numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewPurpose {
    /// To be judged one by one.
    Single,
    /// To be judged together, visit by visit.
    Visit,
    /// To learn colours from.
    Learning,
}

/// All views of a seed.
#[derive(Clone, Debug)]
pub struct ViewSampler {
    pub seed: u64,
    pub plans: Vec<NamedPlan>,
    pub random_plans: bool,
    pub looks: Vec<&'static BuildingLook>,
    /// The image sizes, which views have in turn.
    pub sizes: Vec<[u32; 2]>,
    pub effects: WhichEffects,
    /// Effects that are set in all views but those to learn from.
    pub settings: EffectSettings,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ViewError {
    #[error("there are no floor plans")]
    NoPlan,
    #[error("there is no image size")]
    NoSize,
    #[error("there is no look")]
    NoLook,
    #[error("random plan {seed} is not valid")]
    RandomPlan { seed: u64 },
}

impl ViewSampler {
    /// Views of these looks in the floor plans of `worlds/`, with all effects and one image size.
    pub fn from_looks(
        looks: impl IntoIterator<Item = &'static BuildingLook>,
        size: [u32; 2],
        seed: u64,
    ) -> Result<Self, WorldFileError> {
        Ok(Self {
            seed,
            plans: plans()?,
            random_plans: false,
            looks: looks.into_iter().collect(),
            sizes: vec![size],
            effects: WhichEffects::Default,
            settings: EffectSettings::default(),
        })
    }

    /// The view with this number.
    pub fn view(&self, number: u64) -> Result<RenderedView, ViewError> {
        let (mut view, mut chance) = self.setting(ViewPurpose::Single, number)?;
        place(&mut view, &mut chance, AT_JUNCTIONS);
        Ok(view)
    }

    /// The images of one approach to a junction, in order.
    pub fn visit(&self, number: u64) -> Result<Vec<RenderedView>, ViewError> {
        let (mut view, mut chance) = self.setting(ViewPurpose::Visit, number)?;
        let Some(entry) = an_entry(&view.plan, &mut chance) else { return Ok(Vec::new()) };
        put_marker(&mut view, Some(entry), &mut chance);
        let reach = reach(&view.plan);
        let mut aside = chance.random_range(-reach..=reach);
        let mut before = VISIT[0] - chance.random_range(0.0..STEP[0]);
        let mut views = Vec::new();
        while before >= VISIT[1] {
            let turned = chance.random_range(-SWAY..=SWAY);
            let pose = before_junction(&view.plan, entry, before, aside, turned);
            let seeds = [view.seeds[0], chance.next_u64()];
            views.push(RenderedView { pose, seeds, ..view.clone() });
            before -= chance.random_range(STEP[0]..STEP[1]);
            aside = (aside + chance.random_range(-DRIFT..=DRIFT)).clamp(-reach, reach);
        }
        Ok(views)
    }

    /// A view of a junction from which to learn the colours of a look, often with a marker nearby.
    pub fn to_learn_from(
        &self,
        look: &'static BuildingLook,
        image: [u32; 2],
        number: u64,
    ) -> Result<RenderedView, ViewError> {
        let (mut view, mut chance) = self.setting(ViewPurpose::Learning, number)?;
        view.look = look;
        view.image = image;
        place(&mut view, &mut chance, 1.0);
        Ok(view)
    }

    /// A view without a pose, and the random numbers to complete it.
    fn setting(
        &self,
        purpose: ViewPurpose,
        number: u64,
    ) -> Result<(RenderedView, Xoshiro256PlusPlus), ViewError> {
        let mut chance = stream(self.seed, purpose, number);
        let drawn = self.plans.choose(&mut chance).cloned();
        let of_seed = chance.next_u64() >> 32;
        let (plan_name, plan) = match drawn.filter(|_| !self.random_plans || chance.random()) {
            Some(plan) => plan,
            None if self.random_plans => {
                let plan =
                    random_plan(of_seed).map_err(|_| ViewError::RandomPlan { seed: of_seed })?;
                (format!("random-{of_seed}"), Arc::new(plan))
            }
            None => return Err(ViewError::NoPlan),
        };
        let size = number.checked_rem(self.sizes.len() as u64).ok_or(ViewError::NoSize)?;
        let look = self.looks.choose(&mut chance).copied().ok_or(ViewError::NoLook)?;
        let drawn = Effects::drawn(&mut chance);
        let effects = match self.effects {
            WhichEffects::Default => drawn,
            WhichEffects::None => Effects::plain(),
        };
        let view = RenderedView {
            number,
            plan_name,
            plan,
            look,
            effects: match purpose {
                ViewPurpose::Learning => effects,
                ViewPurpose::Single | ViewPurpose::Visit => self.settings.applied(effects),
            },
            marker: None,
            pose: Pose { position: [0.0; 2], heading: 0.0 },
            image: self.sizes[size as usize],
            seeds: [chance.next_u64(), chance.next_u64()],
        };
        Ok((view, chance))
    }
}

/// Chooses a pose, and a place for the marker.
fn place(view: &mut RenderedView, chance: &mut Xoshiro256PlusPlus, at_junctions: f64) {
    let entry = an_entry(&view.plan, chance).filter(|_| chance.random_bool(at_junctions));
    let reach = reach(&view.plan);
    let aside = chance.random_range(-reach..=reach);
    let turned = chance.random_range(-TURNED..=TURNED);
    let part = chance.random::<f64>();
    view.pose = match entry {
        Some(entry) => {
            let nearest = CLEAR - view.plan.hallway_width() / 2.0;
            let last = APPROACH[1].max(nearest);
            let before = last + part * (APPROACH[0] - last);
            before_junction(&view.plan, entry, before, aside, turned)
        }
        None => in_a_hallway(&view.plan, part, chance.random(), aside, turned),
    };
    put_marker(view, entry, chance);
}

/// Puts the marker on an L: on the one with the entry door, on any other, or on none.
fn put_marker(view: &mut RenderedView, entry: Option<Dart>, chance: &mut Xoshiro256PlusPlus) {
    let graph = view.plan.graph();
    let is_l = |vertex: Vertex| view.plan.junction(vertex).kind == JunctionKind::L;
    let here = entry.map(|dart| graph.vertex(dart)).filter(|&vertex| is_l(vertex));
    let others: Vec<_> =
        graph.vertices().filter(|&vertex| is_l(vertex) && Some(vertex) != here).collect();
    let other = others.choose(chance).copied();
    let by_chance: f64 = chance.random();
    let vertex = match here {
        Some(here) if by_chance < MARKED[0] => Some(here),
        Some(_) => other.filter(|_| by_chance < MARKED[0] + MARKED[1]),
        None => other.filter(|_| by_chance < MARKED[0]),
    };
    let index = chance.random_range(0..2);
    view.marker = vertex.and_then(|vertex| graph.dart(vertex, index));
}

/// The random numbers for a purpose and a number.
fn stream(seed: u64, purpose: ViewPurpose, number: u64) -> Xoshiro256PlusPlus {
    let mut of_seed = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut salt = 0;
    for _ in 0..=purpose as u8 {
        salt = of_seed.next_u64();
    }
    // Neighbouring seeds give unrelated streams, because SplitMix64 seeds the generator.
    Xoshiro256PlusPlus::seed_from_u64(salt.wrapping_add(number))
}

/// An entry door of a junction. Its shape is drawn first, among the shapes in the plan, so that
/// rare shapes are not rare.
fn an_entry(plan: &FloorPlan, chance: &mut Xoshiro256PlusPlus) -> Option<Dart> {
    let entries = JUNCTION_SHAPES.map(|(shape, _)| {
        plan.graph().darts().filter(|&dart| plan.shape(dart) == shape).collect::<Vec<_>>()
    });
    let there: Vec<_> = entries.iter().filter(|entries| !entries.is_empty()).collect();
    there.choose(chance)?.choose(chance).copied()
}

/// The greatest distance from the middle of the hallway, in metres.
fn reach(plan: &FloorPlan) -> f64 {
    (plan.hallway_width() / 2.0 - CLEAR).clamp(0.0, ASIDE)
}

/// A pose this far before the turning point of the dart's junction, on the way in by the dart.
fn before_junction(plan: &FloorPlan, entry: Dart, before: f64, aside: f64, turned: f64) -> Pose {
    let junction = plan.junction(plan.graph().vertex(entry));
    along(junction.position, plan.direction(entry).reversed(), -before, aside, turned)
}

/// A pose in a hallway. `part` selects the hallway and the place in it.
fn in_a_hallway(plan: &FloorPlan, part: f64, back: bool, aside: f64, turned: f64) -> Pose {
    let ends =
        |hallway: &Hallway| [hallway.from, hallway.to].map(|vertex| plan.junction(vertex).position);
    let length = |[from, to]: [[f64; 2]; 2]| (from[0] - to[0]).hypot(from[1] - to[1]);
    let hallways: Vec<_> = plan.hallways().iter().map(ends).collect();
    let mut left = part * hallways.iter().map(|&ends| length(ends)).sum::<f64>();
    let mut at = [[0.0; 2]; 2];
    for &ends in &hallways {
        at = ends;
        if left <= length(ends) {
            break;
        }
        left -= length(ends);
    }
    let [mut from, mut to] = at;
    if back {
        std::mem::swap(&mut from, &mut to);
    }
    let direction = Direction::between(from, to).unwrap_or(Direction::South);
    along(from, direction, left.min(length(at)), aside, turned)
}

/// A pose this far along a direction from a position, `aside` to the left of it, and turned by this
/// many degrees to the left.
fn along(from: [f64; 2], direction: Direction, by: f64, aside: f64, turned: f64) -> Pose {
    let ahead = angle(direction);
    let left = aside * unit(ahead + FRAC_PI_2);
    let position = Vector2::from(from) + by * Vector2::from(direction.vector()) + left;
    Pose { position: position.into(), heading: ahead + turned.to_radians() }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use toposlam_model::floor_plan::{BuildingWall, walls};

    use super::*;
    use crate::LOOKS;

    fn views() -> ViewSampler {
        let mut views = ViewSampler::from_looks(&LOOKS, [1280, 960], 1).unwrap();
        views.plans.retain(|(name, _)| name == "shape-8");
        ViewSampler { random_plans: true, sizes: vec![[1280, 960], [640, 480]], ..views }
    }

    fn distance(wall: &BuildingWall, position: [f64; 2]) -> f64 {
        let across = 1 - wall.along;
        let beyond =
            (wall.span[0] - position[wall.along]).max(position[wall.along] - wall.span[1]).max(0.0);
        (position[across] - wall.plane).hypot(beyond)
    }

    #[test]
    fn no_view_is_nearer_to_a_wall_than_the_robot_can_be() {
        let views = views();
        let visits = (0..60).flat_map(|number| views.visit(number).unwrap());
        for view in (0..600).map(|number| views.view(number).unwrap()).chain(visits) {
            let distances =
                walls(&view.plan).into_iter().map(|wall| distance(&wall, view.pose.position));
            let nearest = distances.fold(f64::INFINITY, f64::min);
            assert!(nearest >= CLEAR - 1e-9, "{nearest} m in {view:?}");
            assert!(view.truth().is_some(), "{view:?}");
        }
    }

    #[test]
    fn a_view_follows_from_its_seed_and_number_and_from_its_purpose() {
        let views = views();
        assert_ne!(views.view(17), views.view(18));
        assert_ne!(views.view(17), ViewSampler { seed: 2, ..views.clone() }.view(17));
        assert_ne!(views.view(17).unwrap().seeds, views.visit(17).unwrap()[0].seeds);
    }

    #[test]
    fn every_kind_of_place_is_viewed_often() {
        let views = views();
        let mut shapes = BTreeMap::new();
        let (mut hallways, mut between, mut random, mut marked) = (0, 0, 0, 0);
        for view in (0..1000).map(|number| views.view(number).unwrap()) {
            match view.truth().unwrap() {
                Truth::Hallway(_) => hallways += 1,
                Truth::Between(..) => between += 1,
                Truth::Junction(junction) => *shapes.entry(junction.shape).or_insert(0) += 1,
            }
            random += usize::from(view.plan_name.starts_with("random-"));
            marked += usize::from(view.marker.is_some());
        }
        assert!(hallways > 100 && between > 200, "{hallways} {between}");
        assert!((400..600).contains(&random), "{random}");
        assert!((300..700).contains(&marked), "{marked}");
        for (shape, name) in JUNCTION_SHAPES {
            assert!(shapes[&Some(shape)] > 20, "{name}: {}", shapes[&Some(shape)]);
        }
    }

    #[test]
    fn a_visit_comes_from_a_metre_and_a_half_to_the_turning_point() {
        let views = views();
        for number in 0..50 {
            let visit = views.visit(number).unwrap();
            assert!((5..=8).contains(&visit.len()), "{}", visit.len());
            let nearest = visit.last().unwrap();
            let Some(Truth::Junction(junction)) = nearest.truth() else { panic!("{nearest:?}") };
            let distance = junction.distance().unwrap();
            assert!((-0.1..=0.18).contains(&distance), "{distance}");
        }
    }

    #[test]
    fn without_plans_sizes_or_looks_there_is_no_view() {
        let none = ViewSampler { plans: Vec::new(), random_plans: false, ..views() };
        assert_eq!(none.view(0), Err(ViewError::NoPlan));
        assert_eq!(ViewSampler { sizes: Vec::new(), ..views() }.view(0), Err(ViewError::NoSize));
        assert_eq!(ViewSampler { looks: Vec::new(), ..views() }.view(0), Err(ViewError::NoLook));
    }
}
