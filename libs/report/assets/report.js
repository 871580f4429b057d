"use strict";

/** base64 of gzip -> bytes, by the browser's own decompressor. */
async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/** Position of a path {t, x, y} at a time; index is the last point passed. */
function at(path, time) {
  let low = 0, high = path.t.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (path.t[middle] <= time) low = middle;
    else high = middle - 1;
  }
  const next = Math.min(low + 1, path.t.length - 1);
  const span = path.t[next] - path.t[low];
  const u = span > 0 ? Math.min(1, Math.max(0, (time - path.t[low]) / span)) : 0;
  return {
    index: low,
    x: path.x[low] + u * (path.x[next] - path.x[low]),
    y: path.y[low] + u * (path.y[next] - path.y[low]),
  };
}

/** "#rrggbb" -> one pixel as the 32-bit word that canvas image data holds (little endian: ABGR). */
function pixel(colour, alpha = 255) {
  const rgb = parseInt(colour.slice(1), 16);
  return ((alpha << 24) | ((rgb & 255) << 16) | (rgb & 0xff00) | (rgb >> 16)) >>> 0;
}

function mixed(a, b, share) {
  const channel = (c, shift) => (parseInt(c.slice(1), 16) >> shift) & 255;
  const mix = (shift) => Math.round(channel(a, shift) * (1 - share) + channel(b, shift) * share);
  return "#" + [16, 8, 0].map((shift) => mix(shift).toString(16).padStart(2, "0")).join("");
}

/** The grid as an image that shows what was known at a step. Row 0 of the grid is at the bottom. */
class MapImage {
  constructor(map, layers) {
    Object.assign(this, { map, layers });
    this.canvas = element("canvas", { width: map.width, height: map.height });
    this.context = this.canvas.getContext("2d");
    this.image = this.context.createImageData(map.width, map.height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.shown = "";
  }

  paint(step, overlap, errors) {
    const key = [step, overlap, errors, css("--map-free")].join();
    if (key === this.shown) return;
    this.shown = key;
    const { state, since, seen, wrong } = this.layers;
    const { width, height } = this.map;
    const free = css("--map-free");
    const shades = [pixel(css("--map-unknown")), pixel(free), pixel(css("--map-wall"))];
    const tints = [0, 0, pixel(mixed(free, "#e69f00", 0.3)), pixel(mixed(free, "#e69f00", 0.7))];
    const marks = [0, pixel("#d55e00"), pixel("#0072b2"), pixel("#cc79a7")];
    for (let i = 0; i < state.length; ++i) {
      const known = !since || since[i] <= step;
      let colour = shades[known ? state[i] : 0];
      if (overlap && known && state[i] === 1 && seen[i] > 1) colour = tints[Math.min(3, seen[i])];
      if (errors && wrong[i] && (known || wrong[i] === 3)) colour = marks[wrong[i]];
      this.pixels[(height - 1 - Math.floor(i / width)) * width + (i % width)] = colour;
    }
    this.context.putImageData(this.image, 0, 0);
  }

  /** Smallest box of known cells in metres: [x0, y0, x1, y1]; absent when nothing is known. */
  knownBox() {
    const { width, resolution, origin } = this.map;
    let x0 = Infinity, y0 = Infinity, x1 = -Infinity, y1 = -Infinity;
    this.layers.state.forEach((s, i) => {
      if (s === 0) return;
      const x = i % width, y = Math.floor(i / width);
      x0 = Math.min(x0, x); x1 = Math.max(x1, x + 1);
      y0 = Math.min(y0, y); y1 = Math.max(y1, y + 1);
    });
    if (x0 > x1) return null;
    return [x0 * resolution + origin[0], y0 * resolution + origin[1], x1 * resolution + origin[0], y1 * resolution + origin[1]];
  }
}

/** Figure 1: the map, the trajectories until the current time, and a camera. */
class MapView {
  constructor(canvas, data, image) {
    Object.assign(this, { canvas, data, image, time: 0, hidden: new Set(), hovered: -1, goals: [] });
    this.show = { overlap: false, errors: false, ranges: false };
    this.box = this.contentBox();
    this.fit();
    this.listen();
  }

