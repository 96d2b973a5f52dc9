# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as aligned text and as HTML, for prompts and notebooks."""

from __future__ import annotations

from dataclasses import replace
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from ..systems.numbers import STANDARD_GRAVITY

if TYPE_CHECKING:
    from .modes import Modes

MOST_ROWS = 20
HEADINGS = ("mode", "conical height", "rad/s", "rev/min", "error bound", "nodes")


def digits(number: float, count: int) -> str:
    """`number` with `count` significant digits, zeros at the end kept."""
    return f"{number:#.{count}g}".removesuffix(".")


def caption(modes: Modes) -> str:
    """One sentence: how many modes of which chain, found how."""
    return f"{which(modes)}: {modes.chain!r}; {modes.method}, {modes.status.replace('_', ' ')}"


def which(modes: Modes) -> str:
    """How many modes of how many, or which where they are not the slowest."""
    total = f"{modes.chain.mode_count:,}"
    if len(modes) == 0 or modes.number[0] == 1:
        return f"{len(modes):,} of {total} modes"
    if len(modes) == 1:
        return f"mode {modes.number[0]:,} of {total}"
    return f"modes {modes.number[0]:,} to {modes.number[-1]:,} of {total}"


def rows(modes: Modes) -> list[tuple[str, ...]]:
    """The first rows as text, in the order of HEADINGS."""
    has_speed = modes.conical_height > 0  # of method="dense" rounding may leave others
    known = replace(modes, conical_height=np.where(has_speed, modes.conical_height, modes.conical_height.dtype.type(1)))
    speeds = np.where(has_speed, known.angular_speed(), np.nan)
    turns = np.where(has_speed, 60 * known.revolutions_per_second(), np.nan)
    table: list[tuple[str, ...]] = []
    for k in range(min(len(modes), MOST_ROWS)):
        nodes = "-" if modes.nodes is None else f"{modes.nodes[k].size:,}"
        numbers = (digits(modes.conical_height[k], 12), digits(speeds[k], 6), digits(turns[k], 6))
        table.append((str(modes.number[k]), *numbers, f"{modes.error_bound[k]:.1e}", nodes))
    return table


def more(modes: Modes) -> str:
    """What is said below a table that does not show every mode; empty where it does."""
    hidden = len(modes) - MOST_ROWS
    return f"... and {hidden:,} more" if hidden > 0 else ""


def text_table(modes: Modes) -> str:
    """The table a prompt shows."""
    table = [HEADINGS, *rows(modes)]
    widths = [max(len(row[column]) for row in table) for column in range(len(HEADINGS))]
    lines = ["  ".join(cell.rjust(width) for cell, width in zip(row, widths, strict=True)) for row in table]
    lines.insert(0, caption(modes))
    lines.append(f"{more(modes)}; speeds for gravity {STANDARD_GRAVITY}".removeprefix("; "))
    return "\n".join(lines)


def html_table(modes: Modes) -> str:
    """The table a notebook shows."""
    head = "".join(f"<th>{escape(heading)}</th>" for heading in HEADINGS)
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows(modes))
    foot = f"{more(modes)}; speeds for gravity {STANDARD_GRAVITY}".removeprefix("; ")
    return (
        f"<table><caption>{escape(caption(modes))}</caption><thead><tr>{head}</tr></thead>"
        f'<tbody>{body}</tbody><tfoot><tr><td colspan="{len(HEADINGS)}">{escape(foot)}</td></tr></tfoot></table>'
    )
