# SPDX-License-Identifier: Apache-2.0
# Linux of glibc 2.28 (Rocky 8, Debian 10) and newer, x86-64.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(METAMER_ZIG_TARGET x86_64-linux-gnu.2.28)
include("${CMAKE_CURRENT_LIST_DIR}/zig.cmake")
# The C++ library comes with tables of symbols, several times as large as the plug-in. It leaves destructors of statics and threads
# behind, which nothing runs where a host unloads the plug-in: it stays until the host ends.
set(CMAKE_MODULE_LINKER_FLAGS_INIT "-s -Wl,-z,nodelete")
