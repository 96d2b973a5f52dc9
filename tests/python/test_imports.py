# SPDX-License-Identifier: GPL-3.0-or-later
"""What `import revchain` brings along, and what works without the extras."""

import re
import tomllib
from pathlib import Path

import pytest

import revchain as rc

OPTIONAL = ["matplotlib", "msgspec", "typer", "rich", "xarray", "h5netcdf", "h5py", "pint", "scipy", "mpmath", "pandas"]
OPTIONAL += ["pyarrow", "dask", "distributed", "PIL", "imageio_ffmpeg", "mujoco"]


def test_importing_and_solving_need_numpy_only(python):
    """So that each of the others may be missing."""
    call = "revchain.modes(revchain.Chain.uniform_rods(3)).status"
    done = python("-c", f"import sys, revchain; print({call}, [name for name in {OPTIONAL} if name in sys.modules])")
    assert done.stdout == "success []\n", done.stderr


def test_everything_but_the_extras_works_without_them(python, without):
    program = without(*OPTIONAL) + (
        "import revchain as rc, pickle\n"
        "m = rc.modes(rc.Chain.uniform_rods(12), count=3)\n"
        "m.save('a.npz'); assert rc.load('a.npz') == m and rc.load('a.npz').system == m.system\n"
        "repr(m); m._repr_html_(); m.to_dict(); pickle.loads(pickle.dumps(m)); rc.__version__\n"
        "rc.modes(rc.Cord(1.0), 3).nodes; rc.conical_pendulum.period(1.0)\n"
        "for attempt in (m.plot, m.system.plot, m.to_xarray, lambda: m.save('a.nc'), lambda: rc.load('a.nc')):\n"
        "    open('a.nc', 'w').close()\n"
        "    try: attempt()\n"
        "    except ImportError as error: print(error)\n"
        "try: rc.Scene\n"
        "except AttributeError as error: print(error)\n"
        "assert not hasattr(rc, 'load_scene')\n"
        "from revchain import *\n"
    )
    done = python("-c", program)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines[:2] == ['plotting needs matplotlib: pip install "revchain[plot]"'] * 2
    assert lines[2] == 'to_xarray needs xarray: pip install "revchain[netcdf]"'
    assert lines[3].endswith('pip install "revchain[netcdf]"') and lines[4].endswith('pip install "revchain[netcdf]"')
    assert lines[5] == "a scene file needs msgspec: pip install msgspec"


def test_names():
    assert all(getattr(rc, name) is not None for name in dir(rc))
    assert re.fullmatch(r"\d+\.\d+\.\d+\S*", rc.__version__)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        rc.nothing  # noqa: B018


def test_what_is_shipped():
    folder = Path(rc.__file__).parent
    for name in ("py.typed", "_core.pyi", "scenes/new_scene.toml", "studies/new_study.toml"):
        assert (folder / name).is_file()
    for path in folder.rglob("*.py"):
        assert path.read_text(encoding="utf-8").startswith("# SPDX-License-Identifier: GPL-3.0-or-later\n"), path


def test_messages_name_extras_that_exist(repository):
    extras = tomllib.loads((repository / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    for path in (repository / "src/revchain").rglob("*.py"):
        for _, extra in re.findall(r'require\("([\w.]+)", "(\w+)"', path.read_text(encoding="utf-8")):
            assert extra in extras, (path, extra)
