# SPDX-License-Identifier: GPL-3.0-or-later
"""revchain.modes, count_modes, recurrence_matrices and the result they give."""

import copy
import dataclasses
import json
import math
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import revchain as rc
from revchain import _core

NAN, INF = math.nan, math.inf
ULP = 2.0**-52


@st.composite
def chains(draw, most=7):
    """Chains of all kinds: plummets, rods, bodies with the centre of gravity above and below the pin."""
    n = draw(st.integers(1, most))
    numbers = lambda low, high: st.lists(st.floats(low, high), min_size=n, max_size=n)  # noqa: E731
    weight = np.exp2(draw(numbers(-20.0, 20.0)))
    length = np.exp2(draw(numbers(-5.0, 5.0)))
    kind = draw(st.sampled_from(["plummets", "radius", "pendulum"]))
    if kind == "plummets":
        return rc.Chain(weight=weight, length=length)
    below = np.concatenate([[0.0], np.cumsum(weight)[:-1]])
    highest = -0.5 * length * below / weight  # half way to standing
    share = np.array(draw(numbers(0.001, 1.0)))
    centroid = highest + share * (length - highest)
    ratio = np.array(draw(numbers(0.0, 2.0)))
    ratio[ratio < 1e-6] = 0.0  # smaller lengths than 1e-77 of the largest are refused
    if kind == "radius":
        return rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=ratio * length)
    centroid = np.where(np.abs(centroid) < 1e-6 * length, 0.1 * length, centroid)
    return rc.Chain(weight=weight, length=length, centroid=centroid, pendulum_length=centroid * (1 + ratio))


@given(chains())
def test_heights_lie_within_the_error_bound(exact_heights, worst_in_bounds, chain):
    result = rc.modes(chain)
    assert result.status == "success"
    assert len(result) == chain.mode_count
    assert worst_in_bounds(result, exact_heights(chain)) <= 1
    assert result.error_bound.max() <= 1e-13


@given(chains(5), st.floats(1e-15, 1.0))
def test_a_tolerance_is_met_and_the_bound_holds(exact_heights, worst_in_bounds, chain, rtol):
    result = rc.modes(chain, rtol=rtol, shapes=False)
    assert result.status == "success"
    assert result.error_bound.max() <= rtol
    assert worst_in_bounds(result, exact_heights(chain)) <= 1


@given(chains(4), st.sampled_from(["dense", "recurrence"]))
def test_reference_methods_agree_within_their_own_bounds(exact_heights, worst_in_bounds, chain, method):
    result = rc.modes(chain, method=method)
    assert result.method == method
    if np.isfinite(result.error_bound).all():
        assert worst_in_bounds(result, exact_heights(chain)) <= 1


@given(chains())
def test_counting_agrees_with_the_modes(chain):
    result = rc.modes(chain, shapes=False)
    width = 2 * result.error_bound
    above = rc.count_modes(chain, conical_height=result.conical_height * (1 + width))
    below = rc.count_modes(chain, conical_height=result.conical_height * (1 - width))
    index = np.arange(len(result))
    # coincident heights may share a bracket: never fewer below than above, and k - 1 < k between
    assert (above <= index).all() and (below >= index + 1).all()


@given(chains(), st.floats(0.1, 100.0), st.floats(0.01, 100.0))
def test_counting_by_speed_is_counting_by_height(chain, speed, gravity):
    height = rc.conical_pendulum.height(speed, gravity)
    heights = rc.modes(chain, shapes=False).conical_height
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


@given(st.lists(st.floats(0.1, 10.0), min_size=2, max_size=8))
def test_mode_k_of_plummets_has_k_minus_one_nodes(weight):
    result = rc.modes(rc.Chain(weight=weight, length=1.0))
    assert [nodes.size for nodes in result.nodes] == list(range(len(weight)))


