//! Compares rendered images with the floor plan: the camera's closed form gives the pixel of a
//! place, and the plan gives its surface.

#![allow(clippy::cast_sign_loss, reason = "pixels are not negative")]

use std::{sync::Arc, thread};

use image::RgbImage;
use nalgebra::{Isometry2, Point2};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use toposlam_model::{
    driving::pose::Pose,
    embedded_graph::Dart,
    floor_plan::{FloorPlan, JunctionKind, Rectangle},
};
use toposlam_simulator::{
    Building, BuildingLook, EffectSettings, Effects, KNOBS, LOOKS, Rig, RigErrors, labels,
    plan_named, render,
};
use toposlam_vision::{
    camera::Camera,
    colour::{PixelClass, StripeKind},
};

fn plan(name: &str) -> Arc<FloorPlan> {
    plan_named(name).unwrap()
}

/// Hallways of this width from each junction to the next.
fn hallways(width: f64, junctions: &[(&str, [f64; 2])]) -> FloorPlan {
    let junctions: Vec<_> = junctions.iter().map(|&(name, at)| (name.to_owned(), at)).collect();
    let ends = junctions.windows(2).map(|two| (two[0].0.clone(), two[1].0.clone()));
    FloorPlan::new(width, &junctions, &ends.collect::<Vec<_>>()).unwrap()
}

fn look(name: &str) -> &'static BuildingLook {
    BuildingLook::named(name).unwrap()
}

fn small_camera() -> Camera {
    Camera::superscout().sized([640, 480])
}

/// A dart of the plan's first L.
fn at_an_l(plan: &FloorPlan) -> Dart {
    let graph = plan.graph();
    graph.darts().find(|&dart| plan.junction(graph.vertex(dart)).kind == JunctionKind::L).unwrap()
}

/// Poses on the floor with at least this distance from all walls.
fn poses(plan: &FloorPlan, clear: f64, count: usize, seed: u64) -> Vec<Pose> {
    let floors: Vec<_> = plan.floor().collect();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    (0..count)
        .map(|number| {
            let floor = floors[number % floors.len()].widened(-clear);
            let position =
                [0, 1].map(|axis| rng.random_range(floor.least[axis]..=floor.greatest[axis]));
            Pose { position, heading: rng.random_range(-7.0..7.0) }
        })
        .collect()
}

/// Effects with these settings, and the others plain.
fn with(settings: &[(&str, f64)]) -> Effects {
    EffectSettings::new(settings.iter().copied()).unwrap().applied(Effects::plain())
}

/// The pixel with an index in an image of this width.
fn pixel(at: usize, width: usize) -> [f64; 2] {
    [at % width, at / width].map(|at| at as f64)
}

fn is_floor(floors: &[Rectangle], place: [f64; 2]) -> bool {
    floors.iter().any(|floor| floor.holds(place))
}

/// Places on the straight line from one place to another.
fn line(from: [f64; 2], to: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
    let shares = (0..=400).map(|step| f64::from(step) / 400.0);
    shares.map(move |share| [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis])))
}

/// Whether a place is nearer than this to the border of the floor, along either axis.
fn near_walls(floors: &[Rectangle], [x, y]: [f64; 2], distance: f64) -> bool {
    let steps = [-distance, 0.0, distance];
    steps
        .iter()
        .flat_map(|right| steps.iter().map(move |up| [x + right, y + up]))
        .any(|place| !is_floor(floors, place))
}

/// The place on the floor that a pixel shows if nothing is in the way, and the place of the mirror
/// above the floor; both in the robot's coordinates.
type Grounds<'a> = &'a dyn Fn([f64; 2]) -> Option<[[f64; 2]; 2]>;

