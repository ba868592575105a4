//! The output of training: the pixels of each class, and the result of cross-validation.

use std::{io::Write, path::PathBuf};

use serde::Serialize;
use serde_json::{Map, Value, json};
use toposlam_vision::colour::{Confusion, ExampleError, PixelClass, Stripe, StripeKind, Training};

use crate::cli::{
    CliError,
    json::print_line,
    text::{grouped, print_hanging, print_rows},
};

/// The result of training.
pub(super) struct TrainingReport<'t> {
    pub(super) training: &'t Training,
    pub(super) left_out: Vec<LeftOut>,
    pub(super) stripe: Stripe,
    pub(super) validation: Validation,
}

/// An image that was left out, and why.
pub(super) struct LeftOut {
    pub(super) image: PathBuf,
    pub(super) cause: ExampleError,
}

/// The result of cross-validation.
pub(super) enum Validation {
    /// With this number of parts.
    Folds(usize, Confusion),
    /// Not validated.
    None { why: String },
}

impl TrainingReport<'_> {
    pub(super) fn print(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let kind = match self.stripe.kind {
            StripeKind::OnFloor => "a tape on the floor",
            StripeKind::OnWall => "a baseboard on the wall",
        };
        writeln!(out, "stripe  {kind}, {} m wide", self.stripe.width)?;
        write!(out, "images  {}", grouped(self.training.images() as u128))?;
        match self.left_out.len() {
            0 => writeln!(out)?,
            others => writeln!(out, ", and {others} left out")?,
        }
        writeln!(out)?;
        match &self.validation {
            Validation::Folds(folds, confusion) => {
                writeln!(out, "Cross-validation in {folds} parts:\n")?;
                self.print_confusion(out, confusion)
            }
            Validation::None { why } => {
                let rows = PixelClass::LEARNED.map(|class| self.seen(class));
                print_rows(out, ["class", "images", "    pixels"], &rows)?;
                Ok(writeln!(out, "\nnot cross-validated: {why}")?)
            }
        }
    }

    fn seen(&self, class: PixelClass) -> [String; 3] {
        let seen = self.training.seen(class);
        let (images, pixels) = (grouped(seen.images as u128), grouped(seen.pixels.into()));
        [class.name().to_owned(), format!("{images:>6}"), format!("{pixels:>10}")]
    }

    fn print_confusion(&self, out: &mut dyn Write, confusion: &Confusion) -> Result<(), CliError> {
        let rows = PixelClass::LEARNED.map(|class| {
            let [name, images, pixels] = self.seen(class);
            let recall = confusion.recall(class);
            let recall = recall.map_or("-".to_owned(), |share| format!("{:.2} %", 100.0 * share));
            [name, images, pixels, format!("{recall:>9}")]
        });
        print_rows(out, ["class", "images", "    pixels", "    right"], &rows)?;
        writeln!(out, "\nTrue class, and the predicted classes with their pixels:\n")?;
        for (class, predicted) in PixelClass::LEARNED.iter().zip(&confusion.pixels) {
            let predicted =
                Confusion::GIVEN.iter().zip(predicted).filter(|(_, pixels)| **pixels > 0);
            let predicted = predicted
                .map(|(class, &pixels)| format!("{} {}", class.name(), grouped(pixels.into())));
            let texts = predicted.collect::<Vec<_>>().join(", ");
            print_hanging(out, &format!("  {:<8}", class.name()), &texts)?;
        }
        Ok(())
    }

    pub(super) fn print_json(&self, out: &mut dyn Write) -> Result<(), CliError> {
        let (folds, confusion, not_validated) = match &self.validation {
            Validation::Folds(folds, confusion) => (Some(*folds), Some(confusion), None),
            Validation::None { why } => (None, None, Some(why.as_str())),
        };
        let classes = PixelClass::LEARNED.map(|class| {
            let seen = self.training.seen(class);
            ClassFigures {
                class: class.name(),
                images: seen.images,
                pixels: seen.pixels,
                recall: confusion.and_then(|confusion| confusion.recall(class)),
                precision: confusion.and_then(|confusion| confusion.precision(class)),
            }
        });
        let left_out = self.left_out.iter().map(|LeftOut { image, cause }| {
            json!({ "image": image.display().to_string(), "reason": cause.to_string() })
        });
        print_line(
            out,
            "training",
            &TrainingLine {
                images: self.training.images(),
                left_out: left_out.collect(),
                folds,
                not_validated,
                confusion: confusion.map(confusion_json),
                classes,
                stripe: json!({ "kind": self.stripe.kind.place(), "width": self.stripe.width }),
            },
        )
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct TrainingLine<'t> {
    images: usize,
    left_out: Vec<Value>,
    folds: Option<usize>,
    /// Why there was no cross-validation.
    not_validated: Option<&'t str>,
    /// For each true class, the number of pixels in each predicted class.
    confusion: Option<Value>,
    classes: [ClassFigures; 4],
    stripe: Value,
}

/// The pixels of a class, and how well they are classified.
#[derive(Serialize)]
struct ClassFigures {
    class: &'static str,
    images: usize,
    pixels: u64,
    recall: Option<f64>,
    precision: Option<f64>,
}

/// For each true class, the number of pixels in each predicted class.
fn confusion_json(confusion: &Confusion) -> Value {
    let rows = PixelClass::LEARNED.iter().zip(&confusion.pixels).map(|(is, predicted)| {
        let columns = Confusion::GIVEN.iter().zip(predicted);
        let row: Map<_, _> =
            columns.map(|(class, &pixels)| (class.name().to_owned(), pixels.into())).collect();
        (is.name().to_owned(), Value::Object(row))
    });
    Value::Object(rows.collect())
}
