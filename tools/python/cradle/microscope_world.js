// The microscope's world: collisions and initial state of a run, and coordinates that are exact at any depth.
//
// Nothing here is a difference of positions. A gap is the integral of the closing speed from a collision of its two
// particles: the one with the shorter path. A time is the sum of intervals between collisions. A position in a chart
// (microscope_chart.js) is the sum of such gaps from the anchor of the chart. So doubles are precise down to 1e-308.

const microscopeTypes = { f8: Float64Array, u1: Uint8Array, u2: Uint16Array, u4: Uint32Array };
// The kinds of collisions: by the law, elastic, a merge (numbered as `kind` in results), or a passage by the law.
const MICROSCOPE = { byLaw: 0, elastic: 1, merge: 2, pass: 3 };

// The typed array of {type, length, deflate}: byte planes, deflated, as base64; null if there is none.
async function microscopeArray(packed) {
  if (!packed) return null;
  const deflated = await fetch(`data:application/octet-stream;base64,${packed.deflate}`);
  const stream = deflated.body.pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const Type = microscopeTypes[packed.type], size = Type.BYTES_PER_ELEMENT, n = packed.length;
  if (planes.length !== n * size) throw new Error(`microscope: an array is incomplete (${planes.length} bytes)`);
  const bytes = new Uint8Array(n * size);
  for (let plane = 0; plane < size; ++plane)
    for (let i = 0, from = plane * n; i < n; ++i) bytes[i * size + plane] = planes[from + i];
  return new Type(bytes.buffer);
}

// The world for data of kind "collisions".
async function microscopeCollisions(data) {
  const names = ["x", "v", "gap", "mass", "left", "right", "interval", "speed", "event"];
  const [x0, v0, gap0, mass, left, right, interval, speed, event] = await Promise.all(
    names.map(name => microscopeArray(data[name])));
  const n = interval.length, particles = x0.length;
  const world = {
    n, particles, x0, v0, gap0, mass0: mass, left, interval, law: data.law, first: data.first, ring: data.length,
    start: data.start, total: data.total, digits: data.digits, collapse: data.collapse, speed,
    right: right || left.map(particle => particle + 1 === particles && data.length ? 0 : particle + 1),
    event: event || new Uint8Array(n), index: null, valid: null,
    w0: gap0.map((_, particle) => v0[particle] - v0[particle + 1 < particles ? particle + 1 : 0]),
  };
  microscopeReplay(world);
  world.end = data.end === null || n === 0 ? world.time[n - 1] : Math.max(data.end, world.time[n - 1]);
  return world;
}

// The world at a snapshot: it has no collisions, and world lines are known until the next one (`valid`, by particle).
async function microscopeSnapshot(data, snapshot) {
  const names = ["gap", "speed", "mass", "index"];
  const [gap, w, mass, index] = await Promise.all(names.map(name => microscopeArray(snapshot[name])));
  const particles = snapshot.particles, x0 = new Float64Array(particles), v0 = new Float64Array(particles);
  const valid = new Float64Array(particles).fill(Infinity);
  x0[0] = snapshot.x;
  v0[0] = snapshot.v;
  for (let particle = 0; particle + 1 < particles; ++particle) {
    x0[particle + 1] = x0[particle] + gap[particle];
    v0[particle + 1] = v0[particle] - w[particle];
    const due = w[particle] > 0 ? gap[particle] / w[particle] : Infinity;
    valid[particle] = Math.min(valid[particle], due);
    valid[particle + 1] = due;
  }
  const none = new Float64Array(0), world = {
    n: 0, particles, x0, v0, gap0: gap, w0: w, mass0: mass, left: none, right: none, interval: none, speed: none,
    event: none, ring: 0, law: data.law, first: snapshot.first, index, valid, start: snapshot.time, total: 0, digits: 9,
    collapse: false,
  };
  microscopeReplay(world);
  // The time until which nine in ten of the world lines are known.
  const known = valid.filter(Number.isFinite).sort();
  world.end = snapshot.time + (known.length ? known[Math.floor(0.9 * (known.length - 1))] : 1);
  return world;
}

