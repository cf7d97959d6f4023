// The core of the page against synth: the same meshes, recipes and messages. It needs node and no browser.
//   node core_test.js FOLDER_OF_CORE SYNTH [CELLS]
"use strict";
const {spawnSync} = require("child_process");
const crypto = require("crypto");
const fs = require("fs");
const os = require("os");
const path = require("path");
const zlib = require("zlib");
const {hostileRecipes} = require("./hostile_recipes.js");
const {loadCore} = require("./node_core.js");

const [coreFolder, synthFile, cells = "48"] = process.argv.slice(2);
const synth = path.resolve(synthFile);
const examples = path.join(__dirname, "../../synthesis/examples");
const folder = fs.mkdtempSync(path.join(os.tmpdir(), "core_test_"));
const sha256 = bytes => crypto.createHash("sha256").update(bytes).digest("hex");
let failures = 0;

function check(good, words) {
  if (good) return true;
  ++failures;
  console.log("FAILED: " + words);
  return false;
}

// What synth makes of a recipe in `folder`: {status, message, files}, the files in the order of their names.
function runSynth(name, names, options) {
  const ran = spawnSync(synth, [name, ...options, "--quiet"], {cwd: folder, encoding: "utf8", timeout: 60000});
  const files = names.map(file => path.join(folder, file)).map(file => fs.existsSync(file) ? fs.readFileSync(file) : null);
  names.forEach(file => fs.rmSync(path.join(folder, file), {force: true}));
  return {status: ran.status, message: ran.stderr.trim().replace(/^synth: /, ""), files};
}

// The same of the core; `work` gives its files.
function runCore(work) {
  try {
    return {status: 0, message: "", files: work()};
  } catch (error) {
    if (error.status === undefined) throw error;  // a trap
    return {status: error.status, message: error.message, files: []};
  }
}

// Every example has the mesh and the written recipe of synth, byte for byte: PLY and JSON, or GLB and the compact recipe as
// well, which every fourth example has. synth writes the heights of a relief into a file beside the JSON, the core into it.
function testExamples(core) {
  let same = 0, lacking = 0;
  fs.readdirSync(examples).sort().forEach((name, number) => {
    const bytes = fs.readFileSync(path.join(examples, name));
    fs.writeFileSync(path.join(folder, name), bytes);
    const pairs = [["ply", bytes.includes('"relief"') ? "astro" : "json"]];
    if (number % 4 === 0) pairs.push(["glb", "astro"]);
    const made = runCore(() => {
      core.make(bytes, name, Number(cells));
      return pairs.flatMap(([mesh, recipe]) => [core.writeMesh(mesh).bytes, core.writeRecipe(bytes, name, recipe).bytes]);
    });
    if (/beside the recipe/.test(made.message)) {
      ++lacking;
      console.log(made.message);
      return;
    }
    const right = pairs.flatMap(([mesh, recipe]) => runSynth(name, ["mesh." + mesh, "again." + recipe],
      ["-o", "mesh." + mesh, "--write-recipe", "again." + recipe, "--resolution", cells]).files);
    const equal = right.map((file, i) => made.files[i] !== undefined && file !== null && sha256(file) === sha256(made.files[i]));
    if (check(equal.every(Boolean), `${name}: ${pairs} equal synth's: ${equal} ${made.message}`)) ++same;
  });
  const {bytes, sha256: digits} = core.writeMesh("ply");
  check(sha256(bytes) === digits, "the core's own SHA-256 is another");
  console.log(`examples: ${same} with the SHA-256 of synth at ${cells} cells, ${lacking} that need files`);
}

// Damaged recipes get the message of synth and no trap; where they are right all the same, the mesh.
function testHostileRecipes(core) {
  let refused = 0, made = 0;
  for (const {name, bytes} of hostileRecipes(80)) {
    fs.writeFileSync(path.join(folder, name), bytes);
    const right = runSynth(name, ["mesh.ply"], ["-o", "mesh.ply", "--resolution", "16"]);
    const got = runCore(() => {
      core.make(bytes, name, 16);
      return [core.writeMesh("ply").bytes];
    });
    check(got.status === right.status && got.message === right.message, `${name}: ${got.status} ${got.message}\n  synth: ${right.status} ${right.message}`);
    if (right.status === 0 && got.status === 0) check(sha256(got.files[0]) === sha256(right.files[0]), `${name}: another mesh`);
    right.status === 0 ? ++made : ++refused;
  }
  console.log(`damaged recipes: ${refused} refused in the words of synth, ${made} made as it makes them`);
}

