# SPDX-License-Identifier: GPL-3.0-or-later
"""revchain.Chain: what it keeps, what it refuses."""

import math
import re

import numpy as np
import pytest
from rigs import agree, random_chain

import revchain as rc

NAN, INF = math.nan, math.inf


def test_scalars_serve_all_links_and_stay_scalars():
    chain = rc.Chain(weight=[1, 2, 3], length=0.5)
    assert chain.size == len(chain) == 3
    assert chain.length.shape == (3,) and chain.length.tolist() == [0.5] * 3
    assert chain.length.strides == (0,)  # one number, shown three times
    assert chain.centroid.tolist() == chain.pendulum_length.tolist() == [0.5] * 3
    assert chain.radius_of_gyration.tolist() == [0.0] * 3
    long = rc.Chain.uniform_rods(10**6)
    assert long.size == 10**6 and long.weight.strides == long.radius_of_gyration.strides == (0,)
    assert rc.Chain.uniform_rods(10**15).mode_count == 10**15


@pytest.mark.parametrize("name", ["weight", "length", "centroid", "pendulum_length", "radius_of_gyration"])
@pytest.mark.parametrize("value", [0.5, [0.5, 0.5]])
def test_columns_are_read_only_copies(name, value):
    weight = np.array([1.0, 2.0])
    chain = rc.Chain(weight=weight, length=value, centroid=value, radius_of_gyration=value)
    column = getattr(chain, name)
    assert column.shape == (2,) and column.dtype == np.float64
    with pytest.raises(ValueError, match="read-only"):
        column[0] = 7.0
    weight[0] = 9.0
    assert chain.weight.tolist() == [1.0, 2.0]


def test_centroids_and_radii():
    by_length = rc.Chain(weight=1.0, length=2.0, centroid=1.0, pendulum_length=1.25)
    by_radius = rc.Chain(weight=1.0, length=2.0, centroid=1.0, radius_of_gyration=0.5)
    assert by_length == by_radius
    assert by_length.radius_of_gyration.tolist() == [0.5] and by_radius.pendulum_length.tolist() == [1.25]
    at_pins = rc.Chain(weight=[5.0, 1.0, 1.0], length=1.0, centroid=[1.0, 0.0, -0.2], radius_of_gyration=0.4)
    assert at_pins.centroid.tolist() == [1.0, 0.0, -0.2]
    assert at_pins.pendulum_length[1] == INF
    assert at_pins.pendulum_length[2] == pytest.approx(-0.2 - 0.16 / 0.2, rel=4 * 2.0**-52)


def test_input_types():
    expected = rc.Chain(weight=[1.0, 2.0], length=[3.0, 4.0])
    assert rc.Chain(weight=(1, 2), length=np.array([3, 4], dtype=np.uint8)) == expected
    assert rc.Chain(weight=np.array([1, 2], dtype=np.float32), length=np.array([3, 0, 4, 0])[::2]) == expected
    assert rc.Chain(weight=2, length=np.float64(3)).size == 1
    assert rc.Chain(weight=[10**30, 1], length=1).weight[0] == 1e30


def test_uniform_chains():
    plummets, rods = (make(4, length=2.0, weight=8.0) for make in (rc.Chain.uniform_plummets, rc.Chain.uniform_rods))
    assert plummets.weight.tolist() == [2.0] * 4
    assert plummets.length.tolist() == plummets.centroid.tolist() == [0.5] * 4
    assert rods.centroid.tolist() == [0.25] * 4
    assert rods.radius_of_gyration[0] == pytest.approx(0.5 / math.sqrt(12), rel=2.0**-52)


def test_a_state_that_is_none_of_a_chain():
    chain = rc.Chain(weight=[1, 2.5, 3], length=[0.1, 0.5, 0.7], centroid=0.04, radius_of_gyration=[0.0, 0.25, 0.3])
    state = chain._compiled.__getstate__()
    for wrong in ((*state[:6], 3), state[:4], (*state, 1.0, 1.0)):
        with pytest.raises(ValueError, match="state of a chain"):
            type(chain._compiled).__new__(type(chain._compiled)).__setstate__(wrong)


