# SPDX-License-Identifier: Apache-2.0
"""What leaves lutgen, and what may come between: devices, pipes, links, full disks, --quiet; signals: test_signals.py."""

import os
import resource
import signal
import stat
import subprocess
import threading
import time
import unittest

import numpy as np
from PIL import Image, ImageCms

from lutgen import LINKED, LUTGEN, LutgenTest, lutgen

LIGHTS = ["--illuminant-in", "D65", "--illuminant-out", "A", "--scene", "smooth", "--size", "5"]
RECIPE = """metamer: 1
name: evening
input: {illuminant: D65}
output: {illuminant: A}
scene: {kind: smooth}
"""
CONFIG_OF_SPACES = """ocio_profile_version: 2
roles: {default: linear, scene_linear: linear, aces_interchange: linear}
file_rules: [!<Rule> {name: Default, colorspace: default}]
displays: {screen: [!<View> {name: as is, colorspace: linear}]}
active_displays: [screen]
active_views: [as is]
colorspaces:
  - !<ColorSpace> {name: linear}
  - !<ColorSpace> {name: mask, isdata: true}
  - !<ColorSpace> {name: lost, to_scene_reference: !<FileTransform> {src: lost.cube}}
  - !<ColorSpace> {name: short, to_scene_reference: !<FileTransform> {src: short.cube}}
"""
STAGE = ["stage", "emitter", "led:620:18"]


