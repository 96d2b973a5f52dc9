# SPDX-License-Identifier: GPL-3.0-or-later
"""Every example scene against the values beside it, every example program run."""

import ast
import importlib.util
import json
import re
import runpy
import shutil
import tomllib
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest

import revchain as rc

ROOT = Path(__file__).resolve().parents[2]
SCENES = sorted((ROOT / "examples" / "scenes").glob("*.toml"))
PYTHON = ROOT / "examples" / "python"
GALLERY = sorted(PYTHON.glob("*/*.py"))
EXPERIMENTS = [path for path in GALLERY if path.parent.name == "experiments"]
DRAW = ROOT / "docs" / "figures"  # draw_*.py
PROGRAMS = sorted({*GALLERY, *DRAW.glob("draw_*.py")} - {*EXPERIMENTS, DRAW / "draw_programs.py"})  # which runs all
LOADED = {path: rc.load_scene(path) for path in SCENES}
DAMPED = [path for path in SCENES if getattr(LOADED[path].system(), "is_damped", False)]
CARRIED = [path for path in SCENES if "drag" in LOADED[path].asks]
RIGS = [path for path in SCENES if LOADED[path].is_rigged and path not in DAMPED + CARRIED]
HELD = [path for path in SCENES if LOADED[path].is_held]
GOVERNORS = [path for path in SCENES if isinstance(LOADED[path].system(), rc.SleeveGovernor)]
CORDS = [path for path in SCENES if "cord" in LOADED[path].to_dict() and path not in HELD]
CHAINS = [path for path in SCENES if path not in RIGS + HELD + DAMPED + GOVERNORS + CORDS + CARRIED]
ULP = 2.0**-52
# The expected values belong to the decimals of the file and the answers to their roundings. Those cost up
# to some ulp in principle and 0.9 ulp measured (bell_and_clapper), inside the bound of 2 ulp.


def test_there_are_all():
    """Of scenes: beside those that docs/scenes.md shows."""
    chains = {"watch_chain", "bell_and_clapper", "crane_hook_block", "bernoulli_chain", "anchor_chain", "weight_ratio"}
    assert {path.stem for path in CHAINS} >= {*chains, "two_weights", "stick_on_string"}
    assert len(RIGS) >= 9 and {path.stem for path in HELD} >= {"troposkien"}
    assert {path.stem for path in PROGRAMS} >= {*SAYS, *CHECKS} and len(EXPERIMENTS) == 11


def solved(path):
    scene = rc.load_scene(path)
    return scene, scene.modes(), expected_of(path)


def expected_of(path):
    return json.loads(path.with_name(f"{path.stem}.expected.json").read_text())


@pytest.mark.parametrize("path", CHAINS, ids=lambda path: path.stem)
def test_chains(path, exact_heights, worst_in_bounds):
    """Heights, speeds and nodes; of few links, for the dense reference, also for the numbers as they are stored."""
    scene, result, expected = solved(path)
    assert result.status == "success"
    assert result.system.size == expected["size"] and len(result) == len(expected["modes"])
    assert result.error_bound.max() <= 4 * ULP
    assert result.gravity == scene.gravity_value()
    with mp.workdps(40):
        for k, mode in enumerate(expected["modes"]):
            height = abs(mp.mpf(float(result.conical_height[k])) / mp.mpf(mode["conical_height"]) - 1)
            speed = abs(mp.mpf(float(result.angular_speed[k])) / mp.mpf(mode["angular_speed"]) - 1)
            stored = ULP / 2 if result.error_bound[k] < ULP else 0  # the file's decimals are rounded when stored
            assert height <= result.error_bound[k] + stored
            assert speed <= result.speed_error_bound[k] <= (result.error_bound[k] / 2 + 2.1 * ULP) * (1 + 1e-9)
    for nodes, mode in zip(result.nodes, expected["modes"], strict=True):
        # absolute, in parts of the length; measured 3.2 ulp (weight_ratio)
        atol = 8 * ULP * result.system.total_length
        np.testing.assert_allclose(nodes, [float(node) for node in mode["nodes"]], rtol=0, atol=atol)
    if result.system.size <= 20:
        assert worst_in_bounds(result, exact_heights(result.system)) <= 1


@pytest.mark.parametrize("path", CARRIED, ids=lambda path: path.stem)
def test_carried_in_air(path):
    """Against the balance of forces in 80 digits."""
    found, expected = rc.load_scene(path).drag_shape(), expected_of(path)["drag"]
    assert found.status == "success" and found.folds == 0
    for name, value in expected.items():
        [number] = np.ravel(getattr(found, name))
        assert number == pytest.approx(float(value), rel=4e-15), name


