# SPDX-License-Identifier: GPL-3.0-or-later
"""The reference of the command `revchain`, from its own help, by typer."""

from __future__ import annotations

import re

from typer.cli import get_docs_for_click
from typer.main import get_command

from revchain.cli.app import app
from revchain.cli.exit_codes import MEANING


def pages() -> dict[str, str]:
    """By its place in the site."""
    command = get_command(app)
    text = get_docs_for_click(obj=command, ctx=command.context_class(command, info_name="revchain"), name="revchain")
    text = re.sub(r"\[b\](.*?)\[/b\]", r"`\1`", text)
    text = re.sub(r"\nExit codes: .*\n", "", text).replace("# `revchain`", "# Command line", 1)
    codes = "".join(f"| {int(code)} | {meaning} |\n" for code, meaning in MEANING.items())
    return {"reference/command_line.md": f"{text}\n## Exit codes\n\n| code | meaning |\n|---|---|\n{codes}"}
