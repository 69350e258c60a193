// docs/pm-format.md, section 6.1: integer arithmetic. No number reaches 2^53, so Numbers are exact.

export const divide = (a, b) => Math.floor((2 * a + b) / (2 * b));

export function bitLength(value) {
  const size = Math.abs(value);
  return size < 2 ** 32
    ? 32 - Math.clz32(size)
    : 64 - Math.clz32(Math.floor(size / 2 ** 32));
}

export const root = (value) => Math.floor(Math.sqrt(value));

export const shiftRight = (value, bits) => Math.floor(value / 2 ** bits);

export function halfOctaves(value) {
  const bits = bitLength(value);
  return bits < 2 ? 2 * bits : 2 * bits + (shiftRight(value, bits - 2) % 2);
}

export const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

// Vectors are arrays of three.
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (factor, a) => [factor * a[0], factor * a[1], factor * a[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const divideEach = (a, b) => a.map((c) => divide(c, b));
export const shiftEach = (a, bits) => a.map((c) => shiftRight(c, bits));
export const clampEach = (a, most) => a.map((c) => clamp(c, -most, most));
/** |x| + |y| + |z| */
export const sumNorm = (a) => Math.abs(a[0]) + Math.abs(a[1]) + Math.abs(a[2]);
/** The largest of |x|, |y|, |z|. */
export const maxNorm = (a) => Math.max(Math.abs(a[0]), Math.abs(a[1]), Math.abs(a[2]));

export class MalformedFile extends Error {}

export function require(condition, what) {
  if (!condition) throw new MalformedFile(what);
}
