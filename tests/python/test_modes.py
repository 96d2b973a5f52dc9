# SPDX-License-Identifier: GPL-3.0-or-later
"""revchain.modes, count_modes, recurrence_matrices and the result they give."""

import gc
import json
import math
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
import mpmath as mp
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from mechanics import chains

import revchain as rc
from revchain import _core
from revchain.results.base import restored

NAN, INF = math.nan, math.inf
ULP = 2.0**-52
THREE = rc.Chain(weight=[1.0, 0.0, 2.0, 3.0], length=1.0)  # four links, three modes
TWO = rc.Chain(weight=[1.0, 3.0], length=1.0)  # heights 3/2 and 1/2: Greenhill section 2


@given(chains(), st.one_of(st.none(), st.floats(1e-15, 1.0)))
@example(THREE, None)
@settings(max_examples=200)
def test_heights_lie_within_the_error_bound(exact_heights, worst_in_bounds, chain, rtol):
    result = rc.modes(chain, rtol=rtol)
    assert result.status == "success"
    assert len(result) == chain.mode_count
    assert result.error_bound.max() <= (rtol or 1e-13)
    assert worst_in_bounds(result, exact_heights(chain)) <= 1


@given(chains(4), st.sampled_from(["dense", "recurrence"]))
def test_reference_methods_agree_within_their_own_bounds(exact_heights, worst_in_bounds, chain, method):
    result = rc.modes(chain, method=method)
    assert result.method == method
    if np.isfinite(result.error_bound).all():
        assert worst_in_bounds(result, exact_heights(chain)) <= 1


@given(chains(), st.floats(0.1, 100.0), st.floats(0.01, 100.0))
def test_counting_by_speed_is_counting_by_height(chain, speed, gravity):
    height = rc.conical_pendulum.height(speed, gravity)
    heights = rc.modes(chain).conical_height
    if np.abs(heights / height - 1).min() > 1e-12:  # else the rounding of the height decides
        count = rc.count_modes(chain, angular_speed=speed, gravity=gravity)
        assert count == rc.count_modes(chain, conical_height=height) == (heights > height).sum()


@given(chains())
def test_shapes(chain):
    result = rc.modes(chain)
    assert result.shape.shape == (len(result), chain.size + 1)
    assert (result.shape[:, -1] == 0).all()
    assert (np.abs(result.shape).max(axis=1) == 1).all()
    assert (result.shape[:, 0] >= 0).all()
    assert result.residual.shape == (len(result),) and (result.residual >= 0).all()
    distance = np.concatenate([[0.0], np.cumsum(chain.length)])
    for shape, nodes in zip(result.shape, result.nodes, strict=True):
        assert (np.diff(nodes) >= 0).all()
        assert ((nodes > 0) & (nodes < distance[-1] * (1 + 4 * ULP))).all()
        signs = np.sign(shape[:-1])
        signs = signs[signs != 0]
        assert len(nodes) == (signs[1:] != signs[:-1]).sum()


def test_shapes_satisfy_relation_21():
    chain = rc.Chain(weight=[3, 1, 2, 5], length=[1, 0.5, 2, 1], centroid=[0.4, 0.3, 1.5, 0.2], pendulum_length=[0.6, 0.7, 1.8, 0.5])
    a, b = rc.recurrence_matrices(chain)
    result = rc.modes(chain)
    for height, shape in zip(result.conical_height, result.shape, strict=True):
        scale = np.abs(a) @ np.abs(shape[:-1]) + height * np.abs(b) @ np.abs(shape[:-1])
        assert (np.abs(a @ shape[:-1] - height * b @ shape[:-1]) <= 16 * ULP * scale).all()
    with pytest.raises(TypeError, match="must be a revchain.Chain"):
        rc.recurrence_matrices([1.0, 2.0])


def test_fields():
    chain = rc.Chain.uniform_rods(5, length=2.0)
    result = rc.modes(chain, count=3)
    assert {name for name in dir(result) if name[0] != "_"} == {name for name in rc.Modes._fields if name[0] != "_"} | (
        {"along", "slope", "with_gravity", "plot", "save", "to_dataframe", "to_dict", "to_excel", "to_xarray", "uncertainty"}
        | {"animate", "show", "to_glb"}
    )
    assert result.system is chain and len(result) == 3 and result.gravity == 9.80665
    assert result.conical_height.shape == result.error_bound.shape == (3,)
    assert (np.diff(result.conical_height) < 0).all()
    assert isinstance(result.nodes, tuple) and result.method == "aberth"


