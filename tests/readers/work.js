// What the pages share: how they see materials, and how what they see is compared. browser.mjs gives them their jobs.
import * as THREE from 'three';

// Colours as preview has them: as they are up to 0.75, then a shoulder; sRGB.
function displayed(x) {
  if (x > 0.75) {
    const over = (x - 0.75) / 0.25;
    x = 0.75 + 0.25 * over / (1 + over);
  }
  x = Math.max(0, x);
  return Math.round(255 * Math.min(1, x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}

function canvasOf(width, height) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  return canvas.getContext('2d', {willReadFrequently: true, colorSpace: 'srgb'});
}

// A picture's pixels, rows from the top.
export async function pixelsOf(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url} is not there`);
  const image = await createImageBitmap(await response.blob(), {premultiplyAlpha: 'none', colorSpaceConversion: 'none'});
  const context = canvasOf(image.width, image.height);
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, image.width, image.height);
}

// Surroundings of brightness 0.8, a little brighter towards the top of the picture. Diffuse light averages over half of
// them, so that they vary half as much again as in preview. Made once, since three.js filters them for long.
let around;
function surroundings() {
  if (around) return around;
  const rows = 64, data = new Float32Array(rows * 2 * rows * 4);
  for (let y = 0; y < rows; y++)
    data.fill(0.8 + 0.3 * Math.sin(((y + 0.5) / rows - 0.5) * Math.PI), y * 2 * rows * 4, (y + 1) * 2 * rows * 4);
  around = new THREE.DataTexture(data, 2 * rows, rows, THREE.RGBAFormat, THREE.FloatType);
  around.mapping = THREE.EquirectangularReflectionMapping;
  around.colorSpace = THREE.LinearSRGBColorSpace;
  around.minFilter = around.magFilter = THREE.LinearFilter;
  around.needsUpdate = true;
  return around;
}

// The light of preview.
export function sceneOf(job) {
  const scene = new THREE.Scene(), turn = Math.PI / 180, azimuth = job.azimuth * turn, elevation = job.elevation * turn;
  const light = new THREE.DirectionalLight(0xffffff, Math.PI);
  light.position.set(Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation));
  scene.add(light);
  scene.environment = surroundings();
  scene.environmentIntensity = job.ambient;
  return scene;
}

// Images load beside what asks for them.
let busy = false;
THREE.DefaultLoadingManager.onStart = () => { busy = true; };
THREE.DefaultLoadingManager.onLoad = () => { busy = false; };
export async function loaded() {
  const pause = () => new Promise(done => setTimeout(done, 50));
  do await pause(); while (busy);
  await pause();
}

// A plane with tangents, 1 m wide, which shows the maps so often.
export function planeOf(material, repeats = 1) {
  const geometry = new THREE.PlaneGeometry(1, 1);
  geometry.attributes.uv.array.forEach((x, i, all) => { all[i] = x * repeats; });
  geometry.setAttribute('tangent', new THREE.BufferAttribute(new Float32Array([1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1]), 4));
  return new THREE.Mesh(geometry, material);
}

// Sees exactly what lies in the bounds, from above.
export function cameraOver(object) {
  const box = new THREE.Box3().setFromObject(object), size = box.getSize(new THREE.Vector3()), at = box.getCenter(new THREE.Vector3());
  const camera = new THREE.OrthographicCamera(-size.x / 2, size.x / 2, size.y / 2, -size.y / 2, 0.1, 10);
  camera.position.set(at.x, at.y, at.z + 5);
  camera.lookAt(at);
  camera.updateMatrixWorld();
  return {camera, size};
}

// How far two pictures are apart, in steps of 255: on average, and in the worst of 8 x 8 blocks, by colour.
export function difference(a, b, width, height) {
  const blocks = new Float64Array(64 * 3);
  let sum = 0;
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++)
      for (let c = 0; c < 3; c++) {
        const d = a[(y * width + x) * 4 + c] - b[(y * width + x) * 4 + c];
        sum += Math.abs(d);
        blocks[(Math.floor(y * 8 / height) * 8 + Math.floor(x * 8 / width)) * 3 + c] += d;
      }
  const round = x => Math.round(x * 100) / 100;
  return {mean: round(sum / (width * height * 3)), block: round(Math.max(...blocks.map(Math.abs)) * 64 / (width * height))};
}

// `rendered`: linear floats, rows from the bottom.
export async function tell(job, rendered, told) {
  const [width, height] = job.size, picture = new ImageData(width, height);
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const from = ((height - 1 - y) * width + x) * 4, to = (y * width + x) * 4;
      for (let c = 0; c < 3; c++) picture.data[to + c] = displayed(rendered[from + c]);
      picture.data[to + 3] = 255;
    }
  if (job.expected) {
    const expected = await pixelsOf('/' + job.expected);
    if (expected.width !== width || expected.height !== height) console.error(`${job.expected} is ${expected.width} x ${expected.height}`);
    else Object.assign(told, difference(picture.data, expected.data, width, height));
  }
  if (job.picture) {
    const context = canvasOf(width, height);
    context.putImageData(picture, 0, 0);
    told.picture = context.canvas.toDataURL();
  }
}

// `one` does a job, and adds to what is told of it.
export function work(one) {
  globalThis.work = async job => {
    const told = {name: job.name};
    try {
      await one(job, told);
    } catch (error) {
      console.error(error.stack ?? error);
    }
    return told;
  };
}
