# SPDX-License-Identifier: Apache-2.0
"""The OpenColorIO that metamer is built with (Debian's), in the same process as the newest one."""

import ctypes



class OlderOcio:
    """Runs LUT files through the linked OpenColorIO (file_door.cpp)."""

    def __init__(self, path):
        self.library = ctypes.CDLL(str(path))
        self.library.metamerLinkedOcioVersion.restype = ctypes.c_char_p
        self.library.metamerFile.restype = ctypes.c_void_p
        self.library.metamerFile.argtypes = [ctypes.c_char_p, ctypes.c_int]
        self.library.metamerFileApply.restype = None
        self.library.metamerFileApply.argtypes = [ctypes.c_void_p] * 3 + [ctypes.c_size_t]
        self.version = self.library.metamerLinkedOcioVersion().decode()

    def file(self, path, log_in_out):
        """A call on (source, destination) arrays of RGBA; `log_in_out`: a file that takes and gives ACEScct, run here
        from linear to linear."""
        handle = self.library.metamerFile(str(path).encode(), int(log_in_out))

        def call(source, destination):
            self.library.metamerFileApply(handle, source.ctypes.data, destination.ctypes.data, source.size // 4)

        return call
