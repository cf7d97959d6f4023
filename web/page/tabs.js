// Tabs that show one panel each: a press or an arrow key changes it, and `onshown` gets its name.
import {at} from "./dom.js";

export function tabs(names, onshown) {
  let shown = names[0];
  function show(name) {
    shown = name;
    for (const other of names) {
      at(`tab-${other}`).setAttribute("aria-selected", other === name);
      at(`tab-${other}`).tabIndex = other === name ? 0 : -1;
      at(`${other}-panel`).hidden = other !== name;
    }
    onshown(name);
  }
  names.forEach((name, i) => {
    at(`tab-${name}`).onclick = () => show(name);
    at(`tab-${name}`).onkeydown = event => {
      const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
      if (!step) return;
      const next = names[(i + step + names.length) % names.length];
      show(next);
      at(`tab-${next}`).focus();
    };
  });
  return {show, shown: () => shown};
}
