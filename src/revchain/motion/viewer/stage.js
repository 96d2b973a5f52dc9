// SPDX-License-Identifier: GPL-3.0-or-later
// A stage in an element of a page: figures, each above its own floor with its shadow, and a camera that can be turned.
import {
  Box3, DirectionalLight, HemisphereLight, InstancedMesh, LineSegments, Matrix4, MeshBasicMaterial, MeshStandardMaterial,
  PerspectiveCamera, PolarGridHelper, Scene, Spherical, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

const night = matchMedia("(prefers-color-scheme: dark)");
const AT_NIGHT = { "#1a1a1a": "#d5dbe1", "#595959": "#9aa5b0", "#b3b3b3": "#5a6672" };  // greys hidden on a dark page
const DOWN = new Matrix4().makeScale(1, 0, 1);  // to the plan
const TILT = 0.24, FIELD = 11, ROOM = 1.15;  // of the first view: radians, degrees, over the width of a figure
const ALONE = 1.05, AXIS = "#b3b3b3";  // room of a figure without neighbours; the grey of an axis that is a line, no mast
const KEYS = {
  ArrowLeft: [0.1, 0, 1], ArrowRight: [-0.1, 0, 1], ArrowUp: [0, 0.1, 1], ArrowDown: [0, -0.1, 1],
  "+": [0, 0, 0.9], "=": [0, 0, 0.9], "-": [0, 0, 1 / 0.9],
};

/** The space that figures need at this instant, about their own axes; `known` is the space for other instants. */
export function extentOf(figures, known = { radius: 0, low: Infinity, high: -Infinity }) {
  let { radius, low, high } = known;
  const box = new Box3();
  for (const { root } of figures) {
    root.updateMatrixWorld(true);
    root.traverse((part) => {
      if (!part.isMesh || part.isInstancedMesh) return;
      if (!part.geometry.boundingBox) part.geometry.computeBoundingBox();
      box.copy(part.geometry.boundingBox).applyMatrix4(part.matrixWorld);
      const wide = Math.max(Math.abs(box.min.x - root.position.x), Math.abs(box.max.x - root.position.x));
      radius = Math.max(radius, Math.hypot(wide, Math.max(-box.min.z, box.max.z)));
      low = Math.min(low, box.min.y);
      high = Math.max(high, box.max.y);
    });
  }
  return { radius, low, high };
}

export class Stage {
  /** Throws where the browser has no WebGL. */
  constructor(element) {
    this.element = element;
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("role", "img");
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(FIELD);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.shade = new MeshBasicMaterial();
    this.line = new MeshStandardMaterial({ name: AXIS, roughness: 0.6, depthWrite: false });  // behind all that turns
    this.floors = [[0xaebac6, 0xcbd4dd], [0x4a5764, 0x35414c]].map((colours) => {  // light and dark; clones share them
      const { geometry, material } = new PolarGridHelper(1, 12, 4, 72, ...colours);
      return new LineSegments(geometry, material);
    });
    Object.assign(this, { figures: [], sets: [], away: 0, stale: true, words: () => [0, 0] });
    const sun = new DirectionalLight(0xffffff, 2.6);
    sun.position.set(0.35, 1, 0.7);
    this.scene.add(new HemisphereLight(0xffffff, 0x9aa6b2, 2.5), sun);
    this.controls.addEventListener("change", () => { this.stale = true; });
    night.addEventListener("change", () => this.paint());
    element.prepend(this.canvas);
    new ResizeObserver(() => this.arrange(false)).observe(element);
  }

  /** Show these figures, {root, turning}, within this extent; meshes below `turning` move, and have shadows. */
  show(figures, extent) {
    for (const { root } of this.figures) root.removeFromParent();
    for (const { bodies, shadows } of this.sets) for (const each of [bodies, shadows]) each.dispose();
    const sets = new Map();  // parts of one figure, form and colour: the browser draws them at once
    for (const { root, turning } of figures) {
      this.scene.add(root);
      turning.traverse((part) => {
        if (!part.isMesh) return;
        const key = [root.id, part.geometry.id, part.material.id].join();
        if (!sets.has(key)) sets.set(key, { root, parts: [] });
        sets.get(key).parts.push(part);
      });
      turning.visible = false;
    }
    for (const set of sets.values()) {
      const { root, parts } = set, [{ geometry, material }] = parts;
      set.bodies = new InstancedMesh(geometry, material, parts.length);
      set.shadows = new InstancedMesh(geometry, this.shade, parts.length);
      set.bodies.frustumCulled = set.shadows.frustumCulled = false;
      root.add(set.bodies, set.shadows);
    }
    this.figures = figures;
    this.sets = [...sets.values()];
    this.low = extent.low;
    this.tall = extent.high - extent.low;
    this.gap = 0.04 * this.tall;
    this.span = Math.max(extent.radius, 0.12 * this.tall);
    for (const { shadows } of this.sets) {
      shadows.position.y = this.low - this.gap;
      shadows.renderOrder = -2;
    }
    for (const { root } of figures) this.stand(root.children.find((part) => part.isMesh && !part.isInstancedMesh));
    this.paint();
  }

  /** Lengthen an axis to the floor. One that is a line is thin, and all parts of the figure are drawn over it. */
  stand(axis) {
    const top = axis.position.y + axis.scale.y / 2, foot = this.low - this.gap;
    axis.position.y = (top + foot) / 2;
    axis.scale.y = top - foot;
    if (axis.material.name !== AXIS) return;
    axis.scale.x = axis.scale.z *= 0.7;
    axis.material = this.line;
    axis.renderOrder = -1;
  }

  /** Set the colours of a light or a dark page. */
  paint() {
    const dark = night.matches;
    this.shade.color.set(dark ? 0x0b0f14 : 0xbcc6d0);
    for (const figure of this.figures) {
      figure.root.traverse(({ material }) => {
        if (material?.name) material.color.set(dark && AT_NIGHT[material.name] || material.name);
      });
      figure.floor?.removeFromParent();
      figure.floor = this.floors[Number(dark)].clone();
      figure.floor.scale.setScalar(1.12 * this.span);
      figure.floor.position.y = this.low - this.gap - 1e-3 * this.tall;
      figure.floor.renderOrder = -2;
      figure.root.add(figure.floor);
    }
    this.stale = true;
  }

  /** Place figures in as many columns as show them largest. A view that was turned stays turned, unless `afresh`. */
  arrange(afresh) {
    const { figures, tall, gap, span, camera, controls } = this;
    const { clientWidth: wide, clientHeight: high } = this.element;
    if (!wide || !high || !figures.length) return;  // in a frame that is folded up
    const [least, words] = this.words();  // width and height of a caption, pixels
    const across = 2 * (figures.length > 1 ? ROOM : ALONE) * span, up = (tall + gap) * Math.cos(TILT) + 2.6 * span * Math.sin(TILT);
    let best = { scale: 0 };
    for (let columns = 1; columns <= figures.length; columns++) {
      const rows = Math.ceil(figures.length / columns);
      if (columns > 1 && wide / columns < least) break;
      const scale = 0.94 * Math.min(wide / (columns * across), Math.max(high / rows - words, 20) / up);
      if (scale > best.scale * 1.05) best = { scale, columns, rows };
    }
    const { scale, columns, rows } = best;
    const step = Math.min(Math.max(1.3 * across, least / scale), 0.98 * wide / columns / scale);
    const fall = Math.min(up + words / scale, high / rows / scale) / Math.cos(TILT);
    figures.forEach(({ root }, n) => {
      const row = Math.floor(n / columns), inside = Math.min(columns, figures.length - row * columns);
      root.position.set((n % columns - (inside - 1) / 2) * step, ((rows - 1) / 2 - row) * fall, 0);
    });
    const centre = new Vector3(0, this.low - gap + tall / 2 - words / scale / 2.2, 0);
    const far = high / scale / 2 / Math.tan(FIELD * Math.PI / 360);
    const size = [wide, high, Math.min(devicePixelRatio, 2)];
    if (size.join() !== this.size?.join()) {  // which empties the picture
      this.renderer.setPixelRatio(size[2]);
      this.renderer.setSize(wide, high);
      this.size = size;
    }
    Object.assign(camera, { aspect: wide / high, near: far / 100, far: far * 12 });
    camera.updateProjectionMatrix();
    controls.minDistance = far / 20;
    controls.maxDistance = far * 6;
    const from = afresh || !this.away ? new Vector3(0, Math.sin(TILT), Math.cos(TILT)).multiplyScalar(far + 0.3 * span)
      : camera.position.clone().sub(controls.target).multiplyScalar(far / this.away);
    this.away = far;
    camera.position.copy(centre).add(from);
    controls.target.copy(centre);
    controls.update();
    this.stale = true;
  }

  /** Turn or zoom by a key; returns whether it is one of this view. */
  key(name) {
    if (name === "Home") this.arrange(true);
    if (!KEYS[name]) return name === "Home";
    const [about, tilt, nearer] = KEYS[name], { camera, controls } = this;
    const from = new Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    from.set(from.radius * nearer, Math.min(Math.max(from.phi + tilt, 0.01), Math.PI - 0.01), from.theta + about);
    camera.position.setFromSpherical(from).add(controls.target);
    controls.update();
    return true;
  }

  /** Draw the figures as they are posed now. */
  draw() {
    this.stale = false;
    const inverse = new Matrix4(), at = new Matrix4();
    for (const { root } of this.figures) root.updateMatrixWorld(true);
    for (const { root, parts, bodies, shadows } of this.sets) {
      inverse.copy(root.matrixWorld).invert();
      parts.forEach((part, k) => {
        bodies.setMatrixAt(k, at.multiplyMatrices(inverse, part.matrixWorld));
        shadows.setMatrixAt(k, at.premultiply(DOWN));
      });
      bodies.instanceMatrix.needsUpdate = shadows.instanceMatrix.needsUpdate = true;
    }
    this.renderer.render(this.scene, this.camera);
  }
}
