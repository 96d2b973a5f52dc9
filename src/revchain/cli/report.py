# SPDX-License-Identifier: GPL-3.0-or-later
"""A solved scene as a table for the terminal, as JSON and as CSV."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from rich import box
from rich.console import Group
from rich.table import Table
from rich.text import Text

from ..questions.explain import Solution
from ..questions.response import Response
from ..results.modes import Modes
from ..results.rig_modes import RigModes
from ..results.tables import MOST_ROWS, digits, which

NARROWEST = 80  # columns of a terminal; numbers are never cut to fit into fewer
_MODE_HEADINGS = ("mode\n", "speed\nrad/s", "speed\nrev/min", "period\ns", "height\nm", "error\nbound")


def empty_grid(numbers: Iterable[str], words: Iterable[str] = (), title: str | None = None) -> Table:
    """A table without rows yet: headings of columns of numbers, then of words; none of them is ever cut."""
    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True, title=title, title_justify="left")
    for heading in numbers:
        grid.add_column(heading, justify="right", no_wrap=True)
    for heading in words:
        grid.add_column(heading, no_wrap=True)
    return grid


def answer_table(found: Solution) -> Table:
    """Of each height what is known."""
    grid = empty_grid(("mode", "speed (rad/s)", "height (m)", "error bound"))
    for i, (speed, height, bound) in enumerate(
        zip(found.angular_speed, found.conical_height, found.error_bound, strict=True)
    ):
        grid.add_row(str(found.first + i), f"{speed:.12g}", f"{height:.12g}", f"{bound:.1e}")
    return grid


def table(modes: Modes | RigModes, title: str, gravity: float, carried: Response | None = None) -> Group:
    """The table with its heading."""
    if isinstance(modes, RigModes):
        return _rig_table(modes, title, carried)
    chain = modes.chain
    links = f"{chain.size:,} link" + ("s" if chain.size > 1 else "")
    facts = Text(
        f"{links}, length {chain.total_length:.6g} m, weight {chain.total_weight:.6g} N, gravity {gravity:.6g} m/s²\n"
        f"{which(modes)} by {modes.method}: "
    )
    grid = empty_grid(_MODE_HEADINGS, ["nodes, m from\nthe free end"])
    speed, period = modes.angular_speed(gravity), modes.period(gravity)
    for k in range(min(len(modes), MOST_ROWS)):
        grid.add_row(*_mode_cells(modes, k, "", speed[k], period[k]), _nodes(modes, k))
    parts: list[Text | Table] = [Text(title, style="bold"), _with_status(facts, modes), grid]
    if modes.certificate is not None:
        parts.append(_proof(modes))
    return Group(*parts, *_and_more(len(modes)), _footnote())


def _rig_table(modes: RigModes, title: str, carried: Response | None) -> Group:
    """Modes of both senses, what is no steady motion, and which links go slack."""
    chain = modes.rig.chain
    what = repr(modes.rig).partition(": ")[2]
    counts = f"{len(modes)} of {modes.forward.available + modes.backward.available} modes by {modes.method}: "
    facts = Text(f"{chain!r} in m and N, gravity {modes.gravity:.6g} m/s²\n{what}\n{counts}")
    grid = empty_grid(_MODE_HEADINGS)
    speed, period = modes.angular_speed(), modes.period()
    words = {1: "forward ", -1: "backward "} if modes.has_momentum else {1: ""}
    for k in range(min(len(modes), MOST_ROWS)):
        grid.add_row(*_mode_cells(modes, k, words[int(modes.sense[k])], speed[k], period[k]))
    parts: list[Text | Table] = [Text(title, style="bold"), _with_status(facts, modes)]
    if len(modes):
        parts.append(grid)
    parts += _and_more(len(modes))
    if len(modes.other):
        parts.append(_others(modes))
    for link, at in list(zip(modes.slack_link, modes.slack_speed, strict=True))[:MOST_ROWS]:
        parts.append(Text(f"link {link + 1} goes slack at {digits(at, 6)} rad/s: its wheel bears all that it carries"))
    if carried is not None:
        parts += _carried(carried)
    return Group(*parts, _footnote())


def _mode_cells(modes: Modes | RigModes, k: int, sense: str, speed: float, period: float) -> list[str]:
    """What stands under `_MODE_HEADINGS` for a mode."""
    return [
        f"{sense}{modes.number[k]}",
        digits(speed, 6),
        digits(speed * 30 / math.pi, 6),
        digits(period, 6),
        digits(modes.conical_height[k], 10),
        f"{modes.error_bound[k]:.1e}",
    ]


def _with_status(facts: Text, modes: Modes | RigModes) -> Text:
    """The facts, and at their end how it went."""
    met = modes.status == "success"
    return facts.append(modes.status.replace("_", " "), style="green" if met else "bold yellow")


def _and_more(count: int, written: str = "--json and --csv write") -> list[Text]:
    """Where a table has not all `count` rows: how many more there are."""
    hidden = count - MOST_ROWS
    return [Text(f"and {hidden:,} more; {written} all of them", style="dim")] if hidden > 0 else []


def _footnote() -> Text:
    return Text("height: of the equivalent conical pendulum; error bound: relative, of the height", style="dim")


def _carried(found: Response) -> list[Text | Table]:
    """Where the pins are while the support goes round."""
    speed = float(found.angular_speed)
    turns = f"{digits(speed, 6)} rad/s, {digits(speed * 30 / math.pi, 6)} rev/min"
    if found.resonant:
        return [Text(f"carried round at {turns}: a resonance, it goes out without bound")]
    grid = empty_grid(["pin\n0: free end", "from the axis\nm"])
    shown = list(zip(found.pins, found.offset, strict=True))
    for pin, offset in shown if len(shown) <= MOST_ROWS else [*shown[: MOST_ROWS - 1], shown[-1]]:
        grid.add_row(f"{pin}", digits(offset, 10))
    heading = Text(f"carried round at {turns}; error bound {float(found.error_bound):.1e}")
    return [heading, grid, *_and_more(len(shown), "--json writes")]


def _others(modes: RigModes) -> Table:
    """Heights that no steady motion has."""
    grid = empty_grid(["height\nm", "falls away as exp(r t)\nr in 1/s", "error\nbound"], title="no steady motion")
    other = modes.other
    for k in range(min(len(other), MOST_ROWS)):
        height = other.conical_height[k]
        shown = digits(height.real, 10) if height.imag == 0 else f"{digits(height.real, 6)} {height.imag:+.6g}i"
        grid.add_row(shown, digits(other.growth_rate[k], 6), f"{other.error_bound[k]:.1e}")
    return grid


def _proof(modes: Modes) -> Table:
    """The certificate: ends of each interval to all their digits, and the counts there."""
    ends = ("height is above\nm", "and up to\nm")
    grid = empty_grid(["mode", *ends, "proved: so many\nare above", "and above\nthe latter"])
    proof = modes.certificate
    assert proof is not None
    for k in range(min(len(modes), MOST_ROWS)):
        between = (f"{proof.lower[k]:.17g}", f"{proof.upper[k]:.17g}")
        grid.add_row(f"{modes.number[k]}", *between, f"{proof.above_lower[k]}", f"{proof.above_upper[k]}")
    return grid


def _nodes(modes: Modes, k: int) -> str:
    if modes.nodes is None:
        return "-"
    nodes = modes.nodes[k]
    if nodes.size == 0:
        return "0"
    if nodes.size <= 2:
        return f"{nodes.size}: " + "  ".join(map(_position, nodes))
    return f"{nodes.size}: {_position(nodes[0])} … {_position(nodes[-1])}"


def _position(node: float) -> str:
    return f"{node:.3g}" if node < 1000 else f"{node:.0f}"


def json_text(modes: Modes | RigModes, title: str, gravity: float, carried: Response | None = None) -> str:
    """Everything but the shapes; numbers with all their digits."""
    data = modes.to_dict(shapes=False) if isinstance(modes, RigModes) else modes.to_dict(gravity, shapes=False)
    if carried is not None:
        numbers = {name: float(getattr(carried, name)) for name in ("angular_speed", "support_radius", "error_bound")}
        offset = None if carried.resonant else carried.offset
        data["carried"] = {**numbers, "resonant": bool(carried.resonant), "offset": offset}
    return json_of({"title": title, **data})


def json_of(data: dict[str, Any]) -> str:
    """As JSON, which has no infinity and no NaN: null in their place."""
    return json.dumps(_plain(data), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _plain(values: Any) -> Any:
    """As Python's numbers, lists and dictionaries."""
    if isinstance(values, dict):
        return {name: _plain(value) for name, value in values.items()}
    if isinstance(values, list | tuple):
        return [_plain(value) for value in values]
    if isinstance(values, np.ndarray | np.generic):
        return _plain(values.tolist())
    return None if isinstance(values, float) and not math.isfinite(values) else values


