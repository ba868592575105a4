//! The report of a robot's run, simulated or live. Section 6.

use std::io::{self, Write};

use serde::Serialize;
use toposlam_model::{
    embedded_graph::{Dart, EmbeddedGraph},
    format::named_world::NamedWorld,
    mapping::{FACING, MapWalk, MappedWorld, MappingError, MappingMethod},
};
use toposlam_robot::explorer::ExplorerError;

use super::{
    CliError, Outcome,
    certificate_cost::CertificateCost,
    json::print_line,
    text::{counted, grouped, print_hanging, print_paragraph, sentence, tenths, vertices},
};

/// A run that has ended.
#[derive(Clone, Copy)]
pub(super) struct RobotRun<'a> {
    pub(super) method: MappingMethod,
    pub(super) mapping: &'a MapWalk,
    /// `None` if it ended early, for the reason in `error`.
    pub(super) mapped: Option<&'a MappedWorld>,
    pub(super) error: Option<&'a MappingError<ExplorerError>>,
    /// The moves, with those of recoveries and audits.
    pub(super) moves: u64,
    /// The duration by the robot's clock.
    pub(super) seconds: f64,
    pub(super) frames: u64,
    pub(super) frame_kind: &'static str,
}

impl RobotRun<'_> {
    /// The doors of the map whose hallways are blocked.
    pub(super) fn blocked(&self) -> &[Dart] {
        self.mapped.map_or(&[], |mapped| &mapped.blocked)
    }

    /// The map as a world, if it is complete and the run did not end before its last check.
    // paper: exp.maps
    pub(super) fn map(&self, name: &str, about: &str) -> Option<NamedWorld> {
        self.mapped?;
        let graph = self.mapping.map().complete()?.clone();
        let about = format!("{about} in {}", counted(self.moves as usize, "move"));
        Some(NamedWorld::numbered(name, &about, graph, Some(FACING)))
    }

    /// The certificate of a world. The moves are compared with it if the whole map is right.
    pub(super) fn certificate(
        &self,
        graph: &EmbeddedGraph,
        facing: Dart,
        is_right: bool,
    ) -> CertificateCost {
        let whole = self.mapped.filter(|mapped| is_right && mapped.blocked.is_empty());
        CertificateCost::new(graph, facing, whole.map(|mapped| mapped.moves - mapped.audit_moves))
    }

    /// How it ended, in words for a map that is whole, and for one without what is behind blocked doors.
    pub(super) fn ending(&self, whole: &str, but_for_blocked: &str) -> String {
        let moves = counted(self.moves as usize, "move");
        match self.error {
            Some(MappingError::World(error @ ExplorerError::Budget { .. })) => error.to_string(),
            Some(error) => format!("the robot gave up: {error}"),
            None if self.blocked().is_empty() => format!("the map is {whole}, after {moves}"),
            None => {
                let doors = counted(self.blocked().len(), "blocked door");
                format!("the map is {but_for_blocked} but for {doors}, after {moves}")
            }
        }
    }

    /// The outcome, if the map is right.
    pub(super) fn outcome(&self, allows_blocked: bool) -> Outcome {
        use ExplorerError::{Budget, Stopped};
        match self.error {
            Some(
                MappingError::Bound { .. } | MappingError::World(Stopped { .. } | Budget { .. }),
            ) => Outcome::Incomplete,
            Some(_) => Outcome::Violated,
            None if allows_blocked || self.blocked().is_empty() => Outcome::Holds,
            None => Outcome::Incomplete,
        }
    }

    /// The number of vertices of the map, and of edges whose both ends are known.
    pub(super) fn known(&self) -> [usize; 2] {
        let map = self.mapping.map();
        [map.vertex_count(), (map.dart_count() - map.unexplored_count() as usize) / 2]
    }
}

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct RunReport {
    #[serde(flatten)]
    robot: RobotReport,
    moves: u64,
    certificate: Option<CertificateCost>,
    /// `null` if the run ended early, as `recoveries` and `blocked`.
    audit_moves: Option<u64>,
    recoveries: Option<u32>,
    /// The doors of the map whose hallways are blocked, as `v2.1`.
    blocked: Option<Vec<String>>,
    error: Option<String>,
    frames: u64,
}

