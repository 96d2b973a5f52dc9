# SPDX-License-Identifier: GPL-3.0-or-later
"""Study files: many variations of a scene. Needs msgspec."""
