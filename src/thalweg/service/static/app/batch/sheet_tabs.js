// Tabs over one sheet in the drawer: each draws itself when it is opened or resized.

import { fill, h } from "../common/elements.js";

export class SheetTabs {
  // parts: [[name, text, draw(sheet)], ...]
  constructor(label, parts) {
    this.parts = parts;
    this.open = parts[0][0];
    this.list = h("div.tabs", { role: "tablist", "aria-label": label });
    this.aside = h("span.lead");
    this.sheet = h("div.sheet", { role: "tabpanel", id: "batch-sheet", tabindex: 0 });
    this.element = h("div.tabbed", {}, h("div.player", {}, this.list, this.aside), this.sheet);
    new ResizeObserver(() => this.draw()).observe(this.sheet);
    addEventListener("palette", () => { if (this.element.isConnected) this.redraw(); });
    this.#tabs();
  }

  #tabs() {
    fill(this.list, this.parts.map(([name, text]) => h("button", { type: "button", role: "tab", id: `batch-${name}`, "aria-controls": "batch-sheet", "aria-selected": String(name === this.open), tabindex: name === this.open ? 0 : -1, onclick: () => this.show(name), onkeydown: (event) => this.#key(event) }, text)));
    this.sheet.setAttribute("aria-labelledby", `batch-${this.open}`);
  }

  show(name) {
    this.open = name;
    this.#tabs();
    this.list.querySelector(`#batch-${name}`).focus({ preventScroll: true });
    this.size = null;
    this.draw();
  }

  #key(event) {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const at = this.parts.findIndex(([name]) => name === this.open);
    this.show(this.parts[(at + step + this.parts.length) % this.parts.length][0]);
  }

  redraw() { this.size = null; this.draw(); }

  draw() {
    const size = `${this.sheet.clientWidth} ${this.sheet.clientHeight}`;
    if (size === this.size || this.sheet.clientWidth < 60 || this.sheet.clientHeight < 40) return;
    this.size = size;
    this.aside.textContent = this.parts.find(([name]) => name === this.open)[2](this.sheet) || "";
  }
}
