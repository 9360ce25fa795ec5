// The menu of what the chart shows.

import { fill, h } from "../common/elements.js";
import { lessMotion, MOVING } from "./particle_layer.js";
import { KINDS } from "./weather_layer.js";

export class LayerMenu {
  bySpeed = false;
  isochrones = true;
  beside = true;

  /** @param {{weather: () => void, routes: () => void, tables: () => void}} changed what to do after a change, or to show tables */
  constructor(chart, changed) {
    Object.assign(this, { chart, changed });
    this.button = document.getElementById("layers-button");
    this.box = document.getElementById("layers");
    this.button.addEventListener("click", () => this.open(this.box.hidden));
  }

  open(on) {
    this.box.hidden = !on;
    this.button.setAttribute("aria-expanded", String(on));
  }

  // kinds: the weather that the chosen seas hold.
  show(kinds) {
    const { chart } = this, { weather } = chart;
    const there = [...new Set(kinds)].filter((kind) => KINDS[kind]);
    const radio = (value, text) => h("label.check", {}, h("input", { type: "radio", name: "weather", value, checked: weather.kind === value, onchange: () => { weather.byHand = true; weather.set({ kind: value }); chart.showLegend(); this.changed.weather(); } }), h("span", {}, text));
    const toggle = (text, checked, act) => h("label.check", {}, h("input", { type: "checkbox", checked, onchange: (event) => act(event.target.checked) }), h("span", {}, text));
    const route = (text, name) => toggle(text, this[name], (on) => { this[name] = on; this.changed.routes(); });
    const layer = (text, one) => toggle(text, one.getVisible(), (on) => one.setVisible(on));
    fill(this.box,
      h("fieldset", {}, h("legend", {}, "Weather"), radio("", "None"), there.map((kind) => radio(kind, KINDS[kind].title)),
        there.length ? null : h("p.facts", {}, "Choose a sea with data in the plan: waves, wind, current, depth and ice can be drawn."),
        MOVING.some((kind) => there.includes(kind)) ? this.#particles(there) : null),
      h("fieldset", {}, h("legend", {}, "Route"), route("Colour by speed over ground", "bySpeed"), route("Isochrones", "isochrones"), route("Route that ignores the weather", "beside")),
      h("fieldset", {}, h("legend", {}, "Chart"), toggle("Depth (global layer, for a picture)", Boolean(chart.depths.kind), (on) => chart.showDepths(on)), layer("Emission control areas", chart.eca), layer("Ports", chart.ports), layer("Canals", chart.canals)),
      h("button.quiet.small", { type: "button", id: "as-tables", onclick: () => { this.open(false); this.changed.tables(); } }, "Show as tables"));
  }

  // Waves do not move as particles: the wind or the current that is wanted is shown in their place.
  #particles(there) {
    const { particles, weather } = this.chart;
    const change = (event) => {
      particles.wanted = event.target.checked;
      localStorage.setItem("particles", String(particles.wanted));
      const kind = MOVING.find((one) => there.includes(one));
      if (particles.wanted && !MOVING.includes(weather.kind)) this.box.querySelector(`input[value=${kind}]`).click();
      else weather.repaint();
    };
    const why = lessMotion.matches ? " (this computer is set to less motion)" : "";
    return h("label.check", {}, h("input", { type: "checkbox", id: "particles", checked: particles.wanted, disabled: lessMotion.matches, onchange: change }), h("span", {}, `Wind and current as moving particles${why}`));
  }
}
