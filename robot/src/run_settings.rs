//! What a robot does in a run: how it maps, what it may spend, and from where it goes on.

use std::fmt;

use toposlam_model::mapping::{EarlierWalk, MappingAlgorithm, MappingMethod};
use toposlam_vision::laser::params::LaserParams;

use crate::{budget::RunBudget, measured_hallway::log_noise};

/// The most darts of a robot's map, if it has no other limit.
pub const DEFAULT_MAX_DARTS: usize = 1000;

/// What a robot does in a run.
#[derive(Clone, Debug)]
pub struct RunSettings {
    pub method: MappingMethod,
    /// The most darts of its map.
    pub dart_bound: usize,
    pub budget: RunBudget,
    /// What a laser scanner takes for vertices; `None` by a camera.
    pub laser: Option<LaserVertices>,
    /// The walks of earlier runs from which it goes on. Without any, it starts at its marker.
    pub earlier: Vec<EarlierWalk>,
}

impl RunSettings {
    /// A run from the marker, without a budget.
    pub fn new(method: impl Into<MappingMethod>, dart_bound: usize) -> Self {
        let (budget, earlier) = (RunBudget::default(), Vec::new());
        Self { method: method.into(), dart_bound, budget, laser: None, earlier }
    }
}

/// The settings in the head of a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedSettings {
    pub method: MappingMethod,
    pub budget: RunBudget,
    /// Whether it goes on from earlier runs.
    pub is_resumed: bool,
    /// The most darts of its map.
    pub dart_bound: usize,
    /// What a laser scanner took for vertices; `None` by a camera, or if it is not recorded.
    pub laser: Option<LaserVertices>,
}

/// What a robot with a laser scanner takes for vertices of its building.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaserVertices {
    /// A way that ends nearer than this to a junction is no arm of it, in metres.
    pub min_arm: f64,
    /// Whether bends and dead ends are vertices.
    pub corners: bool,
}

impl LaserVertices {
    /// Those of a robot in a building of hallways, which may be short.
    pub const OF_HALLWAYS: Self = Self { min_arm: 3.0, corners: true };

    /// How scans are sensed there. Corners are vertices in buildings with short hallways.
    pub fn params(self) -> LaserParams {
        let mut params = if self.corners { LaserParams::HALLWAYS } else { LaserParams::DEFAULT };
        (params.arm.min_arm, params.corner.corners) = (self.min_arm, self.corners);
        params
    }
}

impl From<&LaserParams> for LaserVertices {
    fn from(LaserParams { arm, corner, .. }: &LaserParams) -> Self {
        Self { min_arm: arm.min_arm, corners: corner.corners }
    }
}

impl Default for RecordedSettings {
    fn default() -> Self {
        Self {
            method: MappingMethod::default(),
            budget: RunBudget::default(),
            is_resumed: false,
            dart_bound: DEFAULT_MAX_DARTS,
            laser: None,
        }
    }
}

impl RunSettings {
    /// What the head of its log says.
    pub fn recorded(&self) -> RecordedSettings {
        let Self { method, budget, dart_bound, laser, .. } = *self;
        let is_resumed = !self.earlier.is_empty();
        RecordedSettings { method, budget, is_resumed, dart_bound, laser }
    }
}

/// The form that `from_head` parses, as in `folding recovering audits=1 max-moves=25`.
impl fmt::Display for RecordedSettings {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let Self { method, budget: RunBudget { moves, seconds, metres }, .. } = self;
        write!(out, "{method}")?;
        if let Some(moves) = moves {
            write!(out, " max-moves={moves}")?;
        }
        if let Some(seconds) = seconds {
            write!(out, " max-seconds={seconds}")?;
        }
        if let Some(metres) = metres {
            write!(out, " max-metres={metres}")?;
        }
        if self.dart_bound != DEFAULT_MAX_DARTS {
            write!(out, " max-darts={}", self.dart_bound)?;
        }
        if let Some(LaserVertices { min_arm, corners }) = self.laser {
            write!(out, " min-arm={min_arm} corners={}", if corners { "yes" } else { "no" })?;
        }
        if self.is_resumed { write!(out, " resumed") } else { Ok(()) }
    }
}

