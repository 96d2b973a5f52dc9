# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files of version 1: the changes, and the scene in version 2 with its comments."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, MutableMapping
from copy import deepcopy
from typing import Any

from ..systems.extras import require
from .parse import written

_OF_MODES = ("modes", "first", "conical_height", "angular_speed", "rtol", "certify", "precision", "method")
_OLD = {"shapes": ("sense", "any_posture", "half_waves"), "response": ("steps",), "swing": ("until", "steps")}
_REWRITES = "; revchain validate --upgrade rewrites the file"
Data = MutableMapping[str, Any]


def old_keys(data: dict[str, Any], in_doubt: bool = True) -> list[tuple[str, str]]:
    """The tables of version 1 in a scene, with the text to write instead; none in a scene of version 2.

    `in_doubt`: whether two speeds are read as a range of version 1 if the scene does not give its version.
    """
    version, ask = data.get("schema_version"), data.get("ask")
    ask = ask if isinstance(ask, dict) else {}
    tables = {name: table for name, table in ask.items() if isinstance(table, dict)}
    old = any(name in ask and name not in tables for name in _OF_MODES)
    old = old and not isinstance(ask.get("modes"), bool | list)  # which no version has
    old = old or any(key in tables.get(name, ()) for name, keys in _OLD.items() for key in keys)
    speeds = [tables.get("response", {}).get(name) for name in ("angular_speed", "conical_height")]
    pair = any(isinstance(each, list) and len(each) == 2 for each in speeds)
    if not (version == 1 or old or (in_doubt and version is None and pair)):
        return []
    new = deepcopy(data)
    upgrade(new)
    found = [("schema_version", "is of version 1: write schema_version = 2")] if version == 1 else []
    for name, table in new["ask"].items() if isinstance(new.get("ask"), dict) else ():
        if isinstance(table, dict) and table != ask.get(name):
            entries = ", ".join(f"{key} = {_toml(value)}" for key, value in table.items())
            sure = version == 1 or old
            found.append((f"ask.{name}", f"{'is' if sure else 'may be'} of version 1: write [ask.{name}] {entries}"))
            found[-1] = (found[-1][0], found[-1][1] + ("" if sure else ", or schema_version = 2 at the top"))
    found = [(key, sentence + _REWRITES) for key, sentence in found]
    if isinstance(held := data.get("held"), dict) and "tension" in held:
        found.append(("held.tension", "is that of the upper end in version 2: add the weight of the chain, by hand"))
    return found


def _toml(value: Any) -> str:
    """A value as TOML text."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {written(each)}" for key, each in value.items()) + "}"
    return written(value)


def upgrade(data: Data) -> None:
    """Change a scene of version 1 into one of version 2, in place: plain data or a document of tomlkit."""
    ask = data.get("ask")
    if "schema_version" in data:
        data["schema_version"] = 2
    if not isinstance(ask, MutableMapping):
        return
    if isinstance(shapes := ask.get("shapes"), MutableMapping):
        _put(shapes, "direction", lambda x: x, "sense")
        _put(shapes, "max_half_waves", lambda x: x, "half_waves")
        _put(shapes, "hanging_only", lambda x: not x, "any_posture")
    if isinstance(response := ask.get("response"), MutableMapping):
        for name in ("angular_speed", "conical_height"):
            if isinstance(ends := response.get(name), list) and len(ends) == 1:
                _put(response, name, lambda x: x[0], name)
            elif isinstance(ends, list) and ends:
                _put(response, name, lambda x, n=200: {"from": x[0], "to": x[-1], "steps": n}, name, "steps")
        response.pop("steps", None)
    if isinstance(swing := ask.get("swing"), MutableMapping) and ("until" in swing or "steps" in swing):
        swing.setdefault("until", 10.0)
        _put(swing, "time", lambda x, n=200: {"to": x, "steps": n + 1}, "until", "steps")
    old_modes = [name for name in _OF_MODES if name in ask and not isinstance(ask[name], MutableMapping)]
    if old_modes:
        modes = {("count" if name == "modes" else name): ask.pop(name) for name in old_modes}
        if modes.get("method") == "auto":
            del modes["method"]
        ask["modes"] = modes


def _put(table: Data, new: str, make: Callable[..., Any], *old: str) -> None:
    """Make a key from older keys, if the first one exists; their comments go with it."""
    if old[0] not in table:
        return
    document = getattr(table, "value", None)  # tomlkit's items have the comments behind them
    items = [document.item(name) if document is not None else table[name] for name in old if name in table]
    for name in old:
        table.pop(name, None)
    value = make(*(item.unwrap() if document is not None else item for item in items))
    if document is not None:
        tomlkit = require("tomlkit", None, "--upgrade")
        entries, value = value, tomlkit.inline_table() if isinstance(value, dict) else tomlkit.item(value)
        if isinstance(entries, dict):
            value.update(entries)
        if comments := [item.trivia.comment for item in items if item.trivia.comment]:
            value.trivia.comment_ws, value.trivia.comment = "  ", " ".join(comments)
    table[new] = value


def _headed(block: re.Match[str]) -> str:
    """The lines of [ask] moved below the heading [ask.modes], with their comments."""
    lines = re.sub(r"(?m)^modes(?=\s*=)", "count", block[1])
    return "[ask.modes]" + re.sub(r"(?m)^method\s*=\s*[\"']auto[\"'].*\n?", "", lines)


def upgraded_text(text: str, is_json: bool) -> str:
    """The text of a scene file in version 2; a ValueError if it must be changed by hand."""
    if is_json:
        data = json.loads(text)
        if old_keys(data):
            upgrade(data)
            return json.dumps(data, indent=2, ensure_ascii=False) + "\n"
        return text
    tomlkit = require("tomlkit", None, "--upgrade")
    plain = tomlkit.parse(text).unwrap()
    if not old_keys(plain):
        return text
    if "tension" in plain.get("held", {}):
        raise ValueError("held.tension is that of the upper end in version 2: add the weight of the chain, by hand")
    document = tomlkit.parse(re.sub(r"(?ms)^\[ask\](?=[^\n]*$)(.*?)(?=^\s*\[|\Z)", _headed, text))
    upgrade(document)
    upgrade(plain)
    new: str = tomlkit.dumps(document)
    if tomlkit.parse(new).unwrap() != plain:
        raise ValueError("has tables in an order that cannot be rewritten: change it by hand")
    return new
