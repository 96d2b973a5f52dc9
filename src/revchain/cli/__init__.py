# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line. Needs typer, rich and msgspec."""
