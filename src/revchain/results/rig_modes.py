# SPDX-License-Identifier: GPL-3.0-or-later
"""What `revchain.modes` returns for a `Rig`."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..systems.numbers import Floats, Whole, boolean, positive, real, shown
from ..systems.rig import Rig

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..questions.response import Response
    from .sensitivity import RigSensitivity

Complex = NDArray[np.complex128]


@dataclass(frozen=True, slots=True, eq=False)
class WhirlModes:
    """Whirl modes of a rig in one sense of rotation, slowest first.

    Attributes
    ----------
    number : ndarray of int64, shape (k,)
        From 1 for the slowest of this sense.
    available : int
        How many there are in this sense, computed or not.
    conical_height : ndarray, shape (k,)
        ``gravity / angular_speed**2``, descending, in the unit of the chain's lengths.
    error_bound : ndarray, shape (k,)
        Of each height, relative to the exact one of the numbers stored; proved. Infinite where nothing was.
    angular_speed : ndarray, shape (k,)
        Size of the speed, rad/s.
    speed_error_bound : ndarray, shape (k,)
        Of each speed, relative; proved.
    shape : ndarray, shape (k, N + 1), or None
        Offsets of the pins, free end first, support last (0 where it is firm); the largest magnitude is 1,
        the free end positive.
    residual : ndarray, shape (k,), or None
        Of each shape, relative.
    """

    number: Whole
    available: int
    conical_height: Floats
    error_bound: Floats
    angular_speed: Floats
    speed_error_bound: Floats
    shape: Floats | None
    residual: Floats | None

    def __len__(self) -> int:
        return int(self.conical_height.size)


@dataclass(frozen=True, slots=True, eq=False)
class OtherModes:
    """What is no steady motion of a rig: conical heights that are negative or complex, or complex speeds.

    And infinite heights, speed 0: of links that weigh nothing in the fluid, which stay wherever they are put.

    Attributes
    ----------
    conical_height : ndarray of complex, shape (m,)
    angular_speed : ndarray of complex, shape (m,)
        ``n`` with ``n**2 * conical_height = gravity``; offsets turn and grow as ``exp(1j * n * t)``.
    growth_rate : ndarray, shape (m,)
        Size of the imaginary part, 1/s: small offsets grow as ``exp(growth_rate * t)``.
    error_bound : ndarray, shape (m,)
        Of each height, relative to its size; proved.
    """

    conical_height: Complex
    angular_speed: Complex
    growth_rate: Floats
    error_bound: Floats

    def __len__(self) -> int:
        return int(self.conical_height.size)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RigModes:
    """Whirl modes of a rig.

    Attributes
    ----------
    rig : Rig
    gravity : float
    has_momentum : bool
        Whether a link has angular momentum of its own, so that the two senses of rotation differ.
    forward, backward : WhirlModes
        Modes with positive and with negative speeds. Without momentum both senses are alike, and `backward`
        is empty.
    other : OtherModes
        What is no steady motion.
    slack_link : ndarray of int64, shape (s,)
        Links, from 0, lowest first, whose effective tension, ``tension + n * momentum / length``, vanishes
        between 0 and the fastest speed found in its sense.
    slack_speed : ndarray, shape (s,)
        The speeds at which it does, in rad/s, with their sign, slowest first.
    complete : bool
        Whether the numbers of modes and the list of others are proved to be all there is.
    method : str
        ``"modes"`` (there was nothing on the chain), ``"counts"`` or ``"discs"``.
    status : str
        ``"success"`` or ``"tolerance_not_met"``: something could not be proved.

    Examples
    --------
    A gyrostat on a link, ``A n^2 - H n - W h = 0``:

    >>> import revchain as rc
    >>> top = rc.Rig(rc.Chain(weight=9.80665, length=1.0), momentum=1.5)
    >>> rc.modes(top).angular_speed().round(4)
    array([-2.4701,  3.9701])
    """

    rig: Rig
    gravity: float
    has_momentum: bool
    forward: WhirlModes
    backward: WhirlModes
    other: OtherModes
    slack_link: Whole
    slack_speed: Floats
    complete: bool
    method: str
    status: str

    def __len__(self) -> int:
        return len(self.forward) + len(self.backward)

    @property
    def sense(self) -> Whole:
        """Of each mode, shape (k,): 1 forward, -1 backward, slowest first of both; all 1 without momentum."""
        signs = np.concatenate([np.ones(len(self.forward)), -np.ones(len(self.backward))])
        return self._both(signs.astype(np.int64))  # type: ignore[no-any-return]

    @property
    def number(self) -> Whole:
        """Of each mode among those of its sense, shape (k,), from 1."""
        return self._both(np.concatenate([self.forward.number, self.backward.number]))  # type: ignore[no-any-return]

    @property
    def conical_height(self) -> Floats:
        """Of the modes of both senses, shape (k,), descending."""
        return self._both(self._column("conical_height"))  # type: ignore[no-any-return]

    @property
    def error_bound(self) -> Floats:
        """Of each conical height, relative; proved."""
        return self._both(self._column("error_bound"))  # type: ignore[no-any-return]

    @property
    def shape(self) -> Floats | None:
        """Of the modes of both senses, shape (k, N + 1); None if shapes were not asked for."""
        return None if self.forward.shape is None else self._both(self._column("shape"))

    @property
    def residual(self) -> Floats | None:
        """Of the shapes, shape (k,); None if shapes were not asked for."""
        return None if self.forward.residual is None else self._both(self._column("residual"))

    def angular_speed(self) -> Floats:
        """Return the whirl speed of each mode under `gravity`, signed.

        Returns
        -------
        ndarray, shape (k,)
            In rad/s, slowest first, negative for backward modes. What is in `other` has none here.

        Examples
        --------
        >>> import revchain as rc
        >>> rig = rc.Rig(rc.Chain(weight=[1.0, 3.0], length=1.0), standing=[True, False])
        >>> rc.modes(rig).angular_speed().round(4)
        array([3.3651])
        """
        return self.sense * self._both(self._column("angular_speed"))  # type: ignore[no-any-return]

    def period(self) -> Floats:
        """Return the time of one turn of each mode, ``2 pi / |angular_speed|``.

        Returns
        -------
        ndarray, shape (k,)
            In seconds, descending.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Rig(rc.Chain(weight=1.0, length=0.5), stiffness=2.0)).period().round(4)
        array([2.0064])
        """
        return 2 * np.pi / np.abs(self.angular_speed())

    @property
    def sensitivity(self) -> RigSensitivity:
        """How every datum of the rig moves the whirl speeds: k rows, in the order of `angular_speed`.

        Raises
        ------
        ValueError
            If there are no shapes.

        Examples
        --------
        >>> import revchain as rc
        >>> rig = rc.Rig(rc.Chain(weight=[1.0, 3.0], length=1.0), momentum=[0.0, 0.5])
        >>> found = rc.modes(rig)
        >>> found.angular_speed().round(3)
        array([-2.315,  2.722, -3.939,  5.166])
        >>> found.sensitivity.momentum[:, 1].round(3)
        array([0.55 , 0.26 , 0.746, 1.713])
        """
        from .sensitivity import rig_sensitivity

        if self.shape is None:
            raise ValueError("RigModes.sensitivity: there are no shapes; compute them with shapes=True")
        return rig_sensitivity(self.rig, self.angular_speed(), self.shape, gravity=self.gravity)

    def to_dict(self, shapes: bool = True) -> dict[str, Any]:
        """Return everything as plain Python numbers, lists and strings, ready for JSON.

        Parameters
        ----------
        shapes : bool
            Whether to include the shapes, which are long.

        Returns
        -------
        dict
            ``{"modes": [{"mode": 1, "sense": 1, "angular_speed": ..., "period": ...,
            "revolutions_per_minute": ..., "conical_height": ..., "error_bound": ..., "residual": ...,
            "shape": [...]}, ...], "other": [{"conical_height": [real, imaginary], "growth_rate": ...,
            "error_bound": ...}, ...], "slack": [{"link": ..., "angular_speed": ...}], "complete": ...,
            "method": ..., "status": ..., "gravity": ..., "chain": {...}, "rig": "..."}``; speeds are signed,
            and links counted from 0.

        Examples
        --------
        >>> import revchain as rc
        >>> rig = rc.Rig(rc.Chain(weight=1.0, length=2.0), stiffness=2.0)
        >>> rc.modes(rig).to_dict()["modes"][0]["conical_height"]
        2.5
        """
        speed = self.angular_speed()
        columns = {
            "mode": self.number.tolist(),
            "sense": self.sense.tolist(),
            "angular_speed": speed.tolist(),
            "period": self.period().tolist(),
            "revolutions_per_minute": (speed * (30 / np.pi)).tolist(),
            "conical_height": self.conical_height.tolist(),
            "error_bound": self.error_bound.tolist(),
        }
        if self.shape is not None and self.residual is not None:
            columns["residual"] = self.residual.tolist()
            if boolean("revchain.RigModes.to_dict", "shapes", shapes):
                columns["shape"] = self.shape.tolist()
        other = self.other
        others = zip(other.conical_height.tolist(), other.growth_rate.tolist(), other.error_bound.tolist(), strict=True)
        slack = zip(self.slack_link.tolist(), self.slack_speed.tolist(), strict=True)
        chain = self.rig.chain
        return {
            "modes": [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)],
            "other": [
                {"conical_height": [height.real, height.imag], "growth_rate": rate, "error_bound": bound}
                for height, rate, bound in others
            ],
            "slack": [{"link": link, "angular_speed": at} for link, at in slack],
            "complete": self.complete,
            "method": self.method,
            "status": self.status,
            "gravity": self.gravity,
            "chain": {"size": chain.size, "length": chain.total_length, "weight": chain.total_weight},
            "rig": repr(self.rig),
        }

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything to a file, to be read again by `revchain.load`.

        Parameters
        ----------
        path : path-like
            Ends in ``.npz``.

        Raises
        ------
        ValueError
            If the path has another ending.
        OSError
            (a ValueError too) If the file cannot be written. It is written aside and renamed: what was
            there before stays until the new file is whole.

        Notes
        -----
        Nothing is rounded. No pickles inside.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "result.npz"
        >>> rc.modes(rc.Rig(rc.Chain(weight=1.0, length=2.0), stiffness=2.0)).save(path)
        >>> rc.load(path).conical_height
        array([2.5])
        """
        from .storage import save

        save(self, path)

    def plot(
        self, ax: Axes | None = None, *, most: int = 6, length_unit: str = "m", carried: Response | None = None
    ) -> Axes:
        """Draw the rig at rest, and beside it its shapes along the straight chain, standing links upwards and stout.

        Forward modes are blue, backward ones red, as are the wheels, seen edge-on; bodies that float are hollow.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        most : int
            How many modes, slowest first.
        length_unit : str
            What to write on the axis of depth.
        carried : Response, optional
            Of the same rig at one speed, every pin: drawn first, its support on its circle.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If there are no shapes, or `carried` is no such response.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> rig = rc.Rig(rc.Chain(weight=[1.0, 3.0], length=1.0), momentum=0.3)
        >>> rc.modes(rig).plot().get_ylabel()
        'depth below the support (m)'
        """
        from ..plots.rigs import plot_rig_modes

        return plot_rig_modes(self, ax, most, length_unit, carried)

    def __repr__(self) -> str:
        if self.has_momentum:
            what = f"{len(self.forward)} mode{'s' * (len(self.forward) != 1)} forward, {len(self.backward)} backward"
        else:
            what = f"{len(self.forward)} mode{'s' * (len(self.forward) != 1)}"
        if len(self.other):
            what += f", {len(self.other)} other"
        lines = [f"RigModes: {what} ({self.method}, {self.status})"]
        rows = zip(self.number[:10], self.angular_speed(), self.conical_height, strict=False)
        for number, speed, height in rows:
            lines.append(f"  {number:4d}  {speed:14.8g} rad/s  conical height {height:.8g}")
        if len(self) > 10:
            lines.append("  ...")
        return "\n".join(lines)

    def _column(self, name: str) -> Floats:
        forward: Floats = getattr(self.forward, name)
        return np.concatenate([forward, getattr(self.backward, name)]) if self.has_momentum else forward.copy()

    def _both(self, values: Any) -> Any:
        """Values of the modes of both senses, put in order of speed, read-only."""
        if self.has_momentum:
            values = values[np.argsort(-self._column("conical_height"), kind="stable")]
        values.flags.writeable = False
        return values


def rig_modes(
    place: str, rig: Rig, first: int, count: int | None, gravity: float, shapes: bool, progress: _core.Progress | None
) -> RigModes:
    """The modes of a rig number `first` ... of each sense."""
    g = float(positive(place, "gravity", real(place, "gravity", gravity)))
    has_momentum, forward, backward, other, link, speed, complete, method, status = _core.rig_modes(
        rig._compiled, first, count, g, boolean(place, "shapes", shapes), progress
    )
    return RigModes(
        rig,
        g,
        has_momentum,
        WhirlModes(*forward),
        WhirlModes(*backward),
        OtherModes(*other),
        link,
        speed,
        complete,
        method,
        status,
    )


def refuse_for_rigs(place: str, given: Iterable[tuple[str, object, object]]) -> None:
    """What `revchain.modes` offers for chains alone."""
    for name, value, default in given:
        if value != default:
            raise ValueError(
                f"{place}: {name} is for a Chain; a Rig's modes are chosen by count or modes, got {shown(value)}"
            )