/// Compares labels with the plan, pixel by pixel. Returns the numbers of floor, stripe and marker
/// pixels.
fn hold_against_plan(
    plan: &FloorPlan,
    look: &BuildingLook,
    rig: &Rig,
    grounds: Grounds,
) -> [usize; 3] {
    let effects = Effects::plain();
    let floors: Vec<_> = plan.floor().collect();
    let marker = at_an_l(plan);
    let building = Building::new(plan, look, Some(marker), &effects, 1);
    let marked = building.marker().unwrap();
    let corner = plan.junction(plan.graph().vertex(marker)).position;
    let near_corner = Pose { position: [corner[0] + 0.2, corner[1] - 0.1], heading: 1.0 };
    let mut counted = Vec::new();
    for pose in poses(plan, 0.3, 12, 5).into_iter().chain([near_corner]) {
        let classes = labels(rig, &building, pose, &effects);
        let building_from_robot = Isometry2::new(pose.position.into(), pose.heading);
        for (at, &class) in classes.iter().enumerate().step_by(3) {
            let pixel = pixel(at, 640);
            let Some([origin, ground]) = grounds(pixel) else { continue };
            if ground[0].hypot(ground[1]) > 5.0 {
                continue;
            }
            let [origin, place] =
                [origin, ground].map(|place| (building_from_robot * Point2::from(place)).into());
            let expected = |slack: f64| {
                if !line(origin, place).all(|place| is_floor(&floors, place)) {
                    PixelClass::Other
                } else if marked.widened(slack).holds(place) {
                    PixelClass::Marker
                } else if near_walls(&floors, place, look.stripe.width + slack) {
                    PixelClass::Stripe
                } else {
                    PixelClass::Floor
                }
            };
            // Skip borders, to a millimetre, and lines that graze a corner.
            if expected(1e-3) != expected(-1e-3)
                || near_walls(&floors, place, 2e-3)
                || class == PixelClass::Other && grazes(&floors, origin, place)
            {
                continue;
            }
            assert_eq!(class, expected(0.0), "{pose:?} {pixel:?} {place:?}");
            counted.push(class);
        }
    }
    [PixelClass::Floor, PixelClass::Stripe, PixelClass::Marker].map(|class| count(&counted, class))
}

fn count(classes: &[PixelClass], class: PixelClass) -> usize {
    classes.iter().filter(|&&other| other == class).count()
}

// paper: env.boundary
#[test]
fn each_pixel_shows_the_surface_at_its_place() {
    let camera = small_camera();
    let upright = |pixel| camera.pixel_to_ground(pixel).map(|ground| [[0.0; 2], ground.into()]);
    let errors = RigErrors { tilt: 0.03, towards: 2.0, centre: [3.0, -2.0], height: 0.01 };
    let tilted_rig = Rig::with_errors(&camera, &errors);
    let tilted = |pixel| {
        let ray = tilted_rig.ray(pixel);
        ray.floor().map(|ground| [ray.origin.xy().into(), ground])
    };
    let rig = Rig::new(&camera);
    let cases: [(_, _, _, Grounds); 3] = [
        ("shape-8", "tiles", &rig, &upright),
        ("building-25", "school", &rig, &upright),
        ("shape-8", "tiles", &tilted_rig, &tilted),
    ];
    for (name, look_name, rig, grounds) in cases {
        let counts = hold_against_plan(&plan(name), look(look_name), rig, grounds);
        assert!(counts[0] > 50_000 && counts[1] > 1_500 && counts[2] > 150, "{counts:?}");
    }
}

/// Whether a line on the floor comes near a wall before its end.
fn grazes(floors: &[Rectangle], from: [f64; 2], to: [f64; 2]) -> bool {
    let mut places = line(from, to).take(400).enumerate();
    places.any(|(step, place)| near_walls(floors, place, if step < 380 { 1e-2 } else { 1e-3 }))
}

#[test]
fn a_baseboard_has_the_height_of_its_look() {
    // A long straight hallway along x, its left wall at y = 0.8.
    let plan = hallways(1.6, &[("a", [0.0, 0.0]), ("b", [40.0, 0.0])]);
    let camera = Camera::superscout();
    let (rig, effects) = (Rig::new(&camera), Effects::plain());
    for look in LOOKS.iter().filter(|look| look.stripe.kind == StripeKind::OnWall) {
        let building = Building::new(&plan, look, None, &effects, 1);
        let pose = Pose { position: [20.0, 0.1], heading: 0.0 };
        let classes = labels(&rig, &building, pose, &effects);
        let mut counted = Vec::new();
        for (at, &class) in classes.iter().enumerate() {
            let ray = rig.ray(pixel(at, 1280));
            let [_, left, up] = ray.direction.into();
            // To the left, and neither far ahead nor far behind.
            if left < ray.direction[0].abs() || class == PixelClass::Unseen {
                continue;
            }
            let height = ray.origin[2] + (0.7 - ray.origin[1]) / left * up;
            let expected = match height {
                height if height < 0.0 => PixelClass::Floor,
                height if height < look.stripe.width => PixelClass::Stripe,
                _ => PixelClass::Other,
            };
            if height.abs() > 1e-5 && (height - look.stripe.width).abs() > 1e-5 {
                assert_eq!(class, expected, "{}: {height}", look.name);
                counted.push(class);
            }
        }
        for class in [PixelClass::Floor, PixelClass::Stripe, PixelClass::Other] {
            assert!(count(&counted, class) > 1000, "{}: {class:?}", look.name);
        }
    }
}

