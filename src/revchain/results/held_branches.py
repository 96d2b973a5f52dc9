# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes of chains and cords held at a span."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..systems.chain import Chain
from ..systems.held import Held
from ..systems.numbers import Floats, Whole, place_of
from .base import Field, Result, Results
from .bent import HeldCordShape, HeldShape
from .branches import branch_items, branch_sizes, fold_words, is_fold
from .moving import Moving
from .sheet import Column, Sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class HeldBranch(Result, Moving):
    """A branch of steady shapes of a chain or cord held at a span; returned by `branch` and `branches`.

    Arrays have one number for each point, from the greatest speed to lower speeds and, after a fold, back.

    Examples
    --------
    >>> import revchain as rc
    >>> blade = rc.Held(rc.Chain.uniform_rods(20, length=24.0, mass=160.0), span=17.0)
    >>> branch = rc.branch(blade, 1, max_angular_speed=6.0)
    >>> branch.angular_speed[[0, -1]].round(3), branch.end
    (array([6.   , 0.828]), 'slack')
    """

    __slots__ = ()
    system: Field[Held] = Field("The held system.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.")
    mode: Field[int] = Field(
        "Number of the branch: its half waves at the greatest speed. With ends off the axis the number is ``2 * k - 1`` if the "
        "lowest link of the k half waves leads outwards, ``2 * k`` if inwards.",
    )
    conical_height: Field[Floats] = Field(
        "Conical height of the speed, m.", lambda b: _each(b, lambda s: s.conical_height), part=True
    )
    angular_speed: Field[Floats] = Field("Speed at each point, rad/s.", lambda b: np.sqrt(b.gravity / b.conical_height))
    lowest_inclination: Field[Floats] = Field(
        "Inclination of the lowest link (of a cord: of its lower end) to the upward vertical, rad.",
        lambda b: _each(b, lambda s: s.inclination[0]),
        part=True,
    )
    largest_offset: Field[Floats] = Field(
        "Largest distance of a pin or place from the axis, m.", lambda b: _each(b, lambda s: np.abs(s.offset).max()), part=True
    )
    top_tension: Field[Floats] = Field(
        "Tension at the upper end, N or in the unit of the weights.",
        lambda b: b._force * _each(b, lambda s: s.height_times_tension[-1] / s.conical_height),
        part=True,
    )
    moment_of_inertia: Field[Floats] = Field(
        "Moment of inertia about the axis, kg m^2; for a chain given by weight, in weight times length squared.",
        lambda b: _each(b, lambda s: s.moment_of_inertia),
        part=True,
    )
    half_waves: Field[Whole] = Field(
        "Number of sign changes of the offsets, plus 1.",
        lambda b: np.array([s.half_waves for s in b._found().shapes], int),
        part=True,
    )
    folds: Field[Whole] = Field(
        "Indices of the points where the speed has a local minimum or maximum along the branch.",
        lambda b: np.array(b._found().folds, int),
        part=True,
    )
    end: Field[str] = Field(
        "Reason why the branch ends. ``'slack'``: a link becomes slack or turns over (the last speed is within a "
        "measured 2e-5, relative). ``'folded'``: a cord hangs folded along the axis. ``'speed'``: the greatest speed "
        "is reached again. ``'rest'``: with ends off the axis the chain hangs as at rest, at a conical height of "
        "10,000 lengths. ``'budget'``: 3000 steps are done.",
    )
    asked: Field[tuple[Any, ...]] = Field("Data to repeat the question, and the index in the list.")

    def shape(self, point: int) -> HeldShape | HeldCordShape:
        """Return the shape at a point of the branch.

        Parameters
        ----------
        point : int
            Index of the point; a negative one counts from the end.

        Returns
        -------
        HeldShape or HeldCordShape
            The shape. Its error bound is an estimate; for a chain `steady_shapes` at its speed proves one.

        Raises
        ------
        ValueError
            If there is no such point.

        Examples
        --------
        >>> import revchain as rc
        >>> blade = rc.Held(rc.Chain.uniform_rods(20, length=24.0, mass=160.0), span=17.0)
        >>> rc.branch(blade, 1, max_angular_speed=6.0).shape(0).stability().verdict
        'minimum'
        """
        k = place_of("revchain.HeldBranch.shape", "point", point, len(self))
        kind: Any = HeldShape if isinstance(self.system.system, Chain) else HeldCordShape
        shape: HeldShape | HeldCordShape = kind._made(
            self._found().shapes[k],
            system=self.system,
            gravity=self.gravity,
            angular_speed=float(self.angular_speed[k]),
            _asked=("branch", *self.asked, k),
        )
        return shape

    def plot(self, ax: Axes | None = None, *, quantity: str = "largest_offset") -> Axes:
        """Draw a quantity of the branch against the speed; folds are marked.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.
        quantity : {"largest_offset", "lowest_inclination", "top_tension", "moment_of_inertia"}
            Quantity to draw; an inclination is in degrees.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing.

        Raises
        ------
        ValueError
            If `quantity` is another word.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> blade = rc.Held(rc.Chain.uniform_rods(20, length=24.0, mass=160.0), span=17.0)
        >>> rc.branch(blade, 1, max_angular_speed=6.0).plot().get_xlabel()
        'speed (rad/s)'
        """
        from ..plots.branches import plot_held_branches

        return plot_held_branches([self], ax, quantity=quantity, place="revchain.HeldBranch.plot")

    @property
    def _force(self) -> float:
        return self.system._force(self.gravity)

    def __len__(self) -> int:
        return int(self.conical_height.size)

    def _from_parts(self) -> Any:
        return branch_again(self.system, self.asked)

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("point", np.arange(len(self)), "point"),
            Column("angular_speed", self.angular_speed, "speed (rad/s)"),
            Column("conical_height", self.conical_height, "height (m)"),
            Column("lowest_inclination", self.lowest_inclination, "lowest link (°)", shown=np.degrees(self.lowest_inclination)),
            Column("largest_offset", self.largest_offset, "largest distance from axis (m)"),
            Column("top_tension", self.top_tension, "top tension"),
            Column("half_waves", self.half_waves, "half waves"),
            Column("fold", is_fold(self), "fold"),
            Column("moment_of_inertia", self.moment_of_inertia),
        ]
        waves = self.mode if self.system.is_on_axis else int(self.half_waves[0])
        name = f"Branch of {waves} half wave{'s' * (waves != 1)}"
        name += "" if self.system.is_on_axis else f" (mode {self.mode})"
        heading = f"{name}: {fold_words(self)}"
        facts = {"mode": self.mode, "end": self.end, "gravity": self.gravity}
        return Sheet("point", heading, columns, facts, spread=True)


