#!/usr/bin/env python3
"""Opens the report pages of fit_shape and fit_gabor in headless Chromium and turns their surfaces.

    report_page_test.py FOLDER_OF_PROGRAMS SHAPE PHOTO [--keep FOLDER]

--keep leaves the pages and a screenshot of each in a folder. Exit status 77 says that selenium, Chromium or a file
is missing, so that nothing was tested.
"""

import argparse
import io
import pathlib
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
try:
    import numpy
    from PIL import Image
    from selenium import webdriver
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
except ImportError as error:
    print(f"skipped: {error.name} is missing (scripts/setup.sh --browser)")
    sys.exit(SKIPPED)


def browser(scripts=True):
    options = webdriver.ChromeOptions()
    for argument in (
        "--headless=new",
        "--no-sandbox",
        "--disable-dev-shm-usage",
        "--window-size=1100,1400",
        "--use-angle=swiftshader",  # WebGL without a GPU
        "--enable-unsafe-swiftshader",
    ):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    if not scripts:
        options.add_experimental_option("prefs", {"profile.managed_default_content_settings.javascript": 2})
    return webdriver.Chrome(options=options)


def halves(driver):
    """The left and right half of the canvas as arrays of grey values."""
    canvas = driver.find_element(By.CSS_SELECTOR, ".turnable .canvas")
    driver.execute_script("return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    picture = numpy.asarray(Image.open(io.BytesIO(canvas.screenshot_as_png)).convert("L"), dtype=float)
    middle = picture.shape[1] // 2
    return picture[:, :middle], picture[:, middle:]


def seen_share(picture):
    """The share of pixels that differ from the background, which is the colour of the corner."""
    return numpy.mean(abs(picture - picture[2, 2]) > 12)


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def check_turns(driver):
    before = halves(driver)
    for name, half in zip(("left", "right"), before):
        check(0.03 < seen_share(half) < 0.95, f"the {name} surface fills {seen_share(half):.1%} of its half")
    canvas = driver.find_element(By.CSS_SELECTOR, ".turnable .canvas")
    ActionChains(driver).move_to_element(canvas).click_and_hold().move_by_offset(160, 40).release().perform()
    after = halves(driver)
    changed = [numpy.mean(abs(a - b) > 12) for a, b in zip(before, after)]
    check(min(changed) > 0.02, f"a drag changes {changed} of the halves")
    # Both are seen from the same side: their outlines differ by little.
    outlines = [abs(half - half[2, 2]) > 12 for half in after]
    width = min(outline.shape[1] for outline in outlines)
    differing = numpy.mean(outlines[0][:, :width] != outlines[1][:, :width])
    check(differing < 0.1, f"the outlines of both differ in {differing:.1%} of the pixels after the drag")


def check_slider(driver):
    driver.find_element(By.CSS_SELECTOR, ".turnable .overlaid").click()
    slider = driver.find_element(By.CSS_SELECTOR, ".turnable .slider")
    check(slider.is_displayed(), "the slider is hidden")
    pictures = []
    for value in (0, 100):
        driver.execute_script(
            "arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'))", slider, value
        )
        pictures.append(numpy.hstack(halves(driver)))
    check(numpy.any(abs(pictures[0] - pictures[1]) > 12), "the slider changes nothing")
    driver.find_element(By.CSS_SELECTOR, ".turnable .overlaid").click()


def check_page(page, keep):
    driver = browser()
    try:
        driver.get(page.as_uri())
        if keep:
            driver.save_screenshot(str(keep / f"{page.parent.name}.png"))
        check_turns(driver)
        check_slider(driver)
        errors = [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]
        check(not errors, f"the browser says: {errors}")
        requests = [entry for entry in driver.get_log("performance") if '"url":"http' in entry["message"]]
        check(not requests, "the page asks the network for something")
    finally:
        driver.quit()
    driver = browser(scripts=False)
    try:
        driver.get(page.as_uri())
        check(not driver.find_element(By.CSS_SELECTOR, ".turnable").is_displayed(), "a figure without its script")
        for picture in driver.find_elements(By.TAG_NAME, "img"):
            check(int(picture.get_property("naturalWidth")) > 0, "a picture is missing without scripts")
    finally:
        driver.quit()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("shape", type=pathlib.Path)
    parser.add_argument("photo", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path)
    arguments = parser.parse_args()
    for needed in (arguments.shape, arguments.photo):
        if not needed.exists():
            print(f"skipped: {needed} is missing")
            return SKIPPED
    if not shutil.which("chromedriver"):
        print("skipped: chromedriver is missing (scripts/setup.sh --browser)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        fits = {
            "shape": ["fit_shape", arguments.shape, "--spheres", "10", "--base-only"],
            "photo": ["fit_gabor", arguments.photo],
        }
        for name, (program, *options) in fits.items():
            command = [arguments.programs / program, *options, "-o", folder / f"{name}.json", "--report", folder / name]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            check_page((folder / name / "index.html").resolve(), arguments.keep)
            print(f"{name}: both surfaces are seen and turned, the slider works, no network, readable without scripts")
    return 0


if __name__ == "__main__":
    sys.exit(main())
