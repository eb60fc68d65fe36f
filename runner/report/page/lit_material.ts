// A material on a plane, a ball or a cube under a light that moves: in reports and in the graph editor.
import {
  BackSide, BoxGeometry, BufferAttribute, BufferGeometry, Color, DirectionalLight, Mesh, MeshBasicMaterial, MeshStandardMaterial,
  PerspectiveCamera, PlaneGeometry, PMREMGenerator, RepeatWrapping, Scene, SphereGeometry, SRGBColorSpace, Texture, WebGLRenderer,
} from 'three';

export type Shape = 'plane' | 'sphere' | 'cube';
export interface LitSettings {
  shape: Shape; displacement: number; tiling: number; azimuth: number; elevation: number; turn: number; tilt: number;
  distance: number;  // of the camera, 1: all is seen
}
/// `maps`: sources of pictures by what they mean, such as "base_color".
export interface LitMaterial {width: number; height: number; maps: Record<string, string>; normal_y?: string}

// Where three takes a map from. Heights displace; bumps come from the normals.
const slots = {
  base_color: 'map', normal: 'normalMap', height: 'displacementMap', roughness: 'roughnessMap',
  ambient_occlusion: 'aoMap', metallic: 'metalnessMap', opacity: 'alphaMap', emission: 'emissiveMap',
} as const;
type Meaning = keyof typeof slots;

// Even surroundings, brighter above: metals need something to reflect.
function surroundings(renderer: WebGLRenderer): Texture {
  const scene = new Scene();
  scene.add(new Mesh(new SphereGeometry(20, 24, 12),
                     new MeshBasicMaterial({color: new Color().setScalar(0.35), side: BackSide})));
  const lamp = new Mesh(new SphereGeometry(5, 24, 12), new MeshBasicMaterial({color: new Color().setScalar(3)}));
  lamp.position.set(-4, 10, 6);
  scene.add(lamp);
  const generator = new PMREMGenerator(renderer);
  const {texture} = generator.fromScene(scene, 0, 0.1, 100, {size: 64});
  generator.dispose();
  return texture;
}

// Sides of a cube, the poles of a ball and its seam show different heights at the same place: a surface that is displaced
// by them would gape there. Displacement ends before these borders.
function ended(geometry: BufferGeometry, margin: number): BufferGeometry {
  const uv = geometry.getAttribute('uv'), share = new Float32Array(uv.count);
  for (let i = 0; i < uv.count; ++i) {
    const u = uv.getX(i), v = uv.getY(i), inside = margin ? Math.min(1, Math.max(0, Math.min(u, 1 - u, v, 1 - v) / margin)) : 1;
    share[i] = inside * inside * (3 - 2 * inside);
  }
  return geometry.setAttribute('displaced', new BufferAttribute(share, 1));
}
function displaceByShare(material: MeshStandardMaterial) {
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = 'attribute float displaced;\n' + shader.vertexShader.replace('#include <displacementmap_vertex>', `
#ifdef USE_DISPLACEMENTMAP
  transformed += normalize(objectNormal) * displaced *
    (texture2D(displacementMap, vDisplacementMapUv).x * displacementScale + displacementBias);
#endif`);
  };
}

function loaded(source: string, isColour: boolean): Promise<Texture | null> {
  const texture = new Texture();
  texture.wrapS = texture.wrapT = RepeatWrapping;
  if (isColour) texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  const image = new Image();
  return new Promise((done) => {
    image.onload = () => {
      texture.image = image;
      texture.needsUpdate = true;
      done(texture);
    };
    // A picture that has gone leaves the others to be seen.
    image.onerror = () => done(null);
    image.src = source;
  });
}

export class LitView {
  readonly settings: LitSettings =
    {shape: 'plane', displacement: 0.04, tiling: 1, azimuth: 135, elevation: 40, turn: 0, tilt: 30, distance: 1};
  readonly canvas: HTMLCanvasElement;
  #renderer: WebGLRenderer;
  #scene = new Scene();
  #camera = new PerspectiveCamera(32, 1, 0.1, 50);
  #light = new DirectionalLight(0xffffff, 2.6);
  #mesh = new Mesh<BufferGeometry, MeshStandardMaterial>(new BufferGeometry(), new MeshStandardMaterial());
  #described: LitMaterial = {width: 1, height: 1, maps: {}};
  #textures = new Map<Meaning, {source: string; texture: Texture}>();
  #isWaiting = false;
  #round = 0;

  /// Throws if there is no WebGL. `moved`: the pointer has changed settings. `drawn`: the mean brightness around the middle.
  constructor(size: number, private moved: (settings: LitSettings) => void, private drawn?: (brightness: number) => void) {
    this.#renderer = new WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    this.canvas = this.#renderer.domElement;
    this.#scene.background = new Color(0x1e1f21);
    this.#scene.environment = surroundings(this.#renderer);
    this.#scene.environmentIntensity = 0.7;
    this.#mesh.visible = false;
    this.#scene.add(this.#light, this.#mesh);
    this.resize(size, size);
    this.#followPointer();
  }

  resize(width: number, height: number) {
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.draw();
  }

