# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a film as .gif or .mp4. Matplotlib draws the background once, and in each frame only what moves."""

from __future__ import annotations

import subprocess
import textwrap
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from ..plots.modes import BACKWARD, FORWARD, LINK, ROD
from ..plots.style import AXIS, apart, house, plain
from ..systems.extras import require
from ..systems.numbers import Floats
from .film import Complex, Figure, Film, side_by_side

TILT = np.radians(14.0)  # of the view from above
TALL, WIDE, LEAST = 4.6, 11.0, 4.4  # inches: height of the figures at most, width of the film at most and at least
CAPTION, CHART, LETTER, BOLD = 0.95, 3.3, 0.07, 0.082  # inches: widths
MOST_PINS = 400
MOST_NAMES, NAME_WIDTH = 12, 20  # links whose names are written, letters in a line
TINTS = 8  # of each colour of a GIF
Progress = Callable[[int, int], None]


class Drawing:
    """A film drawn on a canvas of matplotlib: a background, and artists that move in each frame."""

    def __init__(self, film: Film) -> None:
        self.film = film = film.thinned(film.frames, MOST_PINS)
        low, high = film.low_and_high
        deep = film.reach * np.sin(TILT)
        size = max(high - low, 0.1 * film.reach) * np.cos(TILT) + 2 * deep
        chart = CHART if film.chart is not None else 0.0
        names = [textwrap.fill(name.partition("] ")[2], NAME_WIDTH) for name in film.names]
        names = names if any(names) and len(names) <= MOST_NAMES else []
        named = 0.2 * bool(names) + LETTER * max((len(line) for name in names for line in name.split("\n")), default=0)
        per = TALL / (1.1 * size)  # inches a metre
        for _ in range(5):
            widths = film.widths(CAPTION / per)
            per = min((WIDE - chart - named) / widths.sum(), TALL / (1.1 * size))
        self.across = side_by_side(widths)
        drawn = (per * widths.sum(), per * 1.1 * size)
        lines = 1 + max(caption.count("\n") for figure in film.figures for caption in figure.captions)
        head, foot = 0.62, 0.35 + 0.16 * lines
        progress = () if film.chart is not None else film.progress  # captions have the speeds of a chart
        longest = max(map(len, progress), default=0)
        written = max(BOLD * len(film.system), LETTER * (len(film.words) + longest + 2))
        whole = np.array([max(drawn[0] + chart + named, LEAST, min(written, WIDE)), max(drawn[1], 1.5) + head + foot])
        whole = 2 * np.round(50 * whole) / 100  # an even number of pixels, which H.264 needs
        figure = require("matplotlib.figure", "animate", "animation").Figure(figsize=whole, dpi=100)
        self.canvas = require("matplotlib.backends.backend_agg", "animate", "animation").FigureCanvasAgg(figure)
        across = (whole[0] - chart) / whole[0]
        ax = self.ax = figure.add_axes((0.0, 0.0, across, 1.0))
        ax.set_axis_off()
        middle = (widths.sum() - widths[0] - named / per) / 2
        ax.set_xlim(middle - (whole[0] - chart) / per / 2, middle + (whole[0] - chart) / per / 2)
        bottom = low * np.cos(TILT) - deep - (foot / per + 0.05 * size)
        ax.set_ylim(bottom, bottom + whole[1] / per)
        self.moving: list[tuple[Any, Callable[[int], None]]] = []
        figure.text(0.012, 1 - 0.08 / whole[1], plain(film.system), va="top", fontsize=9, weight="bold")
        words = plain(film.words)
        clock = figure.text(0.012, 1 - 0.3 / whole[1], words, va="top", fontsize=9)
        if progress:
            self._move(clock, lambda frame: clock.set_text(f"{words}; {progress[frame].lower()}"))
        for nth, each in enumerate(film.figures):
            self._stage(each, nth, low, high, deep)
        if names:
            self._names(names, -float(widths[0]) / 2, 0.17 / per)
        if chart:
            inner = (
                across + 0.8 / whole[0],
                (foot + 0.1) / whole[1],
                1 - across - 1.0 / whole[0],
                drawn[1] / whole[1] - 0.04,
            )
            self._chart(figure.add_axes(inner))
        self.canvas.draw()
        self.background = self.canvas.copy_from_bbox(figure.bbox)

    def _move(self, artist: Any, update: Callable[[int], None]) -> Any:
        artist.set_animated(True)
        self.moving.append((artist, update))
        return artist

    def _stage(self, figure: Figure, nth: int, low: float, high: float, deep: float) -> None:
        ax, film, at = self.ax, self.film, float(self.across[nth])
        ax.plot([at, at], np.array([low, high]) * np.cos(TILT), **AXIS)
        whole = np.exp(1j * np.linspace(0, 2 * np.pi, 91))
        if figure.is_rigid:
            pin = int(np.abs(figure.offset[0]).argmax())
            ax.plot(*seen(abs(figure.offset[0, pin]) * whole, figure.height[0, pin], at), color="0.85", linewidth=0.9)
        elif not film.chart and figure.offset.imag.any():
            tips = np.array([figure.in_space(frame)[0] for frame in range(film.frames)])
            ax.plot(*seen(tips, figure.height[0, 0], at), color="0.85", linewidth=0.5)
        colour = house(film.colours[nth])
        arms = ax.plot([], [], color="0.3", linewidth=2.0, zorder=2)[0]
        links = ax.plot(
            [], [], color=colour, linewidth=1.8, zorder=3, marker="o" if film.shows_pins else "", markersize=3.0
        )[0]
        stout = ax.plot([], [], color=colour, linewidth=4.5, alpha=0.45, zorder=2)[0]
        text = ax.text(
            at, low * np.cos(TILT) - 1.15 * deep - 0.02 * (high - low), "", ha="center", va="top", fontsize=8
        )

        def move(frame: int) -> None:
            offset, height = figure.in_space(frame), figure.heights(frame)
            links.set_data(*seen(offset, height, at))
            ends = [-1, 0] if film.is_held else [-1]
            held = np.array([part for end in ends for part in (0.0, offset[end], np.nan)])
            arms.set_data(*seen(held, np.repeat(height[ends], 3), at))

        self._move(arms, move)
        self._move(links, lambda frame: None)
        if film.stout.any():
            self._move(stout, lambda frame: stout.set_data(*_pieces(links, film.stout)))
        self._bodies(links, 0.35 * float(np.abs(figure.offset).max()))
        self._supports(links)
        if len(figure.captions) > 1:
            self._move(text, lambda frame: text.set_text(plain(figure.caption(frame))))
        else:
            text.set_text(plain(figure.captions[0]))

    def _names(self, names: list[str], left: float, line: float) -> None:
        """Write the names of the links left of the first figure, at the heights of their bodies in its first frame."""
        film = self.film
        height = film.figures[0].heights(0) * np.cos(TILT)
        along = np.full(len(names), 0.5)
        along[film.bodies.link] = film.bodies.along
        level = height[1:] + along * (height[:-1] - height[1:])
        lines = np.array([name.count("\n") + 1.3 for name in names])
        for place, name in zip(apart(level, line * lines), names, strict=True):
            self.ax.text(left, place, plain(name), ha="right", va="center", fontsize=8, color="0.35")

    def _bodies(self, links: Any, wheel: float) -> None:
        bodies = self.film.bodies
        if not bodies.link.size:
            return

        def between(share: Floats) -> Any:
            return np.column_stack(_along(links, bodies.link, share))

        long = bodies.rod > 0
        if long.any():
            rods = self.ax.plot([], [], **ROD, solid_capstyle="butt")[0]

            def lay(frame: int) -> None:
                ends = [between(bodies.along + sign * bodies.rod)[long] for sign in (-1, 1)]
                none = np.full_like(ends[0], np.nan)
                rods.set_data(*np.stack([*ends, none], 1).reshape(-1, 2).T)

            self._move(rods, lay)
        face = np.where(bodies.floats, "white", LINK)
        size = np.where(long, 0.0, 20 + 60 * bodies.size)
        balls = self.ax.scatter(bodies.size, bodies.size, s=size, c=face, edgecolors=LINK, zorder=4)
        self._move(balls, lambda frame: balls.set_offsets(between(bodies.along)))
        wheels = np.flatnonzero(bodies.wheel)
        if wheels.size:
            colours = [FORWARD if bodies.wheel[k] > 0 else BACKWARD for k in wheels]
            discs = require("matplotlib.collections", "animate", "animation").LineCollection(
                [], colors=colours, linewidths=4, zorder=4
            )
            self.ax.add_collection(discs)

            def turn(frame: int) -> None:
                middle, ends = between(bodies.along)[wheels], between(bodies.along + 0.01)[wheels]
                across = (ends - middle)[:, ::-1] * [1, -1]
                across *= wheel / np.maximum(np.hypot(*across.T), 1e-12)[:, None]
                discs.set_segments(np.stack([middle - across, middle + across], 1))

            self._move(discs, turn)

    def _supports(self, links: Any) -> None:
        kinds = [(-1, "^" if self.film.stout.all() else "v")] + [(0, "^")] * self.film.is_held
        for end, marker in kinds:
            mark = self.ax.plot([], [], marker=marker, color="black", markersize=7.0, zorder=5)[0]

            def move(frame: int, end: int = end, mark: Any = mark) -> None:
                x, y = links.get_data()
                mark.set_data([x[end]], [y[end]])

            self._move(mark, move)

    def _chart(self, ax: Any) -> None:
        chart = self.film.chart
        assert chart is not None
        for nth, (line, x, y) in enumerate(zip(chart.lines, chart.x, chart.y, strict=True)):
            ax.plot(*line, color=house(nth), linewidth=1.3)
            dot = ax.plot([], [], "o", color=house(nth), markersize=7.0)[0]

            def move(frame: int, dot: Any = dot, x: Floats = x, y: Floats = y) -> None:
                dot.set_data([x[frame]], [y[frame]])

            self._move(dot, move)
        ax.set_yscale("log" if chart.is_logarithmic else "linear")
        ax.set_xlabel(chart.x_label, fontsize=9)
        ax.set_ylabel(chart.y_label, fontsize=9)
        ax.tick_params(labelsize=8)
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)

    def frames(self, progress: Progress) -> Iterator[Any]:
        """Draw the frames one by one, each as an array of pixels in red, green and blue."""
        for frame in range(self.film.frames):
            self.canvas.restore_region(self.background)
            for artist, update in self.moving:
                update(frame)
                artist.axes.draw_artist(artist) if artist.axes else artist.figure.draw_artist(artist)
            yield np.asarray(self.canvas.buffer_rgba())[..., :3].copy()
            progress(frame + 1, self.film.frames)


