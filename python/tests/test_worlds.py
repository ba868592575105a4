"""Worlds from dicts, networkx, permutations and files, and what is wrong with others."""

import pickle

import pytest

import toposlam as ts
from toposlam import errors

K4 = {"a": "bcd", "b": "adc", "c": "abd", "d": "acb"}


def lists(text):
    return {vertex: list(neighbours) for vertex, neighbours in text.items()}


def test_a_dict_of_neighbours():
    world = ts.World(lists(K4), name="k4")
    assert (world.vertex_count, world.edge_count, world.genus, world.is_simple) == (4, 6, 0, True)
    assert world.start == ("a", 0)
    assert world.neighbours["b"] == ("a", "d", "c")
    # All starts of the planar tetrahedron are alike.
    assert world.is_isomorphic(ts.World.load("worlds/k4-plane.toml"))
    assert world.with_start(None).is_isomorphic(ts.World.load("worlds/k4-plane.toml").with_start(None))
    assert not world.is_isomorphic(ts.World.load("worlds/k4-torus.toml"))


def test_a_dict_of_far_ends_has_loops_and_parallel_edges():
    theta = ts.World({"u": [("v", 2), ("v", 1), ("v", 0)], "v": [("u", 2), ("u", 1), ("u", 0)]})
    assert theta.genus == 0
    assert theta.with_start(None).is_isomorphic(ts.World.load("worlds/theta-plane.toml").with_start(None))
    torus = ts.World({0: [(0, 2), (0, 3), (0, 0), (0, 1)]})
    assert (torus.genus, torus.vertex_count, torus.edge_count) == (1, 1, 2)
    assert ts.World(dict(torus.far_ends)).is_isomorphic(torus)


@pytest.mark.parametrize(
    "opposite, clockwise",
    [
        ([1, 0, 3, 2], [0, 2, 1, 3]),
        ([2, 1, 4, 3], [1, 3, 2, 4]),
        ("(1,2)(3,4)", "(2,3)"),
        ("(1,2)(3,4)", [(2, 3)]),
        ([(0, 1), (2, 3)], [(0,), (1, 2), (3,)]),
    ],
)
def test_permutations_of_all_kinds(opposite, clockwise):
    path = ts.World({1: [2], 2: [1, 3], 3: [2]})
    assert ts.World.from_permutations(opposite, clockwise).is_isomorphic(path)


def test_both_permutations_count_from_the_same_dart():
    """Darts 0 to 3: two edges, joined by darts 1 and 2. The start is an end of the path."""
    path = ts.World({1: [2], 2: [1, 3], 3: [2]})
    assert ts.World.from_permutations("(0,1)(2,3)", "(1,2)").is_isomorphic(path)
    middle = ts.World.from_permutations("(0,2)(1,3)", "(1,2)")
    assert middle.degree(middle.start.vertex) == 1
    assert ts.World.from_permutations({1: 2, 2: 1, 3: 4, 4: 3}, {1: 1, 2: 3, 3: 2, 4: 4}).is_isomorphic(path)


def test_vertices_of_any_kind_are_found():
    networkx = pytest.importorskip("networkx")
    _, grid = networkx.check_planarity(networkx.grid_2d_graph(2, 2))
    world = ts.World(grid, start=((0, 1), 0))
    assert world.start.vertex == "(0, 1)" and world.degree((0, 1)) == 2
    assert world.darts((0, 1)) == world.darts("(0, 1)")
    for same in [world.with_start(((1, 1), 1)), pickle.loads(pickle.dumps(world)), world.mirror_image()]:
        assert same.opposite(((1, 1), 0)).index in (0, 1)
    with pytest.warns(errors.RenamedVertexWarning):
        rooms = ts.World({"Room 3": ["a/b"], "a/b": ["Room 3"]}, start=("a/b", 0))
    assert rooms.vertices == ("Room 3", "a_b")
    assert rooms.opposite(("a/b", 0)) == ("Room 3", 0) == rooms.opposite("a_b:Room 3")


def test_permutations_of_sage():
    class Element:
        """As SageMath's PermutationGroupElement."""

        def __init__(self, *cycles):
            self.cycles = cycles

        def cycle_tuples(self):
            return list(self.cycles)

    path = ts.World({1: [2], 2: [1, 3], 3: [2]})
    found = ts.World.from_permutations(Element((1, 2), (3, 4)), Element((2, 3)), start=4)
    assert found.is_isomorphic(path.with_start((3, 0)))


