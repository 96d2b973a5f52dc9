// SPDX-License-Identifier: MPL-2.0
// The page itself: sliders, cards, what is selected, and the picture that turns.

const $ = (id) => document.getElementById(id);
const MOST_CARDS = 60;
const VERDICT_WORDS = {
    minimum: 'stable',
    'spectrally stable': 'friction may upset it',
    unstable: 'unstable',
    undecided: 'stability open',
};
const CROSSINGS = ['', 'crosses the axis once', 'crosses the axis twice'];
/** The free end of a chain by the form of its lowest link. */
const ENDS = {seat: 'chair', crate: 'load', jar: 'jar', clapper: 'clapper'};
/** Where questions take too long for a slider: links of a chain whose shapes are listed, whose stability is computed and
 * whose diagram is proved. */
const REQUEST = {mostLinks: 200, mostJudged: 50, budget: 4e5, proofLinks: 24, lists: 16, listBudget: 3e6, proofBudget: 1e6}; // as in Python

let state,
    links,
    modes = null,
    shapes = null,
    diagram = null,
    problem = '',
    refused = ''; // why a link was not opened: said until something changes
let chosen = null; // the mode or the shape that turns: a figure with offset and height
let modesStale = true; // asked for again with the next request
let modesShown = false;
let angle = 0,
    playing = true,
    dirty = true,
    top = 10,
    now = null,
    later = null,
    engine = null;

// Asking -------------------------------------------------------------------------------------------------------------

/** Something in the state has changed. */
function changed({speed = false} = {}) {
    refused = '';
    links = partOfLinks(state);
    if (!speed) {
        if (state.name) {
            state.name = null;
            showStory();
        }
        $('preset').value = '';
        modesStale = true;
    } else if (state.select?.startsWith('m')) {
        state.select = null; // a mode has its own speed
        modesShown = false;
    }
    ask();
    dirty = true;
    saveLink();
}

function ask() {
    const count = links.length;
    if (now) now.ask({task: 'now', ...structuredClone(state), ...REQUEST, modes: modesStale ? Math.min(count + 1, 12) : 0});
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
    modes = {...part, links: partOfLinks(request), forms: formOfLinks(request)};
    modesStale = modesShown = false;
    top = reachOfSpeeds();
    if (state.speed === null) {
        const first = modes.modes.find((mode) => mode.speed > 0);
        const factor = UNITS[state.unit];
        const part = state.radius ? 0.85 : 1.15; // a carried chain swings out before its first mode
        state.speed = Number((part * factor * (first?.speed ?? top / 4)).toPrecision(3)) / factor;
        now.ask({...request, modes: 0, speed: state.speed});
        saveLink();
    }
    askDiagram();
}

function heard({part, time, request}) {
    if (part.modes) heardModes(part.modes, request);
    if ('shapes' in part) {
        const of = {links: partOfLinks(request), forms: formOfLinks(request)};
        shapes = part.shapes;
        for (const shape of shapes?.shapes ?? []) Object.assign(shape, of);
        problem = '';
    }
    if (part.diagram) diagram = {...part.diagram, time};
    $('proving').hidden = !(diagram?.tries && later?.busy);
    if (part.problem) {
        problem = part.problem;
        if (request.task === 'now') shapes = null;
    }
    choose();
    dirty = true;
}

// What is selected ---------------------------------------------------------------------------------------------------

/** The figure of a mode: heights of the straight chain, offsets of a quarter of its length at most; where links are few,
 * none leans by more than 45 degrees. */
function figureOf(mode) {
    const {links, forms, backward} = modes,
        length = links.reduce((sum, link) => sum + link[PART.length], 0);
    const lean = links.map((link, m) => Math.abs(mode.offset[m] - mode.offset[m + 1]) / link[PART.length]);
    const size = Math.min(length / 4, links.length > 12 ? Infinity : 1 / Math.max(...lean));
    const offset = mode.offset.map((y) => y * size);
    const height = heightsOf(links, new Float64Array(offset.length));
    const name = `Mode ${mode.number}${backward ? (mode.speed < 0 ? ' backward' : ' forward') : ''}`;
    const halfWaves = backward ? 1 + (mode.speed < 0) : mode.nodes.length + 1; // which chooses the colour
    return {...mode, name, links, forms, offset, height, halfWaves, isMode: true};
}

