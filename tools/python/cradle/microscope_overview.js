// Replaces charts when there are very many collisions: a picture with one sample of a world line per column and the
// mean colour of the collisions in a pixel; and a strip that shows the depth of every collision, for navigation.

// The picture of a view in positions, as ImageData of width x height pixels: world lines in `ink` and collisions
// coloured by `value` over `range`. It takes at most about `budget` samples of lines, and of collisions. (Pixels are
// written as words, in the byte order of all machines that have a browser.)
function microscopeRaster(world, view, width, height, value, range, ink, budget, store) {
  if (!store.image || store.image.width !== width || store.image.height !== height) {
    Object.assign(store, { image: new ImageData(width, height), lines: new Float32Array(width * height),
                           tint: new Float32Array(width * height), count: new Float32Array(width * height) });
  }
  const { lines, tint, count, image } = store, { begin, time, x, velocity, slotTime, slotPlace } = world;
  lines.fill(0);
  tint.fill(0);
  count.fill(0);
  const { t: t0, x: x0 } = microscopeOrigin(world, view.anchor);
  const begins = t0 + view.tau - view.T / 2, speed = view.lab + view.V, perX = height / view.X;
  // The row of a position at a time: x in the view's frame.
  const row = (place, t) => height / 2 - (place - x0 - speed * (t - t0) - view.xi) * perX;
  const [lowest, highest] = microscopeVisible(world, view, row, height);
  const step = Math.max(1, Math.ceil((highest - lowest + 1) * width / budget));
  const perColumn = view.T / width;
  const firstColumn = Math.max(0, Math.ceil((world.start - begins) / perColumn));
  const lastColumn = Math.min(width - 1, Math.floor((world.end - begins) / perColumn));
  for (let particle = lowest; particle <= highest; particle += step) {
    const t1 = begins + firstColumn * perColumn, none = begin[particle], end = begin[particle + 1];
    const merger = microscopeMerger(world, particle), gone = merger < 0 ? Infinity : time[merger];
    let slot = microscopeFirst(none, end, k => slotTime[k] <= t1), before = NaN;
    for (let column = firstColumn; column <= lastColumn; ++column) {
      const t = begins + column * perColumn;
      while (slot < end && slotTime[slot] <= t) ++slot;
      if (t > gone) break;
      const last = slot - 1;
      const place = last < none ? world.x0[particle] + world.v0[particle] * (t - world.start)
                                : slotPlace[last] + velocity[last] * (t - slotTime[last]);
      const y = row(place, t), from = Math.min(before, y), to = Math.max(before, y);
      before = y;
      if (!(to - from > 1.5)) {
        const at = Math.floor(y), part = y - at;
        if (at >= 0 && at < height) lines[at * width + column] += 1 - part;
        if (at + 1 >= 0 && at + 1 < height) lines[(at + 1) * width + column] += part;
        continue;
      }
      for (let k = Math.max(0, Math.floor(from)), end_ = Math.min(height - 1, to); k <= end_; ++k)
        lines[k * width + column] += 1;
    }
  }
  const add = (column, row, share, logarithm) => {
    if (row < 0 || row >= height) return;
    count[row * width + column] += share;
    tint[row * width + column] += share * logarithm;
  };
  // Visible collisions, from the list sorted by time. Each is shared by two pixels, so that regular ones make no moiré.
  const first = microscopeFirstAfter(time, begins), last = microscopeFirstAfter(time, begins + view.T);
  const skip = Math.max(1, Math.ceil((last - first) / budget));
  for (let k = first; k < last; k += skip) {
    const column = Math.floor((time[k] - begins) / perColumn), y = row(x[k], time[k]), at = Math.floor(y);
    if (column < 0 || column >= width) continue;
    const below = skip * (y - at);
    add(column, at, skip - below, value[k]);
    add(column, at + 1, below, value[k]);
  }
  const crowd = Math.min(1, (highest - lowest) / height);
  microscopeTone(store, range, ink, step, 0.75 - 0.35 * crowd);
  return image;
}

// Converts sums to pixels: world lines in ink, up to `opacity`, and over them the mean colour of the collisions.
function microscopeTone({ image, lines, tint, count }, range, [red, green, blue], step, opacity) {
  const pixels = new Uint32Array(image.data.buffer), table = new Uint32Array(256);
  const scale = 255 / (range[1] - range[0]), low = range[0], paint = blue << 16 | green << 8 | red;
  for (let k = 0; k < 256; ++k) {
    const colour = microscopeColour(k / 255);
    table[k] = colour[2] << 16 | colour[1] << 8 | colour[0];
  }
  for (let k = 0; k < pixels.length; ++k) {
    const line = step * lines[k], met = count[k];
    const alpha = line > 0 ? opacity * line / (line + 0.6) : 0;
    if (met > 0.25) {
      const share = Math.max(0.95 * met / (met + 0.25), alpha), part = (tint[k] / met - low) * scale;
      pixels[k] = (255 * share) << 24 | table[part < 0 ? 0 : part > 255 ? 255 : part | 0];
    } else {
      pixels[k] = (255 * alpha) << 24 | paint;
    }
  }
}

