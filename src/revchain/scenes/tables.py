# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a scene file for what hangs: their keys, what each may hold, and how editors explain them."""

from __future__ import annotations

from functools import cache, partial
from typing import Annotated, Any, Literal

from msgspec import UNSET, Meta, Struct, UnsetType
from msgspec.structs import fields

from ..systems.units import PATTERN


def says(text: str) -> Meta:
    """What editors show for a key."""
    return Meta(description=text)


MOST_LINKS = 10_000_000
BESIDE = ("schema_version", "title", "description", "gravity", "order", "support", "fluid", "held", "ask")
SYSTEMS = ("links", "uniform_chain", "tapered_chain", "cord")  # the tables of which a scene has one

WithUnit = Annotated[str, Meta(pattern=PATTERN, description='A number and its unit, such as "39.1396 inch".')]
NotNegativeNumber = Annotated[float, Meta(ge=0)]
AnySign = float | WithUnit
Positive = Annotated[float, Meta(gt=0)] | WithUnit
NotNegative = NotNegativeNumber | WithUnit
MaybeAnySign = AnySign | UnsetType
MaybePositive = Positive | UnsetType
MaybeNotNegative = NotNegative | UnsetType
Count = Annotated[int, Meta(ge=1, le=MOST_LINKS)]


fields_of = cache(fields)  # which evaluates annotations anew each time, in a millisecond


class Table(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, repr_omit_defaults=True, kw_only=True):
    """What all tables of a scene share: fixed keys, no positional arguments. Numbers are SI or text with a unit."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle what was given only: msgspec knows defaults, which `to_dict` leaves out, by their identity."""
        given = {}
        for field in fields_of(type(self)):
            if (value := getattr(self, field.name)) is not field.default:
                given[field.name] = value
        return partial(type(self), **given), ()


class Flywheel(Table, frozen=True):
    """A wheel that spins about its link's own axis. Its mass and inertia across its axis belong to the link's own."""

    radius_of_gyration: Annotated[NotNegative, says("About the axis of the wheel.")]
    spin: Annotated[AnySign, says("rad/s; positive in the direction of a positive whirl speed.")]
    weight: Annotated[MaybeNotNegative, says("Of the wheel (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Of the wheel (kg); or give weight.")] = UNSET
    driven: Annotated[bool, says("Whether a motor keeps the spin relative to the link; else it runs freely.")] = False


class Displaced(Table, frozen=True):
    """What a link displaces of the fluid around it."""

    weight: Annotated[MaybeNotNegative, says("Of the fluid displaced (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Of the fluid displaced (kg); or give weight.")] = UNSET
    centroid: Annotated[MaybeAnySign, says("Of that fluid, from the upper pin; the link's own if left out.")] = UNSET
    radius_of_gyration: Annotated[MaybeNotNegative, says("Of that fluid; the link's own if left out.")] = UNSET
    added_weight: Annotated[MaybeNotNegative, says("Of still fluid that moves with the link (N).")] = UNSET
    added_mass: Annotated[MaybeNotNegative, says("Of still fluid that moves with the link (kg).")] = UNSET


class Support(Table, frozen=True):
    """What the uppermost pin is held by."""

    stiffness: Annotated[MaybePositive, says("Of a spring sideways (N/m); firm if left out.")] = UNSET
    weight: Annotated[MaybeNotNegative, says("Of what moves sideways with it (N).")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Of what moves sideways with it (kg).")] = UNSET
    radius: Annotated[MaybeNotNegative, says("Of the circle in which it is carried round; 0 if left out.")] = UNSET


class Link(Table, frozen=True):
    """One link, or several equal ones. A mass is multiplied by the scene's gravity; 0 is a massless thread.

    With `clamped` a link is part of the link above, which says whether it stands, what wheel it carries and what
    fluid it displaces.
    """

    length: Annotated[Positive, says("From pin to pin.")]
    name: Annotated[str, says("For people.")] = ""
    weight: Annotated[MaybeNotNegative, says("Weight (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass (kg); or give weight.")] = UNSET
    kind: Annotated[
        Literal["plummet", "rod"] | UnsetType,
        says("plummet (default): all weight at the lower pin; rod: uniform between its pins."),
    ] = UNSET
    centroid: Annotated[MaybeAnySign, says("From the upper pin down to the centre of gravity; any sign.")] = UNSET
    pendulum_length: Annotated[MaybeAnySign, says("Of the equivalent simple pendulum about the upper pin.")] = UNSET
    radius_of_gyration: Annotated[MaybeNotNegative, says("About the centre of gravity; or pendulum_length.")] = UNSET
    repeat: Annotated[Count, says("How many equal links follow one another.")] = 1
    standing: Annotated[bool, says("Whether it stands on its upper pin in the straight chain.")] = False
    tip_weight: Annotated[MaybeNotNegative, says("Of a point fixed to its lower pin (N).")] = UNSET
    tip_mass: Annotated[MaybeNotNegative, says("Of a point fixed to its lower pin (kg).")] = UNSET
    clamped: Annotated[bool, says("Whether it is locked in line with the link above: one rigid piece.")] = False
    flywheel: Annotated[Flywheel | UnsetType, says("A wheel that spins about the link's axis.")] = UNSET
    displaced: Annotated[Displaced | UnsetType, says("What it displaces of a fluid.")] = UNSET


class Whole(Table, frozen=True):
    """What chains and cords that are said as a whole share."""

    length: Annotated[Positive, says("Of the whole.")]
    weight: Annotated[MaybePositive, says("Of the whole (N); or give mass.")] = UNSET
    mass: Annotated[MaybePositive, says("Of the whole (kg); or give weight.")] = UNSET
    tip_weight: Annotated[MaybeNotNegative, says("Of a point fixed to its free end (N).")] = UNSET
    tip_mass: Annotated[MaybeNotNegative, says("Of a point fixed to its free end (kg).")] = UNSET


class UniformChain(Whole, frozen=True, kw_only=True):
    """A chain of equal links."""

    kind: Annotated[Literal["plummets", "rods"], says("What the links are.")]
    count: Annotated[Count, says("How many links.")]


class TaperedChain(Whole, frozen=True, kw_only=True):
    """A cord whose line density is a power of the distance from its free end, cut into straight equal lengths."""

    count: Annotated[Count, says("How many links.")]
    exponent: Annotated[float, Meta(gt=-1, le=1000, description="Of that power; 0: equal rods.")]


class Cord(Whole, frozen=True, kw_only=True):
    """A cord: the limit of ever more, ever shorter links."""

    density: Annotated[
        float,
        Meta(gt=-1, le=1000, description="Line density as this power of the distance from the free end; 0: uniform."),
    ] = 0.0


class End(Support, frozen=True):
    """What an end is held by; on the other side of the axis if its radius is negative."""

    radius: Annotated[MaybeAnySign, says("Of the circle in which it is carried round; 0 if left out.")] = UNSET


class Held(Table, frozen=True):
    """The lower end is held, too: the span of a chain that bows out, or the tension of a straight one."""

    span: Annotated[MaybePositive, says("From end to end along the axis, less than the length.")] = UNSET
    tension: Annotated[MaybePositive, says("Instead: at the upper end of a straight chain (N).")] = UNSET
    weightless: Annotated[bool, says("Whether gravity plays no part.")] = False
    lower: Annotated[End | UnsetType, says("What holds the lower end, if not a firm point on the axis.")] = UNSET
    upper: Annotated[End | UnsetType, says("What holds the upper end, if not a firm point on the axis.")] = UNSET