def test_how_many_modes():
    """Ten unless asked, or as many as there are."""
    rods = rc.Chain.uniform_rods(30)
    count = lambda *count, **first: rc.modes(rods, *count, **first).number.tolist()  # noqa: E731
    assert count() == list(range(1, 11))
    assert count(first=26) == count("all", first=26) == [26, 27, 28, 29, 30]
    assert count("all") == count(30) == list(range(1, 31))
    assert len(rc.modes(rods, conical_height=(0.0, INF))) == 30
    assert len(rc.modes(THREE)) == 3
    assert len(rc.modes(rc.Cord(1.0))) == len(rc.modes(rc.Chain.uniform_rods(10**6))) == 10


def test_speeds():
    result = rc.modes(TWO, gravity=6.0)
    assert result.conical_height.tolist() == [1.5, 0.5] and result.gravity == 6.0
    np.testing.assert_allclose(result.angular_speed, [2.0, math.sqrt(12.0)], rtol=2.1 * ULP)
    np.testing.assert_allclose(result.period, [math.pi, math.pi / math.sqrt(3)], rtol=2.6 * ULP)
    np.testing.assert_allclose(result.frequency * result.period, 1.0, rtol=4.2 * ULP)
    assert np.array_equal(result.rpm, 60 * result.frequency)
    earth = rc.modes(TWO)
    assert earth == rc.modes(TWO, gravity=9.80665) != result
    earth.shape, earth.rpm  # noqa: B018
    moved = earth.with_gravity(6.0)
    assert moved == result and moved.shape is earth.shape and moved.with_gravity(9.80665) == earth
    for name in ("angular_speed", "period", "frequency", "rpm", "speed_error_bound"):
        assert np.array_equal(getattr(moved, name), getattr(result, name))


@given(chains(5), st.floats(1e-3, 1e3), st.sampled_from([None, 1e-6, 0.3]))
def test_speeds_lie_within_their_bound(exact_heights, chain, gravity, rtol):
    result = rc.modes(chain, gravity=gravity, rtol=rtol)
    with mp.workdps(50):
        exact = [mp.sqrt(mp.mpf(gravity) / height) for height in exact_heights(chain)]
        for speed, frequency, period, bound, true in zip(
            result.angular_speed, result.frequency, result.period, result.speed_error_bound, exact, strict=True
        ):
            for found, wanted in ((speed, true), (frequency, true / (2 * mp.pi)), (period, 2 * mp.pi / true)):
                assert abs(mp.mpf(float(found)) / wanted - 1) <= mp.mpf(float(bound))


@pytest.mark.parametrize("gravity", [0.0, -9.8, NAN, INF, "9.8", None, [9.8, 1.6], True, 1j])
def test_gravity_refused(gravity):
    chain = rc.Chain.uniform_rods(2)
    calls = [partial(rc.modes, chain), partial(rc.modes, chain, conical_height=(0.1, 1.0)), partial(rc.modes, rc.Rig(chain))]
    calls += [rc.modes(chain).with_gravity, partial(rc.count_modes, chain, angular_speed=[1.0, 2.0])]
    several = isinstance(gravity, list)
    for call in calls[:4] if several else calls:
        with pytest.raises(ValueError, match="gravity must be a single number" if several else "gravity"):
            call(gravity=gravity)