@pytest.mark.parametrize("path", CORDS, ids=lambda path: path.stem)
def test_cords(path):
    """Against Bessel functions between the point masses; the file's decimals are rounded when stored."""
    _, result, expected = solved(path)
    assert result.status == "success" and len(result) == len(expected["modes"])
    assert result.error_bound.max() <= 1e-13
    for k, mode in enumerate(expected["modes"]):
        with mp.workdps(40):
            assert abs(mp.mpf(float(result.conical_height[k])) / mp.mpf(mode["conical_height"]) - 1) <= result.error_bound[k] + 4 * ULP
            assert abs(mp.mpf(float(result.angular_speed[k])) / mp.mpf(mode["angular_speed"]) - 1) <= result.error_bound[k] + 4 * ULP
        nodes = [float(node) for node in mode["nodes"]]
        np.testing.assert_allclose(result.nodes[k], nodes, rtol=0, atol=1e-13 * result.system.length)


@pytest.fixture(scope="module")
def of_stored_numbers():
    """The reference of rigs for the numbers as they are stored: each decimal of the file rounded to double."""
    spec = importlib.util.spec_from_file_location("expected_rigs", ROOT / "tests" / "data" / "expected_rigs.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    decimal = module.number
    module.number = lambda given: mp.mpf(float(decimal(given)))
    module.check_closed_forms = lambda: None  # those are of the decimals

    def expected(path, asked):
        with mp.workdps(70):
            scene = tomllib.loads(path.read_text(encoding="utf-8"), parse_float=mp.mpf)
            return module.expected_of({**scene, "ask": {}}, 40, asked)

    return expected


@pytest.mark.parametrize("path", RIGS, ids=lambda path: path.stem)
def test_rigs(path, of_stored_numbers):
    """Speeds of both senses, shapes, the response, and what is no steady motion.

    Speeds for the numbers as they are stored; the others for the decimals of the file."""
    scene, result, written = solved(path)
    expected = of_stored_numbers(path, max((mode["number"] for mode in written["modes"]), default=0))
    for stored, decimal in zip(expected["modes"], written["modes"], strict=True):  # what rounding of the decimals costs
        assert abs(mp.mpf(stored["conical_height"]) / mp.mpf(decimal["conical_height"]) - 1) <= 3 * ULP
    assert result.status == "success" and result.complete
    assert result.system.size == expected["size"] and len(result) == len(expected["modes"])
    assert np.max(result.error_bound, initial=0.0) <= 4 * ULP
    worst = 0.0
    with mp.workdps(40):
        rows = zip(expected["modes"], result.conical_height, result.angular_speed, strict=True)
        for k, (mode, height, speed) in enumerate(rows):
            assert (result.direction[k], result.number[k]) == (mode["sense"], mode["number"])
            worst = max(worst, abs(mp.mpf(float(height)) / mp.mpf(mode["conical_height"]) - 1))
            worst = max(worst, abs(mp.mpf(float(speed)) / mp.mpf(mode["angular_speed"]) - 1))
        order = np.lexsort((result.other.conical_height.imag, np.abs(result.other.conical_height)))
        assert len(order) == len(expected["other"])
        for other, k in zip(expected["other"], order, strict=True):
            found = result.other.conical_height[k]
            height = mp.mpc(*other["conical_height"])
            worst = max(worst, abs(mp.mpc(complex(found)) - height) / abs(height))
            rate = mp.mpf(float(result.other.growth_rate[k]))
            worst = max(worst, abs(rate / mp.mpf(other["growth_rate"]) - 1))
    assert worst <= 1.1 * ULP

    for found, mode in zip(result.shape, written["modes"], strict=True):
        offset = np.array([float(y) for y in mode["offset"]])
        # absolute, the largest offset 1; measured 1 ulp (bicycle_wheels)
        np.testing.assert_allclose(found, offset / np.abs(offset).max(), rtol=0, atol=2 * ULP)
    assert ("carried" in written) == ("response" in scene.asks)
    if "carried" in written:  # every pin of a support that goes round, within the bound
        found = scene.response().offset
        with mp.workdps(40):
            errors = [abs(mp.mpf(float(y)) - mp.mpf(x)) for y, x in zip(found, written["carried"], strict=True)]
            # in parts of the largest; measured 0.27 ulp (swing_carousel), the decimals of the file being rounded
            assert max(errors) <= 0.5 * ULP * np.abs(found).max()


@pytest.mark.parametrize("path", HELD, ids=lambda path: path.stem)
def test_held_at_both_ends(path):
    expected = expected_of(path)
    found = rc.load_scene(path).steady_shapes()
    assert [shape.half_waves for shape in found] == [row["half_waves"] for row in expected["shapes"]]
    for shape, row in zip(found, expected["shapes"], strict=True):
        offset, pull = (np.array([float(x) for x in row[name]]) for name in ("offset", "lower_pull"))
        # in parts of the length, and of the tension: measured 0.17 and 0.02 ulp
        np.testing.assert_allclose(shape.offset, offset, rtol=0, atol=0.3 * ULP * 24.0)
        with mp.workdps(40):  # of a system by mass: three roundings after the last sum, measured 1.3 spacings
            exact = [float(abs(mp.mpf(float(x)) - mp.mpf(y))) for x, y in zip(shape.lower_pull, row["lower_pull"], strict=True)]
        assert (exact <= 1.5 * np.spacing(np.abs(pull)) + 0.05 * ULP * shape.tension.max()).all()
    blade = rc.Held(rc.Chain.uniform_rods(20, 24.0, weight=160 * 9.80665), span=17.0)
    by_weight = rc.steady_shapes(blade, angular_speed=np.pi, max_half_waves=2)
    for shape, row in zip(by_weight, expected["shapes"], strict=True):
        pull = np.array([float(x) for x in row["lower_pull"]])
        np.testing.assert_allclose(shape.lower_pull, pull, rtol=0, atol=0.05 * ULP * shape.tension.max())


@pytest.mark.parametrize("path", DAMPED, ids=lambda path: path.stem)
def test_damped(path):
    """Exponents, and the motion while the support is moved."""
    scene, result, expected = solved(path)
    assert result.complete and len(result) == len(expected["exponents"])
    with mp.workdps(40):
        for found, exponent in zip(result.exponent, expected["exponents"], strict=True):
            assert abs(mp.mpc(complex(found)) - mp.mpc(*exponent)) <= 2 * ULP * abs(mp.mpc(*exponent))
    found = scene.swing(time=[float(t) for t in expected["swing"]])
    assert found.time.size >= 2
    for got, offset in zip(found.offset, expected["swing"].values(), strict=True):
        np.testing.assert_allclose(got, [float(y) for y in offset], rtol=4 * ULP)


@pytest.mark.parametrize("path", GOVERNORS, ids=lambda path: path.stem)
def test_governors(path):
    """Equilibria at the speed asked for, and the speeds at the stops.

    The lift changes 14 times as much as the speed, in parts of itself, and the speed is rounded: measured 9.5 ulp."""
    expected, found = expected_of(path), LOADED[path].equilibria()
    assert len(found) == len(expected["equilibria"]) >= 1
    for one, row in zip(found, expected["equilibria"], strict=True):
        assert one.stable == row["stable"] and np.isnan(one.period) == ("period" not in row)
        for name in row.keys() - {"stable"}:
            np.testing.assert_allclose(getattr(one, name), float(row[name]), rtol=16 * ULP)
    governor = LOADED[path].system()
    at = governor.at([governor._given["lowest_inclination"], governor._given["highest_inclination"]])
    for name, column in (("falls", at.low_speed), ("angular_speed", at.angular_speed), ("rises", at.high_speed)):
        np.testing.assert_allclose(column, [float(stop[name]) for stop in expected["stops"]], rtol=2 * ULP)


def test_campbell_of_the_chair():
    path = ROOT / "examples" / "scenes" / "chair_o_plane.toml"
    found, expected = LOADED[path].campbell(), expected_of(path)["crossings"]
    assert [(one.order, one.motion) for one in found.crossings] == [(row["order"], row["motion"]) for row in expected]
    assert f"{found.crossings[0].rpm:.3f}" == "6.094"
    for one, row in zip(found.crossings, expected, strict=True):
        np.testing.assert_allclose(one.angular_speed, float(row["angular_speed"]), rtol=1e-14)


def test_let_go():
    path = ROOT / "examples" / "scenes" / "plucked_chain.toml"
    scene, expected = rc.load_scene(path), expected_of(path)["swing"]
    found = scene.swing()
    assert len(expected) == 2
    for time, offset in expected.items():
        [row] = np.flatnonzero(np.isclose(found.time, float(time), rtol=1e-12))
        exact = np.array([float(y) for y in offset])
        assert np.abs(found.offset[row] - exact).max() <= found.error_bound[row] + 1e-17  # decimals of the file


@pytest.mark.parametrize("path", GALLERY, ids=lambda path: path.stem)
def test_programs_are_pages(path):
    """A title, one sentence, then cells; the last one says where the numbers are checked."""
    text = path.read_text("utf-8")
    title, rule, blank, lead = ast.get_docstring(ast.parse(text)).split("\n")
    assert len(rule) == len(title) and not blank and lead[-1] in ".?:" and len(lead) < 121
    first, *cells = text.split("\n# %%\n")
    assert len(cells) >= 2 and "Usage" not in text and "sys." not in text
    assert all(cell.startswith("# ") for cell in cells) and ("plt.subplots" in first or "picture()" in first or ".show(" in first)
    files = re.findall(r"``([\w./]+)``", re.sub(r"\n# ?", " ", cells[-1].partition("# Checked: ")[2]))
    assert files and all((ROOT / name).is_file() for name in files)


@pytest.mark.parametrize("path", GALLERY, ids=lambda path: path.stem)
def test_notebooks_of_programs(path):
    """The notebook of a program has the same code, and no cell ends on a value that it would show as a list of objects."""
    parser, maker = (pytest.importorskip(f"sphinx_gallery.{name}") for name in ("py_source_parser", "notebook"))
    cells = parser.split_code_and_text_blocks(path)[1]
    settings = {"first_notebook_cell": None, "last_notebook_cell": None, "pypandoc": False, "notebook_images": False}
    notebook = maker.jupyter_notebook(cells, {**settings, "notebook_extensions": set(), "promote_jupyter_magic": False}, str(path.parent))
    code = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert ast.dump(ast.parse("\n".join(code))) == ast.dump(ast.Module(ast.parse(path.read_text("utf-8")).body[1:], []))
    last = [ast.unparse(end.value) for cell in code if isinstance(end := ast.parse(cell).body[-1], ast.Expr)]
    assert all(value.startswith(("print(", "plt.show(")) or ".show(" in value for value in last), last


def run_alone(python, path, folder):
    """Copies a program of the gallery to an empty folder, runs it there without a screen, and returns what it prints."""
    done = python(DRAW / "draw_programs.py", shutil.copy(path, folder))
    assert (done.returncode, done.stderr) == (0, "")
    written = {each.name for each in folder.iterdir()} - {path.name}
    if path.stem == "whirling_chain_3d":  # a view alone, of which test_animate.py has the page
        assert not written
        return done.stdout
    printed, _, last = done.stdout.removesuffix("\n").rpartition("\n")
    picture = folder / f"{path.stem}.svg"
    assert last == f"wrote {picture.name}" and written == {picture.name}
    assert picture.read_text("utf-8").startswith("<?xml") and picture.stat().st_size < 300_000
    return printed + "\n"


def check_chair_o_plane(printed, _):
    assert "21.69  unstable, spectrally stable" in printed
    assert f"```text\n{printed}```" in (ROOT / "docs/scenes.md").read_text("utf-8")


def check_fit_measured_speeds(printed, _):
    page = (ROOT / "docs/measured.md").read_text("utf-8")
    table = printed.partition("correlation of load and rope 0.075")[0]
    assert table and f"```text\n{table}```" in page
    assert "(figures/fit_measured_speeds.svg)" in page and (ROOT / "docs/figures/fit_measured_speeds.svg").is_file()
    assert "cannot tell links[load].mass and links[hook block].mass apart" in printed


def check_draw_studies(printed, folder):
    numbers, _, last = printed.removesuffix("\n").rpartition("\n")
    assert last == "wrote studies.svg" and f"\n```text\n{numbers}\n```\n" in (ROOT / "docs/studies.md").read_text("utf-8")
    assert (folder / "studies.svg").stat().st_size < 300_000 and (ROOT / "docs/figures/studies.svg").is_file()


def check_pipe_from_ship(printed, _):
    """Periods and offsets from matrices written here: tension from net weights, inertia with the added mass."""
    rows = [[float(x) for x in line.split()] for line in printed.splitlines()[1:6]]
    assert [row[0] for row in rows] == [200, 400, 600, 800, 1000]
    for length, *shown in rows:
        lengths = np.array([8.0, *[length / 60] * 60])
        net = np.array([12_000 - 1600, *[(29.0 - 3.8) * length / 60] * 60])
        moved = np.array([15_000, *[(29.0 + 22.5) * length / 60] * 60])
        tension = 9.80665 * (np.cumsum(net) - net / 2)  # of a rod in its middle
        stiffness, mass = np.zeros((62, 62)), np.zeros((62, 62))
        for m, (a, t, w) in enumerate(zip(lengths, tension, moved, strict=True)):
            stiffness[m : m + 2, m : m + 2] += t / a * np.array([[1, -1], [-1, 1]])
            mass[m : m + 2, m : m + 2] += w / 6 * np.array([[2, 1], [1, 2]])
        speeds = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(mass[:-1, :-1], stiffness[:-1, :-1])).real)[:4])
        np.testing.assert_allclose(shown[:4], 2 * np.pi / speeds, atol=0.0051)
        for period, found in zip((8.0, 12.0), shown[4:], strict=True):
            dynamic = stiffness - (2 * np.pi / period) ** 2 * mass
            tip = np.linalg.solve(dynamic[:-1, :-1], -2.0 * dynamic[:-1, -1])[0]
            np.testing.assert_allclose(found, abs(tip), atol=0.00051)


