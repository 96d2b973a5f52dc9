#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""House rules that a compiler does not check: which folder may use which, licences, size, what a library never does.

Run from anywhere; prints file:line: what is wrong, and ends with 1 when something is.
"""

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
INCLUDE = ROOT / "include" / "revchain"
PYTHON = ROOT / "src" / "revchain"

# Folder of include/revchain -> folders it may include, itself apart. The arrows run one way (see the check below).
ALLOWED = {
    "numeric": set(),
    "simd": {"numeric"},
    "system": {"numeric"},
    "special": {"numeric", "system"},
    "pencil": {"numeric", "simd"},
    "pencil/batch": {"numeric", "simd", "pencil"},
    "pencil/condensed": {"numeric", "simd", "pencil"},
    "pencil/spectrum": {"numeric", "simd", "pencil"},
    "pencil/forced": {"numeric", "simd", "pencil"},
    "pencil/complex": {"numeric", "simd", "pencil"},
    "pencil/damped": {"numeric", "pencil", "pencil/complex"},
    "linear": {"numeric", "simd", "system", "pencil", "pencil/batch", "pencil/condensed", "pencil/spectrum"}
    | {"pencil/forced", "pencil/complex", "pencil/damped"},
    "finite/balance": {"numeric", "simd", "system", "linear"},
    "finite/shapes": {"numeric", "system", "linear", "finite/balance"},
    "finite/branch": {"numeric", "simd", "system", "linear", "finite/balance", "finite/shapes"},
    "finite/held": {"numeric", "system", "linear", "finite/balance", "finite/shapes", "finite/cord"},
    "finite/cord": {"numeric", "system", "finite/branch"},
    "finite/stability": {"numeric", "system", "pencil/complex", "finite/balance", "finite/shapes"}
    | {"finite/branch", "finite/held", "finite/cord"},
    "paper": {"numeric", "system", "special", "linear", "finite/balance", "finite/shapes"},
    "models": {"numeric", "system", "pencil", "linear", "paper", "special"}
    | {"finite/balance", "finite/shapes", "finite/branch"},
}
ALLOWED["questions"] = set(ALLOWED) - {"special"}  # what the public headers of the questions declare
ALLOWED["analytic"] = set(ALLOWED)  # questions that need GSL
# The public headers, all that lie in no folder, and the folder each counts for: it may include what its folder may. Two
# umbrellas count for none.
PUBLIC = {
    "chain.hpp": "system",
    "rig.hpp": "system",
    "conical_pendulum.hpp": "system",
    "count.hpp": "linear",
    "modes.hpp": "questions",
    "methods.hpp": "questions",
    "batch.hpp": "questions",
    "recurrence.hpp": "linear",
    "response.hpp": "questions",
    "swing.hpp": "questions",
    "damped_modes.hpp": "questions",
    "forced_motion.hpp": "questions",
    "transient.hpp": "questions",
    "sensitivity.hpp": "questions",
    "tune.hpp": "questions",
    "rig_modes.hpp": "questions",
    "steady_shapes.hpp": "finite/shapes",
    "stability.hpp": "finite/stability",
    "stability_windows.hpp": "finite/stability",
    "campbell.hpp": "questions",
    "drag.hpp": "questions",
    "branches.hpp": "finite/branch",
    "held.hpp": "questions",
    "cord.hpp": "analytic",
    "explain.hpp": "questions",
    "bell.hpp": "paper",
    "buffer.hpp": "paper",
    "compound_link.hpp": "paper",
    "governor.hpp": "special",
    "sleeve_governor.hpp": "paper",
    "gyrostatic_string.hpp": "paper",
    "hoop.hpp": "paper",
    "rope.hpp": "special",
    "statics.hpp": "questions",
    "two_links.hpp": "paper",
    "thorough.hpp": "numeric",
    "revchain.hpp": "",
    "analytic.hpp": "",
}
UMBRELLAS = {name for name, home in PUBLIC.items() if not home}
FURTHER = {  # more files that define what a header declares
    "bell.hpp": {"paper/bell_strike.hpp"},
    "cord.hpp": {"analytic/cord_sensitivity.hpp", "analytic/cord_swing.hpp"},
    "held.hpp": {"questions/held_check.hpp"},
    "finite/cord/continuous_chain.hpp": {"finite/cord/steady_shapes.hpp"},
    "finite/cord/branches.hpp": {"finite/cord/branch_shapes.hpp"},
}
MACROS = {"numeric/compiled.hpp"}  # declares nothing but macros
# A scene pays for what it holds: these read nothing of what a chain can be rigged with.
PLAIN = {"chain.hpp", "modes.hpp", "methods.hpp", "batch.hpp", "finite/cord/continuous_chain.hpp"}
RIGGING = {"rig.hpp", "system/edit.hpp"}
# Macros that outlive the header that defines them. C++ gives a macro no scope, so that one which several headers use
# lives until the end of the file that includes them; its prefix keeps it apart from a user's. All others are undefined at
# the end of their header.
MACROS_THAT_STAY = {
    "REVCHAIN_BUILD",  # every header opens its namespace with it; the next six are its parts
    "REVCHAIN_BUILD_SET",
    "REVCHAIN_BUILD_FMA",
    "REVCHAIN_BUILD_KIND",
    "REVCHAIN_BUILD_LIBRARY",
    "REVCHAIN_JOIN",
    "REVCHAIN_JOINED",
    "REVCHAIN_DECLARE",  # before public functions that are not templates, and before their definitions
    "REVCHAIN_DEFINE",
    "REVCHAIN_LAZY",
    "REVCHAIN_INLINE",
    "REVCHAIN_DECLARE_ANALYTIC",
    "REVCHAIN_DEFINE_ANALYTIC",
    "REVCHAIN_INLINE_ANALYTIC",
    "REVCHAIN_INLINED",  # before bodies of lambdas in kernels
    "REVCHAIN_SEVERAL_TARGETS",  # what kernels are compiled for
    "REVCHAIN_NO_VECTOR_EXTENSIONS",
    "REVCHAIN_MASK_INSTRUCTIONS",
    "REVCHAIN_BITS_AS",
}
# What namespace revchain itself may declare in folders, which is the public headers' namespace: a name in each line.
NAMES = ROOT / "tools" / "names_in_folders.txt"
MAX_LINES = 400
MAX_COLUMNS = 120

# What a library leaves to its caller: printing, ending the process. (static_assert is another word.)
FORBIDDEN = {
    r"#\s*include\s*<(iostream|cstdio|stdio\.h|print|cassert|assert\.h)>": "a library neither prints nor asserts",
    r"\b(cout|cerr|clog)\b|\b(f?printf|puts|putchar)\s*\(": "a library never prints",
    r"\b(abort|exit|_Exit|quick_exit|terminate)\s*\(": "a library never ends the process",
    r"\b(assert|eigen_assert)\s*\(": "a wrong call throws InvalidArgument",
    r"#\s*define\s+(?!REVCHAIN_)\w": "no macros, or else REVCHAIN_",
    r"\bstd::ranges::": "libc++ 14 has no algorithms of ranges",
    r"^namespace revchain\b(?!::inline REVCHAIN_BUILD\b)": "open namespace revchain::inline REVCHAIN_BUILD",
}
# What one compiler knows and another refuses, and the headers that hold it.
COMPILER = r"__attribute__|__builtin_|__has_builtin|__GNUC__|__clang__|_MSC_VER|__float128|__int128|gnu::target|\b_mm\w*"
COMPILER_HEADERS = {"numeric/compiler.hpp", "numeric/dispatch.hpp", "simd/registers.hpp"}
# Folders of src/revchain, each of which may import from itself and those before it, at once or later. What is drawn finds
# its drawer by name (systems/drawing.py).
PYTHON_FOLDERS = (
    *("systems", "results", "closed_forms", "plots", "motion", "questions", "exchange", "scenes", "studies", "cli"),
)
SOURCES = {".hpp", ".cpp", ".py", ".pyi", ".sh", ".js", ".css", ".html"}
SKIPPED = {".git", ".venv", "build", "dist", "out"}

problems: list[str] = []


def complain(path: Path, line: int, what: str) -> None:
    problems.append(f"{path.relative_to(ROOT)}:{line}: {what}")


def without_comments(text: str) -> str:
    """The code alone: comments and the insides of strings go, line ends stay."""

    def blank(match: re.Match[str]) -> str:
        found = match.group()
        return '""' if found[0] == '"' else re.sub(r"[^\n]", "", found)

    text = re.sub(r'^(\s*#\s*include\s*)"(.*)"', r"\1<\2>", text, flags=re.M)  # an include is no string
    return re.sub(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', blank, text, flags=re.S)


def folder(header: str) -> str:
    """The folder a header counts for; '' for an umbrella."""
    return header.rsplit("/", 1)[0] if "/" in header else PUBLIC.get(header, "")


def check_header(path: Path) -> list[str]:
    """Complains about one header; the headers of ours that it includes."""
    name = path.relative_to(INCLUDE).as_posix()
    here = folder(name)
    text = path.read_text(encoding="utf-8")
    code = without_comments(text)
    count = len(text.splitlines())

    if count > MAX_LINES:
        complain(path, count, f"{count} lines; over {MAX_LINES} a header wants splitting")
    if not re.search(r"^#pragma once$", text, re.M):
        complain(path, 1, "no #pragma once")
    if "/" not in name and name not in PUBLIC:
        complain(path, 1, "a public header goes into PUBLIC in tools/check_layers.py, any other into a folder")
    if here != "" and here not in ALLOWED:
        complain(path, 1, f"unknown folder {here}; its place in the order goes into ALLOWED in tools/check_layers.py")
    if path.name.endswith("_impl.hpp") or path.name in {"fwd.hpp", "all.hpp"}:
        complain(path, 1, "no *_impl.hpp, fwd.hpp or all.hpp: these make the cycles in other libraries")
    undefined = set(re.findall(r"^\s*#\s*undef\s+(\w+)", code, re.M))
    for macro in re.finditer(r"^\s*#\s*define\s+(\w+)", code, re.M):
        if macro[1] not in MACROS_THAT_STAY | undefined:
            number = code.count("\n", 0, macro.start(1)) + 1
            complain(path, number, f"{macro[1]} outlives its header: #undef it at the end, or see MACROS_THAT_STAY")
    if name not in UMBRELLAS | MACROS and not re.sub(r"^\s*#.*$", "", code, flags=re.M).strip():
        complain(path, 1, "includes and declares nothing of its own: no folder umbrellas")

    ours = []
    for number, line in enumerate(text.splitlines(), 1):
        if len(line) > MAX_COLUMNS:
            complain(path, number, f"{len(line)} columns; at most {MAX_COLUMNS}")
    for number, line in enumerate(code.splitlines(), 1):
        for pattern, why in FORBIDDEN.items():
            if re.search(pattern, line):
                complain(path, number, f"{line.strip()}: {why}")
        if name not in COMPILER_HEADERS and re.search(COMPILER, line):
            complain(path, number, f"{line.strip()}: another compiler may refuse it; see numeric/compiler.hpp")
        match = re.match(r"\s*#\s*include\s*<([^>]*)>", line)
        if not match:
            continue
        target = match.group(1)
        if target.startswith("gsl/") and here != "special":
            complain(path, number, "GSL belongs under special/")
        if target in {"Eigen/Eigenvalues", "Eigen/Eigen", "Eigen/Dense"} and not here.startswith("pencil"):
            complain(path, number, f"<{target}> costs seconds of compile time; eigensolvers belong under pencil/")
        if target.startswith("revchain/"):
            included = target.removeprefix("revchain/")
            ours.append(included)
            there = folder(included)
            if included in UMBRELLAS and here != "":
                complain(path, number, f"a part includes the whole <{target}>")
            elif there not in {"", here} and here in ALLOWED and there not in ALLOWED[here]:
                complain(path, number, f"{here} must not include {there}")
        elif (path.parent / target).is_file():
            complain(path, number, f"write the path from include/: revchain/..., not {target}")
    return ours


def named_by(head: str) -> str:
    """The name that a declaration gives, from the text before its first `{` or its `;`; "" for none that counts."""
    depth, outside = 0, ""
    for before, mark in zip(" " + head, head):  # template parameters and arguments go
        depth += (mark == "<") - (mark == ">" and before != "-" and depth > 0)
        outside += mark if depth == 0 and mark != ">" else ""
    text = " ".join(re.sub(r"\[\[.*?\]\]|\brequires\b.*?(?=\b(struct|class|inline|constexpr|auto)\b)", "", outside).split())
    instance = re.match(r"\s*(extern\s+)?template\s*[^<\s]", head)
    if instance or re.match(r"(template )?struct \w+ ?$", text) and "<" in head.partition("struct")[2]:  # specialised
        return ""
    kind = re.match(r"(?:template )*(?:struct|class|enum class|concept|using) (\w+)(?= ?(?:$|:[^:]|=|final))", text)
    if not kind and re.match(r"using|static_assert|friend", text):
        return ""
    called = re.search(r"(operator ?[^\s\w(]+|[\w:]+) ?\(", text)
    number = re.search(r"constexpr .*?(\w+) ?(?:=|$)", text)
    found = kind or called or number
    return "" if not found or "::" in found[1] else found[1]


def declared(code: str) -> set[str]:
    """Names that a header declares in namespace revchain itself, in no namespace within it."""
    names: set[str] = set()
    scopes: list[str] = []
    head = ""
    for mark in re.sub(r"^\s*#.*$", "", code, flags=re.M):
        if mark in "{;" and scopes == ["revchain::inline REVCHAIN_BUILD"]:
            names.add(named_by(head))
        if mark == "{":
            space = re.search(r"\bnamespace ([\w:\s]+?)\s*$", head)
            scopes.append(space[1] if space else "")
        elif mark == "}" and scopes:
            scopes.pop()
        head = "" if mark in "{};" else head + mark
    return names - {"", "namespace"}


def check_names(headers: list[Path]) -> None:
    """Complains about a name of the machinery in the namespace of the public headers, and about a list that is too long."""
    public: set[str] = set()
    inner: dict[str, Path] = {}
    for path in headers:
        names = declared(without_comments(path.read_text(encoding="utf-8")))
        if path.parent == INCLUDE:
            public |= names
        else:
            inner |= dict.fromkeys(names, path)
    known = {line for line in NAMES.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")}
    for name in sorted(inner.keys() - public - known):
        complain(inner[name], 1, f"declares {name} in namespace revchain, which is for the public headers: use one within it")
    for name in sorted(known - (inner.keys() - public)):
        problems.append(f"tools/names_in_folders.txt: {name} is no longer declared there: take it off")


def check_test(path: Path) -> None:
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if re.search(r"\bin getattr\(.*, (\{\}|\(\)|\[\])\)", line):
            complain(path, number, "a loop over nothing, which checks nothing, if the name of the attribute is wrong")


def check_cycles(graph: dict[str, list[str]], what: str) -> None:
    done: set[str] = set()

    def visit(node: str, trail: list[str]) -> None:
        if node in trail:
            problems.append(f"{what} in a circle: {' -> '.join([*trail[trail.index(node) :], node])}")
        elif node not in done:
            for following in graph.get(node, []):
                visit(following, [*trail, node])
            done.add(node)

    for node in graph:
        visit(node, [])


def implementations(name: str) -> set[str]:
    """The files that define what a header declares."""
    home = PUBLIC.get(name, "")
    return FURTHER.get(name, set()) | ({f"{home}/{name}", f"{home}/rig_{name}"} if home else set())


def reached_from(start: str, graph: dict[str, list[str]]) -> set[str]:
    """The header and every header of ours that it includes, directly or not."""
    reached, todo = {start}, [start]
    while todo:
        following = set(graph.get(todo.pop(), [])) - reached
        reached |= following
        todo += following
    return reached


def check_python(path: Path) -> list[str]:
    """Complains about one module of the package; the modules of ours that it imports, at once or later."""
    here = path.relative_to(PYTHON).with_suffix("").parts
    own, ours = here[0] if len(here) > 1 else "", []
    if len(here) > 1 and own not in PYTHON_FOLDERS:
        complain(path, 1, f"unknown folder {own}; its place goes into PYTHON_FOLDERS in tools/check_layers.py")
        return []
    for node in imports_of(ast.parse(path.read_text(encoding="utf-8"))):
        package = here[: len(here) - node.level] if node.level else ("?",)
        target = (*package, *(node.module or "").split(".")) if node.module else package
        names = [target] if node.module and len(target) > 1 else [(*target, name.name) for name in node.names]
        for name in names:
            folder_of = name[0] if len(name) > 1 or name[0] in PYTHON_FOLDERS else ""
            if folder_of in PYTHON_FOLDERS and own:
                if folder_of not in PYTHON_FOLDERS[: PYTHON_FOLDERS.index(own) + 1]:
                    complain(path, node.lineno, f"{own} must not import {folder_of}")
            if (PYTHON.joinpath(*name).with_suffix(".py")).is_file():
                ours.append("/".join(name))
    return ours


def print_graph(imported: dict[str, list[str]]) -> None:
    """Prints which folders of the package each imports, with the number of imports; all to its left."""
    for own in PYTHON_FOLDERS:
        to = Counter(name.partition("/")[0] for path, names in imported.items() if path.startswith(f"{own}/") for name in names)
        print(f"{own:12} {sum(path.startswith(f'{own}/') for path in imported):3} modules:", end="")
        print("", *(f"{name} {to[name]}" for name in PYTHON_FOLDERS if name != own and to[name]), sep="  ")


def imports_of(tree: ast.AST) -> Iterator[ast.ImportFrom]:
    """Imports that a program makes, with the module itself or later; those for types alone are left out."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.ImportFrom):
            yield node
        elif not (isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"):
            yield from imports_of(node)


def check_licence(path: Path, graph: dict[str, list[str]]) -> None:
    name = path.relative_to(ROOT).as_posix()
    head = path.read_text(encoding="utf-8").splitlines()[:5]
    match = next((m for line in head if (m := re.search(r"SPDX-License-Identifier: (\S+)", line))), None)
    # what includes GSL or is one binary with it
    gsl = name.startswith(("bindings/", "src/revchain/")) or any(
        folder(header) == "special" for header in reached_from(name.removeprefix("include/revchain/"), graph)
    )
    if match is None:
        complain(path, 1, "no SPDX-License-Identifier in the first five lines")
    elif match.group(1) not in {"MPL-2.0", "GPL-3.0-or-later"}:
        complain(path, 1, f"{match.group(1)} is not one of the licences in LICENSES/")
    elif gsl and match.group(1) != "GPL-3.0-or-later":
        complain(path, 1, "is bound to GSL: GPL-3.0-or-later")
    elif name.startswith("include/") and not gsl and match.group(1) != "MPL-2.0":
        complain(path, 1, "a header of the core: MPL-2.0")


def main() -> int:
    headers = sorted(INCLUDE.rglob("*.hpp"))
    graph = {path.relative_to(INCLUDE).as_posix(): check_header(path) for path in headers}
    # A public header ends with the include of its implementation, a file of the same name in its folder (and another
    # for rigs), which includes the public header: only these may include each other.
    one_way = {
        name: [other for other in following if other not in implementations(name)]
        for name, following in graph.items()
    }
    check_cycles(one_way, "headers include each other")
    check_names(headers)
    for name in sorted(PUBLIC.keys() - graph.keys()):
        problems.append(f"tools/check_layers.py: there is no public header {name}")
    check_cycles({name: sorted(allowed) for name, allowed in ALLOWED.items()}, "ALLOWED runs")

    # Whoever includes revchain.hpp must not need GSL, by no detour.
    for name in sorted(reached_from("revchain.hpp", graph)):
        if folder(name) == "special":
            problems.append(f"include/revchain/revchain.hpp: leads to {name}, which needs GSL")

    for name in sorted(PLAIN | RIGGING):
        if name not in graph:
            problems.append(f"tools/check_layers.py: there is no header {name}")
    for plain in sorted(PLAIN):
        for name in sorted(reached_from(plain, graph) & RIGGING):
            problems.append(f"include/revchain/{plain}: leads to {name}, which a plain chain must not pay for")

    modules = sorted(PYTHON.rglob("*.py"))
    imported = {path.relative_to(PYTHON).with_suffix("").as_posix(): check_python(path) for path in modules}
    check_cycles(imported, "modules import each other")
    if "--graph" in sys.argv[1:]:
        print_graph(imported)

    for path in sorted((ROOT / "tests" / "python").rglob("*.py")):
        check_test(path)

    files = [p for p in sorted(ROOT.rglob("*")) if p.is_file() and not SKIPPED & set(p.relative_to(ROOT).parts)]
    for path in files:
        if path.suffix in SOURCES or path.name == "CMakeLists.txt":
            check_licence(path, graph)

    print(*problems, sep="\n", end="\n" if problems else "")
    print(f"check_layers: {len(headers)} headers, {len(modules)} modules, {len(files)} files checked, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