class Outputs(LutgenTest):
    def bake(self, *arguments, **options):
        return subprocess.run([LUTGEN, "bake", *LIGHTS, *arguments], cwd=self.folder, capture_output=True, text=True,
                              timeout=300, **options)

    def test_streams_and_devices_are_written_into(self):
        self.assertWorks("bake", *LIGHTS, "-o", "a.cube")
        table = (self.folder / "a.cube").read_text()
        run = self.bake("-o", "/dev/stdout", "--format", "iridas_cube")
        self.assertEqual((run.returncode, run.stdout), (0, table), run.stderr)
        self.assertRegex(run.stderr, r"^/dev/stdout: log cube of 5 nodes, p99 [0-9.]+, [0-9.]+ s\n$")
        # At its place in a file that the shell has opened.
        with open(self.folder / "all.txt", "wb", buffering=0) as file:
            file.write(b"first\n")
            run = subprocess.run([LUTGEN, "bake", *LIGHTS, "-o", "/dev/stdout", "--format", "iridas_cube"], stdout=file)
        self.assertEqual((self.folder / "all.txt").read_text(), "first\n" + table)
        os.mkfifo(self.folder / "pipe.cube")
        read = []
        reader = threading.Thread(target=lambda: read.append((self.folder / "pipe.cube").read_text()))
        reader.start()
        self.assertEqual(self.bake("-o", "pipe.cube").stdout, "")
        reader.join()
        self.assertEqual(read, [table])
        self.assertTrue(stat.S_ISFIFO(os.stat(self.folder / "pipe.cube").st_mode))
        self.assertFalse((self.folder / "pipe.cube.json").exists())
        self.assertEqual(self.bake("-o", "/dev/null", "--format", "clf").returncode, 0)
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))
        self.assertFails("bake", *LIGHTS, "-o", "/dev/full", "--format", "clf", says=["/dev/full", "No space left"])
        self.assertFails("bake", *LIGHTS, "-o", "/dev/nothing.clf", says=["/dev/nothing.clf", "no device"])
        (self.folder / "r.yaml").write_text(RECIPE)
        self.assertFails("config", "r.yaml", "-o", "/dev/null", says=["/dev/null", "device"])
        self.assertFalse(os.path.exists("/dev/null.json"))

    def test_a_pipe_that_nobody_reads_can_be_given_up(self):
        os.mkfifo(self.folder / "pipe.cube")
        run = subprocess.Popen([LUTGEN, "bake", *LIGHTS, "-o", "pipe.cube"], cwd=self.folder, stderr=subprocess.PIPE)
        time.sleep(2)  # by then it waits for a reader
        run.send_signal(signal.SIGINT)
        try:
            self.assertEqual(run.communicate(timeout=60)[1], b"lutgen: stopped by SIGINT; nothing was written\n")
            self.assertEqual(run.returncode, -signal.SIGINT)
        finally:
            run.kill()

    def test_a_replaced_file_keeps_its_mode_and_a_link_stays(self):
        self.assertWorks("bake", *LIGHTS, "-o", "a.ctf")
        os.chmod(self.folder / "a.ctf", 0o640)
        before = (self.folder / "a.ctf").read_bytes()
        os.symlink("a.ctf", self.folder / "link.ctf")
        self.assertWorks("bake", *LIGHTS, "--adaptation", "1", "-o", "link.ctf")
        self.assertTrue((self.folder / "link.ctf").is_symlink())
        self.assertNotEqual((self.folder / "a.ctf").read_bytes(), before)
        self.assertEqual(stat.S_IMODE(os.stat(self.folder / "a.ctf").st_mode), 0o640)

    def test_a_full_disk_is_one_line_and_leaves_the_old_file(self):
        (self.folder / "r.yaml").write_text(RECIPE)
        (self.folder / "a.ctf").write_text("old")
        (self.folder / "c.ocio").write_text("old")

        def limited():
            resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

        for arguments, name in ((["bake", *LIGHTS, "-o", "a.ctf"], "a.ctf"),
                                (["config", "r.yaml", "-o", "c.ocio", "--size", "5"], "luts/trial.ctf"),
                                ([*STAGE, "-o", "led.csv"], "led.csv")):
            run = subprocess.run([LUTGEN, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=300,
                                 preexec_fn=limited, env={**os.environ, "LLVM_PROFILE_FILE": os.devnull})
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertRegex(run.stderr, rf"^lutgen: \S*{name}: output: cannot be written: File too large; .*\n$")
        self.assertEqual(sorted(path.name for path in self.folder.rglob("*")), ["a.ctf", "c.ocio", "r.yaml"])
        self.assertEqual((self.folder / "a.ctf").read_text() + (self.folder / "c.ocio").read_text(), "oldold")

    def test_quiet_is_silent_and_failures_are_not(self):
        (self.folder / "r.yaml").write_text(RECIPE)
        for arguments in (["bake", "r.yaml", "-o", "a.ctf", "--size", "5"],
                          ["bake", "r.yaml", "-o", "a.ctf", "--tolerance", "10"],
                          ["config", "r.yaml", "-o", "c.ocio", "--size", "5"],
                          ["compare", "a.ctf", "a.ctf"],
                          [*STAGE, "-o", "led.csv"]):
            self.assertRegex(self.assertWorks(*arguments).splitlines()[-1], r", [0-9.]+ s$", arguments)
            self.assertEqual(self.assertWorks(*arguments, "--quiet"), "", arguments)
        self.assertFails("bake", "none.yaml", "-o", "b.ctf", "--quiet", says=["none.yaml"])

    def test_every_message_is_a_line_of_300_bytes(self):
        long = "x" * 250
        for text in ("a: [" + "\n" * 30, "metamer: 1\nname: " + long + "\nillumin\u00e4nt: " + long + "\n"):
            (self.folder / (long + ".yaml")).write_text(text)
            run = lutgen("bake", long + ".yaml", "-o", long + ".cube", folder=self.folder)
            self.assertEqual((run.returncode, run.stderr.count("\n")), (1, 1), run.stderr)
            self.assertLessEqual(len(run.stderr.encode()), 301)

    def test_what_a_command_refuses_is_named_with_its_file(self):
        def write(name, text):
            (self.folder / name).write_text(text)

        write("config.ocio", CONFIG_OF_SPACES)
        write("short.cube", "LUT_3D_SIZE 2\n0 0 0\n")
        write("zero.csv", "nm,power\n380,0\n780,0\n")
        write("dark.yaml", RECIPE.replace("illuminant: A", "illuminant: zero.csv"))
        write("opaque.yaml", RECIPE.replace("illuminant: A", "illuminant: A, filters: [{file: zero.csv}]"))
        write("comma.yaml", RECIPE.replace("evening", '"a,b"'))
        chart = "patch,R,G,B\n" + "".join(f"{name},{{0}},{{0}},{{0}}\n" for name in ("white", "grey", "red", "blue"))
        for name, value in (("black.csv", 0), ("a.csv", 0.3), ("b.csv", 0.4)):
            write(name, chart.format(value))
        write("others.csv", "patch,R,G,B\nx,1,1,1\n")
        write("two.csv", "patch,R,G,B\n0,0,0,0\n1,1,1,1\n")
        Image.new("RGB", (4, 4)).save(self.folder / "a.png")
        shell = {"OCIO": str(self.folder / "config.ocio")}
        for space, says in (("mask", "space 'mask': holds data"), ("lost", "space 'lost': cannot be converted"),
                            ("short", "space 'short': cannot be converted")):
            write(f"{space}.yaml", RECIPE + f"space: {space}\n")
            with self.subTest(space):
                self.assertFails("bake", f"{space}.yaml", "-o", "a.ctf", environment=shell,
                                 says=[f"{space}.yaml: ", "config.ocio: ", says])
        charts = ["--charts", "a.csv", "b.csv", "--json", "a.json"]
        for arguments, says in (
            (["bake", "dark.yaml", "-o", "a.ctf"], "dark.yaml: output: illuminant 'power'"),
            (["config", "dark.yaml", "-o", "a.ocio"], "dark.yaml: output: illuminant 'power'"),
            (["job", "bake", "dark.yaml", "-o", "looks", "--slurm", "job"], "dark.yaml: output: illuminant 'power'"),
            (["bake", "opaque.yaml", "-o", "a.ctf"], "opaque.yaml: output: A through power: filters '1'"),
            (["config", "comma.yaml", "-o", "a.ocio"], "comma.yaml: name 'a,b'"),
            (["job", "bake", "comma.yaml", "-o", "comma.yaml", "--slurm", "new/job"], "comma.yaml: folder: cannot be made"),
            (["skin", "estimate", "a.png", "-o", "a.exr", "--illuminant", "zero.csv"], "zero.csv: illuminant 'power'"),
            (["stage", "match", "--target", "black.csv", *charts], "black.csv: target: holds no light"),
            (["stage", "match", "--target", "others.csv", *charts], "others.csv: --charts: charts: no patch"),
            (["stage", "select", "--targets", "zero.csv", "--emitters", "led:600:20", "--json", "a.json"], "zero.csv: illuminant 'power'"),
            (["stage", "match", "--target", "A", "--emitters", "zero.csv", "--json", "a.json"], "zero.csv: emitters: give no"),
            (["stage", "linearity", "two.csv"], "two.csv: drives '2'"),
        ):
            with self.subTest(says):
                self.assertFails(*arguments, says=[says])
        self.assertFails("bake", *LIGHTS, "-o", "a.ctf", "--tolerance", "-1", code=2,
                         says=["--tolerance: '-1' is too small; give a number above 0; see"])

    def test_certificates_of_any_depth_and_size_are_refused_at_once(self):
        """Nesting that would overrun the stack, and fields whose number squared is the time that they take."""
        head = '{"metamer_certificate":1,"tool":{},"transform":{},"error":{"mean":1,"p99":1,"max":1},"x":'
        (self.folder / "deep.json").write_text(head + "[" * 300000 + "]" * 300000 + "}")
        self.assertFails("diff", "deep.json", "deep.json", says=["certificate", "nests too deep"])
        fields = ",".join(f'"k{i}":{i}' for i in range(200000))
        (self.folder / "many.json").write_text(head + "{" + fields + "}}")
        self.assertFails("diff", "many.json", "many.json", says=["certificate", "more fields"])


CONFIG = """ocio_profile_version: 2.1
search_path: %s
roles: {aces_interchange: ap0, default: ap0, scene_linear: ap0}
displays:
  d:
    - !<View> {name: v, colorspace: ap0}
colorspaces:
  - !<ColorSpace> {name: ap0, isdata: false}
  - !<ColorSpace> {name: c, isdata: false, encoding: log, to_scene_reference: %s}
"""


class Libraries(LutgenTest):
    """What OpenColorIO and OpenImageIO say, or would do, behind a door: one line, with the reason alone."""

    @unittest.skipIf(LINKED < (2, 5), "the linked OpenColorIO follows spaces that lead back to themselves for ever")
    def test_configs_that_lead_nowhere(self):
        (self.folder / "luts").mkdir()
        (self.folder / "luts" / "zero.ctf").write_text(
            '<ProcessList id="z" version="1.7"><Reference path="/dev/zero" inBitDepth="32f" outBitDepth="32f"/></ProcessList>')
        for search, transform, says in (
            ("luts", "!<FileTransform> {src: /dev/zero}", ["c.ocio", "src '/dev/zero'", "device"]),
            ("/dev", "!<FileTransform> {src: zero}", ["c.ocio", "src 'zero'", "device"]),
            ("luts", "!<GroupTransform> {children: [!<FileTransform> {src: zero.ctf}]}", ["zero.ctf", "/dev/zero"]),
            ("luts", "!<ColorSpaceTransform> {src: c, dst: ap0}", ["space 'c'", "lead back to themselves"]),
            ("luts", "!<NoTransform> {a: 1}", ["c.ocio", "At line 9", "NoTransform"]),
            ("luts", "[", ["c.ocio", "line "]),
        ):
            with self.subTest(transform):
                (self.folder / "c.ocio").write_text(CONFIG % (search, transform))
                run = lutgen("bake", "--illuminant-in", "D65", "--illuminant-out", "A", "--size", 5, "--space", "c", "-o", "o.cube",
                             folder=self.folder, environment={"OCIO": "c.ocio"})
                self.assertEqual(run.returncode, 1, run.stderr)
                self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
                for text in says:
                    self.assertIn(text, run.stderr)
                self.assertNotIn("yaml-cpp", run.stderr)
                self.assertFalse((self.folder / "o.cube").exists())

    def test_luts_by_the_reason_alone(self):
        (self.folder / "a.cube").write_text("LUT_3D_SIZE 3\n0 0 0\n")
        self.assertFails("bake", "--lut", "a.cube", "-o", "b.ctf", says=["a.cube: LUT", "entries", "export it again"])
        run = lutgen("bake", "--lut", "a.cube", "-o", "b.ctf", folder=self.folder)
        self.assertNotIn(str(self.folder), run.stderr)
        self.assertNotIn("debug log", run.stderr)

    def test_cubes_whose_domain_falls(self):
        table = "\n".join(f"{r} {g} {b}" for b in (0, 1) for g in (0, 1) for r in (0, 1)) + "\n"
        Image.fromarray(np.zeros((4, 4, 3), np.uint8)).save(self.folder / "a.png")
        for head, says in (("DOMAIN_MIN 1 1 1\nDOMAIN_MAX 0 0 0", "DOMAIN_MIN '1 1 1'"), ("DOMAIN_MAX 1 0 1", "DOMAIN_MAX (1 0 1)"),
                           ("DOMAIN_MIN 0 0 nan\nDOMAIN_MAX 1 1 1", "DOMAIN_MIN '0 0 nan'"),
                           ("LUT_3D_INPUT_RANGE 1 0", "LUT_3D_INPUT_RANGE '1 0'")):
            for end in ("\n", "\r\n"):
                with self.subTest(head):
                    (self.folder / "a.cube").write_text(f"{head}\nLUT_3D_SIZE 2\n{table}".replace("\n", end), newline="")
                    for arguments in (("apply", "a.cube", "a.png", "b.png"), ("bake", "--lut", "a.cube", "-o", "b.ctf")):
                        self.assertFails(*arguments, says=["a.cube", says, "export the LUT again"])
        for head in ("DOMAIN_MIN -1 0 0\nDOMAIN_MAX 2 2 2", "DOMAIN_MAX 2 2 2", "LUT_3D_INPUT_RANGE 0.0 2.0", ""):
            (self.folder / "a.cube").write_text(f"# DOMAIN_MIN 1\n{head}\nLUT_3D_SIZE 2\n{table}")
            self.assertEqual(lutgen("apply", "a.cube", "a.png", "b.png", folder=self.folder).returncode, 0, head)

    def test_profiles_of_other_colours(self):
        """A PNG's library drops such a profile without a word; nobody takes the pixels for sRGB then."""
        (self.folder / "a.yaml").write_text(RECIPE)
        srgb = ImageCms.ImageCmsProfile(ImageCms.createProfile("sRGB")).tobytes()
        picture = Image.fromarray(np.full((4, 6, 3), 90, np.uint8))
        for extension in ("png", "jpg", "tif"):
            name = "a." + extension
            for colours in ("Lab ", "CMYK", "GRAY", "XYZ "):
                picture.save(self.folder / name, icc_profile=srgb[:16] + colours.encode() + srgb[20:])
                self.assertFails("apply", "a.yaml", name, "b." + extension, says=[name, f"ICC profile '{colours.strip()}'",
                                                                                   "--picture-space"])
                run = lutgen("apply", "a.yaml", name, "b." + extension, "--picture-space", "sRGB", folder=self.folder)
                self.assertEqual(run.returncode, 0, run.stderr)
            picture.save(self.folder / name, icc_profile=srgb)
            self.assertEqual(lutgen("apply", "a.yaml", name, "b." + extension, folder=self.folder).returncode, 0)

    def test_pictures_that_are_pipes_or_devices(self):
        (self.folder / "r.yaml").write_text(RECIPE)
        os.mkfifo(self.folder / "pipe.exr")
        os.symlink("/dev/zero", self.folder / "zero.exr")
        charts = ["--emitter-charts", "a.csv", "--scene-chart", "a.csv"]
        (self.folder / "a.csv").write_text("patch,R,G,B\nwhite,1,1,1\n")
        for name in ("pipe.exr", "zero.exr"):
            for arguments in (
                ["apply", "r.yaml", name, "out.exr"],
                ["compare", name, name],
                ["report", "r.yaml", "-o", "out.html", "--picture", name],
                ["skin", "estimate", name, "-o", "out.exr"],
                ["skin", "edit", name, "-o", "out.exr"],
                ["stage", "environment", name, "-o", "out.exr", *charts],
                ["stage", "sample", name, "--corners", "0,0", "9,0", "9,9", "0,9", "-o", "out.csv"],
                ["uplift", name, "-o", "out.exr"],
                ["bake", "--illuminant-in", name, "--illuminant-out", "A", "-o", "out.ctf"],
            ):
                with self.subTest(arguments):
                    self.assertFails(*arguments, says=[f"{name}: is a folder, "])

    def test_broken_pngs(self):
        Image.fromarray(np.random.default_rng(1).integers(0, 255, (24, 32, 3), np.uint8)).save(self.folder / "whole.png")
        whole = (self.folder / "whole.png").read_bytes()
        damaged = bytearray(whole)
        damaged[len(whole) // 2] ^= 0x10
        (self.folder / "damaged.png").write_bytes(damaged)
        (self.folder / "cut.png").write_bytes(whole[: len(whole) // 2])
        (self.folder / "a.yaml").write_text(RECIPE)
        self.assertEqual(lutgen("apply", "a.yaml", "whole.png", "b.png", folder=self.folder).returncode, 0)
        for name, says in (("damaged.png", "damaged"), ("cut.png", "cut short")):
            for arguments in (("apply", "a.yaml", name, "o.png"), ("compare", name, "whole.png"),
                              ("stage", "sample", name, "-o", "o.csv", "--corners", "0,0", "9,0", "9,9", "0,9")):
                with self.subTest(arguments=arguments):
                    self.assertFails(*arguments, says=[name, "byte '", says, "again"])


if __name__ == "__main__":
    unittest.main()