# What else is known of the output of a program: words in it, or a check of all of it.
SAYS = {
    "watch_chain": ["59.929               59.929"],
    "crane": ["meets the slower one with 9.855 m of rope"],
    "silent_bell": ["0.1785  +1.000000"],
    "all_shapes": ["5 shapes, all", "84 shapes, all", "two shapes appear at a fold at 3.903762157 sqrt(g/a)"],
    "swing_carousel": ["at 6 rad/s: 5 shapes, proved complete: True"],
}
CHECKS = {
    "chair_o_plane": check_chair_o_plane,
    "fit_measured_speeds": check_fit_measured_speeds,
    "draw_studies": check_draw_studies,
    "pipe_from_ship": check_pipe_from_ship,
}


def is_slow(path):
    """Programs that draw the pictures of pages, and a chart of a thousand motions, which test_bell.py checks."""
    return path.stem.startswith("draw_") or path.stem == "clapper_chart"


@pytest.mark.parametrize("path", [pytest.param(path, marks=[pytest.mark.slow] * is_slow(path), id=path.stem) for path in PROGRAMS])
def test_programs(python, tmp_path, path):
    """Each program is run once, in seconds, and all that is known of its output is checked here."""
    if path in GALLERY:
        printed = run_alone(python, path, tmp_path)
    else:
        done = python(path)
        assert (done.returncode, done.stderr) == (0, "")
        printed = done.stdout
    assert len(printed.splitlines()) > 3
    assert all(words in printed for words in SAYS.get(path.stem, []))
    if check := CHECKS.get(path.stem):
        check(printed, tmp_path)


