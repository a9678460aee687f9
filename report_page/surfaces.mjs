// The parts of the view as objects of three.js: facets in the colours of a field, their edges, deformed.
import {Field, floats, integers} from "data";

const vertexShader = `
  attribute float value;
  varying float share, known;
  varying vec3 seen;
  void main() {
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    share = value;
    known = value < 1.5 ? 1.0 : 0.0;
    seen = at.xyz;
    gl_Position = projectionMatrix * at;
  }`;
// The value comes to each pixel, not a colour: bands end where the value within the facet has their limit. Between them are lines as wide
// as a pixel, but none where they would lie closer than two pixels, or where the value does not change.
const fragmentShader = `
  uniform sampler2D map;
  uniform vec3 plain, ink;
  uniform float opacity, bands;
  varying float share, known;
  varying vec3 seen;
  float lineAt(float level) {
    float slope = fwidth(level), limit = floor(level + 0.5);
    if (slope < 1e-5 || limit < 0.5 || limit > bands - 0.5) return 0.0;
    return (1.0 - smoothstep(0.3, 0.9, abs(level - limit) / slope)) * (1.0 - smoothstep(0.25, 0.5, slope));
  }
  void main() {
    vec3 normal = normalize(cross(dFdx(seen), dFdy(seen)));
    float light = 0.6 + 0.4 * abs(dot(normal, normalize(seen)));
    vec3 colour = plain;
    float at = clamp(share, 0.0, 1.0), line = bands > 0.0 ? lineAt(share * bands) : 0.0;
    if (known > 0.999) { // every corner has a value
      vec3 on = at < 0.35 ? vec3(1.0) : ink; // light on dark
      if (bands < 0.0) at = floor(2.0 * at + 0.5) / 2.0; // open, stick, slip
      else if (bands > 0.0) at = (floor(min(at * bands, bands - 0.5)) + 0.5) / bands;
      colour = texture2D(map, vec2((255.0 * at + 0.5) / 256.0, 0.5)).rgb;
      colour = mix(colour, on, 0.7 * line);
    }
    gl_FragColor = vec4(colour * light, opacity);
  }`;
const edgeVertexShader = `
  attribute float value;
  varying float share;
  void main() {
    share = value;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const edgeFragmentShader = `
  uniform vec3 colour;
  uniform float opacity;
  varying float share;
  void main() { gl_FragColor = share < 0.35 ? vec4(1.0, 1.0, 1.0, 0.5 * opacity) : vec4(colour, opacity); } // light on dark`;

const noColour = 9; // beyond all shares

function trianglesOf(facets) {
  const triangles = [];
  for (let i = 0; i < facets.length; i += 4) {
    const [a, b, c, d] = facets.subarray(i, i + 4);
    triangles.push(a, b, c);
    if (d !== c) triangles.push(a, c, d);
  }
  return new Uint32Array(triangles);
}

function edgesOf(facets) {
  const seen = new Set(), edges = [];
  for (let i = 0; i < facets.length; i += 4)
    for (let c = 0; c < 4; ++c) {
      const a = facets[i + c], b = facets[i + (c + 1) % 4], key = a < b ? a * 2 ** 26 + b : b * 2 ** 26 + a;
      if (a === b || seen.has(key)) continue;
      seen.add(key);
      edges.push(a, b);
    }
  return new Uint32Array(edges);
}

