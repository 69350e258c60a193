"""Error against faces: all metrics and peers on three meshes, and figure 5 of the MELOD paper.

A curve is (name, class, {level: (max, rms)}), in % of the diagonal, as bench/peers has it.
"""

import json
import pathlib
import textwrap

import plot
import run as peers  # bench/peers/run.py
import tables
import tools

MESHES = ["horse.ply", "bunny.obj", "fandisk.obj"]
HORSE_FACES = 96966

FIGURE_5 = ["50", "10", "5", "2", "1596", "1", "0.5"]
IN_FIGURE_5 = ["pmesh melod", "pmesh qem:placement=subset", "pmesh qem:placement=solved",
               "pmesh memoryless", "CGAL Lindstrom-Turk", "*QSlim as distributed*"]


def measure(lab):
    """errors[mesh][tool][level] = {faces, max, rms}, in % of the diagonal."""
    meshes = [lab.mesh(name) for name in MESHES]
    return peers.measure_errors(tools.TOOLS, meshes, lab.peers, lab.pmesh, lab.lods)


def taken_from(peers_json):
    """What measure() would give, from the figures of a run of bench/peers."""
    return {pathlib.Path(name).stem: peers_json["errors"][pathlib.Path(name).stem]
            for name in MESHES}


def report(errors, plots):
    curves = {mesh: curves_of(mesh, of_mesh) for mesh, of_mesh in errors.items()}
    for mesh, of_mesh in curves.items():
        for placement, name in (("half", "subset"), ("free", "free")):
            shown = [curve for curve in of_mesh if curve[1] == placement and len(curve[2]) > 1]
            plots[f"error-{mesh}-{name}.svg"] = plot.chart(
                [panel(mesh, shown, "maximum", 0), panel(mesh, shown, "RMS", 1)])
    by_name = {curve[0]: curve for curve in curves["horse"]}
    figure_5 = [by_name[name] for name in IN_FIGURE_5 if name in by_name]
    plots["melod-figure-5.svg"] = plot.chart([panel("horse", figure_5, "maximum", 0)], width=460)
    return {"melod_figure_5": figure_5_table(figure_5),
            "melod_figure_5_verdict": verdict(by_name),
            "error_tables": "\n".join(mesh_section(mesh, curves[mesh]) for mesh in curves)}


def curves_of(mesh, errors):
    earlier = json.loads((pathlib.Path(peers.__file__).parent / "earlier.json").read_text())
    measured = [tool for tool in tools.TOOLS if errors.get(tool.name)]
    return peers.curves_of(measured, errors, earlier["errors"].get(mesh, {}))


def panel(mesh, curves, title, which):
    series = []
    for number, (name, _, levels) in enumerate(curves):
        points = sorted((percent(level), error[which]) for level, error in levels.items())
        dash = "solid" if name.startswith("pmesh") else "dotted" if name[0] == "*" else "dashed"
        series.append(plot.Series(name.strip("*"), points, plot.colour(number), dash))
    names = {value: f"{value:g}" for value in (0.5, 1, 2, 5, 10, 20, 50)}
    return plot.Panel(f"{mesh}: {title} distance", plot.Axis("% of the faces", names=names),
                      plot.Axis("% of the bounding box's diagonal"), series)


def percent(level):
    return float(level) if float(level) <= 100 else 100 * float(level) / HORSE_FACES


def figure_5_table(curves):
    rows = [[name] + [f"{levels[level][0]:.3f}" for level in FIGURE_5]
            for name, _, levels in curves]
    return tables.table(["maximum, % of the diagonal", *map(tables.level_name, FIGURE_5)], rows)


def verdict(by_name):
    """How MELOD fares against QSlim, in a sentence."""
    melod, qslim = by_name["pmesh melod"][2], by_name["*QSlim as distributed*"][2]
    above = [level for level in FIGURE_5 if melod[level][0] > qslim[level][0]]
    sentence = (f"MELOD's maximum error is at or below that of QSlim as distributed at "
                f"{len(FIGURE_5) - len(above)} of the {len(FIGURE_5)} levels")
    if above:
        sentence += "; it is above at " + ", ".join(map(tables.level_name, above))
    return textwrap.fill(sentence + ".", 100)


def mesh_section(mesh, curves):
    levels = [level.rstrip("%") for level in tools.LEVELS]
    return (f"### {mesh}\n\n"
            f"![Error on {mesh}, vertices a subset](plots/error-{mesh}-subset.svg)\n\n"
            f"![Error on {mesh}, vertices placed freely](plots/error-{mesh}-free.svg)\n\n"
            "Maximum / RMS in % of the diagonal:\n\n" + tables.error_table(curves, levels))
