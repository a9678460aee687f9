// Probes along lines and arcs: a field over the path at the time of the view, and before it.
import {chart} from "chart";
import {clock} from "clock";
import {Field, floats, report} from "data";
import {make} from "page";
import {digits, measure, words} from "units";

const most = 8; // pale lines
const first = ["normal_stress", "von_mises"]; // shown unless something else is chosen
const chosen = new Map(); // fields by probe; a page that is renewed keeps them

/// A slider of its own: that of the view, if there is one, is far away on the page.
function makeTime() {
  const last = String(clock.times.length - 1);
  const slider = make("input", {type: "range", name: "path-time", min: "0", max: last, step: "1", "aria-label": "Time"});
  const moment = make("output", {class: "moment"});
  slider.disabled = clock.times.length < 2;
  slider.addEventListener("input", () => clock.show(+slider.value));
  const show = () => {
    slider.value = clock.frame;
    moment.textContent = measure(clock.time, "s");
  };
  clock.listen(show);
  show();
  return make("div", {class: "time"}, slider, moment);
}

/// Index of the time nearest to that of the view.
function nearestTo(times) {
  let found = 0;
  times.forEach((t, f) => {
    if (Math.abs(t - clock.time) < Math.abs(times[found] - clock.time)) found = f;
  });
  return found;
}

/// The field that is shown first: not one that is round-off beside others of its unit.
function startOf(path) {
  const largest = ({low, step}) => Math.max(Math.abs(low[0]), Math.abs(low[0] + 65534 * step[0]));
  const size = (field) => Math.max(...path.fields.filter(({unit}) => unit === field.unit).map(largest));
  const names = path.fields.map(({name}) => name);
  return [chosen.get(path.name), ...first].find((name) => names.includes(name)) ??
    path.fields.find((field) => largest(field) > 1e-9 * size(field))?.name ?? names[0];
}

/// Times whose lines stay, pale, once they have passed: start and others, evenly.
function toKeep(times) {
  return [...new Set(d3.range(most).map((k) => Math.round((k * (times.length - 1)) / most)))];
}

async function makePath(grid, path) {
  const at = Array.from(await floats(path.at), (a) => (path.angle ? (a * 180) / Math.PI : a));
  const turned = at[0] > at[at.length - 1]; // charts want ascending places
  const x = turned ? [...at].reverse() : at;
  const fields = new Map();
  const fieldOf = async (name) => {
    if (!fields.has(name))
      fields.set(name, await Field.read(path.fields.find((one) => one.name === name), path.times.length, path.size));
    return fields.get(name);
  };
  const names = path.fields.map((one) => one.name), kept = toKeep(path.times);
  const choice = make("select", {class: "field", name: "path-field", "aria-label": `Field along ${path.name}`},
                      ...names.map((name) => make("option", {value: name}, words(name))));
  choice.value = startOf(path);

  let field = await fieldOf(choice.value), frame;
  const curve = (f) => {
    const y = x.map((_, p) => field.at(f, 0, p));
    return {x, y: turned ? y.reverse() : y};
  };
  const shown = () => {
    frame = nearestTo(path.times);
    const before = kept.filter((f) => f < frame);
    return {
      unit: field.unit,
      range: [field.low[0], field.low[0] + 65534 * field.step[0]], // over all times: the axis stands still
      series: [{name: `at ${measure(path.times[frame], "s")}`, ...curve(frame)}],
      behind: before.map((f) => ({...curve(f), text: measure(path.times[f], "s")})),
      aside: before.length > 0 ? `pale: ${before.map((f) => digits(path.times[f], 3)).join(", ")} s` : "",
    };
  };
  const along = path.angle ? {xLabel: "angle", xUnit: "°"} : {xLabel: "along the path", xUnit: "m"};
  const draw = chart(grid, {title: path.name, choice: names.length > 1 ? choice : make("span", {class: "field"}, words(names[0])),
                             ...along, ...shown()});
  choice.addEventListener("change", async () => {
    chosen.set(path.name, choice.value);
    field = await fieldOf(choice.value);
    draw(shown());
  });
  // out of the window, it waits until the time stands still: a film in the view must not stutter
  let near = true, later;
  const follow = () => {
    clearTimeout(later);
    if (nearestTo(path.times) === frame) return;
    if (near) draw(shown());
    else later = setTimeout(() => draw(shown()), 300);
  };
  clock.listen(follow);
  new IntersectionObserver((entries) => {
    near = entries.at(-1).isIntersecting;
    if (near) follow();
  }).observe(grid.lastElementChild);
}

/// @param viewed  whether there is a view, whose times are those of the clock
export async function makePaths(place, viewed) {
  if (!viewed) {
    const before = clock.time, last = clock.frame >= clock.times.length - 1;
    clock.times = report.paths.map((path) => path.times).reduce((a, b) => (b.length > a.length ? b : a));
    if (last) clock.show(clock.times.length - 1);
    else clock.seek(before);
  }
  const grid = make("div", {class: "grid"});
  place.append(make("p", {class: "fine"}, `The slider sets the time${viewed ? ", here and in the view" : ""}. Pale lines are of earlier times.`),
               makeTime(), grid);
  for (const path of report.paths) await makePath(grid, path);
}
