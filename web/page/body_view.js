// A body in the sun, which the mouse, a finger or the arrow keys turn.
class BodyView {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true});
    this.renderer.setClearColor(0x0d0f13);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(1.4, -2.9, 1.1);
    this.material = new THREE.MeshStandardMaterial({color: 0xb9b2a8, roughness: 1, metalness: 0});
    this.painted = new THREE.MeshStandardMaterial({vertexColors: THREE.VertexColors, roughness: 1, metalness: 0});
    this.body = new THREE.Mesh(new THREE.BufferGeometry(), this.material);
    this.sun = new THREE.DirectionalLight(0xffffff, 1.15);
    this.scene.add(this.body, this.sun, new THREE.AmbientLight(0xffffff, 0.12));
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false;
    this.controls.enablePan = false;
    this.controls.minDistance = 1.2;
    this.controls.maxDistance = 12;
    this.controls.addEventListener("change", () => this.draw());
    canvas.addEventListener("keydown", event => this.key(event));
    new ResizeObserver(() => this.draw()).observe(canvas);
    this.setSun(-50, 25);
  }

  // Azimuth and height of the sun in degrees, in the body's frame.
  setSun(azimuth, height) {
    const [a, h] = [azimuth, height].map(degrees => degrees * Math.PI / 180);
    this.sun.position.set(10 * Math.cos(h) * Math.cos(a), 10 * Math.cos(h) * Math.sin(a), 10 * Math.sin(h));
    this.draw();
  }

  // Shows a mesh of the core. The first one after refit() is put into the picture; later ones keep its scale.
  show(mesh) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(mesh.positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(mesh.normals, 3));
    if (mesh.colors) geometry.setAttribute("color", new THREE.BufferAttribute(mesh.colors, 3, true));
    geometry.setIndex(new THREE.BufferAttribute(mesh.triangles, 1));
    this.body.geometry.dispose();
    this.body.geometry = geometry;
    this.body.material = mesh.colors ? this.painted : this.material;
    if (!this.fitted) this.fit(geometry);
    this.draw();
  }
  refit() { this.fitted = false; }
  fit(geometry) {
    geometry.computeBoundingSphere();
    const {center, radius} = geometry.boundingSphere;
    this.body.scale.setScalar(0.8 / radius);
    this.body.position.copy(center).multiplyScalar(-0.8 / radius);
    this.fitted = true;
  }

  key(event) {
    const turn = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key];
    const zoom = {"+": 0.9, "=": 0.9, "-": 1 / 0.9}[event.key];
    if (!turn && !zoom) return;
    event.preventDefault();
    // The camera looks at 0, about which its place turns.
    const {x, y, z} = this.camera.position;
    const place = new THREE.Spherical().setFromVector3(new THREE.Vector3(x, z, -y));
    if (turn) {
      place.theta += 0.1 * turn[0];
      place.phi = Math.min(Math.max(place.phi + 0.1 * turn[1], 0.05), Math.PI - 0.05);
    } else {
      place.radius = Math.min(Math.max(place.radius * zoom, this.controls.minDistance), this.controls.maxDistance);
    }
    const to = new THREE.Vector3().setFromSpherical(place);
    this.camera.position.set(to.x, -to.z, to.y);
    this.controls.update();
    this.draw();
  }

  draw() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.fov = width < height ? 30 * Math.min(height / width, 2) : 30;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
  }

  picture() {
    this.draw();
    return new Promise(done => this.canvas.toBlob(done, "image/png"));
  }
}
