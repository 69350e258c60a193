"""Shaded drawings of small meshes as SVG, and the PLY files to get them from."""

import math
import struct
from dataclasses import dataclass

import plot

LIGHT = (-0.35, 0.5, 0.79)  # right, up, towards the viewer


@dataclass(frozen=True)
class View:
    turn: float  # degrees about the upright axis
    rise: float  # of the viewer, degrees
    axes: tuple = (0, 1, 2)  # of the file, cyclic, that are drawn as x, y and upright z
    closed: bool = False  # faces turned away cannot be seen


def write_ply(path, positions, triangles):
    lines = ["ply", "format ascii 1.0", f"element vertex {len(positions)}",
             *(f"property double {axis}" for axis in "xyz"), f"element face {len(triangles)}",
             "property list uchar int vertex_indices", "end_header",
             *(" ".join(repr(value) for value in position) for position in positions),
             *("3 " + " ".join(map(str, triangle)) for triangle in triangles)]
    path.write_text("\n".join(lines) + "\n")


def read_ply(path):
    """(positions, triangles) of a file that bench/peers wrote: binary, double, triangles alone."""
    data = path.read_bytes()
    header, _, body = data.partition(b"end_header\n")
    counts = {words[1]: int(words[2]) for words in map(bytes.split, header.splitlines())
              if words[0] == b"element"}
    positions = [struct.unpack_from("<3d", body, 24 * i) for i in range(counts[b"vertex"])]
    start = 24 * counts[b"vertex"]
    triangles = [struct.unpack_from("<3I", body, start + 13 * i + 1)
                 for i in range(counts[b"face"])]
    return positions, triangles


def strip(meshes, view, size=250):
    """SVG text of the (caption, positions, triangles) side by side, all in the same scale."""
    seen = [[project(p, view) for p in positions] for _, positions, _ in meshes]
    flat = [point for points in seen for point in points]
    left, right = min(p[0] for p in flat), max(p[0] for p in flat)
    low, high = min(p[1] for p in flat), max(p[1] for p in flat)
    scale = size / (right - left)
    height = scale * (high - low)
    parts = []
    for number, ((caption, _, triangles), points) in enumerate(zip(meshes, seen)):
        at = 12 + number * (size + 24)
        places = [(at + scale * (x - left), 12 + scale * (high - y)) for x, y, _ in points]
        parts += draw(places, points, triangles, view.closed)
        parts.append(plot.text(at + size / 2, 12 + height + 24, caption, "middle"))
    return plot.document(len(meshes) * (size + 24), height + 50, parts)


def project(p, view):
    """(right, up, towards the viewer)"""
    x, y, z = (p[axis] for axis in view.axes)
    turn, rise = math.radians(view.turn), math.radians(view.rise)
    along = x * math.cos(turn) - y * math.sin(turn)
    away = x * math.sin(turn) + y * math.cos(turn)
    return (along, z * math.cos(rise) + away * math.sin(rise),
            z * math.sin(rise) - away * math.cos(rise))


def draw(places, points, triangles, closed):
    """The faces, the farthest first."""
    parts = ['<g stroke="#33475b" stroke-width="0.5" stroke-linejoin="round">']
    for triangle in sorted(triangles, key=lambda t: sum(points[corner][2] for corner in t)):
        normal = normal_of(*(points[corner] for corner in triangle))
        if closed and normal[2] <= 0:
            continue
        corners = "L".join("{:.1f} {:.1f}".format(*places[corner]) for corner in triangle)
        parts.append(f'<path d="M{corners}z" fill="{shade(normal)}"/>')
    return parts + ["</g>"]


def normal_of(a, b, c):
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    size = math.hypot(*normal) or 1
    return tuple(component / size for component in normal)


def shade(normal):
    light = max(0.0, sum(n * l for n, l in zip(normal, LIGHT)) / math.hypot(*LIGHT))
    return "#" + "".join(f"{round(dark + (bright - dark) * light):02x}"
                         for dark, bright in ((60, 226), (90, 238), (125, 250)))
