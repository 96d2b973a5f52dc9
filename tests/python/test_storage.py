# SPDX-License-Identifier: GPL-3.0-or-later
"""Results in files: nothing lost, nothing half-written, nothing pickled."""

import copy
import json
import os
import pickle
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import openpyxl
import pytest
from tier import by_tier

import revchain as rc
from revchain.results import files as _files
from revchain.results import storage as _storage

CHAIN = rc.Chain(weight=[5, 1, 0, 1], length=[1, 2, 1, 0.3], centroid=[1, 0.5, 0.1, -0.2], radius_of_gyration=0.3)
CHAINS = {
    "bodies": CHAIN,
    "plummets": rc.Chain(weight=[1.0, 0.0, 3.0], length=0.1),
    "rods": rc.Chain.uniform_rods(40, length=0.36, weight=0.3),
    "one link": rc.Chain(weight=1.0, length=1.0),
    "pendulum length": rc.Chain(weight=[1.0, 2.0], length=0.7, centroid=0.1, pendulum_length=[0.3, 0.7]),
}
THREE = rc.Chain(weight=[1.0, 1.0, 1.0], length=1.0)
NAMED = rc.Chain(mass=[1.0, 2.0], length=0.7, names=["lower", "upper"])
ONE = rc.Chain(weight=1.0, length=[1.0])
WHEELS = rc.Rig(CHAIN, flywheels=rc.Flywheel(momentum=0.2))
BLADE = rc.Held(rc.Chain.uniform_rods(8, length=1.0, mass=1.0), span=0.7)
ROPE = rc.Held(rc.Cord(1.0, mass=1.0), span=0.7)
TIP = rc.Cord(1.0, mass=2.0, tip_mass=0.1)
FLOATING = rc.Displaced(weight=[1.0, 1.0, 2.0], centroid=0.4, radius_of_gyration=0.3)
FLOATS = {"displaced": rc.Displaced(weight=[1, 0, 0]), "fluid": "turning"}
BUOY = {"displaced": rc.Displaced(weight=1.0), "flywheels": rc.Flywheel(momentum=3.0)}
SPRING = rc.Support(stiffness=5.0)
ARM = rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0), support=rc.Support(radius=0.4))
GOVERNOR = rc.SleeveGovernor(ball_mass=2.0, arm=0.3, lower_arm=0.3, sleeve_mass=5.0)
CAROUSEL = rc.Rig(CHAIN, support=rc.Support(stiffness=5.0, radius=0.2))
SIX = rc.Chain.uniform_rods(6)
PLUCKED = np.ones(CHAIN.size) / 9
SLOWEST = float(rc.modes(CHAIN, 1).conical_height[0])
ARMS = {"lower": rc.Support(stiffness=90.0, weight=0.2, radius=0.1), "upper": rc.Support(radius=-0.2)}
POLYGON = ([1.0, 2.0], [0.0, 1.0, 2.0, 3.0], 1.0)
BELL = rc.Chain(weight=[18.0, 500.0], length=[0.65, 0.15], centroid=0.3, radius_of_gyration=0.1)


@cache
def of(name):
    """A result of the table below, from which others are made."""
    return RESULTS[name]()


def fitted(vary):
    return rc.fit(CHAIN, {k: (n, "2 %") for k, n in enumerate(of("Modes").angular_speed, 1)}, vary=vary)


