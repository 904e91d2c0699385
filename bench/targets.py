# SPDX-License-Identifier: Apache-2.0
"""What metamer sets out to hold, and what the benchmark measured: one table, so that nothing missed is left unsaid."""

import math
from dataclasses import dataclass
from typing import Callable

import defaults
from render_scenes import over_mitsuba


@dataclass(frozen=True)
class Target:
    """A bound on a figure of one section."""

    section: str
    what: str
    sense: str  # "<=" or ">="
    bound: float
    figure: Callable  # of the section's figures; KeyError, IndexError or ValueError where it was not measured
    reason: str = ""  # why it is not reached, where it is not

    def measured(self, figures):
        """The figure, or nothing where the section does not hold it."""
        try:
            return float(self.figure(figures))
        except (KeyError, IndexError, ValueError, TypeError, StopIteration):
            return None

    def holds(self, value):
        return value is not None and math.isfinite(value) and (value <= self.bound if self.sense == "<=" else value >= self.bound)


def _largest(values):
    """NaN where there is one among them."""
    values = list(values)
    return math.nan if any(math.isnan(value) for value in values) else max(values)


def _least(values):
    return -_largest(-value for value in values)


def _kernel(least_of, candidate):
    return lambda f: _least(least_of(row["candidates"][candidate]) for row in f["rows"])


def _map_p99_share(f):
    return _largest(row["candidates"]["metamer map"]["error"]["inside"]["p99"] / row["candidates"][cube]["error"]["inside"]["p99"]
               for row in f["rows"] for cube in ("OCIO log + 33^3", "OCIO log + 33^3 + antilog"))


def _map_error(statistic):
    return lambda f: _largest(row["candidates"]["metamer map"]["error"]["all"][statistic] for row in f["rows"])


def _uplift_time(f, method):
    return next(row["ns"] for row in f["times"] if row["method"] == method)


def _stored(rows, most_bytes, figure):
    """The best form of at most so many bytes."""
    return min(row[figure] for row in rows if row["bytes"] <= most_bytes)


def _cubes(f, kind, size, value):
    return {r["pair"]: r[value] for r in f if r["kind"] == kind and r["size"] == size}


def _cube_ratio(kind, size):
    """33 nodes of a kind over sampled of a size, the worst pair of lights."""
    def figure(f):
        fitted, sampled = _cubes(f, kind, 33, "p99"), _cubes(f, "sampled", size, "p99")
        return _largest(fitted[pair] / sampled[pair] for pair in fitted)
    return figure


def _cube_seconds(kind, size):
    return lambda f: _largest(_cubes(f, kind, size, "seconds").values())


def _chain(statistic):
    return lambda f: _largest(r["error"]["all"][statistic] for r in f if r["label"].startswith("chain 65,"))


def _bands(statistic):
    return lambda f: _largest(r[statistic] for r in f if r["bands"] == 251)


def _solve(f):
    return _largest(s["microseconds"] for s in f["solves"] if s["upper_bound"] and s["bands"] == 81)


def _engine(f, scene):
    return _largest(s["microseconds"] for s in f["engine"] if s["scene"] == scene and s["colours"] == "photograph")


def _meng(f):
    return f["meng_2015_microseconds"] / _largest(s["microseconds"] for s in f["solves"] if s["upper_bound"] and s["bands"] == 81)


def _smooth_objects(f):
    return _largest(s["beyond_noise"] for row in f for s in row["scenes"] if s["name"] == "smooth objects")


def _ofx(peer):
    return lambda f: _least(row["faster_than"][peer] for row in f["rows"])


def _first_frame(kind):
    return lambda f: _largest(row["worst"] for row in f["change"] if row["frame"] == kind)


def _guiding(lights):
    """Of guided renders against uniform ones in the same time: MSE of Y lower by, with the samples that gain least."""
    return lambda f: _least(row["equal_time"][1] for row in f["guiding"] if row["light"] in lights)


def _choice(place, names):
    """The best of these choices of light against that by power in the same time."""
    return lambda f: next(max(row["better"][name] for name in names) for row in f["choices"] if row["scene"].startswith(place))


