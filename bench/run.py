# SPDX-License-Identifier: Apache-2.0
"""Speed against error, beside the peers, in one process on the same pixels.

Prints each figure and writes them to out/bench.json. Times are medians of interleaved runs on one core: the machine is
shared, so trust the ratios.
"""

import argparse
import ctypes
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import PyOpenColorIO as ocio
import skimage

REPOSITORY = Path(__file__).resolve().parent.parent
PAIRS = [("D65", "A"), ("D65", "HP1"), ("D65", "FL11"), ("D65", "LED-RGB1"), ("A", "D65"), ("FL11", "D50")]
WIDTH, HEIGHT = 1920, 1080


class Door:
    """The engine behind its C interface."""

    def __init__(self, path):
        self.library = ctypes.CDLL(str(path))
        self.library.metamerOpen.restype = ctypes.c_void_p
        self.library.metamerBuildSeconds.restype = ctypes.c_double
        self.library.metamerProbes.restype = ctypes.c_size_t

    def open(self, source, destination):
        handle = self.library.metamerOpen(source.encode(), destination.encode())
        return ctypes.c_void_p(handle)

    def probes(self, handle):
        count = self.library.metamerProbes(handle, None)
        rgb = np.empty((count, 3))
        self.library.metamerProbes(handle, _pointer(rgb))
        return rgb

    def exact(self, handle, rgb, converged):
        rgb = np.ascontiguousarray(rgb, np.float64)
        result = np.empty_like(rgb)
        self.library.metamerExact(handle, _pointer(rgb), _pointer(result), ctypes.c_size_t(len(rgb)), int(converged))
        return result

    def map(self, handle, source, destination):
        self.library.metamerMap(handle, _pointer(source), _pointer(destination), ctypes.c_size_t(source.size // 4))

    def copy(self, source, destination):
        self.library.metamerCopy(_pointer(source), _pointer(destination), ctypes.c_size_t(source.size // 4))

    def delta_e(self, handle, a, b):
        a, b = (np.ascontiguousarray(x, np.float64) for x in (a, b))
        result = np.empty(len(a))
        self.library.metamerDeltaE(handle, _pointer(a), _pointer(b), _pointer(result), ctypes.c_size_t(len(a)))
        return result

    def time_solves(self, light, bands, upper_bound, xyz):
        xyz = np.ascontiguousarray(xyz, np.float64)
        seconds = np.empty(len(xyz))
        self.library.metamerTimeSolves(light.encode(), bands, int(upper_bound), _pointer(xyz),
                                       ctypes.c_size_t(len(xyz)), _pointer(seconds))
        return seconds


def _pointer(array):
    return array.ctypes.data_as(ctypes.c_void_p)


def photograph(name):
    """A public photograph, cropped to 16:9, resized to 1920x1080, linearised into ACEScg: float32 RGBA."""
    import colour
    from skimage.transform import resize

    picture = skimage.io.imread(Path(skimage.__file__).parent / "data" / f"{name}.png")[..., :3] / 255.0
    height = picture.shape[1] * HEIGHT // WIDTH
    top = (picture.shape[0] - height) // 2
    picture = np.clip(resize(picture[top:top + height], (HEIGHT, WIDTH), order=3), 0, 1)
    linear = colour.RGB_to_RGB(colour.models.eotf_sRGB(picture), "sRGB", "ACEScg", "Bradford")
    return np.ascontiguousarray(np.dstack([linear, np.ones(linear.shape[:2])]), np.float32)


# The peer: OpenColorIO's own operators over a lattice sampled from the converged engine.

def acescct(linear):
    """ACEScct, Academy S-2016-001."""
    return np.where(linear <= 0.0078125, 10.5402377416545 * linear + 0.0729055341958355,
                    (np.log2(np.maximum(linear, 1e-30)) + 9.72) / 17.52)


def acescct_inverse(signal):
    return np.where(signal <= 0.155251141552511, (signal - 0.0729055341958355) / 10.5402377416545,
                    np.exp2(signal * 17.52 - 9.72))


def acescct_transform(direction):
    transform = ocio.LogCameraTransform([0.0078125] * 3, base=2.0, direction=direction)
    transform.setLogSideSlopeValue([1 / 17.52] * 3)
    transform.setLogSideOffsetValue([9.72 / 17.52] * 3)
    transform.setLinearSlopeValue([10.5402377416545] * 3)
    return transform


def ocio_cube(door, handle, size, log_out):
    """CPU processor: ACEScct shaper, tetrahedral lattice, and the antilog where the lattice holds log values."""
    grid = np.linspace(0, 1, size)
    nodes = acescct_inverse(np.stack(np.meshgrid(grid, grid, grid, indexing="ij"), -1).reshape(-1, 3))
    values = door.exact(handle, nodes, converged=False)
    lattice = ocio.Lut3DTransform(gridSize=size, interpolation=ocio.INTERP_TETRAHEDRAL)
    lattice.setData((acescct(values) if log_out else values).astype(np.float32).ravel())
    group = ocio.GroupTransform([acescct_transform(ocio.TRANSFORM_DIR_FORWARD), lattice])
    if log_out:
        group.appendTransform(acescct_transform(ocio.TRANSFORM_DIR_INVERSE))
    return cpu_processor(group)


def ocio_matrix(door, handle):
    # The one matrix that is exact for colours near neutral.
    near = np.full((3, 3), 0.18) + 0.001 * np.eye(3)
    matrix = np.linalg.solve(near, door.exact(handle, near, converged=False)).T
    padded = np.eye(4)
    padded[:3, :3] = matrix
    return cpu_processor(ocio.MatrixTransform(padded.ravel().tolist()))


def cpu_processor(transform):
    return ocio.Config.CreateRaw().getProcessor(transform).getOptimizedCPUProcessor(
        ocio.BIT_DEPTH_F32, ocio.BIT_DEPTH_F32, ocio.OPTIMIZATION_DEFAULT)


def run_ocio(processor, source, destination):
    height, width = source.shape[:2]
    processor.apply(ocio.PackedImageDesc(source, width, height, 4), ocio.PackedImageDesc(destination, width, height, 4))


def interleaved_medians(calls, rounds):
    """Median seconds of each call, the calls taking turns."""
    seconds = {name: [] for name in calls}
    for call in calls.values():
        call()
    for _ in range(rounds):
        for name, call in calls.items():
            start = time.perf_counter()
            call()
            seconds[name].append(time.perf_counter() - start)
    return {name: statistics.median(values) for name, values in seconds.items()}


def protocol_error(door, handle, run, stops=range(-10, 11), keep=None):
    """Error protocol of a candidate: mean, p99, max CIEDE2000."""
    probes = door.probes(handle)
    if keep is not None:
        probes = probes[keep(probes)]
    expected = door.exact(handle, probes, converged=True)
    errors = []
    for stop in stops:
        source = np.ones((1, len(probes), 4), np.float32)
        source[0, :, :3] = probes * 2.0 ** stop
        destination = np.empty_like(source)
        run(source, destination)
        errors.append(door.delta_e(handle, expected, destination[0, :, :3] / 2.0 ** stop))
    errors = np.sort(np.concatenate(errors))
    return {"mean": float(errors.mean()), "p99": float(errors[int(np.ceil(0.99 * len(errors))) - 1]),
            "max": float(errors[-1])}


def bench_kernel(door, results, rounds):
    print("\n## Map kernel against OpenColorIO", ocio.__version__,
          f"\n   RGBA float32 {WIDTH}x{HEIGHT}, linear ACEScg in and out, one core, medians of {rounds} interleaved runs")
    rows = results["kernel"] = []
    for name in ("astronaut", "coffee"):
        picture = photograph(name)
        destination = np.empty_like(picture)
        for pair in PAIRS[:4]:
            handle = door.open(*pair)
            candidates = {
                "metamer map": lambda s, d, h=handle: door.map(h, s, d),
                "OCIO log + 33^3": None, "OCIO log + 33^3 + antilog": None, "OCIO 3x3 matrix": None}
            for label, processor in (("OCIO log + 33^3", ocio_cube(door, handle, 33, False)),
                                     ("OCIO log + 33^3 + antilog", ocio_cube(door, handle, 33, True)),
                                     ("OCIO 3x3 matrix", ocio_matrix(door, handle))):
                candidates[label] = lambda s, d, p=processor: run_ocio(p, s, d)
            candidates["memcpy"] = lambda s, d: door.copy(s, d)
            times = interleaved_medians({k: (lambda r=r: r(picture, destination)) for k, r in candidates.items()},
                                        rounds)
            pixels = picture[::3, ::3, :3].reshape(-1, 3)[::7].astype(np.float64)
            truth = door.exact(handle, pixels, converged=True)
            ours = times["metamer map"]
            row = {"picture": name, "pair": "->".join(pair), "megapixels_per_second": {}, "error": {}}
            print(f"\n   {name}, {row['pair']}")
            for label, seconds in times.items():
                speed = picture.size / 4 / seconds / 1e6
                row["megapixels_per_second"][label] = speed
                line = f"   {label:28s} {speed:7.1f} Mpixel/s   map is {seconds / ours:5.2f} x as fast"
                if label != "memcpy":
                    run = candidates[label]
                    full = protocol_error(door, handle, run)
                    inside = protocol_error(door, handle, run, range(-7, 8), lambda p: p.min(axis=1) >= 0)
                    source = np.ones((1, len(pixels), 4), np.float32)
                    source[0, :, :3] = pixels
                    output = np.empty_like(source)
                    run(source, output)
                    on_picture = float(np.quantile(door.delta_e(handle, truth, output[0, :, :3]), 0.99))
                    row["error"][label] = {"protocol": full, "inside_gamut_7_stops": inside, "picture_p99": on_picture}
                    line += (f"   p99 dE2000: protocol {full['p99']:.4f}, inside gamut +-7 stops {inside['p99']:.4f},"
                             f" picture {on_picture:.4f}")
                print(line, flush=True)
            rows.append(row)
            door.library.metamerClose(handle)


def bench_build(door, results):
    print("\n## Map build, one core")
    rows = results["map_build"] = []
    for pair in PAIRS:
        handles = [door.open(*pair) for _ in range(3)]
        seconds = statistics.median(door.library.metamerBuildSeconds(h) for h in handles)
        print(f"   {'->'.join(pair):14s} {seconds:.2f} s", flush=True)
        rows.append({"pair": "->".join(pair), "seconds": seconds})
        for handle in handles:
            door.library.metamerClose(handle)


def bench_solver(door, results):
    import colour

    print("\n## Smoothest spectrum, one core, against colour-science's Meng 2015")
    generator = np.random.default_rng(2026)
    lights = results["solver"] = []
    # Chart-like and saturated colours that the bounds hold for, and bite on: boxes of reflectance.
    wavelengths = np.arange(380, 781, 5)
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(colour.SpectralShape(380, 780, 5))
    for light in ("D65", "FL11"):
        power = colour.SDS_ILLUMINANTS[light].copy().align(colour.SpectralShape(380, 780, 5)).values
        weights = observer.values.T * power
        weights /= weights[1].sum()
        boxes = []
        while len(boxes) < 2000:
            centre, width = generator.uniform(400, 700), generator.uniform(30, 160)
            spectrum = 0.04 * generator.random() + generator.random() * (np.abs(wavelengths - centre) < width / 2)
            boxes.append(weights @ np.clip(spectrum, 0, 1))
        for bands in (41, 81, 201, 251):
            for upper in (False, True):
                seconds = door.time_solves(light, bands, upper, boxes)
                median = float(np.median(seconds[seconds > 0])) * 1e6
                lights.append({"light": light, "bands": bands, "upper_bound": upper, "microseconds": median})
                print(f"   {light:5s} B = {bands:3d} {'0 <= R <= 1' if upper else '0 <= R     '} median {median:7.2f} us"
                      f"   ({int((seconds < 0).sum())} infeasible)", flush=True)
    sample = np.array([0.21781186, 0.12541048, 0.04697113])
    start = time.perf_counter()
    colour.recovery.XYZ_to_sd_Meng2015(sample)
    meng = (time.perf_counter() - start) * 1e6
    ours = next(r["microseconds"] for r in lights if r["light"] == "D65" and r["bands"] == 81 and not r["upper_bound"])
    results["meng_2015_microseconds"] = meng
    print(f"   colour-science Meng 2015 (81 bands): {meng:.0f} us, {meng / ours:.0f} x our D65, B = 81")


def bench_cube(results, bin_folder):
    print("\n## 65^3 cube written by lutgen")
    with tempfile.TemporaryDirectory() as folder:
        seconds = []
        for _ in range(3):
            start = time.perf_counter()
            subprocess.run([bin_folder / "lutgen", "bake", "--illuminant-in", "D65", "--illuminant-out", "HP1", "--size",
                            "65", "-o", Path(folder) / "x.cube"], check=True, stdout=subprocess.DEVNULL)
            seconds.append(time.perf_counter() - start)
    results["cube_65_seconds"] = statistics.median(seconds)
    print(f"   {statistics.median(seconds):.2f} s wall with its certificate")


def machine():
    model = next((line.split(":")[1].strip() for line in Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), platform.processor())
    return f"{model}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", choices=["kernel", "build", "solver", "cube"], action="append")
    parser.add_argument("--rounds", type=int, default=15, help="interleaved runs a median is taken of")
    arguments = parser.parse_args()
    wanted = arguments.only or ["kernel", "build", "solver", "cube"]
    bin_folder = Path(os.environ.get("METAMER_BIN", REPOSITORY / "build/release/bin"))
    os.environ.setdefault("METAMER_DATA", str(REPOSITORY / "data"))
    door = Door(bin_folder.parent / "lib" / "libmetamer_bench_door.so")
    results = {"machine": machine()}
    print("machine:", results["machine"])
    if "solver" in wanted:
        bench_solver(door, results)
    if "build" in wanted:
        bench_build(door, results)
    if "kernel" in wanted:
        bench_kernel(door, results, arguments.rounds)
    if "cube" in wanted:
        bench_cube(results, bin_folder)
    output = REPOSITORY / "out"
    output.mkdir(exist_ok=True)
    (output / "bench.json").write_text(json.dumps(results, indent=1) + "\n")
    print("\nwritten: out/bench.json")
    return 0


if __name__ == "__main__":
    sys.exit(main())