@pytest.mark.parametrize("path", EXPERIMENTS, ids=lambda path: path.stem)
def test_experiments(python, tmp_path, path):
    """Each draws its pictures, and prints what docs/experiments.md says it prints."""
    printed = run_alone(python, path, tmp_path)
    document = (ROOT / "docs" / "experiments.md").read_text(encoding="utf-8")
    assert f"\n```text\n{printed}```\n" in document
    assert f"](figures/{path.stem}.svg)" in document and f"](../examples/python/experiments/{path.name})" in document
    assert (ROOT / "docs" / "figures" / f"{path.stem}.svg").is_file()


def test_page_of_scenes():
    """docs/scenes.md: lines of the scene files. What the command prints, word for word, is compared in test_cli.py."""
    page = (ROOT / "docs" / "scenes.md").read_text(encoding="utf-8")
    sections = page.split("\n## ")[1:]
    shown = []
    for section in sections:
        name = re.search(r"\]\(\.\./examples/scenes/(\w+)\.toml\)\.\n", section)[1]
        path = ROOT / "examples" / "scenes" / f"{name}.toml"
        shown.append(name)
        lines = re.search(r"```toml\n(.*?)\n```\n\n```text\n", section, re.DOTALL)[1]
        assert f"\n{lines}\n" in path.read_text(encoding="utf-8")
        assert f"](figures/scene_{name}.svg)" in section
        picture = ROOT / "docs" / "figures" / f"scene_{name}.svg"
        assert picture.stat().st_size < 200_000
    carousel = rc.load_scene(ROOT / "examples/scenes/swing_carousel.toml").system()
    [out] = rc.steady_shapes(carousel, angular_speed=8 * np.pi / 30)
    assert "5.95 m, inclined at 23 degrees" in page
    assert f"{out.offset[0]:.2f} m at {np.degrees(out.inclination[0]):.0f}" == "5.95 m at 23"
    chains = {"ball_on_chain", "clamped_bell", "jointed_rod", "rods_on_threads"}
    assert {path.stem for path in RIGS + HELD + GOVERNORS + CORDS + CARRIED} | chains | {"plucked_chain", "crane_brakes_shaped"} == set(shown)


