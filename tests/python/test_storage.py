# SPDX-License-Identifier: GPL-3.0-or-later
"""Results in files: nothing lost, nothing half-written, nothing pickled."""

import copy
import json
import os
import pickle
import threading
from functools import cache

import numpy as np
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
ARMS = {"lower": rc.Support(stiffness=90.0, weight=0.2, radius=0.1), "upper": rc.Support(radius=-0.2)}
IMPACT = {"front_mass": 1, "rear_mass": 3, "buffer_stiffness": 10, "coupling_stiffness": 1, "speed": 2}
POLYGON = ([1.0, 2.0], [0.0, 1.0, 2.0, 3.0], 1.0)
BELL = rc.Chain(weight=[18.0, 500.0], length=[0.65, 0.15], centroid=0.3, radius_of_gyration=0.1)


@cache
def modes():
    return rc.modes(CHAIN, certify=True)


@cache
def rig_modes():
    return rc.modes(rc.Rig(CHAIN, flywheels=rc.Flywheel(momentum=0.2), support=rc.Support(stiffness=5.0)))


@cache
def shapes():
    return rc.steady_shapes(CHAIN, conical_height=0.5 * float(modes().conical_height[0]))


@cache
def shape_of_a_rig():
    return rc.steady_shapes(rc.Rig(CHAIN, support=rc.Support(stiffness=5.0, radius=0.2)), angular_speed=3.0)[0]


@cache
def diagram():
    return rc.branches(THREE, max_angular_speed=5.0, gravity=1.0)


@cache
def taut():
    return rc.modes(rc.Held(rc.Cord(1.0, mass=1.0), tension=20.0), 2)


@cache
def shapes_of_a_cord():
    return rc.steady_shapes(rc.Cord(1.0, mass=2.0), conical_height=0.05)


@cache
def held_shapes():
    return rc.steady_shapes(rc.Held(rc.Chain.uniform_rods(6), span=0.5), angular_speed=9.0, max_half_waves=3)


@cache
def rope():
    return rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0, half_waves=2)


@cache
def branches(held):
    return rc.branches(held, max_angular_speed=15.0)


@cache
def branch(held):
    return rc.branch(held, 1, max_angular_speed=15.0)


def fitted(vary):
    return rc.fit(CHAIN, {k: (n, "2 %") for k, n in enumerate(modes().angular_speed, 1)}, vary=vary)


