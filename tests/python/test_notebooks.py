# SPDX-License-Identifier: GPL-3.0-or-later
"""The notebooks run, and print what they hold as their output."""

from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).parents[2] / "docs" / "notebooks").glob("*.ipynb"))


def printed(notebook):
    """The text of every output, without that of widgets, whose numbers change."""
    outputs = [output for cell in notebook.cells if cell.cell_type == "code" for output in cell.outputs]
    return [output.text for output in outputs if output.output_type == "stream" and output.name == "stdout"]


def test_there_are_three():
    assert len(NOTEBOOKS) == 3


@pytest.mark.slow  # starts three kernels
@pytest.mark.filterwarnings("ignore")  # of zmq and traitlets
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks(path):
    import nbformat  # here: what it imports takes seconds, at every start of pytest
    from nbclient import NotebookClient

    notebook = nbformat.read(path, 4)
    assert sum("interact(" in cell.source for cell in notebook.cells) == 1
    before = printed(notebook)
    NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    assert printed(notebook) == before
