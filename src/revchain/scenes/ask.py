# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a scene file for what is asked, one a question: their keys are the arguments of the Python function."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import UNSET, UnsetType

from .tables import AnySign, Count, MaybeNotNegative, MaybePositive, NotNegative, Table, says

DEFAULT_MODES = 10

Pair = tuple[NotNegative, NotNegative]
Listed = list[AnySign]
OneOrMore = float | str | Listed  # msgspec 0.22 ends the process for a text with a pattern beside a list


class Spread(Table, frozen=True, rename={"first": "from", "last": "to"}):
    """Numbers from one to another, both included."""

    last: Annotated[AnySign, says("The last one.")]
    first: Annotated[AnySign, says("The first one.")] = 0.0
    steps: Annotated[Count, says("How many.")] = 200
    log: Annotated[bool, says("Whether in equal ratios instead of equal differences.")] = False


class AskModes(Table, frozen=True):
    """The modes: whirl speeds, shapes, nodes (`revchain.modes`). Give `count` and `first`, or one window."""

    count: Annotated[
        Count | Literal["all"] | UnsetType,
        says('How many modes, slowest first, or "all"; 10, or as many as there are, if left out.'),
    ] = UNSET
    first: Annotated[Count | UnsetType, says("Number of the slowest mode wanted, from 1.")] = UNSET
    angular_speed: Annotated[Pair | UnsetType, says("[low, high]: low <= whirl speed < high (rad/s).")] = UNSET
    conical_height: Annotated[Pair | UnsetType, says("[low, high]: low < conical height <= high (m).")] = UNSET
    rtol: Annotated[MaybeNotNegative, says('Relative tolerance of the heights, such as "1 %".')] = UNSET
    certify: Annotated[bool, says("Whether to prove each height with an interval and its counts.")] = False
    precision: Annotated[Literal["single", "double", "extended", "double-double"], says("The arithmetic.")] = "double"
    method: Annotated[str | UnsetType, says("A method that explain lists; the cheapest if left out.")] = UNSET


class AskShapes(Table, frozen=True):
    """Every steady shape (relative equilibrium) at one speed, at any inclination (`revchain.steady_shapes`)."""

    angular_speed: Annotated[MaybePositive, says("The speed (rad/s); or conical_height.")] = UNSET
    conical_height: Annotated[MaybePositive, says("g / n^2 of the speed (m); or angular_speed.")] = UNSET
    hanging_only: Annotated[bool, says("Whether to leave out shapes in which links turn over.")] = True
    direction: Annotated[Literal[1, -1], says("Of the rotation; it matters to flywheels.")] = 1
    max_half_waves: Annotated[
        Count | UnsetType, says("Between two held ends: shapes of 1 to so many half waves.")
    ] = UNSET


class AskResponse(Table, frozen=True):
    """Motion of small amplitude of a chain whose support is carried round, or to and fro (`revchain.response`)."""

    angular_speed: Annotated[
        OneOrMore | Spread | UnsetType,
        says("A speed (rad/s), a list of them, or {from, to, steps, log}; negative only with flywheels."),
    ] = UNSET
    conical_height: Annotated[OneOrMore | Spread | UnsetType, says("Instead: g / n^2 of the speeds (m).")] = UNSET
    support_radius: Annotated[MaybePositive, says("Of the circle (m); that of [support], or 1, if left out.")] = UNSET


class AskSwing(Table, frozen=True):
    """Small oscillations of a hanging chain or rig after release (`revchain.swing`)."""

    offset: Annotated[Listed, says("Of each pin at the start (m), free end first, the support left out unless it yields.")]
    velocity: Annotated[Listed | UnsetType, says("Likewise (m/s); at rest if left out.")] = UNSET
    time: Annotated[OneOrMore | Spread, says("s: one, a list, or {from, to, steps}.")] = Spread(last=10.0, steps=201)
    count: Annotated[Count | UnsetType, says("Only so many of the slowest modes; all if left out.")] = UNSET


class AskBranches(Table, frozen=True):
    """The bifurcation diagram: all branches of steady shapes up to a speed (`revchain.branches`)."""

    max_angular_speed: Annotated[MaybePositive, says("The speed (rad/s); or min_conical_height.")] = UNSET
    min_conical_height: Annotated[MaybePositive, says("Instead: down to this one (m).")] = UNSET
    direction: Annotated[Literal[1, -1], says("Of the rotation; it matters to flywheels.")] = 1


class AskExplain(Table, frozen=True):
    """Which method finds the modes for a tolerance, and what the others would cost (`revchain.explain`)."""

    count: Annotated[Count | Literal["all"] | UnsetType, says("How many modes, slowest first.")] = UNSET
    first: Annotated[Count | UnsetType, says("Number of the slowest mode wanted, from 1.")] = UNSET
    rtol: Annotated[MaybeNotNegative, says('Relative tolerance of the heights, such as "1 %".')] = UNSET


class Ask(Table, frozen=True):
    """What is asked; the modes if nothing is."""

    modes: Annotated[AskModes | UnsetType, says("Whirl speeds and mode shapes.")] = UNSET
    shapes: Annotated[AskShapes | UnsetType, says("Steady shapes at any inclination.")] = UNSET
    response: Annotated[AskResponse | UnsetType, says("What a support carried round does.")] = UNSET
    swing: Annotated[AskSwing | UnsetType, says("The chain let go.")] = UNSET
    branches: Annotated[AskBranches | UnsetType, says("All branches of steady shapes.")] = UNSET


QUESTIONS: dict[str, type[Table]] = {
    "modes": AskModes,
    "shapes": AskShapes,
    "response": AskResponse,
    "swing": AskSwing,
    "branches": AskBranches,
}
TABLES: dict[str, type[Table]] = {**QUESTIONS, "explain": AskExplain}
