"""Markdown tables of what was measured."""

import math


def table(header, rows):
    lines = ["| " + " | ".join(header) + " |", "| --- |" + " --: |" * (len(header) - 1)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"


def speed_table(speed, tools, meshes, earlier):
    """speed[mesh][tool] = {faces, seconds, ...}, the best of all rounds."""

    def cell(mesh, tool):
        run = speed[mesh].get(tool.name)
        reference = speed[mesh].get(tools[0].name)
        if not run:
            return "-"
        rate = f"{run['faces'] / run['seconds'] / 1000:.0f}"
        return f"{rate} ({run['seconds'] / reference['seconds']:.2f})" if reference else rate

    rows = [[tool.name] + [cell(mesh, tool) for mesh in meshes] for tool in tools]
    for name, figures in earlier["speed"].items():
        ratios = figures["time_to_meshoptimizer"]
        rows.append([f"*{name}*"] + [f"({ratios[m]})" if m in ratios else "-" for m in meshes])
    return table(["tool", *meshes], rows)


def memory_table(speed, tools, meshes):
    def cell(mesh, tool):
        run = speed[mesh].get(tool.name)
        if not run:
            return "-"
        return f"{run['mesh_bytes'] / run['faces']:.0f} + {run['peak_bytes'] / run['faces']:.0f}"

    rows = [[tool.name] + [cell(mesh, tool) for mesh in meshes] for tool in tools]
    return table(["tool", *meshes], rows)


def error_table(curves, levels):
    """curves: of one mesh, (name, class, {level: (max, rms)}), in % of the diagonal."""
    rows = [[name, placement]
            + ["{:.4g} / {:.3g}".format(*errors[level]) if level in errors else "-"
               for level in levels]
            for name, placement, errors in curves]
    return table(["tool", "class", *(level_name(level) for level in levels)], rows)


def ratio_table(curves, levels):
    """The RMS of pmesh's rows over that of every peer of the same class: over those of `levels`
    that both have, the geometric mean and (the greatest)."""
    rivals = [curve for curve in curves if not curve[0].startswith("pmesh ")]

    def cell(ours, theirs):
        common = [level for level in levels if level in ours[2] and level in theirs[2]]
        if ours[1] != theirs[1] or not common:
            return "-"
        ratios = [ours[2][level][1] / theirs[2][level][1] for level in common]
        return f"{math.prod(ratios) ** (1 / len(ratios)):.2f} ({max(ratios):.2f})"

    rows = [[ours[0]] + [cell(ours, theirs) for theirs in rivals]
            for ours in curves if ours not in rivals]
    return table(["RMS relative to", *(rival[0] for rival in rivals)], rows)


def level_name(level):
    return f"{level}%" if float(level) <= 100 else f"{level} faces"