METHODS = "of bisection, condensed, aberth, interpolated, dense, recurrence, .*closed forms, .*, got "


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        *(({"count": count, "first": 5}, f"count must be at least 1, got {count}") for count in (0, -1)),
        ({"count": 0}, "count must be at least 1, got 0"),
        ({"count": 41}, "count .*40.*41"),
        ({"count": 2.0}, "whole number, got 2.0"),
        ({"count": True}, "whole number"),
        ({"count": "some"}, "a number or \"all\", got 'some'"),
        ({"count": [1]}, "count must be"),
        ({"count": 10**30}, "count"),
        ({"first": 0}, "first must be at least 1, got 0"),
        ({"count": 6, "first": -3}, "first must be at least 1, got -3"),
        ({"count": 3, "first": 39}, "the 2 from number 39 on of the 40 modes.*got 3"),
        *(({**count, "first": 41}, "the 40 modes of this chain, got 41") for count in ({}, {"count": 1}, {"count": "all"})),
        *(({"first": first}, f"first must be a whole number, got {first!r}") for first in ("all", None, 1.0)),
        ({"count": 1, "first": 10**30}, "first is too large"),
        *(({"rtol": rtol}, f"rtol must not be negative or NaN, got {rtol}") for rtol in (-1e-3, -INF, NAN)),
        ({"rtol": "tight"}, "rtol must be a"),
        ({"rtol": [1e-3]}, "rtol must be a single number"),
        *(
            ({"method": name}, f"method must be one {METHODS}{name!r}")
            for name in ("qr", "auto", "", 3, "Closed Forms", "finite amplitude")
        ),
        ({"conical_height": (1.0, 2.0), "angular_speed": (1.0, 2.0), "count": 3, "first": 2}, "not both, got .*first"),
        *(({"conical_height": (low, 1.0)}, f"exceed its low end {low:g}, got 1") for low in (2.0, 1.0)),
        ({"conical_height": (-1.0, 1.0)}, "not negative, got -1"),
        ({"conical_height": (NAN, 1.0)}, "nan"),
        ({"conical_height": (1.0, NAN)}, "nan"),
        ({"conical_height": (INF, INF)}, "inf"),
        *(({"conical_height": window}, "pair") for window in (1.0, (1.0,), (1.0, 2.0, 3.0), "12")),
        ({"conical_height": ("1", "b")}, r"\(each end\) must be a number"),
        ({"angular_speed": (2.0, 1.0)}, "angular speed"),
        ({"precision": "single"}, r"precision must be one of double, extended, double-double, got 'single'; float is for C\+\+ alone"),
        ({"precision": None}, "precision.*None"),
        ({"precision": "extended", "method": "dense"}, "double only"),
    ],
)
def test_refused(arguments, message):
    rods = rc.Chain.uniform_rods(40, length=0.36)
    with pytest.raises(ValueError, match=f"revchain.*modes: .*{message}"):
        rc.modes(rods, **arguments)
    if set(arguments) <= {"count", "first", "rtol"}:
        with pytest.raises((ValueError, TypeError), match="revchain.explain|revchain::"):
            rc.explain(rods, **arguments)


def test_count_modes_shapes():
    chain = rc.Chain.uniform_plummets(10)
    assert isinstance(rc.count_modes(chain, conical_height=0.1), np.int64)
    heights = np.array([[0.01, 0.1, 1.0], [0.5, 0.2, 1e-9]])
    counts = rc.count_modes(chain, conical_height=heights)
    assert counts.shape == (2, 3) and counts.dtype == np.int64
    assert counts.tolist() == [[(rc.modes(chain).conical_height > h).sum() for h in row] for row in heights]
    assert rc.count_modes(chain, conical_height=[]).shape == (0,)
    by_speed = rc.count_modes(chain, angular_speed=[[1.0], [20.0]], gravity=[9.8, 1.6, 0.1])
    assert by_speed.shape == (2, 3)
    assert by_speed[1, 1] == rc.count_modes(chain, conical_height=1.6 / 400.0)


@pytest.mark.parametrize(
    "arguments",
    [{}, {"conical_height": 1.0, "angular_speed": 1.0}, {"angular_speed": [1.0, 2.0], "gravity": [1.0, 2.0, 3.0]}]
    + [{"conical_height": value} for value in (0.0, [1.0, -1.0], NAN, "1")]
    + [{"angular_speed": value} for value in (0.0, -1.0, NAN)],
    ids=repr,
)
def test_count_modes_refused(arguments):
    with pytest.raises(ValueError, match="revchain"):
        rc.count_modes(rc.Chain.uniform_rods(3), **arguments)


def test_to_dict_is_ready_for_json():
    result = rc.modes(rc.Chain.uniform_rods(6, length=2.0, weight=3.0), count=2, gravity=1.62)
    data = result.to_dict()
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    facts = ["gravity", "method", "status", "precision", "complete", "other", "slack_link", "slack_speed", "description"]
    assert list(data) == ["system", *facts, "modes"] and data["complete"] is True and data["other"] == data["slack_link"] == []
    assert data["gravity"] == 1.62
    second = data["modes"][1]
    numbers = ["angular_speed", "frequency", "rpm", "period", "speed_error_bound", "conical_height", "error_bound", "residual"]
    assert set(second) == {"mode", "direction", *numbers, "nodes", "shape"}
    assert second["mode"] == 2 and second["direction"] == 1
    assert {name: second[name] for name in numbers} == {name: getattr(result, name)[1] for name in numbers}
    assert second["nodes"] == result.nodes[1].tolist() and len(second["nodes"]) == 1
    assert second["shape"] == result.shape[1].tolist()
    assert data["description"] == result.system.describe()
    assert rc.Chain.from_dict(data["system"]) == result.system


