# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies: what each point gives, whoever computes it, what is kept of a run that was ended, what is refused."""

import csv
import itertools
import json
import math
import os
import random
import re
import signal
import struct
import sys
import threading
import time
import tracemalloc
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import revchain as rc
from revchain.cli import app as _cli
from revchain.plots.sweep import why_not_drawn
from revchain.scenes.scene import json_schema
from revchain.studies.journal import Journal
from revchain.studies.study import Study, Vary, study_schema

PLUMMETS = {"links": [{"mass": 1.0, "length": 0.5}, {"mass": 2.0, "length": 0.25, "repeat": 2}]}
BODIES = {
    "links": [
        {"mass": 1.0, "length": 0.5, "centroid": 0.2, "radius_of_gyration": 0.1},
        {"weight": 2.0, "length": 0.25, "kind": "rod", "repeat": 2},
        {"mass": 0.5, "length": 0.4, "centroid": 0.3, "pendulum_length": 0.35},
    ],
    "ask": {"modes": "all"},
}
GYROSTAT = {
    "links": [{"mass": 2.0, "length": 0.4, "flywheel": {"mass": 1.5, "radius_of_gyration": 0.29, "spin": 40.0}}] * 2,
    "support": {"stiffness": 200.0, "mass": 0.1, "radius": 0.02},
    "ask": {"modes": 3, "shapes": {"angular_speed": 9.0}, "response": {"angular_speed": [2.0, 9.0], "steps": 4}},
}


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")


@pytest.fixture
def run(capsys):
    """Run a command in this process: exit code, stdout, stderr."""

    def call(*arguments):
        code = _cli.run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        assert "Traceback" not in captured.err
        return code, captured.out, captured.err

    return call


def study(scene, vary, **more):
    return Study.from_dict({"scene": scene, "vary": vary, **more})


def same(one, two):
    """Number for number, bit for bit."""
    for name in [*one.varied, *one.found, "status"]:
        assert one[name].tobytes() == two[name].tobytes(), name
    assert one.refused == two.refused


def files():
    return sorted(path.name for path in Path().iterdir())


# ---- values


def test_batches_are_the_bare_call():
    vary = {
        "links[0].mass": {"from": "100 g", "to": "10 kg", "steps": 5, "log": True},
        "gravity": {"values": [1.62, "981 cm/s^2"]},
        "links[1].length": {"uniform": [0.1, 0.9]},
        "links[0].centroid": {"normal": [0.2, 0.01]},
        "links[2].pendulum_length": {"values": ["35 cm", 0.4]},
    }
    given = study(BODIES, vary, samples=300, seed=7)
    found = rc.sweep(given)
    assert given._plan("").batched and len(found) == 5 * 2 * 2 * 300 == given.points
    weight, length, centroid, radius = np.empty((4, len(found), 4))
    g = found["gravity"]
    weight[:] = np.stack([found["links[0].mass"] * g, np.full_like(g, 2), np.full_like(g, 2), 0.5 * g], axis=1)
    rods = found["links[1].length"]
    length[:] = np.stack([np.full_like(g, 0.5), rods, rods, np.full_like(g, 0.4)], axis=1)
    pendulum = found["links[2].pendulum_length"]
    centroid[:] = np.stack([found["links[0].centroid"], rods / 2, rods / 2, np.full_like(g, 0.3)], axis=1)
    last = np.sqrt(0.3 * (pendulum - 0.3))
    radius[:] = np.stack([np.full_like(g, 0.1), rods / math.sqrt(12), rods / math.sqrt(12), last], axis=1)
    bare = rc.conical_heights(weight=weight, length=length, centroid=centroid, radius_of_gyration=radius)
    assert found["conical_height"].tobytes() == bare.tobytes()
    assert found["angular_speed"].tobytes() == rc.conical_pendulum.angular_speed(bare, g[:, np.newaxis]).tobytes()
    for point in (0, 1, 777, len(found) - 1):
        chain = given.scene_at(point).chain()
        assert chain.weight.tobytes() == weight[point].tobytes() and chain.length.tobytes() == length[point].tobytes()


@pytest.mark.parametrize("kind", ["rods", "plummets"])
def test_batches_of_uniform_chains(kind):
    scene = {"uniform_chain": {"kind": kind, "count": 7, "length": 1.0, "mass": 1.0}, "ask": {"first": 2, "modes": 3}}
    found = rc.sweep({"scene": scene, "vary": {"uniform_chain.length": {"uniform": [0.5, 2.0]}}, "samples": 50})
    length = found["uniform_chain.length"][:, np.newaxis] / 7 * np.ones(7)
    body = {"centroid": length / 2, "radius_of_gyration": length / math.sqrt(12)} if kind == "rods" else {}
    weight = np.full(7, 9.80665 / 7)
    bare = rc.conical_heights(weight=weight, length=length, **body)[:, 1:4]
    assert found["conical_height"].tobytes() == bare.tobytes()
    assert list(found.columns())[2:5] == ["angular_speed_2", "angular_speed_3", "angular_speed_4"]


def test_batches_and_points_one_by_one_agree_to_their_accuracy():
    vary = {"links[0].mass": {"log_uniform": [1e-3, 1e3]}, "links[1].length": {"uniform": [0.1, 0.9]}}
    batches = rc.sweep(study(BODIES, vary, samples=500))
    single = rc.sweep(study(BODIES, vary, samples=500, error_bounds=True))
    assert "error_bound" in single.found and "error_bound" not in batches.found
    assert single["error_bound"].max() < 1e-15
    assert np.abs(batches["conical_height"] / single["conical_height"] - 1).max() < 1.5e-15
    for point in (0, 250, 499):
        modes = single.study.scene_at(point).modes()
        assert single["conical_height"][point].tobytes() == modes.conical_height.tobytes()
        assert single["error_bound"][point].tobytes() == modes.error_bound.tobytes()
    bare = rc.sweep(study(BODIES, vary, samples=500, error_bounds=False))
    assert bare["conical_height"].tobytes() == batches["conical_height"].tobytes()


