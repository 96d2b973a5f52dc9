// SPDX-License-Identifier: MPL-2.0
// The page itself: sliders, cards, what is selected, and the picture that turns.

const $ = (id) => document.getElementById(id);
const MOST_CARDS = 60;
const VERDICT_WORDS = {minimum: 'stable', 'spectrally stable': 'stable if frictionless', unstable: 'unstable', undecided: 'stability open'};
/** Where questions take too long for a slider: links of a chain whose shapes are listed and whose diagram is proved. */
const REQUEST = {mostLinks: 200, budget: 4e5, proofLinks: 10, lists: 8, listBudget: 1e6, proofBudget: 3e6};

let state, links, modes = null, shapes = null, diagram = null, problem = '';
let chosen = null;  // the mode or the shape that turns: a figure with offset and height
let modesStale = true;  // asked for again with the next request
let modesShown = false;
let angle = 0, playing = true, dirty = true, top = 10, now = null, later = null, engine = null;

const digits = (x, n = 4) => Number.isFinite(x) ? String(Number(x.toPrecision(n))) : '–';
const shortBound = (x) => Number.isFinite(x) ? x.toExponential(1) : 'not proved';
const plural = (n, what) => `${n} ${what}${n === 1 ? '' : 's'}`;

function element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
}

// Sliders ------------------------------------------------------------------------------------------------------------

/** A slider with a field for any number. `scale` takes the slider's 0 ... 1000 to the number and back. */
function slider({label, unit = '', scale, get, set, least = -Infinity, main = false, id = ''}) {
    const range = element('input', {type: 'range', min: 0, max: 1000, step: 'any', id});
    const field = element('input', {type: 'number', step: 'any', className: 'number', ariaLabel: `${label}, as a number`});
    range.ariaLabel = label;
    const note = element('span', {className: 'unit'});
    const show = () => {
        range.value = scale.to(get());
        range.setAttribute('aria-valuetext', `${digits(get())} ${unit}`);
        if (document.activeElement !== field) field.value = digits(get(), 6);
    };
    range.oninput = () => { set(scale.from(Number(range.value))); show(); };
    field.onchange = () => {
        const value = Number(field.value);
        if (field.value !== '' && value >= least) set(value);
        field.blur();
        show();
    };
    const box = element('div', {className: `slider${main ? ' main' : ''}`},
                        element('label', {textContent: label, htmlFor: id}), element('span', {}, field, ` ${unit}`), range);
    show();
    return {box, show, note};
}

const linear = (low, high) => ({to: (x) => 1000 * (x - low) / (high() - low), from: (t) => low + (high() - low) * t / 1000});
const whole = (low, high) => ({to: linear(low, high).to, from: (t) => Math.round(linear(low, high).from(t))});
/** A hundred times less to a hundred times more than the number when the slider was made. */
function logarithmic(x) {
    const middle = x > 0 ? x : 1;
    return {to: (y) => 500 + 250 * Math.log10(Math.max(y, 1e-300) / middle), from: (t) => Number((middle * 10 ** ((t - 500) / 250)).toPrecision(4))};
}

