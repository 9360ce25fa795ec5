// Weather on the chart: bands of colour, barbs or arrows, and hatching where there are no data.

import { ImageLayer, ImageCanvas, transformExtent } from "../../vendor/ol.mjs";
import { getBuffer } from "../common/api.js";
import { colour } from "../common/elements.js";

const HALF = 20037508.342789244;
const KNOT = 1852 / 3600;
const NX = 160, NY = 112, UNKNOWN = -32768, COLUMN = 3; // pixels of the screen for each computed one
const MOST_FRAMES = 48;

// Bands from calm to rough; never yellow, which is the land. In dark palettes the rough sea is the bright one.
export const KINDS = {
  waves: { title: "Significant wave height", unit: "m", step: 0.5, top: 10, marks: "arrows",
    stops: [[0, "#dbeef7"], [0.2, "#9fcbe8"], [0.4, "#639fd8"], [0.6, "#5266bd"], [0.8, "#5d3b96"], [1, "#4a1064"]],
    dark: [[0, "#22384a"], [0.2, "#2c5878"], [0.4, "#3b7fb0"], [0.6, "#6f8fd6"], [0.8, "#a98ae0"], [1, "#e0a0e8"]] },
  wind: { title: "Wind at 10 m", unit: "kn", step: 5, top: 60, marks: "barbs",
    stops: [[0, "#e6f1f4"], [0.25, "#a8d0d6"], [0.5, "#5fa3b8"], [0.75, "#4a6aa0"], [1, "#56307a"]],
    dark: [[0, "#24383f"], [0.25, "#2f6a72"], [0.5, "#4b9aac"], [0.75, "#86a8dc"], [1, "#d3a6ec"]] },
  current: { title: "Current", unit: "kn", step: 0.25, top: 4, marks: "arrows",
    stops: [[0, "#e4f1ee"], [0.3, "#97cfc3"], [0.6, "#4f9eaa"], [1, "#27508a"]],
    dark: [[0, "#23393a"], [0.3, "#2f7468"], [0.6, "#57b3ab"], [1, "#9fe0e0"]] },
  ice: { title: "Sea ice", unit: "", step: 0.1, top: 1, marks: "", stops: [[0, "#d9ecf5"], [1, "#ffffff"]], dark: [[0, "#30495a"], [1, "#dfe9ee"]] },
  depth: { title: "Depth", unit: "m", step: 10, top: 200, marks: "", stops: [[0, "#5aa9d6"], [0.1, "#8fc7e6"], [0.25, "#b7dcef"], [1, "#d9ecf5"]],
    dark: [[0, "#5d9cc0"], [0.1, "#427c9f"], [0.25, "#34617d"], [1, "#26445a"]] },
};

const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));

function colourAt(stops, share) {
  const x = Math.max(0, Math.min(1, share));
  let k = stops.findIndex(([at]) => at >= x);
  if (k <= 0) return rgb(stops[Math.max(0, k)][1]);
  const [a, ca] = stops[k - 1], [b, cb] = stops[k];
  const f = (x - a) / (b - a), from = rgb(ca), to = rgb(cb);
  return from.map((value, i) => Math.round(value + f * (to[i] - value)));
}

export function bandColours(kind) {
  const { step, top, stops, dark } = KINDS[kind];
  const count = Math.round(top / step), dim = Number(colour("weather-dim")), shown = Number(colour("dark")) ? dark : stops;
  return Array.from({ length: count + 1 }, (_, i) => colourAt(shown, i / count).map((value) => Math.round(value * dim)));
}

// The same as they appear on the sea of the chart, for its legend.
export function legendColours(kind) {
  const sea = rgb(colour("sea")), share = Number(colour("weather-alpha"));
  return bandColours(kind).map((band) => `rgb(${band.map((value, i) => Math.round(share * value + (1 - share) * sea[i])).join(",")})`);
}

class Frame {
  constructor(buffer) {
    const view = new DataView(buffer);
    [this.nx, this.ny, this.fields] = [4, 6, 8].map((at) => view.getUint16(at, true));
    this.scale = view.getFloat32(12, true);
    [this.south, this.north, this.west, this.east] = [16, 20, 24, 28].map((at) => view.getFloat32(at, true));
    this.values = new Int16Array(buffer, 32);
    this.top = mercator(this.north);
    this.bottom = mercator(this.south);
  }

