// The Pareto front of time against fuel or cost: hover, drag or arrow keys choose a route.

import { fill, h } from "../common/elements.js";
import { difference, duration, known, number, signed, signedDuration } from "../common/format.js";
import { selection } from "../common/selection.js";
import { svg as s, ticks } from "../common/svg_parts.js";

export class FrontDiagram {
  constructor(plan) {
    this.plan = plan;
    const { front } = plan;
    this.column = Object.keys(front.points[0]).find((name) => name === `${front.criterion}_${front.unit.toLowerCase()}`);
    this.points = front.points.map((row, i) => ({ ...row, i, x: row.time_h, y: row[this.column] })).filter((row) => known(row.x) && known(row.y));
    this.bound = front.certain.map((row) => [row.time_h, row[this.column]]).filter((row) => row.every(known));
    this.base = (plan.comparison || []).map((row) => ({ x: row.time_h, y: row.value, speed: row.speed_kn, feasible: row.feasible })).filter((row) => known(row.x) && known(row.y));
    this.element = h("div.front");
    this.svg = s("svg", { role: "group", "aria-label": `Front of time against ${front.criterion}. Arrow keys move along it.` });
    this.element.append(this.svg);
    this.svg.addEventListener("pointerdown", (event) => { this.svg.setPointerCapture(event.pointerId); this.dragging = true; this.#drag(event); });
    this.svg.addEventListener("pointermove", (event) => this.#drag(event));
    for (const end of ["pointerup", "pointercancel"]) this.svg.addEventListener(end, () => { this.dragging = false; });
    this.svg.addEventListener("mousedown", (event) => { event.preventDefault(); this.#focus(); }); // the focus stays on the chosen point
    this.svg.addEventListener("keydown", (event) => this.#key(event));
  }

  draw() {
    const width = this.element.clientWidth, height = this.element.clientHeight;
    if (width < 50 || height < 50 || !this.points.length) return;
    const { front } = this.plan;
    const left = 64, right = 16, top = 12, bottom = 34;
    const xs = this.points.map((p) => p.x), ys = [...this.points.map((p) => p.y)];
    const pad = (a, b) => Math.max(1e-9, b - a) * 0.06;
    const x0 = Math.min(...xs), x1 = Math.max(...xs), y1 = Math.max(...ys), least = Math.min(...ys);
    const y0 = Math.min(least, Math.max(this.#boundAt(x1), least - 0.6 * (y1 - least))); // a far bound is cut off
    const [xa, xb, ya, yb] = [x0 - pad(x0, x1), x1 + pad(x0, x1), y0 - pad(y0, y1), y1 + pad(y0, y1)];
    this.px = (x) => left + ((x - xa) / (xb - xa)) * (width - left - right);
    this.py = (y) => height - bottom - ((y - ya) / (yb - ya)) * (height - top - bottom);
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const focused = this.svg.contains(document.activeElement);
    this.svg.replaceChildren();
    const days = xb - xa > 60;
    for (const x of ticks(days ? xa / 24 : xa, days ? xb / 24 : xb, Math.max(3, width / 110))) {
      const at = this.px(days ? x * 24 : x);
      this.svg.append(s("line", { class: "axis", x1: at, x2: at, y1: top, y2: height - bottom }), s("text", { x: at, y: height - bottom + 15, "text-anchor": "middle" }, `${Number(x.toFixed(2))} ${days ? "d" : "h"}`));
    }
    for (const y of ticks(ya, yb, Math.max(2, height / 46))) this.svg.append(s("line", { class: "axis", x1: left, x2: width - right, y1: this.py(y), y2: this.py(y) }), s("text", { x: left - 8, y: this.py(y) + 4, "text-anchor": "end" }, number(y, y1 - y0 < 5 ? 1 : 0)));
    this.svg.append(s("text", { x: left - 8, y: 10, "text-anchor": "end" }, front.unit), s("text", { x: width - right, y: height - 4, "text-anchor": "end" }, "duration of the voyage"));
    const from = this.bound.length ? Math.max(this.bound[0][0], xa) : xb;
    if (from < xb) {
      const times = [from, ...this.bound.map(([x]) => x).filter((x) => x > from && x < xb), xb];
      const line = times.map((x, k) => `${k ? "L" : "M"}${this.px(x)} ${this.py(Math.min(yb, Math.max(ya, this.#boundAt(x))))}`).join("");
      this.svg.append(s("path", { class: "below", d: `${line}V${this.py(ya)}H${this.px(from)}Z` }), s("path", { class: "lower", d: line }));
    }
    const order = this.order = this.points.slice().sort((a, b) => a.x - b.x);
    this.svg.append(s("path", { class: "join", d: order.map((p, k) => `${k ? "L" : "M"}${this.px(p.x)} ${this.py(p.y)}`).join("") }));
    for (const p of this.base) {
      if (p.x < xa || p.x > xb || p.y < ya || p.y > yb) continue;
      const dot = s("circle", { class: "base", cx: this.px(p.x), cy: this.py(p.y), r: 3.5 });
      dot.append(s("title", {}, `Weather ignored, ${number(p.speed, 1)} kn all the way${p.feasible ? "" : ": breaks a limit"}`));
      this.svg.append(dot);
    }
    this.dots = order.map((p) => {
      const dot = s("circle", { cx: this.px(p.x), cy: this.py(p.y), r: 5, role: "button", "aria-label": `Route ${p.i + 1}: ${duration(p.x)}, ${number(p.y, 1)} ${front.unit}` });
      dot.addEventListener("click", () => this.#choose(p.i)); // of a screen reader
      dot.addEventListener("pointerenter", () => { if (!this.dragging) selection.hover(p.i); });
      dot.addEventListener("pointerleave", () => selection.hover(null));
      dot.number = p.i;
      this.svg.append(dot);
      return dot;
    });
    this.mark();
    if (focused) this.#focus();
  }

  // The value that no route of a duration is below; infinite where none is known.
  #boundAt(x) {
    const next = this.bound.findIndex(([at]) => at >= x);
    if (!this.bound.length || (next === 0 && this.bound[0][0] > x)) return Infinity;
    if (next < 1) return this.bound[next < 0 ? this.bound.length - 1 : 0][1];
    const [[a, low], [b, high]] = [this.bound[next - 1], this.bound[next]];
    return low + ((x - a) / (b - a)) * (high - low);
  }

  // The chosen and the hovered route are marked.
  mark() {
    const entry = this.order?.find((p) => p.i === selection.route) || this.order?.[0];
    for (const dot of this.dots || []) {
      const chosen = dot.number === selection.route;
      dot.setAttribute("aria-pressed", String(chosen));
      dot.setAttribute("r", chosen ? 7 : dot.number === selection.hovered ? 7 : 5);
      dot.setAttribute("tabindex", dot.number === entry.i ? 0 : -1);
    }
    this.#facts();
  }

  #facts() {
    if (!this.facts) return;
    const pointed = this.points.find((one) => one.i === selection.hovered && one.i !== selection.route);
    const p = pointed || this.points.find((one) => one.i === selection.route) || this.points[0];
    const fastest = this.points.reduce((a, b) => (b.x < a.x ? b : a));
    const { unit: unitText, criterion } = this.plan.front;
    const decimals = p.y < 1000 ? 1 : 0;
    fill(this.facts, h("p", {}, h("b", {}, `Route ${p.i + 1} of ${this.points.length}`), pointed ? ", pointed at" : ""), h("p", {}, `${duration(p.x)}, ${number(p.y, decimals)} ${unitText}`),
      p === fastest ? h("p", {}, "The fastest of all.") : h("p", {}, `${signedDuration(difference(p.x, fastest.x))} and ${signed(difference(p.y, fastest.y, decimals), decimals)} ${unitText} against the fastest.`),
      p.gap < 1 ? h("p", {}, `At its time no route has a ${criterion} more than ${number(Math.ceil(1000 * p.gap) / 10, 1)} % lower.`) : h("p", {}, `How much lower the ${criterion} could be at its time is not known.`),
      h("p", {}, "Grey: no route is there. Rings: weather ignored, constant speed."));
  }

  #choose(route) {
    selection.hover(null);
    selection.choose(route);
  }

  #focus() {
    this.dots.find((dot) => dot.getAttribute("tabindex") === "0").focus({ preventScroll: true });
  }

  #key(event) {
    const last = this.order.length - 1, at = this.order.findIndex((p) => p.i === selection.route);
    const to = { ArrowRight: at + 1, ArrowDown: at + 1, ArrowLeft: at - 1, ArrowUp: at - 1, Home: 0, End: last, Enter: at, " ": at }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    this.#choose(this.order[Math.max(0, Math.min(last, to))].i);
    this.#focus();
  }

  #drag(event) {
    if (!this.dragging || !this.px) return;
    const box = this.svg.getBoundingClientRect();
    const x = event.clientX - box.left, y = event.clientY - box.top;
    const near = this.points.reduce((a, b) => (Math.hypot(this.px(b.x) - x, this.py(b.y) - y) < Math.hypot(this.px(a.x) - x, this.py(a.y) - y) ? b : a));
    this.#choose(near.i);
  }
}
