//! The words of the page of a run.

use toposlam_model::driving::algorithm2::{Command, PathState};

use crate::{moment::clock, run_page_data::RunPageData};

/// The result and the length of the run.
pub(super) fn about(run_data: &RunPageData) -> String {
    let ending = run_data.ending.trim_end_matches('.');
    let frames = match run_data.rounds.len() {
        1 => "1 frame".to_owned(),
        count => format!("{count} frames"),
    };
    let Some(last) = run_data.rounds.last() else {
        return format!("{ending}. {frames}.");
    };
    format!("{ending}. {frames}, {} of simulated time.", clock(last.time))
}

pub(super) fn state(state: PathState) -> &'static str {
    match state {
        PathState::Leaving => "leaving a junction",
        PathState::Hallway => "in a hallway",
        PathState::Junction => "at a junction",
        PathState::Unknown => "lost",
    }
}

pub(super) fn command(command: Option<Command>) -> String {
    let Some(Command { turn, forward }) = command else {
        return "none: the path ends".to_owned();
    };
    let degrees = turn.to_degrees().round();
    let side = if degrees > 0.0 { "left" } else { "right" };
    let turning = format!("turn {}\u{b0} to the {side}", degrees.abs());
    let going = format!("go {forward:.2} m ahead");
    match (degrees != 0.0, forward >= 0.005) {
        (true, true) => format!("{turning}, {going}"),
        (true, false) => turning,
        (false, true) => going,
        (false, false) => "take another image".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_in_degrees_and_metres() {
        let text = |turn: f64, forward| command(Some(Command { turn, forward }));
        assert_eq!(text(0.5, 0.5), "turn 29\u{b0} to the left, go 0.50 m ahead");
        assert_eq!(text(-0.5, 0.0), "turn 29\u{b0} to the right");
        assert_eq!(text(0.001, 0.25), "go 0.25 m ahead");
        assert_eq!(text(0.0, 0.0), "take another image");
        assert_eq!(command(None), "none: the path ends");
    }
}
