// The deforming bodies in three dimensions, with fields, contact forces and time.
import {Arrows} from "arrows";
import {clock} from "clock";
import {report} from "data";
import {cssColour, make, onThemeChange, save} from "page";
import {Part, rangeOf} from "surfaces";
import {digits, limits, measure, pretty, scaleFor, words} from "units";

const kinds = {body: "Bodies", slave: "Slave surfaces", master: "Master surfaces"};
const tensor = ["xx", "yy", "zz", "xy", "yz", "zx"], vector = ["x", "y", "z"];
const statuses = ["open", "stick", "slip"];
const bandCounts = [6, 8, 10, 12, 16];
const scales = [0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000];

/// What can be shown as colours: {kind, field, which, label, unit}.
function quantitiesOf(parts) {
  const found = new Map();
  for (const part of parts)
    for (const field of part.fields.values()) {
      if (part.kind !== "body" && field.name === "displacement") continue;
      const which = field.components === 1 ? [0] : field.components === 3 ? ["magnitude", 0, 1, 2] : [0, 1, 2, 3, 4, 5];
      for (const one of which) {
        const suffix = field.components === 1 ? "" : one === "magnitude" ? ", magnitude" : " " + (field.components === 3 ? vector : tensor)[one];
        const key = `${part.kind}/${field.name}/${one}`;
        found.set(key, {key, kind: part.kind, field: field.name, which: one, unit: field.unit, integer: field.integer,
                        label: words(field.name) + suffix});
      }
    }
  return found;
}

/// Red, green and blue of a share of the range.
function colourOf(share) {
  const colours = report.view.colours;
  const at = share * (colours.length - 1), k = Math.min(Math.floor(at), colours.length - 2), t = at - k;
  return [0, 1, 2].map((c) => Math.round((1 - t) * colours[k][c] + t * colours[k + 1][c]));
}

function colourMap() {
  const pixels = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) pixels.set([...colourOf(i / 255), 255], 4 * i);
  const map = new THREE.DataTexture(pixels, 256, 1, THREE.RGBAFormat);
  map.magFilter = map.minFilter = THREE.LinearFilter;
  map.needsUpdate = true;
  return map;
}

/// Box of the bodies over first, middle and last frame.
function boxOf(parts, frames) {
  const box = new THREE.Box3();
  for (const part of parts)
    for (const frame of [0, frames >> 1, frames - 1]) for (let p = 0; p < part.size; ++p) box.expandByPoint(part.position(frame, p));
  return box;
}

class Viewer {
  constructor(place, parts) {
    this.place = place;
    this.parts = parts;
    this.frames = report.view.times.length;
    this.quantities = quantitiesOf(parts);
    this.ranges = new Map();
    this.box = boxOf(parts, this.frames);
    this.extent = this.box.getSize(new THREE.Vector3()).length();
  }

  makeStage(shared) {
    this.shared = shared;
    this.renderer = new THREE.WebGLRenderer({antialias: true, alpha: true});
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setClearColor(0, 0);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(28, 1, this.extent / 100, this.extent * 20);
    this.camera.up.set(0, 0, 1);
    const canvas = this.renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("aria-label", "The bodies in three dimensions");
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableZoom = false; // a page that scrolls past must not stop here
    canvas.addEventListener("pointerdown", () => (this.controls.enableZoom = true));
    canvas.addEventListener("pointerleave", () => (this.controls.enableZoom = false));
    this.controls.addEventListener("change", () => this.draw());
    for (const part of this.parts) this.scene.add(part.mesh, part.lines);
    const slaves = this.parts.filter((part) => part.kind === "slave" && part.fields.has("contact_force"));
    if (slaves.length > 0) {
      this.arrows = new Arrows(slaves, this.frames, this.extent, cssColour("--force"));
      this.scene.add(this.arrows.group);
    }
    this.look(report.view.eye);
  }

