"""Long work: progress, Ctrl-C, threads and memory."""

import os
import signal
import subprocess
import sys
import threading
import time

import astrolith
import numpy as np
import pytest

BALL = {"format_version": 1, "length_unit": "m", "body": {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0.0, 0.0, 0.0, 1.0]]}}


def interrupted_after(seconds, work):
    """Runs the work, presses Ctrl-C, and returns the seconds from then to KeyboardInterrupt."""
    pressed = []

    def press():
        pressed.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(seconds, press)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        work()
    took = time.monotonic() - pressed[0]
    timer.join()
    return took


def test_ctrl_c_ends_a_mesh_and_a_field_within_a_second(example):
    assert interrupted_after(0.3, lambda: astrolith.mesh(example("itokawa_details"), resolution=1024)) < 1.0
    field = astrolith.Field(example("itokawa_details"))
    points = np.random.default_rng(1).uniform(*field.bounds, (4_000_000, 3))
    assert interrupted_after(0.3, lambda: field.value(points)) < 1.0
    assert field.inside(points[:10]).shape == (10,)


def test_progress_grows_to_one_and_can_stop_the_work(example):
    seen = []
    astrolith.mesh(example("itokawa_details"), resolution=96, progress=lambda done, words: seen.append((done, words)))
    assert seen[-1][0] == 1.0 and seen[-1][1].startswith("mesh")
    assert [done for done, _ in seen] == sorted(done for done, _ in seen)
    with pytest.raises(RuntimeError, match="stopped"):
        astrolith.mesh(example("itokawa_details"), resolution=600, progress=lambda done, words: False)


def test_an_exception_of_the_callback_is_raised(example):
    def fail(done, words):
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        astrolith.mesh(example("itokawa_details"), resolution=600, progress=fail)


def test_other_python_threads_run_while_a_mesh_is_made(example):
    count, stop = [0], threading.Event()

    def tick():
        while not stop.is_set():
            count[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    astrolith.mesh(example("itokawa_details"), resolution=256)
    stop.set()
    thread.join()
    assert count[0] > 20


def test_memory_stays_flat_over_many_meshes():
    code = f"""
import astrolith
def resident():
    return int(open("/proc/self/statm").read().split()[1]) * {os.sysconf("SC_PAGE_SIZE")}
for k in range(300):
    if k == 100: before = resident()
    astrolith.mesh({BALL!r}, resolution=24)
print(resident() - before)
"""
    grown = int(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout)
    assert grown < 4e6


def test_an_interpreter_that_ends_during_work_ends_in_order(example):
    code = f"""
import astrolith, threading, os, signal
signal.signal(signal.SIGINT, signal.default_int_handler)
threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    astrolith.mesh({example("itokawa_details")!r}, resolution=1024)
except KeyboardInterrupt:
    print("stopped")
"""
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout == "stopped\n" and done.stderr == ""


def test_a_word_is_a_body_of_the_library(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert {"bennu", "eros", "itokawa"} <= set(astrolith.library())
    recipe = astrolith.Recipe.read("eros")
    assert recipe.description.startswith("433 Eros") and recipe.length_unit == "km"
    figures = astrolith.synth("eros", output="eros.ply", resolution=24)
    assert figures.closed and (tmp_path / "eros.ply").exists()
    np.testing.assert_array_equal(astrolith.mesh("eros", resolution=24).faces, astrolith.mesh(recipe, resolution=24).faces)
    assert astrolith.gravity("eros", 2670.0, resolution=24).figures.body.mass_kg == pytest.approx(6.7e15, rel=0.05)
    for call in (astrolith.Recipe.read, astrolith.mesh, lambda word: astrolith.synth(word, output="x.ply")):
        with pytest.raises(FileNotFoundError, match="^erso: is no file and no body of the library; did you mean eros"):
            call("erso")


def test_a_recipe_in_memory_has_a_name_and_leaves_no_file(tmp_path, monkeypatch):
    page = tmp_path / "share" / "astrolith" / "page.html"
    page.parent.mkdir(parents=True)
    page.write_text('<script type="application/json" id="recipe">null</script>')
    monkeypatch.delenv("ASTROLITH_PAGE", raising=False)
    monkeypatch.setattr(sys, "prefix", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    astrolith.synth(BALL, page="out")
    assert '"name":"recipe.astro"' in (tmp_path / "out" / "index.html").read_text()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["out", "share"]
    with pytest.raises(ValueError, match="^recipe: body"):
        astrolith.synth({**BALL, "body": {"type": "cube"}}, output="ball.ply")
