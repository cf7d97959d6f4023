// The core in node: loadCore(FOLDER) gives the calls of web/page/core_calls.js once the module is ready.
"use strict";
const fs = require("fs");
const path = require("path");

exports.loadCore = async function (folder, settings = {}) {
  const {coreCalls} = await import("../../web/page/core_calls.js");
  const makeCore = require(path.resolve(folder, "astrolith_core.js"));
  const wasmBinary = fs.readFileSync(path.join(folder, "astrolith_core.wasm"));
  return coreCalls(await makeCore({wasmBinary, ...settings}));
};