  // Value of a field at a position (longitude, Mercator y), NaN where unknown; bilinear.
  at(field, lon, y) {
    const x = ((lon - this.west) / (this.east - this.west)) * (this.nx - 1);
    const r = ((this.top - y) / (this.top - this.bottom)) * (this.ny - 1);
    if (!(x >= 0 && r >= 0 && x <= this.nx - 1 && r <= this.ny - 1)) return NaN;
    const i = Math.min(this.nx - 2, x | 0), j = Math.min(this.ny - 2, r | 0), fx = x - i, fy = r - j;
    const at = field * this.nx * this.ny + j * this.nx + i, v = this.values;
    const a = v[at], b = v[at + 1], c = v[at + this.nx], d = v[at + this.nx + 1];
    if (a === UNKNOWN || b === UNKNOWN || c === UNKNOWN || d === UNKNOWN) {
      const near = v[field * this.nx * this.ny + Math.round(r) * this.nx + Math.round(x)];
      return near === UNKNOWN ? NaN : near * this.scale;
    }
    return ((a * (1 - fx) + b * fx) * (1 - fy) + (c * (1 - fx) + d * fx) * fy) * this.scale;
  }
}

const mercator = (lat) => Math.log(Math.tan(Math.PI / 4 + (lat * Math.PI) / 360));

export class WeatherLayer {
  kind = "";
  seas = [];
  time = null;
  step = 3 * 3600;
  particles = null;
  loading = false;
  onState = () => {};

