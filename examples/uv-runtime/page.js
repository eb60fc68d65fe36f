// The page of uv-runtime.html: draws the exemplar through its uv map, and the resolved maps beside it. URL parameters
// set what the controls do (map, zoom, tilt, x, y, gain, probes, packed, wrong), the far maps' level (far), the panes'
// size (pane), and whether to measure (figures); so does `look` for those it is given. The body's data attributes tell what
// came of it; tests/uv_runtime_test.sh reads them.
"use strict";

let query = new URLSearchParams(location.search);
const farLevel = Number(query.get("far") || 3);
const $ = (id) => document.getElementById(id);
const tell = (facts) => Object.assign(document.body.dataset, facts);

function fail(message) {
  $("state").hidden = false;
  $("state").textContent = message;
  $("state").className = "failed";
  tell({ready: "no", errors: message});
}
addEventListener("error", (e) => fail(e.message));

// ---- Files

const inflated = (bytes) =>
  new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();

// A uv map in a 16-bit TIFF as terrazzo writes it. Not a PNG: browsers decode those to 8 bits.
async function readUv(bytes) {
  const view = new DataView(bytes.buffer);
  if (view.getUint32(0) !== 0x49492a00) throw new Error("the uv map is no little-endian TIFF");
  const directory = view.getUint32(4, true), tags = {};
  for (let i = 0; i < view.getUint16(directory, true); i++) {
    const at = directory + 2 + 12 * i, type = view.getUint16(at + 2, true), count = view.getUint32(at + 4, true);
    const size = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8}[type] || 1, from = size * count > 4 ? view.getUint32(at + 8, true) : at + 8;
    tags[view.getUint16(at, true)] = Array.from({length: count}, (_, k) =>
      type === 3 ? view.getUint16(from + 2 * k, true) : type === 4 ? view.getUint32(from + 4 * k, true) : view.getUint8(from + k));
  }
  const width = tags[256][0], height = tags[257][0], channels = tags[277][0], rows = tags[278] ? tags[278][0] : height;
  if (tags[258][0] !== 16 || tags[259][0] !== 8 || (tags[317] && tags[317][0] !== 2))
    throw new Error("the uv map is no 16-bit TIFF with deflated, predicted rows");
  const size = /exemplar of (\d+)x(\d+) pixels/.exec(String.fromCharCode(...tags[270]));
  const values = new Uint16Array(2 * width * height);
  for (const [strip, from] of tags[273].entries()) {
    const data = new Uint16Array(await inflated(bytes.subarray(from, from + tags[279][strip])));
    for (let y = 0; (y + 1) * width * channels <= data.length; y++) {
      let red = 0, green = 0;  // each value is stored as its difference from the one on the left
      for (let x = 0, i = y * width * channels, o = 2 * (strip * rows + y) * width; x < width; x++, i += channels) {
        values[o++] = red = (red + data[i]) & 65535;
        values[o++] = green = (green + data[i + 1]) & 65535;
      }
    }
  }
  return {width, height, exemplar: [+size[1], +size[2]], values};
}

function readMap(image) {
  const name = image.dataset.map || image.dataset.resolved, {naturalWidth: width, naturalHeight: height} = image;
  const canvas = Object.assign(document.createElement("canvas"), {width, height}), context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const rgba = context.getImageData(0, 0, width, height).data;
  const kind = /color|diffuse|emission|specular/.test(name) ? "color" : /normal/.test(name) ? "normal" : "data";
  let gray = kind === "data";
  for (let i = 0; gray && i < rgba.length; i += 4) gray = rgba[i] === rgba[i + 1] && rgba[i] === rgba[i + 2];
  const channels = gray ? 1 : 4;
  const values = gray ? Uint8Array.from({length: rgba.length / 4}, (_, i) => rgba[4 * i]) : new Uint8Array(rgba);
  return {name, kind, channels, width, height, values};
}

// ---- Resolved maps, mips and the packed uv map

