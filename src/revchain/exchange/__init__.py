# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of other programs: models of multibody engines."""
