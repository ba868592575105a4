//! What each pixel shows, for training and judging the classifier of colours. Section 3.

use image::{Rgb, RgbImage};
use toposlam_vision::colour::Class;

use super::building::{Building, WallPart};
use super::effects::Effects;
use super::renderer::Shot;
use super::rig::Rig;
use super::sight_lines::SightLines;
use super::surfaces::Surface;
use crate::pose::Pose;

/// What the middle of each pixel shows, row by row: [`Class::Unseen`] on the robot, its struts and
/// beyond the mirror, and never [`Class::Unknown`].
#[must_use]
pub fn labels(rig: &Rig, building: &Building, pose: Pose, effects: &Effects) -> Vec<Class> {
    let lines = SightLines::from(pose.position, rig.off_axis, building.walls());
    let shot = Shot::new(rig, building, &lines, pose, effects);
    let [width, height] = rig.image();
    let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
    pixels
        .map(|(u, v)| match shot.surface(u, v) {
            Surface::Floor => Class::Floor,
            Surface::Tape | Surface::Wall(_, WallPart::Baseboard) => Class::Stripe,
            Surface::Marker => Class::Marker,
            Surface::Wall(..) | Surface::Ceiling | Surface::Lamp | Surface::Nothing => Class::Other,
            Surface::Robot(_) | Surface::Holder => Class::Unseen,
        })
        .collect()
}

/// The label mask of these classes: floor green, stripe red, marker blue, anything else black, what is
/// to be ignored white.
#[must_use]
pub fn label_mask(rig: &Rig, classes: &[Class]) -> RgbImage {
    let [width, height] = rig.image();
    let mut mask = RgbImage::new(width, height);
    for (pixel, class) in mask.pixels_mut().zip(classes) {
        *pixel = Rgb(match class {
            Class::Floor => [0, 255, 0],
            Class::Stripe => [255, 0, 0],
            Class::Marker => [0, 0, 255],
            Class::Other => [0, 0, 0],
            Class::Unseen | Class::Unknown => [255, 255, 255],
        });
    }
    mask
}
