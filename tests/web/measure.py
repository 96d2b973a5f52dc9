#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures the live page in headless chromium: size, first picture, frames while sliders move, all shapes of 8 links.

Run it after tools/web, with playwright installed; it prints a table.
"""

import gzip
import statistics
from pathlib import Path

from playwright.sync_api import Page, sync_playwright

ARGUMENTS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"]  # as in conftest.py
OUT = Path(__file__).resolve().parents[2] / "out" / "web"

FRAMES = """async (ids) => {
    const gaps = [], work = [], next = window.requestAnimationFrame;
    window.requestAnimationFrame = (draw) => next((time) => {
        const start = performance.now();
        draw(time);
        work.push(performance.now() - start);
    });
    let before = performance.now();
    for (let i = 0; i < 240; ++i) {
        for (const id of ids) {
            const range = document.getElementById(id);
            range.value = 300 + 400 * Math.abs(Math.sin(i / 40));
            range.oninput();
        }
        await new Promise(next);
        const now = performance.now();
        gaps.push(now - before);
        before = now;
    }
    return [gaps, work];
}"""


def frames(page: Page, link: str, ids: list[str]) -> str:
    page.goto(f"{(OUT / 'index.html').as_uri()}#{link}")
    page.evaluate("settled()")
    gaps, work = (times[20:] for times in page.evaluate(FRAMES, ids))
    late = sum(gap > 25 for gap in gaps)
    script = f"script of a frame {statistics.median(work):.1f} ms, one in twenty {statistics.quantiles(work, n=20)[-1]:.1f} ms"
    return f"{1000 / statistics.mean(gaps):.1f} frames/s without a graphics card, {late} of {len(gaps)} later than 25 ms; {script}"


def main() -> None:
    text = (OUT / "index.html").read_bytes()
    print(
        f"size                          {len(text) / 1000:.0f} KB, {len(gzip.compress(text, 9)) / 1000:.0f} KB with gzip"
    )
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=ARGUMENTS)
        for attempt in range(3):
            page = browser.new_page()
            page.goto((OUT / "index.html").as_uri())
            page.wait_for_function("performance.getEntriesByName('modes').length")
            picture, modes = page.evaluate(
                "['picture', 'modes'].map((name) => performance.getEntriesByName(name)[0].startTime)"
            )
            print(
                f"load {attempt + 1}                        picture {picture:.0f} ms, modes {modes:.0f} ms after the start"
            )
            page.close()
        page = browser.new_page()
        print(f"50 links, speed moves         {frames(page, 'p=50_0.1_0.02_point', ['speed'])}")
        page = browser.new_page()
        print(
            f"50 links, speed and mass move {frames(page, 'p=50_0.1_0.02_point', ['speed', 'part0-mass', 'part0-length'])}"
        )
        for speed in (20, 40, 50):
            page = browser.new_page()
            page.goto(f"{(OUT / 'index.html').as_uri()}#p=8_1_0.125_point&n={speed}")
            page.evaluate("settled()")
            times = []
            for _ in range(5):
                page.evaluate("speed.oninput()")
                found = page.evaluate("settled()")
                times.append(found["shapes"]["time"])
            count, median = len(found["shapes"]["shapes"]), statistics.median(times)
            print(f"8 links at {speed} rad/s           {count} shapes in {median:.1f} ms, first {times[0]:.1f} ms")
        browser.close()


if __name__ == "__main__":
    main()