/** The speed of the mode that is shown; null while a shape is shown. */
const speedOfMode = () => (chosen?.isMode && state.select?.startsWith('m') ? Math.abs(chosen.speed) : null);
/** The free end in words. */
const endName = () => ENDS[state.forms[0]] ?? (links[0][PART.stands] ? 'upper end' : 'free end');

const straight = () => {
    const offset = new Float64Array(links.length + 1).fill(state.radius);
    return {links, forms: formOfLinks(state), offset, height: heightsOf(links, offset), halfWaves: 1, isStraight: true};
};

/** A shape of the new list that is nearest to the one selected before: with as many half waves, if there is one. */
function nearest(list) {
    const before = chosen && !chosen.isMode && !chosen.isStraight ? chosen : null;
    const index = /^s(\d+)$/.exec(state.select ?? '');
    if (!before) return list[Math.min(index ? Number(index[1]) - 1 : 0, list.length - 1)];
    const alike = list.filter((shape) => shape.halfWaves === before.halfWaves);
    const apart = (shape) => Math.abs(shape.offset[0] - before.offset[0]);
    return (alike.length ? alike : list).reduce((best, shape) => (apart(shape) < apart(best) ? shape : best));
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
    angle = 0; // as in the cards
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
        const picture = svgElement(`0 0 ${CARD.join(' ')}`);
        const card = element('button', {type: 'button', className: 'card'}, picture, ...lines);
        const index = list.children.length + 1;
        card.onclick = () => select(`${key}${index}`);
        list.append(card);
    }
    figures.forEach((figure, i) => {
        const card = list.children[i];
        card.ariaPressed = String(isChosen(figure, i));
        describe(figure, i).forEach((text, line) => write(card.children[line + 1], text));
        drawSide(card.firstChild, figure);
    });
}

/** A speed in the unit that was chosen, or in another one. */
const inUnit = (speed, n = 4, unit = state.unit) => `${digits(speed * UNITS[unit], n)} ${unit}`;

function showShapes() {
    const list = shapes?.shapes ?? [];
    const said = $('shapes-said');
    write($('shapes-title'), `Shapes that it keeps at ${speedOfMode() ? inUnit(state.speed) : 'this speed'}`);
    if (problem) write(said, 'No shapes: see the message above.');
    else if (!shapes) write(said, links.length > REQUEST.mostLinks ? 'Too many links for this page.' : 'Computing …');
    else if (!list.length && shapes.complete) write(said, 'None: at this speed it hangs straight. Proved.');
    else
        write(
            said,
            `${plural(list.length, 'shape')} at ${inUnit(state.speed)}${state.radius > 0 ? '' : ', beside the straight one'}${
                shapes.complete
                    ? '. Proved: at this speed there are no others.'
                    : '. There may be others: the search ended at its limit, the speed is that of a mode, or a link can leave the plane.'
            }${list.length > MOST_CARDS ? ` The first ${MOST_CARDS} are drawn.` : ''}`,
        );
    showCards(
        $('shape-list'),
        list.slice(0, MOST_CARDS),
        (shape, i) => [
            `Shape ${i + 1}`,
            `${digits(Math.abs(shape.offset[0]), 3)} m off axis`,
            CROSSINGS[shape.halfWaves - 1] ?? `crosses the axis ${shape.halfWaves - 1} times`,
            VERDICT_WORDS[shape.verdict] ?? '',
        ],
        (shape) => shape === chosen,
        's',
    );
}

function showModes() {
    if (!modes) return;
    const {forward, backward, other, growth} = modes;
    const all = backward ? `${forward} forward and ${backward} backward modes` : plural(forward, 'mode');
    const sides = forward + backward ? all : 'No mode keeps turning';
    const growing =
        growth > 0 ? ` Straight, it is unstable: a small push doubles every ${digits(Math.LN2 / growth, 2)} s.` : '';
    const others = other ? `; ${plural(other, 'motion')} ${other === 1 ? 'grows or dies' : 'grow or die'} away instead` : '';
    const node = ` A node is a point that stays ${state.radius ? 'where it hangs' : 'on the axis'}.`;
    $('modes-said').textContent = `${sides}${others}.${modes.modes.length ? node : ''}${growing}`;
    const second = state.unit === 'rpm' ? 'rad/s' : 'rpm';
    showCards(
        $('mode-list'),
        modes.modes.map(figureOf),
        (mode) => [
            mode.name,
            inUnit(Math.abs(mode.speed)),
            inUnit(Math.abs(mode.speed), 4, second),
            plural(mode.nodes.length, 'node'),
        ],
        (mode, i) => state.select === `m${i + 1}`,
        'm',
    );
}

