# SPDX-License-Identifier: GPL-3.0-or-later
"""Which modes: numbers and windows; certificates; precisions. Checked against all modes and against mpmath.

Random windows of long chains: tests/cpp/linear/selection.cpp."""

import copy
import itertools
import json
import math
import pickle
import timeit
from decimal import Decimal

import mpmath as mp
import numpy as np
import pytest
from exact import stored_links
from hanging_links import Body, Hanging
from hypothesis import given
from hypothesis import strategies as st
from mechanics import chains

import revchain as rc
from revchain import _core

ULP = 2.0**-52
NAN, INF = math.nan, math.inf
RODS = rc.Chain.uniform_rods(40, length=0.36)


def same_modes(part, every):
    """The same numbers give the same modes, to a last digit of the heights."""
    index = part.number - every.number[0]
    np.testing.assert_allclose(part.conical_height, every.conical_height[index], rtol=ULP)
    np.testing.assert_allclose(part.shape, every.shape[index], rtol=0, atol=1e-12)
    assert [nodes.size for nodes in part.nodes] == [every.nodes[i].size for i in index]


@given(chains(), st.data())
def test_any_range_of_numbers(chain, data):
    first = data.draw(st.integers(1, chain.mode_count))
    last = data.draw(st.integers(first, chain.mode_count))
    every = rc.modes(chain)
    part = rc.modes(chain, last + 1 - first, first=first)
    assert part.number.tolist() == list(range(first, last + 1))
    assert part.status == "success"
    same_modes(part, every)


@given(chains(), st.lists(st.floats(0.01, 100), min_size=1, max_size=4, unique=True), st.floats(0.1, 10))
def test_windows_of_speeds_that_meet_lose_nothing(chain, ends, gravity):
    ends = [0.0, *sorted(ends), INF]
    found = [
        rc.modes(chain, angular_speed=window, gravity=gravity).number
        for window in zip(ends[:-1], ends[1:], strict=True)
    ]
    assert np.concatenate(found).tolist() == list(range(1, chain.mode_count + 1))
    for numbers, low, high in zip(found, ends[:-1], ends[1:], strict=True):
        below = rc.count_modes(chain, angular_speed=low, gravity=gravity) if low > 0 else 0
        assert numbers.size == 0 or numbers[0] == below + 1
        if high < INF:
            assert below + numbers.size == rc.count_modes(chain, angular_speed=high, gravity=gravity)


def test_a_height_at_the_end_of_a_window():
    chain = rc.Chain(weight=[1.0, 3.0], length=1.0)  # heights 3/2 and 1/2: Greenhill section 2
    number = lambda **window: rc.modes(chain, **window).number.tolist()  # noqa: E731
    assert number(conical_height=(0.5, 1.5)) == [1]
    assert number(conical_height=(1.5, 2.0)) == []
    assert number(conical_height=(0.25, 0.5)) == [2]
    assert number(conical_height=(0, INF)) == [1, 2]
    assert number(conical_height=(np.nextafter(0.5, 0), np.nextafter(1.5, 0))) == [2]
    assert number(angular_speed=(2, 3), gravity=6) == [1]
    assert number(angular_speed=(1, 2), gravity=6) == []
    assert number(angular_speed=(4, INF), gravity=8) == [2]
    assert number(angular_speed=(3, 4), gravity=8) == []


@pytest.mark.parametrize("certify", [True, False])
def test_an_empty_window(certify):
    result = rc.modes(RODS, conical_height=(10, 20), certify=certify)
    assert result.shape.shape == (0, 41) and result.nodes == ()
    assert repr(result).splitlines()[1:] == ["gravity 9.80665 m/s^2; error bound: relative, of the conical height"]
    assert "<table>" in result._repr_html_() and result.to_dict()["modes"] == []
    assert len(result) == 0 and result.status == "success" and "0 of 40 modes" in repr(result)
    assert result.number.dtype == np.int64 and result.angular_speed.shape == (0,)
    assert (result.certificate is not None) == certify
    assert result.to_xarray().sizes["mode"] == len(result.to_dataframe()) == 0
    assert "no mode in this window" in result.plot().get_xlabel()
    with pytest.raises(ValueError, match="there are no modes"):
        result.plot(modes=[1])


