// A mesh as an STL file for a printer: its longest side has so many millimetres, and it stands on the plane z = 0.
export function printedMesh({positions, triangles}, millimetres) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  positions.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  const factor = millimetres / Math.max(...high.map((x, axis) => x - low[axis])), count = triangles.length / 3;
  const bytes = new DataView(new ArrayBuffer(84 + 50 * count));
  bytes.setUint32(80, count, true);
  for (let t = 0; t < count; ++t) {
    const corners = [0, 1, 2].map(k => [0, 1, 2].map(axis => (positions[3 * triangles[3 * t + k] + axis] - low[axis]) * factor));
    const [u, v] = [1, 2].map(k => corners[k].map((x, axis) => x - corners[0][axis]));
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], length = Math.hypot(...n) || 1;
    [n.map(x => x / length), ...corners].flat().forEach((x, i) => bytes.setFloat32(84 + 50 * t + 4 * i, x, true));
  }
  return bytes.buffer;
}
