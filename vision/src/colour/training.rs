//! Learning colours from images and label masks.

use image::RgbImage;
use thiserror::Error;
use toposlam_model::enumerate::{Interrupted, Watch};

use super::{
    ColourModel, Confusion, FloorRing, PixelClass, Smoothing, Stripe,
    hsv::{BINS, Bin},
    light::{self, LightError},
    model::{EQUAL_PRIORS, Histogram},
    table::{self, CELLS},
};
use crate::{camera::Camera, least_squares::median};

/// The radius of the floor that is learned from, in metres from the robot's centre. Geometry: the reach of the ground
/// view.
const RANGE: f64 = 3.0;
/// The spread of one colour in the same light ([`Smoothing::colour`](super::Smoothing)). Views.
const COLOUR_SMOOTHING: f64 = 0.7;
/// The relative spread of the light from place to place ([`Smoothing::light`](super::Smoothing)). Views.
const LIGHT_SMOOTHING: f64 = 0.08;
/// A class does not have a colour if its part of the pixels is less. Views.
const UNKNOWN_BELOW: f64 = 1e-6;
/// The number of mixed pixels that count as one pure pixel. Views: a floor in the shade has the colour of a mixture of
/// lit floor and dark stripe, and is floor. If no pure pixel has the colour, it is a mixture.
const MIXED: u64 = 256;

#[derive(Clone, Debug)]
struct TrainingView {
    camera: Camera,
    ground: Vec<usize>,
    ring: FloorRing,
}

impl TrainingView {
    fn new(camera: &Camera) -> Self {
        let [width, height] = camera.image;
        let shows_floor = |pixel: [u32; 2]| {
            let ground = camera.pixel_to_ground(pixel.map(f64::from));
            ground.is_some_and(|at| at.coords.norm() <= RANGE) && camera.sees(pixel)
        };
        let pixels = (0..height).flat_map(|v| (0..width).map(move |u| [u, v]));
        let ground = pixels
            .enumerate()
            .filter_map(|(nth, pixel)| shows_floor(pixel).then_some(nth))
            .collect();
        Self { camera: camera.clone(), ground, ring: FloorRing::new(camera) }
    }
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ExampleError {
    #[error(
        "the image has {} x {} pixels; the calibration is for {} x {}",
        found[0], found[1], expected[0], expected[1]
    )]
    ImageSize { found: [u32; 2], expected: [u32; 2] },
    #[error(
        "the labels have {} x {} pixels; their image has {} x {}",
        found[0], found[1], expected[0], expected[1]
    )]
    LabelSize { found: [u32; 2], expected: [u32; 2] },
    #[error(
        "the label at pixel ({}, {}) has the colour ({}, {}, {}); there can be {}",
        pixel[0], pixel[1], colour[0], colour[1], colour[2], allowed()
    )]
    LabelColour { pixel: [u32; 2], colour: [u8; 3] },
    #[error(transparent)]
    Light(#[from] LightError),
}

fn allowed() -> String {
    let labels = PixelClass::LEARNED.map(|class| (class.name(), class.label()));
    let labels = labels.into_iter().chain([("ignore", PixelClass::Unseen.label())]);
    let shown = labels.map(|(name, [red, green, blue])| format!("{name} ({red},{green},{blue})"));
    shown.collect::<Vec<_>>().join(", ")
}

#[derive(Clone, Debug, PartialEq)]
struct Example {
    floor: [f64; 3],
    colours: Vec<Alike>,
}

/// Pixels of one colour and class.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Alike {
    colour: [u8; 3],
    class: PixelClass,
    /// Pixels among others of their class.
    pure: u32,
    /// Pixels beside another class: their colours mix.
    mixed: u32,
}

impl Alike {
    fn pixels(&self) -> u64 {
        u64::from(self.pure + self.mixed)
    }
}

