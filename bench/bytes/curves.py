"""Rate and distortion: RMS distance to the original against bytes."""

import itertools

import draco
import plot  # of bench
import tables  # of bench/peers

BITS = 12
OCTAVES = 8  # one-shot levels go down to 1/256 of the faces
LADDER = (64, 16, 4, 1)  # divisors of the faces, the levels of a ladder


def measure(lab, mesh):
    file = lab.pm_file(mesh, BITS)
    info = lab.info(file)
    levels = one_shots(lab, mesh, info["faces"])
    return {"pm": [base(lab, mesh, file, info), *chunk_ends(info)], "one_shot": levels,
            "ladder": ladder(levels)}


def base(lab, mesh, file, info):
    """Its error is not in the index."""
    distance = lab.distance(mesh, lab.extracted(file, info["base_faces"]))
    return {"bytes": info["prologue_bytes"] + info["base_bytes"], "rms": distance["rms_relative"]}


def chunk_ends(info):
    return [{"bytes": chunk["offset"] + chunk["bytes"],
             "rms": chunk["rms_error"] / info["bbox_diagonal"]} for chunk in info["chunks"]]


def one_shots(lab, mesh, faces):
    divisors = [2 ** (step / lab.fineness) for step in range(OCTAVES * lab.fineness + 1)]
    return [one_shot(lab, mesh, faces, divisor) for divisor in reversed(divisors)]


def one_shot(lab, mesh, faces, divisor):
    level = draco.one_shot(lab, mesh, round(faces / divisor), BITS)
    distance = draco.distance(lab, mesh, level["file"])
    return {"divisor": divisor, "bytes": level["bytes"], "rms": distance["rms_relative"]}


def ladder(levels):
    """A client that has seen the levels before has fetched all their bytes."""
    rungs = [level for level in levels if level["divisor"] in LADDER]
    fetched = itertools.accumulate(level["bytes"] for level in rungs)
    return [level | {"bytes": size} for level, size in zip(rungs, fetched)]


def report(figures, _counted, plots):
    for mesh, f in figures.items():
        plots[f"bytes-{mesh}.svg"] = chart(mesh, f)
    rows = [[mesh, f"{f['pm'][-1]['bytes']:,}", f"{f['ladder'][-1]['bytes']:,}",
             f"{f['ladder'][-1]['bytes'] / f['pm'][-1]['bytes']:.2f}"]
            for mesh, f in figures.items()]
    header = ["mesh", "pmesh bytes", "ladder bytes", "ladder / pmesh"]
    pictures = [f"![RMS against bytes, {mesh}](plots/bytes-{mesh}.svg)" for mesh in figures]
    return {"ladders": tables.table(header, rows), "curves": "\n\n".join(pictures)}


def chart(mesh, figures):
    lines = [("pmesh, chunk ends", "pm", "solid"), ("Draco ladder, sum", "ladder", "dotted"),
             ("Draco, one LOD", "one_shot", "dashed")]
    series = [plot.Series(label, [(p["bytes"], 100 * p["rms"]) for p in figures[name]],
                          plot.colour(number), dash)
              for number, (label, name, dash) in enumerate(lines)]
    return plot.chart([plot.Panel(mesh, plot.Axis("bytes"), plot.Axis("RMS, % of the diagonal"),
                                  series)])
