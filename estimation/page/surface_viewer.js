// Shows two surfaces that are turned together: side by side, or the one over the other with a slider between
// them. `figure` is the element of the page that holds the canvas and the controls. Each surface states
//   positions  16-bit steps of the coordinates, x y z for each vertex
//   triangles  16-bit indices, three for each triangle
//   colors     sRGB bytes, three for each vertex, or nothing: then the surface is grey
// as base64 text of little-endian arrays. A step is 1 / 32767 of the scene's half width.
function showSurfaces(figure, surfaces) {
  "use strict";
  const element = name => figure.querySelector("." + name);
  const canvas = element("canvas"), slider = element("slider"), overlaid = element("overlaid");
  const colored = element("colored");
  const bytesOf = text => Uint8Array.from(atob(text), character => character.charCodeAt(0));

  function meshOf(surface) {
    const steps = new Int16Array(bytesOf(surface.positions).buffer);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(steps, s => s / 32767), 3));
    geometry.setIndex(new THREE.BufferAttribute(new Uint16Array(bytesOf(surface.triangles).buffer), 1));
    geometry.computeVertexNormals();
    if (surface.colors) {
      geometry.setAttribute("color", new THREE.BufferAttribute(bytesOf(surface.colors), 3, true));
    }
    return new THREE.Mesh(geometry);
  }

  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({canvas: canvas, antialias: true});
  } catch (error) {
    return;  // a browser without WebGL keeps the pictures below
  }
  figure.hidden = false;
  renderer.setScissorTest(true);
  renderer.setClearColor(0x15171c);
  const grey = new THREE.MeshLambertMaterial({color: 0xb8b2aa, side: THREE.DoubleSide});
  const byColor = new THREE.MeshLambertMaterial({vertexColors: THREE.VertexColors, side: THREE.DoubleSide});
  const camera = new THREE.PerspectiveCamera(30, 1, 0.05, 50);
  camera.up.set(0, 0, 1);
  camera.position.set(2.2, -3.6, 1.6);
  const sun = new THREE.DirectionalLight(0xffffff, 0.95);
  sun.position.set(-1.5, 1.2, 1);
  camera.add(sun);  // the light keeps its side while the bodies are turned
  const scenes = surfaces.map(surface => {
    const scene = new THREE.Scene();
    const mesh = meshOf(surface);
    scene.add(mesh, new THREE.AmbientLight(0xffffff, 0.25));
    return {scene: scene, mesh: mesh, hasColors: Boolean(surface.colors)};
  });
  const controls = new THREE.TrackballControls(camera, canvas);
  controls.staticMoving = true;
  controls.rotateSpeed = 2.5;
  controls.noPan = true;

  // Draws one surface in the columns left .. right of the canvas; the picture itself fills first .. last.
  function drawColumns(view, left, right, first, last) {
    const height = canvas.clientHeight;
    camera.aspect = (last - first) / height;
    camera.updateProjectionMatrix();
    renderer.setViewport(first, 0, last - first, height);
    renderer.setScissor(left, 0, right - left, height);
    view.mesh.material = view.hasColors && colored.checked ? byColor : grey;
    view.scene.add(camera);  // and its sun: a light belongs to one scene at a time
    renderer.render(view.scene, camera);
  }

  function draw() {
    const width = canvas.clientWidth, middle = width / 2;
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(width, canvas.clientHeight, false);
    slider.hidden = !overlaid.checked;
    if (overlaid.checked) {
      const border = Math.round(width * slider.value / 100);
      drawColumns(scenes[0], 0, border, 0, width);
      drawColumns(scenes[1], border, width, 0, width);
    } else {
      drawColumns(scenes[0], 0, middle, 0, middle);
      drawColumns(scenes[1], middle, width, middle, width);
    }
  }

  function frame() {
    controls.update();
    window.requestAnimationFrame(frame);
  }
  controls.addEventListener("change", draw);
  for (const control of [slider, overlaid, colored]) control.addEventListener("input", draw);
  window.addEventListener("resize", () => { controls.handleResize(); draw(); });
  draw();
  frame();
}
