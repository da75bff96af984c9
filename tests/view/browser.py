"""A browser without a screen, to open pages as a user does."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager

import cv2
import numpy as np
import pytest

FLAGS = (
    *("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--disable-quic", "--no-first-run", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync"),
)
"""Draw by the processor, and call nobody."""


@contextmanager
def chromium() -> Iterator:
    """Start Chromium; skip the test where it is absent."""
    sync_api = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    path = shutil.which("chromium")
    if path is None:
        pytest.skip("the system has no chromium")
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        yield browser
        browser.close()


def open_page(browser, path, *, scheme="light", size=(960, 600), **device):
    """Open a page from a file and wait for its first picture.

    Returns:
        The page, and a list that gets every error and every request that leaves the page.
    """
    viewport = {"width": size[0], "height": size[1]}
    page = browser.new_page(viewport=viewport, color_scheme=scheme, **device)
    faults = []
    page.on("console", lambda said: said.type in ("error", "warning") and faults.append(said.text))
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda asked: is_outside(asked.url) and faults.append(asked.url))
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready]", timeout=30_000)
    rest(page)
    return page, faults


def is_outside(address):
    return not address.startswith(("file:", "data:", "blob:"))


def rest(page):
    """Wait until the page has drawn everything and draws no more."""
    page.wait_for_function("() => murkscan.stage.isAtRest", timeout=30_000)


def picture(page):
    """Give what the page shows, as an image of red, green and blue."""
    coded = np.frombuffer(page.screenshot(), np.uint8)
    return cv2.cvtColor(cv2.imdecode(coded, cv2.IMREAD_COLOR), cv2.COLOR_BGR2RGB)