def test_experiments_are_whole():
    document = (ROOT / "docs" / "experiments.md").read_text(encoding="utf-8")
    assert "To come" not in document
    assert document.count("\n**Asked**") == document.count("\n**Take**") == document.count("\n**Expect**") == 11


def frames_of(path):
    """Each picture of a GIF."""
    sequence = pytest.importorskip("PIL.ImageSequence")
    with pytest.importorskip("PIL.Image").open(path) as film:
        return [frame.copy() for frame in sequence.Iterator(film)]


PROSE = [ROOT / "README.md", *sorted(ROOT.glob("paper/*.md")), *sorted((ROOT / "docs").rglob("*.md"))]
PAGES = [path for path in PROSE if "```python" in path.read_text("utf-8")]


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_python_of_pages(python, tmp_path, page):
    """Each block of a page runs, one after the other, and prints the text block that follows it.

    Seconds for a page: an interpreter starts, and draws what the page draws."""
    blocks = re.findall(r"```python\n(.*?)```\n(?:\n```text\n(.*?)```\n)?", page.read_text("utf-8"), re.DOTALL)
    assert blocks
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    mark = "---- end of block"
    program = "import matplotlib\nmatplotlib.use('Agg')\n" + "".join(f"{code}\nprint({mark!r})\n" for code, _ in blocks)
    (tmp_path / "page.py").write_text(program, "utf-8")
    done = python("page.py")
    assert done.returncode == 0, done.stderr
    printed = done.stdout.split(mark + "\n")
    for (code, expected), found in zip(blocks, printed, strict=False):
        assert [line.rstrip() for line in found.splitlines()] == expected.splitlines(), code
    for name in re.findall(r"savefig\(\"(.*?)\"\)", page.read_text("utf-8")):
        assert (tmp_path / name).stat().st_size > 1000 and (ROOT / "docs/figures" / name).is_file()
    for name in re.findall(r"animate\(\"(.*?\.gif)\"", program):
        made, kept = (frames_of(folder / name) for folder in (tmp_path, ROOT / "docs/figures"))
        assert len(made) == len(kept) > 1 and made[0].size == kept[0].size
        differences = [np.abs(np.subtract(*(np.asarray(each.convert("L"), float) for each in pair))) for pair in zip(made, kept, strict=True)]
        assert max(map(np.mean, differences)) < 1.0  # of 255: letters may differ
        assert (ROOT / "docs/figures" / name).stat().st_size < 400_000


