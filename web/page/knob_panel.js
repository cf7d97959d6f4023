// The knobs on the page: one slider for each, with its words. `editing` has document(), size(), put(document, gesture), and
// endGesture().
import {element, shortNumber} from "./dom.js";

export function knobPanel(container, knobs, editing) {
  "use strict";
  const STEPS = 200;
  const rows = knobs.table.knobs.map(knob => {
    const value = element("span", {className: "value"}), meaning = `${knob.title}: ${knob.meaning}`;
    const slider = element("input", {type: "range", min: 0, max: knob.step ? knob.high - knob.low : STEPS, step: 1, id: `knob-${knob.name}`, ariaLabel: meaning, title: knob.meaning});
    slider.oninput = () => {
      if (!editing.document()) return;
      editing.put(knobs.turned(knob, slider.value / slider.max, editing.document(), editing.size()), `knob ${knob.name}`);
      tell(rows.find(row => row.knob === knob));
    };
    slider.onchange = () => editing.endGesture();
    const holder = element("div", {className: "knob"}, element("label", {textContent: knob.title, htmlFor: slider.id}), value, slider,
      ...knob.ends.map(textContent => element("span", {className: "end", textContent})));
    container.append(holder);
    return {knob, slider, value, holder};
  });

  function words({knob}, place, document, size) {
    if (knob.kind === "size") return `${shortNumber(size)} ${document.length_unit}`;
    if (knob.kind === "lobes") return String(Math.round(knob.low + place * (knob.high - knob.low)));
    if (knob.kind === "elongation") return shortNumber(knob.low + place * (knob.high - knob.low));
    return knob.name === "albedo" ? shortNumber((document.albedo || {normal: 0.1}).normal) : "";
  }

  function tell(row) {
    const document = editing.document(), size = editing.size(), place = knobs.place(row.knob, document, size);
    row.slider.disabled = place === null;
    row.holder.classList.toggle("off", place === null);
    row.value.textContent = place === null ? "this shape is measured" : words(row, place, document, size);
    if (place !== null && window.document.activeElement !== row.slider) row.slider.value = Math.round(place * row.slider.max);
    row.slider.setAttribute("aria-valuetext", row.value.textContent || `${Math.round(100 * (place || 0))} of 100`);
  }

  // The number from which all else is drawn.
  const seed = element("input", {id: "knob-seed", inputMode: "numeric"});
  const setSeed = number => {
    if (!editing.document()) return;
    editing.put({...editing.document(), seed: number}, undefined);
    seed.value = number;
  };
  seed.onchange = () => /^\d{1,15}$/.test(seed.value.trim()) && setSeed(Number(seed.value));
  const again = () => setSeed(Math.floor(Math.random() * 1e9));
  container.append(element("div", {className: "knob seed"}, element("label", {textContent: "Seed", htmlFor: "knob-seed"}), seed,
    element("button", {type: "button", textContent: "Again", title: "other hills, craters and blocks of the same kind", onclick: again})));

  return {
    // Puts every knob where the recipe says.
    update() {
      rows.forEach(tell);
      if (window.document.activeElement !== seed) seed.value = editing.document().seed === undefined ? 1 : editing.document().seed;
    },
  };
}
