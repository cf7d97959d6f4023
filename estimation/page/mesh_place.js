// Where a mesh stands in a picture: [x, y, z, factor], the middle of its box and the factor that makes its radius 1.
export function meshPlace(positions) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; i += 3) {
    for (let axis = 0; axis < 3; ++axis) {
      const x = positions[i + axis];
      if (x < low[axis]) low[axis] = x;
      if (x > high[axis]) high[axis] = x;
    }
  }
  const [mx, my, mz] = low.map((x, axis) => (x + high[axis]) / 2);
  let square = 1e-30;
  for (let i = 0; i < positions.length; i += 3) {
    const x = positions[i] - mx, y = positions[i + 1] - my, z = positions[i + 2] - mz, s = x * x + y * y + z * z;
    if (s > square) square = s;
  }
  return [mx, my, mz, 1 / Math.sqrt(square)];
}
