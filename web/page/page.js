// The page: what its parts do together. The page's data are {worker, schema, knobs, examples, library, wall, population}.
import {at, element, download, copyText, shellWord} from "./dom.js";
import {recipeText} from "./recipe_text.js";
import {EditedRecipe} from "./edited_recipe.js";
import {schemaValues} from "./schema_values.js";
import {addedValues} from "./added_values.js";
import {schemaForm} from "./schema_form.js";
import {recipeKnobs} from "./knobs.js";
import {knobPanel} from "./knob_panel.js";
import {CoreClient} from "./core_client.js";
import {BodyMaker} from "./body_maker.js";
import {Stage} from "./stage.js";
import {newAsteroids} from "./draws.js";
import {coarseMesh} from "./coarse_mesh.js";
import {droppedFiles, sortedFiles, imagesIn} from "./opening.js";
import {recordTurn} from "./film.js";
import {printedMesh} from "./printed_mesh.js";
import {likesStrip} from "./likes.js";
import {kept} from "./kept.js";
import {tabs} from "./tabs.js";

const LONGEST_LINK = 500000;  // characters; browsers take addresses of one or two million
const WARM_MS = 100;          // after the wall is shown
const SILENT_MS = 300;        // after which the bar says that work goes on
const AHEAD_MS = 1200;        // of rest before the next asteroid is drawn ahead
const VALUE_CELLS = 128;      // of the finest mesh whose values are shown: gravity takes long
const COARSE_CELLS = 32;      // of the wall's meshes (make_wall.py)

const bytesOf = text => Uint8Array.from(atob(text), character => character.charCodeAt(0));
// Each byte as a character, in parts: a call has room for so many arguments.
function bytesText(bytes) {
  let text = "";
  for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
  return text;
}
const encoded = text => new TextEncoder().encode(text);
const base64Address = bytes => btoa(bytesText(bytes)).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");

const unzipped = bytes => new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
// The bytes that the build has compressed into an element of the page.
function unpacked(id) {
  const bytes = bytesOf(at(id).textContent);
  at(id).remove();
  return unzipped(bytes);
}

