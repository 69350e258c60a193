"""Bytes of the whole PM file over those of Draco's one-shot file of the same lattice mesh."""

import math

import draco
import tables  # of bench/peers

AT_BITS = (12, 14)
SECTIONS = ("header", "index", "base", "components", "marks", "cuts", "positions", "relocations")
NAMES = {"cuts": "cut neighbours"}


def measure(lab, mesh):
    return {str(bits): measure_at(lab, mesh, bits) for bits in AT_BITS}


def measure_at(lab, mesh, bits):
    file = lab.pm_file(mesh, bits)
    info = lab.info(file)
    _, lattice_mesh = lab.lattice_mesh(file)
    return {"vertices": info["vertices"], "bytes": info["file_bytes"],
            "sections": {name: section["bytes"] for name, section in
                         info.get("sections", by_place(info)).items()},
            "draco_bytes": draco.of_lattice(lab, mesh, bits).stat().st_size,
            "coincident": lattice_mesh["coincident"]}


def by_place(info):
    """What is known of a file whose codec does not count its sections."""
    return {"index": {"bytes": info["prologue_bytes"]}, "base": {"bytes": info["base_bytes"]}}


def ratio(figures):
    return figures["bytes"] / figures["draco_bytes"]


def report(figures, counted, _plots):
    """`counted`: the meshes whose ratios the geometric mean is taken over."""
    pieces = {}
    for bits in map(str, AT_BITS):
        of_bits = {mesh: by_bits[bits] for mesh, by_bits in figures.items()}
        pieces[f"totals_{bits}"] = totals_table(of_bits)
        pieces[f"sections_{bits}"] = sections_table(of_bits)
        pieces[f"verdict_{bits}"] = verdict([mesh for mesh in counted if mesh in of_bits], of_bits)
    return pieces


def totals_table(figures):
    def row(mesh, f):
        return [mesh, f"{f['vertices']:,}", f"{f['bytes']:,}", bits_a_vertex(f, f["bytes"]),
                f"{f['draco_bytes']:,}", bits_a_vertex(f, f["draco_bytes"]), f"{ratio(f):.2f}",
                str(f["coincident"])]

    return tables.table(["mesh", "vertices", "pmesh bytes", "bits a vertex", "Draco bytes",
                         "bits a vertex", "ratio", "coincident"],
                        [row(mesh, f) for mesh, f in figures.items()])


def sections_table(figures):
    """Bits a vertex; a dash for what the file does not say."""
    def cell(f, section):
        return bits_a_vertex(f, f["sections"][section]) if section in f["sections"] else "-"

    return tables.table(["mesh", *(NAMES.get(section, section) for section in SECTIONS), "all"],
                        [[mesh, *(cell(f, section) for section in SECTIONS),
                          bits_a_vertex(f, f["bytes"])] for mesh, f in figures.items()])


def verdict(counted, figures):
    if not counted:
        return "None of these meshes was measured."
    ratios = {mesh: ratio(figures[mesh]) for mesh in counted}
    mean = math.prod(ratios.values()) ** (1 / len(ratios))
    worst = max(ratios, key=ratios.get)
    return (f"Over {', '.join(counted)}: **{mean:.2f}** times Draco's bytes in geometric mean; "
            f"the worst, {worst}, takes {ratios[worst]:.2f} times.")


def bits_a_vertex(figures, size):
    return f"{8 * size / figures['vertices']:.2f}"
