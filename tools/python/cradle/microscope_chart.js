// Charts: world lines in coordinates anchored at a contact, and the same in positions where the whole is looked at.
//
// An anchor is {e, a}: contact e, or e = -1, the start, and the body a with its right neighbour. In a chart tau is the
// time since then and xi the distance from there in the frame in which these two have no momentum. Both are local sums.

// Up to so many bodies and contacts are followed: few where positions serve as well, many where they do not.
const MICROSCOPE_CHART = { bodies: 1500, contacts: 8000, deep: 60000 };

// The anchor's two bodies and what is known of them: {a, b, after, speedA, speedB}: velocities right after it, in its
// own frame, and the velocity of that frame in the lab.
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

// The bodies around an anchor, right after it: [{body, xi, u}] from left to right, as far as `reach` to either side and
// `more` = [left, right] bodies beyond; null where there are too many.
function microscopeAround(world, anchor, reach, more) {
  const pair = microscopeAnchor(world, anchor), order = microscopeOrder(world, anchor.e);
  const found = [{ body: pair.a, xi: 0, u: pair.speedA }];
  const seen = new Set([pair.a, pair.b]);
  if (pair.b !== pair.a) found.push({ body: pair.b, xi: pair.gap, u: pair.speedB });
  for (const side of [1, -1]) {
    let last = side > 0 ? found[found.length - 1] : found[0], spare = more[side > 0 ? 1 : 0];
    for (;;) {
      const body = side > 0 ? order.next(last.body) : order.previous(last.body);
      if (body < 0 || seen.has(body) || (Math.abs(last.xi) > reach && spare-- <= 0)) break;
      const { gap, w } = side > 0 ? microscopeRelative(world, last.body, body, anchor.e)
                                  : microscopeRelative(world, body, last.body, anchor.e);
      last = { body, xi: last.xi + side * gap, u: last.u - side * w };
      seen.add(body);
      if (side > 0) found.push(last); else found.unshift(last);
      if (found.length > MICROSCOPE_CHART.bodies) return null;
    }
  }
  return found;
}

// The last contact at or before tau after the anchor's, -1 for none, and the time of it.
function microscopeContactAt(world, e, tau) {
  const { n, time, interval, start } = world, t = e < 0 ? start : time[e];
  let k = e, at = 0;
  if (Math.abs(tau) > 1e-6 * Math.max(Math.abs(t), Number.MIN_VALUE) || e < 0) {
    let low = 0, high = n;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((time[middle] - t) + (world.low[middle] - (e < 0 ? 0 : world.low[e])) <= tau) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }
  if (tau >= 0) while (k + 1 < n && at + interval[k + 1] <= tau) at += interval[++k];
  else while (k >= 0 && at > tau) at -= interval[k--];
  return k;
}

// Times since the anchor's contact of contacts in rising order: sums of intervals where they are close.
function microscopeTimes(world, e, contacts) {
  const tau = new Float64Array(contacts.length);
  let split = 0;
  while (split < contacts.length && contacts[split] <= e) ++split;
  for (const [from, end, step] of [[split, contacts.length, 1], [split - 1, -1, -1]]) {
    let at = 0, last = e;
    for (let i = from; i !== end; i += step) {
      const k = contacts[i];
      const whole = step > 0 ? microscopeFlight(world, last, k) : -microscopeFlight(world, k, last);
      at += whole;
      last = k;
      tau[i] = at;
    }
  }
  return tau;
}