  contentBox() {
    const box = (this.image && this.image.knownBox()) || [Infinity, Infinity, -Infinity, -Infinity];
    for (const { path } of this.data.robots)
      path.t.forEach((_, i) => {
        box[0] = Math.min(box[0], path.x[i]); box[2] = Math.max(box[2], path.x[i]);
        box[1] = Math.min(box[1], path.y[i]); box[3] = Math.max(box[3], path.y[i]);
      });
    const margin = 0.02 * Math.max(box[2] - box[0], box[3] - box[1]) + 0.1;
    return [box[0] - margin, box[1] - margin, box[2] + margin, box[3] + margin];
  }

  fit() {
    const [x0, y0, x1, y1] = this.box;
    const width = this.canvas.clientWidth || 800;
    const height = Math.round(Math.min(Math.max(width * (y1 - y0) / (x1 - x0), 0.3 * width), Math.max(width, 320), 820));
    this.canvas.style.height = height + "px";
    this.scale = Math.min(width / (x1 - x0), height / (y1 - y0));
    this.fitted = this.scale;
    this.left = (width - this.scale * (x0 + x1)) / 2;
    this.top = (height + this.scale * (y0 + y1)) / 2;
  }

  zoom(factor, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2) {
    factor = Math.min(40 * this.fitted, Math.max(0.5 * this.fitted, this.scale * factor)) / this.scale;
    this.scale *= factor;
    this.left = x + (this.left - x) * factor;
    this.top = y + (this.top - y) * factor;
    this.draw();
  }

  listen() {
    let drag = null;
    this.canvas.addEventListener("pointerdown", (e) => {
      if (e.pointerType === "mouse") drag = { x: e.clientX - this.left, y: e.clientY - this.top };
    });
    addEventListener("pointerup", () => (drag = null));
    addEventListener("pointermove", (e) => {
      if (!drag) return;
      this.left = e.clientX - drag.x;
      this.top = e.clientY - drag.y;
      this.draw();
    });
    this.canvas.addEventListener("pointermove", (e) => drag || this.hover(e.offsetX, e.offsetY));
    this.canvas.addEventListener("pointerleave", () => this.hover(-99, -99));
    this.canvas.addEventListener("dblclick", () => { this.fit(); this.draw(); });
    this.canvas.addEventListener("wheel", (e) => {  // a plain wheel scrolls the page
      if (!e.ctrlKey && !e.metaKey) return;
      e.preventDefault();
      this.zoom(Math.exp(-0.002 * e.deltaY), e.offsetX, e.offsetY);
    }, { passive: false });
    new ResizeObserver(() => requestAnimationFrame(() => { this.fit(); this.draw(); })).observe(this.canvas.parentElement);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
  }

  hover(x, y) {
    const distance = (robot) => {
      const p = at(robot.path, this.time);
      return Math.hypot(this.x(p.x) - x, this.y(p.y) - y);
    };
    const near = this.data.robots.findIndex((r, i) => r.path.t.length && !this.hidden.has(i) && distance(r) < 14);
    if (near === this.hovered) return;
    this.hovered = near;
    this.draw();
  }

  x(metres) { return this.left + this.scale * metres; }
  y(metres) { return this.top - this.scale * metres; }

  draw() {
    const ratio = devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    const c = this.canvas.getContext("2d");
    c.scale(ratio, ratio);
    c.fillStyle = css("--map-unknown");
    c.fillRect(0, 0, width, height);
    if (this.image) this.drawMap(c);
    this.drawScaleBar(c, width, height);
    c.lineJoin = c.lineCap = "round";
    this.drawLeft(c);
    this.data.robots.forEach((robot, i) => this.hidden.has(i) || this.drawPath(c, robot, i));
    this.data.robots.forEach((robot, i) => this.hidden.has(i) || this.drawRobot(c, robot, i));
  }

  drawMap(c) {
    const { map } = this.data;
    this.image.paint(Math.floor(this.time / map.step_s + 1e-9), this.show.overlap, this.show.errors);
    const side = map.resolution * this.scale;
    c.imageSmoothingEnabled = side * (devicePixelRatio || 1) < 1.5;
    c.drawImage(this.image.canvas, this.x(map.origin[0]), this.y(map.origin[1]) - side * map.height,
      side * map.width, side * map.height);
  }

