# SPDX-License-Identifier: GPL-3.0-or-later
"""The drag of still air on links that move fast: an argument of `drag_shape`."""

from __future__ import annotations

from numpy.typing import ArrayLike

from .numbers import floats, read_only
from .rig import _Fitting, check_columns, refuse_empty

STANDARD_DENSITY = 1.225


class Drag(_Fitting):
    """Quadratic drag of still air on the links of a chain, on bodies at them, or on both.

    Give each quantity as one number, or as an array with one number for each link, lowest first.

    Parameters
    ----------
    coefficient : array_like, shape (N,) or scalar
        Drag coefficient C: 1.0 to 1.2 for a smooth cylinder across the flow, 0.5 for a sphere, both below the drag crisis.
    diameter : array_like, optional
        Diameter d of each link as a cylinder, m. Its drag for each metre is ``density/2 C d |v| v``, with v the part of its
        velocity across the link.
    area : array_like, optional
        Frontal area A of a body at the centre of gravity of each link, m^2. Its drag is ``density/2 C A |v| v``, with v the
        velocity of that point.
    body_coefficient : array_like, optional
        Drag coefficient of the bodies, if it is not that of the links.
    density : float
        Density of the air, kg/m^3; 1.225 at sea level in the standard atmosphere (ISO 2533).

    Raises
    ------
    ValueError
        If neither diameter nor area is given, or a number is out of its range.

    References
    ----------
    Drag of an inclined cylinder: S. F. Hoerner, Fluid-Dynamic Drag (1965), chapter 3 (cross-flow principle).

    Examples
    --------
    A cord of 5 mm with a ball of 40 cm^2 at its free end:

    >>> import revchain as rc
    >>> rc.Drag(1.1, diameter=0.005, area=[40e-4, 0.0, 0.0], body_coefficient=0.5)
    Drag(coefficient=1.1, diameter=0.005, area=[0.004, 0.0, 0.0], body_coefficient=0.5)
    """

    __slots__ = ()

    def __init__(
        self,
        coefficient: ArrayLike,
        *,
        diameter: ArrayLike | None = None,
        area: ArrayLike | None = None,
        body_coefficient: ArrayLike | None = None,
        density: float = STANDARD_DENSITY,
    ) -> None:
        caller = "revchain.Drag"
        if diameter is None and area is None:
            raise ValueError(f"{caller}: give a diameter of the links, an area of bodies at them, or both, got neither")
        if coefficient is None:
            raise ValueError(f"{caller}: coefficient must be a number or an array of them, got None")
        given = {"coefficient": coefficient, "diameter": diameter, "area": area, "body_coefficient": body_coefficient}
        columns = {name: floats(caller, name, value) for name, value in given.items() if value is not None}
        columns["density"] = floats(caller, "density", density, "air_density")
        check_columns(caller, columns)
        for name, column in columns.items():
            refuse_empty(caller, name, column)
        if columns["density"].ndim:
            raise ValueError(f"{caller}: density must be one number, got an array of shape {columns['density'].shape}")
        if columns["density"] == STANDARD_DENSITY:
            del columns["density"]
        object.__setattr__(self, "_given", {name: read_only(column) for name, column in columns.items()})

    @property
    def density(self) -> float:
        """Density of the air, kg/m^3."""
        return float(self._given.get("density", STANDARD_DENSITY))
