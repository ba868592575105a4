//! Pictures of many worlds, compared with their graphs. To look at them, name a directory:
//! `PICTURES=some/directory cargo test --release gallery`.

pub(super) mod worlds;

use std::{f64::consts::TAU, path::Path, sync::LazyLock};

use resvg::usvg::roxmltree::{Document, Node};
use toposlam_model::format::named_world::NamedWorld;
use worlds::{cycle, random};

use super::{
    Placement, WorldPicture,
    drawing::Drawing,
    geometry::{Extent, Point},
    labels::{LabelKind, labels},
    png,
    reading::{number, numbers, of_class},
    signs::signs,
    svg, text,
};

/// Reads the order off the SVG and compares it with the graph.
fn assert_doors_in_order(world: &NamedWorld, svg: &str) {
    let document = Document::parse(svg).unwrap();
    let discs = of_class(&document, "vertex").into_iter();
    let centres: Vec<[f64; 3]> =
        discs.map(|node| ["cx", "cy", "r"].map(|name| number(node, name))).collect();
    let graph = &world.graph;
    assert_eq!(centres.len(), graph.vertex_count());
    let mut angles = vec![None; graph.dart_count()];
    let mut paths = 0;
    for node in of_class(&document, "edge") {
        paths += 1;
        let darts = numbers(node.attribute("data-darts").unwrap());
        let path = numbers(node.attribute("d").unwrap());
        let at = |place: usize| [path[2 * place], path[2 * place + 1]];
        let last = path.len() / 2 - 1;
        for (dart, end, control) in [(darts[0], at(0), at(1)), (darts[1], at(last), at(last - 1))] {
            let dart = graph.darts().find(|known| (f64::from(known.0) - dart).abs() < 0.5).unwrap();
            let [x, y, r] = centres[graph.vertex(dart).at()];
            let angle = (end[1] - y).atan2(end[0] - x);
            // On the border, and straight out.
            assert!(((end[1] - y).hypot(end[0] - x) - r).abs() < 0.2, "{}", world.name);
            let out = (control[1] - end[1]).atan2(control[0] - end[0]);
            assert!((out - angle).cos() > 0.99, "{}: {dart:?}", world.name);
            assert_eq!(angles[dart.at()].replace(angle), None);
        }
    }
    assert_eq!(paths, graph.edge_count());
    for vertex in graph.vertices() {
        let degree = f64::from(graph.degree(vertex));
        let mut whole = 0.0;
        for dart in graph.darts_of(vertex) {
            let next = graph.clockwise(dart);
            if next == dart {
                continue;
            }
            // y points down: a growing angle is a clockwise turn.
            let (here, there) = (angles[dart.at()].unwrap(), angles[next.at()].unwrap());
            let gap = f64::rem_euclid(there - here, TAU);
            let least = (0.8 * TAU / degree).min(0.25);
            assert!(gap > least, "{}: {dart:?} to {next:?}: {gap}", world.name);
            whole += gap;
        }
        assert!(degree < 2.0 || (whole - TAU).abs() < 1e-6, "{}", world.name);
    }
}

/// A world of the gallery, and its drawing.
struct Drawn {
    world: NamedWorld,
    drawing: Drawing,
    svg: String,
}

/// The whole gallery, drawn once for all tests.
static GALLERY: LazyLock<Vec<Drawn>> = LazyLock::new(|| {
    let draw = |world: NamedWorld| {
        let picture = WorldPicture::from(&world);
        let drawing = Drawing::new(&picture);
        let svg = svg::document(&picture, &drawing, svg::Legend::Below);
        Drawn { world, drawing, svg }
    };
    worlds::gallery().into_iter().map(draw).collect()
});

#[test]
fn doors_stand_in_clockwise_order_in_every_picture() {
    let directory = std::env::var_os("PICTURES");
    for Drawn { world, svg, .. } in GALLERY.iter() {
        assert_doors_in_order(world, svg);
        if let Some(directory) = &directory {
            let path = Path::new(directory);
            let name = world.name.replace([' ', ',', '(', ')'], "-");
            std::fs::write(path.join(format!("{name}.svg")), svg).unwrap();
            std::fs::write(path.join(format!("{name}.png")), png(svg).unwrap()).unwrap();
        }
    }
}

#[test]
fn the_same_picture_gives_the_same_bytes() {
    for Drawn { world, svg: drawn, .. } in GALLERY.iter().take(12) {
        assert_eq!(*drawn, svg(&WorldPicture::from(world)), "{}", world.name);
    }
}

#[test]
fn doors_stand_in_clockwise_order_whatever_the_world() {
    for seed in 0..100 {
        let vertices = 1 + (seed as usize * 7) % 9;
        let world = random(100 + seed, vertices, vertices + (seed as usize) % 5);
        assert_doors_in_order(&world, &svg(&WorldPicture::from(&world)));
    }
}

fn crossings(drawing: &Drawing) -> usize {
    let mut count = 0;
    for (at, (.., one)) in drawing.edges.iter().enumerate() {
        for (.., other) in &drawing.edges[..at] {
            count += super::routes::crossings(one, other).len();
        }
    }
    count
}