  /// Looks from a direction so that everything is seen.
  look(direction) {
    const middle = this.box.getCenter(new THREE.Vector3());
    const eye = new THREE.Vector3(...direction).normalize();
    if (Math.abs(eye.z) > 0.999) eye.set(0, -0.001, eye.z).normalize();
    // the corners of the box decide how far away
    const right = new THREE.Vector3().crossVectors(this.camera.up, eye).normalize(), up = new THREE.Vector3().crossVectors(eye, right);
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360);
    let distance = 0;
    for (let k = 0; k < 8; ++k) {
      const corner = new THREE.Vector3(k & 1 ? this.box.max.x : this.box.min.x, k & 2 ? this.box.max.y : this.box.min.y,
                                       k & 4 ? this.box.max.z : this.box.min.z).sub(middle);
      const needed = Math.max(Math.abs(corner.dot(up)), Math.abs(corner.dot(right)) / this.camera.aspect) / tangent;
      distance = Math.max(distance, needed + corner.dot(eye));
    }
    this.camera.position.copy(middle).addScaledVector(eye, 1.05 * distance);
    this.controls.target.copy(middle);
    this.controls.update();
    this.draw();
  }

  makePanel() {
    const check = (name, checked, change) => {
      const box = make("input", {type: "checkbox", name});
      box.checked = checked;
      box.addEventListener("change", () => change(box.checked));
      return box;
    };
    const label = (text, ...controls) => make("label", {}, make("span", {}, text), ...controls);
    const groups = Object.entries(kinds).map(([kind, title]) => {
      const options = [...this.quantities.values()].filter((one) => one.kind === kind)
        .map((one) => make("option", {value: one.key}, one.label));
      return options.length > 0 ? make("optgroup", {label: title}, ...options) : "";
    });
    this.field = make("select", {name: "field"}, make("option", {value: ""}, "none"), ...groups);
    this.field.addEventListener("change", () => this.choose());
    this.span = make("select", {name: "range"}, make("option", {value: "all"}, "over all times"), make("option", {value: "now"}, "at this time"));
    this.span.addEventListener("change", () => this.update());
    this.bands = make("select", {name: "bands"}, make("option", {value: "0"}, "smooth"),
                      ...bandCounts.map((count) => make("option", {value: String(count)}, `contours, ${count} bands`)));
    this.bands.addEventListener("change", () => this.update());
    this.scale = make("input", {type: "range", name: "scale", min: "0", max: String(scales.length - 1), step: "1"});
    this.scale.value = 1;
    this.scaleText = make("output");
    this.scale.addEventListener("input", () => this.update());

    const shown = this.parts.filter((part) => part.kind === "body").map((part) => {
      part.shown = true;
      return make("label", {class: "check"}, check(`body ${part.name}`, true, (on) => {
        part.shown = on;
        this.update();
      }), part.name);
    });
    this.edges = check("edges", this.parts.every((part) => part.facetCount < 20000), () => this.update());
    this.through = check("through", false, () => this.update());
    this.forces = check("forces", false, () => this.update());
    const views = [["Oblique", report.view.eye], ["x", [1, 0, 0]], ["y", [0, -1, 0]], ["z", [0, 0, 1]]].map(([name, eye]) => {
      const button = make("button", {type: "button", title: `Look ${name === "Oblique" ? "obliquely" : "along " + name}`}, name);
      button.addEventListener("click", () => this.look(eye));
      return button;
    });
    const picture = make("button", {type: "button"}, "Save picture");
    picture.addEventListener("click", () => {
      this.renderer.render(this.scene, this.camera);
      this.renderer.domElement.toBlob((blob) => save(`${report.name}.png`, blob));
    });
    return make("div", {class: "panel"},
      label("Colour by", this.field), label("Colours", this.bands), label("Range", this.span),
      label("Deformation beside the motion", this.scale, this.scaleText),
      make("div", {class: "checks"}, ...shown),
      make("div", {class: "checks"}, make("label", {class: "check"}, this.edges, "Edges"),
           make("label", {class: "check"}, this.through, "See through"),
           this.arrows ? make("label", {class: "check"}, this.forces, "Contact forces") : ""),
      make("div", {class: "tools"}, ...views, picture));
  }

  makeTime() {
    this.slider = make("input", {type: "range", name: "time", min: "0", max: String(this.frames - 1), step: "1", "aria-label": "Time"});
    this.moment = make("output", {class: "moment"});
    this.slider.addEventListener("input", () => clock.show(+this.slider.value));
    this.play = make("button", {type: "button", class: "play", "aria-label": "Play"}, "▶");
    this.play.addEventListener("click", () => this.toggle());
    if (this.frames < 2) this.slider.disabled = this.play.disabled = true;
    return make("div", {class: "time"}, this.play, this.slider, this.moment);
  }

  toggle() {
    if (this.playing) {
      clearInterval(this.playing);
      this.playing = undefined;
    } else {
      const seconds = 8, rate = Math.max(1, this.frames / seconds / 30), wait = Math.max(33, Math.min(250, (1000 * seconds) / this.frames));
      if (clock.frame === this.frames - 1) clock.show(0);
      let at = clock.frame;
      this.playing = setInterval(() => {
        at += rate;
        if (at > this.frames - 1) this.toggle();
        clock.show(Math.round(at));
      }, wait);
    }
    this.play.textContent = this.playing ? "❚❚" : "▶";
  }

  /// Contact surfaces lie between bodies: those become glass when a surface's field is chosen.
  choose() {
    const quantity = this.quantities.get(this.field.value);
    this.through.checked = quantity !== undefined && quantity.kind !== "body";
    this.update();
  }

  rangeFor(quantity) {
    if (!quantity) return [0, 1];
    if (quantity.field === "status") return [0, 2];
    const now = this.span.value === "now", key = quantity.key + (now ? clock.frame : "");
    if (!this.ranges.has(key))
      this.ranges.set(key, rangeOf(this.parts, quantity, now ? [clock.frame] : Array.from({length: this.frames}, (_, f) => f)) ?? [0, 1]);
    return this.ranges.get(key);
  }

  update() {
    const quantity = this.quantities.get(this.field.value);
    const range = this.rangeFor(quantity), frame = clock.frame;
    const scale = scales[+this.scale.value];
    const bands = range[1] > range[0] ? +this.bands.value : 0;
    this.shared.bands.value = quantity?.field === "status" ? -1 : bands;
    this.scaleText.textContent = "× " + scale;
    for (const part of this.parts) {
      part.show(frame, scale, quantity, range);
      part.mesh.visible = part.kind === "body" ? part.shown : quantity !== undefined && part.kind === quantity.kind;
      part.lines.visible = part.mesh.visible && this.edges.checked;
      part.opacity = part.kind === "body" && this.through.checked ? 0.16 : 1;
    }
    if (this.arrows) {
      this.arrows.group.visible = this.forces.checked;
      if (this.forces.checked) this.arrows.show(frame);
    }
    this.slider.value = frame;
    this.moment.textContent = `${measure(clock.time, "s")}  (${frame + 1} of ${this.frames})`;
    this.showLegend(quantity, range, bands);
    this.draw();
  }

  /// Bands stand one above another, the highest on top, with the limits between them.
  showLegend(quantity, [low, high], bands) {
    this.legend.replaceChildren();
    if (quantity?.field === "status") {
      this.legend.append(make("b", {}, quantity.label), ...statuses.map((name, i) =>
        make("span", {class: "swatch"}, make("i", {class: "map", style: `background-position:${50 * i}% 0`}), name)));
    } else if (quantity) {
      const {factor, unit} = scaleFor(Math.max(Math.abs(low), Math.abs(high)), quantity.unit);
      this.legend.append(make("b", {}, `${quantity.label}${unit ? ", " + pretty(unit) : ""}`));
      if (bands > 0) {
        const colours = Array.from({length: bands}, (_, k) => make("i", {style: `background:rgb(${colourOf((k + 0.5) / bands)})`}));
        const texts = limits(low * factor, high * factor, bands).map((text) => make("span", {}, text));
        this.legend.append(make("div", {class: "bands"}, make("div", {}, ...colours.reverse()), make("div", {}, ...texts.reverse())));
      } else {
        const ticks = [0, 0.25, 0.5, 0.75, 1].map((t) => make("span", {}, digits((low + t * (high - low)) * factor, 3)));
        this.legend.append(make("i", {class: "map"}), make("div", {class: "ticks"}, ...ticks));
      }
    }
    if (this.arrows && this.forces.checked)
      this.legend.append(make("span", {class: "arrow"}, `longest arrow ${measure(this.arrows.largest, "N", 3)}`));
  }

  draw() {
    if (this.waiting || !this.legend) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.renderer.render(this.scene, this.camera);
    });
  }

  retint() {
    this.shared.edge.value.set(cssColour("--edge"));
    this.shared.plain.value.set(cssColour("--part"));
    if (this.arrows) this.arrows.colour = cssColour("--force");
    this.draw();
  }

  make(settings) {
    const stage = make("div", {class: "stage"}, this.renderer.domElement);
    this.legend = make("div", {class: "legend3"});
    stage.append(this.legend);
    const panel = this.makePanel();
    this.place.replaceChildren(make("div", {class: "view"}, stage, panel), this.makeTime());
    const wanted = `body/${report.view.field}/${report.view.field === "displacement" ? "magnitude" : 0}`;
    if (this.quantities.has(wanted)) this.field.value = wanted;
    clock.times = report.view.times;
    clock.listen(() => this.update());
    this.controls.addEventListener("start", () => (this.moved = true)); // by hand
    new ResizeObserver(() => {
      const {clientWidth: width, clientHeight: height} = stage;
      if (width === 0 || height === 0) return;
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      if (!this.moved) this.look(report.view.eye);
      this.draw();
    }).observe(stage);
    this.forget = onThemeChange(() => this.retint());
    this.take(settings);
  }

  /// What was chosen, for a viewer of the same bodies at more times.
  settings() {
    const {position} = this.camera, {target} = this.controls;
    return {
      moved: this.moved ? {position: position.toArray(), target: target.toArray()} : undefined,
      time: clock.frame < this.frames - 1 ? clock.time : undefined, // the last one stays the last one
      chosen: [this.field, this.bands, this.span, this.scale].map((one) => one.value),
      checked: new Map([...this.place.querySelectorAll("input[type=checkbox]")].map((box) => [box.name, box.checked])),
    };
  }

  take(settings) {
    if (settings) {
      [this.field, this.bands, this.span, this.scale].forEach((one, i) => (one.value = settings.chosen[i]));
      for (const part of this.parts) part.shown = settings.checked.get(`body ${part.name}`) ?? part.shown;
      for (const box of this.place.querySelectorAll("input[type=checkbox]")) box.checked = settings.checked.get(box.name) ?? box.checked;
      if (settings.moved) {
        this.moved = true;
        this.camera.position.fromArray(settings.moved.position);
        this.controls.target.fromArray(settings.moved.target);
        this.controls.update();
      }
    }
    if (settings?.time === undefined) clock.show(this.frames - 1);
    else clock.seek(settings.time);
  }

  dispose() {
    if (this.playing) this.toggle();
    this.forget();
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss(); // browsers allow some sixteen of them
  }
}

function hasWebGl() {
  const canvas = document.createElement("canvas");
  return (canvas.getContext("webgl") ?? canvas.getContext("experimental-webgl")) !== null;
}

/// @param settings  of a viewer before this one
export async function makeViewer(place, settings) {
  if (!hasWebGl()) throw new Error("this browser has no WebGL; the pictures below show start, middle and end");
  const shared = {
    bands: {value: 0}, map: {value: colourMap()},
    plain: {value: new THREE.Color(cssColour("--part"))}, edge: {value: new THREE.Color(cssColour("--edge"))},
  };
  const parts = [];
  for (const described of report.view.parts) parts.push(await Part.read(described, report.view.times.length, shared));
  for (const part of parts) part.carrier = parts.find((one) => one.kind === "body" && one.name === part.body) ?? part;
  const viewer = new Viewer(place, parts);
  viewer.makeStage(shared);
  viewer.make(settings);
  return viewer;
}
