// SPDX-License-Identifier: MPL-2.0
// What the page shows: a chain in parts of equal links, how it is held, a speed, and what is selected. The part of the
// link after # holds all of it.

const STANDARD_GRAVITY = 9.80665;
const MOST_LINKS = 200;
const PART = {count: 0, mass: 1, length: 2, centroid: 3, gyration: 4, stands: 5, momentum: 6, axial: 7};
const KINDS = {point: [1, 0], rod: [0.5, Math.sqrt(1 / 12)]};

const presets = JSON.parse(document.getElementById('presets').textContent);

function presetState(name) {
    const preset = presets.find((each) => each.name === name) ?? presets[0];
    const {title, ...state} = structuredClone(preset);
    return {...state, speed: null, select: null};
}

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
    if (kind in KINDS) [part[3], part[4]] = KINDS[kind].map((ratio) => ratio * part[PART.length]);
}

const linkCount = (state) => state.parts.reduce((sum, part) => sum + part[PART.count], 0);
const totalLength = (state) => state.parts.reduce((sum, part) => sum + part[PART.count] * part[PART.length], 0);
const hasMomentum = (state) => state.parts.some((part) => part[PART.momentum] !== 0);

/** For each link, lowest first, its part. */
const partOfLinks = (state) => state.parts.flatMap((part) => Array(part[PART.count]).fill(part));

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
    const optional = (key, what, none) => (key in fields ? number(fields[key], what) : none);
    const part = (row) => {
        const given = row.split('_'),
            kind = given[3],
            known = kind in KINDS;
        const values = known ? [...given.slice(0, 3), 0, 0, ...given.slice(4)] : given;
        const numbers = values.map((value, i) => number(value, Object.keys(PART)[i] ?? 'a further number'));
        const whole = [...numbers, ...Array(8).fill(0)].slice(0, 8);
        if (!(whole[0] >= 1 && Number.isInteger(whole[0]))) number('', 'the number of links', 1);
        if (known) setKind(whole, kind);
        return whole;
    };
    if (!fields.p) return {...presetState(fields.x), speed: optional('n', 'the speed', null), select: fields.s ?? null};
    const state = {
        name: presets.some((each) => each.name === fields.x) ? fields.x : null,
        parts: fields.p.split('~').map(part),
        gravity: optional('g', 'gravity', STANDARD_GRAVITY),
        radius: optional('r', 'the arm', 0),
        stiffness: optional('k', 'the stiffness', null),
        carriage: optional('c', 'the carriage', 0),
        speed: optional('n', 'the speed', null),
        select: fields.s ?? null,
    };
    if (linkCount(state) > MOST_LINKS)
        throw new Error(
            `The link has ${linkCount(state)} links. The page shows at most ${MOST_LINKS}; use the Python package.`,
        );
    return state;
}
