"""The PM files that are served: meshes of noise, made once by `pmesh precompute` and kept."""

import array
import json
import os
import random
import struct
import subprocess
from dataclasses import dataclass

# Squares of so many vertices: files of over 10 and over 64 MiB, and two small ones, of which the
# first has a chunk of 64 KiB.
SIDES = {"ten": 1170, "large": 2940, "small": 300, "other": 310}


@dataclass(frozen=True)
class Sample:
    path: object  # of the PM file
    id: str
    hash: str
    file_bytes: int
    chunks: list  # (offset, bytes)

    @property
    def target(self):
        return f"/{self.id}/{self.hash}.pmesh"

    def chunk_near(self, size):
        """The number of the chunk whose length is nearest to `size`."""
        return min(range(len(self.chunks)), key=lambda n: abs(self.chunks[n][1] - size))

    def prefix_within(self, size):
        """The bytes that the wish `bytes=size` gives."""
        return max(offset + length for offset, length in self.chunks if offset + length <= size)

    def part(self, offset, length):
        with self.path.open("rb") as file:
            file.seek(offset)
            return file.read(length)


def write_noise(path, side):
    """A PLY file: a square of side x side vertices without any order in their heights, which no
    codec can make small."""
    draw = random.Random(5).random
    positions = array.array("d", (value for row in range(side) for column in range(side)
                                  for value in (column + 0.8 * draw(), row + 0.8 * draw(),
                                                side * draw())))
    quad = struct.Struct("<BiiiBiii").pack
    with path.open("wb") as out:
        out.write(f"""ply
format binary_little_endian 1.0
element vertex {side * side}
property double x
property double y
property double z
element face {2 * (side - 1) ** 2}
property list uchar int vertex_indices
end_header
""".encode())
        positions.tofile(out)
        for row in range(0, side * (side - 1), side):
            out.write(b"".join(quad(3, k, k + 1, k + side, 3, k + 1, k + side + 1, k + side)
                               for k in range(row, row + side - 1)))


def warm(path):
    """Reads a file into the page cache anew, so that all files lie there alike: what sendfile costs
    depends on it, and differs by how a file was written."""
    with path.open("rb") as file:
        os.fsync(file.fileno())
        os.posix_fadvise(file.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
        while file.read(2**20):
            pass


def describe(program, path):
    """The Sample of a PM file."""
    done = subprocess.run([program, "info", "--json", path], check=True, capture_output=True)
    info = json.loads(done.stdout)
    return Sample(path, path.stem, info["hash"], info["file_bytes"],
                  [(chunk["offset"], chunk["bytes"]) for chunk in info["chunks"]])


def noise(program, folder, name):
    """The sample `name` of SIDES, made in `folder` if it is not there yet."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.pmesh"
    if not path.exists():
        print(f"making {path}, once", flush=True)
        source = folder.parent / f"{name}.ply"
        write_noise(source, SIDES[name])
        subprocess.run([program, "precompute", source, "-o", path, "--quantization", "24",
                        "--no-measure", "--quiet"], check=True)
        source.unlink()
    return describe(program, path)
