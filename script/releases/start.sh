#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Starts the program of this name in ../libexec. The system's loader asks /proc where a program lies, to find the libraries beside it;
# where /proc is not mounted, it is told.
self=$(readlink -f -- "$0")
folder=${self%/*/*}/libexec
[ -e /proc/self/exe ] || export LD_ORIGIN_PATH="$folder"
exec "$folder/${self##*/}" "$@"
