//! The lines between the check and an explorer that is another program: docs/protocol.md.

use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use toposlam_model::{
    aid::Action,
    embedded_graph::Dart,
    mapping::{ExploredMap, Flaw},
    percept::{Door, OtherRobot, Percept, Sighting, StringView, TeamView, TwoMarkersView},
};

use super::fault::ExplorerFault;

/// The most characters of a line that a message shows.
const SHOWN: usize = 60;

pub(super) fn percept_line(percept: Percept) -> String {
    let Percept { degree, sighting } = percept;
    let marker = match sighting {
        Sighting::Nothing => "null".to_owned(),
        Sighting::Pointing(door) => door.0.to_string(),
        Sighting::Lying(count) => count.to_string(),
        Sighting::These(markers) => json!(markers.names().join("+")).to_string(),
        Sighting::Passed => "\"passed\"".to_owned(),
        Sighting::PassedAlong => "\"along\"".to_owned(),
        Sighting::PassedAgainst => "\"against\"".to_owned(),
        Sighting::String(StringView { doors, fixed_end, free_end, hand }) => {
            let doors: Vec<_> = doors.doors().map(|door| door.0).collect();
            let hand = hand.map(|door| door.0);
            json!({ "doors": doors, "fixed_end": fixed_end, "free_end": free_end, "hand": hand })
                .to_string()
        }
        Sighting::Team(TeamView(others)) => {
            let robots: Vec<_> = others.into_iter().filter_map(other_robot).collect();
            json!({ "robots": robots }).to_string()
        }
        Sighting::TwoMarkers(TwoMarkersView { along, movable }) => {
            json!({ "along": along.map(|door| door.0), "movable": movable }).to_string()
        }
        Sighting::Ball(ball) => json!({ "ball": ball.behind() }).to_string(),
        Sighting::Compass(view) => json!(view.to_string()).to_string(),
    };
    format!("{{\"percept\":{{\"degree\":{degree},\"marker\":{marker}}}}}\n")
}

