"""Draco as Debian packages it: draco_encoder and draco_decoder."""

import pathlib

from lab import carry_out

LEVEL = 10  # of compression, the best


def encode(mesh, bits):
    """The Draco file of a mesh file."""
    file = mesh.with_suffix(f".q{bits}.drc")
    carry_out(["draco_encoder", "-i", mesh, "-o", file, "-cl", LEVEL, "-qp", bits])
    return file


def of_lattice(lab, mesh, bits):
    """The Draco file that holds the same mesh as lab.pm_file(mesh, bits): see lattice_mesh.cpp.
    Ends the run if it does not."""
    pm_file = lab.pm_file(mesh, bits)
    file = encode(lab.lattice_mesh(pm_file)[0], bits)
    carry_out([lab.program("decode_rates"), pm_file, file, 1])
    return file


def decode(file):
    """The mesh file that a Draco file holds."""
    mesh = file.with_suffix(".decoded.obj")
    carry_out(["draco_decoder", "-i", file, "-o", mesh])
    return mesh


def one_shot(lab, mesh, faces, bits):
    """A level of at most so many faces as one Draco file: {faces, bits, bytes, file}."""
    file = encode(lab.lod(mesh, faces), bits)
    return {"faces": faces, "bits": bits, "bytes": file.stat().st_size, "file": str(file)}


def distance(lab, mesh, file):
    """Of what a Draco file holds to the original: see Lab.distance."""
    return lab.distance(mesh, decode(pathlib.Path(file)))
