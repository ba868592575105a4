//! Worlds with names, for Python.

use std::path::PathBuf;

use pyo3::{prelude::*, types::PyBytes};
use toposlam_draw::picture::{Placement, WorldPicture, png, side_by_side, svg};
use toposlam_model::{
    aid::{self, Aid, AidKind},
    embedded_graph::{Dart, EmbeddedGraph, GraphError},
    format::{
        dot,
        named_world::NamedWorld,
        plantri,
        world_file::{self, WorldFileErrorKind},
    },
    isomorphism::{Bijection, canonical, code, discovery_order},
};

use crate::error::{error, guarded};

/// A world with names.
#[pyclass(frozen, name = "World", module = "toposlam._core")]
#[derive(Clone)]
pub(crate) struct CoreWorld(pub(crate) NamedWorld);

/// The doors of a world: for each vertex its degree, and for each door, vertex by vertex, the other end of
/// its edge.
type Doors = (Vec<u32>, Vec<u32>);

#[pymethods]
impl CoreWorld {
    /// The worlds of a file: one of a world file, any number of a plantri file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, bytes: &[u8]) -> PyResult<Vec<Self>> {
        let failed = |class, cause: &dyn std::fmt::Display| {
            error(py, class, format!("{}: {cause}", path.display()))
        };
        let worlds = guarded(py, || match plantri::PlantriCode::of_file(&path, bytes) {
            None => {
                let read = world_file::read(bytes);
                Ok(vec![read.map_err(|error| failed(file_error(&error.kind), &error))?])
            }
            Some(code) => {
                let worlds = if bytes.starts_with(b">>") {
                    plantri::read(bytes)
                } else {
                    plantri::read_headerless(bytes, code)
                };
                let graphs = worlds.collect::<Result<Vec<_>, _>>();
                let numbered = |graph| NamedWorld::numbered("", "", graph, None);
                graphs
                    .map(|graphs| graphs.into_iter().map(numbered).collect())
                    .map_err(|error| failed("WorldFileError", &error))
            }
        })?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let named = |mut world: NamedWorld| {
            if world.name.is_empty() {
                world.name.clone_from(&name);
            }
            Self(world)
        };
        Ok(worlds.into_iter().map(named).collect())
    }

    /// A world from its doors. `opposite` is numbered door by door, vertex by vertex.
    #[staticmethod]
    #[pyo3(signature = (degrees, opposite, vertex_names, name, about, start))]
    fn from_doors(
        py: Python<'_>,
        degrees: Vec<u32>,
        opposite: Vec<u32>,
        vertex_names: Vec<String>,
        name: String,
        about: String,
        start: Option<u32>,
    ) -> PyResult<Self> {
        let graph = guarded(py, || Ok(graph_of(&degrees, &opposite)))?
            .map_err(|fault| graph_error(py, fault, &degrees, &vertex_names))?;
        if vertex_names.len() != graph.vertex_count()
            || start.is_some_and(|start| start as usize >= graph.dart_count())
        {
            return Err(error(py, "WorldError", "the names and the start do not fit the doors"));
        }
        let world = NamedWorld::numbered(&name, &about, graph, start.map(Dart));
        Ok(Self(NamedWorld { vertex_names, ..world }))
    }

    /// A world from two permutations, and the number of each dart in it. Errors count darts from `least`.
    #[staticmethod]
    fn from_permutations(
        py: Python<'_>,
        opposite: Vec<u32>,
        clockwise: Vec<u32>,
        least: u32,
    ) -> PyResult<(Self, Vec<u32>)> {
        let made = guarded(py, || Ok(EmbeddedGraph::from_permutations(&opposite, &clockwise)))?;
        let (graph, number) =
            made.map_err(|fault| error(py, fault_class(&fault), fault.counted_from(least)))?;
        let world = NamedWorld::numbered("", "", graph, None);
        Ok((Self(world), number.into_iter().map(|dart| dart.0).collect()))
    }

    /// The same world with another start, name and description.
    #[pyo3(signature = (start, name, about))]
    fn with_start(
        &self,
        py: Python<'_>,
        start: Option<u32>,
        name: &str,
        about: &str,
    ) -> PyResult<Self> {
        let start = start.map(|start| self.dart(py, start)).transpose()?;
        let (name, about) = (name.to_owned(), about.to_owned());
        Ok(Self(NamedWorld { start, name, about, ..self.0.clone() }))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    #[getter]
    fn about(&self) -> &str {
        &self.0.about
    }

    #[getter]
    fn vertex_names(&self) -> Vec<String> {
        self.0.vertex_names.clone()
    }

    #[getter]
    fn start(&self) -> Option<u32> {
        self.0.start.map(|dart| dart.0)
    }

    #[getter]
    fn marker(&self) -> Option<&'static str> {
        self.0.marker.map(AidKind::name)
    }

    #[getter]
    fn doors(&self) -> Doors {
        let graph = &self.0.graph;
        let degrees = graph.vertices().map(|vertex| graph.degree(vertex)).collect();
        (degrees, graph.darts().map(|dart| graph.opposite(dart).0).collect())
    }

    #[getter]
    fn genus(&self) -> usize {
        self.0.graph.genus()
    }

    #[getter]
    fn is_simple(&self) -> bool {
        self.0.graph.is_simple()
    }

    /// A dart from `vertex:facing`.
    fn start_from_text(&self, py: Python<'_>, text: &str) -> PyResult<u32> {
        let start = self.0.start_from_text(text);
        start.map(|dart| dart.0).map_err(|cause| error(py, "UnknownStartError", cause))
    }

    /// The text `vertex:facing` of a dart.
    fn start_text(&self, py: Python<'_>, dart: u32) -> PyResult<String> {
        Ok(self.0.start_text(self.dart(py, dart)?))
    }

    /// The code of the start: equal for isomorphic starts. Without a start, that of the graph.
    fn code(&self) -> Vec<u32> {
        let graph = &self.0.graph;
        let code = match self.0.start {
            Some(start) => code(graph, start),
            None => canonical(graph).code,
        };
        code.words().to_vec()
    }

    /// The least start of the graph, equal exactly for isomorphic graphs.
    fn canonical(&self) -> Self {
        let order = canonical(&self.0.graph).order;
        let least = order.first().copied().unwrap_or(Dart(0));
        Self(NamedWorld::discovered("canonical", "", &self.0.graph, least))
    }

    /// The darts in the order in which a robot with this start meets them: their numbers in a `Start`.
    fn discovery_order(&self, py: Python<'_>, facing: u32) -> PyResult<Vec<u32>> {
        let order = discovery_order(&self.0.graph, self.dart(py, facing)?);
        Ok(order.into_iter().map(|dart| dart.0).collect())
    }

    /// The least dart of each orbit under automorphisms: each start once.
    fn start_darts(&self) -> Vec<u32> {
        let orbit = canonical(&self.0.graph).orbit;
        (0..).zip(orbit).filter(|(dart, least)| *dart == least.0).map(|(dart, _)| dart).collect()
    }

    /// Each automorphism, as the image of each dart; the identity first.
    fn automorphisms(&self) -> Vec<Vec<u32>> {
        let graph = &self.0.graph;
        let orbit = canonical(graph).orbit;
        let images = graph.darts().filter(|image| orbit[image.at()] == orbit[0]).map(|image| {
            let images = Bijection::of_starts((graph, Dart(0)), (graph, image));
            images.images().iter().map(|dart| dart.0).collect()
        });
        images.collect()
    }

    fn mirror_image(&self) -> Self {
        let graph = self.0.graph.mirror_image();
        let world = NamedWorld::numbered(&self.0.name, &self.0.about, graph, self.0.start);
        let vertex_names = self.0.vertex_names.clone();
        Self(NamedWorld { vertex_names, marker: self.0.marker, ..world })
    }

    fn smoothed(&self) -> Self {
        Self(self.0.smoothed())
    }

    fn to_toml(&self) -> String {
        world_file::to_toml(&self.0)
    }

    fn to_json(&self) -> String {
        world_file::to_json_text(&self.0)
    }

    fn to_dot(&self) -> String {
        dot::write(&self.0)
    }

    /// A picture as an SVG document.
    fn svg(&self, py: Python<'_>, title: &str, caption: &str, marker: &str) -> PyResult<String> {
        let kind = named_aid(py, marker)?;
        let placement = Placement::from(&self.0);
        let picture =
            WorldPicture { title, caption, marker: kind, placement, ..WorldPicture::from(&self.0) };
        guarded(py, || Ok(py.detach(|| svg(&picture))))
    }

    /// Several SVG documents in one.
    #[staticmethod]
    fn side_by_side(documents: Vec<String>) -> String {
        side_by_side(&documents)
    }

    /// An SVG document as a PNG image.
    #[staticmethod]
    fn png<'py>(py: Python<'py>, document: &str) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = guarded(py, || Ok(py.detach(|| png(document))))?;
        bytes
            .map(|bytes| PyBytes::new(py, &bytes))
            .map_err(|cause| error(py, "PictureError", cause))
    }
}

