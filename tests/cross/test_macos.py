# SPDX-License-Identifier: Apache-2.0
"""The bundle for macOS, as far as it can be checked where nothing can run it: for whom it was built, what it shows and asks of
the system, and that its signature is of these very bytes.

script/cross runs it: METAMER_BUNDLE is the bundle, METAMER_LINUX_BIN the folder of the native build's programs.
"""

import os
import plistlib
import struct
import unittest
from pathlib import Path

import mach_o

BUNDLE = Path(os.environ["METAMER_BUNDLE"])
NATIVE = Path(os.environ["METAMER_LINUX_BIN"])
LIBRARY = "Contents/MacOS/metamer.ofx"
ENTRY_POINTS = {"_OfxGetNumberOfPlugins", "_OfxGetPlugin", "_OfxSetHost"}
MINIMUM = (11, 0, 0)
# What the system's library of that version has, as far as the bundle asks.
SYSTEM = {line for line in (Path(__file__).parent / "macos_11.txt").read_text().splitlines() if not line.startswith("#")}
# Of Objective-C's library, asked for by name when a host brings Metal.
OBJECTIVE_C = (b"objc_getClass", b"sel_registerName", b"object_getClass", b"class_respondsToSelector",
               b"class_getMethodImplementation", b"objc_autoreleasePoolPush", b"objc_autoreleasePoolPop")
MESSAGES = (b"newLibraryWithSource:options:error:", b"setFastMathEnabled:", b"dispatchThreadgroups:threadsPerThreadgroup:")


class MacOs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.slices = mach_o.slices((BUNDLE / LIBRARY).read_bytes())

    def each(self):
        return self.slices.values()

    def test_has_the_shape_that_hosts_look_for(self):
        names = {path.relative_to(BUNDLE).as_posix() for path in BUNDLE.rglob("*") if path.is_file()}
        self.assertLessEqual({LIBRARY, "Contents/Info.plist", "Contents/Resources/LICENSE", "Contents/Resources/data/manifest.json"},
                             names)
        self.assertEqual([path.name for path in (BUNDLE / "Contents").glob("*/*.ofx")], ["metamer.ofx"])
        self.assertFalse(any(path.is_symlink() for path in BUNDLE.rglob("*")))
        facts = plistlib.loads((BUNDLE / "Contents/Info.plist").read_bytes())
        self.assertEqual((facts["CFBundleExecutable"], facts["CFBundlePackageType"]), ("metamer.ofx", "BNDL"))
        self.assertEqual(facts["LSMinimumSystemVersion"], f"{MINIMUM[0]}.{MINIMUM[1]}")

    def test_is_for_both_processors(self):
        self.assertEqual(set(self.slices), {mach_o.ARM64, mach_o.X86_64})
        for processor, part in self.slices.items():
            self.assertEqual(part.header[:2], (mach_o.MAGIC_64, processor))

    def test_is_a_bundle_of_the_oldest_system_that_it_is_for(self):
        for part in self.each():
            self.assertEqual(part.kind, mach_o.MH_BUNDLE)
            self.assertEqual(part.minimum(), (mach_o.PLATFORM_MACOS, MINIMUM))

    def test_its_load_commands_lie_within_it(self):
        for part in self.each():
            kinds = [kind for kind, _ in part.commands()]
            for once in (mach_o.LC_SYMTAB, mach_o.LC_DYLD_INFO_ONLY, mach_o.LC_BUILD_VERSION, mach_o.LC_CODE_SIGNATURE):
                self.assertEqual(kinds.count(once), 1)
            names = [struct.unpack_from("<16s", part.data, at + 8)[0].rstrip(b"\0") for _, at in part.commands(mach_o.LC_SEGMENT_64)]
            self.assertEqual((names[0], names[-1]), (b"__TEXT", b"__LINKEDIT"))
            self.assertEqual(part.file_end(), len(part.data))

    def test_exports_the_entry_points_alone(self):
        for part in self.each():
            self.assertEqual(part.exports(), ENTRY_POINTS)

    def test_asks_for_nothing_but_the_system(self):
        for part in self.each():
            self.assertEqual(part.libraries(), ["/usr/lib/libSystem.B.dylib"])
            asked = part.undefined()
            # Not from the compiler's library, which has them too.
            self.assertLessEqual({"_pthread_create", "_memcpy", "_exp", "_log"}, set(asked))
            self.assertEqual(sorted(set(asked) - SYSTEM), [], "not in the library of macOS 11")
            self.assertEqual({name for name, description in asked.items() if description >> 8 != 1}, set(), "from another library")
            # The C++ library is within.
            self.assertEqual([name for name in asked if name.startswith("__Z")], [])

    def test_shares_no_symbol_with_a_host(self):
        for part in self.each():
            self.assertTrue(part.flags & mach_o.TWO_LEVEL)
            self.assertFalse(part.flags & (mach_o.WEAK_DEFINES | mach_o.BINDS_TO_WEAK))
            self.assertEqual(part.weak_binds(), 0)
            self.assertEqual([name for name, description in part.undefined().items() if description & mach_o.N_WEAK_REF], [])

    def test_renders_with_metal_by_the_kernels_that_were_tested(self):
        text = (NATIVE.parent / "ofx/window_texts/window.metal").read_bytes()
        self.assertIn(b"#include <metal_stdlib>", text)
        for part in self.each():
            self.assertEqual(part.data.count(text + b"\0"), 1)
            missing = [name for name in (*OBJECTIVE_C, *MESSAGES, b"METAMER_OFX_METAL") if b"\0" + name + b"\0" not in part.data]
            self.assertEqual(missing, [])
            self.assertLessEqual({"_dlopen", "_dlsym"}, set(part.undefined()))

    def test_is_signed_to_the_last_page(self):
        for part in self.each():
            limit, wrong = part.signed_pages()
            self.assertEqual(wrong, [])
            self.assertEqual(limit, part.numbers(mach_o.LC_CODE_SIGNATURE, "<II")[0])


if __name__ == "__main__":
    unittest.main()