/** Marks the speeds of modes on the slider of the speed. */
function markSpeeds() {
    const speeds = (modes?.modes ?? []).map((mode) => mode.speed).filter((speed) => speed > 0 && speed <= top);
    const places = speeds.map((speed) => digits((1000 * speed) / top));
    if ($('mode-speeds').dataset.places === places.join()) return;
    $('mode-speeds').dataset.places = places.join();
    $('marks').hidden = !places.length;
    $('mode-speeds').replaceChildren(...places.map((value) => element('option', {value})));
}

/** The farthest that a branch takes the free end, as far as chain and arm reach, or a shape of this speed. */
function reachOfTip() {
    const reach = totalLength(state) + state.radius;
    const branches = (diagram?.branches ?? []).map((branch) => Math.max(0, ...branch.tip.map(Math.abs)));
    const tips = (shapes?.shapes ?? []).map((shape) => Math.abs(shape.offset[0]));
    return 1.05 * Math.max(Math.min(Math.max(0, ...branches), reach), ...tips, 0.2 * reach);
}

function showDiagram() {
    markSpeeds();
    const said = $('branches-said');
    if (!diagram) write(said, 'Computing …');
    else
        write(
            said,
            `${diagram.branches.length === 1 ? '1 family' : `${diagram.branches.length} families`} of shapes up to ${inUnit(top)}${wordsOf(diagram)}${links.length > REQUEST.mostJudged ? '' : ' ● stable, ○ not.'} Click or use the arrow keys.`,
        );
    const [ariaValueNow, ariaValueMax] = [state.speed ?? 0, top].map((speed) => digits(speed * UNITS[state.unit]));
    Object.assign($('diagram'), {ariaValueNow, ariaValueMax, ariaValueText: inUnit(state.speed ?? 0)});
    drawDiagram($('diagram'), {
        branches: diagram?.branches ?? [],
        shapes: shapes?.shapes ?? [],
        selected: chosen,
        speed: state.speed ?? 0,
        top,
        reach: reachOfTip(),
        unit: state.unit,
        end: endName(),
    });
}

/** What is known about a diagram: proved, being proved, tried in vain, or not tried. */
function wordsOf({complete, tried, tries}) {
    if (complete) return '. Proved: over all these speeds there are no others.';
    if (tried) return '. Over the whole range of speeds it is not proved that there are no more: the proof does not cover this chain.';
    if (tries) return '. Proving that there are no more …';
    return `. There may be more: this page tries a proof up to ${REQUEST.proofLinks} links.`;
}

/** What is known of a shape's stability, as a sentence. */
function stabilityOf({verdict, growth, links}) {
    if (links.length > REQUEST.mostJudged) return `Its stability is not computed: it has more than ${REQUEST.mostJudged} links.`;
    if (verdict === 'unstable')
        return `Unstable: a small push doubles every ${digits(Math.LN2 / (growth * Math.abs(state.speed)), 2)} s.`;
    if (verdict === 'minimum') return 'Stable: after a small push it stays near this shape, with friction at the pins, too.';
    if (verdict === 'spectrally stable') return 'Stable only without friction: friction at the pins may upset it.';
    return verdict === 'undecided' ? 'Whether it is stable could not be decided.' : '';
}

function captionOf(figure) {
    if (figure.isMode) {
        const speed = Math.abs(figure.speed);
        const drawn = state.radius ? 'drawn enlarged, from where it hangs' : 'drawn enlarged';
        return `${figure.name}: a small motion at ${inUnit(speed)}, ${drawn}. One turn takes ${digits((2 * Math.PI) / speed, 3)} s.`;
    }
    if (figure.isStraight) {
        const first = modes?.modes.find((mode) => mode.speed > 0)?.speed;
        const wait = first > (state.speed ?? 0) ? ` It swings out above ${inUnit(first)}.` : '';
        return shapes?.complete
            ? `It hangs straight at this speed.${wait}`
            : `${plural(figure.links.length, 'link')}, ${digits(totalLength(state), 3)} m.`;
    }
    const circle = `The ${endName()} moves on a circle of radius ${digits(Math.abs(figure.offset[0]), 3)} m`;
    const push = figure.links.at(-1)[PART.stands] ? 'push' : 'pull';
    const pull = `the ${push} on the support is ${digits(Math.abs(figure.tension) * state.gravity, 3)} N`;
    return `${circle}; ${pull}. ${stabilityOf(figure)}`;
}

