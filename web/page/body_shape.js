// The shape of a recipe's body as the knobs change it: its axes, and the lobes on it.
export const bodyShape = (function () {
  "use strict";
  const LOBE = 2.5;  // the exponent of a blend by which a lobe is known
  const rounded = x => Number(x.toPrecision(5));
  const isLobe = operation => operation.type === "blend" && operation.exponent === LOBE;

  // The middle and the half sides of the first body, without what operations do.
  function box(body) {
    if (body.type === "morph") return {middle: body.center || [0, 0, 0], half: body.half_axes};
    const ends = [0, 1, 2].map(axis => {
      const low = Math.min(...body.spheres.map(s => s[axis] - s[3])), high = Math.max(...body.spheres.map(s => s[axis] + s[3]));
      return [(low + high) / 2, (high - low) / 2];
    });
    return {middle: ends.map(([m]) => m), half: ends.map(([, h]) => h)};
  }

  const longest = half => half.indexOf(Math.max(...half));
  // The longest axis over the geometric mean of the two others.
  function elongation(body) {
    const {half} = box(body), axis = longest(half);
    return half[axis] / Math.sqrt(half[(axis + 1) % 3] * half[(axis + 2) % 3]);
  }

  // The measured heights of a body have their places on its own shape.
  const isMeasured = document => (document.layers || []).some(layer => layer.type === "relief" && !layer.donor);
  const canStretch = document => Boolean(document.body) && !isMeasured(document) && !document.population;

  // Factors along the axes that change the elongation and keep the volume.
  function factorsTo(wanted, half) {
    const axis = longest(half), by = Math.pow(wanted / elongation({type: "morph", half_axes: half}), 2 / 3);
    return half.map((_, i) => i === axis ? by : 1 / Math.sqrt(by));
  }

  function stretched(body, wanted) {
    if (body.type === "morph") {
      const factors = factorsTo(wanted, body.half_axes);
      return {...body, half_axes: body.half_axes.map((h, i) => rounded(h * factors[i]))};
    }
    let spheres = body.spheres;
    if (spheres.length === 1) {  // one sphere cannot be stretched: three of its kind in a row can
      const [x, y, z, r] = spheres[0];
      spheres = [[x, y, z, 0.8 * r], [x + 0.35 * r, y, z, 0.75 * r], [x - 0.35 * r, y, z, 0.75 * r]];
    }
    // Spheres stay round, so that their centres must move farther than the surface: in steps, each from where the last one led.
    let made = {...body, spheres};
    for (let step = 0; step < 24 && Math.abs(elongation(made) / wanted - 1) > 0.004; ++step) {
      const {middle, half} = box(made), factors = factorsTo(wanted, half);
      const moved = ([x, y, z, r]) => [...[x, y, z].map((c, i) => rounded(middle[i] + (c - middle[i]) * factors[i])), r];
      made = {...made, spheres: made.spheres.map(moved), ...(made.subtract ? {subtract: made.subtract.map(moved)} : {})};
    }
    return made;
  }

  const lobes = body => 1 + (body.operations || []).filter(isLobe).length;

  // A lobe at one end of the longest axis, or beside the body; smaller ones come later.
  function lobe(body, number) {
    const {middle, half} = box(body), axis = longest(half), side = (axis + 1) % 3;
    const r = half[side] * [0.78, 0.6, 0.66][number], along = [1, -1, 0.1][number];
    const center = [...middle];
    center[axis] += along * (half[axis] + 0.45 * r);
    center[side] += [0.12, -0.2, 1][number] * (half[side] + (number === 2 ? 0.2 * r : 0));
    const second = center.map((c, i) => c + [0.3, 0.22, -0.18][(i + number) % 3] * r);
    const sphere = (c, radius) => [...c, radius].map(rounded);
    return {
      type: "blend", width: rounded(0.22 * r), exponent: LOBE,
      body: {type: "metaballs", blend_exponent: 2, spheres: [sphere(center, 0.78 * r), sphere(second, 0.7 * r)],
        warp: {amplitude: rounded(0.12 * r), frequency: rounded(0.7 / r), octaves: 4}},
    };
  }

  function withLobes(body, wanted) {
    const others = (body.operations || []).filter(operation => !isLobe(operation));
    const made = Array.from({length: wanted - 1}, (_, number) => lobe(body, number));
    const {operations, ...bare} = body;
    return others.length + made.length > 0 ? {...bare, operations: [...others, ...made]} : bare;
  }

  return {elongation, stretched, lobes, withLobes, canStretch};
})();
