"""Time to equal error, beside Mitsuba 3 (https://mitsuba-renderer.org): the same scenes, the same longest paths.

`pip install mitsuba numpy`, `cargo build --release -p solution`, then, anywhere in the checkout:

    python3 solution/benches/equal_error.py [--variant=VARIANT] [--samples=N] [SCENE …]

VARIANT is llvm_ad_rgb (the default) or scalar_rgb; the latter is for the diffuse scene, since Mitsuba has no modified
Phong model and the one below runs in Python. It is compiled with everything else where Mitsuba compiles.

Both render each picture several times, with seeds of their own. Neither is biased, so the error is the variance:
relMSE = mean(variance / (mean² + 0.01)), over pixels and channels. relMSE · time is what each pays for an error at this
number of samples; with independent samples, the number does not matter. Time is processor time over all threads, without
Mitsuba's compilation and first picture; arty's includes its start. Both are shown with each of their samplers; the last
column of arty's rows is the price of Mitsuba with the same kind of sampler, independent or its best other one, divided by
arty's: above 1, arty is there first. `means` is by how much a picture's mean differs from Mitsuba's with independent
samples; more than one percent says that they are not of the same scene, and ends this with an error.
"""

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mitsuba as mi
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"

# OBJ files, camera and bounces as in the scene files of these names.
CASES = {
    "cornell_box": (
        ["cornell_room.obj", "cornell_blocks.obj", "cornell_light.obj"],
        dict(origin=[0, 1, 4.63], target=[0, 1, 0], fov=39),
        8,
    ),
    "cornell_box_glossy": (["cornell_box_glossy.obj"], dict(origin=[0, 1, 4.63], target=[0, 1, 0], fov=39), 8),
    "veach_mis": (["veach_mis.obj"], dict(origin=[0, 4, 16], target=[0, 1, 2], fov=30), 4),
}
WIDTH, HEIGHT, PICTURES = 512, 412, 8

# The first of each has independent samples.
SAMPLERS = {"Mitsuba": ["independent", "stratified", "multijitter", "ldsampler"], "arty": ["independent", "sobol"]}

parser = argparse.ArgumentParser(description="Time to equal error, beside Mitsuba 3.")
parser.add_argument("--variant", default="llvm_ad_rgb", choices=["llvm_ad_rgb", "scalar_rgb"])
parser.add_argument("--samples", type=int, default=64, help="samples per pixel; a power of four suits all samplers")
parser.add_argument("scenes", nargs="*", choices=[*CASES, []], metavar="SCENE")
arguments = parser.parse_args()
variant, SAMPLES = arguments.variant, arguments.samples
cases = arguments.scenes or (["cornell_box"] if variant == "scalar_rgb" else list(CASES))
mi.set_variant(variant)
import drjit as dr  # noqa: E402 (needs the variant)


class ModifiedPhong(mi.BSDF):
    """Lafortune and Willems 1994, with a diffuse lobe beside it: kd / pi + ks (n + 2) / (2 pi) cos^n, as arty has it."""

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        rgb = lambda name: [float(props[f"{name}_{channel}"]) for channel in "rgb"]
        luminance = lambda c: 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]
        kd, ks, self.n = rgb("kd"), rgb("ks"), float(props["exponent"])
        self.p_diffuse = min(max(luminance(kd) / (luminance(kd) + luminance(ks)), 0.05), 0.95)
        self.kd, self.ks = mi.Color3f(kd), mi.Color3f(ks)
        self.m_components = [mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide]
        self.m_flags = self.m_components[0]

    def values(self, si, wo, active):
        above = active & (mi.Frame3f.cos_theta(si.wi) > 0) & (mi.Frame3f.cos_theta(wo) > 0)
        power = dr.power(dr.maximum(dr.dot(mi.reflect(si.wi), wo), 0), self.n)
        f = self.kd * dr.inv_pi + self.ks * ((self.n + 2) * 0.5 * dr.inv_pi * power)
        pdf = self.p_diffuse * dr.inv_pi * mi.Frame3f.cos_theta(wo)
        pdf += (1 - self.p_diffuse) * (self.n + 1) * 0.5 * dr.inv_pi * power
        return dr.select(above, f * mi.Frame3f.cos_theta(wo), 0), dr.select(above, pdf, 0)

    def sample(self, ctx, si, sample1, sample2, active=True):
        diffuse = mi.warp.square_to_cosine_hemisphere(sample2)
        cos = dr.power(sample2.x, 1 / (self.n + 1))
        sin, phi = dr.safe_sqrt(1 - cos * cos), dr.two_pi * sample2.y
        lobe = mi.Vector3f(dr.cos(phi) * sin, dr.sin(phi) * sin, cos)
        glossy = mi.Frame3f(mi.reflect(si.wi)).to_world(lobe)
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = dr.select(sample1 < self.p_diffuse, diffuse, glossy)
        bs.eta, bs.sampled_component, bs.sampled_type = 1.0, 0, +mi.BSDFFlags.GlossyReflection
        f, bs.pdf = self.values(si, bs.wo, active)
        return bs, dr.select(bs.pdf > 0, f / bs.pdf, 0) & (active & (bs.pdf > 0))

    def eval(self, ctx, si, wo, active=True):
        return self.values(si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        return self.values(si, wo, active)[1]

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.values(si, wo, active)


mi.register_bsdf("modified_phong", ModifiedPhong)


def materials(file):
    found = {}
    for line in file.read_text().splitlines():
        words = line.split()
        if words[:1] == ["newmtl"]:
            current = found[words[1]] = {}
        elif words and words[0] in ("Kd", "Ks", "Ke", "Ns"):
            current[words[0]] = [float(word) for word in words[1:]]
    return found


def parts(file, folder):
    """A file for each material: Mitsuba's reader has no use for `usemtl`."""
    vertices, faces, current = [], {}, None
    for line in file.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(line)
        elif words[:1] == ["usemtl"]:
            current = words[1]
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) for word in words[1:]]
            corners = [corner if corner > 0 else len(vertices) + 1 + corner for corner in corners]
            faces.setdefault(current, []).append("f " + " ".join(map(str, corners)))
    for material, lines in faces.items():
        path = Path(folder) / f"{file.stem}-{material}.obj"
        path.write_text("\n".join(vertices + lines) + "\n")
        yield material, path


