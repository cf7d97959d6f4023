// The bodies as the page shows them: the view, what is drawn over it, and the controls of the picture.
import {at, shortNumber} from "./dom.js";
import {BodyView} from "../../estimation/page/body_view.js";
import {PlainView} from "./plain_view.js";
import {orbit} from "../../estimation/page/orbit.js";
import {marks} from "./marks.js";
import {colorScale} from "./color_scale.js";

const DARK = [0.0392, 0.0431, 0.0549], PAPER = [1, 1, 1];  // behind the body, as the style has it
const VALUE_WORDS = {slope: "slope (degrees)", height: "height (m)", albedo: "normal albedo", label: "layers"};

function newView(canvas) {
  try {
    return new BodyView(canvas);
  } catch (error) {
    at("figures").dataset.plain = "yes";
    return new PlainView(canvas);
  }
}

// How long the body is, where its unit is known.
function sizeWords({figures: {extent, length_unit: unit}}) {
  return unit ? `, ${shortNumber(Math.max(...extent))} ${unit}` : "";
}

export class Stage {
  constructor() {
    this.view = newView(at("view"));
    this.scale = null;      // of the colours of the first body
    this.unit = "m";
    this.names = ["", ""];  // what the two bodies are called where both are shown
    this.paper = false;
    this.thing = true;
    this.view.background = DARK;
    this.view.ondraw = () => this.drawMarks();
    orbit(this.view, at("view"), () => this.tellSun());
    this.tellSun();
    at("fill").value = this.view.fill;
    at("azimuth").oninput = at("elevation").oninput = () => {
      Object.assign(this.view.sun, {longitude: Number(at("azimuth").value), latitude: Number(at("elevation").value)});
      this.view.request();
    };
    at("fill").oninput = () => { this.view.fill = Number(at("fill").value); this.view.request(); };
    this.toggle("paper", on => this.setPaper(on));
    this.toggle("thing", on => { this.thing = on; this.view.request(); });
    this.toggle("turn", on => on && this.turnOn());
    document.addEventListener("click", event => { if (!at("light").contains(event.target)) at("light").open = false; });
  }

  toggle(id, act) {
    at(id).onclick = () => {
      const on = at(id).getAttribute("aria-pressed") !== "true";
      at(id).setAttribute("aria-pressed", on);
      act(on);
    };
  }
  tellSun() {
    at("azimuth").value = this.view.sun.longitude;
    at("elevation").value = this.view.sun.latitude;
  }
  setPaper(on) {
    this.paper = on;
    at("stage").classList.toggle("paper", on);
    this.view.background = on ? PAPER : DARK;
    this.view.request();
  }

  // The body turns about z under a sun that stands still: camera and sun go around it together.
  turnBy(degrees) {
    this.view.camera.longitude -= degrees;
    this.view.sun.longitude = (this.view.sun.longitude - degrees + 540) % 360 - 180;
  }
  turnOn() {
    let before = performance.now();
    const step = now => {
      if (at("turn").getAttribute("aria-pressed") !== "true") return this.tellSun();
      this.turnBy((now - before) * 0.024);
      before = now;
      this.view.request();
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  // The mesh with what its values show as colours, and the scale of these.
  coloured(mesh, what) {
    if (!mesh.values) return {mesh, scale: null};
    if (what === "label") {
      return {mesh: {...mesh, shown: mesh.values, labelled: true}, scale: {legend: mesh.legend}};
    }
    const {shown, low, high} = colorScale.shares(mesh.values);
    return {mesh: {...mesh, shown}, scale: {words: VALUE_WORDS[what], low, high}};
  }

  // Shows the mesh of a recipe; a first one is put into the picture, a finer one keeps its place.
  show(made, isFirst, what) {
    const {mesh, scale} = this.coloured(made, what);
    this.mesh = mesh;
    this.scale = scale;
    this.unit = made.figures.length_unit;
    this.view.setScale(what === "label" ? colorScale.labelled : colorScale.even);
    this.view.setBody(0, mesh, isFirst ? undefined : this.view.placeOf(0) || undefined);
  }

  clear() {
    this.mesh = this.scale = null;
    this.view.removeBody(0);
  }

  // The second body, beside the first.
  showBeside(mesh, name) {
    this.names[1] = `${name}${sizeWords(mesh)}`;
    this.view.setBody(1, mesh);
  }
  hideBeside() {
    this.view.removeBody(1);
  }

  look(width, height) {
    const parts = this.view.parts(width, height), [first] = parts, place = first && this.view.placeOf(first[0]);
    const isAlone = parts.length === 1;  // each of two bodies fills its half: they have no common scale
    return {
      pixelsPerLength: isAlone && place ? this.view.pixelsPerRadius(first[1][2], first[1][3]) * place[3] : 0,
      unit: this.unit, paper: this.paper, showThing: this.thing, scale: this.scale,
      captions: parts.length < 2 ? [] : parts.map(([body, [x, y, w, h]]) => ({x: x + w / 2, y: height - y - 0.05 * h, words: body === 0 && this.mesh ? `${this.names[0]}${sizeWords(this.mesh)}` : this.names[body]})),
    };
  }
  drawMarks() {
    const canvas = at("marks"), {clientWidth: width, clientHeight: height} = canvas, ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [width, height].map(side => Math.round(side * ratio));
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, {width: w, height: h});
    const context = canvas.getContext("2d");
    context.clearRect(0, 0, w, h);
    if (this.view.shown().length > 0) marks.draw(context, w, h, ratio, this.look(w, h));
  }

  // A second view that draws the same into pictures of any size, so that the one on the page keeps its own.
  studio() {
    const studio = this.studioView = this.studioView || newView(document.createElement("canvas")), {view} = this;
    Object.assign(studio, {camera: view.camera, sun: view.sun, background: view.background, fill: view.fill});
    if (view.scaleColors) studio.setScale(view.scaleColors);
    view.bodies.forEach((body, at) => {
      if (!body) return studio.removeBody(at);
      if (!studio.bodies[at] || studio.bodies[at].mesh !== body.mesh) studio.setBody(at, body.mesh, view.placeOf(at));
    });
    return studio;
  }

  // A small picture of another mesh under the same light.
  thumbnail(mesh, canvas) {
    const small = this.smallView = this.smallView || newView(document.createElement("canvas")), {view} = this;
    Object.assign(small, {camera: {...view.camera, distance: 4.2}, sun: view.sun, background: DARK, fill: view.fill});
    small.setBody(0, mesh);
    small.paintInto(canvas.getContext("2d"), canvas.width, canvas.height);
  }

  // The picture with its marks on a canvas of this size.
  picture(width, height, canvas = document.createElement("canvas")) {
    Object.assign(canvas, {width, height});
    const context = canvas.getContext("2d");
    this.studio().paintInto(context, width, height);
    marks.draw(context, width, height, height / 900, this.look(width, height));
    return canvas;
  }
}
