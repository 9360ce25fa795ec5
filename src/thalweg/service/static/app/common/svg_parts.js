// Parts of drawings as SVG: elements, round values on an axis.

const SVG = "http://www.w3.org/2000/svg";

export function svg(name, attributes = {}, text = null) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key === "style") element.style.cssText = value; // an attribute would need another policy
    else if (value !== null) element.setAttribute(key, value);
  }
  if (text !== null) element.textContent = text;
  return element;
}

// Round values between two others, about count of them.
export function ticks(low, high, count) {
  const raw = (high - low) / count, size = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((m) => m * size).find((value) => value >= raw);
  const found = [];
  for (let v = Math.ceil(low / step) * step; v <= high + 1e-9; v += step) found.push(Number(v.toPrecision(12)));
  return found;
}
