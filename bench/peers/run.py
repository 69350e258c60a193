#!/usr/bin/env python3
"""Debian's decimators beside pmesh, on the same meshes in the same run: speed, memory, error.

Builds what it needs, prints Markdown tables, and leaves them as OUT/peers.md, the figures as
OUT/peers.json and the levels of detail in OUT/lods; with --meshlab OUT/meshlab.md alone. See
bench/README.md.
"""

import argparse
import json
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True  # no __pycache__ in the source tree

import meshlab
import tables
import tools

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MESHES = ["fandisk.obj", "bunny.obj", "horse.ply", "armadillo_52k.off", "igea.ply",
          "dragon_vrip.ply"]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--meshes", type=pathlib.Path, required=True, metavar="DIR",
                        help="folder of mesh files")
    parser.add_argument("--only", nargs="+", default=MESHES, metavar="FILE",
                        help="files of that folder (default: %(default)s)")
    parser.add_argument("--tools", default="", metavar="WORD",
                        help="of all tools only meshoptimizer and those with this in their names")
    parser.add_argument("--rounds", type=int, default=3, help="0 to leave out speed and memory")
    parser.add_argument("--no-errors", action="store_true", help="leave out the error tables")
    parser.add_argument("--meshlab", action="store_true",
                        help="only check `pmesh compare` against MeshLab's Hausdorff filter")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "peers",
                        metavar="DIR")
    parser.add_argument("--out", type=pathlib.Path, metavar="DIR", help="default: BUILD/out")
    arguments = parser.parse_args()
    arguments.out = (arguments.out or arguments.build / "out").resolve()
    return arguments


def build(folder):
    """Configures and builds the peers and pmesh itself; the folder of the peers' programs."""
    cgal = folder / "cgal"
    for command in (
            [HERE / "unpack_cgal.sh", cgal],
            ["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
             "-DPMESH_BUILD_TESTS=OFF", "-DPMESH_BUILD_PEERS=ON", f"-DPMESH_CGAL_DIR={cgal}"],
            ["cmake", "--build", folder, "--target", "peers", "pmesh"]):
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{command[0]} failed:\n{done.stdout}{done.stderr}")
    return folder / "bench" / "peers"


def best_of(runs):
    """The quickest run, with the most memory of any."""
    best = min(runs, key=lambda run: run["seconds"])
    return best | {key: max(run[key] for run in runs) for key in ("mesh_bytes", "peak_bytes")}


def measure_speed(chosen, meshes, programs, rounds):
    """speed[mesh][tool]: the tools take turns, so that what disturbs one disturbs all."""
    speed = {}
    for mesh in meshes:
        runs = {tool: [] for tool in chosen}
        for _ in range(rounds):
            for tool in list(runs):
                run = tools.time_once(tool, mesh, programs)
                if run:
                    runs[tool].append(run)
                else:
                    del runs[tool]
        speed[mesh.stem] = {tool.name: best_of(of_tool) for tool, of_tool in runs.items()}
    return speed


def measure_errors(chosen, meshes, programs, pmesh_program, folder):
    """errors[mesh][tool][level] = {faces, max, rms}, in % of the original's diagonal."""
    errors = {}
    for mesh in meshes:
        for tool in chosen:
            levels = errors.setdefault(mesh.stem, {}).setdefault(tool.name, {})
            for lod in tools.write_lods(tool, mesh, programs, folder):
                distance = tools.compare(pmesh_program, mesh, lod["file"])
                if distance:
                    levels[lod["level"]] = {"faces": lod["faces"],
                                            "max": 100 * distance["max_relative"],
                                            "rms": 100 * distance["rms_relative"]}
    return errors


def curves_of(chosen, errors, earlier):
    """Of one mesh, every tool's and every earlier row's (name, class, {level: (max, rms)})."""
    measured = [(tool.name, tool.placement,
                 {level: (e["max"], e["rms"]) for level, e in errors[tool.name].items()})
                for tool in chosen]
    before = [(f"*{name}*", row["class"], {k: v for k, v in row.items() if k != "class"})
              for name, row in earlier.items()]
    return measured + before


def report(chosen, meshes, speed, errors):
    earlier = json.loads((HERE / "earlier.json").read_text())
    names = [mesh.stem for mesh in meshes]
    text = "# pmesh and Debian's decimators\n"
    if speed:
        text += ("\n## Speed: thousand input faces a CPU second (time, meshoptimizer's = 1)\n\n"
                 + tables.speed_table(speed, chosen, names, earlier)
                 + "\n## Memory: bytes a face, the loaded mesh + the peak above it\n\n"
                 + tables.memory_table(speed, chosen, names))
    for mesh in meshes if errors else []:
        levels = [level.rstrip("%") for level in tools.levels_of(mesh)]
        shares = [level.rstrip("%") for level in tools.LEVELS]
        curves = curves_of(chosen, errors[mesh.stem], earlier["errors"].get(mesh.stem, {}))
        text += (f"\n## Error on {mesh.stem}: maximum / RMS in % of the diagonal\n\n"
                 + tables.error_table(curves, levels) + "\n" + tables.ratio_table(curves, shares))
    return text + f"\nRows in italics: {earlier['note']}\n"


def main():
    arguments = parse_arguments()
    meshes = [arguments.meshes.resolve() / name for name in arguments.only]
    chosen = tools.TOOLS[:1] + [t for t in tools.TOOLS[1:] if arguments.tools in t.name]
    lods = arguments.out / "lods"
    lods.mkdir(parents=True, exist_ok=True)
    programs = build(arguments.build.resolve())
    pmesh_program = arguments.build.resolve() / "cli" / "pmesh"
    if arguments.meshlab:
        text, agree = meshlab.check(arguments.meshes.resolve(), programs, pmesh_program, lods)
        (arguments.out / "meshlab.md").write_text(text)
        print(text)
        sys.exit(0 if agree else 1)

    speed = measure_speed(chosen, meshes, programs, arguments.rounds) if arguments.rounds else {}
    errors = {}
    if not arguments.no_errors:
        errors = measure_errors(chosen, meshes, programs, pmesh_program, lods)
    text = report(chosen, meshes, speed, errors)
    (arguments.out / "peers.json").write_text(
        json.dumps({"speed": speed, "errors": errors}, indent=1) + "\n")
    (arguments.out / "peers.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main()
