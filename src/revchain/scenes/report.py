# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a scene: one HTML file with the system, the answers, their bounds and pictures."""

from __future__ import annotations

import base64
import io
import os
import re
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from datetime import date
from functools import cache
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import UNSET, json, to_builtins

from ..closed_forms.governor import GovernorEquilibria, SleeveGovernor
from ..results.branches import Branches
from ..results.campbell import Campbell
from ..results.drag import DragShape
from ..results.explanation import Explanation
from ..results.modes import Modes
from ..results.motions import Response, Swing
from ..results.parts import Fact, parts_of
from ..results.shapes import SteadyShapes
from ..results.sheet import Column, Sheet, cells, in_unit
from ..systems.extras import require
from ..systems.numbers import file_path
from .system import Numbers, air_drag, has_air_drag, in_file
from .tables import AskDrag

if TYPE_CHECKING:
    from .scene import Scene

MANY_TIMES = 12
MOST_SHOWN, MOST_HIDDEN = 40, 2000  # rows of a table that are printed, and of one that opens on request
MOST_NAMED = 3  # modes in the main results
MOST_CROSSINGS = 4
MOST_RUNS = 30  # rows of the table of links
MOST_JUDGED = 60  # links of a system whose shapes are tested for stability
MOST_TEXT = 200_000  # letters of a scene
TITLES = {
    "modes": "Whirl speeds and mode shapes",
    "shapes": "Steady shapes",
    "response": "Forced motion",
    "swing": "Motion in time",
    "branches": "Branches of steady shapes",
    "campbell": "Campbell diagram",
    "drag": "Steady shape in air",
    "equilibria": "Equilibria of the governor",
}
MEANINGS = {
    "modes": "At each of these speeds the system can whirl about the vertical axis as one rigid figure. A system without flywheels "
    "that hangs on the axis also swings in a plane with the same period.",
    "shapes": "Each row is a shape in which the whole system turns about the vertical axis as one rigid figure, at any inclination.",
    "response": "The steady motion of each pin while the support is moved. Negative offsets are opposite to the drive.",
    "swing": "Small oscillations, as a sum of the natural modes.",
    "branches": "Each branch is a family of steady shapes that changes continuously with the speed.",
    "campbell": "Frequencies of small motion about the steady shape while it turns. Resonance is possible where one of them meets a "
    "multiple of the speed.",
    "drag": "The shape in which the system is carried round through still air, and the torque that this takes.",
    "equilibria": "Inclinations at which the arms stay while the shaft turns at this speed.",
}
DAMPED = (
    "Each row is a motion of small amplitude from which dashpots or drag take energy: it oscillates with this period and decays, or "
    "only decays where the speed is 0. Where the decay time is negative it grows. None is a steady whirl."
)
ON_TROLLEY = (
    "Natural motions",
    "Each mode is a natural swing in a vertical plane, while the trolley rolls freely along its rails. It has one period.",
)
STABILITY = {
    "minimum": "stable, also with friction at the pins",
    "spectrally stable": "stable without friction; friction at the pins can make it unstable",
    "unstable": "unstable: a small disturbance grows",
    "undecided": "not decided within the error of computation",
}
TERMS = {
    "conical height": "Gravity over the square of the speed: the height of the conical pendulum that turns at this speed.",
    "half wave": "A part of the shape between two crossings of the axis; the upper end counts as one.",
    "node": "A point of a mode that stays on the axis.",
    "error bound": "The true value differs from the printed one by at most this amount. It covers rounding, not the data.",
}

def further_sheets(found: Any) -> list[Sheet]:
    """Return the tables beside that of an answer, such as a proof or stability windows."""
    sheets: list[Sheet] = []
    for name in ("certificate", "other", "governor"):
        part = getattr(found, name, None)
        if part is not None and (name != "other" or len(part)):
            sheets.append(part._sheet())
    if getattr(found, "_stability", False):
        sheets.append(found.stability_windows()._printed())
    if isinstance(found, Response) and found.angular_speed.size == 1:
        sheets.append(_pins(found))
    return sheets