#[test]
fn without_effects_colours_are_those_of_the_look() {
    let plan = plan("shape-6");
    let rig = Rig::new(&small_camera());
    let effects = Effects::plain();
    for look in &LOOKS {
        let building = Building::new(&plan, look, Some(at_an_l(&plan)), &effects, 4);
        let pose = Pose { position: [0.2, 7.9], heading: 0.4 };
        let picture = render(&rig, &building, pose, &effects, 4);
        let classes = labels(&rig, &building, pose, &effects);
        let colours = [
            (PixelClass::Floor, look.floor_colour),
            (PixelClass::Stripe, look.stripe_colour),
            (PixelClass::Marker, look.marker_colour),
        ];
        for (class, colour) in colours {
            let inside = (0..classes.len()).filter(|&at| {
                let (u, v) = (at % 640, at / 640);
                (1..639).contains(&u)
                    && (1..479).contains(&v)
                    && (v - 1..=v + 1)
                        .all(|v| (u - 1..=u + 1).all(|u| classes[v * 640 + u] == class))
            });
            let found: Vec<_> = inside
                .map(|at| picture.get_pixel((at % 640) as u32, (at / 640) as u32).0)
                .collect();
            assert!(found.len() > 20, "{}: {} of {class:?}", look.name, found.len());
            for found in found {
                let off = (0..3).map(|c| found[c].abs_diff(colour[c])).max();
                assert!(off <= Some(1), "{}: {found:?} {colour:?}", look.name);
            }
        }
    }
}

/// Effects without JPEG loss and noise, in a building with some of everything.
fn some_effects() -> Effects {
    with(&[("doors", 3.0), ("gaps", 4.0), ("struts", 3.0), ("gap-length", 0.25)])
}

#[test]
fn every_effect_changes_the_image_unless_it_is_plain() {
    let plan = plan("shape-8");
    let pose = Pose { position: [0.1, 4.3], heading: 0.3 };
    // With glossy tiles and tape, every effect has something to change.
    let picture = |effects: &Effects| {
        let rig = Rig::new(&effects.camera(&small_camera()).unwrap());
        let building = Building::new(&plan, look("tiles"), None, effects, 6);
        render(&rig, &building, pose, effects, 6)
    };
    let without = picture(&some_effects());
    for knob in KNOBS {
        let mut effects = some_effects();
        let other = match knob.name {
            "doors" | "gaps" | "struts" => knob.plain,
            "gap-length" => 0.1,
            "strut-bearing" => 20.0,
            // A random share of lamps might be zero.
            "lamps-out" => 1.0,
            _ if knob.is_fixed() => *knob.allowed.end(),
            _ => *knob.default.end(),
        };
        effects.set(knob.name, other).unwrap();
        assert!(picture(&effects) != without, "{}", knob.name);
        if !["doors", "gaps", "struts"].contains(&knob.name) {
            effects.set(knob.name, knob.plain).unwrap();
            assert!(picture(&effects) == without, "{}", knob.name);
        }
    }
}

/// The classes of an image with these effects, and the pixels at which they differ from those without.
fn changed(settings: &[(&str, f64)]) -> (Vec<PixelClass>, Vec<(PixelClass, PixelClass, usize)>) {
    let plan = plan("shape-8");
    let rig = Rig::new(&Camera::superscout());
    let pose = Pose { position: [0.1, 5.3], heading: 1.3 };
    let classes = |effects: &Effects| {
        let building = Building::new(&plan, look("tiles"), Some(at_an_l(&plan)), effects, 6);
        labels(&rig, &building, pose, effects)
    };
    let without = classes(&with(&[("body", 1.0)]));
    let with = classes(&with(&[&[("body", 1.0)], settings].concat()));
    let pairs = without.into_iter().zip(&with).enumerate();
    let changed = pairs.filter(|(_, (before, after))| before != *after);
    let changed = changed.map(|(at, (before, after))| (before, *after, at)).collect();
    (with, changed)
}

#[test]
fn furniture_and_cables_hide_floor_and_stripe_and_are_neither() {
    for (name, value, least) in [("furniture", 6.0, 5_000), ("cables", 10.0, 500)] {
        let (_, changed) = changed(&[(name, value)]);
        assert!(changed.len() > least, "{name}: {}", changed.len());
        for (before, after, at) in changed {
            assert_eq!(after, PixelClass::Other, "{name}: {before:?} {at}");
        }
    }
}

