# SPDX-License-Identifier: GPL-3.0-or-later
"""Force diagrams, funicular polygons, strings of weights, two jointed links."""

from functools import partial

import numpy as np
import pytest
from mechanics import KINDS, random_chain

import revchain as rc
from revchain import two_links


def shapes_of(chain, share):
    return rc.steady_shapes(chain, conical_height=share * rc.modes(chain, 1).conical_height[0], budget=20_000)


def sine(first, second):
    """Of the angle between rows."""
    across = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    return across / np.linalg.norm(first, axis=1) / np.linalg.norm(second, axis=1)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "massless"])
@pytest.mark.parametrize("share", [0.9, 0.08])
def test_what_the_diagram_says(kind, share):
    """Each array is what its name says; of all shapes to the last digits: tests/cpp/statics.cpp."""
    chain = random_chain(kind, 5, 4)
    for shape in shapes_of(chain, share):
        diagram = shape.force_diagram()
        x, height = shape.offset[:-1], shape.conical_height
        assert np.array_equal(diagram.pin, np.stack([shape.offset, shape.height], axis=1))
        for name in ("load", "ray", "reaction"):
            columns = [getattr(diagram, f"{name}_{axis}") for axis in "xz"]
            assert np.array_equal(getattr(diagram, name), np.stack(columns, axis=1))
        assert abs(sine(np.diff(diagram.pin, axis=0), diagram.ray)).max() < 1e-12  # OQ_m is parallel to link m
        np.testing.assert_allclose(np.hypot(*diagram.reaction.T), shape.tension, rtol=1e-12)
        leaning = np.arctan2(-diagram.reaction[:, 0], diagram.reaction[:, 1])
        np.testing.assert_allclose(leaning, shape.reaction_inclination, atol=1e-13)
        down = np.stack([np.sin(shape.inclination), -np.cos(shape.inclination)], axis=1)
        centre = diagram.pin[1:] + chain.centroid[:, None] * down
        centres = np.cumsum(chain.weight[:, None] * centre, axis=0) / np.cumsum(chain.weight)[:, None]
        np.testing.assert_allclose(diagram.centre_of_gravity, centres, atol=1e-12)
        straight = shape.transferred_to_axis()
        assert straight.total_length == pytest.approx(-shape.height[0], rel=1e-14)
        modes = rc.modes(straight, "all")
        k = abs(modes.conical_height - height).argmin()
        assert modes.conical_height[k] == pytest.approx(height, rel=1e-13)
        np.testing.assert_allclose(modes.shape[k], shape.offset / abs(shape.offset).max(), atol=1e-12)
        if kind == "plummets":  # as the paper draws them; G_m K_m is parallel to thread m; N_1 C_1 = lambda
            loads = chain.weight[:, None] * np.stack([x / height, -np.ones(5)], axis=1)
            np.testing.assert_allclose(diagram.load, loads, rtol=1e-15)
            np.testing.assert_allclose(diagram.ray, np.cumsum(loads * [-1, -1], axis=0), rtol=1e-12)
            assert np.array_equal(diagram.ray, diagram.reaction)
            to_k = np.stack([-diagram.centre_of_gravity[:, 0], np.full(5, height)], axis=1)
            assert abs(sine(to_k, diagram.ray)).max() < 1e-12
            np.testing.assert_allclose(diagram.lifted, x, rtol=1e-15)
            assert diagram.crossing[0] - diagram.pin[0, 1] == pytest.approx(height, rel=1e-12)


def test_transfer_of_inverted_links_is_refused():
    shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.05, hanging_only=False)[0]
    assert max(abs(shape.inclination)) > np.pi / 2
    with pytest.raises(ValueError, match="between -pi/2 and pi/2, got -2.03"):
        shape.transferred_to_axis()


