# SPDX-License-Identifier: MPL-2.0
"""The C++ reference: a page for each public header, its comments as text and its declarations as code, and two lists.

The list of headers and the index of symbols are kept in docs/reference/cpp.md, for readers of the repository:

    python docs/site/cpp_reference.py           checks that the page is that of the headers
    python docs/site/cpp_reference.py --write   writes it
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
HEADERS = ROOT / "include" / "revchain"
PAGE = ROOT / "docs" / "reference" / "cpp.md"
COMMENT = re.compile(r"^\s*/// ?")
# What a public header offers and another one declares: header: file: names.
ELSEWHERE: dict[str, dict[str, tuple[str, ...]]] = {
    "chain": {
        "system/link.hpp": (
            "Link", "plummet", "uniform_rod", "CompoundPendulum", "compound_pendulum", "radius_of_gyration", "pendulum_length",
        ),
        "numeric/scalar.hpp": ("Index", "Real", "Vector", "Table", "Matrix"),
        "numeric/status.hpp": ("InvalidArgument", "Cancelled", "Status"),
        "numeric/progress.hpp": ("Progress",),
        "numeric/double_word.hpp": ("Wide", "DoubleWord"),
        "system/column.hpp": ("Column",),
    },
    "rig": {"system/link.hpp": ("Posture",), "numeric/double_word.hpp": ("Wide",)},
    "modes": {"numeric/double_double.hpp": ("DoubleDouble",)},
    "cord": {
        "system/cord.hpp": ("CordDensity", "CordOptions", "Cord"),
        "system/line_density.hpp": ("LineDensity",),
        "finite/cord/continuous_chain.hpp": ("steady_shapes", "CordShapes", "CordShapesOptions"),
        "finite/cord/continuous_shape.hpp": ("CordShape", "CordPlace"),
        "finite/cord/branches.hpp": ("CordBranch", "CordBranches"),
        "finite/cord/shape_on_branch.hpp": ("CordShapesOnBranch",),
    },
    "explain": {"models/select.hpp": ("Estimate",), "models/model.hpp": ("Fit",)},
    "held": {
        "finite/held/shape.hpp": ("HeldShape",),
        "finite/held/held.hpp": ("HeldShapes",),
        "finite/held/cord.hpp": ("HeldCordShape", "HeldCordPlace", "HeldCordShapes"),
        "finite/held/branch.hpp": ("HeldBranch", "HeldBranchOf", "HeldBranchEnd", "to_string"),
        "finite/held/cord_branch.hpp": ("HeldCordBranch",),
    },
}  # fmt: skip


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


def declarations(lines: list[str]) -> list[tuple[str, list[str], list[str]]]:
    """Namespace within revchain, comment and code of each declaration; those of `detail` and `finite` are left out.

    The comment of an inner namespace comes with no code.
    """
    found: list[tuple[str, list[str], list[str]]] = []
    comment: list[str] = []
    place, outer, inner = 0, "", ""
    while place < len(lines):
        line = lines[place]
        entered = re.match(r"namespace (\w+) \{$", line)
        if line.startswith("///"):
            comment.append(line)
            place += 1
        elif entered and entered[1] not in ("detail", "finite"):
            inner = f"{entered[1]}::"
            found.append((inner, comment, []))
            comment, place = [], place + 1
        elif not line.strip() or line.startswith(("#", "//", "namespace revchain", "}")):
            if within := re.match(r"namespace revchain::inline REVCHAIN_BUILD(?:::(\w+))? \{", line):
                outer = f"{within[1]}::" if within[1] else ""
            elif line.startswith("}"):
                inner = ""
            comment = comment if line.strip() else []
            place += 1
        else:
            end = end_of(lines, place)
            code = [line for line in lines[place:end] if not re.fullmatch(r"REVCHAIN_DECLARE(_ANALYTIC)?", line)]
            head = "\n".join(code).partition("{")[0]
            member = re.search(r"\w(<T>)?::~?\w+\(", head.partition(" = ")[0])  # members are shown with their class
            known_before = re.search(r"(?m)^(class|struct) \w+;", "\n".join(code))
            if not (line.startswith("namespace") or member or known_before):
                found.append((outer + inner, comment, code))
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


def symbol(code: list[str]) -> str:
    """The name that a declaration introduces; empty for an explicit instantiation."""
    if code[0].startswith("extern template"):
        return ""
    whole = "\n".join(code).replace("[[nodiscard]] ", "")
    whole = re.sub(r"^template\s*<.*?>\s*(requires .*?\n)?(?=\w)", "", whole, count=1, flags=re.DOTALL)
    if kind := re.match(r"(?:struct|class|enum class|concept|using)\s+(\w+)", whole):
        return kind[1]
    head = re.split(r"\(|=|\{", whole, maxsplit=1)[0]
    return re.findall(r"\w+", head)[-1]


def parts_of(path: Path) -> tuple[list[str], list[tuple[str, list[str], list[str]]]]:
    """The comment of a header, and name, comment and code of each declaration."""
    lines = path.read_text(encoding="utf-8").splitlines()
    at = next((k for k, line in enumerate(lines) if line.startswith("namespace revchain")), len(lines))
    about = [line for line in lines[:at] if line.startswith("///")]
    if not about:  # a header that only includes others has a plain comment
        about = [line.replace("//", "///", 1) for line in lines[3:] if line.startswith("//")]
    found = []
    for namespace, comment, code in declarations(lines[at:]):
        if not code:
            about += ["///", *comment]
        elif name := symbol(code):
            found.append((namespace + name, comment, code))
    return about, found


def offered(header: Path) -> list[tuple[str, str, list[str], list[str]]]:
    """Name, file if it is another one, comment and code of all that a public header offers."""
    found = [(name, "", comment, code) for name, comment, code in parts_of(header)[1]]
    for file, names in ELSEWHERE.get(header.stem, {}).items():
        there = [(name, file, comment, code) for name, comment, code in parts_of(HEADERS / file)[1] if name in names]
        if lost := set(names) - {name for name, *_ in there}:
            raise ValueError(f"{HEADERS / file}: does not declare {', '.join(sorted(lost))}")
        found += there
    return found


def anchor(stem: str, name: str) -> str:
    """The label of the section of a name; types and functions may differ only by a capital."""
    kind = "type" if re.search(r"(^|::)[A-Z]", name) else "function"
    return f"cpp-{stem}-{kind}-{name.lower().replace('::', '-').replace('_', '-')}"


def page(header: Path) -> str:
    """The page of a header: a section for each name."""
    name = f"revchain/{header.relative_to(HEADERS)}"
    parts = [f"# {name}", "", f"```cpp\n#include <{name}>\n```", "", text_of(parts_of(header)[0]), ""]
    all_offered = offered(header)
    for title, file in dict.fromkeys((name, file) for name, file, *_ in all_offered):  # overloads together
        parts += [f"({anchor(header.stem, title)})=", "", f"## {title}", ""]
        parts += [f"Declared in `revchain/{file}`.", ""] if file else []
        for name, _, comment, code in all_offered:
            if name == title:
                parts += [f"```cpp\n{shortened(code)}\n```", "", text_of(comment), ""]
    return "\n".join(parts).rstrip() + "\n"


def purpose(header: Path) -> str:
    """The first sentence of a header's comment."""
    text = " ".join(COMMENT.sub("", line) for line in parts_of(header)[0]).strip()
    return re.split(r"(?<=\.)\s|\s{2,}", text, maxsplit=1)[0]


