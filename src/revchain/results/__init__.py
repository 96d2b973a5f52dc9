# SPDX-License-Identifier: GPL-3.0-or-later
"""What questions return: one base, tables, files."""