// Replays the collisions once: times (as unevaluated sums), positions, velocities, the effect of each collision, and
// the collisions of each particle: particle b has list[begin[b]] .. list[begin[b + 1] - 1]; collision e has the slots
// slotLeft[e] (left particle) and slotRight[e] there. Of each slot the time, and place, velocity and mass right after.
function microscopeReplay(world) {
  const { n, particles, left, right, speed, event, interval, law, ring } = world;
  const begin = new Int32Array(particles + 1), list = new Int32Array(2 * n);
  for (let e = 0; e < n; ++e) { ++begin[left[e] + 1]; ++begin[right[e] + 1]; }
  for (let particle = 0; particle < particles; ++particle) begin[particle + 1] += begin[particle];
  const fill = begin.slice(), slotLeft = new Int32Array(n), slotRight = new Int32Array(n);
  // ofLeft, ofRight: shares of the two in their mass.
  const [time, low, x, after, ofLeft, ofRight] = Array.from({ length: 6 }, () => new Float64Array(n));
  const depth = new Float32Array(n), lost = new Float32Array(n);
  const [slotTime, slotPlace, velocity, slotMass] = Array.from({ length: 4 }, () => new Float64Array(2 * n));
  world.mass0 ||= new Float64Array(particles).fill(1);
  const mass = world.mass0.slice(), v = world.v0.slice(), place = world.x0.slice();
  const since = new Float64Array(particles).fill(world.start), sinceLow = new Float64Array(particles);
  Object.assign(world, { begin, list, slotLeft, slotRight, time, low, x, after, ofLeft, ofRight, depth, velocity,
                         slotTime, slotPlace, slotMass, lost,
                         keepsOrder: law.type === "inelastic" && !event.includes(MICROSCOPE.merge) });
  let t = world.start, rest = 0;
  for (let e = 0; e < n; ++e) {
    const a = left[e], b = right[e], sum = t + interval[e], gained = sum - t;
    rest += (t - (sum - gained)) + (interval[e] - gained);
    t = sum + rest;
    rest -= t - sum;
    time[e] = t;
    low[e] = rest;
    const w = speed[e], total = mass[a] + mass[b];
    let out = 0;
    if (event[e] === MICROSCOPE.elastic) out = -w;
    else if (event[e] !== MICROSCOPE.merge && law.type !== "wet") out = -law.restitution * w;
    else if (event[e] !== MICROSCOPE.merge) {
      const critical = Math.sqrt(2 * law.loss * total / (mass[a] * mass[b]));
      event[e] = MICROSCOPE.pass;
      out = Math.sqrt(Math.max(0, (w - critical) * (w + critical)));
    }
    after[e] = out;  // velocity of the particle that came from the left, minus the other's
    ofLeft[e] = mass[a] / total;
    ofRight[e] = mass[b] / total;
    lost[e] = microscopeLog(mass[a] * ofRight[e] / 2 * (w - out)) + microscopeLog(w + out);
    const flownLeft = (t - since[a]) + (rest - sinceLow[a]), flownRight = (t - since[b]) + (rest - sinceLow[b]);
    const fromLeft = place[a] + v[a] * flownLeft, fromRight = place[b] + v[b] * flownRight;
    const around = ring ? Math.round((fromRight - fromLeft) / ring) : 0;
    x[e] = (fromLeft + (fromRight - around * ring)) / 2;
    place[a] = x[e];
    place[b] = x[e] + around * ring;
    if (event[e] === MICROSCOPE.merge) mass[a] = mass[b] = total;
    slotLeft[e] = fill[a]++;
    slotRight[e] = fill[b]++;
    for (const [particle, slot] of [[a, slotLeft[e]], [b, slotRight[e]]]) {
      list[slot] = e;
      since[particle] = slotTime[slot] = t;
      sinceLow[particle] = rest;
      velocity[slot] = v[particle] += microscopeKick(world, particle, e);
      slotPlace[slot] = place[particle];
      slotMass[slot] = mass[particle];
    }
    // The depth: the gap that has closed since one of the two had its last collision.
    const before = Math.max(slotLeft[e] > begin[a] ? list[slotLeft[e] - 1] : -1,
                            slotRight[e] > begin[b] ? list[slotRight[e] - 1] : -1);
    depth[e] = microscopeLog(w) + microscopeLog(microscopeFlight(world, before, e));
  }
}

const microscopeLog = x => x > 0 ? Math.log10(x) : -400;
const microscopeClamp = (x, low, high) => Math.min(high, Math.max(low, x));

// The time from right after collision i (-1: the start) to collision j >= i.
function microscopeFlight(world, i, j) {
  if (j <= i) return 0;
  if (i < 0) return (world.time[j] - world.start) + world.low[j];
  const difference = (world.time[j] - world.time[i]) + (world.low[j] - world.low[i]);
  // The sums are accurate to 1e-32 of the time; for shorter differences the sum of intervals is more accurate.
  if (difference > 1e-22 * Math.abs(world.time[j])) return difference;
  let sum = 0;
  for (let k = i + 1; k <= j; ++k) sum += world.interval[k];
  return sum;
}

// The first of low .. high - 1 for which `before` is false, as for all later ones; high if there is none.
function microscopeFirst(low, high, before) {
  while (low < high) {
    const middle = (low + high) >> 1;
    if (before(middle)) low = middle + 1; else high = middle;
  }
  return low;
}

// The slot of the first collision of a particle after collision e.
const microscopeSlotAfter = ({ begin, list }, particle, e) =>
  microscopeFirst(begin[particle], begin[particle + 1], slot => list[slot] <= e);

// Time and position of an anchor in the lab.
const microscopeOrigin = (world, { e, a }) =>
  e < 0 ? { t: world.start, x: world.x0[a] } : { t: world.time[e], x: world.x[e] };

// The other particle of a collision, and the change of a particle's velocity in a collision.
const microscopeOther = (world, particle, e) => world.left[e] === particle ? world.right[e] : world.left[e];
const microscopeKick = ({ left, speed, after, ofLeft, ofRight }, particle, e) =>
  left[e] === particle ? (after[e] - speed[e]) * ofRight[e] : (speed[e] - after[e]) * ofLeft[e];
// The particle that disappears in a merger: the lighter one or, of two equal ones, the right one.
const microscopeGone = (world, e) => world.ofRight[e] > 0.5 ? world.left[e] : world.right[e];
// The collision in which a particle disappears; -1 if there is none.
function microscopeMerger(world, particle) {
  const slot = world.begin[particle + 1] - 1, last = slot < world.begin[particle] ? -1 : world.list[slot];
  return last >= 0 && world.event[last] === MICROSCOPE.merge && microscopeGone(world, last) === particle ? last : -1;
}
