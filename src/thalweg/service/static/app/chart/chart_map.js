// The chart: coast, graticule, ports, control areas, canals, weather, routes, drawn areas.

import { Map as OlMap, View, Overlay, Graticule, ScaleLine, Zoom, Draw, Modify, Snap, Translate, GeoJSON, toLonLat, transformExtent, extent as extents, defaultInteractions } from "../../vendor/ol.mjs";
import { get } from "../common/api.js";
import { marginStyles } from "./area_margin.js";
import { CoastLayers } from "./coast_layer.js";
import { ParticleLayer } from "./particle_layer.js";
import { KINDS, legendColours, WeatherLayer } from "./weather_layer.js";
import { RouteLayers, speedColours, layer, stroke, FONT, Feature, Point, Polygon, LineString, Style, Fill, Stroke, Circle, Text, fromLonLat } from "./route_layers.js";
import { colour, fill, h } from "../common/elements.js";
import { known, number, position, time, unwrapped } from "../common/format.js";

const CLOSE = 0.12; // of the chart: places within it are too close

export class Chart extends EventTarget {
  constructor(element) {
    super();
    this.element = element;
    this.legend = document.getElementById("legend");
    this.map = new OlMap({
      target: element,
      controls: [new Zoom({ zoomInTipLabel: "Closer (+)", zoomOutTipLabel: "Farther (−)" }), new ScaleLine({ units: "nautical", target: document.getElementById("scale") })],
      interactions: defaultInteractions({ altShiftDragRotate: false, pinchRotate: false }),
      view: new View({ center: fromLonLat([-28, 46]), zoom: 3.6, minZoom: 1.6, maxZoom: 15, extent: [-Infinity, -20037508, Infinity, 20037508], constrainOnlyCenter: true }),
      keyboardEventTarget: element,
    });
    this.coast = new CoastLayers(this.map);
    this.weather = new WeatherLayer(this.map);
    this.particles = this.weather.particles = new ParticleLayer(this.map, this.weather);
    this.depths = new WeatherLayer(this.map, { zIndex: 4, address: (_, query) => `/chart/depth?${query}`, still: true, bare: true });
    this.depths.set({ seas: ["chart"], time: 0 });
    this.routes = new RouteLayers();
    this.content = { control_areas: [], canals: [] }; // as the service describes them
    this.eca = layer(8, { visible: false }); // under the land: their lines over it mean nothing
    this.canals = layer(14);
    this.ports = layer(15, { declutter: true, minZoom: 2.5, updateWhileInteracting: false, renderBuffer: 300 });
    this.areas = layer(18);
    [...this.coast.layers, this.depths.layer, this.weather.layer, this.particles.layer, this.eca, this.canals, this.ports, this.areas, ...this.routes.layers].forEach((one) => this.map.addLayer(one));
    this.graticules = [];
    this.#pointer();
    this.#chooser();
    this.#dragging();
    this.#loadChart();
    this.map.on("change:size", () => this.#sized());
    this.map.once("rendercomplete", () => element.setAttribute("data-idle", "true"));
    this.paint();
    this.coast.load();
  }

  paint() {
    this.coast.paint();
    this.element.style.backgroundColor = colour("sea");
    for (const one of this.graticules) this.map.removeLayer(one);
    const text = new Text({ font: '11px system-ui, "DejaVu Sans", sans-serif', fill: new Fill({ color: colour("map-ink") }), stroke: new Stroke({ color: colour("casing"), width: 2.5 }) });
    const label = (style) => { const one = text.clone(); Object.entries(style).forEach(([name, value]) => one[name](value)); return one; };
    const lines = (zIndex, showLabels) => new Graticule({
      strokeStyle: new Stroke({ color: showLabels ? "transparent" : colour("graticule"), width: 0.6 }), showLabels, wrapX: true, zIndex, targetSize: 120,
      lonLabelPosition: 0.005, latLabelPosition: 0.998,
      lonLabelStyle: label({ setTextBaseline: "bottom" }), latLabelStyle: label({ setTextAlign: "end", setTextBaseline: "bottom" }),
      lonLabelFormatter: (value) => degrees(value, "E", "W"), latLabelFormatter: (value) => degrees(value, "N", "S"),
      intervals: [30, 20, 10, 5, 2, 1, 0.5, 0.25, 1 / 6, 1 / 12, 1 / 30, 1 / 60],
    });
    this.graticules = [lines(9, false), lines(13, true)]; // the lines under the land, the labels over it
    for (const one of this.graticules) this.map.addLayer(one);
    this.portStyles?.splice(0); // of the palette before
    for (const one of [...this.routes.layers, this.eca, this.canals, this.ports, this.areas]) one.changed();
    this.weather.repaint();
    this.depths.repaint();
    this.showLegend();
  }

  async #loadChart() {
    let chart, ports;
    try {
      [chart, ports] = await Promise.all([get("/chart"), get("/ports?count=900")]);
    } catch {
      setTimeout(() => this.#loadChart(), 5000);
      return;
    }
    this.content = chart;
    for (const area of chart.control_areas) {
      for (const ring of area.rings) {
        const feature = new Feature(new Polygon([ring.map((p) => fromLonLat(p))]));
        feature.setStyle(() => new Style({ stroke: new Stroke({ color: colour("eca"), width: 1.4 }), fill: new Fill({ color: colour("eca") + "12" }) }));
        this.eca.getSource().addFeature(feature);
      }
      if (!area.label) continue;
      const name = new Feature(new Point(fromLonLat(area.label)));
      name.setStyle(() => new Style({ text: new Text({ text: area.title, font: FONT, fill: new Fill({ color: colour("eca") }), stroke: new Stroke({ color: colour("sea"), width: 3 }) }) }));
      this.eca.getSource().addFeature(name);
    }
    for (const canal of chart.canals) {
      const feature = new Feature(new LineString(canal.path.map((p) => fromLonLat(p))));
      feature.setStyle(() => [stroke(colour("casing"), 4), stroke(colour("imported"), 2)]);
      this.canals.getSource().addFeature(feature);
    }
    const most = ports.map((port) => port.importance), styles = this.portStyles = [];
    ports.forEach((port, i) => {
      const feature = new Feature({ geometry: new Point(fromLonLat([port.lon, port.lat])), port });
      feature.setStyle((_, resolution) => {
        const zoom = this.map.getView().getZoomForResolution(resolution);
        if (most[i] < 150 / 2 ** ((zoom - 2) * 1.15)) return null;
        return styles[i] ||= new Style({
          zIndex: port.importance,
          image: new Circle({ radius: 2.2, fill: new Fill({ color: colour("map-ink") }), stroke: new Stroke({ color: colour("casing"), width: 1 }), declutterMode: "obstacle" }),
          text: new Text({ text: port.display_name, font: '11px system-ui, "DejaVu Sans", sans-serif', offsetX: 6, textAlign: "left", fill: new Fill({ color: colour("map-ink") }), stroke: new Stroke({ color: colour("casing"), width: 2.5 }) }),
        });
      });
      this.ports.getSource().addFeature(feature);
    });
  }

  #pointer() {
    const output = document.getElementById("position");
    this.map.on("pointermove", (event) => {
      const [lon, lat] = toLonLat(event.coordinate);
      output.textContent = position(lat, lon);
      if (event.dragging) return;
      const found = this.#routeAt(event.pixel);
      this.element.style.cursor = this.#endAt(event.pixel) ? "grab" : found === null ? "" : "pointer";
      this.dispatchEvent(new CustomEvent("hoverroute", { detail: found }));
    });
    this.element.addEventListener("pointerleave", () => this.dispatchEvent(new CustomEvent("hoverroute", { detail: null })));
    this.map.on("singleclick", (event) => {
      if (this.drawing) return;
      const [lon, lat] = toLonLat(event.coordinate);
      const number = this.#routeAt(event.pixel);
      const port = this.map.forEachFeatureAtPixel(event.pixel, (feature) => feature.get("port"), { layerFilter: (one) => one === this.ports, hitTolerance: 5 });
      this.dispatchEvent(new CustomEvent("click", { detail: { lat, lon, number, port: port || null, coordinate: event.coordinate } }));
    });
  }