impl CoreWorld {
    /// A dart of the world.
    pub(crate) fn dart(&self, py: Python<'_>, dart: u32) -> PyResult<Dart> {
        if (dart as usize) < self.0.graph.dart_count() {
            return Ok(Dart(dart));
        }
        Err(error(py, "UnknownStartError", format!("the world has no dart {dart}")))
    }
}

/// Whether a text can be the name of a vertex in a world file.
#[pyfunction]
pub(crate) fn is_name(text: &str) -> bool {
    world_file::is_name(text)
}

/// The marking aid with this name.
pub(crate) fn named_aid(py: Python<'_>, name: &str) -> PyResult<AidKind> {
    aid::named(name).map_err(|unknown| error(py, "UnknownMarkerError", unknown))
}

/// Checks that an aid can be seen everywhere in a graph. Otherwise a run or a comparison is no evidence.
pub(crate) fn check_seen(py: Python<'_>, aid: impl Aid, graph: &EmbeddedGraph) -> PyResult<()> {
    if aid.is_seen_everywhere(graph) {
        return Ok(());
    }
    let (name, place) = (aid.name(), aid.unseen_place());
    let text = format!("the world has {place}, the most for {name}");
    Err(error(py, "SizeError", text))
}

/// The graph of doors: degrees, and for each door, vertex by vertex, the other end of its edge.
pub(crate) fn graph_of(degrees: &[u32], opposite: &[u32]) -> Result<EmbeddedGraph, GraphError> {
    let doors = degrees.iter().map(|&degree| u64::from(degree)).sum::<u64>();
    if doors != opposite.len() as u64 {
        let clockwise = usize::try_from(doors).unwrap_or(usize::MAX);
        return Err(GraphError::LengthsDiffer { opposite: opposite.len(), clockwise });
    }
    let mut clockwise = Vec::with_capacity(opposite.len());
    for &degree in degrees {
        let first = clockwise.len() as u32;
        clockwise.extend((0..degree).map(|index| first + (index + 1) % degree));
    }
    EmbeddedGraph::from_permutations(opposite, &clockwise).map(|(graph, _)| graph)
}

