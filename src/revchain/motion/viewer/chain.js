// SPDX-License-Identifier: GPL-3.0-or-later
// The figure of a chain from numbers: links as bars, bodies in the forms of their names, support, arm, mast, and a trail.
import {
  BoxGeometry, BufferGeometry, CylinderGeometry, Euler, Float32BufferAttribute, Group, LatheGeometry, Line,
  LineBasicMaterial, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, TorusGeometry, Vector2, Vector3,
} from "three";

const THIN = 0.006, THICK = 0.014, BALL = 0.035;  // radii, over the height or the width of the whole
const UP = new Vector3(0, 1, 0), SEATS = 8;  // places on a carousel
const GREY = { body: "#595959", support: "#1a1a1a", axis: "#b3b3b3", others: "#aab4bd" };
const METAL = "#b08d3c", WOOD = "#8a6a4a", RIDER = "#c25400", AHEAD = "#0072b2", BACK = "#cc3311";

const turned = (points) => new LatheGeometry(points.map(([r, y]) => new Vector2(r, y)), 32);
const forms = {  // of radius or width 1, upright
  bar: new CylinderGeometry(1, 1, 1, 20),
  ball: new SphereGeometry(1, 20, 10),
  box: new BoxGeometry(1, 1, 1),
  ring: new TorusGeometry(0.5, 0.15, 8, 14),
  rim: new TorusGeometry(1, 0.05, 8, 40).rotateX(Math.PI / 2),
  bell: turned([  // from the rim up the outside to the crown and down the inside
    [1, 0], [0.9, 0.06], [0.76, 0.2], [0.66, 0.42], [0.61, 0.66], [0.56, 0.84], [0.44, 0.95], [0.2, 1], [0, 1], [0, 0.92],
    [0.4, 0.86], [0.5, 0.7], [0.58, 0.42], [0.7, 0.18], [0.92, 0], [1, 0],
  ]),
  jar: turned([[0, 0], [0.55, 0], [0.75, 0.2], [0.8, 0.5], [0.6, 0.8], [0.35, 0.9], [0.45, 1], [0, 0.98]]),
};
const materials = new Map();