#[test]
fn a_wide_strut_hides_the_same_number_of_pixels_at_any_distance_from_the_middle() {
    let (classes, _) = changed(&[("strut-width", 14.0), ("strut-bearing", 90.0)]);
    // Left is to the left and right in the image of a camera that looks up with ahead up.
    for column in [240_usize, 400, 500, 780, 900, 1060] {
        let hidden = (0..960).filter(|row| {
            let [u, v] = [column as f64 - 640.0, *row as f64 - 480.0];
            classes[row * 1280 + column] == PixelClass::Unseen && u.hypot(v) < 448.0
        });
        let rows: Vec<usize> = hidden.collect();
        assert!((13..=15).contains(&rows.len()), "{column}: {}", rows.len());
        assert!(rows[0].abs_diff(473) <= 1, "{column}: {}", rows[0]);
    }
}

#[test]
fn an_open_laptop_makes_the_outline_of_the_body_irregular() {
    let camera = Camera::superscout();
    let farthest = |settings: &[(&str, f64)]| {
        let mut ranges = [0.0_f64; 36];
        for (at, class) in changed(settings).0.iter().enumerate() {
            if let (PixelClass::Unseen, Some(ground)) =
                (class, camera.pixel_to_ground(pixel(at, 1280)))
            {
                let [x, y] = ground.into();
                let sector = (y.atan2(x).to_degrees().rem_euclid(360.0) / 10.0) as usize;
                ranges[sector % 36] = ranges[sector % 36].max(x.hypot(y));
            }
        }
        ranges
    };
    let closed = farthest(&[]);
    let open = farthest(&[("laptop", 0.06)]);
    assert!(closed.iter().all(|range| (0.30..0.32).contains(range)), "{closed:?}");
    let longer = (0..36).filter(|&at| open[at] > closed[at] + 0.15).count();
    let same = (0..36).filter(|&at| (open[at] - closed[at]).abs() < 1e-9).count();
    assert!(longer >= 5 && same >= 15, "{longer} {same}: {open:?}");
}

#[test]
fn with_a_dark_rim_less_than_half_of_the_visible_rim_is_brighter_inside_than_outside() {
    let plan = plan("shape-8");
    let pose = Pose { position: [0.1, 5.3], heading: 1.3 };
    let brighter = |dark: f64, seed: u64| {
        let effects =
            with(&[("dark-rim", dark), ("holder", 0.0), ("zoom", 1.45), ("off-centre", -0.03)]);
        let camera = effects.camera(&Camera::superscout()).unwrap();
        let building = Building::new(&plan, look("tiles"), None, &effects, seed);
        let picture = render(&Rig::new(&camera), &building, pose, &effects, seed);
        let light = |radius: f64, angle: f64| {
            let [u, v] = camera.middle().into();
            let [u, v] = [u + radius * angle.cos(), v + radius * angle.sin()];
            let inside = u >= 0.0 && v >= 0.0 && u < 1279.5 && v < 959.5;
            inside.then(|| {
                let pixel = picture.get_pixel(u.round() as u32, v.round() as u32).0;
                pixel.map(u32::from).iter().sum::<u32>()
            })
        };
        let seen: Vec<bool> = (0..720)
            .filter_map(|step| {
                let angle = f64::from(step).to_radians() / 2.0;
                Some(light(645.0, angle)? > light(660.0, angle)?)
            })
            .collect();
        seen.iter().filter(|brighter| **brighter).count() as f64 / seen.len() as f64
    };
    let mean = |dark: f64| (0..6).map(|seed| brighter(dark, seed)).sum::<f64>() / 6.0;
    let [without, with] = [0.0, 0.65].map(mean);
    assert!(without > 0.95 && (0.2..0.5).contains(&with), "{without} {with}");
}

#[test]
fn an_image_follows_from_its_seeds_on_any_thread() {
    let plan = plan("building-12");
    let rig = Rig::new(&small_camera());
    let picture = |seeds: [u64; 2]| -> RgbImage {
        let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(1));
        let building = Building::new(&plan, look("tiles"), None, &effects, seeds[0]);
        render(&rig, &building, poses(&plan, 0.3, 1, 1)[0], &effects, seeds[1])
    };
    let seeds = [[1, 1], [1, 2], [2, 1]];
    let one_by_one = seeds.map(picture);
    let at_once = thread::scope(|scope| {
        let picture = &picture;
        seeds.map(|seeds| scope.spawn(move || picture(seeds))).map(|thread| thread.join().unwrap())
    });
    assert!(one_by_one == at_once);
    assert!(one_by_one[0] != one_by_one[1] && one_by_one[0] != one_by_one[2]);
}

