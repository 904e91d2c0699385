# SPDX-License-Identifier: Apache-2.0
"""transform_pixels.py PREFIX: the README's lines, by the package of an install tree."""

import sys
import tempfile
from pathlib import Path

import numpy as np

import metamer

assert Path(metamer.__file__).is_relative_to(sys.argv[1]), metamer.__file__
picture = np.full((4, 5, 3), [0.2, 0.5, 0.3], np.float32)
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "day_to_sodium.yaml"
    file.write_text("metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: HP1}\n", encoding="utf-8")
    recipe = metamer.Recipe.read(file)
relit = metamer.Transform(recipe)(picture)
assert relit.shape == picture.shape and np.isfinite(relit).all() and (relit != picture).all(), relit
