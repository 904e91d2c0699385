# SPDX-License-Identifier: Apache-2.0
"""A folder, and metamer's programs in it: where hard cases are tried."""

import json
import subprocess
from pathlib import Path

RECIPE = "metamer: 1\nname: hard\nspace: ACEScg\ninput: {{illuminant: {}{}}}\noutput: {{illuminant: {}{}}}\n"


class Workshop:
    def __init__(self, context, folder):
        self.door, self.bin_folder, self.folder = context.door, context.bin_folder, Path(folder)

    def run(self, *arguments, program="lutgen", **options):
        """Exit code and stderr."""
        done = subprocess.run([self.bin_folder / program, *map(str, arguments)], cwd=self.folder, capture_output=True,
                              text=True, errors="replace", check=False, **options)
        return done.returncode, done.stderr.strip()

    def spectrum(self, name, rows, quantity="power"):
        (self.folder / name).write_text(f"wavelength_nm,{quantity}\n" + "".join(f"{w},{v}\n" for w, v in rows))
        return name

    def recipe(self, light_in, light_out, filter_in="", filter_out=""):
        def filters(name):
            return f", filters: [{{file: {name}}}]" if name else ""

        (self.folder / "hard.yaml").write_text(RECIPE.format(light_in, filters(filter_in), light_out, filters(filter_out)))
        return "hard.yaml"

    def bake(self, *recipe, **filters):
        """Exit code, and the certificate's error or the message."""
        code, message = self.run("bake", self.recipe(*recipe, **filters), "-o", "hard.clf")
        if code != 0:
            return code, f"refused: {message}"
        error = json.loads((self.folder / "hard.clf.json").read_text())["error"]
        return code, f"baked; p99 {error['p99']:.2f}, max {error['max']:.1f}"
