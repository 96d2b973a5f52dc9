# SPDX-License-Identifier: GPL-3.0-or-later
"""The main plots against pictures that people have looked at (tests/python/images), without their letters.

After a change that is meant: pytest tests/python/test_images.py --mpl-generate-path=tests/python/images, and look.
"""

import numpy as np
import pytest
from matplotlib.text import Text

import revchain as rc
from revchain.plots.style import STYLE

CHAIN = rc.Chain(mass=[1.0, 1.0, 1.0], length=1.0)
BELL = rc.Chain(mass=[18, 500], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
CAROUSEL = rc.Rig(rc.Chain(mass=90, length=[2.0, 2.0]), support=rc.Support(radius=0.5))
PLOTS = {
    "modes": lambda: rc.modes(rc.Chain.uniform_rods(12, length=1.0), 4).plot(),
    "modes_of_a_rig": lambda: rc.modes(rc.Rig(BELL, support=rc.Support(stiffness=4e5, mass=150.0))).plot(),
    "shapes": lambda: rc.steady_shapes(CHAIN, angular_speed=13.5).plot(),
    "branches": lambda: rc.branches(CHAIN, max_angular_speed=14.0).plot(),
    "branches_of_a_carousel": lambda: rc.branches(CAROUSEL, max_angular_speed=8.0).plot(),
    "response": lambda: rc.response(CHAIN, angular_speed=np.linspace(0.2, 9.0, 300), support_radius=0.01).plot(),
    "swing": lambda: rc.swing(CHAIN, np.linspace(0.0, 2.0, 9), offset=[0.05, 0.02, 0.01]).plot(),
    "force_diagram": lambda: rc.steady_shapes(CHAIN, angular_speed=4.0)[0].force_diagram().plot(),
    "blade": lambda: rc.steady_shapes(rc.Held(rc.Cord(24.0, mass=160.0), span=17.0), angular_speed=3.0).plot(),
    "bell": lambda: rc.bell_and_clapper(BELL).plot(),
}


@pytest.mark.parametrize("name", PLOTS)
@pytest.mark.mpl_image_compare(baseline_dir="images", style={**STYLE, "savefig.dpi": 60})
def test_plots(name):
    drawn = np.atleast_1d(PLOTS[name]())
    figure = drawn.flat[0].get_figure(root=True)
    for text in figure.findobj(Text):
        text.set_visible(False)  # letters are not the same with every version of FreeType
    return figure
