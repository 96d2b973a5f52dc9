# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a scene file: their keys, what each may hold, and how editors explain them."""

from __future__ import annotations

from functools import cache, partial
from typing import Annotated, Any, Literal

from msgspec import UNSET, Meta, Struct, UnsetType
from msgspec.structs import fields

from ..systems.units import PATTERN

MOST_LINKS = 10_000_000

WithUnit = Annotated[str, Meta(pattern=PATTERN, description='A number and its unit, such as "39.1396 inch".')]
Positive = Annotated[float, Meta(gt=0)] | WithUnit
NotNegativeNumber = Annotated[float, Meta(ge=0)]
NotNegative = NotNegativeNumber | WithUnit
AnySign = float | WithUnit
Count = Annotated[int, Meta(ge=1, le=MOST_LINKS)]


fields_of = cache(fields)  # which evaluates annotations anew each time, in a millisecond


class Table(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, repr_omit_defaults=True, kw_only=True):
    """What all tables of a scene share: fixed keys, no positional arguments."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle what was given only: msgspec knows defaults, which `to_dict` leaves out, by their identity."""
        given = {}
        for field in fields_of(type(self)):
            if (value := getattr(self, field.name)) is not field.default:
                given[field.name] = value
        return partial(type(self), **given), ()


class Flywheel(Table, frozen=True):
    """A wheel that spins about its link's own axis. Numbers are SI or text with a unit.

    Attributes
    ----------
    weight, mass : float or str
        One of the two. The wheel's weight, and its inertia across its axis, belong to the link's own numbers.
    radius_of_gyration : float or str
        About its axis.
    spin : float or str
        In rad/s, or text such as ``"3000 rpm"``; positive where a hanging link's wheel turns in the sense of a
        positive speed.
    driven : bool
        Whether a motor keeps the spin relative to a link that turns with the whole; else the wheel runs freely,
        and its spin is as seen from outside.
    """

    radius_of_gyration: Annotated[NotNegative, Meta(description="About the axis of the wheel.")]
    spin: Annotated[AnySign, Meta(description="rad/s; positive in the sense of a positive whirl speed.")]
    weight: Annotated[NotNegative | UnsetType, Meta(description="Of the wheel (N); or give mass.")] = UNSET
    mass: Annotated[NotNegative | UnsetType, Meta(description="Of the wheel (kg); or give weight.")] = UNSET
    driven: Annotated[
        bool, Meta(description="Whether the spin is relative to the link, kept by a motor; else it runs freely.")
    ] = False


class Displaced(Table, frozen=True):
    """What a link displaces of the fluid around it. Numbers are SI or text with a unit.

    Attributes
    ----------
    weight, mass : float or str
        Of the fluid displaced; one of the two.
    centroid, radius_of_gyration : float or str, optional
        Of that fluid; those of the link if left out.
    added_weight, added_mass : float or str, optional
        Of still fluid that has to move with the link; at most one of the two.
    """

    weight: Annotated[NotNegative | UnsetType, Meta(description="Of the fluid displaced (N); or give mass.")] = UNSET
    mass: Annotated[NotNegative | UnsetType, Meta(description="Of the fluid displaced (kg); or give weight.")] = UNSET
    centroid: Annotated[
        AnySign | UnsetType, Meta(description="Of that fluid, from the upper pin; the link's own if left out.")
    ] = UNSET
    radius_of_gyration: Annotated[
        NotNegative | UnsetType, Meta(description="Of that fluid; the link's own if left out.")
    ] = UNSET
    added_weight: Annotated[
        NotNegative | UnsetType, Meta(description="Of still fluid that moves with the link (N).")
    ] = UNSET
    added_mass: Annotated[
        NotNegative | UnsetType, Meta(description="Of still fluid that moves with the link (kg).")
    ] = UNSET


class Support(Table, frozen=True):
    """What the uppermost pin is held by. Numbers are SI or text with a unit.

    Attributes
    ----------
    stiffness : float or str, optional
        Of a spring that holds it sideways, in N/m; firm if left out.
    weight, mass : float or str, optional
        Of what moves sideways with it; at most one of the two.
    radius : float or str, optional
        Of the circle in which it is carried round; on the axis if left out.
    """

    stiffness: Annotated[Positive | UnsetType, Meta(description="Of a spring sideways (N/m); firm if left out.")] = (
        UNSET
    )
    weight: Annotated[NotNegative | UnsetType, Meta(description="Of what moves sideways with it (N).")] = UNSET
    mass: Annotated[NotNegative | UnsetType, Meta(description="Of what moves sideways with it (kg).")] = UNSET
    radius: Annotated[
        NotNegative | UnsetType, Meta(description="Of the circle in which it is carried round; 0 if left out.")
    ] = UNSET


