# SPDX-License-Identifier: GPL-3.0-or-later
"""The functions that answer questions about a system."""
