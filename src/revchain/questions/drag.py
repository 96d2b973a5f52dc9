# SPDX-License-Identifier: GPL-3.0-or-later
"""`drag_shape`: the steady shape of a chain that is carried round through still air."""

from __future__ import annotations

import numpy as np

from .. import _core
from ..results.drag import DragShape
from ..systems.chain import Chain
from ..systems.drag import Drag
from ..systems.numbers import STANDARD_GRAVITY, count, floats, one_positive, real, shown
from ..systems.rig import Rig
from .asked import in_unit_of
from .refuse import refuse_other

_CALLER = "revchain.drag_shape"
_NOTHING = np.zeros(1)
_FASTEST = 1e100  # rad/s: the square of the speed, in the drag, stays finite
_MOST_WAVES = 2**31 - 1  # what the compiled module can hold


@in_unit_of("angular_speed")
def drag_shape(
    system: Rig,
    drag: Drag,
    *,
    angular_speed: float,
    half_waves: int | None = None,
    gravity: float = STANDARD_GRAVITY,
) -> DragShape:
    """Return the steady shape of a chain that an arm carries round through still air.

    The figure is rigid, turns about the vertical and leaves the plane through axis and support. The pins are ball joints,
    which pass on no torque: the moment of the drag about the axis is balanced by the force on the support.

    Parameters
    ----------
    system : Rig
        The rig, with its support off the axis: ``Support(radius=)``.
    drag : Drag
        Drag of the links, of bodies at them, or of both.
    angular_speed : float
        Speed, rad/s, not 0; negative: the other direction, which makes a difference for flywheels only.
    half_waves : int, optional
        Number of half waves of the shape without drag from which to start; of several the one whose free end is farthest
        out, as in `campbell`. If left out, the shape that begins at rest.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.

    Returns
    -------
    DragShape
        The shape, the torque and the power. Other shapes may exist.

    Raises
    ------
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`, or `drag` is not a `Drag`.
    ValueError
        If `system` is a `Cord` or a `Held`, or its support is on the axis; if a rig has springs at pins, a dashpot at its
        support, linear drag, or a fluid that turns with it; if an array of the drag does not have one number for each link;
        if a number is out of its range; if no shape without drag has `half_waves`.

    Notes
    -----
    Method: continuation by arc length. From rest, the squared speed grows from 0, and the drag with it; with `half_waves`,
    the drag grows from 0. Drag is integrated along each link by Gauss's rule. If the way turns back at a fold and does not
    lead to the full speed or drag, `DragShape.status` is ``fold`` and the shape is that at the first fold. Then try the
    other way: ``half_waves=1``, or none. A support on a spring yields alike in all horizontal directions.

    Accuracy (measured, not proved): one link within 2e-15 rad of 40 digits; of 10,000 random chains 99 % within 1e-14 rad,
    all within 3e-13 rad. Cost: O(N) a step; for rods with a ball as below 0.3 ms for one, 8 ms for a hundred; with
    `half_waves` also that of `steady_shapes`. Source: drag of an inclined cylinder by the cross-flow principle, Hoerner,
    Fluid-Dynamic Drag (1965), chapter 3; the whirling machine is Greenhill (1908), section 1 (8).

    Examples
    --------
    A cord of 2 m with a ball, carried round by a hand 0.3 m from the axis, in a vacuum and in air:

    >>> import revchain as rc
    >>> cord = rc.Chain.uniform_rods(20, length=2.0, mass=0.04).with_body(mass=0.1)
    >>> sling = rc.Rig(cord, support=rc.Support(radius=0.3))
    >>> for diameter in (0.0, 0.004):
    ...     shape = rc.drag_shape(sling, rc.Drag(1.1, diameter=diameter), angular_speed=8.0)
    ...     print(shape.position[0].round(3), round(shape.torque, 4))
    [ 2.295  0.    -0.14 ] 0.0
    [ 2.249 -0.425 -0.14 ] 1.185
    """
    if isinstance(system, Chain):
        system = Rig(system)
    its_chain = "use its chain: Rig(cord.chain(100), support=Support(radius=...))"
    refuse_other(_CALLER, system, ("rig",), {"cord": its_chain, "held": "use steady_shapes, without drag"})
    if not isinstance(drag, Drag):
        raise TypeError(f"{_CALLER}: drag must be a revchain.Drag, got {shown(drag)}")
    speed = real(_CALLER, "angular_speed", floats(_CALLER, "angular_speed", angular_speed))
    if abs(speed) > _FASTEST:
        raise ValueError(f"{_CALLER}: angular_speed must be at most {_FASTEST:g} in size, got {speed:g}")
    waves = None if half_waves is None else count(_CALLER, "half_waves", half_waves)
    g = one_positive(_CALLER, "gravity", gravity)
    given = {name: drag._given.get(name, _NOTHING) for name in ("coefficient", "diameter", "area")}
    for name, column in {**given, "body_coefficient": drag._given.get("body_coefficient", _NOTHING)}.items():
        if column.ndim > 1 or column.size not in (1, system.size):
            raise ValueError(
                f"{_CALLER}: {name} of the drag must be a number or an array with one for each of the {system.size} links, "
                f"got shape {column.shape}"
            )
    bodies = drag._given.get("body_coefficient", given["coefficient"])
    core = _core.drag_shape(
        system._under(g), **given, body_coefficient=bodies, density=drag.density, angular_speed=speed,
        half_waves=None if waves is None else min(waves, _MOST_WAVES), gravity=g, force=system._force(g),
    )
    return DragShape._made(
        core, system=system, gravity=g, angular_speed=speed, _half_waves=waves, _drag=dict(drag._given)
    )