  drawPath(c, { path }, i) {
    if (!path.t.length) return;
    const end = at(path, this.time);
    c.beginPath();
    c.moveTo(this.x(path.x[0]), this.y(path.y[0]));
    for (let k = 1; k <= end.index; ++k) c.lineTo(this.x(path.x[k]), this.y(path.y[k]));
    c.lineTo(this.x(end.x), this.y(end.y));
    c.strokeStyle = colourOf(i);
    c.setLineDash(dashOf(i));
    c.lineWidth = i === this.hovered ? 3 : 1.6;
    c.stroke();
    c.setLineDash([]);
    c.fillStyle = css("--paper");  // a hollow square marks the start
    c.lineWidth = 1.6;
    c.fillRect(this.x(path.x[0]) - 3.5, this.y(path.y[0]) - 3.5, 7, 7);
    c.strokeRect(this.x(path.x[0]) - 3.5, this.y(path.y[0]) - 3.5, 7, 7);
  }

  drawRobot(c, { name, path, range, radius }, i) {
    if (!path.t.length) return;
    const p = at(path, this.time), x = this.x(p.x), y = this.y(p.y);
    c.strokeStyle = c.fillStyle = colourOf(i);
    const goal = this.goalOf(i);
    if (goal) {
      c.setLineDash([2, 4]);
      c.lineWidth = 1;
      c.beginPath();
      c.moveTo(x, y);
      c.lineTo(this.x(goal[0]), this.y(goal[1]));
      c.stroke();
      c.setLineDash([]);
      c.beginPath();
      c.arc(this.x(goal[0]), this.y(goal[1]), 4, 0, 7);
      c.stroke();
    }
    if (this.show.ranges || i === this.hovered) {
      c.beginPath();
      c.arc(x, y, range * this.scale, 0, 7);
      c.globalAlpha = 0.12;
      c.fill();
      c.globalAlpha = 0.8;
      c.lineWidth = 1;
      c.stroke();
      c.globalAlpha = 1;
    }
    c.beginPath();
    c.arc(x, y, Math.max(5.5, radius * this.scale), 0, 7);
    c.fill();
    c.lineWidth = 1.5;
    c.strokeStyle = css("--paper");
    c.stroke();
    if (i === this.hovered) this.label(c, name, x + 10, y - 10);
  }

  label(c, text, x, y) {
    c.font = `600 12px ${css("--sans")}`;
    c.lineWidth = 4;
    c.strokeStyle = css("--paper");
    c.strokeText(text, x, y);
    c.fillStyle = css("--ink");
    c.fillText(text, x, y);
  }

  /** The goal in force at the current time, from the events. */
  goalOf(robot) {
    const list = this.goals[robot];
    if (!list) return null;
    let goal = null;
    for (const entry of list) {
      if (entry.t > this.time) break;
      goal = entry.goal;
    }
    return goal;
  }

  drawLeft(c) {  // triangles where something was left unexplored, once the run is over
    if (this.time < this.data.duration) return;
    c.fillStyle = "#d55e00";
    c.strokeStyle = css("--paper");
    c.lineWidth = 1.5;
    for (const { frontier } of this.data.left || []) {
      if (!frontier) continue;
      const x = this.x(frontier[0]), y = this.y(frontier[1]);
      c.beginPath();
      c.moveTo(x, y - 7);
      c.lineTo(x + 6, y + 5);
      c.lineTo(x - 6, y + 5);
      c.closePath();
      c.fill();
      c.stroke();
    }
  }

