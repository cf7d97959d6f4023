#!/usr/bin/env python3
"""Measures the page in headless Chromium: pictures, knobs, blocks of its thread, accessibility, and random use.

    page_figures.py PAGE [--axe axe.min.js] [--rows first,knobs,blocks,axe,random] [--seeds 10] [--steps 500]

axe.min.js lies in PyPI's axe-playwright-python: pip download --no-deps axe-playwright-python, then unzip. Seconds are those of
the clock, so that they mean something on idle cores only.
"""

import argparse
import gzip
import pathlib
import sys
import time

from page_test import Page, browser, example

PHONE = {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True}
# Every error that reaches the window, and how long the page's thread was blocked.
WATCH = """
  window.seen = {errors: [], longest: 0, marks: []};
  addEventListener("error", event => seen.errors.push(event.message));
  addEventListener("unhandledrejection", event => seen.errors.push(String(event.reason && event.reason.message || event.reason)));
  new PerformanceObserver(list => list.getEntries().forEach(entry => { seen.longest = Math.max(seen.longest, entry.duration); }))
    .observe({type: "longtask", buffered: true});
  new PerformanceObserver(list => seen.marks.push(...list.getEntries().filter(({name}) => name === "picture")
    .map(({startTime, detail}) => [startTime, detail]))).observe({type: "mark", buffered: true});
"""


def opened(address, width=1300, height=900, phone=False, scheme="dark"):
    driver = browser(width, height)
    driver.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": WATCH})
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
    if phone:
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", PHONE)
        driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True})
    return Page(driver, address)


def picture_after(page, act, cells, seconds=60):
    """Milliseconds from an act, a script, to the first picture of so many cells."""
    start = page.script(f"seen.marks = []; const start = performance.now(); {act}; return start")
    found = lambda: page.script("return seen.marks.find(([, cells]) => cells === arguments[0])", cells)  # noqa: E731
    page.wait(lambda: found() is not None, seconds)
    return found()[0] - start


def row(words, figure):
    print(f"{words}: {figure}", flush=True)


def first(address, options):
    page = opened(address)
    paint = page.script("return performance.getEntriesByType('paint').map(({name, startTime}) => [name, startTime])")
    ready = page.script("return performance.now()")
    row("wall is painted", f"{dict(paint).get('first-contentful-paint', 0):.0f} ms after the page is asked for, ready before {ready:.0f} ms")
    page.driver.quit()
    for name in ("itokawa", "new_top", "rubble_pile"):
        page = opened(address)
        act = f"document.querySelector('[data-name={name}]').click()"
        coarse = picture_after(page, act, 32)
        fine = page.script("return seen.marks[0][0]")
        page.wait(lambda: page.script("return seen.marks.some(([, cells]) => cells === 128)"))  # noqa: B023
        fine = page.script("return seen.marks.find(([, cells]) => cells === 128)[0] - seen.marks[0][0]")
        row(f"{name}: 32 cells, 128 cells after a press", f"{coarse:.0f} ms, {coarse + fine:.0f} ms")
        page.driver.quit()
    page = opened(address)
    time.sleep(options.rest)
    coarse = picture_after(page, "document.getElementById('first-new').click()", 32)
    page.wait(lambda: page.script("return seen.marks.some(([, cells]) => cells === 128)"))
    fine = page.script("return seen.marks.find(([, cells]) => cells === 128)[0] - seen.marks[0][0]")
    row(f"new asteroid: 32 cells, 128 cells after a press, {options.rest:g} s after the start", f"{coarse:.0f} ms, {coarse + fine:.0f} ms")
    page.driver.quit()


def knobs(address, options):
    page = opened(address)

    def turn(knob, value):
        act = f"const k = document.getElementById('knob-{knob}'); k.value = {value}; k.dispatchEvent(new Event('input'))"
        return picture_after(page, act, 32)

    for name in ("fractal_hills", "itokawa", "new_top"):
        page.driver.execute_async_script("const [name, done] = arguments; window.astrolith.openNamed(name).then(done)", name)
        page.settled()
        for knob in ("roughness", "craters", "boulders"):
            turn(knob, 90)
        times = [turn(knob, value) for knob in ("roughness", "craters", "boulders", "dust", "albedo") for value in (60, 110)]
        times.sort()
        row(f"knob to picture of 32 cells, {name}", f"median {times[len(times) // 2]:.0f} ms, {times[0]:.0f} to {times[-1]:.0f} ms")
    page.driver.quit()


