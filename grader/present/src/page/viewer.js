"use strict";
// The pictures are linear radiance in half floats; everything that is shown is derived from them here.
const half = (bits) => {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
};
const bytesOf = (script) => Uint8Array.from(atob(script.textContent), (letter) => letter.charCodeAt(0));
const decode = {
  radiance: (bytes) => {
    const view = new DataView(bytes.buffer), values = new Float32Array(bytes.length / 2);
    for (let i = 0; i < values.length; i++) values[i] = half(view.getUint16(2 * i, true));
    return values;
  },
  z: (bytes) => Float32Array.from(new Int8Array(bytes.buffer), (tenths) => tenths / 10),
  flip: (bytes) => Float32Array.from(bytes, (level) => level / 255),
};
decode.submission = decode.reference = decode.radiance;
const srgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const curves = {
  clip: (x) => Math.min(1, Math.max(0, x)),
  reinhard: (x) => Math.max(0, x) / (1 + Math.max(0, x)),
  aces: (x) => { x = 0.6 * Math.min(1e6, Math.max(0, x)); return Math.min(1, (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)); },
};
const clamp = (value, low, high) => Math.max(low, Math.min(high, value));
// Blue is too dark, orange too bright, black is right, magenta is NaN or infinity.
const notFinite = [1, 0, 1];
const signed = (t) => { if (!Number.isFinite(t)) return notFinite; t = clamp(t, -1, 1); return t < 0 ? [0, -0.55 * t, -t] : [t, 0.45 * t, 0]; };
// Black, purple, orange, white.
const heat = (t) => [Math.min(1, 1.8 * t), Math.max(0, 1.6 * t - 0.5), Math.max(0, t < 0.4 ? 1.5 * t : t < 0.7 ? 1.4 - 2 * t : 3.3 * t - 2.3)];
const modes = ["submission", "reference", "difference", "z", "flip"];
const techniques = { b: "bsdf", n: "nee", m: "mis" };

