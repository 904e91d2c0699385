# SPDX-License-Identifier: Apache-2.0
"""Two releases of OpenColorIO in one process: the one that metamer links, and the system's, an older one."""

import ctypes


class Release:
    """Runs LUT files through one release (ocio_door.cpp)."""

    def __init__(self, folder, name):
        """`name`: linked or older."""
        self.library = ctypes.CDLL(str(folder / f"libmetamer_bench_{name}_ocio.so"))
        self.library.metamerOcioVersion.restype = ctypes.c_char_p
        self.library.metamerFile.restype = ctypes.c_void_p
        self.library.metamerFile.argtypes = [ctypes.c_char_p, ctypes.c_int, ctypes.c_int]
        self.library.metamerFileApply.restype = None
        self.library.metamerFileApply.argtypes = [ctypes.c_void_p] * 3 + [ctypes.c_size_t]
        self.version = self.library.metamerOcioVersion().decode()

    def file(self, path, log_in_out, exact_log=True):
        """A call on (source, destination) arrays of RGBA; `log_in_out`: a file that takes and gives ACEScct, run here
        from linear to linear; `exact_log`: as metamer runs a file, else by OCIO's defaults."""
        handle = self.library.metamerFile(str(path).encode(), int(log_in_out), int(exact_log))
        if handle is None:
            raise ValueError(f"{path}: OpenColorIO {self.version} refuses it")

        def call(source, destination):
            self.library.metamerFileApply(handle, source.ctypes.data, destination.ctypes.data, source.size // 4)

        return call
