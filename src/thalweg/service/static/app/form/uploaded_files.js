// Files that are uploaded and chosen from a list: `path` of the interface holds the list.

import { get, uploadForm } from "../common/api.js";
import { announce, errorBox, fill, h } from "../common/elements.js";

export class UploadedFiles {
  /**
   * @param {string} path of the list
   * @param {string} words on the button
   * @param {string} accept endings of files
   * @param {{many?: boolean, shown?: (file: object) => boolean, upload?: (file: File) => Promise<object>}} how
   */
  constructor(path, words, accept, { many = false, shown = () => true, upload = (file) => uploadForm(path, file) } = {}) {
    Object.assign(this, { path, words, many, shown, upload, files: [], chosen: [] });
    this.list = h("div");
    this.input = h("input.hidden", { type: "file", "aria-label": words, accept, tabindex: "-1", onchange: () => this.#read() });
    this.slot = h("div.slot");
    this.element = h("div.field", {}, this.list, h("button.quiet.small", { type: "button", onclick: () => this.input.click() }, `${words} …`), this.input, this.slot);
  }

  async load() {
    this.files = (await get(this.path)).filter((file) => this.shown(file) || this.chosen.includes(file.id));
    this.chosen = this.chosen.filter((id) => this.files.some((file) => file.id === id));
    this.#show();
  }

  #show() {
    const gone = this.chosen.filter((id) => !this.files.some((file) => file.id === id)).map((id) => ({ id, name: "a file that is not there any more" }));
    fill(this.list, [...this.files, ...gone].map((file) => h("label.check", {}, h("input", { type: this.many ? "checkbox" : "radio", name: this.path, value: file.id, checked: this.chosen.includes(file.id), onchange: () => { this.chosen = [...this.list.querySelectorAll("input:checked")].map((box) => box.value); } }), h("span", {}, file.name))));
  }

  async #read() {
    const [file] = this.input.files;
    this.input.value = "";
    if (!file) return;
    fill(this.slot, h("p.facts", {}, `Reading ${file.name} …`));
    try {
      const kept = await this.upload(file);
      this.chosen = this.many ? [...this.chosen, kept.id] : [kept.id];
      await this.load();
      fill(this.slot);
      announce(`${file.name} is read.`);
      this.element.dispatchEvent(new Event("change", { bubbles: true }));
    } catch (problem) {
      fill(this.slot, errorBox(problem));
    }
  }

  set(ids) {
    this.chosen = [...ids];
    this.#show();
  }
}
