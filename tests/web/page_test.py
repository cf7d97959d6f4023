#!/usr/bin/env python3
"""Opens the page that makes bodies in headless Chromium and works it as a user does.

    page_test.py PAGE SYNTH

Exit status 77 says that selenium or Chromium is missing, so that nothing was tested.
"""

import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
try:
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError as error:
    print(f"skipped: {error.name} is missing (scripts/setup.sh --browser)")
    sys.exit(SKIPPED)

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
CELLS = 48


def browser(width=1300, height=900):
    options = webdriver.ChromeOptions()
    # ANGLE's swiftshader is WebGL without a GPU.
    for argument in ("headless=new", "no-sandbox", "disable-dev-shm-usage", f"window-size={width},{height}",
                     "use-angle=swiftshader", "enable-unsafe-swiftshader"):  # fmt: skip
        options.add_argument(f"--{argument}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options)
    driver.set_script_timeout(120)
    return driver


def check(condition, what):
    if not condition:
        raise AssertionError(what)


class Page:
    def __init__(self, driver, address):
        self.driver = driver
        driver.get(address)
        self.wait(lambda: self.script("return document.body.dataset.ready === 'yes'"))

    def script(self, code, *arguments):
        return self.driver.execute_script(code, *arguments)

    def wait(self, happened, seconds=60):
        end = time.monotonic() + seconds
        while not happened():
            check(time.monotonic() < end, "the page takes too long")
            time.sleep(0.05)

    def settled(self):
        self.driver.execute_async_script("const done = arguments[0]; window.astrolith.settled().then(done)")

    def open(self, text, name):
        self.driver.execute_async_script(
            "const [text, name, done] = arguments; window.astrolith.openText(text, name).then(done)", text, name
        )
        self.settled()

    def mesh_hash(self):
        return self.driver.execute_async_script(
            "const done = arguments[0]; window.astrolith.meshFile('ply').then(file => done(file.sha256), error => done(String(error)))"
        )

    def recipe_hash(self):
        return self.driver.execute_async_script(
            "const done = arguments[0]; window.astrolith.recipeFile('astro').then(file => done(file.sha256), error => done(String(error)))"
        )

    def set_cells(self, cells):
        self.script("window.astrolith.setCells(arguments[0])", cells)
        self.settled()

    def text(self, element):
        return self.driver.find_element(By.ID, element).text

    def recipe(self):
        return json.loads(self.script("return window.astrolith.recipeText()"))

    def show_tab(self, name):
        self.script("document.getElementById(arguments[0]).click()", f"tab-{name}")

    def set_value(self, element, value):
        self.script("const [id, value] = arguments, e = document.getElementById(id); e.value = value;"
                    "e.dispatchEvent(new Event('input', {bubbles: true})); e.dispatchEvent(new Event('change', {bubbles: true}))",
                    element, value)  # fmt: skip

    def input(self, label, kind="range"):
        """The control of a field in the form of all fields."""
        element = f'#form input[type="{kind}"][aria-label="{label}"]'
        return self.driver.find_element(By.CSS_SELECTOR, element)

    def slide(self, label, value):
        self.script(
            "arguments[0].value = arguments[1]; arguments[0].dispatchEvent(new Event('input'));"
            "arguments[0].dispatchEvent(new Event('change'))", self.input(label), value)  # fmt: skip
        self.settled()


class Synth:
    def __init__(self, program):
        self.program = str(program.resolve())

    def run(self, text, name, cells=CELLS):
        """The hash of synth's mesh and its message."""
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / name).write_bytes(text if isinstance(text, bytes) else text.encode())
            command = [self.program, name, "-o", "mesh.ply", "--resolution", str(cells), "--quiet"]
            ran = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            mesh = pathlib.Path(folder) / "mesh.ply"
            digits = hashlib.sha256(mesh.read_bytes()).hexdigest() if mesh.exists() else ""
            return digits, ran.stderr.strip().removeprefix("synth: ")


    def draw(self, seed, *conditions):
        """The hashes of the mesh and of the compact recipe that synth draws."""
        with tempfile.TemporaryDirectory() as folder:
            files = [pathlib.Path(folder) / name for name in ("mesh.ply", "new.astro")]
            subprocess.run([self.program, "asteroids", "--seed", str(seed), *conditions, "-o", files[0], "--write-recipe", files[1],
                            "--resolution", str(CELLS), "--quiet"], check=True)  # fmt: skip
            return [hashlib.sha256(file.read_bytes()).hexdigest() for file in files]


