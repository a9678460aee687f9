// Which plots a run has, by the columns of its tables.
import {chart} from "chart";
import {floats, report, table} from "data";
import {make} from "page";
import {words} from "units";

const axes = ["x", "y", "z"];
const place = (name) => document.querySelector(`[data-charts="${name}"]`);

function largest(values) {
  let found = 0;
  for (const value of values ?? []) if (isFinite(value)) found = Math.max(found, Math.abs(value));
  return found;
}

function some(values) {
  return largest(values) > 0;
}

/// One chart of columns that are there and more than round-off beside the others.
function overTime(where, history, title, unit, columns, more = {}) {
  const roundOff = 1e-9 * Math.max(...columns.map(([, column]) => largest(history.get(column))));
  const series = columns.map(([name, column], colour) => ({name, colour, x: history.get("time"), y: history.get(column)}))
    .filter(({y}) => largest(y) > roundOff);
  if (series.length > 0)
    chart(where, {title, unit, series, xLabel: "time", xUnit: "s", stages: report.stages, timed: true, ...more});
}

const vector = (start) => axes.map((axis) => [axis, `${start}_${axis}`]);

/// Names between a prefix and a column: "pair.", ".normal" -> the pairs.
function namesOf(history, prefix, ending) {
  return [...history.keys()].filter((name) => name.startsWith(prefix) && name.endsWith(ending))
    .map((name) => name.slice(prefix.length, -ending.length));
}

/// All groups one below another, or one of many by choice.
function groups(where, names, draw) {
  const few = 3;
  const body = make("div");
  where.append(body);
  const show = (list) => {
    body.replaceChildren();
    for (const name of list) {
      const grid = make("div", {class: "grid"});
      if (names.length > 1) body.append(make("h3", {}, name));
      body.append(grid);
      draw(grid, name);
    }
  };
  if (names.length > few) {
    const choice = make("select", {"aria-label": "Which one"}, ...names.map((name) => make("option", {value: name}, name)));
    choice.addEventListener("change", () => show([choice.value]));
    where.prepend(make("p", {class: "tools"}, choice));
    show([names[0]]);
  } else {
    show(names);
  }
}

function contact(history) {
  groups(place("contact"), namesOf(history, "pair.", ".normal"), (grid, pair) => {
    const at = (column) => `pair.${pair}.${column}`;
    overTime(grid, history, "Contact forces, sums over the slave nodes", "N", [["normal", at("normal")], ["friction", at("friction")]]);
    overTime(grid, history, "Force on the slave", "N", vector(at("force")));
    overTime(grid, history, "Slave nodes in contact", "", [["stick", at("stick")], ["slip", at("slip")]]);
    overTime(grid, history, "Contact area", "m^2", [["area", at("area")]]);
    overTime(grid, history, "Worst penetration", "m", [["penetration", at("penetration")]]);
  });
}

function reactions(history) {
  const grid = make("div", {class: "grid"});
  place("reactions").append(grid);
  for (const set of namesOf(history, "set.", ".reaction_x"))
    overTime(grid, history, `Reaction of ${set}`, "N", vector(`set.${set}.reaction`));
}

function energies(history) {
  const grid = make("div", {class: "grid"});
  place("energies").append(grid);
  const names = ["kinetic", "strain", "external", "friction", "damping", "algorithmic", "contact"];
  overTime(grid, history, "Energies", "J", names.map((name) => [name, `energy.${name}`]));
  overTime(grid, history, "Balance: what they do not add up to", "J", [["balance", "energy.balance"]]);
  overTime(grid, history, "Linear momentum", "N s", vector("momentum.linear"));
  overTime(grid, history, "Angular momentum", "N m s", vector("momentum.angular"));
}

function steps() {
  const grid = make("div", {class: "grid"});
  place("steps").append(grid);
  const {accepted, rejected} = report.attempts;
  const column = (rows, c) => Float64Array.from(rows, (row) => row[c]);
  // a step is drawn over the time it took, the first one too
  const first = accepted.length > 0 ? [[accepted[0][0] - accepted[0][1], ...accepted[0].slice(1)]] : [];
  const rows = first.concat(accepted), time = column(rows, 0), dt = column(rows, 1);
  const marks = rejected.map((row) => ({
    x: row[0], y: row[1], kind: `cut: ${words(row[4])}`,
    text: `attempt ${row[3]} to ${row[0]} s, ${row[4]}${row[5] ? `, ${row[5]}${row[6] >= 0 ? " node " + row[6] : ""}` : ""}`,
  }));
  const all = [...dt, ...marks.map((mark) => mark.y)];
  const common = {xLabel: "time", xUnit: "s", stages: report.stages, timed: true, fromZero: true};
  chart(grid, {title: "Steps: dt, and attempts that were cut", unit: "s", series: [{name: "dt", x: time, y: dt, steps: true}],
               marks, log: d3.max(all) > 15 * d3.min(all), ...common});
  chart(grid, {title: "Newton iterations of a step", unit: "", series: [{name: "iterations", x: time, y: column(rows, 2), steps: true}],
               ...common});
}

/// Residuals one after another, a line for every attempt.
function residuals(iterations) {
  const grid = make("div", {class: "grid"});
  place("residuals").append(grid);
  const attempt = iterations.get("attempt"), residual = iterations.get("residual");
  const x = [], y = [];
  attempt.forEach((number, i) => {
    if (i > 0 && number !== attempt[i - 1]) {
      x.push(i - 0.5);
      y.push(NaN);
    }
    x.push(i);
    y.push(residual[i]);
  });
  chart(grid, {title: "Residual over the reference force, attempt after attempt", unit: "", log: true, xLabel: "iteration",
               series: [{name: "residual", x, y}]});
  chart(grid, {title: "Status changes in an iteration", unit: "", xLabel: "iteration",
               series: ["status_changes", "facet_changes"].filter((name) => some(iterations.get(name)))
                 .map((name) => ({name: words(name), x: d3.range(attempt.length), y: iterations.get(name)}))});
}

/// What the scene asks for: curves of its tables and probes.
async function ofTheScene() {
  const grid = make("div", {class: "grid"});
  place("plots").append(grid);
  for (const plot of report.plots) {
    const series = await Promise.all(plot.curves.map(async ({name, points, array}) => {
      const values = await floats(array);
      return {name, x: values.subarray(0, points), y: values.subarray(points)};
    }));
    chart(grid, {title: plot.y_label ? `${plot.title} (${plot.y_label})` : plot.title, unit: "", series, xLabel: plot.x_label,
                 timed: /^time\b/.test(plot.x_label), stages: report.stages});
  }
}

export async function makeCharts() {
  const history = await table("history"), iterations = await table("iterations");
  if (place("plots")) await ofTheScene();
  if (place("contact")) contact(history);
  if (place("reactions")) reactions(history);
  if (place("energies")) energies(history);
  if (place("steps")) steps();
  if (place("residuals")) residuals(iterations);
}
