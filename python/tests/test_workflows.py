"""The scripts of workflows/ with stand-ins of synth and Slurm, and Snakemake where it is installed."""

import importlib.util
import json
import os
import shutil
import stat
import subprocess
import sys

import pytest
from conftest import ROOT

WORKFLOWS = ROOT / "workflows"
# Writes the files and the manifest of synth --members, one byte a body.
SYNTH = f"""#!{sys.executable}
import json, pathlib, sys
words = [part for word in sys.argv[1:] for part in (word.split("=", 1) if word.startswith("--preview=") else [word])]
given = lambda option: words[words.index(option) + 1]
first, last = map(int, given("--members").split(":"))
manifest = pathlib.Path(given("--manifest"))
manifest.parent.mkdir(parents=True, exist_ok=True)
family = pathlib.Path(words[0]).read_text()
if manifest.exists() and any(json.loads(line)["family"] != family for line in manifest.read_text().splitlines()):
    sys.exit("synth: has members of another recipe")
for option in ("-o", "--preview"):
    for member in range(first, last):
        if option in words:
            body = pathlib.Path(given(option).replace("{{member}}", str(member)))
            body.parent.mkdir(parents=True, exist_ok=True)
            body.write_text("b")
with manifest.open("a") as lines:
    for member in range(first, last):
        name = pathlib.Path(given("-o").replace("{{member}}", str(member)))
        name = str(pathlib.Path("..") / name.parent.name / name.name)
        lines.write(json.dumps(dict(member=member, family=family, version="1", files=[dict(name=name, bytes=1)])) + "\\n")
"""


@pytest.fixture
def cluster(tmp_path, monkeypatch):
    """A folder with stand-ins of synth, sbatch and scontrol in PATH."""
    tools = tmp_path / "tools"
    tools.mkdir()
    for name, text in (("synth", SYNTH), ("scontrol", "#!/bin/sh\necho 'MaxArraySize            = 4'\n"),
                       ("sbatch", "#!/bin/sh\necho \"$@\" > asked\n")):  # fmt: skip
        (tools / name).write_text(text)
        (tools / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tools}:{os.environ['PATH']}")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "family.json").write_text("{}")
    return tmp_path


def ran(*command, status=0, **variables):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env={**os.environ, **variables})
    assert done.returncode == status, done.stderr
    return done.stdout + done.stderr


def merge(*words, status=0):
    return ran(sys.executable, WORKFLOWS / "merge_manifests.py", *words, status=status)


def array_task(number, tasks, *words):
    ran(WORKFLOWS / "slurm_array.sh", *words, SLURM_ARRAY_TASK_ID=str(number), SLURM_ARRAY_TASK_COUNT=str(tasks),
        SLURM_ARRAY_TASK_MIN="0", SLURM_ARRAY_TASK_MAX=str(tasks - 1))  # fmt: skip


def test_an_array_makes_the_whole_count_within_the_clusters_limit(cluster):
    ran(WORKFLOWS / "slurm_array.sh", "family.json", 10, "set", MEMBERS_PER_TASK="2")
    assert (cluster / "asked").read_text().split()[0] == "--array=0-3"  # five tasks are more than MaxArraySize
    for task in range(3):
        array_task(task, 3, "family.json", "10", "set")
    assert merge(10, "set/manifests", "-o", "set/manifest.jsonl").startswith("10 members, digest ")
    with_gaps = dict(SLURM_ARRAY_TASK_ID="5", SLURM_ARRAY_TASK_COUNT="2", SLURM_ARRAY_TASK_MIN="0", SLURM_ARRAY_TASK_MAX="5")
    assert "gaps" in ran(WORKFLOWS / "slurm_array.sh", "family.json", 10, "set", status=2, **with_gaps)
    assert "no number" in ran(WORKFLOWS / "slurm_array.sh", "family.json", "set", "10", status=2)


def test_joined_manifests_say_what_is_missing_and_what_is_too_much(cluster):
    array_task(0, 1, "family.json", "12", "set")
    before = os.umask(0o022)
    try:
        said = merge(10, "set/manifests", "-o", "set/manifest.jsonl")
    finally:
        os.umask(before)
    assert "2 members beyond the first 10 are left out" in said and "10 members, digest" in said
    assert len((cluster / "set/manifest.jsonl").read_text().splitlines()) == 10
    assert stat.S_IMODE((cluster / "set/manifest.jsonl").stat().st_mode) == 0o644
    assert "1 of 13 members are missing" in merge(13, "set/manifests", status=1)
    (cluster / "set/bodies/3.ply").unlink()
    (cluster / "set/bodies/5.ply").write_text("longer")
    said = merge(10, "set/manifests", status=1)
    assert "the files of 2 members are missing" in said and "bodies/3.ply of member 3" in said


def test_manifests_are_joined_through_links(cluster):
    array_task(0, 1, "family.json", "4", "set")
    (cluster / "deep/deeper").mkdir(parents=True)
    (cluster / "link").symlink_to("deep/deeper")
    (cluster / "manifests").symlink_to("set/manifests")
    digests = {merge(4, folder, "-o", "link/m.jsonl") for folder in ("set/manifests", "manifests")}
    assert len(digests) == 1
    name = json.loads((cluster / "link/m.jsonl").read_text().splitlines()[0])["files"][0]["name"]
    assert (cluster / "link" / name).is_file() and name == "../../set/bodies/0.ply"


def test_what_members_take_is_asked_again_for_another_recipe(cluster):
    spec = importlib.util.spec_from_file_location("estimate", WORKFLOWS / "estimate.py")
    estimate = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(estimate)
    assert estimate.moved("--preview=set/a.png --resolution 8 --sheet all.png", "/t") == [
        "--preview", "/t/{member}.png", "--resolution", "8", "--sheet", "/t/sheet.png"]  # fmt: skip
    kept = cluster / "set/kept.json"
    asked = lambda options="": estimate.of_member("synth", "family.json", 3, "meshes", options, kept)
    assert asked()[1] == 1.0
    remembered = kept.read_text()
    asked()
    assert kept.read_text() == remembered
    (cluster / "family.json").write_text('{"other": 1}')
    asked()
    assert json.loads(kept.read_text())["asked"] != json.loads(remembered)["asked"]
    assert "above 0.5" in estimate.refusal(estimate.of_set(3600, 1, 1, 10), {"gigabytes": None, "hours": 0.5})


def test_snakemake_makes_a_changed_recipe_anew_and_heeds_limits(cluster):
    snakemake = shutil.which(os.environ.get("SNAKEMAKE", "snakemake"))
    if not snakemake:
        pytest.skip("Snakemake is not installed")
    (cluster / "my family.json").write_text("{}")
    command = [snakemake, "-s", WORKFLOWS / "Snakefile", "--cores", "1", "--config", "recipe=my family.json", "members=5",
               "folder=my set", "options=--preview='my set/{member}.png' --resolution 8"]  # fmt: skip
    ran(*command, "members_per_job=2")
    assert sorted(p.name for p in (cluster / "my set/bodies").iterdir()) == [f"{k}.ply" for k in range(5)]
    assert "othing to be done" in ran(*command, "members_per_job=2")
    assert "the set would take" in ran(*command, "members_per_job=2", "most_gigabytes=1e-12", status=1)
    (cluster / "my family.json").write_text('{"changed": 1}')
    assert "members of another recipe" in ran(*command, "members_per_job=2", status=1)
