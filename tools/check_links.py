# SPDX-License-Identifier: MPL-2.0
"""python tools/check_links.py FOLDER: every link between the pages of a site leads to a file, and to a place in it."""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Links of a page and the places in it that links can name."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.places: set[str] = set()
        self.feed(text)

    def handle_starttag(self, _: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in ("href", "src") and value:
                self.links.append(value)
            elif name in ("id", "name") and value:
                self.places.add(value)


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
    print(*broken, f"{seen} links of {len(pages)} pages checked, {len(broken)} broken", sep="\n")
    return min(len(broken), 1)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
