//! `toposlam draw WORLD`.

use std::fs;

use super::{folder, stdout_of};

const WORLD: &str = "worlds/shape-6.toml";

#[test]
fn without_a_file_the_svg_goes_to_standard_output() {
    let svg = stdout_of(["draw", WORLD]);
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    assert_eq!(svg, stdout_of(["draw", WORLD]));
}

#[test]
fn the_extension_of_the_file_decides_the_format() {
    let folder = folder("draw");
    let (svg, png) = (folder.join("w.svg"), folder.join("w.png"));
    assert_eq!(stdout_of(["draw", WORLD, "--out", svg.to_str().unwrap()]), "");
    assert_eq!(fs::read_to_string(&svg).unwrap(), stdout_of(["draw", WORLD]));
    stdout_of(["draw", WORLD, "--out", png.to_str().unwrap()]);
    assert!(fs::read(&png).unwrap().starts_with(b"\x89PNG\r\n\x1a\n"));
}
