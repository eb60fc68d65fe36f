// What a report does beyond showing itself: zooms the graph, tells about nodes, enlarges pictures, sorts and searches, and
// starts the lit view. The page says how that went in data attributes of its body; tests read them.
"use strict";
{
  const state = document.body.dataset;
  state.errors = "";
  window.addEventListener("error", (event) => { state.errors += event.message + "; "; });

  const data = JSON.parse(document.getElementById("data").textContent);

  const element = (name, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
  };

  const fillCopies = () => {
    for (const copy of document.querySelectorAll("img[data-same]"))
      copy.src = document.getElementById(copy.dataset.same).src;
  };

  // Pictures at full size.
  const enlarge = (picture) => {
    const caption = picture.parentElement.querySelector("figcaption");
    const dialog = element("dialog", {}, element("p", {textContent: caption ? caption.textContent : picture.alt}),
                           element("img", {src: picture.src, alt: picture.alt}));
    dialog.addEventListener("click", () => dialog.close());
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
  };

  // Tables: numbers by value, all else by its letters.
  const compare = (a, b) => {
    const [x, y] = [parseFloat(a), parseFloat(b)];
    return isNaN(x) || isNaN(y) ? a.localeCompare(b, undefined, {numeric: true}) : x - y;
  };

  const sortBy = (head) => {
    const table = head.closest("table");
    const rows = [...table.tBodies[0].rows];
    const order = head.dataset.order === "up" ? "down" : "up";
    for (const other of head.parentElement.cells) delete other.dataset.order;
    head.dataset.order = order;
    const text = (row) => row.cells[head.cellIndex].textContent;
    rows.sort((a, b) => (order === "up" ? 1 : -1) * compare(text(a), text(b)));
    table.tBodies[0].append(...rows);
    const gallery = document.querySelector(".variations");
    if (gallery && rows[0].dataset.row !== undefined) gallery.append(...rows.map((row) => variations[row.dataset.row]));
  };

  const variations = [...document.querySelectorAll(".variations figure")];
  const showVariation = (number) => {
    const shown = variations[number];
    if (!shown) return;
    for (const other of variations) other.classList.toggle("marked", other === shown);
    shown.scrollIntoView({block: "center"});
  };

  // The graph: the view box moves and shrinks.
  const makeZoomable = (drawing) => {
    const svg = drawing.querySelector("svg");
    const full = svg.viewBox.baseVal;
    const [width, height] = [full.width, full.height];
    svg.removeAttribute("width");
    svg.removeAttribute("height");
    drawing.classList.add("live");
    drawing.style.height = Math.max(200, Math.min(560, height * drawing.clientWidth / width)) + "px";
    // All of it, but of a very large graph, such as a sweep's, the first part: still legible.
    const least = 0.3;
    let view = {x: 0, y: 0, width: Math.min(width, drawing.clientWidth / least),
                height: Math.min(height, drawing.clientHeight / least)};
    const show = () => svg.setAttribute("viewBox", `${view.x} ${view.y} ${view.width} ${view.height}`);
    const zoom = (factor, x = view.x + view.width / 2, y = view.y + view.height / 2) => {
      const most = 1.5 * Math.max(width, height);
      const to = Math.min(most, Math.max(60, view.width * factor)) / view.width;
      view = {x: x + (view.x - x) * to, y: y + (view.y - y) * to, width: view.width * to, height: view.height * to};
      show();
    };
    const pointAt = (event) =>
      new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    drawing.addEventListener("wheel", (event) => {
      event.preventDefault();
      const at = pointAt(event);
      zoom(Math.exp(event.deltaY * 0.0015), at.x, at.y);
    }, {passive: false});
    let from = null;
    drawing.addEventListener("pointerdown", (event) => { from = pointAt(event); });
    window.addEventListener("pointerup", () => { from = null; });
    drawing.addEventListener("pointermove", (event) => {
      if (!from) return;
      const at = pointAt(event);
      view = {...view, x: view.x + from.x - at.x, y: view.y + from.y - at.y};
      show();
    });
    const button = (text, title, onclick) => element("button", {type: "button", textContent: text, title, onclick});
    show();
    drawing.before(element("div", {className: "buttons"}, button("+", "closer", () => zoom(0.75)),
                           button("\u2212", "farther", () => zoom(1 / 0.75)),
                           button("all", "the whole graph", () => { view = {x: 0, y: 0, width, height}; show(); })));
  };

  // What is known of a node.
  const parameterRow = (p) => element("tr", {title: p.help}, element("td", {textContent: p.name}),
    element("td", {className: p.default ? "quiet" : "given", textContent: p.text + (p.unit && " " + p.unit)}),
    element("td", {className: "quiet", textContent: p.default ? "default" : ""}));

  const nodePictures = (pictures) => element("div", {className: "gallery"}, ...pictures.map((p) => {
    const shown = document.getElementById(p.id);
    return element("figure", {}, element("img", {className: "picture", src: shown.src, alt: p.caption}),
                   element("figcaption", {textContent: p.caption}));
  }));

  const showNode = (group) => {
    const node = data.nodes[group.dataset.node];
    for (const other of document.querySelectorAll(".node.chosen")) other.classList.remove("chosen");
    group.classList.add("chosen");
    const seconds = node.seconds > 0 ? `, ${node.seconds.toFixed(2)} s` : "";
    const lines = [element("h3", {textContent: `${node.name} (${node.type})`}),
                   element("p", {className: "quiet", textContent: node.summary})];
    if (node.comment) lines.push(element("p", {textContent: node.comment}));
    lines.push(element("p", {className: node.state === "failed" ? "failed" : "", textContent:
      node.state + seconds + (node.reason && ": " + node.reason)}));
    for (const failure of data.failures)
      if (failure.node === node.name) lines.push(element("p", {className: "failed", textContent: failure.message}));
    for (const note of node.notes) lines.push(element("p", {textContent: note}));
    if (node.parameters.length) lines.push(element("table", {className: "narrow"}, ...node.parameters.map(parameterRow)));
    for (const file of node.files) lines.push(element("p", {className: "quiet", textContent: "wrote " + file}));
    document.getElementById("node").replaceChildren(element("div", {}, ...lines), nodePictures(node.pictures));
  };

  // The search: rows, list items and pictures without the text go, what is folded opens where it is.
  const startSearch = (heading) => {
    const entries = [...document.querySelectorAll(
      ".sortable tbody tr, .searched li, .searched tr, .times > div:not(.axis), .searched figure, .variations figure")];
    if (entries.length < 2) return;
    const texts = entries.map((entry) => entry.textContent.toLowerCase());
    const folds = [...document.querySelectorAll("details")].map((fold) => ({fold, open: fold.open, inside: []}));
    const around = new Map(folds.map((f) => [f.fold, f]));
    entries.forEach((entry, i) => around.get(entry.closest("details"))?.inside.push(i));
    const nodes = [...document.querySelectorAll("g.node")];
    const found = element("span", {className: "quiet"});
    const search = () => {
      const text = field.value.trim().toLowerCase();
      const fits = texts.map((t) => t.includes(text));
      entries.forEach((entry, i) => { entry.hidden = !fits[i]; });
      for (const {fold, open, inside} of folds) {
        const any = inside.some((i) => fits[i]);
        fold.hidden = inside.length > 0 && !any;
        fold.open = text && inside.length > 0 ? any : open;
      }
      for (const node of nodes)
        node.classList.toggle("other", !data.nodes[node.dataset.node].name.toLowerCase().includes(text));
      found.textContent = text ? `${fits.filter((f) => f).length} of ${entries.length}` : "";
      state.found = found.textContent;
    };
    const field = element("input", {type: "search", placeholder: "search", ariaLabel: "search this page", oninput: search});
    heading.after(element("div", {className: "search"}, field, found));
  };

  document.addEventListener("click", (event) => {
    const picture = event.target.closest("img.picture");
    if (picture) return enlarge(picture);
    const head = event.target.closest(".sortable th");
    if (head) return sortBy(head);
    const row = event.target.closest("tr[data-row]");
    if (row) return showVariation(row.dataset.row);
    const node = event.target.closest("g.node");
    if (node) showNode(node);
  });

  const startViewer = (viewer) => {
    const line = document.getElementById("viewer-state");
    try {
      lightMaterials(viewer, data.materials, (id) => document.getElementById(id).src);
      line.remove();
      state.lit = "yes";
    } catch (error) {
      line.textContent = "A still picture: this browser has no WebGL to move the light with.";
      line.title = error.message;
      state.lit = "no";
    }
  };

  fillCopies();
  startSearch(document.querySelector("h1"));
  const drawing = document.getElementById("drawing");
  if (drawing) makeZoomable(drawing);
  const viewer = document.getElementById("viewer");
  // Once the page is there: without a graphics card, the first picture takes a while.
  if (viewer) setTimeout(() => startViewer(viewer), 50);
  state.overflow = String(document.documentElement.scrollWidth - document.documentElement.clientWidth);
  state.ready = "yes";
}
