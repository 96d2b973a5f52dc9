// SPDX-License-Identifier: GPL-3.0-or-later
// Plays the .glb file of its page: figures side by side, or in rows where the window is narrow, each above its own floor.
import {
  AnimationMixer, Box3, DirectionalLight, HemisphereLight, InstancedMesh, Matrix4, MeshBasicMaterial, PerspectiveCamera,
  PolarGridHelper, Scene, Spherical, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const $ = (id) => document.getElementById(id), stage = document.querySelector("main"), status = document.body.dataset;
const night = matchMedia("(prefers-color-scheme: dark)");
const AT_NIGHT = { "#1a1a1a": "#d5dbe1", "#595959": "#9aa5b0", "#b3b3b3": "#5a6672" };  // greys that a dark page would hide
const DOWN = new Matrix4().makeScale(1, 0, 1);  // to the plan
const TILT = 0.24, FIELD = 11, ROOM = 1.15;  // of the first view: radians, degrees, over the width of a figure

function stop(words) {
  status.state = "failed";
  status.error = words;
  $("wrong").textContent = words;
  $("wrong").hidden = false;
  document.querySelector("footer").hidden = true;
}

function rendering() {
  try {
    return new WebGLRenderer({ antialias: true, alpha: true });
  } catch {
    return null;
  }
}

function pace(scale) {
  if (Math.abs(scale - 1) < 1e-9) return "in real time";
  return `${Number((scale < 1 ? 1 / scale : scale).toPrecision(3))} times ${scale < 1 ? "slower" : "faster"} than real time`;
}

function child(object, name) { return object.children.find((each) => each.userData.name === name); }

function figureOf(root) {
  const { caption = "", captions = [caption], angular_speed: speed } = root.userData, label = document.createElement("div");
  const turning = child(root, "turning"), first = turning.children.find((each) => each.isMesh);
  label.className = "caption";
  label.style.setProperty("--of", first.material.name);
  stage.append(label);
  return { root, turning, speed, captions, label, axis: child(root, "axis"), radius: 0, low: Infinity, high: -Infinity };
}

function say(label, words) {
  if (label.dataset.words === words) return;
  const [head, ...rest] = words.split("\n"), name = document.createElement("b");
  name.textContent = head;
  label.replaceChildren(name, rest.join("\n"));
  label.dataset.words = words;
}

function measure(figure) {  // how far it reaches at this instant, about its own axis
  const box = new Box3(), middle = figure.root.position;
  figure.root.updateMatrixWorld(true);
  figure.root.traverse((part) => {
    if (!part.isMesh) return;
    box.copy(part.geometry.boundingBox).applyMatrix4(part.matrixWorld);
    const wide = Math.max(Math.abs(box.min.x - middle.x), Math.abs(box.max.x - middle.x));
    figure.radius = Math.max(figure.radius, Math.hypot(wide, Math.max(-box.min.z, box.max.z)));
    figure.low = Math.min(figure.low, box.min.y);
    figure.high = Math.max(figure.high, box.max.y);
  });
}

function ticks(low, high) {  // round numbers
  const rough = (high - low) / 4, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((digit) => digit * power).find((each) => each >= rough * (1 - 1e-9));
  const first = Math.ceil(low / step - 1e-9), count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: count }, (_, k) => Number(((first + k) * step).toPrecision(6)));
}

