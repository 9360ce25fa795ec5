// Voyage files, which hold the request as it is sent; route files, whose ends are filled in; the link.

import { post, uploadForm } from "../common/api.js";
import { announce, errorBox, fill, h, hint } from "../common/elements.js";
import { inputTime, seconds } from "../common/format.js";

const ROUTE = /\.(rtz|rtzp|gml|gpx|geojson|kml|csv)$/i;

export class VoyageFiles {
  /** @param {PlanForm} form */
  constructor(form) {
    this.form = form;
    const button = (text, act) => h("button.quiet.small", { type: "button", onclick: act }, text);
    this.input = h("input.hidden", { type: "file", id: "voyage-file", "aria-label": "Voyage or route file", accept: ".json,.yaml,.yml,.rtz,.rtzp,.gml,.gpx,.geojson,.kml,.csv", tabindex: "-1", onchange: () => this.#open() });
    this.element = h("div.block", {}, h("div.exports", {}, button("Save voyage file", () => this.#save()), button("Open …", () => this.input.click()), button("Copy link", () => this.#link()), this.input),
      h("p.facts", {}, "A voyage file, or a route file whose ends are used for a new plan."));
  }

  #link() {
    const request = this.form.request();
    if (request) this.form.dispatchEvent(new CustomEvent("link", { detail: request }));
  }

  #save() {
    const request = this.form.request();
    if (!request) return;
    const address = URL.createObjectURL(new Blob([JSON.stringify(request, null, 2)], { type: "application/json" }));
    h("a", { href: address, download: `${request.title.replace(/[^\w. -]+/g, "_")}.voyage.json` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
  }

  async #open() {
    const [file] = this.input.files, { form } = this;
    this.input.value = "";
    if (!file) return;
    fill(form.problem);
    try {
      if (ROUTE.test(file.name)) await this.#route(file);
      else form.set(await post("/voyages/read", { text: await file.text() }));
      announce(`${file.name} is filled in.`);
      form.element.querySelector(".scroll").scrollTop = 0;
    } catch (problem) {
      fill(form.problem, errorBox(problem));
      form.problem.scrollIntoView({ block: "center" });
    }
  }

  // The ends and the departure of a route; the route itself is compared with the plan later.
  async #route(file) {
    const { form } = this, { waypoints, depart } = await uploadForm("/routes", file);
    form.fresh = true;
    form.removeVias(); // those of another voyage
    form.start.setPosition(...waypoints[0]);
    form.goal.setPosition(...waypoints.at(-1));
    if (depart) form.depart.value = inputTime(seconds(depart));
    form.dispatchEvent(new Event("change"));
    hint("The ends of the route are filled in. Compare the plan with the file under Compare.");
  }
}