def _mitsuba(depth, place):
    """Price of our best method over that of Mitsuba's better one, the same samples each, start included."""
    return lambda f: next(over_mitsuba(row) for row in f[depth] if row["scene"] == place)


TABLE_COST = "where memory is slow, a frame takes its time whatever is computed"
STEEP = "the transform is steep and kinked for dark saturated colours, and nodes a lattice apart cannot follow every kink"
TOE = ("to A, at -7 stops, six tetrahedra of the 33³ hold the whole gamut; gradient descent on the percentile itself found no "
       "better nodes, but for those fitted to whole stops alone, whose percentile at half stops is 2.7")
WHOLE_CALL = ("a quarter of the work is the table; OpenColorIO's reading the file back, for the certificate, is a quarter with 33 nodes "
              "and half with 65")
BUILD = "exact colours are computed until every patch holds its tolerance: tens of thousands of solves"
LEARNING = "learning is about 3% of the work at 16 samples; this is the least of six ratios that a busy machine blurs by a tenth"
NOISE = "next-event estimation is already near what is left of the noise at this time and size"
EDGES = ("most of the error that is left lies in the few pixels on edges, where a pixel sees several things (on the wall three quarters "
         "in 2% of them): choosing lights or wavelengths better does not help there")
MEMORY = "the film's exact sums and the reservoirs of two progressions are most of it"

