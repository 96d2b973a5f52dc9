# SPDX-License-Identifier: GPL-3.0-or-later
"""The four systems (`Chain`, `Rig`, `Cord`, `Held`), and the checks of numbers and units."""
