# SPDX-License-Identifier: GPL-3.0-or-later
"""A reader of HTML pages that checks them: nesting, ids, links, pictures; and the tables and texts that they hold."""

import base64
import re
from html.parser import HTMLParser
from xml.etree import ElementTree

VOID = {"meta", "img", "br", "link", "input", "hr"}
OPTIONAL_END = {"p", "li", "dt", "dd"}  # closed by us all the same


class Page(HTMLParser):
    """What a page holds. `problems` lists what is wrong with it."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.problems, self.ids, self.refs, self.resources = [], [], [], [], []
        self.tables, self.images, self.hidden, self.text = [], [], 0, ""
        self.doctype = ""
        self.feed(text)
        self.close()
        self.problems += [f"<{tag}> is not closed" for tag in self.open]
        self.problems += [f"id {name} twice" for name in {*self.ids} if self.ids.count(name) > 1]
        self.problems += [f"no id {name}" for name in self.refs if name not in self.ids]
        if self.doctype.lower() != "doctype html":
            self.problems.append("no doctype")

    def handle_decl(self, decl):
        self.doctype = decl

    def handle_starttag(self, tag, attrs):
        given = dict(attrs)
        if len(given) < len(attrs):
            self.problems.append(f"<{tag}> has an attribute twice")
        if "id" in given:
            self.ids.append(given["id"])
        for name in ("src", "href", "data", "srcset", "action"):
            if name in given and given[name].startswith("#"):
                self.refs.append(given[name][1:])
            elif name in given:
                self.resources.append(given[name])
        if tag == "img":
            self.images.append(given)
        if tag == "table":
            self.tables.append([])
        if tag == "tr":
            self.tables[-1].append([])
        if tag in ("td", "th"):
            self.tables[-1][-1].append("")
        if given.get("aria-hidden") == "true":
            self.hidden += 1
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        if not self.open or self.open[-1] != tag:
            self.problems.append(f"</{tag}> closes {self.open[-1:] or 'nothing'} at line {self.getpos()[0]}")
        else:
            self.open.pop()
        if tag == "span" and self.hidden:
            self.hidden -= 1

    def handle_data(self, data):
        if self.hidden or "style" in self.open or "script" in self.open:
            return
        self.text += data
        if {"td", "th"} & {*self.open[-3:]}:
            self.tables[-1][-1][-1] += data

    def svgs(self):
        """The pictures, each as the root of its XML."""
        for image in self.images:
            kind, _, data = image["src"].partition(";base64,")
            assert kind == "data:image/svg+xml" and image["alt"] and int(image["width"]) > 30 and int(image["height"]) > 30
            yield ElementTree.fromstring(base64.b64decode(data, validate=True))


def style_of(text):
    return re.search(r"<style>(.*?)</style>", text, re.DOTALL)[1]
