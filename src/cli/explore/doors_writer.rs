//! The doors of a run, and each pick-up and drop of the marker, as the beginning of a JSON object. They
//! are written while the run goes on.

use std::io::{self, Write};

use toposlam_model::mapping::{MapWalk, MappingEvent, Observer};

use crate::cli::json::{action_json, begin_line};

/// Writes `{"schema":1,"kind":"run","doors":[...],`; the caller writes the rest of the object.
pub(super) struct DoorsWriter<'o, W> {
    out: &'o mut W,
    taken: u64,
    result: io::Result<()>,
}

impl<'o, W: Write> DoorsWriter<'o, W> {
    pub(super) fn new(out: &'o mut W) -> Self {
        let result = begin_line(out, "run").and_then(|()| write!(out, "\"doors\":["));
        Self { out, taken: 0, result }
    }

    pub(super) fn finish(self) -> io::Result<()> {
        self.result?;
        write!(self.out, "],")
    }
}

impl<W: ?Sized, O: Write> Observer<W> for DoorsWriter<'_, O> {
    fn event(&mut self, _: &mut W, _: &MapWalk, event: MappingEvent) {
        if let (Ok(()), Some(action)) = (&self.result, event.action()) {
            let comma = if self.taken == 0 { "" } else { "," };
            self.taken += 1;
            self.result = write!(self.out, "{comma}{}", action_json(action));
        }
    }
}
