// Browsers start no worker for a page that is opened as a file. There a hidden frame runs the script of the search instead.
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      document.body.appendChild(frame);
      this.inner = frame.contentWindow;
      // The worker's messages come to this page; its scripts are loaded one after another.
      this.inner.postToPage = (data) => this.dispatchEvent(new MessageEvent("message", {data}));
      this.inner.document.open();
      this.inner.document.write(`<script>
        window.postMessage = (data) => window.postToPage(data);
        window.importScripts = (...urls) => urls.reduce((before, url) => before.then(() => new Promise((done) => {
          const script = document.createElement("script");
          script.src = url;
          script.onload = done;
          document.body.appendChild(script);
        })), Promise.resolve());
      <\/script><body><script src="${new URL(url, location.href)}"><\/script></body>`);
      this.inner.document.close();
    }

    postMessage(data) {
      const send = () => this.inner.dispatchEvent(new MessageEvent("message", {data}));
      this.inner.document.readyState === "complete" ? send() : this.inner.addEventListener("load", send, {once: true});
    }

    terminate() {
      this.inner.frameElement.remove();
    }
  };
}
