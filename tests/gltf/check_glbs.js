// check_glbs.js FOLDER LATTICE: what write_glbs has written is valid glTF, and both files hold the
// same lattice points and the same faces, in the same orientation.
import { readFileSync } from 'node:fs';
import validator from 'gltf-validator';
import { readGlb } from './glb.js';

const [folder, lattice] = [process.argv[2], JSON.parse(process.argv[3])];
const mostSteps = 0.25; // off the lattice, for meshes of 20 bits; tests/core/io is stricter

/** The validator knows no Draco and says so, for information. */
async function validate(name, mostInfos) {
  const bytes = new Uint8Array(readFileSync(`${folder}/${name}`));
  const { issues } = await validator.validateBytes(bytes);
  if (issues.numErrors + issues.numWarnings > 0 || issues.numInfos > mostInfos) {
    throw new Error(`${name}: ${JSON.stringify(issues, null, 1)}`);
  }
  return readGlb(bytes);
}

/** Every face by its lattice points, the smallest first, sorted. */
function facesOnLattice({ positions, corners }) {
  const points = [];
  for (let v = 0; v < positions.length; v += 3) {
    points.push(lattice.origin.map((low, axis) => snapped((positions[v + axis] - low) / lattice.step)).join());
  }
  const faces = [];
  for (let c = 0; c < corners.length; c += 3) {
    const [i, j, k] = [points[corners[c]], points[corners[c + 1]], points[corners[c + 2]]];
    faces.push([`${i} ${j} ${k}`, `${j} ${k} ${i}`, `${k} ${i} ${j}`].sort()[0]);
  }
  return faces.sort();
}

function snapped(coordinate) {
  const nearest = Math.round(coordinate);
  if (Math.abs(coordinate - nearest) > mostSteps) throw new Error(`${coordinate} is off the lattice`);
  return nearest;
}

const plain = facesOnLattice(await validate('plain.glb', 0));
const draco = facesOnLattice(await validate('draco.glb', 2));
if (plain.length === 0 || plain.join('\n') !== draco.join('\n')) throw new Error('the faces differ');
console.log(`${plain.length} faces`);
