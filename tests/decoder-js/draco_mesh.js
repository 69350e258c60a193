// docs/pm-format.md, section 5: base mesh and new components.
import draco3d from 'draco3d';
import { require } from './arithmetic.js';

const draco = await draco3d.createDecoderModule({});

/** Positions and corners as flat arrays, checked against counts and lattice. */
export function decodeDracoMesh(bytes, vertices, faces, latticeBits) {
  const decoder = new draco.Decoder();
  const mesh = new draco.Mesh();
  try {
    const status = decoder.DecodeArrayToMesh(new Int8Array(bytes), bytes.length, mesh);
    require(status.ok(), `Draco: ${status.error_msg()}`);
    require(mesh.num_points() === vertices && mesh.num_faces() === faces, 'Draco: counts');
    require(mesh.num_attributes() === 1, 'Draco: attributes');
    const positions = readPositions(decoder, mesh, vertices);
    require(positions.every((c) => c >= 0 && c < 2 ** latticeBits), 'a vertex is off the lattice');
    return { positions, corners: readCorners(decoder, mesh, faces) };
  } finally {
    draco.destroy(mesh);
    draco.destroy(decoder);
  }
}

function readPositions(decoder, mesh, vertices) {
  const values = new draco.DracoInt32Array();
  decoder.GetAttributeInt32ForAllPoints(mesh, decoder.GetAttribute(mesh, 0), values);
  require(values.size() === 3 * vertices, 'Draco: not three coordinates');
  const positions = Int32Array.from({ length: 3 * vertices }, (_, i) => values.GetValue(i));
  draco.destroy(values);
  return positions;
}

function readCorners(decoder, mesh, faces) {
  const corners = new Int32Array(3 * faces);
  const face = new draco.DracoInt32Array();
  for (let f = 0; f < faces; ++f) {
    decoder.GetFaceFromMesh(mesh, f, face);
    for (let k = 0; k < 3; ++k) corners[3 * f + k] = face.GetValue(k);
  }
  draco.destroy(face);
  return corners;
}
