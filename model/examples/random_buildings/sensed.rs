//! Random buildings with lengths and directions, and the moves of the folding explorer with these senses. Each map is judged by
//! a bijection.

use toposlam_model::{
    aid::compass::Directions,
    check::judge,
    embedded_graph::{Dart, EmbeddedGraph},
    floor_plan::Direction,
    folding::{ArrivalSenses, LengthInterval},
    isomorphism::Candidate,
    mapping::{Explorer, FoldingRun, explore},
    world::{GraphWorld, SensingWorld},
};

use super::buildings::{Building, Random, buildings_on_grid};

/// How long hallways are: from 3 m to 30 m in steps of 0.5 m, all with equal probability.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Lengths {
    /// The length of each hallway is drawn.
    OfHallways,
    /// The distance between each two neighbouring lines of the grid is drawn.
    OfGrid,
}

/// In thousandths, how wrong a measured length may be. All errors have equal probability.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LengthError {
    /// Each traversal has another error.
    EachTime(u32),
    /// A hallway is always measured with the same error.
    EachHallway(u32),
}

/// What a robot senses besides its percepts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Senses {
    pub(crate) lengths: Option<LengthError>,
    pub(crate) compass: bool,
}

/// A building with the length of the hallway of each dart, in millimetres, and the directions of the darts.
pub(crate) struct MeasuredBuilding {
    pub(crate) graph: EmbeddedGraph,
    lengths: Vec<u32>,
    directions: Directions,
}

/// The buildings of seed 7 with at most so many junctions. The lengths in the first are those of seed 0, and so on.
pub(crate) fn measured_buildings(
    junctions: usize,
    more_hallways: usize,
    lengths: Lengths,
) -> Vec<MeasuredBuilding> {
    let buildings = buildings_on_grid(junctions, more_hallways).into_iter().zip(0..);
    buildings.map(|(building, seed)| measured(building, lengths, &mut Random(seed))).collect()
}

fn measured((graph, places): Building, lengths: Lengths, random: &mut Random) -> MeasuredBuilding {
    let mut draw = || 3000 + 500 * random.below(55) as u32;
    let lines: Vec<[u32; 2]> = places.iter().map(|_| [draw(), draw()]).collect();
    let place = |dart: Dart| places[graph.vertex(dart).at()];
    let ends = |dart: Dart| [place(dart), place(graph.opposite(dart))];
    let mut length = vec![0; graph.dart_count()];
    for (one, other) in graph.edges() {
        let [[x, y], [to_x, to_y]] = ends(one);
        let drawn = match lengths {
            Lengths::OfHallways => draw(),
            Lengths::OfGrid if x == to_x => lines[y.min(to_y)][1],
            Lengths::OfGrid => lines[x.min(to_x)][0],
        };
        (length[one.at()], length[other.at()]) = (drawn, drawn);
    }
    // Rows are counted to the south.
    let position = |[x, y]: [usize; 2]| [x as f64, -(y as f64)];
    let directions = graph.darts().map(|dart| {
        let [from, to] = ends(dart).map(position);
        Direction::between(from, to).unwrap()
    });
    let directions = Directions::new(&graph, directions.collect()).unwrap();
    MeasuredBuilding { graph, lengths: length, directions }
}

/// The moves of the folding explorer. The errors are those of one seed.
pub(crate) fn moves_with(senses: Senses, building: &MeasuredBuilding) -> u64 {
    let MeasuredBuilding { graph, lengths, directions } = building;
    let mut random = Random(1);
    let mut measure = |dart: Dart, error: u32| {
        let (length, error) = (u64::from(lengths[dart.at()]), u64::from(error));
        let least = (length * (1000 - error)).div_ceil(1000);
        let greatest = length * (1000 + error) / 1000;
        (least + random.below((greatest - least + 1) as usize) as u64) as u32
    };
    let mut always = vec![0; graph.dart_count()];
    if let Some(LengthError::EachHallway(error)) = senses.lengths {
        for (one, other) in graph.edges() {
            let measured = measure(one, error);
            (always[one.at()], always[other.at()]) = (measured, measured);
        }
    }
    let sense = |world: &GraphWorld<'_>| {
        let pose = world.pose();
        ArrivalSenses {
            length: senses.lengths.map(|error| match error {
                LengthError::EachTime(error) => {
                    LengthInterval::measured(measure(pose, error), error)
                }
                LengthError::EachHallway(error) => {
                    LengthInterval::measured(always[pose.at()], error)
                }
            }),
            compass: senses.compass.then(|| directions.view(graph, pose)),
        }
    };
    let mut explorer = FoldingRun::default();
    let bound = explorer.move_bound(graph.edge_count(), graph.vertex_count());
    let world = GraphWorld::new(graph, Dart(0)).with_bound(bound);
    let mut world = SensingWorld::new(world, sense);
    explore(&mut explorer, &mut world).unwrap();
    judge(&explorer, Dart(0), world.world(), &mut Candidate::default()).unwrap();
    explorer.moves()
}
