// Gaps and the order of the bodies right after any contact (see microscope_world.js).

const MICROSCOPE_STEPS = 20000;  // contacts that are gone through at most to find a gap

// Gap and closing speed of neighbours a (left) and b right after contact e (-1: the start), and by how much `path` the
// gap changed since or until the contact that it is known from: its rounding is 1e-16 of that.
function microscopeRelative(world, a, b, e) {
  const past = microscopeFromPast(world, a, b, e);
  if (past && past.path === 0) return past;
  const future = microscopeFromFuture(world, a, b, e);
  if (past && future) return past.path <= future.path ? past : future;
  if (past || future) return past || future;
  const apart = microscopeAhead(world, microscopePlace(world, b, e) - microscopePlace(world, a, e));
  return { gap: Math.max(0, apart), path: Infinity,
           w: microscopeVelocity(world, a, e) - microscopeVelocity(world, b, e) };
}

// A distance to the right: on a ring, what is behind is also ahead.
function microscopeAhead({ ring }, distance) {
  return ring ? distance - ring * Math.floor(distance / ring) : distance;
}

function microscopeFromPast(world, a, b, e) {
  const { list, begin } = world, kicks = [];
  let i = microscopeSlotAfter(world, a, e) - 1, j = microscopeSlotAfter(world, b, e) - 1, from = -1;
  let gap = 0, w = 0;
  for (;;) {
    const ofA = i >= begin[a] ? list[i] : -1, ofB = j >= begin[b] ? list[j] : -1;
    if (ofA === ofB) {
      from = ofA;
      break;
    }
    if (kicks.length >= MICROSCOPE_STEPS) return null;
    if (ofA > ofB) kicks.push([ofA, microscopeKick(world, a, list[i--])]);
    else kicks.push([ofB, -microscopeKick(world, b, list[j--])]);
  }
  if (from >= 0) {
    w = world.left[from] === a ? world.after[from] : -world.after[from];
  } else if (b === a + 1 || (world.ring && b === 0 && a === world.bodies - 1)) {
    gap = world.gap0[a];
    w = world.w0[a];
  } else {
    gap = microscopeAhead(world, world.x0[b] - world.x0[a]);
    w = world.v0[a] - world.v0[b];
  }
  let path = gap, at = from;
  const fly = until => {
    const change = w * microscopeFlight(world, at, until);
    gap -= change;
    path += Math.abs(change);
    at = until;
  };
  for (let k = kicks.length - 1; k >= 0; --k) {
    fly(kicks[k][0]);
    w += kicks[k][1];
  }
  if (from < 0 && !kicks.length && e < 0) path = 0;
  fly(e);
  return { gap, w, path };
}

function microscopeFromFuture(world, a, b, e) {
  const { list, begin } = world, kicks = [];
  let i = microscopeSlotAfter(world, a, e), j = microscopeSlotAfter(world, b, e), w = 0, at = -1;
  for (;;) {
    const ofA = i < begin[a + 1] ? list[i] : Infinity, ofB = j < begin[b + 1] ? list[j] : Infinity;
    if (ofA === ofB) {
      if (ofA === Infinity) return null;
      at = ofA;
      w = world.left[at] === a ? world.speed[at] : -world.speed[at];
      break;
    }
    if (kicks.length >= MICROSCOPE_STEPS) return null;
    const next = Math.min(ofA, ofB), isA = ofA < ofB, body = isA ? a : b;
    kicks.push([next, isA ? microscopeKick(world, a, next) : -microscopeKick(world, b, next)]);
    if (isA) ++i; else ++j;
    if (world.event[next] === MICROSCOPE.merge && microscopeGone(world, next) === body) {
      // What it merged into goes on in its place.
      const heir = microscopeOther(world, body, next), slot = microscopeSlotAfter(world, heir, next);
      if (isA) { a = heir; i = slot; } else { b = heir; j = slot; }
    }
  }
  let gap = 0, path = 0;
  const fly = from => {
    const change = w * microscopeFlight(world, from, at);
    gap += change;
    path += Math.abs(change);
    at = from;
  };
  for (let k = kicks.length - 1; k >= 0; --k) {
    fly(kicks[k][0]);
    w -= kicks[k][1];
  }
  fly(e);
  return { gap, w, path };
}

