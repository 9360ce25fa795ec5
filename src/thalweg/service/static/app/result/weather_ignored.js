// What a route saves over the one that ignores the weather, where that can be said.

import { h } from "../common/elements.js";
import { faultWords } from "../common/faults.js";
import { duration, known, number, signed, signedDuration } from "../common/format.js";

const ALIKE = 0.01; // share of the duration by which two routes may differ and arrive at the same time
const AGAINST = " against weather ignored";

export class WeatherIgnored {
  /**
   * @param {object} plan with its notes, and the comparison of a front
   * @param {object} route the chosen one
   * @param {object | null} blind the route that ignores the weather, sailed in it
   */
  constructor(plan, route, blind) {
    Object.assign(this, { plan, route, blind });
    const sailed = blind && blind.feasible !== undefined;
    this.refused = sailed && (!blind.feasible || !known(blind.time_h) || plan.notes.some((note) => note.includes("Savings over it are not stated")));
    this.stated = sailed && !this.refused && route.feasible;
    this.later = this.stated ? route.time_h - blind.time_h : 0;
    this.sameTime = this.stated && Math.abs(this.later) <= ALIKE * blind.time_h;
  }

  time() {
    return this.#words(this.route.time_h, this.blind?.time_h, signedDuration, true);
  }

  // Of fuel and cost: less of it on a voyage that takes longer is no saving.
  amount(mine, other, text) {
    const comparable = this.sameTime || Math.sign(mine - other) === Math.sign(this.later);
    return this.#words(mine, other, text, comparable);
  }

  #words(mine, other, text, comparable) {
    if (!this.stated || !known(mine) || !known(other) || !/[1-9]/.test(text(mine - other))) return null;
    if (!comparable) return `${text(mine - other)}${AGAINST}, which arrives ${duration(Math.abs(this.later))} ${this.later > 0 ? "earlier" : "later"}`;
    return [h(`span.${mine < other ? "less" : "more"}`, {}, text(mine - other)), AGAINST];
  }

  // A card: which limit that route breaks, or what a front saves in the same time.
  card() {
    const text = this.refused ? this.#fault() : this.stated ? this.#saved() : null;
    return text && h("div.card.wide.prices", {}, h("dt", {}, "Weather ignored"), h("dd", {}, text));
  }

  #fault() {
    const { violations } = this.blind;
    return `That route ${violations?.length ? faultWords(violations) : "breaks a limit"}. Savings over it are not stated.`;
  }

  #saved() {
    const rows = (this.plan.comparison || []).filter((row) => row.saved > 0);
    if (!rows.length || !this.plan.front) return null;
    const apart = (row) => Math.abs(row.time_h - this.route.time_h);
    const row = rows.reduce((best, one) => (apart(one) < apart(best) ? one : best));
    const { criterion, unit } = this.plan.front;
    return `The shortest route at ${number(row.speed_kn, 1)} kn takes ${duration(row.time_h)}. In the same time a route of this plan has ${signed(-row.saved, row.saved < 100 ? 1 : 0)} ${unit} of ${criterion} (${number(row.saved_percent, 1)} %).`;
  }
}
