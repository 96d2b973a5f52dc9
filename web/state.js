// SPDX-License-Identifier: MPL-2.0
// What the page shows: a chain in parts of equal links, how it is held, a speed, and what is selected. The part of the
// link after # holds all of it.

const STANDARD_GRAVITY = 9.80665;
const MOST_LINKS = 200;
const PART = {count: 0, mass: 1, length: 2, centroid: 3, gyration: 4, stands: 5, momentum: 6, axial: 7};
/** The least numbers that fields and links accept, and those of a part by index. */
const LEAST = {speed: 0, gravity: 1e-6, radius: 0, stiffness: 1e-12, carriage: 0};
const LEAST_OF_PART = {[PART.count]: 1, [PART.mass]: 0, [PART.length]: 1e-12, [PART.gyration]: 0, [PART.axial]: 0};
const KINDS = {point: [1, 0], rod: [0.5, Math.sqrt(1 / 12)]};

const presets = JSON.parse(document.getElementById('presets').textContent);

function presetState(name) {
    const preset = presets.find((each) => each.name === name);
    if (!preset) throw new Error(`The link names the example "${name}", which this page does not have. Choose one above.`);
    const {title, group, says, tries, ...state} = structuredClone(preset);
    return {...state, speed: null, select: null, unit: 'rpm'};
}

/** Units of speed, each as what a speed in rad/s is multiplied by. */
const UNITS = {rpm: 30 / Math.PI, 'rad/s': 1, Hz: 1 / (2 * Math.PI)};

/** 'point' or 'rod' if a part is that to rounding, else 'body'. */
function kindOf(part) {
    const is = (kind) => KINDS[kind].every((ratio, i) => Math.abs(part[3 + i] / part[PART.length] - ratio) < 1e-12);
    return Object.keys(KINDS).find(is) ?? 'body';
}

/** Centroid and radius of gyration keep their ratio to the length. */
function setLength(part, length) {
    const scale = length / part[PART.length];
    for (const i of [PART.length, PART.centroid, PART.gyration]) part[i] *= scale;
    part[PART.length] = length;
}

function setKind(part, kind) {
    if (Object.hasOwn(KINDS, kind)) [part[3], part[4]] = KINDS[kind].map((ratio) => ratio * part[PART.length]);
}

const linkCount = (state) => state.parts.reduce((sum, part) => sum + part[PART.count], 0);
const totalLength = (state) => state.parts.reduce((sum, part) => sum + part[PART.count] * part[PART.length], 0);
const hasMomentum = (state) => state.parts.some((part) => part[PART.momentum] !== 0);

/** For each link, lowest first, its part. */
const partOfLinks = (state) => state.parts.flatMap((part) => Array(part[PART.count]).fill(part));

/** For each link, lowest first, the form it is drawn in: that of its part, or a ring of a chain of many equal rods. */
const formOfLinks = (state) =>
    state.parts.flatMap((part, i) => {
        const isChain = part[PART.count] >= 8 && kindOf(part) === 'rod';
        return Array(part[PART.count]).fill(state.forms[i] || (isChain ? 'ring' : ''));
    });

function toLink(state) {
    const part = (row) => {
        const exact = (kind) => KINDS[kind].every((ratio, i) => ratio * row[PART.length] === row[3 + i]);
        const kind = Object.keys(KINDS).find(exact);
        const given = kind ? [...row.slice(0, 3), kind, ...row.slice(5)] : [...row];
        while (given.at(-1) === 0) given.pop();
        return given.join('_');
    };
    const fields = {
        x: state.name,
        p: state.parts.map(part).join('~'),
        n: state.speed,
        g: state.gravity === STANDARD_GRAVITY ? null : state.gravity,
        r: state.radius || null,
        k: state.stiffness,
        c: state.carriage || null,
        f: state.forms.some(Boolean) ? state.forms.join('~') : null,
        u: state.unit === 'rpm' ? null : state.unit,
        s: state.select,
    };
    return Object.entries(fields)
        .filter(([, value]) => value !== null)
        .map(([key, value]) => `${key}=${value}`)
        .join('&');
}

/** The state in a link; null where there is none. Throws an Error that says what is wrong with it. */
function fromLink(text) {
    const fields = Object.fromEntries(new URLSearchParams(text));
    if (!fields.p && !fields.x) return null;
    const number = (given, what, least = -Infinity) => {
        const value = Number(given);
        if (given === '' || !Number.isFinite(value) || value < least)
            throw new Error(`The link gives ${what} as "${given}". Choose an example, or copy the link again.`);
        return value;
    };
    const formNamed = (name) => (name in {} ? '' : name); // not a property of every object
    const optional = (key, what, none, least) => (Object.hasOwn(fields, key) ? number(fields[key], what, least) : none);
    const part = (row) => {
        const given = row.split('_'),
            kind = given[3],
            known = Object.hasOwn(KINDS, kind);
        const values = known ? [...given.slice(0, 3), 0, 0, ...given.slice(4)] : given;
        const names = ['the number of links', ...Object.keys(PART).slice(1)];
        const numbers = values.map((value, i) => number(value, names[i] ?? 'a further number', LEAST_OF_PART[i]));
        const whole = [...numbers, ...Array(8).fill(0)].slice(0, 8);
        if (!Number.isInteger(whole[0])) number(`${given[0]} (not whole)`, 'the number of links');
        if (known) setKind(whole, kind);
        return whole;
    };
    const shown = {
        speed: optional('n', 'the speed', null, LEAST.speed),
        select: /^[sm][1-9]\d*$/.test(fields.s) ? fields.s : null,
        unit: fields.u ?? 'rpm',
    };
    if (!Object.hasOwn(UNITS, shown.unit))
        throw new Error(`The link gives the unit of speed as "${shown.unit}". It knows rpm, rad/s and Hz.`);
    if (!fields.p) return {...presetState(fields.x), ...shown};
    const parts = fields.p.split('~').map(part);
    const state = {
        name: presets.some((each) => each.name === fields.x) ? fields.x : null,
        parts,
        forms: parts.map((_, i) => formNamed((fields.f ?? '').split('~')[i] ?? '')),
        gravity: optional('g', 'gravity', STANDARD_GRAVITY, LEAST.gravity),
        radius: optional('r', 'the arm', 0, LEAST.radius),
        stiffness: optional('k', 'the stiffness', null, LEAST.stiffness),
        carriage: optional('c', 'the carriage', 0, LEAST.carriage),
        ...shown,
    };
    if (state.stiffness === null) state.carriage = 0; // nothing moves with a firm support
    if (linkCount(state) > MOST_LINKS)
        throw new Error(
            `The link has ${linkCount(state)} links. The page shows at most ${MOST_LINKS}; use the Python package.`,
        );
    return state;
}