TARGETS = (
    Target("solver", "smoothest spectrum within 0 and 1, 81 bands, µs", "<=", 10, _solve),
    Target("solver", "exact engine, 81 bands, scene natural, photographs, µs per colour", "<=", 6, lambda f: _engine(f, "natural")),
    Target("solver", "exact engine, 81 bands, scene smooth, photographs, µs per colour", "<=", 1.5, lambda f: _engine(f, "smooth")),
    Target("solver", "times as fast as colour-science's Meng 2015", ">=", 1e5, _meng),
    *(Target("uplifts", f"uplift {name}, ns per colour", "<=", asked, lambda f, n=name: _uplift_time(f, n), reason)
      for name, asked, reason in (("mallett", 30, ""), ("smits", 100, ""),
                                  ("otsu", 100, ""), ("jakob", 5000, ""),
                                  ("jakob table, coefficients", 60, "eight nodes of a table larger than the caches"))),
    Target("pairs", "largest error at 24 pairs, exact engine, four lights, CIEDE2000", "<=", 1e-3,
           lambda f: _largest(r["pairs"]["max"] for r in f if r["scene"].startswith("pairs"))),
    *(Target("pairs", f"24 pairs over smooth, TM-30 held out, D65 to {light}, mean", "<=", asked,
             lambda f, name=light: next(r["held_out"]["mean"] for r in f if (r["light"], r["scene"]) == (name, "pairs over smooth")))
      for light, asked in (("A", 1.70), ("FL11", 1.90), ("HP1", 2.65), ("LED-RGB1", 1.70))),
    Target("storage", "223 reflectances in 20 floats, four lights, mean CIEDE2000", "<=", 0.05, lambda f: _stored(f["surfaces"], 80, "mean")),
    Target("storage", "the same in 20 bytes", "<=", 0.15, lambda f: _stored(f["surfaces"], 20, "mean")),
    Target("storage", "the same in 12 floats", "<=", 0.20, lambda f: _stored(f["surfaces"], 48, "mean")),
    Target("storage", "every illuminant in 20 floats, the ColorChecker under the worst", "<=", 0.1, lambda f: _stored(f["lights"], 80, "worst")),
    Target("build", "building a map, slowest lights, s", "<=", 0.5, lambda f: _largest(r["seconds"] for r in f), BUILD),
    Target("kernel", "map's speed over OCIO's log + 33³, least", ">=", 2.5,
           _kernel(lambda c: c["map_is_faster_by"], "OCIO log + 33^3"), TABLE_COST),
    Target("kernel", "map's speed over OCIO's log + 33³ + antilog, least", ">=", 4,
           _kernel(lambda c: c["map_is_faster_by"], "OCIO log + 33^3 + antilog"), TABLE_COST),
    Target("kernel", "map's p99 over the cubes', largest", "<=", 0.1, _map_p99_share),
    Target("kernel", "map against converged, p99, largest", "<=", 0.1, _map_error("p99")),
    Target("kernel", "map against converged, max, largest", "<=", 1.0, _map_error("max")),
    Target("releases", "linked OpenColorIO's speed over 2.1's, a .clf of log + 33³, least", ">=", 4,
           lambda f: _least(row["linked_is_faster_by"] for row in f["rows"] if row["file"].startswith("log +") and row["logarithm"] == "fast")),
    Target("cube", "33³ fitted behind a 1-D shaper, s", "<=", 3, _cube_seconds("fitted, 1-D shaper", 33)),
    Target("cube", "33³ sampled, s", "<=", 0.2, _cube_seconds("sampled", 33), WHOLE_CALL),
    Target("cube", "65³ written (sampled), s", "<=", 1, _cube_seconds("sampled", 65), WHOLE_CALL),
    Target("cube", "33³ fitted over sampled, p99, worst lights", "<=", 1 / 3, _cube_ratio("fitted", 33), STEEP),
    Target("cube", "33³ fitted behind a 1-D shaper over 65³ sampled, p99, worst lights", "<=", 1, _cube_ratio("fitted, 1-D shaper", 65)),
    Target("cube", "the same without a 1-D shaper", "<=", 1, _cube_ratio("fitted", 65), TOE),
    Target("apply", "lutgen apply --engine map on half EXR frames, of the speed of OpenImageIO copying them, two threads", ">=", 0.8,
           lambda f: f["of_the_copy"]),
    Target("apply", "frames whose alpha is not bit for bit what it was", "<=", 0, lambda f: f["frames"] - f["alpha_kept"]),
    Target("ofx", "UHD frames, speed over OCIO's log + 33³, least", ">=", 2.5, _ofx("OCIO log + 33^3"), TABLE_COST),
    Target("ofx", "UHD frames, speed over OCIO's 3x3 matrix, least", ">=", 0.4, _ofx("OCIO 3x3 matrix")),
    Target("ofx", "parameter change to first HD frame as a draft, ms, worst", "<=", 42, _first_frame("draft"),
           "a new lamp's first: the engine's 41 and 201 bands are prepared and a map is built"),
    Target("ofx", "parameter change to first HD frame, ms, worst", "<=", 150, _first_frame("final"),
           "a new lamp's first: some 18,000 colours are solved for its map"),
    Target("ofx", "a draft off the final frame, p99 over the pixel's largest channel", "<=", 0.015,
           lambda f: _largest(r["relative_p99"] for r in f["change"] if r["frame"] == "draft")),
    Target("ofx", "memory grown from frame 100 to the last, MiB", "<=", 1,
           lambda f: f["memory"]["after_all"] - f["memory"]["after_100"]),
    Target("wavelengths", "guided over uniform at equal time, MSE of Y, chart under spiky lamps and a red gel, least", ">=", 2,
           _guiding(("FL11", "HP1", "A through a red gel")), NOISE),
    Target("wavelengths", "the same, smooth lamps, least", ">=", 0.95, _guiding(("A", "D65")), LEARNING),
    Target("wavelengths", "guided over uniform at equal time, MSE of X and Z, all lamps, least", ">=", 0.7,
           lambda f: _least(row["equal_time"][channel] for row in f["guiding"] for channel in (0, 2))),
    *(Target("renderer", f"price over the better Mitsuba's, {place}, {text}", "<=", bound, _mitsuba(depth, place), EDGES)
      for depth, text, bounds in (("noise", "six edges", (1 / 3, 0.25, 0.1)), ("direct", "direct light", (1 / 3, 0.05, 0.05)))
      for place, bound in zip(("chart under A", "LED wall", "chart under FL11"), bounds)),
    Target("renderer", "ReSTIR over choice by power, LED wall of 32 × 18", ">=", 4,
           _choice("LED wall", ("ReSTIR, hero", "ReSTIR, lanes")), NOISE),
    Target("renderer", "ReSTIR over choice by power, 10⁵ emitters", ">=", 10,
           _choice("100,000", ("ReSTIR, hero", "ReSTIR, lanes")), NOISE),
    Target("renderer", "the best choice of lights over that by power, room of 10⁵ emitters, six edges", ">=", 10,
           _choice("a room", ("by place", "ReSTIR, hero", "ReSTIR, lanes"))),
    Target("renderer", "peak memory, 1920×1080, guiding, ReSTIR, 16 bins, MiB", "<=", 1536, lambda f: f["memory_mib"], MEMORY),
    Target("renderer", "the same, 3840×2160", "<=", 4096, lambda f: f["memory_4k_mib"], MEMORY),
    Target("transforms", ".ctf of 65 nodes, ±10 stops, D65 to A, HP1, FL11, p99, largest", "<=", 0.5, _chain("p99"), STEEP),
    Target("transforms", "the same, max", "<=", 3, _chain("max"), STEEP),
    Target("transforms", "cheaper choices that are more accurate than a default", "<=", 0, lambda f: len(defaults.beaten(f)),
           "the default wants changing"),
    Target("bands", "default 251 bands against converged, p99, largest", "<=", 0.1, _bands("p99"), "FL11's lines"),
    Target("bands", "default 251 bands against converged, max, largest", "<=", 0.5, _bands("max"), "FL11's lines"),
    Target("validation", "smooth objects beyond noise, mean CIEDE2000, largest", "<=", 0.1, _smooth_objects),
    Target("stability", "kernel values that are not finite for finite colours", "<=", 0,
           lambda f: sum(not r["finite"] for r in f["arithmetic"])),
    Target("stability", "pixels that an instruction set changes", "<=", 0, lambda f: sum(r["different"] for r in f["instruction_sets"])),
    Target("compilers", "values of engine and kernel, and files, that another compiler changes", "<=", 0,
           lambda f: sum(r["different"] for r in f["rows"] if not r["what"].startswith("render/"))),
    Target("compilers", "values of renders that another compiler changes", "<=", 0,
           lambda f: sum(r["different"] for r in f["rows"] if r["what"].startswith("render/"))),
    Target("compilers", "values that threads or instruction sets change", "<=", 0,
           lambda f: sum(r["different"] for r in f["within"])),
    Target("hard_cases", "hard cases that do not come out as they should", "<=", 0, lambda f: sum(not r["as_it_should"] for r in f),
           "see the table of hard cases"),
)


