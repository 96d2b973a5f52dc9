# SPDX-License-Identifier: MPL-2.0
"""python tools/check_links.py FOLDER: every link between the pages of a site leads to a file, and to a place in it.
No page and no style sheet loads anything from another server: scripts, styles, fonts, pictures, frames."""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


NAMES_ONLY = {"alternate", "author", "canonical", "help", "license", "next", "prev", "search"}  # a <link> that loads nothing
IN_STYLE = re.compile(r"""(?:url\(|@import)\s*["']?\s*((?:https?:)?//[^\s"')]+)""", re.IGNORECASE)


def elsewhere(address: str) -> bool:
    parts = urlsplit(address.strip())
    return bool(parts.netloc) and parts.scheme in ("", "http", "https")


class Page(HTMLParser):
    """Links of a page, the places in it that links can name, and what a browser loads with it from another server."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.places: set[str] = set()
        self.loaded: list[str] = []
        self.in_style = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        rel = set((dict(attrs).get("rel") or "").lower().split())
        for name, value in attrs:
            if not value:
                continue
            if name in ("href", "src"):
                self.links.append(value)
            elif name in ("id", "name"):
                self.places.add(value)
            if name == "style":
                self.loaded += IN_STYLE.findall(value)
            elif name in ("srcset", "imagesrcset"):
                self.loaded += [part for part in re.split(r"[\s,]+", value) if elsewhere(part)]
            elif name in ("src", "poster", "background") or (tag, name) == ("object", "data"):
                self.loaded += [value] if elsewhere(value) else []
            elif name in ("href", "xlink:href") and (tag in ("image", "use") or (tag == "link" and not rel <= NAMES_ONLY)):
                self.loaded += [value] if elsewhere(value) else []
        self.in_style = tag == "style"

    def handle_data(self, data: str) -> None:
        if self.in_style:
            self.loaded += IN_STYLE.findall(data)

    def handle_endtag(self, _: str) -> None:
        self.in_style = False


def main(folder: Path) -> int:
    pages = {path.resolve(): Page(path.read_text(encoding="utf-8")) for path in sorted(folder.rglob("*.html"))}
    broken, seen = [], 0
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            seen += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            where = unquote(parts.fragment)
            if not target.exists() or (where and target in pages and where not in pages[target].places):
                broken.append(f"{path.relative_to(folder.resolve())}: {link}")
    loads = {path: page.loaded for path, page in pages.items()}
    loads |= {path: IN_STYLE.findall(path.read_text(encoding="utf-8")) for path in sorted(folder.resolve().rglob("*.css"))}
    foreign = [
        f"{path.relative_to(folder.resolve())}: loads {address} from another server. Put the file into the site"
        for path, addresses in loads.items()
        for address in addresses
    ]
    print(*broken, *foreign, f"{seen} links of {len(pages)} pages checked, {len(broken)} broken", sep="\n")
    print(f"{len(loads)} pages and style sheets checked, files loaded from other servers: {len(foreign)}")
    return min(len(broken) + len(foreign), 1)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
