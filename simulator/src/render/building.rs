//! A building: walls with doors and posters, the stripe along them, lamps, furniture, cables, and the marker.
//! Section 2.4.

use rand::RngExt;
use toposlam_model::{
    embedded_graph::Dart,
    floor_plan::{BuildingWall, FloorPlan, Rectangle, walls},
};
use toposlam_vision::{
    colour::StripeKind,
    params::{MARKER_LENGTH, MARKER_WIDTH},
};

use crate::render::{
    cables::Cables,
    effects::Effects,
    furniture::{Block, furniture},
    light_map::LightMap,
    lights::{CEILING, Lamp, Lights},
    looks::{BuildingLook, linear},
    overhead::Overhead,
    random_stream::{StreamPurpose, about, clouds, stream},
    squares::Squares,
};
use crate::truth::LyingMarker;

/// Length and width of the marker, in metres.
const MARKER: [f64; 2] = [MARKER_LENGTH, MARKER_WIDTH];

/// Width and height of a door, and width of its frame, in metres.
const DOOR_WIDTH: f64 = 0.90;
const DOOR_HEIGHT: f32 = 2.05;
const FRAME: f32 = 0.07;

/// The greatest length of things on a wall, in metres.
const LONGEST: f32 = 1.01;

/// A building to render.
#[derive(Clone, Debug)]
pub struct Building {
    pub(crate) look: BuildingLook,
    pub(crate) colours: BuildingColours,
    floors: Vec<Rectangle>,
    walls: Vec<BuildingWall>,
    pub(crate) faces: Vec<Face>,
    things: Vec<Thing>,
    /// The walls along which tape may lie.
    taped: Squares<Face>,
    pub(crate) light: LightMap,
    /// The lamps above a place or nearby.
    pub(crate) lamps: Squares<Lamp>,
    pub(crate) marker: Option<Rectangle>,
    pub(crate) texture: f32,
    pub(crate) gloss: f32,
    scuffs: f32,
    pub(crate) furniture: Vec<Block>,
    pub(crate) cables: Cables,
    pub(crate) overhead: Overhead,
}

/// The look's colours, in linear light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BuildingColours {
    pub(crate) floor: [f32; 3],
    pub(crate) wall: [f32; 3],
    pub(crate) stripe: [f32; 3],
    pub(crate) door: [f32; 3],
    pub(crate) frame: [f32; 3],
    pub(crate) ceiling: [f32; 3],
    pub(crate) marker: [f32; 3],
}

/// A wall as rays meet it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub(crate) along: usize,
    pub(crate) plane: f32,
    pub(crate) floor_side: f32,
    pub(crate) span: [f32; 2],
    /// The extent of tape along the wall: the wall itself, and round outer corners.
    taped: [f32; 2],
    /// The range of its things.
    things: [usize; 2],
}

