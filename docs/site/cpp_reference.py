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
            head = "\n".join(lines[place:end]).partition("{")[0]
            member = re.search(r"\w(<T>)?::~?\w+\(", head.partition(" = ")[0])
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
    head, kept, hidden = code[:place], [], False
    while place < len(code) - 1:
        line = code[place].strip()
        is_access = line in ("public:", "private:")
        if is_access:
            hidden = line == "private:"
        if is_access or not line or line.startswith("//"):
            shown, end = code[place : place + 1], place + 1
        else:
            end = end_of(code, place)
            shown = [] if line.startswith("static_assert") else without_body(code[place:end])
        kept += [] if hidden else shown
        place = end
    return "\n".join([*head, "\n".join(kept).strip("\n"), code[-1]])


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
