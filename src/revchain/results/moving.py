# SPDX-License-Identifier: GPL-3.0-or-later
"""Films, pages and solids of results that move."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
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
        point to its last, a response from the least speed to the greatest. A swing runs from the first to the last of
        its times. Offsets of small amplitude are drawn larger; steady shapes and branches are true to scale.

        Parameters
        ----------
        path : path-like
            Ends in ``.gif``, ``.mp4`` or ``.html``. The page is one file of at most 200 KB, with the numbers inside. Its
            view can be turned. It draws lines; `to_html` writes a page with the solid.
        figures : iterable of int, optional
            Which of several: modes by their numbers; shapes and branches by their places in the list, from 0. The first
            six if left out.
        time_scale : float, optional
            Seconds of motion in one second of film: 1 is real time, 0.1 ten times slower. If left out, it is chosen so
            that the fastest figure takes at least 0.8 s for a turn; the film says what it is.
        duration : float, optional
            Seconds of film. If left out: one turn of the slowest figure, at most 10 s; 12 s for a branch or a response.
        frames_per_second : float
            Of ``.gif`` and ``.mp4``. A GIF counts hundredths of a second, and takes the nearest rate.
        progress : callable, optional
            Called with the number of frames drawn and that of all frames.

        Raises
        ------
        ValueError
            If the path has another ending, a number is not positive and finite, `figures` names what is not there, there
            is nothing to draw, or a response has not every pin.
        ImportError
            If a package is missing that the ending needs; the message says how to install it.
        OSError
            (a ValueError too) If the file cannot be written.

        Notes
        -----
        Between two points of a branch, and two speeds of a response, offsets and heights are interpolated. A response is
        drawn smaller where it exceeds the picture; the caption says by how much.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "modes.html"
        >>> rc.modes(rc.Chain.uniform_rods(120, length=0.36), 4).animate(path)
        >>> path.stat().st_size < 200_000
        True
        """
        from ..motion.write import FILMS, write_film

        write_film(
            self,
            "animate",
            FILMS,
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
        solid: bool = False,
    ) -> Any:
        """Show the motion in a notebook, in the output of the cell: the page that `animate` or `to_html` writes.

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
        solid : bool
            Show the solid in three dimensions, as `to_html`, not lines. The view then has 605 KB more.

        Returns
        -------
        object
            The view, which a notebook shows if the call is the last line of a cell. It needs no connection, and still
            works when the notebook is opened without Python.

        Raises
        ------
        ValueError
            As `animate`.
        TypeError
            If `solid` is not True or False.
        ImportError
            If `solid` and pygltflib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain.uniform_rods(12, length=1.0), 3).show()
        a motion, which notebooks show
        """
        from ..motion.write import show_film

        return show_film(self, figures, time_scale, duration, height, solid)

    def to_glb(
        self,
        path: str | os.PathLike[str],
        *,
        figures: Iterable[int] | None = None,
        time_scale: float | None = None,
        duration: float | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> None:
        """Write the motion as a solid: a binary glTF file for 3D viewers and presentations.

        Upwards is y, in metres. Each figure is a node with its axis and a node ``turning``, whose rotation is an
        animation channel; in that are the links, bodies, rods of the same inertia, flywheels, the support and its arm.

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
        ImportError
            If pygltflib is not installed; the message says how to install it.
        OSError
            (a ValueError too) If the file cannot be written.

        Notes
        -----
        Offsets are drawn as in `animate`. Thickness is for sight only. A chain of more than 400 links is drawn through
        400 of its pins.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "shapes.glb"
        >>> shapes = rc.steady_shapes(rc.Chain(mass=[1, 1, 1], length=1.0), angular_speed=8.5)
        >>> shapes.to_glb(path)
        >>> path.read_bytes()[:4]
        b'glTF'
        """
        from ..motion.write import SOLIDS, write_film

        write_film(
            self, "to_glb", SOLIDS, path, figures=figures, time_scale=time_scale, duration=duration, progress=progress
        )

    def to_html(
        self,
        path: str | os.PathLike[str],
        *,
        figures: Iterable[int] | None = None,
        time_scale: float | None = None,
        duration: float | None = None,
        progress: Callable[[int, int], None] | None = None,
    ) -> None:
        """Write a page that shows and animates the solid of `to_glb` in three dimensions.

        The page is one file: the solid and its viewer, three.js, are inside. It opens in any browser that has WebGL and
        needs no network. `animate` with a path that ends in ``.html`` writes a lighter page, which draws lines.

        Parameters
        ----------
        path : path-like
            Ends in ``.html``.
        figures : iterable of int, optional
            As in `animate`.
        time_scale : float, optional
            As in `animate`. A slider on the page changes the pace.
        duration : float, optional
            As in `animate`. Figures that only turn do so without end.
        progress : callable, optional
            Called with the number of figures done and that of all.

        Raises
        ------
        ValueError
            If the path has another ending, or as `animate`.
        ImportError
            If pygltflib is not installed; the message says how to install it.
        OSError
            (a ValueError too) If the file cannot be written.

        Notes
        -----
        The viewer takes 605 KB, the solid four thirds of the size of its ``.glb`` file. Offsets are drawn as in
        `animate`.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "modes.html"
        >>> rc.modes(rc.Chain.uniform_rods(12, length=1.0), 3).to_html(path)
        >>> path.stat().st_size < 800_000
        True
        """
        from ..motion.write import VIEWERS, write_film

        write_film(
            self, "to_html", VIEWERS, path, figures=figures, time_scale=time_scale, duration=duration, progress=progress
        )

    def to_vtk(
        self,
        path: str | os.PathLike[str],
        *,
        figures: Iterable[int] | None = None,
        time_scale: float | None = None,
        duration: float | None = None,
        frames_per_second: float = 25.0,
        progress: Callable[[int, int], None] | None = None,
    ) -> None:
        """Write the pins and links for ParaView and other readers of VTK.

        Upwards is z, in metres. Points have ``pin``, ``offset`` (as in the result, not as drawn) and, of what turns at a
        constant speed, ``velocity`` for these offsets; lines have ``link``, ``figure``, ``angular_speed`` and, of
        shapes of chains, ``tension``, which points have where both ends are held.

        Parameters
        ----------
        path : path-like
            Ends in ``.vtu`` or ``.vtk`` (the first instant of what only turns), or in ``.xdmf`` (all instants of any
            motion).
        figures : iterable of int, optional
            As in `animate`.
        time_scale : float, optional
            As in `animate`; times in the file are those of the motion.
        duration : float, optional
            As in `animate`.
        frames_per_second : float
            Instants in a second of film.
        progress : callable, optional
            Called with the number of instants written and that of all.

        Raises
        ------
        ValueError
            If the path has another ending, a branch, response or swing is asked for as ``.vtu``, or as `animate`.
        ImportError
            If meshio is not installed, for ``.vtu`` and ``.vtk``; the message says how to install it.
        OSError
            (a ValueError too) If the file cannot be written.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "modes.xdmf"
        >>> rc.modes(rc.Chain.uniform_rods(12, length=1.0), 3).to_vtk(path, duration=0.4)
        """
        from ..motion.write import GRIDS, write_film

        write_film(
            self,
            "to_vtk",
            GRIDS,
            path,
            figures=figures,
            time_scale=time_scale,
            duration=duration,
            frames_per_second=frames_per_second,
            progress=progress,
        )
