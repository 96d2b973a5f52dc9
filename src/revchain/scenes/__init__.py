# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: read, checked, answered. Needs msgspec."""