function chartOf({ x_label, y_label, logarithmic, lines, x, y }, colours) {  // returns what moves its dots
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg"), [left, right, top, bottom] = [48, 310, 28, 214];
  function add(name, attributes, words = "") {
    const made = document.createElementNS(svg.namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.textContent = words;
    svg.append(made);
    return made;
  }
  function axis(values, from, to, rounded) {  // of numbers: their position, and the ticks
    let [low, high] = [Math.min(...values), Math.max(...values)];
    if (rounded) [low, high] = [Math.floor(low), Math.ceil(high)];
    if (!(high > low)) [low, high] = [low - (Math.abs(low) || 1) / 10, high + (Math.abs(high) || 1) / 10];
    return { at: (value) => from + (to - from) * (value - low) / (high - low), marks: ticks(low, high) };
  }
  const measure = (value) => logarithmic ? Math.log10(value) : value;
  const across = axis(lines.flatMap(([a]) => a), left, right), up = axis(lines.flatMap(([, b]) => b.map(measure)), bottom, top, logarithmic);
  svg.setAttribute("viewBox", "0 0 320 250");
  add("path", { d: `M${left} ${top}V${bottom}H${right}`, fill: "none" });
  for (const mark of across.marks) add("text", { x: across.at(mark), y: bottom + 15, "text-anchor": "middle" }, mark);
  for (const mark of up.marks) {
    if (logarithmic && mark % 1) continue;
    const words = logarithmic ? Number((10 ** mark).toPrecision(3)) : mark;
    add("text", { x: left - 5, y: up.at(mark) + 4, "text-anchor": "end" }, words);
  }
  add("text", { x: (left + right) / 2, y: bottom + 31, "text-anchor": "middle" }, x_label);
  add("text", { x: 4, y: 12 }, y_label);
  const dots = lines.map(([a, b], n) => {
    const points = a.map((value, k) => `${across.at(value).toFixed(1)},${up.at(measure(b[k])).toFixed(1)}`).join(" ");
    add("polyline", { points, fill: "none", style: `stroke: ${colours[n]}`, "stroke-width": 1.5 });
    return add("circle", { r: 5, fill: colours[n] });
  });
  $("chart").append(svg);
  $("chart").hidden = false;
  return (part) => dots.forEach((dot, n) => {
    const at = part * (x[n].length - 1), k = Math.min(Math.floor(at), x[n].length - 2);
    const between = (list) => list[k] + (at - k) * (list[k + 1] - list[k]);
    dot.setAttribute("cx", across.at(between(x[n])));
    dot.setAttribute("cy", up.at(measure(between(y[n]))));
  });
}

function view(gltf, renderer) {
  const { scene: solid, animations: [clip] } = gltf, scene = new Scene(), canvas = renderer.domElement;
  const figures = solid.children.map(figureOf), { progress = [], note = "", chart } = solid.userData;
  const { gravity, time_scale: scale } = figures[0].root.userData, still = figures.every((each) => each.speed !== undefined);
  const mixer = new AnimationMixer(solid), seconds = clip ? clip.duration : 1;
  const mark = chart && chartOf(chart, figures.map(({ label }) => label.style.getPropertyValue("--of")));
  let time = 0, away = 0, playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, before = null, stale = true;
  if (clip) mixer.clipAction(clip).play();

  function pose() {  // what only turns does not jump where the film begins again
    mixer.setTime(time % seconds);
    for (const { turning, speed } of figures) if (speed) turning.rotation.y = speed * scale * time;
    solid.updateMatrixWorld(true);
    const inverse = new Matrix4(), at = new Matrix4();
    for (const { root, parts, bodies, shadows } of sets.values()) {
      inverse.copy(root.matrixWorld).invert();
      parts.forEach((part, k) => {
        bodies.setMatrixAt(k, at.multiplyMatrices(inverse, part.matrixWorld));
        shadows.setMatrixAt(k, at.premultiply(DOWN));
      });
      bodies.instanceMatrix.needsUpdate = shadows.instanceMatrix.needsUpdate = true;
    }
  }
  const moments = still ? 1 : 120;
  for (let k = 0; k < moments; k++) {
    mixer.setTime(seconds * k / moments);
    figures.forEach(measure);
  }
  const radius = Math.max(...figures.map((each) => each.radius)), low = Math.min(...figures.map((each) => each.low));
  const tall = Math.max(...figures.map((each) => each.high)) - low, gap = 0.04 * tall, span = Math.max(radius, 0.12 * tall);

  // ---- what stands around them
  scene.add(solid);
  const sky = new HemisphereLight(0xffffff, 0x9aa6b2, 2.5), sun = new DirectionalLight(0xffffff, 2.6);
  scene.add(sky, sun);
  sun.position.set(0.35, 1, 0.7);
  const shade = new MeshBasicMaterial(), sets = new Map();  // parts of one figure, form and colour: the browser draws them at once
  for (const { root, turning } of figures) {
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
    set.shadows = new InstancedMesh(geometry, shade, parts.length);
    set.bodies.frustumCulled = set.shadows.frustumCulled = false;
    set.shadows.position.y = low - gap;
    root.add(set.bodies, set.shadows);
  }
  function paint() {
    const dark = night.matches;
    solid.traverse(({ material }) => {
      if (material?.name) material.color.set(dark && AT_NIGHT[material.name] || material.name);
    });
    shade.color.set(dark ? 0x0b0f14 : 0xbcc6d0);
    for (const figure of figures) {
      figure.lines?.removeFromParent();
      figure.lines = new PolarGridHelper(1.12 * span, 12, 4, 72, dark ? 0x4a5764 : 0xaebac6, dark ? 0x35414c : 0xcbd4dd);
      figure.lines.position.y = low - gap - 1e-3 * tall;
      figure.root.add(figure.lines);
    }
    stale = true;
  }

  // ---- where they are seen from
  const camera = new PerspectiveCamera(FIELD), controls = new OrbitControls(camera, canvas);
  controls.addEventListener("change", () => { stale = true; });
  function arrange(afresh) {  // in as many columns as show them largest; a view that was turned stays turned
    const wide = stage.clientWidth, high = stage.clientHeight;
    if (!wide || !high) return;  // in a frame that is folded up
    for (const { label, captions } of figures) say(label, row(captions));
    const most = (what) => Math.max(...figures.map(({ label }) => label[what]));
    const least = most("offsetWidth") + 2, words = most("offsetHeight") + 14;
    const across = 2 * ROOM * span, up = (tall + gap) * Math.cos(TILT) + 2.6 * span * Math.sin(TILT);
    let best = { scale: 0 };
    for (let columns = 1; columns <= figures.length; columns++) {
      const rows = Math.ceil(figures.length / columns);
      if (columns > 1 && wide / columns < least) break;
      const scale = 0.94 * Math.min(wide / (columns * across), Math.max(high / rows - words, 20) / up);
      if (scale > best.scale * 1.05) best = { scale, columns, rows };
    }
    const { scale, columns, rows } = best, step = Math.min(Math.max(1.3 * across, least / scale), 0.98 * wide / columns / scale);
    const fall = Math.min(up + words / scale, high / rows / scale) / Math.cos(TILT);
    figures.forEach(({ root }, n) => {
      const row = Math.floor(n / columns), inside = Math.min(columns, figures.length - row * columns);
      root.position.set((n % columns - (inside - 1) / 2) * step, ((rows - 1) / 2 - row) * fall, 0);
    });
    const centre = new Vector3(0, low - gap + tall / 2 - words / scale / 2.2, 0);
    const far = high / scale / 2 / Math.tan(FIELD * Math.PI / 360);
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(wide, high);
    Object.assign(camera, { aspect: wide / high, near: far / 100, far: far * 12 });
    camera.updateProjectionMatrix();
    controls.minDistance = far / 20;
    controls.maxDistance = far * 6;
    const from = afresh || !away ? new Vector3(0, Math.sin(TILT), Math.cos(TILT)).multiplyScalar(far + 0.3 * span)
      : camera.position.clone().sub(controls.target).multiplyScalar(far / away);
    away = far;
    camera.position.copy(centre).add(from);
    controls.target.copy(centre);
    controls.update();
    stale = true;
  }
  function turn(about, tilt, nearer) {
    const from = new Spherical().setFromVector3(camera.position.clone().sub(controls.target));
    from.set(from.radius * nearer, Math.min(Math.max(from.phi + tilt, 0.01), Math.PI - 0.01), from.theta + about);
    camera.position.setFromSpherical(from).add(controls.target);
    controls.update();
  }

  // ---- words
  const decimals = Math.min(Math.max(2 - Math.floor(Math.log10(seconds * scale)), 0), 9);
  $("progress").style.minWidth = `${1 + Math.max(...[...progress, "Time: 0.000 s"].map((words) => words.length))}ch`;
  $("playback").style.minWidth = "5ch";
  function row(list) { return list.length === 1 ? list[0] : list[Math.round(time % seconds / seconds * (list.length - 1))]; }
  function caption() {
    const pull = gravity ? `gravity ${Number(gravity.toPrecision(6))} m/s²` : "without gravity";
    const part = time % seconds / seconds, faster = 10 ** $("pace").value;
    $("words").textContent = [pull, pace(scale * faster), note].filter(Boolean).join("; ");
    $("playback").textContent = `×${Number(faster.toPrecision(2))}`;
    $("progress").textContent = progress.length ? row(progress) : `Time: ${(part * seconds * scale).toFixed(decimals)} s`;
    $("at").value = part;
    mark?.(part);
    const taken = [], place = new Vector3();
    const placed = figures.map((figure) => {
      place.set(figure.root.position.x, figure.root.position.y + low - gap, 0);
      const depth = place.distanceTo(camera.position), front = camera.position.clone().sub(place).setY(0).setLength(1.12 * span);
      const rim = place.clone().add(front).project(camera);
      place.project(camera);
      const [x, y] = [(1 + place.x) / 2 * stage.clientWidth, (1 - Math.min(rim.y, place.y)) / 2 * stage.clientHeight + 5];
      return { figure, depth, x, y, seen: place.z < 1 };
    });
    for (const { figure: { captions, label }, x, y, seen } of placed.sort((a, b) => a.depth - b.depth)) {
      say(label, row(captions));
      const box = [x - label.offsetWidth / 2, y, x + label.offsetWidth / 2, y + label.offsetHeight];
      const hidden = !seen || taken.some((other) =>
        box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3]);
      label.style.visibility = hidden ? "hidden" : "visible";  // the nearest of those that would cover one another
      if (!hidden) taken.push(box);
      label.style.transform = `translate(${Math.round(box[0])}px, ${Math.round(y)}px)`;
    }
  }

  function partsSeen() {
    const place = new Vector3(), parts = [...sets.values()].flatMap((set) => set.parts);
    return parts.filter((part) => {
      place.setFromMatrixPosition(part.matrixWorld).project(camera);
      return Math.abs(place.x) < 1 && Math.abs(place.y) < 1;
    }).length;
  }
  function draw() {
    stale = false;
    pose();
    renderer.render(scene, camera);
    caption();
  }
  function tick(now) {
    if (before !== null && playing) time += Math.min(now - before, 100) / 1000 * 10 ** $("pace").value;
    before = now;
    if (playing || stale) draw();
    requestAnimationFrame(tick);
  }
  function play(on) { playing = on; $("play").textContent = on ? "Pause" : "Play"; }

  $("play").onclick = () => play(!playing);
  $("reset").onclick = () => arrange(true);
  $("pace").oninput = () => { stale = true; };
  $("at").oninput = () => { play(false); time = Math.min($("at").value, 0.999999) * seconds; stale = true; };
  canvas.tabIndex = 0;
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", document.title);
  const KEYS = {
    ArrowLeft: [0.1, 0, 1], ArrowRight: [-0.1, 0, 1], ArrowUp: [0, 0.1, 1], ArrowDown: [0, -0.1, 1],
    "+": [0, 0, 0.9], "=": [0, 0, 0.9], "-": [0, 0, 1 / 0.9],
  };
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || /INPUT|BUTTON/.test(event.target.tagName)) return;
    if (KEYS[event.key]) turn(...KEYS[event.key]);
    else if (event.key === " ") play(!playing);
    else if (event.key === "Home") arrange(true);
    else return;
    event.preventDefault();
  });
  night.onchange = paint;
  new ResizeObserver(() => arrange(false)).observe(stage);
  stage.prepend(canvas);
  paint();
  arrange(true);
  const start = new URLSearchParams(location.hash.slice(1)).get("t");  // page.html#t=1.5 stands still at 1.5 s
  if (start !== null) { playing = false; time = Number(start); }
  play(playing);
  draw();
  requestAnimationFrame(tick);
  const parts = [];
  solid.traverse((part) => { if (part.userData.name) parts.push(part); });
  const channels = clip ? clip.tracks.length : 0;
  const { triangles } = renderer.info.render;
  Object.assign(status, { state: "loaded", figures: figures.length, nodes: parts.length, channels, triangles, seen: partsSeen() });
}

addEventListener("error", (event) => stop(event.message));
addEventListener("securitypolicyviolation", (event) => stop(`This page may not load ${event.blockedURI}.`));
const renderer = rendering();
if (renderer === null) {
  stop("This page needs WebGL, which this browser does not have or has switched off.");
} else {
  const bytes = Uint8Array.from(atob($("solid").textContent), (c) => c.charCodeAt(0));
  const refused = (error) => stop(`The solid cannot be read: ${error.message}`);
  new GLTFLoader().parse(bytes.buffer, "", (gltf) => view(gltf, renderer), refused);
}
