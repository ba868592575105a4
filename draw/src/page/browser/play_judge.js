// Judges a map: is it isomorphic to the world as a start, and is the robot where the map says? A bijection of
// two starts is forced: facing goes to facing, and the rest follows door by door.

/**
 * What is wrong with a map, or null. `map` and `world` have, for each vertex and each dart clockwise, the vertex
 * and the index of its other end, or null. Dart 0 of vertex 0 of the map is the facing dart, `start` is that of
 * the world. `pose` is the robot's dart in the map, `truth` that in the world.
 */
function faultOf({ map, pose }, world, start, truth) {
  const open = map.findIndex((ends) => ends.includes(null));
  if (open >= 0) return { kind: "open", vertex: open };
  const images = new Map([[0, start]]);
  const image = ([v, i]) => {
    const [w, turn] = images.get(v);
    return [w, (i + turn) % world[w].length];
  };
  const left = [0];
  if (map[0].length !== world[start[0]].length) return { kind: "degree", vertex: 0, degree: world[start[0]].length };
  while (left.length > 0) {
    const vertex = left.shift();
    for (const [index, [to, entry]] of map[vertex].entries()) {
      const [w, i] = image([vertex, index]);
      const [there, arrived] = world[w][i];
      const degree = world[there].length;
      if (map[to].length !== degree) return { kind: "degree", vertex: to, degree };
      const turn = (arrived - entry + degree) % degree;
      const known = images.get(to);
      if (known === undefined) {
        images.set(to, [there, turn]);
        left.push(to);
      } else if (known[0] !== there || known[1] !== turn) {
        return { kind: "several", vertex: to };
      }
    }
  }
  const places = new Map();
  for (const [vertex, [w]] of images) {
    if (places.has(w)) return { kind: "twice", vertices: [places.get(w), vertex] };
    places.set(w, vertex);
  }
  const [w, i] = image(pose);
  return w === truth[0] && i === truth[1] ? null : { kind: "pose" };
}
