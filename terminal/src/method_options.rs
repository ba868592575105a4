//! The options of how a robot maps, which several commands share.

use toposlam_model::mapping::{MappingAlgorithm, MappingMethod, RecoveryConfig};

use toposlam_robot::measured_hallway::log_noise;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::{CliError, text::counted};

/// The audits of a map.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct AuditOption {
    /// When the map is complete, walk once more and check it. N: the number of audits
    #[arg(
        long,
        value_name = "N",
        num_args = 0..=1,
        default_missing_value = "1",
        require_equals = true,
        value_parser = clap::value_parser!(u32).range(1..=100)
    )]
    audit: Option<u32>,
}

impl AuditOption {
    /// The number of audits, if the option is given.
    #[must_use]
    pub fn audits(self) -> Option<u32> {
        self.audit
    }
}

/// The algorithm of a robot for which none is chosen: of the two, it makes the same maps in fewer moves.
const DEFAULT_ALGORITHM: MappingAlgorithm = MappingAlgorithm::Folding;

/// What a robot does for a right map, besides its algorithm.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct SafeguardOptions {
    #[command(flatten)]
    audit: AuditOption,
    /// Go on after a contradiction, and if the robot gets lost; the map is audited
    #[arg(long)]
    recover: bool,
}

impl SafeguardOptions {
    /// The method of the folding explorer.
    #[must_use]
    pub fn folding(&self) -> MappingMethod {
        if self.recover {
            MappingMethod::Recovering(RecoveryConfig {
                audits: self.audit.audits().unwrap_or(1),
                noise: Some(log_noise()),
                ..RecoveryConfig::default()
            })
        } else {
            self.by(MappingAlgorithm::Folding)
        }
    }

    /// The method of an algorithm that does not recover.
    fn by(&self, algorithm: MappingAlgorithm) -> MappingMethod {
        MappingMethod::By { algorithm, audits: self.audit.audits().unwrap_or(0) }
    }
}

/// How a robot maps.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct MethodOptions {
    /// The algorithm that makes the map: algorithm1 or folding [default: folding]
    #[arg(long, hide_possible_values = true, value_name = "ALGORITHM", value_parser = algorithms())]
    algorithm: Option<MappingAlgorithm>,
    #[command(flatten)]
    safeguards: SafeguardOptions,
}

impl MethodOptions {
    /// The method.
    ///
    /// # Errors
    /// Returns an error if Algorithm 1 is to recover.
    pub fn method(&self) -> Result<MappingMethod, CliError> {
        match (self.safeguards.recover, self.algorithm) {
            (true, Some(MappingAlgorithm::Algorithm1 | MappingAlgorithm::MovableMarker)) => {
                let cause = "only the folding explorer recovers; use --algorithm folding";
                Err(CliError::at("--recover", cause))
            }
            (true, Some(MappingAlgorithm::Folding) | None) => Ok(self.safeguards.folding()),
            (false, algorithm) => Ok(self.safeguards.by(algorithm.unwrap_or(DEFAULT_ALGORITHM))),
        }
    }
}

/// Parses the name of an algorithm that maps with the directional marker.
pub fn algorithms() -> impl TypedValueParser<Value = MappingAlgorithm> {
    let names = MappingAlgorithm::with_fixed_marker().map(MappingAlgorithm::name);
    PossibleValuesParser::new(names.map(PossibleValue::new))
        .try_map(|name| name.parse::<MappingAlgorithm>())
}

/// The options that give a method again. They name the algorithm, because earlier versions have another default.
#[must_use]
pub fn words_of(method: MappingMethod) -> Vec<String> {
    let mut words = Vec::new();
    if !method.recovers() {
        words.extend(["--algorithm".to_owned(), method.algorithm().name().to_owned()]);
    }
    let usual = u32::from(method.recovers());
    if method.audits() != usual {
        words.push(format!("--audit={}", method.audits()));
    }
    if let MappingMethod::Recovering(RecoveryConfig { retries_blocked, .. }) = method {
        words.push("--recover".to_owned());
        words.extend(retries_blocked.then(|| "--retry-blocked".to_owned()));
    }
    words
}

/// What a robot does besides its algorithm: `with 2 audits and recovery`, or nothing.
#[must_use]
pub fn safeguards_in_words(method: MappingMethod) -> String {
    let audits = match method.audits() {
        0 => return String::new(),
        1 => "an audit".to_owned(),
        more => counted(more as usize, "audit"),
    };
    let recovery = if method.recovers() { " and recovery" } else { "" };
    format!("with {audits}{recovery}")
}