RESULTS = {  # every kind of result, made when a test asks for it
    "Modes": lambda: rc.modes(CHAIN, certify=True),
    **{f"Modes, {name}": lambda chain=chain: rc.modes(chain, "all", gravity=1.62) for name, chain in CHAINS.items()},
    "Certificate": lambda: of("Modes").certificate,
    "Sensitivity": lambda: of("Modes").sensitivity,
    "Sensitivity, relative": lambda: of("Modes").sensitivity.relative,
    "Sensitivity of a shape": lambda: of("SteadyShape").sensitivity,
    "Sensitivity of offsets": lambda: of("SteadyShape").sensitivity.offset,
    "Sensitivity of a shape of a rig": lambda: of("SteadyShape of a carousel").sensitivity,
    "Sensitivity of offsets of a rig": lambda: of("SteadyShape of a carousel").sensitivity.offset,
    "Uncertainty": lambda: of("Modes").uncertainty(weight=0.1),
    "WorstCase": lambda: rc.modes(THREE).uncertainty(weight="3 %", worst=True).worst,
    "Uncertainty with its worst case": lambda: rc.modes(THREE).uncertainty(weight="3 %", worst=True),
    "Modes of a rig": lambda: rc.modes(rc.Rig(CHAIN, flywheels=rc.Flywheel(momentum=0.2), support=SPRING)),
    "Sensitivity of a rig": lambda: of("Modes of a rig").sensitivity,
    "Uncertainty of a rig": lambda: of("Modes of a rig").uncertainty(weight=0.1, stiffness="3 %"),
    "shares of a variance": lambda: of("Modes of a rig").uncertainty(weight=0.1, momentum="3 %").share,
    "OtherModes": lambda: rc.modes(rc.Rig(THREE, flywheels=rc.Flywheel(momentum=0.3), displaced=FLOATING)).other,
    "links without weight in the fluid": lambda: rc.modes(rc.Rig(THREE, displaced=rc.Displaced(weight=1.0))),
    "in turning fluid": lambda: rc.modes(rc.Rig(THREE, **FLOATS, support=rc.Support(stiffness=3.0))),
    "an infinite height": lambda: rc.modes(rc.Rig(ONE, **BUOY)),
    "none, of a rig": lambda: rc.modes(rc.Rig(ONE, displaced=rc.Displaced(weight=3.0))),
    "none, of a chain": lambda: rc.modes(CHAIN, conical_height=(50.0, 60.0)),
    "certificate of none": lambda: rc.modes(CHAIN, conical_height=(50.0, 60.0), certify=True).certificate,
    "Modes in two words": lambda: rc.modes(CHAIN, precision="double-double", certify=True),
    "SteadyShapes": lambda: rc.steady_shapes(CHAIN, conical_height=0.5 * SLOWEST),
    "SteadyShape": lambda: of("SteadyShapes")[0],
    "SteadyShapes, none": lambda: rc.steady_shapes(CHAIN, conical_height=10 * SLOWEST),
    "SteadyShape of a rig": lambda: rc.steady_shapes(rc.Rig(CHAIN, support=rc.Support(radius=0.3)), angular_speed=0.5)[0],
    "SteadyShape of a carousel": lambda: rc.steady_shapes(CAROUSEL, angular_speed=3.0)[0],
    "Branches": lambda: rc.branches(THREE, max_angular_speed=5.0, gravity=1.0),
    "Branch, isolated": lambda: of("Branches")[3],
    "Branch": lambda: rc.branch(CHAIN, 1, min_conical_height=0.5 * SLOWEST),
    "Branches, held": lambda: rc.branches(BLADE, max_angular_speed=15.0),
    "Branch, held": lambda: rc.branch(BLADE, 1, max_angular_speed=15.0),
    "Branches of a held cord": lambda: rc.branches(ROPE, max_angular_speed=15.0),
    "Branch of a held cord": lambda: rc.branch(ROPE, 1, max_angular_speed=15.0),
    "SteadyShape of a branch of a held cord": lambda: of("Branch of a held cord").shape(3),
    "SteadyShape of a mode of a held cord": lambda: rc.steady_shape(ROPE, top_tension=20.0),
    "Modes of a cord of what is held": lambda: rc.modes(rc.Held(rc.Cord(1.0, mass=1.0), tension=20.0), 2),
    "Modes of a cord without gravity": lambda: rc.modes(rc.Held(rc.Cord(1.0, mass=1.0), tension=20.0, weightless=True), 2),
    "Modes of a chain without gravity": lambda: rc.modes(rc.Held(THREE, tension=20.0, weightless=True), 2),
    "Sensitivity of a cord": lambda: of("Modes of a cord of what is held").sensitivity,
    "Sensitivity, relative, of a cord": lambda: of("Modes of a cord of what is held").sensitivity.relative,
    "Uncertainty of a cord": lambda: of("Modes of a cord of what is held").uncertainty(mass="1 %", tension=0.3),
    "SteadyShape of a branch, held": lambda: of("Branch, held").shape(3),
    "SteadyShape of a mode, held": lambda: rc.steady_shape(BLADE, top_tension=20.0),
    "StabilityWindow": lambda: of("Branches")[0].stability_windows()[0],
    "StabilityWindows": lambda: of("Branches")[0].stability_windows(),
    "StabilityWindows of all branches": lambda: of("Branches").stability_windows(speed="rpm"),
    "Branches of all postures": lambda: rc.branches(THREE, max_angular_speed=1.0, gravity=1.0, hanging_only=False),
    "Explanation": lambda: rc.explain(rc.Chain.uniform_rods(5000), 2, rtol=1e-3),
    "Stability": lambda: of("SteadyShape").stability(),
    "ForceDiagram": lambda: of("SteadyShape").force_diagram(),
    "Response": lambda: rc.response(CHAIN, conical_height=[4.0, 0.3]),
    "Response at no speed": lambda: rc.response(CHAIN, conical_height=[]),
    "Response of no pin": lambda: rc.response(CHAIN, conical_height=[4.0], pins=[]),
    "Response at one speed": lambda: rc.response(rc.Rig(CHAIN, support=SPRING), angular_speed=2.0, pins=0),
    "Swing": lambda: rc.swing(CHAIN, [0.0, 1.0], offset=PLUCKED),
    "Tuned": lambda: rc.tune(CHAIN, vary="links[0].weight", conical_height=0.99 * SLOWEST),
    "Tuned, of a rig": lambda: rc.tune(rc.Rig(CHAIN), vary="flywheels[1].momentum", angular_speed=1.0),
    "Fitted": lambda: fitted(["length", "links[0].weight"]),
    "Fitted, undetermined": lambda: fitted(["links[0].weight", "links[1].weight", "links[3].weight"]),
    "Fitted, of a rig": lambda: rc.fit(WHEELS, {1: 0.9, -1: 0.8}, vary="length"),
    "Modes by mass": lambda: rc.modes(NAMED, rtol=1e-3),
    "SteadyShapes by mass": lambda: rc.steady_shapes(NAMED, angular_speed=9.0),
    "by a method named": lambda: rc.modes(rc.Chain.uniform_rods(3000), 2, method="coarse chain", rtol=1e-3),
    "Modes of a cord": lambda: rc.modes(rc.Cord(2.0, mass=0.4, tip_mass=0.1), 3),
    "Modes of a cord of a density": lambda: rc.modes(rc.Cord(2.0, density=lambda s: 1 + s), 2),
    "Modes of a cord, none": lambda: rc.modes(rc.Cord(2.0), angular_speed=(0.5, 0.6)),
    "SteadyShapes of a cord": lambda: rc.steady_shapes(rc.Cord(1.0, mass=2.0), conical_height=0.05),
    "SteadyShape of a cord": lambda: of("SteadyShapes of a cord")[1],
    "Branch of a cord": lambda: rc.branch(TIP, 2, min_conical_height=0.08),
    "Branches of a cord": lambda: rc.branches(TIP, min_conical_height=0.08),
    "SteadyShape on a branch of a cord": lambda: rc.steady_shape(TIP, mode=2, lowest_inclination=1.0),
    "Swing of a rig": lambda: rc.swing(rc.Rig(CHAIN, support=rc.Support(stiffness=9.0)), [0.0, 1.0], offset=PLUCKED),
    "Swing that turns": lambda: rc.swing(WHEELS, [0.0, 1.0], offset=np.ones(CHAIN.size) * (0.1 + 0.05j)),
    "Swing of a cord": lambda: rc.swing(TIP, [0.0, 1.0], offset=[0.1, 0.0], count=8),
    "Stability of a cord": lambda: of("SteadyShapes of a cord")[0].stability(),
    "Modes, taut": lambda: rc.modes(rc.Held(NAMED, tension=50.0)),
    "SteadyShapes, held": lambda: rc.steady_shapes(rc.Held(SIX, span=0.5), angular_speed=9.0, max_half_waves=3),
    "SteadyShape, held": lambda: of("SteadyShapes, held")[0],
    "Sensitivity, held": lambda: of("SteadyShape, held").sensitivity,
    "Sensitivity of tensions, held": lambda: of("SteadyShape, held").sensitivity.tension,
    "SteadyShapes, on arms": lambda: rc.steady_shapes(rc.Held(SIX, span=0.5, **ARMS), angular_speed=9.0),
    "SteadyShape, weightless": lambda: rc.steady_shapes(rc.Held(NAMED, span=0.5, weightless=True), angular_speed=9.0)[0],
    "SteadyShape of a held cord": lambda: rc.steady_shapes(rc.Held(rc.Cord(1.0, mass=1.0), tension=26.0), conical_height=0.05)[0],
    "Campbell": lambda: rc.campbell(ARM, [1.0, 2.0]),
    "DragShape": lambda: rc.drag_shape(ARM, rc.Drag(coefficient=1.0, diameter=0.05), angular_speed=2.0),
    "GovernorEquilibria": lambda: GOVERNOR.equilibria(angular_speed=9.0),
    "BufferImpact": lambda: rc.BufferImpact(front_mass=1, rear_mass=3, buffer_stiffness=10, coupling_stiffness=1, speed=2),
    "GovernorMotion": lambda: rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5),
    "GovernorMotion, revolving": lambda: rc.GovernorMotion(angular_speed=2.0, pendulum_length=1.0, angle=3.0, angle_rate=-4.0),
    "SkippingRope": lambda: rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0, half_waves=2),
    "SkippingRope, drawn": lambda: of("SkippingRope").drawn_to(2.5),
    "TortuousRope": lambda: rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0),
    "FunicularPolygon": lambda: rc.funicular_polygon(*POLYGON),
    "TransverseModes": lambda: rc.transverse_modes(*POLYGON),
    "BellAndClapper": lambda: rc.bell_and_clapper(BELL),
    "PairShape": lambda: rc.two_links.link_on_thread_shapes(2.0, 1.0, 1.0, height=0.5)[0],
}


