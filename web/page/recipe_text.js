// Recipes as JSON text. Seeds are whole numbers of up to 64 bits, which JavaScript's numbers cannot hold: whole numbers of 16
// digits and more are kept as marked texts, and become numbers again where a recipe is written.
export const recipeText = (function () {
  "use strict";
  const MARK = "\u0000integer ";
  const TOKENS = /"[^"\\]*(?:\\.[^"\\]*)*"|-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?/g;

  function read(text) {
    return JSON.parse(text.replace(TOKENS, token =>
      /^-?\d{16,}$/.test(token) ? JSON.stringify(MARK + token) : token));
  }

  const isBig = value => typeof value === "string" && value.startsWith(MARK);
  // The digits of a whole number, and back.
  const digits = value => isBig(value) ? value.slice(MARK.length) : String(value);
  const integer = text => /^-?\d{16,}$/.test(text) ? MARK + text : Number(text);

  function numberText(number) {
    if (!Number.isFinite(number)) return "null";
    return Object.is(number, -0) ? "-0.0" : String(number);
  }

  // Two spaces a level; arrays of plain values stay on one line.
  function write(value, margin = "") {
    if (typeof value === "number") return numberText(value);
    if (isBig(value)) return digits(value);
    if (value === null || typeof value !== "object") return JSON.stringify(value);
    const inner = margin + "  ";
    const items = Array.isArray(value)
      ? value.map(item => write(item, inner))
      : Object.keys(value).map(key => JSON.stringify(key) + ": " + write(value[key], inner));
    const [first, last] = Array.isArray(value) ? "[]" : "{}";
    if (items.length === 0) return first + last;
    if (Array.isArray(value) && value.every(item => item === null || typeof item !== "object")) {
      return first + items.join(", ") + last;
    }
    return first + "\n" + items.map(item => inner + item).join(",\n") + "\n" + margin + last;
  }

  return {read, write, isBig, digits, integer};
})();