def mitsuba_scene(case, folder, sampler):
    files, camera, bounces = CASES[case]
    look = mi.ScalarTransform4f().look_at(origin=camera["origin"], target=camera["target"], up=[0, 1, 0])
    film = dict(type="hdrfilm", width=WIDTH, height=HEIGHT, rfilter=dict(type="box"), pixel_format="rgb")
    scene = dict(
        type="scene",
        integrator=dict(type="path", max_depth=bounces + 1, rr_depth=5),
        sensor=dict(type="perspective", fov=camera["fov"], fov_axis="x", to_world=look, film=film,
                    sampler=dict(type=sampler, sample_count=SAMPLES)),
    )
    for name in files:
        file = SCENES / name
        library = next(line.split()[1] for line in file.read_text().splitlines() if line.startswith("mtllib"))
        known = materials(SCENES / library)
        for material, path in parts(file, folder):
            values = known[material]
            kd, ks = values.get("Kd", [0, 0, 0]), values.get("Ks", [0, 0, 0])
            if any(ks):
                bsdf = dict(type="modified_phong", exponent=values["Ns"][0])
                bsdf |= {f"{n}_{c}": v for n, rgb in (("kd", kd), ("ks", ks)) for c, v in zip("rgb", rgb)}
            else:
                bsdf = dict(type="diffuse", reflectance=dict(type="rgb", value=kd))
            shape = dict(type="obj", filename=str(path), face_normals=True, bsdf=dict(type="twosided", nested=bsdf))
            if any(values.get("Ke", [])):
                shape["emitter"] = dict(type="area", radiance=dict(type="rgb", value=values["Ke"]))
            scene[path.stem.replace(".", "_")] = shape
    return mi.load_dict(scene)


def by_mitsuba(case, folder, sampler):
    scene = mitsuba_scene(case, folder, sampler)
    render = lambda seed: np.array(mi.render(scene, spp=SAMPLES, seed=seed))
    render(0)
    start = time.process_time()
    pictures = [render(seed) for seed in range(1, PICTURES + 1)]
    return pictures, (time.process_time() - start) / PICTURES


def by_arty(case, folder, sampler):
    program, out = ROOT / "target/release/solution", Path(folder) / "arty.exr"
    pictures, start = [], resource.getrusage(resource.RUSAGE_CHILDREN)
    for seed in range(1, PICTURES + 1):
        options = [f"--width={WIDTH}", f"--height={HEIGHT}", f"--samples={SAMPLES}", f"--seed={seed}"]
        command = [program, SCENES / f"{case}.yml", "--technique=mis", f"--sampler={sampler}", *options, f"--output={out}"]
        subprocess.run(command, check=True, capture_output=True)
        layers = dict(mi.Bitmap(str(out)).split())
        pictures.append(np.array(layers["<root>"].convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)))
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    return pictures, (end.ru_utime + end.ru_stime - start.ru_utime - start.ru_stime) / PICTURES


def summary(pictures):
    mean, variance = np.mean(pictures, axis=0, dtype=float), np.var(pictures, axis=0, ddof=1, dtype=float)
    return mean, float(np.mean(variance / (mean**2 + 0.01)))


print(f"Mitsuba {mi.__version__} {variant}; {WIDTH} x {HEIGHT}, {SAMPLES} samples per pixel, {PICTURES} pictures\n")
print(f"{'scene':<20} {'':>8} {'sampler':>12} {'M samples/cpu s':>16} {'relMSE':>10} {'relMSE x s':>11} {'means':>8} {'Mitsuba / arty':>15}")
for case in cases:
    prices, first_mean = {}, None
    for name, by in (("Mitsuba", by_mitsuba), ("arty", by_arty)):
        for sampler in SAMPLERS[name]:
            with tempfile.TemporaryDirectory() as folder:
                pictures, seconds = by(case, folder, sampler)
            mean, error = summary(pictures)
            first_mean = first_mean or mean.mean()
            difference = mean.mean() / first_mean - 1
            if abs(difference) > 0.01:
                sys.exit(f"{case}: {name}'s pictures ({sampler}) have a mean of {mean.mean():.4f}, not {first_mean:.4f}: not the same scene")
            prices[name, sampler] = error * seconds
            rate = WIDTH * HEIGHT * SAMPLES / seconds / 1e6
            line = f"{case:<20} {name:>8} {sampler:>12} {rate:>16.2f} {error:>10.4f} {error * seconds:>11.4f} {100 * difference:>+7.2f}%"
            if name == "arty":
                rivals = SAMPLERS["Mitsuba"][:1] if sampler == "independent" else SAMPLERS["Mitsuba"][1:]
                line += f" {min(prices['Mitsuba', rival] for rival in rivals) / prices[name, sampler]:>15.2f}"
            print(line, flush=True)
