// The bytes that parts of a deflated stream hold, where they are `count`; of more or fewer the words that refuse them.
async function inflatedParts(parts, count, refused) {
  "use strict";
  const reader = new Blob(parts).stream().pipeThrough(new DecompressionStream("deflate")).getReader(), bytes = new Uint8Array(count);
  let taken = 0;
  for (;;) {
    const {done, value} = await reader.read().catch(() => { throw refused("is damaged, or ends too early; save it again"); });
    if (done) break;
    if (taken + value.length > count) {
      reader.cancel().catch(() => {});
      throw refused("holds more bytes than its pixels have; save it again");
    }
    bytes.set(value, taken);
    taken += value.length;
  }
  if (taken < count) throw refused("ends too early; save it again");
  return bytes;
}

// The pixels of a PNG file of 8 or 16 bits in full depth, which pictures of the browser have not: {width, height, values, rgb},
// grey values or the luma of colours from 0 to 65535, as the programs decode them.
export async function decodedPng(bytes, name) {
  "use strict";
  const refused = words => Object.assign(new Error(`${name}: ${words}`), {status: 2});
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 33 || view.getUint32(0) !== 0x89504e47) throw refused("is no PNG; convert it");
  const width = view.getUint32(16), height = view.getUint32(20), depth = bytes[24], kind = bytes[25];
  const channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[kind];
  if (!channels || (depth !== 8 && (depth !== 16 || kind === 3)) || bytes[28] !== 0) throw refused("is interlaced, or has fewer than 8 bits; save it as plain PNG of 8 or 16 bits");
  if (width * height > 2 ** 26) throw refused(`is ${width} x ${height} pixels; scale it down`);

  const parts = [];
  let palette = null;
  for (let at = 8; at + 12 <= bytes.length;) {
    const length = view.getUint32(at), type = String.fromCharCode(...bytes.subarray(at + 4, at + 8)), data = bytes.subarray(at + 8, at + 8 + length);
    if (type === "IDAT") parts.push(data);
    if (type === "PLTE" && kind === 3) palette = data;  // colours may have one, too, as a mere proposal
    at += 12 + length;
  }
  if (kind === 3 && !palette) throw refused("lacks its palette; save it again");
  const step = channels * depth / 8, row = width * step, raw = await inflatedParts(parts, height * (row + 1), refused);

  // Each row is stored as differences from its neighbours.
  const plain = new Uint8Array(height * row);
  for (let y = 0; y < height; ++y) {
    const filter = raw[y * (row + 1)], from = y * (row + 1) + 1, to = y * row;
    for (let x = 0; x < row; ++x) {
      const a = x >= step ? plain[to + x - step] : 0, b = y > 0 ? plain[to + x - row] : 0, c = x >= step && y > 0 ? plain[to + x - row - step] : 0;
      const p = a + b - c, [pa, pb, pc] = [Math.abs(p - a), Math.abs(p - b), Math.abs(p - c)];
      plain[to + x] = raw[from + x] + [0, a, b, a + b >> 1, pa <= pb && pa <= pc ? a : pb <= pc ? b : c][filter];
    }
  }

  const sample = depth === 8 ? i => 257 * plain[i] : i => plain[2 * i] << 8 | plain[2 * i + 1];
  const values = new Uint16Array(width * height), isGrey = kind === 0 || kind === 4, rgb = isGrey ? null : new Uint16Array(3 * values.length);
  for (let i = 0; i < values.length; ++i) {
    if (isGrey) {
      values[i] = sample(channels * i);
      continue;
    }
    const color = palette ? [0, 1, 2].map(k => 257 * palette[3 * plain[i] + k]) : [0, 1, 2].map(k => sample(channels * i + k));
    rgb.set(color, 3 * i);
    values[i] = Math.floor((2126 * color[0] + 7152 * color[1] + 722 * color[2] + 5000) / 10000);
  }
  return {width, height, values, rgb};
}