def csv_text(modes: Modes | RigModes, gravity: float) -> str:
    """One line for each mode; the positions of the nodes separated by blanks."""
    if isinstance(modes, RigModes):
        return _rig_csv(modes)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = ["mode", "conical_height", "angular_speed", "period", "revolutions_per_minute", "error_bound"]
    table = modes.to_dict(gravity, shapes=False)["modes"]
    if modes.precision in ("extended", "double-double"):
        names.append("conical_height_low")
    proof = [] if modes.certificate is None else list(table[0]["certificate"]) if table else []
    writer.writerow([*names, "node_count", "nodes", *proof])
    for mode in table:
        nodes = mode["nodes"]
        proved = (mode["certificate"][name] for name in proof)
        writer.writerow([*(mode[name] for name in names), len(nodes), " ".join(map(repr, nodes)), *proved])
    return text.getvalue()


def _rig_csv(modes: RigModes) -> str:
    """One line for each mode, then for each height that is no steady motion, without a number."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = ["mode", "sense", "conical_height", "angular_speed", "period", "revolutions_per_minute", "error_bound"]
    writer.writerow([*names, "conical_height_imaginary", "growth_rate"])
    found = modes.to_dict(shapes=False)
    for mode in found["modes"]:
        writer.writerow([*(mode[name] for name in names), 0.0, 0.0])
    for other in found["other"]:
        real, imaginary = other["conical_height"]
        writer.writerow(["", "", real, "", "", "", other["error_bound"], imaginary, other["growth_rate"]])
    return text.getvalue()