class Link(Table, frozen=True):
    """One link, or several equal ones. Numbers are SI (m, kg, N) or text with a unit.

    Attributes
    ----------
    length : float or str
        From pin to pin.
    weight, mass : float or str
        One of the two; a mass is multiplied by the scene's gravity. 0 is a massless thread.
    kind : {"plummet", "rod"}, optional
        A plummet (all weight at the lower pin) if nothing else is said, or a uniform rod.
    centroid : float or str, optional
        From the upper pin to the centre of gravity, positive downwards.
    pendulum_length, radius_of_gyration : float or str, optional
        One of the two goes with `centroid`.
    repeat : int
        How many such links follow one another.
    standing : bool
        Whether it stands on its upper pin, as a broomstick on the hand, in the straight chain.
    tip_weight, tip_mass : float or str, optional
        Of a point fixed to its lower pin; at most one of the two.
    clamped : bool
        Whether it is locked in line with the link above: one rigid piece, of which that link says whether it
        stands, and what wheel it carries and fluid it displaces.
    flywheel : Flywheel, optional
    displaced : Displaced, optional
    """

    length: Annotated[Positive, Meta(description="From pin to pin.")]
    weight: Annotated[NotNegative | UnsetType, Meta(description="Weight (N); or give mass.")] = UNSET
    mass: Annotated[NotNegative | UnsetType, Meta(description="Mass (kg); or give weight.")] = UNSET
    kind: Annotated[
        Literal["plummet", "rod"] | UnsetType,
        Meta(description="plummet (default): all weight at the lower pin; rod: uniform between its pins."),
    ] = UNSET
    centroid: Annotated[
        AnySign | UnsetType, Meta(description="From the upper pin down to the centre of gravity; any sign.")
    ] = UNSET
    pendulum_length: Annotated[
        AnySign | UnsetType, Meta(description="Of the equivalent simple pendulum about the upper pin.")
    ] = UNSET
    radius_of_gyration: Annotated[
        NotNegative | UnsetType, Meta(description="About the centre of gravity; or give pendulum_length.")
    ] = UNSET
    repeat: Annotated[Count, Meta(description="How many equal links follow one another.")] = 1
    standing: Annotated[bool, Meta(description="Whether it stands on its upper pin in the straight chain.")] = False
    tip_weight: Annotated[NotNegative | UnsetType, Meta(description="Of a point fixed to its lower pin (N).")] = UNSET
    tip_mass: Annotated[NotNegative | UnsetType, Meta(description="Of a point fixed to its lower pin (kg).")] = UNSET
    clamped: Annotated[bool, Meta(description="Whether it is locked in line with the link above: one rigid piece.")] = (
        False
    )
    flywheel: Annotated[Flywheel | UnsetType, Meta(description="A wheel that spins about the link's axis.")] = UNSET
    displaced: Annotated[Displaced | UnsetType, Meta(description="What it displaces of a fluid.")] = UNSET


class TaperedChain(Table, frozen=True):
    """A chain cut from a cord whose line density is a power of the distance from its free end.

    Numbers are SI or text with a unit.

    Attributes
    ----------
    count : int
        How many links, straight and equally long.
    exponent : float
        Of that power, above -1 and at most 1000: 0 is equal rods, 1 a cord that thickens upwards.
    length, weight, mass : float or str
        Of the WHOLE chain; one of weight and mass.
    tip_weight, tip_mass : float or str, optional
        Of a point fixed to its free end; at most one of the two.
    """

    count: Annotated[Count, Meta(description="How many links.")]
    exponent: Annotated[
        float, Meta(gt=-1, le=1000, description="Of the line density, by the distance from the free end.")
    ]
    length: Annotated[Positive, Meta(description="Of the whole chain.")]
    weight: Annotated[Positive | UnsetType, Meta(description="Of the whole chain (N); or give mass.")] = UNSET
    mass: Annotated[Positive | UnsetType, Meta(description="Of the whole chain (kg); or give weight.")] = UNSET
    tip_weight: Annotated[NotNegative | UnsetType, Meta(description="Of a point fixed to its free end (N).")] = UNSET
    tip_mass: Annotated[NotNegative | UnsetType, Meta(description="Of a point fixed to its free end (kg).")] = UNSET


class UniformChain(Table, frozen=True):
    """A chain of equal links. Numbers are SI (m, kg, N) or text with a unit.

    Attributes
    ----------
    kind : {"plummets", "rods"}
        What the links are.
    count : int
        How many.
    length, weight, mass : float or str
        Of the WHOLE chain; one of weight and mass.
    tip_weight, tip_mass : float or str, optional
        Of a point fixed to its free end; at most one of the two.
    """

    kind: Annotated[Literal["plummets", "rods"], Meta(description="What the links are.")]
    count: Annotated[Count, Meta(description="How many links.")]
    length: Annotated[Positive, Meta(description="Of the whole chain.")]
    weight: Annotated[Positive | UnsetType, Meta(description="Of the whole chain (N); or give mass.")] = UNSET
    mass: Annotated[Positive | UnsetType, Meta(description="Of the whole chain (kg); or give weight.")] = UNSET
    tip_weight: Annotated[NotNegative | UnsetType, Meta(description="Of a point fixed to its free end (N).")] = UNSET
    tip_mass: Annotated[NotNegative | UnsetType, Meta(description="Of a point fixed to its free end (kg).")] = UNSET
