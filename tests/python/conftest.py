# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference every height is measured against, and places and ways to run things."""

from __future__ import annotations

import contextlib
import os
import runpy
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import Any

import mpmath as mp
import pytest
import tier
from exact import heights_of, stored_links
from hypothesis import HealthCheck, settings

settings.register_profile(
    "revchain", deadline=None, max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
settings.load_profile("revchain")

ULP = 2.0**-52
DESELECTED = pytest.StashKey[Counter[str]]()


def pytest_configure(config: pytest.Config) -> None:
    tier.QUICK = "not slow" in config.option.markexpr
    config.stash[DESELECTED] = Counter()


def module(nodeid: str) -> str:
    return Path(nodeid.partition("::")[0]).stem


def pytest_deselected(items: list[pytest.Item]) -> None:
    """Counts what is left out of each module: by -m "not slow", or by -k."""
    for item in items:
        item.config.stash[DESELECTED][module(item.nodeid)] += 1


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    """Takes the counts from a worker of xdist. All workers leave out the same cases, so that they are not added up."""
    node.config.stash[DESELECTED] |= Counter(getattr(node, "workeroutput", {}).get("deselected", {}))


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report(collector: pytest.Collector) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """A module without a test, such as one whose only class has the wrong name, fails."""
    report = yield
    if isinstance(collector, pytest.Module) and report.passed and not report.result:
        report.outcome, report.longrepr = "failed", f"{collector.nodeid}: there is no test in this module"
    return report


def cases(terminalreporter: pytest.TerminalReporter) -> dict[str, int]:
    """How many cases of each module ran; skipped ones did not."""
    ran: dict[str, int] = {}
    for outcome, reports in terminalreporter.stats.items():
        for report in reports:
            if isinstance(report, pytest.TestReport):
                name = module(report.nodeid)
                ran[name] = ran.get(name, 0) + (outcome in ("passed", "failed", "xfailed", "xpassed"))
    return ran


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    ran, left_out = cases(terminalreporter), terminalreporter.config.stash[DESELECTED]
    counts = (f"{name} {ran.get(name, 0)}" + f" ({left_out[name]} deselected)" * (name in left_out) for name in sorted({*ran, *left_out}))
    terminalreporter.write_line("cases: " + ", ".join(counts))
    for name in (name for name, count in ran.items() if not count):
        terminalreporter.write_line(f"{name}: no case ran, all were skipped", red=True)


def pytest_sessionfinish(session: pytest.Session) -> None:
    """A module of which all cases were skipped fails; not one that needs a package that is not installed, or is deselected."""
    if hasattr(session.config, "workeroutput"):  # of a worker of xdist
        session.config.workeroutput["deselected"] = dict(session.config.stash[DESELECTED])
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if reporter is not None and 0 in cases(reporter).values():
        session.exitstatus = pytest.ExitCode.TESTS_FAILED


@pytest.fixture(scope="session")
def repository() -> Path:
    """The checkout these tests lie in."""
    return Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def claims(repository: Path) -> dict[str, Any]:
    """The functions of tools/claims.py by name."""
    return runpy.run_path(str(repository / "tools/claims.py"))


@pytest.fixture(scope="session")
def exact_heights() -> Callable:
    """All conical heights of the stored numbers, 50 digits."""

    def heights(chain):
        with mp.workdps(50):
            return heights_of(stored_links(chain))[: chain.mode_count]

    return heights


@pytest.fixture(scope="session")
def worst_in_bounds() -> Callable:
    """The largest (relative error) / (error bound) over the modes of a result."""

    def worst(result, exact):
        with mp.workdps(50):
            return max(
                abs(mp.mpf(float(height)) / truth - 1) / mp.mpf(float(bound))
                for height, bound, truth in zip(result.conical_height, result.error_bound, exact, strict=False)
            )

    return worst


@pytest.fixture
def run(capsys):
    """Run a command line in this process: exit code, stdout, stderr."""
    app = pytest.importorskip("revchain.cli.app")

    def call(*arguments):
        code = app.run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        assert "Traceback" not in captured.err
        return code, captured.out, captured.err

    return call


@pytest.fixture
def python(tmp_path) -> Callable:
    """Run a program in a fresh interpreter, in an empty folder, warnings being errors."""

    def run(*arguments, **options):
        environment = {**os.environ, "COLUMNS": "100", "PYTHONWARNINGS": "error"}
        if folders := environment.get("PYTHONPATH"):  # else a relative one would let another revchain be found there
            environment["PYTHONPATH"] = os.pathsep.join(map(os.path.abspath, folders.split(os.pathsep)))
        return subprocess.run(
            [sys.executable, *map(str, arguments)],
            **{"cwd": tmp_path, "env": environment, "capture_output": True, "text": True, "timeout": 60, **options},
        )

    return run


BLOCKER = """
import sys
class Blocker:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {blocked!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Blocker())
"""


@pytest.fixture(scope="session")
def without() -> Callable:
    """Python code that makes packages unimportable."""
    return lambda *blocked: BLOCKER.format(blocked=set(blocked))


@pytest.fixture(scope="session", autouse=True)
def hear_ctrl_c() -> None:
    """Programs started in the background by a shell ignore Ctrl-C, and so would all that the tests start."""
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(autouse=True)
def close_figures() -> Iterator[None]:
    """Close what the test drew: pyplot keeps its figures, and warns of the twenty-first whichever test drew the others."""
    yield
    if pyplot := sys.modules.get("matplotlib.pyplot"):
        pyplot.close("all")


@pytest.fixture
def start() -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start a program to be watched and interrupted; it and its pipes are gone after the test, whatever happens."""
    with contextlib.ExitStack() as stack:

        def run(*command: str, **options: Any) -> subprocess.Popen[str]:
            process = stack.enter_context(subprocess.Popen(command, **{"text": True, **options}))
            stack.callback(process.kill)
            return process

        yield run
