// Fetch a forecast from the page: the size first, then the download as a job.

import { follow, get, hasEnded, post, remove, start } from "../common/api.js";
import { announce, errorBox, fill, h, withUnit } from "../common/elements.js";
import { inputTime, number, seconds, time } from "../common/format.js";
import { typedTime } from "../common/typed_time.js";

const SOURCES = [["gfs", "GFS and GFS-wave (NOAA)", ["wind", "waves"]], ["ecmwf", "ECMWF open data", ["wind", "waves"]], ["open-meteo", "Open-Meteo (small areas)", ["wind", "waves", "current"]], ["matroos", "Rijkswaterstaat, North Sea, 2 days", ["current", "waves"]], ["rws", "Rijkswaterstaat, level at one station", ["level"]], ["copernicus", "Copernicus Marine (account)", ["waves", "current"]], ["era5", "ERA5, past weather (account)", ["wind", "waves"]]];

export class ForecastFetch {
  // ends(): [{lat, lon}]; departs(): seconds or null; chosen(): ids of seas; arrived(seas, chosen before)
  constructor(ends, departs, chosen, arrived) {
    Object.assign(this, { ends, departs, chosen, arrived });
    this.source = h("select", { id: "f-source", onchange: () => this.#sourceChanged() }, SOURCES.map(([name, text]) => h("option", { value: name }, text)));
    this.from = h("input", { type: "text", id: "f-from", autocomplete: "off", placeholder: "2026-01-31 12:00" });
    this.days = h("input", { type: "text", inputmode: "decimal", id: "f-days", value: "10" });
    this.step = h("select", { id: "f-step" }, [1, 3, 6, 12].map((n) => h("option", { value: n, selected: n === 3 }, `${n} h`)));
    this.quantities = h("div");
    this.area = h("p.facts");
    this.answer = h("div", { role: "status" });
    this.element = h("details.fetch", {}, h("summary", {}, "Fetch a forecast"), h("div.inside", {},
      h("div.field", {}, h("label.label", { for: "f-source" }, "From"), this.source), this.quantities,
      h("div.pair.time", {}, h("div.field", {}, h("label.label", { for: "f-from" }, "First time"), withUnit(this.from, "UTC")), h("div.field", {}, h("label.label", { for: "f-days" }, "For"), withUnit(this.days, "days"))),
      h("div.field", {}, h("label.label", { for: "f-step" }, "Fields every"), this.step),
      this.area,
      h("button.quiet", { type: "button", onclick: () => this.#estimate() }, "Estimate the download"), this.answer));
    this.element.addEventListener("toggle", () => { const t = this.departs() ?? Date.now() / 1000; if (this.element.open && !this.from.value) this.from.value = inputTime(Math.floor(t / 10800) * 10800); });
    this.#sourceChanged();
  }

  #sourceChanged() {
    const [, , there] = SOURCES.find(([name]) => name === this.source.value);
    fill(this.quantities, h("div.row", { role: "group", "aria-label": "Quantities" }, there.map((name) => h("label.check", {}, h("input", { type: "checkbox", value: name, checked: true }), h("span", {}, name[0].toUpperCase() + name.slice(1)))), h("span")));
    this.area.textContent = `The area is ${this.source.value === "rws" ? "12 nm around the destination; its level is that of the nearest station" : "that of the voyage with 8 degrees around it"}. Without internet, use files.`;
    fill(this.answer);
  }

  #request() {
    const ends = this.ends(), from = typedTime(this.from), days = Number(this.days.value.replace(",", "."));
    if (ends.length < 2) return this.#refuse("The area is not known.", "Give both ends of the voyage first.");
    if (from === null) return this.#refuse("The first time is not a time.", "Give year, month, day, hour and minute, such as 2026-01-31 12:00.");
    if (!(days > 0)) return this.#refuse("The number of days is not a number.", "Give 10, for example.");
    const lats = ends.map((end) => end.lat), first = ends[0].lon;
    const lons = ends.map((end) => first + ((((end.lon - first + 540) % 360) + 360) % 360) - 180);
    const turned = (lon) => Math.round((((((lon + 180) % 360) + 360) % 360) - 180) * 10) / 10;
    let box = [Math.max(-80, Math.floor(Math.min(...lats) - 8)), Math.min(85, Math.ceil(Math.max(...lats) + 8)), turned(Math.min(...lons) - 8), turned(Math.max(...lons) + 8)];
    if (this.source.value === "rws") box = [ends.at(-1).lat - 0.2, ends.at(-1).lat + 0.2, ends.at(-1).lon - 0.3, ends.at(-1).lon + 0.3].map((v) => Number(v.toFixed(3))); // a level of one place
    const iso = (t) => `${inputTime(t).replace(" ", "T")}Z`;
    if (this.source.value === "matroos") box = [Math.max(48, box[0]), Math.min(64, box[1]), Math.max(-12, box[2]), Math.min(9, box[3])]; // the area of its models
    return { source: this.source.value, box, start: iso(from), end: iso(from + days * 86400), step_h: Number(this.step.value), quantities: [...this.quantities.querySelectorAll("input:checked")].map((box_) => box_.value) };
  }

  #refuse(asked, remedy) {
    fill(this.answer, errorBox({ asked, remedy }));
    return null;
  }

  async #estimate() {
    const request = this.#request();
    if (!request) return;
    const waits = h("p.facts", {}, "Asking the server what it has …");
    fill(this.answer, waits);
    try {
      const found = await post("/forecasts/estimate", request);
      if (!waits.parentNode) return; // the answer to a request that was changed
      fill(this.answer, h("p", {}, h("b", {}, `About ${number(found.bytes / 1e6, found.bytes < 1e7 ? 1 : 0)} MB`), ` in ${number(found.times)} times${found.run ? `, run of ${time(seconds(found.run))} UTC` : ""}.`), h("p.facts", {}, found.licence), found.notes.map((text) => h("p.facts", {}, text)), h("button.quiet", { type: "button", onclick: () => this.#download(request) }, "Download"));
    } catch (problem) {
      if (waits.parentNode) fill(this.answer, errorBox(problem));
    }
  }

  async #download(request) {
    if (this.sending) return;
    this.sending = true;
    try {
      const job = await start("/forecasts", { ...request, title: `Forecast ${request.source} ${request.start.slice(0, 10)}` });
      this.watch(job);
    } catch (problem) {
      fill(this.answer, errorBox(problem));
    } finally {
      this.sending = false;
    }
  }

  watch(job) {
    this.element.open = true;
    this.close?.(); // one download at a time is shown
    const said = h("p.facts", {}, "Waiting for its turn."), before = this.chosen();
    const stop = h("button.quiet.small", { type: "button", onclick: () => remove(`/plans/${job.id}`).catch((problem) => fill(this.answer, errorBox(problem))) }, "Stop the download");
    fill(this.answer, said, stop);
    this.close = follow(job.id, {
      stage: (data) => { said.textContent = `${data.text[0].toUpperCase()}${data.text.slice(1)} …`; },
      state: async (data) => {
        if (!hasEnded(data.state)) return;
        const ended = await get(`/plans/${job.id}`);
        if (data.state === "done") {
          fill(this.answer, h("p.facts", {}, `Fetched: ${time(seconds(ended.summary.start))} to ${time(seconds(ended.summary.end), true)}.`));
          announce("The forecast is fetched.");
          await this.arrived(ended.summary.seas, before);
        } else fill(this.answer, ended.problem ? errorBox(ended.problem) : h("p.facts", {}, "The download was stopped; what has arrived is kept for the next time."));
      },
    });
  }
}
