// Recipes that are damaged in many ways, the same ones every time: [{name, bytes}].
"use strict";
const fs = require("fs");
const path = require("path");

const ROOT = path.join(__dirname, "../..");
const EXAMPLES = path.join(ROOT, "synthesis/examples");
const STREAMS = path.join(ROOT, "tests/fuzz/seeds/compact_recipe");

// CRC-16 with the polynomial 0x1021, as docs/recipe_compact.md states for compact recipes.
function check(bytes) {
  let sum = 0xffff;
  for (const byte of bytes) {
    sum ^= byte << 8;
    for (let bit = 0; bit < 8; ++bit) sum = (sum << 1 ^ (sum & 0x8000 ? 0x1021 : 0)) & 0xffff;
  }
  return sum;
}
const compact = stream => Buffer.concat([Buffer.from("AST\x01"), Buffer.from([check(stream) >> 8, check(stream) & 255]), stream]);

// A generator of numbers in [0, 1) that gives the same ones every time (mulberry32).
function numbers(seed) {
  return () => {
    seed = seed + 0x6d2b79f5 | 0;
    let t = Math.imul(seed ^ seed >>> 15, 1 | seed);
    t = t + Math.imul(t ^ t >>> 7, 61 | t) ^ t;
    return ((t ^ t >>> 14) >>> 0) / 2 ** 32;
  };
}

const WRONG = ["-1", "1e400", "NaN", "null", "\"x\"", "[]", "{}", "true", "1e300", "-0.5", "99999999999999999999", "1e-320", "[[[[]]]]"];

// The text with one of its numbers replaced, or cut, or with one byte changed.
function damaged(text, random) {
  const pick = list => list[Math.floor(random() * list.length)];
  const way = random();
  if (way < 0.15) return text.slice(0, Math.floor(random() * text.length));
  if (way < 0.3) {
    const at = Math.floor(random() * text.length);
    return text.slice(0, at) + pick([..."{}[]\",:0x\u0000é"]) + text.slice(at + 1);
  }
  if (way < 0.45) {
    const key = pick([...text.matchAll(/"(\w+)":/g)]);
    return text.slice(0, key.index) + "\"unknown_word\":" + text.slice(key.index + key[0].length);
  }
  const number = pick([...text.matchAll(/(?<=[\s[:,])-?\d[\d.eE+-]*(?=[\s\],}])/g)]);
  return text.slice(0, number.index) + pick(WRONG) + text.slice(number.index + number[0].length);
}

exports.hostileRecipes = function (count) {
  const recipes = [];
  const random = numbers(55);
  const texts = fs.readdirSync(EXAMPLES).sort().map(file => fs.readFileSync(path.join(EXAMPLES, file), "utf8"));
  for (let i = 0; i < count; ++i) {
    recipes.push({name: `damaged_${i}.json`, bytes: Buffer.from(damaged(texts[i % texts.length], random))});
  }
  for (const file of fs.readdirSync(STREAMS).sort()) {
    const stream = fs.readFileSync(path.join(STREAMS, file));
    const name = path.basename(file, ".stream");
    recipes.push({name: `${name}.astro`, bytes: compact(stream)});
    for (let i = 0; i < 4; ++i) {
      const changed = Buffer.from(stream);
      changed[Math.floor(random() * changed.length)] ^= 1 << Math.floor(8 * random());
      recipes.push({name: `${name}_${i}.astro`, bytes: compact(changed)});
    }
    recipes.push({name: `${name}_cut.astro`, bytes: compact(stream.subarray(0, stream.length / 2))});
    recipes.push({name: `${name}_headless.astro`, bytes: stream});
  }
  const deep = 100000;
  recipes.push({name: "deep.json", bytes: Buffer.from("[".repeat(deep))});
  recipes.push({name: "deep_objects.json", bytes: Buffer.from("{\"a\":".repeat(deep))});
  recipes.push({name: "empty.json", bytes: Buffer.alloc(0)});
  recipes.push({name: "zeros.json", bytes: Buffer.alloc(1000)});
  recipes.push({name: "words.json", bytes: Buffer.from("\"no recipe\"")});
  return recipes;
};