@pytest.fixture(params=[".npz", ".nc"])
def path(request, tmp_path):
    return tmp_path / f"result{request.param}"


@pytest.fixture
def npz(tmp_path):
    return tmp_path / "result.npz"


def in_both_formats():
    """Every kind in both; netCDF, which takes ten times as long, for each fifth kind in the quick tier."""
    for n, name in enumerate(RESULTS):
        yield pytest.param(name, ".npz")
        yield pytest.param(name, ".nc", marks=[pytest.mark.slow] * (n % 5 > 0))


@pytest.mark.parametrize(("name", "ending"), [*in_both_formats()])
def test_every_kind_of_result(tmp_path, name, ending):
    result, path = RESULTS[name](), tmp_path / f"result{ending}"
    names = [field for field in type(result)._fields if hasattr(result, field)]  # not what such a system does not have
    arrays = {field: value for field in names if isinstance(value := getattr(result, field), np.ndarray)}
    assert all(getattr(result, field) is value and not value.flags.writeable for field, value in arrays.items())
    result.save(path)
    twins = [pickle.loads(pickle.dumps(result, protocol)) for protocol in (0, 2, pickle.HIGHEST_PROTOCOL)]
    first = rc.load(path)
    first.save(path)  # over itself
    for twin in (first, rc.load(str(path)), *twins):
        assert type(twin) is type(result) and twin == result and copy.copy(twin) is copy.deepcopy(twin) is twin
        assert repr(twin) == repr(result) and twin._repr_html_() == result._repr_html_()
        assert json.dumps(twin.to_dict()) == json.dumps(result.to_dict())
        assert twin.to_dataframe().equals(result.to_dataframe()) and twin.to_xarray().equals(result.to_xarray())
        for field, value in arrays.items():
            again = getattr(twin, field)
            assert not again.flags.writeable and again.dtype == value.dtype
        if isinstance(getattr(result, "system", None), rc.Chain):  # one number stays one number
            assert twin.system.length.strides == result.system.length.strides
        for change, *value in ((setattr, 1), (delattr,)):
            for field in ("anything", names[0]):
                with pytest.raises(AttributeError, match="cannot be changed"):
                    change(twin, field, *value)
    assert [*tmp_path.iterdir()] == [path]


