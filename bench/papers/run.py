#!/usr/bin/env python3
"""Regenerates docs/papers.md: what three papers on decimation report, beside what pmesh measures.

Builds what it needs (bench/peers and all), measures, and writes DOCS/papers.md from papers.md.in
and the drawings DOCS/plots/*.svg. The figures stay in BUILD/out/papers.json. See bench/README.md.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import time

sys.dont_write_bytecode = True  # no __pycache__ in the source tree
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(ROOT / "bench" / "peers"), str(ROOT / "bench")]

import error_curves
import feature_sensitive_2010
import growth
import lab
import melod_2004
import run as peers  # bench/peers/run.py
import triangle_2011
from template import fill

# Each measures what can be kept as JSON, and reports it as pieces of text and plots by name.
SECTIONS = {"melod": melod_2004, "feature-sensitive": feature_sensitive_2010,
            "triangle": triangle_2011, "errors": error_curves, "growth": growth}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--meshes", type=pathlib.Path, required=True, metavar="DIR",
                        help="folder of mesh files")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "peers",
                        metavar="DIR")
    parser.add_argument("--docs", type=pathlib.Path, default=ROOT / "docs", metavar="DIR",
                        help="where papers.md and plots/ go")
    parser.add_argument("--only", nargs="*", choices=list(SECTIONS), default=list(SECTIONS),
                        help="measure these anew, take the others from the last run")
    parser.add_argument("--errors-from", type=pathlib.Path, metavar="FILE",
                        help="take section \"errors\" from the peers.json of a bench/peers run")
    parser.add_argument("--rounds", type=int, default=3, help="of everything that is timed")
    return parser.parse_args()


def build(folder):
    peers.build(folder)
    done = subprocess.run(["cmake", "--build", folder, "--target", "papers"], capture_output=True,
                          text=True)
    if done.returncode != 0:
        sys.exit(f"cmake failed:\n{done.stdout}{done.stderr}")


def load(kept):
    return json.loads(kept.read_text()) if kept.exists() else {}


def measure(names, equipment, kept):
    """kept[section], those of `names` measured anew and the file brought up to date after each."""
    figures = load(kept)
    for name in names:
        start = time.monotonic()
        figures[name] = SECTIONS[name].measure(equipment)
        kept.write_text(json.dumps(figures, indent=1) + "\n")
        print(f"{name}: {time.monotonic() - start:.0f} s", flush=True)
    return figures


def write_documents(figures, folder):
    missing = [name for name in SECTIONS if name not in figures]
    if missing:
        sys.exit(f"not measured yet: {', '.join(missing)}")
    plots, pieces = {}, {}
    for name, section in SECTIONS.items():
        pieces |= section.report(figures[name], plots)
    text = fill(HERE / "papers.md.in", pieces)
    (folder / "plots").mkdir(parents=True, exist_ok=True)
    for name, svg in plots.items():
        (folder / "plots" / name).write_text(svg)
    (folder / "papers.md").write_text(text)


def main():
    arguments = parse_arguments()
    folder = arguments.build.resolve()
    lods = folder / "out" / "lods"
    lods.mkdir(parents=True, exist_ok=True)
    if arguments.only:
        build(folder)
    equipment = lab.Lab(arguments.meshes.resolve(), folder, lods, arguments.rounds)
    names = [name for name in arguments.only if name != "errors" or not arguments.errors_from]
    figures = measure(names, equipment, folder / "out" / "papers.json")
    if arguments.errors_from:
        figures["errors"] = error_curves.taken_from(json.loads(arguments.errors_from.read_text()))
    write_documents(figures, arguments.docs)


if __name__ == "__main__":
    main()
