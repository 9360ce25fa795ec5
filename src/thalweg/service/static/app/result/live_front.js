// The front while it is searched: points appear as they are found.

import { fill, h } from "../common/elements.js";
import { duration, number } from "../common/format.js";
import { svg, ticks } from "../common/svg_parts.js";

const WIDTH = 312, HEIGHT = 168, LEFT = 52, RIGHT = 8, TOP = 8, BOTTOM = 24;

export class LiveFront {
  constructor() {
    this.holder = h("div.live-front", { hidden: true });
    this.element = this.holder;
  }

  clear() {
    this.points = this.box = undefined;
    this.holder.hidden = true;
    fill(this.holder);
  }

  // data: {points: [[hours, value]], unit}
  show({ points, unit }) {
    if (!points.length) return;
    this.before = this.points || [];
    this.points = points;
    const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]);
    this.box ||= [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    this.box = [Math.min(this.box[0], ...xs), Math.max(this.box[1], ...xs), Math.min(this.box[2], ...ys), Math.max(this.box[3], ...ys)];
    const [x0, x1, y0, y1] = this.box, dx = 0.05 * Math.max(1e-9, x1 - x0), dy = 0.06 * Math.max(1e-9, y1 - y0);
    const px = (x) => LEFT + ((x - x0 + dx) / (x1 - x0 + 2 * dx)) * (WIDTH - LEFT - RIGHT);
    const py = (y) => HEIGHT - BOTTOM - ((y - y0 + dy) / (y1 - y0 + 2 * dy)) * (HEIGHT - TOP - BOTTOM);
    const drawing = svg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": `Front so far: ${points.length} routes, ${duration(x0)} to ${duration(x1)}` });
    const days = x1 - x0 > 48;
    for (const x of ticks(days ? x0 / 24 : x0, days ? x1 / 24 : x1, 4)) drawing.append(svg("line", { class: "axis", x1: px(days ? x * 24 : x), x2: px(days ? x * 24 : x), y1: TOP, y2: HEIGHT - BOTTOM }), svg("text", { x: px(days ? x * 24 : x), y: HEIGHT - 8, "text-anchor": "middle" }, `${Number(x.toFixed(2))} ${days ? "d" : "h"}`));
    for (const y of ticks(y0, y1, 4)) drawing.append(svg("line", { class: "axis", x1: LEFT, x2: WIDTH - RIGHT, y1: py(y), y2: py(y) }), svg("text", { x: LEFT - 6, y: py(y) + 4, "text-anchor": "end" }, number(y, y1 - y0 < 5 ? 1 : 0)));
    for (const [x, y] of this.before) drawing.append(svg("circle", { class: "before", cx: px(x), cy: py(y), r: 1.6 }));
    const step = Math.max(1, Math.floor(points.length / 120));
    points.forEach(([x, y], i) => { if (i % step === 0) drawing.append(svg("circle", { cx: px(x), cy: py(y), r: 2.2 })); });
    this.holder.hidden = false;
    fill(this.holder, h("h2.block", {}, "Front so far"), h("p.facts", {}, `${number(points.length)} routes; time against ${unit}`), h("div.drawing", {}, drawing));
  }
}
