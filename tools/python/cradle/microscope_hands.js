// Mouse, wheel, keys and touch; play; and the gap at a point.

function microscopeHands(canvas, scope) {
  const { zoom, pan, visit, actions, state } = scope, fingers = new Map();
  const at = event => {
    const corner = canvas.getBoundingClientRect();
    return { x: event.clientX - corner.left, y: event.clientY - corner.top };
  };
  // Over an axis only that axis is zoomed.
  const only = (event, { x, y }) => {
    const box = scope.box();
    if (event.shiftKey || y > box.top + box.height) return "time";
    return event.altKey || x < box.left ? "space" : undefined;
  };
  const inside = ({ x, y }) => {
    const { left, top, width, height } = scope.box();
    return { x: microscopeClamp(x, left, left + width), y: microscopeClamp(y, top, top + height) };
  };

  canvas.addEventListener("wheel", event => {
    // Scrolling past the microscope must scroll the page: the wheel zooms only after a click on it.
    if (document.activeElement !== canvas && !event.ctrlKey) return;
    event.preventDefault();
    const turned = (event.deltaY || event.deltaX) * (event.deltaMode === 1 ? 30 : event.deltaMode === 2 ? 300 : 1);
    zoom(Math.exp(-microscopeClamp(turned, -300, 300) / 350), inside(at(event)), only(event, at(event)));
  }, { passive: false });

  canvas.addEventListener("pointerdown", event => {
    canvas.focus({ preventScroll: true });
    const place = at(event), strip = scope.strip();
    if (strip && place.y > strip.top - 4 && place.x >= strip.left && place.x <= strip.left + strip.width) {
      const deepest = scope.deepest();
      let k = Math.min(deepest.length - 1, Math.floor(place.x - strip.left));
      while (k > 0 && deepest[k] < 0) --k;
      return visit(deepest[k]);
    }
    try { canvas.setPointerCapture(event.pointerId); } catch { /* a pointer that scripts made */ }
    fingers.set(event.pointerId, place);
  });
  canvas.addEventListener("pointermove", event => {
    const place = at(event), before = fingers.get(event.pointerId);
    state.pointer = place;
    if (!before) return scope.request();
    fingers.set(event.pointerId, place);
    if (fingers.size === 1) return pan(place.x - before.x, place.y - before.y);
    if (fingers.size > 2) return;
    // Two fingers: the point between them follows them, and each axis is zoomed as they part along it.
    const other = [...fingers].find(([id]) => id !== event.pointerId)[1];
    pan((place.x - before.x) / 2, (place.y - before.y) / 2);
    const part = (a, b, c) => Math.abs(b - c) < 40 ? 1 : microscopeClamp(Math.abs(a - c) / Math.abs(b - c), 0.25, 4);
    scope.camera().zoom(part(place.x, before.x, other.x) || 1, part(place.y, before.y, other.y) || 1,
                        scope.unbounded((place.x + other.x) / 2, (place.y + other.y) / 2));
    pan(0, 0);
  });
  for (const end of ["pointerup", "pointercancel"])
    canvas.addEventListener(end, event => fingers.delete(event.pointerId));
  canvas.addEventListener("pointerleave", () => { state.pointer = null; scope.request(); });
  canvas.addEventListener("dblclick", event => {
    const collision = scope.collisionAt(at(event), 20);
    if (collision) visit(collision.e); else zoom(2, at(event));
  });

  canvas.addEventListener("keydown", event => {
    if (event.ctrlKey || event.metaKey) return;
    const box = scope.box(), step = [box.width / 12, box.height / 12], here = scope.camera().view.anchor.e;
    const middle = state.pointer && inside(state.pointer), corner = { x: box.left, y: box.top };
    // With Alt some keyboards give other letters, so the name of the key decides.
    const key = event.code === "Equal" || event.code === "NumpadAdd" || event.key === "+" ? "+" :
      event.code === "Minus" || event.code === "NumpadSubtract" ? "-" : event.key;
    const acts = {
      "+": () => zoom(1.35, middle, event.code === "Equal" && event.key === "+" ? undefined : only(event, corner)),
      "-": () => zoom(1 / 1.35, middle, only(event, corner)),
      n: () => visit(here + 1), p: () => visit(here - 1), 0: actions.home, Home: actions.home, d: actions.deepest,
      c: actions.colours, " ": actions.play, ArrowLeft: () => pan(step[0], 0), ArrowRight: () => pan(-step[0], 0),
      ArrowUp: () => pan(0, step[1]), ArrowDown: () => pan(0, -step[1]),
    };
    if (!acts[key]) return;
    acts[key]();
    event.preventDefault();
  });
}

