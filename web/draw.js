// SPDX-License-Identifier: MPL-2.0
// Pictures: the chain in space (three.js), a shape from the side and the diagram of branches on canvases.

const COLOURS = ['paper', 'card', 'ink', 'soft', 'line', 'accent', 'w1', 'w2', 'w3', 'w4', 'w5', 'w6'];
let colour = {};
function readColours() {
    const style = getComputedStyle(document.documentElement);
    colour = Object.fromEntries(COLOURS.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}
const waveColour = (halfWaves) => colour[`w${((halfWaves - 1) % 6) + 1}`];

/** Sizes of canvases, read once: reading one makes the browser lay out the page. Emptied when the window changes. */
const sizes = new Map();
function sizeOf(canvas) {
    if (!sizes.has(canvas)) sizes.set(canvas, [canvas.clientWidth, canvas.clientHeight]);
    return sizes.get(canvas);
}

/** A canvas cleared, at the resolution of the screen, with lengths in CSS pixels. */
function paper(canvas) {
    const [width, height] = sizeOf(canvas),
        ratio = window.devicePixelRatio || 1;
    const wide = Math.round(width * ratio),
        high = Math.round(height * ratio);
    if (canvas.width !== wide || canvas.height !== high) [canvas.width, canvas.height] = [wide, high];
    const pen = canvas.getContext('2d');
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    return {pen, width, height};
}

function line(pen, points, style, width = 1, dash = []) {
    pen.beginPath();
    for (const [x, y] of points) pen.lineTo(x, y);
    pen.strokeStyle = style;
    pen.lineWidth = width;
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
}

function dot(pen, [x, y], radius, style, hollow = false) {
    pen.beginPath();
    pen.arc(x, y, radius, 0, 2 * Math.PI);
    pen.fillStyle = hollow ? colour.card : style;
    pen.fill();
    if (!hollow) return;
    pen.strokeStyle = style;
    pen.lineWidth = 1.8;
    pen.stroke();
}

/** Pins of a chain that is bent by so much: offsets as given, heights so that every link keeps its length. */
function heightsOf(links, offset) {
    const height = new Float64Array(offset.length);
    for (let m = links.length - 1; m >= 0; --m) {
        const length = links[m][PART.length],
            across = Math.min(Math.abs(offset[m] - offset[m + 1]), length);
        height[m] = height[m + 1] - Math.sqrt(length * length - across * across) * (links[m][PART.stands] ? -1 : 1);
    }
    return height;
}

/** Where the mass of each link sits, as [offset, height, size 0 to 1]; none for what is drawn as a plain line. */
function massesOf(links, {offset, height}) {
    const heaviest = Math.max(...links.map((link) => link[PART.mass]));
    return links.flatMap((link, m) => {
        if (kindOf(link) === 'rod' || link[PART.mass] === 0) return [];
        const down = link[PART.centroid] / link[PART.length],
            between = (list) => list[m + 1] + down * (list[m] - list[m + 1]);
        return [[between(offset), between(height), Math.cbrt(link[PART.mass] / heaviest)]];
    });
}

/** The stage in an element, shared with the pages of the package; null where the browser has no WebGL. */
function stageIn(element) {
    try {
        const stage = new viewer.Stage(element);
        Object.assign(stage.controls, {enableZoom: false, enablePan: false}); // wheel and fingers scroll the page
        stage.canvas.style.touchAction = 'pan-y';
        stage.canvas.ariaLabel = element.getAttribute('aria-label');
        stage.canvas.onkeydown = (event) => {
            if (stage.key(event.key)) event.preventDefault();
        };
        return stage;
    } catch {
        element.textContent = 'This picture needs WebGL, which this browser does not have or has switched off.';
        return null;
    }
}

/** The chain `figure` {links, offset, height, halfWaves} on the stage, with its support and its arm. */
function putOnStage(stage, arm, figure, afresh) {
    const pins = Array.from(figure.offset, (r, i) => [r, figure.height[i]]);
    const [floor, top] = [Math.min(0, ...figure.height), Math.max(0, ...figure.height)];
    const shown = viewer.chainFigure({
        pins,
        bodies: massesOf(figure.links, figure),
        arm,
        top,
        floor,
        colour: waveColour(figure.halfWaves),
    });
    stage.show([shown], viewer.extentOf([shown]));
    stage.arrange(afresh);
}

const CARD = [124, 92]; // CSS pixels, as in page.css

/** A shape from the side, in a card. */
function drawSide(canvas, figure, style) {
    sizes.set(canvas, CARD);
    const {pen, width, height} = paper(canvas);
    const ends = (list) => [Math.min(0, ...list), Math.max(0, ...list)];
    const [left, right] = ends(figure.offset),
        [bottom, top] = ends(figure.height);
    const scale = Math.min((width - 14) / (right - left || 1), (height - 14) / (top - bottom || 1));
    const at = (r, z) => [width / 2 + scale * (r - (left + right) / 2), 7 + scale * (top - z)];
    line(pen, [at(0, top), [at(0, 0)[0], height - 4]], colour.line);
    pen.lineJoin = 'round';
    line(
        pen,
        Array.from(figure.offset, (r, i) => at(r, figure.height[i])),
        style,
        2,
    );
    dot(pen, at(figure.offset.at(-1), figure.height.at(-1)), 2.5, colour.ink);
}

/** Round numbers from 0 to `most`. */
function ticks(most, wanted) {
    const rough = most / wanted,
        power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((digit) => digit * power).find((each) => each >= rough);
    return Array.from({length: Math.floor(most / step + 1e-9) + 1}, (_, i) => Number((i * step).toPrecision(6)));
}

const MARGIN = {left: 46, right: 12, top: 12, bottom: 36};

/** Places of the diagram: from speeds and radii to pixels and back. */
function diagramScale({width, height}, top, reach) {
    const wide = width - MARGIN.left - MARGIN.right,
        high = height - MARGIN.top - MARGIN.bottom;
    return {
        x: (speed) => MARGIN.left + (wide * speed) / top,
        y: (radius) => MARGIN.top + high * (1 - radius / reach),
        speed: (x) => top * Math.min(1, Math.max(0, (x - MARGIN.left) / wide)),
        radius: (y) => reach * (1 - (y - MARGIN.top) / high),
    };
}

const isStable = (shape) => shape.verdict === 'minimum' || shape.verdict === 'spectrally stable';

/** Distance of the free end from the axis against speed. Filled dots: stable shapes; hollow ones: others. */
function drawDiagram(canvas, {branches, shapes, selected, speed, top, reach}) {
    const {pen, width, height} = paper(canvas),
        {x, y} = diagramScale({width, height}, top, reach);
    pen.font = '12px system-ui, sans-serif';
    pen.fillStyle = colour.soft;
    pen.textAlign = 'center';
    for (const tick of ticks(top, width / 90)) {
        line(
            pen,
            [
                [x(tick), y(0)],
                [x(tick), y(reach)],
            ],
            colour.line,
        );
        pen.fillText(tick, x(tick), height - 20);
    }
    pen.fillText('speed (rad/s)', (MARGIN.left + width) / 2, height - 5);
    pen.textAlign = 'right';
    for (const tick of ticks(reach, height / 60)) {
        line(
            pen,
            [
                [x(0), y(tick)],
                [x(top), y(tick)],
            ],
            colour.line,
        );
        pen.fillText(tick, MARGIN.left - 6, y(tick) + 4);
    }
    pen.save();
    pen.translate(11, height / 2 - 10);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = 'center';
    pen.fillText('free end from axis (m)', 0, 0);
    pen.restore();
    pen.lineJoin = 'round';
    pen.save();
    pen.beginPath();
    pen.rect(x(0), y(reach), x(top) - x(0), y(0) - y(reach));
    pen.clip();
    for (const branch of branches)
        for (let from = 0; from + 1 < branch.speed.length;) {
            let to = from + 1;
            while (to + 1 < branch.speed.length && branch.halfWaves[to] === branch.halfWaves[to + 1]) ++to;
            const places = [];
            for (let i = from; i <= to; ++i) places.push([x(branch.speed[i]), y(Math.abs(branch.tip[i]))]);
            line(pen, places, waveColour(branch.halfWaves[to]), 1.8);
            from = to;
        }
    pen.restore();
    line(
        pen,
        [
            [x(speed), y(0)],
            [x(speed), y(reach)],
        ],
        colour.accent,
        1.2,
        [5, 4],
    );
    for (const shape of shapes) {
        const place = [x(speed), y(Math.abs(shape.offset[0]))];
        dot(
            pen,
            place,
            shape === selected ? 6 : 4,
            waveColour(shape.halfWaves),
            shape.verdict !== null && !isStable(shape),
        );
    }
}
