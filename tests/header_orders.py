# SPDX-License-Identifier: MPL-2.0
"""Writes files that include all public headers, each file in another random order; it prints the seed.

    header_orders.py FOLDER COUNT HEADER...

REVCHAIN_SEED chooses the orders; without it they are new each time.
"""

import os
import random
import sys
import time
from pathlib import Path

folder, count, headers = Path(sys.argv[1]), int(sys.argv[2]), sorted(sys.argv[3:])
seed = int(os.environ.get("REVCHAIN_SEED") or time.time_ns() % 1_000_000)
print(f"orders of the public headers: REVCHAIN_SEED={seed}", flush=True)
shuffle = random.Random(seed).shuffle
for number in range(1, count + 1):
    shuffle(headers)
    lines = "".join(f'#include "revchain/{Path(header).name}"\n' for header in headers)
    (folder / f"order_{number}.cpp").write_text(f"// REVCHAIN_SEED={seed}\n{lines}", encoding="utf-8")
