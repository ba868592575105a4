//! Mapping with a string that is too short for [`ThreadRun`](super::ThreadRun).
//!
//! Laid over one edge, a string is a directed edge: its fixed end is at the start vertex, where it runs through the facing
//! door. So the folding explorer maps with it, after two moves in which the robot lays it. Over a loop it runs through
//! two doors at the fixed end; each time it comes there, the robot takes the free end in its hand to see which is which.

use super::{
    Explorer, ExplorerInfo, FoldingRun, FoldingStep, InvalidStep, MapWalk, Mapped, MappingError,
    MappingEvent, MovableEvent, ObservedWorld, StepPurpose, movable_markers::handle,
};
use crate::{
    aid::{AidAction, AidKind, string::LaidString},
    folding::ArrivalSenses,
    percept::{Door, Percept, Sighting, StringView},
    world::World,
};

/// The moves in which the string is laid.
const LAYING: u64 = 2;

/// The state of a run with a short string.
#[derive(Clone, Debug)]
pub struct ShortStringRun {
    string: LaidString,
    run: FoldingRun,
}

impl ShortStringRun {
    /// A state ready for a run with this string.
    pub(crate) fn with(string: LaidString) -> Self {
        Self { string, run: FoldingRun::default() }
    }
}

impl From<ShortStringRun> for MapWalk {
    fn from(run: ShortStringRun) -> Self {
        run.run.into()
    }
}

impl Explorer for ShortStringRun {
    type Aid = AidKind;
    type Choice = FoldingStep;

    fn info(&self) -> ExplorerInfo {
        ExplorerInfo { option: self.aid().name(), ..self.run.info() }
    }

    fn aid(&self) -> AidKind {
        AidKind::String(self.string)
    }

    fn limit_darts(&mut self, max_darts: usize) {
        self.run.limit_darts(max_darts);
    }

    fn begin<W: ObservedWorld>(&mut self, world: &mut W) -> Mapped<W> {
        let mut world = AsMarker { world };
        self.run.clear();
        world.lay(self.run.walk())?;
        self.run.begin_after(LAYING, &mut world)
    }

    fn choose(&mut self) -> Result<Option<FoldingStep>, InvalidStep> {
        self.run.choose()
    }

    fn add_choices(&mut self, choices: &mut Vec<FoldingStep>) -> Result<(), InvalidStep> {
        self.run.add_choices(choices)
    }

    fn approach<W: ObservedWorld>(&mut self, choice: FoldingStep, world: &mut W) -> Mapped<W> {
        self.run.approach(choice, &mut AsMarker { world })
    }

    fn step<W: ObservedWorld>(&mut self, choice: FoldingStep, world: &mut W) -> Mapped<W> {
        self.run.step(choice, &mut AsMarker { world })
    }

    fn map_walk(&self) -> Option<&MapWalk> {
        self.run.map_walk()
    }

    fn purpose(&self, choice: Option<FoldingStep>) -> StepPurpose {
        self.run.purpose(choice)
    }

    /// That of the folding explorer, and 2.
    fn move_bound(&self, edges: usize, vertices: usize) -> u64 {
        self.run.move_bound(edges, vertices).saturating_add(LAYING)
    }
}

/// A world with a string, which is seen as a directional marker that points along the door over which it lies.
struct AsMarker<'w, W> {
    world: &'w mut W,
}

impl<W: ObservedWorld> AsMarker<'_, W> {
    /// Lays the string over the edge behind the robot, and comes back.
    fn lay(&mut self, walk: &MapWalk) -> Mapped<W> {
        self.traverse(Door::BACK).map_err(MappingError::World)?;
        self.observe(walk)?;
        handle(AidAction::Drop, self.world)?;
        self.world.event(walk, MappingEvent::Movable(MovableEvent::Did(AidAction::Drop)));
        self.traverse(Door::BACK).map_err(MappingError::World)?;
        self.observe(walk)
    }

    fn observe(&mut self, walk: &MapWalk) -> Mapped<W> {
        let percept = self.world.percept().map_err(MappingError::World)?;
        self.world.event(walk, MappingEvent::Moved { door: Door::BACK, percept });
        Ok(())
    }

    fn handle(&mut self, action: AidAction) -> Result<(), W::Error> {
        self.world.handler().map_or(Ok(()), |handler| handler.handle(action))
    }

    /// At the fixed end of a string over a loop, the door through which it runs from the free end.
    fn hand(&mut self) -> Result<Option<Door>, W::Error> {
        self.handle(AidAction::PickUp)?;
        let seen = self.world.percept()?.sighting;
        self.handle(AidAction::Drop)?;
        Ok(if let Sighting::String(view) = seen { view.hand } else { None })
    }
}

impl<W: ObservedWorld> World for AsMarker<'_, W> {
    type Error = W::Error;

    fn percept(&mut self) -> Result<Percept, W::Error> {
        let percept = self.world.percept()?;
        let sighting = match percept.sighting {
            Sighting::String(StringView { doors, fixed_end: true, free_end, .. }) => {
                let hand = if free_end { self.hand()? } else { None };
                let along = doors.doors().find(|door| Some(*door) != hand);
                along.map_or(Sighting::Nothing, Sighting::Pointing)
            }
            Sighting::String(_) => Sighting::Nothing,
            other => other,
        };
        Ok(Percept { sighting, ..percept })
    }

    fn traverse(&mut self, door: Door) -> Result<(), W::Error> {
        self.world.traverse(door)
    }

    fn senses(&mut self) -> ArrivalSenses {
        self.world.senses()
    }
}

impl<W: ObservedWorld> ObservedWorld for AsMarker<'_, W> {
    fn event(&mut self, walk: &MapWalk, event: MappingEvent) {
        self.world.event(walk, event);
    }
}