/// What is reported of one kind of robot only.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum RobotReport {
    Simulated {
        plan: String,
        start: String,
        seed: u64,
        algorithm: &'static str,
        edges: usize,
        explore_moves: u64,
        isomorphic: bool,
        pose_true: bool,
        conforms: bool,
        divergence: Option<String>,
        /// The number of moves before the divergence.
        divergence_move: Option<usize>,
        faults_missed: Vec<String>,
        simulated_seconds: f64,
        /// Of the off-line version on the same frames.
        compute_seconds: f64,
    },
    #[cfg_attr(
        not(any(feature = "ros1", feature = "ros2")),
        allow(dead_code, reason = "there is no robot to drive")
    )]
    Live { ending: &'static str, vertices: usize, edges: usize, seconds: f64 },
}

impl RunReport {
    pub(super) fn new(
        run: &RobotRun,
        certificate: Option<CertificateCost>,
        robot: RobotReport,
    ) -> Self {
        let map = run.mapping.map();
        let door = |&dart: &Dart| format!("v{}.{}", map.vertex(dart).0, map.index(dart));
        Self {
            robot,
            moves: run.moves,
            certificate,
            audit_moves: run.mapped.map(|mapped| mapped.audit_moves),
            recoveries: run.mapped.map(|mapped| mapped.recoveries),
            blocked: run.mapped.map(|mapped| mapped.blocked.iter().map(door).collect()),
            error: run.error.map(ToString::to_string),
            frames: run.frames,
        }
    }

    pub(super) fn print_json(&self, out: &mut dyn Write) -> Result<(), CliError> {
        print_line(out, "run", self)
    }

    /// Prints it after the sentences on how the run ended.
    // paper: exp.multiplicative
    pub(super) fn print(
        &self,
        out: &mut dyn Write,
        run: &RobotRun,
        ending: &[String],
    ) -> Result<(), CliError> {
        writeln!(out)?;
        for text in ending {
            print_paragraph(out, &sentence(text))?;
        }
        let mut moves = grouped(self.moves.into());
        if let RobotReport::Simulated { explore_moves, .. } = self.robot {
            let expected = grouped(explore_moves.into());
            moves.extend([" (", &expected, " in the plan's embedded graph)"]);
        }
        row(out, "moves", &moves)?;
        if let Some(certificate) = &self.certificate {
            certificate.print("  certificate       ", out)?;
        }
        if let Some(moves) = self.audit_moves.filter(|_| run.method.audits() > 0) {
            let moves = grouped(moves.into());
            row(
                out,
                "of them audits",
                &format!("{moves}, and each percept is as the map predicts"),
            )?;
        }
        if let Some(recoveries) = self.recoveries.filter(|_| run.method.recovers()) {
            row(out, "recoveries", &recoveries.to_string())?;
        }
        if let Some(blocked) = self.blocked.as_ref().filter(|blocked| !blocked.is_empty()) {
            row(out, "blocked doors", &blocked.join(", "))?;
        }
        if let RobotReport::Simulated { edges, .. } = self.robot {
            row(out, "edges", &grouped(edges as u128))?;
        }
        let [known_vertices, edges] = run.known();
        row(out, "map", &format!("{}, {}", vertices(known_vertices), counted(edges, "edge")))?;
        row(out, run.frame_kind, &grouped(self.frames.into()))?;
        let minutes = format!("{} minutes", tenths(run.seconds / 60.0));
        match self.robot {
            RobotReport::Live { .. } => row(out, "robot time", &minutes)?,
            RobotReport::Simulated { compute_seconds, .. } => {
                row(out, "simulated time", &minutes)?;
                // From scenes there is almost nothing to compute.
                if run.error.is_none() && run.frame_kind != "scenes" {
                    let ratio = grouped((run.seconds / compute_seconds).round() as u128);
                    let text = format!("{compute_seconds:.2} s off-line, {ratio} times real time");
                    row(out, "computation", &text)?;
                }
            }
        }
        Ok(())
    }
}

fn row(out: &mut dyn Write, label: &str, text: &str) -> io::Result<()> {
    print_hanging(out, &format!("  {label:<18}"), text)
}
