// A film of the body that turns once under the sun, recorded by the browser as WebM: a promise of the blob. `signal` is that
// of an AbortController which ends it.
export function recordTurn(stage, {signal, width = 1280, height = 720, seconds = 8} = {}) {
  if (typeof MediaRecorder === "undefined") return Promise.reject(new Error("this browser records no films; take the picture"));
  const canvas = document.createElement("canvas");
  stage.picture(width, height, canvas);
  const type = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"].find(kind => MediaRecorder.isTypeSupported(kind));
  const recorder = new MediaRecorder(canvas.captureStream(30), {mimeType: type, videoBitsPerSecond: 8e6}), parts = [];
  recorder.ondataavailable = event => parts.push(event.data);
  return new Promise((resolve, reject) => {
    let isOver = false;
    const end = error => {  // a promise that was rejected stays so
      isOver = true;
      reject(error);
      if (recorder.state !== "inactive") recorder.stop();
    };
    recorder.onstop = () => {
      isOver = true;
      resolve(new Blob(parts, {type: (type || "video/webm").replace(/;.*/, "")}));
    };
    recorder.onerror = event => end(event.error || new Error("the film could not be recorded"));
    signal.onabort = () => end(Object.assign(new Error("stopped"), {stopped: "user"}));
    recorder.start();
    const begin = performance.now();
    let turned = 0;
    const step = now => {
      if (isOver) return;
      const share = Math.min((now - begin) / (1000 * seconds), 1), degrees = 360 * share;
      stage.turnBy(degrees - turned);
      turned = degrees;
      try {
        stage.picture(width, height, canvas);
      } catch (error) {
        return end(error);
      }
      if (share < 1) return requestAnimationFrame(step);
      recorder.stop();
    };
    requestAnimationFrame(step);
  });
}
