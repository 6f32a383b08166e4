"""Light from the environment, beside Mitsuba 3 (https://mitsuba-renderer.org): means of tiles of the same scenes.

`pip install mitsuba numpy`, `cargo build --release -p solution`, then, anywhere in the checkout:

    python3 solution/benches/environment_means.py [--wrong=KIND] [SCENE …]

Each scene is rendered in independent pictures by both, 16 with seeds of their own; arty's by the solution of exercise 6, with
each technique. A tile's mean is compared by the standard error of the difference of both means over pictures; a difference
of more than 4 of them is an error, and so is a resolution worse than 3 % in the median tile. With 64 tiles, 4 scenes and
3 techniques, a correct program has 768 comparisons of 30 degrees of freedom: 0.3 of them exceed 4 by chance, with any
seeds; the seeds are fixed.

The maps are 16 x 8 texels of very different radiance, without interpolation. Mitsuba interpolates between texels, so its maps
repeat each texel 128 times in each direction: what is left of the interpolation is a hundredth of a texel. Its u is half a
turn away from arty's, and its rows lie at v = row / (rows - 1).

--wrong=mirrored, turned (by a texel) or shifted (down by half a texel) gives arty a wrong map, to see it found.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba as mi
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = ROOT / "target/release/solution-environment"
SIZE, TILES, SAMPLES, PICTURES, REPEATED = 64, 8, 64, 16, 128
LIMIT, RESOLUTION = 4, 0.03
TECHNIQUES = ["bsdf", "nee", "mis"]

# Compiled ahead of time: it needs no LLVM.
mi.set_variant("scalar_rgb")

FLOOR = "v -3 0 3\nv 3 0 3\nv 3 0 -3\nv -3 0 -3\nf 1 2 3 4\n"
LIGHT = "v -2 1.5 -1\nv -1 1.5 -1\nv -1 1.5 0\nv -2 1.5 0\nf 1 2 3 4\n"
# A border of texels that is one of tiles, too, would let Mitsuba's interpolation move light from tile to tile.
EYE, TARGET, FOV, BOUNCES = [0, 1.6, 4.5], [0.1, 0.7, 0], 40, 8
TURN = dict(axis=[0.48, -0.6, 0.64], degrees=130)


def ball(levels=4):
    """A sphere of radius 0.7 around (0, 0.7, 0): an octahedron, subdivided."""
    x, y, z = np.eye(3)
    triangles = [[a * x, b * y, c * z] if a * b * c > 0 else [a * x, c * z, b * y]
                 for a in (1, -1) for b in (1, -1) for c in (1, -1)]
    for _ in range(levels):
        finer = []
        for a, b, c in triangles:
            ab, bc, ca = ((p + q) / np.linalg.norm(p + q) for p, q in ((a, b), (b, c), (c, a)))
            finer += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        triangles = finer
    corners = [0.7 * corner + [0, 0.7, 0] for triangle in triangles for corner in triangle]
    lines = [f"v {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}" for p in corners]
    return "\n".join(lines + [f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}" for i in range(len(triangles))]) + "\n"


def rough():
    """A map of very different texels."""
    random = np.random.default_rng(6)
    luminance = np.exp(4 * random.random((8, 16, 1)) - 3) * (random.random((8, 16, 1)) > 0.2)
    return (luminance * (0.5 + 0.5 * random.random((8, 16, 3)))).astype(np.float32)


def spot():
    """A bright texel over a dim map."""
    texels = np.full((8, 16, 3), 0.1, np.float32)
    texels[2, 10] = [20, 18, 15]
    return texels


# Name: the ball's MTL and Mitsuba's BSDF, the map, its rotation, and whether there is an area light.
DIFFUSE = ("Kd 0.7 0.5 0.3", dict(type="diffuse", reflectance=dict(type="rgb", value=[0.7, 0.5, 0.3])))
MIRROR = ("Ks 0.9 0.9 0.9\nillum 5", dict(type="conductor", material="none",
                                          specular_reflectance=dict(type="rgb", value=0.9)))
GLASS = ("Ks 1 1 1\nTf 1 1 1\nNi 1.5\nillum 7", dict(type="dielectric", int_ior=1.5, ext_ior=1.0))
CASES = {
    "diffuse": (DIFFUSE, rough, None, False),
    "rotated": (DIFFUSE, rough, TURN, False),
    "mirror_and_light": (MIRROR, rough, None, True),
    "glass_and_spot": (GLASS, spot, TURN, False),
}

wrong = next((a.removeprefix("--wrong=") for a in sys.argv[1:] if a.startswith("--wrong=")), None)
cases = [a for a in sys.argv[1:] if not a.startswith("--")] or list(CASES)


def bitmap(texels, path):
    mi.Bitmap(np.ascontiguousarray(texels, dtype=np.float32), mi.Bitmap.PixelFormat.RGB).write(str(path))


def rounded(make, folder):
    """The map as a Radiance HDR file has it: eight bits of the largest channel."""
    (folder / "rounded.hdr").write_bytes(hdr(make()))
    return np.array(mi.Bitmap(str(folder / "rounded.hdr")))


def hdr(texels):
    """A Radiance HDR file: Mitsuba writes OpenEXR only with a compression that arty does not read."""
    exponents = np.frexp(np.maximum(texels.max(axis=2), 1e-9))[1]
    mantissas = np.minimum(np.round(texels * np.exp2(8.0 - exponents)[..., None]), 255)
    pixels = np.concatenate([mantissas, exponents[..., None] + 128], axis=2).astype(np.uint8)
    pixels[texels.max(axis=2) == 0] = 0
    rows, columns = texels.shape[:2]
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {rows} +X {columns}\n".encode() + pixels.tobytes()


def for_mitsuba(texels):
    rows, columns = texels.shape[0] * REPEATED, texels.shape[1] * REPEATED
    v, u = np.arange(rows) / (rows - 1), ((np.arange(columns) + 0.5) / columns + 0.5) % 1
    row = np.minimum((v * texels.shape[0]).astype(int), texels.shape[0] - 1)
    return texels[row][:, (u * texels.shape[1]).astype(int)]


def write_scene(case, folder):
    (mtl, _), make, turn, light = CASES[case]
    (folder / "ball.mtl").write_text(f"newmtl ball\n{mtl}\nnewmtl floor\nKd 0.6 0.6 0.6\nnewmtl light\nKe 4 4 4\n")
    parts = {"ball": ball(), "floor": FLOOR} | ({"light": LIGHT} if light else {})
    for name, text in parts.items():
        (folder / f"{name}.obj").write_text(f"mtllib ball.mtl\nusemtl {name}\n{text}")
    texels = rounded(make, folder)
    if wrong == "mirrored":
        texels = texels[:, ::-1]
    elif wrong == "turned":
        texels = np.roll(texels, 1, axis=1)
    elif wrong == "shifted":
        twice = np.repeat(texels, 2, axis=0)
        texels = np.concatenate([twice[:1], twice[:-1]])
    (folder / "map.hdr").write_bytes(hdr(texels))
    rotate = f", rotate: {{ axis: {turn['axis']}, degrees: {turn['degrees']} }}" if turn else ""
    (folder / "scene.yml").write_text(
        f"meshes: [{', '.join(f'{name}.obj' for name in parts)}]\n"
        f"camera: !perspective_camera {{ eye: {EYE}, center: {TARGET}, up: [0, 1, 0], fov: {FOV} }}\n"
        f"environment: {{ file: map.hdr{rotate} }}\n"
    )


def by_arty(folder, technique):
    pictures = []
    for seed in range(1, PICTURES + 1):
        out = folder / "arty.exr"
        subprocess.run(
            [PROGRAM, folder / "scene.yml", f"--technique={technique}", f"--max-bounces={BOUNCES}", f"--seed={seed}",
             f"--samples={SAMPLES}", f"--width={SIZE}", f"--height={SIZE}", "--quiet", "-o", out], check=True)
        picture = mi.Bitmap(str(out))
        names = [field.name for field in picture.struct_()]
        pictures.append(np.array(picture)[:, :, [names.index(channel) for channel in "RGB"]])
    return np.array(pictures)


def by_mitsuba(case, folder):
    (_, bsdf), make, turn, light = CASES[case]
    bitmap(for_mitsuba(rounded(make, folder)), folder / "mitsuba.exr")
    to_world = mi.ScalarTransform4f()
    if turn:
        to_world = to_world.rotate(turn["axis"], turn["degrees"])
    film = dict(type="hdrfilm", width=SIZE, height=SIZE, rfilter=dict(type="box"), pixel_format="rgb")
    look = mi.ScalarTransform4f().look_at(origin=EYE, target=TARGET, up=[0, 1, 0])
    shape = lambda name, bsdf: dict(type="obj", filename=str(folder / f"{name}.obj"), face_normals=True, bsdf=bsdf)
    two_sided = lambda bsdf: bsdf if bsdf["type"] == "dielectric" else dict(type="twosided", nested=bsdf)
    grey = dict(type="diffuse", reflectance=dict(type="rgb", value=0.6))
    scene = dict(
        type="scene",
        integrator=dict(type="path", max_depth=BOUNCES + 1, rr_depth=100),
        sensor=dict(type="perspective", fov=FOV, fov_axis="x", to_world=look, film=film,
                    sampler=dict(type="independent", sample_count=SAMPLES)),
        environment=dict(type="envmap", filename=str(folder / "mitsuba.exr"), to_world=to_world),
        ball=shape("ball", two_sided(bsdf)),
        floor=shape("floor", two_sided(grey)),
    )
    if light:
        black = dict(type="diffuse", reflectance=dict(type="rgb", value=0))
        emitter = dict(type="area", radiance=dict(type="rgb", value=4))
        scene["light"] = shape("light", two_sided(black)) | dict(emitter=emitter)
    scene = mi.load_dict(scene)
    return np.array([np.array(mi.render(scene, spp=SAMPLES, seed=seed)) for seed in range(101, 101 + PICTURES)])


def tiles(pictures):
    """Luminance of each tile, and the square of its standard error."""
    luminance = pictures.astype(float) @ [0.2126, 0.7152, 0.0722]
    side = SIZE // TILES
    means = luminance.reshape(PICTURES, TILES, side, TILES, side).mean(axis=(2, 4))
    return means.mean(axis=0), means.var(axis=0, ddof=1) / PICTURES


print(f"Mitsuba {mi.__version__}; {SIZE} x {SIZE}, {PICTURES} pictures of {SAMPLES} samples per pixel, {TILES} x {TILES} tiles\n")
print(f"{'scene':<18} {'technique':<10} {'means':>8} {'resolution':>11} {'largest z':>10} {'tiles beyond ' + str(LIMIT):>15}")
failed = False
for case in cases:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_scene(case, folder)
        expected, expected_error = tiles(by_mitsuba(case, folder))
        for technique in TECHNIQUES:
            mean, error = tiles(by_arty(folder, technique))
            # Some tiles are black, and some show one texel only, without any noise.
            floor = 1e-6 * expected.mean()
            sigma = np.maximum(np.sqrt(expected_error + error), floor)
            z = (mean - expected) / sigma
            beyond, resolution = int((np.abs(z) > LIMIT).sum()), np.median(LIMIT * sigma / np.maximum(expected, floor))
            failed |= beyond > 0 or resolution > RESOLUTION
            print(f"{case:<18} {technique:<10} {100 * (mean.mean() / expected.mean() - 1):>+7.2f}% "
                  f"{100 * resolution:>10.2f}% {z.flat[np.abs(z).argmax()]:>+10.2f} {beyond:>15}")
sys.exit(1 if failed else 0)
