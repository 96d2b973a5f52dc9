# SPDX-License-Identifier: GPL-3.0-or-later
"""What hangs: chains and rigs; numbers, units and their checks."""