GROUPS = {
    "Systems": "chain rig cord held",
    "Questions": "modes methods rig_modes damped_modes count explain steady_shapes thorough branches stability stability_windows campbell drag response forced_motion swing transient "
    "sensitivity tune batch statics recurrence",
    "Closed forms of the paper": "conical_pendulum compound_link two_links hoop rope governor sleeve_governor gyrostatic_string bell buffer",
    "All at once": "revchain analytic",
}
INTRODUCTION = """# C++ reference

Each header has a page on the website, made from the comments in the header. Here are all public headers, what each is for,
and an index of names. Include one header for one system or question, or one of the last two. Headers in folders below
`include/revchain` are internal and may change: names that they declare come with the public header in the index.

Headers marked GSL need GSL, and a program that includes them is under GPL-3.0-or-later ([licence](../about/licence.md)).
[Install for C++](../howto/cmake.md), [first program](../tutorial/cpp.md).

"""


def check_types(public: dict[str, Path]) -> None:
    """Raises ValueError where a page shows a type of the library that no page describes: it is missing in ELSEWHERE."""
    inner = [file for file in HEADERS.rglob("*.hpp") if file.parent != HEADERS]
    declared = [(name, "\n".join(code)) for file in inner for name, _, code in parts_of(file)[1]]
    known = {name for name, code in declared if re.search(rf"(?m)^(struct|class|enum class|using) {name}\b(?!::)", code)}
    found = [(stem, each) for stem, header in public.items() for each in offered(header)]
    missing = known - {name for _, (name, *_) in found}
    for stem, (name, _, _, code) in found:
        shown = re.sub(r"//.*", "", shortened(code))
        if lost := missing & set(re.findall(r"\b[A-Z]\w+", shown)):
            raise ValueError(f"{stem}.hpp: {name} names {', '.join(sorted(lost))}: list it in ELSEWHERE")


