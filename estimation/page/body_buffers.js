import {meshPlace} from "./mesh_place.js";

// A mesh on the graphics card. A mesh has positions, normals, triangles, and may have colors (sRGB bytes; with `plain`
// they stand for values), and shown, a number at each vertex that stands for a colour. `place` is the middle of its box
// and the factor that makes its radius 1.
export class BodyBuffers {
  constructor(gl, attributes, mesh, place) {
    this.gl = gl;
    this.place = place || mesh.place || meshPlace(mesh.positions);
    this.array = gl.createVertexArray();
    this.buffers = [];
    this.count = mesh.triangles.length;
    this.painted = Boolean(mesh.colors);
    this.valued = Boolean(mesh.shown);
    this.plain = Boolean(mesh.plain);
    this.labelled = Boolean(mesh.labelled);
    gl.bindVertexArray(this.array);
    this.put(attributes.position, mesh.positions, 3, gl.FLOAT);
    this.put(attributes.normal, mesh.normals, 3, gl.FLOAT);
    if (mesh.colors) this.put(attributes.color, mesh.colors, 3, gl.UNSIGNED_BYTE);
    if (mesh.shown) this.put(attributes.value, mesh.shown, 1, gl.FLOAT);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.made());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
  }

  made() {
    const buffer = this.gl.createBuffer();
    this.buffers.push(buffer);
    return buffer;
  }
  put(attribute, numbers, width, type) {
    const {gl} = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.made());
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.STATIC_DRAW);
    gl.enableVertexAttribArray(attribute);
    gl.vertexAttribPointer(attribute, width, type, type === gl.UNSIGNED_BYTE, 0, 0);
  }

  draw() {
    this.gl.bindVertexArray(this.array);
    this.gl.drawElements(this.gl.TRIANGLES, this.count, this.gl.UNSIGNED_INT, 0);
  }
  remove() {
    this.buffers.forEach(buffer => this.gl.deleteBuffer(buffer));
    this.gl.deleteVertexArray(this.array);
  }
}
