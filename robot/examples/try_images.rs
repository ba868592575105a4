//! try
#![allow(missing_docs, clippy::all)]
use rand::SeedableRng;
use rayon::prelude::*;
use std::sync::Arc;
use toposlam_model::{floor_plan::*, mapping::DEFAULT_DART_BOUND};
use toposlam_robot::{
    evaluation::{learned, plans, random_plan::random_plan, view::WhichEffects, views::Views},
    explorer::*,
    run::*,
    simulator::*,
};
use toposlam_vision::{camera, sensing::Sensor};
struct Talk(bool, usize, usize);
impl<C: Camera> Observer<SimulatedRobot<C>> for Talk {
    fn round(&mut self, robot: &SimulatedRobot<C>, r: &Round<C::View>) {
        if matches!(r.scene.place, toposlam_model::driving::scene::Place::Unknown(_)) {
            self.1 += 1;
        }
        self.2 += 1;
        if self.0 {
            let p = robot.pose();
            println!(
                "{} {:?} pose {:.2?} {:.1} odo {:.2?} {:.1} {:?} -> {:?}",
                r.moves,
                r.state,
                p.position,
                p.heading.to_degrees(),
                r.odometry.position,
                r.odometry.heading.to_degrees(),
                r.scene,
                r.step
            )
        }
    }
}
fn main() {
    let args: Vec<u64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let size = if args.get(3) == Some(&1) { [1280, 960] } else { [640, 480] };
    let talk = args.get(2).copied().filter(|&t| t < 9999);
    let cam = camera::Camera::superscout().sized(size);
    let rig = Arc::new(Rig::new(&cam));
    let views = Views {
        seed: 1,
        plans: plans().unwrap(),
        random_plans: true,
        looks: LOOKS.iter().collect(),
        sizes: vec![size],
        effects: WhichEffects::Default,
    };
    let models: Vec<_> =
        LOOKS.par_iter().map(|l| learned(&views, l, &cam, &rig).unwrap()).collect();
    let mut all: Vec<(String, Arc<FloorPlan>)> = plans().unwrap();
    all.retain(|(n, _)| n != "building-25");
    for s in args[0]..args[1] {
        all.push((format!("random-{s}"), Arc::new(random_plan(s).unwrap())));
    }
    let mut jobs = vec![];
    for (name, plan) in &all {
        let g = plan.graph();
        let ls: Vec<_> =
            g.darts().filter(|d| plan.junction(g.vertex(*d)).kind == JunctionKind::L).collect();
        for (i, facing) in
            ls.iter().enumerate().filter(|(i, _)| name.starts_with("shape") || i % 4 == 0)
        {
            jobs.push((jobs.len() as u64, name.clone(), plan.clone(), *facing, i));
        }
    }
    let t0 = std::time::Instant::now();
    let rows: Vec<_> = jobs
        .par_iter()
        .with_max_len(1)
        .map(|(n, name, plan, facing, _)| {
            if talk.is_some_and(|t| t != *n) {
                return (true, 0, 0, 0);
            }
            let s = n * 7919 + args[0];
            let look = (s % LOOKS.len() as u64) as usize;
            let effects = Effects::drawn(&mut rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(s));
            let building = Building::new(plan, &LOOKS[look], Some(*facing), &effects, s);
            let camera = RenderingCamera::new(rig.clone(), building, effects, s);
            let robot = SimulatedRobot::new(
                plan.clone(),
                start_pose(plan, *facing),
                camera,
                &MotionNoise::DEFAULT,
                0.3,
                s,
            );
            let (run, _, obs) = run(
                plan,
                *facing,
                robot,
                Sensor::new(&cam, &models[look]),
                Talk(talk.is_some(), 0, 0),
                &mut (),
                DEFAULT_DART_BOUND,
            );
            println!(
                "{n}: {name} {facing:?} {} moves {} pictures {} unknown {} {}: {}",
                LOOKS[look].name,
                run.exploration.moves(),
                run.pictures,
                obs.1,
                if run.ending() == Ending::Right { "ok" } else { "FAIL" },
                run.ending()
            );
            (run.ending() == Ending::Right, run.pictures, run.exploration.moves(), obs.1)
        })
        .collect();
    println!(
        "{} of {} right, pictures {}, moves {}, {:?}",
        rows.iter().filter(|r| r.0).count(),
        rows.len(),
        rows.iter().map(|r| r.1).sum::<u64>(),
        rows.iter().map(|r| r.2).sum::<u64>(),
        t0.elapsed()
    );
}
