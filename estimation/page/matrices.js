// Matrices of 4 x 4 as WebGL takes them, column after column, and vectors of three numbers.
export const matrices = {
  multiply(a, b) {
    const product = new Float32Array(16);
    for (let column = 0; column < 4; ++column) {
      for (let row = 0; row < 4; ++row) {
        let sum = 0;
        for (let k = 0; k < 4; ++k) sum += a[4 * k + row] * b[4 * column + k];
        product[4 * column + row] = sum;
      }
    }
    return product;
  },

  perspective(fov, aspect, near, far) {
    const f = 1 / Math.tan(fov / 2), depth = 1 / (near - far);
    return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) * depth, -1, 0, 0, 2 * far * near * depth, 0]);
  },

  // A box of half width `half` about the origin of the eye's axes, from `near` to `far` before the eye.
  parallel(half, near, far) {
    const depth = 1 / (near - far);
    return new Float32Array([1 / half, 0, 0, 0, 0, 1 / half, 0, 0, 0, 0, 2 * depth, 0, 0, 0, (far + near) * depth, 1]);
  },

  // The axes of an eye at `eye` that looks at the origin; `up` must not lie along its view.
  lookAtOrigin(eye, up) {
    const z = vectors.unit(eye), x = vectors.unit(vectors.cross(up, z)), y = vectors.cross(z, x);
    const moved = axis => -vectors.dot(axis, eye);
    return new Float32Array([x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0, moved(x), moved(y), moved(z), 1]);
  },
};

export const vectors = {
  dot: (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2],
  cross: (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]],
  unit(a) {
    const length = Math.hypot(...a);
    return a.map(x => x / length);
  },
  // The direction of a longitude and a latitude in degrees.
  direction(longitude, latitude) {
    const [a, h] = [longitude, latitude].map(degrees => degrees * Math.PI / 180);
    return [Math.cos(h) * Math.cos(a), Math.cos(h) * Math.sin(a), Math.sin(h)];
  },
};
