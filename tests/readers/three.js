// Exports as programs read them: glTF by three.js, packed maps by shaders that take the channels as the engines'
// documentation has them.
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { USDLoader } from 'three/addons/loaders/USDLoader.js';
import { engines } from './engines.js';
import { cameraOver, loaded, pixelsOf, planeOf, sceneOf, tell, work } from './work.js';

const renderer = new THREE.WebGLRenderer();

function floats(scene, camera, [width, height]) {
  const target = new THREE.WebGLRenderTarget(width, height, {type: THREE.FloatType});
  const out = new Float32Array(width * height * 4);
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, out);
  target.dispose();
  return out;
}

// Where a standard material takes each map from, as a shader sees it.
const places = {
  base_color: ['map', 't.rgb'],
  normal: ['normalMap', 't.rgb'],
  roughness: ['roughnessMap', 'vec3(t.g)'],
  metallic: ['metalnessMap', 'vec3(t.b)'],
  ambient_occlusion: ['aoMap', 'vec3(t.r)'],
  emission: ['emissiveMap', 't.rgb'],
};

const decoded = x => x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;

// How far what the material has for each map is from the map itself, in steps of 255 of linear values.
async function compareMaps(job, object, mesh, camera, told) {
  told.maps = {};
  const lit = mesh.material, [width, height] = job.size;
  for (const [map, file] of Object.entries(job.maps ?? {})) {
    const [place, value] = places[map], texture = lit[place];
    if (!texture) {
      told.maps[map] = 'nothing is connected';
      continue;
    }
    texture.updateMatrix();
    mesh.material = new THREE.ShaderMaterial({
      uniforms: {map: {value: texture}, transform: {value: texture.matrix}},
      vertexShader: 'uniform mat3 transform; varying vec2 at; void main() { at = (transform * vec3(uv, 1)).xy; ' +
                    'gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1); }',
      fragmentShader: `uniform sampler2D map; varying vec2 at; void main() { vec4 t = texture2D(map, at); gl_FragColor = vec4(${value}, 1); }`,
    });
    const found = floats(new THREE.Scene().add(object), camera, job.size), expected = await pixelsOf('/' + file), repeats = job.repeats ?? 1;
    let most = 0, sum = 0;
    for (let y = 0; y < height; y++)
      for (let x = 0; x < width; x++)
        for (let c = 0; c < 3; c++) {
          // The map has one texel a pixel.
          const u = x % (width / repeats), v = y % (height / repeats);
          let want = expected.data[(v * expected.width + u) * 4 + c] / 255;
          if (map === 'base_color' || map === 'emission') want = decoded(want);
          const d = 255 * Math.abs(want - found[((height - 1 - y) * width + x) * 4 + c]);
          most = Math.max(most, d);
          sum += d;
        }
    told.maps[map] = {mean: +(sum / (width * height * 3)).toFixed(2), most: +most.toFixed(1)};
  }
  mesh.material = lit;
}

async function gltf(job) {
  const {scene} = await new GLTFLoader().loadAsync('/' + job.file);
  return scene;
}

// three.js takes the scale of a texture of normals for the strength of the normals; that it is 2 says no more than that
// values of 0..1 become vectors.
async function usd(job) {
  const object = await new USDLoader().loadAsync('/' + job.file);
  await loaded();
  object.traverse(o => {
    if (o.isMesh && o.material.normalScale?.equals(new THREE.Vector2(2, 2))) o.material.normalScale.set(1, 1);
  });
  return object;
}

// A texture's values through a shader, as a texture.
function through(size, value, textures) {
  const target = new THREE.WebGLRenderTarget(...size, {
    type: THREE.FloatType, wrapS: THREE.RepeatWrapping, wrapT: THREE.RepeatWrapping, minFilter: THREE.NearestFilter,
    magFilter: THREE.NearestFilter,
  });
  const uniforms = Object.fromEntries(Object.entries(textures).map(([name, texture]) => [name, {value: texture}]));
  const samplers = Object.keys(uniforms).map(name => `uniform sampler2D ${name}_file;`).join(' ');
  const quad = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
    uniforms: Object.fromEntries(Object.entries(uniforms).map(([name, uniform]) => [name + '_file', uniform])),
    vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0, 1); }',
    fragmentShader: `${samplers} varying vec2 at; void main() {
      ${Object.keys(uniforms).map(name => `vec4 ${name} = texture2D(${name}_file, at);`).join(' ')} gl_FragColor = vec4(${value}, 1); }`,
  }));
  renderer.setRenderTarget(target);
  renderer.render(new THREE.Scene().add(quad), new THREE.Camera());
  return target.texture;
}

async function engine(job) {
  const its = engines[job.engine], load = async (suffix, space) => {
    const texture = await new THREE.TextureLoader().loadAsync(`/${job.file.replace('{}', suffix)}.png`);
    texture.colorSpace = space;
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    return texture;
  };
  const colour = await load(its.colour, THREE.SRGBColorSpace);
  const packed = await load(its.packed, THREE.NoColorSpace), normal = await load(its.normal, THREE.NoColorSpace);
  const size = [packed.image.width, packed.image.height], orm = through(size, its.surface, {packed});
  return planeOf(new THREE.MeshStandardMaterial({
    map: colour, normalMap: through(size, its.vector, {normal}), aoMap: orm, roughnessMap: orm, metalnessMap: orm,
    roughness: 1, metalness: 1,
  }), job.repeats);
}

// MaterialX' own library, which checks the document and writes the shader. What loads its images is left to say that they
// repeat: the definition of tiledimage says so.
async function materialx(job) {
  globalThis.NEEDLE_MATERIALX_LOCATION = '/node_modules/@needle-tools/materialx/bin/';
  const {createMaterialXMaterial} = await import('/node_modules/@needle-tools/materialx/src/loader/loader.three.js');
  const {ready, state} = await import('/node_modules/@needle-tools/materialx/src/materialx.js');
  await ready();
  const text = await (await fetch('/' + job.file)).text(), document = state.materialXModule.createDocument();
  document.setDataLibrary(state.materialXStdLib);
  await state.materialXModule.readFromXmlString(document, text, '');
  if (!document.validate()) throw new Error('the document is not valid');
  const folder = job.file.replace(/[^/]*$/, ''), textures = [];
  const getTexture = file => {
    const texture = new THREE.TextureLoader().loadAsync('/' + folder + file);
    textures.push(texture);
    return texture.then(t => {
      t.wrapS = t.wrapT = THREE.RepeatWrapping;
      return t;
    });
  };
  let frame = 0;
  const material = await createMaterialXMaterial(text, 0, {cacheKey: job.name, getTexture}, {}, {getTime: () => 0, getFrame: () => frame++});
  await Promise.all(textures);
  await loaded();
  return planeOf(material);
}

const readers = {gltf, usd, engine, materialx};

work(async (job, told) => {
  const object = await readers[job.reader](job), scene = sceneOf(job);
  scene.add(object);
  const {camera, size} = cameraOver(object);
  told.metres = [size.x, size.y].map(x => +x.toFixed(4));
  let mesh;
  object.traverse(o => { if (o.isMesh) mesh = o; });
  if (job.maps) await compareMaps(job, object, mesh, camera, told);
  scene.add(object);
  if (job.reader === 'materialx') floats(scene, camera, job.size);  // it prepares the surroundings while it renders
  await loaded();
  await tell(job, floats(scene, camera, job.size), told);
});