/// Another robot of a team; `None` if there is none.
fn other_robot(robot: OtherRobot) -> Option<Value> {
    let at = |place: &str, along: Option<Door>| {
        Some(json!({ "place": place, "along": along.map(|door| door.0) }))
    };
    match robot {
        OtherRobot::Absent => None,
        OtherRobot::Elsewhere { degree } => Some(json!({ "place": "elsewhere", "degree": degree })),
        OtherRobot::Here => at("here", None),
        OtherRobot::HereAlong(door) => at("here", Some(door)),
        OtherRobot::WithSecond => at("with-second", None),
        OtherRobot::WithSecondAlong(door) => at("with-second", Some(door)),
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum ExplorerAnswer {
    Act(Action),
    /// The last answer of a run.
    Done(ReportedMap),
    GiveUp(String),
}

impl ExplorerAnswer {
    /// The answer in a line without its end.
    pub(super) fn from_line(line: &[u8]) -> Result<Self, ExplorerFault> {
        let text = String::from_utf8_lossy(line);
        let shown = || shortened(text.trim());
        let value: Value = serde_json::from_slice(line).map_err(|error| {
            // There is only one line.
            let cause = error.to_string().replace(" at line 1 column ", " at column ");
            ExplorerFault::NotJson { line: shown(), cause }
        })?;
        Self::from_value(&value)
            .map_err(|cause| ExplorerFault::NotAnAnswer { line: shown(), cause })
    }

    fn from_value(value: &Value) -> Result<Self, String> {
        let Value::Object(fields) = value else {
            return Err("an answer is an object, as in {\"door\":2}".to_owned());
        };
        let keys: Vec<_> = fields.keys().map(String::as_str).collect();
        match keys[..] {
            ["door"] => part(&fields["door"], "the number of a door")
                .map(|door| Self::Act(Action::Take(Door(door)))),
            ["action"] => match fields["action"].as_str() {
                Some(action) => action
                    .parse()
                    .map(|action| Self::Act(Action::Do(action)))
                    .map_err(|_| format!("{} is not \"pick-up\" or \"drop\"", fields["action"])),
                None => Err(format!("{} is not \"pick-up\" or \"drop\"", fields["action"])),
            },
            ["give_up"] => part(&fields["give_up"], "a text")
                .map(|reason: String| Self::GiveUp(shortened(&reason))),
            ["map", "pose"] | ["pose", "map"] => {
                let pose = part(&fields["pose"], "a dart, as in [1,0]: dart 0 of vertex 1")?;
                let vertices = "a list of vertices, each a list of darts, as in [1,0], or null";
                Ok(Self::Done(ReportedMap { ends: part(&fields["map"], vertices)?, pose }))
            }
            ["map"] => Err("a map needs a \"pose\" beside it".to_owned()),
            ["pose"] => Err("a pose needs a \"map\" beside it".to_owned()),
            [] => Err("it is empty".to_owned()),
            _ => {
                let known = ["door", "action", "map", "pose", "give_up"];
                let other = keys.iter().find(|key| !known.contains(key));
                Err(match other {
                    Some(key) => format!("there is no key \"{}\"", shortened(key)),
                    None => "it is more than one answer".to_owned(),
                })
            }
        }
    }
}

/// A part of an answer. `what` says what it should be.
fn part<T: DeserializeOwned>(value: &Value, what: &str) -> Result<T, String> {
    let refused = |_| format!("{} is not {what}", shortened(&value.to_string()));
    serde_json::from_value(value.clone()).map_err(refused)
}

pub(super) fn shortened(text: &str) -> String {
    let plain = |letter: char| if letter.is_control() { '\u{fffd}' } else { letter };
    let mut letters = text.chars().map(plain);
    let beginning: String = letters.by_ref().take(SHOWN).collect();
    if letters.next().is_some() { beginning + "…" } else { beginning }
}

/// A map as an explorer returns it: for each vertex and each dart, clockwise, the vertex and the index of
/// the dart's other end. Dart 0 of vertex 0 is the facing dart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ReportedMap {
    /// `None` where an explorer does not state the other end.
    ends: Vec<Vec<Option<ReportedDart>>>,
    pose: ReportedDart,
}

/// A dart: its vertex, and its index there.
type ReportedDart = (usize, usize);

impl ReportedMap {
    pub(super) fn explored(&self) -> Result<ExploredMap<'static>, ExplorerFault> {
        let invalid = |cause: String| ExplorerFault::InvalidMap { cause };
        let mut firsts = Vec::with_capacity(self.ends.len());
        let mut darts = Vec::new();
        for (vertex, ends) in self.ends.iter().enumerate() {
            if ends.is_empty() {
                return Err(invalid(format!("vertex v{vertex} has no dart")));
            }
            firsts.push(darts.len());
            darts.extend((0..ends.len()).map(|index| (vertex, index)));
        }
        let end_of = |(vertex, index): ReportedDart| self.ends.get(vertex)?.get(index).copied();
        let number = |dart: ReportedDart| end_of(dart).map(|_| (firsts[dart.0] + dart.1) as u32);
        let opposite = |&from: &ReportedDart| {
            let name = dart_text(from);
            let Some(Some(to)) = end_of(from) else {
                return Err(ExplorerFault::MissingEdge { dart: name });
            };
            let Some(there) = number(to) else {
                return Err(invalid(format!(
                    "dart {name} leads to {}, which the map does not have",
                    dart_text(to)
                )));
            };
            match end_of(to).flatten() {
                _ if to == from => Err(invalid(format!("dart {name} leads to itself"))),
                Some(back) if back != from => {
                    let (to, back) = (dart_text(to), dart_text(back));
                    Err(invalid(format!("dart {name} leads to {to}, and {to} leads to {back}")))
                }
                None => Err(ExplorerFault::MissingEdge { dart: dart_text(to) }),
                Some(_) => Ok(there),
            }
        };
        let opposite = darts.iter().map(opposite).collect::<Result<Vec<_>, _>>()?;
        let next = |&(vertex, index): &ReportedDart| {
            (firsts[vertex] + (index + 1) % self.ends[vertex].len()) as u32
        };
        let clockwise: Vec<_> = darts.iter().map(next).collect();
        let pose = number(self.pose)
            .ok_or_else(|| invalid(format!("it has no dart {}, the pose", dart_text(self.pose))))?;
        ExploredMap::from_permutations(&opposite, &clockwise, 0, pose).map_err(|flaw| match flaw {
            Flaw::NoGraph(toposlam_model::embedded_graph::GraphError::NotConnected { dart }) => {
                let dart = dart_text(darts[dart as usize]);
                invalid(format!("dart {dart} cannot be reached from the start"))
            }
            flaw => invalid(flaw.to_string()),
        })
    }

    pub(super) fn pose_text(&self) -> String {
        dart_text(self.pose)
    }

    /// A dart of the embedded graph of the map, as a message shows it.
    pub(super) fn dart_name(&self, dart: Dart) -> String {
        let mut index = dart.at();
        for (vertex, ends) in self.ends.iter().enumerate() {
            if index < ends.len() {
                return dart_text((vertex, index));
            }
            index -= ends.len();
        }
        dart.0.to_string()
    }
}

fn dart_text((vertex, index): ReportedDart) -> String {
    format!("v{vertex}.{index}")
}

#[cfg(test)]
mod tests {
    use toposlam_model::{aid::AidAction, percept::MarkerSet};

    use super::*;

    fn answer(line: &str) -> Result<ExplorerAnswer, ExplorerFault> {
        ExplorerAnswer::from_line(line.as_bytes())
    }

