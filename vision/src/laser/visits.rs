//! Visits of junctions: several views agree, or the visit is undecided.

use std::f64::consts::{PI, TAU};

use super::junctions::LaserJunction;
use super::params::LaserParams;

/// A junction that the robot has visited and left.
#[derive(Clone, Debug)]
pub struct Visit {
    /// The number of the view in which the robot entered it.
    pub view: usize,
    pub centre: [f64; 2],
    /// The directions of its arms, clockwise from the entry.
    pub arms: Vec<f64>,
    /// The index of the arm by which the robot left, if it did.
    pub door: Option<usize>,
    /// Whether the views agree.
    pub decided: bool,
    pub votes: Vec<(f64, f64)>,
}

#[derive(Clone, Debug)]
struct Track {
    centre: [f64; 2],
    clearance: f64,
    views: Vec<Vec<f64>>,
    seen_at: f64,
}

#[derive(Clone, Debug)]
struct Inside {
    view: usize,
    centre: [f64; 2],
    clearance: f64,
    /// The direction from the centre to where the robot came in.
    entry: Option<f64>,
    nearest: f64,
}

#[derive(Clone, Debug, Default)]
pub struct Visits {
    tracks: Vec<Track>,
    inside: Option<Inside>,
    /// Left, not decided yet, with the direction of the exit and the path when left.
    left: Vec<(Inside, Option<f64>, f64)>,
    path: f64,
    last: Option<[f64; 2]>,
    trail: Vec<[f64; 2]>,
    views: usize,
}

