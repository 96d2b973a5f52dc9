// SPDX-License-Identifier: MPL-2.0
// Sliders with fields for numbers, and the parts of the chain. page.js has what they change: state, top, changed.

const digits = (x, n = 4) => (Number.isFinite(x) ? String(Number(x.toPrecision(n))) : '–');
const shortBound = (x) => (Number.isFinite(x) ? x.toExponential(1) : 'not proved');
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

/** A slider with a field for any number. `scale` takes the slider's 0 ... 1000 to the number and back. */
function slider({label, unit = '', scale, get, set, least = -Infinity, main = false, id = ''}) {
    const range = element('input', {type: 'range', min: 0, max: 1000, step: 'any', id});
    const field = element('input', {
        type: 'number',
        step: 'any',
        className: 'number',
        ariaLabel: `${label}, as a number`,
    });
    range.ariaLabel = label;
    const note = element('span', {className: 'unit'});
    const show = () => {
        range.value = scale.to(get());
        range.setAttribute('aria-valuetext', `${digits(get())} ${unit}`);
        if (document.activeElement !== field) field.value = digits(get(), 6);
    };
    range.oninput = () => {
        set(scale.from(Number(range.value)));
        show();
    };
    field.onchange = () => {
        const value = Number(field.value);
        if (field.value !== '' && value >= least) set(value);
        field.blur();
        show();
    };
    const box = element(
        'div',
        {className: `slider${main ? ' main' : ''}`},
        element('label', {textContent: label, htmlFor: id}),
        element('span', {}, field, ` ${unit}`),
        range,
    );
    show();
    return {box, show, note};
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
        from: (t) => Number((middle * 10 ** ((t - 500) / 250)).toPrecision(4)),
    };
}

let speedSlider = null;
function buildSliders() {
    speedSlider = slider({
        label: 'Speed',
        unit: 'rad/s',
        main: true,
        id: 'speed',
        least: 0,
        scale: linear(0, () => top),
        get: () => state.speed ?? 0,
        set: (x) => {
            state.speed = x;
            if (x > top) {
                top = 1.1 * x;
                askDiagram();
            }
            changed({speed: true});
        },
    });
    const gravity = slider({
        label: 'Gravity',
        unit: 'm/s²',
        id: 'gravity',
        least: 1e-6,
        scale: {to: (x) => 40 * x, from: (t) => Math.max(0.1, t / 40)},
        get: () => state.gravity,
        set: (x) => {
            state.gravity = x;
            changed();
        },
    });
    const most = 2 * totalLength(state) + 2 * state.radius;
    const arm = slider({
        label: 'Arm that carries the support round',
        unit: 'm',
        id: 'arm',
        least: 0,
        scale: linear(0, () => most),
        get: () => state.radius,
        set: (x) => {
            state.radius = x;
            changed();
        },
    });
    const spring = element('input', {type: 'checkbox', checked: state.stiffness !== null});
    spring.onchange = () => {
        const weight = state.gravity * state.parts.reduce((sum, part) => sum + part[PART.count] * part[PART.mass], 0);
        state.stiffness = spring.checked ? Number(((4 * weight) / totalLength(state)).toPrecision(3)) : null;
        if (!spring.checked) state.carriage = 0;
        buildSliders();
        changed();
    };
    const held = [element('label', {className: 'check'}, spring, 'Support on a sideways spring')];
    if (state.stiffness !== null) {
        held.push(
            slider({
                label: 'Stiffness',
                unit: 'N/m',
                least: 1e-12,
                scale: logarithmic(state.stiffness),
                get: () => state.stiffness,
                set: (x) => {
                    state.stiffness = x;
                    changed();
                },
            }).box,
        );
        held.push(
            slider({
                label: 'Mass that moves with it',
                unit: 'kg',
                least: 0,
                scale: logarithmic(state.carriage || 1),
                get: () => state.carriage,
                set: (x) => {
                    state.carriage = x;
                    changed();
                },
            }).box,
        );
    }
    const open = state.radius > 0 || state.stiffness !== null || $('sliders').querySelector('details')?.open;
    $('speed-slider').replaceChildren(speedSlider.box);
    $('sliders').replaceChildren(
        element(
            'details',
            {open},
            element('summary', {textContent: 'Gravity and support'}),
            gravity.box,
            arm.box,
            ...held,
        ),
    );
}

