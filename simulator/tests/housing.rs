//! A housing of the camera that looks like a stripe on the floor, and a polygon that hides it.

use std::f64::consts::FRAC_PI_3;

use image::{Rgb, RgbImage};
use nalgebra::Point2;
use toposlam_model::driving::scene::Place;
use toposlam_simulator::{
    LOOKS, Rig,
    evaluation::{judged_view::JudgedView, sampling::sample, verdict},
    labels, learned,
    view_sampler::ViewSampler,
};
use toposlam_vision::{
    camera::{Camera, HiddenFloor, Polygon},
    colour::PixelClass,
    geometry::unit,
    sensing::Sensor,
};

const VIEWS: u64 = 90;
/// Where the housing is: its ranges in metres, and its bearings in radians.
const RANGES: [f64; 2] = [0.75, 0.87];
const BEARINGS: [f64; 2] = [0.3, 0.3 + FRAC_PI_3];
/// How much wider the polygon is drawn, in metres and radians.
const MARGIN: f64 = 0.03;

/// The ring sector of the floor that a housing hides, in pixels.
fn sector(camera: &Camera, margin: f64) -> Polygon {
    let [near, far] = [RANGES[0] - margin, RANGES[1] + margin];
    let [first, last] = [BEARINGS[0] - margin, BEARINGS[1] + margin];
    let on_arc = |range: f64, share: f64| {
        let ground = range * unit(first + share * (last - first));
        camera.ground_to_pixel(Point2::from(ground)).unwrap()
    };
    let shares = (0..=20).map(|step| f64::from(step) / 20.0);
    let there = shares.clone().map(|share| on_arc(near, share));
    let back = shares.rev().map(|share| on_arc(far, share));
    Polygon::from_corners(there.chain(back).collect()).unwrap()
}

/// The mean colour of the stripe in an image.
fn stripe(image: &RgbImage, classes: &[PixelClass]) -> Option<Rgb<u8>> {
    let of_stripe = image.pixels().zip(classes).filter(|(_, class)| **class == PixelClass::Stripe);
    let (mut sum, mut count) = ([0_u32; 3], 0);
    for (pixel, _) in of_stripe {
        count += 1;
        sum.iter_mut().zip(pixel.0).for_each(|(sum, level)| *sum += u32::from(level));
    }
    (count > 0).then(|| Rgb(sum.map(|sum| (sum / count) as u8)))
}

/// A view with the housing, by a camera whose calibration hides it, and by one whose does not.
struct Seen {
    hidden: JudgedView,
    /// The boundary points on the housing.
    points: [usize; 2],
}

#[test]
#[ignore = "a long sweep, for `.ci/run --all`"]
fn a_housing_that_a_polygon_hides_is_no_wall_and_makes_no_junction() {
    let looks = LOOKS.iter().take(3);
    let views = ViewSampler::from_looks(looks, [640, 480], 2025).unwrap();
    let views = ViewSampler { random_plans: true, ..views };
    let open = Camera::superscout().sized([640, 480]);
    let polygons = vec![sector(&open, MARGIN)];
    let camera = Camera { hidden: HiddenFloor { polygons, ..open.hidden.clone() }, ..open.clone() };
    let housing = sector(&open, 0.0);
    let rig = Rig::new(&open);
    let colours: Vec<_> =
        views.looks.iter().map(|look| learned(&views, look, &open, &rig, &()).unwrap()).collect();
    let seen = sample(0..VIEWS, &(), |number| {
        let view = views.view(number).unwrap();
        let mut image = view.render(&rig, &view.building());
        let classes = labels(&rig, &view.building(), view.pose, &view.effects);
        let colour = stripe(&image, &classes)?;
        for (u, v, pixel) in image.enumerate_pixels_mut() {
            if housing.contains(Point2::new(u, v).map(f64::from)) {
                *pixel = colour;
            }
        }
        let nth = views.looks.iter().position(|look| look.name == view.look.name).unwrap();
        let [(_, without), (scene, with)] = [&open, &camera]
            .map(|camera| Sensor::new(camera, &colours[nth]).trace(&image).unwrap());
        let points = [without, with].map(|trace| {
            let boundary = trace.boundary.unwrap_or_else(|| panic!("{view:?}"));
            let on_it = |&(_, point): &(usize, Point2<f64>)| {
                let (range, bearing) = (point.coords.norm(), point.y.atan2(point.x));
                (RANGES[0] - MARGIN..RANGES[1]).contains(&range)
                    && (BEARINGS[0]..BEARINGS[1]).contains(&bearing)
            };
            boundary.points().filter(on_it).count()
        });
        let truth = view.truth().unwrap();
        let verdict = verdict::judge(&truth, &scene);
        let marker = verdict::judge_marker(None, None);
        Some(Seen { hidden: JudgedView { view, truth, scene, verdict, marker }, points })
    });
    // Without the polygon it is a wall.
    let walls = seen.iter().filter(|seen| seen.points[0] > 60).count();
    assert!(walls > seen.len() / 2, "{walls} of {}", seen.len());
    for Seen { hidden, points } in &seen {
        assert_eq!(points[1], 0, "{hidden:?}");
        assert!(!hidden.verdict.is_wrong(), "{hidden:?}");
    }
    let known = seen.iter().filter(|seen| !matches!(seen.hidden.scene.place, Place::Unknown(_)));
    assert!(known.clone().count() > seen.len() * 3 / 4, "{} of {}", known.count(), seen.len());
}
