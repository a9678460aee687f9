// What the page holds: one JSON, and arrays in base64, deflated.

const read = () => JSON.parse(document.getElementById("report-data").textContent);

export let report = read();

/// Takes the data of another page of the same run in place of this one's.
export function renew(page) {
  for (const old of document.querySelectorAll("script[id^=array-], #report-data")) old.remove();
  for (const one of page.querySelectorAll("script[id^=array-], #report-data")) document.body.append(document.adoptNode(one));
  report = read();
}

async function bytes(name) {
  const text = atob(document.getElementById(name).textContent);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

export async function floats(name) {
  return new Float32Array((await bytes(name)).buffer);
}

export async function integers(name) {
  return new Uint32Array((await bytes(name)).buffer);
}

/// A table of the report as columns by name; undefined where the run has none.
export async function table(name) {
  const found = report[name];
  if (!found) return undefined;
  const values = await floats(found.array);
  const columns = new Map();
  found.names.forEach((column, c) => columns.set(column, values.subarray(c * found.rows, (c + 1) * found.rows)));
  return columns;
}

const noValue = 65535;

/// Values of a field over time; src/report/pack.hpp says how they lie in the bytes.
export class Field {
  static async read(described, frames, points) {
    const field = Object.assign(new Field(), described);
    const planes = await bytes(described.array);
    const size = points * described.components, all = frames * size;
    const levels = new Uint16Array(all);
    for (let i = 0; i < all; ++i) {
      const before = i >= size ? levels[i - size] : i > 0 ? levels[i - 1] : 0;
      levels[i] = before + planes[i] + 256 * planes[all + i];
    }
    field.points = points;
    field.levels = levels;
    return field;
  }

  /// NaN where there is no value.
  at(frame, component, point) {
    const level = this.levels[(frame * this.components + component) * this.points + point];
    return level === noValue ? NaN : this.low[component] + level * this.step[component];
  }

  /// @param which  a component, or "magnitude"
  number(frame, which, point) {
    if (which !== "magnitude") return this.at(frame, which, point);
    let sum = 0;
    for (let c = 0; c < this.components; ++c) sum += this.at(frame, c, point) ** 2;
    return Math.sqrt(sum);
  }
}