def seen(offset: Complex | Floats, height: Any, across: float) -> tuple[Floats, Floats]:
    """Return where points of space are in the picture, seen from the side and a little from above."""
    point = np.asarray(offset, complex)
    return across + point.real, np.asarray(height) * np.cos(TILT) + point.imag * np.sin(TILT)


def _along(line: Any, link: Any, share: Floats) -> tuple[Floats, Floats]:
    x, y = line.get_data()
    down = x[link] - x[link + 1], y[link] - y[link + 1]
    return x[link + 1] + share * down[0], y[link + 1] + share * down[1]


def _pieces(line: Any, which: Any) -> tuple[Floats, Floats]:
    x, y = line.get_data()
    links = np.flatnonzero(which)
    none = np.full(links.size, np.nan)
    first, second = (np.stack([at[links], at[links + 1], none], 1).ravel() for at in (x, y))
    return first, second


def write_gif(film: Film, path: Path, progress: Progress) -> None:
    image = require("PIL.Image", "animate", "a .gif film")
    drawing = Drawing(film)
    pictures = [image.fromarray(pixels) for pixels in drawing.frames(progress)]
    palette = image.new("P", (1, 1))
    palette.putpalette(_palette(len(film.figures)))
    few = [picture.quantize(palette=palette, dither=image.Dither.NONE) for picture in pictures]
    pause = round(1000 / film.frames_per_second)
    few[0].save(path, save_all=True, append_images=few[1:], duration=pause, loop=0, optimize=False)


