// SPDX-License-Identifier: MPL-2.0
// Compiles the library and asks it from workers, so that the page never waits.

const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** A module with one SIMD instruction: it compiles where the browser has SIMD. */
const SIMD = new Uint8Array([
    0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);

async function fastEngine() {
    const packed = document.getElementById('engine').textContent;
    const unpacked = new Blob([bytesOf(packed)]).stream().pipeThrough(new DecompressionStream('gzip'));
    const compiled = await WebAssembly.compile(await new Response(unpacked).arrayBuffer());
    return {compiled, glue: document.getElementById('glue').textContent};
}

function slowEngine() {
    return new Promise((done, failed) => {
        window.plainEngine = async ({wasm, glue}) => done({compiled: await WebAssembly.compile(bytesOf(wasm)), glue});
        const script = document.createElement('script');
        script.src = 'plain.js';
        script.onerror = () =>
            failed(new Error('this browser has no WebAssembly SIMD, and plain.js is not beside this page'));
        document.head.append(script);
    });
}

/** The compiled engine, with SIMD where the browser has it. */
async function loadEngine(plain) {
    const fast = !plain && 'DecompressionStream' in window && WebAssembly.validate(SIMD);
    const {compiled, glue} = await (fast ? fastEngine() : slowEngine());
    const text = [glue, document.getElementById('worker').textContent];
    return {compiled, fast, url: URL.createObjectURL(new Blob(text, {type: 'text/javascript'}))};
}

/** A worker that answers the newest request. One that is busy with an old request for too long is replaced. */
class Asker {
    constructor(engine, patience, onPart) {
        Object.assign(this, {engine, patience, onPart, current: null, next: null, id: 0, timer: 0});
        this.start();
    }

    start() {
        this.worker = new Worker(this.engine.url);
        this.worker.onmessage = ({data}) => this.heard(data);
        this.worker.postMessage({compiled: this.engine.compiled});
        this.ready = false;
    }

    ask(request) {
        this.next = {...request, id: ++this.id};
        if (this.ready && !this.current) return this.send();
        if (this.current && !this.timer) this.timer = setTimeout(() => this.replace(), this.patience);
    }

    send() {
        this.current = this.next;
        this.next = null;
        this.worker.postMessage(this.current);
    }

    replace() {
        this.timer = 0;
        if (!this.current || !this.next) return;
        this.worker.terminate();
        this.current = null;
        this.start();
    }

    heard({ready, id, part, done, problem, time}) {
        if (ready) this.ready = true;
        else if (part) this.onPart({part, time, request: this.current});
        if (problem) this.onPart({part: {problem}, time, request: this.current});
        if (done) {
            clearTimeout(this.timer);
            this.timer = 0;
            this.current = null;
        }
        if (this.ready && !this.current && this.next) this.send();
    }

    get busy() {
        return Boolean(this.current || this.next || !this.ready);
    }
}
