# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a scene file that describe the system: their keys, the types, and the texts that editors show."""

from functools import cache, partial
from typing import Annotated, Any, Literal, get_args

from msgspec import UNSET, Meta, Struct, UnsetType
from msgspec.structs import fields

from ..systems.units import PATTERN


def says(text: str) -> Meta:
    """The text that editors show for a key."""
    return Meta(description=text)


MOST_LINKS = 10_000_000
BESIDE = ("schema_version", "title", "description", "gravity", "order", "support", "fluid", "held", "ask")
SYSTEMS = ("links", "uniform_chain", "tapered_chain", "cord")  # a scene has exactly one of these tables

WithUnit = Annotated[str, Meta(pattern=PATTERN, description='A number and its unit, such as "39.1396 inch".')]
NotNegativeNumber = Annotated[float, Meta(ge=0)]
AnySign = float | WithUnit
Positive = Annotated[float, Meta(gt=0)] | WithUnit
NotNegative = NotNegativeNumber | WithUnit
MaybeAnySign = AnySign | UnsetType
MaybePositive = Positive | UnsetType
MaybeNotNegative = NotNegative | UnsetType
Count = Annotated[int, Meta(ge=1, le=MOST_LINKS)]


fields_of = cache(fields)  # `fields` takes a millisecond in each call


_SIGNS = {
    AnySign: "any",
    MaybeAnySign: "any",
    Positive: "positive",
    MaybePositive: "positive",
    NotNegative: "not negative",
    MaybeNotNegative: "not negative",
}


@cache
def number_fields(kind: type[Struct]) -> list[tuple[str, str, bool]]:
    """Name of each key that is a number or text with a unit, its sign in words, and whether it must be given."""
    types = [(field, get_args(field.type)[0]) for field in fields_of(kind)]
    return [(field.name, _SIGNS[of], field.required) for field, of in types if of in _SIGNS]


