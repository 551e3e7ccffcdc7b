"""A real browser that opens a page and says what is wrong with its figures."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from step import missing

# Debian package -> its program.
PROGRAMS = {"chromium": "chromium", "chromium-driver": "chromedriver"}

OPTIONS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1000,1400",
)

# What a figure has, as the browser laid it out.  Ink: shapes that are neither white nor empty.
LOOK = """
const visible = (e) => {
  const box = e.getBoundingClientRect();
  return e.checkVisibility({opacityProperty: true, visibilityProperty: true})
    && box.width > 10 && box.height > 10;
};
const inked = (e) => {
  const box = e.getBBox(), style = getComputedStyle(e);
  const empty = ["none", "rgb(255, 255, 255)"];
  return box.width + box.height > 0 && e.checkVisibility()
    && !(empty.includes(style.fill) && empty.includes(style.stroke));
};
return [...document.querySelectorAll("figure")].map((figure) => ({
  name: figure.id,
  visible: visible(figure),
  images: [...figure.querySelectorAll("img")].map(
    (e) => e.complete && e.naturalWidth > 0 && e.naturalHeight > 0 && visible(e)),
  drawings: [...figure.querySelectorAll("svg")].map(
    (e) => visible(e) ? [...e.querySelectorAll("path")].filter(inked).length : 0),
}));
"""


def why_no_browser() -> str | None:
    """The reason to skip, by the name of what is missing."""
    for package, program in PROGRAMS.items():
        if not shutil.which(program):
            return missing(package) or f"no {program} here (Debian: {package})"
    return None


@contextmanager
def open_browser(folder: Path) -> Iterator[webdriver.Chrome]:
    """Chromium with an empty profile in ``folder``, which also is its home."""
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for option in (*OPTIONS, f"--user-data-dir={folder / 'profile'}"):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    environment = {**os.environ, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder)}
    service = Service(shutil.which("chromedriver"), env=environment)
    driver = webdriver.Chrome(options=options, service=service)
    try:
        yield driver
    finally:
        driver.quit()


def faults_of(driver: webdriver.Chrome, page: Path) -> tuple[list[str], int]:
    """What is wrong with the page in this browser, a line each, and how many figures it has."""
    address = page.resolve().as_uri()
    for log in ("browser", "performance"):
        driver.get_log(log)
    driver.get(address)
    figures = driver.execute_script(LOOK)
    faults = []
    for figure in figures:
        name, drawings, images = figure["name"], figure["drawings"], figure["images"]
        if not figure["visible"]:
            faults.append(f"{name}: not to be seen")
        if not images and not drawings:
            faults.append(f"{name}: no picture in it")
        faults += [f"{name}: image {i} does not show" for i, ok in enumerate(images) if not ok]
        faults += [f"{name}: nothing is drawn" for inked in drawings if inked < 5]
    for element in driver.find_elements(By.CSS_SELECTOR, "figure svg"):
        if element.is_displayed() and colours_in(element.screenshot_as_png) < 3:
            faults.append("a drawing without colours")
    faults += [f"console: {entry['message']}" for entry in driver.get_log("browser")]
    faults += [f"asked for {url}" for url in requests(driver) if url != address]
    return faults, len(figures)


def colours_in(png: bytes) -> int:
    """How many colours a screenshot has."""
    pixels = cv2.imdecode(np.frombuffer(png, np.uint8), cv2.IMREAD_COLOR).astype(np.uint32)
    return len(np.unique(pixels @ np.array([1, 256, 65536], np.uint32)))


def requests(driver: webdriver.Chrome) -> list[str]:
    """Addresses that the page made the browser ask for, less what stands in the page itself."""
    messages = [json.loads(e["message"])["message"] for e in driver.get_log("performance")]
    asked = [m["params"] for m in messages if m["method"] == "Network.requestWillBeSent"]
    urls = [params["request"]["url"] for params in asked]
    return [url for url in urls if not url.startswith("data:")]
