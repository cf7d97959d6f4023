// What the form of the page adds is a recipe that the core takes: a new item of every kind, with each of its optional fields.
// A new layer, as it is added to a body of this size, changes the mesh. Knobs make recipes that the core takes, and stand where
// they were put.
//   node fresh_values_test.js FOLDER_OF_CORE
"use strict";
const fs = require("fs");
const path = require("path");
const {loadCore} = require("./node_core.js");

const read = name => JSON.parse(fs.readFileSync(path.join(__dirname, "../../recipe", name), "utf8"));
const schema = read("recipe.schema.json"), table = read("knobs.json");
const {layers} = schema.properties, {operations} = schema.definitions.metaballs.properties;
// They name what a new item cannot know: groups, other layers.
const NAMING = ["locality", "mask"];
const SIZE = 560;
let failures = 0;

function fail(words) {
  ++failures;
  console.log("FAILED: " + words);
}

// A new item of each kind, and each with one more field: [{words, item}].
function newItems(list, values, added) {
  return values.newKindsOf(list.items).flatMap(kind => values.wordsOf(kind).flatMap(type => {
    const bare = added.item(kind, type, SIZE);
    const more = Object.keys(kind.properties).filter(key => !(key in bare) && !NAMING.includes(key));
    return [{words: type, item: bare},
      ...more.map(key => ({words: `${type} with ${key}`, item: {...bare, [key]: added.field(bare, key, kind.properties[key], SIZE)}}))];
  }));
}

function refusal(core, recipe) {
  try {
    core.writeRecipe(new TextEncoder().encode(JSON.stringify(recipe)), "fresh.json", "json");
    return "";
  } catch (error) {
    return error.message;
  }
}

function meshDigits(core, recipe) {
  core.make(new TextEncoder().encode(JSON.stringify(recipe)), "fresh.json", 32);
  return core.writeMesh("ply").sha256;
}

// Every item that is added is a recipe; every layer that is added shows.
function testAdded(core, values, added) {
  const body = {type: "metaballs", spheres: [[0, 0, 0, 150], [130, 0, 0, 140]]}, recipe = {format_version: 1, length_unit: "m", body};
  const tried = [
    ...newItems(layers, values, added).map(({words, item}) => ({words, recipe: {...recipe, layers: [item]}})),
    ...newItems(operations, values, added).map(({words, item}) => ({words, recipe: {...recipe, body: {...body, operations: [item]}}})),
  ];
  const refused = tried.map(({words, recipe: made}) => [words, refusal(core, made)]).filter(([, message]) => message);
  refused.forEach(([words, message]) => fail(`a new ${words}: ${message}`));
  const bare = meshDigits(core, recipe), fresh = tried.filter(({words, recipe: made}) => made.layers && !words.includes(" "));
  const shown = fresh.filter(({words, recipe: made}) => words !== "gabor" && meshDigits(core, made) !== bare);
  if (shown.length !== fresh.length - 1) fail(`of ${fresh.length - 1} new layers ${shown.length} show: ${shown.map(({words}) => words)}`);
  console.log(`new items: ${tried.length - refused.length} of ${tried.length} are taken, ${shown.length} of ${fresh.length - 1} layers show`);
}

// Each knob at five places of its way: the core takes the recipe, and the knob stands where it was put.
function testKnobs(core, knobs) {
  const spheres = [[-120, 0, 0, 150], [130, 20, 0, 140], [0, 60, 20, 120]];
  let turned = 0;
  for (const knob of knobs.table.knobs) {
    for (const t of [0, 0.3, 0.5, 0.8, 1]) {
      const document = {format_version: 1, length_unit: "m", body: {type: "metaballs", spheres}};
      const made = knobs.turned(knob, t, document, SIZE), message = refusal(core, made), metres = knob.kind === "size" ? 2 * Math.pow(5e5, t) : SIZE;
      if (message) fail(`${knob.name} at ${t}: ${message}`);
      const place = knobs.place(knob, made, metres), step = knob.step ? 1 / (knob.high - knob.low) : 0.01;
      if (Math.abs(place - t) > 0.51 * step + 0.02) fail(`${knob.name} at ${t} stands at ${place}`);
      ++turned;
    }
  }
  console.log(`knobs: ${turned} places of ${knobs.table.knobs.length}`);
}

async function main() {
  const core = await loadCore(process.argv[2]);
  const [{schemaValues}, {addedValues}, {recipeKnobs}] = await Promise.all(
    ["schema_values", "added_values", "knobs"].map(name => import(`../../web/page/${name}.js`)));
  const values = schemaValues(schema);
  testAdded(core, values, addedValues(table, values));
  testKnobs(core, recipeKnobs(table, values));
  process.exit(failures > 0 ? 1 : 0);
}
main();
