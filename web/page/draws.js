// New asteroids. What is known of one are fields of the population's recipe, in its own words: `seed`, and `population.draw`. The
// next one is drawn ahead, in a core of its own, which then becomes the one that makes its meshes.
import {at, shortNumber} from "./dom.js";
import {recipeText} from "./recipe_text.js";

const FIRST_CELLS = 32;

// `given` has cores {main, ahead}, schema, population() (a promise of its document), library (bytes by name), and
// finished(document, size, seed).
export function newAsteroids(given) {
  "use strict";
  const {cores} = given;
  let population = null, isDrawn = false, ahead = null;
  at("draw-class").append(...given.schema.definitions.draw.properties.class.enum.map(word => new Option(word.replace(/_/g, " "), word)));
  at("draw-seed").value = 1 + Math.floor(Math.random() * 99999);
  at("draw-seed").oninput = () => { isDrawn = false; };

  const refused = (field, words) => new Error(`asteroids: ${field}: ${words}`);
  function numberOf(id, field) {
    if (at(id).validity.badInput) throw refused(field, "must be a number");
    return at(id).value === "" ? undefined : Number(at(id).value);
  }
  function conditions() {
    const draw = {}, kind = at("draw-class").value, diameter = numberOf("draw-diameter", "population.draw.diameter");
    const b = numberOf("draw-b", "population.draw.axes"), c = numberOf("draw-c", "population.draw.axes");
    if ((b === undefined) !== (c === undefined)) throw refused("population.draw.axes", "give b/a and c/a, or leave both free");
    if (kind) draw.class = kind;
    if (diameter !== undefined) draw.diameter = diameter;
    if (b !== undefined) draw.axes = [1, b, c];
    return draw;
  }
  function wanted() {
    const shown = at("draw-seed").value.trim();
    if (!/^\d+$/.test(shown)) throw refused("seed", "must be a whole number of at least 0");
    return {seed: isDrawn ? String(BigInt(shown) + 1n) : shown, draw: conditions(), ground: at("draw-ground").value};
  }

  // One line about a drawn body.
  function words({description, length_unit: unit}, figures, isMeasured) {
    const ground = figures.ground.replace(/.*\/|\.\w+$/g, "");
    return `${description}. Class ${figures.class.replace(/_/g, " ")}, diameter ${shortNumber(figures.diameter)} ${unit}${isMeasured ? `, ground of ${ground}` : ""}.`;
  }

  // Draws in a core: {recipe (bytes), document, name, words, mesh}.
  async function made(core, {seed, draw, ground}) {
    population = population || await given.population();
    const text = recipeText.write({...population, seed: recipeText.integer(seed), population: {...population.population, draw}});
    const isMeasured = ground === "measured";
    const drawn = await core.call("draw", new TextEncoder().encode(text), "asteroids", isMeasured ? given.library : null);
    let document = recipeText.read(new TextDecoder().decode(drawn.bytes));
    if (!isMeasured) document = given.finished(document, 2 * Math.max(...document.body.half_axes), Number(seed) % 2 ** 31);
    const name = `asteroid_${seed}.json`, recipe = new TextEncoder().encode(recipeText.write(document) + "\n");
    const mesh = await core.call("make", recipe, name, FIRST_CELLS);
    return {recipe, document, name, words: words(document, drawn.figures, isMeasured), mesh};
  }

  function drawAhead() {
    let key;
    try {
      const next = wanted();
      if (next.ground === "measured") return;
      key = JSON.stringify(next);
      if (ahead && ahead.key === key) return;
      ahead = {key, body: made(cores.ahead, next)};
      ahead.body.catch(() => { if (ahead && ahead.key === key) ahead = null; });
    } catch (error) {}  // what is stated is no body; a press says so
  }

  return {
    drawAhead,
    // The next body, with the seed that is shown, or the one after it where that was drawn. The cores change places.
    async next() {
      const shown = at("draw-seed").value, next = wanted(), key = JSON.stringify(next);
      if (!ahead || ahead.key !== key) {
        if (ahead) cores.ahead.stop("replaced");
        ahead = {key, body: made(cores.ahead, next)};
      }
      const {body} = ahead;
      ahead = null;
      const drawn = await body;
      if (at("draw-seed").value === shown) {  // else another was typed meanwhile
        at("draw-seed").value = next.seed;
        isDrawn = true;
      }
      [cores.main, cores.ahead] = [cores.ahead, cores.main];
      return drawn;
    },
    stop: () => cores.ahead.stop("user"),
  };
}
