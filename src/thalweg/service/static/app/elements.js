// Small helpers to build the page: h("p.note", {id: "x"}, "text", child).

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

export const unit = (text) => h("span.unit", {}, ` ${text}`);

export function announce(text) {
  document.getElementById("announcer").textContent = text;
}

export function errorBox(problem) {
  const parts = [h("b", {}, problem.asked || problem.detail || String(problem))];
  if (problem.possible) parts.push(h("span", {}, problem.possible, " "));
  if (problem.remedy) parts.push(h("span.remedy", {}, problem.remedy));
  return h("div.error", { role: "alert" }, ...parts);
}

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}
