# SPDX-License-Identifier: GPL-3.0-or-later
"""A computation in its own thread, with a progress bar after a while and Ctrl-C at any time."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import ExitStack
from typing import TypeVar

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from .. import _core

PATIENCE = 2.0  # seconds before a bar is shown
TICK = 0.1  # seconds between looks
Result = TypeVar("Result")


def bar_of(what: str, console: Console, quiet: bool, *columns: ProgressColumn) -> Progress:
    shown = (TextColumn(what), BarColumn(), TextColumn("{task.percentage:3.0f} %"), TimeElapsedColumn(), *columns)
    return Progress(*shown, console=console, transient=True, disable=quiet or not console.is_terminal)


def counted(stack: ExitStack, what: str, quiet: bool) -> Callable[[int, int], None]:
    """Return a function that takes two counts, the parts done and all parts, and shows the progress."""
    bar = bar_of(what, Console(stderr=True), quiet, MofNCompleteColumn(), TimeRemainingColumn())
    task = bar.add_task(what, total=None)
    began = time.monotonic()

    def show(done: int, total: int) -> None:
        if not (bar.disable or bar.live.is_started) and time.monotonic() - began > PATIENCE:
            stack.enter_context(bar)
        bar.update(task, completed=done, total=total)

    return show


def watched(work: Callable[[_core.Progress], Result], console: Console, quiet: bool = False) -> Result:
    """Run `work` in a thread and return its result; a KeyboardInterrupt cancels it and is raised again."""
    progress = _core.Progress()
    with ThreadPoolExecutor(1) as pool:
        future = pool.submit(work, progress)
        try:
            if wait([future], PATIENCE).not_done:
                with bar_of("solving", console, quiet) as bar:
                    task = bar.add_task("solving", total=1.0)
                    while wait([future], TICK).not_done:
                        bar.update(task, completed=progress.fraction)
        except KeyboardInterrupt:
            progress.cancel()
            raise
    return future.result()