  #endAt(pixel) {
    return this.map.forEachFeatureAtPixel(pixel, (feature) => (feature.get("movable") ? feature : null), { layerFilter: (one) => one === this.routes.ends, hitTolerance: 6 });
  }

  // Start, goal and via points are dragged; where they are dropped is reported.
  #dragging() {
    const drag = new Translate({ layers: [this.routes.ends], filter: (feature) => Boolean(feature.get("movable")), hitTolerance: 6 });
    this.map.addInteraction(drag);
    drag.on("translateend", ({ features }) => {
      const feature = features.item(0), [lon, lat] = toLonLat(feature.getGeometry().getCoordinates());
      this.dispatchEvent(new CustomEvent("dragged", { detail: { number: feature.get("index"), lat: Number(lat.toFixed(4)), lon: Number(lon.toFixed(4)) } }));
    });
  }

  #routeAt(pixel) {
    const number = this.map.forEachFeatureAtPixel(pixel, (feature) => feature.get("number"), { layerFilter: (one) => one === this.routes.others || one === this.routes.chosen, hitTolerance: 5 });
    return number === undefined ? null : number;
  }

  // A small menu at a clicked position.
  #chooser() {
    this.menu = h("div.floating.chooser", { role: "menu" });
    this.overlay = new Overlay({ element: this.menu, positioning: "top-left", offset: [10, 10], stopEvent: true });
    this.map.addOverlay(this.overlay);
  }

  choose(coordinate, title, choices) {
    fill(this.menu, h("b", {}, title), choices.map(([text, act]) => h("button", { type: "button", role: "menuitem", onclick: () => { this.closeMenu(); act(); } }, text)));
    this.overlay.setPosition(coordinate);
  }

  closeMenu() {
    this.overlay.setPosition(undefined);
  }

  fit(points) {
    if (!points.length) return;
    const lons = unwrapped(points.map((p) => p[0]));
    const box = extents.boundingExtent(points.map((p, i) => fromLonLat([lons[i], p[1]])));
    const whole = extents.buffer(box, Math.max(2e4, 0.06 * Math.max(extents.getWidth(box), extents.getHeight(box))));
    const show = (right) => this.map.getView().fit(whole, { padding: [28, right, 28, 40], maxZoom: 11, duration: 0 });
    show(40);
    if (this.#underLegend(points.map((p, i) => fromLonLat([lons[i], p[1]])))) show(this.legend.offsetWidth + 48);
    this.fitted = { points, place: String(this.place) };
  }

  // Whether the legend covers any of these places.
  #underLegend(coordinates) {
    if (this.legend.hidden) return false;
    const [width, height] = this.map.getSize() || [0, 0], { offsetWidth: wide, offsetHeight: high } = this.legend;
    if (width < 3 * wide) return false; // there is no room beside it
    const resolution = this.map.getView().getResolution(), [x0, y0] = this.map.getView().getCenter();
    return coordinates.some(([x, y]) => (x - x0) / resolution > width / 2 - wide - 24 && (y0 - y) / resolution > height / 2 - high - 48);
  }

  // A chart that the user has not moved since shows all of it again when its size changes.
  #sized() {
    if (this.fitted?.place === String(this.place)) this.fit(this.fitted.points);
  }

  // The chart moves only where a place [{lon, lat}] is outside of it, or all are too close to tell apart: to all of them, or to the only one.
  fitOutside(places) {
    const [w, s, e, n] = this.view, east = (lon) => w + ((((lon - w) % 360) + 360) % 360);
    const wide = Math.max(...places.map(({ lon }) => east(lon))) - Math.min(...places.map(({ lon }) => east(lon))), high = Math.max(...places.map(({ lat }) => lat)) - Math.min(...places.map(({ lat }) => lat));
    const apart = places.length < 2 || wide > CLOSE * (e - w) || high > CLOSE * (n - s);
    if (apart && places.every(({ lon, lat }) => lat > s && lat < n && east(lon) < e)) return;
    if (places.length > 1) this.fit(places.map(({ lon, lat }) => [lon, lat]));
    else this.map.getView().setCenter(fromLonLat([places[0].lon, places[0].lat]));
  }

  // On paper the chart has another size: it shows the whole route, then what it showed before.
  forPaper(begins, points) {
    const root = document.documentElement;
    if (begins) this.before = { place: this.place, palette: root.dataset.palette };
    root.classList.toggle("paper", begins);
    root.dataset.palette = begins ? "day" : this.before.palette;
    this.paint();
    this.map.updateSize();
    if (begins && points) this.fit(points);
    if (!begins) this.place = this.before.place;
    this.map.renderSync();
  }

  get place() {
    const view = this.map.getView();
    return [view.getCenter(), view.getZoom()];
  }

  set place([center, zoom]) {
    const view = this.map.getView();
    view.setCenter(center);
    view.setZoom(zoom);
  }

  // In the bar: the time of the weather, the end of the data [s, s], and the age of the forecast that ran at a time.
  showValidity(t, period, run) {
    const shown = this.weather.kind && known(t);
    const outside = shown && period && (t < period[0] || t > period[1]);
    const forecast = run === null ? "" : `forecast of ${time(run)}, ${number(Math.max(0, Date.now() / 1000 - run) / 3600)} h old`;
    const age = forecast && ` · ${forecast}`;
    if (this.run !== forecast) { this.run = forecast; this.showLegend(); }
    fill(document.getElementById("valid"), shown ? [h("b", {}, time(t, true)), " UTC"] : null, outside ? " · outside the data" : period ? h("span.more-of", {}, ` · data until ${time(period[1])}${age}`) : "");
  }

  showLegend(state = this.legendState) {
    this.legendState = state;
    const box = this.legend;
    const { kind } = this.weather;
    box.hidden = !kind && !this.speeds && !this.depths.kind;
    fill(box, this.speeds ? this.#speedLegend(...this.speeds) : null, kind ? this.#weatherLegend(kind, state) : null, this.depths.kind ? this.#depthLegend() : null);
  }

  // The range of the speed colours of the chosen route [kn, kn]; null where it has one colour.
  showSpeeds(range) {
    this.speeds = range;
    this.showLegend();
  }

  clearRoutes() {
    this.routes.clear();
    this.showSpeeds(null);
  }

  #speedLegend(low, high) {
    return h("section", {}, h("b", {}, "Speed over ground"), bar(speedColours()), h("div.ends", {}, h("span", {}, number(low, 1)), h("span", {}, number((low + high) / 2, 1)), h("span", {}, `${number(high, 1)} kn`)));
  }

  // Depths of the package, for a picture of the sea; never for a clearance.
  showDepths(on) {
    this.depths.set({ kind: on ? "depth" : "" });
    this.showLegend();
  }

  #depthLegend() {
    return h("section", {}, h("b", {}, "Depth, every 6 nm"), bar(legendColours("depth")), h("div.ends", {}, h("span", {}, "0"), h("span", {}, "100"), h("span", {}, "200 m")));
  }

  #weatherLegend(kind, state) {
    const { title, unit, top } = KINDS[kind];
    const words = { "no data": "no data at this time", failed: "cannot be read" }[state];
    return h("section", { "aria-busy": String(state === "loading") }, h("b", {}, title), words ? h("div", {}, words) : null, bar(legendColours(kind)),
      h("div.ends", {}, h("span", {}, "0"), h("span", {}, `${top / 2}`), h("span", {}, `${top} ${unit}`.trim())), h("div.none", {}, h("i", {}), "no data"), this.run ? h("div.run", {}, this.run) : null);
  }

  // End the area that is drawn: with the corners it has, where they are three or more, or without it.
  // Returns whether it ended.
  endDrawing(keep) {
    return this.drawing ? this.drawing.ended(keep) : true;
  }

  // Draw an area by hand; resolves with a ring [[lon, lat], ...] or null.
  draw() {
    this.endDrawing(false);
    const interaction = new Draw({ source: new (this.areas.getSource().constructor)(), type: "Polygon", style: handStyle() });
    this.map.addInteraction(interaction);
    this.drawing = interaction;
    const calm = (still) => { this.map.getInteractions().forEach((one) => { if ("delta_" in one && !("condition_" in one)) one.setActive(!still); }); this.modify?.setActive(!still && Boolean(this.onAreaChange)); }; // the double click that ends it is no zoom, and no corner of another is dragged
    calm(true);
    return new Promise((resolve) => {
      let corners = null;
      const end = (ring) => {
        this.map.removeInteraction(interaction);
        document.removeEventListener("keydown", escape, true);
        setTimeout(() => { if (this.drawing !== interaction) return; this.drawing = null; calm(false); }, 300); // the double click that ends it is no click
        interaction.ended = () => true;
        resolve(ring);
      };
      interaction.ended = (keep) => {
        const enough = corners?.getCoordinates()[0].length > 4; // the pointer and the first corner again count, too
        if (keep && enough) interaction.finishDrawing();
        else if (!keep) end(null);
        return !keep || Boolean(enough);
      };
      interaction.on("drawstart", (event) => { corners = event.feature.getGeometry(); });
      const escape = (event) => { if (event.key === "Escape") { event.stopPropagation(); end(null); } };
      document.addEventListener("keydown", escape, true);
      interaction.on("drawend", (event) => end(event.feature.getGeometry().getCoordinates()[0].map((c) => toLonLat(c).map((v) => Number(v.toFixed(4))))));
    });
  }

  // areas: [{kind, factor, ring}]; changes by hand are reported.
  showAreas(areas, onChange) {
    const source = this.areas.getSource();
    source.clear();
    areas.forEach((area, number) => {
      const feature = new Feature({ geometry: new Polygon([area.ring.map((p) => fromLonLat(p))]), area: number });
      const name = area.kind === "no-go" ? "danger" : "amber";
      feature.setStyle((_, resolution) => [...marginStyles(area, colour(name), resolution), new Style({ stroke: new Stroke({ color: colour(name), width: 1.8 }), fill: new Fill({ color: hatch(colour(name)) }), text: new Text({ text: area.factor ? `× ${area.factor}` : area.kind, font: `600 ${FONT}`, fill: new Fill({ color: colour(name) }), stroke: new Stroke({ color: colour("casing"), width: 3.5 }) }) })]);
      source.addFeature(feature);
    });
    if (!this.modify) {
      this.modify = new Modify({ source, style: () => handStyle().slice(-1) });
      this.map.addInteraction(this.modify);
      this.map.addInteraction(new Snap({ source }));
      this.modify.on("modifyend", () => {
        for (const feature of source.getFeatures()) this.onAreaChange?.(feature.get("area"), feature.getGeometry().getCoordinates()[0].map((c) => toLonLat(c).map((v) => Number(v.toFixed(4)))));
      });
    }
    this.onAreaChange = onChange;
    this.modify.setActive(Boolean(onChange));
  }

  get view() {
    return transformExtent(this.map.getView().calculateExtent(), "EPSG:3857", "EPSG:4326");
  }
}

