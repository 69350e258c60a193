// docs/pm-format.md, sections 6.6 to 6.12: batches of vertex splits.
import { bitLength, clamp, divide, require, shiftRight } from './arithmetic.js';
import { freeRuns, rank } from './candidates.js';
import { ChunkReader, table } from './chunk_reader.js';
import { FIRST, INTERIOR, LAST, faceOf, previous } from './mesh.js';
import { Patch } from './patch.js';

const MOST_MOVED = 255, MOST_RANKED = 64;
const BORDER = 4; // the last set of weights for fans
const WINDOW = 4096; // splits that are sorted together

const lengthModel = () => ({ above: table(), up: table(8), down: table(8) });
const residualModel = () => ({
  length: [0, 1].map(() => Array.from({ length: 64 }, lengthModel)),
  second: table(2, 32),
});

export class SplitDecoder {
  #mesh; #header; #reader;
  #covered; #coveredAt; // by face; by vertex, how many of its faces
  #families = []; // by vertex
  #sweep = []; #swept = 0; #sweptAt = 0; // how many of it are done; vertices when it began
  #bits = {
    weightLength: table(8), mark: table(2, 16, 12), gapLength: table(32),
    interior: table(16), last: table(), goesOn: table(), sweeps: table(),
    larger: table(2, 10, 16, 10), candidate: table(4, 8, 4),
    added: residualModel(), kept: residualModel(),
  };
  #weights = {
    fans: Array.from({ length: 5 }, () => ({ tangential: [4, -2, 2, 32], normal: [27, 4] })),
    mirrored: [32, 32],
    fan: [72, -74, 96],
  };

  constructor(mesh, header) {
    this.#mesh = mesh;
    this.#header = header;
    this.#covered = new Uint8Array(header.faces);
    this.#coveredAt = new Int32Array(header.vertices);
  }

  /** Decodes and applies the `count` splits that `bytes` holds. */
  decode(bytes, count) {
    this.#reader = new ChunkReader(bytes);
    for (let v = this.#families.length; v < this.#mesh.vertices; ++v) this.#families.push(v);
    while (count > 0) {
      const splits = this.#batch(count);
      this.#apply(splits);
      count -= splits.length;
    }
    this.#reader.expectEnd();
  }

  #bit(model) { return this.#reader.bit(model); }
  #raw(count) { return this.#reader.raw(count); }

  // 6.6 Batch
  #batch(most) {
    const bits = this.#raw(5);
    const count = 2 ** bits + this.#raw(bits);
    require(count <= most, 'a batch has more splits than its chunk');
    if (this.#bit(this.#bits.goesOn)) return this.#marked(count);
    const sweeps = this.#bit(this.#bits.sweeps);
    this.#readWeights();
    if (!sweeps) return this.#named(count);
    this.#beginSweep();
    return this.#marked(count);
  }

  #readWeights() {
    const { fans, mirrored, fan } = this.#weights;
    const coded = this.#header.hasBorders ? fans : fans.slice(0, BORDER);
    const lists = coded.flatMap(({ tangential, normal }) => [tangential, normal]);
    if (this.#header.hasRelocations) lists.push(mirrored);
    for (const list of [...lists, fan]) {
      list.forEach((weight, i) => { list[i] = clamp(weight + this.#weightChange(), -127, 127); });
    }
  }

  #weightChange() {
    let length = 0;
    while (length < 8 && this.#bit(this.#bits.weightLength[length])) ++length;
    return length === 0 ? 0 : this.#signed(length - 1, 2 ** (length - 1));
  }

  // A sign and, above it, the `bits` low bits of a number whose others are `high`.
  #signed(bits, high) {
    const tail = this.#raw(bits + 1);
    const size = high + Math.floor(tail / 2);
    return tail % 2 === 0 ? size : -size;
  }

  #free(v) { return this.#mesh.valence[v] - this.#coveredAt[v]; }
  #onBorder(v) { return this.#header.hasBorders && this.#mesh.border[v] ? 1 : 0; }
  #valenceClass(v) { return Math.min(this.#mesh.valence[v], 15); }

  // All vertices by family, in each by id.
  #beginSweep() {
    const { vertices } = this.#mesh;
    require(64 * (vertices - this.#sweptAt) >= vertices, 'a sweep begins too soon');
    this.#sweep = Array.from(this.#families.keys())
      .sort((a, b) => this.#families[a] - this.#families[b]); // stable
    this.#swept = 0;
    this.#sweptAt = vertices;
  }

  #marked(count) {
    const splits = [];
    while (splits.length < count) {
      require(this.#swept < this.#sweep.length, 'a batch has more splits than vertices to split');
      const v = this.#sweep[this.#swept++], free = this.#free(v);
      if (free === 0) continue;
      const marks = this.#bits.mark[this.#onBorder(v)][this.#valenceClass(v)];
      if (this.#bit(marks[Math.min(free, 11)])) splits.push(this.#split(v));
    }
    return splits;
  }

  #named(count) {
    const splits = [];
    for (let v = 0; splits.length < count; ++v) {
      v += this.#gap();
      require(v < this.#mesh.vertices && this.#free(v) > 0, 'a split of no vertex');
      splits.push(this.#split(v));
    }
    return splits;
  }

  #gap() {
    let length = 0;
    while (length < 32 && this.#bit(this.#bits.gapLength[length])) ++length;
    return length < 2 ? length : 2 ** (length - 1) + this.#raw(length - 1);
  }

  #split(v) {
    const site = this.#site(v);
    this.#cover(site);
    const patch = new Patch(this.#mesh, site);
    const { fans, mirrored } = this.#weights;
    const set = site.kind === INTERIOR ? clamp(site.moved, 2, 5) - 2 : BORDER;
    const added = this.#point(patch, patch.predict(fans[set]), this.#bits.added);
    const keptTo = this.#header.hasRelocations
      ? this.#point(patch, patch.predictKept(mirrored, added), this.#bits.kept) : patch.kept;
    return { kept: v, site, added, keptTo, bucket: patch.bucket(added) };
  }

  // 6.7 Kind and fan, 6.8 Cut neighbours
  #site(v) {
    const kind = this.#kind(v);
    const ring = this.#mesh.valence[v] <= MOST_RANKED ? this.#mesh.ring(v) : null;
    const site = kind === INTERIOR ? this.#interior(v, ring) : this.#border(v, kind, ring);
    require(this.#coveredBy(site).every((face) => !this.#covered[face]), 'two splits cover a face');
    return site;
  }

  #kind(v) {
    if (!this.#onBorder(v) || this.#bit(this.#bits.interior[this.#valenceClass(v)])) return INTERIOR;
    return this.#bit(this.#bits.last) ? LAST : FIRST;
  }

  #size(v, least, most) {
    let size = least;
    while (size < most) {
      const model =
        this.#bits.larger[least][Math.min(size, 9)][this.#valenceClass(v)][Math.min(most, 9)];
      if (!this.#bit(model)) break;
      ++size;
    }
    return size;
  }

  #interior(v, ring) {
    if (ring === null) {
      const moved = this.#size(v, 1, MOST_MOVED);
      return { kind: INTERIOR, halfEdge: this.#halfEdge(v), moved };
    }
    const closed = !this.#mesh.isBorder(ring[0]);
    const runs = freeRuns(ring, !closed, this.#covered);
    const most = Math.max(...runs);
    require(most > 0, 'no fan to split');
    const moved = this.#size(v, 1, most);
    const { candidates, lead } = rank(this.#mesh, ring, !closed, runs, moved, this.#weights.fan);
    let chosen = 0;
    while (chosen + 1 < candidates.length) {
      const after =
        chosen + 2 < candidates.length ? Math.min(3, lead(chosen, chosen + 2, 1)) : 3;
      const models = this.#bits.candidate[Math.min(chosen, 3)];
      if (this.#bit(models[Math.min(7, lead(chosen, chosen + 1, 3))][after])) break;
      ++chosen;
    }
    return { kind: INTERIOR, halfEdge: candidates[chosen].halfEdge, moved };
  }

  #border(v, kind, ring) {
    if (ring === null) {
      const leaving = this.#halfEdge(v);
      const halfEdge = kind === LAST ? previous(leaving) : leaving;
      require(this.#mesh.isBorder(halfEdge), 'a border split is not at a border');
      return { kind, halfEdge, moved: this.#size(v, 0, MOST_MOVED) };
    }
    const faces = kind === LAST ? ring.slice().reverse() : ring;
    const blocked = faces.findIndex((h) => this.#covered[faceOf(h)]);
    const moved = this.#size(v, 0, blocked === -1 ? faces.length : blocked);
    return { kind, halfEdge: kind === LAST ? previous(faces[0]) : faces[0], moved };
  }

  // The half-edge that leaves `v` in a face named outright.
  #halfEdge(v) {
    const face = this.#raw(bitLength(this.#mesh.faces - 1));
    require(face < this.#mesh.faces, 'a face does not exist');
    const corner = [0, 1, 2].find((k) => this.#mesh.origin(3 * face + k) === v);
    require(corner !== undefined, "a face is not its vertex's");
    return 3 * face + corner;
  }

  #coveredBy(site) {
    const fan = site.moved === 0 ? [site.halfEdge] : this.#mesh.fan(site);
    return fan.map(faceOf);
  }

  #cover(site) {
    for (const face of this.#coveredBy(site)) {
      this.#covered[face] = 1;
      for (let k = 0; k < 3; ++k) ++this.#coveredAt[this.#mesh.origin(3 * face + k)];
    }
  }

  // 6.11 Residuals
  #point(patch, { at, classes }, models) {
    const { normal, kept, shift } = patch;
    const sizes = normal.map(Math.abs);
    const c = sizes.indexOf(Math.max(...sizes)), a = (c + 1) % 3, b = (c + 2) % 3;
    const point = [];
    const read = (axis, expected, part) => {
      const lattice = kept[axis] + shiftRight(expected * 2 ** shift + 4, 3);
      point[axis] = this.#coordinate(lattice, models, part, classes[part]);
      const local = shiftRight(8 * (point[axis] - kept[axis]), shift);
      return clamp(local - at[axis], -(2 ** 20), 2 ** 20);
    };
    const offA = read(a, at[a], 0);
    const across = patch.normalSquared - normal[a] * normal[a];
    const offB = read(b, at[b] + divide(-normal[a] * normal[b] * offA, across), 0);
    const slope = -(normal[a] * offA + normal[b] * offB) * Math.sign(normal[c]);
    read(c, at[c] + divide(slope, Math.abs(normal[c])), 1);
    return point;
  }

  #coordinate(lattice, models, part, likely) {
    const most = 2 ** this.#header.latticeBits - 1;
    const expected = clamp(lattice, 0, most);
    const centre = Math.max(0, Math.floor(likely / 2) - (part === 0 ? 5 : 4));
    const length = this.#length(models.length[part][likely], centre);
    const coordinate = expected + this.#residual(length, models.second[part][length]);
    require(coordinate >= 0 && coordinate <= most, 'a vertex is off the lattice');
    return coordinate;
  }

  #length(model, centre) {
    let length = centre;
    if (this.#bit(model.above)) {
      ++length;
      while (length < 31 && this.#bit(model.up[Math.min(length - centre - 1, 7)])) ++length;
    } else {
      while (length > 0 && this.#bit(model.down[Math.min(centre - length, 7)])) --length;
    }
    return length;
  }

  #residual(length, second) {
    if (length === 0) return 0;
    if (length === 1) return this.#signed(0, 1);
    const high = this.#bit(second) ? 3 : 2;
    return this.#signed(length - 2, high * 2 ** (length - 2));
  }

  // 6.12 Order of application
  #apply(splits) {
    for (const { site } of splits) {
      for (const face of this.#coveredBy(site)) {
        this.#covered[face] = 0;
        for (let k = 0; k < 3; ++k) this.#coveredAt[this.#mesh.origin(3 * face + k)] = 0;
      }
    }
    for (let first = 0; first < splits.length; first += WINDOW) {
      const window = splits.slice(first, first + WINDOW);
      window.sort((a, b) => b.bucket - a.bucket); // stable
      for (const { kept, site, added, keptTo } of window) {
        this.#mesh.split(site, added, keptTo);
        this.#families.push(this.#families[kept]);
      }
    }
  }
}