impl Example {
    fn new(view: &TrainingView, image: &RgbImage, labels: &RgbImage) -> Result<Self, ExampleError> {
        let expected = view.camera.image;
        let [found, labelled] = [image, labels].map(|image| <[u32; 2]>::from(image.dimensions()));
        if found != expected {
            return Err(ExampleError::ImageSize { found, expected });
        }
        if labelled != found {
            return Err(ExampleError::LabelSize { found: labelled, expected: found });
        }
        let [(colours, _), (labels, _)] =
            [image, labels].map(|image| image.as_raw().as_chunks::<3>());
        if let Some(nth) = labels.iter().position(|&label| PixelClass::of_label(label).is_none()) {
            let (nth, width) = (nth as u32, expected[0]);
            let (pixel, colour) = ([nth % width, nth / width], labels[nth as usize]);
            return Err(ExampleError::LabelColour { pixel, colour });
        }
        let floor = light::floor_colour(&view.ring.colours(image))?;
        let mut pixels: Vec<_> = view
            .ground
            .iter()
            .filter_map(|&pixel| {
                let class = PixelClass::of_label(labels[pixel]).unwrap_or_default();
                let mixed = || is_mixed(labels, expected[0] as usize, pixel);
                (class != PixelClass::Unseen).then(|| (colours[pixel], class, mixed()))
            })
            .collect();
        pixels.sort_unstable();
        let colours = pixels.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).map(|group| {
            let mixed = group.iter().filter(|(_, _, mixed)| *mixed).count() as u32;
            let pure = group.len() as u32 - mixed;
            Alike { colour: group[0].0, class: group[0].1, pure, mixed }
        });
        Ok(Self { floor, colours: colours.collect() })
    }
}

