// Land and coast of the chart, in cells of the coastline that plans use.

import { VectorLayer, VectorSource, Feature, MultiPolygon, MultiLineString, Style, Fill, Stroke, transformExtent } from "../../vendor/ol.mjs";
import { get } from "../common/api.js";
import { colour } from "../common/elements.js";

const LEVELS = [["c", 0, 3.1], ["l", 3.1, 6.2], ["i", 6.2, 40]];
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
  constructor(map) {
    this.map = map;
    this.levels = LEVELS.map(([name, from, to]) => this.#level(name, from, to));
    map.on("moveend", () => this.load());
  }

  get layers() {
    return this.levels.flatMap((level) => [level.land, level.coast]);
  }

  #level(name, from, to) {
    const options = { minZoom: from, maxZoom: to, updateWhileInteracting: true, updateWhileAnimating: true };
    return {
      name, from, to, index: null, asked: new Set(),
      land: new VectorLayer({ ...options, source: new VectorSource(), zIndex: 10 }),
      coast: new VectorLayer({ ...options, source: new VectorSource(), zIndex: 11 }),
    };
  }

  paint() {
    const fill = new Style({ fill: new Fill({ color: colour("land") }) });
    const line = new Style({ stroke: new Stroke({ color: colour("coast"), width: 1 }) });
    for (const level of this.levels) {
      level.land.setStyle(fill);
      level.coast.setStyle(line);
    }
  }

  async load() {
    const zoom = this.map.getView().getZoom();
    const level = this.levels.find((one) => zoom > one.from && zoom <= one.to) || this.levels[0];
    if (!level.index) {
      level.index ||= get(`/coast/${level.name}`);
      level.index.catch(() => { level.index = null; });
    }
    let index;
    try {
      index = await level.index;
    } catch {
      this.#again();
      return;
    }
    const { side, cells } = index;
    const there = new Set(cells);
    const [west, south, east, north] = transformExtent(this.map.getView().calculateExtent(), "EPSG:3857", "EPSG:4326");
    const columns = Math.round(360 / side);
    const from = Math.floor((Math.max(west, -540) + 180) / side);
    const to = Math.floor((Math.min(east, 540) + 180) / side);
    for (let k = from; k <= to; k++) {
      const column = ((k % columns) + columns) % columns;
      for (let row = Math.floor((Math.max(south, -89.9) + 90) / side); row <= Math.floor((Math.min(north, 89.9) + 90) / side); row++) {
        const name = `${column}_${row}`;
        if (there.has(name) && !level.asked.has(name)) {
          level.asked.add(name);
          this.#fetch(level, name);
        }
      }
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
    } catch {
      level.asked.delete(name);
      this.#again();
    } finally {
      this.#waitsFor(-1);
    }
  }

  // Until the land is drawn the chart says so: water without land misleads.
  #waitsFor(change) {
    this.open = (this.open || 0) + change;
    clearTimeout(this.timer);
    const note = document.getElementById("coast-state");
    if (!this.open) note.hidden = true;
    else this.timer = setTimeout(() => { note.hidden = !this.open; }, 250);
  }
}
