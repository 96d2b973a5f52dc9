// SPDX-License-Identifier: GPL-3.0-or-later
// The figure of a chain from numbers: links as bars, bodies in their forms, support, arm, mast, and a trail.
import {
  BufferGeometry, CylinderGeometry, Euler, Float32BufferAttribute, Group, LatheGeometry, Line,
  LineBasicMaterial, Mesh, MeshStandardMaterial, Quaternion, Vector2, Vector3,
} from "three";
import table from "./forms.json";

const { thin: THIN, thick: THICK, ball: BALL, balls: BALLS, rim: RIM, ring: RING } = table.sizes;  // over the whole
const UP = new Vector3(0, 1, 0), SEATS = 8;  // places on a carousel
const { grey, support: dark, spoke } = table.colours, GREY = { body: grey, support: dark, axis: spoke, others: "#aab4bd" };
const OPACITY = Object.fromEntries(Object.entries(table.opacity).map(([name, part]) => [table.colours[name], part]));

const turned = (points, around = 32) => new LatheGeometry(points.map(([r, y]) => new Vector2(r, y)), around);

/** A part of a circle of this radius in `count` steps from its lowest point, turned about the y axis at a distance. */
function round(radius, distance, count, part, around) {
  const rim = Array.from({ length: count + 1 }, (_, k) => part * k / count - Math.PI / 2);
  return turned(rim.map((angle) => [distance + radius * Math.cos(angle), radius * Math.sin(angle)]), around);
}

function box() {
  const made = new CylinderGeometry(Math.SQRT1_2, Math.SQRT1_2, 1, 4).rotateY(Math.PI / 4).toNonIndexed();
  made.computeVertexNormals();  // those of flat faces
  return made;
}

const forms = {  // of radius or width 1, upright
  bar: new CylinderGeometry(1, 1, 1, 20),
  ball: round(1, 0, 10, Math.PI, 20),
  box: box(),
  ring: round(0.15, 0.5, 6, 2 * Math.PI, 10).rotateX(Math.PI / 2),
  rim: round(0.05, 1, 8, 2 * Math.PI, 40),
  ...Object.fromEntries(Object.entries(table.profiles).map(([name, points]) => [name, turned(points)])),
};
const materials = new Map();

function materialOf(colour) {
  if (!materials.has(colour)) {
    const clear = colour in OPACITY && { transparent: true, opacity: OPACITY[colour], depthWrite: false };
    materials.set(colour, new MeshStandardMaterial({ name: colour, color: colour, metalness: 0.1, roughness: 0.6, ...clear }));
  }
  return materials.get(colour);
}

function put(parent, form, colour, at, scale, turn) {
  const mesh = new Mesh(forms[form], materialOf(colour));
  mesh.position.copy(at);
  mesh.scale.set(...scale);
  if (turn) mesh.quaternion.copy(turn);
  parent.add(mesh);
}

/** A bar between two points. */
function bar(parent, from, to, radius, colour) {
  const way = to.clone().sub(from), length = Math.max(way.length(), 1e-9);
  const middle = from.clone().add(to).multiplyScalar(0.5);
  const turn = new Quaternion().setFromUnitVectors(UP, way.divideScalar(length));
  put(parent, "bar", colour, middle, [radius, length, radius], turn);
}

/** A link up to its pin `to` from the one it hangs from or stands on, with its body: pieces of forms.json in axes of
 * the link, whose y points along it. */
function addLink(parent, link, to, from, { tall, ball, colour, others, odd }) {
  const paint = (own) => others ? GREY.others : own;
  const way = to.clone().sub(from), length = Math.max(way.length(), 1e-9);
  const turn = new Quaternion().setFromUnitVectors(UP, way.divideScalar(length));
  const at = (x, y, z) => new Vector3(x, y, z).applyQuaternion(turn).add(from);
  function piece(form, own, place, scale, tilt) {
    const way = tilt ? turn.clone().multiply(new Quaternion().setFromEuler(new Euler(...tilt))) : turn;
    put(parent, form, paint(own), at(...place), scale, way);
  }
  if (link.form === "ring") {
    const wide = Math.max(RING[0] * length, RING[1] * THIN * tall);
    piece("ring", colour, [0, length / 2, 0], [wide, RING[2] * length, wide], [0, odd ? Math.PI / 2 : 0, 0]);
    return;
  }
  const along = link.along * length, body = table.bodies[link.form];
  const end = body?.hangs ? at(0, along - body.hangs * tall, 0) : to;
  if (!body?.bare) {
    bar(parent, end, from, (link.stands ? THICK : link.size ? THIN : THIN / 2) * tall, paint(link.size ? colour : GREY.axis));
  }
  if (body) {
    const { gyration } = link, rim = Math.max(Math.SQRT2 * gyration, RIM * tall);
    const unit = { tall, length, rim, gyration }[body.unit];
    const spin = link.ahead < 0 ? "back" : "ahead";
    const start = Math.max(along - (body.above ?? 0) * unit, 0);
    for (const [form, own, [x, y, z], scale, tilt] of [...body.pieces, ...body.solid ?? []]) {
      const shade = table.colours[own] ?? table.colours[spin];
      piece(form, shade, [x * unit, start + y * unit, z * unit], scale.map((part) => part * unit), tilt);
    }
    return;
  }
  if (!link.size) return;
  if (isRod(link)) bar(parent, at(0, along - link.rod * length, 0), to, 1.8 * THIN * tall, paint(colour));
  else if (!link.plain) piece("ball", GREY.body, [0, along, 0], Array(3).fill(ball * Math.max(link.size, 0.12)));
}

