# SPDX-License-Identifier: Apache-2.0
# Sourced by script/cross after debian_sources.sh, in the repository's root: the plug-in's libraries and the plug-in by the compiler of
# zig.txt, for a target that cmake/cross has a toolchain file of, in build/cross/TARGET.

cache=${XDG_CACHE_HOME:-$HOME/.cache}/metamer
# What the bundle links, and googletest for its tests: names of Debian's source packages.
libraries=(eigen3 nlohmann-json3 highway pugixml yaml-cpp googletest)

# Sets METAMER_ZIG.
fetch_zig() {
  local pin version folder work
  pin=$(sha256sum script/releases/zig.txt | cut -c 1-12)
  version=$(sed -nE 's/^ziglang==([0-9.]+).*/\1/p' script/releases/zig.txt)
  folder=$cache/zig-$version-$pin
  if [[ ! -x $folder/ziglang/zig ]]; then
    step "zig $version: $folder"
    mkdir -p "$cache"
    work=$(mktemp -d "$cache/fetching-XXXXXX")
    build/venv/bin/python -m pip download --quiet --disable-pip-version-check --no-deps --require-hashes \
      --only-binary :all: --requirement script/releases/zig.txt --dest "$work/wheel" ||
      { rm -rf "$work"; fail "zig $version cannot be fetched for $(uname -m)"; }
    build/venv/bin/python -m zipfile -e "$work"/wheel/*.whl "$work/unpacked"
    chmod +x "$work/unpacked/ziglang/zig"
    mv "$work/unpacked" "$folder"
    rm -rf "$work"
  fi
  export METAMER_ZIG=$folder/ziglang/zig ZIG_GLOBAL_CACHE_DIR=$cache/zig-cache
}

# configure_and_build <target> <source folder> <build folder> <prefix> [options...]
configure_and_build() {
  local target=$1 from=$2 to=$3 into=$4
  shift 4
  mkdir -p "$to"
  if ! { cmake -G Ninja -S "$from" -B "$to" --toolchain "$PWD/cmake/cross/$target.cmake" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_INSTALL_PREFIX="$into" -DCMAKE_PREFIX_PATH="$PWD/build/cross/$target/libraries" -DCMAKE_POLICY_DEFAULT_CMP0077=NEW "$@" &&
    cmake --build "$to"; } >"$to.log" 2>&1; then
    tail -n 40 "$to.log" >&2
    fail "$(basename "$from") does not build for $target; all of it: $to.log"
  fi
}

# The C++ library and what it needs as archives, and what macOS exports, for its linker: build/cross/TARGET/runtime. zig makes the archives when
# it links, and names them then.
make_macos_runtime() {
  local target=$1 to=build/cross/$1/runtime triple archive
  triple=$(sed -nE 's/^set\(METAMER_ZIG_TARGET ([^)]+)\)/\1/p' "cmake/cross/$target.cmake")
  mkdir -p "$to"
  echo 'int main() { return 0; }' >"$to/empty.cpp"
  ZIG_VERBOSE_LINK=1 "$METAMER_ZIG" c++ -target "$triple" -g0 "$to/empty.cpp" -o "$to/empty" >"$to.log" 2>&1 || { cat "$to.log" >&2; fail "zig does not link for $target"; }
  for archive in libc++abi.a libc++.a libcompiler_rt.a; do
    cp "$(grep '^zig ld ' "$to.log" | grep -oE "/[^ ]*/${archive//+/\\+}")" "$to/$archive" || fail "zig names no $archive for $target: $to.log"
  done
  # The linker knows all processors but the newest kind.
  sed -E 's/arm64e\.x1-[a-z]+,? *//g' "$(dirname "$METAMER_ZIG")/lib/libc/darwin/libSystem.tbd" >"$to/libSystem.tbd"
}

# Into build/cross/TARGET/libraries, anew only where the compiler, a source or how they are built changed.
make_libraries() {
  local target=$1 name folder=build/cross/$1 wanted
  local stamp=$folder/libraries.sha256
  wanted=$(cat script/releases/{debian_sources.sh,zig.sh,zig.txt} cmake/cross/*.cmake "$sources"/*.dsc | sha256sum | cut -d ' ' -f 1)
  [[ -f $stamp && $(<"$stamp") == "$wanted" ]] && return
  step "libraries for $target"
  rm -rf "$folder"
  [[ $target != macos-* ]] || make_macos_runtime "$target"
  for name in "${libraries[@]}"; do
    [[ $name != googletest || $target == windows ]] || continue
    configure_and_build "$target" "$sources/$name" "$folder/$name" "$PWD/$folder/libraries" \
      -DBUILD_TESTING=OFF -DBUILD_SHARED_LIBS=OFF -DBUILD_GMOCK=OFF -DYAML_CPP_BUILD_TOOLS=OFF -DYAML_CPP_BUILD_TESTS=OFF \
      -DJSON_BuildTests=OFF -DHWY_ENABLE_TESTS=OFF -DHWY_ENABLE_EXAMPLES=OFF -DHWY_ENABLE_CONTRIB=OFF -DEIGEN_BUILD_DOC=OFF
    cmake --install "$folder/$name" >/dev/null
  done
  printf '%s\n' "$wanted" >"$stamp"
}

# make_bundle <target> [options...]: build/cross/TARGET/OFX, its libraries first.
make_bundle() {
  local target=$1 folder=build/cross/$1
  shift
  make_libraries "$target"
  step "bundle for $target"
  configure_and_build "$target" "$PWD" "$folder/metamer" "$PWD/$folder" -DMETAMER_OFX_ONLY=ON -DMETAMER_STRICT_PATHS=ON -DMETAMER_PRECOMPILED=ON -DBUILD_TESTING=OFF "$@"
  rm -rf "$folder/OFX"
  cmake --install "$folder/metamer" --component ofx >/dev/null
}
