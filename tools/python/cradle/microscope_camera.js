// The camera: the view. It pans and zooms, and moves its anchor to a visible collision, so that all that is drawn is
// near the anchor in units of the picture. Spans of time and of space are zoomed separately or together; together, the
// span of space follows the motion of the particles around the middle during the span of time.

function microscopeCamera(world) {
  const camera = { world, chart: null, built: null }, limits = { T: 0, X: 0 };

  camera.home = () => {
    const span = Math.max(world.end - world.start, Number.MIN_VALUE);
    const low = world.x.reduce((least, x) => Math.min(least, x), world.x0[0]);
    const high = world.x.reduce((most, x) => Math.max(most, x), world.x0[world.particles - 1]);
    const anchor = world.n ? { e: 0, a: world.left[0] } : { e: -1, a: Math.floor((world.particles - 1) / 2) };
    const { t, x } = microscopeOrigin(world, anchor), lab = microscopeAnchor(world, anchor).lab;
    limits.T = 1.06 * span;
    limits.X = 1.08 * (high - low) || 1;
    camera.view = { anchor, lab, tau: (world.start + world.end) / 2 - t, xi: (low + high) / 2 - x, T: limits.T,
                    X: limits.X, V: -lab };
    camera.settle();
  };

  // Moves to collision e, with given spans. The frame moves with the particles there if the lab's would tilt them.
  camera.goTo = (e, T, X) => {
    const anchor = { e, a: world.left[e] };
    // If the run ends soon after, the end is at four fifths of the picture.
    const ends = microscopeFlight(world, e, world.n - 1) + Math.max(0, world.end - world.time[world.n - 1]);
    const tau = Math.min(0, ends - 0.3 * T);
    camera.view = { anchor, lab: microscopeAnchor(world, anchor).lab, tau, xi: 0, T, X, V: 0 };
    camera.chart = null;
    camera.settle();
    camera.view.V = camera.frame();
    camera.settle();
  };

  // The span of space of the motion around collision e, of up to three more on either side, during a span of time.
  camera.natural = (e, T) => {
    if (e < 0) return T * limits.X / limits.T;
    let X = 1.3 * T * Math.max(world.speed[e], Math.abs(world.after[e]));
    const around = microscopeAround(world, { e, a: world.left[e] }, -1, [3, 3]);
    for (const side of [around.filter(({ xi }) => xi > 0), around.filter(({ xi }) => xi < 0).reverse()])
      for (const { xi, u } of side) {
        if (Math.abs(xi) > X) break;
        X = Math.max(X, 2.4 * Math.abs(xi) + Math.abs(u) * T / 2);
      }
    return Math.min(X, limits.X);
  };

  // The velocity of the frame that suits the view: the lab's while tilts are small, else that of the centre of mass of
  // the visible particles at the anchor, which collisions among them do not change.
  camera.frame = () => {
    const { view, chart } = camera;
    let momentum = 0, mass = 0;
    for (const { particle, xi, u } of chart ? chart.around : []) {
      if (Math.abs(xi) > view.X / 2) continue;
      const m = microscopeMass(world, particle, view.anchor.e);
      momentum += m * u;
      mass += m;
    }
    const local = mass > 0 ? momentum / mass : 0, tilt = Math.abs(view.lab + local) * view.T / view.X;
    return local + (tilt <= 0.5 ? 1 : (0.5 / tilt) ** 2) * (-view.lab - local);
  };

  // Zooms time and space by factors (in, if larger than 1) about a point [tau, xi] of the picture, in the view's frame.
  camera.zoom = (byTime, bySpace, pivot, follow) => {
    const view = camera.view, [tau, xi] = pivot;
    let T = view.T / byTime, X = view.X / bySpace;
    if (follow) X = follow(T, view.X);
    T = microscopeClamp(T, 1e-303, 4 * limits.T);
    X = microscopeClamp(X, 1e-303, 4 * limits.X);
    // At a closer zoom there are only straight lines, and the offset from the anchor would lose its digits.
    if (T < 1e-9 * Math.abs(view.tau) || X < 1e-9 * Math.abs(view.xi)) return;
    view.tau = tau + (view.tau - tau) * (T / view.T);
    view.xi = xi + (view.xi - xi) * (X / view.X);
    const change = Math.abs(Math.log(T / view.T));
    view.T = T;
    view.X = X;
    const old = view.V;
    view.V += (camera.frame() - old) * (1 - Math.exp(-1.5 * change));
    view.xi += (old - view.V) * tau;
    camera.settle();
  };

  // The span of space for a new span of time: on zooming in it tends to the natural one at collision e; on zooming out
  // it tends (linearly in logarithms) to the whole picture.
  camera.follow = e => (T, X) => {
    const change = Math.log(T / camera.view.T);
    if (change > 0) {
      const far = Math.log(limits.T / camera.view.T), out = Math.log(limits.X / X);
      return X * Math.exp(far > change && out > 0 ? change * out / far : change);
    }
    const wanted = Math.log(camera.natural(e, T) / X) - change;
    return X * Math.exp(change + microscopeClamp(0.3 * wanted, 0.9 * change, -0.9 * change));
  };

  // The collision that sets the span of space for the visible span of time: near a point, but not so near that it
  // belongs to the next scale of a collapse.
  camera.guide = ([tau, xi]) => {
    const { view, chart } = camera, found = !chart ? camera.nearestToMiddle() : camera.least((t, x) => {
      const apart = Math.abs(t - tau) / view.T;
      return Math.hypot(apart, (x - xi) / view.X) + (apart < 0.1 ? 10 : 0);
    });
    return found?.e ?? view.anchor.e;
  };

  camera.pan = (byTime, bySpace) => {
    camera.view.tau += byTime;
    camera.view.xi += bySpace;
    camera.settle();
  };

  // Makes a new chart if this one no longer suits; moves an anchor that is out of sight to the collision in the middle.
  camera.settle = () => {
    camera.chartFor();
    const { view } = camera;
    if (Math.abs(view.tau) < 0.75 * view.T && Math.abs(view.xi) < 0.75 * view.X) return;
    const to = camera.nearestToMiddle();
    if (!to || to.e === view.anchor.e || to.distance >= 0.98 * Math.hypot(view.tau / view.T, view.xi / view.X)) return;
    camera.reanchor(to);
  };

  // The collisions of the chart; without one, in positions, those around the middle of the view.
  camera.collisions = () => {
    if (camera.chart) return camera.chart;
    const { anchor, tau: ahead, lab } = camera.view, { t, x } = microscopeOrigin(world, anchor);
    const middle = microscopeFirstAfter(world.time, t + ahead), begin = Math.max(0, middle - 3000);
    const collisions = Int32Array.from(world.time.slice(begin, middle + 3000), (_, i) => begin + i);
    const tau = Float64Array.from(collisions, k => microscopeBetween(world, anchor.e, k));
    return { collisions, tau, xi: tau.map((after, i) => world.x[collisions[i]] - x - lab * after) };
  };
  // {e, tau, xi, distance} of the one with the least cost(tau, xi in the view's frame, e); null if none is finite.
  camera.least = cost => {
    const { collisions, tau, xi } = camera.collisions(), { V } = camera.view;
    let best = null, least = Infinity;
    collisions.forEach((e, i) => {
      const distance = cost(tau[i], xi[i] - V * tau[i], e);
      if (distance < least) [best, least] = [{ e, tau: tau[i], xi: xi[i], distance }, distance];
    });
    return best;
  };
  // The one nearest to a point, in spans of time and space.
  camera.nearest = (tau, xi, spanTau, spanXi) =>
    camera.least((t, x) => Math.hypot((t - tau) / spanTau, (x - xi) / spanXi));
  camera.nearestToMiddle = () => camera.nearest(camera.view.tau, camera.view.xi, camera.view.T, camera.view.X);
  // The deepest collision near a point, within given parts of the picture. It stays in place on zooming in, so that the
  // wheel over the tip of a collapse follows it.
  camera.deepest = ([tau, xi], partOfT, partOfX) => {
    const { T, X } = camera.view;
    return camera.least((t, x, e) =>
      Math.abs(t - tau) > partOfT * T || Math.abs(x - xi) > partOfX * X ? Infinity : world.depth[e]);
  };

  // Keeps the picture but makes another collision, at (tau, xi), the anchor.
  camera.reanchor = ({ e, tau, xi }) => {
    const { view, chart } = camera, anchor = { e, a: world.left[e] }, pair = microscopeAnchor(world, anchor);
    // The velocity of the new pair's frame in the old one: in the chart that of one of its particles right after the
    // collision, minus the velocity of this particle relative to the pair; or from the lab if there is no chart.
    const [line, at] = chart ? microscopeThrough(chart, pair.a, e) : [];
    const u = chart ? line.speeds[at] - pair.speedA : pair.lab - view.lab;
    camera.view = { anchor, lab: pair.lab, T: view.T, X: view.X, V: view.V - u,
                    tau: view.tau - tau, xi: view.xi - (xi - view.V * tau) };
    camera.chart = null;
    camera.chartFor();
  };

  // Whether collisions are far too many for a chart: a quick estimate from positions; false if these do not resolve it.
  camera.crowded = () => {
    const { view } = camera, { t: t0, x: x0 } = microscopeOrigin(world, view.anchor);
    if (!world.n || !world.keepsOrder || world.ring || view.X < 1e-6 * limits.X) return false;
    const row = (place, t) => 0.5 - (place - x0 - (view.lab + view.V) * (t - t0) - view.xi) / view.X;
    const [lowest, highest] = microscopeVisible(world, view, row, 1), { slotTime, begin } = world;
    const before = (particle, t) =>  // slots of the particle before t
      microscopeFirst(begin[particle], begin[particle + 1], slot => slotTime[slot] < t);
    let count = 0;
    for (let particle = lowest; particle <= highest && count < 2 * MICROSCOPE_CHART.collisions; ++particle)
      count += before(particle, t0 + view.tau + view.T / 2) - before(particle, t0 + view.tau - view.T / 2);
    return count >= MICROSCOPE_CHART.collisions / 4;  // a chart extends over nine times the visible area
  };

  camera.chartFor = () => {
    const { view, chart, built } = camera;
    const early = view.tau - view.T / 2, late = view.tau + view.T / 2;
    const low = view.xi - view.X / 2, high = view.xi + view.X / 2;
    // The shear between this frame and that of the chart, over the picture.
    const shear = built ? Math.abs(view.V - built.V) * (Math.abs(view.tau) + view.T / 2) : 0;
    if (built && built.anchor.e === view.anchor.e && built.anchor.a === view.anchor.a && built.early <= early &&
        built.late >= late && built.low <= low - shear && built.high >= high + shear &&
        (chart ? view.T > built.T / 20 : view.T > built.T / 1.5))
      return;
    camera.built = { anchor: view.anchor, early: view.tau - 1.5 * view.T, late: view.tau + 1.5 * view.T, T: view.T,
                     low: view.xi - 1.5 * view.X, high: view.xi + 1.5 * view.X, V: view.V };
    camera.chart = camera.crowded() ? null : microscopeChart(world, camera.built);
  };

  camera.home();
  return camera;
}

// The signed time from collision i to collision j.
const microscopeBetween = (world, i, j) =>
  i <= j ? microscopeFlight(world, i, j) : -microscopeFlight(world, j, i);

// The position of a line at tau.
function microscopeAlong(chart, line, tau) {
  const { points, from, to } = line, next = microscopeFirst(0, points.length, i => chart.tau[points[i]] <= tau);
  const point = i => [chart.tau[points[i]], chart.xi[points[i]]];
  const before = next > 0 ? point(next - 1) : from, behind = next < points.length ? point(next) : to;
  const span = behind[0] - before[0];
  return span > 0 ? before[1] + (behind[1] - before[1]) * ((tau - before[0]) / span) : before[1];
}