def test_dataframe():
    result = rc.modes(rc.Chain.uniform_rods(6), count=2, first=3, gravity=1.62, certify=True)
    table = result.to_dataframe()
    assert table.index.tolist() == [3, 4] and table.attrs["gravity"] == 1.62
    for name in ("angular_speed", "rpm", "conical_height", "residual"):
        assert np.array_equal(table[name], getattr(result, name))
    assert np.array_equal(table["certificate_lower"], result.certificate.lower)


def test_tables():
    result = rc.modes(rc.Chain.uniform_rods(30), count=25)
    lines = repr(result).splitlines()
    assert lines[0].startswith("25 of 30 modes of a chain of 30 links") and lines[0].endswith("success")
    assert lines[1].split("  ")[0] == "mode" and lines[1].endswith("nodes (m from the free end)")
    assert len({len(line) for line in lines[1:-2]}) == 1 and len(lines) == 1 + 21 + 2  # aligned
    assert lines[-2] == "and 5 more" and "9.80665" in lines[-1]
    html = result._repr_html_()
    assert html.startswith("<table>") and html.count("<tr>") == 1 + 20 + 1
    assert all(text in html for text in ("25 of 30 modes", "and 5 more", "9.80665"))


def test_tables_of_long_chains_show_nodes_that_are_known():
    result = rc.modes(rc.Chain.uniform_rods(60_000), 2)
    assert "nodes" not in repr(result) and "nodes" not in result._repr_html_()
    result.nodes  # noqa: B018
    assert "nodes" in repr(result) and "nodes" in result._repr_html_()


def test_python_runs_on_while_modes_are_computed():
    """The lock of the interpreter is released: progress is seen to move, and can be stopped."""
    chain, progress = rc.Chain.uniform_rods(300_000)._compiled, _core.Progress()
    with ThreadPoolExecutor(1) as pool:
        work = pool.submit(_core.modes, chain, 1, 200, None, None, None, False, "double", "auto", progress)
        until = time.monotonic() + 30
        while progress.fraction == 0 and not work.done() and time.monotonic() < until:
            time.sleep(0.001)
        seen = progress.fraction
        progress.cancel()
        with pytest.raises(_core.Cancelled) as raised:
            work.result(30)
    assert 0 < seen < 1 and isinstance(raised.value, RuntimeError)


def test_equal_results():
    chain = rc.Chain.uniform_rods(5)
    result = rc.modes(chain)
    result.shape, result.sensitivity  # noqa: B018
    assert result == rc.modes(chain)  # whatever was read
    for other in ({"count": 4}, {"certify": True}, {"gravity": 1.62}, {"precision": "extended"}, {"method": "dense"}):
        assert result != rc.modes(chain, **other)
    assert result != rc.modes(rc.Rig(chain)) and result != 3


def test_a_light_link_below_a_heavy_one():
    lengths = [0.9277025938204417, 0.5091991363691613]
    result = rc.modes(rc.Chain(weight=[1, 1e12], length=lengths))
    height = result.conical_height[1]
    assert result.shape[1, 1] == pytest.approx(1 - lengths[0] / height, rel=1e-14)  # the moment about the upper pin


def test_a_height_that_is_not_positive_is_shown():
    """As rounding may leave it with method="dense"."""
    result = rc.modes(TWO, method="dense")
    result = restored(rc.Modes, {**result._state(), "conical_height": np.array([1.5, -1e-17])})
    for text in (repr(result), result._repr_html_()):
        assert "-1.00000000e-17" in text and "nan" in text and "1.5" in text


def test_a_printed_table_takes_few_calls():
    result, calls = rc.modes(TWO), []
    gc.disable()  # what it calls for results of other tests does not count
    sys.setprofile(lambda frame, event, _: calls.append(frame.f_code.co_qualname) if event == "call" else None)
    try:
        text = repr(result)
    finally:
        sys.setprofile(None)
        gc.enable()
    assert text.startswith("2 of 2 modes") and len(calls) <= 61, calls  # one of them for the unit that was asked


def test_rows():
    result = rc.modes(TWO)
    assert [row.number for row in result] == [1, 2] and result[-1].conical_height == result.conical_height[1]
    assert result[1].nodes.tolist() == [0.5] and np.array_equal(result[0].shape, result.shape[0])
    assert repr(result[0]).startswith("mode 1, speed (rad/s) 2.55691") and "frequency" in dir(result[0])
    with pytest.raises(AttributeError, match="has no gravity"):
        _ = result[0].gravity
    with pytest.raises(IndexError, match="index must be from -2 to 1, got 2"):
        _ = result[2]
