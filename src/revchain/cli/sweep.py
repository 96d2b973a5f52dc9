# SPDX-License-Identifier: GPL-3.0-or-later
"""The command that computes studies: many variations of a scene."""

from __future__ import annotations

import re
import sys
import time
import warnings
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import typer

from ..plots.sweep import in_speed_unit, plot_sweep, why_not_drawn
from ..results.files import written_aside
from ..studies.plan import columns_of, said
from ..studies.study import Study, load_study
from ..studies.sweep import check_output, columns
from ..studies.sweep import sweep as compute
from . import ExitCode
from .frame import Speed, Stop, app, check_speed, checked_picture, epilog, guarded, save_picture
from .progress import counted

if TYPE_CHECKING:
    from xarray import Dataset

SENTENCES = 5  # number of refused points that are shown


@app.command(epilog=epilog("sweep"))
@guarded
def sweep(
    study: Annotated[
        Path,
        typer.Argument(metavar="STUDY", help="Study file (.toml or .json); [b]revchain new --study[/b] writes one."),
    ],
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="File for the results: .csv, .parquet, .xlsx or .nc; STUDY.csv here if left out."),
    ] = None,
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Picture: .png, .svg or .pdf.")] = None,
    workers: Annotated[int | None, typer.Option(metavar="K", min=1, help="Number of threads or processes.")] = None,
    processes: Annotated[bool, typer.Option("--processes", help="Use processes instead of threads.")] = False,
    speed: Speed = None,
    chunk: Annotated[
        int | None, typer.Option(metavar="K", min=1, help="Number of points computed and stored together.")
    ] = None,
    check: Annotated[bool, typer.Option("--check", help="Only print what would be computed.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print no summary and no progress bar.")] = False,
) -> None:
    """Compute many variations of a scene; an interrupted run continues where it stopped."""
    given = load_study(study)
    check_speed(speed)
    if check:
        print("\n".join(_plan(given, str(study))))
        return
    if plot is not None:
        checked_picture(plot)
        if reason := why_not_drawn(given._plan(str(study))):
            raise Stop(f"--plot: {reason}", ExitCode.WRONG_USAGE)
    out = Path(f"{study.stem}.csv") if out is None else out
    if out.resolve() == study.resolve():
        raise Stop(f"--out: {study}: the study itself would be overwritten", ExitCode.WRONG_USAGE)
    try:
        check_output(out, given._plan(str(study)).points)
    except ValueError as error:
        raise Stop(f"--out: {error}", ExitCode.WRONG_USAGE) from None
    began = time.perf_counter()
    with ExitStack() as stack:
        if plot is not None:  # opened before the computation, so that a wrong path is an error at once
            out.parent.mkdir(parents=True, exist_ok=True)  # the picture may go there, too
            [picture] = stack.enter_context(written_aside(plot))
        pool = stack.enter_context(ProcessPoolExecutor(workers, get_context("spawn"))) if processes else None
        told = counted(stack, "points", quiet)
        try:
            with warnings.catch_warnings():
                warnings.showwarning = lambda message, *_: print(f"revchain: {message}", file=sys.stderr)
                warnings.simplefilter("always", UserWarning)
                found = compute(given, out=out, executor=pool, workers=workers, chunk=chunk, progress=told)
        except KeyboardInterrupt:
            raise Stop(f"interrupted; repeat the command to continue from {out}.partial", ExitCode.INTERRUPTED) from None
        if speed is not None:
            found.attrs["speed_unit"] = speed
        if plot is not None:
            save_picture(plot_sweep(found), given.title or study.stem, picture)
    if not quiet:
        print("\n".join(_summary(found)))
        print(f"wrote {out}: {found['status'].size:,} points in {time.perf_counter() - began:.3g} s")
        if plot is not None:
            print(f"wrote {plot}")
    _complain(found, given)


def _plan(study: Study, source: str) -> list[str]:
    plan = study._plan(source)
    lines = [f"{source}: valid: {plan.points:,} points, {'one by one' if plan.links is None else 'in batches'}"]
    for axis in plan.axes:
        if axis.values is None:
            what = f"{axis.law}, " + " and ".join(f"{number:g}" for number in axis.law_numbers)
        else:
            ends = [value if isinstance(value, str) else f"{value:g}" for value in axis.values[[0, -1]].tolist()]
            what = f"{axis.values.size:,} values, {ends[0]} to {ends[1]}"
        lines.append(f"  {axis.name}: {what}")
    for name, labels in plan.outputs.items():
        for stored in said(plan, name):
            names = columns_of(stored, labels)
            lines.append(f"  finds {' … '.join(dict.fromkeys([names[0], names[-1]]))}")
    return lines


def _summary(found: Dataset) -> list[str]:
    lines: list[tuple[str, ...]] = [("column", "least", "median", "largest")]
    unit = found.attrs.get("speed_unit")
    speeds = [str(key) for key, array in found.variables.items() if array.attrs.get("units") == "rad/s"] if unit else []
    table = in_speed_unit(found, unit)
    if unit == "s":  # the lowest speed has the longest period
        periods = {str(key): _as_period(str(key)) for key, array in found.data_vars.items() if "path" not in array.attrs}
        order = [_opposite(name) if _opposite(name) in periods else name for name in map(str, found.data_vars)]
        periods = {name: said for name, said in periods.items() if name in speeds and said != name}
        if not {*periods.values()} & ({*map(str, found.variables)} - {*periods}):  # find = ["modes", "period"] has both
            table = table[order].rename(periods)
            speeds = [periods.get(name, name) for name in speeds]
    for name, values in list(columns(table).items())[1:-1]:
        if re.sub(r"_\d+$", "", name) in speeds or name in speeds:
            name = f"{name} ({unit})"
        there: Any = values[np.isfinite(values)] if values.dtype.kind in "fi" else ()
        if len(there):
            lines.append((name, *(f"{number:.5g}" for number in (there.min(), np.median(there), there.max()))))
    wide = [max(map(len, column)) for column in zip(*lines, strict=True)]
    rows = ["  ".join([line[0].ljust(wide[0]), *map(str.rjust, line[1:], wide[1:])]) for line in lines]
    points = found["status"].size
    return [f"Study of {points:,} point{'s' * (points != 1)}", *rows]


def _opposite(name: str) -> str:
    """The name of the other end of an interval of speeds."""
    end, _, rest = name.partition("_")
    other = {"lowest": "highest", "highest": "lowest"}.get(end)
    return f"{other}_{rest}" if other and rest in ("angular_speed", "reached") else name


def _as_period(name: str) -> str:
    return _opposite(name).replace("angular_speed", "period")


def _complain(found: Dataset, study: Study) -> None:
    """Raise Stop with the points that have no numbers or no proof."""
    status = found["status"].to_numpy().ravel()
    unmet, refused = np.count_nonzero(status == 2), np.flatnonzero(status == 3)
    parts = [f"{refused.size:,} points are refused"] if refused.size else []
    parts += [f"at {unmet:,} points something is not proved"] if unmet else []
    lines = [f"\n  point {point:,}: {study._refusal(point)}" for point in refused[:SENTENCES].tolist()]
    if parts:
        raise Stop("; ".join(parts) + "".join(lines), ExitCode.TOLERANCE_NOT_MET)
