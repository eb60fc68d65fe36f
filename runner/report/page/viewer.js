// The lit material of a report: a plane or a ball under a light that moves. bundle.sh makes viewer.min.js of it.
import {
  BackSide, Color, DirectionalLight, Mesh, MeshBasicMaterial, MeshStandardMaterial, PerspectiveCamera, PlaneGeometry,
  PMREMGenerator, RepeatWrapping, Scene, SphereGeometry, SRGBColorSpace, Texture, WebGLRenderer,
} from "three";

const size = 640;

// Even surroundings, brighter above: metals need something to reflect.
function surroundings(renderer) {
  const scene = new Scene();
  const add = (radius, y, brightness) => {
    const ball = new Mesh(new SphereGeometry(radius, 24, 12),
                          new MeshBasicMaterial({color: new Color().setScalar(brightness), side: BackSide}));
    ball.position.y = y;
    scene.add(ball);
  };
  add(20, 0, 0.35);
  const lamp = new Mesh(new SphereGeometry(5, 24, 12), new MeshBasicMaterial({color: new Color().setScalar(3)}));
  lamp.position.set(-4, 10, 6);
  scene.add(lamp);
  const generator = new PMREMGenerator(renderer);
  const texture = generator.fromScene(scene, 0, 0.1, 100, {size: 64}).texture;
  generator.dispose();
  return texture;
}

function textureOf(source, isColour, changed) {
  const texture = new Texture();
  texture.wrapS = texture.wrapT = RepeatWrapping;
  if (isColour) texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  const image = new Image();
  image.onload = () => {
    texture.image = image;
    texture.needsUpdate = true;
    changed();
  };
  image.src = source;
  return texture;
}

// Where three takes a map from, by what it means. Heights displace; bumps come from the normals.
const slots = {
  base_color: "map", normal: "normalMap", height: "displacementMap", roughness: "roughnessMap",
  ambient_occlusion: "aoMap", metallic: "metalnessMap", opacity: "alphaMap", emission: "emissiveMap",
};

function materialOf(described, sourceOf, changed) {
  const material = new MeshStandardMaterial({roughness: described.maps.roughness ? 1 : 0.8, metalness: 0});
  for (const [meaning, id] of Object.entries(described.maps)) {
    const slot = slots[meaning];
    if (slot) material[slot] = textureOf(sourceOf(id), meaning === "base_color" || meaning === "emission", changed);
  }
  if (material.metalnessMap) material.metalness = 1;
  if (material.emissiveMap) material.emissive = new Color(1, 1, 1);
  if (material.alphaMap) material.transparent = true;
  // three reads green as up, as OpenGL does.
  if (described.normal_y === "down") material.normalScale.y = -1;
  return material;
}

class View {
  constructor(host, materials, sourceOf) {
    this.materials = materials;
    this.sourceOf = sourceOf;
    this.settings = {material: 0, shape: "plane", displacement: 0.04, tiling: 1, azimuth: 135, elevation: 40, turn: 0, tilt: 30};
    this.renderer = new WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    this.renderer.setSize(size, size, false);
    this.scene = new Scene();
    this.scene.background = new Color(0x1e1f21);
    this.scene.environment = surroundings(this.renderer);
    this.scene.environmentIntensity = 0.7;
    this.camera = new PerspectiveCamera(32, 1, 0.1, 50);
    this.light = new DirectionalLight(0xffffff, 2.6);
    this.mesh = new Mesh();
    this.scene.add(this.light, this.mesh);
    host.replaceChildren(this.renderer.domElement, this.form());
    this.followPointer(this.renderer.domElement);
    this.choose();
  }

  // A material or a shape has been chosen.
  choose() {
    const described = this.materials[this.settings.material];
    this.mesh.geometry.dispose();
    for (const texture of Object.values(this.mesh.material)) if (texture && texture.isTexture) texture.dispose();
    const [w, h] = [described.width, described.height], longer = Math.max(w, h);
    const isPlane = this.settings.shape === "plane";
    this.mesh.geometry = isPlane ? new PlaneGeometry(2 * w / longer, 2 * h / longer, 256, 256)
                                 : new SphereGeometry(0.85, 384, 192);
    this.mesh.material = materialOf(described, this.sourceOf, () => this.draw());
    this.draw();
  }

