// Limits that a route breaks, in words: the worst first, and what may help.

const WORST = [ // beginning of a reason, its words, and whether another time or speed may help
  ["land", "crosses land", false], ["no-go zone", "crosses a closed area", false], ["outside the chart", "leaves the chart", false], ["against the traffic lane", "runs against a traffic lane", false],
  ["nearer to land than the offing", "is nearer to land than the offing", false], ["under-keel clearance", "has too little water under the keel", true],
  ["current too strong", "meets a current too strong to hold the course", true], ["no data", "leaves the data", false], ["outside the period", "leaves the period of the data", true],
];

const reasonOf = ({ reason }) => WORST.findIndex(([begins]) => reason.startsWith(begins));

// Such as "crosses land and breaks 3 more limits"; the worst stands first.
export function faultWords(violations) {
  const found = WORST.findIndex((_, i) => violations.some((one) => reasonOf(one) === i));
  const rest = violations.filter((one) => reasonOf(one) !== found).length;
  const limits = (n, more) => `${n}${more} limit${n === 1 ? "" : "s"}`;
  if (found < 0) return violations.length === 1 ? `breaks a limit: ${violations[0].reason}` : `breaks ${limits(rest, "")}`;
  return WORST[found][1] + (rest ? ` and breaks ${limits(rest, " more")}` : "");
}

export function remedyOf(violations) {
  const fixed = violations.filter((one) => WORST[reasonOf(one)]?.[2] === false).length;
  if (fixed === violations.length) return " Another track is needed.";
  return fixed ? " Another track is needed for the first; a later departure or a lower speed may keep the others." : " A later departure or a lower speed may keep them.";
}
