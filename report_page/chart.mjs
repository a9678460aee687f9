// One plot: lines, marks, over time a cursor that follows the view. SVG by D3.
import {clock} from "clock";
import {make} from "page";
import {digits, measure, pretty, scaleFor} from "units";

const margin = {left: 54, right: 20, top: 22, bottom: 34}, height = 240;

/// Numbers a line may go through: per pixel the first, the least and the largest one.
function thinned(x, y, toX) {
  if (x.length < 3000) return d3.range(x.length);
  const chosen = [];
  let pixel, least, largest;
  for (let i = 0; i < x.length; ++i) {
    const here = Math.round(toX(x[i]) * 2);
    if (here !== pixel) {
      if (pixel !== undefined) chosen.push(Math.min(least, largest), Math.max(least, largest));
      chosen.push(i);
      pixel = here;
      least = largest = i;
    }
    if (y[i] < y[least]) least = i;
    if (y[i] > y[largest]) largest = i;
  }
  chosen.push(x.length - 1);
  return chosen.filter((one, k) => k === 0 || one >= chosen[k - 1]);
}

function extent(series, log) {
  let low = Infinity, high = -Infinity;
  for (const {y} of series)
    for (const value of y) {
      if (!isFinite(value) || (log && value <= 0)) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  if (low > high) return undefined;
  if (log) return [low / 1.5, high * 1.5];
  if (low > 0 && low < 0.7 * high) low = 0;
  if (high < 0 && high > 0.7 * low) high = 0;
  if (low === high && low !== 0) return [Math.min(0, 1.2 * low), Math.max(0, 1.2 * high)];
  const air = 0.05 * (high - low) || Math.abs(high) * 0.05 || 1;
  return [low === 0 ? 0 : low - air, high === 0 ? 0 : high + air];
}

/// Index of the value nearest to a place; x ascends.
function nearest(x, at) {
  let low = 0, high = x.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (x[middle] < at) low = middle;
    else high = middle;
  }
  return Math.abs(x[low] - at) <= Math.abs(x[high] - at) ? low : high;
}

