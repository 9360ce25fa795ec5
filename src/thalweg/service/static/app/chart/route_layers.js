// Routes, isochrones, ship, ends and areas on the chart.

import { VectorLayer, VectorSource, Feature, LineString, Point, Polygon, Style, Fill, Stroke, Circle, RegularShape, Text, fromLonLat } from "../../vendor/ol.mjs";
import { colour } from "../common/elements.js";
import { time as timeText, unwrapped } from "../common/format.js";

const NEAR_END = 0.07; // of the voyage
const FONT = '12px system-ui, "DejaVu Sans", sans-serif';

// Slow to fast, evenly spaced in lightness; on dark charts the slow ones are lighter.
const SPEED_COLOURS = ["#2b1d6b", "#4b2a93", "#7a2f9c", "#a83a93", "#cf4f7f", "#ea6f66", "#f79a56", "#f9c86b"];
const DARK_SPEED_COLOURS = ["#7a6be0", "#8d6fd2", "#a170c4", "#b872b2", "#cf749c", "#e68184", "#f79a62", "#f9c86b"];

// The colours of speeds in the palette of the page.
export function speedColours() {
  const dim = Number(colour("speed-dim"));
  return (Number(colour("dark")) ? DARK_SPEED_COLOURS : SPEED_COLOURS).map((hex) => `rgb(${[1, 3, 5].map((i) => Math.round(dim * parseInt(hex.slice(i, i + 2), 16))).join(",")})`);
}

export function line(points) {
  const lons = unwrapped(points.map((p) => p[0]));
  return new LineString(points.map((p, i) => fromLonLat([lons[i], p[1]])));
}

const stroke = (color, width, lineDash) => new Style({ stroke: new Stroke({ color, width, lineDash, lineCap: "round", lineJoin: "round" }) });

function layer(zIndex, options = {}) {
  return new VectorLayer({ source: new VectorSource(), zIndex, updateWhileInteracting: true, updateWhileAnimating: true, ...options });
}

export class RouteLayers {
  constructor() {
    this.isochrones = layer(12, { declutter: true });
    this.beside = layer(20);
    this.others = layer(21);
    this.near = layer(22);
    this.chosen = layer(23);
    this.marks = layer(24, { declutter: true });
    this.ship = layer(27);
    this.ends = layer(26, { declutter: true });
    this.faults = layer(25);
    this.layers = [this.isochrones, this.beside, this.others, this.near, this.chosen, this.faults, this.marks, this.ends, this.ship];
  }

  clear() {
    for (const one of [this.isochrones, this.beside, this.others, this.near, this.chosen, this.marks, this.ship, this.faults]) one.getSource().clear();
  }

  showIsochrones(found) {
    const source = this.isochrones.getSource();
    source.clear();
    if (!found) return;
    found.lines.forEach(({ hours, points }) => {
      const feature = new Feature(line(points));
      const labelled = Math.round(hours / found.step_h) % 2 === 0;
      feature.setStyle(() => [
        stroke(colour("isochrone"), 0.8),
        ...(labelled ? [new Style({ text: new Text({ text: `${hours} h`, placement: "line", font: '11px system-ui, "DejaVu Sans", sans-serif', fill: new Fill({ color: colour("isochrone") }), stroke: new Stroke({ color: colour("sea"), width: 3 }) }) })] : []),
      ]);
      source.addFeature(feature);
    });
  }

  showBeside(points) {
    const source = this.beside.getSource();
    source.clear();
    if (!points) return;
    const feature = new Feature(line(points));
    feature.setStyle(() => [stroke(colour("casing"), 3.5), stroke(colour("blind"), 1.5, [6, 6])]);
    source.addFeature(feature);
  }

  // Many routes of several runs: [{paint, dash, lines}].
  showBundles(groups, faint) {
    const source = this.others.getSource();
    source.clear();
    for (const { paint, dash, lines } of groups) {
      for (const points of lines) {
        const feature = new Feature(line(points));
        feature.setStyle(() => stroke(colour(paint) + (faint ? "55" : "b0"), dash ? 2 : 1.4, dash));
        source.addFeature(feature);
      }
    }
  }

  showOthers(routes, chosen, hovered) {
    const source = this.others.getSource();
    source.clear();
    routes.forEach((points, number) => {
      if (number === chosen || !points) return;
      const feature = new Feature({ geometry: line(points), number });
      const hot = number === hovered;
      feature.setStyle(() => [stroke(colour("casing"), hot ? 5 : 3), stroke(hot ? colour("route") : colour("other"), hot ? 3 : 1.4)]);
      source.addFeature(feature);
    });
  }

  // The chosen route: of one colour, or by speed over the range of the ship.
  showChosen(points, speeds, range, number) {
    const source = this.chosen.getSource();
    source.clear();
    if (!points) return;
    const whole = new Feature({ geometry: line(points), number });
    whole.setStyle(() => [stroke(colour("casing"), 6), stroke(colour("route"), 3.2)]);
    source.addFeature(whole);
    if (!speeds || !range) return;
    const lons = unwrapped(points.map((p) => p[0]));
    const classOf = (v) => Math.max(0, Math.min(SPEED_COLOURS.length - 1, Math.floor(((v - range[0]) / Math.max(1e-9, range[1] - range[0])) * SPEED_COLOURS.length)));
    for (let i = 0; i + 1 < points.length; ) {
      const kind = classOf(speeds[i]);
      let j = i + 1;
      while (j + 1 < points.length && classOf(speeds[j]) === kind) j++;
      const part = new Feature(new LineString(points.slice(i, j + 1).map((p, k) => fromLonLat([lons[i + k], p[1]]))));
      part.setStyle(() => stroke(speedColours()[kind], 3.6));
      source.addFeature(part);
      i = j;
    }
  }