def test_units_at_the_ends_of_the_range():
    for unit in (5e-324, 1e-300, 1e300):
        chain = rc.Chain(weight=[1.0, 2.0], length=unit, centroid=unit, radius_of_gyration=unit)
        assert rc.modes(chain).status == "success"
        chain = rc.Chain(weight=[unit, 1.0, 1 / max(unit, 1e-308)], length=1.0)
        assert rc.modes(chain, count=1).status == "success"
    assert rc.Chain.uniform_rods(3, length=1e300).radius_of_gyration[0] == pytest.approx(1e300 / 3 / math.sqrt(12))


def test_what_a_chain_says_of_itself():
    assert repr(rc.Chain(weight=1.5, length=2.0)) == "Chain of 1 link, length 2, weight 1.5"
    assert repr(rc.Chain.uniform_rods(10_000)) == "Chain of 10,000 links, length 1, weight 1"
    chain = rc.Chain(weight=[1e16, 1.0, 1.0], length=0.1)  # plain addition would lose both ones
    assert chain.total_weight == 1e16 + 2.0
    assert chain.total_length == pytest.approx(0.3, rel=2.0**-52)
    massless = rc.Chain(weight=[1.0, 0.0, 2.0], length=1.0)
    assert massless.mode_count == 2 and massless.size == 3
    one, other = rc.Chain(weight=[1, 2, 3], length=1.0), rc.Chain(weight=[1, 2, 3], length=[1.0, 1.0, 1.0])
    assert one == other and hash(one) == hash(other)
    assert one != rc.Chain(weight=[1, 2, 3], length=[1.0, 1.0, 1.5])


TWO = {"weight": [1.0, 2.0], "length": [1.0, 1.0]}
NOT_REAL = {"ragged": [[1.0], [1.0, 2.0]], "booleans": [True, True], "none inside": [1.0, None], "a generator": iter([1.0])}
NOT_REAL |= {"bytes": b"12", "an array of bytes": bytearray(b"12"), "an object": object(), "huge integer": 10**400}
BAD = {
    **{kind: ({"weight": weight, "length": 1.0}, "weight must be a real number") for kind, weight in NOT_REAL.items()},
    "no links": ({"weight": [], "length": []}, "at least one"),
    "nan weight": ({**TWO, "weight": [1.0, NAN]}, r"links\[1\]: weight"),
    "infinite weight": ({**TWO, "weight": [INF, 1.0]}, r"links\[0\]: weight"),
    "negative weight": ({**TWO, "weight": [1.0, -2.0]}, r"links\[1\]: weight .*-2"),
    "massless lowest link": ({**TWO, "weight": [0.0, 1.0]}, r"links\[0\]: .*lowest"),
    "weights that overflow": ({**TWO, "weight": [1.7e308, 1.7e308]}, "weights|add up"),
    "nan length": ({**TWO, "length": [NAN, 1.0]}, r"links\[0\]: length"),
    "infinite length": ({**TWO, "length": [1.0, INF]}, r"links\[1\]: length"),
    "zero length": ({**TWO, "length": [1.0, 0.0]}, r"links\[1\]: length .*0"),
    "negative length": ({**TWO, "length": -0.5}, "length must be positive.*-0.5"),
    "different lengths of arrays": ({"weight": [1.0, 2.0], "length": [1.0, 2.0, 3.0]}, "weight has 2, length has 3"),
    "one number in an array": ({"weight": [1.0, 2.0], "length": [1.0]}, "weight has 2, length has 1"),
    "two dimensions": ({"weight": [[1.0, 2.0]], "length": 1.0}, r"weight must be .* one dimension, got shape \(1, 2\)"),
    "strings": ({"weight": ["1", "2"], "length": 1.0}, "weight must be a number, or a number and its unit"),
    "complex": ({**TWO, "length": [1.0 + 0j, 1.0]}, "length must be a real number"),
    "masked": ({**TWO, "weight": np.ma.masked_array([1.0, 2.0], [0, 1])}, "masked"),
    "centroid alone": ({**TWO, "centroid": 0.5}, "exactly one of"),
    "centroid with both": ({**TWO, "centroid": 0.5, "pendulum_length": 1.0, "radius_of_gyration": 1.0}, "exactly one of"),
    "pendulum_length alone": ({**TWO, "pendulum_length": 1.0}, "needs centroid"),
    "radius_of_gyration alone": ({**TWO, "radius_of_gyration": 1.0}, "needs centroid"),
    "nan centroid": ({**TWO, "centroid": NAN, "radius_of_gyration": 1.0}, "centroid"),
    "negative radius": ({**TWO, "centroid": 0.5, "radius_of_gyration": [1.0, -1.0]}, r"links\[1\]: radius of gyration.*-1"),
    "nan radius": ({**TWO, "centroid": 0.5, "radius_of_gyration": NAN}, "radius of gyration"),
    "imaginary radius": ({**TWO, "centroid": 0.5, "pendulum_length": [0.6, 0.4]}, r"links\[1\]: imaginary"),
    "centroid at the pin with pendulum length": ({**TWO, "centroid": 0.0, "pendulum_length": 1.0}, "radius of gyration"),
    "a link that stands": ({**TWO, "centroid": [1.0, -0.6], "radius_of_gyration": 0.1}, r"links\[1\]: .*stand"),
    "lowest link that stands": ({"weight": 1.0, "length": 1.0, "centroid": -0.1, "radius_of_gyration": 0.1}, r"links\[0\]: .*stand"),
}