  drawScaleBar(c, width, height) {
    const wanted = 110 / this.scale;
    const power = 10 ** Math.floor(Math.log10(wanted));
    const metres = [5, 2, 1].map((k) => k * power).find((m) => m <= wanted) || power;
    const length = metres * this.scale;
    c.fillStyle = css("--paper");
    c.globalAlpha = 0.85;
    c.fillRect(width - length - 28, height - 36, length + 20, 28);
    c.globalAlpha = 1;
    c.fillStyle = css("--ink");
    c.fillRect(width - length - 18, height - 17, length, 2);
    c.font = `11px ${css("--sans")}`;
    c.textAlign = "center";
    c.fillText(`${metres} m`, width - 18 - length / 2, height - 22);
    c.textAlign = "start";
  }
}

/** Slider, play button, speed: who listens is told the time. */
class Player {
  constructor(duration, listeners) {
    Object.assign(this, { duration, listeners, playing: false, time: duration });
    const speeds = [0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
    const fitting = speeds.find((s) => duration / s <= 25) || 1000;
    byId("speed").append(...speeds.map((s) => element("option", { value: s, textContent: `${s}×`, selected: s === fitting })));
    Object.assign(byId("time"), { max: duration, value: duration });
    byId("time").addEventListener("input", () => { this.stop(); this.seek(+byId("time").value); });
    byId("play").addEventListener("click", () => (this.playing ? this.stop() : this.start()));
    const linked = /[#&]t=([\d.]+)/.exec(location.hash);  // report.html#t=60 opens at that time
    this.seek(linked ? +linked[1] : duration);
  }

  seek(time) {
    this.time = Math.min(this.duration, Math.max(0, time));
    byId("time").value = this.time;
    byId("clock").textContent = `${this.time.toFixed(1)} s`;
    for (const listener of this.listeners) listener(this.time);
  }

  start() {
    this.playing = true;
    byId("play").textContent = "❚❚";
    byId("play").setAttribute("aria-label", "Pause");
    if (this.time >= this.duration) this.seek(0);
    let last = performance.now();
    const tick = (now) => {
      if (!this.playing) return;
      this.seek(this.time + Math.min(100, now - last) / 1000 * +byId("speed").value);
      last = now;
      if (this.time >= this.duration) this.stop();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  stop() {
    this.playing = false;
    byId("play").textContent = "▶";
    byId("play").setAttribute("aria-label", "Play");
  }
}

const point = (p) => (Array.isArray(p) && p.length === 2 ? `(${p[0].toFixed(1)}, ${p[1].toFixed(1)})` : "");
const plain = (v) => (typeof v === "string" ? v : JSON.stringify(v, (_, n) => (typeof n === "number" ? +n.toFixed(3) : n)));

/** One line of words for an event. */
function summary(event) {
  const count = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;
  if (event.event === "auction" && Array.isArray(event.bids)) {
    const awards = (event.awards || []).map((a) => `${a.robot} → ${point(a.task)}`).join(", ");
    const unheard = (event.unheard || []).length ? `; unheard: ${event.unheard.join(", ")}` : "";
    return `${count(event.bids.length, "bidder")}; ${awards || "no award"}${unheard}`;
  }
  return Object.entries(event)
    .filter(([key]) => !["t", "event", "robot"].includes(key))
    .map(([key, value]) => `${key.replaceAll("_", " ")} ${point(value) || plain(value)}`)
    .join(", ");
}

/** What unfolds below the line: every bid of an auction as a table, else the event as it was recorded. */
function details(event) {
  if (event.event !== "auction" || !Array.isArray(event.bids) || !event.bids.every((b) => Array.isArray(b.tasks)))
    return element("pre", { textContent: JSON.stringify(event, null, 1) });
  const body = element("tbody");
  for (const bid of event.bids)
    for (const [x, y, gain, distance] of bid.tasks) {
      const award = (event.awards || []).find((a) => a.robot === bid.robot && a.task[0] === x && a.task[1] === y);
      body.append(element("tr", {}, ...[bid.robot + (bid.busy ? " (busy)" : ""), point([x, y]), gain, distance, award ? award.value : ""]
        .map((v, i) => element("td", { textContent: v, className: i > 1 ? "number" : "" }))));
    }
  const head = ["bidder", "task at [m]", "gain [m²]", "distance [m]", "won at"]
    .map((v, i) => element("th", { textContent: v, className: i > 1 ? "number" : "" }));
  return element("table", {}, element("thead", {}, element("tr", {}, ...head)), body);
}

/** The table of events: rows are made a hundred at a time, as far as one scrolls. */
class EventTable {
  constructor(events, meta, seek) {
    Object.assign(this, { events, meta, seek, kinds: new Map(), off: new Set(), words: "" });
    for (const e of events) this.kinds.set(e.event, (this.kinds.get(e.event) || 0) + 1);
    byId("event-kinds").append(...[...this.kinds].sort().map(([kind, n]) => toggle(`${kind} ${n}`, true, (on) => {
      on ? this.off.delete(kind) : this.off.add(kind);
      this.refresh();
    })));
    byId("event-search").addEventListener("input", (e) => { this.words = e.target.value.toLowerCase(); this.refresh(); });
    const scroll = byId("event-rows").closest(".scroll");
    scroll.addEventListener("scroll", () => scroll.scrollTop + scroll.clientHeight > scroll.scrollHeight - 200 && this.more());
    this.refresh();
  }

  refresh() {
    this.chosen = this.events.filter((e) => !this.off.has(e.event) &&
      (!this.words || JSON.stringify(e).toLowerCase().includes(this.words)));
    this.made = 0;
    byId("event-rows").replaceChildren();
    this.more();
    const cut = this.meta.shown < this.meta.total ? ` The first ${this.meta.shown} are kept in this file; events.jsonl holds all ${this.meta.total}.` : "";
    byId("event-more").textContent = `${this.chosen.length} of ${this.events.length} events.${cut}`;
  }

  more() {
    for (const event of this.chosen.slice(this.made, this.made + 100)) {
      const fold = element("details", {}, element("summary", { textContent: summary(event) }));
      fold.addEventListener("toggle", () => fold.children.length > 1 || fold.append(details(event)), { once: true });
      const time = element("button", { type: "button", className: "seek", textContent: `${(+event.t).toFixed(1)} s` });
      time.addEventListener("click", () => this.seek(+event.t));
      byId("event-rows").append(element("tr", {}, element("td", { className: "number" }, time),
        element("td", { textContent: plain(event.event ?? "").replaceAll("_", " ") }),
        element("td", { textContent: plain(event.robot ?? event.opener ?? "") }), element("td", {}, fold)));
    }
    this.made += 100;
  }
}

/** A button that is on or off. */
function toggle(label, on, change, tone) {
  const button = element("button", { type: "button" });
  if (tone) {
    const swatch = element("span", { className: "swatch" });
    swatch.style.background = `var(${tone})`;
    button.append(swatch);
  }
  button.append(label);
  button.setAttribute("aria-pressed", on);
  button.addEventListener("click", () => {
    on = !on;
    button.setAttribute("aria-pressed", on);
    change(on);
  });
  return button;
}

function drawCharts(data, seek) {
  const names = data.robots.map((r) => r.name);
  const tones = names.map((_, i) => toneOf(i));
  const { t, fraction, m2, robots } = data.timeline;
  byId("coverage-figure").hidden = t.length === 0;
  const last = t.length - 1;
  const whole = fraction[last] > 0 ? m2[last] / fraction[last] : m2[last] || 1;
  const team = { label: "team", t, y: fraction, tone: "--ink", width: 2.4 };
  const each = names.length > 1 && names.length <= 12 ? robots.map((own, i) => ({
    label: names[i], t, y: own.map((v) => v / whole), tone: tones[i], width: 1.4, dash: dashOf(i),
  })).filter((s) => s.y.length > 0) : [];
  byId("each-robot").hidden = each.length === 0;
  const curve = t.length ? curveChart(byId("coverage"), [team, ...each], "explored", seek) : { setTime() {} };
  const percent = (digits) => (v) => `${(100 * v).toFixed(digits)} %`;
  const bars = (id, values, unit, tick) => {
    byId(`${id}-figure`).hidden = !values;
    if (values) barChart(byId(id), names, names.map((n) => values[n] || 0), tones, unit, tick);
  };
  bars("share", data.share, percent(1), percent(0));
  bars("path", data.path_m, (v) => `${v.toFixed(1)} m`, (v) => `${v} m`);
  const seen = data.overlap && data.overlap.seen_m2;
  byId("overlap-figure").hidden = !seen || names.length < 2;
  if (seen && names.length > 1) {
    const sum = Object.values(seen).reduce((a, b) => a + b, 0) || 1;
    barChart(byId("overlap"), ["one robot", "two", "three or more"], Object.values(seen).map((v) => v / sum),
      ["--seen-1", "--seen-2", "--seen-3"], percent(1), percent(0));
  }
  return curve;
}

/** Per robot: [{t, goal: [x, y] or null}], ascending. */
function goalsFrom(events, robots) {
  const index = new Map(robots.map((r, i) => [r.name, i]));
  const goals = robots.map(() => []);
  for (const e of events) {
    const robot = index.get(e.robot);
    if (robot === undefined) continue;
    const goal = e.stand || e.task || e.goal;
    if (e.event === "goal" && Array.isArray(goal)) goals[robot].push({ t: e.t, goal });
    if (e.event === "task_end") goals[robot].push({ t: e.t, goal: null });
  }
  return goals;
}

async function loadImage(map) {
  if (!map) return null;
  const bytes = async (text) => (text ? unpack(text) : null);
  const [state, since, seen, wrong] = await Promise.all([map.state, map.known_since, map.seen, map.errors].map(bytes));
  const view = (buffer, Type) => buffer && new Type(buffer);
  return new MapImage(map, {
    state: view(state, Uint8Array), since: view(since, Uint16Array), seen: view(seen, Uint8Array), wrong: view(wrong, Uint8Array),
  });
}

function addTools(view, data) {
  const redraw = (change) => (on) => { change(on); view.draw(); };
  byId("robots").append(...data.robots.map((robot, i) =>
    toggle(robot.name, true, redraw((on) => (on ? view.hidden.delete(i) : view.hidden.add(i))), toneOf(i))));
  const layers = view.image ? view.image.layers : {};
  const option = (label, key) => toggle(label, false, redraw((on) => (view.show[key] = on)));
  byId("toggles").append(option("sensing range", "ranges"), ...(layers.seen ? [option("overlap", "overlap")] : []),
    ...(layers.wrong ? [option("errors", "errors")] : []));
  const caption = byId("map-caption");
  caption.textContent += " Squares mark the starts, discs the positions" + (data.left && data.left.length ? ", triangles what was left." : ".");
  if (layers.seen) caption.textContent += " Overlap: pale where two robots sensed, full where three or more did.";
  if (layers.wrong) caption.textContent += " Errors: vermilion is a wall that is not there, blue a wall that was missed, purple what was not seen.";
  byId("zoom-in").addEventListener("click", () => view.zoom(1.5));
  byId("zoom-out").addEventListener("click", () => view.zoom(1 / 1.5));
  byId("zoom-fit").addEventListener("click", () => { view.fit(); view.draw(); });
}

(async () => {
  const data = pageData();
  for (const { path } of data.robots) for (const key of ["t", "x", "y"]) path[key] = path[key].map((v) => v / 100);
  const ends = data.robots.map((r) => r.path.t[r.path.t.length - 1] || 0);
  data.duration = Math.max(...ends, data.timeline.t[data.timeline.t.length - 1] || 0, 0);
  let player = null;
  const seek = (time) => { player.stop(); player.seek(time); };
  const curve = drawCharts(data, seek);
  let image = null, events = [];
  try {
    image = await loadImage(data.map);
    const lines = new TextDecoder().decode(await unpack(data.events.packed));
    events = lines ? lines.split("\n").map((line) => JSON.parse(line)) : [];
  } catch (error) {
    byId("map-caption").textContent = `The layers could not be unpacked (${error.message}); a newer browser is needed.`;
  }
  for (const e of events) if (data.t0 > 0 && e.t >= data.t0) e.t -= data.t0;
  const view = new MapView(byId("map"), data, image);
  view.goals = goalsFrom(events, data.robots);
  addTools(view, data);
  player = new Player(data.duration, [(time) => { view.time = time; view.draw(); }, (time) => curve.setTime(time)]);
  byId("events").hidden = events.length === 0;
  if (events.length) new EventTable(events, data.events, (time) => { seek(time); byId("map").scrollIntoView({ block: "center" }); });
})();
