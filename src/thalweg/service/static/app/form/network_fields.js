// Fields of the network that is searched, and of the traffic of other ships.

import { h, withUnit } from "../common/elements.js";
import { UploadedFiles } from "./uploaded_files.js";

const NETWORKS = [["auto", "Chosen by the voyage"], ["lattice", "Grid around the route"], ["mesh", "Mesh of the sea data"], ["globe", "Global grid"], ["layered", "Layers between two places"], ["history", "Water that ships usually use"]];
const NUMBERS = [["resolution_nm", "Spacing", "nm"], ["proof_s", "Time for the proof", "s"], ["corridor_gain_percent", "Leave it where that saves", "%"], ["near_coast_nm", "Finer near land", "nm"], ["within_percent", "Tolerance of length", "%"]];
const asNumber = (text) => Number(text.trim().replace(",", "."));

export class NetworkFields {
  constructor() {
    this.traffic = new UploadedFiles("/traffic", "Traffic file", ".geojson,.json,.nc,.nc4", { many: true });
    this.histories = new UploadedFiles("/histories", "History network", ".json");
    this.numbers = Object.fromEntries(NUMBERS.map(([name]) => [name, h("input", { type: "text", inputmode: "decimal", id: `net-${name}`, autocomplete: "off" })]));
    this.kind = h("select", { id: "network", onchange: () => this.#parts() }, NETWORKS.map(([value, text]) => h("option", { value }, text)));
    this.shape = Object.fromEntries([["layers", "Layers"], ["fan", "Fan"], ["offset_nm", "Offset"]].map(([name, label]) => [name, h("input", { type: "text", id: `net-${name}`, autocomplete: "off", placeholder: "chosen", "aria-label": label })]));
    this.contain = h("textarea", { id: "net-contain", rows: 2, placeholder: "64.862, 11.253" });
    const field = (name) => { const [, label, unit] = NUMBERS.find((row) => row[0] === name); return h("div.field", { "data-field": name }, h("label.label", { for: `net-${name}` }, label), withUnit(this.numbers[name], unit), h("div.slot")); };
    this.layered = h("div.part", { "data-field": "layered" },
      h("div.triple", {}, Object.entries(this.shape).map(([name, input]) => h("div.field", {}, h("label.label", { for: `net-${name}` }, { layers: "Layers", fan: "Fan", offset_nm: "Offset, nm" }[name]), input))),
      h("div.pair", {}, field("near_coast_nm"), field("within_percent")),
      h("div.field", {}, h("label.label", { for: "net-contain" }, "Straits to contain: latitude, longitude"), this.contain), h("div.slot"));
    this.history = h("div.part", { "data-field": "history" }, this.histories.element, field("corridor_gain_percent"), h("div.slot"));
    this.element = h("div", {}, h("div.field", { "data-field": "network" }, h("label.label", { for: "network" }, "Network"), this.kind, h("div.slot")), this.layered, this.history, h("div.pair", {}, field("resolution_nm"), field("proof_s")), h("p.facts", {}, "Empty: chosen from the length of the voyage."));
    this.trafficElement = h("div", { "data-field": "traffic" }, this.traffic.element, h("p.facts", {}, "Zones (GeoJSON) or a raster of density (NetCDF). The result then states the expected encounters."), h("div.slot"));
    this.#parts();
  }

  async load() {
    await Promise.all([this.traffic.load(), this.histories.load()]);
  }

  #parts() {
    this.layered.hidden = this.kind.value !== "layered";
    this.history.hidden = this.kind.value !== "history";
  }

  // Adds what is set to a request; returns the fault {field, asked, remedy} or null.
  fill(request) {
    const number_ = (name) => (this.numbers[name].value.trim() === "" ? null : asNumber(this.numbers[name].value));
    for (const [name, label] of NUMBERS) if (Number.isNaN(number_(name))) return { field: name, asked: `${label}: ${this.numbers[name].value} is not a number.`, remedy: "Give a number, such as 2.5." };
    for (const name of ["resolution_nm", "proof_s"]) if (number_(name) !== null) request[name] = number_(name);
    if (this.traffic.chosen.length) request.traffic = this.traffic.chosen;
    const kind = this.kind.value;
    if (kind === "history") {
      if (!this.histories.chosen.length) return { field: "history", asked: "No history network is chosen.", remedy: "Choose a file of thalweg history build." };
      [request.history] = this.histories.chosen;
      if (number_("corridor_gain_percent") !== null) request.corridor_gain_percent = number_("corridor_gain_percent");
    } else if (kind !== "auto") request.network = kind;
    return kind === "layered" ? this.#fillLayered(request, number_) : null;
  }

  #fillLayered(request, number_) {
    const layered = {};
    for (const [name, input] of Object.entries(this.shape)) {
      const parts = input.value.split(/[;,\s]+/).filter(Boolean).map(Number);
      if (parts.some((one) => !Number.isFinite(one))) return { field: "layered", asked: `${input.value} is not a number.`, remedy: "Give one number, or one for each section with commas between them." };
      if (parts.length) layered[name] = parts.length > 1 ? parts : parts[0];
    }
    for (const name of ["near_coast_nm", "within_percent"]) if (number_(name) !== null) layered[name] = number_(name);
    const places = this.contain.value.split("\n").map((row) => row.split(/[,;\s]+/).filter(Boolean).map(Number)).filter((row) => row.length);
    if (places.some((row) => row.length !== 2 || !row.every(Number.isFinite))) return { field: "layered", asked: "A strait is not a position.", remedy: "Give latitude and longitude in degrees, one strait in each line, such as 64.862, 11.253." };
    if (places.length) layered.contain = places;
    if (Object.keys(layered).length) request.voyage.layered = layered;
    return null;
  }

  set(request) {
    const layered = request.voyage.layered || {};
    this.kind.value = request.history ? "history" : request.voyage.layered ? "layered" : request.network || "auto";
    for (const [name, input] of Object.entries(this.numbers)) input.value = request[name] ?? layered[name] ?? "";
    for (const [name, input] of Object.entries(this.shape)) input.value = [layered[name] ?? []].flat().join(", ");
    this.contain.value = (layered.contain || []).map((place) => place.join(", ")).join("\n");
    this.traffic.set(request.traffic || []);
    this.histories.set(request.history ? [request.history] : []);
    this.#parts();
  }

  get words() {
    return [this.kind.value === "auto" ? "" : NETWORKS.find(([value]) => value === this.kind.value)[1].toLowerCase(), this.numbers.resolution_nm.value.trim() && `${this.numbers.resolution_nm.value.trim()} nm`];
  }
}