/// @param plot  {title, unit, xLabel, xUnit, series: [{name, x, y, steps, colour}], marks: [{x, y, kind, text}], log, stages, timed};
///              choice: a control beside the title; range: of y, else that of what is shown; behind: [{x, y, text}], pale lines
///              without keys; aside: what the keys say of these
/// @returns  a function that draws it anew with changes of these; as many series as before
export function chart(place, plot) {
  const log = plot.log;
  const figure = make("figure", {class: "chart"}, make("figcaption", {}, plot.title, plot.choice ?? ""));
  const legend = make("div", {class: "keys"});
  const drawing = d3.select(figure).append("svg").attr("role", "img").attr("aria-label", plot.title);
  figure.append(legend, drawing.node());
  place.append(figure);

  const hidden = new Set(), colour = (s) => `l${(plot.series[s].colour ?? s) % 7}`;
  const kinds = [...new Set((plot.marks ?? []).map((mark) => mark.kind))];
  const keys = plot.series.map((series, s) => {
    const name = make("span", {}, series.name), value = make("b");
    const key = make("button", {type: "button", title: "Show or hide"}, make("i", {class: `line ${colour(s)}`}), name, value);
    key.addEventListener("click", () => {
      hidden.has(s) && hidden.delete(s) || hidden.add(s);
      key.classList.toggle("off", hidden.has(s));
      draw();
    });
    legend.append(key);
    return {name, value};
  });
  kinds.forEach((kind, k) => legend.append(make("span", {class: "key"}, make("i", {class: `mark m${k}`}), kind)));

  const aside = make("span", {}, plot.aside ?? "");
  legend.append(aside);

  let toX, toY, cursor;
  let hover;

  function showCursor() {
    const at = hover ?? (plot.timed ? clock.time : undefined);
    plot.series.forEach((series, s) => {
      const i = at === undefined ? -1 : nearest(series.x, at);
      keys[s].value.textContent = i >= 0 && series.x.length > 0 ? measure(series.y[i], plot.unit) : "";
    });
    if (!cursor) return;
    const shown = at !== undefined && at >= toX.domain()[0] && at <= toX.domain()[1];
    cursor.style("display", shown ? null : "none");
    if (shown) cursor.attr("transform", `translate(${toX(at)},0)`);
  }

  function draw() {
    const shown = plot.series.filter((_, s) => !hidden.has(s));
    const within = plot.range ? [{y: plot.range}] : [...shown, ...(plot.marks ? [{y: plot.marks.map((mark) => mark.y)}] : [])];
    const range = extent(within, log) ?? (log ? [0.1, 1] : [0, 1]);
    const width = Math.max(260, figure.clientWidth);
    const {factor, unit} = log ? {factor: 1, unit: plot.unit} : scaleFor(Math.max(Math.abs(range[0]), Math.abs(range[1])), plot.unit);
    drawing.selectAll("*").remove();
    drawing.attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height);
    const all = plot.series.concat(plot.marks ? [{x: plot.marks.map((mark) => mark.x)}] : []);
    const ends = [d3.min(all, (s) => d3.min(s.x)), d3.max(all, (s) => d3.max(s.x))];
    if (plot.fromZero && ends[0] > 0) ends[0] = 0;
    if (!(ends[1] > ends[0])) ends[1] = ends[0] + 1;
    toX = d3.scale.linear().domain(ends).range([margin.left, width - margin.right]);
    toY = (log ? d3.scale.log() : d3.scale.linear()).domain(range.map((v) => v * factor)).range([height - margin.bottom, margin.top]);
    const y = (value) => toY(value * factor);

    for (const [k, stage] of (plot.timed ? plot.stages ?? [] : []).entries()) {
      const start = k > 0 ? plot.stages[k - 1].end : Math.min(0, ends[0]);
      const a = toX(Math.max(ends[0], start)), b = toX(Math.min(ends[1], stage.end));
      if (!(b > a) || plot.stages.length < 2) continue;
      if (k % 2 === 1)
        drawing.append("rect").attr("class", "stage").attr({x: a, y: margin.top, width: b - a, height: height - margin.top - margin.bottom});
      if (b - a > 34) drawing.append("text").attr("class", "stage").attr({x: a + 3, y: margin.top - 5}).text(stage.name);
    }
    const along = scaleFor(Math.max(Math.abs(ends[0]), Math.abs(ends[1])), plot.xUnit ?? "");
    const xAxis = d3.svg.axis().scale(toX).orient("bottom").ticks(Math.max(3, width / 90)).tickSize(4).tickFormat((v) => digits(v * along.factor));
    const span = ends[1] - ends[0];
    if (plot.xUnit === "°" && span > 20) { // parts of a circle
      const step = [5, 10, 15, 30, 45, 90].find((one) => span / one <= width / 50) ?? 180;
      xAxis.tickValues(d3.range(step * Math.ceil(ends[0] / step - 0.01), ends[1] + 0.01 * step, step));
    }
    const yAxis = d3.svg.axis().scale(toY).orient("left").tickSize(-(width - margin.left - margin.right)).tickPadding(6);
    if (log) {
      const decades = Math.log10(range[1] / range[0]);
      const every = Math.ceil(decades / 6);
      let ticks = d3.range(Math.ceil(Math.log10(range[0])), Math.floor(Math.log10(range[1])) + 1, every).map((p) => 10 ** p);
      if (ticks.length < 2) ticks = toY.ticks().filter((v) => [1, 2, 5].includes(Math.round(v / 10 ** Math.floor(Math.log10(v) + 1e-9))));
      yAxis.tickValues(ticks).tickFormat((v) => measure(v, plot.unit, 2));
    } else {
      yAxis.ticks(5).tickFormat((v) => digits(v));
    }
    drawing.append("g").attr("class", "axis grid").attr("transform", `translate(${margin.left},0)`).call(yAxis);
    drawing.append("g").attr("class", "axis").attr("transform", `translate(0,${height - margin.bottom})`).call(xAxis);
    drawing.append("text").attr("class", "label").attr({x: width - margin.right, y: height - 4, "text-anchor": "end"})
      .text(plot.xLabel + (along.unit ? `, ${along.unit}` : ""));
    if (!log && unit) drawing.append("text").attr("class", "label").attr({x: margin.left - 6, y: margin.top - 8, "text-anchor": "end"}).text(pretty(unit));

    const goodIn = (series) => (i) => isFinite(series.y[i]) && (!log || series.y[i] > 0);
    const pathOf = (series, chosen) => d3.svg.line().x((i) => toX(series.x[i])).y((i) => y(series.y[i])).defined(goodIn(series))
      .interpolate(series.steps ? "step-before" : "linear")(chosen);
    for (const series of plot.behind ?? [])
      drawing.append("path").attr("class", "behind").attr("d", pathOf(series, thinned(series.x, series.y, toX)))
        .append("title").text(series.text);
    plot.series.forEach((series, s) => {
      if (hidden.has(s)) return;
      const good = goodIn(series), chosen = thinned(series.x, series.y, toX);
      drawing.append("path").attr("class", `line ${colour(s)}`).attr("d", pathOf(series, chosen));
      if (chosen.length <= 60 && !plot.behind)
        drawing.append("g").selectAll("circle").data(chosen.filter(good)).enter().append("circle")
          .attr("class", `dot ${colour(s)}`).attr({r: 2, cx: (i) => toX(series.x[i]), cy: (i) => y(series.y[i])});
    });
    for (const mark of plot.marks ?? []) {
      if (!isFinite(mark.y) || (log && mark.y <= 0)) continue;
      drawing.append("path").attr("class", `mark m${kinds.indexOf(mark.kind)}`).attr("d", "M-3.5,-3.5L3.5,3.5M-3.5,3.5L3.5,-3.5")
        .attr("transform", `translate(${toX(mark.x)},${y(mark.y)})`).append("title").text(mark.text);
    }
    cursor = drawing.append("line").attr("class", "cursor").attr({y1: margin.top, y2: height - margin.bottom});
    showCursor();
  }

  drawing.on("mousemove", () => {
    const at = toX.invert(d3.mouse(drawing.node())[0]);
    hover = at >= toX.domain()[0] && at <= toX.domain()[1] ? at : undefined;
    showCursor();
  });
  drawing.on("mouseleave", () => {
    hover = undefined;
    showCursor();
  });
  if (plot.timed) {
    clock.listen(showCursor);
    drawing.on("click", () => clock.times.length > 0 && hover !== undefined && clock.seek(hover));
  }
  let width = 0;
  new ResizeObserver(() => {
    if (figure.clientWidth !== width) {
      width = figure.clientWidth;
      draw();
    }
  }).observe(figure);
  draw();
  return (changes) => {
    Object.assign(plot, changes);
    plot.series.forEach((series, s) => (keys[s].name.textContent = series.name));
    aside.textContent = plot.aside ?? "";
    draw();
  };
}
