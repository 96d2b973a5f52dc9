# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of pages whose code saves one, drawn by that code in the style of the documentation.

python draw_pages.py [FOLDER]
"""

import contextlib
import io
import os
import re
import sys
from pathlib import Path

import matplotlib

from revchain.plots.style import STYLE

DOCS = Path(__file__).resolve().parent.parent
PAGES = [
    *("howto/plots.md", "howto/governor.md", "howto/campbell.md", "howto/drag.md", "tutorial/first_chain.md"),
    *("tutorial/carousel.md", "chains.md", "paper.md"),
]

matplotlib.use("agg")
matplotlib.rcParams.update(STYLE)
os.environ.setdefault("SOURCE_DATE_EPOCH", "0")  # the same picture gives the same file
os.chdir(sys.argv[1] if len(sys.argv) > 1 else ".")
for name in PAGES:
    blocks = re.findall(r"```python\n(.*?)```", (DOCS / name).read_text("utf-8"), re.DOTALL)
    with contextlib.redirect_stdout(io.StringIO()):
        exec(compile("\n".join(blocks), name, "exec"), {"__name__": "__main__"})
    pictures = re.findall(r'savefig\("(.*?)"\)', "".join(blocks))
    print(f"docs/{name}: wrote {', '.join(pictures)}")
