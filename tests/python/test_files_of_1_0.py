# SPDX-License-Identifier: GPL-3.0-or-later
"""What version 1.0 wrote is read, what it answered is answered again, and its public names are there.

A failure is a break of the promise in docs/compatibility.md: mend the code, not the files of tests/data/1.0.
"""

import importlib.util
import json
import math
import tarfile
import tomllib
from pathlib import Path

import numpy as np
import pytest
import xarray

import revchain as rc
from revchain.studies.study import Study

FOLDER = Path(__file__).resolve().parents[1] / "data" / "1.0"
spec = importlib.util.spec_from_file_location("make_1_0", FOLDER.parent / "make_1_0.py")
made = importlib.util.module_from_spec(spec)
spec.loader.exec_module(made)

# Not promised: how a number was found, how well it is known, in which words, and how many points a branch has.
FREE = {"method", "remark", "looked_at", "points", "description", "explanation"}
FREE_PARTS = ("error", "residual", "certificate")
SCENES = [path.stem for path in made.scenes()]


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    folder = tmp_path_factory.mktemp("written")
    with tarfile.open(FOLDER / "written.tar.xz") as archive:
        for member in filter(tarfile.TarInfo.isfile, archive):  # Python 3.11 before 3.11.4 has no filters of its own
            path = folder / member.name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(archive.extractfile(member).read())
    return folder


def read(path):
    return json.loads(path.read_text())


def values(data, key="", found=None):
    """The leaves of nested data, all of a column of a table together."""
    found = {} if found is None else found
    if isinstance(data, dict):
        for name, item in data.items():
            values(item, f"{key}.{name}", found)
    elif isinstance(data, list):
        found.setdefault(f"{key}.length", []).append(len(data))
        for item in data:
            values(item, f"{key}[]", found)
    else:
        found.setdefault(key, []).append(data)
    return found


def is_free(key):
    return any(name in FREE or any(part in name for part in FREE_PARTS) for name in key.replace("[]", "").split("."))


def agree(now, then):
    """Compare answers: numbers to 1e-7 of the largest of their column, all else exactly; `now` may have more columns."""
    now, then = values(now), values(then)
    for key in (key for key in then if not is_free(key)):
        assert key in now, f"{key} is missing"
        if any(type(value) is float for value in then[key]):
            old = np.array(then[key], float)  # None becomes NaN
            finite = np.abs(old[np.isfinite(old)])
            size = finite.max() if finite.size else 0.0
            np.testing.assert_allclose(np.array(now[key], float), old, rtol=0, atol=1e-9 + 1e-7 * size, err_msg=key)
        else:
            assert now[key] == then[key], key


def within(now, then):
    """All of `then` is in `now`, to the last bit."""
    if isinstance(then, dict):
        for key in then:
            assert key in now, key
            within(now[key], then[key])
    elif isinstance(then, list):
        assert len(now) == len(then)
        for pair in zip(now, then, strict=True):
            within(*pair)
    else:
        assert now == then or (isinstance(then, float) and math.isnan(then) and math.isnan(now))


RESULTS = [*(f"{name}.npz" for name in made.QUESTIONS), *(f"{name}.nc" for name in made.NETCDF)]


@pytest.mark.parametrize("file", RESULTS)
def test_results_are_read(written, file):
    path = written / "results" / file
    found = rc.load(path)
    within(json.loads(json.dumps(found.to_dict())), read(path.with_suffix(".json")))
    assert str(found) and found == rc.load(path)


@pytest.mark.parametrize("name", made.QUESTIONS)
def test_questions_have_the_same_answers(written, name):
    now, then = made.asked(name), rc.load(written / "results" / f"{name}.npz")
    assert type(now) is type(then) and getattr(now, "system", None) == getattr(then, "system", None)
    if name != "explanation":  # which method is cheapest may change
        agree(json.loads(json.dumps(now.to_dict())), read(written / "results" / f"{name}.json"))
    if isinstance(now, rc.Modes) and hasattr(now, "conical_height"):
        bound = (now.error_bound + then.error_bound) * np.abs(now.conical_height)
        assert (np.abs(now.conical_height - then.conical_height) <= bound).all()


def test_loaded_results_answer_questions(written):
    def of(name):
        return rc.load(written / "results" / f"{name}.npz")

    assert of("modes").uncertainty(mass="3 %") == made.asked("modes").uncertainty(mass="3 %")
    then, now = (branch.at(angular_speed=4.0)[0] for branch in (of("branch"), made.asked("branch")))
    np.testing.assert_allclose(now.offset, then.offset, rtol=1e-9)
    for name in ("shape", "shape_held", "shape_of_cord"):
        assert of(name).stability().verdict == made.asked(name).stability().verdict


