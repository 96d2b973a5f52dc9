# SPDX-License-Identifier: GPL-3.0-or-later
"""The terms of the glossary's tables become entries of the index, which the search of the site shows first."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from sphinx import addnodes
from sphinx.transforms import SphinxTransform


class GlossaryIndex(SphinxTransform):
    """Each row of a table of the page `glossary`: the terms of its first two cells lead to it."""

    default_priority = 400

    def apply(self, **_: Any) -> None:
        if self.env.docname != "glossary":
            return
        for row in self.document.findall(nodes.row):
            cells = [cell.astext() for cell in row.findall(nodes.entry)]
            if isinstance(row.parent, nodes.thead) or len(cells) < 3:
                continue
            words = [word.strip() for cell in cells[:2] for word in re.sub(r"\(.*?\)", "", cell).split(",")]
            terms = [word for word in dict.fromkeys(words) if len(word) > 2]
            place = "term-" + nodes.make_id(terms[0])
            cell = next(row.findall(nodes.entry))
            entries = [("single", term, place, "main", None) for term in terms]
            cell.insert(0, [addnodes.index(entries=entries), nodes.target("", "", ids=[place])])


def setup(app: Any) -> dict[str, bool]:
    app.add_transform(GlossaryIndex)
    return {"parallel_read_safe": True}