@pytest.mark.parametrize("name", RESULTS)
def test_xarray_has_all_that_the_dictionary_has(tmp_path, name):
    result = RESULTS[name]()
    data, whole = result.to_xarray(), result.to_dict()
    there = {*data.variables, *data.attrs}
    assert not {key for key, value in whole.items() if value is not None} - there - {result._sheet().row + "s"}
    for text in data.attrs.values():
        if isinstance(text, str) and text[:1] in ("{", "["):
            json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} is no JSON"))
    data.to_netcdf(tmp_path / "data.nc", engine="h5netcdf")


def test_a_result_of_a_module_that_is_not_imported_yet(npz, python):
    result = RESULTS["PairShape"]()
    result.save(npz)
    done = python("-c", "import revchain as rc, sys; print(rc.load(sys.argv[1]))", npz)
    assert done.stdout == f"{result}\n", done.stderr


def test_no_pickle_inside(npz):
    rc.modes(CHAIN).save(npz)
    with np.load(npz, allow_pickle=False) as file:
        assert all(array.dtype != object for array in file.values())


def test_netcdf_is_labelled(tmp_path):
    import xarray

    path, stability = tmp_path / "result.nc", of("Stability")
    rc.modes(CHAIN).save(path)
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        assert data.sizes["mode"] == CHAIN.mode_count and data.sizes["pin"] == 5
        assert data["shape"].dims == ("mode", "pin") and data.angular_speed.dims == ("mode",)
        assert data.attrs["gravity"] == 9.80665
    stability.save(path)
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        np.testing.assert_array_equal(data.value_real + 1j * data.value_imaginary, stability.exponents)