impl RecordedSettings {
    /// The same for another algorithm: with its audits, without recovery if it cannot recover.
    #[must_use]
    pub fn with_algorithm(self, algorithm: MappingAlgorithm) -> Self {
        if self.method.algorithm() == algorithm {
            return self;
        }
        let method = MappingMethod::By { algorithm, audits: self.method.audits() };
        Self { method, ..self }
    }

    /// Reads what the head of a log says. A robot that recovers compares lengths with the usual uncertainty.
    ///
    /// # Errors
    /// Returns the cause if it is not of this form.
    pub fn from_head(text: &str) -> Result<Self, String> {
        let mut settings = Self::default();
        let mut method = Vec::new();
        let (mut min_arm, mut corners) = (None, None);
        for word in text.split(' ') {
            let (name, number) = word.split_once('=').unwrap_or((word, ""));
            let real = || number.parse().ok().filter(|number: &f64| *number > 0.0);
            let no_number = || format!("`{word}` has no number");
            let budget = &mut settings.budget;
            match name {
                "max-moves" => budget.moves = Some(number.parse().map_err(|_| no_number())?),
                "max-seconds" => budget.seconds = Some(real().ok_or_else(no_number)?),
                "max-metres" => budget.metres = Some(real().ok_or_else(no_number)?),
                "max-darts" => settings.dart_bound = number.parse().map_err(|_| no_number())?,
                "min-arm" => min_arm = Some(real().ok_or_else(no_number)?),
                "corners" => {
                    corners = match number {
                        "yes" => Some(true),
                        "no" => Some(false),
                        _ => return Err(format!("`{word}` is neither yes nor no")),
                    };
                }
                "resumed" => settings.is_resumed = true,
                _ => method.push(word),
            }
        }
        settings.method = method.join(" ").parse()?;
        settings.laser =
            min_arm.zip(corners).map(|(min_arm, corners)| LaserVertices { min_arm, corners });
        if let MappingMethod::Recovering(config) = &mut settings.method {
            config.noise = Some(log_noise());
        }
        Ok(settings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_of_a_log_gives_the_settings_again() {
        for text in [
            "algorithm1",
            "folding audits=2 max-moves=25",
            "folding recovering audits=1 max-darts=12",
            "folding audits=1 min-arm=4.5 corners=no",
            "folding max-darts=12 min-arm=10 corners=yes resumed",
            "folding recovering audits=1 max-seconds=1200 max-metres=500.5 resumed",
        ] {
            assert_eq!(RecordedSettings::from_head(text).unwrap().to_string(), text);
        }
        for (text, cause) in [
            ("folding max-moves=-1", "`max-moves=-1` has no number"),
            ("folding max-metres=0", "`max-metres=0` has no number"),
            ("folding min-arm=-1 corners=no", "`min-arm=-1` has no number"),
            ("folding min-arm=1 corners=maybe", "`corners=maybe` is neither yes nor no"),
            ("folding max-darts=few", "`max-darts=few` has no number"),
            ("folding slowly", "`slowly` does not follow the name of an algorithm"),
        ] {
            assert_eq!(RecordedSettings::from_head(text), Err(cause.to_owned()));
        }
        let nameless = RecordedSettings::from_head("max-moves=3").unwrap_err();
        assert!(nameless.starts_with("`` is no algorithm; they are algorithm1, folding,"));
    }

    #[test]
    fn a_log_of_a_robot_in_hallways_is_sensed_as_the_robot_sensed() {
        assert_eq!(LaserVertices::OF_HALLWAYS.params(), LaserParams::HALLWAYS);
        let vertices = LaserVertices { min_arm: 4.5, corners: false };
        let mut expected = LaserParams::DEFAULT;
        expected.arm.min_arm = 4.5;
        assert_eq!(vertices.params(), expected);
        assert_eq!(LaserVertices::from(&vertices.params()), vertices);
    }

    #[test]
    fn another_algorithm_has_the_same_audits_and_limits() {
        let recorded = "folding recovering audits=2 max-moves=25 max-darts=12 resumed";
        let recorded = RecordedSettings::from_head(recorded).unwrap();
        assert_eq!(recorded.with_algorithm(MappingAlgorithm::Folding), recorded);
        let other = recorded.with_algorithm(MappingAlgorithm::Algorithm1);
        assert_eq!(other.to_string(), "algorithm1 audits=2 max-moves=25 max-darts=12 resumed");
    }
}