#[test]
fn the_robot_hides_the_floor_around_it_and_its_struts_two_opposite_directions() {
    let plan = plan("shape-8");
    let (large, small) = (Camera::superscout(), small_camera());
    let classes = |camera: &Camera, settings: &[(&str, f64)], heading| {
        let effects = with(settings);
        let building = Building::new(&plan, look("vinyl"), None, &effects, 1);
        let pose = Pose { position: [2.0, 4.0], heading };
        let classes = labels(&Rig::new(camera), &building, pose, &effects);
        let width = camera.image[0] as usize;
        let grounds = (0..classes.len()).map(|at| camera.pixel_to_ground(pixel(at, width)));
        let seen = grounds.zip(classes).filter_map(|(ground, class)| Some((ground?, class)));
        seen.collect::<Vec<_>>()
    };
    for (ground, class) in classes(&large, &[("body", 1.0), ("lens", 0.016)], 0.0) {
        let range = ground.coords.norm();
        assert!(class == PixelClass::Unseen || range > 0.30, "{ground} {range}");
        assert!(class != PixelClass::Unseen || range < 0.32, "{ground} {range}");
    }
    let mut hidden = 0;
    for (ground, class) in classes(&small, &[("struts", 4.0), ("strut-bearing", 30.0)], 2.0) {
        if ground.coords.norm() > 0.6 {
            let bearing = ground.y.atan2(ground.x).to_degrees().rem_euclid(180.0);
            let away = (bearing - 30.0).abs();
            assert!(class == PixelClass::Unseen || away > 1.99, "{bearing}");
            assert!(class != PixelClass::Unseen || away < 2.01, "{bearing}");
            hidden += usize::from(class == PixelClass::Unseen);
        }
    }
    assert!(hidden > 1000, "{hidden}");
}

#[test]
fn the_marker_lies_at_the_turning_point_along_its_hallway() {
    let plan = plan("shape-8");
    let building =
        |dart| Building::new(&plan, &LOOKS[0], Some(dart), &Effects::plain(), 1).marker().unwrap();
    for dart in plan.graph().darts() {
        let marker = building(dart);
        let [x, y] = plan.junction(plan.graph().vertex(dart)).position;
        let along_x = plan.direction(dart).vector()[0] != 0.0;
        let [half_x, half_y] = if along_x { [0.30, 0.09] } else { [0.09, 0.30] };
        let edges = [x - half_x, y - half_y, x + half_x, y + half_y];
        let found = [marker.least, marker.greatest].concat();
        assert!(found.iter().zip(edges).all(|(one, other)| (one - other).abs() < 1e-12));
    }
}

#[test]
fn odd_buildings_and_poses_do_not_panic() {
    let effects = Effects::drawn(&mut Xoshiro256PlusPlus::seed_from_u64(9));
    let errors = RigErrors { tilt: 0.3, towards: -2.0, centre: [900.0, -40.0], height: 0.4 };
    let rigs = [
        Rig::new(&Camera::superscout().sized([64, 48])),
        Rig::with_errors(&Camera::superscout().sized([80, 48]), &errors),
        Rig::new(&Camera::superscout().sized([1, 1])),
    ];
    for (width, length) in [(1.6, 4.0), (1e-3, 2e-3), (0.4, 1e5), (3000.0, 1e6)] {
        let plan =
            hallways(width, &[("a", [length, 0.0]), ("b", [length, length]), ("c", [0.0, length])]);
        for look in &LOOKS[..3] {
            let building = Building::new(&plan, look, Some(Dart(1)), &effects, 9);
            for rig in &rigs {
                for position in [[length; 2], [length, 0.3 * length], [0.0; 2], [f64::NAN, 1e300]] {
                    for heading in [0.0, -1e9, f64::INFINITY] {
                        let pose = Pose { position, heading };
                        let picture = render(rig, &building, pose, &effects, 9);
                        let [width, height] = rig.image();
                        assert_eq!(picture.dimensions(), (width, height));
                        let count = labels(rig, &building, pose, &effects).len();
                        assert_eq!(count, (width * height) as usize);
                    }
                }
            }
        }
    }
}