def test_funicular_polygon_and_its_oscillation_against_a_dense_solver():
    scipy_linalg = pytest.importorskip("scipy.linalg")
    rng = np.random.default_rng(3)
    for count in (1, 2, 6, 20):
        weight = rng.uniform(0.2, 3, count)
        place = np.concatenate([[0.0], np.cumsum(rng.uniform(0.2, 2, count + 1))])
        polygon = rc.funicular_polygon(weight, place, 1.7, first_height=0.5, last_height=-1.0)
        assert polygon.height[0] == 0.5 and polygon.height[-1] == -1.0
        np.testing.assert_array_equal(polygon.weight, weight)
        # forces at every weight
        side = np.stack([np.diff(polygon.position), np.diff(polygon.height)], axis=1)
        pull = polygon.tension[:, None] * side / np.linalg.norm(side, axis=1)[:, None]
        np.testing.assert_allclose(np.diff(pull, axis=0), np.stack([np.zeros(count), weight], axis=1), atol=1e-12)
        rays = np.stack([np.full(count + 1, 1.7), polygon.rise], axis=1)
        np.testing.assert_allclose(pull, rays, rtol=1e-12, atol=1e-12)
        # sides of tension T and length a, weights that move across
        k = polygon.tension / np.linalg.norm(side, axis=1)
        stiffness = np.diag(k[:-1] + k[1:]) - np.diag(k[1:-1], 1) - np.diag(k[1:-1], -1)
        inverse, vectors = scipy_linalg.eigh(stiffness, np.diag(weight))
        modes = polygon.transverse_modes()
        np.testing.assert_allclose(modes.conical_height, 1 / inverse, rtol=1e-12)
        assert (modes.error_bound < 2e-15).all()
        vectors = (vectors / abs(vectors).max(axis=0) * np.sign(vectors[0])).T
        np.testing.assert_allclose(modes.shape[:, 1:-1], vectors, atol=1e-10)
        assert not modes.shape[:, [0, -1]].any()
        np.testing.assert_allclose(polygon.transverse_modes(gravity=9.81).period, 2 * np.pi / np.sqrt(9.81 * inverse), rtol=1e-12)


def lowest_energy(weight, length, span):
    """Potential energy of a thread between level supports, of given lengths of sides seen from above, at rest."""
    optimize = pytest.importorskip("scipy.optimize")

    def ends(unknown):
        pull, lift = unknown
        rise = -lift + np.concatenate([[0.0], np.cumsum(weight)])
        size = np.hypot(pull, rise)
        return np.stack([length * pull / size, length * rise / size], axis=1)

    root = optimize.root(lambda u: ends(u).sum(axis=0) - [span, 0.0], [1.0, weight.sum() / 2], tol=1e-14)
    assert abs(root.fun).max() < 1e-14
    return float(weight @ np.cumsum(ends(root.x)[:, 1])[:-1]), root.x[0], ends(root.x)


def test_the_energy_of_weights_swung_sideways():
    # Threads do not stretch: weights swung out by z have sides sqrt(a^2 - dz^2) long in the plane, and hang anew. What
    # that lifts them by is the energy of the string of weights, with no word about tension.
    weight = np.array([1.0, 0.4, 2.0, 0.7])
    length = np.array([1.0, 0.8, 1.3, 0.6, 1.1])
    energy, pull, sides = lowest_energy(weight, length, 3.5)
    place = np.concatenate([[0.0], np.cumsum(sides[:, 0])])
    modes = rc.transverse_modes(weight, place, pull)
    for k, height in enumerate(modes.conical_height):
        z = modes.shape[k]
        scaled = []
        for amplitude in (0.02, 0.01):
            shorter = np.sqrt(length**2 - (amplitude * np.diff(z)) ** 2)
            gain = (lowest_energy(weight, shorter, 3.5)[0] - energy) / amplitude**2
            scaled.append(gain / (0.5 * weight @ z[1:-1] ** 2 / height))
        assert scaled[1] + (scaled[1] - scaled[0]) / 3 == pytest.approx(1, abs=1e-6)


def test_pictures(tmp_path):
    """Seconds: the letters are formulas, which matplotlib sets slowly."""
    pytest.importorskip("matplotlib")
    shape = shapes_of(random_chain("plummets", 4, 3), 0.15)[0]
    figure, forces = shape.force_diagram().plot()
    assert figure.get_xlabel() == "distance from axis (m)" and forces.get_ylabel() == "vertical force (N)"
    letters = {text.get_text() for text in forces.texts}
    assert {"$O$", "$N$", "$Q_1$", "$Q_4$", "$P_1$", "$W_4$"} <= letters
    assert figure.figure is forces.figure
    figure.figure.savefig(tmp_path / "plummets.png")
    again = shapes_of(random_chain("rods", 3, 3), 0.2)[0].force_diagram().plot((figure, forces))
    assert again == (figure, forces)
    many = rc.steady_shapes(rc.Chain.uniform_plummets(30, length=1.0), conical_height=0.4)[0].force_diagram()
    many.plot()[0].figure.savefig(tmp_path / "many.png")
    polygon, rays = rc.funicular_polygon([1, 2, 1], [0, 1, 2, 3, 4], 2.0).plot()
    assert rays.get_title() == "force diagram"
    polygon.figure.savefig(tmp_path / "line.png")