SELECTORS = {"count": 3, "first": 2, "conical_height": (0.1, 1.0), "angular_speed": (1.0, 2.0)}


@pytest.mark.parametrize(("one", "other"), list(itertools.combinations(SELECTORS, 2)))
def test_one_selector_alone(one, other):
    rc.modes(RODS, **{one: SELECTORS[one]})
    asked = {name: SELECTORS[name] for name in (one, other)}
    if (one, other) == ("count", "first"):
        for whole in (int, np.int32, np.uint8, np.array):
            given = {name: whole(number) for name, number in asked.items()}
            assert rc.modes(RODS, **given).number.tolist() == [2, 3, 4]
        return
    message = r"revchain\.modes: give one window, or count and first, not both, got "
    with pytest.raises(ValueError, match=message) as caught:
        rc.modes(RODS, **asked)
    assert set(str(caught.value).partition("got ")[2].split(" and ")) == {one, other}


@given(chains(6), st.sampled_from([None, 1e-12, 1e-3, 0.7]))
def test_certificates_hold_in_sixty_digits(exact_heights, chain, rtol):
    result = rc.modes(chain, rtol=rtol, certify=True)
    proof = result.certificate
    with mp.workdps(60):
        pencil = Hanging([Body(*(Decimal(mp.nstr(x, 60)) for x in link)) for link in stored_links(chain)])
        for end, counts in ((proof.lower, proof.above_lower), (proof.upper, proof.above_upper)):
            assert [pencil.above(x) for x in end.tolist()] == counts.tolist()
        for lower, height, upper in zip(proof.lower.tolist(), exact_heights(chain), proof.upper.tolist(), strict=True):
            assert lower < height <= upper
    assert (proof.above_lower >= result.number).all() and (proof.above_upper < result.number).all()
    assert np.array_equal(rc.count_modes(chain, conical_height=proof.lower), proof.above_lower)
    assert np.array_equal(rc.count_modes(chain, conical_height=proof.upper), proof.above_upper)
    said = 2.001 * result.error_bound / (1 - result.error_bound) * result.conical_height
    assert (proof.upper - proof.lower <= said + ULP * proof.upper).all()  # the ends are rounded


@pytest.mark.parametrize("method", ["dense", "recurrence"])
def test_dense_methods_take_selections_too(method):
    every = rc.modes(RODS)
    part = rc.modes(RODS, count=3, first=5, method=method, certify=True)
    assert part.method == method and part.number.tolist() == [5, 6, 7]
    np.testing.assert_allclose(part.conical_height, every.conical_height[4:7], rtol=1e-9)
    assert part.certificate.above_lower.tolist() == [5, 6, 7]
    assert rc.modes(RODS, conical_height=(0.01, 0.1), method=method).number.tolist() == (
        rc.modes(RODS, conical_height=(0.01, 0.1)).number.tolist()
    )


TYPES = {"double": np.float64, "extended": np.longdouble, "double-double": np.float64}


