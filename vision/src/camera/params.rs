//! The parameters of finding a mirror in images, in one place.
//!
//! Lengths are in pixels. A *unit* is a pixel in a circle of radius [`RimParams::unit_radius`], and more in a larger
//! one. Brightness is that of images whose mean is 64. "A part of" is a number from 0 to 1. The values come from:
//!
//! * **geometry**: the camera or the arithmetic gives the value;
//! * **views**: chosen on rendered images with and without clutter, so that no circle that is found is wrong
//!   (`robot/tests/rim.rs`, `vision/tests/rim.rs`, the tests of `camera::unchanging`).

use crate::params;

params! {
    /// How the circle of a mirror's rim is found.
    RimParams {
        /// The longest side of the image in which all circles are compared. Geometry: time grows with its third
        /// power.
        coarse: usize = 160,
        /// The number of circles of that image that are followed in larger ones. Views.
        followed: usize = 40,
        /// The number of circles that are then fitted. Views.
        kept: usize = 20,
        /// The greatest difference of brightness that counts, over two pixels. Views.
        steep: f32 = 24.0,
        /// Edges of this height count half. Views.
        half: f32 = 6.0,
        /// The least part of a circle that must be in the image. Geometry.
        least_inside: f32 = 0.2,
        /// On bearings, an edge is the difference between means over this number of half units, inside and outside.
        /// Geometry: the blur of an edge.
        wide: usize = 5,
        /// The least height of an edge. Views: less is noise.
        least_edge: f64 = 3.0,
        /// The radius at which a unit is a pixel. Geometry: the rim in images of 1280 by 960 pixels.
        unit_radius: f64 = 450.0,
        /// Edges are searched for up to this many units from a circle, ... Views.
        reach: f64 = 8.0,
        /// ... and the steepest one must be within this many. Views.
        near: f64 = 1.0,
        /// The least part of the full circle that must be seen. Views.
        least_seen: f64 = 0.14,
        /// The least part of the circle in the image that must be seen. Views.
        least_of_visible: f64 = 0.45,
        /// The least part of the edges that must be brighter inside than outside. Views.
        least_falls: f64 = 0.15,
        /// Another circle must have less than this part of the rim's score. Views.
        lead: f64 = 0.6,
        /// Circles that differ by less, as a part of the radius, are the same. Geometry: a calibration allows the
        /// rim to be off by 2 %.
        same: f64 = 0.02,
        /// The greatest change of centre and radius if a part of what is seen is left out, as a part of the radius.
        /// Views.
        certain: f64 = 0.01,
        /// The number of parts of which each is left out once. Views.
        parts: usize = 8,
        /// The number of directions in which other circles that share an arc are tried. Views.
        sides: usize = 12,
        /// A dark ring around the mirror is at most this part of the outer radius wide. Views.
        widest_ring: f64 = 0.12,
        /// The inner border of a dark ring is seen on at least this part of the bearings of the outer one. Views.
        least_inner: f64 = 0.25,
        /// Smaller differences of brightness are noise. Views.
        noise: f64 = 6.0,
        /// Many circles are compared on one bearing in this many. Views: faster, with the same results.
        every: usize = 4,
    }

    /// How the pixels that never change are found.
    UnchangingParams {
        /// The least number of images. Geometry: in fewer, edges of the building are in the same place by chance.
        fewest: usize = 4,
        /// The longest side of an image; larger ones are reduced. Geometry: memory and time.
        longest: u32 = 640,
        /// The least part of the pixels of a piece that change in some image. Views.
        least_changing: f64 = 0.04,
        /// Pieces with a smaller part of the mirror are ignored. Views.
        small: f64 = 0.01,
        /// The least part of the mirror that must be seen. Views.
        least_seen: f64 = 0.3,
        /// Added to the brightness, from 0 to 255, so that its logarithm is finite. Geometry.
        black: f32 = 8.0,
        /// The standard deviation of the smoothing. Geometry: the noise of one pixel.
        sigma: f32 = 1.0,
        /// The least slope of an edge: of the logarithm of the brightness, for each pixel. Views.
        steep: f32 = 0.05,
        /// The radii at which struts are searched for, as parts of the rim's. Geometry: the lens is nearer to the
        /// centre, the rim's own edge farther away.
        strut_radii: [f64; 2] = [0.25, 0.97],
        /// The most bearings, of 2048, that one strut hides. Geometry: 7 degrees.
        widest_strut: usize = 40,
    }
}
