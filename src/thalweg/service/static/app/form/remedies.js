// What a refusal offers: a button for each remedy that one change of the form makes.

import { h } from "../common/elements.js";
import { inputTime, known, number, seconds, time } from "../common/format.js";
import { typedTime } from "../common/typed_time.js";

const DAY = 86400;
const LIMITS = [["wave height above the limit", "wave_height_m", "Change the limit of waves"], ["wind speed above the limit", "wind_speed_kn", "Change the limit of wind"]];

/**
 * The buttons under a refusal.
 * @param {object} problem problem details of the service
 * @param {PlanForm} form
 * @param {(field: string) => void} done after the change: takes the refusal away and shows the field
 */
export function remedyButtons(problem, form, done) {
  const found = [], { sea, ship } = form;
  const offer = (text, field, act) => found.push(h("button.quiet.small", { type: "button", onclick: () => { act(); done(field); } }, text));
  const reasons = problem.reasons || {};
  const departs = typedTime(form.depart);
  const earliest = seconds(problem.details?.earliest);
  if (earliest !== null) {
    const minute = Math.ceil(earliest / 60) * 60;
    offer(`Arrive by ${time(minute)}`, "arrive_by", () => { form.fields.inputs.arrive_by.value = inputTime(minute); });
  } else if (problem.field === "arrive_by") offer("Without an arrival", "arrive_by", () => { form.fields.inputs.arrive_by.value = ""; });
  if (problem.field === "depart" && sea.period) offer(`Depart ${time(sea.period[0], true)}`, "depart", () => { form.depart.value = inputTime(sea.period[0]); form.latest.value = ""; });
  const ended = Boolean(problem.details?.data_end); // an earlier ship arrives within the data
  if (ended && departs !== null && sea.period && departs > sea.period[0]) {
    const earlier = Math.max(departs - DAY, sea.period[0]);
    offer(`Depart ${time(earlier, true)}`, "depart", () => { form.depart.value = inputTime(earlier); form.latest.value = ""; });
  }
  const stormy = ended ? [] : LIMITS.filter(([reason]) => reasons[reason]);
  if (stormy.length && departs !== null) offer("Depart a day later", "depart", () => { form.depart.value = inputTime(departs + DAY); });
  for (const [, field, text] of stormy) offer(text, field, () => {});
  if (!ended && reasons["nearer to land than the offing"]) offer("No distance from land", "offing_nm", () => { form.fields.inputs.offing_nm.value = "0"; });
  if (problem.field?.endsWith("speed_kn") && known(ship.speedRange?.[1])) offer(`Order ${number(ship.speedRange[1], 1)} kn`, "speed_kn", () => { form.fields.inputs.speed_kn.value = String(ship.speedRange[1]); });
  if (problem.field === "min_ukc_m") offer("Without a clearance", "min_ukc_m", () => { form.fields.inputs.min_ukc_m.value = ""; });
  if (reasons["no data"]) offer("Fill with the nearest value within 25 nm", "fill", () => { for (const [, select] of form.fills) select.value = "nearest:25"; });
  return found.length ? h("div.exports.remedies", {}, found) : null;
}