RESULTS = {  # every kind of result, made when a test asks for it
    "Modes": modes,
    **{f"Modes, {name}": lambda chain=chain: rc.modes(chain, "all", gravity=1.62) for name, chain in CHAINS.items()},
    "Certificate": lambda: modes().certificate,
    "Sensitivity": lambda: modes().sensitivity,
    "Sensitivity, relative": lambda: modes().sensitivity.relative,
    "Sensitivity of a shape": lambda: shapes()[0].sensitivity,
    "Sensitivity of offsets": lambda: shapes()[0].sensitivity.offset,
    "Sensitivity of a shape of a rig": lambda: shape_of_a_rig().sensitivity,
    "Sensitivity of offsets of a rig": lambda: shape_of_a_rig().sensitivity.offset,
    "Uncertainty": lambda: modes().uncertainty(weight=0.1),
    "Modes of a rig": rig_modes,
    "Sensitivity of a rig": lambda: rig_modes().sensitivity,
    "Uncertainty of a rig": lambda: rig_modes().uncertainty(weight=0.1, stiffness="3 %"),
    "shares of a variance": lambda: rig_modes().uncertainty(weight=0.1, momentum="3 %").share,
    "OtherModes": lambda: rc.modes(rc.Rig(THREE, flywheels=rc.Flywheel(momentum=0.3), displaced=FLOATING)).other,
    "links without weight in the fluid": lambda: rc.modes(rc.Rig(THREE, displaced=rc.Displaced(weight=1.0))),
    "in turning fluid": lambda: rc.modes(rc.Rig(THREE, **FLOATS, support=rc.Support(stiffness=3.0))),
    "an infinite height": lambda: rc.modes(rc.Rig(ONE, **BUOY)),
    "none, of a rig": lambda: rc.modes(rc.Rig(ONE, displaced=rc.Displaced(weight=3.0))),
    "none, of a chain": lambda: rc.modes(CHAIN, conical_height=(50.0, 60.0)),
    "certificate of none": lambda: rc.modes(CHAIN, conical_height=(50.0, 60.0), certify=True).certificate,
    "Modes in two words": lambda: rc.modes(CHAIN, precision="double-double", certify=True),
    "SteadyShapes": shapes,
    "SteadyShape": lambda: shapes()[0],
    "SteadyShapes, none": lambda: rc.steady_shapes(CHAIN, conical_height=10 * float(modes().conical_height[0])),
    "SteadyShape of a rig": lambda: rc.steady_shapes(rc.Rig(CHAIN, support=rc.Support(radius=0.3)), angular_speed=0.5)[0],
    "Branches": diagram,
    "Branch, isolated": lambda: diagram()[3],
    "Branch": lambda: rc.branch(CHAIN, 1, min_conical_height=0.5 * float(modes().conical_height[0])),
    "Branches, held": lambda: branches(BLADE),
    "Branch, held": lambda: branch(BLADE),
    "Branches of a held cord": lambda: branches(ROPE),
    "Branch of a held cord": lambda: branch(ROPE),
    "SteadyShape of a branch of a held cord": lambda: branch(ROPE).shape(3),
    "SteadyShape of a mode of a held cord": lambda: rc.steady_shape(ROPE, top_tension=20.0),
    "Modes of a cord of what is held": taut,
    "Modes of a cord without gravity": lambda: rc.modes(rc.Held(rc.Cord(1.0, mass=1.0), tension=20.0, weightless=True), 2),
    "Modes of a chain without gravity": lambda: rc.modes(rc.Held(THREE, tension=20.0, weightless=True), 2),
    "Sensitivity of a cord": lambda: taut().sensitivity,
    "Sensitivity, relative, of a cord": lambda: taut().sensitivity.relative,
    "Uncertainty of a cord": lambda: taut().uncertainty(mass="1 %", tension=0.3),
    "SteadyShape of a branch, held": lambda: branch(BLADE).shape(3),
    "SteadyShape of a mode, held": lambda: rc.steady_shape(BLADE, top_tension=20.0),
    "StabilityWindow": lambda: diagram()[0].stability_windows()[0],
    "Explanation": lambda: rc.explain(rc.Chain.uniform_rods(5000), 2, rtol=1e-3),
    "Stability": lambda: shapes()[0].stability(),
    "ForceDiagram": lambda: shapes()[0].force_diagram(),
    "Response": lambda: rc.response(CHAIN, conical_height=[4.0, 0.3]),
    "Response at no speed": lambda: rc.response(CHAIN, conical_height=[]),
    "Response of no pin": lambda: rc.response(CHAIN, conical_height=[4.0], pins=[]),
    "Response at one speed": lambda: rc.response(rc.Rig(CHAIN, support=rc.Support(stiffness=5.0)), angular_speed=2.0, pins=0),
    "Swing": lambda: rc.swing(CHAIN, [0.0, 1.0], offset=np.ones(CHAIN.size) / 9),
    "Tuned": lambda: rc.tune(CHAIN, vary="links[0].weight", conical_height=0.99 * float(modes().conical_height[0])),
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
    "SteadyShapes of a cord": shapes_of_a_cord,
    "SteadyShape of a cord": lambda: shapes_of_a_cord()[1],
    "Branch of a cord": lambda: rc.branch(TIP, 2, min_conical_height=0.08),
    "Branches of a cord": lambda: rc.branches(TIP, min_conical_height=0.08),
    "SteadyShape on a branch of a cord": lambda: rc.steady_shape(TIP, mode=2, lowest_inclination=1.0),
    "Swing of a rig": lambda: rc.swing(rc.Rig(CHAIN, support=rc.Support(stiffness=9.0)), [0.0, 1.0], offset=np.ones(CHAIN.size) / 9),
    "Swing that turns": lambda: rc.swing(WHEELS, [0.0, 1.0], offset=np.ones(CHAIN.size) * (0.1 + 0.05j)),
    "Swing of a cord": lambda: rc.swing(TIP, [0.0, 1.0], offset=[0.1, 0.0], count=8),
    "Stability of a cord": lambda: shapes_of_a_cord()[0].stability(),
    "Modes, taut": lambda: rc.modes(rc.Held(NAMED, tension=50.0)),
    "SteadyShapes, held": held_shapes,
    "SteadyShape, held": lambda: held_shapes()[0],
    "Sensitivity, held": lambda: held_shapes()[0].sensitivity,
    "Sensitivity of tensions, held": lambda: held_shapes()[0].sensitivity.tension,
    "SteadyShapes, on arms": lambda: rc.steady_shapes(
        rc.Held(rc.Chain.uniform_rods(6), span=0.5, **ARMS), angular_speed=9.0
    ),
    "SteadyShape, weightless": lambda: rc.steady_shapes(rc.Held(NAMED, span=0.5, weightless=True), angular_speed=9.0)[0],
    "SteadyShape of a held cord": lambda: rc.steady_shapes(rc.Held(rc.Cord(1.0, mass=1.0), tension=26.0), conical_height=0.05)[0],
    "BufferImpact": lambda: rc.BufferImpact(**IMPACT),
    "GovernorMotion": lambda: rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5),
    "GovernorMotion, revolving": lambda: rc.GovernorMotion(
        angular_speed=2.0, pendulum_length=1.0, angle=3.0, angle_rate=-4.0
    ),
    "SkippingRope": rope,
    "SkippingRope, drawn": lambda: rope().drawn_to(2.5),
    "TortuousRope": lambda: rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0),
    "FunicularPolygon": lambda: rc.funicular_polygon(*POLYGON),
    "TransverseModes": lambda: rc.transverse_modes(*POLYGON),
    "BellAndClapper": lambda: rc.bell_and_clapper(BELL),
    "PairShape": lambda: rc.two_links.link_on_thread_shapes(2.0, 1.0, 1.0, height=0.5)[0],
}


