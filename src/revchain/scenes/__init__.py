# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: reading, checks, answers and reports. Needs msgspec."""
