# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of the questions, their base class, tables and files."""
