//! The options of how a robot maps, which several commands share.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use toposlam_model::mapping::{MappingAlgorithm, MappingMethod, RecoveryConfig};
use toposlam_robot::measured_hallway::log_noise;

use super::{CliError, text::counted};

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
    pub fn audits(self) -> Option<u32> {
        self.audit
    }
}

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

    /// The options that give the same safeguards.
    pub fn arguments(&self) -> Vec<String> {
        let audits = self.audit.audits().map(|audits| format!("--audit={audits}"));
        let recover = self.recover.then(|| "--recover".to_owned());
        audits.into_iter().chain(recover).collect()
    }

    /// The method of an algorithm that does not recover.
    fn by(&self, algorithm: MappingAlgorithm) -> MappingMethod {
        MappingMethod::By { algorithm, audits: self.audit.audits().unwrap_or(0) }
    }
}

/// How a robot maps. The default algorithm makes the same maps in fewer moves.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct MethodOptions {
    /// The algorithm that makes the map: algorithm1 or folding
    #[arg(
        long,
        hide_possible_values = true,
        value_name = "ALGORITHM",
        default_value = "folding",
        value_parser = algorithms()
    )]
    algorithm: MappingAlgorithm,
    #[command(flatten)]
    safeguards: SafeguardOptions,
}

impl MethodOptions {
    /// The options that give the same method.
    pub fn arguments(&self) -> Vec<String> {
        let algorithm = format!("--algorithm {}", self.algorithm.name());
        [algorithm].into_iter().chain(self.safeguards.arguments()).collect()
    }

    /// The method, unless Algorithm 1 is to recover.
    pub fn method(&self) -> Result<MappingMethod, CliError> {
        match (self.safeguards.recover, self.algorithm) {
            (false, algorithm) => Ok(self.safeguards.by(algorithm)),
            (true, MappingAlgorithm::Folding) => Ok(self.safeguards.folding()),
            (true, _) => {
                let cause = "only the folding explorer recovers; use --algorithm folding";
                Err(CliError::at("--recover", cause))
            }
        }
    }
}

/// Parses the name of an algorithm that maps with the directional marker.
pub fn algorithms() -> impl TypedValueParser<Value = MappingAlgorithm> {
    let names = MappingAlgorithm::with_fixed_marker().map(MappingAlgorithm::name);
    PossibleValuesParser::new(names.map(PossibleValue::new))
        .try_map(|name| name.parse::<MappingAlgorithm>())
}

/// What a robot does besides its algorithm: `with 2 audits and recovery`, or nothing.
pub fn safeguards_in_words(method: MappingMethod) -> String {
    let audits = match method.audits() {
        0 => return String::new(),
        1 => "an audit".to_owned(),
        more => counted(more as usize, "audit"),
    };
    let recovery = if method.recovers() { " and recovery" } else { "" };
    format!("with {audits}{recovery}")
}
