"""A process that is forked from one at work is refused in one line, and does not wait for ever."""

import subprocess
import sys

CODE = """
import multiprocessing
import sys
import astrolith
ball = {"type": "metaballs", "kernel": "gaussian", "a": 2, "b": 2, "spheres": [[0, 0, 0, 1]]}
recipe = {"format_version": 1, "length_unit": "km", "body": ball}
def work():
    try:
        astrolith.mesh(recipe, resolution=16)
    except RuntimeError as error:
        sys.exit(0 if "spawn" in str(error) else 4)
    sys.exit(5)
astrolith.mesh(recipe, resolution=16)
child = multiprocessing.get_context("fork").Process(target=work)
child.start()
child.join(60)
print(child.exitcode)
"""


def test_a_forked_child_is_refused():
    run = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True, timeout=120)
    assert run.stdout == "0\n"
