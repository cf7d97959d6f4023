// Draws a body without WebGL: triangles with their depths into an image, in light without shadows. It has the members of BodyView.
import {matrices, vectors} from "../../estimation/page/matrices.js";
import {meshPlace} from "../../estimation/page/mesh_place.js";
import {BodyView} from "../../estimation/page/body_view.js";

const MOST_PIXELS = 260000;

export class PlainView {
  constructor(canvas) {
    Object.assign(this, {
      canvas, camera: {longitude: -62, latitude: 20, distance: 4.6}, sun: {longitude: -118, latitude: 24},
      background: [0, 0, 0], fill: 0.035, bodies: [null, null], overlaid: null, ondraw: () => {}, scaleColors: null,
    });
    new ResizeObserver(() => this.request()).observe(canvas);
  }
  setScale(colors) { this.scaleColors = colors; }
  setBody(at, mesh, place) {
    this.bodies[at] = {mesh, place: place || mesh.place || meshPlace(mesh.positions)};
    this.request();
  }
  removeBody(at) {
    this.bodies[at] = null;
    this.request();
  }
  placeOf(at) { return this.bodies[at] && this.bodies[at].place; }

  // The light of each corner of a body, red, green and blue.
  cornerColors({mesh, place}, sun, eye) {
    const count = mesh.normals.length / 3, made = new Float32Array(3 * count), albedo = [0.44, 0.425, 0.40];
    for (let i = 0; i < count; ++i) {
      const n = mesh.normals.subarray(3 * i, 3 * i + 3), mu = Math.max(vectors.dot(n, sun), 0);
      const at = [0, 1, 2].map(k => (mesh.positions[3 * i + k] - place[k]) * place[3]);
      const viewward = Math.max(vectors.dot(n, vectors.unit(eye.map((x, k) => x - at[k]))), 0.02);
      const light = mesh.shown ? 0 : mu * (0.65 + 0.7 / (mu + viewward)) * 1.45 + this.fill * (0.35 + 0.65 * viewward);
      const value = mesh.shown && (mesh.labelled ? mesh.shown[i] : Math.round(255 * Math.min(Math.max(mesh.shown[i], 0), 1)));
      for (let k = 0; k < 3; ++k) {
        const ground = mesh.colors ? Math.pow(mesh.colors[3 * i + k] / 255, 2.2) : albedo[k];
        made[3 * i + k] = mesh.shown ? this.scaleColors[4 * value + k] : 255 * Math.pow(Math.min(ground * light, 1), 1 / 2.2);
      }
    }
    return made;
  }

  drawBody(body, image, depths, [px, py, width, height], imageHeight) {
    const eye = this.eye(), colors = this.cornerColors(body, this.sunDirection(), eye), {positions, triangles} = body.mesh, {place} = body;
    const clip = matrices.multiply(matrices.perspective(this.fov(width, height), width / height, 0.05, 20), matrices.lookAtOrigin(eye, [0, 0, 1]));
    const count = positions.length / 3, seen = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) {
      const [x, y, z] = [0, 1, 2].map(k => (positions[3 * i + k] - place[k]) * place[3]);
      const w = clip[3] * x + clip[7] * y + clip[11] * z + clip[15];
      seen[3 * i] = px + (0.5 + 0.5 * (clip[0] * x + clip[4] * y + clip[8] * z + clip[12]) / w) * width;
      seen[3 * i + 1] = imageHeight - py - (0.5 + 0.5 * (clip[1] * x + clip[5] * y + clip[9] * z + clip[13]) / w) * height;
      seen[3 * i + 2] = w;
    }
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
      const [ax, ay, bx, by, cx, cy] = [seen[a], seen[a + 1], seen[b], seen[b + 1], seen[c], seen[c + 1]];
      const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
      if (area >= 0) continue;  // seen from behind: y points down
      const left = Math.max(px, Math.floor(Math.min(ax, bx, cx))), right = Math.min(px + width - 1, Math.ceil(Math.max(ax, bx, cx)));
      const top = Math.max(0, Math.floor(Math.min(ay, by, cy))), bottom = Math.min(imageHeight - 1, Math.ceil(Math.max(ay, by, cy)));
      for (let y = top; y <= bottom; ++y) {
        for (let x = left; x <= right; ++x) {
          const u = ((bx - x) * (cy - y) - (cx - x) * (by - y)) / area, v = ((cx - x) * (ay - y) - (ax - x) * (cy - y)) / area, w = 1 - u - v;
          if (u < 0 || v < 0 || w < 0) continue;
          const at = y * image.width + x, depth = u * seen[a + 2] + v * seen[b + 2] + w * seen[c + 2];
          if (depth >= depths[at]) continue;
          depths[at] = depth;
          for (let k = 0; k < 3; ++k) image.data[4 * at + k] = u * colors[a + k] + v * colors[b + k] + w * colors[c + k];
        }
      }
    }
  }

  paintInto(context, width, height) {
    const image = context.createImageData(width, height), depths = new Float32Array(width * height).fill(Infinity);
    const [r, g, b] = this.background.map(c => Math.round(255 * c));
    for (let i = 0; i < image.data.length; i += 4) image.data.set([r, g, b, 255], i);
    this.parts(width, height).forEach(([at, part]) => this.drawBody(this.bodies[at], image, depths, part, height));
    context.putImageData(image, 0, 0);
  }
  draw() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (width === 0 || height === 0) return;
    const ratio = Math.min(1, Math.sqrt(MOST_PIXELS / (width * height)));
    Object.assign(this.canvas, {width: Math.round(width * ratio), height: Math.round(height * ratio)});
    this.paintInto(this.canvas.getContext("2d"), this.canvas.width, this.canvas.height);
    this.ondraw();
  }
}
// What both views do alike.
for (const name of ["request", "shown", "sunDirection", "eye", "fov", "pixelsPerRadius", "parts"]) {
  PlainView.prototype[name] = BodyView.prototype[name];
}
