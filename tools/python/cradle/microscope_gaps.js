// Gaps and the order of the particles right after any collision (see microscope_world.js).

const MICROSCOPE_STEPS = 20000;  // the most collisions that are searched for a gap

// Gap and closing speed of neighbours a (left) and b right after collision e (-1: the start), and `path`, the change of
// the gap since or until the collision from which it is known: the rounding error of the gap is 1e-16 path.
function microscopeRelative(world, a, b, e) {
  const past = microscopeKnownFrom(world, a, b, e, -1);
  if (past && past.path === 0) return past;
  const future = microscopeKnownFrom(world, a, b, e, 1);
  if (past && future) return past.path <= future.path ? past : future;
  if (past || future) return past || future;
  const [left, right] = [a, b].map(particle => microscopeState(world, particle, e));
  return { gap: Math.max(0, microscopeAhead(world, right.x - left.x)), path: Infinity, w: left.v - right.v };
}

// The distance to the right; on a ring, particles behind are also ahead.
const microscopeAhead = ({ ring }, distance) => ring ? distance - ring * Math.floor(distance / ring) : distance;

// The same from the last collision of the two with each other until e, or the start (step -1), or from their next one
// (step 1); null if there is none, or if they have too many with others between.
function microscopeKnownFrom(world, a, b, e, step) {
  const { list, begin } = world, kicks = [], none = step < 0 ? -1 : Infinity;
  const slotOf = particle => microscopeSlotAfter(world, particle, e) - (step < 0 ? 1 : 0);
  const at = (particle, slot) => slot < begin[particle] || slot >= begin[particle + 1] ? none : list[slot];
  let i = slotOf(a), j = slotOf(b), met = none;
  for (;;) {
    const ofA = at(a, i), ofB = at(b, j);
    if (ofA === ofB) {
      met = ofA;
      break;
    }
    if (kicks.length >= MICROSCOPE_STEPS) return null;
    const isA = step * ofA < step * ofB, [next, particle] = isA ? [ofA, a] : [ofB, b];
    kicks.push([next, isA ? microscopeKick(world, a, next) : -microscopeKick(world, b, next)]);
    if (isA) i += step; else j += step;
    if (step > 0 && microscopeMerger(world, particle) === next) {
      // The particle that it merged into replaces it.
      const heir = microscopeOther(world, particle, next), slot = microscopeSlotAfter(world, heir, next);
      if (isA) { a = heir; i = slot; } else { b = heir; j = slot; }
    }
  }
  if (met === Infinity) return null;
  let gap = 0, w = 0;
  if (met >= 0) {
    w = (world.left[met] === a ? 1 : -1) * (step < 0 ? world.after : world.speed)[met];
  } else if (b === a + 1 || (world.ring && b === 0 && a === world.particles - 1)) {
    gap = world.gap0[a];
    w = world.w0[a];
  } else {
    gap = microscopeAhead(world, world.x0[b] - world.x0[a]);
    w = world.v0[a] - world.v0[b];
  }
  let path = met < 0 && !kicks.length && e < 0 ? 0 : gap, from = met;
  for (const [until, kick] of [...kicks.reverse(), [e, 0]]) {  // on to e
    const change = w * microscopeBetween(world, from, until);
    gap -= change;
    path += Math.abs(change);
    w -= step * kick;
    from = until;
  }
  return { gap, w, path };
}

// Position and velocity of a particle in the lab, `since` after collision e, with the accuracy of positions: {x, v}.
function microscopeState(world, particle, e, since = 0) {
  const slot = microscopeSlotAfter(world, particle, e) - 1, none = slot < world.begin[particle];
  const [last, x, v] = none ? [-1, world.x0[particle], world.v0[particle]]
                            : [world.list[slot], world.slotPlace[slot], world.velocity[slot]];
  return { x: x + v * microscopeFlight(world, last, e) + v * since, v };
}

// The mass of a particle right after collision e.
function microscopeMass(world, particle, e) {
  const slot = microscopeSlotAfter(world, particle, e) - 1;
  return slot < world.begin[particle] ? world.mass0[particle] : world.slotMass[slot];
}

// The order of the particles right after collision e: {next, previous}, of each particle, -1 beyond the ends. If
// particles merge or pass, the links of the last order are changed to this one, and the last one is no longer valid.
function microscopeOrder(world, e) {
  const { particles, ring, keepsOrder } = world, links = link => Int32Array.from({ length: particles }, link);
  const order = world.order ||= { e: -1, next: links((_, i) => i + 1 < particles ? i + 1 : ring ? 0 : -1),
                                  previous: links((_, i) => i > 0 ? i - 1 : ring ? particles - 1 : -1) };
  while (!keepsOrder && order.e < e) microscopeRelink(world, ++order.e, order, true);
  while (!keepsOrder && order.e > e) microscopeRelink(world, order.e--, order, false);
  return order;
}

// Makes the links those right after collision e from those right before it, or the other way round.
function microscopeRelink(world, e, { next, previous }, forwards) {
  const link = (l, r) => {
    if (l >= 0) next[l] = r;
    if (r >= 0) previous[r] = l;
  };
  if (world.event[e] === MICROSCOPE.pass) {
    const [a, b] = forwards ? [world.left[e], world.right[e]] : [world.right[e], world.left[e]];
    const before = previous[a], behind = next[b];
    link(before === b ? a : before, b);
    link(b, a);
    link(a, behind === a ? b : behind);
  } else if (world.event[e] === MICROSCOPE.merge) {
    const gone = microscopeGone(world, e), before = previous[gone], behind = next[gone];  // which it keeps
    if (forwards) return link(before, behind);
    link(before, gone);
    link(gone, behind);
  }
}
