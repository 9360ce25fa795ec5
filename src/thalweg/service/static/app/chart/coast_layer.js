// Land and coast of the chart, in cells of the coastline that plans use.

import { VectorLayer, VectorSource, Feature, MultiPolygon, MultiLineString, Style, Fill, Stroke, transformExtent } from "../../vendor/ol.mjs";
import { get } from "../common/api.js";
import { colour } from "../common/elements.js";

const LEVELS = [["c", 2.8], ["l", 5.6], ["i", 40]]; // resolutions of GSHHG, each up to a zoom
const HALF = 20037508.342789244;
const LIMIT = 85.05;

function toMap(flat) {
  const points = [];
  for (let i = 0; i < flat.length; i += 2) {
    const lat = Math.max(-LIMIT, Math.min(LIMIT, flat[i + 1]));
    points.push([(flat[i] * HALF) / 180, (Math.log(Math.tan(Math.PI / 4 + (lat * Math.PI) / 360)) * HALF) / Math.PI]);
  }
  return points;
}

export class CoastLayers {
  waiting = 0; // cells that are on their way

  constructor(map) {
    this.map = map;
    this.levels = LEVELS.map(([name, to]) => {
      const options = { visible: false, updateWhileInteracting: true, updateWhileAnimating: true };
      return { name, to, index: null, cells: null, asked: new Set(), drawn: new Set(), land: new VectorLayer({ ...options, source: new VectorSource(), zIndex: 10 }), coast: new VectorLayer({ ...options, source: new VectorSource(), zIndex: 11 }) };
    });
    map.on("moveend", () => this.load());
  }

  get layers() {
    return this.levels.flatMap((level) => [level.land, level.coast]);
  }

  paint() {
    const fill = new Style({ fill: new Fill({ color: colour("land") }) });
    const line = new Style({ stroke: new Stroke({ color: colour("coast"), width: 1 }) });
    for (const level of this.levels) {
      level.land.setStyle(fill);
      level.coast.setStyle(line);
    }
  }

  // The crude coast of the view comes first and stays until the one for the zoom is there.
  load() {
    const zoom = this.map.getView().getZoom();
    this.wanted = this.levels.find((one) => zoom <= one.to) || this.levels.at(-1);
    this.#show();
    for (const level of new Set([this.levels[0], this.wanted])) this.#read(level);
  }

  async #read(level) {
    this.#waitsFor(1);
    try {
      level.index ||= get(`/coast/${level.name}`);
      const { side, cells } = await level.index;
      level.cells ||= { side, names: new Set(cells) };
    } catch {
      level.index = null;
      this.#again();
      return;
    } finally {
      this.#waitsFor(-1);
    }
    for (const name of this.#inView(level)) {
      if (level.asked.has(name)) continue;
      level.asked.add(name);
      this.#fetch(level, name);
    }
    this.#show();
  }

  // Names of the cells with land in the view.
  #inView({ cells: { side, names } }) {
    const [west, south, east, north] = transformExtent(this.map.getView().calculateExtent(), "EPSG:3857", "EPSG:4326");
    const columns = Math.round(360 / side), found = new Set();
    for (let k = Math.floor((Math.max(west, -540) + 180) / side); k <= Math.floor((Math.min(east, 540) + 180) / side); k++) {
      const column = ((k % columns) + columns) % columns;
      for (let row = Math.floor((Math.max(south, -89.9) + 90) / side); row <= Math.floor((Math.min(north, 89.9) + 90) / side); row++) {
        const name = `${column}_${row}`;
        if (names.has(name)) found.add(name);
      }
    }
    return found;
  }

  #ready(level) {
    return Boolean(level.cells) && [...this.#inView(level)].every((name) => level.drawn.has(name));
  }

  // The wanted level, and under it the best that is there.
  #show() {
    const place = this.levels.indexOf(this.wanted);
    const best = this.levels.slice(0, place + 1).reverse().find((level) => this.#ready(level));
    for (const level of this.levels) {
      const on = level === this.wanted || level === best;
      level.land.setVisible(on);
      level.coast.setVisible(level === (best || this.wanted));
    }
  }

  // What could not be read is read again after a pause.
  #again() {
    clearTimeout(this.retry);
    this.retry = setTimeout(() => this.load(), 5000);
  }

  async #fetch(level, name) {
    this.#waitsFor(1);
    try {
      const { land, coast } = await get(`/coast/${level.name}/${name}.json`);
      level.land.getSource().addFeature(new Feature(new MultiPolygon(land.map((rings) => rings.map(toMap)))));
      level.coast.getSource().addFeature(new Feature(new MultiLineString(coast.map(toMap))));
      level.drawn.add(name);
      this.#show();
    } catch {
      level.asked.delete(name);
      this.#again();
    } finally {
      this.#waitsFor(-1);
    }
  }

  // Until the land is drawn the chart says so: water without land misleads.
  #waitsFor(change) {
    this.waiting += change;
    clearTimeout(this.timer);
    const note = document.getElementById("coast-state");
    if (!this.waiting) note.hidden = true;
    else this.timer = setTimeout(() => { note.textContent = this.#ready(this.levels[0]) ? "The finer coastline is loading …" : "The coastline is loading …"; note.hidden = !this.waiting; }, 250);
  }
}
