# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths such as ``links[load].mass``: their grammar, and the indices that names of links stand for."""

from __future__ import annotations

import re
from collections.abc import Sequence
from difflib import get_close_matches

Path = tuple[str | int, ...]
OF_LINKS = ("links", "flywheels", "displaced", "pins")  # lists with an item for each link, which may be named
_INDEX = r"(?:\[\d{1,9}\])?"
_PATH = re.compile(rf"[a-z_]+{_INDEX}(?:\.[a-z_]+{_INDEX})*")
_NAMED = re.compile(rf"({'|'.join(OF_LINKS)})\[(?:\"([^\"]*)\"|'([^']*)'|([^\]]*))\](?=\.|$)")
_MOST_NAMES = 12  # in a message


def steps(path: object) -> Path:
    """The names and indices of a path into a system or a scene; empty if it is no path, or names a link."""
    if not isinstance(path, str) or _PATH.fullmatch(path) is None:
        return ()
    return tuple(int(index) if index else name for name, index in re.findall(r"([a-z_]+)|\[(\d+)\]", path))


def numbered(path: str, names: Sequence[str]) -> str:
    """The path with the index of the link that it names; a ValueError if there is no such link, or several.

    `names` has the names of the links in the caller's order, empty for a link without one.
    """
    found = _NAMED.match(path)
    if found is None or re.fullmatch(r"\d+", found[4] or ""):
        return path
    name = next(text for text in found.groups()[1:] if text is not None)
    there = [k for k, known in enumerate(names) if known == name] if name else []
    if len(there) == 1:
        return f"{found[1]}[{there[0]}]{path[found.end() :]}"
    if there:
        listed = ", ".join(f"{found[1]}[{k}]" for k in there[:3]) + (" ..." if len(there) > 3 else "")
        raise ValueError(f'{found[0]}: {len(there)} links are named "{name}"; write an index: {listed}')
    if re.fullmatch(r"-\d+", name):
        raise ValueError(f"{found[0]}: indices start at 0, for the first link listed")
    if name == "*":
        raise ValueError(f"{found[0]}: there is no wildcard; write a path for each link")
    known = list(dict.fromkeys(one for one in names if one))
    if not known:
        raise ValueError(f"{found[0]}: no link has a name; write an index such as {found[1]}[0]")
    lower = {one.lower().strip(): one for one in known}
    wanted = name.lower().strip()
    near = get_close_matches(wanted, list(lower), n=1)
    near = near or [one for one in lower if wanted and (wanted in one or one in wanted)]
    hint = f'did you mean "{lower[near[0]]}"? ' if near else ""
    listed = ", ".join(f'"{one}"' for one in known[:_MOST_NAMES]) + (" ..." if len(known) > _MOST_NAMES else "")
    raise ValueError(f'{found[0]}: no link is named "{name}"; {hint}the names are {listed}')


def link_in_path(where: str, index: int, names: Sequence[str]) -> str:
    """The part of a path that stands for one link: ``links[load]``, or its index if no name stands for it alone."""
    name = names[index] if index < len(names) else ""
    path = f"{where}[{name}]"
    try:
        return path if name and numbered(path, names) == f"{where}[{index}]" else f"{where}[{index}]"
    except ValueError:
        return f"{where}[{index}]"