def test_xarray():
    result = rc.modes(CHAINS["rods"], count=5)
    data = result.to_xarray()
    assert data.mode.values.tolist() == [1, 2, 3, 4, 5]
    assert float(data.conical_height.sel(mode=3)) == result.conical_height[2]
    assert data["shape"].dims == ("mode", "pin") and np.array_equal(data["shape"], result.shape)
    assert np.array_equal(data.nodes.sel(mode=3).dropna("node").values, result.nodes[2])
    assert data.attrs["status"] == "success" and data.attrs["gravity"] == 9.80665


@pytest.mark.parametrize("name", ["result", "result.txt", "result.npz.gz"])
def test_other_endings(tmp_path, name):
    for call in (rc.modes(CHAIN).save, rc.load):
        with pytest.raises(ValueError, match=r"\.npz or \.nc"):
            call(tmp_path / name)


class Ran:
    """Pickled, this makes a file in the current folder when it is read."""

    def __reduce__(self):
        return open, ("ran", "w")


def test_a_field_whose_name_is_damaged_is_missed(npz):
    rc.modes(CHAIN).save(npz)
    arrays = dict(np.load(npz))
    arrays["revchain"] = np.array(str(arrays["revchain"]).replace('"error_bound":', '"error_bounc":'))
    np.savez(npz, **arrays)
    found = rc.load(npz)
    assert len(found.conical_height) > 0
    with pytest.raises(ValueError, match=r"^revchain\.Modes: the file that it was loaded from lacks some of its numbers"):
        _ = found.error_bound


def refused(path, match):
    with pytest.raises(ValueError, match=match) as caught:
        rc.load(path)
    assert str(caught.value).startswith(f"{path}: ")


NOT_OURS = "is not a result that revchain saved, or was damaged since; compute and save it again"


def test_not_a_result(path):
    for content in (b"", b"nonsense", b"PK\x03\x04 nonsense", b"\x89HDF\r\n\x1a\n nonsense"):
        path.write_bytes(content)
        refused(path, NOT_OURS)
    path.unlink()
    with pytest.raises(FileNotFoundError):
        rc.load(path)


OTHER_ARRAYS = {  # arrays of a file, and what is said of it
    "numbers": ({"a": np.zeros(3)}, NOT_OURS),
    "objects": ({"kind": [None]}, "pickled Python objects"),
    "nested": ({"revchain": "[" * 100_000}, "recursion"),
    "a list": ({"revchain": "[]"}, "attribute 'get'"),
    "no JSON": ({"revchain": "no JSON"}, "Expecting value"),
    "no result": ({"revchain": '{"format": "revchain 2"}'}, "'result'"),
    "a format of nobody": ({"revchain": '{"format": "revchain 1"}'}, NOT_OURS),
    "no format": ({"revchain": '{"result": 3}'}, NOT_OURS),
    "no number": ({"revchain": '{"format": 3}'}, NOT_OURS),
}


@pytest.mark.parametrize(("arrays", "words"), OTHER_ARRAYS.values(), ids=OTHER_ARRAYS)
def test_other_arrays(npz, arrays, words):
    np.savez(npz, **{name: np.array(array) for name, array in arrays.items()})
    refused(npz, words)


LATER = {  # headers of files of later versions, and what is said of them
    "format": ({"format": "revchain 99", "version": "9.8.7"}, "has format 99, but .* up to 2; it was saved by revchain 9.8.7: "),
    "no version": ({"format": "revchain 3"}, "has format 3, but .*; install a later version$"),
    "no word": ({"format": "revchain 3", "version": "9.8\n7"}, "has format 3, but .*; install a later version$"),
    "kind": (
        {"format": "revchain 2", "version": "9.8.7", "result": {"result": "Knot", "module": "revchain.knots", "state": {}}},
        "holds a Knot, which revchain .* does not know; it was saved by revchain 9.8.7: install that version or a later one$",
    ),
    "kind inside": (
        {"format": "revchain 2", "result": {"result": "Modes", "state": {"x": {"result": "Knot", "state": {}}}}},
        "holds a Knot, which revchain .* does not know; install a later version$",
    ),
}


@pytest.mark.parametrize(("header", "words"), LATER.values(), ids=LATER)
def test_files_of_later_versions(npz, header, words):
    np.savez(npz, revchain=np.array(json.dumps(header)))
    refused(npz, words)