def in_both_formats():
    """Every kind in both; netCDF, which takes ten times as long, for each fifth kind in the quick tier."""
    for n, name in enumerate(RESULTS):
        yield pytest.param(name, ".npz")
        yield pytest.param(name, ".nc", marks=[pytest.mark.slow] * (n % 5 > 0))


@pytest.mark.parametrize(("name", "ending"), [*in_both_formats()])
def test_every_kind_of_result(tmp_path, name, ending):
    result = RESULTS[name]()
    path = tmp_path / f"result{ending}"
    names = [field for field in type(result)._fields if hasattr(result, field)]  # not what such a system does not have
    fields = {field: getattr(result, field) for field in names}
    assert all(getattr(result, field) is value for field, value in fields.items() if isinstance(value, np.ndarray))
    result.save(path)
    twins = [pickle.loads(pickle.dumps(result, protocol)) for protocol in (0, 2, pickle.HIGHEST_PROTOCOL)]
    rc.load(path).save(path)  # over itself
    for twin in (rc.load(str(path)), *twins):
        assert type(twin) is type(result) and twin == result and copy.copy(twin) is copy.deepcopy(twin) is twin
        assert repr(twin) == repr(result) and twin._repr_html_() == result._repr_html_()
        assert json.dumps(twin.to_dict()) == json.dumps(result.to_dict())
        assert twin.to_dataframe().equals(result.to_dataframe()) and twin.to_xarray().equals(result.to_xarray())
        for field, value in fields.items():
            if isinstance(value, np.ndarray):
                assert not value.flags.writeable and not getattr(twin, field).flags.writeable
                assert getattr(twin, field).dtype == value.dtype
        if isinstance(getattr(result, "system", None), rc.Chain):  # one number stays one number
            assert twin.system.length.strides == result.system.length.strides
        for change, *value in ((setattr, 1), (delattr,)):
            for field in ("anything", names[0]):
                with pytest.raises(AttributeError, match="cannot be changed"):
                    change(twin, field, *value)
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("name", RESULTS)
def test_xarray_has_all_that_the_dictionary_has(tmp_path, name):
    result = RESULTS[name]()
    data, whole = result.to_xarray(), result.to_dict()
    there = {*data.variables, *data.attrs}
    assert not {key for key, value in whole.items() if value is not None} - there - {result._sheet().row + "s"}
    data.to_netcdf(tmp_path / "data.nc", engine="h5netcdf")


def test_a_result_of_a_module_that_is_not_imported_yet(tmp_path, python):
    result = rc.two_links.link_on_thread_shapes(2.0, 1.0, 1.0, height=0.5)[0]
    result.save(tmp_path / "shape.npz")
    done = python("-c", "import revchain as rc, sys; print(rc.load(sys.argv[1]))", tmp_path / "shape.npz")
    assert done.stdout == f"{result}\n", done.stderr


def test_no_pickle_inside(tmp_path):
    rc.modes(CHAIN).save(tmp_path / "result.npz")
    with np.load(tmp_path / "result.npz", allow_pickle=False) as file:
        assert all(array.dtype != object for array in file.values())


