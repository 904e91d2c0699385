# SPDX-License-Identifier: Apache-2.0
"""The picture of docs/ofx.md: the OFX plug-in on a photograph, in the test host, at a few of its settings.

    METAMER_BIN=build/release/bin build/venv/bin/python demo/ofx_picture.py docs/images/ofx.jpg
"""

import sys

import contact_sheet
import pictures
from ofx_still import rendered

SETTINGS = [
    ("as shot, D65", {}),
    ("blackbody at 1900 K", {"outputIlluminant": "Blackbody", "outputTemperature": 1900}),
    ("the same, adaptation 0.6", {"outputIlluminant": "Blackbody", "outputTemperature": 1900, "adaptation": 0.6}),
    ("sodium HP1", {"outputIlluminant": "HP1"}),
    ("FL11 behind Lee 201, 0.6 of it", {"outputIlluminant": "FL11", "outputFilter": "Lee 201 Full C.T. Blue",
                                        "outputDensity": 0.6}),
    ("RGB LED, adaptation 1", {"outputIlluminant": "LED-RGB1", "adaptation": 1}),
]


def main():
    photograph = pictures.scene(pictures.scikit_image("coffee.png"))
    cells = [(label, pictures.view(rendered(photograph, settings))) for label, settings in SETTINGS]
    contact_sheet.sheet([cells[:3], cells[3:]], 420).save(sys.argv[1], quality=88)
    return 0


if __name__ == "__main__":
    sys.exit(main())
