# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies: what each point gives, whoever computes it, what is kept of a run that was ended, what is refused."""

import csv
import itertools
import json
import math
import os
import random
import shutil
import signal
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import suppress
from multiprocessing import get_context
from pathlib import Path

import filelock
import numpy as np
import pytest
from studies import GOVERNOR, GYROSTAT, UNIFORM, normal, uniform, words

import revchain as rc
from revchain.plots.sweep import plot_sweep, why_not_drawn
from revchain.scenes import scene as _scene
from revchain.scenes.scene import json_schema
from revchain.studies.axes import Vary
from revchain.studies.study import Study, study_schema
from revchain.studies.sweep import columns

xarray = pytest.importorskip("xarray")

PLUMMETS = {"links": [{"mass": 1.0, "length": 0.5}, {"mass": 2.0, "length": 0.25, "repeat": 2}]}
BODIES = {
    "links": [
        {"mass": 1.0, "length": 0.5, "centroid": 0.2, "radius_of_gyration": 0.1},
        {"weight": 2.0, "length": 0.25, "kind": "rod", "repeat": 2},
        {"mass": 0.5, "length": 0.4, "centroid": 0.3, "pendulum_length": 0.35},
    ],
    "ask": {"modes": {"count": "all"}},
}


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")


def study(scene, vary, **more):
    return Study.from_dict({"scene": scene, "vary": vary, **more})


def rows(found, name):
    """The numbers of a result or of what varied, with a row for each point."""
    array = found[name]
    along = [key for key in array.dims if key not in found["status"].dims]
    whole = array if along else array.broadcast_like(found["status"])
    return whole.transpose(*found["status"].dims, *along).to_numpy().reshape(found["status"].size, *(array.sizes[key] for key in along))


def same(one, two):
    """Number for number, bit for bit."""
    xarray.testing.assert_identical(one, two)
    for name in one.variables:
        assert one[name].to_numpy().tobytes() == two[name].to_numpy().tobytes(), name


def refused(found):
    return rows(found, "status") == 3


def files():
    return sorted(path.name for path in Path().iterdir())


# ---- values


def test_batches_are_the_bare_call():
    vary = {
        "links[0].mass": {"from": "100 g", "to": "10 kg", "steps": 5, "log": True},
        "gravity": {"values": [1.62, "981 cm/s^2"]},
        "links[1].length": {"uniform": [0.1, 0.9]},
        "links[0].centroid": {"normal": [0.2, 0.01]},
        "links[2].centroid": {"values": ["25 cm", 0.3]},
    }
    scene = {**BODIES, "links": [*BODIES["links"][:2], {"mass": 0.5, "length": 0.4, "centroid": 0.3, "radius_of_gyration": 0.2}]}
    given = study(scene, vary, samples=300, seed=7)
    found = rc.sweep(given)
    points = given.points
    assert given._plan("").links is not None and points == 5 * 2 * 2 * 300
    weight, length, centroid, radius = np.empty((4, points, 4))
    g = rows(found, "gravity")
    weight[:] = np.stack([rows(found, "links[0].mass") * g, np.full_like(g, 2), np.full_like(g, 2), 0.5 * g], axis=1)
    rods = rows(found, "links[1].length")
    length[:] = np.stack([np.full_like(g, 0.5), rods, rods, np.full_like(g, 0.4)], axis=1)
    centroid[:] = np.stack([rows(found, "links[0].centroid"), rods / 2, rods / 2, rows(found, "links[2].centroid")], axis=1)
    radius[:] = np.stack([np.full_like(g, 0.1), rods / math.sqrt(12), rods / math.sqrt(12), np.full_like(g, 0.2)], axis=1)
    bare = rc.conical_heights(weight=weight, length=length, centroid=centroid, radius_of_gyration=radius)
    heights = rows(found, "conical_height")
    assert np.abs(heights / bare - 1).max() < 1.5e-15  # factors round a last digit of weights and radii
    speeds = rc.conical_pendulum.angular_speed(heights, g[:, np.newaxis])
    assert rows(found, "angular_speed").tobytes() == speeds.tobytes()
    for point in (0, 1, 777, points - 1):
        chain = given.scene_at(point).system()
        assert chain.weight.tobytes() == weight[point].tobytes() and chain.length.tobytes() == length[point].tobytes()


def test_batches_and_points_one_by_one_agree_to_their_accuracy():
    vary = {"links[0].mass": {"log_uniform": [1e-3, 1e3]}, "links[1].length": {"uniform": [0.1, 0.9]}}
    batches = rc.sweep(study(BODIES, vary, samples=500))
    given = study(BODIES, vary, samples=500, error_bounds=True)
    single = rc.sweep(given)
    assert "error_bound" in single and "error_bound" not in batches
    assert single["error_bound"].max() < 1e-15
    assert np.abs(batches["conical_height"] / single["conical_height"] - 1).max() < 1.5e-15
    for point in (0, 250, 499):
        modes = given.scene_at(point).modes()
        assert rows(single, "conical_height")[point].tobytes() == modes.conical_height.tobytes()
        assert rows(single, "error_bound")[point].tobytes() == modes.error_bound.tobytes()
    same(batches, rc.sweep(study(BODIES, vary, samples=500)))


def test_batches_of_point_masses_are_the_bare_call():
    """Numbers that a varied number replaces are not rounded: heights are those of the direct call to the last bit."""
    vary = {"links[0].mass": {"uniform": [1, 2]}, "links[1].length": {"values": [0.1, 0.7]}}
    found = rc.sweep(study(PLUMMETS, vary, samples=40_000))
    mass, length = np.full((80_000, 3), 2.0), np.full((80_000, 3), 0.5)
    mass[:, 0], length[:, 1:] = rows(found, "links[0].mass"), rows(found, "links[1].length")[:, np.newaxis]
    assert rows(found, "conical_height").tobytes() == rc.conical_heights(mass=mass, length=length).tobytes()


# Scenes, what varies, and whether the numbers of all links are proportional to it.
FOLLOWED = {
    "bodies": (BODIES, ["links[0].mass", "links[1].length"], True),
    "rods": ({"uniform_chain": {"kind": "rods", "count": 7, "length": 1.0, "mass": 1.0}, "ask": {"modes": {"first": 2, "count": 3}}}, ["uniform_chain.length"], True),
    "plummets": ({"uniform_chain": {"kind": "plummets", "count": 7, "length": 1.0, "mass": 1.0}, "ask": {"modes": {"first": 2, "count": 3}}}, ["uniform_chain.length"], True),
    "a number beside another": ({"links": [{"mass": 1, "length": 1}, {"weight": 2, "length": 1, "kind": "rod"}]}, ["links[1].weight", "links[0].mass", "gravity"], True),
    "a tapered chain": ({"tapered_chain": {"count": 12, "exponent": 1.0, "length": 1.0, "mass": 1.0}}, ["tapered_chain.length", "tapered_chain.mass"], True),
    "its exponent": ({"tapered_chain": {"count": 12, "exponent": 1.0, "length": 1.0, "mass": 1.0}}, ["tapered_chain.exponent"], False),
    "a tip": ({"links": [{"mass": 1, "length": 1, "tip_mass": 1.0}, {"mass": 2, "length": 1}]}, ["links[0].mass"], False),
    "a tip elsewhere": ({"links": [{"mass": 1, "length": 1, "tip_mass": 1.0}, {"mass": 2, "length": 1}]}, ["links[1].mass", "links[1].length"], True),
    "a pendulum length": ({"links": [{"mass": 1, "length": 1, "centroid": 0.5, "pendulum_length": 0.7}]}, ["links[0].pendulum_length"], False),
    "the support first": ({"order": "support first", "links": [{"mass": 1, "length": 1, "repeat": 3}, {"mass": 2, "length": 2, "kind": "rod"}]}, ["links[0].mass", "links[1].length", "links[1].mass"], True),
    "clamped": ({"links": [{"mass": 1, "length": 1, "clamped": True}, {"mass": 2, "length": 2, "kind": "rod"}]}, ["links[0].mass"], False),
}  # fmt: skip