def kept_page() -> str:
    """The text of docs/reference/cpp.md. Its links lead to the headers; `with_pages` turns them for the website."""
    public = {header.stem: header for header in sorted(HEADERS.glob("*.hpp"))}
    listed = [stem for stems in GROUPS.values() for stem in stems.split()]
    if sorted(listed) != sorted(public):
        raise ValueError("GROUPS must name each public header once: " + ", ".join(sorted(set(listed) ^ set(public))))
    check_types(public)
    text = INTRODUCTION
    for title, stems in GROUPS.items():
        text += f"## {title}\n\n| header | what it is for |\n|---|---|\n"
        for stem in stems.split():
            gsl = " (GSL)" if "GPL" in public[stem].read_text(encoding="utf-8").partition("\n")[0] else ""
            text += f"| [{stem}.hpp](../../include/revchain/{stem}.hpp){gsl} | {purpose(public[stem])} |\n"
        text += "\n"
    places: dict[str, list[str]] = {}
    for stem in listed:
        for name, *_ in offered(public[stem]):
            if stem not in places.setdefault(name, []):
                places[name].append(stem)
    text += "## Index of symbols\n\n| name | header |\n|---|---|\n"
    for name, stems in sorted(places.items(), key=lambda each: (each[0].lower(), each[0])):
        text += f"| `{name}` | {', '.join(f'[{stem}.hpp](../../include/revchain/{stem}.hpp)' for stem in stems)} |\n"
    return text


def with_pages(text: str) -> str:
    """The page as the website has it: its links lead to the pages of the headers, and to the sections of the names."""
    link = r"\]\(\.\./\.\./include/revchain/(\w+)\.hpp\)"
    text = re.sub(
        r"(?m)^\| `([\w:]+)` \|.*",
        lambda row: re.sub(link, lambda to: f"](#{anchor(to[1], row[1])})", row[0]),
        text,
    )
    text = re.sub(link, r"](cpp/\1.md)", text)
    stems = "\n".join(f"cpp/{stem}" for group in GROUPS.values() for stem in group.split())
    return f"{text}\n```{{toctree}}\n:hidden:\n\n{stems}\n```\n"


def pages() -> dict[str, str]:
    """By its place in the site."""
    return {f"reference/cpp/{header.stem}.md": page(header) for header in sorted(HEADERS.glob("*.hpp"))}


if __name__ == "__main__":
    if "--write" in sys.argv:
        PAGE.write_text(kept_page(), encoding="utf-8")
    elif PAGE.read_text(encoding="utf-8") != kept_page():
        sys.exit("docs/reference/cpp.md is not that of the headers. Run: python docs/site/cpp_reference.py --write")