/** How exact the numbers are, in plain words. */
function boundOf(figure) {
    const proof = 'It is proved each time anew, with interval arithmetic, for the numbers of this page exactly as they stand.';
    const last = (bound) => (bound < 1e-14 ? ': to the last digit or two that the computer’s numbers have' : '');
    if (figure.isMode)
        return Number.isFinite(figure.speedBound)
            ? `The speed of this mode is off by at most ${shortBound(figure.speedBound)} of itself${last(figure.speedBound)}. ${proof}`
            : 'The error of this speed has no proved bound.';
    if (figure.isStraight) return 'That there is no other shape is proved with interval arithmetic.';
    return Number.isFinite(figure.bound)
        ? `Every angle of this shape is off by at most ${shortBound(figure.bound)} rad${last(figure.bound)}. ${proof}`
        : 'The error of this shape has no proved bound.';
}

/** The sentence of the example and what can be tried with it; nothing for a chain of one's own. */
function showStory() {
    const preset = presets.find((each) => each.name === state.name);
    $('story').hidden = !preset;
    const written = `${state.name} ${state.unit}`;
    if (!preset || $('story').dataset.written === written) return; // a button that has the focus stays
    $('story').dataset.written = written;
    const worded = (text) => text.replace(/\{([\d.]+)\}/g, (_, speed) => inUnit(Number(speed), 3));
    write($('says'), worded(preset.says));
    const tries = preset.tries.map((one) => {
        const button = element('button', {type: 'button', textContent: worded(one.text)});
        button.onclick = () =>
            open({...presetState(preset.name), unit: state.unit, speed: one.speed ?? null, select: one.select ?? null});
        return button;
    });
    $('tries').replaceChildren(element('span', {textContent: 'Try this:'}), ...tries);
}

function show() {
    dirty = false;
    $('problem').hidden = !(problem || refused);
    $('problem').textContent = problem || refused;
    speedSlider.show();
    showShapes();
    if (!modesShown) showModes();
    modesShown = true;
    showDiagram();
    write($('caption'), captionOf(chosen ?? straight()));
    write($('bound'), boundOf(chosen ?? straight()));
    $('timing').textContent = engine
        ? `Shapes took ${digits(shapes?.time ?? 0, 2)} ms, branches ${digits(diagram?.time ?? 0, 2)} ms${engine.fast ? '' : ', without SIMD'}.`
        : '';
}

/** Playback over real time: slow enough to be followed, times what the slider says. */
function playbackOf(speed) {
    return 10 ** $('pace').value / Math.max(1, 2 ** Math.ceil(Math.log2(Math.abs(speed) / 4 || 1)));
}

function paceWords(playback) {
    if (Math.abs(playback - 1) < 1e-9) return 'in real time';
    return `${digits(Math.max(playback, 1 / playback), 3)} times ${playback < 1 ? 'slower' : 'faster'} than real time`;
}

let lastFrame = null,
    stage = null,
    staged = null, // the figure on the stage
    settle = true;
function frame(time) {
    requestAnimationFrame(frame);
    const speed = chosen?.isMode ? chosen.speed : (state.speed ?? 0),
        playback = playbackOf(speed);
    if (settle) angle = 0; // what is seen first lies in the plane of the picture
    else if (playing && lastFrame !== null)
        angle = (angle + speed * playback * Math.min(0.1, (time - lastFrame) / 1000)) % (2 * Math.PI);
    lastFrame = time;
    if (dirty) {
        show();
        write($('playback'), `×${digits(10 ** $('pace').value, 2)}`);
        write($('scale'), paceWords(playback));
    }
    chosen ??= straight();
    if (stage && staged !== chosen) putOnStage(stage, state, chosen, speed, settle);
    if (stage) {
        const [figure] = stage.figures;
        figure.turning.rotation.y = figure.trail.rotation.y = angle;
        if (playing || stage.stale) stage.draw();
    }
    staged = chosen;
    settle &&= chosen.isStraight && !shapes && !problem;
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
    problem = refused = '';
    links = partOfLinks(state);
    $('preset').value = state.name ?? '';
    settle = true;
    buildSliders();
    buildParts();
    showStory();
    ask();
    saveLink();
    dirty = true;
}