const bringToLife = (figure) => {
  const { width, height, samples } = Object.fromEntries(Object.entries(figure.dataset).map(([name, text]) => [name, Number(text)]));
  const seeds = figure.dataset.seeds.split(" ");
  const planes = {};
  for (const script of figure.querySelectorAll("script[data-plane]")) {
    const { plane, technique } = script.dataset;
    (planes[technique] ??= {})[plane] = decode[plane](bytesOf(script));
  }
  const reference = planes[""].reference;
  const canvas = figure.querySelector("canvas.view"), context = canvas.getContext("2d");
  const control = (name) => figure.querySelector(`[name=${name}]`);
  const radio = (name, value) => figure.querySelector(`[name^=${name}][value=${value}]`);
  const chosen = (name) => figure.querySelector(`[name^=${name}]:checked`).value;
  // Whole pixels on the screen for each pixel of the picture, so that none is blurred.
  const size = Math.max(1, Math.ceil(640 / width));
  canvas.width = size * width; canvas.height = size * height;
  const small = document.createElement("canvas");
  small.width = width; small.height = height;
  // The pixel that is read, whether it is held, and the corner of what is shown, in pixels of the picture.
  let place = [width >> 1, height >> 1], held = false, corner = [0, 0];
  const zoom = () => 2 ** +control("zoom").value;
  const count = seeds.length * samples;
  const sampleNumber = () => clamp(Math.round(+control("sample").value) || 1, 1, count);
  const withPaths = () => control("paths")?.checked ?? false;
  const overlays = [...figure.querySelectorAll("svg.paths")];

  const colorOf = (technique, mode, i, scale, curve) => {
    const rgb = (list) => {
      const all = [0, 1, 2].map((c) => list[3 * i + c]);
      return all.some((value) => !Number.isFinite(value)) ? notFinite : all.map((value) => srgb(curve(scale * value)));
    };
    if (mode === "reference") return rgb(reference);
    const { submission, z, flip } = planes[technique];
    if (mode === "submission") return rgb(submission);
    if (mode === "flip") return flip.length ? heat(flip[i]) : [0, 0, 0];
    if (mode === "z") return signed(z[i] / 5);
    let difference = 0, total = 0;
    for (let c = 0; c < 3; c++) { difference += submission[3 * i + c] - reference[3 * i + c]; total += reference[3 * i + c]; }
    return signed((scale * difference) / (total + 0.03));
  };
  const paint = (target, colorAt) => {
    const image = target.createImageData(width, height);
    for (let i = 0; i < width * height; i++) {
      colorAt(i).forEach((value, c) => { image.data[4 * i + c] = 255 * value; });
      image.data[4 * i + 3] = 255;
    }
    target.putImageData(image, 0, 0);
  };
  const tone = () => [2 ** +control("exposure").value, curves[control("curve").value]];
  const drawStrip = () => {
    for (const strip of figure.querySelectorAll("canvas[data-strip]")) {
      strip.width = width; strip.height = height;
      const name = strip.dataset.strip, [scale, curve] = tone();
      paint(strip.getContext("2d"), (i) => colorOf(name, name === "reference" ? "reference" : "submission", i, scale, curve));
    }
  };
  const drawView = () => {
    const technique = chosen("technique"), mode = chosen("mode"), [scale, curve] = tone();
    control("stops").textContent = control("exposure").value;
    const factor = zoom(), shown = [width / factor, height / factor];
    corner = [clamp(corner[0], 0, width - shown[0]), clamp(corner[1], 0, height - shown[1])];
    // The wipe is a place in what is shown: it can be moved where one looks.
    const share = +control("wipe").value / 100, edge = share === 1 ? width : corner[0] + share * shown[0];
    const against = control("against").value, isReference = against === "reference";
    const beyond = (i) => colorOf(isReference ? technique : against, isReference ? "reference" : mode, i, scale, curve);
    paint(small.getContext("2d"), (i) => (i % width >= edge ? beyond(i) : colorOf(technique, mode, i, scale, curve)));
    context.imageSmoothingEnabled = false;
    context.drawImage(small, corner[0], corner[1], shown[0], shown[1], 0, 0, canvas.width, canvas.height);
    const pixel = size * factor;
    if (share > 0 && share < 1) { context.fillStyle = "#fff"; context.fillRect(share * canvas.width - 1, 0, 2, canvas.height); }
    for (const overlay of overlays) {
      overlay.classList.toggle("shown", withPaths() && overlay.dataset.technique === technique);
      overlay.setAttribute("viewBox", `${corner[0]} ${corner[1]} ${shown[0]} ${shown[1]}`);
      [...overlay.children].forEach((path, i) => path.classList.toggle("chosen", i === sampleNumber() - 1));
    }
    const box = [(place[0] - corner[0]) * pixel, (place[1] - corner[1]) * pixel];
    for (const [color, line] of [["#000", 3], [held ? "#ffd54a" : "#fff", 1]]) {
      context.strokeStyle = color; context.lineWidth = line;
      context.strokeRect(box[0] - 0.5, box[1] - 0.5, pixel + 1, pixel + 1);
    }
  };
  const read = () => {
    const technique = chosen("technique"), { submission, z, flip } = planes[technique];
    const [x, y] = place, i = y * width + x;
    const number = (value) => (Number.isFinite(value) ? value.toPrecision(4) : String(value)).padStart(10);
    const three = (list) => [0, 1, 2].map((c) => number(list[3 * i + c])).join("");
    const rows = Object.keys(planes).filter((name) => name).map((name) => name.padEnd(10) + three(planes[name].submission));
    const off = [0, 1, 2].map((c) => {
      const difference = 100 * (submission[3 * i + c] / reference[3 * i + c] - 1);
      return (Number.isFinite(difference) ? (difference > 0 ? "+" : "") + difference.toFixed(0) + " %" : "–").padStart(10);
    });
    figure.querySelector(".probe").textContent = [
      `pixel (${x}, ${y})${held ? ", held: click to release" : ""}`, ...rows, "reference " + three(reference), technique.padEnd(4) + " error".padEnd(6) + off.join(""),
      `z ${z[i].toFixed(1)}${Math.abs(z[i]) >= 12.7 ? " or beyond" : ""}${flip.length ? `   FLIP ${flip[i].toFixed(3)}` : ""}`,
    ].join("\n");
    const number0 = sampleNumber() - 1;
    const chosen0 = overlays.find((overlay) => overlay.classList.contains("shown"))?.children[number0];
    if (chosen0 && overlayAt(technique).join() === place.join()) {
      figure.querySelector(".probe").textContent +=
        `\nsample ${number0 + 1}`.padEnd(11) + chosen0.dataset.radiance.split(" ").map((text) => number(+text.replace("inf", "Infinity"))).join("");
    }
    figure.querySelector(".replay").textContent =
      `${figure.dataset.replay} --technique=${technique} --pixel=${x},${y} --sample=${number0 % samples} --seed=${seeds[Math.floor(number0 / samples)]}`;
  };
  // The pixel whose paths there are, for a technique.
  const overlayAt = (technique) => overlays.find((overlay) => overlay.dataset.technique === technique)?.dataset.pixel.split(",").map(Number) ?? place;
  // With paths, their pixel is held; the sample that returned most is chosen.
  const followPaths = () => {
    const technique = chosen("technique"), overlay = overlays.find((it) => it.dataset.technique === technique);
    control("paths").closest(".controls").querySelector(".rays").hidden = !withPaths();
    held = withPaths();
    if (!held || !overlay) return;
    place = overlayAt(technique);
    keepInSight();
    const sums = [...overlay.children].map((path) => path.dataset.radiance.split(" ").reduce((sum, text) => sum + +text.replace("inf", "Infinity"), 0));
    const brightness = sums.map((sum) => (Number.isNaN(sum) ? Infinity : sum));
    control("sample").value = 1 + brightness.indexOf(Math.max(...brightness));
  };
  const draw = () => { drawView(); read(); zoomed = zoom(); };
  const zoomBy = (steps, [x, y]) => {
    const before = zoom();
    control("zoom").value = +control("zoom").value + steps;
    // What is under the pointer stays there.
    corner = [x - ((x - corner[0]) * before) / zoom(), y - ((y - corner[1]) * before) / zoom()];
    draw();
  };
  const at = (event) => {
    const box = canvas.getBoundingClientRect(), factor = zoom();
    return [corner[0] + ((event.clientX - box.left) / box.width) * (width / factor), corner[1] + ((event.clientY - box.top) / box.height) * (height / factor)];
  };
  const pixelAt = ([x, y]) => [clamp(Math.floor(x), 0, width - 1), clamp(Math.floor(y), 0, height - 1)];

  let drag = null;
  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    drag = { from: [event.clientX, event.clientY], corner, moved: false };
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    if (drag) {
      const box = canvas.getBoundingClientRect(), by = [event.clientX - drag.from[0], event.clientY - drag.from[1]];
      drag.moved ||= Math.hypot(...by) > 4;
      if (drag.moved) {
        corner = [drag.corner[0] - (by[0] / box.width) * (width / zoom()), drag.corner[1] - (by[1] / box.height) * (height / zoom())];
        draw();
      }
    } else if (!held) { place = pixelAt(at(event)); draw(); }
  });
  canvas.addEventListener("pointerup", (event) => {
    if (drag && !drag.moved) { held = !held; place = pixelAt(at(event)); draw(); }
    drag = null;
  });
  canvas.addEventListener("dblclick", (event) => zoomBy(control("zoom").value >= 5 ? -5 : 1, at(event)));
  canvas.addEventListener("wheel", (event) => {
    // Without the key, the wheel is for the page.
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoomBy(event.deltaY < 0 ? 0.5 : -0.5, at(event));
  }, { passive: false });

  const nudge = (name, steps) => { control(name).value = +control(name).value + steps; changed(name); };
  const keepInSight = () => {
    const shown = [width / zoom(), height / zoom()];
    corner = corner.map((low, axis) => clamp(low, place[axis] + 1 - shown[axis], place[axis]));
  };
  let zoomed = 1;
  const changed = (name) => {
    if (name === "exposure" || name === "curve") drawStrip();
    // The slider zooms around the pixel that is read, which stays where it is as far as possible.
    if (name === "zoom") {
      corner = corner.map((low, axis) => place[axis] + 0.5 - ((place[axis] + 0.5 - low) * zoomed) / zoom());
      keepInSight();
    }
    if (name === "paths" || (name.startsWith("technique") && withPaths())) followPaths();
    draw();
  };
  let flippedFrom = "submission";
  const keys = {
    f: () => {
      const now = chosen("mode");
      if (now !== "reference") flippedFrom = now;
      radio("mode", now === "reference" ? flippedFrom : "reference").checked = true;
    },
    "+": () => zoomBy(0.5, place), "=": () => zoomBy(0.5, place), "-": () => zoomBy(-0.5, place),
    e: () => nudge("exposure", 0.5), d: () => nudge("exposure", -0.5),
    p: () => { if (overlays.length) { control("paths").checked = !withPaths(); followPaths(); } },
    ",": () => { control("sample").value = ((sampleNumber() + count - 2) % count) + 1; },
    ".": () => { control("sample").value = (sampleNumber() % count) + 1; },
    "[": () => nudge("wipe", -5), "]": () => nudge("wipe", 5),
    0: () => {
      for (const name of ["exposure", "wipe", "zoom"]) control(name).value = control(name).defaultValue;
      for (const name of ["curve", "against"]) control(name).selectedIndex = 0;
      radio("mode", "submission").checked = true;
      if (withPaths()) { control("paths").checked = false; followPaths(); }
      held = false;
      changed("exposure");
    },
  };
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    const technique = techniques[event.key] && radio("technique", techniques[event.key]);
    const mode = modes[event.key - 1];
    if (step) {
      const many = event.shiftKey ? 10 : 1;
      place = [clamp(place[0] + many * step[0], 0, width - 1), clamp(place[1] + many * step[1], 0, height - 1)];
      keepInSight();
    } else if (technique) { technique.checked = true; if (withPaths()) followPaths(); }
    else if (mode) radio("mode", mode).checked = true;
    else if (keys[event.key]) keys[event.key]();
    else return;
    event.preventDefault();
    draw();
  });
  figure.addEventListener("input", (event) => changed(event.target.name));
  drawStrip();
  draw();
};

for (const figure of document.querySelectorAll("figure.pictures")) bringToLife(figure);
// Where the clipboard is closed to the page, the command is selected instead.
for (const command of document.querySelectorAll(".command")) {
  const button = document.createElement("button");
  button.type = "button"; button.className = "copy"; button.textContent = "copy"; button.ariaLabel = "copy this command";
  button.addEventListener("click", () => {
    const select = () => { getSelection().selectAllChildren(command); };
    const said = (text) => { button.textContent = text; setTimeout(() => { button.textContent = "copy"; }, 1500); };
    if (!navigator.clipboard) { select(); return; }
    navigator.clipboard.writeText(command.textContent.trim()).then(() => said("copied"), select);
  });
  command.after(" ", button);
}
// On paper nothing can be unfolded; afterwards everything is folded as before.
let unfolded = [];
addEventListener("beforeprint", () => {
  unfolded = [...document.querySelectorAll("details:not([open])")];
  for (const part of unfolded) part.open = true;
});
addEventListener("afterprint", () => { for (const part of unfolded) part.open = false; });
