"use strict";
// The pictures are linear radiance in half floats; everything that is shown is derived from them here.
const half = (bits) => {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
};
const decode = (text) => {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const view = new DataView(bytes.buffer), values = new Float32Array(bytes.length / 2);
  for (let i = 0; i < values.length; i++) values[i] = half(view.getUint16(2 * i, true));
  return values;
};
const srgb = (x) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const curves = {
  clip: (x) => Math.min(1, Math.max(0, x)),
  reinhard: (x) => Math.max(0, x) / (1 + Math.max(0, x)),
  aces: (x) => { x = 0.6 * Math.max(0, x); return Math.min(1, (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)); },
};
// Blue is too dark, orange too bright, black is right.
const signed = (t) => { t = Math.max(-1, Math.min(1, t)); return t < 0 ? [0, -0.55 * t, -t] : [t, 0.45 * t, 0]; };
// Black, purple, orange, white.
const heat = (t) => [Math.min(1, 1.8 * t), Math.max(0, 1.6 * t - 0.5), Math.max(0, t < 0.4 ? 1.5 * t : t < 0.7 ? 1.4 - 2 * t : 3.3 * t - 2.3)];

for (const figure of document.querySelectorAll("figure[data-width]")) {
  const width = +figure.dataset.width, height = +figure.dataset.height;
  const planes = {};
  for (const name of ["submission", "reference", "z", "flip"])
    planes[name] = decode(figure.querySelector(`script[data-plane=${name}]`).textContent);
  const canvas = figure.querySelector("canvas"), context = canvas.getContext("2d");
  const control = (name) => figure.querySelector(`[name^=${name}]`);
  const probe = figure.querySelector(".probe");
  let place = [width >> 1, height >> 1];

  const colorOf = (mode, i, scale, curve) => {
    const rgb = (list) => [0, 1, 2].map((c) => srgb(curve(scale * list[3 * i + c])));
    if (mode === "submission" || mode === "reference") return rgb(planes[mode]);
    if (mode === "flip") return heat(planes.flip[i]);
    if (mode === "z") return signed(planes.z[i] / 5);
    let difference = 0, size = 0;
    for (let c = 0; c < 3; c++) {
      difference += planes.submission[3 * i + c] - planes.reference[3 * i + c];
      size += planes.reference[3 * i + c];
    }
    return signed((scale * difference) / (size + 0.03));
  };
  const draw = () => {
    const mode = figure.querySelector("[name^=mode]:checked").value;
    const scale = 2 ** +control("exposure").value, curve = curves[control("curve").value];
    const wipe = (+control("wipe").value / 100) * width;
    const image = context.createImageData(width, height);
    for (let i = 0; i < width * height; i++) {
      const shown = i % width >= wipe ? "reference" : mode;
      colorOf(shown, i, scale, curve).forEach((value, c) => { image.data[4 * i + c] = 255 * value; });
      image.data[4 * i + 3] = 255;
    }
    context.putImageData(image, 0, 0);
    const [x, y] = place, i = y * width + x;
    const three = (list) => [0, 1, 2].map((c) => list[3 * i + c].toPrecision(4).padStart(10)).join(" ");
    probe.textContent = `pixel (${x}, ${y})\nhand-in   ${three(planes.submission)}\nreference ${three(planes.reference)}\n` +
      `z ${planes.z[i].toFixed(1)}   FLIP ${planes.flip[i].toFixed(3)}   exposure ${control("exposure").value}`;
  };
  canvas.addEventListener("pointermove", (event) => {
    const box = canvas.getBoundingClientRect();
    const inside = (value, size) => Math.max(0, Math.min(size - 1, Math.floor(value * size)));
    place = [inside((event.clientX - box.left) / box.width, width), inside((event.clientY - box.top) / box.height, height)];
    draw();
  });
  canvas.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (!step) return;
    event.preventDefault();
    place = [Math.max(0, Math.min(width - 1, place[0] + step[0])), Math.max(0, Math.min(height - 1, place[1] + step[1]))];
    draw();
  });
  figure.addEventListener("input", draw);
  draw();
}
addEventListener("beforeprint", () => { for (const part of document.querySelectorAll("details")) part.open = true; });
