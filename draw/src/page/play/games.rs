//! The worlds of a game: random starts of a class, or the starts of one world.

use std::ops::ControlFlow;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use thiserror::Error;
use toposlam_model::{
    counts::counted,
    embedded_graph::Dart,
    enumerate::{Class, Each, Enumeration, SizeError, Watch},
    format::named_world::NamedWorld,
    isomorphism::canonical,
};

/// The most worlds of a page.
const MOST: usize = 12;

#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NoGame {
    #[error(transparent)]
    Size(#[from] SizeError),
    #[error("class {class} has no world with {}", counted(*edges, "edge"))]
    EmptyClass { class: Class, edges: usize },
    #[error("interrupted")]
    Interrupted,
}

/// Random starts of a class with a number of edges, each equally likely, none twice. The start of each is dart 0.
///
/// # Errors
/// Returns an error if there is none, or if the watch stops the search.
pub fn random_games(
    class: Class,
    edges: usize,
    seed: u64,
    watch: &dyn Watch,
) -> Result<Vec<NamedWorld>, NoGame> {
    let starts = Enumeration::new(Each::Start, class, edges)?;
    let mut count: u64 = 0;
    let counting = starts.for_each(&mut |_| {
        count += 1;
        // It takes seconds to count many starts.
        let stops = count.is_multiple_of(1 << 16) && watch.stop();
        if stops { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    if counting.is_break() {
        return Err(NoGame::Interrupted);
    }
    if count == 0 {
        return Err(NoGame::EmptyClass { class, edges });
    }
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut chosen: Vec<u64> = Vec::new();
    while chosen.len() < MOST.min(count.try_into().unwrap_or(MOST)) {
        let number = random.random_range(0..count);
        if !chosen.contains(&number) {
            chosen.push(number);
        }
    }
    let mut games = vec![None; chosen.len()];
    let mut number = 0;
    let _ = starts.for_each(&mut |found| {
        if let Some(place) = chosen.iter().position(|&one| one == number) {
            let suffix = if place == 0 { String::new() } else { format!("-{}", place + 1) };
            let name = format!("{class}-{edges}-{seed}{suffix}");
            let graph = found.graph.clone();
            games[place] = Some(NamedWorld::numbered(&name, "", graph, Some(Dart(0))));
        }
        number += 1;
        let is_done = games.iter().all(Option::is_some);
        if is_done { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    Ok(games.into_iter().flatten().collect())
}

/// The same world with other starts: first the given one, then others that no automorphism relates to it or to each other.
pub fn games_of(world: &NamedWorld, facing: Dart) -> Vec<NamedWorld> {
    let orbits = canonical(&world.graph).orbit;
    let is_other = |dart: &Dart| orbits[dart.at()] == *dart && orbits[facing.at()] != *dart;
    let others: Vec<Dart> = world.graph.darts().filter(is_other).collect();
    let count = others.len().min(MOST - 1);
    let spread = (0..count).map(|place| others[place * others.len() / count]);
    let starts = [facing].into_iter().chain(spread);
    starts.map(|start| NamedWorld { start: Some(start), ..world.clone() }).collect()
}

#[cfg(test)]
mod tests {
    use toposlam_model::{embedded_graph::EmbeddedGraph, isomorphism::code};

    use super::*;

    fn codes(games: &[NamedWorld]) -> std::collections::BTreeSet<Vec<u32>> {
        let code_of = |game: &NamedWorld| code(&game.graph, game.start.unwrap()).words().to_vec();
        games.iter().map(code_of).collect()
    }

    /// There are 2 starts with 1 edge and 10 with 2; with 3 there are 74.
    #[test]
    fn random_games_are_different_starts_and_the_same_for_a_seed() {
        for (edges, count) in [(1, 2), (2, 10), (3, MOST)] {
            let games = random_games(Class::Multigraph, edges, 5, &()).unwrap();
            assert_eq!((games.len(), codes(&games).len()), (count, count));
            assert_eq!(games, random_games(Class::Multigraph, edges, 5, &()).unwrap());
            assert!(games.iter().all(|game| game.graph.edge_count() == edges));
        }
        let of_seed = |seed| codes(&random_games(Class::Multigraph, 6, seed, &()).unwrap());
        assert_ne!(of_seed(1), of_seed(2));
        let none = random_games(Class::Planar, 0, 1, &());
        assert_eq!(none.unwrap_err().to_string(), "a world has at least one edge");
    }

    #[test]
    fn the_starts_of_a_world_are_not_related_by_an_automorphism() {
        // A path with 2 edges: its ends are alike, and so are the darts of its middle.
        let lists = [("a", vec!["m"]), ("m", vec!["a", "b"]), ("b", vec!["m"])];
        let path = EmbeddedGraph::from_neighbour_lists(&lists).unwrap();
        let world = NamedWorld::numbered("path", "", path, None);
        for facing in world.graph.darts() {
            let games = games_of(&world, facing);
            assert_eq!((games.len(), codes(&games).len()), (2, 2));
            assert_eq!(games[0].start, Some(facing));
        }
    }
}
