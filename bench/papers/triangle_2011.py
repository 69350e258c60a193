"""Tables 1 to 3 of the triangle paper: three functions on a grid of 11 x 11 vertices."""

import math
import pathlib

import picture
import tables

SIDE = 11
ORIGINAL = (200, 121)  # triangles, vertices
PAPER = [(196, 119), (180, 111), (142, 91)]
LEVELS = ["196", "180", "140"]
VIEW = picture.View(turn=-50, rise=42)

FUNCTIONS = {
    "cosine": lambda x, y: (1.25 + math.cos(5.4 * y)) / (6 + 6 * (3 * x - 1) ** 2),
    "exponential": lambda x, y: math.exp(-81 / 4 * ((x - 0.5) ** 2 + (y - 0.5) ** 2)) / 3,
    "bump": lambda x, y: math.sin(5 * x) * math.cos(5 * y) / 5,
}


def measure(lab):
    """By function: the original and its levels, each {faces, vertices, max, rms (% of the
    diagonal), file}."""
    return {name: measure_function(lab, name) for name in FUNCTIONS}


def measure_function(lab, name):
    original = lab.lods / f"triangle_{name}_grid.ply"
    picture.write_ply(original, *grid(FUNCTIONS[name]))
    lods = lab.levels("triangle", original, ["100%", *LEVELS])
    return [described(lod["file"], lab.distance(original, lod["file"])) for lod in lods]


def described(file, distance):
    positions, triangles = picture.read_ply(pathlib.Path(file))
    return {"faces": len(triangles), "vertices": len(positions),
            "max": 100 * distance["max_relative"], "rms": 100 * distance["rms_relative"],
            "file": file}


def grid(function):
    """(positions, triangles) over [0, 1] x [0, 1]; every square is cut along the same diagonal."""
    at = [i / (SIDE - 1) for i in range(SIDE)]
    positions = [(x, y, function(x, y)) for y in at for x in at]
    triangles = []
    for row in range(SIDE - 1):
        for column in range(SIDE - 1):
            a = row * SIDE + column
            b, c, d = a + 1, a + SIDE + 1, a + SIDE
            triangles += [(a, b, c), (a, c, d)]
    return positions, triangles


def report(data, plots):
    sections = []
    for number, (name, levels) in enumerate(data.items(), 1):
        plots[f"triangle-{name}.svg"] = picture.strip(
            [(f"{level['faces']} triangles, {level['vertices']} vertices",
              *picture.read_ply(pathlib.Path(level["file"]))) for level in levels], VIEW)
        paper = [ORIGINAL] + PAPER
        rows = [[f"{theirs[0]} / {theirs[1]}", f"{level['faces']} / {level['vertices']}",
                 f"{level['max']:.3f}", f"{level['rms']:.4f}"]
                for theirs, level in zip(paper, levels)]
        sections.append(f"### Table {number}: {name}\n\n"
                        f"![The {name} function and its levels](plots/triangle-{name}.svg)\n\n"
                        + tables.table(["paper: triangles / vertices", "ours",
                                        "max, % of the diagonal", "RMS, % of the diagonal"], rows))
    return {"triangle_tables": "\n".join(sections)}
