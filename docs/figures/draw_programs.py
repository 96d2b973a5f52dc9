# SPDX-License-Identifier: GPL-3.0-or-later
"""Run programs of the gallery and write the last picture of each, NAME.svg, into the current folder.

python draw_programs.py PROGRAM.py ...
"""

import runpy
import sys
from pathlib import Path

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

from revchain.plots.style import STYLE

programs, sys.path[0] = [Path(name) for name in sys.argv[1:]], ""  # a program finds no module beside this one
plt.rcParams.update(STYLE)
plt.show = lambda: None
for program in programs:
    runpy.run_path(str(program), run_name="__main__")
    if plt.get_fignums():
        plt.gcf().savefig(f"{program.stem}.svg", metadata={"Date": None})  # the same picture gives the same file
        print(f"wrote {program.stem}.svg")
    plt.close("all")
