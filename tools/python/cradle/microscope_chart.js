// Charts: world lines in coordinates relative to a collision, and in positions when the whole run is in view.
//
// An anchor is {e, a}: collision e (e = -1 is the start) and the particle a with its right neighbour. In a chart, tau
// is the time since then, and xi the distance from there in the frame in which these two have no momentum: local sums.

// The most particles and collisions that are followed: few if positions serve as well, many if they do not.
const MICROSCOPE_CHART = { particles: 1500, collisions: 8000, deep: 60000 };

// The anchor's two particles: {a, b, gap, speedA, speedB, lab}: right after it, in its frame, whose velocity is lab.
function microscopeAnchor(world, anchor) {
  const { e } = anchor;
  let [a, b] = e < 0 ? [anchor.a, microscopeOrder(world, e).next[anchor.a]] : [world.left[e], world.right[e]];
  if (world.event[e] === MICROSCOPE.pass) [a, b] = [b, a];
  if (world.event[e] === MICROSCOPE.merge) a = b = microscopeOther(world, microscopeGone(world, e), e);
  const { gap, w } = a === b ? { gap: 0, w: 0 } : microscopeRelative(world, a, b, e);
  const [ofA, ofB] = [a, b].map(particle => microscopeMass(world, particle, e)), speedA = w * ofB / (ofA + ofB);
  return { a, b, gap, speedA, speedB: speedA - w, lab: microscopeState(world, a, e).v - speedA };
}

// The particles around an anchor, right after it: [{particle, xi, u}] from left to right, up to `reach` on either side
// and `more` = [left, right] particles beyond; null if there are too many.
function microscopeAround(world, anchor, reach, more) {
  const pair = microscopeAnchor(world, anchor), order = microscopeOrder(world, anchor.e);
  const found = [{ particle: pair.a, xi: 0, u: pair.speedA }];
  const seen = new Set([pair.a, pair.b]);
  if (pair.b !== pair.a) found.push({ particle: pair.b, xi: pair.gap, u: pair.speedB });
  for (const side of [1, -1]) {
    let last = side > 0 ? found[found.length - 1] : found[0], spare = more[side > 0 ? 1 : 0];
    for (;;) {
      const particle = side > 0 ? order.next[last.particle] : order.previous[last.particle];
      if (particle < 0 || seen.has(particle) || (Math.abs(last.xi) > reach && spare-- <= 0)) break;
      const { gap, w } = side > 0 ? microscopeRelative(world, last.particle, particle, anchor.e)
                                  : microscopeRelative(world, particle, last.particle, anchor.e);
      last = { particle, xi: last.xi + side * gap, u: last.u - side * w };
      seen.add(particle);
      if (side > 0) found.push(last); else found.unshift(last);
      if (found.length > MICROSCOPE_CHART.particles) return null;
    }
  }
  return found;
}

// The last collision at or before tau after the anchor's, -1 for none.
const microscopeCollisionAt = (world, e, tau) =>
  microscopeFirst(0, world.n, k => microscopeBetween(world, e, k) <= tau) - 1;

// Times since the anchor's collision of collisions in rising order: sums of intervals if they are close.
function microscopeTimes(world, e, collisions) {
  const tau = new Float64Array(collisions.length);
  const split = microscopeFirst(0, collisions.length, i => collisions[i] <= e);
  for (const [from, end, step] of [[split, collisions.length, 1], [split - 1, -1, -1]]) {
    let at = 0, last = e;
    for (let i = from; i !== end; i += step) {
      at += microscopeBetween(world, last, collisions[i]);
      last = collisions[i];
      tau[i] = at;
    }
  }
  return tau;
}

// The chart for tau in [early, late] and the particles that come within [low, high] of xi - V tau there; null if there
// are too many particles or collisions.
//   collisions    Int32Array, rising; tau, xi of each
//   lines         [{particle, points: [index in collisions], speeds: [velocity after each], from: [tau, xi],
//                 to: [tau, xi]}]
//   around        the particles around the anchor; byParticle: their lines, by particle
function microscopeChart(world, { anchor, early, late, low, high, V }) {
  const begins = -microscopeFlight(world, -1, anchor.e);
  const final = world.n - 1, beyond = world.end - (final < 0 ? world.start : world.time[final]);
  const ends = microscopeFlight(world, anchor.e, final) + Math.max(0, beyond);
  const from = Math.max(early, begins), to = Math.min(Math.max(late, from), ends);
  const deep = high - low < 1e-9 * Math.max(Math.abs(world.x0[0]), Math.abs(world.x0[world.particles - 1]));
  const most = 2 * (deep ? MICROSCOPE_CHART.deep : MICROSCOPE_CHART.collisions);
  // Also those between an anchor that is out of sight and the view: particles are followed from it.
  const first = Math.min(microscopeCollisionAt(world, anchor.e, from), anchor.e) + 1;
  const last = to < ends ? Math.max(microscopeCollisionAt(world, anchor.e, to), anchor.e) : final;
  const reach = Math.max(Math.abs(low), Math.abs(high)), more = [2, 2];
  for (let attempt = 0; attempt < 12; ++attempt) {
    const around = microscopeAround(world, anchor, reach, more);
    if (!around) return null;
    const chart = microscopeFollow(world, anchor, around, from, to, first, last, most);
    if (!chart) return null;
    // Particles further out may enter where the outermost ones do.
    const comesIn = (line, side) => [line.from, line.to, ...line.points.map(i => [chart.tau[i], chart.xi[i]])]
      .some(([tau, xi]) => side > 0 ? xi - V * tau < high : xi - V * tau > low);
    const order = microscopeOrder(world, anchor.e), ring = around.length >= world.particles;
    const [lowest, highest] = [around[0].particle, around[around.length - 1].particle];
    const left = !ring && order.previous[lowest] >= 0 && comesIn(chart.byParticle.get(lowest), -1);
    const right = !ring && order.next[highest] >= 0 && comesIn(chart.byParticle.get(highest), 1);
    if (!left && !right) return { ...chart, around };
    if (left) more[0] = 2 * more[0] + around.length;
    if (right) more[1] = 2 * more[1] + around.length;
  }
  return null;
}

