# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed forms of the paper, one module for each subject."""