  // Parts of the chosen route that are near a limit.
  showNear(parts) {
    const source = this.near.getSource();
    source.clear();
    for (const points of parts) {
      const feature = new Feature(line(points));
      feature.setStyle(() => stroke(colour("near"), 12));
      source.addFeature(feature);
    }
  }

  // Waypoints, and the time along the route every 12 or 24 hours.
  showMarks(waypoints, profile) {
    const source = this.marks.getSource();
    source.clear();
    const lons = unwrapped(waypoints.map((w) => w.lon));
    waypoints.forEach((w, i) => {
      const feature = new Feature(new Point(fromLonLat([lons[i], w.lat])));
      feature.setStyle(() => new Style({ image: new Circle({ radius: 2.6, fill: new Fill({ color: colour("casing") }), stroke: new Stroke({ color: colour("route"), width: 1.4 }), declutterMode: "none" }) }));
      source.addFeature(feature);
    });
    if (!profile) return;
    const hours = (profile.time.at(-1) - profile.time[0]) / 3600;
    const clear = NEAR_END * 3600 * hours; // the name of the port stands there
    const every = (hours > 240 ? 48 : hours > 72 ? 24 : hours > 24 ? 12 : hours > 8 ? 3 : hours > 3 ? 1 : 0.5) * 3600;
    const turns = unwrapped(profile.lon);
    for (let t = Math.ceil(profile.time[0] / every) * every; t < profile.time.at(-1); t += every) {
      const i = profile.time.findIndex((value) => value >= t);
      const feature = new Feature(new Point(fromLonLat([turns[i], profile.lat[i]])));
      const named = Math.min(t - profile.time[0], profile.time.at(-1) - t) > clear;
      feature.setStyle(() => new Style({
        image: new Circle({ radius: 4, fill: new Fill({ color: colour("route") }), stroke: new Stroke({ color: colour("casing"), width: 1.5 }), declutterMode: "none" }),
        text: named ? new Text({ text: t % 86400 && every < 43200 && t >= profile.time[0] + every ? timeText(t).split(" ")[2] : timeText(t), font: FONT, offsetY: -13, fill: new Fill({ color: colour("map-ink") }), stroke: new Stroke({ color: colour("casing"), width: 3.5 }) }) : undefined,
      }));
      source.addFeature(feature);
    }
  }

  showFaults(violations) {
    const source = this.faults.getSource();
    source.clear();
    for (const one of violations) {
      const feature = new Feature(new Point(fromLonLat([one.lon, one.lat])));
      feature.setStyle(() => new Style({ image: new Circle({ radius: 9, stroke: new Stroke({ color: colour("danger"), width: 2 }) }), text: new Text({ text: one.reason.split(":")[0], font: FONT, offsetY: 18, fill: new Fill({ color: colour("danger") }), stroke: new Stroke({ color: colour("casing"), width: 3.5 }) }) }));
      source.addFeature(feature);
    }
  }

  showShip(lon, lat, course) {
    const source = this.ship.getSource();
    let feature = source.getFeatures()[0];
    if (lon === null) { source.clear(); return; }
    if (!feature) { feature = new Feature(); source.addFeature(feature); }
    feature.setGeometry(new Point(fromLonLat([lon, lat])));
    feature.setStyle(() => new Style({ image: new RegularShape({ points: 3, radius: 11, scale: [0.72, 1.15], rotateWithView: true, rotation: ((course || 0) * Math.PI) / 180, fill: new Fill({ color: colour("ink") }), stroke: new Stroke({ color: colour("casing"), width: 2 }) }) }));
  }

  // ends: [{role, lat, lon, label}]; movable ones can be dragged.
  showEnds(ends, movable = false) {
    const source = this.ends.getSource();
    source.clear();
    for (const [index, end] of ends.entries()) {
      const feature = new Feature({ geometry: new Point(fromLonLat([end.lon, end.lat])), role: end.role, index, movable });
      feature.setStyle(() => new Style({
        image: new Circle({ radius: 6, fill: new Fill({ color: end.role === "goal" ? colour("route") : colour("casing") }), stroke: new Stroke({ color: colour("route"), width: 2.5 }), declutterMode: "obstacle" }),
        text: new Text({ declutterMode: "obstacle", text: end.label || "", font: `600 ${FONT}`, offsetX: 11, textAlign: "left", fill: new Fill({ color: colour("map-ink") }), stroke: new Stroke({ color: colour("casing"), width: 3.5 }) }),
      }));
      source.addFeature(feature);
    }
  }
}

export { stroke, layer, FONT, Feature, Point, Polygon, LineString, Style, Fill, Stroke, Circle, Text, fromLonLat };
