# SPDX-License-Identifier: MPL-2.0
"""A page of the C++ reference for each public header: its comments as text, its declarations as code."""

from __future__ import annotations

import re
from pathlib import Path

HEADERS = Path(__file__).parents[2] / "include" / "revchain"
COMMENT = re.compile(r"^\s*/// ?")


def text_of(comment: list[str]) -> str:
    """The text of a comment, its indented lines as code."""
    lines, code = [], False
    for line in comment:
        words = COMMENT.sub("", line)
        if words.startswith("    ") and not code and (not lines or not lines[-1].strip()):
            lines.append("```cpp")
            code = True
        elif code and words.strip() and not words.startswith("    "):
            lines.insert(len(lines) - (not lines[-1].strip()), "```")
            code = False
        lines.append(words[4:] if code else re.sub(r"(`[^`]*`)|<", lambda found: found[1] or "\\<", words))
    return "\n".join([*lines, "```"] if code else lines)


def end_of(lines: list[str], place: int) -> int:
    """Where the declaration that begins at a line ends."""
    braces = brackets = 0
    for end in range(place, len(lines)):
        bare = re.sub(r"//.*|\"[^\"]*\"|'.'", "", lines[end])
        braces += bare.count("{") - bare.count("}")
        brackets += bare.count("(") - bare.count(")")
        if braces == 0 and brackets == 0 and re.search(r"[;}]\s*$", bare):
            return end + 1
    return len(lines)


def end_of_head(lines: list[str], place: int) -> int:
    """Where the template parameters, the type and the name of a declaration have been said."""
    return place + next((k + 1 for k, line in enumerate(lines[place:]) if "(" in line or "{" in line or ";" in line), 1)


def declarations(lines: list[str]) -> list[tuple[list[str], list[str]]]:
    """Each declaration of the namespace revchain with the comment before it; those of `detail` are left out."""
    found: list[tuple[list[str], list[str]]] = []
    comment: list[str] = []
    place = 0
    while place < len(lines):
        line = lines[place]
        if line.startswith("///"):
            comment.append(line)
            place += 1
        elif not line.strip() or line.startswith(("#", "//", "namespace revchain", "}")):
            comment = comment if line.strip() else []
            place += 1
        else:
            end = end_of(lines, place)
            member = re.search(r"\w(<T>)?::~?\w+\(", "\n".join(lines[place : end_of_head(lines, place)]))
            if not line.startswith("namespace") and not member:  # members are shown with their class
                found.append((comment, lines[place:end]))
            comment, place = [], end
    return found


def without_body(code: list[str]) -> list[str]:
    """The declaration of a function; everything else as it is."""
    whole = "\n".join(code)
    body = re.search(r"\)\s*(const\b\s*)?(noexcept\s*)?(:[^{;]*)?\{", whole)
    return (whole[: body.start() + 1] + (" const" if body[1] else "") + ";").split("\n") if body else code


def shortened(code: list[str]) -> str:
    """The declaration as a reader needs it: no bodies of functions, no private members."""
    kind = next((line for line in code if not line.startswith("template")), "")
    if not re.match(r"(struct|class)\b.*\{", kind):
        return "\n".join(code if re.match(r"enum|inline constexpr", kind) else without_body(code))
    place = code.index(kind) + 1
    kept, hidden, place_of_body = code[:place], False, place
    while place < len(code) - 1:
        line = code[place].strip()
        if line in ("public:", "private:"):
            hidden = line == "private:"
            kept += [] if hidden else [code[place]]
        if line.startswith("//") or not line or line in ("public:", "private:"):
            kept += [] if hidden or line in ("public:", "private:") else [code[place]]
            place += 1
            continue
        end = end_of(code, place)
        if not hidden and not line.startswith("static_assert"):
            kept += without_body(code[place:end])
        place = end
    if not kept[place_of_body].strip():
        del kept[place_of_body]
    while not kept[-1].strip():
        kept.pop()
    return "\n".join([*kept, code[-1]])


def page(header: Path) -> str:
    name = f"revchain/{header.relative_to(HEADERS)}"
    lines = header.read_text(encoding="utf-8").splitlines()
    at = next((k for k, line in enumerate(lines) if line.startswith("namespace revchain")), len(lines))
    about = [line for line in lines[:at] if line.startswith("///")]
    parts = [f"# {name}", "", f"```cpp\n#include <{name}>\n```", "", text_of(about), ""]
    for comment, code in declarations(lines[at:]):
        parts += [f"```cpp\n{shortened(code)}\n```", "", text_of(comment), "", "---", ""]
    return "\n".join(parts).rstrip("-\n ") + "\n"


def pages() -> dict[str, str]:
    """By its place in the site."""
    headers = (header for header in sorted(HEADERS.glob("*.hpp")) if header.stem != "revchain")
    return {f"reference/cpp/{header.stem}.md": page(header) for header in headers}
