// The address of a state: #demo, #plan=ID&route=2&t=SECONDS, #voyage=REQUEST, #view=compare
// Each plan and each view has its entry in the history of the browser; the form is the place without a name.

import { hint } from "./common/elements.js";

const NAMES = ["plan", "view", "voyage", "demo", "routes"];

function placeOf(hash) {
  const given = new URLSearchParams(hash.slice(1));
  return given.get("plan") || given.get("view") || "";
}

export class Address {
  written = "";

  // The parts of the address; null where the page wrote it itself, or where it is a place in the page.
  read() {
    if (location.hash === this.written) return null;
    const given = new URLSearchParams(location.hash.slice(1));
    if (location.hash && !NAMES.some((name) => given.has(name))) return null;
    this.written = location.hash;
    return given;
  }

  get namesPlan() {
    return new URLSearchParams(location.hash.slice(1)).has("plan");
  }

  // Whether the browser went back or forward to the form.
  get returnsToForm() {
    return Boolean(history.state?.written) && !placeOf(location.hash);
  }

  // The entry with which the page was opened is one of its own from now on.
  keep() {
    history.replaceState({ written: true }, "");
  }

  leave() {
    if (placeOf(location.hash)) this.write("");
  }

  write(text) {
    clearTimeout(this.timer);
    this.written = text ? `#${text}` : "";
    const same = placeOf(this.written) === placeOf(location.hash);
    history[same ? "replaceState" : "pushState"]({ written: true }, "", this.written || location.pathname);
  }

  // What changed within a place; nothing where the browser has gone to another one.
  update(text) {
    if (placeOf(`#${text}`) === placeOf(location.hash)) this.write(text);
  }

  // A result has its entry as soon as it is shown.
  show(text) {
    if (placeOf(`#${text}`) === placeOf(location.hash)) this.updateSoon(() => text);
    else this.write(text);
  }

  // After a pause, so that a moving time does not write at every step.
  updateSoon(textOf) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => { const text = textOf(); if (text) this.update(text); }, 250);
  }

  async copy(text) {
    this.write(text);
    try {
      await navigator.clipboard.writeText(location.href);
      hint("The link is copied. It opens where the token of this service is known.");
    } catch {
      hint("The link is in the address line. It opens where the token of this service is known.");
    }
  }
}
