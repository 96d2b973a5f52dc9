// SPDX-License-Identifier: MPL-2.0
// Pictures: the chain in space (three.js), a shape from the side and the diagram of branches (SVG).

const AXIS = 'stroke-dasharray="8 3 1.5 3"';
const waveName = (halfWaves) => `--w${((halfWaves - 1) % 6) + 1}`;
const waveColour = (halfWaves) => `var(${waveName(halfWaves)})`;

/** Elements of SVG as text; points are [x, y]. */
const pointsOf = (points) => points.map(([x, y]) => `${x.toFixed(1)},${y.toFixed(1)}`).join(' ');
const curve = (points, colour, more = '') =>
    `<polyline points="${pointsOf(points)}" fill="none" style="stroke: ${colour}" ${more}/>`;
const dot = ([x, y], radius, colour, hollow = false) =>
    `<circle cx="${x}" cy="${y}" r="${radius}" style="fill: ${hollow ? 'var(--card)' : colour}; stroke: ${colour}"/>`;
const label = ([x, y], text, more = '') => `<text x="${x}" y="${y}" ${more}>${text}</text>`;

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

/** What the stage draws of each link, lowest first. */
function solidsOf(links, forms) {
    const heaviest = Math.max(...links.map((link) => link[PART.mass]));
    return links.map((link, m) => {
        const rod = (Math.sqrt(3) * link[PART.gyration]) / link[PART.length];
        return {
            form: forms[m] || (link[PART.momentum] || link[PART.axial] ? 'wheel' : ''),
            size: Math.cbrt(link[PART.mass] / heaviest) || 1e-3, // a string has the colour of the chain
            along: link[PART.centroid] / link[PART.length],
            rod: rod < 1 ? rod : 0, // what is longer is no rod
            gyration: link[PART.gyration],
            ahead: Math.sign(link[PART.momentum] + link[PART.axial]) || 1,
            stands: Boolean(link[PART.stands]),
            plain: kindOf(link) === 'rod' || !link[PART.mass],
        };
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

/** The chain `figure` {links, forms, offset, height, halfWaves} on the stage, with its support and its arm. A mode is
 * drawn about the line in which the chain hangs, without the arm. */
function putOnStage(stage, {radius, carriage, stiffness}, figure, speed, afresh) {
    const pins = Array.from(figure.offset, (r, i) => [r, figure.height[i]]);
    const [floor, top] = [Math.min(0, ...figure.height), Math.max(0, ...figure.height)];
    const shown = viewer.chainFigure({
        pins,
        links: solidsOf(figure.links, figure.forms),
        arm: figure.isMode ? 0 : radius,
        springs: stiffness !== null,
        carriage: stiffness === null ? 0 : carriage,
        turns: Math.sign(speed) || 1,
        top,
        floor,
        colour: getComputedStyle(document.documentElement).getPropertyValue(waveName(figure.halfWaves)).trim(),
    });
    stage.show([shown], viewer.extentOf([shown]));
    stage.arrange(afresh);
}

const CARD = [124, 92]; // as in the element's viewBox

/** Nodes of a mode on the axis, as [0, height]; they are given by their distances from the free end. */
function nodesOf({links, nodes = [], height}) {
    if (links.some((link) => link[PART.stands])) return [];
    return Array.from(nodes, (left) => {
        let m = 0;
        while (m < links.length - 1 && left > links[m][PART.length]) left -= links[m++][PART.length];
        return [0, height[m] + (left / links[m][PART.length]) * (height[m + 1] - height[m])];
    });
}

/** A shape from the side, in a card: its axis, its arm, and the nodes of a mode as rings. */
function drawSide(svg, figure) {
    const ends = (list) => [Math.min(0, ...list), Math.max(0, ...list)];
    const [left, right] = ends(figure.offset),
        [bottom, top] = ends(figure.height);
    const scale = Math.min((CARD[0] - 14) / (right - left || 1), (CARD[1] - 14) / (top - bottom || 1));
    const at = (r, z) => [CARD[0] / 2 + scale * (r - (left + right) / 2), 7 + scale * (top - z)];
    const pins = Array.from(figure.offset, (r, i) => at(r, figure.height[i]));
    svg.innerHTML =
        curve([at(0, top), [at(0, 0)[0], CARD[1] - 4]], 'var(--soft)', AXIS) +
        curve([at(0, figure.height.at(-1)), pins.at(-1)], 'var(--ink)') +
        curve(pins, waveColour(figure.halfWaves), 'stroke-width="2"') +
        nodesOf(figure).map((node) => dot(at(...node), 2.5, 'var(--ink)', true)).join('') +
        dot(pins.at(-1), 2.5, 'var(--ink)');
}

const DIAGRAM = {width: 430, height: 270, left: 46, right: 418, top: 12, bottom: 234}; // as in the element's viewBox

/** Positions in the diagram: from speeds in rad/s and radii to units of the picture and back. */
function diagramScale(most, reach) {
    const {left, right, top, bottom} = DIAGRAM;
    return {
        x: (speed) => left + ((right - left) * speed) / most,
        y: (radius) => bottom - ((bottom - top) * radius) / reach,
        speed: (x) => most * Math.min(1, Math.max(0, (x - left) / (right - left))),
    };
}

const isStable = (shape) => shape.verdict === 'minimum' || shape.verdict === 'spectrally stable';

/** A branch in pieces of one colour, that of the half waves. */
function branchCurves({speed, tip, halfWaves}, {x, y}) {
    let text = '';
    for (let from = 0, to; from + 1 < speed.length; from = to) {
        for (to = from + 1; halfWaves[to] === halfWaves[to + 1]; ) ++to;
        const points = Array.from(speed.subarray(from, to + 1), (each, i) => [x(each), y(Math.abs(tip[from + i]))]);
        text += curve(points, waveColour(halfWaves[to]), 'stroke-width="1.8"');
    }
    return text;
}

/** Distance of the free end, in words `end`, from the axis against speed. Stable shapes are filled dots, others hollow. */
function drawDiagram(svg, {branches, shapes, selected, speed, top, reach, unit, end}) {
    const scale = diagramScale(top, reach),
        {x, y} = scale,
        {left, right, bottom, width, height} = DIAGRAM;
    let text = '';
    for (const tick of viewer.ticks(0, top * UNITS[unit])) {
        const at = x(tick / UNITS[unit]);
        text += curve([[at, y(0)], [at, y(reach)]], 'var(--line)');
        text += label([at, bottom + 16], tick, 'text-anchor="middle"');
    }
    for (const tick of viewer.ticks(0, reach)) {
        text += curve([[left, y(tick)], [right, y(tick)]], 'var(--line)');
        text += label([left - 6, y(tick) + 4], tick, 'text-anchor="end"');
    }
    text += label([(left + width) / 2, height - 5], `speed (${unit})`, 'text-anchor="middle"');
    const upright = `text-anchor="middle" transform="translate(11 ${height / 2 - 10}) rotate(-90)"`;
    text += label([0, 0], `${end} from axis (m)`, upright);
    text += `<svg x="0" y="0" width="${right}" height="${bottom}">`; // which cuts off what goes farther
    for (const branch of branches) text += branchCurves(branch, scale);
    text += '</svg>' + curve([[x(speed), y(0)], [x(speed), y(reach)]], 'var(--accent)', 'stroke-dasharray="5 4"');
    for (const shape of shapes) {
        const size = shape === selected ? 6 : 4;
        const hollow = shape.verdict !== null && !isStable(shape);
        text += dot([x(speed), y(Math.abs(shape.offset[0]))], size, waveColour(shape.halfWaves), hollow);
    }
    svg.innerHTML = text;
}
