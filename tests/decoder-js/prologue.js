// docs/pm-format.md, sections 3 and 4: header and index.
import { crc32c, sha256 } from './checksums.js';
import { require } from './arithmetic.js';

const MAGIC = [0x89, 0x50, 0x4d, 0x53, 0x48, 0x0d, 0x0a, 0x1a];
const FLAG = { borders: 1, relocations: 2, errors: 4, newComponents: 8 };
const FIELD = { crc: [20, 24], hash: [24, 40] };

/** Header and index of a file that is there whole. */
export function readPrologue(file) {
  const data = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const u16 = (at) => data.getUint16(at, true);
  const u32 = (at) => data.getUint32(at, true);
  const u64 = (at) => Number(data.getBigUint64(at, true));

  require(file.length >= 20 && MAGIC.every((byte, i) => file[i] === byte), 'not a PM file');
  require(u16(8) === 0, 'unknown version');
  const headerBytes = u16(10), rowBytes = u16(12), flags = u16(14), chunkCount = u32(16);
  const hasNewComponents = (flags & FLAG.newComponents) !== 0;
  const end = headerBytes + rowBytes * chunkCount;
  require(headerBytes >= 171 && headerBytes <= 256 && rowBytes >= (hasNewComponents ? 44 : 36) &&
    rowBytes <= 64 && end <= 16384 && file.length >= end, 'header: sizes');
  require((flags & ~15) === 0, 'header: flags');
  checkPrologue(file.slice(0, end), u32(20));
  require(file[92] === 1 && file[93] === 0 && file[94] === 0, 'header: codecs');

  const header = {
    end,
    fileBytes: u64(40),
    vertices: u64(48),
    faces: u64(56),
    base: { vertices: u64(64), faces: u64(72), bytes: u64(80), crc: u32(88),
            digest: file.subarray(160, 168) },
    latticeBits: file[95],
    hasBorders: (flags & FLAG.borders) !== 0,
    hasRelocations: (flags & FLAG.relocations) !== 0,
  };
  require(header.latticeBits >= 4 && header.latticeBits <= 30, 'header: lattice_bits');
  require(header.fileBytes === file.length, 'this decoder takes whole files only');

  const rows = [];
  let { vertices, faces } = header.base, offset = header.end + header.base.bytes;
  for (let at = headerBytes; at < end; at += rowBytes) {
    const bytes = u32(at);
    vertices += u32(at + 16);
    faces += u32(at + 20);
    rows.push({
      offset, bytes, crc: u32(at + 4), digest: file.subarray(at + 8, at + 16), vertices, faces,
      newVertices: hasNewComponents ? u32(at + 36) : 0,
      newFaces: hasNewComponents ? u32(at + 40) : 0,
    });
    offset += bytes;
  }
  checkRows(header, rows);
  return { header, rows };
}

// CRC and content hash, each with both (CRC) or the one (hash) of the fields zero.
function checkPrologue(prologue, crc) {
  const hash = Uint8Array.from(prologue.subarray(...FIELD.hash));
  prologue.fill(0, ...FIELD.hash);
  require(hash.every((byte, i) => byte === sha256(prologue)[i]), 'header: content hash');
  prologue.fill(0, ...FIELD.crc);
  require(crc32c(prologue) === crc, 'header: CRC');
}

function checkRows(header, rows) {
  let { vertices, faces } = header.base, end = header.end + header.base.bytes;
  for (const row of rows) {
    row.splits = row.vertices - vertices - row.newVertices;
    row.splitFaces = row.faces - faces - row.newFaces;
    require(row.bytes > 0, 'index: an empty chunk');
    require(row.vertices > vertices && row.faces > faces, 'index: counts do not grow');
    require(row.splits >= 0 && row.splitFaces <= 2 * row.splits &&
      row.splitFaces >= (header.hasBorders ? 1 : 2) * row.splits, 'index: impossible counts');
    ({ vertices, faces } = row);
    end = row.offset + row.bytes;
  }
  require(end === header.fileBytes && vertices === header.vertices && faces === header.faces,
    'index: totals');
}

export function checkSection(bytes, crc, digest, what) {
  require(crc32c(bytes) === crc, `${what}: CRC`);
  require(digest.every((byte, i) => byte === sha256(bytes)[i]), `${what}: digest`);
}
