// MaterialX as the node materials of three.js read it, on WebGL.
import * as THREE from 'three';
import { MaterialXLoader } from 'three/addons/loaders/MaterialXLoader.js';
import { cameraOver, loaded, planeOf, sceneOf, tell, work } from './work.js';

const renderer = new THREE.WebGPURenderer({forceWebGL: true});
await renderer.init();

work(async (job, told) => {
  const {materials} = await new MaterialXLoader().loadAsync('/' + job.file);
  const object = planeOf(Object.values(materials)[0]), scene = sceneOf(job);
  scene.add(object);
  await loaded();
  const {camera} = cameraOver(object), [width, height] = job.size;
  const target = new THREE.RenderTarget(width, height, {type: THREE.FloatType});
  renderer.setRenderTarget(target);
  await renderer.compileAsync(scene, camera);
  renderer.render(scene, camera);
  const found = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height);
  // This renderer has the top row first.
  const rows = Array.from({length: height}, (_, y) => found.subarray((height - 1 - y) * width * 4, (height - y) * width * 4));
  await tell(job, Float32Array.from(rows.flatMap(row => [...row])), told);
});