def _pins(found: Response) -> Sheet:
    """The offset of each pin at one speed."""
    offset, numbers = np.atleast_1d(found.offset.reshape(-1)), np.atleast_1d(found.pins)
    names = [found.system._pin_name(int(pin)) for pin in numbers]
    named = getattr(found.system._base, "names", None) is not None
    pins = Column("pin", numbers, "pin" if named else "pin (0: free end)", shown=names if named else None, left=named)
    columns = [pins, Column("offset", np.abs(offset) if np.iscomplexobj(offset) else offset, "from the axis (m)", 10)]
    if np.iscomplexobj(offset):
        phase = np.angle(offset)
        columns.append(Column("phase", phase, "ahead (°)", 4, shown=np.degrees(phase), unit="rad"))
    return Sheet("pin", "a resonance: it goes out without bound" if found.resonant else "", columns)


def drawn(found: Any) -> dict[str, Any]:
    """Return how an answer is drawn: a swing at many times as offsets against time."""
    if not isinstance(found, Swing) or found.time.size <= MANY_TIMES:
        return {}
    size = found.system.size
    return {"kind": "time", "pins": sorted({0, size // 3, 2 * size // 3})}


def in_radians(sheet: Sheet) -> Sheet:
    """Return a sheet whose angles are printed in radians."""
    columns = [
        each._replace(heading=each.heading.replace("(°)", "(rad)"), shown=None) if "(°)" in each.heading else each
        for each in sheet.columns
    ]
    return replace(sheet, columns=columns)


def shortfall(found: Any) -> str:
    """Return a sentence about what was not found, or not proved where a proof is required; empty if nothing."""
    missing = getattr(found, "missing", ())
    if missing:
        return f"no shape was found with {', '.join(map(str, missing))} half wave{'s' * (list(missing) != [1])}"
    if found._is_good():
        return ""
    if isinstance(found, Explanation):
        best = found.chosen
        return f"no method keeps the tolerance; the best bound is {best.error_bound:.1e}" if best else "no method applies"
    if isinstance(found, Modes):
        reached = f": asked {found.rtol:g}, reached {found.error_bound.max():.1e}" if found.rtol is not None else ""
        return "the tolerance is not met" + reached
    if isinstance(found, Branches):
        return f"the branches are not proved to be all: {found.remark}"
    what = "shapes" if isinstance(found, SteadyShapes) else type(found).__name__.lower()
    return f"the {what} are not proved to be all: the search ended before its proof"


@dataclass(frozen=True)
class Verdict:
    """A sentence about an answer, and its kind: ``"proved"``, ``"computed"`` (without a proof) or ``"open"``."""

    kind: str
    sentence: str


WORDS = {"proved": "Proved", "computed": "Computed", "open": "Not proved"}


def verdicts(found: Any) -> list[Verdict]:
    """Return what is proved about an answer, and what is not, in words."""
    short = shortfall(found)
    said = [Verdict("open", _sentence(short))] if short else []
    makers: dict[type, Callable[[Any], list[Verdict]]] = {
        Modes: _of_modes, SteadyShapes: _of_shapes, Response: _of_response, Swing: _of_swing, Branches: _of_branches,
        Campbell: _of_campbell, DragShape: _of_drag, GovernorEquilibria: _of_governor,
    }  # fmt: skip
    return [*said, *makers.get(type(found), lambda _: [])(found)]


def _of_modes(found: Modes) -> list[Verdict]:
    if not len(found) and found._beyond_window:
        return [Verdict("proved", "No mode is in this window.")] if found._is_good() else []
    if not len(found):
        return [Verdict("proved", "There is no whirl of small amplitude: no speed is missing.")] if found._is_good() else []
    what = "exponent" if found._is_damped else "speed"
    worst = float(np.max(np.asarray(found.error_bound if found._is_damped else found.speed_error_bound, float)))
    if not np.isfinite(worst):
        return [Verdict("open", f"Not every {what} has an error bound.")]
    said = [Verdict("proved", f"The rounding error of each {what} is at most {worst:.1e} of its value.")]
    if found.complete and found._is_good():
        from_on = "up to" if int(np.min(found.number)) == 1 else "between the first and"
        said.append(Verdict("proved", f"No mode is missing {from_on} the last one listed."))
    return said


def _of_shapes(found: SteadyShapes) -> list[Verdict]:
    said = []
    posture = {"hanging": "hanging ", "given": ""}.get(found._posture(), "")
    if found.mode is not None:
        said.append(Verdict("computed", f"Only the branch of mode {found.mode} was searched."))
    elif found.complete:
        more = " Shapes with links above their pins were not searched for." if posture else ""
        said.append(Verdict("proved", f"Complete: there is no other {posture}shape at this speed.{more}"))
    elif found._links_lean:
        more = " Shapes that leave the plane were not searched for."
        said.append(Verdict("proved", f"There is no other {posture}shape in a plane with the axis at this speed.{more}"))
    elif not shortfall(found):
        said.append(Verdict("open", "There may be more shapes: completeness is not proved."))
    if len(found):
        worst = max(float(shape.error_bound) for shape in found)
        kind = "proved" if all(shape.proved for shape in found) else "computed"
        said.append(Verdict(kind, f"The error of each inclination is at most {worst:.1e} rad{'' if kind == 'proved' else ' (an estimate)'}."))
    if 0 < len(found) <= 8 and found.system.size <= MOST_JUDGED:
        judged = [_stability(shape) for shape in found]
        said += [Verdict("computed", f"Shape {k} is {words}.") for k, words in enumerate(judged, 1) if words]
    return said


def _stability(shape: Any) -> str:
    """The stability of a shape in words; empty where it cannot be found."""
    try:
        return STABILITY.get(shape.stability().verdict, "")
    except (AttributeError, ValueError, ArithmeticError):
        return ""


def _of_response(found: Response) -> list[Verdict]:
    error = np.asarray(found._error, float)
    kind = "computed" if found.error_bound is None else "proved"
    said = []
    if (finite := error[np.isfinite(error)]).size:
        words = "The error of each offset is at most" if kind == "proved" else "The error of each offset is estimated at"
        said.append(Verdict(kind, f"{words} {finite.max():.1e} of the largest offset."))
    if np.any(found.resonant):
        said.append(Verdict("open", "At a resonance the offsets grow without bound; a dashpot would limit them."))
    said.append(Verdict("computed", "The motion is of small amplitude: offsets must stay small compared with the length."))
    return said


def _of_swing(found: Swing) -> list[Verdict]:
    if found.error_bound is not None and np.isfinite(worst := float(found.error_bound.max())):
        said = [Verdict("proved", f"The rounding error of each offset is at most {worst:.1e} m.")]
    elif found.error_estimate is not None:
        said = [Verdict("computed", f"The error of each offset is estimated at {float(found.error_estimate.max()):.1e} m.")]
    else:
        said = [Verdict("computed", f"The error of each offset is estimated at {float(np.max(found.truncation_error)):.1e} m.")]
    return [*said, Verdict("computed", "The motion is of small amplitude.")]


def _of_branches(found: Branches) -> list[Verdict]:
    if not getattr(found, "complete", False):
        remark = f" {_sentence(found.remark)}" if hasattr(found, "remark") else ""
        return [] if not found._is_good() else [Verdict("open", f"There may be more branches.{remark}")]
    more = " Branches with links above their pins were not searched for." if found._of_shapes == "hanging shapes" else ""
    return [Verdict("proved", f"Complete: no branch of {found._of_shapes} is missing up to this speed.{more}")]


def _of_campbell(found: Campbell) -> list[Verdict]:
    stable = "The steady shape is stable at each of these speeds."
    return [Verdict("computed", stable if np.all(found.stable) else "The steady shape is unstable, or none was found, at some speeds.")]


def _of_drag(found: DragShape) -> list[Verdict]:
    error = f"The error of each direction is estimated at {found.error_estimate:.1e} rad."
    return [Verdict("computed", error)] if found.status == "success" else []


def _of_governor(found: GovernorEquilibria) -> list[Verdict]:
    count = len(found)
    return [Verdict("proved", f"Complete: the governor has {count} equilibri{'um' if count == 1 else 'a'} at this speed.")]


def finding(found: Any) -> str:
    """Return the main result in a line."""
    if isinstance(found, Modes) and len(found):
        first = []
        for row in range(min(len(found), MOST_NAMED)):
            speed, period = float(found.angular_speed[row]), float(found.period[row])
            periods, unit = f"period {period:.4g} s", "s" if is_on_trolley(found.system) else found._speed_unit
            way = " forward" * (speed > 0) + " backward" * (speed < 0) if found.has_momentum else ""
            words = f"{periods} ({abs(speed):.4g} rad/s)" if unit == "s" else f"{_speed(abs(speed), unit)[:-1]}, {periods})"
            if found._is_damped:
                decay = float(found.decay_time[row])
                words = f"{words}, " * (speed != 0) + f"{'decays' if decay > 0 else 'grows'} in {abs(decay):.4g} s {'to 1/e' if decay > 0 else 'by a factor e'}"
            first.append(f"mode {found.number[row]}{way}: {words}")
        more = f"; {len(found) - MOST_NAMED} more" if len(found) > MOST_NAMED else ""
        return _sentence("; ".join(first) + more)
    if isinstance(found, Modes) and found._is_good():
        rate = float(found.other.growth_rate.max(initial=0.0)) / np.log(2) if len(found.other) else 0.0
        return "There is no whirl of small amplitude" + (f"; a small push doubles every {1 / rate:.2g} s." if rate else ".")
    if isinstance(found, Response):
        return _of_one_speed(found) if found.angular_speed.size == 1 else _of_speeds(found)
    if isinstance(found, Campbell) and found.crossings:
        each = [f"{one.order}n meets frequency {one.motion} at {one.rpm:.4g} rpm" for one in found.crossings[:MOST_CROSSINGS]]
        return f"Possible resonances: {'; '.join(each)}{'; and more' * (len(found.crossings) > MOST_CROSSINGS)}."
    heading = found._printed().heading
    text = heading.split("; with links above")[0].split(", also with links above")[0]
    return _sentence(re.sub(r"^(Branches|Campbell diagram): ", "", text)) if text else ""


def _of_one_speed(found: Response) -> str:
    if found.resonant or not np.size(found.offset):
        return "The speed is that of a resonance: the offsets grow without bound."
    speed, pins = float(found.angular_speed.item()), np.atleast_1d(found.pins)
    name = found.system._pin_name(int(pins[0]))
    far, pull = float(np.abs(found.offset.reshape(-1)[0])), float(np.abs(found.support_force.item()))
    unit = " N" if found.system.by_mass else ""
    return f"At {_speed(speed, found._speed_unit)} the {name} is {far:.4g} m off the axis; the pull on the support is {pull:.4g}{unit}."


def _of_speeds(found: Response) -> str:
    if not found.angular_speed.size:
        return ""
    unit = found._speed_unit or "rad/s"
    ends = in_unit(found.angular_speed, unit)
    at = [f"{in_unit(speed, unit):.4g}" for speed in found.whirl_speeds.tolist()]
    between = f"; resonances at {', '.join(at[:MOST_CROSSINGS])} {unit}{' and more' * (len(at) > MOST_CROSSINGS)}" if at else ""
    what = "periods" if unit == "s" else "speeds"
    return f"{found.angular_speed.size:,} {what} from {np.min(ends):.4g} to {np.max(ends):.4g} {unit}{between}."


def _speed(speed: float, unit: str | None) -> str:
    """A speed in the unit asked, with another one in brackets."""
    if unit in ("rpm", "Hz", "s"):
        return f"{'a period of ' if unit == 's' else ''}{in_unit(speed, unit):.4g} {unit} ({speed:.4g} rad/s)"
    return f"{speed:.4g} rad/s ({speed * 30 / np.pi:.4g} rpm)"


def is_on_trolley(system: Any) -> bool:
    """Return whether the support of a system is a trolley: a mass that rolls freely."""
    support = getattr(system, "_support", None)
    return support is not None and bool(support._yields) and support.stiffness == 0


def _sentence(text: str) -> str:
    text = text.strip().rstrip(".")
    return f"{text[:1].upper()}{text[1:]}." if text else ""


# ---- the page


def check_path(what: str, path: str | os.PathLike[str]) -> None:
    """Raise a ValueError if the path ends in neither .html nor .htm, and an ImportError if matplotlib is missing."""
    if Path(file_path("revchain", "the report", path)).suffix.lower() not in (".html", ".htm"):
        raise ValueError(f"{what} must end in .html, got {os.fspath(path)}; a browser prints the page to PDF")
    require("matplotlib", "plot", "a report")


def page_of(scene: Scene, answers: Mapping[str, Any], units: str = "deg", options: str = "") -> str:
    """Return the report of a scene as a page that needs no other file.

    Parameters
    ----------
    scene : Scene
        The scene.
    answers : mapping
        The result of each question, or a sentence that says why it has none.
    units : {"deg", "rad"}
        Unit of angles in tables.
    options : str
        Further options of the command that repeats the report.

    Returns
    -------
    str
        The page, HTML 5.
    """
    from .. import __version__

    name, text = scene._file()
    system, gravity = scene._built()
    title = scene.title or name.rpartition(".")[0] or name
    today = date.today().isoformat()
    about = [f"revchain {escape(__version__)}", today, f"gravity {gravity:.6g} m/s²"]
    sections = [_system(scene, system)]
    sections += [_answer(scene, question, found, units) for question, found in answers.items()]
    page = "\n".join(sections)
    terms = "".join(
        f"<dt>{escape(term.capitalize())}</dt><dd>{escape(meaning)}</dd>"
        for term, meaning in TERMS.items() if term in page.lower() or term.replace("conical ", "") + " <" in page.lower()
    )  # fmt: skip
    command = f"revchain run {_quoted(name)} --report {_quoted((name.rpartition('.')[0] or name) + '.html')}{options}"
    described = f'<p class="lead">{escape(scene.description)}</p>' if scene.description else ""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="revchain {escape(__version__)}">
<title>{escape(title)}</title>
<style>
{_style()}
</style>
</head>
<body>
<main>
<header>
<h1>{escape(title)}</h1>
<p class="about">{" · ".join(about)}</p>
{described}{_glance(answers)}
</header>
{page}
<section id="terms">
<h2>Terms</h2>
<dl>{terms}<dt>Proved</dt><dd>Follows from rigorous error bounds or from counts that cannot miss a solution.</dd>
<dt>Computed</dt><dd>Found numerically, without a proof.</dd></dl>
</section>
<section id="repeat">
<h2>How to repeat</h2>
<p>Save the text below as <code>{escape(name)}</code>, install revchain {escape(__version__)}, and run</p>
<pre class="command">{escape(command)}</pre>
<h3>The scene</h3>
<pre class="scene">{escape(text if len(text) <= MOST_TEXT else text[:MOST_TEXT] + chr(10) + "... (the file is longer)")}</pre>
</section>
<footer><p>{" · ".join(about)}. Quantities are in SI units unless a heading names another unit.</p></footer>
</main>
</body>
</html>
"""


def _quoted(name: str) -> str:
    return f'"{name}"' if re.search(r"[^\w.+/-]", name) else name


@cache
def _style() -> str:
    """The style sheet of the page, without the line of its licence."""
    return files("revchain").joinpath("scenes/report.css").read_text(encoding="utf-8").partition("\n")[2].strip()


def _glance(answers: Mapping[str, Any]) -> str:
    """The main results, each with what is known about it."""
    rows = []
    for question, found in answers.items():
        if isinstance(found, str):
            kind, words = "open", found
        else:
            kinds = [verdict.kind for verdict in verdicts(found)]
            kind = next((each for each in ("open", "proved", "computed") if each in kinds), "computed")
            words = finding(found)
        rows.append(
            f'<li><span class="mark {kind}">{WORDS[kind]}</span> <a href="#{question}">{escape(_title(question, found))}</a>: '
            f"{escape(words)}</li>"
        )
    return f'<ul class="glance">{"".join(rows)}</ul>' if rows else ""


def _system(scene: Scene, system: Any) -> str:
    """The section about the system: a drawing, the description, and the table of links."""
    from ..plots.scale import plot_to_scale

    words = system.describe().split("; ")
    listed = "".join(f"<li>{escape(part[:1].upper() + part[1:])}</li>" for part in words)
    facts, links = parts_of(system)
    if has_air_drag(scene):
        asked = scene.ask.drag.air_density if isinstance(scene.ask.drag, AskDrag) else UNSET
        numbers = Numbers("scene")
        density = None if asked is UNSET else numbers.value("air_density", asked, "air_density", "positive")
        air = air_drag(scene, density, numbers)
        assert air is not None
        facts.append(Fact("density of the air", float(air.density), "kg/m^3"))
        size = len(links[0].values)
        for name, unit in (("coefficient", ""), ("diameter", "m"), ("area", "m^2")):
            heading = f"drag {name}" + (f" ({unit})" if unit else "")
            links.append(Column(f"drag_{name}", np.broadcast_to(air._given.get(name, 0.0), size), heading, unit=unit))
    facts = [fact for fact in facts if fact.name != "system" and not (isinstance(fact.value, float) and fact.value in (0.0, np.inf))]
    if isinstance(system, SleeveGovernor):
        facts = [
            fact._replace(value=float(np.degrees(fact.value)), unit="°") if fact.unit == "rad" else fact
            for fact in facts if fact.name != "gravity"
        ]  # fmt: skip
    rows = "".join(
        f'<tr><th scope="row">{escape(fact.name)}</th><td>{escape(_plain(fact.value))}{" " * bool(fact.unit)}{escape(_upright(fact.unit))}</td></tr>'
        for fact in facts
    )
    table = f'<div class="wide"><table class="facts"><tbody>{rows}</tbody></table></div>' if rows else ""
    below = _links(links, "upper end" if getattr(system, "_is_held", False) else "support", scene.order)
    picture = _picture(lambda: plot_to_scale(system), f"The system at rest, drawn to scale: {system.describe()}", "drawing")
    scale = "At rest, to scale. Symbols of bodies are not to scale."
    if isinstance(system, SleeveGovernor):
        scale = "To scale, with the arms between their stops. Symbols of bodies are not to scale."
    elif getattr(system, "span", None) is not None:
        scale = "Length and span to scale. The arc is not a shape in which the system turns."
    return f"""<section id="system">
<h2>The system</h2>
<div class="beside"><figure>{picture}<figcaption>{scale}</figcaption></figure>
<div><ul class="parts">{listed}</ul>{table}</div></div>
{below}
</section>"""


def _links(columns: list[Column], top: str, order: str) -> str:
    """The table of links from the top down, numbered in the order of the scene, with equal neighbours in one row."""
    if not columns:
        return ""
    size, names = len(columns[0].values), [column.name for column in columns]
    shown = [column for column in columns if column.name not in ("link", "name")]
    shown = [column for column in shown if column.name in ("mass", "weight", "length") or np.any(column.values)]
    rows: list[tuple[int, int, list[str]]] = []
    texts = [[_plain(value) for value in np.asarray(column.values).tolist()] for column in shown]
    labels = list(columns[names.index("name")].values) if "name" in names else []
    for k in range(size - 1, -1, -1):
        row = [column[k] for column in texts]
        key = [labels[k], *row] if labels else row
        if rows and rows[-1][2] == key:
            rows[-1] = (k, rows[-1][1], key)
        else:
            rows.append((k, k, key))
            if len(rows) > MOST_RUNS:
                break
    counted = "link" in names
    headings = [*["link"] * counted, *["name"] * bool(labels), *[column.heading for column in shown]]
    body = []
    for first, last, key in rows[:MOST_RUNS]:
        ends = sorted(int(columns[names.index("link")].values[k]) for k in (first, last)) if counted else [first, last]
        place = f"{ends[0]}" if first == last else f"{ends[0]} to {ends[1]}"
        body.append(([place] if counted else []) + key)
    numbers = [*[False] * counted, *[False] * bool(labels), *[True] * len(shown)]
    more = f'<p class="note">The other {size - sum(b - a + 1 for a, b, _ in rows[:MOST_RUNS]):,} links are not shown.</p>' if len(rows) > MOST_RUNS else ""
    caption = "Point masses; distances from the free end"
    if counted:
        which = f"the one at the {top}" if order == "support first" else "the lowest"
        caption = f"Links from the {top} down; link 0 is {which}, the first in the scene"
    return _table(caption, headings, body, numbers) + more


def _plain(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _answer(scene: Scene, question: str, found: Any, units: str) -> str:
    """The section of one question."""
    title = _title(question, found)
    heading = f'<section id="{question}">\n<h2>{escape(title)}</h2>\n'
    heading += _asked(scene, question)
    if isinstance(found, str):
        return f'{heading}<p class="verdict open"><b>No answer.</b> {escape(_sentence(found))}</p>\n</section>'
    damped, on_trolley = isinstance(found, Modes) and found._is_damped, title == ON_TROLLEY[0]
    meaning = DAMPED if damped else ON_TROLLEY[1] if on_trolley else MEANINGS.get(question, "")
    parts = [heading, f'<p class="meaning">{escape(meaning)}</p>']
    said = "".join(
        f'<li class="{verdict.kind}"><b>{WORDS[verdict.kind]}.</b> {escape(verdict.sentence)}</li>' for verdict in verdicts(found)
    )
    parts.append(f'<ul class="verdicts">{said}</ul>' if said else "")
    sheets = [found._printed(), *further_sheets(found)]
    for sheet in sheets:
        parts.append(_sheet(in_radians(sheet) if units == "rad" else sheet))
    notes = [in_file(note, scene._bodies()) if scene.order == "support first" else note for note in sheets[0].notes]
    notes = [re.sub(r"\bnan\b", "–", _sentence(note)) for note in notes if note]
    parts.append("".join(f'<p class="note">{escape(_upright(note))}</p>' for note in notes))
    if not isinstance(found, Explanation):
        alternative = f"{title}: {finding(found)}"
        parts.append(f"<figure>{_picture(lambda: found.plot(**drawn(found)), alternative, 'plot')}</figure>")
    return "\n".join(part for part in parts if part) + "\n</section>"


def _title(question: str, found: Any) -> str:
    """The heading of an answer."""
    trolley = question == "modes" and is_on_trolley(getattr(found, "system", None))
    return ON_TROLLEY[0] if trolley else TITLES.get(question, question)


def _asked(scene: Scene, question: str) -> str:
    """The question as the scene asks it."""
    table = getattr(scene.ask, question, UNSET)
    if table is UNSET:
        return '<p class="asked">The scene asks no question, so this one is answered.</p>\n'
    keys = to_builtins(table)
    text = ", ".join(f"{key} = {_toml(value)}" for key, value in keys.items())
    if len(text) > 160:
        text = text[:157] + "..."
    return f'<p class="asked"><code>[ask.{question}]</code>{f" <code>{escape(text)}</code>" if text else ""}</p>\n'


def _toml(value: Any) -> str:
    """A value as a scene file has it."""
    if isinstance(value, dict):
        keys = sorted(value, key=lambda key: [*("from", "to", "steps"), key].index(key))
        return "{" + ", ".join(f"{key} = {_toml(value[key])}" for key in keys) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return json.encode(value).decode()


def _sheet(sheet: Sheet) -> str:
    """The table of a sheet; where it is long, all of its rows on request."""
    headings, rows, notes = cells(sheet, MOST_SHOWN)
    if not rows:
        return ""
    shown = [column for column in sheet.columns if column.heading]
    numbers = [not column.left for column in shown]
    caption = sheet.heading.removesuffix(", success").split(": by ")[0].replace("SleeveGovernor", "Between the stops")
    text = _table(caption, headings, rows, numbers)
    if len(rows) < len(sheet):
        way = ", evenly spaced" if sheet.spread else ""
        text += f'<p class="note">{len(rows)} of {len(sheet):,} rows{way}; <code>revchain run</code> writes all of them as .csv and .json.</p>'
        if len(sheet) <= MOST_HIDDEN:
            _, rows, _ = cells(sheet, MOST_HIDDEN)
            text += f"<details><summary>All {len(sheet):,} rows</summary>{_table('', headings, rows, numbers)}</details>"
    return text


def _table(caption: str, headings: list[str], rows: list[list[str]], numbers: list[bool]) -> str:
    """A table whose numbers are aligned at the decimal point."""
    aligned = [_aligned([row[k] for row in rows]) if numbers[k] else [escape(row[k]) for row in rows] for k in range(len(headings))]
    kinds = ["" if number else ' class="left"' for number in numbers]
    head = "".join(f'<th scope="col"{kind}>{_heading(text)}</th>' for text, kind in zip(headings, kinds, strict=True))
    body = "\n".join(
        "<tr>" + "".join(f"<td{kind}>{cell}</td>" for cell, kind in zip(row, kinds, strict=True)) + "</tr>"
        for row in zip(*aligned, strict=True)
    )
    said = f"<caption>{escape(_sentence(caption))}</caption>" if caption else ""
    tight = ' class="tight"' if len(headings) > 8 else ""
    return f'<div class="wide"><table{tight}>{said}<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody></table></div>'


def _heading(text: str) -> str:
    """A heading with its unit on a line of its own."""
    words, bracket, unit = text.partition(" (")
    return f'{escape(words)}<br><span class="unit">{escape(_upright(unit.removesuffix(")")))}</span>' if bracket else escape(words)


def _upright(unit: str) -> str:
    return unit.replace("^2", "²").replace("^3", "³")


_NUMBER = re.compile(r"(-?[\d,]+)(\.\d*)?")


def _aligned(texts: list[str]) -> list[str]:
    """Numbers with room for as many decimals as the longest has, so that their points are below each other."""
    found = [_NUMBER.fullmatch(text) for text in texts]
    longest = max((len(match[2] or "") for match in found if match), default=0)
    if not longest or any(match is None and text not in ("nan", "inf", "") for match, text in zip(found, texts, strict=True)):
        return [escape(text) for text in texts]
    cells = []
    for text, match in zip(texts, found, strict=True):
        if match is None:
            cells.append(escape(text).replace("nan", "–"))
            continue
        part = match[2] or ""
        room = ("." if not part else "") + "0" * (longest - max(len(part), 1))
        cells.append(escape(text) + (f'<span class="room" aria-hidden="true">{room}</span>' if room and len(part) < longest else ""))
    return cells


def _picture(draw: Any, alternative: str, kind: str) -> str:
    """A picture in the page itself, as an image, so that its names do not meet those of another picture."""
    matplotlib = require("matplotlib", "plot", "a report")
    with matplotlib.rc_context({"svg.hashsalt": "revchain", "svg.fonttype": "path", "figure.facecolor": "white"}):
        figure = draw().figure
        file = io.BytesIO()
        figure.savefig(file, format="svg", bbox_inches="tight", pad_inches=0.06, metadata={"Date": None})
    if (pyplot := sys.modules.get("matplotlib.pyplot")) is not None:
        pyplot.close(figure)
    data = file.getvalue()
    size = re.search(rb'width="([\d.]+)pt" height="([\d.]+)pt"', data)
    wide, tall = (round(float(part) * 4 / 3) for part in size.groups()) if size else (640, 480)
    source = base64.b64encode(data).decode()
    text = escape(alternative[:300], quote=True)
    return f'<img class="{kind}" alt="{text}" width="{wide}" height="{tall}" src="data:image/svg+xml;base64,{source}">'
