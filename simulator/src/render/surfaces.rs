//! The surface that a ray meets in a building, and its colour there.

use crate::render::{
    building::{Building, HEIGHT, WallPart},
    furniture::{BlocksAround, MetBlock},
    looks::FloorCovering,
    random_stream::{clouds, floor, speckle},
    rig::WorldRay,
    sight_lines::SightLines,
};

/// Light on the ceiling, as a share of that on the floor.
const CEILING_LIGHT: f32 = 0.6;

/// Width of a lamp's blurred edge, in metres.
const LAMP_EDGE: f32 = 0.02;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Surface {
    Floor,
    Tape,
    Marker,
    Cable,
    Wall(u32, WallPart),
    /// A face of a piece of furniture.
    Furniture(u32),
    /// Dark furniture just inside of the rim.
    Overhead(u32),
    Ceiling,
    Lamp,
    Robot(crate::render::body::RobotPart),
    Holder,
    /// Nothing: the ray leaves the building.
    Nothing,
}

impl Surface {
    /// A number that is different for different surfaces.
    #[inline]
    pub(crate) fn number(self) -> u32 {
        match self {
            Self::Floor => 0,
            Self::Tape => 1,
            Self::Marker => 2,
            Self::Ceiling => 3,
            Self::Lamp => 4,
            Self::Holder => 5,
            Self::Nothing => 6,
            Self::Cable => 7,
            Self::Robot(part) => 8 + part as u32,
            Self::Wall(wall, part) => {
                let part = match part {
                    WallPart::Bare => 0,
                    WallPart::Baseboard => 1,
                    WallPart::Leaf => 2,
                    WallPart::Frame => 3,
                    // Neighbouring posters have different numbers.
                    WallPart::Poster(number) => 4 + number % 4,
                };
                16 + 8 * wall + part
            }
            Self::Furniture(face) => 1 << 31 | face,
            Self::Overhead(piece) => 1 << 30 | piece,
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum RayEnd {
    Floor { place: [f32; 2] },
    Wall { wall: u32, along: f32, height: f32 },
    Ceiling { place: [f32; 2] },
    Nothing,
}

/// Size of a pixel on the floor, along the ray seen from above and across it, in metres.
pub(crate) type Footprint = [f32; 2];

/// A building, and the sight lines and the furniture from one place in it.
pub(crate) struct BuildingView<'a> {
    pub(crate) building: &'a Building,
    pub(crate) lines: SightLines,
    pub(crate) blocks: BlocksAround<'a>,
}

impl BuildingView<'_> {
    /// The length of a ray up to the first wall, the wall's index, and the place along the wall.
    #[inline]
    fn wall(&self, ray: &WorldRay) -> Option<(f32, u32, f32)> {
        let mut nearest = (f32::INFINITY, u32::MAX, 0.0);
        for &number in self.lines.walls(ray.turn) {
            let face = &self.building.faces[number as usize];
            let across = 1 - face.along;
            let length = (face.plane - ray.origin[across]) / ray.direction[across];
            if length > 0.0 && length < nearest.0 {
                let along = ray.origin[face.along] + length * ray.direction[face.along];
                // The tolerance keeps rounding from opening gaps at corners.
                if face.span[0] - 1e-4 <= along && along <= face.span[1] + 1e-4 {
                    nearest = (length, number, along);
                }
            }
        }
        (nearest.1 != u32::MAX).then_some(nearest)
    }

    /// The end of a ray, given the first wall on its way.
    #[inline]
    fn end(ray: &WorldRay, wall: Option<(f32, u32, f32)>) -> RayEnd {
        let (origin, direction) = (ray.origin, ray.direction);
        let level = if direction[2] < 0.0 { 0.0 } else { HEIGHT };
        let length = (level - origin[2]) / direction[2];
        match wall {
            Some((before, wall, along)) if before <= length || direction[2] == 0.0 => {
                RayEnd::Wall { wall, along, height: origin[2] + before * direction[2] }
            }
            _ if direction[2] == 0.0 => RayEnd::Nothing,
            _ => {
                let place = ray.place(length);
                if direction[2] < 0.0 { RayEnd::Floor { place } } else { RayEnd::Ceiling { place } }
            }
        }
    }

    /// The furniture that a ray meets before the first wall on its way.
    #[inline]
    fn furniture(&self, ray: &WorldRay, wall: Option<(f32, u32, f32)>) -> Option<MetBlock> {
        let block = self.blocks.first(ray)?;
        wall.is_none_or(|(length, ..)| block.length < length).then_some(block)
    }

    /// The light that comes back from a block.
    fn block_light(&self, block: &MetBlock) -> [f32; 3] {
        let light = self.building.light.on_floor(block.place);
        block.colour.map(|channel| channel * light)
    }

    /// The surface at the end of a ray, and the light that comes back along the ray.
    #[inline]
    pub(crate) fn seen(
        &self,
        ray: &WorldRay,
        footprint: impl Fn() -> Footprint,
    ) -> (Surface, [f32; 3]) {
        let wall = self.wall(ray);
        if let Some(block) = self.furniture(ray, wall) {
            return (Surface::Furniture(block.face), self.block_light(&block));
        }
        match Self::end(ray, wall) {
            RayEnd::Floor { place } => {
                let surface = self.on_floor(place);
                let mut colour = match surface {
                    Surface::Cable => self.building.cables.at(place).unwrap_or_default(),
                    Surface::Marker => self.building.colours.marker,
                    Surface::Tape => self.building.scuffed(place),
                    _ => self.floor_colour(place, ray, footprint),
                };
                let light = self.building.light.on_floor(place);
                colour = colour.map(|channel| channel * light);
                if self.building.gloss > 0.0 {
                    self.add_reflection(ray, wall, &mut colour);
                }
                (surface, colour)
            }
            RayEnd::Wall { wall, along, height } => self.on_wall(wall, along, height),
            RayEnd::Ceiling { place } => self.on_ceiling(place, LAMP_EDGE),
            RayEnd::Nothing => (Surface::Nothing, [0.2; 3]),
        }
    }

    #[inline]
    fn on_floor(&self, place: [f32; 2]) -> Surface {
        if self.building.cables.at(place).is_some() {
            return Surface::Cable;
        }
        if self.building.marker.is_some_and(|marker| marker.holds(place.map(f64::from))) {
            return Surface::Marker;
        }
        if self.building.tape_at(place) { Surface::Tape } else { Surface::Floor }
    }

    fn floor_colour(
        &self,
        place: [f32; 2],
        ray: &WorldRay,
        footprint: impl Fn() -> Footprint,
    ) -> [f32; 3] {
        let building = self.building;
        let strength = building.texture;
        if strength == 0.0 {
            return building.colours.floor;
        }
        let shade = match building.look.floor {
            FloorCovering::Plain => 1.0,
            FloorCovering::Tiled { sides, joint, joint_shade } => {
                let [radial, across] = footprint();
                let [x, y] = [ray.direction[0].abs(), ray.direction[1].abs()];
                let level = (x * x + y * y).sqrt().max(1e-6);
                let (cosine, sine) = (x / level, y / level);
                let size = [radial * cosine + across * sine, radial * sine + across * cosine];
                let (sides, joint) = (sides.map(|side| side as f32), joint as f32);
                let open = [0, 1].map(|axis| {
                    1.0 - joint_share(place[axis], size[axis].max(1e-4), sides[axis], joint)
                });
                let tile = speckle(floor(place[0] / sides[0]), floor(place[1] / sides[1]), 5);
                let joints = 1.0 - open[0] * open[1];
                let faint = (sides[0].min(sides[1]) / size[0].max(size[1])).min(1.0);
                (1.0 + 0.03 * strength * tile * faint)
                    * (1.0 + joints * strength * (joint_shade as f32 - 1.0))
            }
            FloorCovering::Carpet { tuft, spread } => {
                let [radial, across] = footprint();
                let (tuft, spread) = (tuft as f32, spread as f32 * strength);
                // A pixel with many tufts shows their mean.
                let faint = (tuft / radial.max(tuft)) * (tuft / across.max(tuft)).sqrt();
                let [x, y] = place.map(|at| floor(at / tuft));
                1.0 + spread * faint * speckle(x, y, 9)
            }
        };
        let worn = 1.0 + 0.05 * strength * clouds(place[0] * 1.7, place[1] * 1.7, 3);
        building.colours.floor.map(|channel| channel * (shade * worn).max(0.0))
    }

    fn on_wall(&self, wall: u32, along: f32, height: f32) -> (Surface, [f32; 3]) {
        let building = self.building;
        let part = building.wall_part(&building.faces[wall as usize], along, height);
        let light = building.light.on_wall(wall as usize, along, height);
        let colour = building.wall_colour(part, along, height);
        (Surface::Wall(wall, part), colour.map(|channel| channel * light))
    }

    /// The surface at a place of the ceiling, and its light. Lamps have blurred edges of this
    /// width, in metres.
    #[inline]
    fn on_ceiling(&self, place: [f32; 2], blurred: f32) -> (Surface, [f32; 3]) {
        let ceiling = self.building.colours.ceiling.map(|channel| channel * CEILING_LIGHT);
        for lamp in self.building.lamps.at(place) {
            let [x, y] = [0, 1].map(|axis| {
                let inside = lamp.half[axis] - (place[axis] - lamp.middle[axis]).abs();
                (0.5 + inside / blurred).clamp(0.0, 1.0)
            });
            if x * y > 0.0 {
                let light = ceiling.map(|channel| channel + x * y * (lamp.brightness - channel));
                return (if x.min(y) >= 0.5 { Surface::Lamp } else { Surface::Ceiling }, light);
            }
        }
        (Surface::Ceiling, ceiling)
    }

    /// The light of the furniture that a ray meets after its reflection on the floor.
    fn reflected_furniture(
        &self,
        ray: &WorldRay,
        wall: Option<(f32, u32, f32)>,
    ) -> Option<[f32; 3]> {
        let [along, left, down] = ray.direction;
        let length = -ray.origin[2] / down;
        let [x, y] = ray.place(length);
        let (origin, direction) = ([x, y, 0.0], [along, left, -down]);
        let reflected = WorldRay { origin, direction, turn: ray.turn };
        let wall = wall.map(|(before, number, along)| (before - length, number, along));
        self.furniture(&reflected, wall).map(|block| self.block_light(&block))
    }

    /// Adds the reflection on the floor: the ray continues below it in the mirrored building.
    fn add_reflection(&self, ray: &WorldRay, wall: Option<(f32, u32, f32)>, colour: &mut [f32; 3]) {
        let gloss = self.building.gloss;
        let down = -ray.direction[2];
        let graze = 1.0 - down;
        let square = graze * graze;
        // Schlick's approximation of the Fresnel reflectance, for a surface that is not quite
        // smooth.
        let share = gloss * (0.04 + 0.6 * square * square * graze);
        let above = HEIGHT + ray.origin[2];
        let up = above / down;
        let mirrored = match (self.reflected_furniture(ray, wall), wall) {
            (Some(light), _) => light,
            (None, Some((length, wall, along))) if length < up => {
                self.on_wall(wall, along, length * down - ray.origin[2]).1
            }
            (None, _) => self.on_ceiling(ray.place(up), 0.1 + 0.6 * (1.0 - gloss).max(0.0)).1,
        };
        for (channel, mirrored) in colour.iter_mut().zip(mirrored) {
            *channel += share * mirrored;
        }
    }
}

fn joint_share(at: f32, size: f32, side: f32, joint: f32) -> f32 {
    // The length of joint between 0 and a place.
    let before = |at: f32| {
        let tiles = floor(at / side) as f32;
        tiles * joint + (at - tiles * side).min(joint)
    };
    (before(at + size / 2.0) - before(at - size / 2.0)) / size
}