/// Whether one of the eight pixels around a pixel has another label.
fn is_mixed(labels: &[[u8; 3]], width: usize, pixel: usize) -> bool {
    [pixel.saturating_sub(width), pixel, pixel + width].into_iter().any(|middle| {
        let row = labels.get(middle.saturating_sub(1)..=middle + 1).unwrap_or_default();
        row.iter().any(|label| *label != labels[pixel])
    })
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TrainingError {
    #[error("there is no image to learn from")]
    NoImage,
    #[error("no pixel within {} m is labelled as {}", RANGE, class.name())]
    NoPixel { class: PixelClass },
    #[error(
        "{images} images cannot be divided into {folds} parts; the number of parts must be from 2 to {images}"
    )]
    Folds { folds: usize, images: usize },
    #[error("without part {fold} of the images {cause}")]
    InFold { fold: usize, cause: Box<TrainingError> },
    #[error(transparent)]
    Interrupted(#[from] Interrupted),
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ClassPixels {
    pub images: usize,
    /// The number of their pixels, within the range of sensing.
    pub pixels: u64,
}

#[derive(Clone, Debug)]
pub struct Training {
    stripe: Stripe,
    view: Option<TrainingView>,
    examples: Vec<Example>,
}

impl Training {
    pub fn new(stripe: Stripe) -> Self {
        Self { stripe, view: None, examples: Vec::new() }
    }

    /// Adds an image of this camera with its labels.
    ///
    /// # Errors
    /// Returns an error if image or labels have another size, if a label has an unknown colour, or if the light is not
    /// known; then they are left out.
    pub fn add(
        &mut self,
        camera: &Camera,
        image: &RgbImage,
        labels: &RgbImage,
    ) -> Result<(), ExampleError> {
        let view = match self.view.take() {
            Some(view) if view.camera == *camera => view,
            _ => TrainingView::new(camera),
        };
        let example = Example::new(&view, image, labels);
        self.view = Some(view);
        self.examples.push(example?);
        Ok(())
    }

    pub fn images(&self) -> usize {
        self.examples.len()
    }

    pub fn seen(&self, class: PixelClass) -> ClassPixels {
        let pixels = self.examples.iter().map(|example| {
            let of_class = example.colours.iter().filter(|alike| alike.class == class);
            of_class.map(Alike::pixels).sum::<u64>()
        });
        pixels.filter(|&pixels| pixels > 0).fold(ClassPixels::default(), |seen, pixels| {
            ClassPixels { images: seen.images + 1, pixels: seen.pixels + pixels }
        })
    }

    /// The model that is learned from all examples.
    ///
    /// # Errors
    /// Returns an error if there is no image, or no pixel of floor or stripe.
    pub fn model(&self) -> Result<ColourModel, TrainingError> {
        self.model_of(&self.examples.iter().collect::<Vec<_>>())
    }

    /// Cross-validation: divides the images into parts, in their order, and classifies each part with
    /// the model that is learned from the others.
    ///
    /// # Errors
    /// Returns an error if there are fewer images than parts, if a part's others give no model, or if the
    /// watch stops.
    pub fn cross_validate(
        &self,
        folds: usize,
        watch: &dyn Watch,
    ) -> Result<Confusion, TrainingError> {
        let images = self.examples.len();
        if folds < 2 || folds > images {
            return Err(TrainingError::Folds { folds, images });
        }
        let mut confusion = Confusion::default();
        watch.parts(folds);
        for fold in 0..folds {
            watch.check_stop()?;
            let examples = self.examples.iter().enumerate();
            let (left_out, others): (Vec<_>, Vec<_>) =
                examples.partition(|(nth, _)| nth % folds == fold);
            let others: Vec<_> = others.into_iter().map(|(_, example)| example).collect();
            let model = self.model_of(&others).map_err(|cause| TrainingError::InFold {
                fold: fold + 1,
                cause: Box::new(cause),
            })?;
            let table = model.table();
            for (_, example) in left_out {
                watch.check_stop()?;
                let lit = table.lit(light::gain(example.floor, model.floor));
                for alike in &example.colours {
                    confusion.count(alike.class, lit.class(alike.colour), alike.pixels());
                }
            }
            watch.part_done(1);
        }
        Ok(confusion)
    }

    fn model_of(&self, examples: &[&Example]) -> Result<ColourModel, TrainingError> {
        let floor = common_floor(examples)?;
        let histograms = histograms(examples, floor);
        let needed = [(PixelClass::Floor, &histograms[0]), (PixelClass::Stripe, &histograms[1])];
        if let Some(&(class, _)) = needed.iter().find(|(_, histogram)| histogram.is_empty()) {
            return Err(TrainingError::NoPixel { class });
        }
        Ok(ColourModel {
            stripe: self.stripe,
            floor,
            priors: EQUAL_PRIORS,
            smoothing: Smoothing { colour: COLOUR_SMOOTHING, light: LIGHT_SMOOTHING },
            unknown_below: UNKNOWN_BELOW,
            histograms,
        })
    }
}

fn common_floor(examples: &[&Example]) -> Result<[f64; 3], TrainingError> {
    if examples.is_empty() {
        return Err(TrainingError::NoImage);
    }
    Ok(std::array::from_fn(|channel| {
        let level = median(examples.iter().map(|example| example.floor[channel]));
        (level.unwrap_or_default().max(1.0) * 100.0).round() / 100.0
    }))
}

/// The colours of each class, in the light in which the floor has this colour, as in the table.
fn histograms(examples: &[&Example], floor: [f64; 3]) -> [Histogram; 4] {
    let mut cells = PixelClass::LEARNED.map(|class| (class, vec![0_u64; CELLS]));
    for example in examples {
        let offsets = light::gain(example.floor, floor).offsets();
        for alike in &example.colours {
            let counts = cells.iter_mut().filter(|(learned, _)| *learned == alike.class);
            counts.for_each(|(_, counts)| {
                counts[table::index(&offsets, alike.colour)] +=
                    MIXED * u64::from(alike.pure) + u64::from(alike.mixed);
            });
        }
    }
    cells.map(|(_, cells)| {
        let mut bins: Vec<(Option<Bin>, u64)> = vec![(None, 0); BINS];
        for (cell, &count) in cells.iter().enumerate().filter(|(_, count)| **count > 0) {
            let bin = Bin::from_rgb(table::centre(cell));
            let (known, counted) = &mut bins[bin.index()];
            *known = Some(bin);
            *counted += count;
        }
        bins.into_iter().filter_map(|(bin, count)| Some((bin?, count))).collect()
    })
}
