# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a scene file for what is asked: whirl speeds, shapes, motions; and for both ends held."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import UNSET, Meta, UnsetType

from .tables import AnySign, Count, NotNegative, NotNegativeNumber, Positive, Table

OneOrTwo = Annotated[list[AnySign], Meta(min_length=1, max_length=2)]
AtEveryPin = Annotated[list[AnySign], Meta(min_length=1)]


class AskShapes(Table, frozen=True):
    """Steady shapes at any inclination, at one speed. Numbers are SI or text with a unit.

    Attributes
    ----------
    angular_speed, conical_height : float or str
        One of the two.
    sense : {1, -1}
        Of the rotation; it matters to flywheels.
    any_posture : bool
        Whether links may stand that hang in the straight chain, and hang that stand there.
    half_waves : int
        Between two held ends: shapes of 1 to so many are looked for.
    """

    angular_speed: Annotated[Positive | UnsetType, Meta(description="The speed (rad/s); or conical_height.")] = UNSET
    conical_height: Annotated[Positive | UnsetType, Meta(description="g / n^2 of the speed; or angular_speed.")] = UNSET
    sense: Annotated[Literal[1, -1], Meta(description="Of the rotation; it matters to flywheels.")] = 1
    any_posture: Annotated[bool, Meta(description="Whether links may turn over.")] = False
    half_waves: Annotated[Count, Meta(description="Between two held ends: of 1 to so many.")] = 1


class AskResponse(Table, frozen=True):
    """Small motions of a chain whose support is carried round, or to and fro. Numbers are SI or text with a unit.

    Attributes
    ----------
    angular_speed, conical_height : list of float or str
        One of the two: ``[at]``, or ``[from, to]`` in equal steps. Speeds of a rig with flywheels may be negative.
    steps : int
        How many speeds from one end to the other.
    """

    angular_speed: Annotated[OneOrTwo | UnsetType, Meta(description="[at] or [from, to] (rad/s).")] = UNSET
    conical_height: Annotated[OneOrTwo | UnsetType, Meta(description="Instead: g / n^2 of the speeds.")] = UNSET
    steps: Annotated[Count, Meta(description="How many speeds from one end to the other.")] = 200

    @property
    def ends(self) -> list[float | str]:
        """The one speed or height, or the first and the last; none where nothing is said."""
        said = self.conical_height if isinstance(self.angular_speed, UnsetType) else self.angular_speed
        return [] if isinstance(said, UnsetType) else list(said)


class AskSwing(Table, frozen=True):
    """A hanging chain let go: small oscillations in a plane. Numbers are SI or text with a unit.

    Attributes
    ----------
    offset : list of float or str
        Of each pin at time 0, the free end first, the support left out.
    velocity : list of float or str, optional
        Likewise; at rest if left out.
    until : float or str
        To this time.
    steps : int
        How many times from 0 to there.
    """

    offset: Annotated[AtEveryPin, Meta(description="Of each pin at the start, the free end first.")]
    velocity: Annotated[AtEveryPin | UnsetType, Meta(description="Likewise (m/s); at rest if left out.")] = UNSET
    until: Annotated[Positive, Meta(description="To this time (s).")] = 10.0
    steps: Annotated[Count, Meta(description="How many times from 0 to there.")] = 200


class Held(Table, frozen=True):
    """The lower end is held on the axis, too. Numbers are SI or text with a unit.

    Attributes
    ----------
    span : float or str
        From end to end, less than the length: the chain bows out as it turns.
    tension : float or str
        Instead: the pull at the lower end, of a chain drawn straight.
    weightless : bool
        Whether gravity plays no part, as of a skipping rope turned fast.
    """

    span: Annotated[Positive | UnsetType, Meta(description="From end to end, less than the length.")] = UNSET
    tension: Annotated[
        Positive | UnsetType, Meta(description="Instead: pull at the lower end of a straight chain (N).")
    ] = UNSET
    weightless: Annotated[bool, Meta(description="Whether gravity plays no part.")] = False


class Ask(Table, frozen=True):
    """What is asked.

    Attributes
    ----------
    modes : int or "all"
        How many modes, slowest first; 10, or as many as there are, if left out.
    first : int
        Number of the slowest mode wanted, from 1; those before are not computed.
    conical_height : [low, high], optional
        Instead of `modes` and `first`: the modes with low < conical height <= high.
    angular_speed : [low, high], optional
        Instead of them: the modes with low <= whirl speed < high, in rad/s.
    rtol : float, optional
        Relative tolerance of the conical heights; as accurate as possible if left out.
    certify : bool
        Whether to give for each height the interval that holds it and the counts that prove it.
    precision, method : str
        As for `revchain.modes`.
    shapes : AskShapes, optional
        What `Scene.steady_shapes` finds.
    response : AskResponse, optional
        What `Scene.response` finds.
    swing : AskSwing, optional
        What `Scene.small_oscillation` finds.
    """

    modes: Annotated[
        Count | Literal["all"] | UnsetType,
        Meta(description="How many modes, slowest first; 10, or as many as there are, if left out."),
    ] = UNSET
    first: Annotated[Count | UnsetType, Meta(description="Number of the slowest mode wanted, from 1.")] = UNSET
    conical_height: Annotated[
        tuple[NotNegative, NotNegative] | UnsetType,
        Meta(description="Instead of modes and first: low < conical height <= high."),
    ] = UNSET
    angular_speed: Annotated[
        tuple[NotNegativeNumber, NotNegativeNumber] | UnsetType,
        Meta(description="Instead of modes and first: low <= whirl speed < high, in rad/s."),
    ] = UNSET
    rtol: Annotated[
        Annotated[float, Meta(ge=0)] | UnsetType,
        Meta(description="Relative tolerance of the heights; as accurate as possible if left out."),
    ] = UNSET
    certify: Annotated[bool, Meta(description="Whether to prove each height with an interval and its counts.")] = False
    precision: Annotated[
        Literal["single", "double", "extended", "double-double"], Meta(description="The arithmetic of the result.")
    ] = "double"
    method: Annotated[
        Literal["auto", "bisection", "condensed", "aberth", "interpolated", "dense", "recurrence"],
        Meta(description="How to compute."),
    ] = "auto"
    shapes: Annotated[AskShapes | UnsetType, Meta(description="Steady shapes at any inclination.")] = UNSET
    response: Annotated[AskResponse | UnsetType, Meta(description="What a support carried round does.")] = UNSET
    swing: Annotated[AskSwing | UnsetType, Meta(description="The chain let go from here.")] = UNSET
