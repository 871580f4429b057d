"use strict";
// What the pages share: colours that colour-blind readers can tell apart, chart defaults, a time cursor.

const kTones = 8;  // --tone-0 ... in page.css: Okabe and Ito's, lighter on dark paper
const kDashes = [[], [7, 3], [2, 3]];
const toneOf = (i) => `--tone-${i % kTones}`;
const dashOf = (i) => kDashes[Math.floor(i / kTones) % kDashes.length];
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const colourOf = (i) => css(toneOf(i));
const byId = (id) => document.getElementById(id);
const pageData = () => JSON.parse(byId("data").textContent);

/** An element with properties and children; text never becomes markup. */
function element(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
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

const allCharts = [];

function applyTheme() {
  Chart.defaults.color = css("--muted");
  Chart.defaults.borderColor = css("--rule");
  for (const chart of allCharts) {
    for (const scale of Object.values(chart.options.scales)) {
      scale.grid.color = scale.grid.borderColor = css("--rule");
      scale.ticks.color = scale.title.color = css("--muted");
    }
    chart.options.plugins.legend.labels.color = css("--muted");
    for (const set of chart.data.datasets) {
      if (Array.isArray(set.tones)) set.backgroundColor = set.tones.map(css);
      else set.borderColor = css(set.tones);
    }
    chart.update("none");
  }
}

Chart.defaults.animation = false;
Chart.defaults.maintainAspectRatio = false;
Chart.defaults.font.family = css("--sans");
Chart.defaults.font.size = 12;
applyTheme();
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", applyTheme);
addEventListener("beforeprint", () => allCharts.forEach((chart) => chart.resize()));

function axis(title, options = {}) {
  const { ticks, grid, ...others } = options;
  return {
    title: { display: title !== "", text: title },
    grid: { drawTicks: false, borderColor: css("--rule"), ...grid },
    ticks: { padding: 6, maxRotation: 0, ...ticks },
    ...others,
  };
}

function addChart(canvas, config) {
  const chart = new Chart(canvas, config);
  allCharts.push(chart);
  return chart;
}

const kPercent = { most: 1, tick: (v) => Math.round(100 * v) + " %", tip: (v) => (100 * v).toFixed(1) + " %" };

/**
 * Curves over time. series: [{label, t, y, tone (a CSS variable), width, dash}]; onSeek(time) is called on a click.
 * unit: {most: the axis goes at least there, cap: and not beyond this, if set, tick(value), tip(value): labels}
 */
function curveChart(canvas, series, yTitle, onSeek, unit = kPercent) {
  const cursor = {
    id: "cursor",
    time: null,
    afterDatasetsDraw(chart) {
      if (this.time === null) return;
      const { ctx, chartArea, scales } = chart;
      const x = scales.x.getPixelForValue(this.time);
      ctx.save();
      ctx.strokeStyle = css("--muted");
      ctx.beginPath();
      ctx.moveTo(x, chartArea.top);
      ctx.lineTo(x, chartArea.bottom);
      ctx.stroke();
      ctx.restore();
    },
  };
  const last = Math.max(0, ...series.map((s) => s.t[s.t.length - 1] || 0));
  const chart = addChart(canvas, {
    type: "line",
    data: {
      datasets: series.map((s) => ({
        label: s.label,
        data: s.t.map((t, i) => ({ x: t, y: s.y[i] })),
        borderColor: css(s.tone),
        tones: s.tone,
        borderWidth: s.width,
        borderDash: s.dash || [],
        pointRadius: 0,
        pointHitRadius: 6,
      })),
    },
    options: {
      parsing: false,
      normalized: true,
      interaction: { mode: "nearest", axis: "x", intersect: false },
      onClick: (event, _, c) => onSeek && onSeek(c.scales.x.getValueForPixel(event.x)),
      scales: {
        x: axis("time [s]", { type: "linear", min: 0, max: last || 1, grid: { display: false }, ticks: { includeBounds: false } }),
        y: axis(yTitle, { min: 0, suggestedMax: unit.most, max: unit.cap, ticks: { callback: unit.tick } }),
      },
      plugins: {
        legend: { display: series.length > 1, align: "end", labels: { boxWidth: 18, boxHeight: 0, padding: 12 } },
        tooltip: {
          callbacks: {
            title: (items) => items[0].parsed.x.toFixed(1) + " s",
            label: (item) => `${item.dataset.label}: ${unit.tip(item.parsed.y)}`,
          },
        },
      },
    },
    plugins: [cursor],
  });
  return {
    setTime(time) {
      cursor.time = time;
      chart.draw();
    },
    /** One more point of the first curve; of very many the older half is thinned out. */
    append(point) {
      const set = chart.data.datasets[0];
      set.data.push(point);
      if (set.data.length > 2000) set.data = set.data.filter((_, i) => i % 2 || i > 1000);
      chart.options.scales.x.min = set.data[0].x;
      chart.options.scales.x.max = point.x;
      chart.update("none");
    },
  };
}

/** Horizontal bars. unit(value) makes the label of a value, tick(value) that of the axis. */
function barChart(canvas, labels, values, tones, unit, tick = unit) {
  canvas.parentElement.style.height = `${Math.max(120, 46 + (labels.length > 16 ? 17 : 26) * labels.length)}px`;
  addChart(canvas, {
    type: "bar",
    data: { labels, datasets: [{ data: values, backgroundColor: tones.map(css), tones, maxBarThickness: 16 }] },
    options: {
      indexAxis: "y",
      layout: { padding: { right: 52 } },
      scales: {
        x: axis("", { beginAtZero: true, ticks: { callback: (v) => tick(v), maxTicksLimit: 5 } }),
        y: axis("", { grid: { display: false }, ticks: { autoSkip: false } }),
      },
      plugins: {
        legend: { display: false },
        tooltip: { callbacks: { label: (item) => unit(item.parsed.x) } },
      },
    },
    plugins: [{
      id: "values",
      afterDatasetsDraw(chart) {
        const { ctx } = chart;
        ctx.save();
        ctx.fillStyle = css("--ink");
        ctx.font = `12px ${css("--sans")}`;
        ctx.textBaseline = "middle";
        chart.getDatasetMeta(0).data.forEach((bar, i) => ctx.fillText(unit(values[i]), bar.x + 6, bar.y));
        ctx.restore();
      },
    }],
  });
}
