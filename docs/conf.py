# SPDX-License-Identifier: MPL-2.0
"""The site: the pages of this folder, and references from docstrings and headers. Built by tools/site."""

import os
import shutil
import sys
from importlib import metadata
from pathlib import Path

import jupyter_server_mathjax

HERE = Path(__file__).parent
ROOT = HERE.parent
sys.path.insert(0, str(HERE / "site"))

project, author, copyright = "revchain", "the revchain developers", "the revchain developers"
release = version = metadata.version("revchain")
extensions = [
    "gallery_pictures",
    "generated_pages",
    "glossary_index",
    "search_questions",
    "myst_nb",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.mathjax",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "sphinx_sitemap",
    "sphinxext.opengraph",
]
if (ROOT / "out/web/index.html").exists():
    tags.add("live")  # noqa: F821
exclude_patterns = ["site", "figures", "sg_execution_times.rst", "gallery/[!i]*.rst",
                    "gallery/*/sg_execution_times.rst", "gallery/**.ipynb"]
source_suffix = {".rst": "restructuredtext", ".md": "myst-nb", ".ipynb": "myst-nb"}
nb_execution_mode = "off"
myst_enable_extensions = ["amsmath", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3

templates_path = ["site/templates"]
autosummary_generate = True
autosummary_imported_members = True
autodoc_typehints = "none"
numpydoc_show_class_members = False

sphinx_gallery_conf = {
    "examples_dirs": str(ROOT / "examples" / "python"),
    "gallery_dirs": "gallery",
    "filename_pattern": r"/[a-z]\w+\.py$",
    "image_scrapers": ("gallery_pictures.scrape",),
    "within_subsection_order": "gallery_pictures.order",
    "capture_repr": ("_repr_html_",),
    "remove_config_comments": True,
    "show_signature": False,
    "reset_modules": (),
    "show_memory": False,
    "min_reported_time": 1e9,
    "abort_on_example_error": True,
    "download_all_examples": False,
}

html_theme = "furo"
html_title = f"revchain {release}"
html_static_path = ["site/static"]
html_css_files = ["wide.css", "dark.css"]
html_favicon = "site/static/favicon.svg"
# The address of the site, for the sitemap and for what others show of a link to it.
html_baseurl = os.environ.get("REVCHAIN_SITE_URL", "http://localhost:8000/")
sitemap_url_scheme = "{link}"
sitemap_show_lastmod = False
ogp_site_name = "revchain"
ogp_image = html_baseurl + "_static/card.png"
ogp_image_alt = "A chain of seven balls whirls at one speed in three ways"
ogp_social_cards = {"enable": False}
ogp_enable_meta_description = True
html_show_sphinx = False
copybutton_prompt_text = ">>> "
mathjax_path = "mathjax/MathJax.js?config=TeX-AMS-MML_HTMLorMML-full"
mathjax_options = {"async": "async"}
mathjax2_config = {
    "tex2jax": {"processClass": "tex2jax_process|mathjax_process|math|output_area"},
    "HTML-CSS": {"availableFonts": [], "imageFont": None, "preferredFont": None, "webFont": "STIX-Web"},
}


def copy_mathjax(app, _):
    """Copies MathJax into the site: formulas then show without a network."""
    source = Path(jupyter_server_mathjax.__file__).parent / "static"
    target = Path(app.outdir) / "_static" / "mathjax"
    if app.builder.format == "html" and not target.exists():
        shutil.copytree(source, target, ignore=shutil.ignore_patterns("localization", "SVG", "CommonHTML", "NativeMML"))


def setup(app):
    app.connect("build-finished", copy_mathjax)