// Place and velocity of a body right after contact e, in the lab: as good as positions are.
function microscopePlace(world, body, e) {
  const slot = microscopeSlotAfter(world, body, e) - 1;
  if (slot < world.begin[body]) return world.x0[body] + world.v0[body] * microscopeFlight(world, -1, e);
  const last = world.list[slot], turned = world.ring && world.right[last] === body ? world.turn[last] * world.ring : 0;
  return world.x[last] + turned + world.velocity[slot] * microscopeFlight(world, last, e);
}
function microscopeVelocity(world, body, e) {
  const slot = microscopeSlotAfter(world, body, e) - 1;
  return slot < world.begin[body] ? world.v0[body] : world.velocity[slot];
}

// Mass of a body right after contact e.
function microscopeMass(world, body, e) {
  if (!world.share) return 1;
  if (world.keepsOrder) return world.mass0[body];
  let mass = world.mass0 ? world.mass0[body] : 1;
  // The mass follows from the share that the body has in the impulse at its next contact, or at its last one.
  for (let slot = world.begin[body]; slot < world.begin[body + 1] && world.list[slot] <= e; ++slot) {
    const contact = world.list[slot];
    if (world.event[contact] !== MICROSCOPE.merge) continue;
    const own = world.left[contact] === body ? 1 - world.share[contact] : world.share[contact];
    mass /= own;
  }
  return mass;
}

// The order of the bodies right after contact e: {next, previous}, functions of a body, -1 beyond the ends. Where
// bodies merge or pass, it is made anew from the nearest of some orders that are kept.
function microscopeOrder(world, e) {
  const { bodies, ring } = world;
  if (world.keepsOrder)
    return { next: body => body + 1 < bodies ? body + 1 : ring ? 0 : -1,
             previous: body => body > 0 ? body - 1 : ring ? bodies - 1 : -1 };
  if (!world.orders) {
    const next = Int32Array.from({ length: bodies }, (_, i) => i + 1 < bodies ? i + 1 : ring ? 0 : -1);
    const previous = Int32Array.from({ length: bodies }, (_, i) => i > 0 ? i - 1 : ring ? bodies - 1 : -1);
    world.stride = Math.max(1024, Math.ceil(world.n * bodies / 8e6));
    world.orders = [[next, previous]];
  }
  const wanted = Math.floor((e + 1) / world.stride);
  while (world.orders.length <= wanted) {
    const done = world.orders.length - 1, [next, previous] = world.orders[done].map(links => links.slice());
    for (let k = done * world.stride; k < (done + 1) * world.stride; ++k) microscopeRelink(world, k, next, previous);
    world.orders.push([next, previous]);
  }
  const [next, previous] = world.orders[wanted].map(links => links.slice());
  for (let k = wanted * world.stride; k <= e; ++k) microscopeRelink(world, k, next, previous);
  return { next: body => next[body], previous: body => previous[body] };
}

function microscopeRelink(world, e, next, previous) {
  const a = world.left[e], b = world.right[e];
  const link = (l, r) => {
    if (l >= 0) next[l] = r;
    if (r >= 0) previous[r] = l;
  };
  if (world.event[e] === MICROSCOPE.pass) {
    const before = previous[a], behind = next[b];
    link(before === b ? a : before, b);
    link(b, a);
    link(a, behind === a ? b : behind);
  } else if (world.event[e] === MICROSCOPE.merge) {
    const gone = microscopeGone(world, e);
    link(previous[gone], next[gone]);
  }
}
