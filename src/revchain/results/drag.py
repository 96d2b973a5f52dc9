# SPDX-License-Identifier: GPL-3.0-or-later
"""`DragShape`: the result of `revchain.drag_shape`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..systems.drag import Drag
from ..systems.numbers import Floats, Whole
from .base import Field, Result
from .sheet import speed_text


class DragShape(Result, row="link", title="{summary}", notes=("{_remarks}",), good="status"):
    """The steady shape of a chain that is carried round through still air; returned by `drag_shape`.

    It turns as a rigid figure about the vertical axis. Coordinates are in the turning frame: x outward through the support
    (through a spring's rest position, if it has one), y in the sense of the motion, z upward from the support.

    Examples
    --------
    A chair of 80 kg on a carousel:

    >>> import revchain as rc
    >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=3.0))
    >>> shape = rc.drag_shape(carousel, rc.Drag(1.0, area=0.6), angular_speed="12 rpm")
    >>> shape
    Shape with drag at 12.0000 rpm (1.25664 rad/s), success: torque 107.743 N m, power 135.394 W
    link  inclination (°)  azimuth (°)  lower pin: outward (m)  in the sense of motion (m)  above support (m)  from axis (m)  tension (N)
       0          42.5811     -2.85545                  5.7032                    -0.13483            -2.9453         5.7048      1065.48
    azimuth: from outward towards the sense of motion, negative where a link trails; error estimate 4.4e-16 rad
    """

    __slots__ = ()
    link: Field[Whole] = Field(
        "Number of each link in the list that was given; the lowest link first.",
        lambda s: s.system._link_numbers,
        heading="link",
        shown=lambda s: getattr(s.system, "names", None) or getattr(s.system.chain, "names", None),
    )
    system: Field[Any] = Field("The rig.")
    angular_speed: Field[float] = Field("The turning speed, rad/s, as given.", fact=True)
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    _half_waves: Field[int | None] = Field("Half waves of the shape without drag, as given.")
    _drag: Field[dict[str, Floats]] = Field("The arguments of `drag`.")
    inclination: Field[Floats] = Field(
        "Inclination of each link to the downward vertical, 0 to pi, rad, shape (N,).",
        part=True, heading="inclination", unit="rad",
    )
    azimuth: Field[Floats] = Field(
        "Direction in which each link leads away from its upper pin, seen from above: from outward (x) towards the sense "
        "of motion (y), rad, within (-pi, pi], shape (N,). Negative where the link trails.",
        part=True, heading="azimuth", unit="rad",
    )
    outward: Field[Floats] = Field(
        "x of the lower pin of each link, m, shape (N,).", lambda s: s.position[:-1, 0],
        heading="lower pin: outward", unit="m", digits=5,
    )
    ahead: Field[Floats] = Field(
        "y of the lower pin of each link, m, shape (N,).", lambda s: s.position[:-1, 1],
        heading="in the sense of motion", unit="m", digits=5,
    )
    height: Field[Floats] = Field(
        "z of the lower pin of each link, m, shape (N,).", lambda s: s.position[:-1, 2],
        heading="above support", unit="m", digits=5,
    )
    distance: Field[Floats] = Field(
        "Distance of the lower pin of each link from the axis, m, shape (N,).", lambda s: np.hypot(s.outward, s.ahead),
        heading="from axis", unit="m", digits=5,
    )
    tension: Field[Floats] = Field(
        "Magnitude of the reaction at the upper pin of each link, shape (N,), N or in the unit of the weights.",
        lambda s: s._per * s._found().tension, part=True, heading="tension", unit="force",
    )
    position: Field[Floats] = Field(
        "Coordinates x, y, z of each pin in the turning frame, m, shape (N + 1, 3), free end first, support last.",
        part=True,
    )
    torque: Field[float] = Field(
        "Torque about the axis that keeps the chain turning, in the sense of the motion, N m (or weight times length), "
        "without the drag of the arm.",
        lambda s: s._per * s._found().torque, part=True, fact=True,
    )
    power: Field[float] = Field(
        "Torque times speed, W.", lambda s: s.torque * abs(s.angular_speed), fact=True
    )
    status: Field[str] = Field(
        "``'success'``; ``'fold'`` if the way to this speed or drag turns back at `factor`; ``'stalled'`` if the "
        "continuation did not converge.",
        part=True, fact=True,
    )
    factor: Field[float] = Field(
        "1 on success; otherwise the share of the drag or, from rest, of the squared speed at which the shape is.",
        part=True, fact=True,
    )
    folds: Field[int] = Field(
        "Number of folds on the way. If it is not 0, a chain whose speed (or drag) grows slowly jumps, perhaps to another "
        "shape.",
        part=True, fact=True,
    )
    residual: Field[float] = Field(
        "Largest unbalanced moment about an upper pin, over total weight times total length.", part=True, fact=True
    )
    error_estimate: Field[float] = Field("Estimated error of the direction of each link, rad.", part=True, fact=True)
    summary: Field[str] = Field("What was found, in words.", lambda s: s._words())

    @property
    def drag(self) -> Drag:
        """The drag, as given."""
        return Drag(**self._drag)  # type: ignore[arg-type]

    @property
    def half_waves(self) -> int | None:
        """Half waves of the shape without drag, as given; None for the shape that begins at rest."""
        return self._half_waves

    @property
    def _per(self) -> float:
        return float(self.system._force(self.gravity))

    def _words(self) -> str:
        newton, watt = (" N m", " W") if self.system.by_mass else ("", "")
        speed = f"{self.angular_speed:.6g} rad/s ({self.angular_speed * 30 / np.pi:.4g} rpm)"
        if self._speed_unit in ("rpm", "Hz", "s"):
            speed = speed_text(self.angular_speed, self._speed_unit)
        reached = "" if self.status == "success" else f" at {self.factor:.4g} of the "
        if reached:
            reached += "squared speed" if self._half_waves is None else "drag"
        at = f"Shape with drag at {speed}, {self.status}{reached}"
        return f"{at}: torque {self.torque:#.6g}{newton}, power {self.power:#.6g}{watt}"

    @property
    def _remarks(self) -> str:
        lines = [
            "azimuth: from outward towards the sense of motion, negative where a link trails; error estimate "
            f"{self.error_estimate:.1e} rad"
        ]
        if self.folds:
            lines.append(f"the way to this shape passes {self.folds} fold{'s' * (self.folds > 1)}: a chain that follows it jumps")
        return "\n".join(lines)
