# SPDX-License-Identifier: Apache-2.0
"""Pixels shot in daylight, as they would look under high-pressure sodium light."""

import numpy as np

import metamer

recipe = metamer.Recipe("D65", "HP1", adaptation=0.5)
transform = metamer.Transform(recipe)

picture = np.random.default_rng(1).uniform(0, 1, (270, 480, 3)).astype(np.float32)  # linear ACEScg
relit = transform(picture)  # exact, a new array
transform.map()(picture, out=picture)  # a table over colours, in place

report = metamer.ErrorProtocol(recipe).measure(transform.map())
print(f"{recipe}: mean {relit.mean(axis=(0, 1))}; the table is within {report.p99:.3f} CIEDE2000 (p99)")
