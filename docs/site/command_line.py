# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference of the command `revchain`, from its parser: what it prints as help, with whole sentences and as tables."""

from __future__ import annotations

import re
from typing import Any

from typer.main import get_command

from revchain.cli import MEANING
from revchain.cli.app import app
from revchain.cli.frame import USE, codes_of

INTRODUCTION = """# Command line

The command `revchain` reads [scene files](scene_files.md) and [studies](../studies.md), and answers their questions. The
examples work in a copy of the repository. `revchain COMMAND --help` prints the same text.

`revchain SCENE` means `revchain run SCENE`, also with the options of `run` after it. A scene is a file whose name ends in
`.toml` or `.json`, or any other file whose name is not that of a command.

An option that is also a key of the scene replaces the value of the scene. If both are left out, the default applies.
Numbers are in SI units; with a unit they are text in quotes, such as `"12 rpm"`.
"""


def plain(text: str | None) -> str:
    """A sentence of the help as Markdown."""
    return re.sub(r"\[b\](.*?)\[/b\]", r"`\1`", text or "").replace("\\[", "[").replace("<", "\\<").replace("|", "\\|")


def default_of(parameter: Any) -> str:
    """The default of an option as it is written."""
    if isinstance(parameter.show_default, str):
        return f"`{parameter.show_default}`"
    if parameter.required:
        return "required"
    if parameter.default is None or isinstance(parameter.default, bool):
        return ""
    return f"`{parameter.default}`"


def row(parameter: Any) -> str:
    """An option or argument as a row of a table."""
    is_option = parameter.param_type_name == "option"
    names = ", ".join(f"`{name}`" for name in (*parameter.opts, *parameter.secondary_opts)) if is_option else ""
    value = "" if getattr(parameter, "is_flag", False) else (parameter.metavar or parameter.type.name)
    shown = f"`{value}`".replace("|", "\\|") if value else ""
    return f"| {f'{names} {shown}'.strip()} | {default_of(parameter)} | {plain(parameter.help)} |\n"


def table(command: Any) -> str:
    rows = "".join(row(each) for each in command.params if "--help" not in each.opts)
    return f"| option | default | meaning |\n|---|---|---|\n{rows}"


def section(name: str, command: Any) -> str:
    """All about one command."""
    example, files = USE[name]
    arguments = " ".join(each.metavar for each in command.params if each.param_type_name == "argument")
    codes = ", ".join(str(int(code)) for code in codes_of(name))
    return (
        f"## `revchain {name}`\n\n{plain(command.help)}\n\n"
        f"```console\n$ revchain {name} [OPTIONS] {arguments}".rstrip()
        + f"\n```\n\nExample:\n\n```console\n$ {example}\n```\n\n{table(command)}\n"
        f"Files written: {plain(files)}.\n\n[Exit codes](#exit-codes): {codes}.\n"
    )


def pages() -> dict[str, str]:
    """By its place in the site."""
    group = get_command(app)
    commands = {name: group.commands[name] for name in group.list_commands(None)}
    summary = "".join(f"| [`{name}`](#revchain-{name}) | {plain(each.help)} |\n" for name, each in commands.items())
    codes = "".join(f"| {int(code)} | {meaning} |\n" for code, meaning in MEANING.items())
    parts = [
        INTRODUCTION,
        f"| command | what it does |\n|---|---|\n{summary}",
        f"Options without a command:\n\n{table(group)}",
        *(section(name, each) for name, each in commands.items()),
        f"## Exit codes\n\n| code | meaning |\n|---|---|\n{codes}",
    ]
    return {"reference/command_line.md": "\n".join(parts)}
