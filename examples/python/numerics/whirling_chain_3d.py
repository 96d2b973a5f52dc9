# SPDX-License-Identifier: GPL-3.0-or-later
"""Whirling chain in three dimensions
==================================

The modes of a hanging chain, each turning about its axis as a solid: drag the picture to turn the view.
"""

# sphinx_gallery_thumbnail_path = "figures/viewer_mode.png"
import revchain as rc

modes = rc.modes(rc.Chain.uniform_rods(12), 6)
modes.show()

# %%
# A chain of twelve rods whirls in as many modes. The first six turn here, each at its own speed,
# slower than in reality. The offsets are exaggerated. The shadow on each floor is the plan: how far
# each body is from the axis.
#
# Scroll to zoom, press the space bar to pause.

print(modes)

# %%
# In a notebook, the view is in the output of the cell. ``modes.animate("chain.html")`` writes the
# same view as a page of its own, ``modes.to_glb("chain.glb")`` as a glTF file for presentations.
#
# To try next: ``rc.steady_shapes(modes.system, angular_speed="120 rpm").show()``, which
# is true to scale.
#
# Checked: ``tests/python/test_viewer.py`` and ``tests/python/test_animate.py``.
