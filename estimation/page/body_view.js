// Draws one or two bodies in the sun, with the shadows that they cast on themselves (WebGL 2). The camera goes around a body
// at `longitude` and `latitude`, `distance` radii away; the sun has a longitude and a latitude, too. All angles are in degrees.
import {matrices, vectors} from "./matrices.js";
import {bodyShaders} from "./body_shaders.js";
import {BodyBuffers} from "./body_buffers.js";

export class BodyView {
  constructor(canvas) {
    this.canvas = canvas;
    this.camera = {longitude: -62, latitude: 20, distance: 4.6};
    this.sun = {longitude: -118, latitude: 24};
    this.background = [0.027, 0.031, 0.040];
    this.fill = 0.035;
    this.bodies = [null, null];   // what is drawn, each {mesh, buffers}
    this.isOpen = false;          // whether surfaces show both sides
    this.overlaid = null;         // the share of the width that the first body has where both lie over each other
    this.ondraw = () => {};
    this.start();
    canvas.addEventListener("webglcontextlost", event => { event.preventDefault(); this.lost = true; });
    canvas.addEventListener("webglcontextrestored", () => this.restore());
    new ResizeObserver(() => this.request()).observe(canvas);
  }

  start() {
    const gl = this.canvas.getContext("webgl2", {antialias: true, alpha: false, powerPreference: "high-performance"});
    if (!gl) throw new Error("this browser has no WebGL 2");
    this.gl = gl;
    this.lost = false;
    this.parallel = gl.getExtension("KHR_parallel_shader_compile");
    this.depth = this.program(bodyShaders.depthVertex, bodyShaders.depthFragment);
    this.paint = this.program(bodyShaders.vertex, bodyShaders.fragment);
    this.ready = false;
    this.drawn = null;
    this.maps = [this.depthMap(), null];
    this.scaleTexture = gl.createTexture();
    this.setScale(new Uint8Array(4 * 256).fill(128));
  }
  restore() {
    this.start();
    this.bodies.forEach((body, at) => body && this.setBody(at, body.mesh, body.buffers.place));
    if (this.scaleColors) this.setScale(this.scaleColors);
  }

  program(vertex, fragment) {
    const {gl} = this, program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    ["position", "normal", "color", "value"].forEach((name, at) => gl.bindAttribLocation(program, at, name));
    gl.linkProgram(program);
    const places = new Map();
    const at = name => {
      if (!places.has(name)) places.set(name, gl.getUniformLocation(program, name));
      return places.get(name);
    };
    return {program, at};
  }

  // Whether the programs are made: to ask for more before would stop the page until they are.
  isReady() {
    const {gl, parallel} = this;
    const made = ({program}) => !parallel || gl.getProgramParameter(program, parallel.COMPLETION_STATUS_KHR);
    return this.ready = this.ready || made(this.depth) && made(this.paint);
  }

  // Whether the last picture is still being drawn: a queue of pictures would stop the page when it is full.
  isBusy() {
    const {gl, drawn} = this;
    if (!drawn || gl.getSyncParameter(drawn, gl.SYNC_STATUS) !== gl.SIGNALED) return Boolean(drawn);
    gl.deleteSync(drawn);
    this.drawn = null;
    return false;
  }

