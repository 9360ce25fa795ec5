// The address of a state: #demo, #plan=ID&route=2&t=SECONDS, #voyage=REQUEST, #view=compare

import { hint } from "./common/elements.js";

// What an address shows: a job, a view or the form. Its route and moment are no other place.
function placeOf(hash) {
  const parts = new URLSearchParams(hash.slice(1));
  return parts.get("plan") || parts.get("view") || "";
}

export class Address {
  written = "";

  // The parts of the address; null where the page wrote it itself.
  read() {
    if (location.hash === this.written) return null;
    this.written = location.hash;
    return new URLSearchParams(location.hash.slice(1));
  }

  // Another place is an entry of the browser's history, so that Back returns from it.
  write(text) {
    clearTimeout(this.timer);
    this.written = text ? `#${text}` : "";
    const entry = placeOf(this.written) === placeOf(location.hash) ? "replaceState" : "pushState";
    history[entry](null, "", this.written || location.pathname);
  }

  // After a pause, so that a moving time does not write at every step.
  writeSoon(textOf) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => { const text = textOf(); if (text) this.write(text); }, 250);
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
