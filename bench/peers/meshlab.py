"""`pmesh compare` against an independent meter, MeshLab's Hausdorff filter.

The filter's samples of vertices and edges find the maximum, but are not spread evenly over the
surface: so the RMS is taken from a second pass with samples of faces alone. It computes in single
precision and prints six digits after the point of the diagonal: the pairs are coarse enough.
"""

import re
import subprocess

import tables
import tools

SAMPLES = 2_000_000
MOST_RMS, MOST_MAX = 0.02, 0.05  # the differences allowed

# The mesh, the tool of tools.py, and the level of detail.
PAIRS = [
    ("horse.ply", "meshoptimizer", "1%"),
    ("bunny.obj", "CGAL Lindstrom-Turk", "1%"),
    ("fandisk.obj", "OpenMesh quadric + guard", "0.5%"),
    ("armadillo_52k.off", "OpenMesh quadric", "5%"),
    ("igea.ply", "CGAL Garland-Heckbert + guard", "0.5%"),
]

FILTER = """ <filter name="Hausdorff Distance">
  <Param type="RichMesh" name="SampledMesh" value="{source}"/>
  <Param type="RichMesh" name="TargetMesh" value="{target}"/>
  <Param type="RichBool" name="SaveSample" value="false"/>
  <Param type="RichBool" name="SampleVert" value="{edges}"/>
  <Param type="RichBool" name="SampleEdge" value="{edges}"/>
  <Param type="RichBool" name="SampleFauxEdge" value="false"/>
  <Param type="RichBool" name="SampleFace" value="true"/>
  <Param type="RichInt" name="SampleNum" value="{samples}"/>
  <Param type="RichAbsPerc" name="MaxDist" value="{far}" min="0" max="{far}"/>
 </filter>
"""


def script(far):
    """Four passes: from A and from B, with edges and vertices and without."""
    passes = [(0, 1, "true"), (1, 0, "true"), (0, 1, "false"), (1, 0, "false")]
    filters = [FILTER.format(source=source, target=target, edges=edges, samples=SAMPLES, far=far)
               for source, target, edges in passes]
    return "<!DOCTYPE FilterScript>\n<FilterScript>\n" + "".join(filters) + "</FilterScript>\n"


def hausdorff(a, b, far, folder):
    """(max, rms) as MeshLab sees them, in the meshes' unit."""
    script_file = folder / "hausdorff.mlx"
    script_file.write_text(script(far))
    run = subprocess.run(["xvfb-run", "-a", "meshlabserver", "-i", a, "-i", b, "-s", script_file],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    # Of each pass: the diagonal of the sampled mesh, then max and RMS over that diagonal.
    found = re.findall(r"^LOG: 2 Values w\.r\.t\. BBox Diag \((\S+)\)\n"
                       r"LOG: 2 +min : \S+ +max (\S+) +mean : \S+ +RMS : (\S+)",
                       run.stdout, re.MULTILINE)
    if len(found) != 4:
        raise SystemExit(f"MeshLab's filter did not run:\n{run.stdout}")
    values = [[float(diagonal) * float(value) for value in rest] for diagonal, *rest in found]
    return max(value[0] for value in values), max(value[1] for value in values[2:])


def write_level(program, variant, mesh, level, programs, folder):
    """The file of the mesh at that level."""
    run = [programs / program, variant, mesh, level, "--write", folder / f"meshlab_{mesh.stem}"]
    return tools.run_json(run)["lods"][0]["file"]


def check(meshes, programs, pmesh_program, folder):
    """Both meters' figures as a Markdown table, and whether they agree."""
    by_name = {tool.name: tool for tool in tools.TOOLS}
    rows, agree = [], True
    for file, tool_name, level in PAIRS:
        mesh = meshes / file
        # As PLY: MeshLab cannot read every OBJ.
        original = write_level("peer_pmesh", "melod", mesh, "100%", programs, folder)
        tool = by_name[tool_name]
        lod = write_level(tool.program, tool.variant, mesh, level, programs, folder)
        ours = tools.compare(pmesh_program, original, lod)
        diagonal = ours["bbox_diagonal"]
        largest, rms = hausdorff(original, lod, diagonal, folder)
        difference_max, difference_rms = ours["max"] / largest - 1, ours["rms"] / rms - 1
        agree &= abs(difference_max) <= MOST_MAX and abs(difference_rms) <= MOST_RMS
        rows.append([f"{mesh.stem} at {level}, {tool_name}"]
                    + [f"{100 * figure / diagonal:.4f}"
                       for figure in (ours["max"], largest, ours["rms"], rms)]
                    + [f"{100 * difference_max:+.2f}%", f"{100 * difference_rms:+.2f}%"])
    verdict = "agree" if agree else "DISAGREE"
    text = tables.table(["pair (% of the diagonal)", "max, pmesh", "max, MeshLab", "RMS, pmesh",
                         "RMS, MeshLab", "max differs by", "RMS differs by"], rows)
    text += f"\nThey {verdict} within {MOST_RMS:.0%} in RMS, {MOST_MAX:.0%} in maximum.\n"
    return text, agree
