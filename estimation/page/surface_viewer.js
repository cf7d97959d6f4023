// Shows two surfaces that are turned together: side by side, or the one over the other with a slider between
// them. `figure` is the element of the page that holds the canvas and the controls. Each surface states
//   positions  16-bit steps of the coordinates, x y z for each vertex
//   triangles  16-bit indices, three for each triangle
//   colors     sRGB bytes, three for each vertex, or nothing: then the surface is grey
// as base64 text of little-endian arrays. A step is 1 / 32767 of the scene's half width.
import {BodyView} from "./body_view.js";
import {orbit} from "./orbit.js";

export function showSurfaces(figure, surfaces) {
  "use strict";
  const element = name => figure.querySelector("." + name);
  const canvas = element("canvas"), slider = element("slider"), overlaid = element("overlaid"), colored = element("colored");
  const bytesOf = text => Uint8Array.from(atob(text), character => character.charCodeAt(0));

  // The mean of the normals of the triangles around each vertex, by their areas.
  function normalsOf(p, triangles) {
    const normals = new Float32Array(p.length);
    for (let i = 0; i < triangles.length; i += 3) {
      const [a, b, c] = [0, 1, 2].map(k => 3 * triangles[i + k]);
      const [u, v] = [b, c].map(q => [0, 1, 2].map(k => p[q + k] - p[a + k]));
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      for (const q of [a, b, c]) n.forEach((x, k) => { normals[q + k] += x; });
    }
    return normals;
  }

  // Colours with a scale stand for values, which shading must not darken.
  function meshOf(surface) {
    const positions = Float32Array.from(new Int16Array(bytesOf(surface.positions).buffer), step => step / 32767);
    const triangles = Uint32Array.from(new Uint16Array(bytesOf(surface.triangles).buffer));
    const colors = surface.colors ? bytesOf(surface.colors) : null;
    return {positions, triangles, normals: normalsOf(positions, triangles), colors, plain: Boolean(colors && element("scale"))};
  }

  let view;
  try {
    view = new BodyView(canvas);
  } catch (error) {
    return;  // a browser without WebGL keeps the pictures below
  }
  figure.hidden = false;
  view.parallel = null;
  view.isOpen = true;
  view.background = [0.082, 0.09, 0.11];
  view.fill = 0.06;
  Object.assign(view.camera, {latitude: 24, distance: 4});
  const meshes = surfaces.map(meshOf);
  const radius = Math.max(...meshes.map(({positions}) => {
    let square = 0;
    for (let i = 0; i < positions.length; i += 3) square = Math.max(square, positions[i] ** 2 + positions[i + 1] ** 2 + positions[i + 2] ** 2);
    return Math.sqrt(square);
  }));

  function show() {
    meshes.forEach((mesh, at) => view.setBody(at, colored.checked ? mesh : {...mesh, colors: null, plain: false}, [0, 0, 0, 1 / radius]));
  }
  function lay() {
    slider.hidden = !overlaid.checked;
    view.overlaid = overlaid.checked ? slider.value / 100 : null;
    view.request();
  }
  colored.addEventListener("input", show);
  for (const control of [slider, overlaid]) control.addEventListener("input", lay);
  orbit(view, canvas);
  show();
  lay();
}