class HeldBranches(Results[HeldBranch], Moving):
    """The branches of a chain or cord held at a span that start at one speed, ordered by half waves.

    Examples
    --------
    >>> import revchain as rc
    >>> blade = rc.Held(rc.Chain.uniform_rods(20, length=24.0, mass=160.0), span=17.0)
    >>> [(each.mode, each.end) for each in rc.branches(blade, max_angular_speed=3.0)]
    [(1, 'slack'), (2, 'slack')]
    """

    __slots__ = ()
    system: Field[Held] = Field("The held system.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.")

    def plot(self, ax: Axes | None = None, *, quantity: str = "largest_offset") -> Axes:
        """Draw a quantity of each branch against the speed, coloured by half waves; folds are marked.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.
        quantity : {"largest_offset", "lowest_inclination", "top_tension", "moment_of_inertia"}
            Quantity to draw; an inclination is in degrees.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing.

        Raises
        ------
        ValueError
            If `quantity` is another word.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> blade = rc.Held(rc.Chain.uniform_rods(20, length=24.0, mass=160.0), span=17.0)
        >>> ax = rc.branches(blade, max_angular_speed=3.0).plot()
        >>> ax.get_ylabel()
        'largest distance from axis (m)'
        """
        from ..plots.branches import plot_held_branches

        return plot_held_branches(self, ax, quantity=quantity, place="revchain.HeldBranches.plot")

    def _sheet(self, brief: bool = False) -> Sheet:
        on_axis = self.system.is_on_axis
        columns = [Column("mode", [each.mode for each in self], "half waves" if on_axis else "mode"), *branch_sizes(self)]
        number = f"{len(self)} branch{'es' * (len(self) != 1)}"
        return Sheet("branch", f"{number} from the nearly straight chain", columns, {"gravity": self.gravity})


def _each(branch: HeldBranch, of: Any) -> Floats:
    return np.array([of(shape) for shape in branch._found().shapes], float)


def branch_again(held: Held, asked: tuple[Any, ...]) -> Any:
    """The compiled branch, computed again."""
    height, step, gravity, place = asked
    assert held.span is not None
    found: Any = _core.held_branches(held.system._compiled, held.span, *held._ends(gravity), height, step)
    return found[place]


def held_branches_made(found: list[Any], held: Held, gravity: float, asked: tuple[Any, ...]) -> HeldBranches:
    """The list of the compiled branches of a held system."""
    given: dict[str, Any] = {"system": held, "gravity": gravity}
    return HeldBranches._made(None, _items=branch_items(HeldBranch, found, asked, given), **given)
