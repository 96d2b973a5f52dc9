// SPDX-License-Identifier: MPL-2.0
// Sliders with fields for numbers, and the parts of the chain. page.js has what they change: state, top, changed.

const digits = (x, n = 4) => (Number.isFinite(x) ? String(Number(x.toPrecision(n))) : '–');
const shortBound = (x) => (Number.isFinite(x) ? x.toExponential(1) : 'not proved');
/** A number that has four digits once it is multiplied by `factor`. */
const rounded = (x, factor = 1) => Number((x * factor).toPrecision(4)) / factor;
const plural = (n, what) => `${n} ${what}${n === 1 ? '' : 's'}`;

function element(name, properties = {}, ...children) {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
}

function svgElement(viewBox) {
    const made = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    made.setAttribute('viewBox', viewBox);
    return made;
}

/** A slider and a field for `owner[key]`. `scale` takes the slider's 0 ... 1000 to the number and back; the field shows
 * the number, or what `shown` returns instead, times what `times` returns, in `unit`, a word or an element. */
function slider(owner, key, {label, unit = '', scale, least = -Infinity, id = '', set, times = () => 1, shown, main}) {
    const range = element('input', {type: 'range', min: 0, max: 1000, step: 'any', id, ariaLabel: label});
    const ariaLabel = `${label}, as a number`;
    const field = element('input', {type: 'number', step: 'any', className: 'number', ariaLabel});
    const put = (x) => {
        if (set) return set(x);
        owner[key] = x;
        changed();
    };
    const show = () => {
        const value = shown?.() ?? owner[key] ?? 0;
        range.value = scale.to(value);
        range.setAttribute('aria-valuetext', `${digits(value * times())} ${unit.value ?? unit}`);
        if (document.activeElement !== field) field.value = digits(value * times());
    };
    range.oninput = () => {
        put(rounded(scale.from(Number(range.value)), times())); // to what the field shows
        show();
    };
    field.onchange = () => {
        const value = Number(field.value) / times();
        if (field.value !== '' && value >= least) put(value);
        field.blur();
        show();
    };
    const name = element('label', {textContent: label, htmlFor: id});
    const className = `slider${main ? ' main' : ''}`;
    const box = element('div', {className}, name, element('span', {}, field, ' ', unit), range);
    show();
    return {box, show};
}

const linear = (low, high) => ({
    to: (x) => (1000 * (x - low)) / (high() - low),
    from: (t) => low + ((high() - low) * t) / 1000,
});
const whole = (low, high) => ({to: linear(low, high).to, from: (t) => Math.round(linear(low, high).from(t))});
/** A hundred times less to a hundred times more than the number when the slider was made. */
function logarithmic(x) {
    const middle = x > 0 ? x : 1;
    return {
        to: (y) => 500 + 250 * Math.log10(Math.max(y, 1e-300) / middle),
        from: (t) => middle * 10 ** ((t - 500) / 250),
    };
}

let speedSlider = null;
function buildSliders() {
    const options = Object.keys(UNITS).map((name) => element('option', {value: name, textContent: name}));
    const unit = element('select', {ariaLabel: 'Unit of speed'}, ...options);
    unit.value = state.unit;
    unit.onchange = () => {
        state.unit = unit.value;
        showStory();
        modesShown = false;
        dirty = true;
        saveLink();
    };
    speedSlider = slider(state, 'speed', {
        label: 'Speed',
        unit,
        times: () => UNITS[state.unit],
        shown: speedOfMode,
        main: true,
        id: 'speed',
        least: LEAST.speed,
        scale: linear(0, () => top),
        set: (x) => {
            state.speed = x;
            if (x > top) {
                top = 1.1 * x;
                askDiagram();
            }
            changed({speed: true});
        },
    });
    const most = 2 * totalLength(state) + 2 * state.radius;
    const weak = {to: (x) => 40 * x, from: (t) => Math.max(0.1, t / 40)};
    const sliders = [
        slider(state, 'gravity', {label: 'Gravity', unit: 'm/s²', id: 'gravity', least: LEAST.gravity, scale: weak}),
        slider(state, 'radius', {
            label: 'Arm that carries the support round',
            unit: 'm',
            id: 'arm',
            least: LEAST.radius,
            scale: linear(0, () => most),
        }),
    ];
    const spring = element('input', {type: 'checkbox', id: 'spring', checked: state.stiffness !== null});
    spring.onchange = () => {
        const weight = state.gravity * state.parts.reduce((sum, part) => sum + part[PART.count] * part[PART.mass], 0);
        state.stiffness = spring.checked ? Number(((4 * weight) / totalLength(state)).toPrecision(3)) : null;
        if (!spring.checked) state.carriage = 0;
        buildSliders();
        $('spring').focus();
        changed();
    };
    const held = [];
    if (state.stiffness !== null) {
        const [stiffness, carriage] = [logarithmic(state.stiffness), logarithmic(state.carriage || 1)];
        held.push(slider(state, 'stiffness', {label: 'Stiffness', unit: 'N/m', least: LEAST.stiffness, scale: stiffness}));
        const mass = {label: 'Mass that moves with it', unit: 'kg', least: LEAST.carriage, scale: carriage};
        held.push(slider(state, 'carriage', mass));
    }
    const boxes = (list) => list.map((each) => each.box);
    const check = element('label', {className: 'check'}, spring, 'Support on a sideways spring');
    const summary = element('summary', {textContent: 'Gravity and support'});
    const open = state.radius > 0 || state.stiffness !== null || $('sliders').querySelector('details')?.open;
    speedSlider.box.querySelector('[type="range"]').setAttribute('list', 'mode-speeds');
    $('speed-slider').replaceChildren(speedSlider.box);
    $('sliders').replaceChildren(element('details', {open}, summary, ...boxes(sliders), check, ...boxes(held)));
}