def test_table_of_questions():
    """The table of docs/systems.md says "yes" where `test_interface.py` expects an answer, and only there."""
    cells = runpy.run_path(str(ROOT / "tests/python/test_interface.py"))["CELLS"]
    table = (ROOT / "docs/systems.md").read_text("utf-8").partition("| question | Chain |")[2].partition("\n\n")[0]
    rows = [line.strip("|").split("|") for line in table.splitlines()[2:]]
    shown = {name.strip("."): row[1:] for row in rows for name in re.findall(r"`([.\w]+(?:\(\w+=True\))?)(?:\(\))?`", row[0])}
    assert shown.keys() == cells.keys()
    for question, refusals in cells.items():
        for kind, cell in zip(("chain", "rig", "cord", "held"), shown[question], strict=True):
            assert ("yes" in cell) != (kind in refusals), (question, kind, cell)


def test_scene_of_the_first_page_of_scenes(python, tmp_path):
    """As a program, which draws: seconds."""
    [text] = re.findall(r"```toml\n(.*?)```", (ROOT / "docs/howto/scene.md").read_text("utf-8"), re.DOTALL)
    (tmp_path / "crane.toml").write_text(text, "utf-8")
    done = python("-m", "revchain", "run", "crane.toml")
    assert done.returncode == 0, done.stderr
    assert "hook block: 400 kg on 24 m; load: 2500 kg on 6 m" in done.stdout
    assert (tmp_path / "out/crane/modes.png").is_file() and (tmp_path / "out/crane/response.png").is_file()
