//! Certificates that no robot can tell two placed worlds apart: what the verifier accepts is a
//! bisimulation, and what a bisimulation relates perceives the same for ever. Section 2.2.

use toposlam_model::{
    ambiguity::{Comparison, Relation},
    embedded_graph::Dart,
    marker::{MARKERS, Marker, Undirected},
    world::{Action, GraphWorld, State},
};

use crate::{
    choose::{Case, Choose, Exhibit, claim, given},
    definition::is_bisimulation,
    draw,
    lemma::declare,
    lemmas::figure_1,
};

declare! {
    related_states_perceive_the_same_for_ever {
        "Robots whose states are related by a relation that the verifier accepts perceive the same \
         along every door sequence.",
        paper "2.2",
        exhaustive "starts with 1 edge against starts with up to 2, each marker that stays, every \
                    relation, every walk of up to 4 moves", 484 cases:
            for_ever::<_, 1, 2, 4>;
    }
    the_verifier_accepts_exactly_bisimulations {
        "The verifier accepts a relation exactly if it is a bisimulation that relates the starts.",
        paper "2.2",
        // 7 2 (2 16 + 10 256 + 74 4096)
        exhaustive "starts with 1 edge against starts with up to 3, each marker that stays, every \
                    relation", 4_279_744 cases: verified::<_, 1, 3>;
    }
    an_altered_certificate_is_rejected {
        "A certificate from which one pair is taken, or in which one pose is altered, is accepted \
         exactly if it still is a bisimulation that relates the starts.",
        paper "2.2",
        exhaustive "any two starts with up to 2 edges that a marker of any kind cannot tell apart, \
                    every alteration", 10_142 cases: altered::<_, 1, 2>;
        sampled "starts with up to 5 edges": altered::<_, 1, 5>;
    }
    no_pair_of_the_certificate_of_figure_1_can_be_spared {
        "The certificate of Figure 1 has 32 pairs; with any one taken away it is rejected.",
        paper "2.2, Figure 1",
        exhaustive "every pair", 32 cases: spared::<_>;
    }
}

/// A marker that stays where it is.
fn immovable(choose: &mut impl Choose) -> &'static dyn Marker {
    let staying = || MARKERS.into_iter().filter(|marker| !marker.is_movable());
    let place = choose.below(staying().count() as u8);
    staying().nth(place.into()).unwrap_or(&Undirected)
}

/// Two placed worlds and a relation of their states, any at all.
macro_rules! any_relation {
    ($choose:ident, $one:ident, $other:ident, $relation:ident, $least:ident, $most:ident) => {
        let marker = immovable($choose);
        $choose.show(|| Exhibit::Value { name: "marker", value: marker.name().to_owned() });
        let one = draw::start::<$most>($choose, $least)?;
        let other = draw::start_of::<1, $most>($choose)?;
        let $one = GraphWorld::with_marker(&one, marker, Dart(0));
        let $other = GraphWorld::with_marker(&other, marker, Dart(0));
        let mut pairs = Vec::new();
        for here in one.darts() {
            for there in other.darts() {
                if $choose.below(2) == 1 {
                    let state = |world: &GraphWorld<_>, pose| State { pose, ..world.state() };
                    pairs.push((state(&$one, here), state(&$other, there)));
                }
            }
        }
        let $relation = Relation(pairs);
        $choose.show(|| shown(&$relation));
    };
}

fn shown(Relation(pairs): &Relation) -> Exhibit {
    let pair = |(here, there): &(State, State)| {
        let placed = |state: &State| match state.placed {
            Some(dart) => format!("{} (marker at {})", state.pose.0, dart.0),
            None => format!("{} (carrying)", state.pose.0),
        };
        format!("{} ~ {}", placed(here), placed(there))
    };
    let value = pairs.iter().map(pair).collect::<Vec<_>>().join("; ");
    Exhibit::Value { name: "relation", value }
}

fn for_ever<C: Choose, const LEAST: usize, const MOST: usize, const MOVES: usize>(
    choose: &mut C,
) -> Case {
    any_relation!(choose, one, other, relation, LEAST, MOST);
    given(choose, relation.verify(&one, &other))?;
    let (mut here, mut there) = (one.clone(), other.clone());
    let mut doors = Vec::new();
    let moves = choose.below(MOVES as u8 + 1);
    let mut agree = here.sensed() == there.sensed();
    for _ in 0..moves {
        let door = draw::door(choose, here.graph(), here.pose());
        doors.push(door);
        let action = Action::Take(door);
        agree = agree
            && here.act(action).is_ok()
            && there.act(action).is_ok()
            && here.sensed() == there.sensed();
    }
    for world in 0..2 {
        let (marker, doors) = (*one.marker(), doors.clone());
        choose.show(|| Exhibit::Walk { world, marker, pose: Dart(0), doors });
    }
    claim("they perceive the same", agree)
}

fn verified<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> Case {
    any_relation!(choose, one, other, relation, LEAST, MOST);
    let is_one = is_bisimulation(&relation.0, &one, &other);
    claim("the verifier tells it", relation.verify(&one, &other) == is_one)
}

fn altered<C: Choose, const LEAST: usize, const MOST: usize>(choose: &mut C) -> Case {
    let marker = MARKERS[usize::from(choose.below(MARKERS.len() as u8))];
    choose.show(|| Exhibit::Value { name: "marker", value: marker.name().to_owned() });
    let one = draw::start_of::<LEAST, MOST>(choose)?;
    let other = draw::start_of::<LEAST, MOST>(choose)?;
    let comparison = Comparison::new(marker, (&one, Dart(0)), (&other, Dart(0)));
    let relation = comparison.relation([Dart(0), Dart(0)]);
    given(choose, relation.as_ref().is_some_and(|relation| relation.0.len() < 255))?;
    let Some(mut relation) = relation else { return Ok(()) };
    let [one, other] = comparison.starts([Dart(0), Dart(0)]);
    claim("it is accepted as it is", relation.verify(&one, &other))?;
    let place = usize::from(choose.below(relation.0.len() as u8));
    // A dart of either world, or one that neither has.
    let dart = |choose: &mut C| Dart(choose.below(2 * MOST as u8 + 1).into());
    match choose.below(3) {
        0 => {
            relation.0.remove(place);
        }
        1 => relation.0[place].0.pose = dart(choose),
        _ => relation.0[place].1.pose = dart(choose),
    }
    choose.show(|| shown(&relation));
    let is_one = is_bisimulation(&relation.0, &one, &other);
    claim("it is accepted exactly if it still is one", relation.verify(&one, &other) == is_one)
}

// paper: marker.undirected-insufficient
fn spared<C: Choose>(choose: &mut C) -> Case {
    let [one, other] = figure_1::worlds(choose)?;
    let comparison = Comparison::new(&Undirected, (&one, Dart(0)), (&other, Dart(0)));
    let Some(mut relation) = comparison.relation([Dart(0), Dart(0)]) else {
        return claim("no walk tells the worlds apart", false);
    };
    let [one, other] = comparison.starts([Dart(0), Dart(0)]);
    claim("the certificate has 32 pairs", relation.0.len() == 32)?;
    claim("it is accepted", relation.verify(&one, &other))?;
    claim("it is a bisimulation", is_bisimulation(&relation.0, &one, &other))?;
    relation.0.remove(usize::from(choose.below(32)));
    choose.show(|| shown(&relation));
    claim("with a pair less it is rejected", !relation.verify(&one, &other))
}
