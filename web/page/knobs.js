// What the knobs do to a recipe. The table (recipe/knobs.json) says which fields a knob moves; where a knob stands follows from
// the recipe alone, so that nothing else is kept.
//   place(knob, document, size)         0 .. 1, or null where the recipe has no such thing
//   turned(knob, t, document, size)     the recipe with the knob at t; `size` is the longest side of its body
import {bodyShape} from "./body_shape.js";
import {scaledRecipe} from "./scaled_recipe.js";

export function recipeKnobs(table, values) {
  "use strict";
  const METRES = {m: 1, km: 1000};
  const rounded = x => typeof x === "number" ? Number(x.toPrecision(4)) : x.map(rounded);
  const copy = value => JSON.parse(JSON.stringify(value));
  const isIn = (knob, layer) => layer.name === knob && layer.type === table.layers[knob].type;
  const layerOf = (document, name) => (document.layers || []).find(layer => isIn(name, layer));

  const get = (holder, path) => path.split(".").reduce((value, key) => value === undefined ? undefined : value[key], holder);
  function put(holder, path, value) {
    const keys = path.split("."), last = keys.pop();
    for (const key of keys) holder = holder[key] = holder[key] || {};
    holder[last] = value;
  }

  // -- moves: a value at a place of the knob, and back ---------------------------------------------------------------------

  function valueAt({at, log}, t) {
    const next = Math.max(1, at.findIndex(([place]) => place >= t)), [[t0, a], [t1, b]] = [at[next - 1], at[next]];
    const share = Math.min(Math.max((t - t0) / (t1 - t0), 0), 1);
    const mixed = (x, y) => log ? x * Math.pow(y / x, share) : x + share * (y - x);
    return Array.isArray(a) ? a.map((x, i) => mixed(x, b[i])) : mixed(a, b);
  }
  function placeOf({at, log}, value) {
    const rising = at[at.length - 1][1] > at[0][1], beyond = (x, y) => rising ? x >= y : x <= y;
    if (!beyond(value, at[0][1])) return at[0][0];
    const next = at.findIndex(([, y], i) => i > 0 && beyond(y, value));
    if (next < 0) return at[at.length - 1][0];
    const [[t0, a], [t1, b]] = [at[next - 1], at[next]];
    const share = a === b ? 0 : log ? Math.log(value / a) / Math.log(b / a) : (value - a) / (b - a);
    return t0 + Math.min(Math.max(share, 0), 1) * (t1 - t0);
  }

  const holderOf = (knob, move, document) => {
    const name = move.if || knob.layer;
    return name ? layerOf(document, name) : document;
  };

  // -- layers of the table -------------------------------------------------------------------------------------------------

  function newLayer(name, size) {
    const layer = {...copy(table.layers[name]), name};
    for (const [path, [share, power]] of Object.entries(table.sizes[name])) put(layer, path, rounded(share * Math.pow(size, power)));
    return layer;
  }
  // Layers of the table stand in its order, after all others.
  function addLayer(document, name, size) {
    const names = Object.keys(table.layers), later = names.slice(names.indexOf(name) + 1);
    const layers = document.layers = document.layers || [];
    const before = layers.findIndex(layer => later.some(other => isIn(other, layer)));
    layers.splice(before < 0 ? layers.length : before, 0, newLayer(name, size));
  }

  function turnMoves(knob, t, given, size) {
    const document = copy(given);
    if (knob.layer && t <= knob.none) {
      document.layers = (document.layers || []).filter(layer => !isIn(knob.layer, layer));
      return document;
    }
    if (knob.layer && !layerOf(document, knob.layer)) addLayer(document, knob.layer, size);
    for (const move of knob.moves) {
      const holder = holderOf(knob, move, document);
      if (!holder) continue;
      if (holder === document && !document.albedo) document.albedo = copy(table.albedo);
      const value = valueAt(move, t), by = Math.pow(size, move.power || 0);
      put(holder, move.field, move.whole ? Math.max(1, Math.round(value)) : rounded(Array.isArray(value) ? value : value * by));
      if (move.field === "population.count") delete holder.population.density;
    }
    return document;
  }
  function placeByMove(knob, document, size) {
    const move = knob.moves[0], holder = holderOf(knob, move, document);
    if (!holder) return 0;
    const value = get(holder, move.field);
    return value === undefined ? (move.field === "albedo.normal" ? placeOf(move, 0.1) : 0) : placeOf(move, value / Math.pow(size, move.power || 0));
  }

  // -- knobs of the shape --------------------------------------------------------------------------------------------------

  const metres = (document, size) => size * METRES[document.length_unit];
  const shapes = {
    size: {
      place: (knob, document, size) => METRES[document.length_unit] ? Math.log(metres(document, size) / knob.low) / Math.log(knob.high / knob.low) : null,
      turned: (knob, t, document, size) => scaledRecipe(values, document, knob.low * Math.pow(knob.high / knob.low, t) / metres(document, size)),
    },
    elongation: {
      place: (knob, document) => bodyShape.canStretch(document) ? (bodyShape.elongation(document.body) - knob.low) / (knob.high - knob.low) : null,
      turned: (knob, t, document) => ({...document, body: bodyShape.stretched(document.body, knob.low + t * (knob.high - knob.low))}),
    },
    lobes: {
      place: (knob, document) => document.body ? (bodyShape.lobes(document.body) - knob.low) / (knob.high - knob.low) : null,
      turned: (knob, t, document) => ({...document, body: bodyShape.withLobes(document.body, Math.round(knob.low + t * (knob.high - knob.low)))}),
    },
  };

  const within = t => t === null ? null : Math.min(Math.max(t, 0), 1);
  const place = (knob, document, size) => within(knob.kind ? shapes[knob.kind].place(knob, document, size) : placeByMove(knob, document, size));
  const turned = (knob, t, document, size) => knob.kind ? shapes[knob.kind].turned(knob, t, document, size) : turnMoves(knob, t, document, size);

  // -- a new body ----------------------------------------------------------------------------------------------------------

  // Numbers from 0 to 1 that follow from a seed (mulberry32).
  function numbersOf(seed) {
    let state = seed >>> 0;
    return () => {
      state = state + 0x6d2b79f5 | 0;
      let t = Math.imul(state ^ state >>> 15, 1 | state);
      t = t + Math.imul(t ^ t >>> 7, 61 | t) ^ t;
      return ((t ^ t >>> 14) >>> 0) / 2 ** 32;
    };
  }
  // Knobs of a drawn body: from where to where each may stand.
  const USUAL = {roughness: [0.25, 0.6], craters: [0.15, 0.7], crater_age: [0.2, 0.9], boulders: [0.2, 0.75], boulder_size: [0.05, 0.6], dust: [0, 0.7], albedo: [0.1, 0.75]};
  function finished(document, size, seed) {
    const next = numbersOf(seed);
    return table.knobs.filter(({name}) => USUAL[name]).reduce((made, knob) => {
      const [low, high] = USUAL[knob.name];
      return turned(knob, low + (high - low) * next(), made, size);
    }, document);
  }

  return {table, place, turned, finished};
}
