// Contact forces as arrows from the slave nodes, seen through the bodies.

const share = 0.13; // of the view's size: the longest arrow

export class Arrows {
  /// @param parts   slave surfaces with contact_force
  /// @param extent  of the bodies, m
  constructor(parts, frames, extent, colour) {
    this.parts = parts;
    this.length = share * extent;
    this.largest = 0;
    for (const part of parts) {
      const force = part.fields.get("contact_force");
      for (let f = 0; f < frames; ++f)
        for (let p = 0; p < part.size; ++p) this.largest = Math.max(this.largest, force.number(f, "magnitude", p) || 0);
    }
    const count = parts.reduce((sum, part) => sum + part.size, 0);
    const geometry = new THREE.BufferGeometry();
    this.ends = new THREE.BufferAttribute(new Float32Array(6 * count), 3);
    geometry.setAttribute("position", this.ends);
    this.material = new THREE.LineBasicMaterial({color: colour, depthTest: false, transparent: true});
    this.shafts = new THREE.LineSegments(geometry, this.material);
    const long = this.length * Math.min(0.14, 1.1 / Math.sqrt(count)); // many are thin
    const tip = new THREE.ConeBufferGeometry(0.27 * long, long, 8);
    tip.translate(0, -long / 2, 0);
    this.tips = new THREE.InstancedMesh(tip, new THREE.MeshBasicMaterial({color: colour, depthTest: false, transparent: true}), count);
    this.group = new THREE.Group();
    this.group.add(this.shafts, this.tips);
    for (const object of [this.shafts, this.tips]) {
      object.frustumCulled = false;
      object.renderOrder = 3;
    }
  }

  set colour(value) {
    this.material.color.set(value);
    this.tips.material.color.set(value);
  }

  /// From where the points are shown.
  show(frame) {
    const up = new THREE.Vector3(0, 1, 0), matrix = new THREE.Matrix4(), none = new THREE.Matrix4().makeScale(0, 0, 0);
    let i = 0;
    for (const part of this.parts) {
      const force = part.fields.get("contact_force");
      for (let p = 0; p < part.size; ++p, ++i) {
        const from = new THREE.Vector3().fromArray(part.places.array, 3 * p);
        const f = new THREE.Vector3(force.at(frame, 0, p), force.at(frame, 1, p), force.at(frame, 2, p));
        const size = f.length() / (this.largest || 1);
        const to = size > 1e-3 ? from.clone().addScaledVector(f.normalize(), size * this.length) : from;
        from.toArray(this.ends.array, 6 * i);
        to.toArray(this.ends.array, 6 * i + 3);
        if (size > 1e-3) {
          const thin = Math.min(1, 0.3 + size);
          matrix.compose(to, new THREE.Quaternion().setFromUnitVectors(up, f), new THREE.Vector3(thin, thin, thin));
        }
        this.tips.setMatrixAt(i, size > 1e-3 ? matrix : none);
      }
    }
    this.ends.needsUpdate = true;
    this.tips.instanceMatrix.needsUpdate = true;
  }
}
