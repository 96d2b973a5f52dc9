# SPDX-License-Identifier: GPL-3.0-or-later
"""Films, pages and 3D models of results that move."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from importlib import import_module
from typing import Any


class Moving:
    """The base of results that can be shown moving."""

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

        Modes and steady shapes turn about their axes, each at its own speed. A branch is shown from its first point to its
        last, a response at several speeds from the least to the greatest, and a swing from the first of its times. Steady
        shapes and branches are true to scale; offsets of small amplitude have a scale of their own, and between points,
        speeds and times they may be interpolated.

        Parameters
        ----------
        path : path-like
            Ends in ``.gif``, ``.mp4`` or ``.html``. The page shows the model of `to_glb` in a browser with WebGL 2, without
            a network.
        figures : iterable of int, optional
            Which of several: modes by their numbers; shapes and branches by their positions in the list, from 0. The first
            six if left out.
        time_scale : float, optional
            Seconds of motion in one second of film: 1 is real time, 0.1 ten times slower. If left out, it is chosen, and
            the film says what it is.
        duration : float, optional
            Seconds of film. If left out, it is chosen.
        frames_per_second : float
            Frame rate of ``.gif`` and ``.mp4``, 0.1 to 1000.
        progress : callable, optional
            Called with the number of frames drawn and that of all; of a page, with numbers of figures.

        Raises
        ------
        ValueError
            If the path has another ending, a number is out of its range, `figures` names what is not there, there is
            nothing to draw, the film is too long, or a response does not have every pin.
        TypeError
            If `path` is not a path or `progress` is not a function.
        ImportError
            If a package is missing that the ending needs; the message says how to install it.
        OSError
            (a ValueError too) If the file cannot be written.

        Notes
        -----
        A page has 600 KB for its viewer, three.js, and four thirds of the size of the ``.glb`` file.

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
            The view, which a notebook shows if the call is the last line of a cell, without a network.

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

        Upwards is y, in metres. Each figure is a node with its axis and a node ``turning``, which holds the links and the
        support, with bodies and flywheels if there are few links.

        Parameters
        ----------
        path : path-like
            Ends in ``.glb``.
        figures : iterable of int, optional
            As in `animate`.
        time_scale : float, optional
            As in `animate`; ``extras`` of the node of a figure have it, with gravity and the caption.
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
        Offsets are drawn as in `animate`. A chain of more than 400 links is drawn as 400 straight pieces.

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
