//! The looks of real buildings: floors, walls, stripes and markers. Section 2.4.
//!
//! A colour is red, green and blue from 0 to 255, as a well exposed camera shows the surface in
//! white light.

use toposlam_vision::colour::{Stripe, StripeKind};

/// A colour as a camera shows it.
pub type Colour = [u8; 3];

/// The covering of a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FloorCovering {
    /// One colour.
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

/// The look of a building.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuildingLook {
    /// Its name.
    pub name: &'static str,
    /// What it looks like, in a few words.
    pub about: &'static str,
    /// The floor's covering.
    pub floor: FloorCovering,
    /// The floor's colour.
    pub floor_colour: Colour,
    /// How much the floor shines, from 0 (not at all) to 1 (polished).
    pub gloss: f64,
    /// The walls' colour.
    pub wall_colour: Colour,
    /// Kind and width of the stripe.
    pub stripe: Stripe,
    /// The stripe's colour.
    pub stripe_colour: Colour,
    /// The doors' colour.
    pub door_colour: Colour,
    /// The colour of the doors' frames.
    pub frame_colour: Colour,
    /// The ceiling's colour.
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

const MAGENTA: Colour = [205, 35, 140];
const ORANGE: Colour = [235, 110, 20];
const CYAN: Colour = [15, 150, 190];

/// All looks; the first is the default.
// paper: env.boundary
pub const LOOKS: [BuildingLook; 9] = [
    BuildingLook {
        name: "laboratory",
        about: "white tape on grey carpet, beige walls",
        floor: FloorCovering::Carpet { tuft: 0.012, spread: 0.22 },
        floor_colour: [104, 106, 110],
        gloss: 0.0,
        wall_colour: [206, 190, 158],
        stripe: tape(0.05),
        stripe_colour: [232, 231, 224],
        door_colour: [126, 86, 56],
        frame_colour: [84, 80, 76],
        ceiling_colour: [214, 212, 206],
        marker_colour: MAGENTA,
    },
    BuildingLook {
        name: "tiles",
        about: "black tape on light tiles, white walls",
        floor: FloorCovering::Tiled { sides: [0.30, 0.30], joint: 0.005, joint_shade: 0.62 },
        floor_colour: [186, 180, 166],
        gloss: 0.25,
        wall_colour: [212, 212, 206],
        stripe: tape(0.05),
        stripe_colour: [30, 30, 32],
        door_colour: [92, 112, 132],
        frame_colour: [150, 150, 148],
        ceiling_colour: [220, 220, 216],
        marker_colour: MAGENTA,
    },
    BuildingLook {
        name: "vinyl",
        about: "black baseboard on polished vinyl, white walls",
        floor: FloorCovering::Plain,
        floor_colour: [158, 154, 140],
        gloss: 0.8,
        wall_colour: [216, 214, 206],
        stripe: baseboard(0.10),
        stripe_colour: [26, 25, 26],
        door_colour: [150, 116, 76],
        frame_colour: [96, 92, 88],
        ceiling_colour: [214, 214, 210],
        marker_colour: ORANGE,
    },
    BuildingLook {
        name: "office",
        about: "white baseboard on brown carpet, cream walls",
        floor: FloorCovering::Carpet { tuft: 0.010, spread: 0.25 },
        floor_colour: [112, 80, 58],
        gloss: 0.0,
        wall_colour: [206, 196, 164],
        stripe: baseboard(0.09),
        stripe_colour: [236, 234, 228],
        door_colour: [168, 132, 92],
        frame_colour: [224, 220, 210],
        ceiling_colour: [216, 214, 206],
        marker_colour: CYAN,
    },
    BuildingLook {
        name: "hospital",
        about: "black baseboard on polished green linoleum, pale green walls",
        floor: FloorCovering::Plain,
        floor_colour: [124, 146, 118],
        gloss: 0.6,
        wall_colour: [188, 204, 182],
        stripe: baseboard(0.10),
        stripe_colour: [32, 32, 34],
        door_colour: [198, 168, 122],
        frame_colour: [132, 132, 130],
        ceiling_colour: [222, 222, 218],
        marker_colour: MAGENTA,
    },
    BuildingLook {
        name: "basement",
        about: "white tape on painted concrete, grey walls as bright as the floor",
        floor: FloorCovering::Carpet { tuft: 0.060, spread: 0.07 },
        floor_colour: [122, 118, 110],
        gloss: 0.15,
        wall_colour: [128, 130, 134],
        stripe: tape(0.05),
        stripe_colour: [234, 232, 226],
        door_colour: [78, 88, 96],
        frame_colour: [60, 62, 64],
        ceiling_colour: [150, 148, 144],
        marker_colour: ORANGE,
    },
    BuildingLook {
        name: "school",
        about: "black tape on red tiles, yellow walls",
        floor: FloorCovering::Tiled { sides: [0.20, 0.20], joint: 0.006, joint_shade: 1.35 },
        floor_colour: [158, 98, 76],
        gloss: 0.3,
        wall_colour: [210, 186, 118],
        stripe: tape(0.06),
        stripe_colour: [34, 33, 33],
        door_colour: [58, 92, 74],
        frame_colour: [108, 104, 96],
        ceiling_colour: [212, 210, 202],
        marker_colour: CYAN,
    },
    BuildingLook {
        name: "theatre",
        about: "white tape on dark blue carpet, dark panelled walls",
        floor: FloorCovering::Carpet { tuft: 0.012, spread: 0.25 },
        floor_colour: [54, 62, 88],
        gloss: 0.0,
        wall_colour: [104, 74, 52],
        stripe: tape(0.05),
        stripe_colour: [222, 220, 212],
        door_colour: [66, 40, 30],
        frame_colour: [44, 34, 28],
        ceiling_colour: [120, 116, 110],
        marker_colour: ORANGE,
    },
    BuildingLook {
        name: "gallery",
        about: "black baseboard on pale wooden boards, grey walls",
        floor: FloorCovering::Tiled { sides: [1.20, 0.12], joint: 0.003, joint_shade: 0.7 },
        floor_colour: [196, 166, 122],
        gloss: 0.4,
        wall_colour: [162, 162, 160],
        stripe: baseboard(0.08),
        stripe_colour: [38, 37, 38],
        door_colour: [214, 212, 206],
        frame_colour: [120, 118, 116],
        ceiling_colour: [208, 208, 206],
        marker_colour: MAGENTA,
    },
];

impl BuildingLook {
    /// The look with this name.
    #[must_use]
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