  /// What was there is shown until all maps are loaded.
  async show(described: LitMaterial) {
    const round = ++this.#round;
    const wanted = Object.entries(described.maps).filter(([meaning]) => meaning in slots) as [Meaning, string][];
    const textures = await Promise.all(wanted.map(async ([meaning, source]) => {
      const before = this.#textures.get(meaning);
      if (before?.source === source) return [meaning, before] as const;
      const texture = await loaded(source, meaning === 'base_color' || meaning === 'emission');
      return [meaning, texture && {source, texture}] as const;
    }));
    if (round !== this.#round) return;
    const kept = new Set(textures.map(([, found]) => found?.texture));
    for (const {texture} of this.#textures.values()) if (!kept.has(texture)) texture.dispose();
    this.#textures = new Map(textures.filter((entry): entry is [Meaning, {source: string; texture: Texture}] => entry[1] !== null));
    this.#described = described;

    const material = new MeshStandardMaterial({roughness: this.#textures.has('roughness') ? 1 : 0.8, metalness: 0});
    displaceByShare(material);
    for (const [meaning, {texture}] of this.#textures) material[slots[meaning]] = texture;
    if (material.metalnessMap) material.metalness = 1;
    if (material.emissiveMap) material.emissive = new Color(1, 1, 1);
    if (material.alphaMap) material.transparent = true;
    // three reads green as up, as OpenGL does.
    if (described.normal_y === 'down') material.normalScale.y = -1;
    this.#mesh.material.dispose();
    this.#mesh.material = material;
    this.#mesh.visible = true;
    this.#reshape();
    this.draw();
  }

  set<Name extends keyof LitSettings>(name: Name, value: LitSettings[Name]) {
    this.settings[name] = value;
    if (name === 'shape') this.#reshape();
    this.draw();
  }

  #reshape() {
    const {width: w, height: h} = this.#described, longer = Math.max(w, h), {shape} = this.settings;
    this.#mesh.geometry.dispose();
    // A plane has no other side to meet.
    this.#mesh.geometry = shape === 'plane' ? ended(new PlaneGeometry(2 * w / longer, 2 * h / longer, 256, 256), 0)
      : shape === 'sphere' ? ended(new SphereGeometry(0.85, 384, 192), 0.02)
        : ended(new BoxGeometry(1.15, 1.15 * Math.min(1.4, h / w), 1.15, 128, 128, 128), 0.03);
  }

  #apply() {
    const s = this.settings, material = this.#mesh.material, radians = Math.PI / 180, isPlane = s.shape === 'plane';
    // Around a ball the material goes twice as often as from pole to pole.
    const across = s.shape === 'sphere' ? Math.max(1, Math.round(2 * this.#described.height / this.#described.width)) : 1;
    for (const slot of Object.values(slots)) material[slot]?.repeat.set(s.tiling * across, s.tiling);
    material.displacementScale = s.displacement * 2 / s.tiling;
    material.displacementBias = -material.displacementScale / 2;
    const flat = Math.cos(s.elevation * radians);
    this.#light.position.set(flat * Math.cos(s.azimuth * radians), flat * Math.sin(s.azimuth * radians), Math.sin(s.elevation * radians));
    // A ball and a cube are seen a little from above at the usual tilt of a plane.
    this.#mesh.rotation.set(isPlane ? -s.tilt * radians : (s.shape === 'cube' ? 0.45 : 0.2) + (30 - s.tilt) * radians, 0, 0);
    if (isPlane) this.#mesh.rotateZ(s.turn * radians);
    else this.#mesh.rotateY((s.turn + (s.shape === 'cube' ? 35 : 0)) * radians);
    // Farther away where the picture is narrow, so that all of it is seen.
    this.#camera.position.set(0, 0, 3.9 * s.distance * Math.max(1, 1 / this.#camera.aspect));
    this.#camera.lookAt(0, 0, 0);
  }

  /// Once for all changes until the next frame.
  draw() {
    if (this.#isWaiting) return;
    this.#isWaiting = true;
    requestAnimationFrame(() => {
      this.#isWaiting = false;
      this.#apply();
      this.#renderer.render(this.#scene, this.#camera);
      if (this.drawn) this.drawn(this.#brightness());
    });
  }

  #brightness(): number {
    const gl = this.#renderer.getContext(), side = 64, pixels = new Uint8Array(4 * side * side);
    gl.readPixels((this.canvas.width - side) / 2, (this.canvas.height - side) / 2, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let sum = 0;
    for (let i = 0; i < pixels.length; i += 4) sum += pixels[i]! + pixels[i + 1]! + pixels[i + 2]!;
    return sum / (3 * side * side);
  }

  // Dragging turns the material; with Shift, or the right button, it moves the light.
  #followPointer() {
    const {canvas, settings} = this;
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener('pointermove', (event) => {
      if (!event.buttons) return;
      if (!event.shiftKey && event.buttons !== 2) {
        settings.turn += event.movementX * 0.5;
        settings.tilt = Math.min(80, Math.max(0, settings.tilt - event.movementY * 0.4));
      } else {
        const box = canvas.getBoundingClientRect();
        const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
        settings.azimuth = (Math.atan2(y, x) * 180 / Math.PI + 360) % 360;
        settings.elevation = Math.max(5, 90 - 85 * Math.min(1, Math.hypot(x, y)));
      }
      this.moved(settings);
      this.draw();
    });
  }

  /// Gives back what the graphics card holds.
  dispose() {
    this.#round = Infinity;
    for (const {texture} of this.#textures.values()) texture.dispose();
    this.#mesh.geometry.dispose();
    this.#mesh.material.dispose();
    this.#renderer.dispose();
  }
}