// The chart for tau in [from, to] and the bodies that come within [low, high] of xi - drift tau there; null where there
// are too many bodies or contacts for it.
//   contacts  Int32Array, rising; tau, xi of each
//   lines     [{body, points: [place in contacts], speeds: [velocity after each], from: [tau, xi], to: [tau, xi]}]
//   byBody    the lines of the bodies around the anchor, by body
function microscopeChart(world, anchor, from, to, low, high, drift) {
  const begins = -microscopeFlight(world, -1, anchor.e);
  const final = world.n - 1, beyond = world.end - (final < 0 ? world.start : world.time[final]);
  const ends = microscopeFlight(world, anchor.e, final) + Math.max(0, beyond);
  from = Math.max(from, begins);
  to = Math.min(Math.max(to, from), ends);
  const deep = high - low < 1e-9 * Math.max(Math.abs(world.x0[0]), Math.abs(world.x0[world.bodies - 1]));
  const most = 2 * (deep ? MICROSCOPE_CHART.deep : MICROSCOPE_CHART.contacts);
  const first = microscopeContactAt(world, anchor.e, from) + 1;
  const last = to < ends ? microscopeContactAt(world, anchor.e, to) : final;
  const reach = Math.max(Math.abs(low), Math.abs(high)), more = [2, 2];
  for (let attempt = 0; attempt < 12; ++attempt) {
    const around = microscopeAround(world, anchor, reach, more);
    if (!around) return null;
    const chart = microscopeFollow(world, anchor, around, from, to, first, last, most);
    if (!chart) return null;
    // Bodies further out may come in where the outermost ones do.
    const comesIn = (line, side) => [line.from, line.to, ...line.points.map(i => [chart.tau[i], chart.xi[i]])]
      .some(([tau, xi]) => side > 0 ? xi - drift * tau < high : xi - drift * tau > low);
    const order = microscopeOrder(world, anchor.e), ring = around.length >= world.bodies;
    const outer = body => chart.byBody.get(body);
    const left = !ring && order.previous(around[0].body) >= 0 && comesIn(outer(around[0].body), -1);
    const right = !ring && order.next(around[around.length - 1].body) >= 0 &&
                  comesIn(outer(around[around.length - 1].body), 1);
    if (!left && !right) return Object.assign(chart, { around, low, high, drift, begins, ends });
    if (left) more[0] = 2 * more[0] + around.length;
    if (right) more[1] = 2 * more[1] + around.length;
  }
  return null;
}

