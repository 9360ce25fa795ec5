// A field for a place: suggestions of ports while typing, and how the text is understood.

import { get } from "../common/api.js";
import { errorBox, fill, h } from "../common/elements.js";
import { number, plainPosition, position } from "../common/format.js";

let count = 0;
const nameOf = ({ label, locode }) => `${label}${locode ? ` (${locode})` : ""}`;

export class PlaceField {
  constructor(role, label, onChange) {
    this.role = role;
    this.place = null;
    this.onChange = onChange;
    const id = `place-${++count}`;
    this.input = h("input", { type: "text", id, autocomplete: "off", spellcheck: "false", role: "combobox", "aria-expanded": "false", "aria-controls": `${id}-list`, "aria-autocomplete": "list", "aria-describedby": `${id}-said`, placeholder: "Port, UN/LOCODE or 52.0N 4.1E" });
    this.list = h("ul.options", { id: `${id}-list`, role: "listbox", hidden: true, "aria-label": `Suggestions for ${label}` });
    this.said = h("p.understood", { id: `${id}-said` });
    this.problem = h("div");
    this.tools = h("span.row");
    this.element = h(`div.field.${role}`, { "data-field": role }, h("label.label", { for: id }, label), h("div.row", {}, h("div.combo", {}, this.input, this.list), this.tools), this.said, this.problem);
    this.input.addEventListener("input", () => this.#typed());
    this.input.addEventListener("keydown", (event) => this.#key(event));
    this.input.addEventListener("blur", () => setTimeout(() => { this.#close(); this.understand(); }, 120));
  }

  get value() {
    return this.input.value.trim();
  }

  set(text, place = null) {
    this.input.value = text;
    this.#close();
    if (place) this.#understood(place);
    else this.understand();
  }

  setPosition(lat, lon) {
    this.set(plainPosition(lat, lon), { kind: "position", lat, lon, label: plainPosition(lat, lon) });
  }

  fail(problem) {
    this.failed = this.value; // the error stays until the text changes
    this.element.classList.add("wrong");
    fill(this.problem, errorBox(problem));
    this.input.setAttribute("aria-invalid", "true");
  }

  clear() {
    this.failed = null;
    this.element.classList.remove("wrong");
    fill(this.problem);
    this.input.removeAttribute("aria-invalid");
  }

  async understand() {
    const text = this.value;
    if (text === this.asked) return;
    this.asked = text;
    this.clear();
    if (!text) { this.place = null; this.said.textContent = ""; this.onChange(); return; }
    try {
      const place = await get(`/places?text=${encodeURIComponent(text)}`);
      if (text === this.value) this.#understood(place, true);
    } catch (problem) {
      if (text !== this.value) return;
      this.place = null;
      this.said.textContent = "";
      this.fail(problem);
      this.onChange();
    }
  }

  #understood(place, typed = false) {
    if (this.failed !== this.value) this.clear();
    this.place = place;
    this.asked = this.value;
    this.said.textContent = this.#words(place);
    this.onChange(typed);
  }

  // Where the route begins or ends: at the berth, at the end of its way for a via point, or at a position.
  get spot() {
    const { approach, lat, lon } = this.place, end = approach && (this.role === "via" ? approach.sea_end : approach.berth);
    return end ? { lat: end[0], lon: end[1] } : { lat, lon };
  }

  #words({ kind, label, locode, approach }) {
    const { lat, lon } = this.spot, where = position(lat, lon);
    if (kind !== "port") return `Position ${where}`;
    const name = nameOf({ label, locode });
    if (!approach) return `${name} · ${where}, no approach known`;
    return this.role === "via" ? `${name} · passed off its approach, at ${where}` : `${name} · berth ${where}, approach of ${number(approach.length_nm, 1)} nm`;
  }

  #typed() {
    this.clear();
    clearTimeout(this.timer);
    const text = this.value;
    if (text.length < 2 || /^[\d\-+]/.test(text)) { this.#close(); return; }
    this.timer = setTimeout(async () => {
      const found = await get(`/ports?count=8&q=${encodeURIComponent(text)}`).catch(() => []);
      if (text === this.value && document.activeElement === this.input) this.#open(found);
    }, 120);
  }

  #open(ports) {
    this.ports = ports;
    this.at = -1;
    fill(this.list, ports.map((port, i) => h("li", { role: "option", id: `${this.list.id}-${i}`, "aria-selected": "false", onmousedown: (event) => { event.preventDefault(); this.#take(i); } }, h("span", {}, port.label), h("small", {}, port.locode))));
    this.list.hidden = !ports.length;
    this.input.setAttribute("aria-expanded", String(ports.length > 0));
  }

  #close() {
    this.list.hidden = true;
    this.input.setAttribute("aria-expanded", "false");
    this.input.removeAttribute("aria-activedescendant");
  }

  #take(i) {
    const port = this.ports[i];
    this.input.value = port.locode || port.label;
    this.#close();
    this.understand();
    this.said.textContent = nameOf(port); // until its approach is known
  }

  #key(event) {
    if (event.key === "Escape") { this.#close(); return; }
    if (event.key === "Enter" && this.list.hidden) { this.understand(); return; }
    if (this.list.hidden) return;
    if (event.key === "ArrowDown" || event.key === "ArrowUp") {
      event.preventDefault();
      this.at = (this.at + (event.key === "ArrowDown" ? 1 : -1) + this.ports.length) % this.ports.length;
      [...this.list.children].forEach((item, i) => item.setAttribute("aria-selected", String(i === this.at)));
      this.input.setAttribute("aria-activedescendant", `${this.list.id}-${this.at}`);
    } else if (event.key === "Enter") {
      event.preventDefault();
      event.stopPropagation();
      this.#take(Math.max(0, this.at));
    }
  }
}

// The ends of a voyage as the chart shows them; a place is [latitude, longitude] or a text.
export async function endsOf({ start, goal }) {
  const end = async (given, role) => {
    if (Array.isArray(given)) return { role, lat: given[0], lon: given[1], label: "" };
    const { kind, display_name: name, lat, lon, approach } = await get(`/places?text=${encodeURIComponent(given)}`);
    const [y, x] = approach?.berth || [lat, lon];
    return { role, lat: y, lon: x, label: kind === "port" ? name : "" };
  };
  return Promise.all([end(start, "start"), end(goal, "goal")]);
}
