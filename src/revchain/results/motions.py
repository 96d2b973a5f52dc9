# SPDX-License-Identifier: GPL-3.0-or-later
"""Small motions: the response to a moving support, and the free swing after release."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..systems.numbers import Floats, Numbers, Whole
from .base import Field, Result
from .moving import Moving
from .sheet import Column, Sheet, speed_columns


Flags = NDArray[np.bool_]
Complex = NDArray[np.complex128]
TURN = 2 * np.pi
BENT = 0.3  # part of the length of a chain; a larger offset is not a small amplitude
MOST_RESONANCES = 60  # largest number that a plot marks; more would blacken it


class Response(Result, Moving):
    """Forced motion of a chain or rig whose support is moved or pushed, at one or more speeds; returned by `response`.

    Arrays have the shape of the given speeds, ``(...)``; those of pins have one more axis. Without flywheels and a fluid
    that turns, the numbers are also amplitudes for a support that moves to and fro along a line (base excitation). With
    dashpots or linear drag offsets and forces are complex: the real part of ``offset * exp(1j * angular_speed * time)`` is
    where a pin is while the drive goes as the cosine.

    Examples
    --------
    >>> import revchain as rc
    >>> found = rc.response(rc.Chain(weight=[1.0, 3.0], length=1.0), conical_height=[3.0, 1.0, 0.1])
    >>> found.offset
    array([[ 2.4       ,  1.6       ,  1.        ],
           [-4.        ,  0.        ,  1.        ],
           [ 0.01785714, -0.16071429,  1.        ]])
    >>> found.modes_below
    array([0, 1, 2])
    """

    __slots__ = ()
    system: Field[Any] = Field("The chain or rig.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.")
    angular_speed: Field[Floats] = Field("Speeds of the support, rad/s, shape (...).")
    frequency: Field[Floats] = Field("Revolutions per second, Hz, shape (...).", lambda r: r.angular_speed / TURN)
    rpm: Field[Floats] = Field("Revolutions per minute, shape (...).", lambda r: r.angular_speed * (60 / TURN))
    period: Field[Floats] = Field("Time of one revolution, s, shape (...).", lambda r: TURN / np.abs(r.angular_speed))
    conical_height: Field[Floats] = Field("Conical heights ``gravity / angular_speed**2``, m, shape (...).")
    support_radius: Field[float | None] = Field("Radius of the circle, m; None if an acceleration or a force is given.")
    acceleration: Field[float | None] = Field(
        "Amplitude of the acceleration of the support, m/s^2, if given.", lambda r: None, part=True
    )
    force: Field[float | None] = Field("Amplitude of the force on the support, if given.", lambda r: None, part=True)
    pins: Field[Whole] = Field(
        "Numbers of the pins, from 0 for the free end, shape (P,); if a single number was asked, without this axis.",
    )
    offset: Field[Numbers] = Field(
        "Offsets of the pins from the axis, m, shape (..., P), positive on the side of the support (of the acceleration, of the "
        "force); complex with dashpots. NaN at a resonance.",
    )
    amplitude: Field[Floats] = Field("Sizes of the offsets, m, shape (..., P).", lambda r: np.abs(r.offset))
    phase: Field[Floats] = Field(
        "Angles by which the pins are ahead of the drive, rad, shape (..., P); negative: they lag.",
        lambda r: np.angle(r.offset),
    )
    amplification: Field[Numbers | None] = Field(
        "Offsets divided by the amplitude of the support (of the far end of its spring), shape (..., P); None for a force.",
        lambda r: r._amplification(),
    )
    error_bound: Field[Floats | None] = Field(
        "Proved bound of the error of each offset of the chain, divided by the largest offset, shape (...). None if there "
        "is an estimate.",
    )
    error_estimate: Field[Floats | None] = Field(
        "Estimate of that error, shape (...), where there is no proved bound; else None.",
        lambda r: None,
        part=True,
    )
    modes_below: Field[Whole] = Field(
        "Number of slower whirl speeds of the same direction, without dashpots, shape (...).",
    )
    reversed: Field[Flags] = Field(
        "Whether the free end is on the side opposite to the support (to the force), shape (...); with dashpots, more than "
        "a quarter of a turn behind or ahead."
    )
    resonant: Field[Flags] = Field("Whether the speed cannot be separated from a resonance, shape (...).")
    support_force: Field[Numbers] = Field(
        "Horizontal outward pull on the support, or on the far end of its spring, N or in the unit of the weights, shape "
        "(...). Complex with dashpots.",
    )
    support_force_error: Field[Floats | None] = Field(
        "Proved bound of the error of `support_force`, in its unit, or None."
    )
    whirl_speeds: Field[Floats] = Field(
        "The whirl speeds of a chain with a fixed support between the smallest and the largest speed, rad/s. Empty for a "
        "rig, and if there are more than 60.",
        lambda r: r._resonances(),
    )

    @property
    def _support_amplitude(self) -> Any:
        """Amplitude of the support, m; None for a force."""
        if self.acceleration is not None:
            return self.acceleration / self.angular_speed**2
        return self.support_radius

    def _amplification(self) -> Numbers | None:
        if self.force is not None:
            return None
        size = self._support_amplitude
        return np.asarray(self.offset / (size if np.ndim(size) == 0 or self.pins.ndim == 0 else size[..., None]))

    def _resonances(self) -> Floats:
        """Whirl speeds between the smallest and the largest speed."""
        speed = self.angular_speed.reshape(-1)
        if self.system._kind != "chain" or speed.size == 0 or not 0 < speed.min() < speed.max():
            return np.empty(0)
        core = self.system._compiled
        ends = np.array([speed.min(), speed.max()])
        below = _core.count_modes_at_speed(core, ends, np.full(2, self.gravity))
        count = int(below[1] - below[0])
        if not 0 < count <= MOST_RESONANCES:
            return np.empty(0)
        found = _core.modes(core, int(below[0]) + 1, count, None, None, None, False, "double", "auto")
        return np.asarray(np.sqrt(self.gravity / found.conical_height))

    def _sheet(self, brief: bool = False) -> Sheet:
        speed = self.angular_speed.reshape(-1)
        pins = np.atleast_1d(self.pins)
        offset = self.offset.reshape(speed.size, pins.size)
        size = np.abs(offset)
        farthest = size.max(axis=1, initial=0.0)
        pin = int(pins[0]) if pins.size else 0
        name = "free end" if pin == 0 else f"pin {pin}"
        damped = np.iscomplexobj(self.support_force)
        columns = [
            *speed_columns(speed, 5),
            Column("modes_below", self.modes_below.reshape(-1), "modes below"),
        ]
        if pins.size:
            if damped:
                columns += [
                    Column(f"{name.replace(' ', '_')}_amplitude", size[:, 0], f"{name} off axis (m)", 5),
                    Column(f"{name.replace(' ', '_')}_phase", np.angle(offset[:, 0]), "ahead (°)", 4, shown=np.degrees(np.angle(offset[:, 0])), unit="rad"),
                ]
            else:
                columns.append(Column(f"{name.replace(' ', '_')}_offset", offset[:, 0], f"{name} off axis (m)", 5))
            if self.amplification is not None:
                first = self.amplification.reshape(offset.shape)[:, 0]
                columns.append(Column("first_pin_amplification", np.abs(first) if damped else first, "over support", 4))
            every = np.unique(pins).size == self.system.size + 1
            columns.append(Column("largest_offset", farthest, f"farthest {'pin' if every else 'of these pins'} (m)", 5))
        columns += [
            Column(
                "support_force", np.abs(self.support_force).reshape(-1) if damped else self.support_force.reshape(-1),
                f"pull on support{' (N)' if self.system.by_mass else ''}", 5,
            ),
            self._error_column(),
            Column("conical_height", self.conical_height.reshape(-1), unit="m"),
            Column("resonant", self.resonant.reshape(-1)),
            Column("reversed", self.reversed.reshape(-1)),
        ]
        if self.support_force_error is not None:
            columns.append(Column("support_force_error", self.support_force_error.reshape(-1)))
        columns.append(Column("offset", offset, axes=("pin",), unit="m"))
        drive = "support" if self.force is None else "force"
        lost = "; nan: at a resonance" if self.resonant.any() else ""
        notes = [
            (f"ahead of the {drive}; negative: it lags" if damped else f"negative: opposite to the {drive}") + lost,
            f"error {'bound' if self.error_estimate is None else 'estimate'}: rounding error over the largest offset; pull: "
            "outward force on the support",
            f"steady motion of small amplitude, {'with' if damped else 'without'} damping",
        ]
        base = getattr(self.system, "chain", self.system)
        moved = 0.0 if self.force is not None else np.max(np.abs(self._support_amplitude), initial=0.0)
        if farthest.max(initial=0.0, where=np.isfinite(farthest)) - moved > BENT * base.total_length:
            instead = ": use steady_shapes there" if self.error_bound is not None else ""
            notes.append(f"some offsets are not small compared with the chain{instead}")
        facts: dict[str, Any] = {"gravity": self.gravity}
        drives = {"support_radius": self.support_radius, "acceleration": self.acceleration, "force": self.force}
        facts |= {name: value for name, value in drives.items() if value is not None}
        return Sheet("speed", self._heading(), columns, facts | {"pins": self.pins}, notes, spread=True)

    @property
    def _error(self) -> Floats:
        """The bound of the error of each offset, or the estimate."""
        found = self.error_estimate if self.error_bound is None else self.error_bound
        assert found is not None
        return found

    def _error_column(self) -> Column:
        if self.error_bound is None:
            return Column("error_estimate", self._error.reshape(-1), "error estimate", 2)
        return Column("error_bound", self._error.reshape(-1), "error bound")

    def _heading(self) -> str:
        # With these parts the motion to and fro is another one.
        turning = getattr(self.system, "displaced", None) is not None and self.system.fluid == "turning"
        turns = getattr(self.system, "flywheels", None) is not None or turning
        if self.force is not None:
            unit = " N" if self.system.by_mass else ""
            return f"support pushed {'round' if turns else 'to and fro'} with {self.force:g}{unit}"
        if self.acceleration is not None:
            way = "in a circle" if turns else "to and fro"
            return f"support moving {way} with an acceleration of {self.acceleration:g} m/s^2{'' if turns else ', or in a circle'}"
        to_and_fro = "" if turns else ", or to and fro with this amplitude"
        return f"support moving in a circle of radius {self.support_radius:g} m{to_and_fro}"


class Swing(Result, Moving, row="time", title="{summary}", notes=("{_remarks}",), spread=True):
    """Motion of a chain, rig or cord after release or under a moving support, as a sum of its k modes; returned by `swing`.

    Flywheels with momentum turn the plane of the swing: offsets are then complex, x + i y, and the modes are whirls.

    Examples
    --------
    >>> import revchain as rc
    >>> pendulum = rc.swing(rc.Chain(mass=1.0, length=9.80665), [0.0, 3.0], offset=[0.1, 0.0])
    >>> pendulum.offset.round(4)
    array([[ 0.1  ,  0.   ],
           [-0.099,  0.   ]])

    A pendulum with a wheel: the plane of its swing turns.

    >>> import numpy as np
    >>> wheel = rc.Flywheel(momentum=0.05)
    >>> found = rc.swing(rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=wheel), [0.0, 20.0635], offset=[0.1, 0.0])
    >>> np.degrees(np.angle(found.offset[:, 0])).round(1)
    array([ 0. , 28.7])
    >>> found.angular_frequency.round(4)
    array([-3.1067,  3.1567])

    A cord:

    >>> found = rc.swing(rc.Cord(1.0), [0.0, 0.5], offset=lambda s: 0.1 * (1 - s))
    >>> found.offset.shape, round(float(found.offset[1, 50]), 4)
    ((2, 101), -0.0149)
    """

    __slots__ = ()
    system: Field[Any] = Field("The chain or rig of N links, or the cord.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    time: Field[Floats] = Field("Times, s, shape (T,).", heading="time", unit="s")
    arc_length: Field[Floats | None] = Field(
        "For a cord: distance of each place from the free end, m, shape (n,). Else None.", fact=True
    )
    free_end_x: Field[Floats] = Field(
        "Offset of the lowest pin or place at each time, m; with momentum along x.",
        lambda s: s.offset[:, 0].real,
        heading=lambda s: "free end: x" if s._turns else "free end",
        unit="m",
    )
    free_end_y: Field[Floats | None] = Field(
        "With momentum: offset of the lowest pin along y, m. Else None.",
        lambda s: s.offset[:, 0].imag if s._turns else None,
        heading="y",
        unit="m",
    )
    free_end_velocity: Field[Numbers] = Field(
        "Velocity of the lowest pin or place at each time, m/s.",
        lambda s: s.velocity[:, 0],
        axes=(),
        heading=lambda s: "" if s._turns else "free end",
        unit="m/s",
    )
    support_offset: Field[Floats | None] = Field(
        "Offset of a support that is moved or pushed, m. Else None.",
        lambda s: s.offset[:, -1].real if s.motion_end else None,
        heading="support",
        unit="m",
    )
    largest_deflection: Field[Floats | None] = Field(
        "Where there is an `error_estimate`: largest distance of a pin from below the support at each time, m. Else None.",
        lambda s: np.abs(s.offset - s.offset[:, -1:]).max(axis=1) if s.error_estimate is not None else None,
        heading=lambda s: "from support" if s.motion_end else "",
        unit="m",
    )
    largest_offset: Field[Floats] = Field(
        "Largest distance of a pin or place from the axis at each time, m.",
        lambda s: np.abs(s.offset).max(axis=1),
        heading=lambda s: "" if s.motion_end else "farthest pin",
        unit="m",
    )
    error_bound: Field[Floats | None] = Field(
        "Proved bound of the rounding error of each offset as a sum of the modes used, m, shape (T,). None for a cord, or "
        "if there is an `error_estimate`.",
        heading="error bound",
        unit="m",
    )
    error_estimate: Field[Floats | None] = Field(
        "With springs at pins, dashpots, linear drag, a trolley or a moving support: estimate of the error of each offset, "
        "m, shape (T,). Else None.",
        lambda s: None,
        part=True,
        axes=(),
        heading="error estimate",
        unit="m",
        digits=2,
    )
    offset: Field[Numbers] = Field(
        "Offsets of the pins, m, shape (T, N + 1), free end first, support last; of a cord at `arc_length`, shape (T, n).",
        axes=("pin",),
        unit="m",
    )
    velocity: Field[Numbers] = Field("Velocities of the pins or places, m/s, like `offset`.", axes=("pin",), unit="m/s")
    angular_frequency: Field[Floats] = Field(
        "Natural angular frequency of each mode, rad/s, shape (k,), slowest first (with dashpots by ``abs(exponent)``); "
        "negative for backward whirls.",
        fact=True,
    )
    exponent: Field[Complex | None] = Field(
        "Where there is an `error_estimate`: exponents of the motions, 1/s, shape (k,), as in `Modes`; else None.",
        lambda s: None,
        part=True,
        fact=True,
    )
    motion_end: Field[float | None] = Field(
        "Where there is an `error_estimate`: the time at which the prescribed motion is over, s; else None.",
        lambda s: None,
        part=True,
        fact=True,
    )
    sway: Field[Floats | None] = Field(
        "Where there is an `error_estimate`: the largest distance of each pin from below the support after `motion_end`, "
        "m, shape (N + 1,), seen at 400 instants, to 1 %; slightly damped motions count with their whole amplitudes. The "
        "last is that of the support from its resting place. Else None.",
        lambda s: None,
        part=True,
        fact=True,
    )
    residual_sway: Field[float | None] = Field(
        "`sway` of the free end, m.", lambda s: None if s.sway is None else float(s.sway[0])
    )
    energy: Field[Floats | None] = Field(
        "Energy of each mode, J (weight times length), shape (k,). None where there is an `error_estimate`.",
        fact=True,
    )
    shape: Field[Numbers] = Field(
        "Shape of each mode, shape (k, N + 1), the largest offset 1; complex with dashpots; of a cord, shape (k, n), 1 at the "
        "free end."
    )
    amplitude: Field[Complex] = Field(
        "Coefficients, shape (k,), in offset = sum of ``shape * amplitude * exp(1j * angular_frequency * time)``; without "
        "momentum the real part of this sum. Where there is an `error_estimate`: those of the offsets from the resting "
        "place after `motion_end`, with ``exp(exponent * (time - motion_end))``; NaN where damping is critical.",
        fact=True,
    )
    start: Field[Numbers | None] = Field(
        "Offsets of the pins at time 0, shape (N + 1,): those given, but for pins without inertia, which their neighbours "
        "pull into place. None for a cord, and for momentum without `error_estimate`.",
        fact=True,
    )
    projected: Field[bool] = Field("Whether `start` differs from the given offsets.", fact=True)
    energy_left_out: Field[float] = Field(
        "Energy of the start that is not in the modes used: an upper bound; for a cord an estimate.",
        fact=True,
    )
    truncation_error: Field[Floats] = Field(
        "Proved bound of the effect of the modes not used on each offset at any time, m, shape (N + 1,). For a cord an "
        "estimate, shape (n,).",
        fact=True,
    )
    summary: Field[str] = Field(
        "The number of modes, and those with most of the energy or the sway, in words.",
        lambda s: s._words(),
    )

    @property
    def _turns(self) -> bool:
        """Return whether the momentum of flywheels turns the plane of the swing."""
        return self.offset.dtype.kind == "c"

    @property
    def _remarks(self) -> str:
        if self.error_estimate is not None:
            return "sway: distance from below the support; error estimate: of every offset"
        if self.error_bound is None:
            return f"error: {self.truncation_error.max():.2g} m at most, estimated from the modes left out"
        plane = "x + i y: the two horizontal directions; " if self._turns else ""
        return f"{plane}error bound: of every offset as a sum of modes, rounding"

    def _words(self) -> str:
        what = "whirl" if self._turns else "mode"
        if self.energy is None:
            count = self.angular_frequency.size
            end = self.system._pin_name(0)
            since = f"after {self.motion_end:.6g} s the {end}" if self.motion_end else f"the {end}"
            sway = self.residual_sway or 0.0
            far = f"sways by {sway:.5g} m at most" if np.isfinite(sway) else "falls"
            return f"{count} {what}{'s' * (count != 1)}; {since} {far}"
        energy = np.abs(self.energy)
        share = energy / energy.sum() if energy.sum() > 0 else energy
        most = np.argsort(share)[::-1][:3]
        words = ", ".join(f"{100 * share[k]:.3g} % in {what} {k + 1}" for k in most if share[k] > 0)
        many = f"{energy.size} {what}{'s' * (energy.size != 1)}"
        return f"{many}; of the energy {words}" if words else f"{many}, at rest"
