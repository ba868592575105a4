//! The class of each pixel, to train and judge the colour classifier. Section 3.

use image::{Rgb, RgbImage};
use toposlam_model::driving::pose::Pose;
use toposlam_vision::colour::PixelClass;

use crate::render::{
    building::{Building, WallPart},
    effects::Effects,
    optics::RayPath,
    renderer::Shot,
    rig::{PixelRay, Rig},
    surfaces::Surface,
};

/// The class of the middle of each pixel, row by row: [`PixelClass::Unseen`] on the robot, its
/// struts and outside the mirror, and never [`PixelClass::Unknown`].
pub fn labels(rig: &Rig, building: &Building, pose: Pose, effects: &Effects) -> Vec<PixelClass> {
    let shot = Shot::new(rig, building, pose, effects);
    let [width, height] = rig.image();
    let pixels = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
    let class = |((u, v), ray): ((u32, u32), &PixelRay)| match shot
        .seen(ray, [u as f32, v as f32], 1.0)
        .0
    {
        _ if ray.by == RayPath::Direct => PixelClass::Unseen,
        Surface::Robot(_) | Surface::Holder => PixelClass::Unseen,
        Surface::Floor => PixelClass::Floor,
        Surface::Tape | Surface::Wall(_, WallPart::Baseboard) => PixelClass::Stripe,
        Surface::Marker => PixelClass::Marker,
        _ => PixelClass::Other,
    };
    pixels.zip(&rig.rays).map(class).collect()
}

/// The label image of these classes: floor green, stripe red, marker blue, ignored pixels white,
/// anything else black.
pub fn label_mask(rig: &Rig, classes: &[PixelClass]) -> RgbImage {
    let [width, height] = rig.image();
    let mut mask = RgbImage::new(width, height);
    for (pixel, class) in mask.pixels_mut().zip(classes) {
        *pixel = Rgb(match class {
            PixelClass::Floor => [0, 255, 0],
            PixelClass::Stripe => [255, 0, 0],
            PixelClass::Marker => [0, 0, 255],
            PixelClass::Other => [0, 0, 0],
            PixelClass::Unseen | PixelClass::Unknown => [255, 255, 255],
        });
    }
    mask
}
