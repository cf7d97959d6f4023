// Colours that stand for numbers: a scale from dark blue to yellow that keeps its order in grey (viridis), and sixteen colours
// that differ for labels.
export const colorScale = (function () {
  "use strict";
  const STOPS = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121], [110, 206, 88], [181, 222, 43], [253, 231, 37]];
  const LABELS = ["#9a9690", "#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7", "#999933", "#88ccee", "#882255", "#44aa99", "#ddcc77", "#aa4499", "#117733", "#332288"];

  function color(t) {
    const at = Math.min(Math.max(t, 0), 1) * (STOPS.length - 1), i = Math.min(Math.floor(at), STOPS.length - 2);
    return STOPS[i].map((c, k) => Math.round(c + (at - i) * (STOPS[i + 1][k] - c)));
  }
  const bytes = list => Uint8Array.from(list.flatMap(([r, g, b]) => [r, g, b, 255]));
  const even = bytes(Array.from({length: 256}, (_, i) => color(i / 255)));
  const labelled = bytes(LABELS.map(hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16))));

  // Round numbers from low to high, four or so.
  function ticks(low, high) {
    const rough = (high - low) / 4, power = Math.pow(10, Math.floor(Math.log10(rough)));
    const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= rough) || rough;
    const made = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) made.push(Number((k * step).toPrecision(12)));
    return made;
  }

  // The numbers of a mesh as shares of the scale: {shown, low, high}. A hundredth of them may lie beyond each end.
  function shares(values) {
    const every = Math.max(1, Math.floor(values.length / 20000));
    const sample = values.filter((_, i) => i % every === 0).sort();
    let low = sample[Math.floor(0.005 * (sample.length - 1))], high = sample[Math.ceil(0.995 * (sample.length - 1))];
    if (!(high - low > 1e-6 * Math.abs(high))) [low, high] = [low - Math.abs(low) / 20 - 1e-9, high + Math.abs(high) / 20 + 1e-9];
    return {shown: values.map(x => (x - low) / (high - low)), low, high};
  }

  return {color, LABELS, even, labelled, ticks, shares};
})();
