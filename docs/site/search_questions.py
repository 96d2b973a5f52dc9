# SPDX-License-Identifier: GPL-3.0-or-later
"""The search of the site shows first the pages that answer a question of docs/questions.md.

The words of each question become keywords of the pages that its row links to, and order the results (search_order.js).
"""

from __future__ import annotations

import functools
import json
import posixpath
import re
from pathlib import Path
from typing import Any

from docutils import nodes

HERE = Path(__file__).parent


@functools.cache
def questions(folder: Path) -> list[tuple[str, list[str]]]:
    """The questions of the page in `folder`, each with the names of the pages to which its answer links."""
    found = []
    for line in (folder / "questions.md").read_text(encoding="utf-8").splitlines():
        if not (row := re.fullmatch(r"\| (.*?) \| (.*) \|", line)):
            continue
        links = re.findall(r"\]\(([^)#]+)\.(?:md|py|ipynb)(?:#[^)]*)?\)", row[2])
        links = [re.sub(r"^\.\./examples/python/", "gallery/", link) for link in links]
        if links:
            found.append((row[1], list(dict.fromkeys(posixpath.normpath(link) for link in links))))
    return found


def write_order(app: Any, config: Any) -> None:
    """The script that orders the results, with the questions in it; it is part of a script of the site."""
    script = (HERE / "search_order.js").read_text(encoding="utf-8")
    data = json.dumps(questions(Path(app.srcdir)), ensure_ascii=False)
    target = Path(app.doctreedir) / "search_order.js"
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(script.replace("QUESTIONS_OF_THE_SITE", data), encoding="utf-8")
    config.html_search_scorer = str(target)


def add_keywords(app: Any, doctree: nodes.document, name: str) -> None:
    """A search finds only pages with all its words. These words count, too."""
    words = " ".join(question for question, pages in questions(Path(app.srcdir)) if name in pages)
    if words:
        stems = dict.fromkeys(re.findall(r"\w+", words))
        doctree.insert(0, nodes.meta(name="keywords", content=", ".join(stems)))


def setup(app: Any) -> dict[str, bool]:
    app.connect("config-inited", write_order)
    app.connect("doctree-resolved", add_keywords)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