    fn map(line: &str) -> Result<ExploredMap<'static>, ExplorerFault> {
        match answer(line).unwrap() {
            ExplorerAnswer::Done(map) => map.explored(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_percept_is_a_line_without_spaces() {
        let line = |degree, sighting| percept_line(Percept { degree, sighting });
        let pointing = Sighting::Pointing(Door(1));
        assert_eq!(line(3, pointing), "{\"percept\":{\"degree\":3,\"marker\":1}}\n");
        assert_eq!(line(1, Sighting::Nothing), "{\"percept\":{\"degree\":1,\"marker\":null}}\n");
        assert_eq!(
            line(2, MarkerSet::from_numbers([0, 1]).map(Sighting::These).unwrap()),
            "{\"percept\":{\"degree\":2,\"marker\":\"first+second\"}}\n"
        );
    }

    #[test]
    fn an_action_is_a_door_or_a_word() {
        assert_eq!(answer("{\"door\":2}\r"), Ok(ExplorerAnswer::Act(Action::Take(Door(2)))));
        assert_eq!(
            answer(" {\"action\": \"drop\"}"),
            Ok(ExplorerAnswer::Act(Action::Do(AidAction::Drop)))
        );
        assert_eq!(answer("{\"give_up\":\"lost\"}"), Ok(ExplorerAnswer::GiveUp("lost".to_owned())));
    }

    #[test]
    fn what_is_no_answer_is_named_with_its_line() {
        let cases = [
            ("", "not-json", "EOF while parsing a value at column 0"),
            ("door 1", "not-json", "expected value at column 1"),
            ("{\"door\":1} {}", "not-json", "trailing characters at column 12"),
            ("7", "not-an-answer", "an answer is an object, as in {\"door\":2}"),
            ("{}", "not-an-answer", "it is empty"),
            ("{\"door\":-1}", "not-an-answer", "-1 is not the number of a door"),
            ("{\"door\":1.5}", "not-an-answer", "1.5 is not the number of a door"),
            ("{\"door\":\"1\"}", "not-an-answer", "\"1\" is not the number of a door"),
            ("{\"door\":4294967296}", "not-an-answer", "4294967296 is not the number of a door"),
            ("{\"dor\":1}", "not-an-answer", "there is no key \"dor\""),
            ("{\"door\":1,\"action\":\"drop\"}", "not-an-answer", "it is more than one answer"),
            ("{\"action\":\"jump\"}", "not-an-answer", "\"jump\" is not \"pick-up\" or \"drop\""),
            ("{\"map\":[]}", "not-an-answer", "a map needs a \"pose\" beside it"),
            (
                "{\"map\":[[3]],\"pose\":[0,0]}",
                "not-an-answer",
                "[[3]] is not a list of vertices, each a list of darts, as in [1,0], or null",
            ),
            (
                "{\"map\":[[null]],\"pose\":3}",
                "not-an-answer",
                "3 is not a dart, as in [1,0]: dart 0 of vertex 1",
            ),
        ];
        for (line, name, cause) in cases {
            let fault = answer(line).unwrap_err();
            assert_eq!(fault.name(), name, "{line}");
            assert!(fault.to_string().ends_with(&format!(": {cause}")), "{line}: {fault}");
        }
        let fault = ExplorerAnswer::from_line(&[0xff, b'\x07']).unwrap_err();
        assert_eq!(fault.name(), "not-json");
        assert!(!fault.to_string().contains('\u{7}'));
        assert!(answer(&"[".repeat(1000)).is_err());
    }

    #[test]
    fn a_map_is_an_embedded_graph() {
        // An edge with a loop at its end.
        let loops = map("{\"map\":[[[1,0]],[[0,0],[1,2],[1,1]]],\"pose\":[1,2]}").unwrap();
        assert_eq!((loops.graph.edge_count(), loops.graph.vertex_count()), (2, 2));
        assert_eq!((loops.facing, loops.pose), (Dart(0), Dart(3)));
    }

    #[test]
    fn a_map_that_contradicts_itself_is_rejected_with_its_dart() {
        let cases = [
            ("[]", "[0,0]", "invalid-map", "it has no dart v0.0, the pose"),
            ("[[]]", "[0,0]", "invalid-map", "vertex v0 has no dart"),
            ("[[[1,0]],[[0,0]]]", "[1,1]", "invalid-map", "it has no dart v1.1, the pose"),
            ("[[[0,0]]]", "[0,0]", "invalid-map", "dart v0.0 leads to itself"),
            (
                "[[[1,1]],[[0,0]]]",
                "[0,0]",
                "invalid-map",
                "dart v0.0 leads to v1.1, which the map does not have",
            ),
            (
                "[[[0,1],[1,0]],[[0,1]]]",
                "[0,0]",
                "invalid-map",
                "dart v0.0 leads to v0.1, and v0.1 leads to v1.0",
            ),
            ("[[null]]", "[0,0]", "missing-edge", "dart v0.0 leads nowhere"),
            ("[[[1,0]],[null]]", "[0,0]", "missing-edge", "dart v1.0 leads nowhere"),
            (
                "[[[0,1],[0,0]],[[1,1],[1,0]]]",
                "[0,0]",
                "invalid-map",
                "dart v1.0 cannot be reached from the start",
            ),
        ];
        for (ends, pose, name, cause) in cases {
            let fault = map(&format!("{{\"map\":{ends},\"pose\":{pose}}}")).unwrap_err();
            assert_eq!(fault.name(), name, "{ends}: {fault}");
            assert!(fault.to_string().ends_with(&format!(": {cause}")), "{ends}: {fault}");
        }
    }
}
