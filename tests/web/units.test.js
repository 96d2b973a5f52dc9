// SPDX-License-Identifier: MPL-2.0
// The state of the live page and its link, without a browser:  node --test tests/web/units.test.js
'use strict';
const assert = require('node:assert/strict'),
    {readFileSync} = require('node:fs'),
    {join} = require('node:path'),
    {test} = require('node:test'),
    vm = require('node:vm');

const WEB = join(__dirname, '../../web');
const PRESETS = [
    {
        ...{name: 'nut', title: 'A nut', says: 'It hangs.', tries: [], parts: [[1, 2, 3, 3, 0, 0, 0, 0]], forms: ['']},
        ...{gravity: 9.80665, radius: 0, stiffness: null, carriage: 0},
    },
];
const NAMES =
    'presetState, kindOf, setLength, setKind, linkCount, totalLength, partOfLinks, formOfLinks, toLink, fromLink, toPython, toScene, heightsOf, nodesOf';

/** The functions of the scripts, which are plain ones, in a context of their own. */
function page() {
    const document = {getElementById: () => ({textContent: JSON.stringify(PRESETS)})};
    const context = vm.createContext({document, URLSearchParams, structuredClone});
    const text = ['state.js', 'draw.js'].map((name) => readFileSync(join(WEB, name), 'utf8')).join('\n');
    return vm.runInContext(`${text}\n;({${NAMES}})`, context);
}
const {kindOf, setLength, setKind, linkCount, totalLength, partOfLinks, formOfLinks} = page();
const {toLink, fromLink, toPython, toScene, presetState, heightsOf, nodesOf} = page();
const plain = (value) => JSON.parse(JSON.stringify(value));

/** The same numbers on every run. */
function random(seed) {
    return () => (seed = (seed * 48271) % 2147483647) / 2147483647;
}

test('a link gives back every digit of what is set', () => {
    const next = random(1);
    for (let turn = 0; turn < 500; ++turn) {
        const parts = Array.from({length: 1 + Math.floor(4 * next())}, () => {
            const part = [1 + Math.floor(40 * next()), next(), next(), next(), next(), Number(next() < 0.3), 0, 0];
            if (next() < 0.3) part.splice(6, 2, next() - 0.5, next());
            if (next() < 0.6) setKind(part, next() < 0.5 ? 'rod' : 'point');
            return part;
        });
        const stiffness = next() < 0.5 ? null : 1000 * next();
        const state = {
            name: next() < 0.5 ? 'nut' : null,
            parts,
            gravity: next() < 0.5 ? 9.80665 : 20 * next(),
            radius: next() < 0.5 ? 0 : next(),
            stiffness,
            carriage: stiffness === null || next() < 0.5 ? 0 : next(),
            forms: parts.map(() => ['', 'bell', 'seat'][Math.floor(3 * next())]),
            unit: ['rpm', 'rad/s', 'Hz'][Math.floor(3 * next())],
            speed: next() < 0.5 ? null : 30 * next(),
            select: next() < 0.5 ? null : 's2',
        };
        assert.deepEqual(plain(fromLink(toLink(state))), state);
    }
});

test('links of point masses and rods are short', () => {
    const part = [5, 1, 2, 0, 0, 0, 0, 0];
    setKind(part, 'point');
    assert.equal(toLink({...presetState('nut'), name: null, parts: [part]}), 'p=5_1_2_point');
    setKind(part, 'rod');
    assert.equal(toLink({...presetState('nut'), name: null, parts: [part]}), 'p=5_1_2_rod');
});

test('an example alone, and no link at all', () => {
    assert.equal(fromLink(''), null);
    assert.deepEqual(plain(fromLink('x=nut&n=2.5&s=m1')), {...plain(presetState('nut')), speed: 2.5, select: 'm1'});
});