def test_rigs_shapes_and_response_are_those_of_the_scene():
    vary = {
        "links[1].flywheel.spin": {"values": ["-300 rpm", 0.0, 50.0]},
        "support.stiffness": {"from": "0.1 kN/m", "to": "1 kN/m", "steps": 2},
        "ask.shapes.angular_speed": {"values": [3.0, "120 rpm"]},
        "ask.response.angular_speed[1]": {"values": [8.0]},
    }
    given = study(GYROSTAT, vary, most_shapes=3)
    found = rc.sweep(given)
    assert found.shape == (3, 2, 2, 1) and set(found.status) <= {"success", "tolerance_not_met"}
    for point in range(len(found)):
        scene = given.scene_at(point)
        modes, shapes, response = scene.modes(), scene.steady_shapes(), scene.response()
        for sense, turn in (("forward", 1), ("backward", -1)):
            of_sense = modes.direction == turn
            for name in ("angular_speed", "conical_height", "error_bound", "speed_error_bound"):
                row, want = found[f"{sense}_{name}"][point], np.abs(getattr(modes, name)[of_sense])
                assert row[: len(want)].tobytes() == want.tobytes()
                assert np.isnan(row[len(want) :]).all()
        assert found["shapes"][point] == len(shapes) and found["shapes_complete"][point] == shapes.complete
        for k, shape in enumerate(shapes[:3]):
            assert found["half_waves"][point, k] == shape.half_waves
            assert found["lowest_inclination"][point, k] == shape.inclination[0]
            assert found["top_tension"][point, k] == shape.tension[-1]
        assert found["response_free_end_offset"][point].tobytes() == response.offset[:, 0].tobytes()
        assert found["support_force"][point].tobytes() == response.support_force.tobytes()
        good = modes.status == "success" and shapes.complete and np.isfinite(response.error_bound).all()
        assert (found.status[point] == "success") == good


def test_chains_held_at_both_ends():
    taut = {"links": [{"mass": 1.0, "length": 0.5, "repeat": 3}], "held": {"tension": "50 N"}}
    found = rc.sweep({"scene": taut, "vary": {"held.tension": {"values": ["10 N", 20.0]}}})
    for point in range(2):
        assert (
            found["conical_height"][point][:2].tobytes() == found.study.scene_at(point).modes().conical_height.tobytes()
        )
    slack = {**taut, "held": {"span": 1.2}, "ask": {"shapes": {"angular_speed": 20.0}}}
    found = rc.sweep({"scene": slack, "vary": {"held.span": {"values": [1.2, "1.3 m"]}}, "most_shapes": 1})
    assert found.found[:2] == ["shapes", "shapes_complete"]
    assert found["top_tension"][1, 0] == found.study.scene_at(1).steady_shapes()[0].tension[-1]


def test_counts_and_words_vary():
    scene = {"uniform_chain": {"kind": "rods", "count": 3, "length": 1.0, "mass": 1.0}}
    vary = {
        "uniform_chain.count": {"from": 1, "to": 5, "steps": 3},
        "uniform_chain.kind": {"values": ["rods", "plummets"]},
    }
    found = rc.sweep({"scene": scene, "vary": vary})
    assert (
        found["uniform_chain.count"].tolist() == [1, 1, 3, 3, 5, 5] and found["uniform_chain.count"].dtype.kind == "i"
    )
    assert found["uniform_chain.kind"].tolist() == ["rods", "plummets"] * 3
    assert np.isfinite(found["conical_height"]).sum(axis=1).tolist() == [1, 1, 3, 3, 5, 5]
    assert (
        found["conical_height"][3, :3].tobytes()
        == rc.modes(rc.Chain.uniform_plummets(3, 1.0, 9.80665)).conical_height.tobytes()
    )


def test_order_of_the_points():
    vary = {
        "links[0].length": {"values": [1, 2, 3]},
        "gravity": {"values": [5.0, 10.0]},
        "links[0].mass": {"uniform": [1, 2]},
    }
    found = rc.sweep(study(PLUMMETS, vary, samples=2))
    expected = [(a, g) for a, g, _ in itertools.product([1, 2, 3], [5, 10], range(2))]
    assert list(zip(found["links[0].length"], found["gravity"], strict=True)) == expected
    assert np.unique(found["links[0].mass"]).size == 12
    assert found.shape == (3, 2, 2)
    for point in range(12):
        scene = found.study.scene_at(point)
        assert scene.links[0].mass == found["links[0].mass"][point] and scene.gravity == found["gravity"][point]
        assert scene.links[1] == found.study.scene.links[1]
    for outside in (-1, 12):
        with pytest.raises(IndexError, match="12 points"):
            found.study.scene_at(outside)


def test_random_numbers_belong_to_their_points():
    vary = {
        "links[0].mass": {"uniform": [1, 2]},
        "links[0].length": {"log_uniform": [0.01, 100]},
        "links[1].mass": {"normal": [5, 0.1]},
    }
    many = rc.sweep(study(PLUMMETS, vary, samples=40_000, seed=3))
    few = rc.sweep(study(PLUMMETS, vary, samples=100, seed=3))
    alone = rc.sweep(study(PLUMMETS, {"links[1].mass": vary["links[1].mass"]}, samples=100, seed=3))
    for name in vary:
        assert few[name].tobytes() == many[name][:100].tobytes()
        assert np.unique(many[name]).size == 40_000
    assert alone["links[1].mass"].tobytes() == few["links[1].mass"].tobytes()
    assert not np.any(rc.sweep(study(PLUMMETS, vary, samples=100, seed=4))["links[0].mass"] == few["links[0].mass"])
    uniform, logs, normal = (
        many["links[0].mass"] - 1,
        np.log10(many["links[0].length"]),
        (many["links[1].mass"] - 5) / 0.1,
    )
    shares = [uniform, (logs + 2) / 4, [0.5 * math.erfc(-x / math.sqrt(2)) for x in normal]]
    for share in shares:  # Kolmogorov-Smirnov, 1 in 1e5
        gap = np.abs(np.sort(share) - (np.arange(40_000) + 0.5) / 40_000).max()
        assert gap < 2.5 / math.sqrt(40_000)
    assert np.abs(np.corrcoef([uniform, logs, normal]) - np.eye(3)).max() < 0.025


# ---- whoever computes


MIXED = {
    "batches": (BODIES, {"links[0].mass": {"normal": [0.5, 0.2]}, "gravity": {"values": [1.0, 10.0]}}, 9000),
    "one by one": (GYROSTAT, {"support.stiffness": {"uniform": [1.0, 300.0]}}, 60),
}


@pytest.mark.parametrize(("scene", "vary", "samples"), MIXED.values(), ids=MIXED.keys())
def test_threads_chunks_and_executors_change_nothing(scene, vary, samples):
    given = study(scene, vary, samples=samples)
    first = rc.sweep(given, threads=1)
    same(first, rc.sweep(given, threads=3, chunk=17))
    same(first, rc.sweep(given, chunk=given.points))
    with ThreadPoolExecutor(2) as threads, ProcessPoolExecutor(2) as processes:
        same(first, rc.sweep(given, executor=threads))
        same(first, rc.sweep(given, executor=processes, chunk=1000))


