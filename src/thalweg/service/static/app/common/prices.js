// The prices that a cost counts, each with where it comes from.

import { known, number } from "./format.js";

const SOURCES = { "ship file": "ship file", request: "given" };

// Such as "fuel 300 a tonne (ship file), 468 in control areas; no price of time; no EU charges".
export function pricesText(prices) {
  const of = (name) => prices?.[name]?.value, from = (name) => { const { source } = prices[name]; return ` (${SOURCES[source] || source})`; };
  const fuel = of("fuel_per_t"), dear = of("fuel_in_eca_per_t"), cubed = of("per_second_per_cubed_speed"), day = of("time_per_day"), parts = [];
  if (known(fuel)) parts.push(`fuel ${number(fuel)} a tonne${from("fuel_per_t")}${known(dear) && dear !== fuel ? `, ${number(dear)} in control areas` : ""}`);
  if (known(cubed)) parts.push(`sailing ${cubed} a second and cubed m/s of speed${from("per_second_per_cubed_speed")}`);
  const own = prices?.time_per_day?.replaced;
  if (day > 0) parts.push(`time ${number(day)} a day${from("time_per_day")}${known(own) ? ` in place of ${number(own)} of the ship file` : ""}`);
  if (!parts.length) return "";
  if (!(day > 0)) parts.push("no price of time");
  const { not_counted: left, voyage_share: share } = prices.european_charges || {};
  if (share > 0) parts.push(`EU charges on ${number(100 * share)} %${left?.length ? `, without ${left.map((text) => text.split(":")[0]).join(" and ")}` : ""}`);
  else if (left?.length) parts.push("no EU charges");
  return parts.join("; ").replace(/^./, (first) => first.toUpperCase());
}
