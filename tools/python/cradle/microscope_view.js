// Drawing: world lines and collisions of a chart, and axes with labels for any depth.
//
// The view is {anchor, lab, tau, xi, T, X, V}: the middle of the picture at tau after the anchor's collision and xi
// from it, its spans of time and space, the velocity V of its frame in the anchor's, and that of this in the lab.

const MICROSCOPE_MARGIN = { left: 72, right: 14, top: 12, bottom: 42, strip: 92 };
const MICROSCOPE_PALETTE = [[58, 82, 164], [41, 138, 171], [86, 175, 128], [226, 170, 52], [214, 73, 58]];

// Colour from the palette at 0 .. 1: [red, green, blue].
function microscopeColour(part) {
  const at = microscopeClamp(part, 0, 0.9999) * (MICROSCOPE_PALETTE.length - 1), k = Math.floor(at);
  return MICROSCOPE_PALETTE[k].map((c, i) => Math.round(c + (at - k) * (MICROSCOPE_PALETTE[k + 1][i] - c)));
}

// A number such as 2.5e-148 for display: 2.5×10⁻¹⁴⁸.
function microscopeNumber(value, digits = 4) {
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(digits))).replace("-", "−");
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  const shown = String(Number(mantissa)).replace("-", "−");
  return (shown === "1" ? "" : shown === "−1" ? "−" : shown + "×") + microscopePower(Number(exponent));
}
const microscopePower = exponent =>
  "10" + String(exponent).replace(/./g, c => c === "-" ? "⁻" : "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)]);

// Round steps that divide a span into up to `count` parts.
function microscopeStep(span, count) {
  const power = 10 ** Math.floor(Math.log10(span / count)), scaled = span / count / power;
  return power * (scaled <= 1 ? 1 : scaled <= 2 ? 2 : scaled <= 5 ? 5 : 10);
}

// The ticks of an axis: values from the middle at `centre` over `span`, with an absolute `origin` if that is resolved,
// else in powers of ten from the anchor. {ticks: [[offset from the centre, label]], power}.
function microscopeTicks(centre, span, count, origin) {
  const step = microscopeStep(span, count), absolute = Math.abs(origin) + span < 2e4 * span;
  const base = absolute ? origin + centre : centre, power = Math.floor(Math.log10(span));
  const plain = absolute && span >= 1e-3 && span < 1e6, ticks = [];
  for (let k = Math.ceil((base - span / 2) / step); k <= Math.floor((base + span / 2) / step); ++k) {
    const decimals = Math.max(0, -Math.floor(Math.log10(plain ? step : step / 10 ** power) + 1e-9));
    const scaled = plain ? k * step : k * step / 10 ** power;
    const label = scaled.toFixed(Math.min(decimals, 9)).replace(/^-(0\.?0*)$/, "$1").replace("-", "−");
    ticks.push([k * step - base, label]);
  }
  return { ticks, power: plain ? 0 : power, absolute };
}

// Text; x is its left, center or right, y its top or middle.
function microscopeText(pen, align, baseline, text, x, y) {
  pen.textAlign = align;
  pen.textBaseline = baseline;
  pen.fillText(text, x, y);
}

// Lines through points, [[x, y], ...] each, in a colour.
function microscopeStroke(pen, colour, width, lines) {
  pen.strokeStyle = colour;
  pen.lineWidth = width;
  pen.beginPath();
  for (const [first, ...others] of lines) {
    pen.moveTo(...first);
    for (const point of others) pen.lineTo(...point);
  }
  pen.stroke();
}

// Adds the segments of a polyline to the path, clipped to the box [0, width] x [0, height] with some margin.
function microscopeSegment(path, x0, y0, x1, y1, box) {
  let from = 0, to = 1;
  const dx = x1 - x0, dy = y1 - y0;
  for (const [p, q] of [[-dx, x0 - box[0]], [dx, box[1] - x0], [-dy, y0 - box[2]], [dy, box[3] - y0]]) {
    if (p === 0) {
      if (q < 0) return;
    } else if (p < 0) {
      from = Math.max(from, q / p);
    } else {
      to = Math.min(to, q / p);
    }
  }
  if (from > to) return;
  if (from > 0 || path.lastX !== x0 || path.lastY !== y0) path.moveTo(x0 + from * dx, y0 + from * dy);
  path.lineTo(x0 + to * dx, y0 + to * dy);
  path.lastX = to < 1 ? NaN : x1;
  path.lastY = y1;
}

// Maps from a view to a box {left, top, width, height}: of tau, and of xi at tau.
function microscopeScales(view, box) {
  return { x: tau => box.left + box.width * ((tau - view.tau) / view.T + 0.5),
           y: (xi, tau) => box.top + box.height * (0.5 - (xi - view.V * tau - view.xi) / view.X) };
}

// World lines of a chart, without invisible parts and repeated vertices.
function microscopeLines(pen, chart, view, box, colours) {
  const { x, y } = microscopeScales(view, box), path = new Path2D();
  const cut = [box.left - 20, box.left + box.width + 20, box.top - 20, box.top + box.height + 20];
  for (const line of chart.lines) {
    let [tau, xi] = line.from, px = x(tau), py = y(xi, tau);
    const step = (nextTau, nextXi, last) => {
      const nx = x(nextTau), ny = y(nextXi, nextTau);
      if (!last && Math.abs(nx - px) < 0.3 && Math.abs(ny - py) < 0.3) return;
      if (Math.max(px, nx) >= cut[0] && Math.min(px, nx) <= cut[1]) microscopeSegment(path, px, py, nx, ny, cut);
      px = nx;
      py = ny;
    };
    for (const i of line.points) step(chart.tau[i], chart.xi[i], false);
    step(...line.to, true);
  }
  pen.lineWidth = chart.lines.length > 150 ? 0.75 : 1;
  pen.lineJoin = "round";
  pen.strokeStyle = colours.line;
  pen.stroke(path);
}

// Collisions of a chart as dots, coloured by `value(collision)`, a logarithm, over `range`.
function microscopeDots(pen, chart, view, box, value, range) {
  const { x, y } = microscopeScales(view, box), bins = new Map();
  let seen = 0, lastX = NaN, lastY = NaN;
  for (let i = 0; i < chart.collisions.length; ++i) {
    const px = x(chart.tau[i]), py = y(chart.xi[i], chart.tau[i]);
    if (px < box.left - 5 || px > box.left + box.width + 5) continue;
    if (py < box.top - 5 || py > box.top + box.height + 5) continue;
    if (Math.abs(px - lastX) < 0.5 && Math.abs(py - lastY) < 0.5) continue;
    lastX = px;
    lastY = py;
    ++seen;
    const part = (value[chart.collisions[i]] - range[0]) / (range[1] - range[0]);
    const bin = Math.round(15 * microscopeClamp(part, 0, 1));
    if (!bins.has(bin)) bins.set(bin, []);
    bins.get(bin).push(px, py);
  }
  const radius = seen > 2500 ? 1.2 : seen > 500 ? 2 : seen > 80 ? 2.8 : 4;
  for (const [bin, places] of bins) {
    const path = new Path2D();
    for (let k = 0; k < places.length; k += 2) {
      path.moveTo(places[k] + radius, places[k + 1]);
      path.arc(places[k], places[k + 1], radius, 0, 7);
    }
    pen.fillStyle = `rgb(${microscopeColour(bin / 15)})`;
    pen.fill(path);
  }
}

// The numbers of the particles, if there are few: at the left edge, or where a line becomes visible.
function microscopeNames(pen, chart, view, box, colours, number) {
  const { x, y } = microscopeScales(view, box), places = [];
  for (const line of chart.lines) {
    for (const part of [0.02, 0.2, 0.4, 0.6, 0.8]) {
      const tau = Math.max(line.from[0], view.tau + view.T * (part - 0.5));
      if (tau > line.to[0]) break;
      const px = x(tau) + 4, py = y(microscopeAlong(chart, line, tau), tau);
      if (px > box.left + box.width - 30) break;
      if (py < box.top + 9 || py > box.top + box.height - 9) continue;
      places.push([px, py, String(number(line.particle))]);
      break;
    }
  }
  if (places.length > 14) return;
  for (const [k, [px, py, name]] of places.entries()) {
    if (places.some(([qx, qy], j) => j < k && Math.abs(qx - px) < 30 && Math.abs(qy - py) < 13)) continue;
    pen.fillStyle = colours.plate;
    pen.fillRect(px - 2, py - 7, pen.measureText(name).width + 4, 14);
    pen.fillStyle = colours.text;
    microscopeText(pen, "left", "middle", name, px, py);
  }
}

// Axes with ticks and their quantities, from `origin`, {t, x} of the anchor; returns a function that draws the labels.
function microscopeAxes(pen, view, box, colours, origin, anchorName) {
  const time = microscopeTicks(view.tau, view.T, Math.max(3, box.width / 110), origin.t);
  const space = microscopeTicks(view.xi, view.X, Math.max(3, box.height / 70), origin.moving ? Infinity : origin.x);
  const bottom = box.top + box.height, right = box.left + box.width;
  const across = offset => box.left + box.width * (offset / view.T + 0.5);
  const up = offset => box.top + box.height * (0.5 - offset / view.X), between = at => Math.round(at) + 0.5;
  microscopeStroke(pen, colours.grid, 1, [
    ...time.ticks.map(([offset]) => between(across(offset))).map(px => [[px, box.top], [px, bottom]]),
    ...space.ticks.map(([offset]) => between(up(offset))).map(py => [[box.left, py], [right, py]])]);
  return () => {  // the labels, drawn last
    pen.strokeStyle = colours.frame;
    pen.strokeRect(box.left + 0.5, box.top + 0.5, box.width - 1, box.height - 1);
    pen.fillStyle = colours.text;
    for (const [offset, label] of time.ticks) microscopeText(pen, "center", "top", label, across(offset), bottom + 5);
    for (const [offset, label] of space.ticks) microscopeText(pen, "right", "middle", label, box.left - 6, up(offset));
    const unit = (axis, letter) => axis.power ? `, in ${microscopePower(axis.power)} ${letter}` : `, in ${letter}`;
    microscopeText(pen, "center", "top", (time.absolute ? "time" : `t − t(${anchorName})`) + unit(time, "t"),
                   box.left + box.width / 2, bottom + 21);
    pen.save();
    pen.translate(10, box.top + box.height / 2);
    pen.rotate(-Math.PI / 2);
    microscopeText(pen, "center", "middle", (space.absolute ? "position" : `x − x(${anchorName})`) + unit(space, "l") +
                   (origin.moving ? ", moving with the particles" : ""), 0, 0);
    pen.restore();
  };
}

// Bars of a round length of time and of space, and the meaning of the colours.
function microscopeLegend(pen, view, box, colours, range, quantity) {
  const right = box.left + box.width - 12, bottom = box.top + box.height - 12;
  const time = microscopeStep(view.T, 12), space = microscopeStep(view.X, 8);
  const across = box.width * time / view.T, up = box.height * space / view.X;
  const labels = [microscopeNumber(time, 1) + " t", microscopeNumber(space, 1) + " l"];
  const widths = labels.map(label => pen.measureText(label).width);
  const plate = (x, y, width, height) => {
    pen.fillStyle = colours.plate;
    pen.fillRect(x, y, width, height);
  };
  plate(right - across - widths[0] - 12, bottom - 9, across + widths[0] + 18, 18);
  plate(right - widths[1] - 12, bottom - up - 9, widths[1] + 18, 18);
  pen.fillStyle = colours.text;
  microscopeStroke(pen, colours.text, 1.5, [[[right, bottom - up], [right, bottom], [right - across, bottom]]]);
  microscopeText(pen, "right", "middle", labels[0], right - across - 6, bottom);
  microscopeText(pen, "right", "middle", labels[1], right - 6, bottom - up + 2);
  if (!range) return;
  const width = 120, top = box.top + 12, left = box.left + box.width - width - 14;
  plate(left - 8, top - 6, width + 16, 46);
  for (let k = 0; k < width; ++k) {
    pen.fillStyle = `rgb(${microscopeColour(k / width)})`;
    pen.fillRect(left + k, top + 16, 1.5, 7);
  }
  pen.fillStyle = colours.text;
  const end = log => log < -307 ? microscopePower(Math.round(log)) : microscopeNumber(10 ** log, 1);
  microscopeText(pen, "center", "top", quantity, left + width / 2, top - 1);
  microscopeText(pen, "left", "top", end(range[0]), left, top + 26);
  microscopeText(pen, "right", "top", end(range[1]), left + width, top + 26);
}
