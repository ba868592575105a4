//! The data of the page, as JSON for its script.

use std::collections::HashMap;

use base64::{Engine, engine::general_purpose::STANDARD};
use serde_json::{Value, json};

use super::{folding, rounded, words};
use crate::{
    moment::clock,
    page::template::in_script,
    picture::{BODY, Drawn, Point},
    run_page_data::{PageArrival, PageFrame, RunPageData},
    scene,
    story::Story,
};

/// The data as JSON that can stand inside a `script` element.
pub(super) fn json(run_data: &RunPageData, drawn: &Drawn) -> String {
    let mut album = Album::default();
    let story = Story::new(&run_data.world, run_data.facing);
    let (story, lines) = story.of_steps(&run_data.steps);
    let last = run_data.rounds.len().saturating_sub(1);
    let places = drawn.places.iter().zip(&drawn.aids);
    let frames = run_data.rounds.iter().zip(places).enumerate();
    let rounds = frames.map(|(nth, (frame, (at, aid)))| {
        // The last frame shows the end of the run.
        let steps = if nth == last { run_data.steps.len() } else { frame.steps };
        let known = [lines[steps], run_data.maps(steps).count()];
        let aid = run_data.aid.moves().then(|| aid.map_or(Value::Null, place_of_aid));
        let mut fields = round(frame, (*at, aid), known, &mut album);
        if run_data.has_scenes() {
            fields["state"] = words::state(frame.state).into();
            fields["scene"] = frame.scene.as_ref().map(scene::in_words).unwrap_or_default().into();
            fields["command"] = words::command(frame.command).into();
        }
        fields
    });
    let rounds: Vec<_> = rounds.collect();
    in_script(&json!({
        "rounds": rounds,
        "calls": run_data.calls.iter().map(call).collect::<Vec<_>>(),
        "story": story,
        "images": album.images,
        "body": rounded(BODY * drawn.metre),
        "trail": folding::json(run_data),
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

/// The lines of the story and the maps that are shown are counted.
fn round<'a>(
    round: &'a PageFrame,
    (at, aid): (Point, Option<Value>),
    [story, maps]: [usize; 2],
    album: &mut Album<'a>,
) -> Value {
    let mut fields = json!({
        "time": clock(round.time),
        "x": rounded(at.x),
        "y": rounded(at.y),
        // Clockwise on the screen, in degrees.
        "turn": rounded(-round.pose.heading.to_degrees()),
        "moves": round.moves,
        "image": round.image.as_ref().map(|jpeg| album.place(jpeg)),
        "story": story,
        "maps": maps,
    });
    if let Some(aid) = aid {
        fields["aid"] = aid;
    }
    fields
}

/// Its direction is clockwise on the screen, in degrees.
fn place_of_aid((at, direction): (Point, f64)) -> Value {
    json!({ "x": rounded(at.x), "y": rounded(at.y), "turn": rounded(direction.to_degrees()) })
}

fn call(call: &PageArrival) -> Value {
    json!({
        "rounds": call.rounds,
        "percept": call.percept.to_string(),
        "conforms": call.conforms,
    })
}
