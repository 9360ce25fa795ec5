// The address of a state: #demo, #plan=ID&route=2&t=SECONDS, #voyage=REQUEST, #view=compare

import { hint } from "./common/elements.js";

export class Address {
  written = "";

  // The parts of the address; null where the page wrote it itself.
  read() {
    return location.hash === this.written ? null : new URLSearchParams(location.hash.slice(1));
  }

  write(text) {
    clearTimeout(this.timer);
    this.written = text ? `#${text}` : "";
    history.replaceState(null, "", this.written || location.pathname);
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