def test_netcdf_is_labelled(tmp_path):
    import xarray

    rc.modes(CHAIN).save(tmp_path / "result.nc")
    with xarray.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as data:
        assert data.sizes["mode"] == CHAIN.mode_count and data.sizes["pin"] == 5
        assert data["shape"].dims == ("mode", "pin") and data.angular_speed.dims == ("mode",)
        assert data.attrs["gravity"] == 9.80665
    stability = shapes()[0].stability()
    stability.save(tmp_path / "result.nc")
    with xarray.open_dataset(tmp_path / "result.nc", engine="h5netcdf") as data:
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
    with pytest.raises(ValueError, match=r"\.npz or \.nc"):
        rc.modes(CHAIN).save(tmp_path / name)
    with pytest.raises(ValueError, match=r"\.npz or \.nc"):
        rc.load(tmp_path / name)


@pytest.mark.parametrize("ending", [".npz", ".nc"])
def test_not_a_result(tmp_path, ending):
    path = tmp_path / f"other{ending}"
    for content in (b"", b"nonsense", b"PK\x03\x04 nonsense", b"\x89HDF\r\n\x1a\n nonsense"):
        path.write_bytes(content)
        with pytest.raises(ValueError, match="not a result that revchain saved"):
            rc.load(path)
    with pytest.raises(FileNotFoundError):
        rc.load(tmp_path / f"missing{ending}")


def test_other_arrays_and_objects(tmp_path):
    path = tmp_path / "other.npz"
    for arrays in ({"a": np.zeros(3)}, {"kind": np.array("revchain modes 99")}, {"kind": np.array([None])}):
        np.savez(path, **arrays)
        with pytest.raises(ValueError, match="not a result that revchain saved"):
            rc.load(path)


class Ran:
    """Pickled, this makes a file in the current folder when it is read."""

    def __reduce__(self):
        return open, ("ran", "w")


def sealed(path):
    """Make the file at `path` pass for one that revchain wrote."""
    with open(path, "r+b") as file:
        file.write(_storage._seal(file))


