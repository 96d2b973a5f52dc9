# SPDX-License-Identifier: GPL-3.0-or-later
"""The notebooks run, print what they hold as their output, and show sliders."""

from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs" / "notebooks").glob("*.ipynb"))
WIDGETS = "application/vnd.jupyter.widget-"


def printed(notebook):
    """The text of every output, without that of widgets, whose numbers change."""
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    return [output.text for output in outputs if output.output_type == "stream" and output.name == "stdout"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_no_widgets_are_stored(path):
    """Their page would load the widgets' scripts from another server. What the sliders show first is stored as a picture."""
    text = path.read_text("utf-8")
    assert WIDGETS not in text and '"image/png"' in text and "Opened in Jupyter" in text and len(NOTEBOOKS) == 3


@pytest.mark.slow  # starts three kernels
@pytest.mark.filterwarnings("ignore")  # of zmq and traitlets
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(path):
    import nbformat  # here: what it imports takes seconds, at every start of pytest
    from nbclient import NotebookClient

    notebook = nbformat.read(path, 4)
    [cell] = [cell for cell in notebook.cells if cell.source.startswith("interact(")]
    before = printed(notebook)
    assert before
    NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    assert printed(notebook) == before
    assert any(WIDGETS + "view+json" in output.get("data", {}) for output in cell.outputs)
    models = [state["model_name"] for state in notebook.metadata.widgets[WIDGETS + "state+json"]["state"].values()]
    assert sum(model in ("IntSliderModel", "FloatSliderModel") for model in models) == cell.source.count("=")