#[test]
fn a_world_in_the_plane_is_drawn_without_crossings() {
    let mut planar = 0;
    for Drawn { world, drawing, .. } in GALLERY.iter() {
        if world.graph.genus() == 0 && !matches!(Placement::from(world), Placement::At(_)) {
            planar += 1;
            assert_eq!(crossings(drawing), 0, "{}", world.name);
        }
    }
    for seed in 0..250_u64 {
        let vertices = 1 + (seed as usize * 5) % 11;
        let world = random(1000 + seed, vertices, vertices + (seed as usize) % 3);
        if world.graph.genus() == 0 {
            planar += 1;
            assert_eq!(crossings(&Drawing::new(&WorldPicture::from(&world))), 0, "{}", world.name);
        }
    }
    assert!(planar > 100, "{planar}");
}

/// The edges that pass through the disc of a vertex that is not an end, each with the vertex.
fn pierced(drawing: &Drawing) -> Vec<(usize, usize)> {
    let mut pierced = Vec::new();
    for (edge, ((.., curve), ends)) in drawing.edges.iter().zip(&drawing.ends).enumerate() {
        for (vertex, centre) in drawing.centres.iter().enumerate() {
            let through = |two: &[Point]| {
                centre.distance_to_segment(two[0], two[1]) < drawing.size.discs[vertex]
            };
            if !ends.contains(&vertex) && curve.trace.windows(2).any(through) {
                pierced.push((edge, vertex));
            }
        }
    }
    pierced
}

#[test]
fn no_edge_passes_through_the_disc_of_another_vertex() {
    for Drawn { world, drawing, .. } in GALLERY.iter() {
        assert_eq!(pierced(drawing), [], "{}", world.name);
    }
}

#[test]
fn names_of_vertices_do_not_overlap_and_stand_on_the_canvas() {
    for Drawn { world, svg, .. } in GALLERY.iter() {
        let document = Document::parse(svg).unwrap();
        let root = document.root_element();
        let canvas = [number(root, "width"), number(root, "height")];
        let mut boxes: Vec<Extent> = Vec::new();
        for name in of_class(&document, "name") {
            let size = number(name, "font-size");
            let mut extent = Extent::EMPTY;
            for line in name.children().filter(Node::is_element) {
                let half = text::width(line.text().unwrap(), size) / 2.0;
                let at = Point::new(number(line, "x"), number(line, "y"));
                extent.include(at + Point::new(-half, -0.76 * size));
                extent.include(at + Point::new(half, 0.24 * size));
            }
            let name: String =
                name.descendants().filter(Node::is_text).filter_map(|node| node.text()).collect();
            assert!(extent.least.x >= 0.0 && extent.least.y >= 0.0, "{}: {name}", world.name);
            assert!(extent.most.x <= canvas[0] && extent.most.y <= canvas[1], "{name}");
            let covered = boxes.iter().any(|other| extent.shared_area(other) > 0.0);
            assert!(!covered, "{}: {name} covers another", world.name);
            boxes.push(extent);
        }
        assert_eq!(boxes.len(), world.graph.vertex_count(), "{}", world.name);
    }
}

#[test]
fn names_beside_discs_keep_clear_of_hallways_edges_and_discs() {
    let mut beside = 0;
    for Drawn { world, drawing, .. } in GALLERY.iter() {
        let picture = WorldPicture::from(world);
        let labels = labels(drawing, &picture, &signs(&picture, drawing));
        for label in labels.iter().filter(|label| label.kind == LabelKind::Beside) {
            beside += 1;
            let extent = label.extent();
            let on_floor = drawing.hallways().any(|floor| extent.shared_area(&floor) > 0.0);
            let mut curves = drawing.edges.iter().flat_map(|(.., curve)| &curve.trace);
            let on_edge = curves.any(|point| extent.contains(*point));
            assert!(!on_floor && !on_edge, "{}: {:?}", world.name, label.lines);
        }
    }
    assert!(beside > 8, "{beside}");
}

#[test]
fn the_same_positions_give_the_same_places_whatever_the_edges() {
    let positions: Vec<_> = (0..6).map(|at| [f64::from(at % 3), f64::from(at / 3)]).collect();
    let centres = |seed| {
        let mut world = random(seed, 6, 8);
        world.positions = Some(positions.clone());
        let drawing = Drawing::new(&WorldPicture::from(&world));
        assert!(drawing.floor.is_none());
        drawing.centres.iter().map(|&at| (at - drawing.centres[0]).angle()).collect::<Vec<_>>()
    };
    let first = centres(1);
    for seed in 2..6 {
        let here = centres(seed);
        assert!(first.iter().zip(here).all(|(one, other)| (one - other).abs() < 1e-9));
    }
}

#[test]
fn a_cycle_of_two_thousand_edges_is_a_circle() {
    let world = cycle(2000);
    let drawing = Drawing::new(&WorldPicture::from(&world));
    let middle = Extent::from_points(drawing.centres.iter().copied()).centre();
    let radii: Vec<_> = drawing.centres.iter().map(|at| at.distance(middle)).collect();
    assert!(radii.iter().all(|radius| (radius / radii[0] - 1.0).abs() < 1e-3));
    let steps = drawing.ends.iter().map(|&[u, v]| drawing.centres[u].distance(drawing.centres[v]));
    let steps: Vec<_> = steps.collect();
    assert!(steps.iter().all(|step| (step / steps[0] - 1.0).abs() < 1e-2));
}

#[test]
fn the_order_can_be_read_off_large_worlds_too() {
    for world in [random(1, 2000, 1999), random(2, 2000, 3000), cycle(2000)] {
        assert_doors_in_order(&world, &svg(&WorldPicture::from(&world)));
    }
}
