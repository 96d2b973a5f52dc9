# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed forms, most of them of the paper, by subject."""