def test_words():
    diagram = shapes_of(random_chain("plummets", 2, 3), 0.5)[0].force_diagram()
    polygon = rc.funicular_polygon([1.0], [0, 1, 2], 2.0)
    assert repr(diagram).startswith("ForceDiagram: 2 links, conical height ")
    assert repr(polygon).startswith("FunicularPolygon: 1 weight, horizontal tension 2\n")
    for array in (diagram.ray, polygon.height):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    huge = rc.funicular_polygon([1.0], [-1e290, 0.0, 1e290], 1.0)  # no overflow that is not said
    assert huge.height.tolist() == [0.0, -0.5e290, 0.0]


@pytest.mark.parametrize(
    ("weight", "place", "pull", "message"),
    [
        ([1, -1], [0, 1, 2, 3], 1.0, "weight must be positive and finite"),
        ([1, 1], [0, 1, 2], 1.0, "positions must be two more than weights"),
        ([1, 1], [0, 1, 1, 2], 1.0, "positions must be finite and increase"),
        ([1, 1], [0, 1, np.nan, 2], 1.0, "positions must be finite and increase"),
        ([1, np.nan], [0, 1, 2, 3], 1.0, "weight must be positive and finite"),
        ([1, 1], [0, 1, 2, 3], 0.0, "tension must be positive"),
        ([1, 1], [0, 1, 2, 3], np.nan, "tension must be positive"),
        ([1, 1], [[0, 1, 2, 3]], 1.0, "position must be a list of numbers"),
    ],
)
def test_wrong_polygons(weight, place, pull, message):
    for call in (rc.funicular_polygon, rc.transverse_modes):
        with pytest.raises(ValueError, match=f"{message}.*, got ") as error:
            call(weight, place, pull)
        assert str(error.value).count("got") == 1
        assert "string_of_weights" not in str(error.value)  # what both call


BELL = dict(upper_weight=3.0, upper_length=0.4, upper_centroid=0.1, upper_radius_of_gyration=0.6)
CLAPPER = dict(lower_weight=0.2, lower_centroid=0.7, lower_radius_of_gyration=0.25)


def test_jointed_links_are_a_chain_of_two():
    """Of random pairs: tests/cpp/two_links.cpp."""
    pair, names = {**CLAPPER, **BELL}, ("weight", "centroid", "radius_of_gyration")
    columns = {name: [pair[f"lower_{name}"], pair[f"upper_{name}"]] for name in names}
    chain = rc.Chain(length=[1.0, pair["upper_length"]], **columns)
    heights = two_links.jointed_links(**pair)
    np.testing.assert_allclose(heights, rc.modes(chain).conical_height, rtol=1e-15)
    figures = two_links.jointed_links_shapes(**pair, height=0.95 * heights[0])
    listed = rc.steady_shapes(chain, conical_height=0.95 * heights[0])
    assert len(figures) == len(listed) <= 4
    for figure in figures:
        mirrored = np.array([[1.0], [-1.0]]) * figure.inclination
        gaps = [abs(s.inclination - mirrored).max(axis=1).min() for s in listed]
        assert min(gaps) < 1e-12
        tension = listed[int(np.argmin(gaps))].tension
        np.testing.assert_allclose(figure.tension * chain.total_weight, tension, rtol=1e-12)
    assert two_links.jointed_links_shapes(**pair, height=1.01 * heights[0]) == []
    table = two_links.jointed_links(**{**pair, "lower_weight": [[0.2], [0.3]], "upper_weight": [1.0, 3.0]})
    assert table.shape == (2, 2, 2)
    np.testing.assert_array_equal(table[0, 1], heights)


