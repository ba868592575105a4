// Judges a map: is it isomorphic to the world as a start, and is the robot where the map says? A bijection of two starts
// is forced: facing goes to facing, and the rest follows door by door.

/**
 * What is wrong with a map, or null. Dart 0 of the map is the facing dart, `start` is that of the world. `pose` is the
 * robot's dart in the map, `truth` that in the world.
 */
function faultOf(map, pose, world, start, truth) {
  const [open] = map.open();
  if (open !== undefined) return { kind: "open", vertex: map.vertex(open) };
  if (map.degree(0) !== world.degree(start)) return { kind: "degree", vertex: 0, degree: world.degree(start) };
  /** The image of the first dart of each vertex. */
  const images = new Map([[0, start]]);
  const image = (dart) => world.turned(images.get(map.vertex(dart)), map.index(dart));
  const left = [0];
  while (left.length > 0) {
    for (const dart of map.darts(left.shift())) {
      const entry = map.opposite(dart);
      const vertex = map.vertex(entry);
      const arrived = world.opposite(image(dart));
      const degree = world.degree(arrived);
      if (map.degree(entry) !== degree) return { kind: "degree", vertex, degree };
      const first = world.turned(arrived, degree - map.index(entry));
      const known = images.get(vertex);
      if (known === undefined) {
        images.set(vertex, first);
        left.push(vertex);
      } else if (known !== first) {
        return { kind: "several", vertex };
      }
    }
  }
  const places = new Map();
  for (const [vertex, dart] of images) {
    const place = world.vertex(dart);
    if (places.has(place)) return { kind: "twice", vertices: [places.get(place), vertex] };
    places.set(place, vertex);
  }
  return image(pose) === truth ? null : { kind: "pose" };
}
