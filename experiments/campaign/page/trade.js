"use strict";
// Detection time over false alarms per hour: a panel for each body, a line for each estimator along the grid.

const tradeBox = { left: 46, top: 10, width: 480, height: 240, right: 26, bottom: 40 };

function showTrade() {
  const told = campaign.groups.filter(({ contacts, alarm_rate_at_most: bound }) => contacts > 0 && bound !== null);
  const isTrade = told.some(({ alarms }) => alarms > 0) && new Set(told.map(rateOf)).size > 1;
  byId("trade").hidden = !isTrade;
  if (!isTrade) return;
  const hours = told.map(({ alarm_hours }) => alarm_hours);
  const [least, most] = [Math.min(...hours), Math.max(...hours)].map((each) => number(each, 2));
  byId("trade-source").textContent = `counted in ${least} to ${most} h at each point ` +
    (campaign.alarm_table ? `in ${campaign.alarm_table}` : "before the contacts of this campaign");
  const bodies = [...new Set(told.map((group) => group.body))];
  byId("trade-panels").replaceChildren(...bodies.map((body) => tradePanel(body, told.filter((group) => group.body === body), told)));
  byId("trade-legend").replaceChildren(...campaign.estimators.map((estimator) => {
    const swatch = element("span", { class: "dot" });
    swatch.style.background = colourOf(estimator);
    return element("span", {}, swatch, estimator.replaceAll("_", " "));
  }));
}

/** Where a point stands: by the false alarms of its place in the grid, whatever was touched and in which scenario. */
function rateOf(group) {
  return group.alarms > 0 ? group.alarm_rate : group.alarm_rate_at_most;
}

function tradePanel(body, groups, all) {
  const { left, top, width, height, right, bottom } = tradeBox;
  const svg = picture(left + width + right, top + height + bottom, `Detection time over false alarms, ${body}`);
  const rates = all.map(rateOf);
  const marks = powers(Math.min(...rates), Math.max(...rates));
  const [first, last] = [Math.log10(marks[0]), Math.log10(marks.at(-1))];
  const longest = longestTime(all);
  const x = (rate) => left + (width * (Math.log10(rate) - first)) / Math.max(1, last - first);
  const y = (time) => top + height * (1 - Math.min(1, time / longest));
  for (const mark of marks) {
    shape(svg, "line", { class: "grid", x1: x(mark), x2: x(mark), y1: top, y2: top + height });
    write(svg, x(mark), top + height + 16, number(mark, 1), { class: "tick" });
  }
  for (const tick of roundNumbers(1000 * longest)) {
    shape(svg, "line", { class: "grid", x1: left, x2: left + width, y1: y(tick / 1000), y2: y(tick / 1000) });
    write(svg, left - 6, y(tick / 1000) + 4, chosen(tick), { class: "tick end" });
  }
  write(svg, left + width, top + height + 33, "false alarms per hour", { class: "tick end" });
  write(svg, left, top + height + 33, "ms until detected, upwards", { class: "tick start" });
  for (const estimator of campaign.estimators) tradeLine(svg, groups.filter((group) => group.estimator === estimator), x, y);
  return panel(capitalised(body), svg);
}

function tradeLine(svg, groups, x, y) {
  const seen = groups.filter(({ quantiles }) => quantiles[2] !== null).sort((a, b) => rateOf(a) - rateOf(b));
  if (seen.length === 0) return;
  const style = `--colour: ${colourOf(seen[0].estimator)}`;
  const points = seen.map((group) => `${x(rateOf(group))},${y(group.quantiles[2])}`).join(" ");
  shape(svg, "polyline", { class: "trade-line", style, points });
  for (const group of seen) {
    const [at, median, end] = [x(rateOf(group)), y(group.quantiles[2]), group.quantiles[4]];
    shape(svg, "line", { class: "whisker", style, x1: at, x2: at, y1: median, y2: end === null ? tradeBox.top : y(end) });
    const dot = shape(svg, "circle", { class: group.alarms > 0 ? "seen" : "none-seen", style, cx: at, cy: median, r: 4.5 });
    shape(dot, "title").textContent = `${nameOf(group)}: ${inMs(group.quantiles[2])} ms (${inMs(end)} ms)`;
  }
}