@pytest.mark.parametrize(("arguments", "message"), BAD.values(), ids=BAD.keys())
def test_refused(arguments, message):
    with pytest.raises(ValueError, match=f"revchain.*Chain.*({message})"):
        rc.Chain(**arguments)


def test_arguments_have_names():
    with pytest.raises(TypeError):
        rc.Chain([1.0], [1.0])


@pytest.mark.parametrize("make", [rc.Chain.uniform_plummets, rc.Chain.uniform_rods])
@pytest.mark.parametrize(
    "arguments",
    [(0,), (-1,), (2.0,), ("2",), (True,), (None,), (10**30,), (2, 0.0), (2, -1.0), (2, NAN), (2, INF), (2, [1.0, 2.0])]
    + [(2, 1.0, 0.0), (2, 1.0, -1.0), (2, 1.0, NAN), (2, 1.0, INF), (2, "1")],
)
def test_uniform_refused(make, arguments):
    with pytest.raises(ValueError, match="uniform_"):
        make(*arguments)


# ---- weights at pins, threads, clamped links: heights_with_a_weight_at_a_pin is in test_accuracy.py


@pytest.mark.parametrize("pin", [1, 2, 4])
def test_a_thread_anywhere(pin):
    longer = random_chain(np.random.default_rng(55), 4).with_thread(0.4, pin=pin)
    assert longer.weight[pin] == 0 and longer.size == 5
    agree(rc.Rig(longer), rc.modes(rc.Rig(longer)), digits=80)


def test_attached_bodies():
    chain = rc.Chain.uniform_rods(3, length=3.0, weight=3.0)
    heavy = chain.with_body(weight=2.0)
    assert heavy.weight.tolist() == [3.0, 1.0, 1.0]
    assert heavy.centroid[0] == pytest.approx((0.5 + 2 * 1.0) / 3, rel=1e-15)
    assert rc.modes(rc.Chain(weight=1.0, length=1.0).with_thread(0.5, pin=1)).conical_height.tolist() == [1.5]
    # a tip weight many times the chain's: a plummet on a chain without weight
    assert rc.modes(chain.with_body(weight=1e9)).conical_height[0] == pytest.approx(3.0, rel=1e-8)


def test_clamped_pairs():
    """The body of both, and heights between those of the chain: tests/cpp/system/edit.cpp."""
    chain = random_chain(np.random.default_rng(66), 4)
    a, got, free = chain.length, rc.modes(chain.clamped(1)).conical_height, rc.modes(chain).conical_height
    assert chain.clamped(1).length == pytest.approx([a[0], a[1] + a[2], a[3]], rel=1e-15)
    assert np.all(got <= free[:3] * (1 + 4 * 2.0**-52)) and np.all(got >= free[1:] * (1 - 4 * 2.0**-52))
    rods = rc.Chain.uniform_rods(3, length=3.0, weight=3.0).clamped(0).clamped(0)
    assert rc.modes(rods).conical_height == pytest.approx([2.0], rel=1e-15)


