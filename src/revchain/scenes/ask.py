# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables [ask.…] of a scene file, one for each question; their keys are the arguments of the Python function."""

from typing import Annotated, Literal

from msgspec import UNSET, UnsetType

from .tables import AnySign, Count, MaybeNotNegative, MaybePositive, NotNegative, Table, says

DEFAULT_MODES = 10

Pair = tuple[NotNegative, NotNegative]
Listed = list[AnySign]
OneOrMore = float | str | Listed  # without a pattern: msgspec 0.22 crashes for text with a pattern beside a list


class Spread(Table, frozen=True, rename={"first": "from", "last": "to"}):
    """Numbers from a first to a last one, both included."""

    last: Annotated[AnySign, says("Last number.")]
    first: Annotated[AnySign, says("First number.")] = 0.0
    steps: Annotated[Count, says("Number of values.")] = 200
    log: Annotated[bool, says("Whether the numbers have equal ratios instead of equal differences.")] = False


class AskModes(Table, frozen=True):
    """The modes: whirl speeds, shapes, nodes (`revchain.modes`). Give `count` and `first`, or one window."""

    count: Annotated[
        Count | Literal["all"] | UnsetType,
        says('Number of modes, slowest first, or "all"; if left out 10, or all if there are fewer.'),
    ] = UNSET
    first: Annotated[Count | UnsetType, says("Number of the first mode; the slowest mode is 1.")] = UNSET
    angular_speed: Annotated[Pair | UnsetType, says("Window [low, high]: low <= whirl speed < high (rad/s).")] = UNSET
    conical_height: Annotated[Pair | UnsetType, says("Window [low, high]: low < conical height <= high (m).")] = UNSET
    rtol: Annotated[MaybeNotNegative, says('Relative tolerance of the heights, such as "1 %".')] = UNSET
    certify: Annotated[bool, says("Whether to prove each height with an interval and its counts.")] = False
    precision: Annotated[
        Literal["double", "extended", "double-double"], says("Arithmetic of the results.")
    ] = "double"
    method: Annotated[str | UnsetType, says("Method, one of those that explain lists; the cheapest if left out.")] = UNSET


class AskShapes(Table, frozen=True):
    """Every steady shape (relative equilibrium) at one speed, at any inclination (`revchain.steady_shapes`)."""

    angular_speed: Annotated[MaybePositive, says("Speed (rad/s); or give conical_height.")] = UNSET
    conical_height: Annotated[MaybePositive, says("Conical height g / n^2 (m); or give angular_speed.")] = UNSET
    hanging_only: Annotated[bool, says("Whether to leave out shapes with links above their pins.")] = True
    direction: Annotated[Literal[1, -1], says("Direction of rotation; only flywheels depend on it.")] = 1
    max_half_waves: Annotated[
        Count | UnsetType, says("Largest number of half waves between two held ends; 1 if left out.")
    ] = UNSET


class AskResponse(Table, frozen=True):
    """Small forced motion of a chain whose support moves in a circle or to and fro (`revchain.response`)."""

    angular_speed: Annotated[
        OneOrMore | Spread | UnsetType,
        says("A speed (rad/s), a list of speeds, or {from, to, steps, log}; negative only with flywheels."),
    ] = UNSET
    conical_height: Annotated[
        OneOrMore | Spread | UnsetType, says("Conical heights g / n^2 (m), instead of angular_speed.")
    ] = UNSET
    support_radius: Annotated[
        MaybePositive, says("Radius of the circle (m); if left out that of [support], or 1 if it has none.")
    ] = UNSET


class AskSwing(Table, frozen=True):
    """Small oscillations of a hanging chain or rig after release (`revchain.swing`)."""

    offset: Annotated[
        Listed, says("Offset of each pin at the start (m), free end first, without the support unless it yields.")
    ]
    velocity: Annotated[
        Listed | UnsetType, says("Velocity of each pin at the start (m/s), in the same order; at rest if left out.")
    ] = UNSET
    time: Annotated[OneOrMore | Spread, says("A time (s), a list of times, or {from, to, steps}.")] = Spread(
        last=10.0, steps=201
    )
    count: Annotated[Count | UnsetType, says("Number of modes used, slowest first; all if left out.")] = UNSET


class AskBranches(Table, frozen=True):
    """The bifurcation diagram: all branches of steady shapes up to a speed (`revchain.branches`)."""

    max_angular_speed: Annotated[MaybePositive, says("Largest speed (rad/s); or give min_conical_height.")] = UNSET
    min_conical_height: Annotated[
        MaybePositive, says("Smallest conical height (m); or give max_angular_speed.")
    ] = UNSET
    direction: Annotated[Literal[1, -1], says("Direction of rotation; only flywheels depend on it.")] = 1


class AskExplain(Table, frozen=True):
    """The method that finds the modes for a tolerance, and the cost of the others (`revchain.explain`)."""

    count: Annotated[Count | Literal["all"] | UnsetType, says("Number of modes, slowest first.")] = UNSET
    first: Annotated[Count | UnsetType, says("Number of the first mode; the slowest mode is 1.")] = UNSET
    rtol: Annotated[MaybeNotNegative, says('Relative tolerance of the heights, such as "1 %".')] = UNSET


class Ask(Table, frozen=True):
    """Questions to answer; the modes if there are none."""

    modes: Annotated[AskModes | UnsetType, says("Whirl speeds and mode shapes.")] = UNSET
    shapes: Annotated[AskShapes | UnsetType, says("Steady shapes at any inclination.")] = UNSET
    response: Annotated[AskResponse | UnsetType, says("Forced motion by a moving support.")] = UNSET
    swing: Annotated[AskSwing | UnsetType, says("Free motion after release.")] = UNSET
    branches: Annotated[AskBranches | UnsetType, says("All branches of steady shapes.")] = UNSET


QUESTIONS: dict[str, type[Table]] = {
    "modes": AskModes,
    "shapes": AskShapes,
    "response": AskResponse,
    "swing": AskSwing,
    "branches": AskBranches,
}
TABLES: dict[str, type[Table]] = {**QUESTIONS, "explain": AskExplain}
