// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
//
// The page: loads the program and the body, steps the scene in real time, draws it, and passes mouse input to it.
// Emscripten generates loadBulletFEM from scene.cpp; scene.h declares its functions.
'use strict';

const element = id => document.getElementById(id);
const canvas = element('view');
const kMostFrame = 0.1;     // longest time between frames that steps catch up with [s]
const kMostStepping = 50;   // limit of the time for steps in a frame; beyond it the scene is slower than real time [ms]
const kFieldOfView = 0.6;   // [rad]
const kLight = normalize([0.45, 1, 0.35]);  // direction to the light
const kElephant = [0.56, 0.62, 0.72], kBall = [0.83, 0.36, 0.25], kBox = [0.87, 0.62, 0.27];
const kHand = [0.15, 0.35, 0.8];
const camera = {target: [0, 0.5, 0], distance: 3.1, turn: 0.5, height: 0.28};

// Vectors and 4 x 4 matrices by columns.
function add(a, b, s = 1) { return a.map((x, c) => x + s * b[c]); }
function dot(a, b) { return a.reduce((sum, x, c) => sum + x * b[c], 0); }
function cross(a, b) { return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]; }
function normalize(a) { return a.map(x => x / Math.hypot(...a)); }
function multiply(a, b) {
    const entry = k => [0, 1, 2, 3].reduce((sum, j) => sum + a[4 * j + k % 4] * b[(k & 12) + j], 0);
    return Array.from({length: 16}, (_, k) => entry(k));
}

/** Position and axes of the camera: x to the right, y up, z towards the viewer. */
function view() {
    const c = Math.cos(camera.height);
    const z = [Math.sin(camera.turn) * c, Math.sin(camera.height), Math.cos(camera.turn) * c];
    const x = normalize(cross([0, 1, 0], z));
    return {eye: add(camera.target, z, camera.distance), x, y: cross(z, x), z};
}

