# SPDX-License-Identifier: MPL-2.0
"""The reference of scene files, a table for each table of the file, from the JSON Schema that `revchain schema` prints."""

from __future__ import annotations

import json
import re
from typing import Any

from revchain.scenes.scene import json_schema

UNITS = "A number and its unit"


def kind(entry: dict[str, Any]) -> str:
    """The kinds of value that an entry accepts, in words."""
    if "$ref" in entry:
        name = entry["$ref"].rpartition("/")[2]
        return f"[{name}](#{name.lower()})"
    if "enum" in entry:
        return ", ".join(f"`{json.dumps(value, ensure_ascii=False)}`" for value in entry["enum"])
    if "anyOf" in entry:
        words = dict.fromkeys(kind(choice) for choice in entry["anyOf"] if choice.get("type") != "null")
        return " or ".join(words)
    if entry.get("type") == "array":
        return f"list of {kind(entry['items'])}" if entry.get("items") else "list"
    if entry.get("type") == "object":
        return "table"
    if entry.get("type") == "string" and str(entry.get("description", "")).startswith(UNITS):
        return "text with a unit"
    return {"string": "text", "integer": "whole number", "boolean": "true or false"}.get(entry.get("type", ""), entry.get("type", ""))


def places(definitions: dict[str, Any]) -> dict[str, str]:
    """How the table of each definition is written in a file, such as ``[ask.modes]``, from the outermost inwards."""
    found = {"Scene": "The file"}
    open_tables = [("Scene", "")]
    while open_tables:
        name, path = open_tables.pop(0)
        for key, entry in definitions[name].get("properties", {}).items():
            text = json.dumps(entry)
            for inner in re.findall(r'"#/\$defs/(\w+)"', text):
                if inner in found or "properties" not in definitions[inner]:
                    continue
                many = '"array"' in text
                place = path + key
                found[inner] = f"[[{place}]]" if many else f"[{place}]"
                open_tables.append((inner, place + "."))
    return found


def pages() -> dict[str, str]:
    """By its place in the site."""
    definitions = json_schema()["$defs"]
    titles = places(definitions)
    parts = [
        "# Scene files",
        "",
        "A scene file is TOML or JSON. `revchain new` writes a commented one and `revchain schema` prints the JSON Schema",
        "for editors. [What a scene can hold](../scenes.md) shows examples.",
        "",
    ]
    for name in [*titles, *(name for name in definitions if name not in titles)]:
        table = definitions[name]
        if "properties" not in table:
            continue
        title = titles.get(name, name)
        parts += [f"({name.lower()})=", f"## {title if name == 'Scene' else f'`{title}`'}", "", table.get("description", ""), "", "| key | value | if left out | meaning |", "|---|---|---|---|"]
        required = table.get("required", [])
        for key, entry in table.get("properties", {}).items():
            left_out = "required" if key in required else f"`{json.dumps(entry['default'])}`" if entry.get("default") is not None else ""
            meaning = entry.get("description", "").replace("|", "\\|").replace("\n", " ")
            parts.append(f"| `{key}` | {kind(entry)} | {left_out} | {meaning} |")
        parts.append("")
    return {"reference/scene_files.md": "\n".join(parts)}
