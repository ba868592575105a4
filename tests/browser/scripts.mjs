// Runs the rules of the pages on cases, without a browser.
//
//   node scripts.mjs SCRIPTS CASES
//
// SCRIPTS is the folder of the scripts. CASES has one JSON object a line, with the name of a rule in `rule`. The answer is
// one line for each:
//
//   judge     `right` or the kind of fault of a map
//   fold      the number of open doors of the folded trail of a walk with a directional marker
//   sightings what the robot senses in each pose, as a list
//   map       what a robot senses on the map of a walk, at the start and after each action, if all that is true is claimed
//   walk      before and after each action of a walk: the state of the robot, its percept, and what it can do
//   other     the smallest other world that explains a walk, as lists; or null
//   compare   of two worlds: the shortest walk that distinguishes them, or the number of pairs of states that the robots can
//             reach; and the pose in which the second robot begins

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";

const [folder, cases] = process.argv.slice(2);
const scripts = ["graph.js", "marker.js", "walk_state.js", "play_map.js", "play_judge.js", "play_search.js", "comparison.js"];
const source = scripts.map((name) => readFileSync(join(folder, name), "utf8")).join("\n");
const names = "Graph, FoldedMap, WorldSearch, foldedTrail, faultOf, Robot, WalkState, compareWorlds";
const { Graph, FoldedMap, WorldSearch, foldedTrail, faultOf, Robot, WalkState, compareWorlds } = new Function(
  `${source}\nreturn { ${names} };`,
)();

const rules = {
  judge({ map, pose, world, start, truth }) {
    const graphs = [map, world].map(Graph.of);
    const [at, facing, robot] = [graphs[0].dart(pose), graphs[1].dart(start), graphs[1].dart(truth)];
    return faultOf(graphs[0], at, graphs[1], facing, robot)?.kind ?? "right";
  },
  fold({ percepts, actions }) {
    return String(foldedTrail(percepts, actions).open().length);
  },
  sightings({ marker, world, facing }) {
    const graph = Graph.of(world);
    const { aid, placed } = Robot.start(marker, graph, graph.dart(facing));
    const all = graph.far.map((_, pose) => aid.sightings(graph, placed, pose));
    assert.ok(all.every((possible) => possible.length === 1));
    return JSON.stringify(all.flat());
  },
  map({ marker, world, actions }) {
    const graph = Graph.of(world);
    const robots = [Robot.start(marker, graph, 0)];
    for (const action of actions) robots.push(robots.at(-1).after(action));
    const percepts = robots.map((robot) => robot.percept());
    const { others } = robots[0].aid;
    const posesOf = (robot) => [robot.pose, ...robot.placed.slice(0, others)];
    const firstAt = new Map();
    const claims = robots.flatMap((robot, time) =>
      posesOf(robot).flatMap((pose, number) => {
        const vertex = graph.vertex(pose);
        if (!firstAt.has(vertex)) firstAt.set(vertex, { pose, time, number });
        const first = firstAt.get(vertex);
        return [[[first.time, graph.door(first.pose, pose), first.number], [time, 0, number]]];
      }),
    );
    // Nothing that is true is refused, whatever is claimed of it, and whenever.
    for (let time = actions.length % 5; time <= actions.length; time += 5) {
      const known = claims.filter(([, [claimed]]) => claimed <= time);
      for (const some of [0, 2, 3]) {
        const made = known.filter((_, number) => some > 0 && (number * 7) % some === 0);
        new FoldedMap(marker, percepts.slice(0, time + 1), actions.slice(0, time), made);
      }
    }
    const map = new FoldedMap(marker, percepts, actions, claims);
    const { aid } = robots[0];
    return JSON.stringify(
      robots.map((_, time) => {
        const possible = aid.sightings(map.graph, map.placed[time], map.poses[time]);
        // Where an edge with a marker at its end was not traversed, the map leaves open what is there.
        return possible.find((sighting) => sighting === percepts[time].sighting) ?? possible[0];
      }),
    );
  },
  walk({ marker, world, vertices, facing, actions }) {
    const graph = Graph.of(world);
    const states = [new WalkState({ graph, vertices }, Robot.start(marker, graph, graph.dart(facing)))];
    for (const action of actions) {
      const before = states.at(-1);
      const text = before.text;
      states.push(before.actions.get(action));
      assert.equal(before.text, text, "an action leaves the state before it as it was");
    }
    for (const { words, robot } of states) {
      assert.ok(words.length > 0 && !/undefined|null|NaN/.test(words), words);
      for (const { dart, drawn } of robot.parts) assert.ok(graph.vertex(dart) !== undefined && drawn !== undefined);
    }
    return JSON.stringify(states.map((state) => [state.text, state.percept, [...state.actions.keys()]]));
  },
  other({ marker, world, percepts, actions }) {
    const truth = Graph.of(world);
    const search = new WorldSearch(marker, percepts, actions, (graph) => faultOf(graph, 0, truth, 0, 0) === null);
    const found = search.run();
    assert.ok(found.isSmallest || found.isComplete, "the search reached its limit");
    if (marker === "directional" && found.world !== null) {
      // If the search reaches its limit, the folded trail still shows a world.
      const world = search.closing(foldedTrail(percepts, actions));
      assert.ok(world !== null && !search.isTrue(world) && search.explains(world));
      assert.ok(world.dartCount >= found.world.dartCount);
    }
    return JSON.stringify(found.world?.lists() ?? null);
  },
  compare({ marker, worlds, facings }) {
    const graphs = worlds.map(Graph.of);
    const ends = graphs.map((graph, side) => [graph, graph.dart(facings[side])]);
    const { walk, pairs, robots } = compareWorlds(marker, ends);
    return JSON.stringify([walk?.join(" ") ?? pairs.length, robots[1].pose]);
  },
};

const lines = readFileSync(cases, "utf8").trimEnd().split("\n").map((line) => JSON.parse(line));
process.stdout.write(lines.map((line) => `${rules[line.rule](line)}\n`).join(""));
