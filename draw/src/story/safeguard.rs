//! The story of audits and recoveries.

use toposlam_model::mapping::{MapWalk, SafeguardEvent};

use super::Story;
use crate::{moment::grouped, text::counted};

impl Story {
    pub(super) fn add_safeguard(&mut self, journey: &MapWalk, event: SafeguardEvent) {
        let moves = match event {
            // An audit has its own moves.
            SafeguardEvent::AuditBegun | SafeguardEvent::AuditPassed { .. } => String::new(),
            _ => self.take_moves(journey),
        };
        let text = match event {
            SafeguardEvent::AuditBegun => "The map is complete. The robot audits it.".to_owned(),
            SafeguardEvent::AuditPassed { moves } => {
                let moves = counted(moves as usize, "move");
                let text = format!("Every percept of the audit is as the map predicts ({moves}).");
                self.add_paragraph(text);
                return;
            }
            SafeguardEvent::Contradicted(contradiction) => {
                format!("Contradiction{moves}: {contradiction}. The robot looks for the marker.")
            }
            SafeguardEvent::TooLarge { bound } => format!(
                "The map would have more than {} darts{moves}. The robot discards it and looks for the \
                 marker.",
                grouped(bound as u128)
            ),
            SafeguardEvent::Relocated => {
                format!(
                    "The robot got lost{moves}. It is at a junction now, and looks for the marker."
                )
            }
            SafeguardEvent::MarkerFound { kept, walks } => {
                let walks = counted(walks, "walk");
                format!(
                    "It finds the marker{moves}. {} of its {walks} from or to the marker agree.",
                    grouped(kept as u128)
                )
            }
            SafeguardEvent::BlockedRetried { doors } => {
                format!("The robot tries {} once more.", counted(doors, "blocked door"))
            }
        };
        self.add_section(text);
    }
}
