# SPDX-License-Identifier: GPL-3.0-or-later
"""How many random cases a test tries: few in the quick tier, `pytest -m "not slow"`, and all of them otherwise.

REVCHAIN_CASES=10000 tries so many instead, in every test that asks here: for one test at a time, with -s for what it prints.
"""

import os

QUICK = False  # conftest.py says whether tests that are marked slow are left out


def by_tier(few: int, many: int) -> int:
    return int(os.environ.get("REVCHAIN_CASES") or (few if QUICK else many))