def example(name):
    return (ROOT / "synthesis/examples" / name).read_text()


def check_slider(page, synth):
    page.show_tab("fields")
    page.open(example("fractal_hills.json"), "fractal_hills.json")
    page.set_cells(CELLS)
    before = page.mesh_hash()
    check(before == synth.run(page.script("return window.astrolith.recipeText()"), "fractal_hills.json")[0], "the mesh is not synth's")
    label = next(
        slider.get_attribute("aria-label")
        for slider in page.driver.find_elements(By.CSS_SELECTOR, "#form input[type=range]")
        if slider.get_attribute("aria-label").startswith("layers[0].amplitude")
    )
    page.slide(label, 330)
    after = page.mesh_hash()
    check(after != before, "a slider changes nothing")
    check(after == synth.run(page.script("return window.astrolith.recipeText()"), "fractal_hills.json")[0], "the changed mesh is not synth's")
    page.driver.find_element(By.ID, "undo").click()
    page.settled()
    check(page.mesh_hash() == before, "undo does not bring the mesh back")


def check_wall(page):
    """The page opens on bodies, each of which is one press away."""
    check(page.script("return document.body.dataset.shows") == "wall", "the page does not open on the wall")
    bodies = page.driver.find_elements(By.CSS_SELECTOR, ".bodies button")
    check(len(bodies) == 20, f"{len(bodies)} bodies are on the wall")
    bodies[0].click()
    page.wait(lambda: "triangles" in page.script("return document.getElementById('figures').textContent"))
    page.settled()
    check(page.recipe()["description"].startswith("25143 Itokawa"), "the first body of the wall is not Itokawa")


def check_library(page, synth):
    """A measured body of the list is the one of synth's library, and so is the command for the desktop."""
    page.set_value("examples", "ky26")
    page.wait(lambda: page.recipe().get("description", "").startswith("1998 KY26"))
    page.set_cells(CELLS)
    check(page.mesh_hash() == synth.run((ROOT / "library/ky26.astro").read_bytes(), "ky26.astro")[0], "the body is not synth's")
    page.show_tab("save")
    page.wait(lambda: page.text("command") == f"synth ky26 -o ky26.glb --resolution {CELLS}", 5)


def check_command(page, synth):
    """The command of a body that the library has not makes the page's mesh."""
    page.show_tab("save")
    page.wait(lambda: "base64 -d" in page.text("command"), 10)
    with tempfile.TemporaryDirectory() as folder:
        command = page.text("command").replace("\nsynth ", f"\n{synth.program} --quiet ").replace(".glb", ".ply")
        subprocess.run(["bash", "-c", command], cwd=folder, check=True)
        mesh = next(pathlib.Path(folder).glob("*.ply"))
        check(hashlib.sha256(mesh.read_bytes()).hexdigest() == page.mesh_hash(), "the command makes another mesh")


def check_knobs(page, synth):
    """A knob moves the recipe, its mesh is synth's, and undo takes it back at once."""
    page.open(example("fractal_hills.json"), "fractal_hills.json")
    page.set_cells(32)
    before = page.recipe()
    for knob, value in (("craters", 100), ("boulders", 80), ("size", 120), ("lobes", 1)):
        page.set_value(f"knob-{knob}", value)
    page.settled()
    made = page.recipe()
    check([layer["type"] for layer in made["layers"][-2:]] == ["craters", "boulders"], "the knobs add no landforms")
    check(page.mesh_hash() == synth.run(page.script("return window.astrolith.recipeText()"), "fractal_hills.json", 32)[0], "the knobs' mesh is not synth's")
    check_command(page, synth)
    for _ in range(4):
        page.driver.find_element(By.ID, "undo").click()
    page.settled()
    check(page.recipe() == before, "undo does not take the knobs back")


