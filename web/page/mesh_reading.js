// Meshes of files that are dropped on the page: PLY, OBJ and STL, as {positions, normals, triangles, place, figures}. Polygons
// become fans. What else the programs read (docs/tutorial.md) is left to them.
import {meshPlace} from "../../estimation/page/mesh_place.js";

export function readMesh(bytes, name) {
  "use strict";
  const kind = name.toLowerCase().replace(/.*\./, "");
  const refused = words => Object.assign(new Error(`${name}: ${words}`), {status: 2});
  const text = () => new TextDecoder().decode(bytes);

  function fans(corners, triangles) {
    for (let i = 2; i < corners.length; ++i) triangles.push(corners[0], corners[i - 1], corners[i]);
  }

  function objMesh() {
    const positions = [], triangles = [];
    for (const line of text().split("\n")) {
      const words = line.trim().split(/\s+/);
      if (words[0] === "v") positions.push(+words[1], +words[2], +words[3]);
      if (words[0] !== "f") continue;
      fans(words.slice(1).map(word => parseInt(word, 10)).map(i => i < 0 ? positions.length / 3 + i : i - 1), triangles);
    }
    return {positions, triangles};
  }

  // Corners of triangles, of which those at one place become one vertex.
  function welded(corners) {
    const positions = [], triangles = new Uint32Array(corners.length / 3), numbers = new Map();
    for (let i = 0; i < triangles.length; ++i) {
      const p = corners.subarray(3 * i, 3 * i + 3), key = p.join();
      if (!numbers.has(key)) {
        numbers.set(key, numbers.size);
        positions.push(...p);
      }
      triangles[i] = numbers.get(key);
    }
    return {positions, triangles};
  }
  function stlMesh() {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const count = bytes.length >= 84 ? view.getUint32(80, true) : 0;
    if (bytes.length === 84 + 50 * count && count > 0) {
      const corners = new Float32Array(9 * count);
      for (let i = 0; i < corners.length; ++i) corners[i] = view.getFloat32(84 + 50 * Math.floor(i / 9) + 12 + 4 * (i % 9), true);
      return welded(corners);
    }
    const numbers = [...text().matchAll(/vertex\s+(\S+)\s+(\S+)\s+(\S+)/g)].flatMap(match => [+match[1], +match[2], +match[3]]);
    return welded(Float32Array.from(numbers));
  }

  const READERS = {
    char: "getInt8", int8: "getInt8", uchar: "getUint8", uint8: "getUint8", short: "getInt16", int16: "getInt16", ushort: "getUint16", uint16: "getUint16",
    int: "getInt32", int32: "getInt32", uint: "getUint32", uint32: "getUint32", float: "getFloat32", float32: "getFloat32", double: "getFloat64", float64: "getFloat64",
  };
  const widthOf = type => Number(READERS[type].match(/\d+/)[0]) / 8;

  // The next number of a type, of a file of text or of bytes.
  function plyNumbers(format, start) {
    if (format === "ascii") {
      const words = new TextDecoder().decode(bytes.subarray(start)).split(/\s+/);
      let at = words[0] === "" ? 1 : 0;
      return () => Number(words[at++]);
    }
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), little = format === "binary_little_endian";
    let at = start;
    return type => {
      const number = view[READERS[type]](at, little);
      at += widthOf(type);
      return number;
    };
  }
  function plyMesh() {
    const head = new TextDecoder("latin1").decode(bytes.subarray(0, 65536)), end = head.search(/end_header\r?\n/);
    if (!head.startsWith("ply") || end < 0) throw refused("is not a PLY file");
    const next = plyNumbers((head.match(/format (\S+)/) || [])[1], end + head.slice(end).indexOf("\n") + 1);
    const positions = [], triangles = [];
    const elements = head.slice(0, end).split(/\r?\nelement /).slice(1).map(part => part.split(/\r?\n/));
    for (const [first, ...lines] of elements) {
      const [element, count] = first.split(/\s+/), properties = lines.filter(line => line.startsWith("property")).map(line => line.trim().split(/\s+/));
      for (let i = 0; i < Number(count); ++i) {
        for (const property of properties) {
          const isList = property[1] === "list", key = property[property.length - 1];
          const numbers = isList ? Array.from({length: next(property[2])}, () => next(property[3])) : [next(property[1])];
          if (element === "vertex" && /^[xyz]$/.test(key)) positions.push(numbers[0]);
          if (element === "face" && isList && /^vertex_ind/.test(key)) fans(numbers, triangles);
        }
      }
    }
    return {positions, triangles};
  }

  // The mean of the normals of the triangles around each vertex, by their areas, and whether every edge has two sides.
  function finished({positions, triangles}) {
    const p = Float32Array.from(positions), t = Uint32Array.from(triangles), normals = new Float32Array(p.length);
    if (t.length === 0) throw refused("has no triangles");
    if (t.some(v => 3 * v >= p.length) || p.some(x => !Number.isFinite(x))) throw refused("is damaged: a triangle names a vertex that is not there, or a place is no number");
    for (let i = 0; i < t.length; i += 3) {
      const [a, b, c] = [3 * t[i], 3 * t[i + 1], 3 * t[i + 2]];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2], vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
      for (const v of [a, b, c]) for (let k = 0; k < 3; ++k) normals[v + k] += n[k];
    }
    for (let i = 0; i < normals.length; i += 3) {
      const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
      for (let k = 0; k < 3; ++k) normals[i + k] /= length;
    }
    const place = meshPlace(p), extent = [0, 1, 2].map(axis => {
      let low = Infinity, high = -Infinity;
      for (let i = axis; i < p.length; i += 3) low = Math.min(low, p[i]), high = Math.max(high, p[i]);
      return high - low;
    });
    return {positions: p, normals, triangles: t, colors: null, place, figures: {triangles: t.length / 3, extent, length_unit: ""}};
  }

  const readers = {obj: objMesh, stl: stlMesh, ply: plyMesh};
  if (!readers[kind]) throw refused("is a mesh that this page does not read; PLY, OBJ and STL are shown");
  return finished(readers[kind]());
}
