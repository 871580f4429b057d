"use strict";
// The live page: what arrives as events goes onto the same map view as in a report.

const kTeam = "the team";
const live = { view: null, maps: new Map(), shown: kTeam, robots: [], curve: null, known: 0, events: 0 };

/** [state, count, state, count, ...] -> one byte a cell. */
function unroll(runs, cells) {
  const state = new Uint8Array(cells);
  let at = 0;
  for (let k = 0; k < runs.length; k += 2) {
    state.fill(runs[k], at, at + runs[k + 1]);
    at += runs[k + 1];
  }
  return state;
}

function showMap(name) {
  const state = live.maps.get(name);
  if (!state || !live.view) return;
  live.shown = name;
  live.view.image.layers.state = state;
  live.view.image.shown = "";
  const box = live.view.contentBox();
  if (box.some((v, i) => v !== live.view.box[i])) {
    const fitted = live.view.scale === live.view.fitted;
    live.view.box = box;
    if (fitted) live.view.fit();
  }
  live.view.draw();
  for (const button of byId("maps").children) button.setAttribute("aria-pressed", button.textContent === name);
}

/** A team has introduced itself: names, grid. */
function meet(team) {
  const map = { ...team.map, step_s: 1 };
  live.robots = team.robots;
  live.cells = map.width * map.height;
  const robots = team.robots.map((r) => ({ ...r, path: { t: [], x: [], y: [] } }));
  const image = new MapImage(map, { state: new Uint8Array(live.cells) });
  live.view = new MapView(byId("map"), { map, robots, left: [], duration: Infinity }, image);
  live.view.drawPath = drawWay;
  byId("title").textContent = `${team.robots.length} robots — ${team.coordinator}`;
  byId("maps").replaceChildren(...[kTeam, ...team.robots.map((r) => r.name)].map((name, i) => {
    const button = toggle(name, name === kTeam, () => showMap(name), i > 0 ? toneOf(i - 1) : undefined);
    return button;
  }));
  byId("toggles").replaceChildren(toggle("sensing range", false, (on) => { live.view.show.ranges = on; live.view.draw(); }));
  for (const [id, factor] of [["zoom-in", 1.5], ["zoom-out", 1 / 1.5]]) byId(id).onclick = () => live.view.zoom(factor);
  byId("zoom-fit").onclick = () => { live.view.fit(); live.view.draw(); };
  live.curve = curveChart(byId("coverage"), [{ label: "known", t: [], y: [], tone: "--ink", width: 2.4 }], "known");
}

/** Instead of the way driven, the way ahead. */
function drawWay(c, robot, i) {
  const way = robot.way || [];
  if (!way.length || !robot.path.t.length) return;
  c.beginPath();
  c.moveTo(this.x(robot.path.x[0]), this.y(robot.path.y[0]));
  for (const [x, y] of way) c.lineTo(this.x(x), this.y(y));
  c.strokeStyle = colourOf(i);
  c.lineWidth = 1.2;
  c.stroke();
}

function takeState(state) {
  ++live.events;
  if (state.team && (!live.view || live.run !== state.team.run)) {
    live.run = state.team.run;
    live.maps.clear();
    meet(state.team);
  }
  if (!live.view) return;
  live.state = state;
  state.robots.forEach((heard, i) => {
    const robot = live.view.data.robots[i];
    if (!heard.pose) return;
    Object.assign(robot.path, { t: [0], x: [heard.pose[0]], y: [heard.pose[1]] });
    robot.way = heard.way;
    live.view.goals[i] = heard.goal ? [{ t: -1, goal: heard.goal }] : [];
  });
  const done = state.robots.filter((r) => r.done).length;
  byId("verdict").textContent = `${(100 * state.known).toFixed(1)} % of the grid known, ${state.robots.filter((r) => r.age_s < 2).length} ` +
    `of ${state.robots.length} robots on the air, ${done} done`;
  live.curve.append({ x: state.t, y: state.known });
  live.view.draw();
  showHearing(state);
  showAuctions(state.auctions);
  byId("air").replaceChildren(...Object.entries(state.air).map(([key, value]) =>
    element("tr", {}, element("th", { scope: "row", textContent: key }), element("td", { className: "number", textContent: value }))));
}

function showHearing(state) {
  const age = (s) => (s === null ? "never" : s < 2 ? "now" : `${s.toFixed(0)} s ago`);
  const head = element("tr", {}, element("th"), ...live.robots.map((r) => element("th", { textContent: r.name })), element("th", { textContent: "heard" }));
  byId("hearing").replaceChildren(head, ...state.robots.map((robot, i) =>
    element("tr", {}, element("th", { scope: "row", textContent: live.robots[i].name }),
      ...live.robots.map((_, k) => element("td", { textContent: k === i ? "" : robot.hears.includes(k) ? "●" : "○" })),
      element("td", { textContent: age(robot.age_s) }))));
}

function showAuctions(auctions) {
  const point = ([x, y]) => `(${x.toFixed(1)}, ${y.toFixed(1)})`;
  byId("auctions").replaceChildren(...auctions.map((a) => element("tr", {}, element("td", { textContent: `${a.t.toFixed(1)} s` }),
    element("td", { textContent: a.seller }), element("td", { textContent: a.bids.map((b) => `${b.robot} ${b.tasks}`).join(", ") }),
    element("td", { textContent: a.awards.map((w) => `${w.robot} → ${point(w.task)}`).join(", ") || "none" }))));
}

const source = new EventSource("events");
source.addEventListener("state", (e) => takeState(JSON.parse(e.data)));
source.addEventListener("map", (e) => {
  const { name, runs } = JSON.parse(e.data);
  if (!live.view) return;
  live.maps.set(name, unroll(runs, live.cells));
  if (name === live.shown) showMap(name);
});
source.onerror = () => { byId("verdict").textContent = "The program that serves this page is gone; trying again."; };
