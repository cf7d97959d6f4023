#!/usr/bin/env python3
"""Opens the report pages of fit_shape and fit_gabor in headless Chromium and turns their surfaces.

    report_page_test.py FOLDER_OF_PROGRAMS SHAPE PHOTO

Exit status 77 says that selenium, Chromium or a file is missing, so that nothing was tested.
"""

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
    # ANGLE's swiftshader is WebGL without a GPU.
    for argument in ("headless=new", "no-sandbox", "disable-dev-shm-usage", "window-size=1100,1400", "use-angle=swiftshader",
                     "enable-unsafe-swiftshader"):  # fmt: skip
        options.add_argument(f"--{argument}")
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


def check_page(page):
    driver = browser()
    try:
        driver.get(page.as_uri())
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
    programs, shape, photo = map(pathlib.Path, sys.argv[1:])
    if not (shape.exists() and photo.exists() and shutil.which("chromedriver")):
        print(f"skipped: {shape}, {photo} or chromedriver is missing (scripts/setup.sh --browser)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name, line in (("shape", ["fit_shape", shape, "--spheres", "10", "--base-only"]), ("photo", ["fit_gabor", photo])):
            command = [programs / line[0], *line[1:], "-o", folder / f"{name}.json", "--report", folder / name]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            check_page((folder / name / "index.html").resolve())
            print(f"{name}: both surfaces are seen and turned, the slider works, no network, readable without scripts")
    return 0


if __name__ == "__main__":
    sys.exit(main())