/** Whether the body is a uniform rod that ends at the lower pin. */
const isRod = ({ form, along, rod }) => !form && rod && Math.abs(along + rod - 1) < 1e-6;

/** An arc of radius 1 that fades away. */
const arc = new BufferGeometry(), places = [], shades = [];
for (let part = 1; part >= 0; part -= 0.02) {
  places.push(Math.cos(2.2 * (1 - part)), 0, Math.sin(2.2 * (1 - part)));
  shades.push(1, 1, 1, part * part);
}
arc.setAttribute("position", new Float32BufferAttribute(places, 3));
arc.setAttribute("color", new Float32BufferAttribute(shades, 4));

/** The arc along which a point at this distance and height has come. */
function trailOf(radius, height, turns, colour) {
  const name = `~${colour}`;
  if (!materials.has(name)) {
    materials.set(name, new LineBasicMaterial({ color: colour, vertexColors: true, transparent: true }));
  }
  const trail = new Line(arc, materials.get(name));
  trail.scale.set(radius, 1, radius * turns);
  trail.position.y = height;
  return trail;
}

/** {root, turning, trail} of a chain. Pins are [offset, height], lowest first; `links`, one fewer, are described by
 * {form, size 0 to 1, along and rod as parts of the length, gyration in m, ahead, stands, plain}. */
export function chainFigure({ pins, links, arm, springs, carriage, top, floor, colour, turns }) {
  const root = new Group(), turning = new Group(), points = pins.map(([x, y]) => new Vector3(x, y, 0));
  const tall = Math.max(top - floor, ...pins.map(([x]) => 2 * Math.abs(x))), support = points.at(-1);
  const heavy = links.reduce((sum, { size }) => sum + size ** 3, 0);  // the heaviest as one, the others as parts of it
  const ball = tall * Math.min(BALL, Math.max(BALLS / heavy, 1.5 * THIN));
  const end = new Vector3(arm, 0, 0), axis = new Vector3(0, 0, 0);
  const hall = arm > 0 && links.some(({ form }) => form === "seat"), mast = hall ? 2.5 * THIN : THIN / 3;
  const ride = hall && !springs, frame = Math.max(0.36 * tall, 1.5 * Math.abs(support.x));
  const held = arm ? [end].filter((each) => each.distanceTo(support) > 1e-9 * tall)
    : [-1, 1].map((side) => new Vector3(side * frame, 0, 0));  // springs run from these points
  bar(root, new Vector3(0, floor, 0), new Vector3(0, top, 0), mast * tall, hall ? GREY.support : GREY.axis);
  for (let place = 0; place < (ride ? SEATS : 1); place++) {
    const group = new Group(), others = place > 0;
    group.rotation.y = 2 * Math.PI * place / SEATS;
    points.slice(1).forEach((upper, k) => {
      addLink(group, links[k], points[k], upper, { tall, ball, colour, others, odd: k % 2 });
    });
    if (carriage && !others) put(group, "box", GREY.body, support, [0.09 * tall, 0.025 * tall, 0.06 * tall]);
    put(group, "ball", GREY.support, support, Array(3).fill(0.5 * BALL * tall));
    if (links.length <= 12 && links.every(({ form }) => form !== "ring")) {
      points.slice(1, -1).forEach((joint, k) => {
        const wide = (isRod(links[k]) ? 2.8 : 1.6) * THIN * tall;
        put(group, "ball", GREY.support, joint, Array(3).fill(wide));
      });
    }
    if (arm) bar(group, axis, end, 1.3 * THIN * tall, GREY.support);
    for (const from of springs ? held : []) {
      const node = (j) => from.clone().lerp(support, j / 12).setY(j % 12 ? (j % 2 - 0.5) * 0.04 * tall : 0);
      for (let k = 0; k < 12; k++) bar(group, node(k), node(k + 1), THIN / 2 * tall, GREY.body);
      if (!arm) bar(group, from.clone().setY(-0.06 * tall), from.clone().setY(0.06 * tall), 1.3 * THIN * tall, GREY.support);
    }
    turning.add(group);
  }
  const trail = new Group(), [x, y] = pins[0];
  if (Math.abs(x) > 1e-6 * tall) trail.add(trailOf(x, y, turns, colour));
  root.add(turning, trail);
  return { root, turning, trail };
}
