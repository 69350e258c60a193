#!/usr/bin/env python3
"""What a progressive mesh costs in bytes and time, beside Draco's one-shot files: docs/bytes.md.

Builds what it needs, measures, prints the page, and writes DOCS/bytes.md from bytes.md.in and
DOCS/plots/bytes-*.svg. The figures stay in BUILD/out/bytes.json. See bench/README.md.
"""

import argparse
import json
import os
import pathlib
import shutil
import sys
import time

sys.dont_write_bytecode = True  # no __pycache__ in the source tree
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(ROOT / "bench" / "peers"), str(ROOT / "bench")]
sys.path.insert(0, str(HERE))  # before those of the others, whose modules have names like ours

import curves
import lab
import link
import lossless
import one_percent
import totals
from template import fill

# Each measures, mesh by mesh, what can be kept as JSON, and reports pieces of text and plots.
SECTIONS = {"totals": totals, "link": link, "one-percent": one_percent, "curves": curves,
            "lossless": lossless}
COUNTED = ["fandisk.obj", "bunny.obj", "horse.ply", "igea.ply", "armadillo_52k.off",
           "rocker-arm_20k.obj", "kitten_50k.obj", "lucy_100k.ply"]  # in means and worst cases
ASIDE = ["dragon_vrip.ply", "happy_vrip_q14.ply"]
ONE_PERCENT = ["bunny.obj", "horse.ply", "igea.ply", "fandisk.obj"]
QUICK = ["fandisk.obj", "horse.ply"]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--meshes", type=pathlib.Path, metavar="DIR",
                        default=os.environ.get("PMESH_TEST_MESHES"),
                        help="folder of mesh files (default: $PMESH_TEST_MESHES)")
    parser.add_argument("--only", nargs="+", metavar="MESH", default=[],
                        help="files of that folder, or their names without ending; the figures of "
                             "the others are kept from the last run")
    parser.add_argument("--sections", nargs="*", choices=list(SECTIONS), default=list(SECTIONS),
                        metavar="SECTION", help="measure these anew, keep the others: %(choices)s")
    parser.add_argument("--quick", action="store_true",
                        help="two meshes, coarse searches, few rounds, no page in DOCS")
    parser.add_argument("--rounds", type=int, help="of everything that is timed (default: 11)")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "bytes",
                        metavar="DIR")
    parser.add_argument("--docs", type=pathlib.Path, default=ROOT / "docs", metavar="DIR",
                        help="where bytes.md and plots/ go")
    arguments = parser.parse_args()
    if not arguments.meshes:
        parser.error("no folder of meshes: give --meshes, or set PMESH_TEST_MESHES")
    arguments.rounds = arguments.rounds or (3 if arguments.quick else 11)
    return arguments


def build(folder):
    if not shutil.which("draco_encoder"):
        sys.exit("draco_encoder is missing: scripts/deps.sh peers installs it")
    lab.carry_out(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                   "-DPMESH_BUILD_TESTS=OFF", "-DPMESH_BUILD_BENCH=ON"])
    lab.carry_out(["cmake", "--build", folder, "--target", "bytes", "pmesh"])


def present_meshes(arguments):
    """The mesh files to measure; says which are absent."""
    chosen = QUICK if arguments.quick and not arguments.only else COUNTED + ASIDE
    if arguments.only:
        known = {pathlib.Path(name).stem: name for name in chosen}
        chosen = [known.get(name, name) for name in arguments.only]
    paths = [pathlib.Path(arguments.meshes).resolve() / name for name in chosen]
    for path in paths:
        if not path.is_file():
            print(f"skipped: {path} is absent", file=sys.stderr)
    return [path for path in paths if path.is_file()]


def meshes_of(section, meshes):
    return [mesh for mesh in meshes if section != "one-percent" or mesh.name in ONE_PERCENT]


def measure(sections, meshes, equipment, kept):
    """kept[section][mesh], those asked for measured anew, the file brought up to date each time."""
    figures = json.loads(kept.read_text()) if kept.exists() else {}
    for section in sections:
        for mesh in meshes_of(section, meshes):
            start = time.monotonic()
            measured = SECTIONS[section].measure(equipment, mesh)
            figures.setdefault(section, {})[mesh.stem] = measured
            kept.write_text(json.dumps(figures, indent=1) + "\n")
            print(f"{section} {mesh.stem}: {time.monotonic() - start:.0f} s", file=sys.stderr)
    return figures


def in_order(figures):
    order = [pathlib.Path(name).stem for name in COUNTED + ASIDE]
    rank = {name: number for number, name in enumerate(order)}
    return dict(sorted(figures.items(), key=lambda item: rank.get(item[0], len(rank))))


def write_page(figures, page):
    """The page, and beside it the plots. Gives its text."""
    plots, pieces = {}, {}
    for name, section in SECTIONS.items():
        counted = [pathlib.Path(mesh).stem for mesh in COUNTED]
        pieces |= section.report(in_order(figures.get(name, {})), counted, plots)
    text = fill(HERE / "bytes.md.in", pieces)
    (page.parent / "plots").mkdir(parents=True, exist_ok=True)
    for name, svg in plots.items():
        (page.parent / "plots" / name).write_text(svg)
    page.write_text(text)
    return text


def main():
    arguments = parse_arguments()
    folder = arguments.build.resolve()
    files = folder / "out" / "files"
    files.mkdir(parents=True, exist_ok=True)
    build(folder)
    equipment = lab.Lab(folder, files, arguments.rounds, fineness=1 if arguments.quick else 2)
    kept = folder / "out" / ("quick.json" if arguments.quick else "bytes.json")
    figures = measure(arguments.sections, present_meshes(arguments), equipment, kept)
    whole = not arguments.quick and all(section in figures for section in SECTIONS)
    page = arguments.docs / "bytes.md" if whole else kept.with_suffix(".md")
    print(write_page(figures, page))
    print(f"written: {page}", file=sys.stderr)


if __name__ == "__main__":
    main()
