# SPDX-License-Identifier: GPL-3.0-or-later
"""The package without GSL: what needs no special functions works, the rest raises an ImportError that names the reason."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import revchain

pytestmark = pytest.mark.slow  # compiles the module
ROOT = Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "dev"
SAME = """
rc.modes(CHAIN).conical_height.tolist()
rc.modes(RODS, 2, rtol=1e-2).conical_height.tolist()
rc.modes(RIG).angular_speed.tolist()
rc.modes(rc.Held(RODS, tension=30.0), 2).conical_height.tolist()
rc.conical_heights(mass=[[1.0, 2.0], [3.0, 4.0]], length=1.0).tolist()
int(rc.count_modes(RODS, angular_speed=20.0))
rc.steady_shapes(CHAIN, angular_speed=5.0)[0].offset.tolist()
rc.steady_shapes(RIG, angular_speed=5.0)[0].stability().verdict
rc.steady_shapes(rc.Held(RODS, span=0.5), angular_speed=9.0)[0].offset.tolist()
rc.branches(CHAIN, max_angular_speed=9.0)[0].conical_height.tolist()
rc.response(RODS, angular_speed=3.0, support_radius=0.01).offset.tolist()
rc.swing(CHAIN, [0.5], offset=[0.1, 0.0, 0.0]).offset.tolist()
rc.tune(CHAIN, vary="links[0].mass", angular_speed=2.6).value
[method["name"] for method in rc.explain(RODS, 2).to_dict()["methods"]]
rc.Cord(1.0, mass=0.2, density=lambda s: 1 + s).mass
rc.steady_shapes(rc.Cord(1.0), angular_speed=9.0)[0].offset.tolist()
rc.steady_shapes(rc.Cord(1.0), angular_speed=9.0)[0].stability().verdict
rc.steady_shapes(rc.Held(rc.Cord(1.0), span=0.5), angular_speed=9.0)[0].offset.tolist()
rc.branches(rc.Held(rc.Cord(1.0), span=0.5), max_angular_speed=9.0)[0].conical_height.tolist()
rc.conical_pendulum.height(3.0)
rc.two_links.two_plummets_from_the_middle(1.0, 0.3, 3.0).tolist()
rc.bell_and_clapper.__name__
rc.GyrostaticString.__name__
rc.load_scene(SCENE).system().describe()
"""
NEEDS_GSL = """
rc.modes(rc.Cord(1.0), 2)
rc.modes(rc.Held(rc.Cord(1.0, weight=1.0), tension=3.0), 2)
rc.count_modes(rc.Cord(1.0), angular_speed=9.0)
rc.branches(rc.Cord(1.0), max_angular_speed=9.0)
rc.branch(rc.Cord(1.0), 1, max_angular_speed=9.0)
rc.steady_shape(rc.Cord(1.0), lowest_inclination=0.3)
rc.swing(rc.Cord(1.0), [0.5], offset=lambda s: 0.1 * (1 - s))
rc.elliptic.jacobi(1.0, modulus=0.5)
rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=0.3)
rc.SkippingRope(span=1.0, length=1.5)
rc.TortuousRope(least_radius=0.1, greatest_radius=0.3, angular_speed=5.0, tension=2.0)
"""
SETUP = f"""
import revchain as rc
SCENE = {str(ROOT / "examples/scenes/watch_chain.toml")!r}
CHAIN, RODS = rc.Chain(mass=[1.0, 3.0], length=1.0), rc.Chain.uniform_rods(5, length=1.0, mass=1.0)
RIG = rc.Rig(CHAIN, support=rc.Support(radius=0.2), flywheels=rc.Flywheel(momentum=0.1))
"""
ANSWER = """
import json, sys
answers = []
for line in sys.stdin.read().split("\\n"):
    try:
        answers.append(eval(line))
    except ImportError as error:
        answers.append(f"ImportError: {error}")
print(json.dumps([rc.__file__, answers], default=repr))
"""


def answers(lines, folder=None):
    environment = os.environ | ({} if folder is None else {"PYTHONPATH": str(folder)})
    command = [sys.executable, "-c", SETUP + ANSWER]
    done = subprocess.run(command, input=lines.strip(), capture_output=True, text=True, env=environment, timeout=300)
    assert done.returncode == 0, done.stderr
    place, found = json.loads(done.stdout)
    assert folder is None or Path(place).is_relative_to(folder)
    return dict(zip(lines.strip().split("\n"), found, strict=True))


@pytest.fixture(scope="module")
def without_gsl(tmp_path_factory):
    if not (BUILD / "CMakeCache.txt").exists() or shutil.which("cmake") is None:
        pytest.skip("needs cmake and the build folder of ./run or ./test")
    build = ["cmake", "--build", str(BUILD), "--target", "core_without_gsl"]
    done = subprocess.run(build, capture_output=True, text=True, timeout=1200)
    assert done.returncode == 0, done.stdout + done.stderr
    folder = tmp_path_factory.mktemp("without_gsl")
    shutil.copytree(Path(revchain.__file__).parent, folder / "revchain", ignore=shutil.ignore_patterns("_core.*.so", "include"))
    for module in BUILD.glob("bindings/without_gsl/_core*"):
        shutil.copy(module, folder / "revchain")
    return folder


def test_the_module_has_no_gsl(without_gsl):
    (module,) = (without_gsl / "revchain").glob("_core.*.so")
    assert b"gsl_sf_" not in module.read_bytes()


def test_what_needs_no_special_functions_gives_the_same_answers(without_gsl):
    assert answers(SAME, without_gsl) == answers(SAME)


def test_the_rest_names_the_reason(without_gsl):
    for line, answer in answers(NEEDS_GSL, without_gsl).items():
        assert str(answer).startswith("ImportError: revchain was built without GSL (REVCHAIN_ANALYTIC=OFF)"), (line, answer)


def test_the_command_line_names_the_reason(without_gsl, tmp_path):
    cord = tmp_path / "cord.toml"
    cord.write_text("[cord]\nlength = 1\nmass = 1\n")
    watch = ROOT / "examples/scenes/watch_chain.toml"
    for arguments, code, said in ((["modes", cord], 2, "built without GSL"), (["run", watch, "--out", tmp_path / "out"], 0, "")):
        command = [sys.executable, "-m", "revchain", *map(str, arguments)]
        environment = os.environ | {"PYTHONPATH": str(without_gsl)}
        done = subprocess.run(command, capture_output=True, text=True, env=environment, timeout=300)
        assert done.returncode == code and said in done.stderr and "Traceback" not in done.stderr, done.stderr
