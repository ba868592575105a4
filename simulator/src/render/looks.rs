//! The looks of real buildings: floors, walls, stripes and markers. Section 2.4.
//!
//! A colour is red, green and blue from 0 to 255, as a well exposed camera shows the surface in
//! white light.

use toposlam_vision::colour::{Stripe, StripeKind};

/// A colour as a camera shows it.
pub type Colour = [u8; 3];

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloorCovering {
    Plain,
    /// Tiles or boards with joints between them.
    Tiled {
        /// Distance between joints along x and along y, in metres.
        sides: [f64; 2],
        /// Width of a joint, in metres.
        joint: f64,
        /// Brightness of a joint, as a share of the tiles' brightness.
        joint_shade: f64,
    },
    /// Tufts of different shades.
    Carpet {
        /// Size of a tuft, in metres.
        tuft: f64,
        /// Spread of the shades, as a share.
        spread: f64,
    },
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildingLook {
    pub name: &'static str,
    pub about: &'static str,
    pub floor: FloorCovering,
    pub floor_colour: Colour,
    /// How much the floor shines, from 0 (not at all) to 1 (polished).
    pub gloss: f64,
    pub wall_colour: Colour,
    pub stripe: Stripe,
    pub stripe_colour: Colour,
    pub door_colour: Colour,
    pub frame_colour: Colour,
    pub ceiling_colour: Colour,
    /// The marker's colour. Nothing else in the building has it.
    pub marker_colour: Colour,
}

const fn tape(width: f64) -> Stripe {
    Stripe { kind: StripeKind::OnFloor, width }
}

const fn baseboard(width: f64) -> Stripe {
    Stripe { kind: StripeKind::OnWall, width }
}

const fn carpet(tuft: f64, spread: f64) -> FloorCovering {
    FloorCovering::Carpet { tuft, spread }
}

const fn tiles(sides: [f64; 2], joint: f64, joint_shade: f64) -> FloorCovering {
    FloorCovering::Tiled { sides, joint, joint_shade }
}

const MAGENTA: Colour = [205, 35, 140];
const ORANGE: Colour = [235, 110, 20];
const CYAN: Colour = [15, 150, 190];

macro_rules! looks {
    ($($name:literal $about:literal: $covering:expr, gloss $gloss:literal, $stripe:expr;
        floor $floor:expr, wall $wall:expr, stripe $stripe_colour:expr, door $door:expr,
        frame $frame:expr, ceiling $ceiling:expr, marker $marker:expr;)*) => {
        /// All looks; the first is the default.
        // paper: env.boundary
        pub const LOOKS: [BuildingLook; 9] = [$(BuildingLook {
            name: $name,
            about: $about,
            floor: $covering,
            floor_colour: $floor,
            gloss: $gloss,
            wall_colour: $wall,
            stripe: $stripe,
            stripe_colour: $stripe_colour,
            door_colour: $door,
            frame_colour: $frame,
            ceiling_colour: $ceiling,
            marker_colour: $marker,
        },)*];
    };
}

looks! {
    "laboratory" "white tape on grey carpet, beige walls": carpet(0.012, 0.22), gloss 0.0, tape(0.05);
        floor [104, 106, 110], wall [206, 190, 158], stripe [232, 231, 224], door [126, 86, 56],
        frame [84, 80, 76], ceiling [214, 212, 206], marker MAGENTA;
    "tiles" "black tape on light tiles, white walls":
        tiles([0.30, 0.30], 0.005, 0.62), gloss 0.25, tape(0.05);
        floor [186, 180, 166], wall [212, 212, 206], stripe [30, 30, 32], door [92, 112, 132],
        frame [150, 150, 148], ceiling [220, 220, 216], marker MAGENTA;
    "vinyl" "black baseboard on polished vinyl, white walls":
        FloorCovering::Plain, gloss 0.8, baseboard(0.10);
        floor [158, 154, 140], wall [216, 214, 206], stripe [26, 25, 26], door [150, 116, 76],
        frame [96, 92, 88], ceiling [214, 214, 210], marker ORANGE;
    "office" "white baseboard on brown carpet, cream walls":
        carpet(0.010, 0.25), gloss 0.0, baseboard(0.09);
        floor [112, 80, 58], wall [206, 196, 164], stripe [236, 234, 228], door [168, 132, 92],
        frame [224, 220, 210], ceiling [216, 214, 206], marker CYAN;
    "hospital" "black baseboard on polished green linoleum, pale green walls":
        FloorCovering::Plain, gloss 0.6, baseboard(0.10);
        floor [124, 146, 118], wall [188, 204, 182], stripe [32, 32, 34], door [198, 168, 122],
        frame [132, 132, 130], ceiling [222, 222, 218], marker MAGENTA;
    "basement" "white tape on painted concrete, grey walls as bright as the floor":
        carpet(0.060, 0.07), gloss 0.15, tape(0.05);
        floor [122, 118, 110], wall [128, 130, 134], stripe [234, 232, 226], door [78, 88, 96],
        frame [60, 62, 64], ceiling [150, 148, 144], marker ORANGE;
    "school" "black tape on red tiles, yellow walls":
        tiles([0.20, 0.20], 0.006, 1.35), gloss 0.3, tape(0.06);
        floor [158, 98, 76], wall [210, 186, 118], stripe [34, 33, 33], door [58, 92, 74],
        frame [108, 104, 96], ceiling [212, 210, 202], marker CYAN;
    "theatre" "white tape on dark blue carpet, dark panelled walls":
        carpet(0.012, 0.25), gloss 0.0, tape(0.05);
        floor [54, 62, 88], wall [104, 74, 52], stripe [222, 220, 212], door [66, 40, 30],
        frame [44, 34, 28], ceiling [120, 116, 110], marker ORANGE;
    "gallery" "black baseboard on pale wooden boards, grey walls":
        tiles([1.20, 0.12], 0.003, 0.7), gloss 0.4, baseboard(0.08);
        floor [196, 166, 122], wall [162, 162, 160], stripe [38, 37, 38], door [214, 212, 206],
        frame [120, 118, 116], ceiling [208, 208, 206], marker MAGENTA;
}

impl BuildingLook {
    pub fn named(name: &str) -> Option<&'static Self> {
        LOOKS.iter().find(|look| look.name == name)
    }
}

/// The reflectance of a colour for red, green and blue.
pub(crate) fn linear(colour: Colour) -> [f32; 3] {
    colour.map(|value| {
        let value = f32::from(value) / 255.0;
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    })
}
