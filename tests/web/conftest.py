# SPDX-License-Identifier: GPL-3.0-or-later
"""The live page in Debian's chromium; the browser gets no network."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "out" / "web" / "index.html"
SOFTWARE = ["--enable-unsafe-swiftshader", "--use-angle=swiftshader"]  # WebGL without a graphics card
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    assert PAGE.is_file(), f"{PAGE} is missing: build it with tools/web"
    assert CHROMIUM, "no chromium found: install it with  sudo apt-get install chromium"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", *SOFTWARE])
        yield browser
        browser.close()


@pytest.fixture
def open_page(browser: Browser) -> Iterator[Callable[..., Page]]:
    """Opens the page from its folder with a link and a query; errors and requests to the network fail the test."""
    contexts, wrong = [], []

    def opened(link: str = "", query: str = "", **context: Any) -> Page:
        made = browser.new_context(**context)
        contexts.append(made)
        page = made.new_page()
        page.on("pageerror", lambda error: wrong.append(f"error: {error}"))
        page.on(
            "request",
            lambda sent: sent.url.startswith(("file:", "data:", "blob:")) or wrong.append(f"request: {sent.url}"),
        )
        page.goto(f"{PAGE.as_uri()}{query}#{link}")
        return page

    yield opened
    for each in contexts:
        each.close()
    assert not wrong