def refused(path, match):
    with pytest.raises(ValueError, match=match) as caught:
        rc.load(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_a_pickled_array_is_refused_by_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "result.npz"
    rc.modes(CHAIN).save(path)
    with np.load(path) as file:
        arrays = dict(file)
    for name in arrays:
        np.savez(path, **{**arrays, name: np.array([Ran()], dtype=object)})
        sealed(path)
        refused(path, f"the array {name!r} is not loaded: .* pickled Python objects, which may run any code")
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize("ending", [".npz", ".nc"])
def test_a_pickle_is_refused(tmp_path, monkeypatch, ending):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / f"result{ending}"
    for protocol in (0, 2, pickle.HIGHEST_PROTOCOL):
        path.write_bytes(pickle.dumps(Ran(), protocol))
        refused(path, "not a result that revchain saved")
        sealed(path)
        refused(path, "pickle|not a zip|not zip|signature|file format")
    assert not (tmp_path / "ran").exists()


@pytest.mark.parametrize("ending", [".npz", ".nc"])
def test_a_file_whose_arrays_are_larger_than_itself_is_refused(tmp_path, ending):
    import h5netcdf

    path = tmp_path / f"result{ending}"
    if ending == ".npz":
        np.savez_compressed(path, revchain=np.zeros(10**6))
    else:
        with h5netcdf.File(path, "w") as file:
            file.dimensions = {"x": 10**13}
            file.create_variable("numbers", ("x",), "f8", chunks=(10**6,))  # none of them is written
    sealed(path)
    refused(path, "holds arrays larger than the file")


HEADERS = {"[" * 100_000: "recursion", "[]": "attribute 'get'", "no JSON": "Expecting value", '{"format": "revchain 2"}': "'result'"}


@pytest.mark.parametrize(("header", "match"), HEADERS.items(), ids=[text[:24] for text in HEADERS])
def test_a_header_that_describes_no_result(tmp_path, header, match):
    path = tmp_path / "result.npz"
    np.savez(path, revchain=np.array(header))
    sealed(path)
    refused(path, match)


@pytest.mark.parametrize("content", [{"kind": "revchain modes 1"}, {"revchain": '{"format": "revchain 1"}'}], ids=repr)
def test_files_of_other_versions(tmp_path, content):
    path = tmp_path / "old.npz"
    np.savez(path, **{name: np.array(text) for name, text in content.items()})
    sealed(path)
    with pytest.raises(ValueError, match="save the result again|save it again"):
        rc.load(path)


DAMAGED = "not a result that revchain saved, or damaged since; compute and save it again"


@pytest.mark.parametrize("ending", [".npz", ".nc"])
def test_every_byte_that_is_changed_is_found(tmp_path, ending):
    path = tmp_path / f"result{ending}"
    rc.modes(CHAIN, certify=True).save(path)
    data = path.read_bytes()
    for place in [*range(0, len(data), by_tier(499, 97)), *range(len(data) - 30, len(data))]:
        for changed in (1, 0x80, 0xFF):
            path.write_bytes(data[:place] + bytes([data[place] ^ changed]) + data[place + 1 :])
            with pytest.raises(ValueError, match=DAMAGED):
                rc.load(path)
    path.write_bytes(data[:-1000])
    with pytest.raises(ValueError, match="not a result"):
        rc.load(path)
    path.rename(tmp_path / f"RESULT{ending.upper()}").write_bytes(data)
    assert rc.load(tmp_path / f"RESULT{ending.upper()}") == rc.modes(CHAIN, certify=True)


@pytest.mark.parametrize("result", [rc.modes(CHAIN, certify=True), rc.modes(rc.Rig(CHAIN, support=rc.Support(stiffness=5.0)))], ids=repr)
def test_arrays_that_do_not_go_together(tmp_path, result):
    path = tmp_path / "result.npz"
    result.save(path)
    with np.load(path) as file:
        arrays = dict(file)
    for name, array in arrays.items():
        for other in (array[..., :-1] if array.ndim and array.size else np.zeros(7), array.astype("U"), -1 * np.ones(10**3)):
            np.savez(path, **{**arrays, name: other})
            with pytest.raises(ValueError, match=DAMAGED):
                rc.load(path)
        np.savez(path, **{other: arrays[other] for other in arrays if other != name})
        with pytest.raises(ValueError, match=DAMAGED):
            rc.load(path)


@pytest.mark.slow
@pytest.mark.parametrize("ending", [".npz", ".nc"])
def test_a_full_disk(python, tmp_path, ending):
    """Wherever it is full: an OSError that names the output, nothing left, and the process goes on to its end."""
    program = """
import errno, os, resource, sys
import revchain as rc
path, ending = "result" + sys.argv[1], sys.argv[1]
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
    assert caught.value.filename == str(tmp_path / place)
    assert [entry.name for entry in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("ending", [".npz", ".nc"])
def test_failure_in_the_middle_leaves_the_old_file(tmp_path, monkeypatch, ending):
    path = tmp_path / f"result{ending}"
    rc.modes(CHAIN).save(path)
    before = path.read_bytes()

    def broken(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(_storage.np, "savez", broken)
    monkeypatch.setattr("xarray.Dataset.dump_to_store", broken)
    with pytest.raises(OSError, match="No space"):
        rc.modes(CHAINS["rods"]).save(path)
    assert path.read_bytes() == before
    assert len(list(tmp_path.iterdir())) == 1


def test_several_files_appear_together(tmp_path):
    one, two = tmp_path / "one", tmp_path / "two"
    one.write_text("old")
    with pytest.raises(KeyboardInterrupt), _files.written_aside(one, two) as [first, second]:
        first.write_text("new")
        second.write_text("half")
        assert one.read_text() == "old" and not two.exists()
        raise KeyboardInterrupt
    assert one.read_text() == "old"
    assert [entry.name for entry in tmp_path.iterdir()] == ["one"]
    with _files.written_aside(one, two) as [first, second]:
        first.write_text("new")
        second.write_text("new too")
    assert one.read_text() == "new" and two.read_text() == "new too"
    assert len(list(tmp_path.iterdir())) == 2


def test_links_devices_and_permissions(tmp_path):
    target, link = tmp_path / "target.txt", tmp_path / "link.txt"
    target.write_text("old")
    link.symlink_to(target)
    with _files.written_aside(link) as [aside]:
        aside.write_text("new")
    assert link.is_symlink() and target.read_text() == "new"
    with _files.written_aside("/dev/null") as [aside]:
        aside.write_text("nothing")
    assert not os.path.isfile("/dev/null") and os.path.exists("/dev/null")
    with pytest.raises(IsADirectoryError), _files.written_aside(tmp_path):
        pass
    plain = tmp_path / "plain.txt"
    plain.write_text("")
    with _files.written_aside(tmp_path / "new.txt") as [aside]:
        aside.write_text("")
    assert (tmp_path / "new.txt").stat().st_mode == plain.stat().st_mode  # the umask, as for any other file


def test_what_a_caller_gave_stays_the_callers():
    speeds, times = np.array([0.5, 1.0]), np.array([0.0, 1.0])
    driven = rc.response(CHAIN, angular_speed=speeds)
    swing = rc.swing(CHAIN, times, offset=np.ones(CHAIN.size) / 9)
    speeds[0] = times[0] = 99.0
    assert driven.angular_speed[0] == 0.5 and swing.time[0] == 0.0


def test_a_class_of_a_caller_does_not_take_the_place_of_ours(tmp_path):
    class Modes(rc.Modes):
        __slots__ = ()

    assert Modes.__name__ == "Modes"
    result = rc.modes(CHAIN)
    result.save(tmp_path / "result.npz")
    assert type(rc.load(tmp_path / "result.npz")) is rc.Modes


def test_a_chain_is_in_a_file_once(tmp_path):
    chain = rc.Chain(weight=np.ones(8), length=np.ones(8))
    shapes = rc.steady_shapes(chain, conical_height=1 / 35.4025)
    shapes.save(tmp_path / "shapes.npz")
    again = rc.load(tmp_path / "shapes.npz")
    assert len(again) == 84 and all(shape.system is again.system for shape in again)


def test_threads_may_read_and_pickle_the_same_result():
    result = rc.modes(rc.Chain.uniform_rods(200), "all")
    raised = []

    def read():
        try:
            for name in type(result)._fields:
                assert getattr(result, name, None) is getattr(result, name, None)
                pickle.dumps(result.with_gravity(1.62))
        except Exception as error:
            raised.append(error)

    threads = [threading.Thread(target=read) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert raised == []


ALONG_BRANCHES = {
    "chain": THREE,
    "rig": rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0), support=rc.Support(stiffness=400.0, mass=0.5)),
    "carousel": rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0)),
    "cord": TIP,
    "density": rc.Cord(1.0, density=lambda s: 1 + s),
    "held": BLADE,
    "arms": rc.Held(rc.Chain.uniform_rods(6), span=0.5, **ARMS),
    "held cord": ROPE,
}


@pytest.mark.parametrize("system", ALONG_BRANCHES.values(), ids=ALONG_BRANCHES.keys())
def test_shapes_of_a_branch_after_loading(tmp_path, system):
    """They are computed from the numbers of the file, without following the branch again; all are the same."""
    diagram = rc.branches(system, max_angular_speed=9.0, gravity=1.62)
    diagram.save(tmp_path / "branches.npz")
    loaded = rc.load(tmp_path / "branches.npz")
    assert loaded == diagram and len(loaded)
    for again, branch in zip(loaded, diagram, strict=True):
        for point in {len(branch) - 1, len(branch) // 2, *branch.folds.tolist()}:
            shape, same = branch.shape(point), again.shape(point)
            assert same == shape and same.gravity == 1.62 and same.proved == shape.proved
        if not isinstance(system, rc.Held):
            assert again.at(angular_speed=8.0) == branch.at(angular_speed=8.0)
        if isinstance(system, rc.Chain | rc.Rig):
            assert again.stability_windows(samples=1) == branch.stability_windows(samples=1)


@pytest.mark.parametrize("system", ALONG_BRANCHES.values(), ids=ALONG_BRANCHES.keys())
def test_what_is_asked_of_a_loaded_shape(tmp_path, system):
    shape = rc.steady_shapes(system, angular_speed=9.0, gravity=1.62)[0]
    shape.save(tmp_path / "shape.npz")
    same = rc.load(tmp_path / "shape.npz")
    one, other = shape.stability(), same.stability()
    assert one.verdict == other.verdict
    np.testing.assert_allclose(one.exponents, other.exponents, rtol=0, atol=1e-9)
    if hasattr(shape, "arc_length"):
        for here, there in zip(shape.along([0.0, 0.3, 1.0]), same.along([0.0, 0.3, 1.0]), strict=True):
            np.testing.assert_allclose(here, there, rtol=1e-14)
    elif isinstance(system, rc.Chain):
        assert shape.force_diagram() == same.force_diagram()