def test_a_planar_embedding_there_and_back():
    networkx = pytest.importorskip("networkx")
    _, embedding = networkx.check_planarity(networkx.wheel_graph(5))
    world = ts.World(embedding, name="wheel")
    wheel = ts.World.load("worlds/figure-1a.toml")
    plain = wheel.with_start(None)
    assert world.with_start(None).is_isomorphic(plain) or world.mirror_image().with_start(None).is_isomorphic(
        plain
    )
    assert ts.World(wheel.to_networkx(), start="x:a").is_isomorphic(wheel)


def test_a_multigraph_of_networkx_there_and_back():
    networkx = pytest.importorskip("networkx")
    theta = ts.World.load("worlds/theta-torus.toml").to_networkx()
    assert type(theta) is networkx.MultiGraph
    assert theta.nodes["u"]["rotation"] == [("v", 0), ("v", 1), ("v", 2)]
    assert theta.nodes["v"]["rotation"] == [("u", 0), ("u", 1), ("u", 2)]
    kinds = set()
    for world in ts.starts(4):
        graph = world.to_networkx()
        kinds.add(type(graph))
        assert (graph.number_of_nodes(), world.edge_count) == (world.vertex_count, 4)
        again = ts.World(graph, start=world.start)
        assert again.neighbours == world.neighbours and again.far_ends == world.far_ends
    assert kinds == {networkx.MultiGraph, networkx.PlanarEmbedding}


@pytest.mark.parametrize(
    "rotations, kind, text",
    [
        ({"u": [("v", 0), ("v", 1)], "v": [("u", 0)]}, errors.MissingEdgeError, "is not once"),
        ({"u": [("v", 0), ("v", 0)], "v": [("u", 1), ("u", 1)]}, errors.MissingEdgeError, "is not once"),
        ({"u": [("v", 0), ("v", 2)], "v": [("u", 0), ("u", 1)]}, errors.MissingEdgeError, r"\('v', 2\)"),
        ({"u": ["v", "v"], "v": ["u", "u"]}, errors.MissingEdgeError, "not .neighbour, key. of an edge"),
        ({"u": [("v", []), 7], "v": []}, errors.MissingEdgeError, "rotation of node 'u'"),
        ({"u": {("v", 0), ("v", 1)}, "v": []}, errors.WorldTypeError, "rotation of node 'u' is a list"),
        ({"u": None, "v": []}, errors.WorldTypeError, "rotation of node 'u' is a list"),
    ],
)
def test_rotations_that_are_wrong(rotations, kind, text):
    networkx = pytest.importorskip("networkx")
    graph = networkx.MultiGraph([("u", "v"), ("u", "v")])
    networkx.set_node_attributes(graph, rotations, "rotation")
    with pytest.raises(kind, match=text):
        ts.World(graph)


def test_multigraphs_that_are_no_worlds():
    networkx = pytest.importorskip("networkx")
    two = networkx.MultiGraph([("a", "b"), ("c", "d")])
    networkx.set_node_attributes(two, {v: [(w, 0)] for v, w in ["ab", "ba", "cd", "dc"]}, "rotation")
    with pytest.raises(errors.NotConnectedError):
        ts.World(two)
    alone = networkx.MultiGraph()
    alone.add_node("a", rotation=[])
    with pytest.raises(errors.NoEdgeError):
        ts.World(alone)
    for graph in [networkx.MultiGraph(), networkx.MultiGraph([(0, 1)]), networkx.MultiDiGraph([(0, 1)])]:
        with pytest.raises(errors.NoEmbeddingError, match="rotation"):
            ts.World(graph)


def test_permutations_there_and_back():
    for world in ts.starts(4):
        opposite, clockwise = world.to_permutations()
        again = ts.World.from_permutations(opposite, clockwise, start=world.number(world.start))
        assert again.is_isomorphic(world)
        # The commutator of the two has the faces as its cycles: another way to the genus.
        assert sorted(opposite) == sorted(clockwise) == list(range(8))


