# SPDX-License-Identifier: Apache-2.0
"""docs/images/playground.jpg: the page that script/playground made, in headless Chromium.

    build/venv/bin/python demo/playground.py
"""

import sys
import tempfile
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests" / "playground"))

from devtools import Page  # noqa: E402

SET = """for (const [id, value] of [['out', 'HP1'], ['gel', 'Lee 219 Fluorescent Green'], ['adaptation', 0.6]]) {
  document.getElementById(id).value = value;
  document.getElementById(id).dispatchEvent(new Event('input'));
}
document.documentElement.dataset.state = '';"""


def main():
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        page = Page(Path(folder) / "profile", 1180, 880)
        try:
            page.open((ROOT / "build" / "playground" / "metamer.html").as_uri())
            page.wait("document.documentElement?.dataset.state === 'rest'")
            page.evaluate(SET)
            page.wait("document.documentElement.dataset.state === 'rest'")
            page.screenshot(Path(folder) / "page.png")
        finally:
            page.close()
        with Image.open(Path(folder) / "page.png") as shot:
            target = ROOT / "docs" / "images" / "playground.jpg"
            shot.convert("RGB").resize((960, round(960 * shot.height / shot.width)), Image.Resampling.LANCZOS).save(
                target, quality=85, optimize=True)
            print(target, target.stat().st_size, "bytes")


if __name__ == "__main__":
    main()
