# SPDX-License-Identifier: Apache-2.0
"""Cases that break colour tools, each run through the programs, with what came out."""

import tempfile

from hard import colours, files, lights, pictures, stages
from hard.workshop import Workshop

# Name, case, exit code that is right (where the case judges itself it gives 0 for as it should be).
CASES = [
    ("input light: a 532 nm laser", lights.laser, 0),
    ("input light: one LED at 630 nm", lights.one_led, 0),
    ("input light: low-pressure sodium", lights.low_pressure_sodium, 0),
    ("two pipelines with no overlap", lights.no_overlap, 0),
    ("a filter that is zero everywhere", lights.zero_filter, 1),
    ("a light without power", lights.no_power, 1),
    ("spiky lamps against smooth ones", lights.spiky_against_smooth, 0),
    ("16 to 401 bands", lights.few_and_many_bands, 0),
    ("on, at and outside the locus and the purple line", colours.locus, 0),
    ("hard pixels between ordinary ones", colours.pixels, 0),
    ("a look twice, and its inverse", colours.twice_and_back, 0),
    ("LED primaries in one plane", stages.collinear_primaries, 1),
    ("a chart with missing and saturated patches", stages.faulty_chart, 0),
    ("Q of rank one", stages.rank_one_q, 0),
    ("pictures of odd sizes", pictures.odd_sizes, 0),
    ("a picture with another origin", pictures.moved_origin, 0),
    ("no pixel, and a picture that is its own result", pictures.nothing_and_itself, 0),
    ("memory of every shape, in the plug-in", pictures.memory_shapes, 0),
    ("malformed files", files.malformed, 0),
    ("a full disk", files.full_disk, 0),
    ("a folder that cannot be written", files.read_only_folder, 0),
    ("a killed render, resumed", files.killed_render, 0),
]


def run(context):
    rows = []
    for name, case, expected in CASES:
        with tempfile.TemporaryDirectory() as folder:
            code, outcome = case(Workshop(context, folder))
        rows.append({"case": name, "as_it_should": code == expected, "outcome": outcome.replace(str(folder), "…")})
    return rows


def markdown(results):
    good = sum(r["as_it_should"] for r in results)
    lines = [f"{good} of {len(results)} come out as they should.", "", "| case | outcome | as it should be |", "| --- | --- | --- |"]
    return lines + [f"| {r['case']} | {r['outcome'].replace('|', '/')} | {'yes' if r['as_it_should'] else '**no**'} |"
                    for r in results]