def test_a_dask_cluster_of_two_workers_changes_nothing():
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        for scene, vary, samples in MIXED.values():
            given = study(scene, vary, samples=samples)
            same(rc.sweep(given), rc.sweep(given, executor=client.get_executor(), chunk=given.points // 7))
        code = _cli.run(["new", "--study", "a.toml"])
        assert code == 0 and _cli.run(["sweep", "a.toml", "--dask", cluster.scheduler_address, "-q"]) == 0
    assert len(Path("a.csv").read_text().splitlines()) == 1 + 21 * 3


def test_begun_by_threads_and_ended_by_a_dask_cluster():
    distributed = pytest.importorskip("distributed")
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None}
    with distributed.LocalCluster(**options) as cluster, distributed.Client(cluster) as client:
        for scene, vary, samples in MIXED.values():
            given = study(scene, vary, samples=samples)
            for first, second in (({}, {"executor": client.get_executor()}), ({"executor": client.get_executor()}, {})):
                with pytest.raises(Ended):
                    rc.sweep(given, out="a.csv", chunk=samples // 9, progress=ended_after(samples // 3), **first)
                there = sum(stop - start for start, stop in kept())
                assert samples // 3 <= there < given.points
                found = rc.sweep(given, out="a.csv", **second)
                assert found.resumed == there
                same(found, rc.sweep(given))


def test_what_is_refused_of_the_call():
    given = study(PLUMMETS, {"gravity": {"values": [1.0]}})
    with ThreadPoolExecutor(1) as pool, pytest.raises(ValueError, match="threads does not go with executor"):
        rc.sweep(given, executor=pool, threads=2)
    for wrong in ({"threads": 0}, {"chunk": 0}, {"chunk": 1.5}, {"out": "a.txt"}, {"out": "a"}):
        with pytest.raises(ValueError):
            rc.sweep(given, **wrong)
    with pytest.raises(OSError, match="is no file"):
        Path("a.csv").mkdir()
        rc.sweep(given, out="a.csv")
    with pytest.raises(OSError):
        rc.sweep(given, out="/proc/a.csv")
    assert [name for name in files() if "partial" in name] == []


def test_points_that_are_refused_have_no_numbers():
    vary = {"links[0].mass": {"normal": [0.01, 0.1]}, "links[1].length": {"uniform": [0.1, 0.2]}}
    for bounds in (False, True):
        found = rc.sweep(study(PLUMMETS, vary, samples=200, error_bounds=bounds))
        negative = found["links[0].mass"] <= 0
        assert 0 < negative.sum() < 200
        assert ((found.status == "refused") == negative).all()
        assert (np.isnan(found["conical_height"]).all(axis=1) == negative).all()
        assert (np.isnan(found["angular_speed"]).all(axis=1) == negative).all()
        assert found.count("refused") == negative.sum()
        first = min(found.refused)
        assert negative[first] and found.refused[first].startswith("links[0]")
    with pytest.raises(ValueError, match="status must be"):
        found.count("nothing")
    with pytest.raises(KeyError, match="there is no 'nothing'"):
        found["nothing"]


# ---- files


def test_files_hold_every_bit():
    for package in ("pyarrow", "xarray", "h5netcdf"):
        pytest.importorskip(package)
    given = study(
        BODIES, {"gravity": {"values": [1.0, 9.81]}, "links[0].mass": {"uniform": [1, 2], "name": "bob"}}, samples=50
    )
    found = rc.sweep(given, out="a.csv")
    same(found, rc.sweep(given, out="a.parquet"))
    same(found, rc.sweep(given, out="a.nc"))
    assert files() == ["a.csv", "a.nc", "a.parquet"]
    columns = found.columns()
    with open("a.csv") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == list(columns)
    for name, column in columns.items():
        assert np.array([row[name] for row in rows]).astype(column.dtype).tolist() == column.tolist()


def test_tables_and_labelled_arrays():
    pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    xarray = pytest.importorskip("xarray")
    import pandas

    given = study(
        BODIES,
        {"gravity": {"values": [1.0, 9.81]}, "links[0].mass": {"uniform": [1, 2], "name": "bob"}},
        samples=50,
        title="t",
    )
    found = rc.sweep(given, out="a.parquet")
    frame = found.to_dataframe()
    pandas.testing.assert_frame_equal(pandas.read_parquet("a.parquet"), frame)
    assert frame["bob"].to_numpy().tobytes() == found["bob"].tobytes() and list(frame["status"].unique()) == ["success"]
    found.save("a.nc")
    with xarray.open_dataset("a.nc", engine="h5netcdf") as read:
        assert dict(read.sizes) == {"gravity": 2, "sample": 50, "mode": 4}
        assert read["conical_height"].to_numpy().tobytes() == found["conical_height"].tobytes()
        at = read.sel(gravity=9.81)["angular_speed"].isel(sample=3).to_numpy()
        assert at.tobytes() == found["angular_speed"][53].tobytes()
        assert Study.from_dict(json.loads(read.attrs["study"])) == given
        assert read["bob"].attrs["path"] == "links[0].mass" and read.attrs["title"] == "t"


STREAMED = {
    "rig": (GYROSTAT, {"support.stiffness": {"uniform": [1.0, 300.0]}, "gravity": {"values": [1.0, 9.8]}}, {"samples": 5}),
    "words": (
        {"uniform_chain": {"kind": "rods", "count": 3, "length": 1.0, "mass": 1.0}},
        {"uniform_chain.count": {"from": 1, "to": 5, "steps": 3}, "uniform_chain.kind": {"values": ["rods", "plummets"]}},
        {},
    ),
    "refused": (PLUMMETS, {"links[0].mass": {"normal": [0.01, 0.1]}}, {"samples": 40}),
    "yes and no": (
        {"links": [{"mass": 1.0, "length": 0.5, "clamped": False}] * 2, "support": {"stiffness": 10.0}},
        {"links[0].clamped": {"values": [True, False]}},
        {},
    ),
}  # fmt: skip


@pytest.mark.parametrize(("scene", "vary", "more"), STREAMED.values(), ids=STREAMED.keys())
@pytest.mark.parametrize("chunk", [None, 3])
def test_files_are_the_same_in_whatever_pieces(scene, vary, more, chunk, monkeypatch):
    for package in ("pyarrow", "pandas", "h5netcdf"):
        pytest.importorskip(package)
    xarray = pytest.importorskip("xarray")
    import pandas
    import pyarrow.parquet

    monkeypatch.setattr("revchain.studies.keep.ROWS", 7)
    monkeypatch.setattr("revchain.studies.output._LINES", 3)
    given = study(scene, vary, **more)
    found = rc.sweep(given, out="a.nc", chunk=chunk)
    with xarray.open_dataset("a.nc", engine="h5netcdf") as read:
        xarray.testing.assert_identical(read.load(), found.to_xarray())
    found.to_xarray().to_netcdf("b.nc", engine="h5netcdf")  # as xarray itself would write it
    with xarray.open_dataset("a.nc", engine="h5netcdf") as one, xarray.open_dataset("b.nc", engine="h5netcdf") as two:
        for name in two.variables:
            assert one[name].dtype == two[name].dtype and one[name].dims == two[name].dims
            fills = [str(each[name].encoding.get("_FillValue")) for each in (one, two)]
            assert fills[0] == fills[1] or one[name].dtype.kind == "O"
    rc.sweep(given, out="a.parquet", chunk=chunk)
    frame = pandas.read_parquet("a.parquet")
    pandas.testing.assert_frame_equal(frame, found.to_dataframe())
    groups = pyarrow.parquet.ParquetFile("a.parquet").metadata
    rows = [groups.row_group(k).num_rows for k in range(groups.num_row_groups)]
    assert rows[:-1] == [7] * (len(rows) - 1) and 0 < rows[-1] <= 7  # whatever the chunk
    rc.sweep(given, out="a.csv", chunk=chunk)
    found.save("b.csv")
    assert Path("a.csv").read_bytes() == Path("b.csv").read_bytes()
    with open("a.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for name, column in found.columns().items():
        texts = [row[name] for row in rows]
        if column.dtype.kind == "f":
            numbers = np.array([float(text) for text in texts])
            assert (np.isnan(numbers) == np.isnan(column)).all()
            assert numbers[~np.isnan(numbers)].tobytes() == column[~np.isnan(column)].tobytes()
        else:
            assert texts == [str(value) for value in column.tolist()]


def test_numbers_of_all_sizes_read_back_from_text():
    from revchain.studies.output import _lines

    bits = np.random.default_rng(1).integers(0, 2**64 - 1, 20_000, dtype=np.uint64, endpoint=True)
    special = [
        0.0,
        -0.0,
        5e-324,
        -5e-324,
        2.2250738585072014e-308,
        1.7976931348623157e308,
        math.inf,
        -math.inf,
        1e22,
        0.1,
    ]
    numbers = np.concatenate([bits.view(np.float64), special])
    lines = _lines({"a": numbers, "b": np.arange(numbers.size), "status": np.zeros(numbers.size, np.uint8)})
    assert lines.endswith(b",success\n")
    rows = [line.split(",") for line in lines.decode().splitlines()]
    there = np.isfinite(numbers) | np.isinf(numbers)
    read = np.array([float(row[0]) for row in rows])
    assert read[there].tobytes() == numbers[there].tobytes() and np.isnan(read[~there]).all()
    assert [int(row[1]) for row in rows] == list(range(numbers.size))


def test_grids_by_their_definition():
    """In whatever stretches, the numbers of a grid are those that counting through it gives."""
    vary = {
        "links[0].mass": {"values": [1.0, 2.0, 3.0]},
        "gravity": {"values": [5.0]},
        "links[0].length": {"from": 1, "to": 7, "steps": 7},
        "links[1].length": {"values": [0.1, 0.2]},
        "links[1].mass": {"uniform": [1, 2]},
    }
    plan = study(PLUMMETS, vary, samples=3)._plan("")
    axes = [axis.values.tolist() for axis in plan.axes[:4]]
    expected = [values[:4] for values in itertools.product(*axes, range(3))]
    drawn = plan.values(0, plan.points)[4]
    chance = random.Random(1)
    for _ in range(300):
        start = chance.randrange(plan.points)
        stop = min(start + chance.choice([1, 2, 5, 17, 126]), plan.points)
        *grids, numbers = plan.values(start, stop)
        assert list(zip(*(grid.tolist() for grid in grids), strict=True)) == expected[start:stop]
        assert numbers.tobytes() == drawn[start:stop].tobytes()


def test_random_numbers_across_their_blocks():
    plan = study(PLUMMETS, {"links[0].mass": {"log_uniform": [1, 2]}}, samples=200_000)._plan("")
    (whole,) = plan.values(0, plan.points)
    reader, chance, start = plan.reader(), random.Random(1), 0
    while start < plan.points:
        stop = min(start + chance.choice([1, 1000, 65536, 70000, 65536 - start % 65536]), plan.points)
        assert reader.at(start, stop)[0].tobytes() == whole[start:stop].tobytes()
        start = stop
    for start in (65535, 65536, 5, 131072, 131073, 0):  # back and forth
        assert reader.at(start, start + 3)[0].tobytes() == whole[start : start + 3].tobytes()
    assert np.unique(whole).size > 199_990


def test_results_of_a_file_need_no_memory_of_their_own():
    """Peak of what Python allocates: a piece of the results, not all 40 MB of them."""
    given = study(PLUMMETS, {"links[0].mass": {"uniform": [1, 2]}}, samples=1_000_000)
    rc.sweep(study(PLUMMETS, {"gravity": {"values": [1.0]}}), out="a.nc")
    for name in ("a.nc", "a.csv"):
        if name == "a.csv":
            given = study(PLUMMETS, {"links[0].mass": {"uniform": [1, 2]}}, samples=300_000)
        tracemalloc.start()
        found = rc.sweep(given, out=name, threads=1)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < 30e6, name
        assert np.isfinite(found["conical_height"]).all() and files().count(name) == 1


# ---- runs that were ended


class Ended(Exception):
    pass


def ended_after(points):
    def told(done, _):
        if done >= points:
            raise Ended

    return told


LARGE = (GYROSTAT, {"support.stiffness": {"uniform": [1.0, 300.0]}})


def kept(folder="a.csv.partial"):
    """The records of a journal: beginnings and ends of stretches, as they lie there."""
    try:
        data = Path(folder, "index").read_bytes()
    except FileNotFoundError:  # not yet, or no longer: the output stands
        data = b""
    return [struct.unpack_from("<QQ", data, place) for place in range(0, len(data) - 23, 24)]


def test_a_run_goes_on_where_it_was():
    given = study(*LARGE, samples=100)
    with pytest.raises(Ended):
        rc.sweep(given, out="a.csv", chunk=10, progress=ended_after(40))
    assert files() == ["a.csv.partial"] and len(kept()) >= 4
    assert sorted(os.listdir("a.csv.partial")) == ["index", "points", "study.json"]
    there, seen = 10 * len(kept()), []
    found = rc.sweep(given, out="a.csv", chunk=7, threads=1, progress=lambda done, total: seen.append((done, total)))
    assert found.resumed == there == seen[0][0] and seen[-1] == (100, 100)
    same(found, rc.sweep(given))
    assert files() == ["a.csv"]
    assert len(Path("a.csv").read_text().splitlines()) == 101


@pytest.fixture
def ended():
    """A study of 60 points in six stretches, all of them kept, and its journal's folder."""
    given = study(*LARGE, samples=60)
    with pytest.raises(Ended):
        rc.sweep(given, out="a.csv", chunk=10, threads=1, progress=ended_after(60))
    folder = Path("a.csv.partial")
    assert sorted(kept()) == [(k, k + 10) for k in range(0, 60, 10)]
    return given, folder, {name: (folder / name).read_bytes() for name in ("points", "index")}


def goes_on(given, whole):
    """A run that finds so many points that are whole; its numbers are those of one that was never ended."""
    found = rc.sweep(given, out="a.csv")
    assert found.resumed == whole
    same(found, rc.sweep(given))
    assert files() == ["a.csv"]
    return found


def test_what_is_damaged_is_computed_again(ended):
    given, folder, data = ended
    plan = given._plan("")
    stiffness = next(block for block in plan.stored if block.kind == "f8")
    points, index = bytearray(data["points"]), bytearray(data["index"])
    points[10 * stiffness.each[0] * 8 + 3] ^= 1  # a bit of the second stretch, in its numbers
    points[-4096 + 25] ^= 1  # and of the third, in its status
    index[3 * 24 + 2] ^= 1  # the fourth said to be elsewhere
    index[4 * 24 + 17] ^= 1  # the checksum of the fifth
    (folder / "points").write_bytes(points)
    (folder / "index").write_bytes(bytes(index) + data["index"][:24])  # and the first said twice
    (folder / ".output.writing.csv").write_bytes(b"half")
    words = "a.csv.partial: 5 of 7 records of finished points are damaged; 20 points are kept, all others are computed"
    found = goes_on(given, 20)
    assert words in found.damage and words in repr(found)


def test_the_command_tells_of_damage(ended, run):
    given, folder, data = ended
    Path("a.json").write_text(json.dumps(given.to_dict()))
    (folder / "index").write_bytes(b"x" + data["index"][1:])
    _, _, err = run("sweep", "a.json", "--out", "a.csv")
    assert err.splitlines()[0].startswith("revchain: warning: ") and "1 of 6 records of finished points" in err


def test_a_missing_index_is_told(ended):
    given, folder, _ = ended
    (folder / "index").unlink()
    assert "index is missing" in goes_on(given, 0).damage


@pytest.mark.parametrize("text", [b"", b"{", b"[]", b"{}", b"\xff", b"[" * 10**5])
def test_a_damaged_head_is_told(ended, text):
    given, folder, _ = ended
    (folder / "study.json").write_bytes(text)
    with pytest.raises(OSError, match="study.json is damaged"):
        rc.sweep(given, out="a.csv")


@pytest.mark.parametrize("name", ["points", "index", "study.json", ".study.json.writing", ".output.writing.csv"])
@pytest.mark.parametrize("begun", [False, True])
def test_symbolic_links_in_the_folder_are_not_followed(ended, name, begun):
    given, folder, _ = ended
    Path("mine.txt").write_text("mine")
    if not begun:
        for path in folder.iterdir():
            path.unlink()
    (folder / name).unlink(missing_ok=True)
    (folder / name).symlink_to(Path("mine.txt").resolve())
    with pytest.raises(OSError, match=f"{re.escape(name)} is a symbolic link; remove it"):
        rc.sweep(given, out="a.csv")
    assert Path("mine.txt").read_text() == "mine"


def test_a_journal_cut_anywhere_gives_what_is_whole(ended):
    given, folder, data = ended
    plan = given._plan("")
    for length in [*range(0, 49), 100, 143, 144]:
        (folder / "index").write_bytes(data["index"][:length])
        with Journal("a.csv", plan) as journal:
            assert journal.kept == kept() == [(k, k + 10) for k in range(0, length // 24 * 10, 10)]
            assert (folder / "index").stat().st_size == length // 24 * 24
        for name in data:  # where nothing was whole the folder is gone
            folder.mkdir(exist_ok=True)
            (folder / name).write_bytes(data[name])
        if length < 24:
            (folder / "study.json").write_text(json.dumps({"fingerprint": plan.fingerprint(), "points": 60}))

    def survives(stretch, cut):
        """Whether all numbers of a stretch are as they were; what is beyond the end reads as zeros."""
        for place, kind, each in journal._layout.values():
            row = kind.itemsize * math.prod(each)
            piece = slice(place + stretch[0] * row, place + stretch[1] * row)
            if cut[piece] != data["points"][piece]:
                return False
        return True

    counts, size = set(), len(data["points"])
    for length in [0, 1, *random.Random(1).sample(range(size), 30), size - 4096 + 35]:
        for name in data:
            (folder / name).write_bytes(data[name][:length] if name == "points" else data[name])
        (folder / "study.json").write_text(json.dumps({"fingerprint": plan.fingerprint(), "points": 60}))
        with Journal("a.csv", plan) as journal:
            cut = data["points"][:length] + bytes(size - length)
            assert journal.kept == [ends for ends in [(k, k + 10) for k in range(0, 60, 10)] if survives(ends, cut)]
            counts.add(len(journal.kept))
        folder.mkdir(exist_ok=True)
    assert len(counts) >= 3 and min(counts) == 0
    for name in data:
        (folder / name).write_bytes(data[name])
    (folder / "study.json").write_text(json.dumps({"fingerprint": plan.fingerprint(), "points": 60}))
    (folder / "index").write_bytes(data["index"][:100])
    assert goes_on(given, 40).damage == ""  # as a kill leaves it


def test_a_folder_of_something_else_is_left_alone():
    given = study(PLUMMETS, {"gravity": {"values": [1.0]}})
    Path("a.csv.partial").mkdir()
    Path("a.csv.partial/mine.txt").write_text("mine")
    with pytest.raises(OSError, match="a.csv.partial holds other files; remove it or write elsewhere"):
        rc.sweep(given, out="a.csv")
    assert Path("a.csv.partial/mine.txt").read_text() == "mine"
    Path("b.csv.partial").write_text("mine")
    with pytest.raises(OSError, match="b.csv.partial is no folder"):
        rc.sweep(given, out="b.csv")
    assert Path("b.csv.partial").read_text() == "mine"


def test_another_study_is_refused():
    given = study(*LARGE, samples=60)
    with pytest.raises(Ended):
        rc.sweep(given, out="a.csv", chunk=10, progress=ended_after(10))
    before = sorted((path.name, path.read_bytes()) for path in Path("a.csv.partial").iterdir())
    changed = {**LARGE[1]["support.stiffness"], "uniform": [1.0, 301.0]}
    others = [
        study(*LARGE, samples=61),
        study(*LARGE, samples=60, seed=1),
        study(*LARGE, samples=60, most_shapes=2),
        study(*LARGE, samples=60, find=["modes"]),
        study(LARGE[0], {"support.stiffness": changed}, samples=60),
        study({**LARGE[0], "gravity": 9.8}, LARGE[1], samples=60),
    ]
    for other in others:
        with pytest.raises(OSError, match="holds points of another study") as caught:
            rc.sweep(other, out="a.csv")
        assert isinstance(caught.value, ValueError)
    assert sorted((path.name, path.read_bytes()) for path in Path("a.csv.partial").iterdir()) == before
    with Journal("a.csv", given._plan("")), pytest.raises(OSError, match="another run is writing it"):
        rc.sweep(given, out="a.csv")
    assert rc.sweep(study(*LARGE, samples=60, title="only another title"), out="a.csv").resumed >= 10


SLOW = """
samples = 3000
error_bounds = true
[scene]
links = [{mass = 1, length = 0.1, repeat = 40}]
ask = {modes = 2}
[vary."links[0].mass"]
uniform = [1, 2]
"""


def test_killed_at_any_moment_nothing_is_lost_or_repeated(start):
    Path("a.toml").write_text(SLOW)
    command = (sys.executable, "-m", "revchain", "sweep", "a.toml", "--chunk", "5", "--workers", "2")
    partial, there, kills, chance = Path("a.csv.partial"), b"", 0, random.Random(2)
    for wanted in (1, 20, 60, 100, 150, 220, 300):
        process = start(*command)
        deadline = time.monotonic() + 30
        while len(kept()) < wanted and process.poll() is None:
            assert time.monotonic() < deadline
            time.sleep(0.001)
        time.sleep(chance.uniform(0, 0.02))
        process.send_signal(signal.SIGKILL)
        process.wait()
        if not partial.exists():
            break
        kills += 1
        assert not Path("a.csv").exists()
        now = (partial / "index").read_bytes()
        assert now[: len(there)] == there  # nothing is gone or written again
        there = now[: len(now) // 24 * 24]
    stretches = kept()
    assert kills >= 2 and len(set(stretches)) == len(stretches)
    process = start(*command, stdout=-1)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 0 and "3,000 points in" in out and f"{5 * len(stretches):,} of them from before" in out
    assert files() == ["a.csv", "a.toml"]
    written = Path("a.csv").read_bytes()
    rc.sweep("a.toml", out="b.csv")
    assert Path("b.csv").read_bytes() == written


MILLION = """
samples = 1_000_000
[scene]
links = [{mass = 1, length = 0.1}, {mass = 1, length = 0.1}]
ask = {modes = "all"}
[vary."links[0].mass"]
uniform = [1, 2]
"""


def test_a_million_points_killed_again_and_again(start):
    pytest.importorskip("h5netcdf")
    Path("a.toml").write_text(MILLION)
    command = (sys.executable, "-m", "revchain", "sweep", "a.toml", "--out", "a.nc", "-q")
    partial, chance = Path("a.nc.partial"), random.Random(3)
    for _ in range(8):
        process, before = start(*command), len(kept(partial))
        deadline = time.monotonic() + 30
        while len(kept(partial)) <= before and process.poll() is None:
            assert time.monotonic() < deadline
        time.sleep(chance.uniform(0, 0.03))
        process.send_signal(signal.SIGKILL)
        process.wait()
        if Path("a.nc").exists():
            break
    stretches = sorted(kept(partial))
    assert all(stop <= start for (_, stop), (start, _) in itertools.pairwise(stretches))
    if not Path("a.nc").exists():
        assert start(*command).wait(timeout=60) == 0
    rc.sweep("a.toml", out="b.nc", threads=1)
    assert Path("a.nc").read_bytes() == Path("b.nc").read_bytes()
    assert not partial.exists() or not Path("a.nc").exists() or stretches


def test_ctrl_c_ends_cleanly(start):
    Path("a.toml").write_text(SLOW.replace("3000", "300_000"))
    process = start(sys.executable, "-m", "revchain", "sweep", "a.toml", stdout=-1, stderr=-1)
    while not kept():
        assert process.poll() is None
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert (process.returncode, out) == (130, "")
    assert err == "revchain: interrupted; the same command goes on from a.csv.partial\n"
    assert files() == ["a.csv.partial", "a.toml"]


def test_no_file_of_half_the_points(monkeypatch):
    given = study(*LARGE, samples=20)
    Path("a.csv").write_text("before")

    def fails(writer, start, stop, pieces):
        writer._file.write(b"half")
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr("revchain.studies.output._Csv.add", fails)
        with pytest.raises(OSError, match="No space"):
            rc.sweep(given, out="a.csv")
    assert Path("a.csv").read_text() == "before" and files() == ["a.csv", "a.csv.partial"]
    assert rc.sweep(given, out="a.csv").resumed == 20
    assert files() == ["a.csv"] and len(Path("a.csv").read_text().splitlines()) == 21


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
    "unknown law": (varied("gravity", unifrm=[1, 2]), 'vary."gravity".unifrm: unknown key; did you mean uniform?'),
    "no law": (varied("gravity"), 'vary."gravity": give from, to and steps, or one of values'),
    "two laws": (varied("gravity", values=[1], uniform=[1, 2]), 'vary."gravity": give from, to and steps, or one of'),
    "no steps": (varied("gravity", **{"from": 1, "to": 2}), 'vary."gravity".steps: is missing'),
    "no from": (varied("gravity", to=2, steps=3), 'vary."gravity".from: is missing'),
    "no steps at all": (varied("gravity", **{"from": 1, "to": 2, "steps": 0}), 'vary."gravity".steps: must be at least 1, got 0'),
    "log of values": (varied("gravity", values=[1], log=True), 'vary."gravity".log: goes with from, to and steps'),
    "log of 0": (varied("gravity", **{"from": 0, "to": 2, "steps": 3, "log": True}), 'vary."gravity".log: needs from and to'),
    "no values": (varied("gravity", values=[]), 'vary."gravity".values: '),
    "nan": (varied("gravity", values=[math.nan]), 'vary."gravity".values[0]: must be finite, got nan'),
    "unit of another kind": (varied("links[0].mass", values=[1, "2 m"]), 'vary."links[0].mass".values[1]: must be a mass such as "2 kg", got "2 m"'),
    "truth for a number": (varied("gravity", values=[True]), 'vary."gravity".values[0]: must be a number, got True'),
    "a word for a number": (varied("gravity", values=["much"]), 'vary."gravity".values[0]: must be a number, or a number and its unit'),
    "ends the wrong way": ({**varied("gravity", uniform=[2, 1]), "samples": 3}, 'vary."gravity".uniform: its low end'),
    "three ends": ({**varied("gravity", uniform=[1, 2, 3]), "samples": 3}, 'vary."gravity".uniform: '),
    "negative deviation": ({**varied("gravity", normal=[2, -1]), "samples": 3}, 'vary."gravity".normal: its deviation'),
    "log of a negative number": ({**varied("gravity", log_uniform=[-2, 1]), "samples": 3}, 'vary."gravity".log_uniform: must be positive'),
    "random without samples": (varied("gravity", uniform=[1, 2]), "samples: is missing: say how many points"),
    "samples without random": ({"scene": ONE, "vary": GOOD, "samples": 3}, "samples: is for random numbers, and none are"),
    "samples 0": ({**varied("gravity", uniform=[1, 2]), "samples": 0}, "samples: must be at least 1, got 0"),
    "negative seed": ({"scene": ONE, "vary": GOOD, "seed": -1}, "seed: must not be negative, got -1"),
    "no path": (varied("links 0", values=[1]), 'vary."links 0": is no path into a scene such as links[0].mass'),
    "no such link": (varied("links[1].mass", values=[1]), 'vary."links[1].mass": the scene has nothing at [1]: there are 1'),
    "no such key": (varied("links[0].mas", values=[1]), 'vary."links[0].mas": unknown key; did you mean mass?'),
    "no such table": (varied("suport.mass", values=[1]), 'vary."suport.mass": suport: unknown key; did you mean support?'),
    "other of two": (varied("links[0].weight", values=[1]), 'vary."links[0].weight": links[0]: give either weight or mass'),
    "other kind of chain": (varied("uniform_chain.length", values=[1]), 'vary."uniform_chain.length": '),
    "a value refused": (varied("links[0].length", values=[1, -1]), 'vary."links[0].length": must be positive, got -1'),
    "a table": (varied("links[0]", values=[1]), 'vary."links[0]": '),
    "the title": (varied("title", values=["a"]), 'vary."title": is nothing to vary'),
    "what is asked": (varied("ask.modes", values=[1]), 'vary."ask.modes": what is asked is the same at all points'),
    "not whole": (varied("links[0].repeat", values=[1.5]), 'vary."links[0].repeat".values[0]: must be a whole number, got 1.5'),
    "steps not whole": (varied("links[0].repeat", **{"from": 1, "to": 2, "steps": 3}), 'vary."links[0].repeat".steps: makes numbers that are not whole'),
    "random count": ({**varied("links[0].repeat", uniform=[1, 2]), "samples": 3}, 'vary."links[0].repeat": takes no random numbers'),
    "an unknown word": (varied("links[0].kind", values=["rod", "bod"]), 'vary."links[0].kind": must be one of plummet, rod, got'),
    "the same twice": ({"scene": ONE, "vary": {"gravity": {"values": [1]}, "links[0].mass": {"values": [1], "name": "gravity"}}}, 'vary."links[0].mass".name: gravity is the name of another, too'),
    "name of a result": (varied("gravity", values=[1], name="conical_height"), 'vary."gravity".name: conical_height is the name of a result'),
    "name with a slash": (varied("gravity", values=[1], name="m/s"), 'vary."gravity".name: must be a printable name'),
    "find nothing": ({"scene": ONE, "vary": GOOD, "find": []}, "find: "),
    "find what is not there": ({"scene": ONE, "vary": GOOD, "find": ["all"]}, "find[0]: must be one of modes, shapes, response"),
    "shapes at no speed": ({"scene": ONE, "vary": GOOD, "find": ["shapes"]}, "find[0]: the scene does not say at which speed"),
    "window": ({"scene": {**ONE, "ask": {"conical_height": [0, 1]}}, "vary": GOOD}, "scene.ask.conical_height: finds not as many"),
    "swing": ({"scene": {**ONE, "ask": {"swing": {"offset": [0.1]}}}, "vary": GOOD}, "scene.ask.swing: is not for studies"),
    "slack": ({"scene": {"links": [{"mass": 1, "length": 1}] * 3, "held": {"span": 2}}, "vary": GOOD}, "scene.held.span: leaves the chain slack"),
    "too many": ({"scene": ONE, "vary": {"gravity": {"from": 1, "to": 2, "steps": 10**7}, "links[0].mass": {"from": 1, "to": 2, "steps": 10**6}}}, "vary: makes 10,000,000,000,000 points"),
    "another version": ({"scene": ONE, "vary": GOOD, "schema_version": 2}, "schema_version: must be 1, got 2"),
}  # fmt: skip


@pytest.mark.parametrize(("data", "message"), BAD.values(), ids=BAD.keys())
def test_errors_name_the_key(data, message):
    with pytest.raises(rc.SceneError) as caught:
        Study.from_dict(data, source="my.toml")
    assert str(caught.value).startswith(f"my.toml: {message}")
    assert "\n" not in str(caught.value)


def test_errors_of_files():
    Path("a.toml").write_text('scene = "b.toml"\n[vary.gravity]\nvalues = [1]\n')
    with pytest.raises(rc.SceneError, match=r"b.toml: cannot be read: No such file"):
        rc.load_study("a.toml")
    Path("b.toml").write_text("[[links]]\nmass = 1\n")
    with pytest.raises(rc.SceneError, match=r"b.toml: links\[0\].length: is missing"):
        rc.load_study("a.toml")
    Path("b.toml").write_text("[[links]]\nmass = 1\nlength = 2\n")
    assert rc.load_study("a.toml").points == 1
    Path("deep").mkdir()
    Path("deep/a.json").write_text('{"scene": "../b.toml", "vary": {"gravity": {"values": [1, 2]}}}')
    assert rc.load_study("deep/a.json").points == 2
    Path("a.toml").write_text("x = ")
    with pytest.raises(rc.SceneError, match=r"a.toml: line 1, column 5"):
        rc.load_study("a.toml")


def test_round_trip():
    data = {
        "scene": BODIES,
        "vary": {"links[0].mass": {"from": "1 g", "to": 2.0, "steps": 3}, "gravity": {"normal": [9.8, 0.1]}},
        "samples": 2,
    }
    given = Study.from_dict(data)
    assert given.to_dict() == data and Study.from_dict(given.to_dict()) == given


def test_the_schema(repository):
    schema = study_schema()
    text = json.dumps(schema, indent=2) + "\n"
    for folder in (Path(rc.__file__).parent, repository / "src/revchain"):
        shipped = (folder / "studies" / "study.schema.json").read_text(encoding="utf-8")
        assert shipped == text, "revchain schema --study > src/revchain/studies/study.schema.json"
    assert set(schema["$defs"]) == {"Study", "Vary", *json_schema()["$defs"]}
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
    code, out, err = run("sweep", "study.toml", "--plot", "a.png")
    assert (code, err) == (0, "") and out.startswith("wrote study.csv: 63 points in ") and out.endswith("wrote a.png\n")
    assert files() == ["a.png", "study.csv", "study.toml"]
    assert json.loads(run("schema", "--study")[1]) == study_schema()


def test_how_the_command_ends(run):
    def toml(vary, more=""):
        Path("a.toml").write_text(
            f'{more}\nscene = {{links = [{{mass = 1, length = 1}}]}}\n[vary."links[0].mass"]\n{vary}\n'
        )

    toml("values = [-1]")
    assert run("sweep", "a.toml") == (3, "", 'revchain: a.toml: vary."links[0].mass": must not be negative, got -1.0\n')
    toml("values = [1]")
    assert run("sweep", "a.toml", "--out", "a.txt")[0] == 2
    assert run("sweep", "a.toml", "--out", "a.toml")[0] == 2
    assert run("sweep", "a.toml", "--plot", "a.gif")[0] == 2
    assert run("sweep", "a.toml", "--out", "/proc/a.csv")[0] == 4
    toml('values = [1]\n[vary.gravity]\nvalues = [1]\n[vary."links[0].length"]\nvalues = [1]')
    message = "revchain: --plot: draws one or two numbers, or random ones only, and 3 vary: links[0].mass, gravity, links[0].length\n"
    assert run("sweep", "a.toml", "--plot", "a.png") == (2, "", message)
    toml("values = [1]")
    assert run("sweep", "a.toml", "--dask", "tcp://127.0.0.1:1", "--workers", "2")[0] == 2
    assert files() == ["a.toml"]
    toml("normal = [0.1, 1]", "samples = 8")
    code, out, err = run("sweep", "a.toml")
    assert code == 1 and "8 points" in out
    lines = err.splitlines()
    assert lines[0].endswith("points are refused") and lines[1].startswith("  point ") and "links[0]" in lines[1]


def test_pictures():
    one = rc.sweep(study(BODIES, {"links[0].mass": {"from": 0.1, "to": 10, "steps": 9, "log": True}}))
    ax = one.plot()
    assert (ax.get_xscale(), len(ax.lines), ax.get_ylabel()) == ("log", 4, "angular speed")
    two = rc.sweep(study(BODIES, {"links[0].mass": {"values": [1, 2, 3]}, "gravity": {"values": [1, 2]}}))
    assert len(two.plot("conical_height").collections) == 1
    law = {"normal": [1.0, 0.1], "name": "$% a $"}
    random_ones = {"links[0].mass": law, "links[0].length": {"uniform": [1, 2]}, "gravity": {"uniform": [1, 2]}}
    scattered = rc.sweep(study(BODIES, random_ones, samples=500))
    ax = scattered.plot("conical_height")
    assert ax.get_xlabel() == "conical height, % from its mean" and len(ax.get_legend().get_texts()) == 4
    heights, edges = (ax.patches[0].get_xy()[:, k] for k in (1, 0))
    assert np.sum(heights[1:-1:2] * np.diff(edges[1:-1:2], append=edges[-1])) == pytest.approx(1.0, rel=0.2)
    rc.sweep(study(BODIES, {"links[0].mass": law}, samples=9)).plot().figure.savefig("a.png")
    words = rc.sweep(study(BODIES, {"links[1].kind": {"values": ["rod", "plummet"]}}))
    with pytest.raises(ValueError, match="not words"):
        words.plot()
    with pytest.raises(ValueError, match="name must be one of"):
        one.plot("nothing")


def test_missing_packages_are_named(python, without):
    Path("a.toml").write_text("scene = {links = [{mass = 1, length = 1}]}\nvary.gravity.values = [1]\n")
    blocked = ("pandas", "pyarrow", "xarray", "h5netcdf", "dask", "distributed")
    program = without(*blocked) + (
        "import revchain as rc\n"
        "found = rc.sweep('a.toml', out='a.csv')\n"
        "for attempt in (found.to_dataframe, found.to_xarray, lambda: found.save('a.parquet'), lambda: found.save('a.nc')):\n"
        "    try: attempt()\n"
        "    except ImportError as error: print(error)\n"
        "from revchain.cli import app as _cli\n"
        "print(_cli.run(['sweep', 'a.toml', '--dask', 'local']))\n"
    )
    done = python("-c", program)
    lines = done.stdout.splitlines()
    assert len(lines) == 5 and all(line.endswith('pip install "revchain[sweep]"') for line in lines[:4]), done.stderr
    assert lines[4] == "2" and 'revchain: --dask needs distributed: pip install "revchain[sweep]"' in done.stderr


def test_the_page_and_its_examples(python, repository, run):
    pytest.importorskip("xarray")
    page = (repository / "docs/studies.md").read_text(encoding="utf-8")
    done = python(repository / "examples/python/draw_studies.py")
    numbers, _, last = done.stdout.removesuffix("\n").rpartition("\n")
    assert last == "wrote studies.png" and f"\n```text\n{numbers}\n```\n" in page, done.stderr
    assert Path("studies.png").stat().st_size < 60_000 and (repository / "docs/figures/studies.png").is_file()
    for path in (repository / "examples/studies").glob("*.toml"):
        assert run("sweep", path, "--check")[0] == 0
        assert why_not_drawn(rc.load_study(path)._plan("")) == ""
    assert run("sweep", repository / "examples/studies/crane_scatter.toml", "--plot", "crane.png")[0] == 0
    for name in (
        *(name for name in Vary.__struct_fields__ if name not in ("first", "last")),
        "samples",
        "seed",
        "find",
    ):
        assert name in page


def test_threads_end_with_the_call():
    before = threading.active_count()
    rc.sweep(study(PLUMMETS, GOOD))
    with pytest.raises(Ended):
        rc.sweep(study(*LARGE, samples=500), progress=ended_after(1))
    assert threading.active_count() == before and not os.path.exists("a.csv")