def test_euler_counts_faces():
    for cls, edges in [("multigraph", 4), ("simple", 5)]:
        for world in ts.worlds(edges, cls):
            faces = world.faces()
            assert world.vertex_count - edges + len(faces) == 2 - 2 * world.genus
            assert sorted(dart for face in faces for dart in face) == sorted(world.darts())
            for face in faces:
                assert world.walk(world.opposite(face[-1]), []) == world.opposite(face[-1])
                for dart, following in zip(face, face[1:] + face[:1]):
                    assert world.clockwise(world.opposite(dart)) == following
    # The faces of the tetrahedron and of the planar wheel.
    assert [len(face) for face in ts.World.load("worlds/k4-plane.toml").faces()] == [3] * 4
    wheel = ts.World.load("worlds/figure-1a.toml").faces()
    assert sorted(map(len, wheel)) == [3, 3, 3, 3, 4]


def test_automorphisms_are_symmetries_and_form_a_group():
    # Rotations of the tetrahedron; turns of a cycle with 4 edges, and of the wheel.
    for name, count in [("k4-plane", 12), ("cycle-4", 8), ("figure-1a", 4), ("chain-5", 2), ("shape-6", 1)]:
        world = ts.World.load(f"worlds/{name}.toml")
        maps = world.automorphisms()
        assert len(maps) == count, name
        assert maps[0] == {dart: dart for dart in world.darts()}
        for one in maps:
            assert set(one.values()) == set(world.darts())
            for dart, image in one.items():
                assert one[world.opposite(dart)] == world.opposite(image)
                assert one[world.clockwise(dart)] == world.clockwise(image)
            assert all({dart: one[other[dart]] for dart in one} in maps for other in maps)
        assert len(world.starts()) == 2 * world.edge_count // count
    sizes = [len(world.automorphisms()) for world in ts.worlds(4)]
    assert sum(8 // size for size in sizes) == 706


def test_canonical_forms_are_equal_exactly_for_isomorphic_graphs():
    worlds = [*ts.worlds(3), *(world.mirror_image() for world in ts.worlds(3))]
    for one in worlds:
        for other in worlds:
            same = one.is_isomorphic(other)
            assert (one.canonical() == other.canonical()) == same
            assert not same or hash(one.canonical()) == hash(other.canonical())
    starts = list(ts.starts(4))
    assert len({start.canonical() for start in starts}) == 107
    wheel = ts.World.load("worlds/figure-1a.toml")
    assert wheel.canonical().is_isomorphic(wheel.with_start(None)) and wheel.canonical().start is None


def test_a_world_is_saved_pickled_and_drawn(tmp_path):
    for name in ["figure-1b", "theta-torus", "shape-6", "two-loops-plane", "real/aces"]:
        world = ts.World.load(f"worlds/{name}.toml")
        again = pickle.loads(pickle.dumps(world))
        assert again == world and again.draw().svg == world.draw().svg
        assert again.far_ends == world.far_ends and again.start == world.start
        world.save(tmp_path / "world.json")
        assert ts.World.load(tmp_path / "world.json").is_isomorphic(world)
        world.draw().save(tmp_path / "world.png")
        assert (tmp_path / "world.png").read_bytes().startswith(b"\x89PNG")
        assert world._repr_svg_().startswith("<svg")
    with pytest.raises(errors.PictureError):
        world.draw().save(tmp_path / "world.gif")


def test_a_walk_in_a_world():
    world = ts.World.load("worlds/figure-1a.toml")
    robot = world.robot()
    pose = world.start
    for door in [1, 1, 2, 0]:
        percept = robot.go(door)
        pose = world.after(pose, door)
        assert percept.degree == world.degree(pose.vertex)
    assert world.walk(world.start, [1, 1, 2, 0]) == pose
    assert world.opposite(world.opposite(pose)) == pose
    for dart in world.darts():
        turns = [dart]
        while world.clockwise(turns[-1]) != dart:
            turns.append(world.clockwise(turns[-1]))
        start = dart.index
        around = world.darts(dart.vertex)
        assert turns == around[start:] + around[:start]
    assert robot.actions == [1, 1, 2, 0]


def test_the_mirror_image_and_corners():
    world = ts.World.load("worlds/figure-1a.toml")
    assert world.mirror_image().mirror_image().is_isomorphic(world)
    assert ts.World.load("worlds/cycle-4.toml").edge_count == 4
    assert ts.World.load("worlds/shape-6.toml").without_corners().edge_count == 2


WRONG = [
    ({}, errors.NoEdgeError, "no vertex"),
    ({"a": []}, errors.NoEdgeError, "no edge"),
    ({"a": ["b"], "b": []}, errors.MissingEdgeError, "'a' lists the neighbour 'b', which does not"),
    ({"a": ["b"]}, errors.MissingEdgeError, "'a' lists 'b', which is neither a vertex"),
    ({"a": ["b", None], "b": ["a"]}, errors.MissingEdgeError, "leads nowhere"),
    ({"a": ["a"]}, errors.RepeatedEdgeError, "lists itself"),
    ({"a": ["b", "b"], "b": ["a", "a"]}, errors.RepeatedEdgeError, "'b' twice"),
    ({"a": ["b"], "b": ["a"], "c": ["d"], "d": ["c"]}, errors.NotConnectedError, "c cannot be"),
    ({0: [(0, 0)]}, errors.MissingEdgeError, "leads to itself"),
    ({0: [(1, 0)], 1: [(0, 1)]}, errors.MissingEdgeError, "which leads to"),
    ({0: [(1, 5)], 1: [(0, 0)]}, errors.MissingEdgeError, "does not exist"),
    ({"a": 7}, errors.WorldTypeError, "needs a list"),
    ({"a": "b", "b": "a"}, errors.WorldTypeError, "needs a list"),
    ({1: [2], "1": [2], 2: [1, "1"]}, errors.WorldError, "two vertices have the name 1"),
    (None, errors.WorldTypeError, "not None; .* None if the graph is not planar"),
    ((False, None), errors.WorldTypeError, "whose second is the embedding"),
    ({"a": {"b"}, "b": ["a"]}, errors.WorldTypeError, "type set has no order"),
    ({"a": frozenset("b"), "b": ["a"]}, errors.WorldTypeError, "type frozenset has no order"),
    ({"a": {"b": 0}, "b": ["a"]}, errors.WorldTypeError, "type dict has no order"),
    ({"a": {"b": 0}.keys(), "b": ["a"]}, errors.WorldTypeError, "type dict_keys has no order"),
    ({"a": {0: "b"}.values(), "b": ["a"]}, errors.WorldTypeError, "type dict_values has no order"),
    ({"a": iter(["b"]), "b": ["a"]}, errors.WorldTypeError, "can be read only once"),
    ({"a": (x for x in "b"), "b": ["a"]}, errors.WorldTypeError, "type generator can be read only once"),
    ([{1}, {0}], errors.WorldTypeError, "vertex 0 .* type set has no order"),
    ({"a", "b"}, errors.WorldTypeError, "type set"),
    ([1, 2], errors.WorldTypeError, "list"),
    ([[1], []], errors.MissingEdgeError, "does not list 0 back"),
    ("worlds/figure-1a.toml", errors.WorldTypeError, "str"),
]


@pytest.mark.parametrize("value, kind, text", WRONG)
def test_what_is_not_a_world_has_an_error_of_its_own(value, kind, text):
    with pytest.raises(errors.WorldError, match=text) as raised:
        ts.World(value)
    assert type(raised.value) is kind


def test_a_graph_of_networkx_without_embedding():
    networkx = pytest.importorskip("networkx")
    with pytest.raises(errors.NoEmbeddingError, match="check_planarity"):
        ts.World(networkx.complete_graph(4))
    torus = networkx.PlanarEmbedding()
    lists = ts.World.load("worlds/figure-1b.toml").neighbours
    torus.set_data({vertex: list(listed) for vertex, listed in lists.items()})
    with pytest.raises(errors.NoEmbeddingError, match="not valid"):
        ts.World(torus)


@pytest.mark.parametrize(
    "opposite, clockwise",
    [
        ([1, 0], [0, 0]),
        ([0, 1], [0, 1]),
        ([1, 2, 0], [0, 1, 2]),
        ("(1,2)(2,3)", "()"),
        ("hello", "()"),
        (5, [0]),
        ([1, 0], ["a", "b"]),
        ([1, 0], [0, 1, 2]),
        ([], []),
        ([(0, -1)], [0, 1]),
        ({0, 1}, [0, 1]),
        ([1, 0], iter([0, 1])),
        ([1, 0], {0: 0, 1: 1}.values()),
    ],
)
def test_what_are_not_permutations(opposite, clockwise):
    with pytest.raises((errors.PermutationError, errors.NoEdgeError)):
        ts.World.from_permutations(opposite, clockwise)


@pytest.mark.parametrize("least", [0, 1])
def test_errors_count_darts_as_the_permutations_do(least):
    def counted(*images):
        return [image + least for image in images]

    with pytest.raises(errors.PermutationError, match=f"dart {least} is its own opposite"):
        ts.World.from_permutations(counted(0, 1), counted(0, 1))
    with pytest.raises(errors.PermutationError, match=f"the opposite of dart {least} is {1 + least}, whose"):
        ts.World.from_permutations(counted(1, 2, 0, 3), counted(0, 1, 2, 3))
    with pytest.raises(errors.NotConnectedError, match=f"dart {2 + least} cannot"):
        ts.World.from_permutations(counted(1, 0, 3, 2), counted(0, 1, 2, 3))


def test_a_name_that_no_world_file_has_is_changed_with_a_warning():
    with pytest.warns(errors.RenamedVertexWarning, match="'a/b' is 'a_b_2'") as warned:
        world = ts.World({"a/b": ["a_b"], "a_b": ["a/b", "a//b"], "a//b": ["a_b"]})
    assert world.vertices == ("a_b_2", "a_b", "a_b_3")
    assert world.degree("a//b") == 1 and world.darts("a/b") == [("a_b_2", 0)]
    assert warned[0].filename == __file__
    # Other vertices have no text of their own.
    assert ts.World({(0, 0): [(0, 1)], (0, 1): [(0, 0)]}).vertices == ("(0, 0)", "(0, 1)")


def test_the_doors_of_a_walk_have_an_order():
    world = ts.World.load("worlds/figure-1a.toml")
    for doors in [{1, 2}, iter([1, 2]), "12", {1: 2}]:
        with pytest.raises(errors.WorldTypeError, match="doors of a walk are a list"):
            world.walk(world.start, doors)


def test_permutations_of_two_components():
    with pytest.raises(errors.NotConnectedError):
        ts.World.from_permutations("(1,2)(3,4)", "()")
    with pytest.raises(errors.UnknownStartError):
        ts.World.from_permutations("(1,2)", "()", start=3)


@pytest.mark.parametrize(
    "text, kind, message",
    [
        ('name = "x"\n[clockwise]\na = ["b"]\n', errors.MissingEdgeError, "a.toml: .*`b`"),
        ("[clockwise", errors.WorldFileError, "a.toml: "),
        ("", errors.WorldFileError, "the file is empty"),
        ('name = "x"', errors.WorldFileError, "no world"),
        (
            '[clockwise]\na = ["b"]\nb = ["a"]\nc = ["d"]\nd = ["c"]\n',
            errors.NotConnectedError,
            "c",
        ),
        ("\0\1\2", errors.WorldFileError, "a.toml"),
    ],
)
def test_a_file_that_is_not_a_world(tmp_path, text, kind, message):
    file = tmp_path / "a.toml"
    file.write_text(text)
    with pytest.raises(errors.WorldError, match=message) as raised:
        ts.World.load(file)
    assert type(raised.value) is kind


def test_a_file_that_does_not_exist():
    with pytest.raises(errors.WorldFileError, match="No such file"):
        ts.World.load("worlds/nowhere.toml")


@pytest.mark.parametrize(
    "start", ["x", "x:q", ("x", 4), ("x", -1), ("q", 0), ("x", "a"), 3, None.__class__, ("x",)]
)
def test_a_start_that_is_not_there(start):
    with pytest.raises(errors.UnknownStartError):
        ts.World.load("worlds/figure-1a.toml").with_start(start)


def test_a_world_without_start():
    world = ts.World.load("worlds/figure-1a.toml").with_start(None)
    for ask in [
        ts.explore,
        certificate_of,
        lambda world: world.robot(),
        lambda w: ts.compare(w, w),
    ]:
        with pytest.raises(errors.NoStartError, match="figure-1a has no start"):
            ask(world)


def certificate_of(world):
    return world.certificate()


def test_a_world_cannot_be_changed():
    world = ts.World.load("worlds/figure-1a.toml")
    with pytest.raises(errors.FrozenError):
        world.name = "other"
    with pytest.raises(errors.FrozenError):
        del world._core
    with pytest.raises(TypeError):
        world.neighbours["x"] = ()
    assert world == ts.World.load("worlds/figure-1a.toml")