ACTS = """
  const [seed, steps, done] = arguments;
  let state = seed;
  const next = () => { state = (Math.imul(state, 1664525) + 1013904223) >>> 0; return state / 2 ** 32; };
  const pick = list => list[Math.floor(next() * list.length)];
  // Not what leaves the page: downloads and the choice of files.
  const shown = () => [...document.querySelectorAll("button, select, summary, input, canvas[tabindex]")]
    .filter(e => e.offsetParent !== null && !e.disabled && e.type !== "file" && !e.dataset.save);
  const keys = ["ArrowLeft", "ArrowRight", "ArrowUp", "+", "-", "Enter", " ", "Tab", "Escape", "z"];
  function act() {
    const e = pick(shown());
    if (!e) return;
    if (next() < 0.25) return void e.dispatchEvent(new KeyboardEvent("keydown", {key: pick(keys), bubbles: true, ctrlKey: next() < 0.2}));
    if (e.tagName === "SELECT") {
      e.value = pick([...e.options]).value;
      return void e.dispatchEvent(new Event("change", {bubbles: true}));
    }
    if (e.tagName === "INPUT" && e.type !== "checkbox") {
      e.value = e.type === "range" ? Number(e.min) + next() * (e.max - e.min) : pick(["0", "1", "7.5", "-3", "x", "1e9"]);
      e.dispatchEvent(new Event("input", {bubbles: true}));
      return void e.dispatchEvent(new Event("change", {bubbles: true}));
    }
    e.click();
  }
  let count = 0;
  const step = () => {
    try { act(); } catch (error) { seen.errors.push(String(error.stack)); }
    ++count < steps ? setTimeout(step, 20) : done(count);
  };
  step();
"""


def random_use(page, seed, steps):
    """Clicks and keys by chance, and then a press on a body, which must come."""
    page.driver.set_script_timeout(300)
    page.driver.execute_async_script(ACTS, seed, steps)
    page.script("document.getElementById('home').click()")
    page.set_value("values", "")
    page.set_value("resolution", "64")
    page.wait(lambda: page.script("return document.body.dataset.shows") == "wall", 10)
    picture_after(page, "document.querySelector('[data-name=itokawa]').click()", 64, 120)
    return page.script("return seen.errors")


def random_sessions(address, options):
    failed = 0
    for seed in range(1, options.seeds + 1):
        page = opened(address)
        errors = random_use(page, seed, options.steps)
        failed += bool(errors)
        if errors:
            print(f"seed {seed}: {errors[:3]}")
        page.driver.quit()
    row(f"{options.seeds} sessions of {options.steps} clicks and keys, with errors or dead", failed)


def blocks(address, options):
    page = opened(address)
    page.script("seen.longest = 0")
    random_use(page, 5, 60)
    row("longest block of the page's thread in 60 clicks (0: below 50 ms)", f"{page.script('return seen.longest'):.0f} ms")
    page.driver.quit()


def axe_findings(page, script):
    page.script(script)
    found = page.driver.execute_async_script("const done = arguments[0]; axe.run().then(result => done(result.violations))")
    return [
        f"{one['id']} ({one['impact']}): {one['nodes'][0]['html'][:90]}" for one in found if one["impact"] in ("serious", "critical")
    ]


def axe(address, options):
    if options.axe is None:
        return row("axe-core", "not measured: give --axe")
    script, findings = options.axe.read_text(), []
    for scheme, phone in (("dark", False), ("light", False), ("dark", True)):
        page = opened(address, scheme=scheme, phone=phone)
        findings += [f"wall, {scheme}: {words}" for words in axe_findings(page, script)]
        page.open(example("boulders.json"), "boulders.json")
        for tab in ("knobs", "fields", "save"):
            page.show_tab(tab)
            findings += [f"{tab}, {scheme}{', phone' * phone}: {words}" for words in axe_findings(page, script)]
        page.driver.quit()
    for words in findings:
        print("  " + words)
    row("axe-core, serious and critical findings on four screens in three looks", len(findings))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--axe", type=pathlib.Path)
    parser.add_argument("--rows", default="size,first,knobs,blocks,axe,random")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--rest", type=float, default=8)
    options = parser.parse_args()
    address = options.page.resolve().as_uri()
    measured = {"first": first, "knobs": knobs, "blocks": blocks, "axe": axe, "random": random_sessions,
                "size": lambda *_: row("page, compressed", f"{len(gzip.compress(options.page.read_bytes(), 9)) / 1e6:.2f} MB")}  # fmt: skip
    for name in options.rows.split(","):
        measured[name](address, options)


if __name__ == "__main__":
    sys.exit(main())
