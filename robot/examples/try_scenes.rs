//! try
#![allow(missing_docs, clippy::all)]
use std::sync::Arc;
use toposlam_model::{floor_plan::*, mapping::DEFAULT_DART_BOUND};
use toposlam_robot::{
    evaluation::{plans, random_plan::random_plan},
    explorer::*,
    robot::Robot,
    run::*,
    simulator::*,
};
struct Talk(bool);
impl<R: Robot> Observer<R> for Talk
where
    R: Posed,
{
    fn round(&mut self, robot: &R, r: &Round<R::View>) {
        if self.0 {
            println!(
                "{} {:?} pose {} odo {:.2?} {:.1} {:?} -> {:?}",
                r.moves,
                r.state,
                robot.posed(),
                r.odometry.position,
                r.odometry.heading.to_degrees(),
                r.scene,
                r.step
            )
        }
    }
}
trait Posed {
    fn posed(&self) -> String;
}
impl<C: Camera> Posed for SimulatedRobot<C> {
    fn posed(&self) -> String {
        let p = self.pose();
        format!("{:.2?} {:.1}", p.position, p.heading.to_degrees())
    }
}
fn main() {
    let args: Vec<u64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let talk = args.get(2).copied();
    let mut all: Vec<(String, Arc<FloorPlan>)> = plans().unwrap();
    for s in args[0]..args[1] {
        all.push((format!("random-{s}"), Arc::new(random_plan(s).unwrap())));
    }
    let (mut runs, mut right, mut moves, mut pics) = (0, 0, 0, 0);
    for (name, plan) in &all {
        let g = plan.graph();
        for facing in g.darts().filter(|d| plan.junction(g.vertex(*d)).kind == JunctionKind::L) {
            for seed in 0..2u64 {
                let s = seed * 1000 + u64::from(facing.0);
                let camera = SceneCamera::new(plan.clone(), Some(facing), 1.0, s);
                let robot = SimulatedRobot::new(
                    plan.clone(),
                    start_pose(plan, facing),
                    camera,
                    &MotionNoise::DEFAULT,
                    0.3,
                    s,
                );
                let t = talk.is_some_and(|t| t == runs);
                let (run, _, _) =
                    run(plan, facing, robot, Told, Talk(t), &mut (), DEFAULT_DART_BOUND);
                if run.ending() == Ending::Right {
                    right += 1
                } else {
                    println!("{runs}: {name} {facing:?} {seed}: {}", run.ending());
                }
                if t {
                    return;
                }
                runs += 1;
                moves += run.exploration.moves();
                pics += run.pictures;
            }
        }
    }
    println!("{right}/{runs} moves {moves} pictures {pics}");
}
