// What is drawn over the bodies: a scale of lengths, a thing of known size, and the bar of the colours.
import {colorScale} from "./color_scale.js";
import {shortNumber} from "./dom.js";

export const marks = (function () {
  "use strict";
  const METRES = {m: 1, km: 1000};
  // Things that most people have seen, with their heights in metres.
  const THINGS = [["a person", 1.75, person], ["a house", 9, house], ["the Eiffel Tower", 330, tower], ["Mount Fuji", 3776, mountain]];

  // Each draws a figure of height 1 that stands on (0, 0), y upwards.
  function person(c) {
    c.arc(0, 0.89, 0.09, 0, 7);
    c.rect(-0.13, 0.38, 0.26, 0.40);
    c.rect(-0.11, 0, 0.09, 0.4);
    c.rect(0.02, 0, 0.09, 0.4);
    c.rect(-0.21, 0.42, 0.06, 0.34);
    c.rect(0.15, 0.42, 0.06, 0.34);
    return 0.42;
  }
  const polygon = (c, points) => { points.forEach(([x, y], i) => i ? c.lineTo(x, y) : c.moveTo(x, y)); c.closePath(); };
  function house(c) {
    polygon(c, [[-0.6, 0], [-0.6, 0.55], [-0.72, 0.55], [0, 1], [0.72, 0.55], [0.6, 0.55], [0.6, 0], [0.12, 0], [0.12, 0.35], [-0.12, 0.35], [-0.12, 0]]);
    return 1.44;
  }
  function tower(c) {
    polygon(c, [[-0.19, 0], [-0.08, 0.28], [-0.035, 0.6], [-0.012, 0.92], [0, 1], [0.012, 0.92], [0.035, 0.6], [0.08, 0.28], [0.19, 0], [0.12, 0], [0.06, 0.14], [-0.06, 0.14], [-0.12, 0]]);
    return 0.38;
  }
  function mountain(c) {
    polygon(c, [[-2.6, 0], [-1.2, 0.3], [-0.5, 0.72], [-0.14, 0.98], [0, 0.95], [0.12, 1], [0.5, 0.7], [1.3, 0.28], [2.7, 0]]);
    return 5.3;
  }

  // The tallest thing that fits beside the body.
  function thingFor(pixelsPerMetre, most) {
    return [...THINGS].reverse().find(([, height]) => height * pixelsPerMetre <= most && height * pixelsPerMetre >= 5);
  }

  function roundLength(most) {
    const power = Math.pow(10, Math.floor(Math.log10(most)));
    return [5, 2, 1].map(m => m * power).find(length => length <= most);
  }
  const lengthText = metres => metres >= 1000 ? `${shortNumber(metres / 1000)} km` : metres >= 1 ? `${shortNumber(metres)} m` : `${shortNumber(metres * 100)} cm`;

  function drawScale(c, {x, y, u, ink, pixelsPerMetre}) {
    const metres = roundLength(150 * u / pixelsPerMetre), width = metres * pixelsPerMetre;
    c.lineWidth = 1.5 * u;
    c.strokeStyle = ink;
    c.beginPath();
    [[x, y - 5 * u], [x, y], [x + width, y], [x + width, y - 5 * u]].forEach(([a, b], i) => i ? c.lineTo(a, b) : c.moveTo(a, b));
    c.stroke();
    c.fillStyle = ink;
    c.textAlign = "left";
    c.fillText(lengthText(metres), x, y - 10 * u);
    return width;
  }

  function drawThing(c, {x, y, u, ink, pixelsPerMetre, height}) {
    const thing = thingFor(pixelsPerMetre, 0.2 * height);
    if (!thing) return;
    const [words, metres, shape] = thing, size = metres * pixelsPerMetre;
    c.save();
    c.translate(x, y);
    c.scale(size, -size);
    c.beginPath();
    const wide = shape(c);
    c.restore();
    const half = wide * size / 2;
    c.save();
    c.translate(x + half, y);
    c.scale(size, -size);
    c.beginPath();
    shape(c);
    c.restore();
    c.fillStyle = ink;
    c.fill();
    c.textAlign = "left";
    c.fillText(words, x + 2 * half + 8 * u, y);
  }

  function drawBar(c, {width, height, u, ink, scale}) {
    const tall = Math.min(0.5 * height, 260 * u), wide = 12 * u, x = width - 84 * u, top = (height - tall) / 2;
    c.textAlign = "left";
    c.fillStyle = ink;
    if (scale.legend) {
      scale.legend.slice(0, 16).forEach((words, i) => {
        const y = top + 24 * u * i;
        c.fillStyle = colorScale.LABELS[i % 16];
        c.fillRect(width - 190 * u, y, 14 * u, 14 * u);
        c.fillStyle = ink;
        c.fillText(words.replace(/^label \d+: /, "").slice(0, 24), width - 170 * u, y + 12 * u);
      });
      return;
    }
    for (let i = 0; i < tall; ++i) {
      c.fillStyle = `rgb(${colorScale.color(1 - i / tall)})`;
      c.fillRect(x, top + i, wide, 1.5);
    }
    c.fillStyle = ink;
    c.fillText(scale.words, Math.min(x, width - c.measureText(scale.words).width - 12 * u), top - 14 * u);
    for (const tick of colorScale.ticks(scale.low, scale.high)) {
      const y = top + tall * (1 - (tick - scale.low) / (scale.high - scale.low));
      c.fillRect(x + wide, y - 0.5 * u, 5 * u, u);
      c.fillText(tick.toLocaleString("en", {maximumFractionDigits: 6}), x + wide + 9 * u, y + 4.5 * u);
    }
  }

  // `c` is a context of two dimensions; `look` has pixelsPerLength, unit, paper, showThing, captions, scale ({words, low, high} or {legend}).
  // `u` is how many pixels of the picture a pixel of the page takes.
  function draw(c, width, height, u, look) {
    const ink = look.paper ? "#2b2e35" : "#c9ced8", metre = METRES[look.unit];
    c.font = `${13 * u}px system-ui, sans-serif`;
    if (metre && look.pixelsPerLength > 0) {
      const given = {x: 22 * u, y: height - 24 * u, u, ink, pixelsPerMetre: look.pixelsPerLength / metre, height};
      const wide = drawScale(c, given);
      if (look.showThing) drawThing(c, {...given, x: given.x + wide + 26 * u});
    }
    if (look.scale) drawBar(c, {width, height, u, ink, scale: look.scale});
    (look.captions || []).forEach(({x, y, words}) => {
      c.textAlign = "center";
      c.fillStyle = ink;
      c.fillText(words, x, y);
    });
  }

  return {draw};
})();