class Table(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, repr_omit_defaults=True, kw_only=True):
    """The base of all tables of a scene: fixed keys, no positional arguments; numbers in SI units or with a unit."""

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle only the given values: msgspec recognizes defaults, which `to_dict` leaves out, by identity."""
        given = {}
        for field in fields_of(type(self)):
            if (value := getattr(self, field.name)) is not field.default:
                given[field.name] = value
        return partial(type(self), **given), ()


class Flywheel(Table, frozen=True):
    """A wheel that spins about the axis of its link. The data of the link include its mass and its inertia."""

    radius_of_gyration: Annotated[NotNegative, says("Radius of gyration about the axis of the wheel (m).")]
    spin: Annotated[AnySign, says("Spin (rad/s); positive in the direction of a positive whirl speed.")]
    weight: Annotated[MaybeNotNegative, says("Weight of the wheel (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass of the wheel (kg); or give weight.")] = UNSET
    driven: Annotated[
        bool, says("Whether a motor keeps the spin relative to the link constant; else the wheel runs freely.")
    ] = False


class Displaced(Table, frozen=True):
    """The fluid that a link displaces."""

    weight: Annotated[MaybeNotNegative, says("Weight of the displaced fluid (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass of the displaced fluid (kg); or give weight.")] = UNSET
    centroid: Annotated[
        MaybeAnySign, says("Distance of the centre of gravity of the fluid below the upper pin (m); the link's if left out.")
    ] = UNSET
    radius_of_gyration: Annotated[
        MaybeNotNegative, says("Radius of gyration of the fluid about its centre of gravity (m); the link's if left out.")
    ] = UNSET
    added_weight: Annotated[MaybeNotNegative, says("Weight of still fluid that moves with the link (N).")] = UNSET
    added_mass: Annotated[MaybeNotNegative, says("Mass of still fluid that moves with the link (kg).")] = UNSET


class Support(Table, frozen=True):
    """The support of the uppermost pin."""

    stiffness: Annotated[MaybePositive, says("Sideways stiffness of the spring (N/m); firm if left out.")] = UNSET
    weight: Annotated[MaybeNotNegative, says("Weight that moves sideways with the pin (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass that moves sideways with the pin (kg); or give weight.")] = UNSET
    radius: Annotated[
        MaybeNotNegative, says("Radius of the circle in which the pin is carried round (m); 0 if left out.")
    ] = UNSET


class Link(Table, frozen=True):
    """One link, or several equal ones. A link of mass 0 is a massless thread.

    A link with `clamped` is part of the link above; `standing`, `flywheel` and `displaced` belong to that link.
    """

    length: Annotated[Positive, says("Distance between its pins (m).")]
    name: Annotated[str, says("Name in reports and pictures.")] = ""
    weight: Annotated[MaybeNotNegative, says("Weight (N); or give mass.")] = UNSET
    mass: Annotated[MaybeNotNegative, says("Mass (kg); or give weight.")] = UNSET
    kind: Annotated[
        Literal["plummet", "rod"] | UnsetType,
        says("plummet (default): all weight at the lower pin; rod: uniform between its pins."),
    ] = UNSET
    centroid: Annotated[
        MaybeAnySign, says("Distance of the centre of gravity below the upper pin (m); negative above it.")
    ] = UNSET
    pendulum_length: Annotated[
        MaybeAnySign, says("Length of the equivalent simple pendulum about the upper pin (m).")
    ] = UNSET
    radius_of_gyration: Annotated[
        MaybeNotNegative, says("Radius of gyration about the centre of gravity (m); or give pendulum_length.")
    ] = UNSET
    repeat: Annotated[Count, says("Number of equal links in a row.")] = 1
    standing: Annotated[bool, says("Whether it stands on its upper pin in the straight chain (inverted).")] = False
    tip_weight: Annotated[MaybeNotNegative, says("Weight of a point mass fixed to its lower pin (N).")] = UNSET
    tip_mass: Annotated[MaybeNotNegative, says("Point mass fixed to its lower pin (kg).")] = UNSET
    clamped: Annotated[bool, says("Whether it is locked in line with the link above as one rigid body.")] = False
    flywheel: Annotated[Flywheel | UnsetType, says("A wheel that spins about the axis of the link.")] = UNSET
    displaced: Annotated[Displaced | UnsetType, says("The fluid that it displaces.")] = UNSET


class Whole(Table, frozen=True):
    """The base of chains and cords that are given as a whole."""

    length: Annotated[Positive, says("Length of the whole (m).")]
    weight: Annotated[MaybePositive, says("Weight of the whole (N); or give mass.")] = UNSET
    mass: Annotated[MaybePositive, says("Mass of the whole (kg); or give weight.")] = UNSET
    tip_weight: Annotated[MaybeNotNegative, says("Weight of a point mass fixed to its free end (N).")] = UNSET
    tip_mass: Annotated[MaybeNotNegative, says("Point mass fixed to its free end (kg).")] = UNSET


class UniformChain(Whole, frozen=True, kw_only=True):
    """A chain of equal links."""

    kind: Annotated[Literal["plummets", "rods"], says("Kind of the links.")]
    count: Annotated[Count, says("Number of links.")]


class TaperedChain(Whole, frozen=True, kw_only=True):
    """A cord whose line density is a power of the distance from its free end, cut into straight equal lengths."""

    count: Annotated[Count, says("Number of links.")]
    exponent: Annotated[float, Meta(gt=-1, le=1000, description="Exponent of the power; 0 gives equal rods.")]


class Cord(Whole, frozen=True, kw_only=True):
    """A flexible cord: the limit of many short links."""

    density: Annotated[
        float,
        Meta(gt=-1, le=1000, description="Exponent of the distance from the free end in the line density; 0: uniform."),
    ] = 0.0


class End(Support, frozen=True):
    """The support of an end; with a negative radius on the other side of the axis."""

    radius: Annotated[
        MaybeAnySign, says("Signed radius of the circle in which the end is carried round (m); 0 if left out.")
    ] = UNSET


class Held(Table, frozen=True):
    """Data of a chain or cord held at both ends: the span of a bent one, or the tension of a straight one."""

    span: Annotated[MaybePositive, says("Distance between the ends along the axis (m), less than the length.")] = UNSET
    tension: Annotated[MaybePositive, says("Tension at the upper end (N), instead of span.")] = UNSET
    weightless: Annotated[bool, says("Whether gravity is left out.")] = False
    lower: Annotated[End | UnsetType, says("Support of the lower end; a firm point on the axis if left out.")] = UNSET
    upper: Annotated[End | UnsetType, says("Support of the upper end; a firm point on the axis if left out.")] = UNSET
