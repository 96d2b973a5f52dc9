# SPDX-License-Identifier: GPL-3.0-or-later
"""The command that computes studies: many variations of a scene."""

from __future__ import annotations

import sys
import time
import warnings
from concurrent.futures import Executor
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from ..plots.sweep import why_not_drawn
from ..results.files import written_aside
from ..studies.result import SweepResult
from ..studies.store import checked_ending
from ..studies.study import Study, load_study
from ..studies.sweep import dask_client
from ..studies.sweep import sweep as compute
from .exit_codes import ExitCode
from .frame import Stop, app, checked_picture, epilog, guarded, save_picture
from .progress import counted

SENTENCES = 5  # number of refused points that are shown
MAX_SHOWN = 10**7  # largest number of results with a summary


@app.command(epilog=epilog("sweep"))
@guarded
def sweep(
    study: Annotated[
        Path,
        typer.Argument(metavar="STUDY", help="Study file (.toml or .json); [b]revchain new --study[/b] writes one."),
    ],
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="File for the results: .csv, .parquet or .nc; STUDY.csv here if left out."),
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Picture: .png, .svg or .pdf.")] = None,
    dask: Annotated[
        str | None,
        typer.Option(metavar="tcp://ADDRESS|local", help="Compute on a Dask cluster; local starts one on this machine."),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(metavar="K", min=1, help="Number of threads, or of processes of the local cluster.")
    ] = None,
    chunk: Annotated[
        int | None, typer.Option(metavar="K", min=1, help="Number of points computed and stored together.")
    ] = None,
    check: Annotated[bool, typer.Option("--check", help="Only print what would be computed.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print no summary and no progress bar.")] = False,
) -> None:
    """Compute many variations of a scene; an interrupted run continues where it stopped."""
    given = load_study(study)
    if check:
        for line in _plan(given, str(study)):
            print(line)
        return
    if plot is not None:
        checked_picture(plot)
        if reason := why_not_drawn(given._plan(str(study))):
            raise Stop(f"--plot: {reason}", ExitCode.WRONG_USAGE)
    if workers is not None and dask not in (None, "local"):
        raise Stop("--workers is for this machine: a cluster has its own", ExitCode.WRONG_USAGE)
    out = Path(f"{study.stem}.csv") if out is None else out
    if out.resolve() == study.resolve():
        raise Stop(f"{study}: the study itself would be overwritten", ExitCode.WRONG_USAGE)
    began = time.perf_counter()
    with ExitStack() as stack:
        picture = None if plot is None else _picture(plot, out, stack)
        executor = None if dask is None else _executor(dask, workers, stack)
        told = counted(stack, "points", quiet)
        threads = None if executor is not None else workers
        try:
            with warnings.catch_warnings(record=True) as warned:
                warnings.simplefilter("always", UserWarning)
                found = compute(given, out=out, executor=executor, threads=threads, chunk=chunk, progress=told)
        except KeyboardInterrupt:
            raise Stop(f"interrupted; repeat the command to continue from {out}.partial", ExitCode.INTERRUPTED) from None
        except OSError:
            raise
        except ValueError as error:
            raise Stop(str(error), ExitCode.WRONG_USAGE) from None
        if picture is not None:
            save_picture(found.plot(), given.title or study.stem, picture)
    for each in warned:
        print(f"revchain: {each.message}", file=sys.stderr)
    if not quiet:
        there = f", {found.resumed:,} of them from before" if found.resumed else ""
        if len(found) * len(found.found) <= MAX_SHOWN:
            print(found)
        print(f"wrote {out}: {len(found):,} points in {time.perf_counter() - began:.3g} s{there}")
        if plot is not None:
            print(f"wrote {plot}")
    if found.count("success") < len(found):
        _complain(found)


def _plan(study: Study, source: str) -> list[str]:
    """Lines that describe what would be computed."""
    plan = study._plan(source)
    lines = [f"{source}: valid: {plan.points:,} points, {'in batches' if plan.batched else 'one by one'}"]
    for axis in plan.axes:
        if axis.values is None:
            what = f"{axis.law}, " + " and ".join(f"{number:g}" for number in axis.law_numbers)
        else:
            ends = [value if isinstance(value, str) else f"{value:g}" for value in axis.values[[0, -1]].tolist()]
            what = f"{axis.values.size:,} values, {ends[0]} to {ends[1]}"
        lines.append(f"  {axis.name}: {what}")
    columns = [
        f"{block.columns[0]} … {block.columns[-1]}" if len(block.columns) > 1 else block.columns[0]
        for block in plan.blocks
    ]
    return [*lines, *(f"  finds {column}" for column in columns)]


def _executor(address: str, workers: int | None, stack: ExitStack) -> Executor:
    try:
        client = stack.enter_context(dask_client(address, workers))
    except ImportError:
        raise
    except (OSError, ValueError, TimeoutError) as error:
        raise Stop(f"--dask: {address} does not answer: {error}", ExitCode.WRONG_USAGE) from None
    if client.cluster is not None:
        stack.callback(client.cluster.close)
    executor: Executor = client.get_executor()
    return executor


def _picture(plot: Path, out: Path, stack: ExitStack) -> Path:
    """The temporary file of the picture; it is opened before the computation, so that a wrong path is an error at once."""
    try:
        checked_ending(out)
    except ValueError as error:
        raise Stop(str(error), ExitCode.WRONG_USAGE) from None
    out.parent.mkdir(parents=True, exist_ok=True)  # the picture may go there, too
    [aside] = stack.enter_context(written_aside(plot))
    return aside


def _complain(found: SweepResult) -> None:
    """Raise Stop with the points that have no numbers or no proof."""
    refused, unmet = found.count("refused"), found.count("tolerance_not_met")
    lines = [f"point {point:,}: {reason}" for point, reason in sorted(found.refused.items())[:SENTENCES]]
    parts = [f"{refused:,} points are refused"] if refused else []
    parts += [f"at {unmet:,} points something is not proved"] if unmet else []
    raise Stop("; ".join(parts) + "".join(f"\n  {line}" for line in lines), ExitCode.TOLERANCE_NOT_MET)
