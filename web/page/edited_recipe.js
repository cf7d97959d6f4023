import {recipeText} from "./recipe_text.js";

// The recipe that is edited: its document, which layers are off, and what came before. A path is a list of keys, such as
// ["layers", 0, "amplitude"]. Layers that are off stay in the list and are left out of the text.
const MOST_STEPS = 200, MOST_CHARACTERS = 32e6;  // of what can be undone

export class EditedRecipe {
  constructor(document, name) {
    this.name = name;
    this.document = document;
    this.off = new Set();  // positions in the list of layers
    this.before = [];
    this.after = [];
  }

  get(path) {
    return path.reduce((value, key) => value === undefined || value === null ? undefined : value[key], this.document);
  }

  // Sets a value, or removes it where the value is undefined. Changes of one `gesture` are undone together.
  set(path, value, gesture) {
    this.remember(gesture);
    let holder = this.document;
    for (const key of path.slice(0, -1)) holder = holder[key] === undefined ? (holder[key] = {}) : holder[key];
    const last = path[path.length - 1];
    if (value !== undefined) holder[last] = value;
    else if (Array.isArray(holder)) holder.splice(last, 1);
    else delete holder[last];
    if (path.length === 1 && path[0] === "layers" && value === undefined) this.off.clear();
    if (path.length === 2 && path[0] === "layers" && value === undefined) this.moveMarks(at => at === last ? -1 : at > last ? at - 1 : at);
  }

  // Puts another document in the place of this one. Layers that are off stay so where the list stays as long.
  replace(document, gesture) {
    this.remember(gesture);
    if ((document.layers || []).length !== (this.document.layers || []).length) this.off.clear();
    this.document = document;
  }

  // Moves an item of a list to the place before or after it.
  move(path, step) {
    const list = this.get(path.slice(0, -1)), from = path[path.length - 1], to = from + step;
    if (to < 0 || to >= list.length) return false;
    this.remember();
    [list[from], list[to]] = [list[to], list[from]];
    if (path.length === 2 && path[0] === "layers") this.moveMarks(at => at === from ? to : at === to ? from : at);
    return true;
  }

  switchLayer(at, on) {
    this.remember();
    on ? this.off.delete(at) : this.off.add(at);
  }

  moveMarks(moved) {
    this.off = new Set([...this.off].map(moved).filter(at => at >= 0));
  }

  // The text that the core reads, of this document or of one with as many layers.
  text(document = this.document) {
    if (this.off.size === 0) return recipeText.write(document) + "\n";
    const layers = document.layers.filter((_, at) => !this.off.has(at));
    return recipeText.write({...document, layers}) + "\n";
  }

  // The position in the document of a layer of the text.
  layerOfText(at) {
    const on = (this.document.layers || []).map((_, i) => i).filter(i => !this.off.has(i));
    return on[at];
  }

  snapshot() { return JSON.stringify({document: this.document, off: [...this.off]}); }
  restore(text) {
    const {document, off} = JSON.parse(text);
    this.document = document;
    this.off = new Set(off);
  }

  remember(gesture) {
    if (gesture !== undefined && gesture === this.gesture) return;
    this.gesture = gesture;
    this.before.push(this.snapshot());
    let characters = this.before.reduce((sum, text) => sum + text.length, 0);
    while (this.before.length > MOST_STEPS || characters > MOST_CHARACTERS) characters -= this.before.shift().length;
    this.after = [];
  }
  step(from, to) {
    if (from.length === 0) return false;
    to.push(this.snapshot());
    this.restore(from.pop());
    this.gesture = undefined;
    return true;
  }
  undo() { return this.step(this.before, this.after); }
  redo() { return this.step(this.after, this.before); }
}