#[derive(Clone, Copy, Debug)]
struct Thing {
    kind: Kind,
    from: f32,
    to: f32,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// A gap in the stripe.
    Gap,
    Door {
        taped: bool,
    },
    Poster {
        low: f32,
        high: f32,
        colour: [f32; 3],
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WallPart {
    Bare,
    Baseboard,
    Leaf,
    Frame,
    Poster(u32),
}

impl Building {
    /// The building of a floor plan. If `marker` is given, the marker lies at that dart's junction,
    /// along the dart's hallway.
    ///
    /// Only effects with the scope `Building` matter. The same seed gives the same building.
    pub fn new(
        plan: &FloorPlan,
        look: &BuildingLook,
        marker: Option<Dart>,
        effects: &Effects,
        seed: u64,
    ) -> Self {
        let walls = walls(plan);
        let lights = Lights::new(plan, &walls, effects, seed);
        let floors: Vec<_> = plan.floor().collect();
        let mut things = Vec::new();
        let faces: Vec<_> = walls
            .iter()
            .enumerate()
            .map(|(number, wall)| {
                let begin = things.len();
                things.extend(things_of(wall, number, effects, seed));
                let round = look.stripe.width;
                let [before, beyond] = wall.juts.map(|juts| if juts { round } else { 0.0 });
                Face {
                    along: wall.along,
                    plane: wall.plane as f32,
                    floor_side: wall.floor_side as f32,
                    span: wall.span.map(|at| at as f32),
                    taped: [(wall.span[0] - before) as f32, (wall.span[1] + beyond) as f32],
                    things: [begin, things.len()],
                }
            })
            .collect();
        let taped = match look.stripe.kind {
            StripeKind::OnFloor => faces.clone(),
            StripeKind::OnWall => Vec::new(),
        };
        Self {
            look: *look,
            colours: BuildingColours {
                floor: linear(look.floor_colour),
                wall: linear(look.wall_colour),
                stripe: linear(look.stripe_colour),
                door: linear(look.door_colour),
                frame: linear(look.frame_colour),
                ceiling: linear(look.ceiling_colour),
                marker: linear(look.marker_colour),
            },
            taped: Squares::new(&floors, 0.25, taped, |face| face.tape(look.stripe.width)),
            light: LightMap::new(&floors, &walls, &lights),
            // Edges of lamps may be blurred this far.
            lamps: Squares::new(&floors, 0.5, lights.lamps, |lamp| lamp.rectangle().widened(0.5)),
            marker: marker.map(|dart| rectangle(&LyingMarker::along(plan, dart))),
            texture: effects.texture as f32,
            gloss: (effects.gloss * look.gloss) as f32,
            scuffs: effects.scuffs as f32,
            furniture: furniture(&walls, effects.furniture, plan.hallway_width(), seed),
            cables: Cables::new(&floors, effects.cables, seed),
            overhead: Overhead::new(effects.dark_rim, seed),
            floors,
            walls,
            faces,
            things,
        }
    }

    pub fn walls(&self) -> &[BuildingWall] {
        &self.walls
    }

    /// Puts the marker elsewhere, or takes it away.
    pub(crate) fn place_marker(&mut self, marker: Option<LyingMarker>) {
        self.marker = marker.as_ref().map(rectangle);
    }

    /// Where the marker lies.
    pub fn marker(&self) -> Option<Rectangle> {
        self.marker
    }

    /// Whether there is floor at a position.
    pub fn has_floor(&self, position: [f64; 2]) -> bool {
        self.floors.iter().any(|floor| floor.holds(position))
    }

    /// The things on a wall at a place along it, and perhaps others nearby.
    #[inline]
    fn things(&self, face: &Face, along: f32) -> impl Iterator<Item = (usize, &Thing)> {
        let things = &self.things[face.things[0]..face.things[1]];
        let first = things.partition_point(|thing| thing.from < along - LONGEST);
        let things = things[first..].iter().take_while(move |thing| thing.from <= along);
        (face.things[0] + first..).zip(things)
    }

    /// The part of a wall at this place along it and this height.
    pub(crate) fn wall_part(&self, face: &Face, along: f32, height: f32) -> WallPart {
        let stripe = self.look.stripe;
        let low = stripe.kind == StripeKind::OnWall && height < stripe.width as f32;
        let mut part = if low { WallPart::Baseboard } else { WallPart::Bare };
        for (number, thing) in self.things(face, along) {
            if thing.to < along {
                continue;
            }
            match thing.kind {
                Kind::Gap if low => part = WallPart::Bare,
                Kind::Door { .. } if height < DOOR_HEIGHT => {
                    let edge = (along - thing.from).min(thing.to - along).min(DOOR_HEIGHT - height);
                    return if edge < FRAME { WallPart::Frame } else { WallPart::Leaf };
                }
                Kind::Poster { low, high, .. } if low < height && height < high => {
                    return WallPart::Poster(number as u32);
                }
                _ => {}
            }
        }
        part
    }

    pub(crate) fn wall_colour(&self, part: WallPart, along: f32, height: f32) -> [f32; 3] {
        match part {
            WallPart::Bare => self.colours.wall,
            WallPart::Baseboard => self.scuffed([along, height]),
            WallPart::Leaf => self.colours.door,
            WallPart::Frame => self.colours.frame,
            WallPart::Poster(number) => match self.things[number as usize] {
                Thing { kind: Kind::Poster { low, high, colour }, from, to } => {
                    poster(colour, [(along - from) / (to - from), (height - low) / (high - low)])
                }
                _ => self.colours.wall,
            },
        }
    }

    /// Whether there is tape at a place of the floor.
    #[inline]
    pub(crate) fn tape_at(&self, place: [f32; 2]) -> bool {
        self.taped.at(place).any(|face| {
            let (along, out) = (place[face.along], place[1 - face.along]);
            let out = (out - face.plane) * face.floor_side;
            let width = self.look.stripe.width as f32;
            (0.0..=width).contains(&out)
                && (face.taped[0]..=face.taped[1]).contains(&along)
                && !self.things(face, along).any(|(_, thing)| {
                    matches!(thing.kind, Kind::Gap | Kind::Door { taped: false })
                        && along <= thing.to
                })
        })
    }

    /// The colour of the stripe at a place on it.
    pub(crate) fn scuffed(&self, [x, y]: [f32; 2]) -> [f32; 3] {
        if self.scuffs == 0.0 {
            return self.colours.stripe;
        }
        let wear = 0.5 * clouds(x * 5.0, y * 5.0, 77) + 0.5 * clouds(x * 31.0, y * 31.0, 78);
        // Worn tape looks more like what it sticks on, and dirty tape is greyer.
        let share = self.scuffs * (0.5 + 0.5 * wear);
        [0, 1, 2].map(|c| {
            self.colours.stripe[c] * (1.0 - share)
                + share * 0.5 * (self.colours.floor[c] + self.colours.wall[c])
        })
    }
}

impl Face {
    fn tape(&self, width: f64) -> Rectangle {
        let plane = f64::from(self.plane);
        let inner = plane + f64::from(self.floor_side) * width;
        let (mut least, mut greatest) = ([plane.min(inner); 2], [plane.max(inner); 2]);
        [least[self.along], greatest[self.along]] = self.taped.map(f64::from);
        Rectangle { least, greatest }
    }
}

/// Doors, posters and gaps of a wall, sorted by their beginnings.
fn things_of(wall: &BuildingWall, number: usize, effects: &Effects, seed: u64) -> Vec<Thing> {
    let length = wall.length();
    let mut things: Vec<Thing> = Vec::new();
    let mut rng = stream(seed, StreamPurpose::Doors, number);
    for _ in 0..about(effects.doors * length / 10.0, &mut rng) {
        let (share, taped) = (rng.random::<f64>(), rng.random::<f64>() >= effects.untaped_doors);
        place(wall, &mut things, share, DOOR_WIDTH, 0.25, Kind::Door { taped });
    }
    let mut rng = stream(seed, StreamPurpose::Posters, number);
    for _ in 0..about(effects.posters * length / 10.0, &mut rng) {
        let (share, width) = (rng.random::<f64>(), rng.random_range(0.4..=1.0));
        let low = rng.random_range(0.9..=1.4);
        let high = low + rng.random_range(0.4..=0.8);
        let colour = [(); 3].map(|()| rng.random_range(0.02..=0.75));
        place(wall, &mut things, share, width, 0.1, Kind::Poster { low, high, colour });
    }
    let mut rng = stream(seed, StreamPurpose::Gaps, number);
    for _ in 0..about(effects.gaps * length / 10.0, &mut rng) {
        let missing = effects.gap_length * rng.random_range(0.2..=1.0);
        let from = wall.span[0] + rng.random::<f64>() * (length - missing).max(0.0);
        let to = from + missing;
        things.push(Thing { kind: Kind::Gap, from: from as f32, to: to as f32 });
    }
    things.sort_by(|one, other| one.from.total_cmp(&other.from));
    things
}

/// Puts a thing on a wall at this share of its length, if there is room between the others.
fn place(
    wall: &BuildingWall,
    things: &mut Vec<Thing>,
    share: f64,
    width: f64,
    apart: f64,
    kind: Kind,
) {
    let room = wall.length() - width - 2.0 * apart;
    if room < 0.0 {
        return;
    }
    let from = (wall.span[0] + apart + share * room) as f32;
    let thing = Thing { kind, from, to: from + width as f32 };
    let apart = apart as f32;
    if things.iter().all(|other| thing.to + apart < other.from || other.to + apart < thing.from) {
        things.push(thing);
    }
}

/// The colour of a poster: a paper border and two fields.
fn poster(colour: [f32; 3], [along, up]: [f32; 2]) -> [f32; 3] {
    let edge = along.min(1.0 - along).min(up.min(1.0 - up));
    if edge < 0.05 {
        [0.75; 3]
    } else if up > 0.65 {
        [colour[2], colour[0], colour[1]]
    } else {
        colour
    }
}

fn rectangle(marker: &LyingMarker) -> Rectangle {
    let along = marker.direction.vector();
    let half = along.map(|along| if along == 0.0 { MARKER[1] } else { MARKER[0] } / 2.0);
    Rectangle::centred(marker.centre_in_plan.into(), half)
}

/// Height of the ceiling, in metres.
pub(crate) const HEIGHT: f32 = CEILING as f32;