function partBox(part, index) {
    const kind = element(
        'select',
        {ariaLabel: `kind of part ${index + 1}`},
        ...[
            ['point', 'point masses'],
            ['rod', 'rods'],
            ['body', 'bodies'],
        ].map(([value, textContent]) => element('option', {value, textContent})),
    );
    kind.value = kindOf(part);
    kind.onchange = () => {
        setKind(part, kind.value);
        if (kind.value === 'body')
            ((part[PART.gyration] = 0.3 * part[PART.length]), (part[PART.centroid] = 0.6 * part[PART.length]));
        buildParts();
        changed();
    };
    const remove = element('button', {type: 'button', textContent: 'Remove', disabled: state.parts.length === 1});
    remove.onclick = () => {
        state.parts.splice(index, 1);
        buildParts();
        changed();
    };
    const others = () => linkCount(state) - part[PART.count];
    const place = (i, label, unit, scale, least = 0) =>
        slider({
            label,
            unit,
            scale,
            least,
            id: `part${index}-${Object.keys(PART)[i]}`,
            get: () => part[i],
            set: (x) => {
                part[i] = x;
                changed();
            },
        }).box;
    const boxes = [
        slider({
            label: 'Links',
            id: `part${index}-count`,
            least: 1,
            scale: whole(1, () => Math.max(60, part[PART.count])),
            get: () => part[PART.count],
            set: (x) => {
                part[PART.count] = Math.max(1, Math.min(Math.round(x), MOST_LINKS - others()));
                changed();
            },
        }).box,
        place(PART.mass, 'Mass of each', 'kg', logarithmic(part[PART.mass])),
        slider({
            label: 'Length of each',
            unit: 'm',
            id: `part${index}-length`,
            least: 1e-12,
            scale: logarithmic(part[PART.length]),
            get: () => part[PART.length],
            set: (x) => {
                setLength(part, x);
                changed();
            },
        }).box,
    ];
    if (kind.value === 'body') {
        const span = 2 * part[PART.length];
        boxes.push(
            place(
                PART.centroid,
                'Centre of gravity below the upper pin',
                'm',
                linear(-span / 2, () => span),
                -Infinity,
            ),
        );
        boxes.push(
            place(
                PART.gyration,
                'Radius of gyration',
                'm',
                linear(0, () => span),
            ),
        );
    }
    if (part[PART.momentum])
        boxes.push(
            place(
                PART.momentum,
                'Angular momentum of each wheel',
                'kg m²/s',
                linear(-3 * Math.abs(part[PART.momentum]), () => 3 * Math.abs(part[PART.momentum])),
                -Infinity,
            ),
        );
    if (part[PART.stands]) boxes.push(element('p', {textContent: 'These links stand on their upper pins.'}));
    const name = state.parts.length === 1 ? 'All links' : index === 0 ? 'Lowest' : `Part ${index + 1}`;
    return element(
        'fieldset',
        {},
        element('legend', {}, name, kind, ...(state.parts.length > 1 ? [remove] : [])),
        ...boxes,
    );
}

function buildParts() {
    const fine = state.parts.length <= 4;
    const boxes = state.parts.map(partBox);
    $('parts').replaceChildren(
        ...(fine
            ? boxes
            : [element('details', {}, element('summary', {textContent: plural(boxes.length, 'part')}), ...boxes)]),
    );
    $('add').disabled = linkCount(state) >= MOST_LINKS;
}
