#!/usr/bin/env python3
"""Stops a program by SIGTERM after given times, and says how long it takes to end, in which stage, and what it leaves.

    stop_times.py SECONDS,SECONDS,... PROGRAM ARGUMENTS     (names of inputs are absolute, those of outputs relative)
"""
import os
import pty
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time


def last_line(text):
    lines = [line for line in re.split(r"[\r\n]", text.replace("\x1b[K", "")) if line.strip()]
    return lines[-1] if lines else ""


def stop_after(wait, command):
    """Prints a line, and returns whether the program had ended by itself."""
    with tempfile.TemporaryDirectory() as folder:
        master, slave = pty.openpty()
        text = []
        child = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=slave)
        os.close(slave)

        def read():
            try:
                while chunk := os.read(master, 65536):
                    text.append(chunk.decode(errors="replace"))
            except OSError:
                pass  # the program has closed its end

        reader = threading.Thread(target=read)
        reader.start()
        time.sleep(wait)
        ended, stage, start = child.poll() is not None, last_line("".join(text))[:70], time.time()
        if not ended:
            child.send_signal(signal.SIGTERM)
        status = child.wait()
        took = time.time() - start
        reader.join()
        os.close(master)
        left = sorted(os.path.relpath(os.path.join(root, name), folder) for root, _, names in os.walk(folder) for name in names)
        end = "had ended" if ended else f"ended in {took:.2f} s"
        print(f"{wait:7.2f} s: {end}, status {status}, in [{stage}], left {left}", flush=True)
        return ended


for seconds in map(float, sys.argv[1].split(",")):
    if stop_after(seconds, sys.argv[2:]):
        break
