// SPDX-License-Identifier: GPL-3.0-or-later
// The figure of a chain from numbers, in the forms that the package writes into .glb files.
import { CylinderGeometry, Group, Mesh, MeshStandardMaterial, SphereGeometry, Vector3 } from "three";

const THIN = 0.006, BALL = 0.035;  // radii, over the height or the width of the whole
const UP = new Vector3(0, 1, 0), forms = { bar: new CylinderGeometry(1, 1, 1, 20), ball: new SphereGeometry(1, 20, 8) };
const materials = new Map();

function materialOf(colour) {
  if (!materials.has(colour)) {
    materials.set(colour, new MeshStandardMaterial({ name: colour, color: colour, metalness: 0.1, roughness: 0.6 }));
  }
  return materials.get(colour);
}

/** {root, turning} of a chain. Pins are [offset, height], lowest first; bodies are [offset, height, size 0 to 1]. */
export function chainFigure({ pins, bodies, arm, top, floor, colour }) {
  const root = new Group(), turning = new Group(), points = pins.map(([x, y]) => new Vector3(x, y, 0));
  const tall = Math.max(top - floor, ...pins.map(([x]) => 2 * Math.abs(x))), support = points.at(-1);
  function bar(parent, from, to, radius, of) {
    const mesh = new Mesh(forms.bar, materialOf(of)), way = to.clone().sub(from);
    const length = Math.max(way.length(), 1e-9 * tall);
    mesh.position.copy(from).add(to).multiplyScalar(0.5);
    mesh.quaternion.setFromUnitVectors(UP, way.divideScalar(length));
    mesh.scale.set(radius * tall, length, radius * tall);
    parent.add(mesh);
  }
  function ball(at, radius, of) {
    const mesh = new Mesh(forms.ball, materialOf(of));
    mesh.position.copy(at);
    mesh.scale.setScalar(radius * tall);
    turning.add(mesh);
  }
  bar(root, new Vector3(0, floor, 0), new Vector3(0, top, 0), THIN / 3, "#b3b3b3");
  points.slice(1).forEach((upper, k) => bar(turning, upper, points[k], THIN, colour));
  const most = Math.min(BALL, Math.max(0.28 / (points.length - 1), 1.5 * THIN));
  for (const [x, y, size] of bodies) ball(new Vector3(x, y, 0), most * Math.max(size, 0.3), "#595959");
  ball(support, 0.6 * BALL, "#1a1a1a");
  const end = new Vector3(arm, 0, 0), axis = new Vector3(0, 0, 0);
  if (arm) bar(turning, axis, end, 1.3 * THIN, "#1a1a1a");
  if (support.distanceTo(end) > 1e-9 * tall) bar(turning, end, support, THIN / 2, "#b3b3b3");  // the spring
  root.add(turning);
  return { root, turning };
}
