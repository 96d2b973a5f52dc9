# SPDX-License-Identifier: GPL-3.0-or-later
"""Results for spreadsheets and other programs: workbooks, a column for each pin, the system in numbers."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import openpyxl
import pytest
import tier

import revchain as rc
from revchain.cli import ExitCode
from revchain.results import excel
from revchain.results.parts import parts_of
from revchain.results.sheet import Column, Sheet, in_columns

SCENES = Path(__file__).resolve().parents[2] / "examples" / "scenes"
LONG = "anchor_chain"  # 10,001 columns
EXAMPLES = [pytest.param(path, marks=[pytest.mark.slow] * (path.stem == LONG), id=path.stem) for path in sorted(SCENES.glob("*.toml"))]
CRANE = rc.Chain(mass=[2500.0, 400.0], length=[6.0, 24.0], names=["load", "hook block"])
CORD = rc.Cord(1.0, mass=0.5, masses={0.4: 0.1}, tip_mass=0.2)
RNG = np.random.default_rng(47)


def sheets(path):
    book = openpyxl.load_workbook(path)
    return {sheet.title: [list(row) for row in sheet.iter_rows(values_only=True)] for sheet in book}


def near(cell, number):
    """A workbook holds 16 digits."""
    return (cell is None and math.isnan(number)) or cell == number or math.isclose(cell, number, rel_tol=1e-15)


# ---- the system in numbers


@pytest.mark.parametrize("path", EXAMPLES)
def test_every_answer_holds_its_system(path, tmp_path, run):
    """In `to_dict`, in JSON of the command line and in the attributes of xarray; `from_dict` makes the same system."""
    scene = rc.load_scene(path)
    system = scene.system()
    assert run("run", path, "--out", tmp_path, "--quiet")[0] in (0, 1)
    for question, found in scene.answers().items():
        written = json.loads((tmp_path / f"{question}.json").read_text(encoding="utf-8"))
        assert written["description"] == system.describe()
        if isinstance(system, rc.SleeveGovernor):
            assert written["system"].pop("system") == "SleeveGovernor" and rc.SleeveGovernor(**written["system"]) == system
            continue
        kind = type(system)
        assert kind.from_dict(found.to_dict()["system"]) == system == kind.from_dict(written["system"])
        if system.size <= 1000:
            assert kind.from_dict(json.loads(found.to_xarray().attrs["system"])) == system
            assert kind.from_dict(found.to_dataframe().attrs["system"]) == system


@pytest.mark.parametrize("ending", [".npz", ".nc"])
@pytest.mark.parametrize("system", [CRANE, CORD, rc.Rig(CRANE, support=rc.Support(radius=3.0))], ids=["chain", "cord", "rig"])
def test_saved_files_hold_the_system(system, ending, tmp_path):
    found = rc.modes(system, 2)
    found.save(tmp_path / f"a{ending}")
    loaded = rc.load(tmp_path / f"a{ending}")
    assert loaded == found and loaded.system == system
    assert type(system).from_dict(loaded.to_dict()["system"]) == system


def test_a_large_system_goes_into_attributes(tmp_path):
    """More than the 64 kB of an ordinary attribute of HDF5."""
    xarray = pytest.importorskip("xarray")
    chain = rc.Chain(mass=RNG.uniform(1, 2, 8000), length=1.0)
    rc.modes(chain, 1).to_xarray().to_netcdf(tmp_path / "a.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "a.nc", engine="h5netcdf") as dataset:
        assert len(dataset.attrs["system"]) > 65536 and rc.Chain.from_dict(json.loads(dataset.attrs["system"])) == chain


def test_random_systems_come_back():
    for _ in range(tier.by_tier(20, 300)):
        size = int(RNG.integers(1, 13))
        chain = rc.Chain(mass=10 ** RNG.uniform(-8, 8, size), length=10 ** RNG.uniform(-1, 1, size), names=[f"n {k}" for k in range(size)])
        found = rc.modes(chain, 1)
        assert rc.Chain.from_dict(json.loads(json.dumps(found.to_dict()))["system"]) == chain


# ---- a column for each pin


def test_response_has_a_column_for_each_pin(tmp_path, run):
    path = tmp_path / "a.toml"
    path.write_text(SCENES.joinpath("crane_hook_block.toml").read_text() + '[ask.response]\nangular_speed = {from = 0.2, to = 3, steps = 7}\nsupport_radius = 0.01\n')
    assert run("response", path, "--csv", tmp_path / "a.csv", "--quiet")[0] == 0
    found = rc.load_scene(path).response()
    rows = list(csv.DictReader((tmp_path / "a.csv").read_text().splitlines()))
    for k, name in enumerate(("offset_free_end_of_load", "offset_pin_1_below_hook_block", "offset_support")):
        assert [float(row[name]) for row in rows] == found.offset[:, k].tolist()
    assert all(len(value.split()) == 1 for row in rows for value in row.values())
    some = rc.response(CRANE, angular_speed=[1.0, 2.0], support_radius=0.01, pins=[1])
    (column,) = [column for column in in_columns(some._full()) if column.name.startswith("offset_")]
    assert column.name == "offset_pin_1_below_hook_block" and column.values.tolist() == some.offset[:, 0].tolist()


def test_with_dashpots_parts_have_columns_of_their_own():
    damped = rc.Rig(CRANE, pins=rc.Pin(damping=[0.0, 2e4]))
    found = rc.response(damped, angular_speed=[1.0, 2.0], support_radius=0.01)
    columns = {column.name: column.values for column in in_columns(found._full())}
    for k, name in enumerate(("free_end_of_load", "pin_1_below_hook_block", "support")):
        assert columns[f"offset_{name}_real"].tolist() == found.offset[:, k].real.tolist()
        assert columns[f"offset_{name}_imaginary"].tolist() == found.offset[:, k].imag.tolist()


def test_names_of_pins():
    def names(system):
        return [system._pin_name(pin) for pin in range(system.size + 1)]

    assert names(rc.Chain(mass=[1.0, 1.0], length=1.0)) == ["free end", "pin 1", "support"]
    assert names(CRANE) == ["free end of load", "pin 1, below hook block", "support"]
    assert names(rc.Chain(mass=[1.0, 1.0], length=1.0, names=["", "top"])) == ["free end", "pin 1, below top", "support"]
    assert names(rc.Rig(CRANE, inverted=True))[1] == "pin 1, above hook block"
    assert names(rc.Held(CRANE, tension=1e5)) == ["lower end", "pin 1, below hook block", "upper end"]
    assert [CORD._pin_name(place) for place in (0, 7)] == ["free end", "point 7"]
    keys = [column.name for column in in_columns(rc.modes(rc.Chain(mass=[1.0] * 3, length=1.0, names=["a", "a", "a"]))._full())]
    assert len({*keys}) == len(keys) and keys[-3:] != keys[-4:-1]


def test_long_rows_stay_one_column():
    """A row of a million numbers is no table: it stays a text of numbers, separated by blanks."""
    values = np.ones((2, 1001))
    sheet = Sheet("speed", "", [Column("offset", values, axes=("pin",))], named=lambda axis, k: f"pin {k}")
    assert [column.name for column in in_columns(sheet)] == ["offset"]
    few = Sheet("speed", "", [Column("offset", values[:, :1000], axes=("pin",))], named=sheet.named)
    assert len(in_columns(few)) == 1000
    assert [column.name for column in in_columns(Sheet("row", "", [Column("pull", values[:, :2], axes=("axis",))], named=lambda axis, k: ""))] == ["pull"]


# ---- workbooks


@pytest.mark.parametrize("path", EXAMPLES)
def test_a_workbook_of_every_example(path, tmp_path):
    """All numbers are there as numbers, under headings with their units; the system and the facts are on the first sheet."""
    for question, found in rc.load_scene(path).answers().items():
        found.to_excel(tmp_path / f"{question}.xlsx")
        book = sheets(tmp_path / f"{question}.xlsx")
        first, *_ = book
        assert first == "system" and book[first][0] == ["what", "value", "unit"]
        about = {row[0]: row[1] for row in book[first][1:] if row[0]}
        system = getattr(found, "system", getattr(found, "governor", found))
        assert about["description"] == system.describe() and about["revchain"] == rc.__version__
        assert about["gravity"] == 9.80665
        name = excel.name_of(found)
        single = [column for column in found._sheet().columns if not column.axes]
        rows = book[name[:31]]
        assert len(rows[0]) >= len(single) and len(rows) == len(found._sheet()) + 1
        for column in single:
            if isinstance(column.values, np.ndarray) and column.values.dtype.kind in "fi":
                at = [excel.heading_of(each) for each in excel._single(Sheet("", "", single))].index(excel.heading_of(column))
                assert all(map(near, [row[at] for row in rows[1:]], column.values.astype(float).tolist()))
        for column in found._sheet().columns:
            if column.axes and isinstance(column.values, np.ndarray) and column.values.ndim == 2 and column.values.dtype.kind == "f":
                cells = book[f"{name} {column.name}".replace("_", " ")[:31].strip()]
                numbers = np.array([[math.nan if x is None else x for x in row] for row in cells[1:]], float).reshape(-1, len(cells[0]))
                np.testing.assert_allclose(numbers[:, -column.values.shape[1] :], column.values, rtol=1e-15)


def test_headings_have_units(tmp_path):
    rc.steady_shapes(CRANE, angular_speed="10 rpm").to_excel(tmp_path / "a.xlsx")
    book = sheets(tmp_path / "a.xlsx")
    assert book["links"][0] == ["link", "name", "mass (kg)", "length (m)", "centroid (m)", "radius of gyration (m)"]
    assert book["links"][1:] == [[0, "load", 2500, 6, 6, 0], [1, "hook block", 400, 24, 24, 0]]
    assert {"lowest inclination (rad)", "top tension (N)", "error (rad)"} <= {*book["steady shapes"][0]}
    places = ["offset, free end of load (m)", "offset, pin 1, below hook block (m)", "offset, support (m)"]
    assert book["steady shapes offset"][0][1:] == places
    assert book["steady shapes tension"][0][1:] == ["tension, link 0, load (N)", "tension, link 1, hook block (N)"]
    found = rc.response(CRANE, angular_speed=[1.0, 2.0], support_radius=0.01)
    found.to_excel(tmp_path / "r.xlsx")
    assert sheets(tmp_path / "r.xlsx")["response offset"][0] == ["speed (rad/s)", *places]
    assert found.to_xarray()["offset"].attrs["units"] == "m"


def test_a_workbook_of_all_answers(tmp_path, run):
    path = SCENES / "chair_o_plane.toml"
    code, out, _ = run("run", path, "--out", tmp_path / "out", "--xlsx", tmp_path / "a.xlsx")
    assert code == 0 and out.endswith(f"wrote {tmp_path / 'a.xlsx'}\n")
    book = sheets(tmp_path / "a.xlsx")
    assert [*book][:3] == ["system", "links", "shapes"] and {"branches", "campbell", "campbell frequency", "campbell crossings"} <= {*book}
    assert ["title", "Chair-o-plane on a mast that yields", None] in book["system"]
    assert ["support: stiffness", 1000, "N/m"] in book["system"]
    assert run("modes", SCENES / "two_weights.toml", "--xlsx", tmp_path / "m.xlsx", "--quiet") == (0, "", "")
    assert [*sheets(tmp_path / "m.xlsx")] == ["system", "links", "modes", "modes nodes", "modes shape"]


def test_a_workbook_stays_if_nothing_is_answered(tmp_path, run):
    scene, book, page = (tmp_path / name for name in ("cord.toml", "keep.xlsx", "page.html"))
    scene.write_text("[cord]\nlength=1\nmass=1\n[ask.response]\nangular_speed=2\n")
    rc.modes(CRANE).to_excel(book)
    before = book.read_bytes()
    code, out, _ = run("run", scene, "--out", tmp_path / "out", "--xlsx", book, "--report", page)
    assert code and out.splitlines()[-1] == f"wrote {page}" and page.stat().st_size > 0
    assert book.read_bytes() == before and {each.name for each in tmp_path.iterdir()} == {"cord.toml", "keep.xlsx", "out", "page.html"}
    book.unlink()
    assert run("run", scene, "--out", tmp_path / "out", "--xlsx", book)[1] == "" and not book.exists()


def test_a_workbook_of_a_study(tmp_path, run, monkeypatch):
    monkeypatch.chdir(tmp_path)
    study = {"scene": {"title": "Rope", "links": [{"mass": 1, "length": 1}]}, "vary": {"links[0].length": {"from": 1, "to": 2, "steps": 5}}}
    Path("study.json").write_text(json.dumps(study))
    assert run("sweep", "study.json", "--out", "a.xlsx", "--quiet")[0] == 0
    found, book = rc.sweep(study), sheets("a.xlsx")
    assert [*book] == ["study", "points"] and ["points", 5] in book["study"]
    heading, *rows = book["points"]
    assert heading[0] == "point" and heading[-1] == "status" and any(name.endswith("length (m)") for name in heading)
    speed = heading.index("angular speed 1 (rad/s)")
    assert all(map(near, [row[speed] for row in rows], found["angular_speed"].sel(mode=1).to_numpy().tolist()))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.xlsx", "study.json"]


def test_too_large_for_a_sheet(tmp_path, run):
    many = {"scene": {"links": [{"mass": 1, "length": 1}]}, "vary": {"gravity": {"from": 1, "to": 2, "steps": 1_048_576}}}
    with pytest.raises(ValueError, match=r"a sheet has at most 1,048,575 rows, got 1,048,576 points; write \.csv or \.nc"):
        rc.sweep(many, out=tmp_path / "a.xlsx")
    (tmp_path / "a.json").write_text(json.dumps(many))
    code, _, err = run("sweep", tmp_path / "a.json", "--out", tmp_path / "a.xlsx")
    assert code == ExitCode.WRONG_USAGE and "a sheet has at most" in err
    pages = [excel.Page("points", [Column(f"c{k}", np.ones(1)) for k in range(16_385)])]
    with pytest.raises(ValueError, match="16,384 columns, got 16,385 columns of points"):
        excel.write_workbook(tmp_path / "b.xlsx", pages, "b.xlsx")
    assert [path.name for path in tmp_path.iterdir()] == ["a.json"]


@pytest.mark.slow
def test_more_pins_than_columns(tmp_path):
    rc.modes(rc.Chain.uniform_rods(16_400, length=1.0, mass=1.0), 1).to_excel(tmp_path / "a.xlsx")
    book = sheets(tmp_path / "a.xlsx")
    assert [*book] == ["system", "links", "modes"] and len(book["links"]) == 16_401
    assert any(row[0] == "note" and row[1].startswith("shape has more numbers in a row than a sheet has columns") for row in book["system"])


def test_refused_and_failed(tmp_path, monkeypatch):
    modes = rc.modes(CRANE)
    with pytest.raises(ValueError, match=r"revchain\.Modes\.to_excel: path must end in \.xlsx, got .*a\.csv; for other files"):
        modes.to_excel(tmp_path / "a.csv")
    with pytest.raises((TypeError, ValueError), match="to_excel"):
        modes.to_excel(3)
    with pytest.raises(OSError, match="No such file"):
        modes.to_excel(tmp_path / "missing" / "a.xlsx")
    (tmp_path / "a.xlsx").write_text("old")
    monkeypatch.setattr(excel, "_dress", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(OSError, match="No space left"):
        modes.to_excel(tmp_path / "a.xlsx")
    assert (tmp_path / "a.xlsx").read_text() == "old" and [path.name for path in tmp_path.iterdir()] == ["a.xlsx"]


def test_odd_names_and_numbers(tmp_path):
    """Characters that a workbook cannot hold, names of sheets that meet, infinities and missing numbers."""
    chain = rc.Chain(mass=[1.0, 1.0], length=1.0, names=["a\x07b", "=1+1"])
    rc.modes(chain).to_excel(tmp_path / "a.xlsx")
    names = [row[1] for row in sheets(tmp_path / "a.xlsx")["links"][1:]]
    assert names == ["a b", "=1+1"]
    assert openpyxl.load_workbook(tmp_path / "a.xlsx")["links"]["B3"].data_type == "s"  # no formula
    columns = [Column("x", np.array([1.0, np.nan, np.inf])), Column("y", [True, "z" * 40_000, None])]
    pages = [excel.Page(name, columns) for name in ("a/b:c", "a b c", "x" * 40, "x" * 41)]
    excel.write_workbook(tmp_path / "b.xlsx", pages, "b.xlsx")
    book = sheets(tmp_path / "b.xlsx")
    assert len(book) == 4 and all(len(name) <= 31 for name in book)
    assert [row[0] for row in book["a b c"]] == ["x", 1, None, "inf"] and len(book["a b c"][2][1]) == 32_000


def test_parts_of_systems():
    facts, links = parts_of(rc.Rig(CRANE, support=rc.Support(stiffness=5.0, mass=2.0), pins=rc.Pin(damping=[0.0, 3.0])))
    assert [(fact.name, fact.value, fact.unit) for fact in facts[1:]] == [
        ("support: stiffness", 5.0, "N/m"), ("support: mass", 2.0, "kg"),
    ]  # fmt: skip
    assert links[-1].heading == "pin damping (N m s/rad)" and links[-1].values.tolist() == [0.0, 3.0]
    facts, places = parts_of(CORD)
    assert {"length", "mass", "tip mass"} <= {fact.name for fact in facts}
    assert [column.values.tolist() for column in places] == [[0.4], [0.1]]
    facts, _ = parts_of(rc.Held(rc.Cord(2.0, mass=1.0), span=1.5))
    assert ("span", 1.5, "m") in [tuple(fact) for fact in facts]


def test_without_the_packages(tmp_path, monkeypatch, run):
    import sys

    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(ImportError, match=r'needs openpyxl: pip install "revchain\[excel\]"'):
        rc.modes(CRANE).to_excel(tmp_path / "a.xlsx")
    code, _, err = run("modes", SCENES / "two_weights.toml", "--xlsx", tmp_path / "a.xlsx")
    assert code == ExitCode.WRONG_USAGE and 'pip install "revchain[excel]"' in err and [*tmp_path.iterdir()] == []
