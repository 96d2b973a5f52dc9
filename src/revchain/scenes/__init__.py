# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: reading, checks and answers. Needs msgspec."""
