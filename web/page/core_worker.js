// The core in a worker. A message {id, call, args} is answered by {id, result} or {id, error: {message, status}}, and
// while a mesh is made by {fraction}. The first message brings the module: {module}.
"use strict";
const TELL_MS = 100;
let core;

function start(module) {
  let told = 0;
  const goesOn = fraction => {
    const now = performance.now();
    if (now - told > TELL_MS) {
      postMessage({fraction});
      told = now;
    }
    return true;
  };
  core = new Promise((resolve, reject) => {
    const instantiateWasm = (imports, receive) => {
      WebAssembly.instantiate(module, imports).then(receive).catch(reject);
      return {};
    };
    makeAstrolithCore({instantiateWasm, goesOn}).then(coreCalls).then(resolve, reject);
  });
  core.catch(() => {});  // every call tells of it
}

const calls = {
  // The mesh of a recipe; with `what` also its values of that kind.
  make(core, recipe, name, resolution, what) {
    core.make(recipe, name, resolution);
    const mesh = core.mesh();
    mesh.place = meshPlace(mesh.positions);
    return what ? {...mesh, ...core.values(what)} : mesh;
  },
  meshFile(core, recipe, name, resolution, format) {
    core.make(recipe, name, resolution);
    return core.writeMesh(format);
  },
  writeRecipe: (core, recipe, name, format) => core.writeRecipe(recipe, name, format),
  // The images in the place of all that were given before; one that cannot be read leaves those.
  async giveImages(core, images) {
    const decoded = [];
    for (const {name, bytes} of images) decoded.push([name, bytes, await decodedPng(bytes, name)]);
    core.forgetImages();
    decoded.forEach(image => core.giveImage(...image));
  },
  draw: (core, recipe, name, library) => core.draw(recipe, name, library),
  readMesh: (core, bytes, name) => readMesh(bytes, name),
  version: core => core.version(),
};

const buffersOf = result => Object.values(result).filter(ArrayBuffer.isView).map(array => array.buffer);

async function answer(data) {
  try {
    const result = await calls[data.call](await core, ...data.args);
    postMessage({id: data.id, result}, result && typeof result === "object" ? buffersOf(result) : []);
  } catch (error) {
    postMessage({id: data.id, error: {message: error.message, status: error.status}});
  }
}

// Each call waits for the one before it: images take a while to be read.
let before = Promise.resolve();
onmessage = ({data}) => {
  if (data.module) return start(data.module);
  before = before.then(() => answer(data));
};