let speedSlider = null;
function buildSliders() {
    speedSlider = slider({
        label: 'Speed', unit: 'rad/s', main: true, id: 'speed', least: 0, scale: linear(0, () => top),
        get: () => state.speed ?? 0, set: (x) => { state.speed = x; if (x > top) { top = 1.1 * x; askDiagram(); } changed({speed: true}); },
    });
    const gravity = slider({label: 'Gravity', unit: 'm/s²', id: 'gravity', least: 1e-6, scale: {to: (x) => 40 * x, from: (t) => Math.max(0.1, t / 40)},
                            get: () => state.gravity, set: (x) => { state.gravity = x; changed(); }});
    const most = 2 * totalLength(state) + 2 * state.radius;
    const arm = slider({label: 'Arm that carries the support round', unit: 'm', id: 'arm', least: 0, scale: linear(0, () => most),
                        get: () => state.radius, set: (x) => { state.radius = x; changed(); }});
    const spring = element('input', {type: 'checkbox', checked: state.stiffness !== null});
    spring.onchange = () => {
        const weight = state.gravity * state.parts.reduce((sum, part) => sum + part[PART.count] * part[PART.mass], 0);
        state.stiffness = spring.checked ? Number((4 * weight / totalLength(state)).toPrecision(3)) : null;
        if (!spring.checked) state.carriage = 0;
        buildSliders();
        changed();
    };
    const held = [element('label', {className: 'check'}, spring, 'Support on a sideways spring')];
    if (state.stiffness !== null) {
        held.push(slider({label: 'Stiffness', unit: 'N/m', least: 1e-12, scale: logarithmic(state.stiffness),
                          get: () => state.stiffness, set: (x) => { state.stiffness = x; changed(); }}).box);
        held.push(slider({label: 'Mass that moves with it', unit: 'kg', least: 0, scale: logarithmic(state.carriage || 1),
                          get: () => state.carriage, set: (x) => { state.carriage = x; changed(); }}).box);
    }
    const open = state.radius > 0 || state.stiffness !== null || $('sliders').querySelector('details')?.open;
    $('speed-slider').replaceChildren(speedSlider.box);
    $('sliders').replaceChildren(element('details', {open}, element('summary', {textContent: 'Gravity and support'}), gravity.box, arm.box, ...held));
}

function partBox(part, index) {
    const kind = element('select', {ariaLabel: `kind of part ${index + 1}`}, ...[['point', 'point masses'], ['rod', 'rods'], ['body', 'bodies']].map(
        ([value, textContent]) => element('option', {value, textContent})));
    kind.value = kindOf(part);
    kind.onchange = () => {
        setKind(part, kind.value);
        if (kind.value === 'body') part[PART.gyration] = 0.3 * part[PART.length], part[PART.centroid] = 0.6 * part[PART.length];
        buildParts();
        changed();
    };
    const remove = element('button', {type: 'button', textContent: 'Remove', disabled: state.parts.length === 1});
    remove.onclick = () => { state.parts.splice(index, 1); buildParts(); changed(); };
    const others = () => linkCount(state) - part[PART.count];
    const place = (i, label, unit, scale, least = 0) => slider({
        label, unit, scale, least, id: `part${index}-${Object.keys(PART)[i]}`, get: () => part[i], set: (x) => { part[i] = x; changed(); }}).box;
    const boxes = [
        slider({label: 'Links', id: `part${index}-count`, least: 1, scale: whole(1, () => Math.max(60, part[PART.count])), get: () => part[PART.count],
                set: (x) => { part[PART.count] = Math.max(1, Math.min(Math.round(x), MOST_LINKS - others())); changed(); }}).box,
        place(PART.mass, 'Mass of each', 'kg', logarithmic(part[PART.mass])),
        slider({label: 'Length of each', unit: 'm', id: `part${index}-length`, least: 1e-12, scale: logarithmic(part[PART.length]),
                get: () => part[PART.length], set: (x) => { setLength(part, x); changed(); }}).box,
    ];
    if (kind.value === 'body') {
        const span = 2 * part[PART.length];
        boxes.push(place(PART.centroid, 'Centre of gravity below the upper pin', 'm', linear(-span / 2, () => span), -Infinity));
        boxes.push(place(PART.gyration, 'Radius of gyration', 'm', linear(0, () => span)));
    }
    if (part[PART.momentum]) boxes.push(place(PART.momentum, 'Angular momentum of each wheel', 'kg m²/s', linear(-3 * Math.abs(part[PART.momentum]), () => 3 * Math.abs(part[PART.momentum])), -Infinity));
    if (part[PART.stands]) boxes.push(element('p', {textContent: 'These links stand on their upper pins.'}));
    const name = state.parts.length === 1 ? 'All links' : index === 0 ? 'Lowest' : `Part ${index + 1}`;
    return element('fieldset', {}, element('legend', {}, name, kind, ...(state.parts.length > 1 ? [remove] : [])), ...boxes);
}