@pytest.mark.parametrize(("scene", "paths", "follows"), FOLLOWED.values(), ids=FOLLOWED.keys())
def test_links_that_follow_the_varied_numbers(scene, paths, follows):
    """Batches agree with proved heights to their accuracy."""
    scene = {"ask": {"modes": {"count": "all"}}, **scene}
    vary = {path: uniform(0.55, 0.95) if path.endswith("pendulum_length") else uniform(0.5, 3.0) for path in paths}
    given = study(scene, vary, samples=60)
    assert (given._plan("").links is not None) is follows
    single, found = rc.sweep(study(scene, vary, samples=60, error_bounds=True)), rc.sweep(given)
    assert "error_bound" in single and ("error_bound" in found) is not follows
    assert single["error_bound"].max() < 1e-15
    assert np.abs(found["conical_height"] / single["conical_height"] - 1).max() < 1.5e-15
    assert np.abs(found["angular_speed"] / single["angular_speed"] - 1).max() < 1.5e-15
    assert (found["status"] == single["status"]).all() and found["mode"].equals(single["mode"])
    assert found["mode"][0] == scene["ask"]["modes"].get("first", 1)


def test_only_the_questions_of_find_are_asked(monkeypatch):
    scene = {"links": [{"mass": 1, "length": 1}], "ask": {"response": {"angular_speed": 1.0}, "shapes": {"angular_speed": 9.0}}}
    for name in ("response", "steady_shapes"):
        monkeypatch.setattr(rc.Scene, name, lambda self: pytest.fail("asked"))
    for bounds in (False, True):
        given = study(scene, {"links[0].mass": words(1, 2)}, find=["modes"], error_bounds=bounds)
        assert (given._plan("").links is not None) is not bounds and rc.sweep(given)["status"].all()


def test_one_system_serves_all_speeds(monkeypatch):
    """Points that differ in their speeds alone share a system; that of another point is built again."""
    speeds, masses = {"from": 1.0, "to": 9.0, "steps": 20}, {"from": 1.0, "to": 2.0, "steps": 3}
    scene = {**PLUMMETS, "ask": {"shapes": {"angular_speed": 9.0}}}
    plan = study(scene, {"links[0].mass": masses, "ask.shapes.angular_speed": speeds})._plan("")
    built, build = [], _scene.system_of
    monkeypatch.setattr(_scene, "system_of", lambda *given: built.append(given) or build(*given))
    assert plan.solve(plan.values())["status"].size == 60 and len(built) == 3


def test_a_tolerance_that_batches_keep_stays_in_them():
    vary = {"links[0].mass": uniform(1, 2)}
    bare = rc.sweep(study(BODIES, vary, samples=100))
    for rtol in (0.01, 1e-14):
        given = study({**BODIES, "ask": {"modes": {"count": "all", "rtol": rtol}}}, vary, samples=100)
        assert given._plan("").links is not None and rc.sweep(given)["conical_height"].equals(bare["conical_height"])
    tight = study({**BODIES, "ask": {"modes": {"count": "all", "rtol": 1e-15}}}, vary, samples=100)
    assert tight._plan("").links is None and rc.sweep(tight)["error_bound"].max() <= 1e-15


def test_order_of_the_points():
    """The last grid varies faster than the others, samples fastest; each point has its own random numbers."""
    vary = {
        "links[0].length": {"from": 1, "to": 3, "steps": 3},
        "gravity": words(5.0, 10.0),
        "links[1].length": words(0.5),
        "links[0].mass": uniform(1, 2),
    }
    given = study(PLUMMETS, vary, samples=2)
    found = rc.sweep(given)
    *grids, mass = (rows(found, name) for name in vary)
    expected = [values[:3] for values in itertools.product([1, 2, 3], [5, 10], [0.5], range(2))]
    assert list(zip(*grids, strict=True)) == expected and found["status"].shape == (3, 2, 1, 2)
    assert np.unique(mass).size == 12
    for point in range(12):
        scene = given.scene_at(point)
        assert scene.links[0].mass == mass[point] and scene.gravity == expected[point][1]
        assert scene.links[1].mass == given.scene.links[1].mass
    for outside in (-1, 12):
        with pytest.raises(IndexError, match="12 points"):
            given.scene_at(outside)


def test_random_numbers_belong_to_their_points():
    vary = {
        "links[0].mass": uniform(1, 2),
        "links[0].length": {"log_uniform": [0.01, 100]},
        "links[1].mass": normal(5, 0.1),
    }
    many = rc.sweep(study(PLUMMETS, vary, samples=40_000, seed=3))
    few = rc.sweep(study(PLUMMETS, vary, samples=100, seed=3))
    alone = rc.sweep(study(PLUMMETS, {"links[1].mass": vary["links[1].mass"]}, samples=100, seed=3))
    for name in vary:
        assert few[name].to_numpy().tobytes() == many[name][:100].to_numpy().tobytes()
        assert np.unique(many[name]).size == 40_000
    assert alone["links[1].mass"].equals(few["links[1].mass"])
    assert not np.any(rc.sweep(study(PLUMMETS, vary, samples=100, seed=4))["links[0].mass"] == few["links[0].mass"])
    mass, logs = rows(many, "links[0].mass") - 1, np.log10(rows(many, "links[0].length"))
    gauss = (rows(many, "links[1].mass") - 5) / 0.1
    shares = [mass, (logs + 2) / 4, [0.5 * math.erfc(-x / math.sqrt(2)) for x in gauss]]
    for share in shares:  # Kolmogorov-Smirnov, 1 in 1e5
        gap = np.abs(np.sort(share) - (np.arange(40_000) + 0.5) / 40_000).max()
        assert gap < 2.5 / math.sqrt(40_000)
    assert np.abs(np.corrcoef([mass, logs, gauss]) - np.eye(3)).max() < 0.025


def test_percentages_are_of_the_first_number():
    vary = {"links[0].mass": normal(5, "5 %"), "links[1].mass": uniform(2, "10%"), "gravity": {"log_uniform": [9, "50 %"]}}
    laws = [axis.law_numbers for axis in study(PLUMMETS, vary, samples=2)._plan("").axes]
    assert laws == [(5.0, 0.25), (1.8, 2.2), (6.0, 13.5)]
    assert study(PLUMMETS, {"links[0].mass": normal("5 t", "1 kg")}, samples=2)._plan("").axes[0].law_numbers == (5000, 1)


# ---- whoever computes


MIXED = {
    "batches": (BODIES, {"links[0].mass": normal(0.5, 0.2), "gravity": words(1.0, 10.0)}, 9000),
    "one by one": (GYROSTAT, {"support.stiffness": uniform(1.0, 300.0)}, 60),
    "words": (UNIFORM, {"uniform_chain.kind": words("rods", "plummets"), "uniform_chain.tip_mass": uniform(-1, 2)}, 50),
}