fn off([x, y]: [f64; 2], [u, v]: [f64; 2]) -> f64 {
    (x - u).hypot(y - v)
}
fn towards(from: [f64; 2], to: [f64; 2]) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}
pub fn wrapped(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

impl Visits {
    /// The next view. Returns the visits that are now decided.
    pub fn see(&mut self, view: usize, robot: [f64; 2], junctions: &[LaserJunction], params: &LaserParams) -> Vec<Visit> {
        if let Some(last) = self.last {
            self.path += off(last, robot);
        }
        self.last = Some(robot);
        self.trail.push(robot);
        self.views += 1;
        for junction in junctions {
            if off(junction.centre, robot) > params.view_range + junction.clearance {
                continue;
            }
            let near = self.tracks.iter_mut().filter(|track| {
                off(track.centre, junction.centre) < params.same.max(0.6 * track.clearance)
            });
            let near = near.min_by(|a, b| off(a.centre, junction.centre).total_cmp(&off(b.centre, junction.centre)));
            if let Some(track) = near {
                let n = track.views.len().min(8) as f64;
                for axis in 0..2 {
                    track.centre[axis] = (n * track.centre[axis] + junction.centre[axis]) / (n + 1.0);
                }
                track.clearance = (n * track.clearance + junction.clearance) / (n + 1.0);
                track.views.push(junction.arms.clone());
                track.seen_at = self.path;
            } else {
                self.tracks.push(Track { centre: junction.centre, clearance: junction.clearance, views: vec![junction.arms.clone()], seen_at: self.path });
            }
        }
        // A junction known nearby but not seen in this view has a view without arms.
        for track in &mut self.tracks {
            let d = off(track.centre, robot);
            if d < params.view_range + track.clearance && track.seen_at < self.path - 1e-9 && self.path - track.seen_at < 8.0 {
                track.views.push(Vec::new());
            }
        }
        if let Some(inside) = &mut self.inside {
            if let Some(track) = self.tracks.iter().find(|t| off(t.centre, inside.centre) < params.same.max(0.6 * t.clearance)) {
                inside.centre = track.centre;
                inside.clearance = track.clearance;
            }
            let d = off(inside.centre, robot);
            inside.nearest = inside.nearest.min(d);
            if d > inside.clearance.max(1.0) + params.leave {
                let exit = towards(inside.centre, robot);
                let inside = self.inside.take().unwrap_or_else(|| unreachable!());
                self.left.push((inside, Some(exit), self.path));
            }
        }
        if self.inside.is_none() {
            let entered = self.tracks.iter().filter(|track| off(track.centre, robot) < track.clearance.max(1.0) && track.views.iter().filter(|v| v.len()>=3).count()>=1 && self.path - track.seen_at < 3.0)
                .min_by(|a, b| off(a.centre, robot).total_cmp(&off(b.centre, robot)));
            if let Some(track) = entered {
                // Where the robot was last outside.
                let entry = self.trail.iter().rev().find(|&&p| off(p, track.centre) > track.clearance.max(1.0)).map(|&p| towards(track.centre, p));
                self.inside = Some(Inside { view, centre: track.centre, clearance: track.clearance, entry, nearest: off(track.centre, robot) });
            }
        }
        let ready: Vec<_> = { let path = self.path; let cut = self.left.iter().take_while(|l| path - l.2 >= params.settle).count(); self.left.drain(..cut).collect() };
        let done = ready.into_iter().filter_map(|(inside, exit, _)| self.decide(&inside, exit, params)).collect();
        if self.trail.len() > 400 { self.trail.drain(..200); }
        done
    }

    pub fn finish(&mut self, params: &LaserParams) -> Vec<Visit> {
        let mut left = std::mem::take(&mut self.left);
        if let Some(inside) = self.inside.take() { left.push((inside, None, self.path)); }
        left.into_iter().filter_map(|(inside, exit, _)| self.decide(&inside, exit, params)).collect()
    }

    fn decide(&self, inside: &Inside, exit: Option<f64>, params: &LaserParams) -> Option<Visit> {
        let track = self.tracks.iter().min_by(|a, b| off(a.centre, inside.centre).total_cmp(&off(b.centre, inside.centre)))?;
        // Directions that views agree on.
        let mut groups: Vec<(f64, f64, usize)> = Vec::new();
        let views: Vec<_> = track.views.iter().rev().take(params.last_views).collect();
        for (number, view) in views.iter().enumerate() {
            for &arm in view.iter() {
                let near = groups.iter_mut().filter(|g| wrapped(g.0 - arm).abs() < params.same_arm).min_by(|a, b| wrapped(a.0 - arm).abs().total_cmp(&wrapped(b.0 - arm).abs()));
                match near {
                    Some(group) => {
                        if group.2 != number || group.1 == 0.0 { group.1 += 1.0; }
                        group.2 = number;
                        group.0 = wrapped(group.0 + wrapped(arm - group.0) / group.1.max(1.0));
                    }
                    None => groups.push((arm, 1.0, number)),
                }
            }
        }
        let all = views.len() as f64;
        let sure = |direction: f64| [inside.entry, exit].into_iter().flatten().any(|known| wrapped(known - direction).abs() < 0.8);
        let votes: Vec<(f64, f64)> = groups.iter().map(|g| (g.0, g.1 / all)).collect();
        let mut arms: Vec<f64> = votes.iter().filter(|v| v.1 >= params.vote || sure(v.0) && v.1 >= 0.25).map(|v| v.0).collect();
        let decided = !votes.iter().any(|v| (v.1 - params.vote).abs() < 0.1 && !sure(v.0));
        if arms.len() < 3 { return None; }
        let nearest = |arms: &[f64], to: f64| (0..arms.len()).min_by(|&a, &b| wrapped(arms[a] - to).abs().total_cmp(&wrapped(arms[b] - to).abs()));
        let entry = inside.entry.and_then(|e| nearest(&arms, e)).unwrap_or(0);
        let base = arms[entry];
        arms.sort_by(|a, b| (base - a).rem_euclid(TAU).total_cmp(&(base - b).rem_euclid(TAU)));
        let door = exit.and_then(|e| nearest(&arms, e));
        Some(Visit { view: inside.view, centre: track.centre, arms, door: if inside.entry.is_some() { door } else { None }, decided, votes })
    }
}