function resolved(map, uv) {
  const n = map.channels, values = new Uint8Array(n * uv.width * uv.height);
  for (let i = 0; i < uv.width * uv.height; i++) {
    const from = n * (uv.values[2 * i + 1] * map.width + uv.values[2 * i]);
    for (let c = 0; c < n; c++) values[n * i + c] = map.values[from + c];
  }
  return {...map, width: uv.width, height: uv.height, values};
}

const linearOf = Float32Array.from({length: 256}, (_, i) =>
  i / 255 <= 0.04045 ? i / 255 / 12.92 : ((i / 255 + 0.055) / 1.055) ** 2.4);
const encodedOf = (v) => 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055);

// All mip levels: means of 2x2 texels, colours in linear light. Normals are averaged and stay shortened. From
// unrounded values, so that coarse levels keep their mean. An odd side's last row or column counts with its neighbour.
function mipsOf(map) {
  const n = map.channels, linear = map.kind === "color";
  const levels = [{width: map.width, height: map.height, values: map.values}];
  let {width, height} = map;
  let fine = Float32Array.from(map.values);
  if (linear)
    for (let i = 0; i < fine.length; i++) fine[i] = linearOf[map.values[i]];
  while (width > 1 || height > 1) {
    const w = Math.max(1, width >> 1), h = Math.max(1, height >> 1), coarse = new Float32Array(n * w * h);
    for (let y = 0; y < h; y++)
      for (let x = 0; x < w; x++) {
        const x0 = Math.floor(x * width / w), x1 = Math.max(x0 + 1, Math.floor((x + 1) * width / w));
        const y0 = Math.floor(y * height / h), y1 = Math.max(y0 + 1, Math.floor((y + 1) * height / h));
        for (let c = 0; c < n; c++) {
          let sum = 0;
          for (let j = y0; j < y1; j++)
            for (let i = x0; i < x1; i++) sum += fine[n * (j * width + i) + c];
          coarse[n * (y * w + x) + c] = sum / ((x1 - x0) * (y1 - y0));
        }
      }
    [fine, width, height] = [coarse, w, h];
    const values = new Uint8Array(fine.length);
    for (let i = 0; i < fine.length; i++) values[i] = Math.round(linear ? encodedOf(fine[i]) : fine[i]);
    levels.push({width, height, values});
  }
  return levels;
}

// One byte a texel: an index into the palette of its tile, which lists the tile's distinct offsets from output to
// exemplar pixel. Tiles of 16x16 always fit; larger ones are tried first.
function packed(uv) {
  const [ew, eh] = uv.exemplar;
  for (let shift = 6; shift >= 4; shift--) {
    const side = 1 << shift, across = Math.ceil(uv.width / side), down = Math.ceil(uv.height / side);
    const palettes = [], indices = new Uint8Array(uv.width * uv.height);
    let most = 0;
    for (let t = 0; t < across * down && most <= 256; t++) {
      const palette = new Map();
      const x0 = t % across * side, y0 = Math.floor(t / across) * side;
      for (let y = y0; y < Math.min(y0 + side, uv.height); y++)
        for (let x = x0; x < Math.min(x0 + side, uv.width); x++) {
          const i = y * uv.width + x;
          const dx = ((uv.values[2 * i] - x) % ew + ew) % ew, dy = ((uv.values[2 * i + 1] - y) % eh + eh) % eh;
          const key = dy * 65536 + dx;
          if (!palette.has(key)) palette.set(key, palette.size);
          indices[i] = palette.get(key);
        }
      palettes.push([...palette.keys()]);
      most = Math.max(most, palette.size);
    }
    if (most > 256) continue;
    const rows = Math.ceil(most / 16), width = 16 * across, values = new Uint16Array(2 * width * rows * down);
    palettes.forEach((palette, t) => palette.forEach((key, e) => {
      const at = (Math.floor(t / across) * rows + (e >> 4)) * width + t % across * 16 + (e & 15);
      values[2 * at] = key % 65536;
      values[2 * at + 1] = Math.floor(key / 65536);
    }));
    return {shift, rows, most, indices, palette: {width, height: rows * down, values}};
  }
}