def test_shapes_satisfy_relation_21():
    chain = rc.Chain(weight=[3, 1, 2, 5], length=[1, 0.5, 2, 1], centroid=[0.4, 0.3, 1.5, 0.2], pendulum_length=[0.6, 0.7, 1.8, 0.5])
    a, b = rc.recurrence_matrices(chain)
    result = rc.modes(chain)
    for height, shape in zip(result.conical_height, result.shape, strict=True):
        scale = np.abs(a) @ np.abs(shape[:-1]) + height * np.abs(b) @ np.abs(shape[:-1])
        assert (np.abs(a @ shape[:-1] - height * b @ shape[:-1]) <= 16 * ULP * scale).all()


def test_fields():
    chain = rc.Chain.uniform_rods(5, length=2.0)
    result = rc.modes(chain, count=3)
    assert [field.name for field in dataclasses.fields(result)] == (
        ["chain", "number", "conical_height", "error_bound", "shape", "residual", "nodes", "method", "status"]
        + ["precision", "certificate", "conical_height_low"]
    )
    assert result.chain is chain and len(result) == 3
    assert result.conical_height.shape == result.error_bound.shape == (3,)
    assert (np.diff(result.conical_height) < 0).all()
    assert isinstance(result.nodes, list) and result.method == "bisection"


def test_without_shapes():
    result = rc.modes(rc.Chain.uniform_rods(5), shapes=False)
    assert result.shape is None and result.residual is None and result.nodes is None
    assert np.array_equal(result.conical_height, rc.modes(rc.Chain.uniform_rods(5)).conical_height)


def test_the_result_is_frozen():
    result = rc.modes(rc.Chain.uniform_rods(3))
    with pytest.raises(dataclasses.FrozenInstanceError):
        result.status = "fine"
    with pytest.raises((AttributeError, TypeError)):
        result.colour = "red"
    for array in (result.number, result.conical_height, result.error_bound, result.shape, result.residual, *result.nodes):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0.0


@pytest.mark.parametrize("shapes", [True, False])
def test_pickle_and_copy(shapes):
    result = rc.modes(rc.Chain.uniform_rods(6), shapes=shapes)
    for twin in (pickle.loads(pickle.dumps(result)), copy.deepcopy(result), copy.copy(result)):
        assert twin.chain == result.chain and twin.status == result.status
        assert np.array_equal(twin.conical_height, result.conical_height)
        assert not twin.conical_height.flags.writeable
        assert (twin.shape is None) == (not shapes)


def test_speeds():
    result = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0))  # heights 3/2 and 1/2: Greenhill section 2
    assert result.conical_height.tolist() == [1.5, 0.5]
    np.testing.assert_allclose(result.angular_speed(6.0), [2.0, math.sqrt(12.0)], rtol=2.1 * ULP)
    np.testing.assert_allclose(result.period(6.0), [math.pi, math.pi / math.sqrt(3)], rtol=2.6 * ULP)
    np.testing.assert_allclose(result.revolutions_per_second(6.0) * result.period(6.0), 1.0, rtol=4.2 * ULP)
    assert np.array_equal(result.angular_speed(), result.angular_speed(9.80665))
    moon_and_earth = result.angular_speed([[1.62], [9.80665]])
    assert moon_and_earth.shape == (2, 2)
    assert np.array_equal(moon_and_earth[0], result.angular_speed(1.62))


@pytest.mark.parametrize("gravity", [0.0, -9.8, NAN, INF, "9.8", None, [9.8, 0.0], True, 1j])
def test_gravity_refused(gravity):
    result = rc.modes(rc.Chain.uniform_rods(2))
    for speed in (result.angular_speed, result.period, result.revolutions_per_second):
        with pytest.raises(ValueError, match="gravity"):
            speed(gravity)
    with pytest.raises(ValueError, match="gravity"):
        rc.count_modes(result.chain, angular_speed=[1.0, 2.0], gravity=gravity)