function degrees(value, plus, minus) {
  const size = Math.abs(value), whole = Math.floor(size + 1e-9), minutes = Math.round((size - whole) * 60);
  return `${whole}°${minutes ? `${String(minutes).padStart(2, "0")}′` : ""}${size < 1e-9 ? "" : value < 0 ? minus : plus}`;
}

// What is drawn by hand.
function handStyle() {
  const paint = colour("accent");
  return [new Style({ stroke: new Stroke({ color: paint, width: 2 }), fill: new Fill({ color: `${paint}1c` }) }), new Style({ image: new Circle({ radius: 5, fill: new Fill({ color: paint }), stroke: new Stroke({ color: colour("casing"), width: 1.5 }) }) })];
}

// A bar of colours from low to high.
function bar(colours) {
  const canvas = h("canvas", { width: 180, height: 10, "aria-hidden": "true" }), pen = canvas.getContext("2d");
  colours.forEach((one, i) => { pen.fillStyle = one; pen.fillRect((180 * i) / colours.length, 0, 180 / colours.length + 1, 10); });
  return canvas;
}

function hatch(color) {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 8;
  const pen = tile.getContext("2d");
  pen.strokeStyle = color;
  pen.globalAlpha = 0.55;
  for (const shift of [-8, 0, 8]) { pen.moveTo(shift, 8); pen.lineTo(shift + 8, 0); }
  pen.stroke();
  return pen.createPattern(tile, "repeat");
}

export { GeoJSON };