test('wrong links say which number is wrong', () => {
    for (const [link, words] of [
        ['x=unknown', /example "unknown", which this page does not have/],
        ['x=nut&u=mph', /unit of speed as "mph"/],
        ['p=2_x_1_rod', /mass as "x"/],
        ['p=2_1__rod', /length as ""/],
        ['p=2.5_1_1_rod', /number of links/],
        ['p=0_1_1_rod', /number of links/],
        ['p=1_1_1_rod&g=NaN', /gravity as "NaN"/],
        ['p=150_1_1_rod~51_1_1_rod', /201 links.*at most 200/],
        ['x=nut&u=toString', /unit of speed as "toString"/],
        ['p=1_1_1_constructor', /centroid as "constructor"/],
        ['p=1_-1_1_point', /mass as "-1"/],
        ['p=1_0_0_rod', /length as "0"/],
        ['p=1_1_1_0.5_-0.1', /gyration as "-0.1"/],
        ['p=1_1_1_rod_0_0.5_-0.01', /axial as "-0.01"/],
        ['p=1_1_1_point&g=-9.81', /gravity as "-9.81"/],
        ['p=1_1_1_point&g=0', /gravity as "0"/],
        ['p=1_1_1_point&r=-1', /arm as "-1"/],
        ['p=1_1_1_point&k=-5', /stiffness as "-5"/],
        ['p=1_1_1_point&k=0', /stiffness as "0"/],
        ['p=1_1_1_point&k=5&c=-1', /carriage as "-1"/],
        ['x=nut&n=-2', /speed as "-2"/],
    ])
        assert.throws(() => fromLink(link), words, link);
});

test('names that every object has are neither forms nor kinds, and there is no mode 0', () => {
    assert.deepEqual(plain(fromLink('p=1_1_1_point~1_1_1_rod&f=constructor~bell').forms), ['', 'bell']);
    for (const select of ['m0', 's0', 'm', 'x1']) assert.equal(fromLink(`x=nut&s=${select}`).select, null);
    const part = [1, 1, 1, 0.3, 0.2, 0, 0, 0];
    setKind(part, 'constructor');
    assert.deepEqual(part, [1, 1, 1, 0.3, 0.2, 0, 0, 0]);
});

test('a part keeps its kind when its length changes', () => {
    for (const kind of ['point', 'rod', 'body']) {
        const part = [3, 1, 0.7, 0.31, 0.2, 0, 0, 0];
        setKind(part, kind);
        setLength(part, 1.9);
        assert.equal(part[2], 1.9);
        assert.equal(kindOf(part), kind);
    }
});

test('a chain of many equal rods is drawn as rings, a part in its form', () => {
    const rod = [9, 1, 1, 0, 0, 0, 0, 0];
    setKind(rod, 'rod');
    const state = {parts: [[1, 1, 1, 1, 0, 0, 0, 0], rod], forms: ['seat', '']};
    assert.deepEqual(plain(formOfLinks(state)), ['seat', ...Array(9).fill('ring')]);
});

test('the same chain as a program and as a scene', () => {
    const state = {...presetState('nut'), speed: 2.5, radius: 0.5, stiffness: 40, carriage: 3};
    assert.match(toPython(state), /mass=\[2\],\n    length=\[3\],\n\)\nsystem = rc.Rig\(chain, support=rc.Support\(stiffness=40, mass=3, radius=0.5\)\)/);
    assert.match(toScene(state), /title = "A nut"\n\n\[\[links\]\]\nmass = 2\nlength = 3\n\n\[support\]\nradius = 0.5\nstiffness = 40\nmass = 3\n/);
});

test('nothing moves with a firm support', () => {
    const state = fromLink('p=1_1_1_point&r=3&c=30');
    assert.equal(state.carriage, 0);
    assert.match(toPython(state), /rc.Support\(radius=3\)/);
    assert.match(toScene(state), /\[support\]\nradius = 3\n\n/);
});

test('counts, lengths and heights', () => {
    const state = {parts: [[2, 1, 0.5, 0, 0, 0, 0, 0], [1, 1, 2, 0, 0, 1, 0, 0]]};
    assert.equal(linkCount(state), 3);
    assert.equal(totalLength(state), 3);
    const links = partOfLinks(state);
    assert.deepEqual(plain(links), plain([state.parts[0], state.parts[0], state.parts[1]]));
    // pins from the free end: 0.3 across 0.5 is 0.4 down, 0 across is 0.5 down, 1.2 across 2 is 1.6 up: that link stands
    const height = [...heightsOf(links, [1.5, 1.2, 1.2, 0])];
    [0.7, 1.1, 1.6, 0].forEach((want, k) => assert.ok(Math.abs(height[k] - want) < 1e-15, `${height}`));
});

test('nodes are on the axis, at their distance from the free end along the chain', () => {
    const link = [1, 1, 0.5, 0, 0, 0, 0, 0];
    const links = [link, link];
    assert.deepEqual(plain(nodesOf({links, nodes: [0.25, 0.75], height: [-0.75, -0.5, 0]})), [[0, -0.625], [0, -0.25]]);
    assert.deepEqual(plain(nodesOf({links, height: [-1, -0.5, 0]})), []); // a shape
    assert.deepEqual(plain(nodesOf({links: [[1, 1, 0.5, 0, 0, 1, 0, 0]], nodes: [0.1], height: [0.5, 0]})), []);
});
