"""Bytes until the mesh is within 1% of the diagonal of the original, everywhere and both ways."""

import draco
import tables  # of bench/peers

BITS = 12  # of the PM file, and of Draco's
FEWER_BITS = range(8, 12)  # which a Draco file may have that need not be refined
GOAL = 0.01  # of the diagonal
FEWEST = 16  # faces that no mesh here gets by with


def measure(lab, mesh):
    file = lab.pm_file(mesh, BITS)
    info = lab.info(file)
    return {"prologue_bytes": info["prologue_bytes"],
            "pm": base(lab, mesh, file, info) or first_chunk_end(info),
            "draco": least_draco(lab, mesh, info["faces"], [BITS]),
            "coarse": least_draco(lab, mesh, info["faces"], FEWER_BITS)}


def base(lab, mesh, file, info):
    """The base, if it meets the goal: its error is not in the index."""
    distance = lab.distance(mesh, lab.extracted(file, info["base_faces"]))["max_relative"]
    return distance < GOAL and {"bytes": info["base_bytes"], "faces": info["base_faces"]}


def first_chunk_end(info):
    """The first chunk at whose end the file's own error index meets the goal; None if none does."""
    for chunk in info["chunks"]:
        if chunk["max_error"] < GOAL * info["bbox_diagonal"]:
            return {"bytes": chunk["offset"] + chunk["bytes"] - info["prologue_bytes"],
                    "faces": chunk["faces"]}
    return None


def least_draco(lab, mesh, faces, some_bits):
    """The smallest one-shot file that meets the goal, of any of these bits; None if there is none."""
    best = None
    for bits in some_bits:
        best = least_at(lab, mesh, bits, faces, best)
    return best


def least_at(lab, mesh, bits, faces, best):
    """`best`, or a smaller file of so many bits that meets the goal. Doubles the faces until the
    goal is met, then bisects. Errors are not monotone, so a still smaller file may exist."""
    bad, count = FEWEST, 2 * FEWEST
    while bad < count <= faces:
        level = draco.one_shot(lab, mesh, count, bits)
        too_large = best is not None and level["bytes"] >= best["bytes"]
        if too_large or draco.distance(lab, mesh, level["file"])["max_relative"] < GOAL:
            best, faces = best if too_large else level, count
        else:
            bad = count
        narrow = faces - bad <= max(1, faces // 64)
        count = bad if narrow else min(2 * bad, (bad + faces) // 2)
    return best


def report(figures, _counted, _plots):
    def against(pm, best):
        if best is None:
            return ["-"] * 4
        ratio = f"{pm['bytes'] / best['bytes']:.2f}" if pm else "-"
        return [f"{best['bytes']:,}", f"{best['faces']:,}", str(best["bits"]), ratio]

    def row(mesh, f):
        pm = f["pm"]
        return [mesh, f"{f['prologue_bytes']:,}",
                f"{pm['bytes']:,}" if pm else "-", f"{pm['faces']:,}" if pm else "-",
                *against(pm, f["draco"]), *against(pm, f["coarse"])]

    draco_columns = ["Draco bytes", "faces", "bits", "ratio"]
    return {"one_percent": tables.table(
        ["mesh", "header and index", "pmesh bytes", "faces", *draco_columns, *draco_columns],
        [row(mesh, f) for mesh, f in figures.items()])}