async function startPage() {
  const [module, DATA] = await Promise.all([
    unpacked("core").then(bytes => WebAssembly.compile(bytes)),
    unpacked("data").then(bytes => JSON.parse(new TextDecoder().decode(bytes)))]);
  const newCore = () => new CoreClient(DATA.worker, module), cores = {main: newCore(), fine: newCore(), ahead: newCore()};
  const library = Object.fromEntries(Object.entries(DATA.library).map(([name, text]) => [`${name}.astro`, bytesOf(text)]));
  const coarseMeshes = JSON.parse(at("meshes").textContent);
  const stage = new Stage(), values = schemaValues(DATA.schema), knobs = recipeKnobs(DATA.knobs, values);
  let recipe = null, size = 1, opened = 0, unchanged = "";

  // -- editing --------------------------------------------------------------------------------------------------------------

  const editing = {
    get: path => recipe.get(path),
    set: (path, value, gesture) => recipe.set(path, value, gesture),
    move: (path, step) => recipe.move(path, step),
    endGesture: () => { if (recipe) recipe.gesture = undefined; },
    lengthUnit: () => recipe.document.length_unit || "m",
    size: () => size,
    added: addedValues(DATA.knobs, values),
    canSwitch: path => path.length === 2 && path[0] === "layers",
    isOff: path => editing.canSwitch(path) && recipe.off.has(path[1]),
    switchItem: (path, on) => recipe.switchLayer(path[1], on),
    changed: () => changed(),
    document: () => recipe && recipe.document,
    put(document, gesture) {
      recipe.replace(document, gesture);
      changed();
    },
  };
  const form = schemaForm(at("form"), values, editing), panel = knobPanel(at("knobs"), knobs, editing);
  const panels = tabs(["knobs", "fields", "save"], name => {
    if (name === "fields" && recipe) form.rebuild();
    if (name === "save" && recipe) tellCommand();
  });
  at("seek").oninput = () => recipe && form.seek(at("seek").value);

  // -- meshes ---------------------------------------------------------------------------------------------------------------

  function say(mesh, cells) {
    const {triangles, extent, length_unit: unit, closed, components} = mesh.figures;
    const sides = extent.map(x => Number(x.toPrecision(3))).join(" × ");
    at("figures").textContent = `${triangles.toLocaleString("en")} triangles, ${closed ? "closed" : "open"}, ` +
      `${components} ${components === 1 ? "piece" : "pieces"}, ${sides} ${unit}, ${cells} cells, ${(mesh.milliseconds / 1000).toFixed(2)} s`;
  }
  const maker = new BodyMaker(cores, {
    onmesh(mesh, cells, isFirst) {
      size = Math.max(...mesh.figures.extent);
      mesh.milliseconds = mesh.milliseconds || 0;
      at("ghost").hidden = at("waiting").hidden = true;
      stage.show(mesh, isFirst, at("values").value);
      performance.mark("picture", {detail: cells});
      say(mesh, cells);
      at("refusal").textContent = "";
      form.clear();
      if (isFirst && recipe) panel.update();
    },
    onrefusal: error => refuse(error),
    onworking: isWorking => tellWork(isWorking),
  });

  let silent = 0;
  function tellWork(isWorking) {
    clearTimeout(silent);
    at("stop").hidden = at("work").hidden = true;
    if (!isWorking) return;
    silent = setTimeout(() => {  // fractions come late where a morph or a relief is prepared
      at("work").removeAttribute("value");
      at("work").hidden = at("stop").hidden = false;
    }, SILENT_MS);
  }
  const onfraction = fraction => { at("work").value = fraction; };
  Object.values(cores).forEach(core => { core.onfraction = onfraction; });
  // Waits for a work that the user can stop.
  async function waitedFor(work) {
    tellWork(true);
    return work.finally(() => tellWork(Boolean(maker.running)));
  }

  // The path that a message names, as keys; the layers are those of the text.
  function pathIn(message) {
    const rest = message.startsWith(recipe.name + ": ") ? message.slice(recipe.name.length + 2) : message;
    const words = rest.slice(0, rest.indexOf(": "));
    if (!/^[A-Za-z_][\w.[\]]*$/.test(words)) return [];
    const path = [...words.matchAll(/[A-Za-z_]\w*|\[(\d+)\]/g)].map(([word, number]) => number === undefined ? word : Number(number));
    if (path[0] === "layers" && path.length > 1) path[1] = recipe.layerOfText(path[1]);
    return path;
  }
  function refuse(error) {
    if (error.stopped) return;
    at("refusal").textContent = error.message;
    const path = recipe ? pathIn(error.message) : [];
    if (path.length > 0) form.refuse(path, error.message);
  }

  const finest = () => Number(at("resolution").value);
  function wanted(more) {
    const what = at("values").value, cells = what ? Math.min(finest(), VALUE_CELLS) : finest();
    return {recipe: encoded(recipe.text()), name: recipe.name, cells, values: what || undefined, ...more};
  }
  const draw = more => recipe ? maker.want(wanted(more)) : Promise.resolve();

  function changed() {
    at("undo").disabled = recipe.before.length === 0;
    at("redo").disabled = recipe.after.length === 0;
    if (location.hash) history.replaceState(null, "", location.href.replace(/#.*/, ""));  // the link holds another body now
    kept.keep(recipe.name, () => recipe.text());
    panel.update();
    if (panels.shown() === "save") tellCommand();
    return draw();
  }

  // -- opening --------------------------------------------------------------------------------------------------------------

  function showBody(isBody) {
    document.body.dataset.shows = isBody ? "body" : "wall";
    kept.tellShown(isBody);
    at("ghost").hidden = true;
    if (isBody) return stage.view.request();
    at("title").textContent = "";
    tellKept();
    warmSoon();
    drawSoon();
  }

  // The first picture of a body is prepared while the wall is looked at.
  const warmSoon = () => setTimeout(() => stage.view.warm && stage.view.warm(at("stage").clientWidth || innerWidth, at("stage").clientHeight || innerHeight), WARM_MS);

  // Draws ahead once the page is at rest: what the user has chosen goes first.
  let soon = 0;
  function drawSoon() {
    clearTimeout(soon);
    soon = setTimeout(() => maker.running ? drawSoon() : asteroids.drawAhead(), AHEAD_MS);
  }

  // Images in the place of those that all cores have. The calls of a core wait for its images.
  async function giveImages(images) {
    const {main, ...others} = cores;
    Object.values(others).forEach(core => core.give(images).catch(() => {}));  // main says the same
    await main.give(images);
  }

  // The document in the bytes of a file. The core reads it first, and refuses what is no recipe. Of the files beside it those
  // that it names are given to the cores. The fields that a JSON recipe leaves out stay out.
  async function documentOf(bytes, name, files) {
    const written = async () => new TextDecoder().decode((await cores.main.lasting("writeRecipe", bytes, name, "json")).bytes);
    await giveImages([]);
    const json = await written(), named = files.filter(file => json.includes(file.name));
    if (named.length > 0) await giveImages(await imagesIn(named));
    const isCompact = bytesText(bytes.subarray(0, 3)) === "AST";
    const document = recipeText.read(bytes.length > 0 && !isCompact ? new TextDecoder().decode(bytes) : json);
    const hasImages = !isCompact && (document.layers || []).some(layer => layer.type === "relief" && layer.image);
    return hasImages ? recipeText.read(await written()) : document;  // the heights lie in the recipe then
  }

  // Shows a document; `mesh` is its coarse mesh where that was made before, by the main core or, with `opens`, not.
  async function openDocument(document, name, {words = "", mesh = null, opens = !mesh, library: libraryName = ""} = {}) {
    recipe = new EditedRecipe(document, name.replace(/\.astro$/, ".json"));
    unchanged = libraryName && `${libraryName}\n${recipe.text()}`;
    at("drawn").textContent = words;
    at("title").textContent = recipe.name.replace(/\.json$/, "").replace(/_/g, " ");
    stage.names[0] = at("title").textContent;
    at("undo").disabled = at("redo").disabled = true;
    ["layers", "layers[0]"].forEach(form.open);
    tellRefusal("");
    const {hidden} = at("ghost");
    showBody(true);
    at("ghost").hidden = hidden;
    likes.clear();
    if (panels.shown() === "fields") form.rebuild();
    if (panels.shown() === "save") tellCommand();
    kept.keep(recipe.name, () => recipe.text());
    if (mesh) {
      size = Math.max(...mesh.figures.extent);
      panel.update();
    }
    await draw({opens, mesh: at("values").value ? null : mesh});
  }

  // Opens the bytes of a file, given or promised, with the images beside it. One that holds no recipe leaves the page as it
  // is, but for the message; of several that are opened at once the last counts.
  async function openBytes(given, name, {images = [], ...more} = {}) {
    const number = ++opened, {images: before} = cores.main;
    await maker.stop("replaced");
    let read;
    try {
      read = await documentOf(await given, name, images);
    } catch (error) {
      if (number !== opened) return false;
      if (!error.stopped) tellRefusal(error.message);
      giveImages(before).catch(() => {});  // the recipe that stays may need them
      return false;
    }
    if (number !== opened) return false;
    await openDocument(read, name, more);
    return true;
  }
  const tellRefusal = message => { at("refusal").textContent = message; };
  const openText = (text, name) => openBytes(encoded(text), name);

  async function openNamed(name, more = {}) {
    const example = DATA.examples[name], drawn = DATA.wall[name];
    if (library[`${name}.astro`]) return openBytes(library[`${name}.astro`], `${name}.astro`, {library: name, ...more});
    if (drawn) return openBytes(bytesOf(drawn), `${name}.astro`, more);
    return example !== undefined && openBytes(encoded(example), `${name}.json`, more);
  }

  async function openMesh({bytes, name}) {
    const fit = `fit_shape ${shellWord(name)} -o ${shellWord(name.replace(/\.\w+$/, "") + ".json")}`;
    const words = element("p", {textContent: `${name} is a mesh. It is shown beside the body, turning with it. ` +
      "To make a recipe of it that you can change here, run this where the programs are, and drop the recipe that it writes:"});
    const command = element("pre", {textContent: fit, tabIndex: 0}), copy = element("button", {type: "button", textContent: "Copy the command"});
    copy.onclick = () => copyText(fit, copy);
    showBody(true);
    try {
      const mesh = await waitedFor(cores.main.lasting("readMesh", bytes, name));
      at("refusal").textContent = "";
      stage.showBeside(mesh, name);
      tellBeside(words, command, copy);
    } catch (error) {
      at("refusal").textContent = `${error.message} (${fit} makes a recipe of it)`;
    }
  }
  function tellBeside(...parts) {
    const close = element("button", {type: "button", textContent: "Remove it", onclick: () => hideBeside()});
    at("beside").replaceChildren(...parts, " ", close);
    at("beside").hidden = false;
    at("compare").setAttribute("aria-pressed", "true");
  }
  function hideBeside() {
    stage.hideBeside();
    at("beside").hidden = true;
    at("compare").setAttribute("aria-pressed", "false");
  }
  at("compare").onclick = () => {
    if (at("compare").getAttribute("aria-pressed") === "true") return hideBeside();
    if (!stage.mesh) return;
    stage.showBeside(stage.mesh, `${at("title").textContent}, before`);
    tellBeside(element("p", {textContent: "This body stays beside what you make next. Both turn together."}));
  };

  async function openFiles(files) {
    if (files.length === 0) return;
    const given = await sortedFiles(files);
    if (given.kind === "none") return tellRefusal(given.words);
    if (given.kind === "mesh") return openMesh(given);
    await openBytes(given.bytes, given.name, {words: given.words, images: given.images});
  }
  at("file").onchange = () => {
    const files = [...at("file").files];
    at("file").value = "";  // so that the same file can be opened again
    openFiles(files);
  };
  document.ondragover = event => { event.preventDefault(); document.body.classList.add("dropping"); };
  document.ondragleave = event => { if (!event.relatedTarget) document.body.classList.remove("dropping"); };
  document.ondrop = event => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    droppedFiles(event.dataTransfer).then(openFiles);
  };

  // -- the wall -------------------------------------------------------------------------------------------------------------

  at("examples").append(new Option("choose", ""));
  for (const [label, names] of [["measured bodies", Object.keys(DATA.library)], ["examples", Object.keys(DATA.examples)]]) {
    const group = at("examples").appendChild(element("optgroup", {label}));
    group.append(...names.map(name => new Option(name.replace(/_/g, " "), name)));
  }
  at("examples").onchange = () => {
    if (at("examples").value) openNamed(at("examples").value);
    at("examples").value = "";
  };
  // The picture of a body stays until its coarse mesh is unpacked, and that until the core has made a finer one.
  async function openFromWall(button) {
    const {name} = button.dataset, coarse = coarseMeshes[name];
    at("ghost").style.setProperty("--sheet", button.querySelector(".sheet-view").style.getPropertyValue("--sheet"));
    stage.clear();
    showBody(true);
    at("ghost").hidden = false;
    if (!coarse) return openNamed(name);
    const number = opened, mesh = coarseMesh(new Uint8Array(await unzipped(bytesOf(coarse))));
    if (number !== opened) return;  // another was chosen meanwhile
    await maker.stop("replaced");
    maker.hooks.onmesh(mesh, COARSE_CELLS, true);
    return openNamed(name, {mesh, opens: true});
  }
  let choosing = Promise.resolve();  // until what was chosen last is being made
  document.querySelectorAll(".bodies button").forEach(button => { button.onclick = () => { choosing = openFromWall(button).catch(refuse); }; });
  at("home").onclick = () => showBody(false);
  function tellKept() {
    const last = kept.recipe();
    at("go-on").hidden = !last && !recipe;
    if (recipe || last) at("go-on").textContent = `Go on with ${(recipe || last).name.replace(/\.json$/, "").replace(/_/g, " ")}`;
  }
  at("go-on").onclick = () => recipe ? openKeptRecipe() : openKept();
  const openKeptRecipe = () => {
    at("title").textContent = stage.names[0];
    showBody(true);
  };
  function openKept() {
    const last = kept.recipe();
    return last ? openText(last.text, last.name) : Promise.resolve(false);
  }

  // -- new asteroids --------------------------------------------------------------------------------------------------------

  const asteroids = newAsteroids({
    cores, schema: DATA.schema, library, finished: knobs.finished,
    population: () => cores.ahead.lasting("writeRecipe", bytesOf(DATA.population), "asteroids", "json")
      .then(({bytes}) => recipeText.read(new TextDecoder().decode(bytes))),
  });
  async function drawNext() {
    const number = ++opened;
    showBody(true);
    at("waiting").hidden = stage.view.shown().length > 0;
    await maker.stop("replaced");
    const drawn = await waitedFor(asteroids.next()).catch(error => {
      at("waiting").hidden = true;
      throw error;
    });
    if (number !== opened) return;
    const {document, name, words, mesh} = drawn;
    await openDocument(document, name, {words, mesh});
    drawSoon();
  }
  const drawOrRefuse = event => {
    event.preventDefault();
    return drawNext().catch(refuse);
  };
  at("draw").onsubmit = at("new").onclick = at("first-new").onclick = drawOrRefuse;
  at("draw").onchange = drawSoon;

  const likes = likesStrip(at("strip"), {
    cores, stage, recipe: () => recipe, finest,
    take: document => editing.put(document, undefined),
  });
  at("likes").onclick = () => recipe && likes.toggle();

  // -- undo -----------------------------------------------------------------------------------------------------------------

  function step(back) {
    if (recipe && (back ? recipe.undo() : recipe.redo())) {
      if (panels.shown() === "fields") form.rebuild();
      changed();
    }
  }
  at("undo").onclick = () => step(true);
  at("redo").onclick = () => step(false);
  document.onkeydown = event => {
    const typing = /^(INPUT|TEXTAREA)$/.test(event.target.tagName) && event.target.type !== "range" && event.target.type !== "checkbox";
    if (!(event.ctrlKey || event.metaKey) || typing) return;
    if (event.key === "z" && !event.shiftKey) { event.preventDefault(); step(true); }
    if (event.key === "y" || (event.key.toLowerCase() === "z" && event.shiftKey)) { event.preventDefault(); step(false); }
  };

  // -- what is saved --------------------------------------------------------------------------------------------------------

  const stem = () => recipe.name.replace(/\.[^.]*$/, "");
  // The mesh of the finest resolution as a file, {bytes, sha256}: of the recipe as it is now, whatever is drawn.
  const meshFile = format => waitedFor(cores.fine.lasting("meshFile", encoded(recipe.text()), recipe.name, finest(), format));
  const recipeFile = format => cores.main.lasting("writeRecipe", encoded(recipe.text()), recipe.name, format);

  async function link() {
    const code = base64Address((await recipeFile("astro")).bytes);
    if (code.length > LONGEST_LINK) {
      throw new Error(`the recipe is too long for a link (${code.length} of at most ${LONGEST_LINK} characters); save the .astro`);
    }
    return location.href.replace(/#.*/, "") + "#r=" + code;
  }

  // The command that makes the same mesh where the programs are.
  async function tellCommand() {
    const output = `-o ${shellWord(stem() + ".glb")} --resolution ${finest()}`, file = shellWord(stem() + ".astro");
    const [name, text] = unchanged.split(/\n([\s\S]*)/);
    if (name && text === recipe.text()) return void (at("command").textContent = `synth ${name} ${output}`);
    const {bytes} = await recipeFile("astro").catch(() => ({bytes: new Uint8Array()}));
    at("command").textContent = `echo ${btoa(bytesText(bytes))} | base64 -d > ${file}\nsynth ${file} ${output}`;
  }
  at("copy-command").onclick = () => copyText(at("command").textContent, at("copy-command"));

  let filming = new AbortController();  // of the film that is recorded
  const saves = {
    json: () => download(new Blob([recipe.text()], {type: "application/json"}), `${stem()}.json`),
    astro: async () => download(new Blob([(await recipeFile("astro")).bytes]), `${stem()}.astro`),
    png: () => new Promise(done => stage.picture(3840, 2160).toBlob(done, "image/png")).then(blob => download(blob, `${stem()}.png`)),
    film: async () => {
      filming.abort();
      filming = new AbortController();
      download(await waitedFor(recordTurn(stage, filming)), `${stem()}.webm`);
    },
    stl: async () => {
      const mesh = await waitedFor(cores.fine.lasting("make", encoded(recipe.text()), recipe.name, finest()));
      download(new Blob([printedMesh(mesh, Number(at("print-size").value) || 80)], {type: "model/stl"}), `${stem()}.stl`);
    },
    link: async button => {
      history.replaceState(null, "", await link());
      await copyText(location.href, button.firstChild.parentElement);
      at("figures").textContent = "the address of this page now holds the body, and was copied";
    },
  };
  at("save-panel").addEventListener("click", event => {
    const button = event.target.closest("[data-save]");
    if (!button || !recipe) return;
    const kind = button.dataset.save, save = saves[kind] || (async () => download(new Blob([(await meshFile(kind)).bytes]), `${stem()}.${kind}`));
    Promise.resolve().then(() => save(button)).catch(refuse);
  });

  // -- the rest -------------------------------------------------------------------------------------------------------------

  at("stop").onclick = () => { maker.stop("user"); asteroids.stop(); filming.abort(); };
  at("resolution").onchange = () => draw();
  at("values").onchange = () => draw();
  cores.main.lasting("version").then(version => { at("version").textContent = `Astrolith ${version}.`; }, refuse);

  // For whoever drives the page by a script: tests, and other pages.
  const setCells = cells => {
    if (![...at("resolution").options].some(option => option.value === String(cells))) at("resolution").append(new Option(cells));
    at("resolution").value = cells;
    return draw({patient: true});
  };
  window.astrolith = {openText, openFiles, openNamed, settled: () => opening.then(() => choosing).then(() => maker.settled()), meshFile, recipeFile, recipeText: () => recipe && recipe.text(), link, setCells};

  async function openLink(code) {
    let bytes;
    try {
      bytes = bytesOf(code.replace(/-/g, "+").replace(/_/g, "/"));
    } catch (error) {
      tellRefusal("the link is damaged: what stands behind #r= is no recipe");
      return false;
    }
    return openBytes(bytes, "link.astro");
  }

  // The recipe of the link, or that of the page, or what this tab showed before it was loaded again; else the wall.
  async function openFirst() {
    const link = location.hash.match(/^#r=(.*)$/), own = JSON.parse(at("recipe").textContent), early = window.earlyChoice;
    delete window.earlyChoice;
    if (link) return openLink(link[1]);
    if (early) return early === "new" ? drawNext().catch(refuse) : openFromWall(document.querySelector(`[data-name=${early}]`));
    if (kept.wasShown() && await openKept()) return true;
    if (own) return openBytes(bytesOf(own.bytes), own.name);
    return showBody(false);
  }
  window.onhashchange = openFirst;
  const opening = openFirst();
  document.body.dataset.ready = "yes";
  await opening;
}

startPage().catch(error => {
  document.body.dataset.shows = "body";
  at("refusal").textContent = `this browser cannot show the page: ${error.message}`;
});