def check_values(page):
    """Slopes, heights, albedo and layers are shown as colours."""
    for values in ("slope", "height", "label"):
        page.set_value("values", values)
        page.settled()
        check(page.text("refusal") == "", f"{values}: {page.text('refusal')}")
    page.set_value("values", "")
    page.settled()


def check_images(page, synth):
    """A recipe is opened together with the image that it names; without it, the page says what is missing."""
    with tempfile.TemporaryDirectory() as folder:
        recipe = pathlib.Path(folder) / "body.json"
        subprocess.run([synth.program, "ky26", "--write-recipe", recipe, "--quiet"], check=True)
        image = next(pathlib.Path(folder).glob("*.png"))
        page.driver.find_element(By.ID, "file").send_keys(str(recipe))
        page.wait(lambda: "is a file beside the recipe" in page.text("refusal"))
        page.driver.find_element(By.ID, "file").send_keys(f"{recipe}\n{image}")
        page.wait(lambda: page.text("refusal") == "" and '"heights"' in page.script("return window.astrolith.recipeText()"))
        page.set_cells(CELLS)
        page_mesh = page.mesh_hash()
        other = pathlib.Path(folder) / "other.png"
        other.write_bytes(b"no PNG")
        page.driver.find_element(By.ID, "file").send_keys(str(recipe))
        page.wait(lambda: "is a file beside the recipe" in page.text("refusal"))
        page.driver.find_element(By.ID, "file").send_keys(f"{recipe}\n{image}\n{other}")
        page.wait(lambda: page.text("refusal") == "" and '"heights"' in page.script("return window.astrolith.recipeText()"))
        page.settled()
        mesh = pathlib.Path(folder) / "mesh.ply"
        subprocess.run([synth.program, recipe, "-o", mesh, "--resolution", str(CELLS), "--quiet"], check=True)
        digits = hashlib.sha256(mesh.read_bytes()).hexdigest()
        check(page_mesh == digits == page.mesh_hash(), "a recipe with its image makes another mesh")


def check_draw(page, synth):
    """A body that is drawn on the page is the one that synth draws; each press takes the next seed."""
    page.show_tab("knobs")
    page.script("document.querySelector('.more').open = true")
    for element, value in (("draw-class", "top"), ("draw-diameter", 330), ("draw-seed", 7), ("draw-ground", "measured")):
        page.set_value(element, value)
    button = page.driver.find_element(By.CSS_SELECTOR, "#draw button")
    button.click()
    page.wait(lambda: page.recipe().get("seed") == 7, 120)
    words = page.text("drawn")
    check(words.startswith(page.recipe()["description"]) and "diameter 330 m" in words, f"the page says of its body {words!r}")
    page.settled()
    page.set_cells(CELLS)
    mesh, recipe = synth.draw(7, "--class", "top", "--diameter", "330")
    check(page.recipe_hash() == recipe, "the drawn recipe is not synth's")
    check(page.mesh_hash() == mesh, "the drawn mesh is not synth's")
    page.set_value("draw-ground", "knobs")
    button.click()
    page.wait(lambda: page.recipe().get("seed") == 8, 120)
    page.settled()
    layers = [layer["type"] for layer in page.recipe()["layers"]]
    check(layers == ["simplex", "craters", "boulders"], f"a new asteroid has the layers {layers}")
    text = page.script("return window.astrolith.recipeText()")
    check(page.mesh_hash() == synth.run(text, "asteroid_8.json")[0], "the new asteroid's mesh is not synth's")
    before = page.recipe()
    page.set_value("draw-b", 0.9)
    button.click()
    page.wait(lambda: "population.draw.axes: give b/a and c/a" in page.text("refusal"))
    page.set_value("draw-c", 0.1)
    button.click()
    page.wait(lambda: "asteroids: population.draw.axes: have a ratio of 10;" in page.text("refusal"), 120)
    check(page.recipe() == before, "a draw that is refused replaces the recipe")
    seed = page.script("return document.getElementById('draw-seed').value")
    check(seed == "8", f"of two refusals, one by the core, the seed became {seed}")
    page.open(example("fractal_hills.json"), "fractal_hills.json")
    check(page.text("drawn") == "", "the words about a drawn body stay with another")
    page.set_value("draw-b", "")
    page.set_value("draw-c", "")