function openLink() {
    try {
        open(fromLink(location.hash.slice(1)) ?? presetState('swing_carousel'));
    } catch (wrong) {
        open(presetState('swing_carousel'));
        refused = wrong.message;
    }
}

/** Copy a link to what is shown, or the same chain as a program or a scene file. */
async function copy(button) {
    const what = button.dataset.copy,
        words = button.textContent;
    history.replaceState(null, '', `#${toLink(state)}`);
    const text = {link: () => location.href, python: () => toPython(state), scene: () => toScene(state)}[what]();
    try {
        await navigator.clipboard.writeText(text);
        button.textContent = 'Copied';
    } catch {
        window.prompt('Copy this:', text);
    }
    setTimeout(() => {
        button.textContent = words;
        closeMenu();
    }, 1200);
}

function closeMenu() {
    const menu = $('copy');
    if (menu.contains(document.activeElement)) menu.firstElementChild.focus();
    menu.open = false;
}

function play(on) {
    playing = on;
    $('play').textContent = on ? 'Pause' : 'Play';
}

function dragged(canvas, move) {
    canvas.onpointerdown = (event) => {
        canvas.setPointerCapture(event.pointerId);
        move(event, true);
    };
    canvas.onpointermove = (event) => {
        if (event.buttons) move(event, false);
    };
}

function listen() {
    const optionsOf = (label) =>
        presets
            .filter(({group}) => group === label)
            .map(({name, title}) => element('option', {value: name, textContent: title}));
    $('preset').replaceChildren(
        element('option', {value: '', textContent: 'Your own chain', disabled: true}),
        ...[...new Set(presets.map(({group}) => group))].map((label) => element('optgroup', {label}, ...optionsOf(label))),
    );
    $('preset').onchange = () => open(presetState($('preset').value));
    $('add').onclick = () => {
        state.parts.unshift([1, ...state.parts[0].slice(1)]);
        state.forms.unshift('');
        buildParts();
        changed();
    };
    play(!matchMedia('(prefers-reduced-motion: reduce)').matches);
    $('play').onclick = () => play(!playing);
    $('pace').oninput = () => {
        dirty = true;
    };
    $('reset').onclick = () => stage?.arrange(true);
    for (const button of document.querySelectorAll('[data-copy]')) button.onclick = () => copy(button);
    $('copy').onkeydown = ({key}) => {
        if (key === 'Escape') closeMenu();
    };
    for (const event of ['pointerdown', 'focusin'])
        document.addEventListener(event, ({target}) => {
            if (!$('copy').contains(target)) $('copy').open = false;
        });
    $('docs').hidden = !location.pathname.includes('/live/');
    const setSpeed = (speed) => {
        state.speed = rounded(speed, UNITS[state.unit]);
        changed({speed: true});
    };
    dragged($('diagram'), (event, first) => {
        const box = $('diagram').getBoundingClientRect(),
            reach = reachOfTip(),
            scale = diagramScale(top, reach);
        const x = ((event.clientX - box.left) * DIAGRAM.width) / box.width,
            y = ((event.clientY - box.top) * DIAGRAM.height) / box.height;
        const near = (shapes?.shapes ?? []).findIndex(
            (shape) => Math.hypot(x - scale.x(state.speed), y - scale.y(Math.abs(shape.offset[0]))) < 14,
        );
        if (first && near >= 0) select(`s${near + 1}`);
        else setSpeed(scale.speed(x));
    });
    $('diagram').onkeydown = ({key}) => {
        const step = {ArrowLeft: -1, ArrowRight: 1}[key];
        if (step) setSpeed(Math.max(0, state.speed + (step * top) / 200));
    };
    window.onhashchange = openLink;
    matchMedia('(prefers-color-scheme: dark)').onchange = () => {
        staged = null; // its colours are those of the page
    };
}

async function start() {
    stage = stageIn($('view'));
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

/** For tests: what `copy` copies. */
window.copied = (what) => ({python: toPython, scene: toScene})[what](state);
/** For tests: what is known once nothing is being computed. */
window.settled = async () => {
    while (!now || now.busy || later.busy) await new Promise((done) => setTimeout(done, 5));
    return {state, modes, shapes, diagram, problem: problem || refused, top, angle, fast: engine.fast};
};

start();
