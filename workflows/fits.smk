# A folder of shape models through fit_shape: a recipe and a report each, and a table of all.
#
#   snakemake -s workflows/fits.smk --profile workflows/profiles/local --config models=shapes folder=fits
#
# A model that cannot be fitted stands in the table with the reason, and the others go on. Models whose recipe is there
# are not fitted again. Settings:
#   models      the folder of the shape models
#   folder      where all goes (default fits)
#   options     further options of fit_shape, such as "--spheres 100 --base-only"
#   program     fit_shape itself, where it is not in PATH
import pathlib
import re
import subprocess

if "models" not in config:
    raise WorkflowError("state the folder of the shape models: --config models=shapes")

WORKFLOWS = pathlib.Path(workflow.basedir)
FOLDER = str(config.get("folder", "fits"))
PROGRAM = str(config.get("program", "fit_shape"))
OPTIONS = str(config.get("options", ""))
# The extensions of the meshes that the program reads, as its help names them.
HELP = subprocess.run([PROGRAM, "--help"], capture_output=True, text=True, check=True).stdout
NAMED = re.search(r"mesh of a closed body \((.*?)\)", HELP)
if NAMED is None:
    raise WorkflowError(f"{PROGRAM} --help: names no meshes; is it fit_shape?")
FORMATS = {*re.findall(r"\.\w+", NAMED[1]), ".plt"}  # as PDS names some of its .tab
FILES = {file: pathlib.PurePath(re.sub(r"\.ply\.zst$", ".ply", file.name)) for file in sorted(pathlib.Path(config["models"]).iterdir())}
MODELS = {name.stem: str(file) for file, name in FILES.items() if name.suffix in FORMATS}
if not MODELS:
    raise WorkflowError(f"{config['models']}: holds no shape model ({' '.join(sorted(FORMATS))})")


wildcard_constraints:
    name="[^/]+",


rule all:
    input: f"{FOLDER}/fits.csv", f"{FOLDER}/index.html"


# The shell ends well in any case, so that one bad model does not keep the table from being made.
rule fit:
    input: lambda wildcards: MODELS[wildcards.name]
    output: f"{FOLDER}/messages/{{name}}.txt"
    params: folder=FOLDER
    threads: 1
    shell:
        "mkdir -p {params.folder:q}/recipes {params.folder:q}/summaries {params.folder:q}/reports;"
        " {PROGRAM:q} {input:q} -o {params.folder:q}/recipes/{wildcards.name:q}.json --threads {threads} --quiet"
        " --summary {params.folder:q}/summaries/{wildcards.name:q}.json"
        " --report {params.folder:q}/reports/{wildcards.name:q} {OPTIONS} >{output:q} 2>&1 ||"
        " rm -f {params.folder:q}/summaries/{wildcards.name:q}.json"


rule table:
    input: expand(f"{FOLDER}/messages/{{name}}.txt", name=MODELS)
    output: f"{FOLDER}/fits.csv", f"{FOLDER}/index.html"
    shell: "{WORKFLOWS:q}/fit_table.py {FOLDER:q}"
