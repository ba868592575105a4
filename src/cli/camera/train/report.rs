//! The report of training: the pixels of each class, and the result of cross-validation.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Map, Value};
use toposlam_vision::colour::{Confusion, PixelClass, Stripe, Training};

use crate::cli::text::{grouped, print_hanging, print_rows};

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct TrainingReport {
    images: usize,
    left_out: Vec<LeftOut>,
    folds: Option<usize>,
    /// Why there was no cross-validation.
    not_validated: Option<String>,
    /// For each true class, the number of pixels in each predicted class.
    confusion: Option<Map<String, Value>>,
    classes: [ClassReport; 4],
    stripe: StripeReport,
}

/// An image that was left out, and why.
#[derive(Serialize)]
pub(super) struct LeftOut {
    pub(super) image: String,
    pub(super) reason: String,
}

/// The pixels of a class, and how well they are classified.
#[derive(Serialize)]
struct ClassReport {
    class: &'static str,
    images: usize,
    pixels: u64,
    recall: Option<f64>,
    precision: Option<f64>,
}

#[derive(Serialize)]
struct StripeReport {
    kind: &'static str,
    width: f64,
}

impl TrainingReport {
    /// The validation has the number of parts and its result, or the reason why there is none.
    pub(super) fn new(
        training: &Training,
        left_out: Vec<LeftOut>,
        stripe: Stripe,
        validation: Result<(usize, Confusion), String>,
    ) -> Self {
        let confusion = validation.as_ref().ok().map(|(_, confusion)| confusion);
        let classes = PixelClass::LEARNED.map(|class| {
            let seen = training.seen(class);
            ClassReport {
                class: class.name(),
                images: seen.images,
                pixels: seen.pixels,
                recall: confusion.and_then(|confusion| confusion.recall(class)),
                precision: confusion.and_then(|confusion| confusion.precision(class)),
            }
        });
        let name = |class: &PixelClass| class.name().to_owned();
        let row = |pixels: &[u64; 5]| {
            let pixels = pixels.iter().map(|&pixels| Value::from(pixels));
            Value::Object(Confusion::GIVEN.iter().map(name).zip(pixels).collect())
        };
        let pixels = confusion.map(|confusion| {
            PixelClass::LEARNED.iter().map(name).zip(confusion.pixels.iter().map(row)).collect()
        });
        Self {
            images: training.images(),
            left_out,
            folds: validation.as_ref().ok().map(|(folds, _)| *folds),
            confusion: pixels,
            classes,
            stripe: StripeReport { kind: stripe.kind.place(), width: stripe.width },
            not_validated: validation.err(),
        }
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let kind = match self.stripe.kind {
            "floor" => "a tape on the floor",
            _ => "a baseboard on the wall",
        };
        writeln!(out, "stripe  {kind}, {} m wide", self.stripe.width)?;
        write!(out, "images  {}", grouped(self.images as u128))?;
        match self.left_out.len() {
            0 => writeln!(out)?,
            others => writeln!(out, ", and {others} left out")?,
        }
        writeln!(out)?;
        let row = |class: &ClassReport| {
            let recall = class.recall.map_or("-".to_owned(), |it| format!("{:.2} %", 100.0 * it));
            [
                class.class.to_owned(),
                format!("{:>6}", grouped(class.images as u128)),
                format!("{:>10}", grouped(class.pixels.into())),
                format!("{recall:>9}"),
            ]
        };
        let rows = self.classes.each_ref().map(row);
        let heads = ["class", "images", "    pixels", "    right"];
        let (Some(folds), Some(confusion)) = (self.folds, &self.confusion) else {
            let [class, images, pixels, _] = heads;
            let rows = rows.map(|[class, images, pixels, _]| [class, images, pixels]);
            print_rows(out, [class, images, pixels], &rows)?;
            let why = self.not_validated.as_deref().unwrap_or_default();
            return writeln!(out, "\nnot cross-validated: {why}");
        };
        writeln!(out, "Cross-validation in {folds} parts:\n")?;
        print_rows(out, heads, &rows)?;
        writeln!(out, "\nTrue class, and the predicted classes with their pixels:\n")?;
        for class in &self.classes {
            let pixels = |given: &PixelClass| {
                let pixels = confusion.get(class.class)?.get(given.name())?.as_u64()?;
                (pixels > 0).then(|| format!("{} {}", given.name(), grouped(pixels.into())))
            };
            let texts: Vec<_> = Confusion::GIVEN.iter().filter_map(pixels).collect();
            print_hanging(out, &format!("  {:<8}", class.class), &texts.join(", "))?;
        }
        Ok(())
    }
}