THREE = rc.Chain(weight=[1.0, 0.0, 2.0, 3.0], length=1.0)  # four links, three modes
BAD = {
    "count 0": ({"count": 0}, "count must be.*0"),
    "count -1": ({"count": -1}, "count must be"),
    "count above mode_count": ({"count": 4}, "count .*3.*4"),
    "count not whole": ({"count": 2.0}, "whole number, got 2.0"),
    "count boolean": ({"count": True}, "whole number"),
    "count text": ({"count": "all"}, "whole number"),
    "huge count": ({"count": 10**30}, "count"),
    "rtol nan": ({"rtol": NAN}, "(rtol|tolerance).*nan"),
    "rtol negative": ({"rtol": -1e-3}, "(rtol|tolerance).*-0.001"),
    "rtol text": ({"rtol": "tight"}, "rtol must be a real number"),
    "rtol array": ({"rtol": [1e-3]}, "rtol must be a single number"),
    "method unknown": ({"method": "qr"}, "auto, bisection, condensed, aberth, interpolated, dense, recurrence.*qr"),
    "method no text": ({"method": None}, "auto, bisection, condensed, aberth, interpolated, dense, recurrence.*None"),
}


@pytest.mark.parametrize(("arguments", "message"), BAD.values(), ids=BAD.keys())
def test_refused(arguments, message):
    with pytest.raises(ValueError, match=f"revchain.*modes.*{message}"):
        rc.modes(THREE, **arguments)


def test_all_modes_of_a_chain_with_a_massless_link(exact_heights, worst_in_bounds):
    result = rc.modes(THREE)
    assert len(result) == 3
    assert worst_in_bounds(result, exact_heights(THREE)) <= 1


def test_what_is_no_chain():
    for call in (rc.modes, rc.recurrence_matrices):
        with pytest.raises(TypeError, match="must be a revchain.Chain"):
            call([1.0, 2.0])
    with pytest.raises(TypeError, match="must be a revchain.Chain"):
        rc.count_modes(None, conical_height=1.0)


def test_a_tolerance_out_of_reach_is_said():
    result = rc.modes(rc.Chain.uniform_rods(20), rtol=1e-30)
    assert result.status == "tolerance_not_met"
    assert (result.error_bound > 1e-30).all() and result.error_bound.max() <= 1e-13
    assert rc.modes(rc.Chain.uniform_rods(20), rtol=0.0).status == "tolerance_not_met"


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
    [
        {},
        {"conical_height": 1.0, "angular_speed": 1.0},
        {"conical_height": 0.0},
        {"conical_height": [1.0, -1.0]},
        {"conical_height": NAN},
        {"conical_height": "1"},
        {"angular_speed": 0.0},
        {"angular_speed": -1.0},
        {"angular_speed": NAN},
        {"angular_speed": [1.0, 2.0], "gravity": [1.0, 2.0, 3.0]},
    ],
)
def test_count_modes_refused(arguments):
    with pytest.raises(ValueError):
        rc.count_modes(rc.Chain.uniform_rods(3), **arguments)


def test_to_dict_is_ready_for_json():
    result = rc.modes(rc.Chain.uniform_rods(6, length=2.0, weight=3.0), count=2)
    data = result.to_dict(gravity=1.62)
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    assert list(data) == ["modes", "method", "status", "precision", "gravity", "chain"]
    second = data["modes"][1]
    assert second["mode"] == 2
    assert second["conical_height"] == result.conical_height[1]
    assert second["angular_speed"] == result.angular_speed(1.62)[1]
    assert second["period"] == result.period(1.62)[1]
    assert second["error_bound"] == result.error_bound[1]
    assert second["nodes"] == result.nodes[1].tolist() and len(second["nodes"]) == 1
    assert second["shape"] == result.shape[1].tolist()
    assert "shape" not in result.to_dict(shapes=False)["modes"][0]
    assert "nodes" not in rc.modes(result.chain, shapes=False).to_dict()["modes"][0]
    assert data["chain"] == {"size": 6, "mode_count": 6, "length": pytest.approx(2.0), "weight": pytest.approx(3.0)}