  apply() {
    const s = this.settings, material = this.mesh.material, radians = Math.PI / 180;
    const described = this.materials[s.material], isPlane = s.shape === "plane";
    // Around a ball the material goes twice as often as from pole to pole.
    const across = isPlane ? 1 : Math.max(1, Math.round(2 * described.height / described.width));
    for (const slot of Object.values(slots)) if (material[slot]) material[slot].repeat.set(s.tiling * across, s.tiling);
    material.displacementScale = s.displacement * 2 / s.tiling;
    material.displacementBias = -material.displacementScale / 2;
    const flat = Math.cos(s.elevation * radians);
    this.light.position.set(flat * Math.cos(s.azimuth * radians), flat * Math.sin(s.azimuth * radians), Math.sin(s.elevation * radians));
    this.mesh.rotation.set(isPlane ? -s.tilt * radians : 0.2, 0, 0);
    if (isPlane) this.mesh.rotateZ(s.turn * radians);
    else this.mesh.rotateY(s.turn * radians);
    this.camera.position.set(0, 0, 3.9);
    this.camera.lookAt(0, 0, 0);
  }

  // Once for all changes until the next frame.
  draw() {
    if (this.isWaiting) return;
    this.isWaiting = true;
    requestAnimationFrame(() => {
      this.isWaiting = false;
      this.apply();
      this.renderer.render(this.scene, this.camera);
      this.measure();
    });
  }

  // The mean brightness around the middle, for tests.
  measure() {
    const gl = this.renderer.getContext(), side = 64, pixels = new Uint8Array(4 * side * side);
    gl.readPixels((size - side) / 2, (size - side) / 2, side, side, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let sum = 0;
    for (let i = 0; i < pixels.length; i += 4) sum += pixels[i] + pixels[i + 1] + pixels[i + 2];
    document.body.dataset.brightness = (sum / (3 * side * side)).toFixed(1);
  }

  // Dragging moves the light; with Shift, or the right button, the material.
  followPointer(canvas) {
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (!event.buttons) return;
      if (event.shiftKey || event.buttons === 2) {
        this.set("turn", this.settings.turn + event.movementX * 0.5);
        this.set("tilt", Math.min(80, Math.max(0, this.settings.tilt - event.movementY * 0.4)));
        return;
      }
      const box = canvas.getBoundingClientRect();
      const x = 2 * (event.clientX - box.left) / box.width - 1, y = 1 - 2 * (event.clientY - box.top) / box.height;
      this.set("azimuth", (Math.atan2(y, x) * 180 / Math.PI + 360) % 360);
      this.set("elevation", Math.max(5, 90 - 85 * Math.min(1, Math.hypot(x, y))));
    });
  }

  set(name, value) {
    this.settings[name] = value;
    const input = this.inputs[name];
    if (input) {
      input.value = value;
      input.nextSibling.textContent = input.shown(value);
    }
    this.draw();
  }

  form() {
    this.inputs = {};
    const form = document.createElement("form");
    const label = (text) => form.append(Object.assign(document.createElement("label"), {textContent: text}));
    const choice = (name, text, options) => {
      label(text);
      const select = document.createElement("select");
      options.forEach(([value, shown]) => select.add(new Option(shown, value)));
      select.ariaLabel = text;
      select.onchange = () => { this.settings[name] = select.value; this.choose(); };
      form.append(select, document.createElement("span"));
    };
    const slider = (name, text, min, max, step, shown) => {
      label(text);
      const input = Object.assign(document.createElement("input"), {type: "range", min, max, step, ariaLabel: text});
      input.value = this.settings[name];
      input.shown = shown;
      input.oninput = () => this.set(name, Number(input.value));
      form.append(input, Object.assign(document.createElement("span"), {textContent: shown(this.settings[name])}));
      this.inputs[name] = input;
    };
    const degrees = (value) => Math.round(value) + "\u00b0";
    if (this.materials.length > 1) choice("material", "material", this.materials.map((m, i) => [i, m.title]));
    choice("shape", "shape", [["plane", "plane"], ["sphere", "sphere"]]);
    slider("displacement", "displacement", 0, 0.2, 0.005, (v) => v.toFixed(3));
    slider("tiling", "tiling", 1, 4, 1, (v) => v + "\u00d7" + v);
    slider("azimuth", "light from", 0, 360, 1, degrees);
    slider("elevation", "light height", 5, 90, 1, degrees);
    slider("tilt", "tilt", 0, 80, 1, degrees);
    const help = document.createElement("p");
    help.className = "quiet";
    help.textContent = "Drag in the picture to move the light; with Shift or the right button to turn the material.";
    form.append(help);
    return form;
  }
}

// Throws if there is no WebGL. `sourceOf`: a picture's data URI by its id.
globalThis.lightMaterials = (host, materials, sourceOf) => new View(host, materials, sourceOf);
