// The page: what its controls do. PAGE holds what the build takes into it: {worker, core, schema, examples, population, first}.
(async function () {
  "use strict";
  const at = id => document.getElementById(id);
  const COARSE = [12, 16, 24, 32, 48];  // cells of a mesh while something moves
  const REST_MS = 250;                  // after which a finer mesh is made
  const SILENT_MS = 300;                // after which the bar says that work goes on
  const LONGEST_LINK = 500000;          // characters; browsers take addresses of one or two million

  const bytesOf = text => Uint8Array.from(atob(text), character => character.charCodeAt(0));
  // Each byte as a character, in parts: a call has room for so many arguments.
  function bytesText(bytes) {
    let text = "";
    for (let i = 0; i < bytes.length; i += 8192) text += String.fromCharCode(...bytes.subarray(i, i + 8192));
    return text;
  }
  const encoded = text => new TextEncoder().encode(text);
  const client = new CoreClient(PAGE.worker, await WebAssembly.compile(bytesOf(PAGE.core)));
  PAGE.core = null;

  let view = null;
  try {
    view = new BodyView(at("view"));
  } catch (error) {
    at("refusal").textContent = "This browser has no WebGL, so that nothing is drawn here; meshes can be saved all the same.";
  }

  let recipe = null, form = null, size = 1;
  const values = schemaValues(PAGE.schema);
  const editing = {
    get: path => recipe.get(path),
    set: (path, value, gesture) => recipe.set(path, value, gesture),
    move: (path, step) => recipe.move(path, step),
    endGesture: () => { recipe.gesture = undefined; },
    lengthUnit: () => recipe.document.length_unit || "m",
    size: () => size,
    canSwitch: path => path.length === 2 && path[0] === "layers",
    isOff: path => editing.canSwitch(path) && recipe.off.has(path[1]),
    switchItem: (path, on) => recipe.switchLayer(path[1], on),
    changed: () => changed(),
  };
  form = schemaForm(at("form"), values, editing);

  // -- meshes: coarse ones while something moves, a finer one when it rests -----------------------------------------------

  let wanted = false, drawing = null, coarse = 3, fine = false, working = 0;

  function say(mesh, cells, milliseconds) {
    const {triangles, extent, length_unit: unit, closed, components} = mesh.figures;
    const sides = extent.map(x => Number(x.toPrecision(3))).join(" × ");
    at("figures").textContent = `${triangles.toLocaleString("en")} triangles, ${closed ? "closed" : "open"}, ` +
      `${components} ${components === 1 ? "piece" : "pieces"}, ${sides} ${unit}, ${cells} cells, ${(milliseconds / 1000).toFixed(2)} s`;
  }

  // Waits for a mesh, which the user can stop.
  async function waitedFor(work) {
    ++working;
    at("stop").disabled = false;
    client.onfraction = fraction => { at("work").hidden = false; at("work").value = fraction; };
    const silent = setTimeout(() => {  // fractions come late where a morph or a relief is prepared
      if (at("work").hidden) at("work").removeAttribute("value");
      at("work").hidden = false;
    }, SILENT_MS);
    try {
      return await work;
    } finally {
      clearTimeout(silent);
      if (--working === 0) at("work").hidden = at("stop").disabled = true;
    }
  }

  async function make(cells) {
    const start = performance.now();
    const mesh = await waitedFor(client.call("make", encoded(recipe.text()), recipe.name, cells));
    size = Math.max(...mesh.figures.extent);
    mesh.milliseconds = performance.now() - start;
    return mesh;
  }

  function show(mesh, cells) {
    if (view) view.show(mesh);
    performance.mark("picture", {detail: cells});
    say(mesh, cells, mesh.milliseconds);
    at("refusal").textContent = "";
    form.clear();
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

  const rested = () => new Promise(done => setTimeout(done, REST_MS));
  const finest = () => Number(at("resolution").value);

  // One mesh of a change; true where nothing changed meanwhile.
  async function drawOnce(cells) {
    try {
      const mesh = await make(cells);
      show(mesh, cells);
      if (cells === COARSE[coarse] && mesh.milliseconds > 200 && coarse > 0) --coarse;
      if (cells === COARSE[coarse] && mesh.milliseconds < 40 && coarse + 1 < COARSE.length) ++coarse;
      return !wanted;
    } catch (error) {
      if (!wanted) refuse(error);
      return false;
    }
  }

  async function drawAll() {
    while (wanted) {
      wanted = false;
      fine = false;
      if (COARSE[coarse] < finest()) {
        if (!await drawOnce(COARSE[coarse])) continue;
        await rested();
        if (wanted) continue;
      }
      fine = true;
      await drawOnce(finest());
    }
  }

  function draw() {
    wanted = true;
    if (drawing && fine) client.stop("replaced");
    if (!drawing) drawing = drawAll().finally(() => { drawing = null; });
    return drawing;
  }
  async function settled() {
    while (drawing) await drawing;
  }

  function changed() {
    at("undo").disabled = recipe.before.length === 0;
    at("redo").disabled = recipe.after.length === 0;
    at("like").hidden = !(recipe.document.layers || []).some(layer => layer.arrangement || layer.type === "relief");
    return draw();
  }

  // -- recipes ------------------------------------------------------------------------------------------------------------

  let opened = 0;         // how many times the user opened something
  let drawsBody = false;  // whether one is drawn from the population

  // Ends the meshes of what is open, and the draw of a body.
  async function stopped() {
    wanted = false;
    if (drawing || drawsBody) client.stop("replaced");
    await settled();
  }

  // The document in the bytes of a file. The core reads it first, and refuses what is no recipe. The fields that a JSON recipe
  // leaves out stay out.
  async function documentOf(bytes, name) {
    const json = await client.lasting("writeRecipe", bytes, name, "json");
    const isCompact = bytesText(bytes.subarray(0, 3)) === "AST";
    return recipeText.read(new TextDecoder().decode(isCompact ? json.bytes : bytes));
  }

  // Opens the bytes of a file, given or promised. One that holds no recipe leaves the page as it is, but for the message; of
  // several that are opened at once the last counts. `words` tell of a drawn body.
  async function openBytes(given, name, words = "") {
    const number = ++opened;
    await stopped();
    let read;
    try {
      read = await documentOf(await given, name);
    } catch (error) {
      if (number === opened && !error.stopped) at("refusal").textContent = error.message;
      return false;
    }
    if (number !== opened) return false;
    recipe = new EditedRecipe(read, name.replace(/\.astro$/, ".json"));
    at("drawn").textContent = words;
    at("examples").value = PAGE.examples.some(example => example.name === recipe.name) ? recipe.name : "";
    ["layers", "layers[0]"].forEach(form.open);
    if (view) view.refit();
    form.rebuild();
    await changed();
    return true;
  }
  const openText = (text, name) => openBytes(encoded(text), name);
  const openFile = file => openBytes(file.arrayBuffer().then(buffer => new Uint8Array(buffer)), file.name);
  const openExample = example => openBytes(example.bytes ? bytesOf(example.bytes) : encoded(example.text), example.name);

  at("examples").append(new Option("own recipe", ""));
  for (const label of ["measured bodies", "examples"]) {
    const group = at("examples").appendChild(document.createElement("optgroup"));
    group.label = label;
    const chosen = PAGE.examples.filter(({bytes}) => (bytes !== undefined) === (label === "measured bodies"));
    group.append(...chosen.map(({name}) => new Option(name.replace(".json", "").replace(/_/g, " "), name)));
  }
  at("examples").onchange = () => {
    const example = PAGE.examples.find(({name}) => name === at("examples").value);
    if (example) openExample(example);
  };
  at("file").onchange = () => {
    const file = at("file").files[0];
    at("file").value = "";  // so that the same file can be opened again
    if (file) openFile(file);
  };
  document.ondragover = event => { event.preventDefault(); document.body.classList.add("dropping"); };
  document.ondragleave = () => document.body.classList.remove("dropping");
  document.ondrop = event => {
    event.preventDefault();
    document.body.classList.remove("dropping");
    if (event.dataTransfer.files[0]) openFile(event.dataTransfer.files[0]);
  };

  // A body that nobody has seen, from the population.
  const body = drawnBody(at, PAGE.schema, () => documentOf(bytesOf(PAGE.population), "asteroids"));
  const measured = () => Object.fromEntries(PAGE.examples.filter(({bytes}) => bytes !== undefined)
    .map(({name, bytes}) => [name.replace(".json", ".astro"), bytesOf(bytes)]));

  async function drawNext() {
    const number = ++opened;
    await stopped();
    const {text, name} = await body.next();
    if (number !== opened) return;
    drawsBody = true;
    const drawn = await waitedFor(client.call("draw", encoded(text), "asteroids", measured())).finally(() => { drawsBody = false; });
    const document = recipeText.read(new TextDecoder().decode(drawn.bytes));
    if (number === opened) await openBytes(drawn.bytes, name, body.words(document, drawn.figures));
  }
  at("draw").onsubmit = event => {
    event.preventDefault();
    drawNext().catch(refuse);
  };

  function step(back) {
    if (back ? recipe.undo() : recipe.redo()) {
      form.rebuild();
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

  // Another body of the kind: what synth --like --seed does.
  at("like").onclick = () => {
    (recipe.document.layers || []).forEach((layer, i) => {
      if (layer.type === "relief") recipe.set(["layers", i, "arrangement"], "like", "like");
    });
    recipe.set(["seed"], Math.floor(Math.random() * 2 ** 31), "like");
    recipe.gesture = undefined;
    form.rebuild();
    changed();
  };

  // -- what is saved ------------------------------------------------------------------------------------------------------

  function download(blob, name) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }

  // The mesh of the finest resolution as a file, {bytes, sha256}: of the recipe as it is now, whatever is drawn.
  const meshFile = format =>
    waitedFor(client.lasting("meshFile", encoded(recipe.text()), recipe.name, finest(), format));
  const recipeFile = format => client.lasting("writeRecipe", encoded(recipe.text()), recipe.name, format);

  async function link() {
    const {bytes} = await recipeFile("astro");
    const code = btoa(bytesText(bytes)).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
    if (code.length > LONGEST_LINK) {
      throw new Error(`the recipe is too long for a link (${code.length} of at most ${LONGEST_LINK} characters); save the .astro`);
    }
    return location.href.replace(/#.*/, "") + "#r=" + code;
  }

  async function save(kind) {
    const stem = recipe.name.replace(/\.[^.]*$/, "");
    if (kind === "json") return download(new Blob([recipe.text()], {type: "application/json"}), stem + ".json");
    if (kind === "astro") return download(new Blob([(await recipeFile("astro")).bytes]), stem + ".astro");
    if (kind === "png") return view && download(await view.picture(), stem + ".png");
    if (kind !== "link") return download(new Blob([(await meshFile(kind)).bytes]), `${stem}.${kind}`);
    history.replaceState(null, "", await link());
    at("figures").textContent = "the address of this page now holds the recipe";
    if (navigator.clipboard) navigator.clipboard.writeText(location.href).catch(() => {});
  }
  at("saves").onclick = event => {
    const kind = event.target.dataset.save;
    if (kind) save(kind).catch(refuse);
  };

  // -- the rest -----------------------------------------------------------------------------------------------------------

  at("stop").onclick = () => client.stop("user");
  const tellCells = () => { at("cells").textContent = finest(); };
  at("resolution").oninput = () => { tellCells(); draw(); };
  const turnSun = () => view && view.setSun(Number(at("azimuth").value), Number(at("height").value));
  at("azimuth").oninput = at("height").oninput = turnSun;
  tellCells();
  client.lasting("version").then(version => { at("version").textContent = `Astrolith ${version}.`; }, refuse);

  // For whoever drives the page by a script: tests, and other pages.
  const setCells = cells => {
    at("resolution").value = cells;
    tellCells();
    return draw();
  };
  window.astrolith = {openText, settled, meshFile, recipeFile, recipeText: () => recipe.text(), link, setCells};

  async function openLink(code) {
    let bytes;
    try {
      bytes = bytesOf(code.replace(/-/g, "+").replace(/_/g, "/"));
    } catch (error) {
      at("refusal").textContent = "the link is damaged: what stands behind #r= is no recipe";
      return false;
    }
    return openBytes(bytes, "link.astro");
  }

  // The recipe of the link, or that of the page. Where neither is one, the first example, so that there is one to change.
  async function openFirst() {
    const link = location.hash.match(/^#r=(.*)$/), own = JSON.parse(at("recipe").textContent);
    if (link) await openLink(link[1]);
    else if (own) await openBytes(bytesOf(own.bytes), own.name);
    if (recipe && (link || own)) return;
    const message = at("refusal").textContent;
    await openExample(PAGE.examples.find(example => example.name === PAGE.first));
    if (message) at("refusal").textContent = message;
  }
  window.onhashchange = openFirst;
  await openFirst();
  client.keepSpare();
  document.body.dataset.ready = "yes";
})().catch(error => {
  document.getElementById("refusal").textContent = `this browser cannot show the page: ${error.message}`;
});