const KIND_WORDS = {point: 'point masses', rod: 'rods', body: 'bodies'};

/** The sliders of a part: [index, label, unit, scale, and what else]. */
function numbersOf(part, kind) {
    const length = part[PART.length],
        momentum = 3 * Math.abs(part[PART.momentum]);
    const setCount = (x) => {
        const others = linkCount(state) - part[PART.count];
        part[PART.count] = Math.max(1, Math.min(Math.round(x), MOST_LINKS - others));
        $('add').disabled = linkCount(state) >= MOST_LINKS;
        changed();
    };
    const setScaled = (x) => {
        setLength(part, x);
        changed();
    };
    const count = whole(1, () => Math.max(60, part[PART.count]));
    const numbers = [
        [PART.count, 'Links', '', count, {set: setCount}],
        [PART.mass, 'Mass of each', 'kg', logarithmic(part[PART.mass])],
        [PART.length, 'Length of each', 'm', logarithmic(length), {set: setScaled}],
    ];
    if (kind === 'body') {
        numbers.push([PART.centroid, 'Centre of gravity below the upper pin', 'm', linear(-length, () => 2 * length)]);
        numbers.push([PART.gyration, 'Radius of gyration', 'm', linear(0, () => 2 * length)]);
    }
    if (momentum)
        numbers.push([PART.momentum, 'Angular momentum of each wheel', 'kg m²/s', linear(-momentum, () => momentum)]);
    return numbers;
}

function partBox(part, index) {
    const options = Object.entries(KIND_WORDS).map(([value, textContent]) => element('option', {value, textContent}));
    const kind = element('select', {id: `part${index}-kind`, ariaLabel: `kind of part ${index + 1}`}, ...options);
    kind.value = kindOf(part);
    kind.onchange = () => {
        setKind(part, kind.value);
        if (kind.value === 'body') {
            part[PART.gyration] = 0.3 * part[PART.length];
            part[PART.centroid] = 0.6 * part[PART.length];
        }
        buildParts();
        $(kind.id).focus();
        changed();
    };
    const remove = element('button', {type: 'button', textContent: 'Remove'});
    remove.onclick = () => {
        state.parts.splice(index, 1);
        state.forms.splice(index, 1);
        buildParts();
        $('add').focus();
        changed();
    };
    const boxes = numbersOf(part, kind.value).map(([key, label, unit, scale, more]) => {
        const id = `part${index}-${Object.keys(PART)[key]}`;
        return slider(part, key, {label, unit, scale, id, least: LEAST_OF_PART[key], ...more}).box;
    });
    if (part[PART.stands]) boxes.push(element('p', {textContent: 'These links stand on their upper pins.'}));
    const alone = state.parts.length === 1;
    const name = alone ? 'All links' : index === 0 ? 'Lowest' : `Part ${index + 1}`;
    return element('fieldset', {}, element('legend', {}, name, kind, ...(alone ? [] : [remove])), ...boxes);
}

function buildParts() {
    const boxes = state.parts.map(partBox);
    const summary = element('summary', {textContent: plural(boxes.length, 'part')});
    $('parts').replaceChildren(...(boxes.length <= 4 ? boxes : [element('details', {}, summary, ...boxes)]));
    $('add').disabled = linkCount(state) >= MOST_LINKS;
}
