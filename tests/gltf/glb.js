// Reads the mesh of a GLB as pmesh writes it: positions where the node puts them, and corners.
import draco3d from 'draco3d';

const draco = await draco3d.createDecoderModule({});

const componentArrays = { 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array };

export function readGlb(bytes) {
  const header = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const jsonBytes = header.getUint32(12, true);
  const gltf = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + jsonBytes)));
  const buffer = bytes.slice(28 + jsonBytes);
  const primitive = gltf.meshes[0].primitives[0];
  const compressed = primitive.extensions?.KHR_draco_mesh_compression;
  const mesh = compressed ? decode(gltf, buffer, compressed) : readAccessors(gltf, buffer, primitive);
  checkCounts(mesh, gltf.accessors[primitive.attributes.POSITION], gltf.accessors[primitive.indices]);
  return { positions: placed(gltf.nodes[0], mesh.positions), corners: mesh.corners };
}

function readAccessors(gltf, buffer, primitive) {
  const read = (accessor, components) => {
    const { byteOffset = 0 } = gltf.bufferViews[accessor.bufferView];
    const Numbers = componentArrays[accessor.componentType];
    return new Numbers(buffer.buffer, byteOffset, components * accessor.count);
  };
  return {
    positions: read(gltf.accessors[primitive.attributes.POSITION], 3),
    corners: read(gltf.accessors[primitive.indices], 1),
  };
}

function decode(gltf, buffer, { bufferView, attributes }) {
  const { byteOffset = 0, byteLength } = gltf.bufferViews[bufferView];
  const decoder = new draco.Decoder();
  const mesh = new draco.Mesh();
  const bytes = new Int8Array(buffer.buffer, byteOffset, byteLength);
  const status = decoder.DecodeArrayToMesh(bytes, byteLength, mesh);
  if (!status.ok()) throw new Error(`Draco: ${status.error_msg()}`);

  const values = new draco.DracoFloat32Array();
  const attribute = decoder.GetAttributeByUniqueId(mesh, attributes.POSITION);
  decoder.GetAttributeFloatForAllPoints(mesh, attribute, values);
  const positions = Float32Array.from({ length: values.size() }, (_, i) => values.GetValue(i));

  const face = new draco.DracoInt32Array();
  const corners = new Uint32Array(3 * mesh.num_faces());
  for (let f = 0; f < mesh.num_faces(); ++f) {
    decoder.GetFaceFromMesh(mesh, f, face);
    for (let k = 0; k < 3; ++k) corners[3 * f + k] = face.GetValue(k);
  }
  for (const object of [face, values, mesh, decoder]) draco.destroy(object);
  return { positions, corners };
}

function checkCounts({ positions, corners }, positionAccessor, indexAccessor) {
  if (positions.length !== 3 * positionAccessor.count || corners.length !== indexAccessor.count) {
    throw new Error('an accessor has another count than its data');
  }
}

function placed({ scale = [1, 1, 1], translation = [0, 0, 0] }, positions) {
  return Float64Array.from(positions, (c, i) => translation[i % 3] + scale[i % 3] * c);
}