def test_the_version_that_saved_a_result_is_in_the_file(npz):
    rc.modes(CHAIN).save(npz)
    with np.load(npz) as file:
        said = json.loads(str(file["revchain"]))
    assert (said["format"], said["version"]) == ("revchain 2", rc.__version__)


def test_a_pickled_array_is_refused_by_name(npz, monkeypatch):
    monkeypatch.chdir(npz.parent)
    rc.modes(CHAIN).save(npz)
    with np.load(npz) as file:
        arrays = dict(file)
    for name in arrays:
        np.savez(npz, **{**arrays, name: np.array([Ran()], dtype=object)})
        refused(npz, f"the array {name!r} is not loaded: .* pickled Python objects, which may run any code")
    assert not os.path.exists("ran")


def test_a_pickle_is_refused(path, monkeypatch):
    monkeypatch.chdir(path.parent)
    for protocol in (0, 2, pickle.HIGHEST_PROTOCOL):
        path.write_bytes(pickle.dumps(Ran(), protocol))
        refused(path, NOT_OURS)
    assert not os.path.exists("ran")


def test_a_file_whose_arrays_are_larger_than_itself_is_refused(path):
    import h5netcdf

    if path.suffix == ".npz":
        np.savez_compressed(path, revchain=np.zeros(10**6))
    else:
        with h5netcdf.File(path, "w") as file:
            file.dimensions = {"x": 10**13}
            file.create_variable("numbers", ("x",), "f8", chunks=(10**6,))  # none of them is written
    refused(path, "holds arrays larger than the file")


def test_a_number_that_is_changed_is_found(npz):
    """Slow: each change is a file written and read. What a reader of .zip files ignores may change."""
    result = of("Modes")
    result.save(npz)
    data = npz.read_bytes()
    for position in [*range(0, len(data), by_tier(499, 97)), *range(len(data) - 30, len(data))]:
        for changed in (1, 0x80, 0xFF):
            npz.write_bytes(data[:position] + bytes([data[position] ^ changed]) + data[position + 1 :])
            try:
                assert rc.load(npz) == result
            except ValueError as error:
                assert str(error).startswith(f"{npz}: ")


@pytest.mark.parametrize(("right", "wrong"), [("'<f8'", "'<f4'"), ("'shape': (2", "'shape': (1"), ("'<f8'", "'|b1'")])
def test_a_header_that_is_changed_is_found(npz, right, wrong):
    """numpy reads only as many numbers as the header says, so that the checksum at the end is not reached."""
    rc.modes(rc.Chain.uniform_rods(2000, length=1.0), 2000).save(npz)  # zipfile compares small arrays at once
    data = bytearray(npz.read_bytes())
    place = data.index(right.encode(), data.index(b"Modes.conical_height.npy"))
    data[place : place + len(wrong)] = wrong.encode()
    npz.write_bytes(data)
    refused(npz, NOT_OURS)


def test_a_header_that_is_no_python_is_refused(npz):
    """numpy passes on errors of Python's tokenizer and of its parser."""
    rc.modes(CHAIN).save(npz)
    data = npz.read_bytes()
    for right, wrong in ((b"'shape': ()", b"'shape': (("), (b"'<U", b"',U")):
        assert len(right) == len(wrong) and right in data
        npz.write_bytes(data.replace(right, wrong, 1))
        refused(npz, NOT_OURS)


def test_a_file_that_was_cut(path):
    result = of("Modes")
    result.save(path)
    data = path.read_bytes()
    path.write_bytes(data[:-1000])
    refused(path, NOT_OURS)
    capital = path.with_name(path.name.upper())
    path.rename(capital).write_bytes(data)
    assert rc.load(capital) == result


@pytest.mark.parametrize("name", ["Modes", "Modes of a rig"])
def test_an_array_that_is_missing(npz, name):
    of(name).save(npz)
    with np.load(npz) as file:
        arrays = dict(file)
    for missing in arrays:
        np.savez(npz, **{other: arrays[other] for other in arrays if other != missing})
        refused(npz, NOT_OURS)