/// The error for doors that are not a graph, in the names of its vertices.
fn graph_error(py: Python<'_>, fault: GraphError, degrees: &[u32], names: &[String]) -> PyErr {
    let name = |dart: u32| {
        let mut end = 0_u64;
        let ends = degrees.iter().map(|&degree| {
            end += u64::from(degree);
            end
        });
        let vertex = ends.into_iter().position(|end| u64::from(dart) < end);
        vertex.and_then(|vertex| names.get(vertex)).map_or("?", String::as_str)
    };
    let text = match fault {
        GraphError::NotConnected { dart } => format!(
            "the world is not connected: vertex {} cannot be reached from {}",
            name(dart),
            name(0)
        ),
        other => other.to_string(),
    };
    error(py, fault_class(&fault), text)
}

/// The class of the error for two arrays that are not a graph.
fn fault_class(fault: &GraphError) -> &'static str {
    match fault {
        GraphError::NoEdge => "NoEdgeError",
        GraphError::NotConnected { .. } => "NotConnectedError",
        GraphError::TooManyEdges => "SizeError",
        GraphError::LengthsDiffer { .. }
        | GraphError::OppositeOutOfRange { .. }
        | GraphError::OppositeFixed { .. }
        | GraphError::OppositeNotMutual { .. }
        | GraphError::ClockwiseOutOfRange { .. }
        | GraphError::ClockwiseRepeated { .. } => "PermutationError",
    }
}

/// The class of the error for a world file.
fn file_error(kind: &WorldFileErrorKind) -> &'static str {
    use toposlam_model::embedded_graph::ListError;
    match kind {
        WorldFileErrorKind::Lists(
            ListError::UnknownNeighbour { .. }
            | ListError::OneSided { .. }
            | ListError::NotTwoEnds { .. },
        ) => "MissingEdgeError",
        WorldFileErrorKind::Lists(ListError::NotConnected { .. }) => "NotConnectedError",
        _ => "WorldFileError",
    }
}