function buildParts() {
    const fine = state.parts.length <= 4;
    const boxes = state.parts.map(partBox);
    $('parts').replaceChildren(...(fine ? boxes : [element('details', {}, element('summary', {textContent: plural(boxes.length, 'part')}), ...boxes)]));
    $('add').disabled = linkCount(state) >= MOST_LINKS;
}

// Asking -------------------------------------------------------------------------------------------------------------

/** Something in the state has changed. */
function changed({speed = false} = {}) {
    links = partOfLinks(state);
    if (!speed) {
        state.name = null;
        $('preset').value = '';
        modesStale = true;
    }
    ask();
    dirty = true;
    saveLink();
}

function ask() {
    const count = links.length;
    if (now) now.ask({task: 'now', ...structuredClone(state), ...REQUEST, modes: modesStale ? Math.min(count, 12) : 0});
}

function askDiagram() {
    if (!modes || !later) return;
    const below = modes.modes.filter((mode) => mode.speed > 0 && mode.speed < top).length;
    const branches = state.radius > 0 ? 1 : below;
    later.ask({task: 'diagram', ...structuredClone(state), ...REQUEST, top, branches: Math.min(branches, 12)});
}

/** The speeds that the slider and the diagram run to: past the fourth mode, but not so far that the first is lost. */
function reachOfSpeeds() {
    const forward = modes.modes.filter((mode) => mode.speed > 0).map((mode) => mode.speed);
    const last = forward[Math.min(forward.length, 4) - 1] ?? 2 * Math.sqrt(state.gravity / totalLength(state));
    const most = Math.min(1.5 * last, 8 * (forward[0] ?? last));
    return Math.max(Number(most.toPrecision(2)), 1.05 * (state.speed ?? 0));
}

function heardModes(part, request) {
    modes = {...part, links: partOfLinks(request)};
    modesStale = modesShown = false;
    top = reachOfSpeeds();
    if (state.speed === null) {
        const first = modes.modes.find((mode) => mode.speed > 0);
        state.speed = Number((1.15 * (first?.speed ?? top / 4)).toPrecision(3));
        now.ask({...request, modes: 0, speed: state.speed});
        saveLink();
    }
    askDiagram();
    speedSlider.show();
}

function heard({part, time, request}) {
    if (part.modes) heardModes(part.modes, request);
    if ('shapes' in part) {
        const links = partOfLinks(request);
        shapes = part.shapes;
        for (const shape of shapes?.shapes ?? []) shape.links = links;
        problem = '';
    }
    if (part.diagram) diagram = {...part.diagram, time};
    if (part.problem) {
        problem = part.problem;
        if (request.task === 'now') shapes = null;
    }
    choose();
    dirty = true;
}

// What is selected ---------------------------------------------------------------------------------------------------

/** The figure of a mode: a small motion is drawn with a sixth of the length, or as far as no link leans by 35 degrees. */
function figureOf(mode) {
    const {links} = modes, length = links.reduce((sum, link) => sum + link[PART.length], 0);
    const lean = links.map((link, m) => Math.abs(mode.offset[m] - mode.offset[m + 1]) / link[PART.length]);
    const size = Math.min(length / 6, 0.57 / Math.max(...lean));
    const offset = mode.offset.map((y) => y * size);
    return {...mode, links, offset, height: heightsOf(links, offset), halfWaves: mode.nodes.length + 1, isMode: true};
}

const straight = () => {
    const offset = new Float64Array(links.length + 1).fill(state.radius);
    return {links, offset, height: heightsOf(links, offset), halfWaves: 1, isStraight: true};
};

/** A shape of the new list that is nearest to the one selected before: with as many half waves, if there is one. */
function nearest(list) {
    const before = chosen && !chosen.isMode && !chosen.isStraight ? chosen : null;
    const index = /^s(\d+)$/.exec(state.select ?? '');
    if (!before) return list[Math.min(index ? Number(index[1]) - 1 : 0, list.length - 1)];
    const alike = list.filter((shape) => shape.halfWaves === before.halfWaves);
    const apart = (shape) => Math.abs(shape.offset[0] - before.offset[0]);
    return (alike.length ? alike : list).reduce((best, shape) => apart(shape) < apart(best) ? shape : best);
}