@pytest.mark.parametrize("ending", [".npz", ".nc"])
def test_a_full_disk(python, ending):
    """Wherever it is full: an OSError that names the output, nothing left, and the process goes on to its end."""
    program = """


import errno, os, resource, sys
import revchain as rc
path = "result" + sys.argv[1]
result = rc.modes(rc.Chain.uniform_rods(200), count=100)
result.shape
result.save(path)
size = os.stat(path).st_size
os.unlink(path)
for limit in [0, 100, 2000, 10_000, size // 2, size - 1000, size - 1]:
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    try:
        result.save(path)
    except OSError as error:
        assert isinstance(error, ValueError) and error.filename == path, repr(error)
        assert str(error) == f"[Errno {errno.EFBIG}] {os.strerror(errno.EFBIG)}: {path!r}", error
    else:
        raise AssertionError(limit)
    assert os.listdir() == [], os.listdir()


print("alive")
"""
    done = python("-c", program, ending)
    assert (done.returncode, done.stdout, done.stderr) == (0, "alive\n", "")


@pytest.mark.parametrize("place", ["missing/result.npz", "file/result.npz", "/proc/result.npz"])
def test_folder_that_cannot_be_written(tmp_path, place):
    (tmp_path / "file").write_text("a file, no folder")
    with pytest.raises(OSError) as caught:
        rc.modes(CHAIN).save(tmp_path / place)
    assert caught.value.filename == str(tmp_path / place) and [*tmp_path.iterdir()] == [tmp_path / "file"]


def test_failure_in_the_middle_leaves_the_old_file(path, monkeypatch):
    rc.modes(CHAIN).save(path)
    before = path.read_bytes()

    def broken(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(_storage.np, "savez", broken)
    monkeypatch.setattr("xarray.Dataset.dump_to_store", broken)
    with pytest.raises(OSError, match="No space"):
        rc.modes(CHAINS["rods"]).save(path)
    assert path.read_bytes() == before and [*path.parent.iterdir()] == [path]


def test_a_link_to_a_file_of_another_ending_gets_what_was_asked(tmp_path):
    """The path's ending says what is written, and the target of the link is what changes."""
    (target := tmp_path / "blob").write_text("old")
    (link := tmp_path / "picture.png").symlink_to(target)
    with _files.written_aside(link) as [aside]:
        assert aside.suffix == ".png"
        aside.write_text("new")
    assert target.read_text() == "new"
    assert link.is_symlink()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["blob", "picture.png"]



def test_several_files_appear_together(tmp_path):
    one, two = tmp_path / "one", tmp_path / "two"
    one.write_text("old")
    with pytest.raises(KeyboardInterrupt), _files.written_aside(one, two) as [first, second]:
        first.write_text("new")
        second.write_text("half")
        assert one.read_text() == "old" and not two.exists()
        raise KeyboardInterrupt
    assert one.read_text() == "old" and [*tmp_path.iterdir()] == [one]
    with _files.written_aside(one, two) as [first, second]:
        first.write_text("new")
        second.write_text("new too")
    assert one.read_text() == "new" and two.read_text() == "new too" and {*tmp_path.iterdir()} == {one, two}
    with _files.written_aside(one, two) as asides:
        asides[0].write_text("newer")
        del asides[1]  # so that its file stays
    assert one.read_text() == "newer" and two.read_text() == "new too" and {*tmp_path.iterdir()} == {one, two}


def test_links_devices_and_permissions(tmp_path):
    def write(path, text):
        with _files.written_aside(path) as [aside]:
            aside.write_text(text)

    target, link, plain = (tmp_path / f"{name}.txt" for name in ("target", "link", "plain"))
    target.write_text("old")
    link.symlink_to(target)
    write(link, "new")
    assert link.is_symlink() and target.read_text() == "new"
    write("/dev/null", "nothing")
    assert not os.path.isfile("/dev/null") and os.path.exists("/dev/null")
    with pytest.raises(IsADirectoryError):
        write(tmp_path, "")
    plain.write_text("")
    write(tmp_path / "new.txt", "")
    assert (tmp_path / "new.txt").stat().st_mode == plain.stat().st_mode  # the umask, as for any other file


def test_what_a_caller_gave_stays_the_callers():
    speeds, times = np.array([0.5, 1.0]), np.array([0.0, 1.0])
    driven = rc.response(CHAIN, angular_speed=speeds)
    swing = rc.swing(CHAIN, times, offset=np.ones(CHAIN.size) / 9)
    speeds[0] = times[0] = 99.0
    assert driven.angular_speed[0] == 0.5 and swing.time[0] == 0.0


def test_a_class_of_a_caller_does_not_take_the_place_of_ours(npz):
    class Modes(rc.Modes):
        __slots__ = ()

    assert Modes.__name__ == "Modes"
    rc.modes(CHAIN).save(npz)
    assert type(rc.load(npz)) is rc.Modes


LOADED = ["Modes", "Modes of a rig", "Modes in two words", "none, of a chain", "none, of a rig"]
LOADED += ["Modes of a chain without gravity", "Modes of a cord of what is held", "Modes of a cord without gravity"]


@pytest.mark.parametrize("name", LOADED)
def test_a_loaded_result_asks_nothing_again(npz, monkeypatch, name):
    """All that a result has comes from its file, or is made from its system and its numbers."""
    result = RESULTS[name]()
    result.save(npz)
    fields = {key: getattr(result, key) for key in type(result)._fields if hasattr(result, key)}
    for question in ("modes", "rig_modes", "cord_modes", "held_modes"):
        monkeypatch.delattr(rc._core, question)
    loaded = rc.load(npz)
    for key, value in fields.items():
        found = getattr(loaded, key)
        if key == "nodes" or key == "vertical_points":
            for mine, other in zip(found, value, strict=True):
                np.testing.assert_array_equal(mine, other)
        elif isinstance(value, np.ndarray):
            np.testing.assert_array_equal(found, value)
        else:
            assert found == value


def test_a_chain_is_in_a_file_once(npz):
    chain = rc.Chain(weight=np.ones(8), length=np.ones(8))
    rc.steady_shapes(chain, conical_height=1 / 35.4025).save(npz)
    again = rc.load(npz)
    assert len(again) == 84 and all(shape.system is again.system for shape in again)


def test_threads_may_read_and_pickle_the_same_result():
    result = rc.modes(rc.Chain.uniform_rods(200), "all")

    def read(_):
        for name in type(result)._fields:
            assert getattr(result, name, None) is getattr(result, name, None)
            pickle.dumps(result.with_gravity(1.62))

    with ThreadPoolExecutor(4) as pool:
        assert [*pool.map(read, range(4))] == [None] * 4


ALONG_BRANCHES = {
    "chain": THREE,
    "rig": rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0), support=rc.Support(stiffness=400.0, mass=0.5)),
    "carousel": rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0)),
    "cord": TIP,
    "cord": TIP,
    "held": BLADE,
    "arms": rc.Held(SIX, span=0.5, **ARMS),
    "held cord": ROPE,
}


