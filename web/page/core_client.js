// The core as the page calls it: each call returns a promise, and the page never waits. A call cannot be interrupted where it
// runs; stop() ends its worker, and with it what the core has kept of the body.
export class CoreClient {
  // `script` is the text of the worker, `module` the compiled core.
  constructor(script, module) {
    this.url = URL.createObjectURL(new Blob([script], {type: "text/javascript"}));
    this.module = module;
    this.number = 0;
    this.waiting = new Map();
    this.onfraction = () => {};
    this.images = [];  // {name, bytes}, given to every worker before its calls
    this.worker = this.started();
  }

  started() {
    const worker = new Worker(this.url);
    worker.postMessage({module: this.module});
    if (this.images.length > 0) worker.postMessage({call: "giveImages", args: [this.images]});
    worker.onmessage = ({data}) => {
      if (worker === this.worker) this.take(data);  // one that was ended may have sent more
    };
    worker.onerror = event => {
      if (worker === this.worker) this.fail(new Error(event.message || "the core stopped"));
    };
    return worker;
  }

  take(data) {
    if (data.fraction !== undefined) return this.onfraction(data.fraction);
    if (!this.waiting.has(data.id)) return;  // images are given again without a call
    const {resolve, reject} = this.waiting.get(data.id);
    this.waiting.delete(data.id);
    if (!data.error) return resolve(data.result);
    const error = Object.assign(new Error(data.error.message), {status: data.error.status});
    reject(error);
    if (error.status === undefined) this.fail(error);  // a trap: the module is not to be used again
  }

  // Gives images to this worker, and to those that follow it, in the place of those that were given before.
  async give(images) {
    if (images.length + this.images.length === 0) return;
    this.images = images;
    await this.lasting("giveImages", images);
  }

  call(call, ...args) {
    const id = ++this.number;
    return new Promise((resolve, reject) => {
      this.worker = this.worker || this.started();
      this.waiting.set(id, {resolve, reject});
      this.worker.postMessage({id, call, args});
    });
  }

  // A call that goes on, anew, when what runs is ended for something else, but not when the user stops it.
  async lasting(...call) {
    for (;;) {
      try {
        return await this.call(...call);
      } catch (error) {
        if (error.stopped !== "replaced") throw error;
      }
    }
  }

  fail(error) {
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    this.worker.terminate();
    this.worker = null;  // the next call starts another: one that cannot start would else be replaced for ever
    waiting.forEach(({reject}) => reject(error));
  }

  // Ends what is going on; its promises are rejected with the reason in `stopped`: "replaced", or "user".
  stop(reason) {
    if (this.waiting.size === 0) return;
    this.fail(Object.assign(new Error("stopped"), {stopped: reason}));
    this.worker = this.started();
  }
}
