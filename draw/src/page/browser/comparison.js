// Two robots that do the same in two worlds: the walk that distinguishes the worlds, or all pairs of states that the robots
// can be in.

/** The most pairs of states that are looked at: for more, a page would have to be waited for. */
const MOST_PAIRS = 100_000;

/** The poses in which the robot may begin, given the aid: the facing dart, then the others in their order. */
const startsOf = (marker, graph, facing) => [...new Set([facing, ...AIDS[marker].starts(graph, facing)])];

/**
 * Compares what two robots perceive: `walk` is the shortest one on which they perceive something different, the least of
 * several; `pairs` are those of all robots that they can become, if there is none. Both are null if these are more than
 * `most`. `looked` is the number of pairs that were looked at.
 */
function compareRobots(robots, most) {
  const steps = [{ robots, before: null, action: null }];
  const key = (pair) => pair.map((robot) => `${robot.pose} ${robot.placed}`).join(" ");
  const seen = new Set([key(robots)]);
  for (const step of steps) {
    const [here, there] = step.robots.map((robot) => perceptText(robot.percept()));
    if (here !== there) return { walk: walkTo(step), pairs: null, looked: steps.length };
    if (steps.length > most) return { walk: null, pairs: null, looked: steps.length };
    for (const action of step.robots[0].actions()) {
      const after = step.robots.map((robot) => robot.after(action));
      if (seen.has(key(after))) continue;
      seen.add(key(after));
      steps.push({ robots: after, before: step, action });
    }
  }
  return { walk: null, pairs: steps.map((step) => step.robots), looked: steps.length };
}

function walkTo(step) {
  return step.before === null ? [] : [...walkTo(step.before), step.action];
}

/**
 * Compares the worlds `[graph, facing]` with a marker. The robot of the second one begins in the first pose from which no
 * walk distinguishes the worlds, or else by its facing dart.
 */
function compareWorlds(marker, [[graph, facing], [other, otherFacing]], poses = startsOf(marker, other, otherFacing)) {
  let left = MOST_PAIRS;
  let first;
  for (const pose of poses) {
    const robots = [Robot.start(marker, graph, facing), Robot.start(marker, other, pose, otherFacing)];
    const found = { robots, ...compareRobots(robots, left) };
    if (found.walk === null) return found;
    first ??= found;
    left -= found.looked;
  }
  return first;
}