// Bodies drawn from the library's population have the recipe of synth, or its message. The first has its mesh, too.
function testDraws(core) {
  const library = path.join(__dirname, "../../library");
  const bytes = fs.readFileSync(path.join(library, "populations/asteroids.astro"));
  const bodies = Object.fromEntries(fs.readdirSync(library).filter(file => file.endsWith(".astro"))
    .map(file => [file, fs.readFileSync(path.join(library, file))]));
  const population = JSON.parse(Buffer.from(core.writeRecipe(bytes, "asteroids", "json").bytes));
  const draws = [
    [7, {class: "top", diameter: 330}, ["--class", "top", "--diameter", "330"]],
    [1, {}, []],
    [12345678901, {axes: [1, 0.8, 0.5]}, ["--axes", "1:0.8:0.5"]],
    [2, {axes: [1, 0.1, 0.05]}, ["--axes", "1:0.1:0.05"]],
    [3, {axes: [0.5, 1, 1]}, ["--axes", "0.5:1:1"]],
  ];
  let drawn = 0;
  draws.forEach(([seed, draw, conditions], number) => {
    const mesh = number === 0, document = {...population, seed, population: {...population.population, draw}};
    const names = mesh ? ["new.astro", "new.ply"] : ["new.astro"];
    const right = runSynth("asteroids", names, ["--seed", seed, ...conditions, "--write-recipe", "new.astro",
      ...(mesh ? ["-o", "new.ply", "--resolution", cells] : [])]);
    const got = runCore(() => {
      const recipe = core.draw(Buffer.from(JSON.stringify(document)), "asteroids", bodies).bytes;
      const files = [core.writeRecipe(recipe, "new.json", "astro").bytes];
      if (!mesh) return files;
      core.make(recipe, "new.json", Number(cells));
      return [...files, core.writeMesh("ply").bytes];
    });
    check(got.status === right.status && got.message === right.message, `draw ${number}: ${got.status} ${got.message}\n  synth: ${right.status} ${right.message}`);
    if (got.status !== 0 || right.status !== 0) return;
    if (check(got.files.every((file, i) => sha256(file) === sha256(right.files[i])), `draw ${number}: another body than synth's`)) ++drawn;
  });
  check(drawn === 3, `${drawn} of 3 bodies drawn as synth draws them`);
  console.log(`draws: ${drawn} bodies with the bytes of synth, ${draws.length - 3} refused in its words`);
}

// A PNG file of 16 x 16 pixels of 8 bits.
function pngOf(kind, rows, ...chunks) {
  const chunk = (type, data) => {
    const length = Buffer.alloc(4);
    length.writeUInt32BE(data.length);
    return Buffer.concat([length, Buffer.from(type), data, Buffer.alloc(4)]);  // sums are not looked at
  };
  const signature = Buffer.from([137, 80, 78, 71, 13, 10, 26, 10]), head = Buffer.from([0, 0, 0, 16, 0, 0, 0, 16, 8, kind, 0, 0, 0]);
  return Buffer.concat([signature, chunk("IHDR", head), ...chunks.map(data => chunk("PLTE", data)), chunk("IDAT", zlib.deflateSync(rows))]);
}

// The palette counts where the pixels are its numbers, and the stream ends where the pixels do.
async function testPngs() {
  const {decodedPng} = await import("../../web/page/png_reading.js");
  const palette = Buffer.from([9, 8, 7, 6, 5, 4]), colors = Buffer.alloc(16 * 49, 1), numbers = Buffer.alloc(16 * 17, 1);
  for (let y = 0; y < 16; ++y) colors[49 * y] = numbers[17 * y] = 0;
  const decoded = (...png) => decodedPng(pngOf(...png), "a.png").then(({rgb}) => String(rgb.slice(0, 3).map(x => x / 257)), error => error.message);
  const cases = [
    ["1,1,1", 2, colors, palette],
    ["6,5,4", 3, numbers, palette],
    ["a.png: lacks its palette; save it again", 3, numbers],
    ["a.png: holds more bytes than its pixels have; save it again", 2, Buffer.alloc(1e7), palette],
    ["a.png: ends too early; save it again", 2, numbers],
  ];
  for (const [right, ...png] of cases) {
    const got = await decoded(...png);
    check(got === right, `a PNG: ${got} instead of ${right}`);
  }
}

// A host that says no stops the work, and the core goes on to the next call.
async function testStop() {
  let calls = 0, stops = true;
  const core = await loadCore(coreFolder, {goesOn: () => ++calls < 2 || !stops});
  const bytes = fs.readFileSync(path.join(examples, "kernels.json"));
  const stopped = runCore(() => core.make(bytes, "kernels.json", 64));
  check(stopped.status === 1 && /stopped/.test(stopped.message), `a stopped mesh: ${stopped.status} ${stopped.message}`);
  stops = false;
  check(runCore(() => core.make(bytes, "kernels.json", 16)).status === 0, "a mesh after a stop");
}

async function main() {
  const core = await loadCore(coreFolder);
  testExamples(core);
  testHostileRecipes(core);
  testDraws(core);
  await testPngs();
  await testStop();
  fs.rmSync(folder, {recursive: true});
  process.exit(failures > 0 ? 1 : 0);
}
main();
