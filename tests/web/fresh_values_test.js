// What the form of the page adds is a recipe that the core takes: a new item of every kind, with each of its optional fields.
//   node fresh_values_test.js FOLDER_OF_CORE
"use strict";
const fs = require("fs");
const path = require("path");
const schemaValues = require("../../web/page/schema_values.js");
const {loadCore} = require("./node_core.js");

const schema = JSON.parse(fs.readFileSync(path.join(__dirname, "../../recipe/recipe.schema.json"), "utf8"));
const values = schemaValues(schema);
const {layers} = schema.properties, {operations} = schema.definitions.metaballs.properties;
// They name what a new item cannot know: groups, other layers.
const NAMING = ["locality", "mask"];

// A new item of each kind, and each with one more field: [{words, item}].
function newItems(list) {
  return values.newKindsOf(list.items).flatMap(kind => values.wordsOf(kind).flatMap(type => {
    const bare = {...values.fresh(kind), type};
    const more = Object.keys(kind.properties).filter(key => !(key in bare) && !NAMING.includes(key));
    return [{words: type, item: bare},
      ...more.map(key => ({words: `${type} with ${key}`, item: {...bare, [key]: values.fresh(kind.properties[key])}}))];
  }));
}

function refusal(core, recipe) {
  const bytes = new TextEncoder().encode(JSON.stringify(recipe));
  try {
    core.writeRecipe(bytes, "fresh.json", "json");
    return "";
  } catch (error) {
    return error.message;
  }
}

loadCore(process.argv[2]).then(core => {
  const body = values.fresh(schema.definitions.metaballs), recipe = {format_version: 1, length_unit: "m", body};
  const tried = [
    ...newItems(layers).map(({words, item}) => ({words, recipe: {...recipe, layers: [item]}})),
    ...newItems(operations).map(({words, item}) => ({words, recipe: {...recipe, body: {...body, operations: [item]}}})),
  ];
  const refused = tried.map(({words, recipe: made}) => [words, refusal(core, made)]).filter(([, message]) => message);
  refused.forEach(([words, message]) => console.log(`FAILED: a new ${words}: ${message}`));
  console.log(`new items: ${tried.length - refused.length} of ${tried.length} are taken`);
  process.exit(refused.length > 0 ? 1 : 0);
});
