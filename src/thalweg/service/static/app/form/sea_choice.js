// The seas of a voyage: files, the embedded storm, calm water, a fetched forecast.

import { get, uploadSea } from "../common/api.js";
import { announce, fill, h } from "../common/elements.js";
import { seconds, time } from "../common/format.js";
import { ForecastFetch } from "./forecast_fetch.js";

export class SeaChoice {
  list = null;
  order = []; // ids of the seas by priority, where a request or the hand gave it
  reading = null; // resolves when the files that were chosen last are read: whether all are seas

  /**
   * @param {{ends: () => object[], departs: () => number|null, changed: (byHand?: boolean) => void, problemAt: (problem: object|null) => void}} handlers
   */
  constructor(handlers) {
    this.handlers = handlers;
    this.box = h("div");
    this.facts = h("p.facts", {}, "Choose one or more: weather is never assumed.");
    this.file = h("input.hidden", { type: "file", id: "sea-file", "aria-label": "Sea files", accept: ".nc,.nc4,.grb,.grb2,.grib,.grib2", multiple: true, tabindex: "-1", onchange: () => { this.reading = this.#upload([...this.file.files]); } });
    this.drop = h("div.drop", {
      ondragover: (event) => { event.preventDefault(); this.drop.classList.add("over"); },
      ondragleave: () => this.drop.classList.remove("over"),
      ondrop: (event) => { event.preventDefault(); this.drop.classList.remove("over"); this.reading = this.#upload([...event.dataTransfer.files]); },
    }, "Drop a GRIB or NetCDF file here, or ", h("button.link", { type: "button", onclick: () => this.file.click() }, "choose a file"), ".");
    this.fetch = new ForecastFetch(handlers.ends, handlers.departs, () => this.chosen, (seas, before) => this.#fetched(seas, before));
    this.element = h("fieldset.block", { "data-field": "seas" }, h("legend", {}, "Sea"), this.facts, this.box, this.drop, this.file, h("div.slot"), this.fetch.element);
  }

  get chosen() {
    const place = (id) => (this.order.indexOf(id) + 1 || Infinity);
    return [...this.box.querySelectorAll("input:checked")].map((input) => input.value).sort((a, b) => (place(a) === place(b) ? 0 : place(a) - place(b)));
  }

  get #rows() {
    return this.chosen.map((id) => this.list.find((sea) => sea.id === id)).filter(Boolean);
  }

  // The time in which all chosen seas have data [s]; null where none has an end.
  get period() {
    const rows = this.#rows.filter((sea) => sea.start);
    return rows.length ? [Math.max(...rows.map((sea) => seconds(sea.start))), Math.min(...rows.map((sea) => seconds(sea.end)))] : null;
  }

  // The start of the oldest forecast among the chosen seas; null where none is known.
  get run() {
    const runs = this.#rows.map((sea) => sea.run).filter(Boolean);
    return runs.length ? Math.min(...runs.map(seconds)) : null;
  }

  get frameKinds() {
    return [...new Set(this.#rows.filter((sea) => sea.id !== "calm").flatMap((sea) => sea.frames || []))]; // of calm water there is nothing to see
  }

  show(list = this.list, chosen = null) {
    const before = chosen || (this.list ? this.chosen : []);
    this.order = before;
    this.list = list;
    const order = list.slice().sort((a, b) => Boolean(a.embedded) - Boolean(b.embedded) || (a.id === "calm") - (b.id === "calm"));
    fill(this.box, order.map((sea) => h("label.check", {},
      h("input", { type: "checkbox", value: sea.id, checked: before.includes(sea.id), onchange: (event) => this.#choose(event.target) }),
      h("span", {}, sea.embedded ? sea.name.split(":")[0] : sea.name, h("small", {}, this.#facts(sea))))));
    this.handlers.problemAt(null);
    this.handlers.changed();
  }

  #facts(sea) {
    if (sea.id === "calm") return "no wind, waves and currents anywhere";
    const example = sea.id === "storm" ? "an example · " : "";
    const period = sea.start ? `${time(seconds(sea.start))} to ${time(seconds(sea.end), true)}` : "at all times";
    return `${example}${(sea.frames || []).join(", ") || "no field to draw"} · ${period}${sea.members ? ` · ${sea.members} members` : ""}`;
  }

  // Calm water is never mixed with data.
  #choose(input) {
    if (input.checked) for (const other of this.box.querySelectorAll("input")) if (other !== input && (input.value === "calm" || other.value === "calm")) other.checked = false;
    this.handlers.problemAt(null);
    this.handlers.changed(true);
  }

  async #upload(files) {
    this.file.value = "";
    let read = true;
    for (const file of files) {
      this.handlers.problemAt(null);
      const bar = h("progress", { max: 1, value: 0, "aria-label": `Upload of ${file.name}` });
      this.drop.append(bar);
      try {
        const sea = await uploadSea(file, (share) => { bar.value = share; });
        this.show(await get("/seas"), [...this.chosen.filter((id) => id !== "calm" && id !== "storm"), sea.id]);
        announce(`${file.name} is read.`);
      } catch (problem) {
        this.handlers.problemAt(problem);
        read = false;
      }
      bar.remove();
    }
    return read;
  }

  // A forecast takes the place of the seas that were chosen when its download began.
  async #fetched(seas, before) {
    const list = await get("/seas"), same = String(this.chosen) === String(before);
    this.show(list, same ? seas : this.chosen);
    if (!same) announce("The forecast is in the list of seas.");
  }

  openForecast(job) {
    this.fetch.watch(job);
    this.fetch.element.scrollIntoView({ block: "center" });
  }
}