@pytest.mark.parametrize("mass", [1e200, 1e300])
def test_a_body_beyond_all_measure_is_named(mass):
    rods = rc.Chain.uniform_rods(3, length=1.0, mass=1.0)
    with pytest.raises(ValueError, match=rf"with_body: mass is too far from that of the link above pin 0, got {re.escape(f'{mass:g}')}"):
        rods.with_body(mass=mass)


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        (lambda chain: chain.with_body(weight=-1.0), "weight must"),
        (lambda chain: chain.with_body(weight=1.0, pin=3), "pin must"),
        (lambda chain: chain.with_body(weight=1.0, radius_of_gyration=-1.0), "radius.of.gyration must"),
        (lambda chain: chain.with_thread(0.0, pin=1), "length must"),
        *((lambda chain, pin=pin: chain.with_thread(1.0, pin=pin), "pin must") for pin in (0, 4)),
        *((lambda chain, link=link: chain.clamped(link), "link must") for link in (-1, 2, 1.5)),
    ],
)
def test_wrong_edits(edit, message):
    with pytest.raises(ValueError, match=rf"^revchain\.Chain\.(with_body|with_thread|clamped): {message}.*, got"):
        edit(rc.Chain(weight=[1.0, 2.0, 3.0], length=[0.5, 0.4, 0.3]))


@pytest.mark.parametrize("call", [lambda: rc.Chain([1, 3], [1, 1]), lambda: rc.Chain(mass=[1.0]), lambda: rc.Chain(3, length=1.0)])
def test_quantities_are_given_by_name(call):
    with pytest.raises(TypeError, match=r"revchain.Chain: give quantities by name, such as Chain\(mass=.*, length=.*\), got "):
        call()


def test_data_are_checked_as_arguments_are():
    data = rc.Chain(mass=[1.0, 2.0, 3.0], length=1.0).to_dict()
    for wrong in ({"names": ["a"]}, {"names": [1, 2, 3]}, {"links": "3"}, {"links": 3.5}, {"taper": "x"}):
        with pytest.raises((ValueError, TypeError), match="revchain.Chain.from_dict"):
            rc.Chain.from_dict({**data, **wrong})
    huge = 10**400  # too large for a float
    for name in ("mass", "length", "centroid", "gyration_ratio"):
        wrong = {**data, name: huge}
        for read in (
            lambda: rc.Chain.from_dict(wrong),
            lambda: rc.Rig.from_dict({"system": "Rig", "chain": wrong, "fluid": "still"}),
            lambda: rc.Held.from_dict({"system": "Held", "of": wrong, "span": 2.0}),
        ):
            with pytest.raises(ValueError, match=f"^revchain.Chain.from_dict: {name} must be a real number"):
                read()
    cord = rc.Cord(1.0, density=lambda s: 1 + s, masses={0.5: 0.1})
    assert rc.Cord.from_dict(cord.to_dict()) == cord
    density = [([], "density must be"), ([1], "density must be"), ([1, 2], "density: "), ([huge, 2], r"density\[0\] must be")]
    masses = [([[huge, 1.0]], "masses must be"), ([[0.5]], "masses must be pairs"), ([0.5], "masses must be pairs")]
    for key, values in {"density": density, "masses": masses}.items():
        for value, message in values:
            wrong = {**cord.to_dict(), key: value}
            for read in (
                lambda: rc.Cord.from_dict(wrong),
                lambda: rc.Held.from_dict({"system": "Held", "of": wrong, "span": 0.5}),
            ):
                with pytest.raises(ValueError, match=f"^revchain.Cord.from_dict: {message}"):
                    read()
    with pytest.raises(ValueError, match='^revchain.Held.from_dict: of must have "system"'):
        rc.Held.from_dict({"system": "Held", "of": {}, "span": 0.5})
    rig = rc.Rig(rc.Chain(mass=1.0, length=1.0)).to_dict()
    with pytest.raises(ValueError, match="there is no flywheel"):
        rc.Rig.from_dict({**rig, "flywheel": {"momentum": 1.0}})
    with pytest.raises(ValueError, match="drag must be a number or an array"):
        rc.Rig(rc.Chain(mass=[1.0] * 3, length=1.0), drag=[0.0, 0.0])


def test_a_rod_is_known_to_rounding():
    long = 0.1 + 0.2
    assert "rod, 1 kg" in rc.Chain(mass=1.0, length=long, centroid=0.15, radius_of_gyration=long / 12**0.5).describe()
    assert "body, 1 kg" in rc.Chain(mass=1.0, length=0.3, centroid=0.15 + 1e-9, radius_of_gyration=0.3 / 12**0.5).describe()
