// docs/pm-format.md, sections 6.4 and 6.5: the two streams of a chunk, and adaptive bits.
import { require } from './arithmetic.js';

// After n decisions the next one weighs RATES[n] / 65536.
const RATES = Uint16Array.from({ length: 256 }, (_, n) => Math.floor(131072 / (2 * n + 3)));

export class AdaptiveBit {
  slow = 32768;
  fast = 32768;
  seen = 0;

  get chance() { return (this.slow + this.fast) >>> 1; }

  update(bit) {
    const rate = RATES[this.seen];
    this.slow = moved(this.slow, rate, bit);
    this.fast = moved(this.fast, Math.max(rate, 2048), bit);
    if (this.seen < 255) ++this.seen;
  }
}

function moved(chance, rate, bit) {
  return bit ? chance + (((65536 - chance) * rate) >>> 16) : chance - ((chance * rate) >>> 16);
}

/** A table of adaptive bits of the given dimensions. */
export function table(...dimensions) {
  if (dimensions.length === 0) return new AdaptiveBit();
  const [size, ...rest] = dimensions;
  return Array.from({ length: size }, () => table(...rest));
}

// Decisions read less than this far into the raw bits, or beyond the chunk's end.
const AHEAD = 6;

export class ChunkReader {
  #bytes; #front = 0; #back; // read by decisions, and left by raw bits
  #range = 2 ** 48 - 1;
  #code = 0;
  #rawByte = 0; #rawLeft = 0; // the rest of the byte last taken from the back

  constructor(bytes) {
    this.#bytes = bytes;
    this.#back = bytes.length;
    for (let unit = 0; unit < 3; ++unit) this.#code = this.#code * 65536 + this.#unit();
    require(this.#code < this.#range, 'a chunk begins with 48 one bits');
  }

  #unit() {
    require(this.#front < this.#back + AHEAD, 'a chunk ends inside a batch');
    const byte = () => this.#bytes[this.#front++] ?? 0;
    return byte() * 256 + byte();
  }

  bit(model) {
    const bound = Math.floor(this.#range / 65536) * model.chance;
    const bit = this.#code < bound;
    if (bit) {
      this.#range = bound;
    } else {
      this.#range -= bound;
      this.#code -= bound;
    }
    if (this.#range < 2 ** 32) {
      this.#range *= 65536;
      this.#code = this.#code * 65536 + this.#unit();
    }
    model.update(bit);
    return bit;
  }

  /** A number of `count` <= 32 bits from the back, least significant first. */
  raw(count) {
    let value = 0;
    for (let done = 0; done < count;) {
      if (this.#rawLeft === 0) {
        require(this.#back > 0, 'a chunk ends inside a batch');
        this.#rawByte = this.#bytes[--this.#back];
        this.#rawLeft = 8;
      }
      const take = Math.min(count - done, this.#rawLeft);
      value += (this.#rawByte % 2 ** take) * 2 ** done;
      this.#rawByte >>>= take;
      this.#rawLeft -= take;
      done += take;
    }
    return value;
  }

  expectEnd() {
    require(this.#front < this.#back + AHEAD, 'a chunk ends inside a batch');
    const between = this.#bytes.subarray(this.#front, Math.max(this.#front, this.#back));
    require(this.#rawByte === 0 && between.every((byte) => byte === 0),
      'bytes follow the last split');
  }
}
