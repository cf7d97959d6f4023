// Coarse meshes of the wall's bodies, shown until the core has made finer ones (coarse_mesh.py says how they are written).

// Normals at the vertices, each weighted by the area of its triangles.
function meanNormals(positions, triangles) {
  const normals = new Float32Array(positions.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map(k => 3 * triangles[t + k]);
    const [ux, uy, uz] = [0, 1, 2].map(k => positions[b + k] - positions[a + k]);
    const [vx, vy, vz] = [0, 1, 2].map(k => positions[c + k] - positions[a + k]);
    const cross = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const at of [a, b, c]) for (let k = 0; k < 3; ++k) normals[at + k] += cross[k];
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[i + k] /= length;
  }
  return normals;
}

// A mesh as the core gives it, of the bytes that coarse_mesh.py wrote.
export function coarseMesh(bytes) {
  const end = bytes.indexOf(10), {figures, color, low, step, vertices} = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)));
  const lows = bytes.subarray(end + 1, end + 1 + (bytes.length - end - 1) / 2), highs = bytes.subarray(end + 1 + lows.length);
  const numbers = Uint16Array.from(lows, (byte, i) => byte + 256 * highs[i]);
  const positions = new Float32Array(3 * vertices), triangles = new Uint32Array(numbers.length - 3 * vertices);
  for (let axis = 0, n = 0; axis < 3; ++axis) {
    for (let i = 0, at = 0; i < vertices; ++i, ++n) {
      at += numbers[n] & 1 ? -(numbers[n] + 1) / 2 : numbers[n] / 2;
      positions[3 * i + axis] = low[axis] + step * at;
    }
  }
  for (let t = 0, named = 0; t < triangles.length; ++t) {
    triangles[t] = named - numbers[3 * vertices + t];
    named = Math.max(named, triangles[t] + 1);
  }
  const colors = color && Uint8Array.from({length: 3 * vertices}, (_, i) => color[i % 3]);
  return {positions, normals: meanNormals(positions, triangles), colors, triangles, figures, milliseconds: 0};
}
