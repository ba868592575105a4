//! What training prints: how much of each class was seen, and how well it is told.

use std::{io::Write, path::PathBuf};

use serde::Serialize;
use serde_json::{Map, Value, json};
use toposlam_vision::colour::{Confusion, ExampleError, PixelClass, Stripe, StripeKind, Training};

use crate::cli::{Failure, json::print_object, text::grouped, text::print_rows};

/// What was learned from, and how well.
pub(super) struct TrainingReport<'t> {
    pub(super) training: &'t Training,
    pub(super) left_out: Vec<LeftOut>,
    pub(super) stripe: Stripe,
    pub(super) validation: Validation,
}

/// An image that teaches nothing, and why.
pub(super) struct LeftOut {
    pub(super) image: PathBuf,
    pub(super) cause: ExampleError,
}

/// How well images are told by what others teach.
pub(super) enum Validation {
    /// In so many parts.
    Folds(usize, Confusion),
    /// Not known.
    None { why: String },
}

impl TrainingReport<'_> {
    pub(super) fn print(&self, out: &mut dyn Write) -> Result<(), Failure> {
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
                writeln!(
                    out,
                    "What pixels are (rows), and what they are told to be by the other images, in \
                     {folds} parts:\n"
                )?;
                self.print_confusion(out, confusion)
            }
            Validation::None { why } => {
                let rows = PixelClass::LEARNED.map(|class| self.seen(class));
                print_rows(out, ["", "images", "    pixels"], &rows)?;
                Ok(writeln!(out, "\nnot cross-validated: {why}")?)
            }
        }
    }

    fn seen(&self, class: PixelClass) -> [String; 3] {
        let seen = self.training.seen(class);
        let (images, pixels) = (grouped(seen.images as u128), grouped(seen.pixels.into()));
        [class.name().to_owned(), format!("{images:>6}"), format!("{pixels:>10}")]
    }

    fn print_confusion(&self, out: &mut dyn Write, confusion: &Confusion) -> Result<(), Failure> {
        let [floor, stripe, marker, other, unknown] =
            Confusion::GIVEN.map(|class| format!("{:>10}", class.name()));
        let heads =
            ["", "images", "    pixels", &floor, &stripe, &marker, &other, &unknown, "    right"];
        let rows = PixelClass::LEARNED.iter().zip(&confusion.pixels).map(|(&class, told)| {
            let [name, images, pixels] = self.seen(class);
            let [floor, stripe, marker, other, unknown] =
                told.map(|pixels| format!("{:>10}", grouped(pixels.into())));
            let right = confusion.recall(class).map_or_else(
                || format!("{:>9}", "-"),
                |share| format!("{:>9}", format!("{:.2} %", 100.0 * share)),
            );
            [name, images, pixels, floor, stripe, marker, other, unknown, right]
        });
        Ok(print_rows(out, heads, &rows.collect::<Vec<_>>())?)
    }

    pub(super) fn print_json(&self, out: &mut dyn Write) -> Result<(), Failure> {
        let (folds, confusion) = match &self.validation {
            Validation::Folds(folds, confusion) => (Some(*folds), Some(confusion)),
            Validation::None { .. } => (None, None),
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
        print_object(
            out,
            &Line {
                schema: 1,
                images: self.training.images(),
                left_out: left_out.collect(),
                folds,
                confusion: confusion.map(confusion_json),
                classes,
                stripe: json!({ "kind": self.stripe.kind.place(), "width": self.stripe.width }),
            },
        )
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Line {
    schema: u32,
    images: usize,
    left_out: Vec<Value>,
    folds: Option<usize>,
    /// Of each class, how many pixels were told to be of which.
    confusion: Option<Value>,
    classes: [ClassFigures; 4],
    stripe: Value,
}

/// How much of a class there is, and how well it is told.
#[derive(Serialize)]
struct ClassFigures {
    class: &'static str,
    images: usize,
    pixels: u64,
    recall: Option<f64>,
    precision: Option<f64>,
}

/// A row for each class that pixels are, in it a number for each that they are told to be.
fn confusion_json(confusion: &Confusion) -> Value {
    let rows = PixelClass::LEARNED.iter().zip(&confusion.pixels).map(|(is, told)| {
        let columns = Confusion::GIVEN.iter().zip(told);
        let row: Map<_, _> =
            columns.map(|(told, &pixels)| (told.name().to_owned(), pixels.into())).collect();
        (is.name().to_owned(), Value::Object(row))
    });
    Value::Object(rows.collect())
}