// Follows the bodies around an anchor through contacts first .. last, forwards and backwards. A body that is not among
// them is known where it meets one of them, from its contact before to its next one: a line of its own each time.
function microscopeFollow(world, anchor, around, from, to, first, last, most) {
  const { left, right, list, begin, event, slotLeft, slotRight } = world, e = anchor.e, all = [];
  for (const { body } of around)
    for (let slot = microscopeSlotAfter(world, body, first - 1); slot < begin[body + 1] && list[slot] <= last; ++slot) {
      all.push(list[slot]);
      if (all.length > most) return null;
    }
  const sorted = Int32Array.from(all).sort(), contacts = sorted.filter((k, i) => i === 0 || k !== sorted[i - 1]);
  const tau = microscopeTimes(world, e, contacts), xi = new Float64Array(contacts.length), lines = [];
  const timeOf = (body, slot) => slot < begin[body] ? -Infinity : slot >= begin[body + 1] ? Infinity :
    microscopeBetween(world, e, list[slot]);
  const at = (one, time) => one.xi + one.u * (time - one.tau);
  // `slot`: of the contact that the line has come to, forwards or backwards.
  const line = (body, slot, now, place, u) => {
    const made = { body, points: [], speeds: [], slot, tau: now, xi: place, u, from: null, to: null };
    lines.push(made);
    return made;
  };
  const endLine = one => {
    const end = Math.min(to, timeOf(one.body, one.slot + 1), world.valid ? world.valid[one.body] : Infinity);
    one.to = [Math.max(end, one.tau), at(one, Math.max(end, one.tau))];
  };
  const beginLine = one => {
    const start = Math.min(one.tau, Math.max(from, timeOf(one.body, one.slot - 1)));
    one.from = [start, at(one, start)];
  };
  // One way through the contacts. `known`: the lines that go on, by body. `step`: 1 forwards, -1 backwards.
  const follow = (known, begins, ends, step, before, after, endHere, beginHere) => {
    for (let i = begins; i !== ends; i += step) {
      const k = contacts[i], now = tau[i];
      let [a, b] = [[left[k], slotLeft[k]], [right[k], slotRight[k]]].map(([body, slot]) => {
        const one = known.get(body);
        if (!one || one.slot + step === slot) return one;
        endHere(one);  // it has met others meanwhile
        return null;
      });
      // All around a ring a body is in sight twice: the one further out is the one that is let go.
      if (world.ring && a && b && Math.abs(at(a, now) - at(b, now)) > world.ring / 2) {
        const outer = Math.abs(at(a, now)) > Math.abs(at(b, now)) ? a : b;
        endHere(outer);
        if (outer === a) a = null; else b = null;
      }
      const w = before(k);
      const speedA = a ? a.u : b.u + w, speedB = b ? b.u : a.u - w;
      xi[i] = a && b ? (at(a, now) + at(b, now)) / 2 : at(a || b, now);
      for (const [old, body, slot, speed, kick] of [[a, left[k], slotLeft[k], speedA, -step * world.kickLeft[k]],
                                                    [b, right[k], slotRight[k], speedB, step * world.kickRight[k]]]) {
        let one = old;
        if (!one) {
          one = line(body, slot, now, xi[i], speed);
          beginHere(one, k);
        }
        known.set(body, one);
        one.points.push(i);
        one.speeds.push(step > 0 ? speed + kick : speed);
        Object.assign(one, { slot, tau: now, xi: xi[i], u: speed + kick });
      }
      after(k, known);
    }
    known.forEach(endHere);
  };
  let split = 0;
  while (split < contacts.length && contacts[split] <= e) ++split;
  const middle = around.map(({ body, xi: place, u }) =>
    line(body, microscopeSlotAfter(world, body, e) - 1, 0, place, u));
  const came = new Set();  // slots at which bodies came in forwards: known from the contact before on
  const merged = k => event[k] === MICROSCOPE.merge;
  follow(new Map(middle.map(one => [one.body, one])), split, contacts.length, 1, k => world.speed[k], (k, known) => {
    if (!merged(k)) return;
    const one = known.get(microscopeGone(world, k));
    one.to = [one.tau, one.xi];
    known.delete(one.body);
  }, endLine, one => {
    beginLine(one);
    came.add(one.slot);
  });
  // Backwards from the anchor; the points of both ways together.
  const ahead = middle.map(({ points, speeds }) => ({ points, speeds }));
  around.forEach(({ body, xi: place, u }, i) => Object.assign(middle[i], {
    points: [], speeds: [], slot: microscopeSlotAfter(world, body, e), tau: 0, xi: place, u }));
  const earlier = lines.length;
  follow(new Map(middle.map(one => [one.body, one])), split - 1, -1, -1, k => world.after[k], () => {},
         beginLine, (one, k) => {
           const gone = merged(k) && microscopeGone(world, k) === one.body;
           if (gone || came.has(one.slot + 1)) one.to = [one.tau, one.xi];
           else endLine(one);
         });
  lines.forEach((one, k) => {
    if (k >= middle.length && k < earlier) return;
    one.points.reverse();
    one.speeds.reverse();
    if (k >= middle.length) return;
    one.points.push(...ahead[k].points);
    one.speeds.push(...ahead[k].speeds);
  });
  return { anchor, from, to, contacts, tau, xi, lines, byBody: new Map(middle.map(one => [one.body, one])) };
}

// The line of a chart that goes through contact k of a body, and the place of k in its points: [line, place].
function microscopeThrough(chart, body, k) {
  for (const line of chart.lines) {
    const place = line.body === body ? line.points.findIndex(i => chart.contacts[i] === k) : -1;
    if (place >= 0) return [line, place];
  }
  return null;
}

// The contact of a chart that is nearest to a place, in spans of time and space; its number there, -1 for none.
function microscopeNearest(chart, tau, place, spanTau, spanXi, drift) {
  let best = -1, least = Infinity;
  for (let i = 0; i < chart.contacts.length; ++i) {
    const across = (chart.tau[i] - tau) / spanTau;
    if (Math.abs(across) > least) continue;
    const distance = Math.hypot(across, (chart.xi[i] - drift * chart.tau[i] - place) / spanXi);
    if (distance < least) {
      least = distance;
      best = i;
    }
  }
  return { best, distance: least };
}
