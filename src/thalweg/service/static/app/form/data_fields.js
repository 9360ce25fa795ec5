// Depth files of the chart, and the names of variables in the files of the sea.

import { get, uploadSea } from "../common/api.js";
import { h } from "../common/elements.js";
import { UploadedFiles } from "./uploaded_files.js";

export class DataFields {
  /** @param {(list: object[]) => void} arrived a file of depth came into the list of seas */
  constructor(arrived) {
    const upload = async (file) => { const sea = await uploadSea(file, () => {}); arrived(await get("/seas")); return sea; };
    this.depths = new UploadedFiles("/seas", "Depth file", ".nc,.nc4,.grb,.grb2,.grib,.grib2", { many: true, shown: (sea) => !sea.embedded && (sea.frames || []).includes("depth"), upload });
    this.names = h("textarea", { id: "variables", rows: 2, placeholder: "eastward_wind = u10" });
    this.depthElement = h("div.field", { "data-field": "depths" }, h("span.label", {}, "Depth from files"), this.depths.element, h("p.facts", {}, "Beside those of the sea. Without either, the global depth layer says where water is shoal, and no clearance is checked."), h("div.slot"));
    this.nameElement = h("div.field", { "data-field": "variables" }, h("label.label", { for: "variables" }, "Variables of the files"), this.names, h("p.facts", {}, "Only where they are not recognised: a CF standard name and the variable, one in each line."), h("div.slot"));
  }

  // Adds what is set to a request; returns the fault {field, asked, remedy} or null.
  fill(request) {
    if (this.depths.chosen.length) request.depths = this.depths.chosen;
    const rows = this.names.value.split("\n").filter((row) => row.trim()).map((row) => row.split("=").map((part) => part.trim()));
    const wrong = rows.find((row) => row.length !== 2 || !row.every(Boolean));
    if (wrong) return { field: "variables", asked: `${wrong.join(" = ")} names no variable.`, remedy: "Write a name, an equals sign and the variable, such as eastward_wind = u10." };
    if (rows.length) request.variables = Object.fromEntries(rows);
    return null;
  }

  set(request) {
    this.depths.set(request.depths || []);
    this.names.value = Object.entries(request.variables || {}).map((pair) => pair.join(" = ")).join("\n");
  }
}
