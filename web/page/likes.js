// Six bodies of the kind of the one that is open, as small pictures: what synth --laid --seed makes. A press takes one.
import {element} from "./dom.js";

const CELLS = 32, SIDE = 200;

export function likesStrip(container, {cores, stage, recipe, take}) {
  let round = 0;  // of which pictures are still wanted

  // The arrangement "like" takes five times as long.
  function another(document, seed) {
    const layers = (document.layers || []).map(layer => layer.type === "relief" ? {...layer, arrangement: "laid"} : layer);
    return {...document, seed, ...(layers.length > 0 ? {layers} : {})};
  }

  async function picture(button, text, number) {
    const mesh = await cores.ahead.lasting("make", new TextEncoder().encode(text), recipe().name, CELLS);
    if (number !== round) return;
    const canvas = element("canvas", {width: SIDE, height: SIDE});
    stage.thumbnail(mesh, canvas);
    button.replaceChildren(canvas);
  }

  async function show() {
    const number = ++round;
    container.hidden = false;
    const made = Array.from({length: 6}, (_, i) => {
      const document = another(recipe().document, Math.floor(Math.random() * 2 ** 31)), text = recipe().text(document), button = element("button", {type: "button", textContent: "…", ariaLabel: `take body ${i + 1} of the six`});
      button.onclick = () => take(document);
      return {text, button};
    });
    container.replaceChildren(...made.map(({button}) => button));
    for (const {text, button} of made) {
      if (number !== round) return;
      await picture(button, text, number).catch(error => { button.textContent = error.stopped ? "" : "no such body"; });
    }
  }
  function clear() {
    ++round;
    container.hidden = true;
  }
  return {toggle: () => container.hidden ? show() : clear(), clear};
}
