"use strict";
// What the charts show, in order. A chart without columns in the report, or without a value in any, is left out.
//
// symbol: letter and index. series: label, values, colour (a variable of page.css) and wide: true for the true or commanded value,
// over which the estimated or applied one is drawn thin. scale: from SI to the unit shown.
// least: smallest span of the value axis, so that noise is not blown up. reach: bounds that the axis always includes.

const degrees = 180 / Math.PI;

function one(name, label, colour, wide = false) {
  return has(name) ? [{ label, values: report.columns[name], colour, wide }] : [];
}

function derived(values, label, colour, wide = false) {
  return values ? [{ label, values, colour, wide }] : [];
}

/** One pair of commanded and applied torque for each leg. */
function torques() {
  const legs = Math.max(columnCount("torque_commanded_"), columnCount("torque_applied_"));
  return Array.from({ length: legs }, (_, i) => i + 1).flatMap((leg) => [
    ...one(`torque_commanded_${leg}`, `${leg} commanded`, `--leg-${leg}`, true),
    ...one(`torque_applied_${leg}`, `${leg} applied`, `--leg-${leg}`),
  ]);
}

const estimatorColours = ["--estimate", "--leg-2", "--leg-3", "--leg-4", "--leg-5", "--leg-1", "--leg-6", "--plain"];

/** What each estimator says, thin, over what is true; nothing where only one ran. */
function byEstimator(part, truth) {
  if (report.estimators.length === 0) return [];
  return [...derived(truth, "true", "--true", true), ...report.estimators.flatMap((name, i) =>
    one(`estimator_${i + 1}_${part}`, name.replaceAll("_", " "), estimatorColours[i % estimatorColours.length]))];
}

/** Probabilities of the classes that ever had a share worth drawing; those of a leg have its colour. */
function probabilities() {
  return Object.keys(report.columns).filter((name) => name.startsWith("probability_")).flatMap((name) => {
    const values = report.columns[name];
    if (!values.some((value) => value !== null && value > 0.05)) return [];
    const leg = /leg(\d)/.exec(name)?.[1];
    const label = name.slice("probability_".length).replaceAll("_", " ");
    return [{ label, values, colour: leg ? `--leg-${leg}` : "--plain", wide: name.endsWith("clamping") }];
  });
}

/** Decimals that show three significant digits of the largest value, but at least one. */
function decimalsFor(values) {
  const largest = values.reduce((size, value) => Math.max(size, Math.abs(value ?? 0)), 0);
  return largest > 0 ? Math.min(6, Math.max(1, 2 - Math.floor(Math.log10(largest)))) : 1;
}

/** What the law serves, where it ever does. */
function energies(prefix) {
  const served = [["task_1", "first task", "--plain"], ["task_2", "second task", "--estimate"],
    ["sigma_kappa", "condition number", "--leg-1"], ["sigma_sc", "self-collision", "--leg-2"]];
  return served.filter(([name]) => has(`energy_${name}`) && report.columns[`energy_${name}`].some((value) => value !== null))
    .flatMap(([name, label, colour]) => one(`${prefix}_${name}`, label, colour));
}

function chartList() {
  const list = [
    { id: "contact_force", title: "Contact force", unit: "N", least: 20, reach: true, fromZero: true, series: [
      ...one("contact_force", report.columns.external_force_x ? "true" : "measured", "--true", true),
      ...derived(magnitudeOf("estimated_force"), "estimated, on the platform", "--estimate")] },
    { id: "force", title: "External force on the platform", unit: "N", least: 24, series: [
      ...one("external_force_x", "x true", "--leg-2", true), ...one("estimated_force_x", "x estimated", "--leg-2"),
      ...one("external_force_y", "y true", "--leg-1", true), ...one("estimated_force_y", "y estimated", "--leg-1"),
      ...one("external_force_z", "z true", "--leg-3", true), ...one("estimated_force_z", "z estimated", "--leg-3")] },
    { id: "moment", title: "External moment on the platform", unit: "Nm", least: 2.4, series: [
      ...one("external_moment", "true", "--true", true), ...one("estimated_moment", "estimated", "--estimate"),
      ...["x", "y", "z"].flatMap((axis, i) => [
        ...one(`external_moment_${axis}`, `${axis} true`, `--leg-${[2, 1, 3][i]}`, true),
        ...one(`estimated_moment_${axis}`, `${axis} estimated`, `--leg-${[2, 1, 3][i]}`)])] },
    { id: "force_by_estimator", title: "External force, by estimator", unit: "N", least: 24, fromZero: true,
      series: byEstimator("force", magnitudeOf("external_force")) },
    { id: "moment_by_estimator", title: "External moment, by estimator", unit: "Nm", least: 2.4, fromZero: true,
      series: byEstimator("moment", magnitudeOf("external_moment") ?? report.columns.external_moment?.map((m) => m && Math.abs(m))) },
    { id: "probability", title: "What is touched", unit: "%", scale: 100, least: 100, fromZero: true, series: probabilities() },
    { id: "location_error", title: "Error of the place", unit: "mm", scale: 1000, least: 10, fromZero: true,
      series: one("location_error", "error", "--plain") },
    { id: "force_error", title: "Error of the force", unit: "N", least: 10, fromZero: true,
      series: one("force_error", "error", "--plain") },
    { id: "speed", title: "Speed of the platform", unit: "m/s", least: 0.05, fromZero: true, series: [
      ...one("speed", "speed", "--plain")] },
    { id: "position_error", title: "Tracking error, position", unit: "mm", scale: 1000, least: 0.1, fromZero: true,
      series: one("position_error", "error", "--plain") },
    { id: "orientation_error", title: "Tracking error, orientation", unit: "°", scale: degrees, least: 0.01, fromZero: true,
      series: one("orientation_error", "error", "--plain") },
    { id: "torque", title: `Drive ${report.drive_unit === "N" ? "forces" : "torques"}`, unit: report.drive_unit, least: 2, series: torques() },
    { id: "sigma_kappa", title: "Condition number", symbol: ["σ", "κ"], unit: "", least: 0.5, series: [
      ...one("sigma_kappa", "σκ", "--plain"), ...one("sigma_kappa_reference", "led to", "--estimate")] },
    { id: "sigma_sc", title: "Self-collision distance", symbol: ["σ", "sc"], unit: "mm", scale: 1000, least: 2,
      series: [...one("sigma_sc", "σsc", "--plain"), ...one("sigma_sc_reference", "led to", "--estimate")] },
    { id: "energy", title: "Lyapunov functions of the tasks", symbol: ["V", "i"], unit: "mJ", scale: 1000, least: 1, fromZero: true,
      series: energies("energy") },
    { id: "energy_rate", title: "How fast they change", unit: "W", least: 0.1, series: energies("energy_rate") },
  ];
  for (const chart of list) {
    chart.scale ??= 1;
    chart.bounds = report.bounds.filter((bound) => bound.chart === chart.id)
      .map((bound) => ({ name: bound.name, value: bound.value * chart.scale }));
    for (const series of chart.series) {
      if (chart.scale !== 1) series.values = series.values.map((value) => (value === null ? null : value * chart.scale));
    }
    chart.decimals = decimalsFor(chart.series.flatMap((series) => series.values));
  }
  return list.filter((chart) => chart.series.some((series) => series.values.some((value) => value !== null)));
}
