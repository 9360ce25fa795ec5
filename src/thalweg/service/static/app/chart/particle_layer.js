// Wind and current as moving particles, between the weather and the routes.

import { ImageLayer } from "../../vendor/ol.mjs";
import { colour, h } from "../common/elements.js";

const CELL = 12; // pixels between computed velocities
const SHARE = 1 / 900; // particles for each pixel
const LIFE = 90; // frames
const FRAME_MS = 40;
const STILL = 24; // frames drawn at once where the particles rest
const PIXELS = { wind: 0.16, current: 2.2 }; // a frame, for each m/s
export const MOVING = Object.keys(PIXELS);
const LONGEST = 9; // pixels of one step

export const lessMotion = matchMedia("(prefers-reduced-motion: reduce)");

// A layer of OpenLayers with a canvas of its own, which moves while the chart does not.
class CanvasLayer extends ImageLayer {
  render(frame) {
    return this.onRender(frame);
  }
}

export class ParticleLayer {
  wanted = false;
  resting = false; // while a voyage is calculated: the processor is for it
  particles = [];

  constructor(map, weather) {
    Object.assign(this, { map, weather });
    this.canvas = document.createElement("canvas");
    this.holder = h("div.particles", {}, this.canvas); // a bare canvas would be drawn on by the layers above
    this.layer = new CanvasLayer({ zIndex: 6, visible: false });
    this.layer.onRender = (frame) => this.#sized(frame.size);
    map.on("movestart", () => this.#stop());
    map.on("moveend", () => this.refresh());
    document.addEventListener("visibilitychange", () => this.refresh());
    lessMotion.addEventListener("change", () => this.weather.repaint());
  }

  // Whether particles stand in place of barbs and arrows now.
  get shown() {
    return this.wanted && !lessMotion.matches && this.weather.kind in PIXELS;
  }

  refresh() {
    this.#stop();
    const runs = this.shown && Boolean(this.weather.shown) && !document.hidden;
    this.layer.setVisible(this.shown);
    if (!runs) return;
    this.#velocities();
    const { width, height } = this.canvas;
    this.particles = Array.from({ length: Math.round(width * height * SHARE) }, () => this.#born(true));
    this.last = 0;
    if (this.resting) for (let i = 0; i < STILL; i++) this.#advance();
    else this.running = requestAnimationFrame((now) => this.#step(now));
  }

  rest(wanted) {
    if (wanted === this.resting) return;
    this.resting = wanted;
    this.refresh();
  }

  #stop() {
    cancelAnimationFrame(this.running);
    this.canvas.getContext("2d").clearRect(0, 0, this.canvas.width, this.canvas.height);
  }

  #sized([width, height]) {
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    return this.holder;
  }

  // Pixels of one frame on a raster of the screen; NaN where there are no data.
  #velocities() {
    const [width, height] = this.map.getSize();
    this.#sized([width, height]);
    this.columns = Math.ceil(width / CELL) + 1;
    this.rows = Math.ceil(height / CELL) + 1;
    const factor = PIXELS[this.weather.kind];
    this.flow = new Float32Array(2 * this.columns * this.rows);
    for (let j = 0; j < this.rows; j++) {
      for (let i = 0; i < this.columns; i++) {
        const found = this.weather.velocityAt(this.map.getCoordinateFromPixel([i * CELL, j * CELL]));
        const at = 2 * (j * this.columns + i);
        if (!found) { this.flow[at] = NaN; continue; }
        const size = Math.hypot(...found) * factor, least = size > LONGEST ? LONGEST / size : 1;
        this.flow[at] = found[0] * factor * least;
        this.flow[at + 1] = -found[1] * factor * least;
      }
    }
  }

  #born(anyAge) {
    return { x: Math.random() * this.canvas.width, y: Math.random() * this.canvas.height, age: anyAge ? Math.random() * LIFE : 0 };
  }

  #step(now) {
    this.running = requestAnimationFrame((next) => this.#step(next));
    if (now - this.last < FRAME_MS) return;
    this.last = now;
    this.#advance();
  }

  #advance() {
    const { canvas, columns, flow } = this, pen = canvas.getContext("2d");
    pen.globalCompositeOperation = "destination-in";
    pen.fillStyle = "rgba(0, 0, 0, 0.9)";
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.globalCompositeOperation = "source-over";
    pen.strokeStyle = colour("map-ink");
    pen.lineWidth = 1.3;
    pen.beginPath();
    for (const one of this.particles) {
      const at = 2 * (Math.round(one.y / CELL) * columns + Math.round(one.x / CELL));
      const dx = flow[at], dy = flow[at + 1];
      const x = one.x + dx, y = one.y + dy;
      one.age += 1;
      if (one.age > LIFE || !(x >= 0 && y >= 0 && x < canvas.width && y < canvas.height)) { Object.assign(one, this.#born(false)); continue; }
      pen.moveTo(one.x, one.y);
      pen.lineTo(x, y);
      Object.assign(one, { x, y });
    }
    pen.stroke();
  }
}
