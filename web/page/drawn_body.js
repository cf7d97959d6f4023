// The controls of a drawn body. What they say are fields of the population's recipe, in its own words: `seed`, and
// `population.draw`. `readPopulation` gives the document of that recipe.
function drawnBody(at, schema, readPopulation) {
  "use strict";
  let population = null, isDrawn = false;  // whether the seed that is shown was drawn
  const kinds = schema.definitions.draw.properties.class.enum;
  at("draw-class").append(...kinds.map(word => new Option(word.replace(/_/g, " "), word)));
  at("draw-seed").oninput = () => { isDrawn = false; };

  const refused = (field, words) => new Error(`asteroids: ${field}: ${words}`);
  // A number, or undefined where it is free.
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

  return {
    // The recipe to draw from, {text, name}: with the seed that is shown, or the one after it where that was drawn.
    async next() {
      const draw = conditions(), shown = at("draw-seed").value.trim();
      if (!/^\d+$/.test(shown)) throw refused("seed", "must be a whole number of at least 0");
      const seed = isDrawn ? String(BigInt(shown) + 1n) : shown;
      at("draw-seed").value = seed;
      isDrawn = true;
      population = population || await readPopulation();
      const document = {...population, seed: recipeText.integer(seed), population: {...population.population, draw}};
      return {text: recipeText.write(document), name: `asteroid_${seed}.json`};
    },
    // One line about a drawn body.
    words({description, length_unit: unit}, figures) {
      const diameter = Number(figures.diameter.toPrecision(3)).toLocaleString("en");
      const ground = figures.ground.replace(/.*\/|\.\w+$/g, "");
      return `${description}. Class ${figures.class.replace(/_/g, " ")}, diameter ${diameter} ${unit}, ground of ${ground}.`;
    },
  };
}
