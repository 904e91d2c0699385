# SPDX-License-Identifier: Apache-2.0
"""The OFX plug-in in a host with two threads, UHD RGBA float32, against OpenColorIO on the same buffer and threads."""

import ctypes
import resource
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import PyOpenColorIO as ocio

import peers
from timing import interleaved, spread

THREADS = 2
FRAMES = 1000
OURS, CUBE, MATRIX = "metamer.ofx", "OCIO log + 33^3", "OCIO 3x3 matrix"
# At the least as fast as the cube, at the most as slow as the matrix: what the plug-in sets out to hold.
WANTED = {CUBE: 2.5, MATRIX: 1 / 2.5}
PAIRS = (("D65", "A"), ("D65", "HP1"))
TRANSFER, SKIN = 0, 2
# Of Spectral Transfer's speed.
WANTED_OF_SKIN = 0.5


class Effect:
    """An effect behind its C door (ofx_door.cpp): Spectral Transfer, or Skin."""

    def __init__(self, folder, index=TRANSFER):
        self.library = ctypes.CDLL(str(folder / "libmetamer_ofx_bench_door.so"))
        self.library.ofxOpenEffect.restype = ctypes.c_void_p
        for render in (self.library.ofxRender, self.library.ofxRenderDraft):
            render.argtypes = [ctypes.c_void_p, ctypes.c_double]
        self.library.ofxSetNumber.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double]
        self.handle = ctypes.c_void_p(self.library.ofxOpenEffect(THREADS, index))

    def __del__(self):
        self.library.ofxClose(self.handle)

    def set(self, **values):
        for name, value in values.items():
            if isinstance(value, str):
                self.library.ofxSetText(self.handle, name.encode(), value.encode())
            else:
                self.library.ofxSetNumber(self.handle, name.encode(), value)

    def connect(self, source, destination):
        height, width = source.shape[:2]
        self.library.ofxConnect(self.handle, source.ctypes.data_as(ctypes.c_void_p),
                                destination.ctypes.data_as(ctypes.c_void_p), width, height)

    def render(self, frame=0):
        if self.library.ofxRender(self.handle, frame) != 0:
            raise RuntimeError("the plug-in failed to render")

    def render_draft(self, frame=0):
        if self.library.ofxRenderDraft(self.handle, frame) != 0:
            raise RuntimeError("the plug-in failed to render a draft")

    def exact(self, rgb):
        """The engine's own result for colours."""
        source = np.ones((1, len(rgb), 4), np.float32)
        source[0, :, :3] = rgb
        destination = np.empty_like(source)
        self.set(quality="Exact")
        self.connect(source, destination)
        self.render()
        self.set(quality="Map")
        return destination[0, :, :3].astype(np.float64)


def in_strips(pool, processor, source, destination):
    """One strip a thread; OpenColorIO lets go of Python's lock while it works."""
    rows = np.array_split(np.arange(source.shape[0]), THREADS)
    jobs = [pool.submit(peers.run_ocio, processor, source[r[0]:r[-1] + 1], destination[r[0]:r[-1] + 1]) for r in rows]
    for job in jobs:
        job.result()


def steady_state(effect, source, destination, pair, rounds):
    effect.set(inputIlluminant=pair[0], outputIlluminant=pair[1])
    cube, matrix = peers.sampled_cube(effect.exact, 33, False), peers.matrix(effect.exact)
    effect.connect(source, destination)
    with ThreadPoolExecutor(THREADS) as pool:
        times = interleaved({
            OURS: effect.render,
            CUBE: lambda: in_strips(pool, cube, source, destination),
            MATRIX: lambda: in_strips(pool, matrix, source, destination),
        }, rounds)
    ours = times[OURS]
    return {"pair": "->".join(pair), "frames_per_second": {k: 1 / float(np.median(v)) for k, v in times.items()},
            "noise": spread(ours), "faster_than": {k: float(np.median(times[k] / ours)) for k in WANTED}}


def relative_difference(draft, final):
    """How far two pictures are apart, over the pixel's largest channel, 99th percentile."""
    size = np.maximum(np.abs(final[..., :3]).max(axis=-1), 1e-6)
    return float(np.quantile(np.abs(draft - final)[..., :3].max(axis=-1) / size, 0.99))


