// Draws the organ of report.html with WebGL, and updates everything that depends on the slider. Copied into the page.
"use strict";
const D = JSON.parse(document.getElementById("data").textContent);
const element = id => document.getElementById(id);
const bytes = base64 => Uint8Array.from(atob(base64), c => c.charCodeAt(0)).buffer;
const rest = new Float32Array(bytes(D.rest)),
  moved = new Int16Array(bytes(D.moved)),
  stress = new Uint8Array(bytes(D.stress));
const organFaces = new Uint32Array(bytes(D.faces)),
  lesionFaces = new Uint32Array(bytes(D.lesion));
const track = new Float32Array(bytes(D.track)); // per frame: time, sphere x y z, force x y z, penetration, highest stress
const palette = new Uint8Array(bytes(D.palette)),
  count = rest.length / 3,
  frames = track.length / 9;
const of = (frame, k) => track[9 * frame + k];

// --- vectors and matrices (column-major) ---
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]],
  dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => {
  const l = Math.hypot(...a) || 1;
  return [a[0] / l, a[1] / l, a[2] / l];
};
const product = (a, b) => {
  const c = new Float32Array(16);
  for (let i = 0; i < 4; i++)
    for (let j = 0; j < 4; j++) for (let k = 0; k < 4; k++) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
  return c;
};
const placed = (x, y, z, at) => new Float32Array([...x, 0, ...y, 0, ...z, 0, ...at, 1]);

// --- camera ---
const home = () => ({
  yaw: Math.atan2(D.outward[1], D.outward[0]),
  pitch: Math.min(Math.asin(D.outward[2]), 0.5),
  distance: 1.3 * D.size,
  target: [...D.centre],
});
let camera = home(),
  frame = D.start,
  playing = false,
  dirty = true;
function eye() {
  const c = Math.cos(camera.pitch),
    out = [c * Math.cos(camera.yaw), c * Math.sin(camera.yaw), Math.sin(camera.pitch)];
  return camera.target.map((t, i) => t + camera.distance * out[i]);
}
function viewMatrix(aspect) {
  const e = eye(),
    z = unit(sub(e, camera.target)),
    x = unit(cross([0, 0, 1], z)),
    y = cross(z, x);
  const look = new Float32Array([
    x[0],
    y[0],
    z[0],
    0,
    x[1],
    y[1],
    z[1],
    0,
    x[2],
    y[2],
    z[2],
    0,
    -dot(x, e),
    -dot(y, e),
    -dot(z, e),
    1,
  ]);
  const near = 0.05 * D.size,
    far = 20 * D.size,
    f = 2.4 * Math.min(1, aspect);
  return product(
    new Float32Array([
      f / aspect,
      0,
      0,
      0,
      0,
      f,
      0,
      0,
      0,
      0,
      (far + near) / (near - far),
      -1,
      0,
      0,
      (2 * far * near) / (near - far),
      0,
    ]),
    look,
  );
}

// --- shapes ---
function ballShape() {
  const p = [],
    f = [],
    n = 24;
  for (let i = 0; i <= n; i++)
    for (let j = 0; j <= 2 * n; j++) {
      const a = (Math.PI * i) / n,
        b = (Math.PI * j) / n;
      p.push(Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a));
      if (i < n && j < 2 * n) {
        const q = i * (2 * n + 1) + j;
        f.push(q, q + 2 * n + 1, q + 1, q + 1, q + 2 * n + 1, q + 2 * n + 2);
      }
    }
  return { p, n: p, f };
}
function arrowShape() {
  // from 0 to 1 along z: shaft, shoulder, tip, each a band between two rings
  const p = [],
    normals = [],
    f = [],
    n = 24;
  const band = (r0, z0, r1, z1, out, up) => {
    const first = p.length / 3;
    for (let j = 0; j <= n; j++) {
      const c = Math.cos((2 * Math.PI * j) / n),
        s = Math.sin((2 * Math.PI * j) / n);
      p.push(r0 * c, r0 * s, z0, r1 * c, r1 * s, z1);
      normals.push(out * c, out * s, up, out * c, out * s, up);
      if (j < n) {
        const q = first + 2 * j;
        f.push(q, q + 2, q + 1, q + 1, q + 2, q + 3);
      }
    }
  };
  band(0.035, 0, 0.035, 0.72, 1, 0);
  band(0.035, 0.72, 0.1, 0.72, 0, -1);
  band(0.1, 0.72, 0, 1, 0.94, 0.34);
  return { p, n: normals, f };
}
function edges(faces) {
  const seen = new Set(),
    lines = [];
  for (let i = 0; i < faces.length; i++) {
    const a = faces[i],
      b = faces[i % 3 == 2 ? i - 2 : i + 1],
      key = Math.min(a, b) * count + Math.max(a, b);
    if (!seen.has(key)) {
      seen.add(key);
      lines.push(a, b);
    }
  }
  return new Uint32Array(lines);
}