def _number(value):
    return f"{value:,.0f}" if math.isfinite(value) and value == int(value) else f"{value:.3g}"


def _judged(results, sections):
    return [(t, t.measured(results[t.section]["figures"]) if t.section in results else None) for t in TARGETS if t.section in sections]


def _bound(target):
    return f"{'≤' if target.sense == '<=' else '≥'} {_number(target.bound)}"


def verdict(results, sections):
    """In words: how many of these sections' targets are met, and which are missed."""
    rows = _judged(results, sections)
    unmeasured = sum(value is None for _, value in rows)
    missed = [(t, value) for t, value in rows if value is not None and not t.holds(value)]
    lines = [f"{len(rows) - unmeasured - len(missed)} of {len(rows)} are met" + (f", {unmeasured} not measured" if unmeasured else "") + "."
             + (" Missed:" if missed else "")]
    if missed:
        lines.append("")
    return lines + [f"- {t.what}: {_number(value)}, where the goal is {_bound(t)}" + (f" ({t.reason})" if t.reason else "") for t, value in missed]


def markdown(results, sections):
    """Table of the targets of these sections."""
    lines = ["| what | goal | figure | met | why not |", "| --- | --- | --- | --- | --- |"]
    for t, value in _judged(results, sections):
        verdict = "not measured" if value is None else "yes" if t.holds(value) else "**no**"
        shown = "" if value is None else _number(value)
        lines.append(f"| {t.what} | {_bound(t)} | {shown} | {verdict} | {t.reason if verdict == '**no**' else ''} |")
    return lines