def check_layers(page):
    """A layer is added by the keyboard, switched off and removed."""
    page.show_tab("fields")
    count = len(page.recipe()["layers"])
    choice = page.driver.find_element(By.CSS_SELECTOR, '#form select[aria-label="kind to add to layers"]')
    choice.send_keys("worley")
    check(len(page.recipe()["layers"]) == count, "the choice of a kind adds a layer before it is asked to")
    page.driver.find_element(By.CSS_SELECTOR, '#form button[aria-label="add to layers"]').send_keys(Keys.ENTER)
    page.settled()
    layers = page.recipe()["layers"]
    check(len(layers) == count + 1 and layers[-1]["type"] == "worley", f"no layer was added: {layers}")
    with_layer = page.mesh_hash()
    page.driver.find_element(By.CSS_SELECTOR, f'#form input[aria-label="layers[{count}] on"]').send_keys(Keys.SPACE)
    page.settled()
    check(len(page.recipe()["layers"]) == count, "a layer that is off is in the recipe")
    check(page.mesh_hash() != with_layer, "a layer that is off changes the mesh")
    page.driver.find_element(By.CSS_SELECTOR, f'#form button[aria-label="move layers[{count}] up"]').send_keys(Keys.ENTER)
    focus = page.script("return document.activeElement.getAttribute('aria-label')")
    check(focus in (f"move layers[{count - 1}] up", f"move layers[{count - 1}] down"), f"after a move the focus is on {focus!r}")


def check_refusal(page, synth):
    text = example("fractal_hills.json")
    page.open(text, "fractal_hills.json")
    box = page.input("layers[0].frequency", "text")
    box.clear()
    box.send_keys("-3" + Keys.TAB)
    page.settled()
    message = synth.run(page.script("return window.astrolith.recipeText()"), "fractal_hills.json")[1]
    check(message != "", "synth takes a negative frequency")
    check(page.text("refusal") == message, f"the page says {page.text('refusal')!r}, synth says {message!r}")
    beside = page.driver.find_element(By.CSS_SELECTOR, "#form .refused .refusal")
    field = beside.find_element(By.XPATH, "..").text
    check("frequency" in field, f"the refusal stands beside {field!r}")
    check(message in page.mesh_hash(), "of a refused recipe a mesh is saved")


def check_bad_files(page, synth):
    """What is no recipe is refused in the words of synth, and the recipe before it stays."""
    page.open(example("fractal_hills.json"), "fractal_hills.json")
    before = page.recipe()
    unlike = ('{"layers": 5}', '{"layers": [null]}', '{"seed": 1, "seed": 2}', '{"seed": 1e400}', "[" * 5000)
    for text in (example("kernels.json")[:700], *unlike):
        page.open(text, "bad.json")
        message = synth.run(text, "bad.json")[1]
        said = page.text("refusal")
        check(said == message != "", f"of {text[:20]} the page says {said!r}, synth says {message!r}")
        check(page.recipe() == before, f"{text[:20]} replaces the recipe")


def check_two_files(page):
    """Of two files that are opened at once the later one stays."""
    page.driver.execute_async_script(
        "const [older, newer, done] = arguments, open = window.astrolith.openText;"
        "Promise.all([open(older, 'older.json'), open(newer, 'newer.json')]).then(done)",
        example("kernels.json"), example("fractal_hills.json"))  # fmt: skip
    check(page.recipe() == json.loads(example("fractal_hills.json")), "the older of two files is open")


def check_damaged_link(driver, address):
    for code in ("%25%25", "QVNUAQ"):
        driver.get("about:blank")
        page = Page(driver, f"{address}#r={code}")
        page.settled()
        page.wait(lambda: page.text("refusal") != "", 20)
        page.driver.find_element(By.CSS_SELECTOR, ".bodies button").click()
        page.wait(lambda: "triangles" in page.text("figures"), 60)