@pytest.mark.parametrize("name", SCENES)
def test_scenes_have_the_same_answers(written, tmp_path, run, name):
    scene = FOLDER / "scenes" / f"{name}.toml"
    answers = sorted((written / "answers" / name).glob("*.json"))
    assert answers
    for answer in answers:
        now, table = tmp_path / answer.name, tmp_path / "table.csv"
        code, _, err = run(answer.stem, scene, "--json", now, "--csv", table)
        assert (code, err) == (0, "")
        then = read(answer)
        agree(read(now), then)
        columns = answer.with_suffix(".csv").read_text().strip().split(",")
        assert [column for column in table.read_text().partition("\n")[0].split(",") if column in columns] == columns
        if "system" in then:
            data, system = then["system"], rc.load_scene(scene).system()
            if data["system"] == "SleeveGovernor":
                assert rc.SleeveGovernor(**{key: data[key] for key in data if key != "system"}) == system
            else:
                assert getattr(rc, data["system"]).from_dict(data) == system


@pytest.mark.parametrize("name", made.STUDIES)
def test_studies_have_the_same_answers(written, name):
    with xarray.open_dataset(written / "studies" / Path(name).with_suffix(".nc"), engine="h5netcdf") as then:
        now = rc.sweep(rc.load_study(FOLDER / name))
        for key, column in then.variables.items():
            assert now[key].dims == column.dims and now[key].attrs.get("units") == column.attrs.get("units")
            if column.dtype.kind == "f" and "error" not in key:
                np.testing.assert_allclose(now[key], column, rtol=1e-9)
            elif column.dtype.kind != "f":
                np.testing.assert_array_equal(now[key], column)
        assert now.attrs["title"] == then.attrs["title"]
        assert Study.from_dict(json.loads(then.attrs["study"])).points == now["status"].size


def kept(now, then, path=""):
    """Every name of version 1.0 is there, each parameter in its place; a new parameter has a default."""
    if isinstance(then, dict):
        assert set(then) <= set(now), (path, set(then) - set(now))
        for name in then:
            kept(now[name], then[name], f"{path}.{name}")
    elif isinstance(then, list) and path.startswith((".c++", ".scene", ".study", ".command_line")):
        assert set(then) <= set(now), (path, set(then) - set(now))
    elif isinstance(then, list):
        for place, name in enumerate(then):  # with its default; one that is given by position stays where it is
            assert name in (now if name[0] == "*" else now[place : place + 1]), (path, name)
        assert all("=" in name or name.startswith("**") for name in set(now) - set(then)), path
    else:
        assert now == then, path


def test_public_names_stay():
    from revchain.plots.style import STYLE
    from revchain.plots.sweep import plot_sweep

    assert isinstance(STYLE, dict) and callable(plot_sweep)
    kept(made.interface(), read(FOLDER / "interface.json"))


@pytest.mark.parametrize("change", ["name", "attribute", "order", "default", "required", "option", "code", "key", "header"])
def test_a_missing_name_is_found(change):
    now, then = read(FOLDER / "interface.json"), read(FOLDER / "interface.json")
    kept(now, then)
    if change == "name":
        del now["python"]["modes"]
    elif change == "attribute":
        del now["python"]["Modes"]["period"]
    elif change == "order":
        now["python"]["modes"].insert(1, "first=1")
    elif change == "default":
        now["python"]["modes"][1] = "count=9"
    elif change == "required":
        now["python"]["modes"].append("*units")
    elif change == "option":
        now["command_line"]["modes"].remove("--count")
    elif change == "code":
        now["exit_codes"]["OUTPUT_FAILED"] = 5
    elif change == "header":
        now["c++"]["modes.hpp"].remove("ModesOptions")
    else:
        now["scene"]["Link"].remove("mass")
    with pytest.raises(AssertionError):
        kept(now, then)


def test_comparison_finds_changes():
    then = {"modes": [{"period": period, "error_bound": 1e-16, "direction": 1} for period in (2.0, 1.0)]}
    agree({"modes": [{**row, "error_bound": 0.0, "new": 3} for row in then["modes"]]}, then)
    changes = {"period": 2.000001, "direction": -1}
    for name, value in changes.items():
        with pytest.raises(AssertionError):
            agree({"modes": [{**then["modes"][0], name: value}, then["modes"][1]]}, then)
    with pytest.raises(AssertionError):
        agree({"modes": then["modes"][:1]}, then)
    with pytest.raises(AssertionError):
        agree({"modes": [{"period": row["period"]} for row in then["modes"]]}, then)


def test_scenes_have_every_key_of_1_0():
    found = made.tables_written()
    tables = read(FOLDER / "interface.json")
    for name, keys in (tables["scene"] | tables["study"]).items():
        assert set(keys) <= found[name], name
    for path in made.scenes():
        assert tomllib.loads(path.read_text()).get("schema_version", 2) == 2