@pytest.mark.parametrize("system", ALONG_BRANCHES.values(), ids=ALONG_BRANCHES)
def test_shapes_of_a_branch_after_loading(npz, system):
    """They are computed from the numbers of the file, without following the branch again; all are the same."""
    diagram = rc.branches(system, max_angular_speed=9.0, gravity=1.62)
    diagram.save(npz)
    loaded = rc.load(npz)
    assert loaded == diagram and len(loaded)
    for again, branch in zip(loaded, diagram, strict=True):
        for point in {len(branch) - 1, len(branch) // 2, *branch.folds.tolist()}:
            shape, same = branch.shape(point), again.shape(point)
            assert same == shape and same.gravity == 1.62 and same.proved == shape.proved
        if not isinstance(system, rc.Held):
            assert again.at(angular_speed=8.0) == branch.at(angular_speed=8.0)
        if isinstance(system, rc.Chain | rc.Rig):
            assert again.stability_windows(samples=1) == branch.stability_windows(samples=1)


@pytest.mark.parametrize("system", ALONG_BRANCHES.values(), ids=ALONG_BRANCHES)
def test_what_is_asked_of_a_loaded_shape(npz, system):
    shape = rc.steady_shapes(system, angular_speed=9.0, gravity=1.62)[0]
    shape.save(npz)
    same = rc.load(npz)
    one, other = shape.stability(), same.stability()
    assert one.verdict == other.verdict
    np.testing.assert_allclose(one.exponents, other.exponents, rtol=0, atol=1e-9)
    if hasattr(shape, "arc_length"):
        for here, there in zip(shape.along([0.0, 0.3, 1.0]), same.along([0.0, 0.3, 1.0]), strict=True):
            np.testing.assert_allclose(here, there, rtol=1e-14)
    elif isinstance(system, rc.Chain):
        assert shape.force_diagram() == same.force_diagram()


@pytest.mark.parametrize("name", RESULTS)
def test_every_kind_of_result_has_a_workbook(tmp_path, name):
    result, path = RESULTS[name](), tmp_path / "result.xlsx"
    result.to_excel(path)
    book = openpyxl.load_workbook(path, read_only=True)
    first = [row[:2] for row in book["system"].iter_rows(min_row=2, values_only=True)]
    assert ("revchain", rc.__version__) in first and len(book.sheetnames) > 1
