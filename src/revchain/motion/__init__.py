# SPDX-License-Identifier: GPL-3.0-or-later
"""Films, pages and solids of what moves. Imported when a result is written as one."""
