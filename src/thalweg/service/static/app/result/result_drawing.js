// A result on the chart.

import { Feature, line, stroke } from "../chart/route_layers.js";
import { colour } from "../common/elements.js";
import { known } from "../common/format.js";
import { nearParts } from "./limits_met.js";
import { selection } from "../common/selection.js";

// Draw a result: the chosen route, the others, the one that ignores the weather, isochrones, limits that are broken.
// shown: {bySpeed, isochrones, beside}; shipRange: speeds of the ship [kn, kn] or null.
// Returns the range of the speed colours [kn, kn], or null where the route has one colour.
export function drawResult(layers, result, profile, shown, shipRange) {
  const lines = result.plan.routes.map((route) => route.waypoints.map((w) => [w.lon, w.lat]));
  const points = profile.lon.map((lon, i) => [lon, profile.lat[i]]);
  layers.showIsochrones(shown.isochrones ? result.isochrones : null);
  const beside = shown.beside ? result.beside?.profile : null;
  layers.showBeside(beside && beside.lon.map((lon, i) => [lon, beside.lat[i]]));
  layers.showOthers(lines, selection.route, selection.hovered);
  const speeds = profile.speed_over_ground_kn.filter(known);
  const range = [Math.min(...speeds, shipRange?.[0] ?? Infinity), Math.max(...speeds, shipRange?.[1] ?? -Infinity)];
  layers.showChosen(points, shown.bySpeed ? profile.speed_over_ground_kn : null, range, selection.route);
  layers.showNear(nearParts(result.limits?.routes[selection.route], profile));
  const route = result.plan.routes[selection.route];
  layers.showMarks(route.waypoints, profile);
  layers.showFaults(route.violations);
  const { from, to } = result.plan.provenance, name = (text) => (text || "").split(",")[0].replace(/^[\d.].*/, "");
  const end = (role, [lon, lat], text) => ({ role, lon, lat, label: name(text) });
  layers.showEnds([end("start", points[0], from), end("goal", points.at(-1), to)]);
  return shown.bySpeed && speeds.length ? range : null;
}

// Two to six routes, in the paints and dashes of their table.
export const PAINTS = ["route", "imported", "good", "amber", "ink", "other"];
const DASHES = [null, [10, 6], [2, 6], [12, 5, 2, 5], [18, 6], [4, 4]];

export function drawCompared(layers, routes) {
  layers.clear();
  if (routes.length) layers.showEnds([["start", routes[0][0]], ["goal", routes[0].at(-1)]].map(([role, [lon, lat]]) => ({ role, lon, lat, label: "" })));
  layers.others.getSource().addFeatures(routes.map((points, i) => {
    const feature = new Feature(line(points));
    feature.setStyle(() => [...(i ? [] : [stroke(colour("casing"), 6.5)]), stroke(colour(PAINTS[i]), i ? 2.4 : 4, DASHES[i] || undefined)]);
    return feature;
  }));
}
