// The pixels of a PNG file of 8 or 16 bits in full depth, which pictures of the browser have not: {width, height, values, rgb},
// grey values or the luma of colours from 0 to 65535, as the programs decode them.
export async function decodedPng(bytes, name) {
  "use strict";
  const refused = words => Object.assign(new Error(`${name}: ${words}`), {status: 2});
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 33 || view.getUint32(0) !== 0x89504e47) throw refused("is no PNG; convert it");
  const width = view.getUint32(16), height = view.getUint32(20), depth = bytes[24], kind = bytes[25];
  const channels = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}[kind];
  if (!channels || depth < 8 || bytes[28] !== 0) throw refused("is interlaced, or has fewer than 8 bits; save it as plain PNG of 8 or 16 bits");
  if (width * height > 2 ** 26) throw refused(`is ${width} x ${height} pixels; scale it down`);

  const parts = [];
  let palette = null;
  for (let at = 8; at + 12 <= bytes.length;) {
    const length = view.getUint32(at), type = String.fromCharCode(...bytes.subarray(at + 4, at + 8)), data = bytes.subarray(at + 8, at + 8 + length);
    if (type === "IDAT") parts.push(data);
    if (type === "PLTE") palette = data;
    at += 12 + length;
  }
  const stream = new Blob(parts).stream().pipeThrough(new DecompressionStream("deflate"));
  const raw = new Uint8Array(await new Response(stream).arrayBuffer()), step = channels * depth / 8, row = width * step;
  if (raw.length < height * (row + 1)) throw refused("ends too early; save it again");

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