// ---- Drawing

const fragment = `
uniform sampler2D exemplar0, exemplar1, exemplar2, exemplar3;
uniform sampler2D far0, far1, far2, far3;
uniform sampler2D whole0, whole1, whole2, whole3;
uniform vec2 pane, centre;    // in pixels; in output texels
uniform float zoom, tilt;     // pixels for a texel; radians
uniform int source, look, probes;
uniform float gain;           // 0: a picture; else the difference of run time and resolved, times gain
out vec4 fragColor;

const int runTime = 0, ordinary = 1, reference = 2, mistake = 3;
const int color = 0, normals = 1, gray = 2, lit = 3;  // 4: several channels of data

// The output coordinate in texels that a pixel of the pane shows. False above the horizon.
bool outputAt(vec2 at, out vec2 p) {
  vec2 s = vec2(at.x - 0.5 * pane.x, 0.5 * pane.y - at.y);
  float focal = 1.5 * pane.y, distance = focal / zoom;
  float facing = focal * cos(tilt) + s.y * sin(tilt);
  float y = s.y * distance / facing;
  p = centre + vec2(tilt == 0.0 ? s.x / zoom : s.x * (distance - y * sin(tilt)) / focal, tilt == 0.0 ? s.y / zoom : y);
  return facing > 0.02 * focal;
}

struct Maps { vec4 a, b, c, d; };
void add(inout Maps sum, Maps m, float weight) {
  sum.a += weight * m.a; sum.b += weight * m.b; sum.c += weight * m.c; sum.d += weight * m.d;
}

Maps runTimeAt(vec2 st, float texels) {
  ExemplarPlace place = placeInExemplar(st, texels);
  Maps m = Maps(sampleExemplar(exemplar0, far0, place), vec4(0), vec4(0), vec4(0));
  if (look != lit) return m;
  m.b = sampleExemplar(exemplar1, far1, place);
  m.c = sampleExemplar(exemplar2, far2, place);
  m.d = sampleExemplar(exemplar3, far3, place);
  return m;
}

// What not to do: the exemplar coordinate's own derivatives choose the mip.
Maps mistakeAt(vec2 p) {
  ivec2 size = textureSize(uvMap, 0), texel = ivec2(floor(p));
  vec2 st = (vec2(exemplarPixel((texel % size + size) % size)) + p - vec2(texel)) / vec2(exemplarSize);
  Maps m = Maps(texture(exemplar0, st), vec4(0), vec4(0), vec4(0));
  if (look == lit) { m.b = texture(exemplar1, st); m.c = texture(exemplar2, st); m.d = texture(exemplar3, st); }
  return m;
}

Maps ordinaryAt(vec2 st, vec2 dx, vec2 dy) {
  Maps m = Maps(textureGrad(whole0, st, dx, dy), vec4(0), vec4(0), vec4(0));
  if (look != lit) return m;
  m.b = textureGrad(whole1, st, dx, dy);
  m.c = textureGrad(whole2, st, dx, dy);
  m.d = textureGrad(whole3, st, dx, dy);
  return m;
}

// The mean of the finest level over the pixel, from 8x8 samples.
Maps referenceAt(vec2 st, vec2 dx, vec2 dy) {
  Maps sum = Maps(vec4(0), vec4(0), vec4(0), vec4(0));
  for (int i = 0; i < 64; i++) {
    vec2 at = st + ((float(i & 7) + 0.5) / 8.0 - 0.5) * dx + ((float(i >> 3) + 0.5) / 8.0 - 0.5) * dy;
    add(sum, ordinaryAt(at, vec2(0), vec2(0)), 1.0 / 64.0);
  }
  return sum;
}

vec3 encoded(vec3 v) {
  v = clamp(v, 0.0, 1.0);
  return mix(12.92 * v, 1.055 * pow(v, vec3(1.0 / 2.4)) - 0.055, greaterThan(v, vec3(0.0031308)));
}
vec3 unit(vec3 stored) {
  vec3 n = stored * 2.0 - 1.0;
  return n / max(length(n), 1e-4);
}

vec3 seen(Maps m) {
  if (look == color) return encoded(m.a.rgb);
  if (look == normals) return unit(m.a.rgb) * 0.5 + 0.5;
  if (look == gray) return m.a.rrr;
  if (look != lit) return m.a.rgb;
  vec3 n = unit(m.b.rgb), l = normalize(vec3(-0.6, 0.7, 0.8)), h = normalize(l + vec3(0, 0, 1));
  float shine = 2.0 / max(pow(m.c.r, 4.0), 1e-3);
  float specular = 0.04 * (shine + 2.0) / 8.0 * pow(max(dot(n, h), 0.0), shine);
  return encoded(m.a.rgb * (0.25 * m.d.r + 0.95 * max(dot(n, l), 0.0)) + specular * max(dot(n, l), 0.0));
}

void main() {
  vec2 p;
  bool ground = outputAt(gl_FragCoord.xy, p);
  vec2 size = vec2(textureSize(uvMap, 0)), st = p / size;
  vec2 dx = dFdx(p), dy = dFdy(p);
  vec3 shown = vec3(0), other = vec3(0);
  if (source == mistake) shown = seen(mistakeAt(p));  // here, since implicit derivatives need all pixels of a quad
  if (!ground) { fragColor = gain > 0.0 ? vec4(0, 0, 0, 1) : vec4(0.55, 0.62, 0.7, 1); return; }
  if (source == runTime) {
    ExemplarFootprint f = exemplarFootprint(dx, dy, probes);
    Maps sum = Maps(vec4(0), vec4(0), vec4(0), vec4(0));
    for (int i = 0; i < f.probes; i++)
      add(sum, runTimeAt(st + (float(i) - 0.5 * float(f.probes - 1)) * f.step / size, f.texels), 1.0 / float(f.probes));
    shown = seen(sum);
  }
  if (source == ordinary || gain > 0.0) other = seen(ordinaryAt(st, dx / size, dy / size));
  if (source == ordinary) shown = other;
  if (source == reference) shown = seen(referenceAt(st, dx / size, dy / size));
  fragColor = vec4(gain > 0.0 ? gain * abs(shown - other) : shown, 1);
}`;

