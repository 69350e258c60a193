// docs/pm-format.md, section 6.8: which runs of faces an interior split may move, likeliest first.
import { bitLength, dot, maxNorm, root, shiftRight, subtract } from './arithmetic.js';
import { faceOf } from './mesh.js';

/** By face of the ring: how many free faces follow from it on, itself included. */
export function freeRuns(ring, onBorder, covered) {
  const faces = ring.length, most = onBorder ? faces : faces - 1;
  return ring.map((_, first) => {
    let run = 0;
    while (run < most && (!onBorder || first + run < faces) &&
           !covered[faceOf(ring[(first + run) % faces])]) {
      ++run;
    }
    return run;
  });
}

/** The runs of `length` faces by falling score; each with its first half-edge. */
export function rank(mesh, ring, onBorder, runs, length, weights) {
  const spokes = measureSpokes(mesh, ring, onBorder);
  const mean = Math.max(1,
    Math.floor(spokes.reduce((sum, spoke) => sum + spoke.length, 0) / spokes.length));
  const inners = Math.max(1, length - 1);
  const unit = 2 * inners * (length + 2) * mean;
  const candidates = [];
  for (const [first, halfEdge] of ring.entries()) {
    if (runs[first] < length) continue;
    const run = Array.from({ length: length + 1 }, (_, i) => spokes[(first + i) % spokes.length]);
    candidates.push({ halfEdge, score: score(run, mean, inners, weights) });
  }
  candidates.sort((a, b) => b.score - a.score);
  const lead = (i, j, factor) =>
    shiftRight(Math.floor((factor * (candidates[i].score - candidates[j].score)) / unit), 4);
  return { candidates, lead };
}

function measureSpokes(mesh, ring, onBorder) {
  const centre = mesh.position(mesh.origin(ring[0]));
  const ends = ring.map((h) => mesh.target(h));
  if (onBorder) ends.push(mesh.apex(ring.at(-1)));
  const spokes = ends.map((v) => subtract(mesh.position(v), centre));
  const shift = Math.max(0, bitLength(Math.max(...spokes.map(maxNorm))) - 14);
  return spokes.map((spoke) => {
    const at = spoke.map((c) => 8 * shiftRight(c, shift));
    return { at, length: root(dot(at, at)) };
  });
}

function score(run, mean, inners, [innerWeight, cutWeight, centreWeight]) {
  const all = run.length + 1;
  const cut = run[0].length + run.at(-1).length;
  const inner = run.length === 2
    ? mean : run.slice(1, -1).reduce((sum, spoke) => sum + spoke.length, 0);
  const centre = [0, 1, 2].map((axis) => run.reduce((sum, spoke) => sum + spoke.at[axis], 0));
  return 2 * innerWeight * inner * all + cutWeight * cut * inners * all +
    2 * centreWeight * root(dot(centre, centre)) * inners;
}
