// Small helpers to build the page: h("p.note", {id: "x"}, "text", child).

import { duration, number, readable } from "./format.js";

// What legs were refused for, after their number.
export const REASONS = {
  "nearer to land than the offing": "legs nearer to land than the offing", "no-go zone": "legs through closed areas", "outside the period of the data": "legs after the end of the data",
  "wave height above the limit": "legs with waves above the limit", "wind speed above the limit": "legs with wind above the limit", "no data": "legs over water without data", land: "legs over land",
  "under-keel clearance": "legs over water that is too shallow", "current too strong to hold the course": "legs with a current too strong to hold the course",
  "weather in which the ship's speed is not known": "legs in weather in which the ship's speed is not known", "safety or comfort limit of the ship": "legs beyond a limit of safety or comfort",
};

export function h(kind, attributes = {}, ...children) {
  const [tag, ...classes] = kind.split(".");
  const element = document.createElement(tag || "div");
  if (classes.length) element.className = classes.join(" ");
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name === "style") element.style.cssText = value; // an attribute would need another policy
    else if (name === "value") element.value = value;
    else if (name === "checked" || name === "selected" || name === "hidden") element[name] = Boolean(value);
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

export function fill(element, ...children) {
  element.replaceChildren(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

// An input with its unit in it, at the right.
export const withUnit = (input, text) => h("div.with-unit", {}, input, h("span.unit", {}, text));

export const unit = (text) => h("span.unit", {}, ` ${text}`);

// A duration with its units in a lighter tone.
export const durationParts = (hours) => duration(hours).split(" ").map((word, i, all) => (i % 2 ? h("span.unit", {}, ` ${word}${i < all.length - 1 ? " " : ""}`) : word));

// A list whose first entries are shown, and the others where they are wanted.
export function longList(items, first) {
  const rest = items.slice(first);
  return [h("ul.list", {}, items.slice(0, first)), rest.length ? h("details", {}, h("summary", {}, `${number(rest.length)} more`), h("ul.list", {}, rest)) : null];
}

export function announce(text) {
  document.getElementById("announcer").textContent = text;
}

// A note over the chart for some seconds.
export function hint(text) {
  const note = document.getElementById("hint");
  note.textContent = text;
  note.hidden = false;
  announce(text);
  setTimeout(() => { note.hidden = true; }, 2500);
}

/**
 * A refusal in three parts, with the number of legs that were refused for each reason.
 * @param {{asked: string, possible?: string, remedy?: string, reasons?: Object<string, number>}} problem
 */
export function errorBox(problem) {
  const reasons = Object.entries(problem.reasons || {}).filter(([reason]) => REASONS[reason]);
  return h("div.error", { role: "alert" }, h("b", {}, readable(problem.asked || problem.detail || String(problem))),
    problem.possible ? h("span", {}, readable(problem.possible), " ") : null,
    reasons.length ? h("span", {}, `Refused were ${reasons.map(([reason, count]) => `${number(count)} ${REASONS[reason]}`).join(", ")}. `) : null,
    problem.remedy ? h("span.remedy", {}, readable(problem.remedy)) : null);
}

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
