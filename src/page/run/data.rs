//! The data of the page, as JSON for its script.

use std::collections::HashMap;

use base64::{Engine, engine::general_purpose::STANDARD};
use serde_json::{Value, json};

use super::{folding, rounded, words};
use crate::{
    journal::{FrameEntry, Journal, JunctionCall},
    moment::clock,
    page::template::in_script,
    picture::Drawn,
};

/// The radius of the robot's body, in metres.
const BODY: f64 = 0.41 / 2.0;

/// The data as JSON that can stand inside a `script` element.
pub(super) fn json(journal: &Journal, drawn: &Drawn) -> String {
    let mut album = Album::default();
    let rounds = journal.rounds.iter().zip(&drawn.places);
    let mut rounds = rounds.map(|(it, at)| round(it, *at, &mut album)).collect::<Vec<_>>();
    if let Some(last) = rounds.last_mut() {
        // The last frame shows the end of the run.
        last["story"] = json!(journal.story.len());
        last["maps"] = json!(journal.maps.len());
    }
    in_script(&json!({
        "rounds": rounds,
        "calls": journal.calls.iter().map(call).collect::<Vec<_>>(),
        "story": journal.story,
        "images": album.images,
        "body": rounded(BODY * drawn.metre),
        "trail": folding::json(journal),
    }))
}

/// The distinct images, as data URLs.
#[derive(Default)]
struct Album<'a> {
    images: Vec<String>,
    place: HashMap<&'a [u8], usize>,
}

impl<'a> Album<'a> {
    /// The index of an image. It is added if it is new.
    fn place(&mut self, jpeg: &'a [u8]) -> usize {
        *self.place.entry(jpeg).or_insert_with(|| {
            self.images.push(format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg)));
            self.images.len() - 1
        })
    }
}

fn round<'a>(round: &'a FrameEntry, [x, y]: [f64; 2], album: &mut Album<'a>) -> Value {
    json!({
        "time": clock(round.time),
        "x": rounded(x),
        "y": rounded(y),
        // Clockwise on the screen, in degrees.
        "turn": rounded(-round.pose.heading.to_degrees()),
        "moves": round.moves,
        "state": words::state(round.state),
        "scene": round.scene,
        "command": words::command(round.command),
        "image": round.image.as_ref().map(|jpeg| album.place(jpeg)),
        "story": round.story,
        "maps": round.maps,
    })
}

fn call(call: &JunctionCall) -> Value {
    json!({
        "rounds": call.rounds,
        "percept": call.percept.to_string(),
        "conforms": call.conforms,
    })
}
