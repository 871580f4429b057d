"use strict";
// Figure 1: the grid as an image, and the view of it with trajectories, robots and a camera.

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