// Play. In a collapse it zooms about the last collision at a steady rate, so that collisions pass by evenly. Else time
// runs, a picture's width in ten seconds. `frame` draws, `stop` is called at the end.
function microscopePlay(camera, state, frame, stop) {
  const { world } = camera, last = world.n - 1;
  let before = performance.now();
  const inSight = () => {
    const { view, chart } = camera, { e } = view.anchor;
    const tau = last < 0 || e < 0 ? NaN : microscopeFlight(world, e, last);
    if (!chart || !(Math.abs(tau - view.tau) <= 0.5 * view.T)) return null;
    const i = chart.collisions.length - 1;
    const near = i >= 0 && chart.collisions[i] === last &&
      Math.abs(chart.xi[i] - view.V * chart.tau[i] - view.xi) < view.X / 2;
    return near ? [chart.tau[i], chart.xi[i] - view.V * chart.tau[i]] : null;
  };
  if (world.collapse && !inSight()) camera.home();
  const step = now => {
    if (!state.playing) return;
    const passed = Math.min(0.1, (now - before) / 1000);
    before = now;
    const { view } = camera, aim = world.collapse ? inSight() : null;
    if (aim) {
      // Moves the collapse to three quarters of the picture.
      const part = Math.min(1, 2 * passed);
      camera.pan((aim[0] - view.tau - 0.25 * view.T) * part, (aim[1] - view.xi) * part);
      const to = inSight();
      if (!to || camera.view.T < 6 * world.interval[last]) return stop();
      camera.zoom(Math.exp(6 * passed), 1, to, camera.follow(camera.guide(to)));
    } else {
      const after = world.end - (world.n ? world.time[last] : world.start);
      const end = (world.n ? microscopeBetween(world, view.anchor.e, last) : 0) + after;
      if (view.tau > end) return stop();
      camera.pan(view.T * passed / 10, 0);
    }
    frame();
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}

// The two particles below and above a point [tau, xi] of the picture: {below, above, gap, w, next, until}: gap and
// closing speed then, the next collision of either of them (-1: none) and the time to it. null beyond the outermost.
function microscopeGapAt(camera, [tau, xi]) {
  const { world, chart, view } = camera, e = view.anchor.e, collision = microscopeCollisionAt(world, e, tau);
  const since = tau - (collision < 0 && e < 0 ? 0 : microscopeBetween(world, e, collision));
  let below = -1, above = -1, low = -Infinity, high = Infinity;
  const consider = (particle, place) => {
    if (place <= xi && place > low) [below, low] = [particle, place];
    if (place > xi && place < high) [above, high] = [particle, place];
  };
  if (chart) {
    for (const line of chart.lines)
      if (line.from[0] <= tau && line.to[0] >= tau)
        consider(line.particle, microscopeAlong(chart, line, tau) - view.V * tau);
  } else {
    const { t, x: x0 } = microscopeOrigin(world, view.anchor);
    for (let particle = 0; particle < world.particles; ++particle) {
      const merger = microscopeMerger(world, particle);
      if (merger >= 0 && world.time[merger] < t + tau) continue;
      consider(particle, microscopeState(world, particle, collision, since).x - x0 - (view.lab + view.V) * tau);
    }
  }
  if (below < 0 || above < 0) return null;
  const { gap, w } = microscopeRelative(world, below, above, collision);
  const following = [below, above].map(particle => microscopeSlotAfter(world, particle, collision))
    .map((slot, i) => slot < world.begin[[below, above][i] + 1] ? world.list[slot] : Infinity);
  const next = Math.min(...following), known = Number.isFinite(next);
  const pending = gap - w * since, dueIn = world.n || !(w > 0) ? NaN : pending / w;
  return { below, above, gap: Math.max(0, pending), w, next: known ? next : -1,
           until: known ? microscopeFlight(world, collision, next) - since : dueIn };
}
