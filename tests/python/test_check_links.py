# SPDX-License-Identifier: GPL-3.0-or-later
"""tools/check_links.py: broken links and files from other servers are found, plain links to other sites are not."""

import pytest

GOOD = """<html><head><link rel="stylesheet" href="a.css"><link rel="canonical" href="https://example.org/"></head>
<body id="top"><a href="https://example.org/page">elsewhere</a> <a href="#top">up</a> <code>url(https://example.org/x)</code>
<img src="data:image/png;base64,AAAA"></body></html>"""
LOADS = {
    "script": '<script src="https://example.org/x.js"></script>',
    "style sheet": '<link rel="preload stylesheet" href="//example.org/x.css">',
    "picture": '<img src="http://example.org/x.png">',
    "picture of two sizes": '<img src="a.css" srcset="a.css 1x, https://example.org/x.png 2x">',
    "frame": '<iframe src="https://example.org/x.html"></iframe>',
    "style": "<style>@import 'https://example.org/x.css';</style>",
    "attribute": '<p style="background: url(https://example.org/x.png)"></p>',
}


@pytest.fixture
def check(tmp_path, python, repository):
    def run(page, style="p {background: url(b.png)}"):
        (tmp_path / "index.html").write_text(page, "utf-8")
        (tmp_path / "a.css").write_text(style, "utf-8")
        return python(repository / "tools/check_links.py", tmp_path)

    return run


def test_a_site_by_itself(check):
    done = check(GOOD)
    assert done.returncode == 0 and "2 pages and style sheets checked, files loaded from other servers: 0" in done.stdout


@pytest.mark.parametrize("tag", LOADS.values(), ids=LOADS)
def test_what_comes_from_another_server(check, tag):
    done = check(GOOD.replace("</body>", f"{tag}</body>"))
    assert done.returncode == 1 and "index.html: loads " in done.stdout and "example.org/x" in done.stdout
    assert ", files loaded from other servers: 1" in done.stdout


def test_a_font_of_a_style_sheet(check):
    done = check(GOOD, "@font-face {src: url('https://example.org/x.woff2')}")
    assert done.returncode == 1 and "a.css: loads https://example.org/x.woff2 from another server" in done.stdout


def test_a_broken_link(check):
    done = check(GOOD.replace("#top", "#bottom"))
    assert done.returncode == 1 and "index.html: #bottom" in done.stdout