export class Part {
  static async read(described, frames, shared) {
    const part = Object.assign(new Part(), {name: described.name, kind: described.kind, body: described.body, size: described.size});
    const [points, nodes, facets] =
      await Promise.all([floats(described.points), integers(described.nodes), integers(described.facets)]);
    part.points = points;
    part.nodes = nodes;
    part.fields = new Map();
    for (const field of described.fields) part.fields.set(field.name, await Field.read(field, frames, described.size));
    part.facetCount = facets.length / 4;

    const geometry = new THREE.BufferGeometry();
    part.places = new THREE.BufferAttribute(new Float32Array(points), 3);
    geometry.setAttribute("position", part.places);
    part.value = new THREE.BufferAttribute(new Float32Array(part.size).fill(noColour), 1);
    geometry.setAttribute("value", part.value);
    geometry.setIndex(new THREE.BufferAttribute(trianglesOf(facets), 1));
    const surface = part.kind !== "body";
    part.uniforms = {map: shared.map, plain: shared.plain, ink: shared.edge, bands: shared.bands, opacity: {value: 1}};
    part.mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
      uniforms: part.uniforms, vertexShader, fragmentShader, side: THREE.DoubleSide, extensions: {derivatives: true},
      polygonOffset: true, polygonOffsetFactor: surface ? -1 : 1, polygonOffsetUnits: surface ? -1 : 1,
    }));
    const outline = new THREE.BufferGeometry();
    for (const name of ["position", "value"]) outline.setAttribute(name, geometry.getAttribute(name));
    outline.setIndex(new THREE.BufferAttribute(edgesOf(facets), 1));
    part.lines = new THREE.LineSegments(outline, new THREE.ShaderMaterial({
      uniforms: {colour: shared.edge, opacity: {value: 0.35}},
      vertexShader: edgeVertexShader, fragmentShader: edgeFragmentShader, transparent: true, depthWrite: false,
    }));
    for (const object of [part.mesh, part.lines]) object.frustumCulled = false;
    return part;
  }

  /// Where a point is in a frame.
  position(frame, point) {
    const u = this.fields.get("displacement");
    return new THREE.Vector3(...[0, 1, 2].map((c) => this.points[3 * point + c] + (u ? u.at(frame, c, point) : 0)));
  }

  /// Mean displacement of all points.
  motion(frame) {
    const u = this.fields.get("displacement"), mean = [0, 0, 0];
    for (let p = 0; u && p < this.size; ++p) for (let c = 0; c < 3; ++c) mean[c] += u.at(frame, c, p) / this.size;
    return mean;
  }

  /// @param scale     of the displacement beside the mean one of the body: a body that slides or flies stays where it is
  /// @param quantity  {kind, field, which}, or undefined
  /// @param range     [low, high] in SI
  show(frame, scale, quantity, range) {
    const u = this.fields.get("displacement");
    if (u) {
      const whole = this.carrier.motion(frame);
      for (let p = 0; p < this.size; ++p)
        for (let c = 0; c < 3; ++c)
          this.places.array[3 * p + c] = this.points[3 * p + c] + whole[c] + scale * (u.at(frame, c, p) - whole[c]);
      this.places.needsUpdate = true;
    }
    const field = quantity && quantity.kind === this.kind ? this.fields.get(quantity.field) : undefined;
    const [low, high] = range;
    for (let p = 0; p < this.size; ++p) {
      const number = field ? field.number(frame, quantity.which, p) : NaN;
      this.value.array[p] = isNaN(number) ? noColour : Math.max(0, Math.min(1, (number - low) / (high - low || 1)));
    }
    this.value.needsUpdate = true;
  }

  set opacity(value) {
    this.uniforms.opacity.value = value;
    this.mesh.material.transparent = value < 1;
    this.mesh.material.depthWrite = value === 1;
    this.lines.material.uniforms.opacity.value = value < 1 ? 0.12 : 0.35;
    this.mesh.renderOrder = value < 1 ? 2 : this.kind === "body" ? 0 : 1;
  }
}

/// Least and largest number of a quantity. @param frames  those to look at
export function rangeOf(parts, quantity, frames) {
  let low = Infinity, high = -Infinity;
  for (const part of parts) {
    const field = part.kind === quantity.kind ? part.fields.get(quantity.field) : undefined;
    if (!field) continue;
    for (const frame of frames)
      for (let p = 0; p < part.size; ++p) {
        const number = field.number(frame, quantity.which, p);
        if (number < low) low = number;
        if (number > high) high = number;
      }
  }
  return low > high ? undefined : [low, high];
}
