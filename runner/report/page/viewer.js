// The lit material of a report, with its controls. bundle.sh makes viewer.min.js of it.
import { LitView } from './lit_material.ts';

const size = 640;

class Viewer {
  constructor(host, materials, sourceOf) {
    this.materials = materials;
    this.sourceOf = sourceOf;
    this.inputs = {};
    this.view = new LitView(size, (settings) => this.follow(settings), (brightness) => {
      document.body.dataset.brightness = brightness.toFixed(1);  // for tests
    });
    host.replaceChildren(this.view.canvas, this.form());
    this.choose(0);
  }

  choose(index) {
    const material = this.materials[index];
    const maps = Object.fromEntries(Object.entries(material.maps).map(([meaning, id]) => [meaning, this.sourceOf(id)]));
    this.view.show({...material, maps});
  }

  follow(settings) {
    for (const [name, input] of Object.entries(this.inputs)) {
      input.value = settings[name];
      input.nextSibling.textContent = input.shown(settings[name]);
    }
  }

  form() {
    const form = document.createElement("form");
    const label = (text) => form.append(Object.assign(document.createElement("label"), {textContent: text}));
    const choice = (text, options, chosen) => {
      label(text);
      const select = document.createElement("select");
      options.forEach(([value, shown]) => select.add(new Option(shown, value)));
      select.ariaLabel = text;
      select.onchange = () => chosen(select.value);
      form.append(select, document.createElement("span"));
    };
    const slider = (name, text, min, max, step, shown) => {
      label(text);
      const input = Object.assign(document.createElement("input"), {type: "range", min, max, step, ariaLabel: text});
      input.value = this.view.settings[name];
      input.shown = shown;
      input.oninput = () => {
        this.view.set(name, Number(input.value));
        this.follow(this.view.settings);
      };
      form.append(input, Object.assign(document.createElement("span"), {textContent: shown(this.view.settings[name])}));
      this.inputs[name] = input;
    };
    const degrees = (value) => Math.round(value) + "\u00b0";
    if (this.materials.length > 1)
      choice("material", this.materials.map((m, i) => [i, m.title]), (index) => this.choose(index));
    choice("shape", ["plane", "sphere", "cube"].map((shape) => [shape, shape]), (shape) => this.view.set("shape", shape));
    slider("displacement", "displacement", 0, 0.2, 0.005, (v) => v.toFixed(3));
    slider("tiling", "tiling", 1, 4, 1, (v) => v + "\u00d7" + v);
    slider("azimuth", "light from", 0, 360, 1, degrees);
    slider("elevation", "light height", 5, 90, 1, degrees);
    slider("tilt", "tilt", 0, 80, 1, degrees);
    const help = document.createElement("p");
    help.className = "quiet";
    help.textContent = "Drag in the picture to turn the material; with Shift or the right button to move the light.";
    form.append(help);
    return form;
  }
}

// Throws if there is no WebGL. `sourceOf`: a picture's data URI by its id.
globalThis.lightMaterials = (host, materials, sourceOf) => new Viewer(host, materials, sourceOf);
