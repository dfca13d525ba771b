"""The report in a real browser: pages load without errors, the table filters and sorts, the 3D view draws and turns.

Needs Chromium on this machine; nothing is fetched.
"""

from __future__ import annotations

import io
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, ConsoleMessage, Error, Page, sync_playwright

from reports import site
from reports.runner import CaseRun, Failure

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
PICTURE = site.DrawnPicture(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR42mP4DwABAQEAWk1v8QAAAABJRU5ErkJggg==", 1, 1, "10", ""
)

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium to open pages with (Debian: chromium)"),
]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        try:
            # without a graphics card WebGL is drawn by software
            found = playwright.chromium.launch(executable_path=CHROMIUM, args=["--enable-unsafe-swiftshader"])
        except Error as error:
            pytest.skip(f"Chromium does not start: {str(error).splitlines()[0]}")
        yield found
        found.close()


@pytest.fixture(scope="module")
def report(drawn_run: CaseRun, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report of three cases: two that pass or fail, called alpha and beta, and one that was not run, gamma."""
    passing = tuple(replace(found, verdict="pass") for found in drawn_run.comparisons)
    failing = (replace(passing[0], verdict="fail"), *passing[1:])
    alpha = replace(drawn_run, case=replace(drawn_run.case, name="alpha", title="Alpha <b>"), comparisons=passing)
    slower = replace(drawn_run.rod, total_seconds=9.0)
    beta = replace(alpha, case=replace(drawn_run.case, name="beta", title="Beta"), comparisons=failing, rod=slower)
    gamma = Failure(replace(drawn_run.case, name="gamma", title="Gamma"), "it took too long")
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(site, "pictures", lambda _: {"alpha": PICTURE, "beta": PICTURE})
        return site.write_report([beta, gamma, alpha], tmp_path_factory.mktemp("report")).parent


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    context = browser.new_context(viewport={"width": 1300, "height": 900})
    page = context.new_page()
    page.set_default_timeout(120_000)  # ms; where many share a processor
    yield page
    context.close()


def shown(page: Page) -> list[str]:
    """Names of the cases whose rows are seen, in their order."""
    return page.locator("#all-cases tbody tr:visible code").all_inner_texts()


@pytest.mark.parametrize("width", [1300, 360])
def test_pages_load_without_errors_and_do_not_scroll_sideways(report: Path, page: Page, width: int) -> None:
    errors: list[str] = []

    def heard(message: ConsoleMessage) -> None:
        if message.type == "error":
            errors.append(message.text)

    page.on("console", heard)
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.on("requestfailed", lambda request: errors.append(f"{request.url} was not loaded"))
    page.set_viewport_size({"width": width, "height": 900})

    for path in sorted(report.rglob("*.html")):
        page.goto(path.as_uri())
        page.wait_for_function("document.readyState === 'complete'")
        assert page.evaluate("document.documentElement.scrollWidth") <= width, path.name

    assert errors == []


def test_the_table_of_all_cases_filters_by_text_and_verdict(report: Path, page: Page) -> None:
    page.goto((report / "index.html").as_uri())
    assert shown(page) == ["beta", "gamma", "alpha"]

    page.get_by_label("Show cases with").fill("alph <B>")
    assert shown(page) == ["alpha"]
    assert page.locator("#filter-count").inner_text() == "1 of 3 shown"

    page.get_by_label("Show cases with").fill("")
    page.get_by_label("and verdict").select_option("not run")
    assert shown(page) == ["gamma"]
    page.get_by_label("and verdict").select_option("fail")
    assert shown(page) == ["beta"]


def test_the_table_of_all_cases_sorts_by_keyboard_and_says_so(report: Path, page: Page) -> None:
    page.goto((report / "index.html").as_uri())
    case, time = page.locator("#all-cases th[data-sort]").first, page.locator("#all-cases th[data-sort]").nth(7)
    assert case.get_attribute("aria-sort") == "none"

    case.get_by_role("button").focus()
    page.keyboard.press("Enter")
    assert shown(page) == ["alpha", "beta", "gamma"]
    assert case.get_attribute("aria-sort") == "ascending"
    page.keyboard.press("Enter")
    assert shown(page) == ["gamma", "beta", "alpha"]
    assert case.get_attribute("aria-sort") == "descending"

    time.get_by_role("button").click()
    assert shown(page)[:2] == ["alpha", "beta"]  # seconds of the rod model; the one that was not run comes last
    time.get_by_role("button").click()
    assert shown(page) == ["beta", "alpha", "gamma"]
    assert case.get_attribute("aria-sort") == "none"


def test_without_scripts_the_table_is_plain_and_pages_say_what_is_missing(report: Path, browser: Browser) -> None:
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()

    page.goto((report / "index.html").as_uri())
    assert shown(page) == ["beta", "gamma", "alpha"]
    assert not page.locator("#filter").is_visible()
    assert page.locator("#all-cases button").count() == 0

    page.get_by_role("link", name="Alpha <b>").click()
    missing = page.locator("noscript p").all()
    assert len(missing) == 2
    assert all(each.is_visible() and "scripts are switched off" in each.inner_text() for each in missing)
    assert page.get_by_role("img", name="3D picture of the deformed rods").is_visible()
    context.close()


def test_the_3d_view_draws_both_models_alike_and_turns_them_together(report: Path, page: Page) -> None:
    page.goto((report / "cases" / "alpha.html").as_uri())
    page.wait_for_selector("#turning[data-drawn='2']")

    stress = seen(page)
    page.get_by_role("radio", name="contact pressure").check()
    pressure = seen(page, unlike=stress)
    page.get_by_role("button", name="Turn right").press("Enter")
    turned = seen(page, unlike=pressure)

    left, right = np.array_split(stress, 2, axis=1)
    for half in (left, right):
        # red where rods are pulled and blue where they are pressed, on white
        red, _, blue = (half[..., channel].astype(int) for channel in range(3))
        assert (red - blue > 60).sum() > 200
        assert (blue - red > 60).sum() > 200
    assert differ(stress, pressure)
    assert differ(pressure, turned)
    cameras = page.evaluate(
        "['scene', 'scene2'].map((each) => document.getElementById('turning')._fullLayout[each].camera.eye)"
    )
    assert cameras[0] == pytest.approx(cameras[1])


def seen(page: Page, unlike: np.ndarray | None = None) -> np.ndarray:
    """What the view shows above its scale of colours once it rests, shape (height, width, 3).

    unlike : what it showed before; it is given half a minute to change
    """
    last = np.empty(0)
    for _ in range(100):
        png = page.locator("#turning").screenshot()
        picture = np.asarray(Image.open(io.BytesIO(png)).convert("RGB"))[60:390]
        if np.array_equal(last, picture) and (unlike is None or differ(unlike, picture)):
            return picture
        last = picture
        page.wait_for_timeout(300)
    return last


def differ(one: np.ndarray, other: np.ndarray) -> bool:
    return bool((one != other).any(axis=2).mean() > 0.005)
