// docs/pm-format.md, sections 6.9, 6.10 and 6.12: the patch of a split in its local frame, where it expects
// the new position, and what the split costs.
import {
  add, bitLength, clamp, clampEach, cross, divide, divideEach, dot, halfOctaves, maxNorm, root,
  scale, shiftEach, shiftRight, subtract, sumNorm,
} from './arithmetic.js';
import { FIRST, INTERIOR, LAST, next, previous } from './mesh.js';

const sum = (vectors) => vectors.reduce(add, [0, 0, 0]);
const total = (numbers) => numbers.reduce((a, b) => a + b, 0);

export class Patch {
  constructor(mesh, site) {
    this.kind = site.kind;
    this.moved = site.moved;
    this.kept = mesh.position(mesh.kept(site));
    const { polygon, beyond } = site.moved === 0 ? ear(mesh, site) : fan(mesh, site);
    const reach = Math.max(...polygon.map((p) => maxNorm(subtract(p, this.kept))));
    this.shift = Math.max(0, bitLength(reach) - 11);
    this.polygon = polygon.map((p) => this.local(p));
    this.#measure(beyond.map((face) => this.#opposite(face.map((v) => mesh.position(v)))));
  }

  local(point) {
    return clampEach(shiftEach(scale(8, subtract(point, this.kept)), this.shift), 2 ** 17);
  }

  // Across the edge from a to b, of a face with the third corner c.
  #opposite([a, b, c]) {
    const corner = clampEach(this.local(c), 2 ** 14);
    return subtract(add(this.local(a), this.local(b)), corner);
  }

  #measure(opposites) {
    const all = [...this.polygon, [0, 0, 0]]; // and kept
    this.centroid = divideEach(sum(all), all.length);
    const mean = opposites.length === 0
      ? this.centroid : divideEach(sum(opposites), opposites.length);
    this.crosses = this.polygon.slice(1).map((p, i) => cross(this.polygon[i], p));
    this.area = total(this.crosses.map(sumNorm));
    this.#measureNormal(opposites);
    this.features = [
      subtract([0, 0, 0], this.centroid),
      subtract(divideEach(add(this.polygon[0], this.polygon.at(-1)), 2), this.centroid),
      subtract(mean, this.centroid),
      this.#areaFeature(),
    ];
    const offsets = all.map((p) => subtract(p, this.centroid));
    this.radiusSquared = Math.floor(total(offsets.map((p) => dot(p, p))) / all.length);
    this.flatness = this.#meanHeight(offsets);
    this.oppositeFlatness = this.#meanHeight(opposites.map((p) => subtract(p, mean)));
  }

  #measureNormal(opposites) {
    const long = this.moved === 0
      ? cross(this.polygon[0], subtract(opposites[0], this.polygon[0])) : sum(this.crosses);
    this.normal = shiftEach(long, Math.max(0, bitLength(maxNorm(long)) - 14));
    if (this.normal.every((c) => c === 0)) this.normal = [0, 0, 1];
    this.normalSquared = dot(this.normal, this.normal);
  }

  #areaFeature() {
    const drop = Math.max(0, bitLength(this.area) - 20);
    const weights = this.crosses.map((c) => shiftRight(sumNorm(c), drop));
    const moments = weights.map((w, i) => scale(w, add(this.polygon[i], this.polygon[i + 1])));
    const weight = total(weights);
    return weight === 0
      ? [0, 0, 0] : subtract(divideEach(sum(moments), 3 * weight), this.centroid);
  }

  height(offset) { return Math.abs(dot(offset, this.normal)); }

  #meanHeight(offsets) {
    if (offsets.length === 0) return 0;
    const heights = total(offsets.map((p) => this.height(p)));
    return Math.floor(heights / (offsets.length * root(this.normalSquared)));
  }

  // Parts of two sums of 32nds: `tangential`'s along the plane, `normal`'s across it.
  #combine(tangential, normal) {
    const along = divide(256 * dot(subtract(normal, tangential), this.normal), this.normalSquared);
    return divideEach(add(scale(256, tangential), scale(along, this.normal)), 8192);
  }

  /** Where the added vertex is expected, by the weights for this patch. */
  predict({ tangential, normal }) {
    const move = this.#combine(
      sum(this.features.map((feature, i) => scale(tangential[i], feature))),
      add(scale(normal[0], this.features[0]), scale(normal[1], this.features[2])));
    const rise = this.#rise(move);
    const spread =
      Math.floor((5 * this.flatness + 8 * rise + 6 * this.oppositeFlatness) / 16) +
      Math.floor(root(this.radiusSquared) / 64);
    return this.#prediction(add(this.centroid, move), this.radiusSquared, spread);
  }

  /** Where the kept vertex is expected once the added one stands at `added`. */
  predictKept(mirrored, added) {
    const back = scale(-1, this.local(added));
    const move = this.#combine(scale(mirrored[0], back), scale(mirrored[1], back));
    return this.#prediction(move, dot(back, back), this.#rise(back));
  }

  #rise(offset) { return Math.floor(this.height(offset) / root(this.normalSquared)); }

  #prediction(at, squared, height) {
    const magnitude = (square) => Math.min(63, bitLength(square) + 2 * this.shift);
    return { at, classes: [magnitude(squared), magnitude(height * height)] };
  }

  /** The bucket in which the split that adds `added` is applied; the highest first. */
  bucket(added) {
    const at = clampEach(this.local(added), 2 ** 14);
    const volume = total(this.crosses.map((c) => Math.abs(dot(at, c))));
    let cost = 2 * halfOctaves(volume) - halfOctaves(this.area);
    if (this.kind !== INTERIOR) {
      cost = Math.max(cost, 2 * halfOctaves(sumNorm(cross(at, this.polygon[0]))));
    }
    return clamp(Math.floor((cost + 8 * this.shift) / 2), 0, 127);
  }
}

// The moved faces' outer vertices, and the faces beyond their outer edges: the edge's ends, and the
// third corner.
function fan(mesh, site) {
  const { kind } = site;
  const spokes = mesh.fan(site);
  const outer = spokes.map(next);
  if (kind === INTERIOR) outer.push(spokes[0]);
  outer.push(kind === LAST ? spokes.at(-1) : previous(spokes.at(-1)));
  const polygon = kind === LAST
    ? [mesh.apex(spokes[0]), ...spokes.map((h) => mesh.target(h))]
    : [mesh.target(spokes[0]), ...spokes.map((h) => mesh.apex(h))];
  return {
    polygon: polygon.map((v) => mesh.position(v)),
    beyond: outer.filter((h) => !mesh.isBorder(h))
      .map((h) => [mesh.origin(h), mesh.target(h), mesh.apex(mesh.twin(h))]),
  };
}

function ear(mesh, { kind, halfEdge }) {
  const ends = [mesh.origin(halfEdge), mesh.target(halfEdge)];
  return {
    polygon: [mesh.position(ends[kind === FIRST ? 1 : 0])],
    beyond: [[...ends, mesh.apex(halfEdge)]],
  };
}
