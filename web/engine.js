// SPDX-License-Identifier: MPL-2.0
// Runs in a worker: asks the compiled library and reads its answers. client.js starts it.
'use strict';

let library = null,
    compiled = null;

const started = async () => {
    library = await createEngine({
        instantiateWasm: (imports, done) => {
            WebAssembly.instantiate(compiled, imports).then((instance) => done(instance));
            return {};
        },
    });
};

/** The answer of a function of engine.cpp as a reader of its numbers, first to last. */
function ask(name, ...values) {
    const count = library[`_${name}`](...values);
    const numbers = library.HEAPF64.slice(library._answer() / 8, library._answer() / 8 + count);
    let at = 0;
    return {
        next: () => numbers[at++],
        list: (size) => numbers.subarray(at, (at += size)),
    };
}

/** Parts: [count, mass, length, centroid, radius of gyration, stands, momentum, axial moment]. Returns the links. */
function setRig({parts, stiffness, carriage, radius, gravity}) {
    const flat = parts.flat(),
        room = library._room(flat.length) / 8;
    library.HEAPF64.set(flat, room);
    return ask('set_rig', parts.length, stiffness ?? Infinity, carriage, radius, gravity).next();
}

function findModes(links, count) {
    const read = ask('find_modes', count);
    const found = {
        forward: read.next(),
        backward: read.next(),
        other: read.next(),
        growth: read.next(),
        complete: Boolean(read.next()),
        modes: [],
    };
    for (let left = read.next(), number = 1; left > 0; --left, ++number) {
        const mode = {number, speed: read.next(), speedBound: read.next(), height: read.next(), bound: read.next()};
        mode.nodes = read.list(read.next());
        mode.offset = read.list(links + 1);
        if (mode.speed < 0 && (found.modes.at(-1)?.speed ?? 1) > 0) mode.number = number = 1;
        found.modes.push(mode);
    }
    found.modes.sort((one, other) => Math.abs(one.speed) - Math.abs(other.speed));
    return found;
}

function findShapes(links, speed, budget) {
    const from = performance.now(),
        read = ask('find_shapes', speed, budget);
    const found = {complete: Boolean(read.next()), time: performance.now() - from, shapes: []};
    for (let left = read.next(); left > 0; --left)
        found.shapes.push({
            halfWaves: read.next(),
            bound: read.next(),
            tension: read.next(),
            verdict: null,
            inclination: read.list(links),
            offset: read.list(links + 1),
            height: read.list(links + 1),
        });
    return found;
}

const VERDICTS = ['minimum', 'spectrally stable', 'unstable', 'undecided'];

function judgeShapes(found, first, last) {
    const read = ask('judge_shapes', first, last);
    for (const shape of found.shapes.slice(first, last)) {
        shape.verdict = VERDICTS[read.next()];
        shape.growth = read.next();
    }
}

function readBranch(read) {
    const branch = {mode: read.next(), birth: read.next(), end: read.next()},
        points = read.next();
    branch.speed = read.list(points);
    branch.tip = read.list(points);
    branch.halfWaves = read.list(points);
    return branch;
}

const tasks = {
    /** Modes, then all shapes at the speed, then what becomes of them when disturbed. */
    now(request, reply) {
        const links = setRig(request);
        if (request.modes) reply({modes: findModes(links, request.modes)});
        if (!request.speed || links > request.mostLinks) return reply({shapes: null});
        const shapes = findShapes(links, request.speed, request.budget);
        reply({shapes});
        const share = Math.max(1, Math.floor(400 / links));
        for (let i = 0; links <= request.mostJudged && i < shapes.shapes.length && i < 200; i += share)
            judgeShapes(shapes, i, Math.min(i + share, shapes.shapes.length));
        reply({shapes, judged: true});
    },
    /** The branches of the modes one by one, then the whole diagram with its proof. */
    diagram(request, reply) {
        const links = setRig(request),
            branches = [];
        for (let mode = 1; mode <= request.branches; ++mode)
            branches.push(readBranch(ask('find_branch', mode, request.top)));
        const tries = links <= request.proofLinks;
        reply({diagram: {branches, complete: false, tries}});
        if (!tries) return;
        const read = ask('find_branches', request.top, request.lists, request.listBudget, request.proofBudget);
        const diagram = {complete: Boolean(read.next()), branches: [], tried: true};
        for (let left = read.next(); left > 0; --left) diagram.branches.push(readBranch(read));
        reply({diagram});
    },
};

/** What an exception of the library says. The instance it left behind is of no more use. */
function said(thrown) {
    const pointer = typeof thrown === 'number' ? thrown : parseInt(thrown, 10);
    return Number.isNaN(pointer)
        ? String(thrown)
        : library.UTF8ToString(library._what(pointer)).replace('revchain::', '');
}

onmessage = async ({data}) => {
    if (data.compiled) {
        compiled = data.compiled;
        await started();
        return postMessage({ready: true});
    }
    const from = performance.now();
    try {
        tasks[data.task](data, (part) => postMessage({id: data.id, part, time: performance.now() - from}));
        postMessage({id: data.id, done: true, time: performance.now() - from});
    } catch (thrown) {
        const problem = said(thrown);
        await started();
        postMessage({id: data.id, done: true, problem});
    }
};
