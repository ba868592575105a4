//! Certificates that no robot can distinguish two placed worlds: the verifier accepts exactly
//! bisimulations, and related robots perceive the same for ever. Section 2.2.

use toposlam_model::{
    aid::{AidKind, AnyAid, FEW_STATES, Places, State},
    ambiguity::{Comparison, PlacedRobot, Relation},
    embedded_graph::{Dart, EmbeddedGraph},
    marker::Undirected,
    world::GraphWorld,
};

use crate::{
    choose::{CaseResult, Choose, Exhibit, Stop, claim, given},
    definition::is_bisimulation,
    draw,
    lemma::declare,
    lemmas::figure_1,
};

declare! {
    related_states_perceive_the_same_for_ever {
        "If the verifier accepts a relation, then robots in related states perceive the same, \
         whatever both do.",
        paper "2.2",
        exhaustive "any two starts with up to 2 edges that a marker of any kind cannot distinguish, \
                    any related states, up to 3 actions", 70_256 cases:
            for_ever::<_, 1, 2, 3>;
        sampled "starts with up to 5 edges, up to 20 actions": for_ever::<_, 1, 5, 20>;
    }
    the_verifier_accepts_exactly_bisimulations {
        "The verifier accepts a relation exactly if it is a bisimulation that relates the starts.",
        paper "2.2",
        // 7 2 (2 16 + 10 256 + 74 4096)
        exhaustive "starts with 1 edge against starts with up to 3, each marker that stays, every \
                    relation of poses", 4_279_744 cases:
            verified::<_, 1, 3>;
    }
    an_altered_certificate_is_rejected {
        "A certificate with one pair removed, altered or added, or with the marker elsewhere, is \
         accepted exactly if it is still a bisimulation that relates the starts.",
        paper "2.2",
        // 922 pairs, each taken away, or altered or joined by an altered one in 30 + 30 + 25 + 36 ways;
        // and 128 certificates with the marker in 36 places.
        exhaustive "any two starts with up to 2 edges that a marker of any kind cannot distinguish; \
                    one state, both poses, or both places of the marker altered, or those of all \
                    pairs", 228_654 cases:
            altered::<_, 1, 2>;
        sampled "starts with up to 5 edges": altered::<_, 1, 5>;
    }
    no_pair_of_the_certificate_of_figure_1_can_be_spared {
        "The certificate of Figure 1 has 32 pairs; without any one of them it is rejected.",
        paper "2.2, Figure 1",
        exhaustive "every pair", 32 cases: spared::<_>;
    }
}

fn marker(choose: &mut impl Choose, of: impl Fn(AidKind) -> bool) -> AidKind {
    let kinds = || FEW_STATES.iter().copied().filter(|&marker| of(marker));
    let place = choose.below(kinds().count() as u8);
    let marker = kinds().nth(place.into()).unwrap_or(Undirected.into());
    choose.show(|| Exhibit::Value { name: "marker", value: marker.name().to_owned() });
    marker
}

