# SPDX-License-Identifier: GPL-3.0-or-later
"""Films, pages and 3D models of results that move."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any


class Moving:
    """A result that can be seen moving: modes, steady shapes, branches, responses, swings."""

    __slots__ = ()

    def animate(
        self,
        path: str | os.PathLike[str],
        *,
        figures: Iterable[int] | None = None,
        time_scale: float | None = None,
        duration: float | None = None,
        frames_per_second: float = 25.0,
        progress: Callable[[int, int], None] | None = None,
    ) -> None:
        """Write a film of the motion, or a page that plays it.

        Modes and steady shapes turn about their axes, each at its own speed. A branch is gone through from its first
        point to its last, a response at several speeds from the least to the greatest. A swing runs from the first to the
        last of its times. Offsets of small amplitude have their own scale; steady shapes and branches are true to scale.

        Parameters
        ----------
        path : path-like
            Ends in ``.gif``, ``.mp4`` or ``.html``. The page is one file that shows the model of `to_glb` in three
            dimensions, in any browser with WebGL 2 and without a network.
        figures : iterable of int, optional
            Which of several: modes by their numbers; shapes and branches by their positions in the list, from 0. The first
            six if left out.
        time_scale : float, optional
            Seconds of motion in one second of film: 1 is real time, 0.1 ten times slower. If left out, it is chosen so
            that the fastest figure takes about 0.8 s or more for a turn; of a swing 1, unless it takes more than 10 s or
            `duration` is given. The film says what it is.
        duration : float, optional
            Seconds of film. If left out: one turn of the slowest figure, at most 10 s; the whole swing, at most 10 s unless
            `time_scale` is given; 12 s for a branch or a response at several speeds.
        frames_per_second : float
            Frame rate of ``.gif`` and ``.mp4``, 0.1 to 1000. A GIF shows each
            frame for whole hundredths of a second, at least 2.
        progress : callable, optional
            Called with the number of frames drawn and that of all frames; of a page, with numbers of figures.

        Raises
        ------
        ValueError
            If the path has another ending, a number is not positive and finite or the frame rate is out of its range,
            `figures` names what is not there or is given for a single result, there is nothing to draw, the film has too
            many frames, a figure of a page turns more than 5000 times, or a response does not have every pin.
        TypeError
            If `path` is not a path or `progress` is not a function.
        ImportError
            If a package is missing that the ending needs; the message says how to install it.
        OSError
            (a ValueError too) If the file cannot be written.

        Notes
        -----
        Between two points of a branch, and two speeds of a response, offsets and heights are interpolated. So are offsets
        between two times of a swing that has an `error_estimate`. Offsets of a response are drawn larger or smaller than they
        are; the caption says by how much. A page has 600 KB for its viewer,
        three.js, and four thirds of the size of the ``.glb`` file. On it, figures that only turn do so without end.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "modes.html"
        >>> rc.modes(rc.Chain.uniform_rods(120, length=0.36), 4).animate(path)
        >>> path.stat().st_size < 1_000_000
        True
        """
        _motion().write_film(
            self,
            "animate",
            path,
            figures=figures,
            time_scale=time_scale,
            duration=duration,
            frames_per_second=frames_per_second,
            progress=progress,
        )

    def show(
        self,
        *,
        figures: Iterable[int] | None = None,
        time_scale: float | None = None,
        duration: float | None = None,
        height: int = 640,
    ) -> object:
        """Show the motion in a notebook, in the output of the cell: the page that `animate` writes.

        Parameters
        ----------
        figures : iterable of int, optional
            As in `animate`.
        time_scale : float, optional
            As in `animate`.
        duration : float, optional
            As in `animate`.
        height : int
            Height of the view in pixels.

        Returns
        -------
        object
            The view, which a notebook shows if the call is the last line of a cell. It needs neither
            network nor kernel; Jupyter shows it in trusted notebooks only.

        Raises
        ------
        ValueError
            As `animate`.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain.uniform_rods(12, length=1.0), 3).show()
        a motion, which notebooks show
        """
        shown: object = _motion().show_film(
            self, height, figures=figures, time_scale=time_scale, duration=duration
        )
        return shown

    def to_glb(
        self,
        path: str | os.PathLike[str],
        *,
        figures: Iterable[int] | None = None,
        time_scale: float | None = None,
        duration: float | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> None:
        """Write the motion as a 3D model: a binary glTF file for viewers, presentations, Blender and ParaView.

        Upwards is y, in metres. Each figure is a node with its axis and a node ``turning``; if it turns, its
        rotation is an animation channel. In that node are the links, the support and its arm. Of at most 40 links there
        are also bodies, rods of the same inertia and flywheels.

        Parameters
        ----------
        path : path-like
            Ends in ``.glb``.
        figures : iterable of int, optional
            As in `animate`.
        time_scale : float, optional
            As in `animate`; each node of a figure has it, gravity, the caption and, if it only turns, the angular speed
            in its ``extras``.
        duration : float, optional
            As in `animate`.
        progress : callable, optional
            Called with the number of figures done and that of all.

        Raises
        ------
        ValueError
            If the path has another ending, or as `animate`.
        TypeError
            As `animate`.
        OSError
            (a ValueError too) If the file cannot be written.

        Notes
        -----
        Offsets are drawn as in `animate`. Thickness is for sight only. A chain of more than 400 links is drawn as
        400 straight pieces.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "shapes.glb"
        >>> shapes = rc.steady_shapes(rc.Chain(mass=[1, 1, 1], length=1.0), angular_speed=8.5)
        >>> shapes.to_glb(path)
        >>> path.read_bytes()[:4]
        b'glTF'
        """
        _motion().write_film(
            self, "to_glb", path, figures=figures, time_scale=time_scale, duration=duration, progress=progress
        )


def _motion() -> Any:
    """The writers of films, imported when they are first needed."""
    return import_module("revchain.motion.write")
