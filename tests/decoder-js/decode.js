// decode.js FILE: prints, for the base mesh and after every chunk, vertices, faces and the CRC-32C
// over positions (three i32 a vertex) and faces (three u32 a face).
import { readFileSync } from 'node:fs';
import { require } from './arithmetic.js';
import { crc32c } from './checksums.js';
import { decodeDracoMesh } from './draco_mesh.js';
import { Mesh } from './mesh.js';
import { checkSection, readPrologue } from './prologue.js';
import { SplitDecoder } from './split_decoder.js';

// Little-endian machines only, as all are that run Node.js today.
function print(mesh) {
  const digested = new Uint8Array(12 * (mesh.vertices + mesh.faces));
  const words = new Int32Array(digested.buffer);
  words.set(mesh.positions.subarray(0, 3 * mesh.vertices));
  words.set(mesh.origins.subarray(0, 3 * mesh.faces), 3 * mesh.vertices);
  const digest = crc32c(digested).toString(16).padStart(8, '0');
  console.log(`${mesh.vertices} ${mesh.faces} ${digest}`);
}

function decodeChunk(chunk, row, header, mesh, splits) {
  let rest = chunk;
  if (row.newFaces > 0) {
    require(chunk.length >= 4, 'new components overrun their chunk');
    const end = 4 + new DataView(chunk.buffer, chunk.byteOffset).getUint32(0, true);
    require(end <= chunk.length, 'new components overrun their chunk');
    require(64 * (end - 4) >= row.newFaces, 'too few bytes for the new components');
    mesh.append(decodeDracoMesh(chunk.subarray(4, end), row.newVertices, row.newFaces,
      header.latticeBits));
    rest = chunk.subarray(end);
  }
  if (row.splits > 0) {
    splits.decode(rest, row.splits);
  } else {
    require(rest.length === 0, 'bytes follow the new components');
  }
  require(mesh.faces === row.faces, 'the face count differs from the index');
}

function decode(file) {
  const { header, rows } = readPrologue(file);
  const { base } = header;
  const section = file.subarray(header.end, header.end + base.bytes);
  checkSection(section, base.crc, base.digest, 'base mesh');
  const mesh = new Mesh(header.vertices, header.faces);
  mesh.append(decodeDracoMesh(section, base.vertices, base.faces, header.latticeBits));
  print(mesh);

  const splits = new SplitDecoder(mesh, header);
  rows.forEach((row, c) => {
    const chunk = file.subarray(row.offset, row.offset + row.bytes);
    checkSection(chunk, row.crc, row.digest, `chunk ${c}`);
    decodeChunk(chunk, row, header, mesh, splits);
    print(mesh);
  });
}

decode(readFileSync(process.argv[2]));
