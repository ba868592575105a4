// Runs the judge of the game on cases, without a browser.
//
//   node play_judge.mjs SCRIPTS CASES
//
// SCRIPTS is the folder of the scripts. CASES has one JSON object a line: a map to judge, or a walk. The answer
// is one line for each: `right` or the kind of fault, or the number of open doors of the folded trail.

import { readFileSync } from "node:fs";
import { join } from "node:path";

const [folder, cases] = process.argv.slice(2);
const source = ["play_map.js", "play_judge.js"].map((name) => readFileSync(join(folder, name), "utf8")).join("\n");
const { FoldedMap, markerClaims, faultOf } = new Function(`${source}\nreturn { FoldedMap, markerClaims, faultOf };`)();

function answer({ map, pose, world, start, truth, percepts, doors }) {
  if (map) return faultOf({ map, pose }, world, start, truth)?.kind ?? "right";
  const folded = new FoldedMap(percepts, doors, markerClaims(percepts)).asLists();
  return String(folded.map.flat().filter((end) => end === null).length);
}

const lines = readFileSync(cases, "utf8").trimEnd().split("\n");
process.stdout.write(lines.map((line) => `${answer(JSON.parse(line))}\n`).join(""));
