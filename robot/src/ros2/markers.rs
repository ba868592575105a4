//! A map as RViz and Foxglove draw it: `visualization_msgs/msg/MarkerArray`. Spheres are vertices where the robot was, with
//! their numbers; lines are edges.

use serde::Serialize;
use toposlam_logs::{
    messages::Stamp,
    record::MapRecord,
    standard::{CompressedImage, FileBytes, Header, ODOM, PoseMessage, Quaternion, Vector3},
};
use toposlam_model::{embedded_graph::Dart, percept::Door};

use super::messages::write;

pub(super) const MARKERS: &str = "/toposlam/markers";
pub(super) const MARKERS_TYPE: &str = "visualization_msgs/msg/MarkerArray";

/// A visit of a junction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct VisitedPlace {
    /// The door by which the robot left the junction before; `None` at the start.
    pub(super) door: Option<Door>,
    pub(super) degree: u32,
    /// Where the robot was, by odometry.
    pub(super) position: [f64; 2],
}

/// The darts of a map by vertex.
struct VertexDarts {
    /// The first dart of each vertex,
    first: Vec<u32>,
    /// and the vertex of each dart.
    vertex: Vec<usize>,
}

impl VertexDarts {
    fn new(map: &MapRecord) -> Self {
        let (mut first, mut vertex) = (Vec::new(), Vec::new());
        for (number, &degree) in map.degrees.iter().enumerate() {
            first.push(vertex.len() as u32);
            vertex.extend((0..degree).map(|_| number));
        }
        Self { first, vertex }
    }

    fn vertex(&self, Dart(dart): Dart) -> Option<usize> {
        self.vertex.get(dart as usize).copied()
    }
}

/// Where each vertex is: where the robot was at its last visit. The robot's walk is followed backwards, as far as it agrees
/// with the map.
fn positions(
    map: &MapRecord,
    darts: &VertexDarts,
    visits: &[VisitedPlace],
) -> Vec<Option<[f64; 2]>> {
    let mut found = vec![None; map.degrees.len()];
    let mut entry = map.robot;
    for visit in visits.iter().rev() {
        let Some(vertex) = darts.vertex(entry) else { break };
        if map.degrees[vertex] != visit.degree {
            break;
        }
        found[vertex].get_or_insert(visit.position);
        // The robot came from the other end of this edge, by a door that is counted from where it had come in.
        let exit = map.opposite.get(entry.0 as usize).copied().flatten();
        let (Some(door), Some(exit)) = (visit.door, exit) else { break };
        let Some(before) = darts.vertex(exit) else { break };
        let (first, degree) = (darts.first[before], map.degrees[before]);
        let index = (exit.0 - first + degree - door.0 % degree) % degree;
        entry = Dart(first + index);
    }
    found
}

/// The message of a map, whose vertices are where the robot was at its visits.
pub(super) fn markers(map: &MapRecord, visits: &[VisitedPlace]) -> Vec<u8> {
    let darts = VertexDarts::new(map);
    let places = positions(map, &darts, visits);
    let place = |[x, y]: [f64; 2], z| Vector3 { x, y, z };
    let mut shown = vec![Marker { action: DELETE_ALL, ..Marker::new("", 0, SPHERES, 0.0, GREY) }];
    let seen = || (0_i32..).zip(&places).filter_map(|(number, at)| Some((number, (*at)?)));
    let mut spheres = Marker::new("vertices", 0, SPHERES, 0.3, BLUE);
    spheres.points.extend(seen().map(|(_, at)| place(at, 0.0)));
    let mut lines = Marker::new("edges", 0, LINES, 0.05, GREY);
    for (dart, far) in map.opposite.iter().enumerate() {
        let ends = far.filter(|far| dart < far.0 as usize).and_then(|far| {
            let near = places[darts.vertex(Dart(dart as u32))?]?;
            Some([near, places[darts.vertex(far)?]?])
        });
        lines.points.extend(ends.into_iter().flatten().map(|at| place(at, 0.0)));
    }
    // RViz reports a marker without points as faulty.
    shown.extend([spheres, lines].into_iter().filter(|marker| !marker.points.is_empty()));
    shown.extend(seen().map(|(number, at)| {
        let mut text = Marker::new("numbers", number, TEXT, 0.3, WHITE);
        text.pose.position = place(at, 0.4);
        text.text = number.to_string();
        text
    }));
    write(&shown)
}

