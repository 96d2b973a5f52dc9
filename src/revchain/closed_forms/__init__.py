# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed forms of the paper, each a module of its own."""
