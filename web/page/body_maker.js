// Meshes of the recipe that is open, progressively finer. Two cores make them: `main` the coarse ones, and it is never ended for
// a change, so that it keeps what reliefs and morphs took seconds for; `fine` the finer ones, which a change ends at once. A
// coarse mesh that a change overtakes is still shown, so that something always follows the hand.
export const LADDER = [32, 64, 128, 256, 384, 512];
const COARSE_MS = 150;      // main makes the second level, too, where the first took no longer
const QUIET_MS = 180;       // after a change before finer levels begin: while a knob is turned, coarse ones alone are made
const LONGEST_MS = 45000;   // a level that would take longer is left out, unless it is asked for
const GROWTH = 2.3;         // the time of a mesh grows with its cells to this power

export class BodyMaker {
  // hooks: onmesh(mesh, cells, isFirst), onrefusal(error), onworking(isWorking).
  constructor(cores, hooks) {
    Object.assign(this, {cores, hooks, next: null, running: null, expected: COARSE_MS, wake: () => {}});
  }

  // `wanted` is {recipe (bytes), name, cells, values}; with `opens` the finer core begins at once, with `mesh` the first level is
  // that mesh, with `patient` no level is left out.
  want(wanted) {
    this.next = wanted;
    this.wake();
    this.cores.fine.stop("replaced");
    if (!this.running) {
      this.running = this.run().finally(() => {
        this.running = null;
        this.hooks.onworking(false);
      });
    }
    return this.running;
  }
  async settled() {
    while (this.running) await this.running;
  }
  // Ends the meshes of what is open.
  async stop(reason) {
    this.next = null;
    this.wake();
    this.cores.fine.stop(reason);
    if (reason === "user" && this.running) this.cores.main.stop(reason);
    await this.settled();
  }

  async run() {
    this.hooks.onworking(true);
    while (this.next) {
      const wanted = this.next;
      this.next = null;
      await this.climb(wanted).catch(error => this.next || error.stopped || this.hooks.onrefusal(error));
    }
  }

  // Until nothing has been wanted for a while, or something is.
  quiet() {
    return new Promise(done => {
      const over = setTimeout(done, QUIET_MS);
      this.wake = () => { clearTimeout(over); done(); };
    });
  }

  async made({recipe, name, values}, core, cells) {
    const start = performance.now(), mesh = await core.call("make", recipe, name, cells, values);
    mesh.milliseconds = performance.now() - start;
    return mesh;
  }

  async climb(wanted) {
    const {main, fine} = this.cores, levels = [...LADDER.filter(cells => cells < wanted.cells), wanted.cells];
    const early = wanted.opens && levels.length > 2 ? this.made(wanted, fine, levels[2]) : null;
    if (early) early.catch(() => {});  // the level that waits for it tells
    for (const [number, cells] of levels.entries()) {
      const isCoarse = number === 0 || (number === 1 && (early || this.expected <= COARSE_MS));
      const mesh = number === 0 && wanted.mesh || await (number === 2 && early || this.made(wanted, isCoarse ? main : fine, cells));
      if (this.next && number > 0) return;
      this.hooks.onmesh(mesh, cells, number === 0);
      if (number === 0) this.expected = mesh.milliseconds || COARSE_MS;
      if (number === 0 && !wanted.opens) await this.quiet();
      const growth = Math.pow((levels[number + 1] || 0) / cells, number > 0 ? GROWTH : 1);
      if (number === 1 && early) continue;  // it has begun
      if (this.next || (!wanted.patient && growth * mesh.milliseconds > LONGEST_MS)) return;
    }
  }
}