// Follows the particles around an anchor through collisions first .. last, those nearest to it first: each goes its own
// way, since its kicks are known. Other particles are known when they meet one of these, from their previous collision
// to their next one: each time as a separate line.
function microscopeFollow(world, anchor, around, from, to, first, last, most) {
  const { left, right, list, begin, after, slotLeft, slotRight, ring } = world, e = anchor.e, all = [];
  for (const { particle } of around)
    for (let slot = microscopeSlotAfter(world, particle, first - 1);
         slot < begin[particle + 1] && list[slot] <= last; ++slot) {
      all.push(list[slot]);
      if (all.length > most) return null;
    }
  const collisions = Int32Array.from(new Set(all)).sort(), n = collisions.length;
  const places = new Map(Array.from(collisions, (k, i) => [k, i]));
  const tau = microscopeTimes(world, e, collisions), xi = new Float64Array(n).fill(NaN);
  const speedOfLeft = new Float64Array(n), drawn = [new Uint8Array(n), new Uint8Array(n)];  // left and right particles
  // The line of a particle that is at `place` with the velocity u `now`, before its collision in `slot`.
  const follow = (particle, slot, now, place, u) => {
    const line = { particle, points: [], speeds: [] }, merger = microscopeMerger(world, particle);
    const known = world.valid ? world.valid[particle] : merger < 0 ? Infinity : microscopeBetween(world, e, merger);
    // On (step 1) or back (-1) through collisions that are not drawn yet: the point [tau, xi] up to which it is known.
    const end = (slot, step) => {
      for (let t = now, x = place, speed = u;; slot += step) {
        const inside = slot >= begin[particle] && slot < begin[particle + 1], k = inside ? list[slot] : -1;
        const i = places.get(k), side = left[k] === particle ? 0 : 1;
        if (i === undefined || drawn[side][i]) {
          const due = inside ? microscopeBetween(world, e, k) : step * Infinity;
          const stop = step > 0 ? Math.max(t, Math.min(to, due, known)) : Math.min(t, Math.max(from, due));
          return [stop, x + speed * (stop - t)];
        }
        x += speed * (tau[i] - t);
        t = tau[i];
        // Around a whole ring a particle is visible twice: here it is another one's neighbour a turn away.
        if (ring && Math.abs(x - xi[i]) > ring / 2) return [t, x];
        x = xi[i] = Number.isNaN(xi[i]) ? x : xi[i];
        const kick = microscopeKick(world, particle, k), later = step > 0 ? speed + kick : speed;
        line.points.push(i);
        line.speeds.push(later);
        speedOfLeft[i] = side === 0 ? later : later + after[k];
        drawn[side][i] = 1;
        speed += step * kick;
      }
    };
    line.from = end(slot - 1, -1);
    line.points.reverse();
    line.speeds.reverse();
    line.to = end(slot, 1);
    return line;
  };
  const byParticle = new Map();
  for (const { particle, xi: place, u } of [...around].sort((one, other) => Math.abs(one.xi) - Math.abs(other.xi)))
    byParticle.set(particle, follow(particle, microscopeSlotAfter(world, particle, e), 0, place, u));
  const lines = around.map(({ particle }) => byParticle.get(particle));
  const others = i => {
    const k = collisions[i];
    if (!drawn[0][i]) lines.push(follow(left[k], slotLeft[k] + 1, tau[i], xi[i], speedOfLeft[i]));
    if (!drawn[1][i]) lines.push(follow(right[k], slotRight[k] + 1, tau[i], xi[i], speedOfLeft[i] - after[k]));
  };
  const split = microscopeFirst(0, n, i => collisions[i] <= e);
  for (let i = split - 1; i >= 0; --i) others(i);
  for (let i = split; i < n; ++i) others(i);
  return { collisions, tau, xi, lines, byParticle };
}

// The line of a chart through collision k of a particle, and the index of k in its points: [line, index].
function microscopeThrough(chart, particle, k) {
  for (const line of chart.lines) {
    const place = line.particle === particle ? line.points.findIndex(i => chart.collisions[i] === k) : -1;
    if (place >= 0) return [line, place];
  }
  return null;
}
