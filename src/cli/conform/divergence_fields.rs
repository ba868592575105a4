//! The first divergence, what is allowed instead, and a shorter log, as fields of the JSON line of a log.

use serde::Serialize;
use toposlam_conform::{CheckedEvent, CheckedKind, DivergenceCause};
use toposlam_model::{
    percept::Sighting,
    trace::{AllowedStep, MisfitReason},
};

use super::{JudgedLog, LISTED};

/// The first event that is not allowed.
#[derive(Serialize)]
pub(super) struct DivergenceFields {
    /// The event; `None` if one is missing at the end.
    found: Option<EventFields>,
    /// The first of what is allowed instead.
    allowed: Vec<AllowedFields>,
    /// The number of all that is allowed instead.
    allowed_total: usize,
    /// The expected number of moves, edge ends or doors.
    expected: Option<u64>,
    /// The recorded one.
    recorded: Option<u64>,
    /// The angle by which the robot missed a door, in radians.
    off: Option<f64>,
    /// The numbers of the events between which a measurement contradicts earlier ones.
    between: Option<[usize; 2]>,
    /// The numbers of the events between which those were made.
    earlier: Option<[usize; 2]>,
}

/// An event.
#[derive(Serialize)]
pub(super) struct EventFields {
    what: &'static str,
    #[serde(flatten)]
    step: StepFields,
}

/// What is perceived, or the door that is taken.
#[derive(Default, Serialize)]
struct StepFields {
    degree: Option<u32>,
    marker: Option<MarkerField>,
    door: Option<u32>,
}

/// What the robot saw of its marker.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum MarkerField {
    /// The door along which it points, or -1 without a marker.
    Door(i64),
    /// It is there, and points along no door.
    Seen(bool),
}

/// What is allowed, and where.
#[derive(Serialize)]
struct AllowedFields {
    #[serde(flatten)]
    step: StepFields,
    /// The vertex in the known world.
    vertex: Option<String>,
    /// The neighbour or the edge that the robot came from.
    from: Option<String>,
    /// The number of doors, if the door that was taken does not exist.
    doors: Option<u32>,
    /// Why the algorithm takes the door.
    purpose: Option<String>,
}

impl MarkerField {
    pub(super) fn of(sighting: Sighting) -> Option<Self> {
        match sighting {
            Sighting::Pointing(door) => Some(Self::Door(door.0.into())),
            Sighting::Nothing => Some(Self::Door(-1)),
            Sighting::Lying(_) => Some(Self::Seen(true)),
            _ => None,
        }
    }
}

impl EventFields {
    pub(super) fn of(event: &CheckedEvent) -> Self {
        let (what, step) = match &event.kind {
            CheckedKind::Arrival { arrival, .. } => {
                let marker = arrival.sighting.and_then(MarkerField::of);
                let degree = Some(arrival.degree);
                ("percept", StepFields { degree, marker, ..StepFields::default() })
            }
            CheckedKind::Door { door, .. } => {
                ("door", StepFields { door: Some(door.0), ..StepFields::default() })
            }
            CheckedKind::Aside { .. } => ("aside", StepFields::default()),
            CheckedKind::TurnedBack => ("turned-back", StepFields::default()),
            CheckedKind::Undecided(_) => ("undecided", StepFields::default()),
        };
        Self { what, step }
    }
}

impl DivergenceFields {
    pub(super) fn of(judged: &JudgedLog) -> Option<Self> {
        let divergence = judged.judgement.divergence.as_ref()?;
        let event = judged.judgement.events.events.get(divergence.event);
        let none = Self {
            found: event.map(EventFields::of),
            allowed: Vec::new(),
            allowed_total: 0,
            expected: None,
            recorded: None,
            off: None,
            between: None,
            earlier: None,
        };
        let counts = |expected, recorded| (Some(expected), Some(recorded));
        Some(match &divergence.cause {
            DivergenceCause::World(misfit) => {
                let allowed = misfit.candidates.iter().take(LISTED).map(|(state, why)| {
                    let world = judged.known.as_ref().map(|known| known.world);
                    let (step, doors) = match why {
                        MisfitReason::Percept { expected } => {
                            let marker = MarkerField::of(expected.sighting);
                            let degree = Some(expected.degree);
                            (StepFields { degree, marker, ..StepFields::default() }, None)
                        }
                        MisfitReason::NoSuchDoor { degree } => {
                            (StepFields::default(), Some(*degree))
                        }
                    };
                    AllowedFields {
                        step,
                        vertex: world.map(|world| world.at_text(state.pose).to_owned()),
                        from: world.map(|world| world.leads_to(state.pose).to_owned()),
                        doors,
                        purpose: None,
                    }
                });
                let allowed_total = misfit.candidates.len();
                Self { allowed: allowed.collect(), allowed_total, ..none }
            }
            DivergenceCause::Algorithm(departure) => {
                let allowed = departure.allowed.iter().map(|AllowedStep { door, purpose }| {
                    let door = door.map(|door| door.0);
                    AllowedFields {
                        step: StepFields { door, ..StepFields::default() },
                        vertex: None,
                        from: None,
                        doors: None,
                        purpose: Some(purpose.to_string()),
                    }
                });
                let allowed_total = departure.allowed.len();
                Self { allowed: allowed.collect(), allowed_total, ..none }
            }
            &DivergenceCause::Number { expected, recorded } => {
                let (expected, recorded) = counts(expected.into(), recorded.into());
                Self { expected, recorded, ..none }
            }
            &DivergenceCause::Moves { made, recorded } => {
                let (expected, recorded) = counts(made as u64, recorded);
                Self { expected, recorded, ..none }
            }
            &DivergenceCause::Form { degree, doors } => {
                let (expected, recorded) = counts(doors.into(), degree.into());
                Self { expected, recorded, ..none }
            }
            &DivergenceCause::Return { before, now } => {
                let (expected, recorded) = counts(before.into(), now.into());
                Self { expected, recorded, ..none }
            }
            &DivergenceCause::Unfinished { unexplored } => {
                let (expected, recorded) = counts(unexplored.into(), 0);
                Self { expected, recorded, ..none }
            }
            &DivergenceCause::Aside { off } | &DivergenceCause::Entry { off } => {
                Self { off: Some(off), ..none }
            }
            DivergenceCause::Measurement { between, earlier, .. } => {
                let [between, earlier] =
                    [between, earlier].map(|events| Some(events.map(|event| event + 1)));
                Self { between, earlier, ..none }
            }
            DivergenceCause::NotInTurn(_)
            | DivergenceCause::TurnedBack
            | DivergenceCause::Undecided(_)
            | DivergenceCause::NoWorld { .. }
            | DivergenceCause::Map { .. }
            | DivergenceCause::WrongMap => none,
        })
    }
}
