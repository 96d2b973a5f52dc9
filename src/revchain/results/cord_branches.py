# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes of a cord."""

from __future__ import annotations

from typing import Any

from .. import _core
from ..systems.cord import Cord
from ..systems.numbers import Floats, height_of, one_positive, place_of
from .base import Field
from .bent import CordShape, branch_shape
from .branches import Branch, Branches, StabilityWindow, branch_items
from .shapes import is_driven


class CordBranch(Branch):
    """A branch of steady shapes of a cord, point by point along its arc; returned by `branch` and `branches`.

    Examples
    --------
    >>> import revchain as rc
    >>> branch = rc.branch(rc.Cord(1.0, mass=2.0), 1, max_angular_speed=20.0)
    >>> branch.angular_speed[[0, -1]].round(4), branch.folds.size, branch.end
    (array([ 3.7654, 20.    ]), 0, 'height')
    """

    __slots__ = ()
    system: Field[Cord] = Field("The cord.")  # type: ignore[assignment]
    direction: Field[int] = Field("Always 1: a cord is alike in both directions of rotation.", lambda b: 1, part=True)
    birth: Field[str] = Field(
        "Start of the branch. ``'vertical'``: it leaves the straight cord at a critical speed. ``'fold'``: it is isolated; "
        "two shapes start at a fold.",
        lambda b: "fold" if b.mode is None else "vertical",
        part=True,
    )
    arc: Field[Floats] = Field(
        "Arc length of the branch from its first point, dimensionless: the root of the squares of ``d "
        "arsinh(tan(tip_inclination))`` and ``d log(conical_height)``, summed up.",
    )

    def shape(self, point: int) -> CordShape:  # type: ignore[override]
        """Return the shape at a point of the branch.

        Parameters
        ----------
        point : int
            Index of the point; a negative one counts from the end.

        Returns
        -------
        CordShape
            The shape. At a fold its ``error_estimate`` is 1e-7, because of the place of the fold on the arc.

        Raises
        ------
        ValueError
            If there is no such point, or it is the straight cord, at which the branch of a mode starts.

        Examples
        --------
        >>> import revchain as rc
        >>> branch = rc.branch(rc.Cord(1.0), 1, min_conical_height=0.1)
        >>> round(float(branch.shape(-1).offset[0]), 6)
        0.989943
        """
        number = place_of("revchain.CordBranch.shape", "point", point, len(self))
        found = self._found().shape(number)
        return branch_shape(found, self.system, self.gravity, bool((self.folds == number).any()))

    def at(  # type: ignore[override]
        self,
        *,
        conical_height: float | None = None,
        angular_speed: float | None = None,
        gravity: float | None = None,
    ) -> tuple[CordShape, ...]:
        """Return the shapes at a speed on the part of the branch that was followed.

        Parameters
        ----------
        conical_height : float
            Conical height of the speed, m, positive.
        angular_speed : float
            Speed in rad/s, positive, instead of `conical_height`.
        gravity : float, optional
            Acceleration of gravity, m/s^2; that of the branch if left out.

        Returns
        -------
        tuple of CordShape
            The shapes in the order of the arc; empty if the branch does not pass the speed.

        Raises
        ------
        ValueError
            If not exactly one of `conical_height` and `angular_speed` is given, or a number is not positive
            and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> branch = rc.branch(rc.Cord(1.0), 2, min_conical_height=0.05)
        >>> [shape.half_waves for shape in branch.at(conical_height=0.1)]
        [2]
        """
        place = "revchain.CordBranch.at"
        g = self.gravity if gravity is None else one_positive(place, "gravity", gravity)
        height = height_of(place, conical_height, angular_speed, g)
        return tuple(branch_shape(found, self.system, g) for found in self._found().shapes_at(height))

    def stability_windows(
        self, *, frame: str = "free", tolerance: float = 1e-6, samples: int = 8
    ) -> list[StabilityWindow]:
        """Raise a ValueError: a cord has no windows; use the stability of its shapes, ``branch.shape(k).stability()``.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            Not used.
        tolerance : float, optional
            Not used.
        samples : int, optional
            Not used.

        Returns
        -------
        list of StabilityWindow
            Nothing is returned.

        Raises
        ------
        ValueError
            Always.

        Examples
        --------
        >>> import revchain as rc
        >>> branch = rc.branch(rc.Cord(1.0), 1, min_conical_height=0.1)
        >>> branch.shape(-1).stability().verdict
        'minimum'
        """
        place = "revchain.CordBranch.stability_windows"
        is_driven(place, frame)
        raise ValueError(f"{place}: is for chains; use the stability of shapes: branch.shape(-1).stability()")

    def _from_parts(self) -> Any:
        core = self.system._compiled
        if len(self.asked) == 4:
            return _core.cord_branch(core, *self.asked)
        return _core.cord_branches(core, *self.asked[:-1]).branches[self.asked[-1]]


class CordBranches(Branches):
    """All branches of a cord found down to one conical height: those of the modes, slowest first, then isolated ones.

    Examples
    --------
    >>> import revchain as rc
    >>> diagram = rc.branches(rc.Cord(1.0), min_conical_height=0.05)
    >>> [each.mode for each in diagram], diagram.complete
    ([1, 2, 3], True)
    """

    __slots__ = ()
    system: Field[Cord] = Field("The cord.")  # type: ignore[assignment]
    direction: Field[int] = Field("Always 1: a cord is alike in both directions of rotation.", lambda b: 1, part=True)
    consistent: Field[bool] = Field(
        "Whether at each of the speeds `looked_at` each shape found by a scan lies on exactly one branch."
    )
    complete: Field[bool] = Field(
        "Whether a theorem counts the shapes (see `steady_shapes`) and every branch was followed to its end. Then no branch "
        "is missing.",
    )


def cord_branches_made(found: Any, system: Cord, gravity: float, asked: tuple[Any, ...]) -> CordBranches:
    """The list of the compiled branches of a cord."""
    given: dict[str, Any] = {"system": system, "gravity": gravity}
    return CordBranches._made(found, _items=branch_items(CordBranch, found.branches, asked, given), **given)
