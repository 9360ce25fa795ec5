// Ready comparisons: voyages that two theses show, each with what it compares.

const NORWAY = { ship: "yu-single-screw-169m", seas: ["storm"], proof_s: 2 };
const OCEAN = { ship: "handysize-bulker", seas: ["storm"], proof_s: 2 };
const WAYS = { ship: "handysize-bulker", seas: ["calm"], proof_s: 0 };
const rotterdam = { start: "Rotterdam", goal: "Singapore", depart: "2026-01-01T00:00Z" };
const atlantic = { start: "Halifax", goal: "49.7N 6.5W", depart: "1998-08-31T12:00Z" };

// beside: the route that ignores the weather is compared too.
export const EXAMPLES = [
  {
    name: "Suez, or round the Cape", facts: "Rotterdam to Singapore in calm water, as on the screen of Seuren.",
    plans: [{ ...WAYS, title: "By Suez", voyage: rotterdam }, { ...WAYS, title: "Round the Cape", voyage: { ...rotterdam, avoid: ["suez"] } }],
  },
  {
    name: "North Atlantic in a storm", facts: "Halifax to the Channel in August 1998: least time, the weather ignored, and a day later (Seuren).", beside: true,
    plans: [{ ...OCEAN, title: "Least time", voyage: atlantic }, { ...OCEAN, title: "A day later", voyage: { ...atlantic, depart: "1998-09-01T12:00Z" } }],
  },
  {
    name: "One voyage, four speeds", facts: "Along western Norway, as case B of Yu: the same way, more fuel. This ship reaches 13.9 kn.",
    plans: [10, 11, 12, 13].map((speed_kn) => ({ ...NORWAY, title: `${speed_kn} kn`, voyage: { start: "59.2N 4.4E", goal: "62.6N 5.2E", depart: "1998-08-31T12:00Z", speed_kn } })),
  },
  {
    name: "One voyage, three resolutions", facts: "Along western Norway, case C of Yu: coarse networks stay off land too.",
    plans: [1, 2, 4].map((resolution_nm) => ({ ...NORWAY, title: `${resolution_nm} nm`, resolution_nm, voyage: { start: "62.5N 4.8E", goal: "59.0N 4.6E", depart: "1998-08-31T12:00Z", speed_kn: 12 } })),
  },
];

// A change of a voyage: a text, and the requests that follow from that of the first route and the ship's top speed.
const changed = (base, title, edit) => {
  const request = structuredClone(base);
  edit(request);
  request.title = `${base.title || "Plan"}, ${title}`;
  return request;
};
const later = (voyage, hours) => {
  voyage.depart = `${new Date(Date.parse(voyage.depart || voyage.depart_window[0]) + hours * 3.6e6).toISOString().slice(0, 19)}Z`;
  delete voyage.depart_window;
};

export const VARIATIONS = [
  ["Three speeds", (base, top) => [0.8, 0.9].map((share) => Number((top * share).toFixed(1))).map((speed) => changed(base, `${speed} kn`, ({ voyage }) => { Object.assign(voyage, { speed_kn: speed, objective: "time" }); }))],
  ["Departures +12, +24 h", (base) => [12, 24].map((hours) => changed(base, `+${hours} h`, ({ voyage }) => later(voyage, hours)))],
  ["Shortest route", (base) => [changed(base, "shortest", ({ voyage }) => { voyage.objective = "distance"; })]],
  ["Without weather", (base) => [changed(base, "no weather", (request) => { request.seas = ["calm"]; request.fill = {}; })]],
  ["Without offing", (base) => [changed(base, "no offing", ({ voyage }) => { voyage.offing_nm = 0; })]],
  ["Coarser networks", (base) => [2, 4].map((factor) => factor * (base.resolution_nm || 4)).map((spacing) => changed(base, `${spacing} nm`, (request) => { request.resolution_nm = spacing; }))],
  ["Global grid", (base) => [changed(base, "global grid", (request) => { request.network = "globe"; delete request.resolution_nm; })]],
];

// The same request has the same key: an example that was planned is shown at once.
export function keyOf(request) {
  let sum = 0;
  for (const letter of JSON.stringify(request)) sum = (Math.imul(sum, 31) + letter.codePointAt(0)) | 0;
  return `example ${request.title} ${(sum >>> 0).toString(16)}`;
}