function choose() {
    const mode = /^m(\d+)$/.exec(state.select ?? '');
    if (mode && modes?.modes.length) {
        chosen = figureOf(modes.modes[Math.min(Number(mode[1]), modes.modes.length) - 1]);
    } else if (shapes?.shapes.length) {
        chosen = nearest(shapes.shapes);
        state.select = `s${shapes.shapes.indexOf(chosen) + 1}`;
    } else {
        chosen = straight();
    }
}

function select(what) {
    state.select = what;
    chosen = null;
    choose();
    dirty = true;
    modesShown = false;
    saveLink();
}

// Showing ------------------------------------------------------------------------------------------------------------

/** Text that has not changed is left alone: the browser then lays out nothing. */
function write(where, text) {
    if (where.textContent !== text) where.textContent = text;
}

function showCards(list, figures, describe, isChosen, key) {
    while (list.children.length > figures.length) list.lastChild.remove();
    while (list.children.length < figures.length) {
        const lines = [element('b'), ...Array.from({length: 3}, () => element('small'))];
        const card = element('button', {type: 'button', className: 'card'}, element('canvas'), ...lines);
        const index = list.children.length + 1;
        card.onclick = () => select(`${key}${index}`);
        list.append(card);
    }
    figures.forEach((figure, i) => {
        const card = list.children[i];
        card.ariaPressed = String(isChosen(figure, i));
        describe(figure, i).forEach((text, line) => write(card.children[line + 1], text));
        drawSide(card.firstChild, figure, waveColour(figure.halfWaves));
    });
}

function showShapes() {
    const list = shapes?.shapes ?? [];
    const said = $('shapes-said');
    if (problem) write(said, 'No shapes: see the message above.');
    else if (!shapes) write(said, 'Computing …');
    else if (!list.length && shapes.complete) write(said, 'At this speed the chain hangs straight: proved, it has no other shape.');
    else write(said, `${plural(list.length, 'shape')} at ${digits(state.speed)} rad/s. ${shapes.complete ? 'Proved: there are no others.' :
        'There may be others: the search ended at its limit, or the speed is that of a mode.'}${list.length > MOST_CARDS ? ` The first ${MOST_CARDS} are drawn.` : ''}`);
    showCards($('shape-list'), list.slice(0, MOST_CARDS), (shape) => [
        plural(shape.halfWaves, 'half wave'), `free end ${digits(Math.abs(shape.offset[0]))} m`, `error ≤ ${shortBound(shape.bound)} rad`,
        VERDICT_WORDS[shape.verdict] ?? '',
    ], (shape) => shape === chosen, 's');
}

function showModes() {
    if (!modes) return;
    const {forward, backward, other, growth} = modes;
    const sides = backward ? `${forward} forward and ${backward} backward modes` : plural(forward, 'mode');
    const growing = growth > 0 ? ` Straight it is unstable: a disturbance grows e-fold in ${digits(1 / growth, 3)} s.` : '';
    $('modes-said').textContent = `${sides}${other ? `, ${other} other solutions` : ''}.${growing} Bounds are relative${modes.complete ? ' and proved' : ''}.`;
    showCards($('mode-list'), modes.modes.map(figureOf), (mode) => [
        `${digits(Math.abs(mode.speed), 5)} rad/s`, `${digits(Math.abs(mode.speed) * 30 / Math.PI)} rpm${mode.speed < 0 ? ' backward' : ''}`,
        `error ≤ ${shortBound(mode.speedBound)}`, `mode ${mode.number}, ${plural(mode.nodes.length, 'node')}`,
    ], (mode, i) => state.select === `m${i + 1}`, 'm');
}

/** The farthest that a branch takes the free end, as far as chain and arm reach, or a shape of this speed. */
function reachOfTip() {
    const reach = totalLength(state) + state.radius;
    const branches = (diagram?.branches ?? []).map((branch) => Math.max(0, ...branch.tip.map(Math.abs)));
    const tips = (shapes?.shapes ?? []).map((shape) => Math.abs(shape.offset[0]));
    return 1.05 * Math.max(Math.min(Math.max(0, ...branches), reach), ...tips, 0.2 * reach);
}