@pytest.mark.parametrize(("scene", "vary", "samples"), MIXED.values(), ids=MIXED.keys())
def test_threads_chunks_and_executors_change_nothing(scene, vary, samples):
    given = study(scene, vary, samples=samples)
    first = rc.sweep(given, workers=1)
    same(first, rc.sweep(given, workers=3, chunk=17))
    same(first, rc.sweep(given, chunk=given.points))
    same(first, rc.sweep(given, chunk=1) if samples < 100 else first)
    with ThreadPoolExecutor(2) as threads, ProcessPoolExecutor(2, get_context("spawn")) as processes:
        same(first, rc.sweep(given, executor=threads))
        same(first, rc.sweep(given, executor=processes, chunk=1000))


@pytest.mark.slow
def test_a_dask_cluster_changes_nothing_and_goes_on_where_threads_were():
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        for scene, vary, samples in MIXED.values():
            given = study(scene, vary, samples=samples)
            expected = rc.sweep(given)
            same(expected, rc.sweep(given, executor=client.get_executor(), workers=2, chunk=given.points // 7))
            for first, second in (({}, {"executor": client.get_executor()}), ({"executor": client.get_executor()}, {})):
                with pytest.raises(Ended):
                    rc.sweep(given, out="a.csv", chunk=samples // 9, progress=ended_after(samples // 3), **first)
                there = sum(stop - start for start, stop in kept())
                assert samples // 3 <= there < given.points
                found, resumed = with_resumed(given, out="a.csv", **second)
                assert resumed == there
                same(found, expected)


def test_what_is_refused_of_the_call():
    given = study(PLUMMETS, {"gravity": words(1.0)})
    for wrong in ({"workers": 0}, {"chunk": 0}, {"chunk": 1.5}, {"out": "a.txt"}, {"out": "a"}):
        with pytest.raises(ValueError):
            rc.sweep(given, **wrong)
    for wrong in ({"executor": 3}, {"executor": ThreadPoolExecutor}, {"progress": 3}):
        with pytest.raises(TypeError, match="must be a"):
            rc.sweep(given, **wrong)
    with pytest.raises(TypeError, match=r"such as ThreadPoolExecutor\(4\), got <class"):
        rc.sweep(given, executor=ThreadPoolExecutor)
    for wrong in ({"study": 3}, {"study": given, "out": 3}):
        with pytest.raises(TypeError):
            rc.sweep(**wrong)
    with pytest.raises(rc.SceneError, match="nowhere.toml: cannot be read"):
        rc.sweep("nowhere.toml")
    with pytest.raises(OSError, match="is no file"):
        Path("a.csv").mkdir()
        rc.sweep(given, out="a.csv")
    with pytest.raises(OSError):
        rc.sweep(given, out="/proc/a.csv")
    assert [name for name in files() if "partial" in name] == []


def test_points_that_are_refused_have_no_numbers():
    vary = {"links[0].mass": normal(0.01, 0.1), "links[1].length": uniform(0.1, 0.2)}
    for bounds in (False, True):
        given = study(PLUMMETS, vary, samples=200, error_bounds=bounds)
        found = rc.sweep(given)
        negative = rows(found, "links[0].mass") <= 0
        assert 0 < negative.sum() < 200 and (refused(found) == negative).all()
        for name in ("conical_height", "angular_speed"):
            assert (np.isnan(rows(found, name)).all(axis=1) == negative).all()
        with pytest.raises(rc.SceneError, match=r"links\[0\]"):
            given.scene_at(int(np.flatnonzero(negative)[0]))
    weights = {"links": [{"weight": 1.0, "length": 0.5}]}  # heights do not depend on gravity, which is refused all the same
    found = rc.sweep(study(weights, {"gravity": normal(1.0, 1.0)}, samples=50))
    assert (refused(found) == (rows(found, "gravity") <= 0)).all() and 0 < refused(found).sum() < 50


# ---- files


FILES = {
    "rig": (GYROSTAT, {"support.stiffness": uniform(1.0, 300.0), "gravity": words(1.0, 9.8)}, {"samples": 5}),
    "words": (UNIFORM, {"uniform_chain.count": {"from": 1, "to": 5, "steps": 3}, "uniform_chain.kind": words("rods", "plummets")}, {}),
    "refused": (PLUMMETS, {"links[0].mass": {"normal": [0.01, 0.1], "name": "bob, \"$\""}}, {"samples": 40, "title": "t"}),
    "yes and no": ({"links": [{"mass": 1.0, "length": 0.5}] * 2, "support": {"stiffness": 10.0}}, {"links[0].clamped": words(True, False)}, {}),
}  # fmt: skip


@pytest.mark.parametrize(("scene", "vary", "more"), FILES.values(), ids=FILES.keys())
@pytest.mark.parametrize("chunk", [None, 3])
def test_files_hold_every_bit(scene, vary, more, chunk):
    for package in ("pyarrow", "pandas", "h5netcdf"):
        pytest.importorskip(package)
    import pyarrow.parquet

    given = study(scene, vary, **more)
    found = rc.sweep(given)
    for ending in ("csv", "parquet", "nc"):
        same(rc.sweep(given, out=f"a.{ending}", chunk=chunk), found)
    assert files() == ["a.csv", "a.nc", "a.parquet"]
    with xarray.open_dataset("a.nc", engine="h5netcdf") as read:
        xarray.testing.assert_identical(read.load(), found)
        assert Study.from_dict(json.loads(read.attrs["study"])) == given
    table = pyarrow.parquet.read_table("a.parquet")
    whole = columns(found)
    assert table.column_names == list(whole)
    for name, column in whole.items():
        assert np.array_equal(table[name].to_numpy(), column, equal_nan=column.dtype.kind == "f")
    with open("a.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    for name, column in whole.items():
        kind = str.capitalize if column.dtype.kind == "b" else str
        texts = [kind(line[name]) for line in lines]
        assert np.array_equal(np.array(texts).astype(column.dtype) if kind is str else texts, column if kind is str else column.astype(str), equal_nan=column.dtype.kind == "f")  # fmt: skip


def test_labelled_arrays():
    vary = {"gravity": words(1.0, 9.81), "links[0].mass": {"uniform": [1, 2], "name": "bob"}}
    found = rc.sweep(study(BODIES, vary, samples=50, title="t"))
    assert dict(found.sizes) == {"gravity": 2, "sample": 50, "mode": 4}
    at = found.sel(gravity=9.81)["angular_speed"].isel(sample=3).to_numpy()
    assert at.tobytes() == rows(found, "angular_speed")[53].tobytes()
    assert found["bob"].attrs == {"units": "kg", "path": "links[0].mass"} and found.attrs["title"] == "t"
    units = {name: found[name].attrs["units"] for name in ("gravity", "angular_speed", "conical_height")}
    assert units == {"gravity": "m/s^2", "angular_speed": "rad/s", "conical_height": "m"}
    assert found["status"].attrs["flag_meanings"].split() == ["success", "tolerance_not_met", "refused"]
    assert found.to_dataframe()["bob"].notna().all()


# ---- runs that were ended


class Ended(Exception):
    pass


def ended_after(points):
    def told(done, _):
        if done >= points:
            raise Ended

    return told


LARGE = (GYROSTAT, {"support.stiffness": uniform(1.0, 300.0)})


def with_resumed(given, **more):
    """The results, and the number of points that an earlier run had computed."""
    seen = []
    found = rc.sweep(given, **more, progress=lambda done, total: seen.append(done))
    return found, seen[0]


def kept(folder="a.csv.partial"):
    """Beginnings and ends of the chunks that are kept."""
    names: list[str] = []
    with suppress(FileNotFoundError):  # a sweep that has just ended removes its folder
        names = os.listdir(folder)
    return sorted(tuple(map(int, name[:-4].split("-"))) for name in names if name[0].isdigit() and name.endswith(".npz"))


@pytest.fixture
def ended():
    """A study of 60 points in six chunks, all of them kept, and its folder."""
    given = study(*LARGE, samples=60)
    with pytest.raises(Ended):
        rc.sweep(given, out="a.csv", chunk=10, workers=1, progress=ended_after(60))
    assert kept() == [(k, k + 10) for k in range(0, 60, 10)] and files() == ["a.csv.partial"]
    return given, Path("a.csv.partial")


def test_a_run_goes_on_where_it_was():
    given = study(*LARGE, samples=100)
    with pytest.raises(Ended):
        rc.sweep(given, out="a.csv", chunk=10, progress=ended_after(40))
    there, seen = 10 * len(kept()), []
    assert files() == ["a.csv.partial"] and there >= 40
    found = rc.sweep(given, out="a.csv", chunk=7, workers=1, progress=lambda done, total: seen.append((done, total)))
    assert there == seen[0][0] and seen[-1] == (100, 100)
    same(found, rc.sweep(given))
    assert files() == ["a.csv"] and len(Path("a.csv").read_text().splitlines()) == 101


def test_what_is_damaged_is_computed_again(ended):
    given, folder = ended
    paths = sorted(folder.glob("[0-9]*.npz"))
    paths[1].write_bytes(b"\0" * len(paths[1].read_bytes()))
    paths[2].write_bytes(paths[2].read_bytes()[:-100])
    paths[3].write_bytes(b"")
    flipped = bytearray(paths[4].read_bytes())
    flipped[len(flipped) // 2] ^= 1
    paths[4].write_bytes(flipped)
    encrypted = bytearray(paths[5].read_bytes())
    encrypted[encrypted.index(b"PK\x01\x02") + 8] ^= 1  # says the flag, for which zipfile has a RuntimeError
    paths[5].write_bytes(encrypted)
    (folder / "0000000000055-0000000000065.npz").write_bytes(paths[0].read_bytes())  # there are no such points
    (folder / ".0000000000000-0000000000010-0123456789ab.npz").write_bytes(b"half")
    with pytest.warns(UserWarning, match="cannot be read, and its points are computed again") as warned:
        found, resumed = with_resumed(given, out="a.csv")
    assert len(warned) == 6 and all("\n" not in str(each.message) for each in warned)
    assert resumed == 10 and files() == ["a.csv"]
    same(found, rc.sweep(given))


@pytest.mark.parametrize(("right", "wrong"), [(b"'<f8'", b"'<f4'"), (b"'shape': (2000,", b"'shape': ((000,")])
def test_a_damaged_header_is_computed_again(right, wrong):
    """With these headers numpy reads other numbers, or raises an error of Python's tokenizer."""
    given = study(PLUMMETS, {"links[0].mass": {"from": 1.0, "to": 2.0, "steps": 4000}})
    with pytest.raises(Ended):
        rc.sweep(given, out="a.csv", chunk=2000, workers=1, progress=ended_after(2000))
    [path] = Path("a.csv.partial").glob("[0-9]*.npz")
    data = bytearray(path.read_bytes())
    place = data.index(right, data.index(b"angular_speed.npy"))
    data[place : place + len(right)] = wrong
    path.write_bytes(data)
    with pytest.warns(UserWarning, match="cannot be read, and its points are computed again"):
        found, resumed = with_resumed(given, out="a.csv")
    assert resumed == 0
    same(found, rc.sweep(given))


def test_nothing_is_written_through_a_link(ended):
    """A link in the place of a chunk is replaced or removed; the file that it names stays."""
    given, folder = ended
    path = folder / "0000000000000-0000000000010.npz"
    path.unlink()
    Path("mine.txt").write_text("mine")
    path.symlink_to(Path("mine.txt").resolve())
    with pytest.warns(UserWarning, match="cannot be read"):
        same(rc.sweep(given, out="a.csv"), rc.sweep(given))
    assert Path("mine.txt").read_text() == "mine" and files() == ["a.csv", "mine.txt"]


def test_other_files_in_the_folder_stay(ended, run):
    given, folder = ended
    (folder / "mine.txt").write_text("mine")
    shutil.copytree(folder, "b.csv.partial")
    Path("study.json").write_text(json.dumps(given.to_dict()))
    with pytest.warns(UserWarning, match="a.csv.partial stays: it holds other files, such as mine.txt"):
        rc.sweep(given, out="a.csv")
    assert sorted(path.name for path in folder.iterdir()) == ["mine.txt"] and Path("a.csv").exists()
    code, _, err = run("sweep", "study.json", "--out", "b.csv", "--quiet")
    assert (code, err) == (0, f"revchain: {Path('b.csv.partial').resolve()} stays: it holds other files, such as mine.txt\n")
    assert sorted(path.name for path in Path("b.csv.partial").iterdir()) == ["mine.txt"]
    assert (Path("b.csv.partial") / "mine.txt").read_text() == "mine"
    Path("c.csv.partial").write_text("mine")
    with pytest.raises(OSError, match="c.csv.partial is no folder"):
        rc.sweep(given, out="c.csv")
    assert Path("c.csv.partial").read_text() == "mine"


def test_another_study_and_another_run_are_refused(ended):
    given, folder = ended

    def content():
        return sorted((path.name, path.read_bytes()) for path in folder.iterdir())

    before = content()
    others = [
        study(*LARGE, samples=61),
        study(*LARGE, samples=60, seed=1),
        study(*LARGE, samples=60, max_shapes=2),
        study(*LARGE, samples=60, find=["modes"]),
        study(LARGE[0], {"support.stiffness": uniform(1.0, 301.0)}, samples=60),
        study({**LARGE[0], "gravity": 9.8}, LARGE[1], samples=60),
    ]
    for other in others:
        with pytest.raises(OSError, match="holds points of another study") as caught:
            rc.sweep(other, out="a.csv")
        assert isinstance(caught.value, ValueError)
    for text in (b"", b"{", b"[]", b"{}", b"\xff", b"[" * 10**5):
        (folder / "study.json").write_bytes(text)
        with pytest.raises(OSError, match="holds points of another study"):
            rc.sweep(given, out="a.csv")
    (folder / "study.json").write_bytes(dict(before)["study.json"])
    with filelock.FileLock(folder / "lock"), pytest.raises(OSError, match="another run is writing it"):
        rc.sweep(given, out="a.csv")
    assert content() == before
    assert with_resumed(study(*LARGE, samples=60, title="only another title"), out="a.csv")[1] == 60


SLOW = """
samples = 3000
error_bounds = true
[scene]
links = [{mass = 1, length = 0.1, repeat = 40}]
ask.modes = {count = 2}
[vary."links[0].mass"]
uniform = [1, 2]
"""
MILLION = """
samples = 1_000_000
[scene]
links = [{mass = 1, length = 0.1}, {mass = 1, length = 0.1}]
ask.modes = {count = "all"}
[vary."links[0].mass"]
uniform = [1, 2]
"""


@pytest.mark.slow
@pytest.mark.parametrize(("text", "ending", "more"), [(SLOW, "csv", ["--chunk", "5"]), (MILLION, "nc", [])])
def test_killed_again_and_again_nothing_is_lost(start, text, ending, more):
    if ending == "nc":
        pytest.importorskip("h5netcdf")
    Path("a.toml").write_text(text)
    command = (sys.executable, "-m", "revchain", "sweep", "a.toml", "--out", f"a.{ending}", "--workers", "2", *more)
    partial, there, kills, chance = Path(f"a.{ending}.partial"), set(), 0, random.Random(2)
    for _ in range(6):
        process, before = start(*command, stdout=-1), len(kept(partial))
        deadline = time.monotonic() + 30
        while len(kept(partial)) <= before and process.poll() is None:
            assert time.monotonic() < deadline
            time.sleep(0.001)
        time.sleep(chance.uniform(0, 0.03))
        process.send_signal(signal.SIGKILL)
        process.wait()
        if not partial.exists() or Path(f"a.{ending}").exists():
            break
        kills += 1
        assert there <= set(kept(partial))  # nothing is gone
        there = set(kept(partial))
    assert kills >= 1
    process = start(*command, stdout=-1)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 0 and "000 points in" in out
    assert files() == [f"a.{ending}", "a.toml"]
    rc.sweep("a.toml", out=f"b.{ending}")
    assert Path(f"a.{ending}").read_bytes() == Path(f"b.{ending}").read_bytes()


def test_ctrl_c_ends_cleanly(start):
    Path("a.toml").write_text(SLOW.replace("3000", "300_000"))
    process = start(sys.executable, "-m", "revchain", "sweep", "a.toml", stdout=-1, stderr=-1)
    while not kept():
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out) == (130, "")
    assert err == "revchain: interrupted; repeat the command to continue from a.csv.partial\n"
    assert files() == ["a.csv.partial", "a.toml"]


FULL = """
import errno, os, resource, sys
import revchain as rc
study = rc.load_study("a.toml")
for limit in (0, 5_000, 60_000, 150_000):
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, resource.RLIM_INFINITY))
    try:
        rc.sweep(study, out="a." + sys.argv[1], chunk=1000)
    except OSError as error:
        assert error.errno == errno.EFBIG and error.filename.endswith("a." + sys.argv[1]), repr(error)
        assert not os.path.exists("a." + sys.argv[1])
        print(len([name for name in os.listdir("a." + sys.argv[1] + ".partial")] if limit > 60_000 else []))
resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
done = []
rc.sweep(study, out="a." + sys.argv[1], progress=lambda *now: done.append(now[0]))
print(done[0])
"""


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["csv", "parquet", "nc"])
def test_a_full_disk_loses_nothing_finished(python, ending):
    """Chunks of 33 kB fit, the output of 200 kB or more does not: an error, and all chunks stay."""
    Path("a.toml").write_text(MILLION.replace("1_000_000", "10_000"))
    done = python("-c", FULL, ending)
    assert done.returncode == 0 and done.stdout.splitlines()[-1] == "10000", done.stderr
    assert sorted(path.name for path in Path().iterdir()) == [f"a.{ending}", "a.toml"]


# ---- studies that are wrong


ONE = {"links": [{"mass": 1.0, "length": 1.0}]}
GOOD = {"gravity": {"values": [1.0, 2.0]}}


def varied(key, **table):
    return {"scene": ONE, "vary": {key: table}}


BAD = {
    "nothing": ({}, "scene: is missing"),
    "no table": ([], "must be a table"),
    "no vary": ({"scene": ONE}, "vary: is missing"),
    "empty vary": ({"scene": ONE, "vary": {}}, "vary: is empty: say what varies"),
    "vary a list": ({"scene": ONE, "vary": []}, "vary: must be a table, got []"),
    "scene a number": ({"scene": 3, "vary": GOOD}, "scene: "),
    "scene wrong": ({"scene": {"links": [{"mass": 1}]}, "vary": GOOD}, "scene.links[0].length: is missing"),
    "unknown key": ({"scene": ONE, "vary": GOOD, "sample": 3}, "sample: unknown key; did you mean samples?"),
    "unknown law": (varied("gravity", unifrm=[1, 2]), 'vary.gravity.unifrm: unknown key; did you mean uniform?'),
    "no law": (varied("gravity"), 'vary.gravity: give from, to and steps, or one of values'),
    "two laws": (varied("gravity", values=[1], uniform=[1, 2]), 'vary.gravity: give from, to and steps, or one of'),
    "no steps": (varied("gravity", **{"from": 1, "to": 2}), 'vary.gravity.steps: is missing'),
    "no from": (varied("gravity", to=2, steps=3), 'vary.gravity.from: is missing'),
    "no steps at all": (varied("gravity", **{"from": 1, "to": 2, "steps": 0}), 'vary.gravity.steps: must be at least 1, got 0'),
    "log of values": (varied("gravity", values=[1], log=True), 'vary.gravity.log: goes with from, to and steps'),
    "log of 0": (varied("gravity", **{"from": 0, "to": 2, "steps": 3, "log": True}), 'vary.gravity.log: needs from and to'),
    "no values": (varied("gravity", values=[]), 'vary.gravity.values: '),
    "nan": (varied("gravity", values=[math.nan]), 'vary.gravity.values[0]: must be finite, got nan'),
    "unit of another kind": (varied("links[0].mass", values=[1, "2 m"]), 'vary."links[0].mass".values[1]: must be a mass such as "2 kg", got "2 m"'),
    "truth for a number": (varied("gravity", values=[True]), 'vary.gravity.values[0]: must be a number, got true'),
    "a word for a number": (varied("gravity", values=["much"]), 'vary.gravity.values[0]: must be a number, or a number and its unit'),
    "ends the wrong way": ({**varied("gravity", uniform=[2, 1]), "samples": 3}, 'vary.gravity.uniform: its low end'),
    "three ends": ({**varied("gravity", uniform=[1, 2, 3]), "samples": 3}, 'vary.gravity.uniform: '),
    "negative deviation": ({**varied("gravity", normal=[2, -1]), "samples": 3}, 'vary.gravity.normal: its deviation'),
    "log of a negative number": ({**varied("gravity", log_uniform=[-2, 1]), "samples": 3}, 'vary.gravity.log_uniform: must be positive'),
    "percentage of no number": ({**varied("gravity", normal=[2, "much %"]), "samples": 3}, 'vary.gravity.normal[1]: must be a number'),
    "negative percentage": ({**varied("gravity", uniform=[2, "-5 %"]), "samples": 3}, 'vary.gravity.uniform[1]: must be positive, got "-5 %"'),
    "random without samples": (varied("gravity", uniform=[1, 2]), "samples: is missing: say how many points"),
    "samples without random": ({"scene": ONE, "vary": GOOD, "samples": 3}, "samples: is for random numbers, and none are"),
    "samples 0": ({**varied("gravity", uniform=[1, 2]), "samples": 0}, "samples: must be at least 1, got 0"),
    "negative seed": ({"scene": ONE, "vary": GOOD, "seed": -1}, "seed: must not be negative, got -1"),
    "no path": (varied("links 0", values=[1]), 'vary."links 0": is no path into a scene such as links[0].mass'),
    "path from the study": (varied("scene.gravity", values=[1]), 'vary."scene.gravity": is no path into a scene: write "gravity"'),
    "path of no link": (varied("mass", values=[1]), 'vary.mass: is no path into a scene: write "links[0].mass"'),
    "a name": (varied("links[0].name", values=["a"]), 'vary."links[0].name": cannot be varied'),
    "samples in vary": (varied("gravity", normal=[1, 2], samples=3), "vary.gravity.samples: unknown key; belongs at the top of the study"),
    "normal of one number": (varied("gravity", normal=[1]), "vary.gravity.normal: must be a pair [mean, deviation], got [1]"),
    "ask beside the scene": ({**varied("gravity", values=[1]), "ask": {}}, "ask: unknown key; belongs in [scene]"),
    "find without brackets": ({**varied("gravity", values=[1]), "find": "modes"}, 'find: must be a list: write ["modes"]'),
    "held at some points": ({"scene": {"links": [{"mass": 1, "length": 1}] * 3}, "vary": {"held.span": {"values": [2]}}}, 'vary."held.span": makes a chain held at both ends of a chain at 2.0'),
    "no such link": (varied("links[1].mass", values=[1]), 'vary."links[1].mass": the scene has nothing at [1]: there are 1'),
    "no such key": (varied("links[0].mas", values=[1]), 'vary."links[0].mas": unknown key; did you mean mass?'),
    "no such table": (varied("suport.mass", values=[1]), 'vary."suport.mass": suport: unknown key; did you mean support?'),
    "other of two": (varied("links[0].weight", values=[1]), 'vary."links[0].weight": is given beside mass'),
    "other kind of chain": (varied("uniform_chain.length", values=[1]), 'vary."uniform_chain.length": '),
    "a value refused": (varied("links[0].length", values=[1, -1]), 'vary."links[0].length": must be positive, got -1'),
    "a table": (varied("links[0]", values=[1]), 'vary."links[0]": '),
    "the title": (varied("title", values=["a"]), 'vary.title: cannot be varied'),
    "what is asked": (varied("ask.modes", values=[1]), 'vary."ask.modes": cannot be varied: of [ask] only the speeds'),
    "not whole": (varied("links[0].repeat", values=[1.5]), 'vary."links[0].repeat".values[0]: must be a whole number, got 1.5'),
    "steps not whole": (varied("links[0].repeat", **{"from": 1, "to": 2, "steps": 3}), 'vary."links[0].repeat".steps: makes numbers that are not whole'),
    "random count": ({**varied("links[0].repeat", uniform=[1, 2]), "samples": 3}, 'vary."links[0].repeat": takes no random numbers'),
    "an unknown word": (varied("links[0].kind", values=["rod", "bod"]), 'vary."links[0].kind": must be one of plummet, rod, got'),
    "the same twice": ({"scene": ONE, "vary": {"gravity": {"values": [1]}, "links[0].mass": {"values": [1], "name": "gravity"}}}, 'vary."links[0].mass".name: gravity is the name of another, too'),
    "name of a result": (varied("gravity", values=[1], name="conical_height"), 'vary.gravity.name: conical_height is the name of a result'),
    "name with a slash": (varied("gravity", values=[1], name="m/s"), 'vary.gravity.name: must be a printable name'),
    "find nothing": ({"scene": ONE, "vary": GOOD, "find": []}, "find: "),
    "find what is not there": ({"scene": ONE, "vary": GOOD, "find": ["all"]}, "find[0]: must be one of modes, shapes, response"),
    "a diagram without speeds": ({"scene": ONE, "vary": GOOD, "find": ["campbell"]}, "find[0]: the scene does not say at which speed: [ask.campbell]"),
    "modes of a governor": ({"scene": {"governor": GOVERNOR}, "vary": {"governor.arm": {"values": [0.3]}}, "find": ["modes"]}, 'find[0]: has no answer for this system: write "equilibria"'),
    "equilibria of a chain": ({"scene": ONE, "vary": GOOD, "find": ["equilibria"]}, 'find[0]: has no answer for this system: write "modes"'),
    "a governor without a number": ({"scene": {"governor": GOVERNOR}, "vary": {"governor.arm": {"values": [0.3]}}}, "scene.governor: gives no number to store: write its two stops, or a speed in [ask.equilibria]"),
    "a diagram of a cord": ({"scene": {"cord": {"length": 1, "mass": 1}, "ask": {"campbell": {"angular_speed": [5, 6]}}}, "vary": {"cord.length": {"values": [1]}}}, "scene.ask.campbell: does not go with cord"),
    "shapes at no speed": ({"scene": ONE, "vary": GOOD, "find": ["shapes"]}, "find[0]: the scene does not say at which speed"),
    "window": ({"scene": {**ONE, "ask": {"modes": {"conical_height": [0, 1]}}}, "vary": GOOD}, "scene.ask.modes.conical_height: gives each point another number of modes"),
    "swing": ({"scene": {**ONE, "ask": {"swing": {"offset": [0.1]}}}, "vary": GOOD}, "scene.ask.swing: is not for studies"),
    "slack": ({"scene": {"links": [{"mass": 1, "length": 1}] * 3, "held": {"span": 2}}, "vary": GOOD}, "scene.held.span: makes the chain bent"),
    "too many": ({"scene": ONE, "vary": {"gravity": {"from": 1, "to": 2, "steps": 10**7}, "links[0].mass": {"from": 1, "to": 2, "steps": 10**6}}}, "vary: makes 10,000,000,000,000 points"),
    "another version": ({"scene": ONE, "vary": GOOD, "schema_version": 2}, "schema_version: must be 1, got 2"),
}  # fmt: skip


@pytest.mark.parametrize(("data", "message"), BAD.values(), ids=BAD.keys())
def test_errors_name_the_key(data, message):
    with pytest.raises(rc.SceneError) as caught:
        Study.from_dict(data, source="my.toml")
    assert str(caught.value).startswith(f"my.toml: {message}")
    assert len(str(caught.value).splitlines()) == len(caught.value.problems)


def test_errors_of_files():
    Path("a.toml").write_text('scene = "b.toml"\n[vary.gravity]\nvalues = [1]\n')
    with pytest.raises(rc.SceneError, match=r"b.toml: cannot be read: No such file"):
        rc.load_study("a.toml")
    Path("b.toml").write_text("[[links]]\nmass = 1\n")
    with pytest.raises(rc.SceneError, match=r"b.toml: line 1, column 1: links\[0\].length: is missing"):
        rc.load_study("a.toml")
    Path("b.toml").write_text("[[links]]\nmass = 1\nlength = 2\n")
    assert rc.load_study("a.toml").points == 1
    Path("deep").mkdir()
    Path("deep/a.json").write_text('{"scene": "../b.toml", "vary": {"gravity": {"values": [1, 2]}}}')
    assert rc.load_study("deep/a.json").points == 2
    Path("a.toml").write_text("[[scene.links]]\nmass = -1\nlenght = 2\n[vary.gravity]\nvalues = [1]\n")
    with pytest.raises(rc.SceneError) as error:
        rc.load_study("a.toml")
    assert [each[:3] for each in error.value.problems] == [
        (1, 1, "scene.links[0].length"),
        (2, 1, "scene.links[0].mass"),
        (3, 1, "scene.links[0].lenght"),
    ]
    Path("a.toml").write_text("x = ")
    with pytest.raises(rc.SceneError, match=r"a.toml: line 1, column 5"):
        rc.load_study("a.toml")


WRONG = """samples = 0
find = ["modes", "all"]
[scene]
gravity = 2,5
[[scene.links]]
mass = -1
lenght = 1
[vary."links[0].mass"]
values = [1,
  "2 m"]
[vary.gravity]
frm = 3
to = "3 kg"
[vary.links[0].length]
uniform = [2, 1]
name = "a/b"
"""


def test_more_modes_than_there_are():
    """Points with fewer modes than are asked for have all of theirs; there are columns for the point with the most."""
    data = {"links": [{"mass": 1, "length": 1}], "ask": {"modes": {"count": 5}}}
    found = rc.sweep(study(data, {"links[0].repeat": {"values": [1, 2, 4]}}))
    speed = found["angular_speed"].to_numpy()
    assert speed.shape == (3, 4) and (found["status"] == 1).all()
    assert np.isfinite(speed).sum(axis=1).tolist() == [1, 2, 4]
    assert speed[1, :2].tolist() == rc.modes(rc.Chain(mass=[1.0, 1.0], length=1.0)).angular_speed.tolist()


def test_all_at_once():
    """Syntax, the scene, what varies and what is asked, each with its line; quoted keys, too."""
    Path("a.toml").write_text(WRONG)
    with pytest.raises(rc.SceneError) as error:
        rc.load_study("a.toml")
    assert [each[:3] for each in error.value.problems] == [
        (1, 1, "samples"),
        (2, 18, "find[1]"),
        (4, 1, ""),
        (5, 1, "scene.links[0].length"),
        (6, 1, "scene.links[0].mass"),
        (7, 1, "scene.links[0].lenght"),
        (10, 3, 'vary."links[0].mass".values[1]'),
        (11, 1, "vary.gravity.from"),
        (11, 1, "vary.gravity.steps"),
        (12, 1, "vary.gravity.frm"),
        (13, 1, "vary.gravity.to"),
        (14, 7, ""),
        (15, 1, 'vary."links[0].length".uniform'),
        (16, 1, 'vary."links[0].length".name'),
    ]
    Path("b.toml").write_text("[[links]]\nmass = 1\nlength = 2,5\nmas = 1\n")
    Path("a.toml").write_text('scene = "b.toml"\nsampels = 2\n[vary.gravity]\nvalues = 3\n')
    with pytest.raises(rc.SceneError) as error:
        rc.load_study("a.toml")
    assert str(error.value).split("\n") == [
        "a.toml: line 1, column 1: scene: b.toml: line 3, column 1: the decimal mark is a point: write length = 2.5, not 2,5",
        "a.toml: line 1, column 1: scene: b.toml: line 4, column 1: links[0].mas: unknown key; did you mean mass?",
        "a.toml: line 2, column 1: sampels: unknown key; did you mean samples?",
        "a.toml: line 4, column 1: vary.gravity.values: must be a list of numbers, got 3: write [3]",
    ]


def test_round_trip():
    data = {
        "scene": BODIES,
        "vary": {"links[0].mass": {"from": "1 g", "to": 2.0, "steps": 3}, "gravity": {"normal": [9.8, 0.1]}},
        "samples": 2,
    }
    given = Study.from_dict(data)
    assert given.to_dict() == data and Study.from_dict(given.to_dict()) == given


def test_the_schema():
    schema = study_schema()
    assert set(schema["$defs"]) == {"Study", "Vary", "Scatter", *json_schema()["$defs"]}
    for kind in (Study, Vary):
        table = schema["$defs"][kind.__name__]
        assert set(table["properties"]) == {
            "from" if name == "first" else "to" if name == "last" else name for name in kind.__struct_fields__
        }
        assert table["additionalProperties"] is False
        assert all("description" in entry for entry in table["properties"].values())


# ---- the command


def test_the_command(run):
    assert run("new", "--study")[:2] == (0, "wrote study.toml; now: revchain sweep study.toml\n")
    code, out, err = run("sweep", "study.toml", "--check")
    assert (code, err) == (0, "")
    assert out.splitlines() == [
        "study.toml: valid: 63 points, in batches",
        "  links[0].mass: 21 values, 0.1 to 10",
        "  links[1].length: 3 values, 0.2 to 0.4",
        "  finds angular_speed_1 … angular_speed_2",
        "  finds conical_height_1 … conical_height_2",
    ]
    assert run("sweep", "study.toml", "--processes", "--workers", "2", "-q")[0] == 0
    code, out, err = run("sweep", "study.toml", "--plot", "a.png")
    lines = out.splitlines()
    assert (code, err) == (0, "") and lines[0] == "Study of 63 points" and lines[-1] == "wrote a.png"
    assert lines[1].split() == ["column", "least", "median", "largest"] and lines[-2].startswith("wrote study.csv: 63 points in ")
    assert files() == ["a.png", "study.csv", "study.toml"]
    assert json.loads(run("schema", "--study")[1]) == study_schema()


def test_how_the_command_ends(run):
    def toml(vary, more=""):
        Path("a.toml").write_text(
            f'{more}\nscene = {{links = [{{mass = 1, length = 1}}]}}\n[vary."links[0].mass"]\n{vary}\n'
        )

    toml("values = [-1]")
    assert run("sweep", "a.toml") == (3, "", 'revchain: a.toml: line 3, column 1: vary."links[0].mass": must not be negative, got -1.0\n')
    toml("values = [1]")
    assert run("sweep", "a.toml", "--out", "a.txt")[0] == 2
    assert run("sweep", "a.toml", "--out", "a.toml")[0] == 2
    assert run("sweep", "a.toml", "--plot", "a.gif")[0] == 2
    assert run("sweep", "a.toml", "--out", "/proc/a.csv")[0] == 4
    toml('values = [1]\n[vary.gravity]\nvalues = [1]\n[vary."links[0].length"]\nvalues = [1]')
    message = "revchain: --plot: draws at most two grids, and there are 3: links[0].mass, gravity, links[0].length\n"
    assert run("sweep", "a.toml", "--plot", "a.png") == (2, "", message)
    assert files() == ["a.toml"]
    toml("normal = [0.1, 1]", "samples = 8")
    code, out, err = run("sweep", "a.toml")
    assert code == 1 and "8 points" in out
    lines = err.splitlines()
    assert lines[0].endswith("points are refused") and lines[1].startswith("  point ") and "links[0]" in lines[1]
    toml("values = [1, 2]")
    Path("a.toml").write_text(Path("a.toml").read_text().replace("}]}", "}], ask = {modes = {rtol = 1e-40}}}"))
    assert run("sweep", "a.toml", "-q") == (1, "", "revchain: at 2 points something is not proved\n")


def test_pictures():
    grid = {"from": 0.1, "to": 10, "steps": 9, "log": True}
    one = rc.sweep(study(BODIES, {"links[0].mass": grid}))
    ax = plot_sweep(one)
    assert (ax.get_xscale(), len(ax.lines), ax.get_ylabel()) == ("log", 4, "angular speed (rad/s)")
    two = rc.sweep(study(BODIES, {"links[0].mass": words(1, 2, 3), "gravity": words(1, 2)}))
    assert len(plot_sweep(two, "conical_height").collections) == 1
    law = {"normal": [1.0, 0.1], "name": "$% a $"}
    scattered = rc.sweep(study(BODIES, {"links[0].mass": law, "links[0].length": uniform(1, 2)}, samples=500))
    ax = plot_sweep(scattered, "conical_height")
    assert ax.get_xlabel() == "conical height (m), % above its median" and len(ax.get_legend().get_texts()) == 4
    height = scattered["conical_height"][:, 0].to_numpy()
    assert f"mode 1: median {np.median(height):.4g}" in ax.get_legend().get_texts()[0].get_text()
    heights, edges = (ax.patches[0].get_xy()[:, k] for k in (1, 0))
    assert np.sum(heights[1:-1:2] * np.diff(edges[1:-1:2], append=edges[-1])) == pytest.approx(1.0, rel=0.2)
    bands = rc.sweep(study(BODIES, {"links[0].mass": grid, "gravity": normal(9.8, "5 %")}, samples=200))
    ax = plot_sweep(bands)
    assert (len(ax.lines), len(ax.collections)) == (4, 8)  # for each mode the median, and two bands
    median = np.median(bands["angular_speed"].sel(mode=1).to_numpy(), axis=1)
    assert np.array_equal(ax.lines[0].get_ydata(), median)
    both = {"links[0].mass": words(1, 2, 3), "gravity": words(1, 2), "links[1].length": normal(1, "5 %")}
    assert "median" in plot_sweep(rc.sweep(study(BODIES, both, samples=9))).figure.axes[1].get_ylabel()
    plot_sweep(rc.sweep(study(BODIES, {"links[0].mass": law}, samples=9))).figure.savefig("a.png")
    named = rc.sweep(study(BODIES, {"links[1].kind": words("rod", "plummet")}))
    with pytest.raises(ValueError, match="not words"):
        plot_sweep(named)
    with pytest.raises(ValueError, match="name must be one of"):
        plot_sweep(one, "nothing")


def test_missing_packages_are_named(python, without):
    Path("a.toml").write_text("scene = {links = [{mass = 1, length = 1}]}\nvary.gravity.values = [1]\n")
    program = "import revchain as rc\n"
    for missing, call in (("xarray", "rc.sweep('a.toml')"), ("pyarrow", "rc.sweep('a.toml', out='a.csv')"), ("h5netcdf", "rc.sweep('a.toml', out='a.nc')"), ("filelock", "rc.sweep('a.toml', out='a.csv')")):
        done = python("-c", without(missing) + program + f"try: {call}\nexcept ImportError as error: print(error)\n")
        assert missing in done.stdout and 'pip install "revchain[sweep]"' in done.stdout, done.stderr
    done = python("-c", without("xarray") + "from revchain.cli import app\nprint(app.run(['sweep', 'a.toml']))\n")
    assert done.stdout == "2\n" and 'pip install "revchain[sweep]"' in done.stderr


def test_the_page_and_its_examples(repository, run):
    pytest.importorskip("xarray")
    page = (repository / "docs/studies.md").read_text(encoding="utf-8")
    for path in (repository / "examples/studies").glob("*.toml"):
        assert run("sweep", path, "--check")[0] == 0
        assert why_not_drawn(rc.load_study(path)._plan("")) == ""
    assert run("sweep", repository / "examples/studies/crane_scatter.toml", "--plot", "crane.png")[0] == 0
    for name in (*(name for name in Vary.__struct_fields__ if name not in ("first", "last")), "samples", "seed", "find"):
        assert name in page


def test_threads_end_with_the_call():
    before = threading.active_count()
    rc.sweep(study(PLUMMETS, GOOD))
    with pytest.raises(Ended):
        rc.sweep(study(*LARGE, samples=500), progress=ended_after(1))
    assert threading.active_count() == before and not os.path.exists("a.csv")


def test_what_a_batch_refuses_has_no_numbers():
    links = [{"mass": 1, "length": 0.5}, {"mass": 1, "length": 1}, {"mass": 2, "length": 0.7, "kind": "rod"}]
    rng = np.random.default_rng(1)
    junk = [rng.random((4, 3)) for _ in range(50)]  # memory that has been used
    del junk
    found = rc.sweep({"scene": {"links": links}, "vary": {"links[1].mass": {"values": [3, 2, 1, 0]}}})
    assert np.isnan(found["conical_height"][3, 2]) and np.isfinite(found["conical_height"][:3]).all()
    bodies = [{**links[0], "centroid": 0.3, "radius_of_gyration": 0.1}, links[2]]
    study = {"scene": {"links": bodies}, "vary": {"links[0].centroid": {"normal": [1, 2]}}, "samples": 50}
    found = rc.sweep(study)
    assert 10 < refused(found).sum() < 40
    same(found, rc.sweep(study))
    assert np.array_equal(np.isnan(found["conical_height"]).all(axis=1), refused(found))


def test_rigs_with_damping_have_speeds_and_no_heights():
    links = [{"mass": 1.0, "length": 1.0, "pin": {"damping": 0.1}}, {"mass": 2.0, "length": 0.5}]
    asked = study({"links": links}, {"links[0].pin.damping": words(0.1, 0.2)})
    found = rc.sweep(asked)
    for k in range(2):
        modes = asked.scene_at(k).modes()
        assert np.array_equal(found["angular_speed"][k], modes.angular_speed)
        assert np.array_equal(found["error_bound"][k], modes.error_bound)
    assert np.isnan(found["conical_height"]).all()


def test_all_points_are_one_kind_of_system():
    wheel = {"mass": 0.1, "radius_of_gyration": 0.1, "spin": 0}
    links = [{"mass": 1, "length": 0.5, "flywheel": wheel}, {"mass": 2, "length": 0.7}]
    for scene, key, words in (
        ({"links": links[1:]}, "support.stiffness", "makes a rig of a chain"),
        ({"links": links}, "links[0].flywheel.spin", "makes a rig with flywheels that spin of a rig"),
    ):
        with pytest.raises(rc.SceneError, match=words):
            rc.sweep({"scene": scene, "vary": {key: {"values": [5.0, 10.0]}}})
    wheel["spin"] = 1
    found = rc.sweep({"scene": {"links": links}, "vary": {"links[0].flywheel.spin": {"values": [0, 5]}}})
    assert np.isfinite(found["backward_angular_speed"][1, :2]).all()
    clamped = [{"mass": 1, "length": 0.5, "clamped": True}, *links[1:], *links[1:]]
    found = rc.sweep({"scene": {"links": clamped}, "vary": {"links[0].clamped": {"values": [False, True]}}})
    assert np.isfinite(found["conical_height"]).sum(axis=1).to_numpy().tolist() == [3, 2]


def test_quantities_of_pins_and_of_exponents():
    links = [{"mass": 1, "length": 1, "pin": {"stiffness": 1.0}}]
    values = {"values": ["1 N m/rad", "2 N m/rad"]}
    given = rc.Study.from_dict({"scene": {"links": links}, "vary": {"links[0].pin.stiffness": values}})
    assert rc.sweep(given).coords["links[0].pin.stiffness"].attrs["units"] == "N m/rad"
    cord = {"scene": {"cord": {"mass": 1, "length": 1}}, "vary": {"cord.density": {"values": [0.0, 1.0]}}}
    assert "units" not in rc.sweep(rc.Study.from_dict(cord)).coords["cord.density"].attrs
    tapered = {"tapered_chain": {"count": 3, "length": 1, "mass": 1, "exponent": 0}}
    for scene, key in ((tapered, "tapered_chain.exponent"), (cord["scene"], "cord.density")):
        for values in ({"values": ["2 m"]}, {"from": "1 kg", "to": 2, "steps": 2}, {"uniform": [0, "50 %/s"]}):
            with pytest.raises(rc.SceneError, match="must be a number without a unit, got"):
                rc.Study.from_dict({"scene": scene, "vary": {key: values}, "samples": 2})


def test_values_of_a_wrong_kind_are_told_what_they_may_be():
    tapered = {"tapered_chain": {"count": 3, "length": 1, "mass": 1, "exponent": 0}}
    for values, words in (
        ({"from": True, "to": 2, "steps": 2}, "from: must be a number or text, got true"),
        ({"uniform": [True, 1]}, r"uniform\[0\]: must be a number or text, got true"),
        ({"values": [[1]]}, r"values\[0\]: must be true or false, a number or text, got \[1\]"),
    ):
        with pytest.raises(rc.SceneError, match=words):
            rc.Study.from_dict({"scene": tapered, "vary": {"tapered_chain.mass": values}})


def test_modes_of_a_held_chain_whose_pins_have_mass_at_the_points_alone():
    links = [{"mass": mass, "length": 0.5} for mass in (1, 0, 0, 1, 1)]
    given = {"scene": {"links": links, "held": {"tension": 100.0}}, "vary": {"links[2].mass": {"values": [2.0, 1.0]}}}
    assert rc.sweep(rc.Study.from_dict(given)).sizes["mode"] >= 3