class Renderer {
  constructor(uv, pack, maps) {
    this.canvas = document.createElement("canvas");
    const gl = this.gl = this.canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error("This browser has no WebGL 2.");
    this.anisotropy = gl.getExtension("EXT_texture_filter_anisotropic");
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    [this.uv, this.pack] = [uv, pack];
    this.programs = {};
    this.plain = this.integers(gl.RG16UI, gl.RG_INTEGER, gl.UNSIGNED_SHORT, uv.width, uv.height, uv.values);
    this.indices = this.integers(gl.R8UI, gl.RED_INTEGER, gl.UNSIGNED_BYTE, uv.width, uv.height, pack.indices);
    const {width, height, values} = pack.palette;
    this.palette = this.integers(gl.RG16UI, gl.RG_INTEGER, gl.UNSIGNED_SHORT, width, height, values);
    this.maps = new Map();
    for (const m of maps)
      this.maps.set(m.name, {
        exemplar: this.texture(m, m.exemplarMips, gl.CLAMP_TO_EDGE),
        far: this.texture(m, m.wholeMips.slice(farLevel), gl.REPEAT),
        whole: this.texture(m, m.wholeMips, gl.REPEAT),
      });
    this.absent = {};  // stands for maps that the material lacks
    const absent = {kind: "data", channels: 1}, level = (v) => [{width: 1, height: 1, values: Uint8Array.of(v)}];
    for (const [name, v] of [["roughness", 160], ["ambient_occlusion", 255]]) {
      const texture = this.texture(absent, level(v), gl.REPEAT);
      this.absent[name] = {exemplar: texture, far: texture, whole: texture};
    }
  }

