// SPDX-License-Identifier: GPL-3.0-or-later
// Plays the .glb file of its page: figures side by side, or in rows in a narrow window, each above its own floor.
// On a page without such a file, the live page, it only provides `viewer`: a stage, and figures of chains.
import { AnimationMixer, Vector3 } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { chainFigure } from "./chain.js";
import { Stage, extentOf } from "./stage.js";

const $ = (id) => document.getElementById(id), status = document.body.dataset;

function stop(words) {
  status.state = "failed";
  status.error = words;
  $("wrong").textContent = words;
  $("wrong").hidden = false;
  document.querySelector("footer").hidden = true;
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
  document.querySelector("main").append(label);
  return { root, turning, speed, captions, label };
}

function say(label, words) {
  if (label.dataset.words === words) return;
  const [head, ...rest] = words.split("\n"), name = document.createElement("b");
  name.textContent = head;
  label.replaceChildren(name, rest.join("\n"));
  label.dataset.words = words;
}

function ticks(low, high) {  // round numbers
  const rough = (high - low) / 4, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((digit) => digit * power).find((each) => each >= rough * (1 - 1e-9));
  const first = Math.ceil(low / step - 1e-9), count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: count }, (_, k) => Number(((first + k) * step).toPrecision(6)));
}

function chartOf({ x_label, y_label, logarithmic, lines, x, y }, colours) {  // returns what moves its dots
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const [left, right, top, bottom] = [48, 310, 28, 214];
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
  const across = axis(lines.flatMap(([a]) => a), left, right);
  const up = axis(lines.flatMap(([, b]) => b.map(measure)), bottom, top, logarithmic);
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

function view(gltf, stage) {
  const { scene: solid, animations: [clip] } = gltf, { progress = [], note = "", chart } = solid.userData;
  const figures = solid.children.map(figureOf), all = [];
  const { gravity, time_scale: scale } = figures[0].root.userData;
  const still = figures.every((each) => each.speed !== undefined);
  const mixer = new AnimationMixer(solid), seconds = clip ? clip.duration : 1;
  const mark = chart && chartOf(chart, figures.map(({ label }) => label.style.getPropertyValue("--of")));
  const decimals = Math.min(Math.max(2 - Math.floor(Math.log10(seconds * scale)), 0), 9);
  let time = 0, playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, before = null;
  if (clip) mixer.clipAction(clip).play();
  solid.traverse((part) => all.push(part));

  const moments = still ? 1 : 120;
  let extent;
  for (let k = 0; k < moments; k++) {
    mixer.setTime(seconds * k / moments);
    extent = extentOf(figures, extent);
  }
  stage.show(figures, extent);

  const row = (list) => list[Math.round(time % seconds / seconds * (list.length - 1))];
  stage.words = () => {
    for (const { label, captions } of figures) say(label, row(captions));
    const most = (what) => Math.max(...figures.map(({ label }) => label[what]));
    return [most("offsetWidth") + 2, most("offsetHeight") + 14];
  };
  function caption() {
    const pull = gravity ? `gravity ${Number(gravity.toPrecision(6))} m/s²` : "without gravity";
    const part = time % seconds / seconds, faster = 10 ** $("pace").value;
    $("words").textContent = [pull, pace(scale * faster), note].filter(Boolean).join("; ");
    $("playback").textContent = `×${Number(faster.toPrecision(2))}`;
    const clock = `Time: ${(part * seconds * scale).toFixed(decimals)} s`;
    $("progress").textContent = progress.length ? row(progress) : clock;
    $("at").value = part;
    mark?.(part);
    const { camera, low, gap, span, element: { clientWidth: wide, clientHeight: high } } = stage;
    const taken = [], place = new Vector3();
    const placed = figures.map((figure) => {
      place.set(figure.root.position.x, figure.root.position.y + low - gap, 0);
      const depth = place.distanceTo(camera.position);
      const front = camera.position.clone().sub(place).setY(0).setLength(1.12 * span);
      const rim = place.clone().add(front).project(camera);
      place.project(camera);
      const [x, y] = [(1 + place.x) / 2 * wide, (1 - Math.min(rim.y, place.y)) / 2 * high + 5];
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
  function draw() {
    mixer.setTime(time % seconds);  // what only turns does not jump where the film begins again
    for (const { turning, speed } of figures) if (speed) turning.rotation.y = speed * scale * time;
    stage.draw();
    caption();
  }
  function tick(now) {
    if (before !== null && playing) time += Math.min(now - before, 100) / 1000 * 10 ** $("pace").value;
    before = now;
    if (playing || stage.stale) draw();
    requestAnimationFrame(tick);
  }
  function play(on) { playing = on; $("play").textContent = on ? "Pause" : "Play"; }

  $("play").onclick = () => play(!playing);
  $("reset").onclick = () => stage.arrange(true);
  $("pace").oninput = () => { stage.stale = true; };
  $("at").oninput = () => { play(false); time = Math.min($("at").value, 0.999999) * seconds; stage.stale = true; };
  $("progress").style.minWidth = `${1 + Math.max(...[...progress, "Time: 0.000 s"].map((words) => words.length))}ch`;
  $("playback").style.minWidth = "5ch";
  stage.canvas.setAttribute("aria-label", document.title);
  addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey || /INPUT|BUTTON/.test(event.target.tagName)) return;
    if (event.key === " ") play(!playing);
    else if (!stage.key(event.key)) return;
    event.preventDefault();
  });
  stage.arrange(true);
  const start = new URLSearchParams(location.hash.slice(1)).get("t");  // page.html#t=1.5 stands still at 1.5 s
  if (start !== null) { playing = false; time = Number(start); }
  play(playing);
  draw();
  requestAnimationFrame(tick);
  const place = new Vector3(), seen = all.filter((part) => {
    if (!part.isMesh || part.userData.name === "axis") return false;
    place.setFromMatrixPosition(part.matrixWorld).project(stage.camera);
    return Math.abs(place.x) < 1 && Math.abs(place.y) < 1;
  }).length;
  const nodes = all.filter((part) => part.userData.name).length, channels = clip ? clip.tracks.length : 0;
  const { triangles } = stage.renderer.info.render;
  Object.assign(status, { state: "loaded", figures: figures.length, nodes, channels, triangles, seen });
}

function start() {
  let stage;
  addEventListener("error", (event) => stop(event.message));
  addEventListener("securitypolicyviolation", (event) => stop(`This page may not load ${event.blockedURI}.`));
  try {
    stage = new Stage(document.querySelector("main"));
  } catch {
    stop("This page needs WebGL, which this browser does not have or has switched off.");
    return;
  }
  const bytes = Uint8Array.from(atob($("solid").textContent), (c) => c.charCodeAt(0));
  const refused = (error) => stop(`The 3D model cannot be read: ${error.message}`);
  new GLTFLoader().parse(bytes.buffer, "", (gltf) => view(gltf, stage), refused);
}

if ($("solid")) start();
export { Stage, chainFigure, extentOf, ticks };