def parameter_change(effect, rounds):
    """Seconds, and processor seconds of all threads, from a slider's change to the first frame of HD under the new light,
    as a draft and then as a final frame. The final frame's time begins anew: what the draft made does not shorten it."""
    source = peers.photograph("astronaut")
    destination = np.empty_like(source)
    effect.connect(source, destination)
    rows = []
    for name, settings in (("daylight to blackbody", {"outputIlluminant": "Blackbody"}),
                           ("daylight to sodium, a gel", {"outputIlluminant": "HP1", "outputFilter": "Lee 204 Full C.T. Orange"}),
                           ("fluorescent to D50", {"inputIlluminant": "FL11", "outputIlluminant": "D50"})):
        effect.set(**{"inputIlluminant": "D65"} | settings)
        for kind, render in (("draft", effect.render_draft), ("final", effect.render)):
            wall, cpu = [], []
            for i in range(rounds):
                started, used = time.perf_counter(), time.process_time()
                effect.set(outputTemperature=2500.0 + 7 * i, outputDensity=0.5 + i / 100,
                           adaptation=(i + (kind == "final") / 2) / 1000)
                render()
                wall.append(time.perf_counter() - started)
                cpu.append(time.process_time() - used)
            rows.append({"change": name, "frame": kind, "milliseconds": 1e3 * float(np.median(wall)), "least": 1e3 * min(wall),
                         "worst": 1e3 * max(wall), "processor_milliseconds": 1e3 * float(np.median(cpu))})
        # The same parameters twice: as a draft, then final.
        effect.set(adaptation=0.31)
        effect.render_draft()
        draft = destination.copy()
        effect.render()
        rows[-2]["relative_p99"] = relative_difference(draft, destination)
        effect.set(inputIlluminant="D65", outputFilter="None", outputDensity=1.0, adaptation=0.0)
    return rows


def skin(transfer, folder, source, destination, rounds):
    """Skin, map quality, and Spectral Transfer from daylight to A, in turns."""
    effect = Effect(folder, SKIN)
    effect.set(blood=1.5, melanin=1.2)
    transfer.set(inputIlluminant="D65", outputIlluminant="A")
    effect.connect(source, destination)
    transfer.connect(source, destination)
    times = interleaved({"skin": effect.render, "transfer": transfer.render}, rounds)
    return {"frames_per_second": {k: 1 / float(np.median(v)) for k, v in times.items()},
            "noise": spread(times["skin"]), "as_fast": float(np.median(times["transfer"] / times["skin"]))}


def memory(effect):
    """Largest resident size after 100 frames and after all, MiB, mix animated by hand."""
    source = np.random.default_rng(1).random((270, 480, 4), np.float32)
    destination = np.empty_like(source)
    effect.connect(source, destination)
    sizes = []
    for frame in range(FRAMES):
        effect.set(mix=0.5 + frame % 10 / 20)
        effect.render(frame)
        if frame in (99, FRAMES - 1):
            sizes.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
    return {"frames": FRAMES, "after_100": sizes[0], "after_all": sizes[1]}


def run(context):
    effect = Effect(context.bin_folder.parent / "lib")
    picture = peers.photograph("astronaut")
    source = np.ascontiguousarray(np.kron(picture, np.ones((2, 2, 1), np.float32)))
    destination = np.empty_like(source)
    rows = [steady_state(effect, source, destination, pair, context.rounds) for pair in PAIRS]
    return {"ocio": ocio.__version__, "rounds": context.rounds, "rows": rows,
            "skin": skin(effect, context.bin_folder.parent / "lib", source, destination, context.rounds), "change": parameter_change(effect, max(5, context.rounds // 2)), "memory": memory(effect)}


def markdown(results):
    lines = [f"Spectral Transfer, map quality, 3840×2160, {THREADS} threads; OpenColorIO {results['ocio']} in as many strips. "
             f"Medians of {results['rounds']} interleaved rounds. Goal: {WANTED[CUBE]} times as fast as the cube, "
             f"{WANTED[MATRIX]} times as fast as the matrix.", "",
             "| | frames/s | noise | " + " | ".join(f"{k}, frames/s | as fast as it" for k in WANTED) + " |",
             "| --- | --- | --- |" + " --- | --- |" * len(WANTED)]
    for row in results["rows"]:
        peers_text = " | ".join(f"{row['frames_per_second'][k]:.1f} | {row['faster_than'][k]:.2f}" for k in WANTED)
        lines.append(f"| {row['pair']} | {row['frames_per_second'][OURS]:.1f} | ±{row['noise']:.0%} | {peers_text} |")
    # Results of before the effect have none.
    if "skin" in results:
        row = results["skin"]
        lines += ["", f"Skin, map quality, on the same picture: {row['frames_per_second']['skin']:.1f} frames/s (±{row['noise']:.0%}), "
                  f"{row['as_fast']:.2f} times as fast as Spectral Transfer (goal: {WANTED_OF_SKIN})."]
    lines += ["", "From a parameter's change to the first frame, HD:", "",
              "| | frame | milliseconds, median | least | worst | processor milliseconds | off the final frame, p99 |",
              "| --- | --- | --- | --- | --- | --- | --- |"]
    for row in results["change"]:
        off = f"{row['relative_p99']:.2%} of a pixel" if "relative_p99" in row else ""
        lines.append(f"| {row['change']} | {row['frame']} | {row['milliseconds']:.0f} | {row['least']:.0f} "
                     f"| {row['worst']:.0f} | {row['processor_milliseconds']:.0f} | {off} |")
    memory_row = results["memory"]
    lines += ["", f"Largest resident size of the process after 100 frames: {memory_row['after_100']:.1f} MiB; after "
              f"{memory_row['frames']}: {memory_row['after_all']:.1f} MiB."]
    return lines