  program(define) {
    const gl = this.gl, program = gl.createProgram();
    const vertex = "#version 300 es\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }";
    for (const [type, text] of [[gl.VERTEX_SHADER, vertex],
                                [gl.FRAGMENT_SHADER, `#version 300 es\n${define}${$("sample_exemplar").textContent}${fragment}`]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const at = (name) => gl.getUniformLocation(program, name);
    return {program, at};
  }

  integers(internal, format, type, width, height, values) {
    const gl = this.gl, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, format, type, values);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  texture(map, levels, wrap) {
    const gl = this.gl, texture = gl.createTexture();
    const [internal, format] = map.channels === 1 ? [gl.R8, gl.RED] : [map.kind === "color" ? gl.SRGB8_ALPHA8 : gl.RGBA8, gl.RGBA];
    gl.bindTexture(gl.TEXTURE_2D, texture);
    levels.forEach((l, i) => gl.texImage2D(gl.TEXTURE_2D, i, internal, l.width, l.height, 0, format, gl.UNSIGNED_BYTE, l.values));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAX_LEVEL, levels.length - 1);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
    return texture;
  }

  // Draws what `view` says, at view.pane pixels a side. `source` as in the shader.
  draw(view, source, gain = 0) {
    const gl = this.gl, define = view.packed ? "#define EXEMPLAR_PACKED_UV\n" : "";
    const {program, at} = this.programs[define] ||= this.program(define);
    if (this.canvas.width !== view.pane) this.canvas.width = this.canvas.height = view.pane;
    gl.viewport(0, 0, view.pane, view.pane);
    gl.useProgram(program);
    const bind = (unit, name, texture) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(at(name), unit);
    };
    bind(0, "uvMap", view.packed ? this.indices : this.plain);
    bind(1, "uvPalette", this.palette);
    const names = view.map === "lit" ? ["base_color", "normal", "roughness", "ambient_occlusion"] : [view.map];
    for (let i = 0; i < 4; i++) {
      const name = names[i] || names[0], map = this.maps.get(name) || this.absent[name];
      bind(2 + i, `exemplar${i}`, map.exemplar);
      bind(6 + i, `far${i}`, map.far);
      bind(10 + i, `whole${i}`, map.whole);
      if (this.anisotropy) gl.texParameterf(gl.TEXTURE_2D, this.anisotropy.TEXTURE_MAX_ANISOTROPY_EXT, view.probes);
    }
    gl.uniform2i(at("exemplarSize"), ...this.uv.exemplar);
    gl.uniform2i(at("outputWraps"), 1, 1);
    gl.uniform1i(at("farLevel"), farLevel);
    gl.uniform1i(at("uvTileShift"), this.pack.shift);
    gl.uniform1i(at("uvPaletteRows"), this.pack.rows);
    gl.uniform2f(at("pane"), view.pane, view.pane);
    gl.uniform2f(at("centre"), view.x, view.y);
    gl.uniform1f(at("zoom"), view.zoom);
    gl.uniform1f(at("tilt"), view.tilt * Math.PI / 180);
    gl.uniform1i(at("source"), source);
    gl.uniform1i(at("look"), view.look);
    gl.uniform1i(at("probes"), view.probes);
    gl.uniform1f(at("gain"), gain);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  pixels(view, source) {
    this.draw(view, source);
    const gl = this.gl, values = new Uint8Array(4 * view.pane * view.pane);
    gl.readPixels(0, 0, view.pane, view.pane, gl.RGBA, gl.UNSIGNED_BYTE, values);
    return values;
  }
}

const sources = {runTime: 0, resolved: 1, reference: 2, mistake: 3};

// Mean and greatest difference in 8-bit steps; `counts` may leave pixels out.
function compare(a, b, counts = () => true) {
  let sum = 0, most = 0, n = 0;
  for (let i = 0; i < a.length; i += 4) {
    if (!counts(i / 4)) continue;
    for (let c = 0; c < 3; c++) {
      const d = Math.abs(a[i + c] - b[i + c]);
      sum += d;
      most = Math.max(most, d);
    }
    n += 3;
  }
  return {mean: n ? sum / n : 0, most, share: n / (a.length / 4 * 3)};
}

// For a view without tilt: whether the four texels around the place that a pixel shows lie in one piece.
function insidePieces(view, uv) {
  const wrapped = (v, n) => ((v % n) + n) % n;
  const origin = (x, y) => {
    const i = wrapped(y, uv.height) * uv.width + wrapped(x, uv.width);
    return (uv.values[2 * i] - x) * 65536 + uv.values[2 * i + 1] - y;
  };
  return (i) => {
    const row = view.pane - 1 - Math.floor(i / view.pane);
    const x = Math.floor(view.x + (i % view.pane + 0.5 - view.pane / 2) / view.zoom - 0.5);
    const y = Math.floor(view.y + (row + 0.5 - view.pane / 2) / view.zoom - 0.5);
    const o = origin(x, y);
    return o === origin(x + 1, y) && o === origin(x, y + 1) && o === origin(x + 1, y + 1);
  };
}

// ---- Memory

const sizeOf = (levels, perTexel) => levels.reduce((sum, l) => sum + l.width * l.height, 0) * perTexel;
const withUnit = (bytes) => bytes >= 10 * 2 ** 20 ? `${(bytes / 2 ** 20).toFixed(1)} MiB` :
  bytes >= 2 ** 20 ? `${(bytes / 2 ** 20).toFixed(2)} MiB` : `${(bytes / 1024).toFixed(0)} KiB`;

function showMemory(uv, pack, maps) {
  // Block compression: BC7 or BC5 takes a byte for a texel, BC4 half a byte.
  const formats = [["uncompressed", (m) => m.channels], ["BC", (m) => m.channels === 1 ? 0.5 : 1]];
  const all = (perTexel, levelsOf) => maps.reduce((sum, m) => sum + sizeOf(levelsOf(m), perTexel(m)), 0);
  const uvBytes = {plain: uv.values.byteLength, packed: pack.indices.byteLength + pack.palette.values.byteLength};
  const columns = formats.map(([, f]) => {
    const whole = all(f, (m) => m.wholeMips), exemplar = all(f, (m) => m.exemplarMips), far = all(f, (m) => m.wholeMips.slice(farLevel));
    return {whole, exemplar, far, plain: exemplar + far + uvBytes.plain, packed: exemplar + far + uvBytes.packed};
  });
  const share = (a, b) => (b / a).toFixed(1);
  const rows = [
    ["Resolved maps", (c) => withUnit(c.whole), "sum"],
    ["Exemplar", (c) => withUnit(c.exemplar)],
    [`Far maps (levels from ${farLevel} on)`, (c) => withUnit(c.far)],
    ["uv map, RG16", () => withUnit(uvBytes.plain)],
    ["Run time, RG16 uv map", (c) => withUnit(c.plain), "sum"],
    ["… smaller by a factor of", (c) => share(c.plain, c.whole)],
    ["uv map, packed", () => withUnit(uvBytes.packed)],
    ["Run time, packed uv map", (c) => withUnit(c.packed), "sum"],
    ["… smaller by a factor of", (c) => share(c.packed, c.whole)],
  ];
  const table = $("memory");
  const add = (cells, kind, tag = "td") => {
    const row = table.insertRow();
    if (kind) row.className = kind;
    for (const text of cells) row.appendChild(document.createElement(tag)).textContent = text;
  };
  add(["All maps with mips", ...formats.map(([name]) => name)], "", "th");
  for (const [name, value, kind] of rows) add([name, ...columns.map(value)], kind);
  $("memory-note").textContent = `${maps.length} maps: ${maps.map((m) => m.name).join(", ")}. This page draws from ` +
    `uncompressed ones: 4 bytes a texel for colours and normals, 1 for one-channel maps. BC would be block compression ` +
    `(BC7, BC5, BC4): 1 byte, and half a byte.`;
  tell({bytesWhole: columns[0].whole, bytesRuntime: columns[0].plain, bytesPacked: columns[0].packed,
        bytesUv: uvBytes.plain, bytesUvPacked: uvBytes.packed});
}

// ---- The page

// `write` puts the red, green and blue of pixel i at bytes[o] and after.
function paint(canvas, width, height, write) {
  [canvas.width, canvas.height] = [width, height];
  canvas.style.aspectRatio = `${width} / ${height}`;
  const context = canvas.getContext("2d"), image = context.createImageData(width, height), bytes = image.data.fill(255);
  for (let i = 0; i < width * height; i++) write(i, bytes, 4 * i);
  context.putImageData(image, 0, 0);
}

function showStores(uv, pack, maps, name) {
  const map = maps.find((m) => m.name === name) || maps.find((m) => m.name === "base_color") || maps[0];
  const n = map.channels;
  paint($("exemplar"), map.width, map.height, (i, bytes, o) => {
    for (let c = 0; c < 3; c++) bytes[o + c] = map.values[n * i + (n === 1 ? 0 : c)];
  });
  $("exemplar-caption").textContent = `The exemplar, ${map.width} × ${map.height}: ${map.name}`;
}

async function main() {
  const uv = await readUv(Uint8Array.from(atob($("uv-file").textContent.trim()), (c) => c.charCodeAt(0)));
  const maps = [...document.querySelectorAll("img[data-map]")].map(readMap);
  for (const m of maps) {
    if (m.width !== uv.exemplar[0] || m.height !== uv.exemplar[1])
      throw new Error(`${m.name} has ${m.width}x${m.height} pixels, but the uv map was made for ${uv.exemplar.join("x")}`);
    const whole = resolved(m, uv);
    m.exemplarMips = mipsOf(m);
    m.wholeMips = mipsOf(whole);
  }
  // The test puts the maps that terrazzo resolved into the page: they must be these.
  for (const image of document.querySelectorAll("img[data-resolved]")) {
    const theirs = readMap(image), ours = resolved(maps.find((m) => m.name === image.dataset.resolved), uv);
    tell({resolvedUnequal: Number(document.body.dataset.resolvedUnequal || 0) + ours.values.filter((v, i) => v !== theirs.values[i]).length});
  }
  const pack = packed(uv);
  const renderer = new Renderer(uv, pack, maps);

  const form = $("form"), has = (name) => maps.some((m) => m.name === name);
  if (has("base_color") && has("normal")) form.map.add(new Option("lit", "lit"));
  for (const m of maps) form.map.add(new Option(m.name.replaceAll("_", " "), m.name));
  const number = (name, fallback) => query.has(name) ? Number(query.get(name)) : fallback;
  const view = {};
  const choose = () => {
    form.map.value = query.get("map") || (has("base_color") ? "base_color" : maps[0].name);
    form.zoom.value = Math.log2(number("zoom", 1));
    form.tilt.value = number("tilt", 0);
    form.gain.value = number("gain", 4);
    form.packed.checked = number("packed", 0) > 0;
    form.wrong.checked = number("wrong", 0) > 0;
    form.probes.checked = number("probes", 1) > 1;
    Object.assign(view, {x: number("x", uv.width / 2), y: number("y", uv.height / 2), zoom: number("zoom", 1)});
  };

  const draw = (figures) => {
    view.pane = number("pane", 0) || Math.max(64, 2 * Math.round($("runtime").clientWidth * devicePixelRatio / 2));
    Object.assign(view, {map: form.map.value, tilt: Number(form.tilt.value), packed: form.packed.checked,
                         probes: form.probes.checked ? number("probes", 1) > 1 ? number("probes", 1) : 8 : 1});
    const map = maps.find((m) => m.name === view.map);
    view.look = !map ? 3 : {color: 0, normal: 1, data: map.channels === 1 ? 2 : 4}[map.kind];
    $("zoom-text").textContent = view.zoom >= 1 ? `${+view.zoom.toFixed(2)} : 1` : `1 : ${+(1 / view.zoom).toFixed(2)}`;
    $("tilt-text").textContent = `${view.tilt}°`;
    const source = form.wrong.checked ? sources.mistake : sources.runTime, gain = Number(form.gain.value);
    const show = (id, from, gain) => {
      renderer.draw(view, from, gain);
      const canvas = $(id);
      if (canvas.width !== view.pane) canvas.width = canvas.height = view.pane;
      canvas.getContext("2d").drawImage(renderer.canvas, 0, 0);
    };
    show("runtime", source);
    show("resolved", sources.resolved);
    show("difference", source, gain);
    if (!figures) return;
    const a = renderer.pixels(view, source), b = renderer.pixels(view, sources.resolved);
    const all = compare(a, b);
    $("figures").textContent = `Difference × ${gain}: mean ${all.mean.toFixed(2)}, greatest ${all.most} of 255`;
    tell({mean: all.mean.toFixed(3), most: all.most, pane: view.pane});
    return [a, b, source];
  };
  let waiting = 0;
  const redraw = () => {
    waiting ||= requestAnimationFrame(() => {
      waiting = 0;
      draw(true);
    });
  };
  form.addEventListener("input", (e) => {
    if (e.target.name === "zoom") view.zoom = 2 ** Number(form.zoom.value);
    if (e.target.name === "map") showStores(uv, pack, maps, form.map.value);
    redraw();
  });
  $("one").addEventListener("click", () => {
    Object.assign(view, {zoom: 1, x: Math.round(view.x), y: Math.round(view.y)});
    form.zoom.value = form.tilt.value = 0;
    redraw();
  });
  addEventListener("resize", redraw);
  for (const id of ["runtime", "resolved", "difference"]) {
    const canvas = $(id);
    canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      form.zoom.value = Math.log2(view.zoom) - e.deltaY * (e.deltaMode ? 0.05 : 0.002);
      view.zoom = 2 ** Number(form.zoom.value);
      redraw();
    }, {passive: false});
    canvas.addEventListener("pointerdown", (e) => canvas.setPointerCapture(e.pointerId));
    canvas.addEventListener("pointermove", (e) => {
      if (!canvas.hasPointerCapture(e.pointerId)) return;
      const scale = view.pane / canvas.clientWidth / view.zoom;
      view.x -= e.movementX * scale;
      view.y -= e.movementY * scale;
      redraw();
    });
  }

  paint($("uv"), uv.width, uv.height, (i, bytes, o) => {
    for (let c = 0; c < 2; c++) bytes[o + c] = 255 * uv.values[2 * i + c] / uv.exemplar[c];
    bytes[o + 2] = 0;
  });
  $("uv-caption").textContent = `The uv map, ${uv.width} × ${uv.height}; packed with at most ${pack.most} offsets in a tile of ${1 << pack.shift}²`;
  showMemory(uv, pack, maps);
  $("state").hidden = true;
  const measure = (a, b, source) => {
    const truth = renderer.pixels(view, sources.reference);
    tell({meanRuntime: compare(a, truth).mean.toFixed(3), meanResolved: compare(b, truth).mean.toFixed(3)});
    if (view.tilt === 0) {
      const inside = compare(a, b, insidePieces(view, uv));
      tell({mostInside: inside.most, shareInside: inside.share.toFixed(3)});
    }
    // What half a pixel's motion changes: where it changes more than in the resolved maps, the picture shimmers.
    const moved = {...view, x: view.x + 0.5 / view.zoom};
    tell({changeRuntime: compare(a, renderer.pixels(moved, source)).mean.toFixed(3),
          changeResolved: compare(b, renderer.pixels(moved, sources.resolved)).mean.toFixed(3)});
    tell({mostPacked: compare(a, renderer.pixels({...view, packed: !view.packed}, source)).most});
  };
  globalThis.look = (search) => {
    query = new URLSearchParams(search);
    choose();
    showStores(uv, pack, maps, form.map.value);
    const drawn = draw(true);
    if (query.has("figures")) measure(...drawn);
    tell({ready: "yes", errors: "", glError: renderer.gl.getError(), overflow: document.documentElement.scrollWidth - document.documentElement.clientWidth});
  };
  look(location.search);
}
addEventListener("load", () => main().catch((e) => fail(e.message)));