def test_tables():
    result = rc.modes(rc.Chain.uniform_rods(30), count=25)
    lines = repr(result).splitlines()
    assert "25 of 30 modes" in lines[0] and "success" in lines[0]
    assert len({len(line) for line in lines[1:-1]}) == 1  # aligned
    assert "... and 5 more" in lines[-1] and "9.80665" in lines[-1]
    html = result._repr_html_()
    assert html.startswith("<table>") and html.count("<tr>") == 1 + 20 + 1
    assert "-" in repr(rc.modes(rc.Chain.uniform_rods(2), shapes=False)).splitlines()[-2].split()[-1]


def test_python_runs_on_while_modes_are_computed():
    """The lock of the interpreter is released: progress is seen to move, and can be stopped."""
    chain = rc.Chain.uniform_rods(300_000)._compiled
    progress = _core.Progress()
    raised = []

    def work():
        try:
            _core.modes(chain, 1, 200, None, None, None, False, False, "double", "auto", progress)
        except _core.Cancelled as error:
            raised.append(error)

    worker = threading.Thread(target=work)
    worker.start()
    until = time.monotonic() + 30
    while progress.fraction == 0 and worker.is_alive() and time.monotonic() < until:
        time.sleep(0.001)
    seen = progress.fraction
    progress.cancel()
    worker.join(30)
    assert not worker.is_alive()
    assert 0 < seen < 1
    assert len(raised) == 1 and isinstance(raised[0], RuntimeError)


def test_threads_share_a_chain():
    chain = rc.Chain.uniform_rods(2000)
    expected = rc.modes(chain, count=5).conical_height
    results = []
    workers = [threading.Thread(target=lambda: results.append(rc.modes(chain, count=5))) for _ in range(8)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(results) == 8
    assert all(np.array_equal(result.conical_height, expected) for result in results)


def test_ctrl_c_stops_a_long_computation(start):
    """In the interpreter as in a script: KeyboardInterrupt, soon, and the session goes on."""
    script = """
import revchain as rc
print("ready", flush=True)
try:
    rc.modes(rc.Chain.uniform_rods(20_000), shapes=False)   # minutes
except KeyboardInterrupt:
    print("interrupted", flush=True)
print(rc.modes(rc.Chain.uniform_rods(1)).conical_height.size)
"""
    process = start(sys.executable, "-c", script, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (out, err, process.returncode) == ("interrupted\n1\n", "", 0)


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_every_pickle_protocol(protocol):
    chain = rc.Chain(weight=[1, 2], length=1.0, centroid=0.3, radius_of_gyration=[0.1, 0.2])
    result = rc.modes(chain)
    assert pickle.loads(pickle.dumps(chain, protocol)) == chain
    assert pickle.loads(pickle.dumps(result, protocol)) == result


def test_equal_results():
    chain = rc.Chain.uniform_rods(5)
    assert rc.modes(chain) == rc.modes(chain)
    assert rc.modes(chain) != rc.modes(chain, count=4)
    assert rc.modes(chain) != rc.modes(chain, shapes=False)
    assert rc.modes(chain) != 3


def test_nodes_outlast_offsets_that_underflow():
    result = rc.modes(rc.Chain.uniform_plummets(500))
    assert [len(nodes) for nodes in result.nodes] == list(range(500))


def test_a_light_link_below_a_heavy_one():
    lengths = [0.9277025938204417, 0.5091991363691613]
    result = rc.modes(rc.Chain(weight=[1, 1e12], length=lengths))
    height = result.conical_height[1]
    assert result.shape[1, 1] == pytest.approx(1 - lengths[0] / height, rel=1e-14)  # the moment about the upper pin


def test_a_height_that_is_not_positive_is_shown():
    """As rounding may leave it with method="dense"."""
    result = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0), method="dense")
    result = dataclasses.replace(result, conical_height=np.array([1.5, -1e-17]))
    for text in (repr(result), result._repr_html_()):
        assert "-1.00000000000e-17" in text and "nan" in text and "1.5" in text
