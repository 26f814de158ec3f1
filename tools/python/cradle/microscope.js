// The microscope in a page: cradleMicroscope(element, data) builds it in a <div> from the data of microscope.py.
//
// It needs the other microscope_*.js before it. It returns a small handle for scripts and tests, which is also in
// `element.cradleMicroscope` and window.cradleMicroscopeTest; its `ready` is a promise of the first picture.

function cradleMicroscope(element, data) {
  const make = (tag, name, parent, text) => {
    const made = document.createElement(tag);
    made.className = name;
    if (text) made.textContent = text;
    parent.append(made);
    return made;
  };
  element.classList.add("microscope");
  element.replaceChildren();
  const bar = make("div", "microscope-bar", element), stage = make("div", "microscope-stage", element);
  const canvas = make("canvas", "microscope-canvas", stage), readout = make("div", "microscope-readout", element);
  make("div", "microscope-help", element, "drag: move · click, then wheel, or + −: zoom (shift: time only, alt: " +
       "space only; over an axis: that one) · 0: all · space: play" + (data.kind !== "collisions" ? "" :
         " · n, p: next, previous collision · d: deepest · c: colours"));
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", "world lines of the particles in space and time");
  readout.setAttribute("aria-live", "polite");
  const pen = canvas.getContext("2d"), state = { quantity: "speed", playing: false, pointer: null, moving: 0 };
  const stores = { raster: {}, strip: {} }, offscreen = document.createElement("canvas");
  let world = null, camera = null, box = null, strip = null, colours = null, due = 0, restful = 0, quality = 2;

  const say = text => { if (readout.textContent !== text) readout.textContent = text; };
  const button = (text, title, act) => {
    const made = make("button", "microscope-button", bar, text);
    made.type = "button";
    made.title = title;
    made.addEventListener("click", () => { act(); canvas.focus({ preventScroll: true }); });
    return made;
  };

  // Drawing

  const style = name => getComputedStyle(element).getPropertyValue(name).trim();
  const number = particle => world.index ? world.index[particle] : world.first + particle;
  function layout() {
    const ratio = window.devicePixelRatio || 1, width = stage.clientWidth, height = stage.clientHeight;
    canvas.width = Math.max(1, Math.round(width * ratio));
    canvas.height = Math.max(1, Math.round(height * ratio));
    const m = MICROSCOPE_MARGIN, below = world.n ? m.strip : 0;
    box = { left: m.left, top: m.top, width: Math.max(40, width - m.left - m.right),
            height: Math.max(40, height - m.top - m.bottom - below) };
    const under = box.top + box.height + m.bottom + 6;
    strip = world.n ? { left: m.left, top: under, width: box.width, height: below - 30 } : null;
    const names = ["paper", "plate", "line", "grid", "frame", "text", "accent", "ink"];
    colours = Object.fromEntries(names.map(name => [name, style("--microscope-" + name)]));
    stores.strip = {};
    cancelAnimationFrame(due);
    draw();  // at once: resizing a canvas clears it
  }
  function request() {
    if (!due) due = requestAnimationFrame(draw);
  }
  function changed() {  // by hand or in play: draw quickly now, and in full detail when the view is at rest
    state.moving = 1;
    clearTimeout(restful);
    restful = setTimeout(() => { state.moving = 0; request(); }, 160);
    request();
  }

  // The logarithms that colour collisions, and their visible range, which changes slowly: colours must not flicker.
  function colouring() {
    const value = state.quantity === "speed" ? world.logSpeed : world.lost, { chart, view } = camera, sample = [];
    if (chart) {
      let before = -Infinity;  // only one of the collisions within a pixel counts
      for (let i = 0, skip = Math.ceil(chart.collisions.length / 4000); i < chart.collisions.length; i += skip) {
        const tau = chart.tau[i], xi = chart.xi[i] - view.V * tau - view.xi;
        if (Math.abs(tau - view.tau) > view.T / 2 || Math.abs(xi) > view.X / 2) continue;
        if (chart.collisions.length < 4000 && tau - before < view.T / 400) continue;
        before = tau;
        sample.push(value[chart.collisions[i]]);
      }
    } else {
      const t = microscopeOrigin(world, view.anchor).t + view.tau;
      const [first, last] = [-0.5, 0.5].map(part => microscopeFirstAfter(world.time, t + part * view.T));
      for (let e = first, skip = Math.ceil((last - first) / 2000); e < last; e += skip) sample.push(value[e]);
    }
    const real = sample.filter(v => v > -350).sort((a, b) => a - b), shown = chart ? null : state.shown;
    if (!real.length) return { value, range: state.range || [-1, 0], empty: true };
    let [low, high] = shown || [real[Math.floor(0.02 * (real.length - 1))], real[Math.ceil(0.98 * (real.length - 1))]];
    if (high - low < 0.5) [low, high] = [(low + high) / 2 - 0.25, (low + high) / 2 + 0.25];
    const old = state.range, near = old && Math.abs(old[0] - low) + Math.abs(old[1] - high) < 3 && state.moving;
    state.range = near ? [old[0] + 0.2 * (low - old[0]), old[1] + 0.2 * (high - old[1])] : [low, high];
    return { value, range: state.range, empty: false };
  }

  function draw() {
    due = 0;
    if (!box || canvas.width < 2) return;
    const begun = performance.now(), ratio = canvas.width / stage.clientWidth, { view, chart } = camera;
    const { value, range, empty } = colouring(), e = view.anchor.e;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.font = "12px system-ui, sans-serif";
    pen.fillStyle = colours.paper;
    pen.fillRect(0, 0, canvas.width, canvas.height);
    const tilt = Math.abs(view.V + view.lab) * view.T / view.X;  // velocity of the frame in the lab, as a slope
    const name = e < 0 ? `particle ${number(view.anchor.a)}` : `collision ${e + 1}`;
    const origin = { ...microscopeOrigin(world, view.anchor), moving: tilt > 0.02 };
    const labels = microscopeAxes(pen, view, box, colours, origin, name);
    pen.save();
    pen.beginPath();
    pen.rect(box.left, box.top, box.width, box.height);
    pen.clip();
    if (chart) {
      microscopeLines(pen, chart, view, box, colours);
      microscopeDots(pen, chart, view, box, value, range);
      microscopeNames(pen, chart, view, box, colours, number);
    } else {
      const scale = state.moving ? ratio / quality : ratio;
      const width = Math.round(box.width * scale), height = Math.round(box.height * scale);
      const image = microscopeRaster(world, view, width, height, value, range, colours.ink.split(",").map(Number),
                                     state.moving ? 3e5 / quality : 3e6, stores.raster);
      const shown = microscopeShown(stores.raster), known = state.shown;
      state.shown = shown;
      if (shown && (!known || Math.abs(shown[0] - known[0]) + Math.abs(shown[1] - known[1]) > 0.3)) request();
      offscreen.width = image.width;
      offscreen.height = image.height;
      offscreen.getContext("2d").putImageData(image, 0, 0);
      pen.drawImage(offscreen, box.left, box.top, box.width, box.height);
    }
    pen.restore();
    labels();
    microscopeLegend(pen, view, box, colours, empty ? null : range,
                     state.quantity === "speed" ? "closing speed, l/t" : "energy lost, m l²/t²");
    if (strip) microscopeStrip(pen, world, view, strip, colours, stores.strip);
    state.drawn = performance.now() - begun;
    const coarser = state.drawn > 14 ? 1.1 : state.drawn < 7 ? 0.95 : 1;
    if (state.moving && !chart) quality = microscopeClamp(quality * coarser, 1, 4);
    describe();
  }

  // The readout: the collision or the gap under the pointer, else the position of the view.
  function describe() {
    const { view } = camera, e = view.anchor.e;
    const where = e < 0 ? `t = ${world.start}, beside particle ${number(view.anchor.a)}` :
      `at collision ${view.anchor.e + 1} of ${world.total}, particles ${pairName(view.anchor.e)}`;
    const n = value => microscopeNumber(value, Math.min(6, world.digits));
    const view_ = `${where}: ${microscopeNumber(view.T, 3)} t across, ${microscopeNumber(view.X, 3)} l high`;
    const place = state.pointer && placeOf(state.pointer.x, state.pointer.y);
    const cut = world.total > world.n && world.n ? `; the first ${world.n} collisions are here` : "";
    if (!place) return say(view_ + cut);
    const collision = collisionAt(state.pointer, 10);
    if (collision) {
      const k = collision.e, time = world.time[k];
      return say(`collision ${k + 1}, particles ${pairName(k)}: t = ${time}, closing speed ${n(world.speed[k])} l/t, ` +
                 `${n(world.interval[k])} t after the collision before, energy lost ${power(world.lost[k])} m l²/t²` +
                 (k + 1 < world.n ? `; next collision in ${n(world.interval[k + 1])} t` : ""));
    }
    const pair = microscopeGapAt(camera, place);
    if (!pair) return say(view_);
    const moves = pair.w > 0 ? `closing at ${n(pair.w)} l/t` : `opening at ${n(-pair.w)} l/t`;
    const then = pair.next >= 0 ? `collision ${pair.next + 1} (${pairName(pair.next)}) in ${n(pair.until)} t` :
      pair.until > 0 ? `they would meet in ${n(pair.until)} t` : "no further collision of theirs";
    say(`particles ${number(pair.below)} and ${number(pair.above)}: gap ${n(pair.gap)} l, ${moves}; ${then}`);
  }
  const power = log => log < -350 ? "0" : log > -307 ? microscopeNumber(10 ** log, 3) :
    `${(10 ** (log - Math.floor(log))).toFixed(2)}×${microscopePower(Math.floor(log))}`;
  const pairName = e => `${number(world.left[e])} and ${number(world.right[e])}`;

  // The position of a pointer: [tau, xi] in the view's frame.
  function placeOf(x, y) {
    const inside = x >= box.left && x <= box.left + box.width && y >= box.top && y <= box.top + box.height;
    return inside ? unbounded(x, y) : null;
  }
  function unbounded(x, y) {
    const { view } = camera;
    return [view.tau + view.T * ((x - box.left) / box.width - 0.5),
            view.xi - view.X * ((y - box.top) / box.height - 0.5)];
  }
  function collisionAt({ x, y }, within) {
    const { view, chart } = camera, place = placeOf(x, y);
    if (!place || !chart) return null;
    const found = camera.nearest(place[0], place[1], view.T * within / box.width, view.X * within / box.height);
    return found && found.distance <= 1 ? found : null;
  }

  // Mouse, keys and touch

  function zoom(factor, at, only) {
    const { view } = camera;
    let place = at ? placeOf(at.x, at.y) : [view.tau, view.xi];
    if (!place) return;
    const caught = at && factor > 1 && camera.chart ? camera.deepest(place, 14 / box.width, 14 / box.height) : null;
    if (caught) place = [caught.tau, caught.xi - view.V * caught.tau];
    if (only === "time") camera.zoom(factor, 1, place);
    else if (only === "space") camera.zoom(1, factor, place);
    else camera.zoom(factor, 1, place, camera.follow(camera.guide(place)));
    changed();
  }
  function pan(dx, dy) {
    camera.pan(-dx / box.width * camera.view.T, dy / box.height * camera.view.X);
    changed();
  }
  // Moves to collision e. Keeps the spans if they still suit it, else takes the gap that closed in it.
  function visit(e) {
    if (e < 0 || e >= world.n) return;
    const deep = 10 ** Math.max(-300, world.depth[e]), { view } = camera;
    const suits = view.X > 2 * deep && view.X < 40 * deep, X = suits ? view.X : 6 * deep;
    camera.goTo(e, suits ? view.T : Math.max(1e-300, X / (1.3 * world.speed[e])), X);
    changed();
  }
  const actions = {
    home: () => { camera.home(); changed(); },
    deepest: () => visit(world.depth.reduce((best, d, e) => d > -330 && d < world.depth[best] ? e : best, 0)),
    colours: () => {
      state.quantity = state.quantity === "speed" ? "lost" : "speed";
      state.range = state.shown = null;
      request();
    },
    play: () => {
      state.playing = !state.playing;
      playButton.textContent = state.playing ? "Pause" : "Play";
      if (state.playing) microscopePlay(camera, state, changed, () => state.playing && actions.play());
    },
  };
  const playButton = button("Play", "fly on (space)", actions.play);
  button("All", "the whole run (0)", actions.home);
  button("+", "zoom in (+)", () => zoom(1.6, null));
  button("−", "zoom out (−)", () => zoom(1 / 1.6, null));
  if (data.kind === "collisions") {
    button("‹", "previous collision (p)", () => visit(camera.view.anchor.e - 1));
    button("›", "next collision (n)", () => visit(camera.view.anchor.e + 1));
    button("Deepest", "the collision with the smallest gap (d)", actions.deepest);
    button("Colours", "colour by closing speed or by energy lost (c)", actions.colours);
  }

  const handle = {
    view: () => ({ ...camera.view, exact: Boolean(camera.chart), box: { ...box }, depth: camera.view.X }),
    // Shows collision `event`, or the first one of this depth, with so much space (depth, in l) in sight.
    zoomTo: ({ event, depth, time }) => {
      const found = world.depth.findIndex(d => d > -330 && d <= Math.log10(depth / 3));
      const e = event === undefined ? (found < 0 ? world.n - 1 : found) : event;
      if (!(e >= 0 && e < world.n)) throw new Error(`no such collision (${e}): give one from 0 to ${world.n - 1}`);
      camera.goTo(e, time || depth / (1.3 * world.speed[e]), depth);
      changed();
      state.moving = 0;
      draw();
      return handle.view();
    },
    // The pixel on the canvas at which a particle's collision is drawn; null if it is not in the chart.
    position: (particle, event) => {
      const { chart, view } = camera, found = chart && microscopeThrough(chart, particle - world.first, event);
      if (!found) return null;
      const i = found[0].points[found[1]], scales = microscopeScales(view, box);
      return { x: scales.x(chart.tau[i]), y: scales.y(chart.xi[i], chart.tau[i]) };
    },
    // The height of a particle's world line at a pixel column.
    height: (particle, x) => {
      const { chart, view } = camera, line = chart.byParticle.get(particle - world.first), [tau] = unbounded(x, 0);
      return microscopeScales(view, box).y(microscopeAlong(chart, line, tau), tau);
    },
    gap: (a, b, event) => microscopeRelative(world, a - world.first, b - world.first, event),
    readout: () => readout.textContent, zoom, pan, visit, draw, actions, state,
    world: () => world, camera: () => camera,
  };
  const start = made => {
    world = made;
    world.logSpeed = Float32Array.from(world.speed, microscopeLog);
    camera = microscopeCamera(world);
    layout();
  };
  handle.ready = (async () => {
    say("unpacking …");
    if (data.kind === "collisions") {
      start(await microscopeCollisions(data));
    } else {
      const choice = make("select", "microscope-choice", bar);
      data.snapshots.forEach((shot, i) => { make("option", "", choice, `t = ${shot.time}`).value = i; });
      const show = async () => start(await microscopeSnapshot(data, data.snapshots[choice.value]));
      choice.addEventListener("change", show);
      await show();
    }
    microscopeHands(canvas, { zoom, pan, visit, actions, collisionAt, unbounded, camera: () => camera, state, request,
                              box: () => box, strip: () => strip, deepest: () => stores.strip.deepest });
    new ResizeObserver(layout).observe(stage);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", layout);
  })().catch(error => {
    say(`The microscope cannot show this run (${error.message}): make the report again, or use a newer browser`);
    throw error;
  });
  element.cradleMicroscope = window.cradleMicroscopeTest = handle;
  return handle;
}