function showDiagram() {
    const said = $('branches-said');
    if (!diagram) write(said, 'Computing …');
    else write(said, `${plural(diagram.branches.length, 'branch').replace('branchs', 'branches')} up to ${digits(top)} rad/s. ${diagram.complete ?
        'Proved: there are no others.' : 'Whether there are others is not proved.'} ●\u00a0stable, ○\u00a0not.`);
    drawDiagram($('diagram'), {branches: diagram?.branches ?? [], shapes: shapes?.shapes ?? [], selected: chosen, speed: state.speed ?? 0, top, reach: reachOfTip()});
}

function showCaption() {
    const caption = $('caption');
    if (!chosen || chosen.isStraight) caption.textContent = shapes?.complete ? 'The chain hangs straight at this speed.' : `${plural(links.length, 'link')}, ${digits(totalLength(state))} m`;
    else if (chosen.isMode) caption.textContent = `Small motion at ${digits(chosen.speed, 8)} rad/s, drawn large. Relative error of the speed at most ${shortBound(chosen.speedBound)}: proved.`;
    else {
        const stable = chosen.verdict ? ` ${{minimum: 'Stable, also with friction.', 'spectrally stable': 'Stable, but friction at the pins may destroy it.',
            unstable: `Unstable: a disturbance grows e-fold in ${digits(1 / (chosen.growth * state.speed), 3)} s.`, undecided: 'Stability not decided.'}[chosen.verdict]}` : '';
        const weight = chosen.tension * state.gravity;
        caption.textContent = `Free end ${digits(chosen.offset[0], 6)} m from the axis; pull at the support ${digits(weight)} N. Every angle is within ${shortBound(chosen.bound)} rad: proved.${stable}`;
    }
}

function show() {
    dirty = false;
    $('problem').hidden = !problem;
    $('problem').textContent = problem;
    showShapes();
    if (!modesShown) showModes();
    modesShown = true;
    showDiagram();
    showCaption();
    $('timing').textContent = engine ? `Shapes took ${digits(shapes?.time ?? 0, 2)} ms, branches ${digits(diagram?.time ?? 0, 2)} ms${engine.fast ? '' : ', without SIMD'}.` : '';
}

/** How many times slower than true the picture turns. */
function slowness(speed) {
    const given = $('slowness').value;
    return given === 'auto' ? Math.max(1, 2 ** Math.ceil(Math.log2(Math.abs(speed) / 4 || 1))) : Number(given);
}

let lastFrame = null, settle = true;
function frame(time) {
    requestAnimationFrame(frame);
    const speed = chosen?.isMode ? chosen.speed : state.speed ?? 0, slow = slowness(speed);
    if (playing && lastFrame !== null) angle = (angle + speed / slow * Math.min(0.1, (time - lastFrame) / 1000)) % (2 * Math.PI);
    lastFrame = time;
    if (dirty) {
        show();
        $('scale').textContent = `${digits(speed)} rad/s = ${digits(speed * 30 / Math.PI)} rpm${slow > 1 ? `, ${slow} times slower` : ''}`;
    }
    drawSpace($('view'), state.radius, chosen ?? straight(), angle, settle);
    settle = false;
    mark('picture');
    if (modes && !dirty) mark('modes');
}

/** The first time of something, for measurements (tests/web/measure.py). */
const mark = (name) => performance.getEntriesByName(name).length || performance.mark(name);

// Start --------------------------------------------------------------------------------------------------------------

let saving = 0;
function saveLink() {
    clearTimeout(saving);
    saving = setTimeout(() => history.replaceState(null, '', `#${toLink(state)}`), 250);
}

function open(given) {
    state = given;
    modes = shapes = diagram = chosen = null;
    modesStale = true;
    problem = '';
    links = partOfLinks(state);
    $('preset').value = state.name ?? '';
    settle = true;
    buildSliders();
    buildParts();
    ask();
    saveLink();
    dirty = true;
}

