//! No bytes make a reader of calibrations, of colours or of images take more memory than documented.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may panic")]

#[path = "../../tests/memory/peak.rs"]
mod peak;

use std::{
    hint::black_box,
    io::{Cursor, ErrorKind},
};

use image::{DynamicImage, ImageFormat, Rgb, RgbImage};
use peak::{Documented, keep, peak};
use toposlam_vision::{
    camera::{KannalaBrandt, Mask, Mei, OCam, calibration},
    colour::ColourModel,
    image_file::{ImageFile, ImageFileError},
};

const COLOURS: Documented =
    Documented::new("colours", |bytes| keep(ColourModel::read(bytes)), [512, 4096]);
const IMAGE: Documented = Documented::new(
    "image",
    |bytes| keep(ImageFile::open(bytes).map(|it| it.size())),
    [16, 1 << 20],
);
const READERS: [Documented; 6] = [
    Documented::new(
        "calibration",
        |bytes| keep(calibration::read(bytes, &mut |_| Err(ErrorKind::NotFound.into()))),
        [512, 4096],
    ),
    Documented::new("OCamCalib", |bytes| keep(OCam::read("f", bytes, 1.0)), [32, 4096]),
    Documented::new("MEI", |bytes| keep(Mei::read("f", bytes, 1.0)), [512, 65_536]),
    Documented::new(
        "fisheye",
        |bytes| keep(KannalaBrandt::read("f", bytes, 1.0, [0.0; 2])),
        [512, 65_536],
    ),
    COLOURS,
    IMAGE,
];

fn main() {
    peak::run(
        "reading_takes_no_more_memory_than_documented",
        reading_takes_no_more_memory_than_documented,
    );
}

fn reading_takes_no_more_memory_than_documented() {
    let parts = "\n~,~[~{~=~\"~a.~#\n~[[a]]\n~[[a.b]]\n~'~\x7f~1 ~1\n~-1 ~- ~- 1\n~? ~a: ~\
        a:\n ~a: 1\n~[1],~&a ~*a ~!!a ~%A\n~---\n~|\n~\t~\u{fffd}~1,~{},~[],~\\~>~a";
    let starts = "~<a>~a=[~[camera]\na=[~[camera]\nmask=\"~K:\n   data: [~D:\n   data: [ ~xi: [~5 ~\
        #\n~%YAML:1.0\n---\n~model_type: ~model_type: \"~a: [~a: {~version=1\na=[~\
        version=1\n[histograms]\nfloor=[~\x7f";
    let mut most = [0; 6];
    // Growing vectors are largest just after a power of two.
    for length in (1..70).step_by(7).chain([127, 260, 1030, 4100, 16_400, 33_000]) {
        for part in parts.split('~') {
            for start in starts.split('~') {
                let bytes = format!("{start}{}", part.repeat(length / part.len() + 1));
                for (most, stated) in most.iter_mut().zip(&READERS) {
                    *most = (*most).max(stated.holds(bytes.as_bytes()));
                }
            }
        }
    }
    println!("the most for each byte: {most:?}");

    // A mask is as large as the images, however few bytes it takes.
    let size = [1280, 960];
    let png = Mask::new("m", size, vec![true; 1280 * 960]).to_png().unwrap();
    assert!(peak(|| drop(black_box(Mask::from_png("m", &png, size)))) <= 16 * 1280 * 960);
    let taken = peak(|| drop(black_box(Mask::from_png("m", &png, [640, 480]))));
    assert!(taken <= 16 * 640 * 480 / 10, "{taken}");

    colour_files_hold();
    images_hold();
}

fn colour_files_hold() {
    let colours = include_str!("../../fuzz/corpus/colours/of-the-images");
    for bins in [1, 10, 100, 1000, 5000] {
        let rows = (0..bins).map(|nth| format!("[31,{},{},1],", 60 - nth / 200, nth % 200));
        let many = colours.replace("[13, 1, 4, 5673],", &rows.collect::<String>());
        assert!(ColourModel::read(many.as_bytes()).is_ok(), "{bins}");
        COLOURS.holds(many.as_bytes());
    }
    COLOURS.holds(colours.as_bytes());
}

/// The header of an image takes no more memory, whatever size it gives. An image that is too large is not
/// decoded.
fn images_hold() {
    let (head, pixels) = (include_bytes!("../../fuzz/corpus/image/error-promises-much"), 16_384);
    IMAGE.holds(head);
    let taken = peak(|| {
        let file = ImageFile::open(head).unwrap();
        let refused = file.image().unwrap_err();
        assert_eq!(refused, ImageFileError::TooLarge { size: [pixels; 2] });
    });
    assert!(taken <= IMAGE.multiple * head.len() + IMAGE.besides, "{taken}");
    let size = [1280, 960];
    let picture =
        RgbImage::from_fn(size[0], size[1], |u, v| Rgb([u as u8, v as u8, (u + v) as u8]));
    let deep = DynamicImage::ImageRgb8(picture.clone()).into_rgba16();
    let encoded = |format| {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    };
    let mut deep_png = Cursor::new(Vec::new());
    deep.write_to(&mut deep_png, ImageFormat::Png).unwrap();
    for image in [encoded(ImageFormat::Png), encoded(ImageFormat::Jpeg), deep_png.into_inner()] {
        IMAGE.holds(&image);
        let taken = peak(|| drop(black_box(ImageFile::open(&image).unwrap().image().unwrap())));
        let pixels = 1280 * 960;
        println!("{} bytes for each pixel", taken / pixels);
        assert!(taken <= 16 * image.len() + (1 << 20) + 16 * pixels, "{taken}");
    }
}