/// Types of markers,
const LINES: i32 = 5;
const SPHERES: i32 = 7;
const TEXT: i32 = 9;
/// and an action.
const DELETE_ALL: i32 = 3;

type Colour = [f32; 4];

const BLUE: Colour = [0.2, 0.5, 1.0, 1.0];
const GREY: Colour = [0.6, 0.6, 0.6, 1.0];
const WHITE: Colour = [1.0, 1.0, 1.0, 1.0];

/// `visualization_msgs/msg/Marker` since Humble.
#[derive(Serialize)]
struct Marker {
    header: Header,
    ns: &'static str,
    id: i32,
    kind: i32,
    action: i32,
    pose: PoseMessage,
    scale: Vector3,
    color: Colour,
    lifetime: Stamp,
    frame_locked: bool,
    points: Vec<Vector3>,
    colors: Vec<Colour>,
    texture_resource: &'static str,
    texture: CompressedImage<FileBytes<'static>>,
    uv_coordinates: Vec<[f32; 2]>,
    text: String,
    mesh_resource: &'static str,
    mesh_file_name: &'static str,
    mesh_file: FileBytes<'static>,
    mesh_use_embedded_materials: bool,
}

impl Marker {
    /// One of a type, without content, in the frame of odometry at any time.
    fn new(ns: &'static str, id: i32, kind: i32, size: f64, color: Colour) -> Self {
        let origin = Vector3::default();
        let anytime = Stamp::default();
        Self {
            header: Header { stamp: anytime, frame_id: ODOM },
            ns,
            id,
            kind,
            action: 0,
            pose: PoseMessage { position: origin, orientation: Quaternion::turn(0.0) },
            scale: Vector3 { x: size, y: size, z: size },
            color,
            lifetime: Stamp::default(),
            frame_locked: false,
            points: Vec::new(),
            colors: Vec::new(),
            texture_resource: "",
            texture: CompressedImage {
                header: Header { stamp: anytime, frame_id: "" },
                format: "",
                data: FileBytes(&[]),
            },
            uv_coordinates: Vec::new(),
            text: String::new(),
            mesh_resource: "",
            mesh_file_name: "",
            mesh_file: FileBytes(&[]),
            mesh_use_embedded_materials: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A junction of three hallways, vertex 0, and their ends. The robot started at the end of the first one, went to that of
    /// the second, and then to that of the third.
    fn star() -> (MapRecord, Vec<VisitedPlace>) {
        let opposite = [3, 4, 5, 0, 1, 2].map(|dart| Some(Dart(dart))).to_vec();
        let map = MapRecord { moves: 4, degrees: vec![3, 1, 1, 1], opposite, robot: Dart(5) };
        let visit = |door: Option<u32>, degree, x| VisitedPlace {
            door: door.map(Door),
            degree,
            position: [x, 0.0],
        };
        let end = |x| visit(Some(1), 1, x);
        let junction = |x| visit(Some(0), 3, x);
        (map, vec![visit(None, 1, 0.0), junction(1.0), end(2.0), junction(3.0), end(4.0)])
    }

    #[test]
    fn a_vertex_is_where_the_robot_was_at_its_last_visit() {
        let (map, visits) = star();
        let darts = VertexDarts::new(&map);
        let expected = [3.0, 0.0, 2.0, 4.0].map(|x| Some([x, 0.0]));
        assert_eq!(positions(&map, &darts, &visits), expected);
    }

    #[test]
    fn visits_that_do_not_agree_with_the_map_are_left_out() {
        let (map, mut visits) = star();
        let darts = VertexDarts::new(&map);
        visits[2].degree = 2;
        let expected = [Some([3.0, 0.0]), None, None, Some([4.0, 0.0])];
        assert_eq!(positions(&map, &darts, &visits), expected);
        let lost = MapRecord { robot: Dart(99), ..map };
        assert_eq!(positions(&lost, &darts, &visits), [None; 4]);
        assert!(!markers(&lost, &visits).is_empty());
    }
}
