"""The page of an evaluation in a real browser, and that the check of it can fail."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import polars as pl
import pytest
from browser import colours_in, faults_of, open_browser, why_no_browser
from evaluation_data import write_evaluation
from selenium import webdriver
from selenium.webdriver.common.by import By

from chromadock.evaluate.filters import FILTERS
from chromadock.evaluate.gallery import read_gallery
from chromadock.evaluate.rendering import gallery_svg
from chromadock.evaluate.report import write_report

REASON = why_no_browser()
pytestmark = pytest.mark.skipif(REASON is not None, reason=str(REASON))


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    with open_browser(tmp_path_factory.mktemp("browser")) as driver:
        yield driver


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("evaluation")
    frames = write_evaluation(out, frames=6)
    frames.filter(pl.col("experiment") != "lake").write_parquet(out / "frames.parquet")
    return write_report(out)


def test_every_figure_of_the_page_shows(
    driver: webdriver.Chrome, page: Path, record_property: object
) -> None:
    faults, figures = faults_of(driver, page)
    assert not faults
    assert figures == 9
    record_property("figure", f"report.html in chromium: {figures} figures, no faults")


def test_the_page_fits_a_phone(driver: webdriver.Chrome, page: Path) -> None:
    driver.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": 360, "height": 740, "deviceScaleFactor": 2, "mobile": True},
    )
    try:
        faults, _ = faults_of(driver, page)
        width = driver.execute_script("return document.documentElement.scrollWidth")
    finally:
        driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert not faults
    assert width == 360


def test_the_documents_gallery_shows_its_pictures(
    driver: webdriver.Chrome, page: Path, tmp_path: Path
) -> None:
    exhibits = read_gallery(page.parent, ["pool 3 m ternary"], FILTERS)
    (tmp_path / "gallery.svg").write_text(gallery_svg(exhibits))
    holder = tmp_path / "page.html"
    holder.write_text('<figure id="one"><img src="gallery.svg" width="1000"></figure>')
    faults, _ = faults_of(driver, holder)
    assert faults == [f"asked for {(tmp_path / 'gallery.svg').as_uri()}"]
    shot = driver.find_element(By.TAG_NAME, "img").screenshot_as_png
    assert colours_in(shot) > 500  # noise of the water in the frames


def drawn(shape: str) -> str:
    return f'<svg width="200" height="100" viewBox="0 0 200 100">{shape}</svg>'


STROKES = "".join(
    f'<path d="M0 {y} L200 {y}" stroke="{colour}"/>'
    for y, colour in zip(
        range(10, 70, 10), ("red", "blue", "green", "teal", "navy", "lime"), strict=True
    )
)
PIXEL = (
    "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGA"
    "WjR9awAAAABJRU5ErkJggg=="
)


@pytest.mark.parametrize(
    ("content", "fault"),
    [
        (drawn(STROKES), None),
        ("", "no picture in it"),
        (drawn(""), "nothing is drawn"),
        (drawn('<path d="M0 0 L200 0 L200 100 Z" fill="white"/>'), "nothing is drawn"),
        (drawn(STROKES).replace('width="200"', 'width="0"'), "nothing is drawn"),
        (f'<div style="display: none">{drawn(STROKES)}</div>', "nothing is drawn"),
        (f'<img width="99" height="99" src="{PIXEL}">', None),
        ('<img width="99" height="99" src="data:image/png;base64,AAAA">', "image 0 does not show"),
        (f'<img width="0" height="99" src="{PIXEL}">', "image 0 does not show"),
        (drawn(STROKES.replace("stroke", "title")), "a drawing without colours"),
        (drawn(f'<g opacity="0">{STROKES}</g>'), "a drawing without colours"),
        (drawn(STROKES) + "<script>nothing.here()</script>", "console: "),
        (drawn(STROKES) + '<img src="http://127.0.0.1:9/x.png">', "asked for http://127.0.0.1:9"),
    ],
)
def test_the_check_finds_a_broken_figure(
    driver: webdriver.Chrome, tmp_path: Path, content: str, fault: str | None
) -> None:
    page = tmp_path / "page.html"
    page.write_text(f'<!DOCTYPE html><body><figure id="one">{content}</figure></body>')
    faults, figures = faults_of(driver, page)
    assert figures == 1
    if fault is None:
        assert not faults
    else:
        assert any(fault in each for each in faults)


def test_a_damaged_figure_of_the_page_is_found(
    driver: webdriver.Chrome, page: Path, tmp_path: Path
) -> None:
    whole = page.read_text()
    damaged = tmp_path / "damaged.html"
    damaged.write_text(
        whole.replace("data:image/jpeg;base64,/9j/", "data:image/jpeg;base64,AAAA", 1)
    )
    faults, _ = faults_of(driver, damaged)
    assert any(each.startswith("gallery: image 0") for each in faults)
    damaged.write_text(re.sub(r"<path [^>]*>", "", whole))
    faults, _ = faults_of(driver, damaged)
    assert {"passed: nothing is drawn", "sweep-tint: nothing is drawn"} <= set(faults)
