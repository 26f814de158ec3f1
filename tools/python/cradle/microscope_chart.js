// Charts: world lines in coordinates relative to a collision, and in positions when the whole run is in view.
//
// An anchor is {e, a}: collision e (e = -1 is the start) and the particle a with its right neighbour. In a chart, tau
// is the time since then, and xi the distance from there in the frame in which these two have no momentum: local sums.

// The most particles and collisions that are followed: few if positions serve as well, many if they do not.
const MICROSCOPE_CHART = { particles: 1500, collisions: 8000, deep: 60000 };

// The anchor's two particles: {a, b, gap, speedA, speedB, lab}: right after it, in its frame, whose velocity is lab.
function microscopeAnchor(world, anchor) {
  const { e } = anchor;
  if (e < 0) {
    const a = anchor.a, b = microscopeOrder(world, -1).next(a), { gap, w } = microscopeRelative(world, a, b, -1);
    const ofB = world.mass0 ? world.mass0[b] / (world.mass0[a] + world.mass0[b]) : 0.5;
    return { a, b, gap, speedA: w * ofB, speedB: -w * (1 - ofB), lab: world.v0[a] - w * ofB };
  }
  const passed = world.event[e] === MICROSCOPE.pass, merged = world.event[e] === MICROSCOPE.merge;
  const from = world.left[e], to = world.right[e], ofTo = world.share ? world.share[e] : 0.5;
  const ofFrom = world.after[e] * ofTo, ofOther = -world.after[e] * (1 - ofTo);
  const lab = world.velocity[world.slotLeft[e]] - ofFrom;
  if (merged) {
    const heir = microscopeOther(world, microscopeGone(world, e), e);
    return { a: heir, b: heir, gap: 0, speedA: 0, speedB: 0, lab };
  }
  return passed ? { a: to, b: from, gap: 0, speedA: ofOther, speedB: ofFrom, lab }
                : { a: from, b: to, gap: 0, speedA: ofFrom, speedB: ofOther, lab };
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
      const particle = side > 0 ? order.next(last.particle) : order.previous(last.particle);
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

// The last collision at or before tau after the anchor's, -1 for none, and its time.
function microscopeCollisionAt(world, e, tau) {
  const { n, time, interval, start } = world, t = e < 0 ? start : time[e];
  let k = e, at = 0;
  if (Math.abs(tau) > 1e-6 * Math.max(Math.abs(t), Number.MIN_VALUE) || e < 0) {
    const rest = e < 0 ? 0 : world.low[e];
    return microscopeFirst(0, n, k => (time[k] - t) + (world.low[k] - rest) <= tau) - 1;
  }
  if (tau >= 0) while (k + 1 < n && at + interval[k + 1] <= tau) at += interval[++k];
  else while (k >= 0 && at > tau) at -= interval[k--];
  return k;
}

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

// The chart for tau in [from, to] and the particles that come within [low, high] of xi - drift tau there; null if there
// are too many particles or collisions.
//   collisions    Int32Array, rising; tau, xi of each
//   lines         [{particle, points: [index in collisions], speeds: [velocity after each], from: [tau, xi],
//                 to: [tau, xi]}]
//   around        the particles around the anchor; byParticle: their lines, by particle
function microscopeChart(world, anchor, from, to, low, high, drift) {
  const begins = -microscopeFlight(world, -1, anchor.e);
  const final = world.n - 1, beyond = world.end - (final < 0 ? world.start : world.time[final]);
  const ends = microscopeFlight(world, anchor.e, final) + Math.max(0, beyond);
  from = Math.max(from, begins);
  to = Math.min(Math.max(to, from), ends);
  const deep = high - low < 1e-9 * Math.max(Math.abs(world.x0[0]), Math.abs(world.x0[world.particles - 1]));
  const most = 2 * (deep ? MICROSCOPE_CHART.deep : MICROSCOPE_CHART.collisions);
  const first = microscopeCollisionAt(world, anchor.e, from) + 1;
  const last = to < ends ? microscopeCollisionAt(world, anchor.e, to) : final;
  const reach = Math.max(Math.abs(low), Math.abs(high)), more = [2, 2];
  for (let attempt = 0; attempt < 12; ++attempt) {
    const around = microscopeAround(world, anchor, reach, more);
    if (!around) return null;
    const chart = microscopeFollow(world, anchor, around, from, to, first, last, most);
    if (!chart) return null;
    // Particles further out may enter where the outermost ones do.
    const comesIn = (line, side) => [line.from, line.to, ...line.points.map(i => [chart.tau[i], chart.xi[i]])]
      .some(([tau, xi]) => side > 0 ? xi - drift * tau < high : xi - drift * tau > low);
    const order = microscopeOrder(world, anchor.e), ring = around.length >= world.particles;
    const [lowest, highest] = [around[0].particle, around[around.length - 1].particle];
    const left = !ring && order.previous(lowest) >= 0 && comesIn(chart.byParticle.get(lowest), -1);
    const right = !ring && order.next(highest) >= 0 && comesIn(chart.byParticle.get(highest), 1);
    if (!left && !right) return { ...chart, around };
    if (left) more[0] = 2 * more[0] + around.length;
    if (right) more[1] = 2 * more[1] + around.length;
  }
  return null;
}

// Follows the particles around an anchor through collisions first .. last, forwards and backwards. Other particles are
// known when they meet one of these, from their previous collision to their next one: each time as a separate line.
function microscopeFollow(world, anchor, around, from, to, first, last, most) {
  const { left, right, list, begin, event, slotLeft, slotRight } = world, e = anchor.e, all = [];
  for (const { particle } of around)
    for (let slot = microscopeSlotAfter(world, particle, first - 1);
         slot < begin[particle + 1] && list[slot] <= last; ++slot) {
      all.push(list[slot]);
      if (all.length > most) return null;
    }
  const collisions = Int32Array.from(new Set(all)).sort();
  const tau = microscopeTimes(world, e, collisions), xi = new Float64Array(collisions.length), lines = [];
  const timeOf = (particle, slot) => slot < begin[particle] ? -Infinity : slot >= begin[particle + 1] ? Infinity :
    microscopeBetween(world, e, list[slot]);
  const at = (one, time) => one.xi + one.u * (time - one.tau);
  // `slot`: of the last collision of the line so far, forwards or backwards.
  const line = (particle, slot, now, place, u) => {
    const made = { particle, points: [], speeds: [], slot, tau: now, xi: place, u, from: null, to: null };
    lines.push(made);
    return made;
  };
  const endLine = one => {
    const end = Math.min(to, timeOf(one.particle, one.slot + 1), world.valid ? world.valid[one.particle] : Infinity);
    one.to = [Math.max(end, one.tau), at(one, Math.max(end, one.tau))];
  };
  const beginLine = one => {
    const start = Math.min(one.tau, Math.max(from, timeOf(one.particle, one.slot - 1)));
    one.from = [start, at(one, start)];
  };
  // One pass through the collisions. `known`: the lines that continue, by particle. `step`: 1 forwards, -1 backwards.
  const follow = (known, begins, ends, step, before, after, endHere, beginHere) => {
    for (let i = begins; i !== ends; i += step) {
      const k = collisions[i], now = tau[i];
      let [a, b] = [[left[k], slotLeft[k]], [right[k], slotRight[k]]].map(([particle, slot]) => {
        const one = known.get(particle);
        if (!one || one.slot + step === slot) return one;
        endHere(one);  // it has met others meanwhile
        return null;
      });
      // Around a whole ring a particle is visible twice: drop the one further out.
      if (world.ring && a && b && Math.abs(at(a, now) - at(b, now)) > world.ring / 2) {
        const outer = Math.abs(at(a, now)) > Math.abs(at(b, now)) ? a : b;
        endHere(outer);
        if (outer === a) a = null; else b = null;
      }
      const w = before(k);
      const speedA = a ? a.u : b.u + w, speedB = b ? b.u : a.u - w;
      xi[i] = a && b ? (at(a, now) + at(b, now)) / 2 : at(a || b, now);
      for (const [old, particle, slot, speed, kick] of [[a, left[k], slotLeft[k], speedA, -step * world.kickLeft[k]],
                                                    [b, right[k], slotRight[k], speedB, step * world.kickRight[k]]]) {
        let one = old;
        if (!one) {
          one = line(particle, slot, now, xi[i], speed);
          beginHere(one, k);
        }
        known.set(particle, one);
        one.points.push(i);
        one.speeds.push(step > 0 ? speed + kick : speed);
        Object.assign(one, { slot, tau: now, xi: xi[i], u: speed + kick });
      }
      after(k, known);
    }
    known.forEach(endHere);
  };
  const split = microscopeFirst(0, collisions.length, i => collisions[i] <= e);
  const middle = around.map(({ particle, xi: place, u }) =>
    line(particle, microscopeSlotAfter(world, particle, e), 0, place, u));
  const byParticle = new Map(middle.map(one => [one.particle, one]));
  const ended = new Set();  // slots of the collisions after which particles are known until their next one
  const goneIn = k => event[k] === MICROSCOPE.merge ? microscopeGone(world, k) : -1;
  follow(new Map(byParticle), split - 1, -1, -1, k => world.after[k], () => {}, beginLine, (one, k) => {
    ended.add(one.slot);
    if (goneIn(k) === one.particle) one.to = [one.tau, one.xi];
    else endLine(one);
  });
  // Then forwards from the anchor.
  for (const one of lines) {
    one.points.reverse();
    one.speeds.reverse();
  }
  around.forEach(({ particle, xi: place, u }, i) =>
    Object.assign(middle[i], { slot: microscopeSlotAfter(world, particle, e) - 1, tau: 0, xi: place, u }));
  follow(new Map(byParticle), split, collisions.length, 1, k => world.speed[k], (k, known) => {
    const one = known.get(goneIn(k));
    if (!one) return;
    one.to = [one.tau, one.xi];
    known.delete(one.particle);
  }, endLine, one => {
    beginLine(one);
    if (ended.has(one.slot - 1)) one.from = [one.tau, one.xi];
  });
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