def _palette(figures: int) -> list[int]:
    """Return the colours of a film for a GIF, each in tints from full to white."""
    to_rgb = require("matplotlib.colors", "animate", "a .gif film").to_rgb
    names = ["black", LINK, ROD["color"], BACKWARD, *(house(k) for k in range(max(figures, 2)))]
    pure = np.array([to_rgb(name) for name in names])[:, None]
    tints = 1 - (1 - pure) * np.linspace(0.0, 1.0, TINTS)[:, None]
    return np.unique((255 * tints).round().astype(int).reshape(-1, 3), axis=0).ravel().tolist()


def write_mp4(film: Film, path: Path, progress: Progress) -> None:
    """Write an .mp4 file in H.264, by ffmpeg."""
    ffmpeg = require("imageio_ffmpeg", "animate", "a .mp4 film").get_ffmpeg_exe()
    drawing = Drawing(film)
    size = "x".join(map(str, drawing.canvas.get_width_height()))
    taken = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", str(film.frames_per_second), "-i", "-"]
    made = ["-c:v", "libx264", "-crf", "20", "-pix_fmt", "yuv420p", "-movflags", "+faststart"]
    command = [ffmpeg, "-loglevel", "error", "-y", *taken, *made, str(path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdin is not None and process.stderr is not None
        try:
            with suppress(BrokenPipeError):  # what is wrong it says itself
                for pixels in drawing.frames(progress):
                    process.stdin.write(pixels.tobytes())
                process.stdin.close()
            said = process.stderr.read().decode(errors="replace").strip()
        except BaseException:
            process.kill()
            raise
    if process.returncode:
        raise OSError(f"ffmpeg says: {said or process.returncode}")
