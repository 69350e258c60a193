// docs/pm-format.md, sections 6.2 and 6.3: a triangle mesh as half-edges, the ring of a vertex, and
// the application of a vertex split.
import { require } from './arithmetic.js';

export const INTERIOR = 0, FIRST = 1, LAST = 2;

const NONE = -1;
export const next = (h) => (h % 3 === 2 ? h - 2 : h + 1);
export const previous = (h) => (h % 3 === 0 ? h + 2 : h - 1);
export const faceOf = (h) => Math.floor(h / 3);

export class Mesh {
  constructor(vertices, faces) {
    this.vertices = 0;
    this.faces = 0;
    this.positions = new Int32Array(3 * vertices);
    this.origins = new Int32Array(3 * faces);
    this.twins = new Int32Array(3 * faces).fill(NONE);
    this.anyHalfEdge = new Int32Array(vertices).fill(NONE); // that leaves the vertex
    this.valence = new Int32Array(vertices); // in faces
    this.border = new Uint8Array(vertices); // whether the vertex is on a border
  }

  /** Appends a mesh of its own, the base or new components. */
  append({ positions, corners }) {
    const firstVertex = this.vertices, firstHalfEdge = 3 * this.faces;
    this.positions.set(positions, 3 * firstVertex);
    this.vertices += positions.length / 3;
    this.faces += corners.length / 3;
    const edges = new Map();
    const key = (a, b) => a * this.vertices + b;
    for (let c = 0; c < corners.length; ++c) {
      this.#set(firstHalfEdge + c, firstVertex + corners[c]);
    }
    for (let h = firstHalfEdge; h < 3 * this.faces; ++h) {
      const edge = key(this.origins[h], this.target(h));
      require(!edges.has(edge) && this.origins[h] !== this.target(h), 'not a manifold');
      edges.set(edge, h);
    }
    for (let h = firstHalfEdge; h < 3 * this.faces; ++h) {
      this.twins[h] = edges.get(key(this.target(h), this.origins[h])) ?? NONE;
      if (this.twins[h] === NONE) this.border[this.origins[h]] = 1;
    }
    for (let v = firstVertex; v < this.vertices; ++v) {
      require(this.valence[v] > 0 && this.ring(v).length === this.valence[v], 'not a manifold');
    }
  }

  #set(h, v) {
    this.origins[h] = v;
    this.anyHalfEdge[v] = h;
    ++this.valence[v];
  }

  origin(h) { return this.origins[h]; }
  target(h) { return this.origins[next(h)]; }
  apex(h) { return this.origins[previous(h)]; }
  twin(h) { return this.twins[h]; }
  isBorder(h) { return this.twins[h] === NONE; }
  counterClockwise(h) { return this.twins[previous(h)]; }
  clockwise(h) { return this.twins[h] === NONE ? NONE : next(this.twins[h]); }
  position(v) { return Array.from(this.positions.subarray(3 * v, 3 * v + 3)); }

  /** The half-edges that leave `v`, counter-clockwise, from the border or the smallest face. */
  ring(v) {
    const any = this.anyHalfEdge[v];
    let start = any;
    for (let h = this.clockwise(any); h !== any; h = this.clockwise(start)) {
      if (h === NONE) break;
      start = h;
    }
    const onBorder = this.isBorder(start);
    if (!onBorder) start = any;
    const ring = [start];
    for (let h = this.counterClockwise(start); h !== start && h !== NONE;
         h = this.counterClockwise(h)) {
      ring.push(h);
    }
    if (onBorder) return ring;
    const smallest = ring.indexOf(Math.min(...ring));
    return [...ring.slice(smallest), ...ring.slice(0, smallest)];
  }

  /** The kept vertex's half-edges in the moved faces, in the order in which the kind walks. */
  fan({ kind, halfEdge, moved }) {
    const fan = [];
    let h = kind === LAST ? next(halfEdge) : halfEdge;
    while (fan.length < moved) {
      require(h !== NONE && !(h === fan[0]), 'a split moves more faces than there are');
      fan.push(h);
      h = kind === LAST ? this.clockwise(h) : this.counterClockwise(h);
    }
    require(kind !== INTERIOR || h !== fan[0], 'all faces of an interior vertex move');
    return fan;
  }

  /** The vertex that a split keeps. */
  kept({ kind, halfEdge }) {
    return kind === LAST ? this.target(halfEdge) : this.origin(halfEdge);
  }

  /** Applies a split: `added` is the new vertex's position, `keptTo` the kept vertex's. */
  split(site, added, keptTo) {
    const { kind, halfEdge, moved } = site;
    const fan = this.fan(site), kept = this.kept(site), vertex = this.vertices++;
    this.positions.set(keptTo, 3 * kept);
    this.positions.set(added, 3 * vertex);
    this.border[vertex] = kind === INTERIOR ? 0 : 1;

    // The fan's two sides: half-edges within and beyond it, and the cut neighbour.
    const toLeft = kind === LAST ? fan.at(-1) : fan[0];
    const fromRight = moved === 0 ? NONE : previous(fan.at(-1));
    const left = moved === 0 ? this.origin(halfEdge) : this.target(toLeft);
    const right = moved === 0 ? this.target(halfEdge) : this.origin(fromRight);
    const beyondLeft = moved === 0 ? halfEdge : this.twins[toLeft];
    const beyondRight = moved === 0 ? halfEdge : this.twins[fromRight];

    for (const h of fan) {
      --this.valence[kept];
      this.#set(h, vertex);
    }
    let addedToKept = NONE;
    if (kind !== FIRST) {
      const l = this.#appendFace(vertex, kept, left);
      addedToKept = l;
      this.#join(l + 1, beyondLeft);
      this.#join(l + 2, moved === 0 ? NONE : toLeft);
    }
    if (kind !== LAST) {
      const r = this.#appendFace(vertex, right, kept);
      this.#join(r, fromRight);
      this.#join(r + 1, beyondRight);
      this.#join(r + 2, addedToKept);
    }
  }

  #appendFace(a, b, c) {
    const h = 3 * this.faces++;
    [a, b, c].forEach((v, corner) => this.#set(h + corner, v));
    return h;
  }

  #join(a, b) {
    this.twins[a] = b;
    if (b !== NONE) this.twins[b] = a;
  }
}
