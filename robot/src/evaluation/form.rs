//! What a junction looks like from the door by which it was entered, and what a scene says of it.

use std::{f64::consts::FRAC_PI_2, fmt};

use toposlam_model::{
    driving::scene::{Place, Scene},
    floor_plan::JunctionKind,
};

/// A junction as it is seen from its entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Form {
    /// One door, the way back.
    DeadEnd,
    /// An L that goes on to the left.
    LeftL,
    /// An L that goes on to the right.
    RightL,
    /// A T entered by its stem.
    StemT,
    /// A T entered by an arm, its stem to the left.
    StemLeftT,
    /// A T entered by an arm, its stem to the right.
    StemRightT,
}

/// What an image shows, or what a scene says that it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Class {
    /// A hallway.
    Hallway,
    /// A junction.
    Junction(Form),
    /// A junction whose doors are none of the forms'.
    Other,
    /// The image does not tell.
    Unknown,
}

impl Form {
    /// All of them.
    pub const ALL: [Self; 6] =
        [Self::DeadEnd, Self::LeftL, Self::RightL, Self::StemT, Self::StemLeftT, Self::StemRightT];

    /// The form of a junction by the directions of its doors, clockwise from the entry door; `None`
    /// where they are no dead end, L or T.
    #[must_use]
    pub fn of(doors: &[f64]) -> Option<Self> {
        let (&entry, others) = doors.split_first()?;
        // Quarter turns clockwise from the entry door.
        let turns = others.iter().map(|door| ((entry - door) / FRAC_PI_2).round().rem_euclid(4.0));
        let turns: Vec<_> = turns.map(|quarter| quarter as u8).collect();
        match turns[..] {
            [] => Some(Self::DeadEnd),
            [1] => Some(Self::LeftL),
            [3] => Some(Self::RightL),
            [1, 3] => Some(Self::StemT),
            [1, 2] => Some(Self::StemLeftT),
            [2, 3] => Some(Self::StemRightT),
            _ => None,
        }
    }

    /// The kind of the junction.
    #[must_use]
    pub fn kind(self) -> JunctionKind {
        match self {
            Self::DeadEnd => JunctionKind::DeadEnd,
            Self::LeftL | Self::RightL => JunctionKind::L,
            Self::StemT | Self::StemLeftT | Self::StemRightT => JunctionKind::T,
        }
    }
}

impl Class {
    /// The classes that a truth can be, and then those that only a scene can say.
    pub const ALL: [Self; 9] = [
        Self::Hallway,
        Self::Junction(Form::DeadEnd),
        Self::Junction(Form::LeftL),
        Self::Junction(Form::RightL),
        Self::Junction(Form::StemT),
        Self::Junction(Form::StemLeftT),
        Self::Junction(Form::StemRightT),
        Self::Other,
        Self::Unknown,
    ];

    /// What a scene says.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        match &scene.place {
            Place::Hallway(_) => Self::Hallway,
            Place::Unknown(_) => Self::Unknown,
            Place::Junction(junction) => {
                let doors: Vec<_> = junction.doors.iter().map(|door| door.direction).collect();
                Form::of(&doors).map_or(Self::Other, Self::Junction)
            }
        }
    }
}

impl fmt::Display for Form {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.pad(match self {
            Self::DeadEnd => "dead-end",
            Self::LeftL => "l-left",
            Self::RightL => "l-right",
            Self::StemT => "t-by-stem",
            Self::StemLeftT => "t-stem-left",
            Self::StemRightT => "t-stem-right",
        })
    }
}

impl fmt::Display for Class {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Hallway => out.pad("hallway"),
            Self::Junction(form) => form.fmt(out),
            Self::Other => out.pad("other"),
            Self::Unknown => out.pad("unknown"),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn forms_are_those_of_the_design_page() {
        let (left, ahead, right, behind) = (FRAC_PI_2, 0.0, -FRAC_PI_2, PI);
        let cases: [(&[f64], _); 9] = [
            (&[behind], Some(Form::DeadEnd)),
            (&[behind, left], Some(Form::LeftL)),
            (&[behind, right], Some(Form::RightL)),
            (&[behind, left, right], Some(Form::StemT)),
            (&[behind, left, ahead], Some(Form::StemLeftT)),
            (&[behind, ahead, right], Some(Form::StemRightT)),
            (&[behind, ahead], None),
            (&[behind, right, left], None),
            (&[], None),
        ];
        for (doors, form) in cases {
            for turn in [-3.0, -0.4, 0.0, 0.4, 2.0] {
                // The same doors, seen by a robot that has turned, and measured a little wrong.
                let turned: Vec<_> = doors.iter().map(|door| door + turn * 1.01).collect();
                assert_eq!(Form::of(&turned), form, "{doors:?} {turn}");
            }
        }
    }

    #[test]
    fn every_form_has_a_class_and_every_class_a_name() {
        for form in Form::ALL {
            assert!(Class::ALL.contains(&Class::Junction(form)));
        }
        let names: std::collections::BTreeSet<_> = Class::ALL.map(|class| class.to_string()).into();
        assert_eq!(names.len(), Class::ALL.len());
    }
}