/** Matrix from world to screen. */
function projection() {
    const {eye, x, y, z} = view(), near = 0.05, far = 60, f = 1 / Math.tan(kFieldOfView / 2);
    const perspective = [f * canvas.height / canvas.width, 0, 0, 0, 0, f, 0, 0,
        0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
    return multiply(perspective, [x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0,
        -dot(x, eye), -dot(y, eye), -dot(z, eye), 1]);
}

/** Direction of the view ray through a point of the page; its component along the view axis is 1. */
function rayThrough(event) {
    const {x, y, z} = view(), box = canvas.getBoundingClientRect();
    const scale = Math.tan(kFieldOfView / 2) / (box.height / 2);
    const right = (event.clientX - box.left - box.width / 2) * scale;
    const up = (box.top + box.height / 2 - event.clientY) * scale;
    return add(add(x.map(v => v * right), y, up), z, -1);
}

// Drawing: triangles with positions and normals; a shadow is a projection of these triangles onto the ground.
const kVertexShader = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 toScreen, toWorld;
uniform vec3 light;
uniform bool shadow;
out vec3 place, direction;
void main() {
    place = (toWorld * vec4(position, 1)).xyz;
    if (shadow) place = vec3(place.x - light.x / light.y * place.y, 0.002, place.z - light.z / light.y * place.y);
    direction = transpose(inverse(mat3(toWorld))) * normal;
    gl_Position = toScreen * vec4(place, 1);
}`;
const kFragmentShader = `#version 300 es
precision highp float;
in vec3 place, direction;
uniform vec3 light, eye, colour, sky;
uniform bool shadow, ground;
out vec4 pixel;
void main() {
    if (shadow) { pixel = vec4(0.1, 0.13, 0.18, 0.32); return; }
    vec3 c = colour;
    vec3 n = normalize(direction);
    if (ground) {
        vec2 line = abs(fract(place.xz / 0.5 - 0.5) - 0.5) / fwidth(place.xz / 0.5);
        c = mix(c * 0.9, c, clamp(min(line.x, line.y), 0.0, 1.0));
        c = mix(c, sky, smoothstep(4.0, 18.0, length(place - eye)));
    } else {
        vec3 half_way = normalize(light + normalize(eye - place));
        c *= 0.42 + 0.18 * n.y + 0.62 * max(dot(n, light), 0.0);
        c += 0.12 * pow(max(dot(n, half_way), 0.0), 40.0);
    }
    pixel = vec4(c, 1);
}`;
const kSky = [0.86, 0.9, 0.94], kGround = [0.9, 0.91, 0.92];

class Drawing {
    constructor() {
        const gl = this.gl = canvas.getContext('webgl2', {alpha: false, antialias: true, stencil: true});
        if (!gl) throw new Error('this browser has no WebGL 2');
        this.program = gl.createProgram();
        for (const [kind, source] of [[gl.VERTEX_SHADER, kVertexShader], [gl.FRAGMENT_SHADER, kFragmentShader]]) {
            const shader = gl.createShader(kind);
            gl.shaderSource(shader, source);
            gl.compileShader(shader);
            gl.attachShader(this.program, shader);
        }
        gl.linkProgram(this.program);
        if (!gl.getProgramParameter(this.program, gl.LINK_STATUS))
            throw new Error(gl.getProgramInfoLog(this.program));
        gl.useProgram(this.program);
        this.uniform = {};
        for (const name of ['toScreen', 'toWorld', 'light', 'eye', 'colour', 'sky', 'shadow', 'ground'])
            this.uniform[name] = gl.getUniformLocation(this.program, name);
        this.ball = this.mesh(...ballMesh());
        this.box = this.mesh(...boxMesh());
        const far = 40;
        const corners = [[-far, -far], [far, -far], [far, far], [-far, far]];
        this.ground = this.mesh(corners.flatMap(([x, z]) => [x, 0, z, 0, 1, 0]), [0, 2, 1, 0, 3, 2]);
        this.body = this.mesh([], []);
    }

    mesh(vertices, triangles) {
        const gl = this.gl;
        const mesh = {array: gl.createVertexArray(), vertices: gl.createBuffer(), triangles: gl.createBuffer()};
        gl.bindVertexArray(mesh.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, mesh.vertices);
        for (const attribute of [0, 1]) {
            gl.enableVertexAttribArray(attribute);
            gl.vertexAttribPointer(attribute, 3, gl.FLOAT, false, 24, 12 * attribute);
        }
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles);
        this.fill(mesh, new Float32Array(vertices), new Int32Array(triangles));
        return mesh;
    }

    fill(mesh, vertices, triangles) {
        const gl = this.gl;
        gl.bindVertexArray(mesh.array);
        gl.bindBuffer(gl.ARRAY_BUFFER, mesh.vertices);
        gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.DYNAMIC_DRAW);
        if (!triangles) return;
        gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
        mesh.count = triangles.length;
    }

    draw(things) {
        const gl = this.gl, scale = window.devicePixelRatio || 1;
        const width = Math.round(canvas.clientWidth * scale), height = Math.round(canvas.clientHeight * scale);
        if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
        gl.viewport(0, 0, width, height);
        gl.enable(gl.DEPTH_TEST);
        gl.clearColor(...kSky, 1);
        gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
        gl.uniformMatrix4fv(this.uniform.toScreen, false, projection());
        gl.uniform3fv(this.uniform.eye, view().eye);
        gl.uniform3fv(this.uniform.light, kLight);
        gl.uniform3fv(this.uniform.sky, kSky);

        const one = (mesh, pose, colour, {shadow = false, ground = false} = {}) => {
            gl.uniformMatrix4fv(this.uniform.toWorld, false, pose);
            gl.uniform3fv(this.uniform.colour, colour);
            gl.uniform1i(this.uniform.shadow, shadow);
            gl.uniform1i(this.uniform.ground, ground);
            gl.bindVertexArray(mesh.array);
            gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
        };
        one(this.ground, kHere, kGround, {ground: true});
        gl.enable(gl.STENCIL_TEST);  // shades each pixel once
        gl.stencilFunc(gl.EQUAL, 0, 1);
        gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
        for (const [mesh, pose, colour] of things) one(mesh, pose, colour, {shadow: true});
        gl.disable(gl.BLEND);
        gl.disable(gl.STENCIL_TEST);
        for (const [mesh, pose, colour] of things) one(mesh, pose, colour);
    }
}

const kHere = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** A ball of radius 1 at a point, or a rod between two points. */
function ballAt(p, r) { return [r, 0, 0, 0, 0, r, 0, 0, 0, 0, r, 0, ...p, 1]; }
function rod(p, q, r) {
    const along = add(q, p, -1).map(x => x / 2);
    const side = normalize(cross(along, Math.abs(along[1]) > Math.abs(along[0]) ? [1, 0, 0] : [0, 1, 0]));
    const other = normalize(cross(along, side));
    return [...side.map(x => r * x), 0, ...other.map(x => r * x), 0, ...along, 0, ...add(p, along), 1];
}

function ballMesh(around = 32, rings = 16) {
    const vertices = [], triangles = [];
    for (let i = 0; i <= rings; ++i)
        for (let j = 0; j <= around; ++j) {
            const u = Math.PI * i / rings, v = 2 * Math.PI * j / around;
            const n = [Math.sin(u) * Math.cos(v), Math.cos(u), Math.sin(u) * Math.sin(v)], k = i * (around + 1) + j;
            vertices.push(...n, ...n);
            const below = k + around + 1;
            if (i < rings && j < around) triangles.push(k, k + 1, below, k + 1, below + 1, below);
        }
    return [vertices, triangles];
}

function boxMesh() {
    const vertices = [], triangles = [];
    for (let axis = 0; axis < 3; ++axis)
        for (const sign of [-1, 1]) {
            const first = vertices.length / 6;
            for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
                const p = [0, 0, 0], n = [0, 0, 0];
                p[axis] = n[axis] = sign;
                p[(axis + 1) % 3] = u;
                p[(axis + 2) % 3] = v;
                vertices.push(...p, ...n);
            }
            triangles.push(first, first + 1, first + 2, first, first + 2, first + 3);
        }
    return [vertices, triangles];
}

// The program.
async function start() {
    const [program, body] = await Promise.all([loadBulletFEM(),
        fetch('elephant.bfem').then(answer => {
            if (!answer.ok) throw new Error(`elephant.bfem: ${answer.status} ${answer.statusText}`);
            return answer.arrayBuffer();
        })]);
    const call = Object.fromEntries(Object.keys(program).filter(name => name.startsWith('_scene_'))
        .map(name => [name.slice('_scene_'.length), program[name]]));
    const errorText = () => program.UTF8ToString(call.error());
    const must = done => { if (!done) throw new Error(errorText()); };
    // Any call may grow the memory, so views of it must be created after the call.
    const numbers = (address, count, Kind = Float32Array) => new Kind(program.HEAPU8.buffer, address, count);

    const drawing = new Drawing();
    const ms = [];  // time of each of the last steps
    let mouse = null, late = 0, last = 0, changed = false, steps = 0, time = 0;

    const settings = () => ({young: Math.round(10 ** element('young').value), damping: +element('damping').value,
        gravity: +element('gravity').value, step: 1 / element('step').value});
    function set() {
        const {young, damping, gravity, step} = settings();
        element('young-value').value =
            young < 1e6 ? `${Math.round(young / 1e3)} kPa` : `${(young / 1e6).toFixed(1)} MPa`;
        element('damping-value').value = `${(1e3 * damping).toFixed(0)} ms`;
        element('gravity-value').value = `${gravity.toFixed(2)} m/s²`;
        element('step-value').value = `1/${element('step').value} s`;
        must(call.set(young, damping, gravity, step));
        ms.length = 0;
    }
    function open(bytes, count) {
        must(call.open(bytes, count));
        must(call.hold_feet(element('feet').checked ? 1 : 0));
        drawing.fill(drawing.body, numbers(call.vertices(), 6 * call.vertex_count()),
            numbers(call.triangles(), 3 * call.triangle_count(), Int32Array));
        element('tets').textContent = call.tets();
        mouse = null;
        late = 0;
    }
    const bytes = program._malloc(body.byteLength);
    program.HEAPU8.set(new Uint8Array(body), bytes);
    set();
    open(bytes, body.byteLength);
    program._free(bytes);

    // Shows all errors of event handlers on the page.
    const guarded = handler => event => {
        try { handler(event); } catch (error) { element('error').textContent = error.message; throw error; }
    };
    for (const name of ['young', 'damping', 'gravity', 'step'])
        element(name).addEventListener('input', () => { changed = true; });
    const holdFeet = () => must(call.hold_feet(element('feet').checked ? 1 : 0));
    element('feet').addEventListener('change', guarded(holdFeet));
    element('again').addEventListener('click', guarded(() => open(0, 0)));

    // The mouse drags the body by a spring at the constant depth of the picked point; elsewhere it turns the view.
    canvas.addEventListener('pointerdown', guarded(event => {
        canvas.setPointerCapture(event.pointerId);
        const {eye, z} = view(), end = add(eye, rayThrough(event), 50);
        const held = call.pick(...eye, ...end) === 1;
        mouse = {held, x: event.clientX, y: event.clientY};
        if (held) mouse.depth = dot(z, add(eye, numbers(call.held(), 3), -1));
        if (held) mouse.target = Array.from(numbers(call.held(), 3));
        canvas.classList.toggle('holding', held);
    }));
    canvas.addEventListener('pointermove', guarded(event => {
        if (!mouse) return;
        if (mouse.held) {
            mouse.target = add(view().eye, rayThrough(event), mouse.depth);
            must(call.drag(...mouse.target));
        } else {
            camera.turn -= 0.008 * (event.clientX - mouse.x);
            camera.height = Math.min(1.5, Math.max(0.02, camera.height + 0.008 * (event.clientY - mouse.y)));
            [mouse.x, mouse.y] = [event.clientX, event.clientY];
        }
    }));
    const letGo = guarded(() => {
        call.release();
        mouse = null;
        canvas.classList.remove('holding');
    });
    canvas.addEventListener('pointerup', letGo);
    canvas.addEventListener('pointercancel', letGo);
    canvas.addEventListener('wheel', event => {
        event.preventDefault();
        camera.distance = Math.min(12, Math.max(1.2, camera.distance * Math.exp(0.001 * event.deltaY)));
    }, {passive: false});

    function step() {
        const began = performance.now();
        call.step();
        ms.push(performance.now() - began);
        if (ms.length > 60) ms.shift();
        ++steps;
        time += settings().step;
    }

    function frame(now) {
        if (changed) set();
        changed = false;
        late = Math.min(late + (now - last) / 1000, kMostFrame);
        last = now;
        const began = performance.now();
        for (; late >= settings().step && performance.now() - began < kMostStepping; late -= settings().step) step();
        drawing.fill(drawing.body, numbers(call.vertices(), 6 * call.vertex_count()));
        const things = [[drawing.body, kHere, kElephant]];
        for (let k = 0; k < call.rigid_count(); ++k) {
            const ball = call.rigid_is_ball(k);
            const pose = Array.from(numbers(call.rigid_pose(k), 16));
            things.push(ball ? [drawing.ball, pose, kBall] : [drawing.box, pose, kBox]);
        }
        if (mouse && mouse.held) {
            const held = Array.from(numbers(call.held(), 3));
            things.push([drawing.ball, ballAt(held, 0.02), kHand], [drawing.ball, ballAt(mouse.target, 0.03), kHand]);
            if (Math.hypot(...add(held, mouse.target, -1)) > 1e-3)
                things.push([drawing.box, rod(held, mouse.target, 0.008), kHand]);
        }
        drawing.draw(things);
        if (ms.length) element('ms').textContent = `${(ms.reduce((a, b) => a + b) / ms.length).toFixed(2)} ms`;
        element('contacts').textContent = call.asleep() ? 'asleep' : call.contacts();
        element('iterations').textContent = call.asleep() ? 'asleep' : call.iterations();
        window.requestAnimationFrame(guarded(frame));
    }
    window.requestAnimationFrame(guarded(now => { last = now; frame(now); }));

    // For tests.
    window.bulletfem = {
        state: () => ({steps, time, tets: call.tets(), fastest: call.fastest(), asleep: call.asleep() === 1,
            centre: Array.from(numbers(call.centre(), 3)),
            finite: numbers(call.vertices(), 6 * call.vertex_count()).every(Number.isFinite),
            held: mouse && mouse.held ? Array.from(numbers(call.held(), 3)) : null,
            target: mouse && mouse.held ? mouse.target : null}),
        /** Position of a world point on the page [pixels]. */
        pixelOf: point => {
            const p = multiply(projection(), ballAt(point, 1)).slice(12), box = canvas.getBoundingClientRect();
            return [box.left + box.width * (1 + p[0] / p[3]) / 2, box.top + box.height * (1 - p[1] / p[3]) / 2];
        },
        open: () => open(0, 0), step, call, numbers,
    };
}

start().catch(error => {
    element('error').textContent = error.message;
    throw error;
});