def check_link(page, address):
    page.open(example("kernels.json"), "kernels.json")
    page.set_cells(32)
    link = page.driver.execute_async_script("const done = arguments[0]; window.astrolith.link().then(done)")
    before = page.mesh_hash()
    page.driver.get("about:blank")
    again = Page(page.driver, link)
    again.settled()
    again.set_cells(32)
    check(again.mesh_hash() == before, "a link makes another body")
    check(link.startswith(address), f"a link leads elsewhere: {link[:80]}")


def check_own_page(driver, synth, file):
    """synth --page writes a page that opens with its recipe."""
    with tempfile.TemporaryDirectory() as folder:
        recipe = ROOT / "synthesis/examples/kernels.json"
        subprocess.run([synth.program, str(recipe), "--seed", "7", "--page", folder, "--quiet"], check=True,
                       env={**os.environ, "ASTROLITH_PAGE": str(file.resolve())})  # fmt: skip
        page = Page(driver, (pathlib.Path(folder) / "index.html").as_uri())
        page.settled()
        check(page.recipe()["seed"] == 7, "a page of synth opens another recipe")


def check_reload(page):
    """What was edited is there again when the page is loaded anew."""
    page.open(example("kernels.json"), "kernels.json")
    page.set_cells(32)
    page.set_value("knob-craters", 90)
    page.settled()
    before = page.recipe()
    time.sleep(0.5)
    page.driver.refresh()
    page.wait(lambda: page.script("return window.astrolith && window.astrolith.recipeText() !== null"), 20)
    check(page.recipe() == before, "edits vanish when the page is loaded anew")


def check_mesh_beside(page, synth):
    """A mesh is shown beside the body, with the command that fits it."""
    with tempfile.TemporaryDirectory() as folder:
        mesh = pathlib.Path(folder) / "rock.ply"
        subprocess.run([synth.program, str(ROOT / "synthesis/examples/kernels.json"), "-o", mesh, "--resolution", "24", "--quiet"], check=True)
        page.driver.find_element(By.ID, "file").send_keys(str(mesh))
        page.wait(lambda: "fit_shape rock.ply -o rock.json" in page.text("beside"), 20)
    check(page.text("refusal") == "", f"a mesh is refused: {page.text('refusal')!r}")
    page.script("[...document.querySelectorAll('#beside button')].at(-1).click()")
    check(page.text("beside") == "", "the mesh beside stays")


def check_quiet(driver):
    errors = [entry["message"] for entry in driver.get_log("browser") if entry["level"] == "SEVERE"]
    check(not errors, f"the browser says: {errors}")
    requests = [entry for entry in driver.get_log("performance") if '"url":"http' in entry["message"]]
    check(not requests, "the page asks the network for something")


def check_phone(address):
    driver = browser(500, 900)
    try:
        page = Page(driver, address)
        check_wall(page)
        check(page.script("return document.documentElement.scrollWidth <= innerWidth"), "the page is wider than a phone")
        check_quiet(driver)
    finally:
        driver.quit()


def main():
    file, program = map(pathlib.Path, sys.argv[1:])
    if not shutil.which("chromedriver"):
        print("skipped: chromedriver is missing (scripts/setup.sh --browser)")
        return SKIPPED
    address, synth = file.resolve().as_uri(), Synth(program)
    driver = browser()
    try:
        page = Page(driver, address)
        check_wall(page)
        check_slider(page, synth)
        check_library(page, synth)
        check_knobs(page, synth)
        check_values(page)
        check_mesh_beside(page, synth)
        check_images(page, synth)
        check_draw(page, synth)
        check_layers(page)
        check_refusal(page, synth)
        check_bad_files(page, synth)
        check_two_files(page)
        check_link(page, address)
        check_reload(page)
        check_damaged_link(driver, address)
        check_own_page(driver, synth, file)
        check_quiet(driver)
    finally:
        driver.quit()
    check_phone(address)
    print("page: wall, knobs, slider, values, measured bodies, draws, layers, undo, refusals and links work, meshes are synth's, no errors, no network")
    return 0


if __name__ == "__main__":
    sys.exit(main())
