"""The tools that are compared, and how one run of one of them goes."""

import json
import pathlib
import subprocess
import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class Tool:
    name: str
    program: str  # of bench/peers
    variant: str
    placement: str  # "half": vertices stay a subset; "free": placed freely
    final_level: str = "1%"  # where a timed run ends


def pmesh(options, placement):
    """pmesh's engine goes all the way down, so its time is that of the whole continuum."""
    return Tool(f"pmesh {options}", "peer_pmesh", options, placement, "200")


# The order of the tables' rows; ratios are to the first. pmesh's variants are METRIC[:PARAMETERS]
# as core/metrics/table.h has them.
TOOLS = [
    Tool("meshoptimizer", "peer_meshoptimizer", "simplify", "half"),
    Tool("OpenMesh quadric", "peer_openmesh", "quadric", "half"),
    Tool("OpenMesh quadric + guard", "peer_openmesh", "quadric+guard", "half"),
    Tool("CGAL Garland-Heckbert", "peer_cgal", "garland-heckbert", "free"),
    Tool("CGAL Garland-Heckbert + guard", "peer_cgal", "garland-heckbert+guard", "free"),
    Tool("CGAL Lindstrom-Turk", "peer_cgal", "lindstrom-turk", "free"),
    Tool("CGAL Lindstrom-Turk + guard", "peer_cgal", "lindstrom-turk+guard", "free"),
    pmesh("blended-qem", "half"),
    pmesh("melod", "half"),
    pmesh("qem:placement=subset", "half"),
    pmesh("qem:placement=solved", "free"),
    pmesh("memoryless", "free"),
    pmesh("feature-sensitive", "free"),
    pmesh("feature-sensitive:blow-up", "free"),
    pmesh("triangle", "free"),
]

LEVELS = ["50%", "10%", "5%", "2%", "1%", "0.5%"]


def levels_of(mesh):
    """Finest first; of the horse also the level that the MELOD paper's figure 5 shows."""
    return LEVELS[:4] + ["1596"] + LEVELS[4:] if mesh.stem == "horse" else LEVELS


def run_json(command):
    """The JSON object that a command prints; None, with its complaint passed on, if it fails."""
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        complaint = done.stderr.strip() or f"ended with {done.returncode}"
        print(f"  {pathlib.Path(command[0]).name}: {complaint}", file=sys.stderr)
        return None
    return json.loads(done.stdout)


def time_once(tool, mesh, programs):
    return run_json([programs / tool.program, tool.variant, mesh, tool.final_level])


def write_lods(tool, mesh, programs, folder):
    """[{level, faces, file}], finest first."""
    prefix = folder / f"{mesh.stem}_{tool.name.replace(' ', '_')}"
    run = [programs / tool.program, tool.variant, mesh, *levels_of(mesh), "--write", prefix]
    result = run_json(run)
    return result["lods"] if result else []


def compare(pmesh_program, original, lod, *options):
    return run_json([pmesh_program, "compare", original, lod, "--json", *options])
