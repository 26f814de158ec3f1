// The search. What is typed before its index is there finds nothing, but must be answered: the theme waits for each
// answer and keeps only the last message meanwhile, so that the one with the index would be lost. It sends the last
// query again once the index is there.
//
// A page that is opened from a disk may neither fetch the index nor start a worker. There the index comes as a script
// (written by pages.py), and the worker's script runs in a hidden frame. It starts when the reader goes to the search,
// since the browser needs a moment to prepare the index.
const [READY, QUERY, RESULT] = [1, 2, 3];  // kinds of messages
const nothing = {type: RESULT, data: {items: []}};

if (location.protocol !== "file:")
  window.Worker = class extends Worker {
    constructor(url) {
      super(url);
      this.addEventListener("message", ({data}) => this.ready ||= data.type === READY);
    }

    postMessage(data) {
      if (this.ready || data.type !== QUERY) super.postMessage(data);
      else queueMicrotask(() => this.dispatchEvent(new MessageEvent("message", {data: nothing})));
    }
  };

if (location.protocol === "file:") {
  const index = new URL("search/search_index.js", document.currentScript.src);
  document.write(`<script src="${index}"><\/script>`);

  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      this.url = url;
      this.waiting = [];
      const isField = element => element !== null && element.name === "query";
      document.addEventListener("focusin", event => isField(event.target) && this.start());
      document.addEventListener("change", event => event.target.dataset.mdToggle === "search" && this.start());
      if (isField(document.activeElement) || location.search) this.start();
    }

    start() {
      if (this.frame) return;
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.body.append(this.frame);
      const inside = this.frame.contentWindow;
      inside.postMessage = data => this.answer(data);
      const script = inside.document.createElement("script");
      script.src = this.url;
      script.onload = () => {
        const waiting = this.waiting;
        this.waiting = null;
        waiting.forEach(data => this.postMessage(data));
      };
      inside.document.body.append(script);
    }

    postMessage(data) {
      if (this.waiting && data.type === QUERY) queueMicrotask(() => this.answer(nothing));
      else if (this.waiting) this.waiting.push(data);
      else this.frame.contentWindow.dispatchEvent(new MessageEvent("message", {data}));
    }

    answer(data) { this.dispatchEvent(new MessageEvent("message", {data})); }

    terminate() {
      if (this.frame) this.frame.remove();
    }
  };
}
