"use strict";
// The report page: player, events, charts, and what ties them together.

/** base64 of gzip -> bytes, by the browser's own decompressor. */
async function unpack(text) {
  const packed = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
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

/** The top of an axis for curves that begin with a peak, which would flatten all the rest; undefined when there is none. */
function topWithoutPeak(series) {
  const begin = 0.1 * Math.max(...series.map((s) => s.t[s.t.length - 1]));
  const highest = Math.max(...series.flatMap((s) => s.y));
  const later = Math.max(...series.flatMap((s) => s.y.filter((_, i) => s.t[i] > begin)));
  return later > 0 && highest > 2 * later ? +(1.1 * later).toPrecision(2) : undefined;
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
  byId("rates-figure").hidden = !data.rates || names.length > 12;
  const rates = data.rates && names.length <= 12 ? names.flatMap((name, i) => data.rates[name] ? [{
    label: name, t: data.rates[name].t, y: data.rates[name].a, tone: tones[i], width: 1.4, dash: dashOf(i),
  }] : []) : [];
  const rate = rates.length ? curveChart(byId("rates"), rates, "explored per second", seek,
    { most: 0, cap: topWithoutPeak(rates), tick: (v) => `${+v.toFixed(2)} m²/s`, tip: (v) => `${v.toFixed(2)} m²/s` }) : { setTime() {} };
  const percent = (digits) => (v) => `${(100 * v).toFixed(digits)} %`;
  const bars = (id, values, unit, tick) => {
    const shown = values && names.length > 1;  // one robot: the table says it all
    byId(`${id}-figure`).hidden = !shown;
    if (shown) barChart(byId(id), names, names.map((n) => values[n] || 0), tones, unit, tick);
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
  return { setTime(time) { curve.setTime(time); rate.setTime(time); } };
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
  const [state, since, seen, wrong, truth] =
    await Promise.all([map.state, map.known_since, map.seen, map.errors, map.truth].map(bytes));
  const view = (buffer, Type) => buffer && new Type(buffer);
  return new MapImage(map, {
    state: view(state, Uint8Array), since: view(since, Uint16Array), seen: view(seen, Uint8Array),
    wrong: view(wrong, Uint8Array), truth: view(truth, Uint8Array),
  });
}

/** The finished map with its errors, and the truth beside it. */
function drawQuality({ map, layers: { state, wrong, truth } }) {
  if (!wrong || !truth) return;
  for (const [name, layers, errors] of [["found", { state, wrong }, true], ["truth", { state: truth }, false]]) {
    const still = new MapImage(map, layers);
    still.paint(Infinity, false, errors);
    still.canvas.className = "still";
    byId(`${name}-figure`).prepend(still.canvas);
    byId(`${name}-figure`).hidden = false;
  }
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
  if (image) drawQuality(image);
  player = new Player(data.duration, [(time) => { view.time = time; view.draw(); }, (time) => curve.setTime(time)]);
  byId("events").hidden = events.length === 0;
  if (events.length) new EventTable(events, data.events, (time) => { seek(time); byId("map").scrollIntoView({ block: "center" }); });
})();