def test_a_bell_and_its_clapper_one_piece_and_not():
    data = dict(weight=[18.0, 500.0], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    bell = rc.bell_and_clapper(rc.Chain(**data))
    y = rc.modes(rc.Chain(**data)).shape
    ratio = (y[:, 0] - y[:, 1]) / 0.65 / ((y[:, 1] - y[:, 2]) / 0.15)
    assert bell.inclination_ratio == pytest.approx(tuple(ratio), rel=1e-13)
    m = 500 * 0.2 / (18 * 0.15)
    l1, l2 = 0.52 + 0.08**2 / 0.52, 0.2 + 0.3**2 / 0.2
    assert bell.mismatch == pytest.approx(0.52 - (m + 1) * l1 - m * (0.15 - l2), rel=1e-12)
    of = ("weight", "centroid", "radius_of_gyration")
    names = {f"{body}_{name}": (name, i) for i, body in enumerate(("clapper", "bell")) for name in of}
    names["joint"] = ("length", 1)
    assert set(bell.derivative) == set(names) == set(bell.present)

    def changed(name, value):
        new = {k: list(v) for k, v in data.items()}
        new[names[name][0]][names[name][1]] = value
        return rc.bell_and_clapper(rc.Chain(**new))

    for name, value in bell.with_ratio(1.0).items():
        step = 1e-5 * bell.present[name]
        sides = [changed(name, bell.present[name] + sign * step).inclination_ratio[0] for sign in (1, -1)]
        assert bell.derivative[name] == pytest.approx((sides[0] - sides[1]) / (2 * step), rel=1e-7, abs=1e-9)
        if not np.isnan(value):
            silent = changed(name, value)
            assert silent.inclination_ratio[0] == pytest.approx(1, abs=1e-12)
            assert silent.mismatch == pytest.approx(0, abs=1e-12)
            assert silent.conical_height[0] == pytest.approx(silent.silent_height, rel=1e-12)
            clamped = rc.modes(silent.system.clamped(0)).conical_height[0]
            assert clamped == pytest.approx(silent.conical_height[0], rel=1e-12)
            # and at any inclination, the pair is straight
            shape = rc.steady_shapes(silent.system, conical_height=0.8 * silent.silent_height)[0]
            assert shape.inclination[0] == pytest.approx(shape.inclination[1], abs=1e-9)
    silent = changed("joint", bell.with_ratio(1.0)["joint"])
    assert silent.inclination_ratio[0] == pytest.approx(1, abs=4e-16) and abs(silent.mismatch) < 1e-16
    heights = [rc.modes(chain).conical_height[0] for chain in (silent.system, silent.system.clamped(0))]
    assert heights[0] == pytest.approx(heights[1], rel=4e-16)
    given = {name: value for name, value in bell.present.items() if name != "joint"}
    assert bell.with_ratio(1.0)["joint"] == pytest.approx(float(rc.two_links.pin_of_silent_clapper(**given)), rel=1e-14)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"lower_weight": 0.0}, "lower_weight must be positive"),
        ({"upper_centroid": -0.1}, "would stand"),
        ({"upper_radius_of_gyration": -1.0}, "upper_radius_of_gyration must be finite and not negative"),
        ({"lower_radius_of_gyration": -1.0}, "lower_radius_of_gyration must be finite and not negative"),
        *(({"lower_centroid": value}, "must not be more than 1e77 apart") for value in (1e-300, 1e300)),
    ],
)
def test_wrong_links(change, message):
    for call in (two_links.jointed_links, partial(two_links.jointed_links_shapes, height=0.1)):
        with pytest.raises(ValueError, match=message):
            call(**{**CLAPPER, **BELL, **change})


def test_wrong_bells_and_rods():
    bell = {"bell_weight": 1, "bell_centroid": 0.5, "bell_radius_of_gyration": 0.1}
    clapper = {"clapper_weight": 1, "clapper_centroid": 0.7, "clapper_radius_of_gyration": 0.1}
    joint, pair = partial(two_links.joint_without_bending, 2.0), rc.Chain(weight=[1.0, 2.0], length=1.0)
    three = rc.Chain(weight=[1.0, 2.0, 3.0], length=1.0)
    for call, given, message in (
        (lambda given: two_links.pin_of_silent_clapper(**given), {**bell, **clapper}, "pendulum length must be less than the bell's"),
        *((joint, pin, "pin must be more than length/6 and less than length/2, got") for pin in (0.1, 1.0, 1 / 3, 1.2)),
        *((joint, pin, "pin must be positive and finite, got") for pin in (np.nan, -0.3)),
        *((rc.bell_and_clapper, system, "bell_and_clapper: .*, got") for system in (three, rc.Rig(pair))),
        (rc.bell_and_clapper(pair).with_ratio, 0.0, "ratio must"),
    ):
        with pytest.raises((ValueError, TypeError), match=message):
            call(given)
