// The calls of the core (web/core/page_core.h) with the types of JavaScript. `module` is what makeAstrolithCore() gives.
// A call that fails throws an Error whose `status` is that of synth: 1, the work failed, or 2, the recipe is wrong.
export function coreCalls(module) {
  "use strict";
  // The core's pointers come as signed numbers, its memory may have 4 GB.
  const place = pointer => pointer >>> 0;
  const textAt = pointer => module.UTF8ToString(place(pointer));
  const failed = (message, status) => Object.assign(new Error(message), {status});

  function withBytes(bytes, use) {
    const pointer = place(module._malloc(bytes.length + 1));
    if (pointer === 0) throw failed("the recipe needs more memory than a page may have", 1);
    try {
      module.HEAPU8.set(bytes, pointer);
      module.HEAPU8[pointer + bytes.length] = 0;
      return use(pointer);
    } finally {
      module._free(pointer);
    }
  }
  const withText = (text, use) => withBytes(new TextEncoder().encode(text), use);

  function require(status) {
    if (status !== 0) throw failed(textAt(module._astrolith_message()), status);
  }

  // A copy of `count` numbers: the memory moves when it grows.
  function taken(Type, pointer, count) {
    return pointer === 0 ? null : new Type(module.HEAPU8.buffer, place(pointer), count).slice();
  }

  function madeMesh() {
    const vertices = module._astrolith_vertex_count(), triangles = module._astrolith_triangle_count();
    return {
      positions: taken(Float32Array, module._astrolith_positions(), 3 * vertices),
      normals: taken(Float32Array, module._astrolith_normals(), 3 * vertices),
      colors: taken(Uint8Array, module._astrolith_colors(), 3 * vertices),
      triangles: taken(Uint32Array, module._astrolith_triangles(), 3 * triangles),
      figures: JSON.parse(textAt(module._astrolith_figures())),
    };
  }

  // A number at each vertex of the mesh: {values, unit, legend}; `what` is slope, height, albedo or label.
  function foundValues(what) {
    require(withText(what, w => module._astrolith_find_values(w)));
    const values = taken(Float32Array, module._astrolith_values(), module._astrolith_vertex_count());
    return {values, ...JSON.parse(textAt(module._astrolith_figures()))};
  }

  function written() {
    return {
      bytes: taken(Uint8Array, module._astrolith_bytes(), place(module._astrolith_byte_count())),
      sha256: textAt(module._astrolith_sha256()),
    };
  }

  // A call on the bytes of a recipe's file and its name in messages, and what it wrote.
  function drawnBy(work, recipe, name) {
    require(withBytes(recipe, r => withText(name, n => work(r, recipe.length, n))));
    return {...written(), figures: JSON.parse(textAt(module._astrolith_figures()))};
  }

  return {
    version: () => textAt(module._astrolith_version()),
    // `recipe` is the bytes of a file, `name` its name in messages.
    make(recipe, name, resolution) {
      require(withBytes(recipe, r => withText(name, n => module._astrolith_make(r, recipe.length, n, resolution))));
    },
    mesh: madeMesh,
    values: foundValues,
    writeMesh(format) {
      require(withText(format, f => module._astrolith_write_mesh(f)));
      return written();
    },
    writeRecipe(recipe, name, format) {
      require(withBytes(recipe, r => withText(name, n => withText(format,
        f => module._astrolith_write_recipe(r, recipe.length, n, f)))));
      return written();
    },
    forgetImages: () => module._astrolith_forget_images(),
    // An image that recipes name: the bytes of its file, and its pixels as decodedPng() gives them.
    giveImage(name, bytes, {width, height, values, rgb}) {
      const pixels = array => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
      require(withText(name, n => withBytes(bytes, b => withBytes(pixels(values), v => rgb
        ? withBytes(pixels(rgb), c => module._astrolith_give_image(n, b, bytes.length, width, height, v, c))
        : module._astrolith_give_image(n, b, bytes.length, width, height, v, 0)))));
    },
    // A body drawn from the recipe's population, with the ground of a measured one: {bytes, sha256, figures}. `library` has the
    // bytes of measured bodies' recipes by the names of their files; without it the body stays bare.
    draw(recipe, name, library) {
      const drawn = drawnBy(module._astrolith_draw, recipe, name), ground = drawn.figures.ground.replace(/.*\//, "");
      return ground && library ? drawnBy(module._astrolith_lay_ground, library[ground], ground) : drawn;
    },
  };
}
