//! Faults to inject into a simulated robot. Section 2.5.

use std::{fmt, str::FromStr};

use thiserror::Error;

/// A fault that never passes lasts for this number of images.
pub const FOR_EVER: u32 = u32::MAX;

/// A fault that starts when the robot takes its nth image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RobotFault {
    pub kind: FaultKind,
    /// The number of the first image or scan that it affects, from 1.
    pub frame: u64,
    /// The number of images or commands that it affects, if it passes.
    pub lasting: u32,
}

macro_rules! kinds {
    ($($kind:ident $name:literal $lasting:literal $about:literal;)*) => {
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum FaultKind {
            $(#[doc = $about] $kind,)*
        }

        /// All kinds of faults: kind, name, default number of affected images or commands, and
        /// meaning.
        pub const FAULTS: &[(FaultKind, &str, u32, &str)] =
            &[$((FaultKind::$kind, $name, $lasting, $about),)*];
    };
}

kinds! {
    Dropped "dropped" 3 "No images arrive.";
    Late "late" 3 "Images arrive that are older than the last motion.";
    Frozen "frozen" 3 "The same image arrives repeatedly, as if it were new.";
    OverExposed "over-exposed" 3 "Images are overexposed.";
    Corrupt "corrupt" 3 "Image files are damaged.";
    Ignored "ignored" 2 "Commands are ignored.";
    Blocked "blocked" 4_294_967_295 "An obstacle ahead, unseen by the camera, stops the robot.";
    LightsOut "lights-out" 40 "The lights go out.";
    Carried "carried" 1 "The robot is carried elsewhere; odometry does not notice.";
}

#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("write NAME@IMAGE or NAME@IMAGE:COUNT, as in dropped@12:3; the faults are {}", names())]
pub struct FaultError;

fn names() -> String {
    FAULTS.iter().map(|(_, name, ..)| *name).collect::<Vec<_>>().join(", ")
}

impl FaultKind {
    pub fn name(self) -> &'static str {
        FAULTS.iter().find(|(kind, ..)| *kind == self).map_or("", |(_, name, ..)| name)
    }
}

impl RobotFault {
    /// A fault of this kind at an image, with its default duration.
    pub fn at(kind: FaultKind, frame: u64) -> Self {
        let lasting = FAULTS.iter().find(|(known, ..)| *known == kind).map_or(1, |fault| fault.2);
        Self { kind, frame, lasting }
    }

    /// Whether it has passed when this image is taken.
    pub(super) fn has_passed(&self, frame: u64) -> bool {
        self.lasting < FOR_EVER && frame >= self.frame + u64::from(self.lasting)
    }

    /// Whether it affects the image with this number.
    pub(super) fn spoils(&self, frame: u64) -> bool {
        frame >= self.frame && !self.has_passed(frame)
    }
}

/// The form that `from_str` parses.
impl fmt::Display for RobotFault {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}@{}", self.kind.name(), self.frame)?;
        if self.lasting == FOR_EVER { Ok(()) } else { write!(out, ":{}", self.lasting) }
    }
}

impl FromStr for RobotFault {
    type Err = FaultError;

    fn from_str(text: &str) -> Result<Self, FaultError> {
        let (name, when) = text.trim().split_once('@').ok_or(FaultError)?;
        let &(kind, ..) = FAULTS.iter().find(|(_, known, ..)| *known == name).ok_or(FaultError)?;
        let (frame, lasting) = match when.split_once(':') {
            Some((frame, lasting)) => (frame, Some(lasting)),
            None => (when, None),
        };
        let fault = Self::at(kind, frame.parse().map_err(|_| FaultError)?);
        let lasting = lasting.map_or(Ok(fault.lasting), str::parse).map_err(|_| FaultError)?;
        if fault.frame == 0 || lasting == 0 {
            Err(FaultError)
        } else {
            Ok(Self { lasting, ..fault })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_is_parsed_with_its_image_and_its_duration() {
        let fault = RobotFault { kind: FaultKind::Dropped, frame: 12, lasting: 3 };
        assert_eq!("dropped@12".parse(), Ok(fault));
        assert_eq!("dropped@12:9".parse(), Ok(RobotFault { lasting: 9, ..fault }));
        for text in
            ["dropped", "dropped@", "dropped@0", "dropped@1:0", "fog@1", "late@x", "late@1:"]
        {
            assert_eq!(text.parse::<RobotFault>(), Err(FaultError), "{text}");
        }
    }

    #[test]
    fn a_fault_affects_as_many_images_as_it_lasts() {
        let fault: RobotFault = "frozen@5:2".parse().unwrap();
        let spoilt: Vec<_> = (1..10).filter(|&frame| fault.spoils(frame)).collect();
        assert_eq!(spoilt, [5, 6]);
    }
}