  // Depths as the sun sees them.
  depthMap() {
    const {gl} = this, side = 2048, texture = gl.createTexture(), frame = gl.createFramebuffer();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, side, side);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return {side, texture, frame, of: ""};
  }

  // The colours of values: 256 of them, or 16 for labels, as RGBA bytes.
  setScale(colors) {
    const {gl} = this;
    this.scaleColors = colors;
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.scaleTexture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, colors.length / 4, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, colors);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.activeTexture(gl.TEXTURE0);
  }

  // Puts a mesh in place `at`, 0 or 1. It fills the picture, or keeps a scale: `place` is [x, y, z, factor].
  setBody(at, mesh, place) {
    this.removeBody(at);
    this.bodies[at] = {mesh, buffers: new BodyBuffers(this.gl, {position: 0, normal: 1, color: 2, value: 3}, mesh, place)};
    if (this.maps[at]) this.maps[at].of = "";
    this.request();
  }
  removeBody(at) {
    if (this.bodies[at]) this.bodies[at].buffers.remove();
    this.bodies[at] = null;
    this.request();
  }
  placeOf(at) { return this.bodies[at] && this.bodies[at].buffers.place; }

  request() {
    if (this.requested) return;
    this.requested = requestAnimationFrame(() => {
      this.requested = 0;
      this.draw();
    });
  }

  shown() { return this.bodies.map((body, at) => body && at).filter(at => at !== null); }
  sunDirection() { return vectors.direction(this.sun.longitude, this.sun.latitude); }
  eye() { return vectors.direction(this.camera.longitude, this.camera.latitude).map(x => x * this.camera.distance); }
  fov(width, height) { return Math.PI / 180 * (width < height ? 30 * Math.min(height / width, 2) : 30); }
  // How many pixels of a picture of this height the radius 1 takes at the body's middle.
  pixelsPerRadius(width, height) { return height / (2 * Math.tan(this.fov(width, height) / 2) * this.camera.distance); }

  sunClip() {
    const sun = this.sunDirection(), up = Math.abs(sun[2]) > 0.9 ? [1, 0, 0] : [0, 0, 1];
    return matrices.multiply(matrices.parallel(1.03, 0.5, 3.5), matrices.lookAtOrigin(sun.map(x => 2 * x), up));
  }

  drawDepths(at, sunClip) {
    const {gl} = this, map = this.maps[at] = this.maps[at] || this.depthMap(), of = sunClip.join();
    if (map.of === of) return map;
    map.of = of;
    gl.bindFramebuffer(gl.FRAMEBUFFER, map.frame);
    gl.viewport(0, 0, map.side, map.side);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.depth.program);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 3);
    gl.uniformMatrix4fv(this.depth.at("sunClip"), false, sunClip);
    gl.uniform4fv(this.depth.at("place"), this.bodies[at].buffers.place);
    this.bodies[at].buffers.draw();
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return map;
  }

  drawBody(at, [x, y, width, height], sunClip) {
    const {gl, paint} = this, {buffers} = this.bodies[at], map = this.drawDepths(at, sunClip), eye = this.eye();
    gl.viewport(x, y, width, height);
    gl.useProgram(paint.program);
    const near = Math.max(this.camera.distance - 1.1, 0.02), far = this.camera.distance + 1.1;
    const clip = matrices.multiply(matrices.perspective(this.fov(width, height), width / height, near, far), matrices.lookAtOrigin(eye, [0, 0, 1]));
    gl.uniformMatrix4fv(paint.at("clip"), false, clip);
    gl.uniformMatrix4fv(paint.at("sunClip"), false, sunClip);
    gl.uniform4fv(paint.at("place"), buffers.place);
    gl.uniform3fv(paint.at("sun"), this.sunDirection());
    gl.uniform3fv(paint.at("eye"), eye);
    gl.uniform1f(paint.at("fill"), this.fill);
    gl.uniform1f(paint.at("texel"), 1 / map.side);
    gl.uniform1i(paint.at("painted"), buffers.painted);
    gl.uniform1i(paint.at("valued"), buffers.valued);
    gl.uniform1i(paint.at("labelled"), buffers.labelled);
    gl.uniform1i(paint.at("plain"), buffers.plain);
    gl.bindTexture(gl.TEXTURE_2D, map.texture);
    gl.uniform1i(paint.at("depths"), 0);
    gl.uniform1i(paint.at("scale"), 1);
    buffers.draw();
  }

  // The parts of a picture, one for each body: [x, y, width, height], or all of it where both lie over each other.
  parts(width, height) {
    const shown = this.shown();
    if (shown.length < 2 || this.overlaid !== null) return shown.map(at => [at, [0, 0, width, height]]);
    if (width < height) return shown.map((at, i) => [at, [0, Math.round((1 - i) * height / 2), width, Math.round(height / 2)]]);
    return shown.map((at, i) => [at, [Math.round(i * width / 2), 0, Math.round(width / 2), height]]);
  }

  drawPixels(width, height) {
    const {gl} = this;
    gl.enable(gl.DEPTH_TEST);
    gl[this.isOpen ? "disable" : "enable"](gl.CULL_FACE);
    const sunClip = this.sunClip();
    this.shown().forEach(at => this.drawDepths(at, sunClip));
    gl.viewport(0, 0, width, height);
    gl.clearColor(...this.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.parts(width, height).forEach(([at, part], i) => {
      if (this.overlaid !== null) {
        const border = Math.round(this.overlaid * width);
        gl.enable(gl.SCISSOR_TEST);
        gl.scissor(i === 0 ? 0 : border, 0, i === 0 ? border : width - border, height);
      }
      this.drawBody(at, part, sunClip);
      gl.disable(gl.SCISSOR_TEST);
    });
  }

  draw() {
    const {clientWidth: width, clientHeight: height} = this.canvas, ratio = Math.min(window.devicePixelRatio || 1, 2);
    if (width === 0 || height === 0 || this.lost) return;
    if (!this.isReady() || this.isBusy()) return this.request();
    const [w, h] = [width, height].map(side => Math.round(side * ratio));
    if (this.canvas.width !== w || this.canvas.height !== h) Object.assign(this.canvas, {width: w, height: h});
    this.drawPixels(w, h);
    this.drawn = this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    this.gl.flush();
    this.ondraw();
  }

  // Draws a point of a body once, before there is any, so that the first one need not wait for what a graphics card prepares.
  warm(width, height) {
    if (this.lost || this.shown().length > 0) return;
    if (!this.isReady()) return void setTimeout(() => this.warm(width, height), 50);
    Object.assign(this.canvas, {width, height});
    this.setBody(0, {positions: new Float32Array(9), normals: new Float32Array(9), triangles: Uint32Array.of(0, 1, 2)}, [0, 0, 0, 1]);
    this.drawPixels(width, height);
    this.removeBody(0);
    this.gl.flush();
  }

  // The picture of a size in pixels, painted into a context of two dimensions.
  paintInto(context, width, height) {
    Object.assign(this.canvas, {width, height});
    this.drawPixels(width, height);
    context.drawImage(this.canvas, 0, 0);
  }
}