@pytest.mark.parametrize("precision", _core.PRECISIONS)
def test_precisions(tmp_path, precision):
    kind = TYPES[precision]
    result = rc.modes(RODS, count=6, first=3, precision=precision, certify=True)
    assert result.precision == precision and result.status == "success"
    for array in (result.conical_height, result.error_bound, result.shape, result.residual, *result.nodes):
        assert array.dtype == kind and not array.flags.writeable
    assert result.certificate.lower.dtype == kind
    assert (result.conical_height_low is not None) == (precision == "double-double")
    assert (result.certificate.upper_low is not None) == (precision == "double-double")
    speeds = (result.angular_speed, result.period, result.frequency)
    assert all(speed.dtype == (np.longdouble if precision == "extended" else np.float64) for speed in speeds)
    np.testing.assert_allclose(result.angular_speed, rc.modes(RODS, count=6, first=3).angular_speed, rtol=1e-15)
    assert json.loads(json.dumps(result.to_dict(), allow_nan=False))["precision"] == precision
    assert "modes 3 to 8 of 40" in repr(result)
    assert result == pickle.loads(pickle.dumps(result)) == copy.deepcopy(result)
    for read, ending in itertools.product((False, True), (".npz", ".nc")):
        fresh = rc.modes(RODS, count=11, first=20, certify=True, precision=precision)
        if read:
            fresh.shape  # noqa: B018
        fresh.save(tmp_path / f"result{ending}")
        loaded = rc.load(tmp_path / f"result{ending}")
        assert loaded == fresh and loaded.certificate == fresh.certificate
        assert np.array_equal(loaded.shape, fresh.shape) and loaded.shape.dtype == fresh.shape.dtype == kind
        assert loaded.number.tolist() == list(range(20, 31)) and loaded.conical_height.dtype == kind
    data = result.to_xarray()
    assert data.mode.values.tolist() == [3, 4, 5, 6, 7, 8] and data.conical_height.dtype == kind
    assert data.attrs["precision"] == precision


def exactly(value):
    """A number of any precision in mpmath."""
    high = float(value)
    return mp.mpf(high) + mp.mpf(float(value - type(value)(high)))


@given(chains(6, wild=False))
def test_every_precision_is_within_its_bound(exact_heights, chain):
    exact = exact_heights(chain)
    with mp.workdps(50):
        for precision, limit in (("extended", 2.2e-19), ("double-double", 1e-26)):
            result = rc.modes(chain, precision=precision, certify=True)
            low = [0.0] * len(result) if result.conical_height_low is None else result.conical_height_low.tolist()
            heights = [exactly(height) + rest for height, rest in zip(result.conical_height, low, strict=True)]
            proof = result.certificate
            ends = (proof.lower, proof.upper), (proof.lower_low, proof.upper_low)
            for j, (height, truth) in enumerate(zip(heights, exact, strict=True)):
                assert abs(height / truth - 1) <= mp.mpf(float(result.error_bound[j]))
                assert result.error_bound[j] <= limit
                lower, upper = (
                    exactly(end[j]) + (0 if rest is None else rest[j]) for end, rest in zip(*ends, strict=True)
                )
                assert lower < truth <= upper


def test_plots_and_tables_say_the_numbers():
    result = rc.modes(rc.Chain.uniform_plummets(300), count=30, first=100)
    lines = repr(result).splitlines()
    assert "modes 100 to 129 of 300" in lines[0]
    assert [line.split()[0] for line in lines[2:22]] == [str(number) for number in range(100, 120)]
    assert "<td>119</td>" in result._repr_html_()
    axes = result.plot()
    labels = [label.get_text().splitlines()[0] for label in axes.get_xticklabels()]
    assert labels == ["at rest", *(f"mode {k}" for k in range(100, 106))]
    curve = next(line for line in result.plot(modes=[129]).lines if line.get_label() == "mode 129")
    across = curve.get_xdata()  # each mode hangs from its own axis
    np.testing.assert_allclose(across - across[-1], result.shape[29], rtol=0, atol=1e-15)
    for wrong in (99, 130, 1):
        with pytest.raises(ValueError, match=f"from 100 to 129, got {wrong}"):
            result.plot(modes=[wrong])
    assert [mode["mode"] for mode in result.to_dict()["modes"]] == list(range(100, 130))
    assert float(result.to_xarray().conical_height.sel(mode=129)) == result.conical_height[-1]


def test_python_adds_little():
    """Less than 20 microseconds to the call of three links; the least of many runs, as others use the machine too."""
    chain = rc.Chain.uniform_rods(3)
    arguments = (chain._compiled, 1, None, None, None, None, False, "double", "auto", None)
    calls = (lambda: rc.modes(chain).shape, lambda: _core.modes(*arguments).shape)
    whole, core = (min(timeit.repeat(call, number=100, repeat=60)) / 100 for call in calls)
    assert whole - core < 20e-6
