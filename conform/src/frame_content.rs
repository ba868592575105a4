//! What the images of a log show in which no junction is visited.

use std::{cmp::Reverse, collections::BTreeMap, fmt};

use toposlam_model::{
    counts::grouped,
    driving::scene::{Place, Reason},
};

use super::extract::ExtractedRun;

/// What an image shows, or why it shows nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FrameContent {
    Unreadable,
    /// Its time is far from that of all odometry.
    OffClock,
    Unknown(Reason),
    Hallway,
    Junction,
}

/// The number of images with each content.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameContents(BTreeMap<FrameContent, u64>);

impl FrameContents {
    /// The contents of the images that were sensed.
    pub(super) fn of_images(run: &ExtractedRun) -> Self {
        let skipped = [
            (FrameContent::Unreadable, run.unreadable),
            (FrameContent::OffClock, run.skipped.off_clock),
        ];
        let mut counts = BTreeMap::from(skipped);
        for seen in &run.seen {
            *counts.entry(FrameContent::from(&seen.scene.place)).or_default() += 1;
        }
        counts.retain(|_, count| *count > 0);
        Self(counts)
    }
}

impl From<&Place> for FrameContent {
    fn from(place: &Place) -> Self {
        match place {
            Place::Hallway(_) => Self::Hallway,
            Place::Junction(_) => Self::Junction,
            Place::Unknown(reason) => Self::Unknown(*reason),
        }
    }
}

impl fmt::Display for FrameContent {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Unreadable => "not decodable",
            Self::OffClock => "at another time than the odometry",
            Self::Unknown(Reason::NoFloor) => "without floor",
            Self::Unknown(Reason::TooDark) => "too dark",
            Self::Unknown(Reason::Overexposed) => "overexposed",
            Self::Unknown(Reason::MixedFloor) => "with a floor of many colours",
            Self::Unknown(Reason::FewWalls) => "with too few walls",
            Self::Unknown(Reason::NothingFits) => "with no hallway and no junction",
            Self::Unknown(Reason::Ambiguous) => "with several possible junctions",
            Self::Hallway => "in a hallway",
            Self::Junction => "of a junction that may be none",
        })
    }
}

/// `: 12 too dark, 7 in a hallway`, the most frequent content first; empty if nothing is known.
impl fmt::Display for FrameContents {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut counts: Vec<_> = self.0.iter().collect();
        counts.sort_by_key(|(_, count)| Reverse(**count));
        for (at, (content, count)) in counts.into_iter().enumerate() {
            let separator = if at == 0 { ": " } else { ", " };
            write!(out, "{separator}{} {content}", grouped((*count).into()))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::driving::{odometry::Odometry, scene::Scene};

    use super::*;
    use crate::{EventSource, SensedScene};

    #[test]
    fn the_contents_of_images_are_counted_the_most_frequent_first() {
        let contents = |dark: usize, unreadable| {
            let scene = SensedScene {
                source: EventSource::default(),
                scene: Scene { place: Place::Unknown(Reason::TooDark), marker: None },
                odometry: Odometry::default(),
            };
            let seen = vec![scene; dark];
            let run = ExtractedRun { seen, unreadable, ..ExtractedRun::default() };
            FrameContents::of_images(&run).to_string()
        };
        assert_eq!(contents(0, 0), "");
        assert_eq!(contents(2, 0), ": 2 too dark");
        assert_eq!(contents(2, 7), ": 7 not decodable, 2 too dark");
    }
}