function openLink() {
    try {
        open(fromLink(location.hash.slice(1)) ?? presetState('swing_carousel'));
    } catch (wrong) {
        open(presetState('swing_carousel'));
        problem = wrong.message;
    }
}

function dragged(canvas, move) {
    canvas.onpointerdown = (event) => {
        canvas.setPointerCapture(event.pointerId);
        move(event, true);
    };
    canvas.onpointermove = (event) => { if (event.buttons) move(event, false); };
}

function listen() {
    $('preset').replaceChildren(element('option', {value: '', textContent: 'Your own chain', disabled: true}),
        ...presets.map(({name, title}) => element('option', {value: name, textContent: title})));
    $('preset').onchange = () => open(presetState($('preset').value));
    $('add').onclick = () => { state.parts.unshift([1, ...state.parts[0].slice(1)]); buildParts(); changed(); };
    $('play').onclick = () => {
        playing = !playing;
        $('play').textContent = playing ? 'Pause' : 'Turn';
        $('play').ariaPressed = String(playing);
    };
    $('slowness').onchange = () => { dirty = true; };
    $('share').onclick = async () => {
        history.replaceState(null, '', `#${toLink(state)}`);
        try {
            await navigator.clipboard.writeText(location.href);
            $('share').textContent = 'Copied';
        } catch {
            $('share').textContent = 'Copy it from the address bar';
        }
        setTimeout(() => { $('share').textContent = 'Copy link'; }, 2000);
    };
    let held = null;
    dragged($('view'), (event, first) => {
        if (!first && held) {
            eye.yaw += (event.clientX - held[0]) / 150;
            eye.pitch = Math.max(-1.5, Math.min(1.5, eye.pitch + (event.clientY - held[1]) / 200));
        }
        held = [event.clientX, event.clientY];
    });
    $('view').onkeydown = ({key}) => {
        eye.yaw += {ArrowLeft: -0.1, ArrowRight: 0.1}[key] ?? 0;
        eye.pitch = Math.max(-1.5, Math.min(1.5, eye.pitch + ({ArrowUp: 0.1, ArrowDown: -0.1}[key] ?? 0)));
    };
    const setSpeed = (speed) => {
        state.speed = Number(speed.toPrecision(4));
        speedSlider.show();
        changed({speed: true});
    };
    dragged($('diagram'), (event, first) => {
        const box = $('diagram').getBoundingClientRect(), reach = reachOfTip(), scale = diagramScale(box, top, reach);
        const x = event.clientX - box.left, y = event.clientY - box.top;
        const near = (shapes?.shapes ?? []).findIndex((shape) =>
            Math.hypot(x - scale.x(state.speed), y - scale.y(Math.abs(shape.offset[0]))) < 14);
        if (first && near >= 0) select(`s${near + 1}`);
        else setSpeed(scale.speed(x));
    });
    $('diagram').onkeydown = ({key}) => {
        const step = {ArrowLeft: -1, ArrowRight: 1}[key];
        if (step) setSpeed(Math.max(0, state.speed + step * top / 200));
    };
    window.onhashchange = openLink;
    window.onresize = () => { sizes.clear(); dirty = true; modesShown = false; };
    matchMedia('(prefers-color-scheme: dark)').onchange = () => { readColours(); dirty = true; modesShown = false; };
}

async function start() {
    readColours();
    listen();
    openLink();
    requestAnimationFrame(frame);
    try {
        engine = await loadEngine(new URLSearchParams(location.search).has('plain'));
    } catch (wrong) {
        problem = `The page cannot compute: ${wrong.message}.`;
        dirty = true;
        return;
    }
    now = new Asker(engine, 400, heard);
    later = new Asker(engine, 100, heard);
    ask();
}

/** For tests: what is known once nothing is being computed. */
window.settled = async () => {
    while (!now || now.busy || later.busy) await new Promise((done) => setTimeout(done, 5));
    return {state, modes, shapes, diagram, problem, top, fast: engine.fast};
};

start();
