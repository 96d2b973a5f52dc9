# SPDX-License-Identifier: GPL-3.0-or-later
"""The questions: modes, shapes, branches, response, swing, tune, fit, explain."""
