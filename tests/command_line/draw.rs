//! `toposlam draw WORLD`.

use super::Scratch;

#[test]
fn the_extension_of_the_file_decides_the_format_and_svg_is_the_default() {
    let scratch = Scratch::new("draw");
    let svg = scratch.out("draw worlds/shape-6.toml", 0);
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    for (option, name) in [("--out", "w.svg"), ("-o", "w.png")] {
        assert_eq!(scratch.out(&format!("draw worlds/shape-6.toml {option} {name}"), 0), "");
    }
    assert_eq!(scratch.text("w.svg"), svg);
    assert!(scratch.bytes("w.png").starts_with(b"\x89PNG\r\n\x1a\n"));
}