/// Two starts that the marker cannot distinguish, their comparison, and its certificate.
fn certified<'g, C: Choose>(
    choose: &mut C,
    marker: AidKind,
    [one, other]: [&'g EmbeddedGraph; 2],
) -> Result<([PlacedRobot<'g>; 2], Relation), Stop> {
    let comparison = Comparison::new(marker, (one, Dart(0)), (other, Dart(0)));
    let relation = comparison.relation([Dart(0), Dart(0)]);
    given(choose, relation.as_ref().is_some_and(|Relation(pairs)| pairs.len() < 255))?;
    let worlds = comparison.starts([Dart(0), Dart(0)]);
    match relation {
        Some(relation) => {
            claim("it is accepted as it is", relation.verify(&worlds[0], &worlds[1]))?;
            Ok((worlds, relation))
        }
        None => Err(Stop::Excluded),
    }
}

fn shown(Relation(pairs): &Relation) -> Exhibit {
    let pair = |(here, there): &(State<Places>, State<Places>)| {
        let placed = |state: &State<Places>| match state.placed[..] {
            [Some(dart)] => format!("{} (marker at {})", state.pose.0, dart.0),
            _ => format!("{} (carrying)", state.pose.0),
        };
        format!("{} ~ {}", placed(here), placed(there))
    };
    let value = pairs.iter().map(pair).collect::<Vec<_>>().join("; ");
    Exhibit::Value { name: "relation", value }
}

fn for_ever<C: Choose, const LEAST: usize, const MOST: usize, const ACTIONS: usize>(
    choose: &mut C,
) -> CaseResult {
    let marker = marker(choose, |_| true);
    let one = draw::start_of::<LEAST, MOST>(choose)?;
    let other = draw::start_of::<LEAST, MOST>(choose)?;
    let ([here, there], Relation(pairs)) = certified(choose, marker, [&one, &other])?;
    let (one, other) = pairs[usize::from(choose.below(pairs.len() as u8))].clone();
    let (mut here, mut there) = (here.at(one.clone()), there.at(other.clone()));
    let mut done = Vec::new();
    let mut agree = here.sensed() == there.sensed();
    for _ in 0..choose.below(ACTIONS as u8 + 1) {
        let can = here.actions();
        let action = can[usize::from(choose.below(can.len() as u8))];
        done.push(action.to_string());
        agree = agree
            && here.act(action).is_ok()
            && there.act(action).is_ok()
            && here.sensed() == there.sensed();
    }
    choose.show(|| shown(&Relation(vec![(one, other)])));
    choose.show(|| Exhibit::Value { name: "actions", value: done.join(",") });
    claim("they perceive the same", agree)
}

fn verified<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    let marker = marker(choose, |marker| !marker.moves());
    let one = draw::start::<MOST>(choose, LEAST)?;
    let other = draw::start_of::<1, MOST>(choose)?;
    let here = GraphWorld::with_aid(&one, AnyAid::from(marker), Dart(0));
    let there = GraphWorld::with_aid(&other, AnyAid::from(marker), Dart(0));
    let mut pairs = Vec::new();
    for one in one.darts() {
        for other in other.darts() {
            if choose.below(2) == 1 {
                let at = |world: &GraphWorld<_>, pose| State { pose, ..world.state() };
                pairs.push((at(&here, one), at(&there, other)));
            }
        }
    }
    let relation = Relation(pairs);
    choose.show(|| shown(&relation));
    let is_one = is_bisimulation(&relation.0, &here, &there);
    claim("the verifier finds it", relation.verify(&here, &there) == is_one)
}

fn altered<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> CaseResult {
    let marker = marker(choose, |_| true);
    let one = draw::start_of::<LEAST, MOST>(choose)?;
    let other = draw::start_of::<LEAST, MOST>(choose)?;
    let ([one, other], mut relation) = certified(choose, marker, [&one, &other])?;
    // A dart of either world, or one that neither has.
    let dart = |choose: &mut C| Dart(choose.below(2 * MOST as u8 + 1).into());
    let placed =
        |choose: &mut C| Places::from_elem((choose.below(2) == 1).then(|| dart(choose)), 1);
    match choose.below(4) {
        0 => {
            relation.0.remove(usize::from(choose.below(relation.0.len() as u8)));
        }
        1 => {
            // The whole certificate, with the marker elsewhere, or nowhere.
            let (here, there) = (placed(choose), placed(choose));
            let moved = |(one, other): &(State<Places>, State<Places>)| {
                let (one, other) = (one.clone(), other.clone());
                (State { placed: here.clone(), ..one }, State { placed: there.clone(), ..other })
            };
            relation.0.extend(relation.0.iter().map(moved).collect::<Vec<_>>());
        }
        is_added => {
            let place = usize::from(choose.below(relation.0.len() as u8));
            let (mut here, mut there) = relation.0[place].clone();
            match choose.below(4) {
                0 => here = State { pose: dart(choose), placed: placed(choose) },
                1 => there = State { pose: dart(choose), placed: placed(choose) },
                2 => (here.pose, there.pose) = (dart(choose), dart(choose)),
                _ => (here.placed, there.placed) = (placed(choose), placed(choose)),
            }
            if is_added == 2 {
                relation.0.push((here, there));
            } else {
                relation.0[place] = (here, there);
            }
        }
    }
    choose.show(|| shown(&relation));
    let is_one = is_bisimulation(&relation.0, &one, &other);
    claim("it is accepted exactly if it still is one", relation.verify(&one, &other) == is_one)
}

// paper: marker.undirected-insufficient
fn spared<C: Choose>(choose: &mut C) -> CaseResult {
    let [one, other] = figure_1::worlds(choose)?;
    let comparison = Comparison::new(AidKind::from(Undirected), (&one, Dart(0)), (&other, Dart(0)));
    let Some(mut relation) = comparison.relation([Dart(0), Dart(0)]) else {
        return claim("no walk distinguishes the worlds", false);
    };
    let [one, other] = comparison.starts([Dart(0), Dart(0)]);
    claim("the certificate has 32 pairs", relation.0.len() == 32)?;
    claim("it is accepted", relation.verify(&one, &other))?;
    claim("it is a bisimulation", is_bisimulation(&relation.0, &one, &other))?;
    relation.0.remove(usize::from(choose.below(32)));
    choose.show(|| shown(&relation));
    claim("with a pair less it is rejected", !relation.verify(&one, &other))
}