// The range of the logarithms in a raster, weighted by area, not by the number of collisions; null if there are none.
function microscopeShown({ count, tint }) {
  const shown = [];
  for (let k = 0, skip = Math.max(1, Math.floor(count.length / 40000)); k < count.length; k += skip)
    if (count[k] > 0.3) shown.push(tint[k] / count[k]);
  if (shown.length < 20) return null;
  shown.sort((a, b) => a - b);
  return [shown[Math.floor(0.02 * shown.length)], shown[Math.floor(0.98 * shown.length)]];
}

// The first collision after a time.
const microscopeFirstAfter = (time, t) => microscopeFirst(0, time.length, k => time[k] <= t);

// The particles that are visible. While they keep their order some columns suffice, else all are needed.
function microscopeVisible(world, view, row, height) {
  if (!world.keepsOrder || world.ring) return [0, world.particles - 1];
  let lowest = world.particles - 1, highest = 0;
  const t0 = microscopeOrigin(world, view.anchor).t;
  for (let k = 0; k <= 24; ++k) {
    const t = microscopeClamp(t0 + view.tau + view.T * (k / 24 - 0.5), world.start, world.end);
    const collision = microscopeFirstAfter(world.time, t) - 1;
    const since = t - (collision < 0 ? world.start : world.time[collision]);
    // The number of particles left of the part shown at this row.
    const above = edge =>
      microscopeFirst(0, world.particles, k => row(microscopeState(world, k, collision, since).x, t) > edge);
    lowest = Math.min(lowest, above(1.2 * height));
    highest = Math.max(highest, above(-0.2 * height));
  }
  return [Math.max(0, lowest - 2), Math.min(world.particles - 1, highest + 2)];
}

// The strip: depth of collisions against their number, minimum and maximum of each column; the position of the view.
function microscopeStrip(pen, world, view, box, colours, store) {
  const { n, depth } = world, columns = Math.max(1, Math.floor(box.width));
  if (store.columns !== columns) {
    const deepest = new Int32Array(columns).fill(-1), high = new Float32Array(columns).fill(-Infinity);
    for (let e = 0; e < n; ++e) {
      if (depth[e] < -330) continue;  // two collisions within rounding
      const column = Math.min(columns - 1, Math.floor(e / n * columns));
      if (deepest[column] < 0 || depth[e] < depth[deepest[column]]) deepest[column] = e;
      if (depth[e] > high[column]) high[column] = depth[e];
    }
    const least = deepest.reduce((a, e) => e < 0 ? a : Math.min(a, depth[e]), 0);
    const most = high.reduce((a, b) => Math.max(a, b), -400);
    Object.assign(store, { columns, high, deepest, range: [Math.floor(least), Math.max(1, Math.ceil(most))] });
  }
  const [least, most] = store.range, y = value => box.top + box.height * (most - value) / (most - least);
  const step = microscopeStep(most - least, 3);
  pen.fillStyle = colours.text;
  for (let value = Math.ceil(least / step) * step; value <= most; value += step) {
    const at = Math.round(y(value)) + 0.5, label = value === 0 ? "1" : microscopePower(Math.round(value));
    microscopeStroke(pen, colours.grid, 1, [[[box.left, at], [box.left + box.width, at]]]);
    microscopeText(pen, "right", "middle", label, box.left - 6, at);
  }
  pen.fillStyle = colours.line;
  for (let column = 0; column < columns; ++column)
    if (store.deepest[column] >= 0)
      pen.fillRect(box.left + column, y(store.high[column]) - 0.75, Math.max(1, 1.2 * columns / n),
                   Math.max(1.5, y(depth[store.deepest[column]]) - y(store.high[column])));
  // The position of the view: its collision and its span of space.
  const at = box.left + box.width * Math.max(0, view.anchor.e + 0.5) / n;
  const level = microscopeClamp(y(Math.log10(view.X)), box.top, box.top + box.height);
  microscopeStroke(pen, colours.accent, 1, [[[box.left, level], [box.left + box.width, level]],
                                            [[at, box.top], [at, box.top + box.height]]]);
  pen.fillStyle = colours.accent;
  pen.beginPath();
  pen.arc(at, level, 3.5, 0, 7);
  pen.fill();
  pen.strokeStyle = colours.frame;
  pen.strokeRect(box.left + 0.5, box.top + 0.5, box.width - 1, box.height - 1);
  pen.fillStyle = colours.text;
  microscopeText(pen, "center", "top", `gap that closes, in l, in each of ${n} collisions`,
                 box.left + box.width / 2, box.top + box.height + 5);
}