// --- drawing ---
const canvas = element("organ"),
  gl = canvas.getContext("webgl2", {
    antialias: true,
    alpha: true,
    premultipliedAlpha: true,
    preserveDrawingBuffer: true,
  });
let draw = () => {};
const message = element("message"); // with a still picture; shown until, and unless, there is a renderer
function showStill(on) {
  message.hidden = !on;
  element("view").classList.toggle("still", on);
  canvas.hidden = on;
  if (on) draw = () => {};
}
try {
  if (gl) draw = makeRenderer();
  showStill(!gl);
} catch (error) {
  console.error(error); // a driver that refuses the shaders
  showStill(true);
}
canvas.addEventListener("webglcontextlost", () => showStill(true));

function makeRenderer() {
  const shader = (type, source) => {
    const s = gl.createShader(type);
    gl.shaderSource(s, source);
    gl.compileShader(s);
    if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw Error(gl.getShaderInfoLog(s));
    return s;
  };
  const program = gl.createProgram();
  gl.attachShader(
    program,
    shader(
      gl.VERTEX_SHADER,
      `#version 300 es
    layout(location=0) in vec3 position; layout(location=1) in vec3 normal; layout(location=2) in float stress;
    uniform mat4 view, place; out vec3 n, x; out float s;
    void main() {
      vec4 w = place * vec4(position, 1.0);
      x = w.xyz; n = mat3(place) * normal; s = stress; gl_Position = view * w;
    }`,
    ),
  );
  gl.attachShader(
    program,
    shader(
      gl.FRAGMENT_SHADER,
      `#version 300 es
    precision highp float;
    in vec3 n, x; in float s; out vec4 o;
    uniform sampler2D palette; uniform vec4 colour; uniform vec3 eye; uniform float mapped, lit, shine;
    void main() {
      vec3 c = mix(colour.rgb, texture(palette, vec2(s, 0.5)).rgb, mapped), v = normalize(eye - x), m = normalize(n);
      if (dot(m, v) < 0.0) m = -m;
      vec3 key = normalize(v + vec3(0.25, 0.1, 0.55));
      float light = 0.44 + 0.14 * m.z + 0.44 * max(dot(m, key), 0.0);
      float gloss = shine * pow(max(dot(reflect(-key, m), v), 0.0), 24.0);
      c = mix(c, c * light + gloss, lit);
      o = vec4(c * colour.a, colour.a);
    }`,
    ),
  );
  gl.linkProgram(program);
  gl.useProgram(program);
  const at = name => gl.getUniformLocation(program, name),
    identity = placed([1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]);
  const vertexBuffer = (slot, size, type, normalised, data, usage) => {
    const b = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, b);
    gl.bufferData(gl.ARRAY_BUFFER, data, usage);
    gl.enableVertexAttribArray(slot);
    gl.vertexAttribPointer(slot, size, type, normalised, 0, 0);
    return b;
  };
  const indexBuffer = data => {
    const b = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, b);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, data, gl.STATIC_DRAW);
    return b;
  };
  const fixedShape = shape => {
    const v = gl.createVertexArray();
    gl.bindVertexArray(v);
    vertexBuffer(0, 3, gl.FLOAT, false, new Float32Array(shape.p), gl.STATIC_DRAW);
    vertexBuffer(1, 3, gl.FLOAT, false, new Float32Array(shape.n), gl.STATIC_DRAW);
    indexBuffer(new Uint32Array(shape.f));
    return { v, size: shape.f.length };
  };
  const tissue = gl.createVertexArray();
  gl.bindVertexArray(tissue);
  const position = new Float32Array(3 * count),
    normal = new Float32Array(3 * count);
  const positions = vertexBuffer(0, 3, gl.FLOAT, false, position, gl.DYNAMIC_DRAW),
    normals = vertexBuffer(1, 3, gl.FLOAT, false, normal, gl.DYNAMIC_DRAW);
  const stresses = vertexBuffer(2, 1, gl.UNSIGNED_BYTE, true, stress.subarray(0, count), gl.DYNAMIC_DRAW);
  const faces = indexBuffer(organFaces),
    core = indexBuffer(lesionFaces),
    lineIds = edges(organFaces),
    lines = indexBuffer(lineIds);
  const sphere = fixedShape(ballShape()),
    arrow = fixedShape(arrowShape());
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, palette.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, palette);
  for (const [k, v] of [
    [gl.TEXTURE_MIN_FILTER, gl.LINEAR],
    [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
    [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
    [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
  ])
    gl.texParameteri(gl.TEXTURE_2D, k, v);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  gl.polygonOffset(1, 1);
  gl.clearColor(0, 0, 0, 0);

  let shown = -1;
  function move() {
    shown = frame;
    for (let i = 0; i < 3 * count; i++) position[i] = rest[i] + D.step * moved[3 * count * frame + i];
    normal.fill(0);
    for (const list of [organFaces, lesionFaces])
      for (let i = 0; i < list.length; i += 3) {
        const [a, b, c] = [0, 1, 2].map(k => {
          const q = 3 * list[i + k];
          return [position[q], position[q + 1], position[q + 2]];
        });
        const m = cross(sub(b, a), sub(c, a));
        for (let k = 0; k < 3; k++) for (let j = 0; j < 3; j++) normal[3 * list[i + k] + j] += m[j];
      }
    for (const [b, data] of [
      [positions, position],
      [normals, normal],
      [stresses, stress.subarray(count * frame, count * (frame + 1))],
    ]) {
      gl.bindBuffer(gl.ARRAY_BUFFER, b);
      gl.bufferSubData(gl.ARRAY_BUFFER, 0, data);
    }
  }
  const paint = (mapped, lit, shine, colour, place) => {
    gl.uniform1f(at("mapped"), mapped);
    gl.uniform1f(at("lit"), lit);
    gl.uniform1f(at("shine"), shine);
    gl.uniform4fv(at("colour"), colour);
    gl.uniformMatrix4fv(at("place"), false, place || identity);
  };
  const triangles = (buffer, list) => {
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
    gl.drawElements(gl.TRIANGLES, list.length, gl.UNSIGNED_INT, 0);
  };

  function tissueShapes(through) {
    gl.bindVertexArray(tissue);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    if (through) {
      paint(0, 1, 0.1, [0.3, 0.16, 0.2, 1]);
      triangles(core, lesionFaces);
      gl.enable(gl.BLEND);
      gl.enable(gl.CULL_FACE);
      gl.depthMask(false);
      paint(1, 1, 0.02, [1, 1, 1, 0.38]);
      for (const side of [gl.FRONT, gl.BACK]) {
        gl.cullFace(side);
        triangles(faces, organFaces);
      }
      gl.disable(gl.CULL_FACE);
      gl.depthMask(true);
    } else {
      paint(1, 1, 0.03, [1, 1, 1, 1]);
      triangles(faces, organFaces);
    }
    gl.disable(gl.POLYGON_OFFSET_FILL);
    if (element("lines").checked) {
      gl.enable(gl.BLEND);
      paint(0, 0, 0, [0.1, 0.1, 0.2, through ? 0.07 : 0.11]);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, lines);
      gl.drawElements(gl.LINES, lineIds.length, gl.UNSIGNED_INT, 0);
    }
    gl.disable(gl.BLEND);
  }
  function toolShapes() {
    const centre = [of(frame, 1), of(frame, 2), of(frame, 3)],
      force = [of(frame, 4), of(frame, 5), of(frame, 6)],
      r = D.radius,
      size = Math.hypot(...force);
    gl.bindVertexArray(sphere.v);
    paint(0, 1, 0.35, [0.62, 0.65, 0.7, 1], placed([r, 0, 0], [0, r, 0], [0, 0, r], centre));
    gl.drawElements(gl.TRIANGLES, sphere.size, gl.UNSIGNED_INT, 0);
    if (size < 1e-4) return;
    const z = unit(force),
      x = unit(cross(Math.abs(z[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], z)),
      y = cross(z, x),
      l = size * D.metresPerNewton,
      w = 0.055;
    gl.bindVertexArray(arrow.v);
    paint(
      0,
      1,
      0.2,
      [0.93, 0.55, 0.1, 1],
      placed(
        x.map(v => v * w),
        y.map(v => v * w),
        z.map(v => v * l),
        centre,
      ),
    );
    gl.drawElements(gl.TRIANGLES, arrow.size, gl.UNSIGNED_INT, 0);
  }
  return () => {
    const ratio = Math.min(window.devicePixelRatio || 1, 2),
      w = Math.round(canvas.clientWidth * ratio),
      h = Math.round(canvas.clientHeight * ratio);
    if (canvas.width != w || canvas.height != h) {
      canvas.width = w;
      canvas.height = h;
    }
    gl.viewport(0, 0, w, h);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (shown != frame) move();
    gl.uniformMatrix4fv(at("view"), false, viewMatrix(w / h));
    gl.uniform3fv(at("eye"), eye());
    const through = element("lesion").checked;
    if (through) {
      toolShapes();
      tissueShapes(true);
    } else {
      tissueShapes(false);
      toolShapes();
    }
  };
}

// --- numbers and cursors of the frame ---
function tell() {
  const force = Math.hypot(of(frame, 4), of(frame, 5), of(frame, 6)),
    depth = 1e3 * of(frame, 7),
    most = of(frame, 8);
  element("r-time").textContent = of(frame, 0).toFixed(2) + " s";
  element("r-force").textContent = force.toFixed(3) + " N";
  element("r-depth").textContent = Math.max(0, depth).toFixed(1) + " mm";
  element("r-stress").textContent = (1e-3 * most).toFixed(2) + " kPa";
  element("clamped").textContent = most > D.most ? "higher in places" : "";
  element("slider").value = frame;
  element("slider").setAttribute("aria-valuetext", of(frame, 0).toFixed(2) + " seconds");
  for (const cursor of document.querySelectorAll(".cursor")) {
    const here = cursor.classList.contains("here"),
      [x0, x1, left, right] = cursor.dataset.x.split(",").map(Number),
      [y0, y1, low, high] = cursor.dataset.y.split(",").map(Number);
    const x = left + ((right - left) * ((here ? depth : of(frame, 0)) - x0)) / (x1 - x0),
      y = low + ((high - low) * (force - y0)) / (y1 - y0);
    cursor.setAttribute("transform", `translate(${x.toFixed(1)} ${here ? y.toFixed(1) : 0})`);
    cursor.style.visibility = here && depth < x0 ? "hidden" : "";
  }
}
function show(f) {
  frame = Math.max(0, Math.min(frames - 1, f));
  dirty = true;
  tell();
}

// --- user input ---
const slider = element("slider");
slider.max = frames - 1;
slider.addEventListener("input", () => {
  stop();
  show(+slider.value);
});
let begun = 0;
function stop() {
  playing = false;
  element("play").textContent = "Play";
}
element("play").addEventListener("click", () => {
  if (playing) return stop();
  if (frame == frames - 1) show(0);
  playing = true;
  begun = performance.now() - 1e3 * of(frame, 0);
  element("play").textContent = "Pause";
});
for (const id of ["lesion", "lines"]) element(id).addEventListener("change", () => (dirty = true));
element("whole").addEventListener("click", () => {
  camera = home();
  dirty = true;
});
element("near").addEventListener("click", () => {
  camera.target = [of(frame, 1), of(frame, 2), of(frame, 3)];
  camera.distance = 0.5 * D.size;
  dirty = true;
});
const turn = (x, y) => {
  camera.yaw -= x;
  camera.pitch = Math.max(-1.5, Math.min(1.5, camera.pitch + y));
  dirty = true;
};
const zoom = by => {
  camera.distance = Math.max(0.3 * D.size, Math.min(6 * D.size, camera.distance * by));
  dirty = true;
};
let held = null;
canvas.addEventListener("pointerdown", e => {
  held = [e.clientX, e.clientY];
  canvas.setPointerCapture(e.pointerId);
});
canvas.addEventListener("pointermove", e => {
  if (held) {
    turn(0.008 * (e.clientX - held[0]), 0.008 * (e.clientY - held[1]));
    held = [e.clientX, e.clientY];
  }
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => (held = null));
canvas.addEventListener(
  "wheel",
  e => {
    e.preventDefault();
    zoom(Math.exp(0.0012 * e.deltaY));
  },
  { passive: false },
);
canvas.addEventListener("keydown", e => {
  const keys = { ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
  if (keys[e.key]) {
    turn(...keys[e.key]);
    e.preventDefault();
  } else if (e.key == "+") zoom(0.9);
  else if (e.key == "-") zoom(1.1);
});
window.addEventListener("resize", () => (dirty = true));

function loop(now) {
  if (playing) {
    const t = 1e-3 * (now - begun);
    let f = frame;
    while (f < frames - 1 && of(f + 1, 0) <= t) f++;
    if (f != frame) show(f);
    if (f == frames - 1) stop();
  }
  if (dirty) {
    dirty = false;
    draw();
  }
  requestAnimationFrame(loop);
}
show(D.start);
draw();
requestAnimationFrame(loop);
