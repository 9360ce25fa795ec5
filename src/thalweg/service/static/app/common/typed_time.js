// A time as it is typed, in UTC.

// Seconds since 1970; null where the text of an input is no time.
export function typedTime(input) {
  const found = /^\s*(\d{4})-(\d\d?)-(\d\d?)(?:[T ]+(\d\d?):(\d\d)(?::(\d\d))?)?\s*Z?\s*$/.exec(input.value);
  if (!found) return null;
  const [year, month, day, hour = 0, minute = 0, second = 0] = found.slice(1).map((part) => Number(part ?? 0));
  const t = Date.UTC(year, month - 1, day, hour, minute, second);
  return new Date(t).getUTCDate() === day && hour < 24 && minute < 60 && second < 60 ? t / 1000 : null;
}