function materialOf(colour) {
  if (!materials.has(colour)) {
    materials.set(colour, new MeshStandardMaterial({ name: colour, color: colour, metalness: 0.1, roughness: 0.6 }));
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
  put(parent, "bar", colour, middle, [radius, length, radius], new Quaternion().setFromUnitVectors(UP, way.divideScalar(length)));
}

/** What links are drawn as: functions of {piece, length, gyration, along, tall, ahead}, in axes of the link whose y points
 * away from the pin it hangs from or stands on. `piece(form, colour, [x, y, z], [wide, high, deep], turned by)`. */
const bodies = {
  bell({ piece, gyration, along }) {
    const wide = 1.35 * gyration, high = 2.2 * gyration;
    piece("bell", METAL, [0, along + 0.42 * high, 0], [wide, high, wide], new Euler(Math.PI, 0, 0));
  },
  jar({ piece, length }) { piece("jar", WOOD, [0, 0, 0], [0.4 * length, length, 0.4 * length]); },
  person({ piece, length: tall }) {
    const part = (form, colour, y, z, scale) => piece(form, colour, [0, y * tall, z * tall], scale.map((x) => x * tall));
    for (const side of [-1, 1]) {
      part("bar", GREY.body, 0.25, 0.06 * side, [0.035, 0.5, 0.035]);
      part("ball", GREY.body, 0.64, 0.13 * side, [0.03, 0.17, 0.03]);
    }
    part("ball", RIDER, 0.64, 0, [0.08, 0.19, 0.11]);
    part("ball", GREY.body, 0.9, 0, [0.07, 0.09, 0.07]);
  },
  seat({ piece, along, tall }) {
    const s = 0.075 * tall;
    const part = (form, colour, y, z, scale) => piece(form, colour, [0, along + y * s, z * s], scale.map((x) => x * s));
    part("box", AHEAD, 0.3, 0, [1, 0.1, 0.9]);
    part("box", AHEAD, -0.1, -0.45, [1, 0.9, 0.08]);
    part("ball", RIDER, -0.2, -0.1, [0.3, 0.5, 0.25]);
    part("ball", GREY.body, -0.9, -0.1, [0.22, 0.24, 0.22]);
    part("ball", GREY.body, 0.25, 0.2, [0.26, 0.16, 0.4]);
  },
  crate({ piece, along, tall }) { piece("box", WOOD, [0, along, 0], [0.1 * tall, 0.08 * tall, 0.1 * tall]); },
  hook({ piece, along, tall }) { piece("box", METAL, [0, along, 0], [0.035 * tall, 0.045 * tall, 0.025 * tall]); },
  wheel({ piece, gyration, along, ahead }) {
    const r = Math.SQRT2 * gyration, rim = ahead < 0 ? BACK : AHEAD;
    piece("rim", rim, [0, along, 0], [r, r, r]);
    piece("ball", GREY.body, [0, along, 0], [0.09 * r, 0.14 * r, 0.09 * r]);
    for (const way of [0, 1, 2]) {
      piece("bar", GREY.axis, [0, along, 0], [0.02 * r, 2 * r, 0.02 * r], new Euler(0, way * Math.PI / 3, Math.PI / 2));
    }
  },
  disc({ piece, gyration, along, ahead }) {
    const r = Math.SQRT2 * gyration;
    piece("bar", ahead < 0 ? BACK : AHEAD, [0, along, 0], [r, 0.3 * r, r]);
  },
};

/** A link up to its pin `to` from the one it hangs from or stands on, with its body. */
function addLink(parent, link, to, from, { tall, ball, colour, others, odd }) {
  const paint = (own) => others ? GREY.others : own;
  const way = to.clone().sub(from), length = Math.max(way.length(), 1e-9);
  const turn = new Quaternion().setFromUnitVectors(UP, way.divideScalar(length));
  const at = (x, y, z) => new Vector3(x, y, z).applyQuaternion(turn).add(from);
  function piece(form, own, place, scale, tilt) {
    const way = tilt === undefined ? turn : turn.clone().multiply(new Quaternion().setFromEuler(tilt));
    put(parent, form, paint(own), at(...place), scale, way);
  }
  const along = link.along * length, gyration = link.gyration;
  if (link.form === "ring") {
    const wide = Math.max(0.55 * length, 2.4 * THIN * tall);
    const twist = turn.clone().multiply(new Quaternion().setFromAxisAngle(UP, odd ? Math.PI / 2 : 0));
    put(parent, "ring", paint(colour), at(0, length / 2, 0), [wide, 1.15 * length, wide], twist);
    return;
  }
  bar(parent, to, from, (link.stands ? THICK : THIN) * tall, paint(colour));
  if (bodies[link.form]) return bodies[link.form]({ piece, length, along, gyration, tall, ahead: link.ahead });
  if (link.size) {
    if (link.rod) bar(parent, at(0, along - link.rod * length, 0), at(0, along + link.rod * length, 0), 1.8 * THIN * tall, paint(colour));
    if (!link.plain) piece("ball", GREY.body, [0, along, 0], Array(3).fill(ball * Math.max(link.size, 0.3)));
  }
}

/** The arc along which a point at this distance and height has come, fading away. */
function trailOf(radius, height, turns, colour) {
  const count = 49, line = new BufferGeometry(), places = [], shades = [];
  const { r, g, b } = materialOf(colour).color;
  for (let k = 0; k < count; k++) {
    const angle = turns * k / (count - 1) * 2.2;
    places.push(radius * Math.cos(angle), height, radius * Math.sin(angle));
    shades.push(r, g, b, 0.75 * (1 - k / (count - 1)) ** 1.5);
  }
  line.setAttribute("position", new Float32BufferAttribute(places, 3));
  line.setAttribute("color", new Float32BufferAttribute(shades, 4));
  return new Line(line, new LineBasicMaterial({ vertexColors: true, transparent: true }));
}

/** {root, turning, trail} of a chain. Pins are [offset, height], lowest first; `links`, one fewer, are described by
 * {form, size 0 to 1, along and rod as parts of the length, gyration in m, ahead, stands, plain}. */
export function chainFigure({ pins, links, arm, carriage, top, floor, colour, turns }) {
  const root = new Group(), turning = new Group(), points = pins.map(([x, y]) => new Vector3(x, y, 0));
  const tall = Math.max(top - floor, ...pins.map(([x]) => 2 * Math.abs(x))), support = points.at(-1);
  const heavy = links.reduce((sum, { size }) => sum + size ** 3, 0);  // the heaviest as one, the others as parts of it
  const ball = tall * Math.min(BALL, Math.max(0.28 / heavy, 1.5 * THIN));
  const end = new Vector3(arm, 0, 0), axis = new Vector3(0, 0, 0), ride = arm > 0 && links.some(({ form }) => form === "seat");
  bar(root, new Vector3(0, floor, 0), new Vector3(0, top, 0), (ride ? 2.5 * THIN : THIN / 3) * tall, ride ? GREY.support : GREY.axis);
  for (let place = 0; place < (ride ? SEATS : 1); place++) {
    const group = new Group(), others = place > 0;
    group.rotation.y = 2 * Math.PI * place / SEATS;
    points.slice(1).forEach((upper, k) => {
      addLink(group, links[k], points[k], upper, { tall, ball, colour, others, odd: k % 2 });
    });
    if (carriage && !others) put(group, "box", GREY.body, support, [0.09 * tall, 0.025 * tall, 0.06 * tall]);
    put(group, "ball", GREY.support, support, Array(3).fill(0.5 * BALL * tall));
    if (arm) bar(group, axis, end, 1.3 * THIN * tall, GREY.support);
    if (support.distanceTo(end) > 1e-9 * tall) bar(group, end, support, THIN / 2 * tall, GREY.axis);  // the spring
    turning.add(group);
  }
  const trail = new Group(), [x, y] = pins[0];
  if (Math.abs(x) > 1e-6 * tall) trail.add(trailOf(x, y, turns, colour));
  root.add(turning, trail);
  return { root, turning, trail };
}
