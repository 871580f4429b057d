"use strict";
(() => {
  const { curves } = pageData();
  byId("coverage-figure").hidden = curves.length === 0;
  if (curves.length === 0) return;
  curveChart(byId("coverage"), curves.map((c, i) => ({
    label: c.name, t: c.t, y: c.fraction, tone: toneOf(i), width: 2, dash: dashOf(i),
  })), "explored");
})();
