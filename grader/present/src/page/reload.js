// Written again on every save (`cargo grade --watch`). Nobody who is reading or using a control is interrupted.
let used = 0;
for (const kind of ["pointermove", "keydown", "wheel", "input"]) addEventListener(kind, () => { used = Date.now(); });
setInterval(() => { if (!document.hidden && Date.now() - used > 3000) location.reload(); }, 2000);
document.addEventListener("visibilitychange", () => { if (!document.hidden) location.reload(); });