// The same chain as a program and as a scene file -----------------------------------------------------------------------

/** The columns that a program or a scene gives, as [name, index in a part], and whether links stand or wheels spin. */
function columnsOf(state) {
    const has = (index) => state.parts.some((part) => part[index] !== 0);
    const plain = state.parts.every((part) => kindOf(part) === 'point');
    const given = [['mass', PART.mass], ['length', PART.length]];
    if (!plain) given.push(['centroid', PART.centroid], ['radius_of_gyration', PART.gyration]);
    return {given, stands: has(PART.stands), spins: has(PART.momentum) || has(PART.axial)};
}

function toPython(state) {
    const {given, stands, spins} = columnsOf(state);
    const list = (index, write = String) => {
        const parts = state.parts.map((part) => `[${write(part[index])}]${part[0] > 1 ? ` * ${part[0]}` : ''}`);
        return parts.join(' + ');
    };
    const rig = [];
    if (state.radius || state.stiffness !== null) {
        const support = {stiffness: state.stiffness, mass: state.carriage || null, radius: state.radius || null};
        const known = Object.entries(support).filter(([, value]) => value !== null);
        rig.push(`support=rc.Support(${known.map(([name, value]) => `${name}=${value}`).join(', ')})`);
    }
    if (spins) rig.push(`flywheels=rc.Flywheel(momentum=${list(PART.momentum)}, axial_moment=${list(PART.axial)})`);
    if (stands) rig.push(`inverted=${list(PART.stands, (x) => (x ? 'True' : 'False'))}`);
    const gravity = state.gravity === STANDARD_GRAVITY ? '' : `, gravity=${state.gravity}`;
    const lines = ['import revchain as rc', '', 'chain = rc.Chain(  # the lowest link first'];
    for (const [name, index] of given) lines.push(`    ${name}=${list(index)},`);
    lines.push(')', rig.length ? `system = rc.Rig(chain, ${rig.join(', ')})` : 'system = chain');
    lines.push(`print(rc.modes(system${gravity}))`);
    if (state.speed) lines.push(`print(rc.steady_shapes(system, angular_speed=${state.speed}${gravity}))`);
    return `${lines.join('\n')}\n`;
}

/** A wheel of half the mass of a link with its momentum; one with an axial moment is driven. */
function wheelOf(part) {
    const mass = part[PART.mass] / 2,
        driven = part[PART.axial] > 0;
    const radius = driven ? Math.sqrt(part[PART.axial] / mass) : part[PART.gyration] || part[PART.length] / 10;
    const spin = part[PART.momentum] / (mass * radius * radius);
    return `{mass = ${mass}, radius_of_gyration = ${radius}, spin = ${spin}${driven ? ', driven = true' : ''}}`;
}

function toScene(state) {
    const {given} = columnsOf(state);
    const title = presets.find((each) => each.name === state.name)?.title ?? 'My chain';
    const lines = [`title = "${title}"`];
    if (state.gravity !== STANDARD_GRAVITY) lines.push(`gravity = ${state.gravity}`);
    for (const part of state.parts) {
        lines.push('', '[[links]]');
        const kind = kindOf(part);
        const shown = kind === 'body' ? given : given.slice(0, 2);
        if (kind === 'rod') lines.push('kind = "rod"');
        for (const [name, index] of shown) lines.push(`${name} = ${part[index]}`);
        if (part[PART.count] > 1) lines.push(`repeat = ${part[PART.count]}`);
        if (part[PART.stands]) lines.push('standing = true');
        if (part[PART.momentum] || part[PART.axial]) lines.push(`flywheel = ${wheelOf(part)}`);
    }
    if (state.radius || state.stiffness !== null) {
        lines.push('', '[support]');
        if (state.radius) lines.push(`radius = ${state.radius}`);
        if (state.stiffness !== null) lines.push(`stiffness = ${state.stiffness}`);
        if (state.carriage) lines.push(`mass = ${state.carriage}`);
    }
    lines.push('', '[ask.modes]');
    if (state.speed) lines.push('', '[ask.shapes]', `angular_speed = ${state.speed}`);
    return `${lines.join('\n')}\n`;
}
