// Numbers, times and positions as text. Unknown is "unknown", never zero.

const MONTHS = ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];
const two = (n) => String(n).padStart(2, "0");

export const known = (value) => value !== null && value !== undefined && Number.isFinite(value);

export function number(value, decimals = 0) {
  if (!known(value)) return "unknown";
  return value.toLocaleString("en-GB", { minimumFractionDigits: decimals, maximumFractionDigits: decimals });
}

// A time of the service or of a voyage file; without a zone it is UTC.
export function seconds(text) {
  if (typeof text === "number") return text;
  const value = Date.parse(/T[\d:.]+$/.test(text) ? `${text}Z` : text);
  return Number.isFinite(value) ? value / 1000 : null;
}

// To the nearest minute, as all times of the page.
export function time(s, withYear = false) {
  if (!known(s)) return "unknown";
  const d = new Date(Math.round(s / 60) * 60000);
  const year = withYear ? ` ${d.getUTCFullYear()}` : "";
  return `${d.getUTCDate()} ${MONTHS[d.getUTCMonth()]}${year} ${two(d.getUTCHours())}:${two(d.getUTCMinutes())}`;
}

// Whether a plan has no weather data: the sea was assumed to be calm.
export const isCalm = (request) => request?.seas?.length === 1 && request.seas[0] === "calm";

// A text of the service: times such as 1998-08-31T12:00:00Z become 31 Aug 1998 12:00 UTC.
// Positions in degrees become degrees and minutes, as on a chart.
export function readable(text) {
  return text.replace(/\d{4}-\d\d-\d\dT\d\d:\d\d(:[\d.]+)?Z/g, (found) => `${time(seconds(found), true)} UTC`)
    .replace(/\b(\d{1,2}\.\d+)([NS]),? (\d{1,3}\.\d+)([EW])\b/g, (_, lat, north, lon, east) => position(north === "S" ? -lat : Number(lat), east === "W" ? -lon : Number(lon)));
}

export function duration(hours) {
  if (!known(hours)) return "unknown";
  const minutes = Math.round(hours * 60), days = Math.floor(minutes / 1440);
  if (minutes < 60) return `${minutes} min`;
  return `${days ? `${days} d ` : ""}${Math.floor((minutes % 1440) / 60)} h ${two(minutes % 60)} min`;
}

// A duration of weeks: days and whole hours.
export function days(hours) {
  const whole = Math.round(hours);
  return known(hours) && whole >= 48 ? `${Math.floor(whole / 24)}\u00a0d ${whole % 24}\u00a0h` : duration(hours);
}

// The difference of two figures as they are shown: of hours to the minute (decimals null), else rounded.
export function difference(a, b, decimals = null) {
  const rounded = (value) => (decimals === null ? Math.round(value * 60) / 60 : Number(value.toFixed(decimals)));
  return known(a) && known(b) ? rounded(a) - rounded(b) : null;
}

export function signedDuration(hours) {
  if (!known(hours)) return "";
  if (Math.round(hours * 60) === 0) return "0 min";
  return `${hours < 0 ? "−" : "+"}${duration(Math.abs(hours))}`;
}

export function signed(value, decimals = 1) {
  if (!known(value)) return "";
  if (Number(value.toFixed(decimals)) === 0) return number(0, decimals);
  return `${value < 0 ? "−" : "+"}${number(Math.abs(value), decimals)}`;
}

function angle(value, digits, plus, minus) {
  const size = Math.abs(value);
  let degrees = Math.floor(size), minutes = (size - degrees) * 60;
  if (minutes >= 59.95) { degrees += 1; minutes = 0; }
  return `${String(degrees).padStart(digits, "0")}°${minutes.toFixed(1).padStart(4, "0")}′${value < 0 ? minus : plus}`;
}

// The name of a job; those of programs may have none.
export function titleOf({ title, kind, request }) {
  const place = (given) => (Array.isArray(given) ? plainPosition(...given) : given);
  const { start, goal } = request?.voyage || {};
  return title || (start && goal ? `${place(start)} to ${place(goal)}` : { evaluation: "Route from a file", project: "Project", study: "Study", forecast: "Forecast" }[kind] || "Plan");
}

export function position(lat, lon) {
  const turned = ((((lon + 180) % 360) + 360) % 360) - 180;
  return `${angle(lat, 2, "N", "S")} ${angle(turned, 3, "E", "W")}`;
}

export function plainPosition(lat, lon) {
  const turned = ((((lon + 180) % 360) + 360) % 360) - 180;
  return `${Math.abs(lat).toFixed(4)}${lat < 0 ? "S" : "N"} ${Math.abs(turned).toFixed(4)}${turned < 0 ? "W" : "E"}`;
}

export const bearing = (degrees) => (known(degrees) ? `${String(Math.round(degrees) % 360).padStart(3, "0")}°` : "unknown");

export function inputTime(s) {
  return new Date(s * 1000).toISOString().slice(0, s % 60 ? 19 : 16).replace("T", " ");
}

export function unwrapped(lons) {
  const found = [];
  let turn = 0;
  lons.forEach((lon, i) => {
    if (i) {
      const step = lon + turn - found[i - 1];
      if (step > 180) turn -= 360;
      else if (step < -180) turn += 360;
    }
    found.push(lon + turn);
  });
  return found;
}