  // of: where frames come from, and what is true of them: still (at no time), bare (what is unknown is not hatched)
  constructor(map, { zIndex = 5, address = (seas, query) => `/seas/${encodeURIComponent(seas)}/frames?${query}`, still = false, bare = false } = {}) {
    Object.assign(this, { map, address, still, bare });
    this.frames = new Map();
    this.shown = null;
    this.layer = new ImageLayer({ zIndex, source: new ImageCanvas({ canvasFunction: (...given) => this.#draw(...given), ratio: 1.4 }) });
    map.on("moveend", () => this.refresh());
  }

  set(values) {
    Object.assign(this, values);
    this.refresh();
  }

  repaint() {
    this.layer.getSource().changed();
    this.particles?.refresh();
  }

  // Wind or current [m/s] to the east and north at a place of the chart; null where unknown.
  velocityAt([x, y]) {
    const { frames } = this.shown;
    const parts = [0, 1].map((field) => this.#blended(field, this.#turned((x / HALF) * 180, frames[0]), (y / HALF) * Math.PI));
    return parts.every(Number.isFinite) ? parts : null;
  }

  // The fields at a place; null where nothing is loaded.
  fieldsAt(lon, lat) {
    if (!this.shown) return null;
    const [first] = this.shown.frames;
    return Array.from({ length: first.fields }, (_, i) => this.#blended(i, this.#turned(lon, first), mercator(lat)));
  }

  #blended(field, lon, y) {
    const { frames, share } = this.shown;
    return (1 - share) * frames[0].at(field, lon, y) + (share ? share * frames[1].at(field, lon, y) : 0);
  }

  async refresh() {
    this.layer.setVisible(Boolean(this.kind));
    this.loading = false;
    const ask = (this.ask = Symbol("ask"));
    const uploaded = this.seas.join("+");
    if (!this.kind || !uploaded || this.time === null) {
      this.shown = null;
      this.onState("");
      this.repaint();
      return;
    }
    const box = this.#box();
    const first = Math.floor(this.time / this.step) * this.step;
    const wanted = [first, this.still ? first : first + this.step].map((time) => this.#frame(uploaded, time, box));
    const ready = wanted.map((one) => one.frame);
    if (ready.every(Boolean)) this.#show(ready, first);
    else {
      this.loading = true;
      this.onState("loading");
      try {
        const frames = await Promise.all(wanted.map((one) => one.promise));
        if (ask === this.ask) this.#show(frames, first);
      } catch (problem) {
        if (ask === this.ask) { this.loading = false; this.onState("failed", problem); }
      }
    }
  }

  #show(frames, first) {
    this.loading = false;
    this.shown = { frames, share: (this.time - first) / this.step, kind: this.kind };
    const known = frames.some((frame) => frame.values.subarray(0, frame.nx * frame.ny).some((v) => v !== UNKNOWN));
    this.onState(known ? "shown" : "no data");
    this.repaint();
  }

  #box() {
    const [west, south, east, north] = transformExtent(this.map.getView().calculateExtent(), "EPSG:3857", "EPSG:4326");
    const wide = Math.min(360, (east - west) * 1.3), high = (north - south) * 1.3;
    const grid = 2 ** Math.round(Math.log2(Math.max(wide / 8, 0.01)));
    const snap = (value, up) => (up ? Math.ceil(value / grid) : Math.floor(value / grid)) * grid;
    let w = snap((west + east - wide) / 2, false), e = snap((west + east + wide) / 2, true);
    if (e - w > 360) [w, e] = [(w + e) / 2 - 180, (w + e) / 2 + 180];
    const shift = Math.round(w / 360) * 360;
    return [Math.max(-85, snap((south + north - high) / 2, false)), Math.min(85, snap((south + north + high) / 2, true)), w - shift, e - shift].map((v) => Number(v.toFixed(4)));
  }

  #frame(seas, time, box) {
    const key = [seas, this.kind, time, box].join("|");
    let entry = this.frames.get(key);
    if (!entry) {
      const query = new URLSearchParams({ variable: this.kind, time: new Date(time * 1000).toISOString().slice(0, 19) + "Z", box: box.join(","), nx: NX, ny: NY });
      entry = { frame: null };
      entry.promise = getBuffer(this.address(seas, query)).then((buffer) => (entry.frame = new Frame(buffer)));
      entry.promise.catch(() => this.frames.delete(key));
      this.frames.set(key, entry);
      if (this.frames.size > MOST_FRAMES) this.frames.delete(this.frames.keys().next().value);
    }
    return entry;
  }

  #draw(extent, resolution, ratio, size) {
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = size.map((n) => Math.max(1, Math.round(n)));
    if (!this.shown || !this.kind) return canvas;
    const { frames, share, kind } = this.shown;
    const { step } = KINDS[kind];
    const colours = bandColours(kind);
    const w = Math.ceil(canvas.width / COLUMN), hgt = Math.ceil(canvas.height / COLUMN);
    const image = new ImageData(w, hgt), missing = new ImageData(w, hgt);
    const pixel = (resolution / ratio) * COLUMN;
    const alpha = Math.round(255 * Number(colour("weather-alpha")));
    let holes = false;
    for (let j = 0; j < hgt; j++) {
      const y = ((extent[3] - (j + 0.5) * pixel) / HALF) * Math.PI;
      for (let i = 0; i < w; i++) {
        const lon = this.#turned(((extent[0] + (i + 0.5) * pixel) / HALF) * 180, frames[0]);
        const value = this.#value(frames, share, kind, lon, y);
        const at = 4 * (j * w + i);
        if (Number.isNaN(value)) { missing.data[at + 3] = 255; holes = true; continue; }
        if (value === null) continue;
        const c = colours[Math.max(0, Math.min(colours.length - 1, Math.floor(value / step)))];
        image.data[at] = c[0]; image.data[at + 1] = c[1]; image.data[at + 2] = c[2]; image.data[at + 3] = alpha;
      }
    }
    const context = canvas.getContext("2d");
    this.#paste(context, image);
    if (holes && !this.bare) this.#hatch(canvas, missing);
    if (KINDS[kind].marks && !this.particles?.shown) this.#marks(context, canvas, extent, resolution / ratio, ratio);
    return canvas;
  }

  #turned(lon, frame) {
    return lon - Math.round((lon - (frame.west + frame.east) / 2) / 360) * 360;
  }

  // NaN: no data; null: not loaded yet.
  #value(frames, share, kind, lon, y) {
    const [a, b] = frames;
    if (y > a.top || y < a.bottom || lon < a.west || lon > a.east) return null;
    const one = (frame) => {
      if (kind === "wind" || kind === "current") return Math.hypot(frame.at(0, lon, y), frame.at(1, lon, y)) / KNOT;
      return frame.at(0, lon, y);
    };
    return (1 - share) * one(a) + (share ? share * one(b) : 0);
  }

