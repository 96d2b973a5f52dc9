# SPDX-License-Identifier: GPL-3.0-or-later
"""A solved scene as a table for the terminal, as JSON and as CSV."""

from __future__ import annotations

import csv
import io
import json

from rich import box
from rich.console import Group
from rich.table import Table
from rich.text import Text

from ._modes import Modes
from ._tables import digits, which

MOST_ROWS = 20
NARROWEST = 80  # columns of a terminal; numbers are never cut to fit into fewer


def table(modes: Modes, title: str, gravity: float) -> Group:
    """The table with its heading."""
    chain = modes.chain
    links = f"{chain.size:,} link" + ("s" if chain.size > 1 else "")
    heading = Text(title, style="bold")
    facts = Text(
        f"{links}, length {chain.total_length:.6g} m, weight {chain.total_weight:.6g} N, gravity {gravity:.6g} m/s²\n"
        f"{which(modes)} by {modes.method}: "
    )
    met = modes.status == "success"
    facts.append("success" if met else modes.status.replace("_", " "), style="green" if met else "bold yellow")

    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for name, unit in (("mode", ""), ("speed", "rad/s"), ("speed", "rev/min"), ("period", "s"), ("height", "m")):
        grid.add_column(f"{name}\n{unit}", justify="right", no_wrap=True)
    grid.add_column("error\nbound", justify="right", no_wrap=True)
    grid.add_column("nodes\nm from the free end", no_wrap=True)
    speed = modes.angular_speed(gravity)
    turns = 60 * modes.revolutions_per_second(gravity)
    period = modes.period(gravity)
    for k in range(min(len(modes), MOST_ROWS)):
        grid.add_row(
            f"{modes.number[k]}",
            digits(speed[k], 6),
            digits(turns[k], 6),
            digits(period[k], 6),
            digits(modes.conical_height[k], 10),
            f"{modes.error_bound[k]:.1e}",
            _nodes(modes, k),
        )
    parts: list[Text | Table] = [heading, facts, grid]
    if modes.certificate is not None:
        parts.append(_proof(modes))
    hidden = len(modes) - MOST_ROWS
    if hidden > 0:
        parts.append(Text(f"and {hidden:,} more; --json and --csv write all of them", style="dim"))
    parts.append(Text("height: of the equivalent conical pendulum; error bound: relative, of the height", style="dim"))
    return Group(*parts)


def _proof(modes: Modes) -> Table:
    """The certificate: ends of each interval to all their digits, and the counts there."""
    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for name in ("mode", "height is above\nm", "and up to\nm", "proved: so many\nare above", "and above\nthe latter"):
        grid.add_column(name, justify="right", no_wrap=True)
    proof = modes.certificate
    assert proof is not None
    for k in range(min(len(modes), MOST_ROWS)):
        ends = (f"{proof.lower[k]:.17g}", f"{proof.upper[k]:.17g}")
        grid.add_row(f"{modes.number[k]}", *ends, f"{proof.above_lower[k]}", f"{proof.above_upper[k]}")
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


def json_text(modes: Modes, title: str, gravity: float) -> str:
    """Everything but the shapes; numbers with all their digits."""
    return json.dumps({"title": title, **modes.to_dict(gravity, shapes=False)}, indent=2, ensure_ascii=False) + "\n"


def csv_text(modes: Modes, gravity: float) -> str:
    """One line for each mode; the positions of the nodes separated by blanks."""
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
