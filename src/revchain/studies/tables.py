# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a study file beside its scene: what is varied, and how."""

from __future__ import annotations

from typing import Annotated

from msgspec import UNSET, Meta, UnsetType

from ..scenes.tables import Table

MOST_POINTS = 10**12

NumberOrText = float | str
Samples = Annotated[int, Meta(ge=1, le=MOST_POINTS)]
TwoNumbers = Annotated[list[NumberOrText], Meta(min_length=2, max_length=2)]


class Vary(Table, frozen=True, rename={"first": "from", "last": "to"}):
    """What one number of the scene is to be. Numbers are SI or text with a unit, as in the scene.

    Attributes
    ----------
    first, last : float or str
        Keys ``from`` and ``to``: a grid from one to the other, both included.
    steps : int
        Of how many values, with `from` and `to`.
    log : bool
        Whether those are spaced in equal ratios, not in equal differences.
    values : list of float, str or bool
        Instead: these.
    uniform : [low, high]
        Instead: random, low <= number < high.
    normal : [mean, deviation]
        Instead: random, of the normal distribution.
    log_uniform : [low, high]
        Instead: random, the logarithm uniform.
    name : str, optional
        What its column is called; the path if left out.
    """

    first: Annotated[NumberOrText | UnsetType, Meta(description="The first value of a grid.")] = UNSET
    last: Annotated[NumberOrText | UnsetType, Meta(description="Its last value.")] = UNSET
    steps: Annotated[Samples | UnsetType, Meta(description="How many values, both ends included.")] = UNSET
    log: Annotated[bool, Meta(description="Whether in equal ratios instead of equal differences.")] = False
    values: Annotated[
        Annotated[list[bool | float | str], Meta(min_length=1)] | UnsetType,
        Meta(description="Instead: a grid of these values."),
    ] = UNSET
    uniform: Annotated[TwoNumbers | UnsetType, Meta(description="Instead: random, low <= number < high.")] = UNSET
    normal: Annotated[TwoNumbers | UnsetType, Meta(description="Instead: random, [mean, deviation].")] = UNSET
    log_uniform: Annotated[
        TwoNumbers | UnsetType, Meta(description="Instead: random, the logarithm uniform, [low, high].")
    ] = UNSET
    name: Annotated[str | UnsetType, Meta(description="Of its column; the path if left out.")] = UNSET