  #paste(context, image) {
    const small = document.createElement("canvas");
    [small.width, small.height] = [image.width, image.height];
    small.getContext("2d").putImageData(image, 0, 0);
    context.imageSmoothingEnabled = true;
    context.drawImage(small, 0, 0, image.width * COLUMN, image.height * COLUMN);
  }

  #hatch(canvas, missing) {
    const mask = document.createElement("canvas");
    [mask.width, mask.height] = [canvas.width, canvas.height];
    const context = mask.getContext("2d");
    this.#paste(context, missing);
    context.globalCompositeOperation = "source-in";
    const tile = document.createElement("canvas");
    tile.width = tile.height = 8;
    const pen = tile.getContext("2d");
    pen.strokeStyle = colour("hatch");
    pen.lineWidth = 1;
    for (const shift of [-8, 0, 8]) { pen.moveTo(shift, 8); pen.lineTo(shift + 8, 0); }
    pen.stroke();
    context.fillStyle = context.createPattern(tile, "repeat");
    context.fillRect(0, 0, mask.width, mask.height);
    canvas.getContext("2d").drawImage(mask, 0, 0);
  }

  #marks(context, canvas, extent, pixel, ratio) {
    const { frames, kind } = this.shown;
    const gap = 58 * ratio;
    context.strokeStyle = context.fillStyle = colour("map-ink");
    context.globalAlpha = 0.62;
    context.lineWidth = 1.1 * ratio;
    context.lineCap = "round";
    const x0 = gap - ((((extent[0] / pixel) % gap) + gap) % gap), y0 = (((extent[3] / pixel) % gap) + gap) % gap;
    for (let y = y0; y < canvas.height + gap; y += gap) {
      for (let x = x0; x < canvas.width + gap; x += gap) {
        const my = ((extent[3] - y * pixel) / HALF) * Math.PI;
        const lon = this.#turned(((extent[0] + x * pixel) / HALF) * 180, frames[0]);
        const first = kind === "waves" ? 1 : 0;
        const east = this.#blended(first, lon, my), north = this.#blended(first + 1, lon, my);
        if (!Number.isFinite(east) || !Number.isFinite(north) || Math.hypot(east, north) < 1e-3 || (kind === "waves" && this.#blended(0, lon, my) < 0.05)) continue;
        context.save();
        context.translate(x, y);
        context.rotate(Math.atan2(east, north));
        if (kind === "wind") barb(context, Math.hypot(east, north) / KNOT, ratio);
        else arrow(context, kind === "current" ? Math.min(24, 6 + 14 * Math.hypot(east, north)) : 13, ratio);
        context.restore();
      }
    }
    context.globalAlpha = 1;
  }
}

function arrow(context, length, ratio) {
  const half = (length / 2) * ratio, head = 4 * ratio;
  context.beginPath();
  context.moveTo(0, half); context.lineTo(0, -half);
  context.moveTo(-head, -half + head); context.lineTo(0, -half); context.lineTo(head, -half + head);
  context.stroke();
}

// A wind barb: the staff points to where the wind comes from; 5, 10 and 50 kn feathers.
function barb(context, knots, ratio) {
  const staff = 22 * ratio, feather = 8 * ratio, space = 3.6 * ratio;
  let left = Math.round(knots / 5) * 5;
  context.beginPath();
  if (left < 5) { context.arc(0, 0, 2.5 * ratio, 0, 7); context.stroke(); return; }
  context.moveTo(0, 0); context.lineTo(0, staff);
  let at = staff;
  for (; left >= 50; left -= 50) {
    context.moveTo(0, at); context.lineTo(-feather, at - space / 2); context.lineTo(0, at - space);
    at -= space * 1.4;
  }
  for (; left >= 10; left -= 10) { context.moveTo(0, at); context.lineTo(-feather, at + space); at -= space; }
  if (left >= 5) {
    if (at === staff) at -= space;
    context.moveTo(0, at); context.lineTo(-feather / 2, at + space / 2);
  }
  context.stroke();
}
