# SPDX-License-Identifier: Apache-2.0
# Sourced by the scripts that build for other systems, in the repository's root. They set `cache`, a folder, and `libraries`,
# names of Debian's source packages, and call fetch_sources, which sets `sources`.

step() { printf '==> %s\n' "$*"; }
fail() { printf 'script/%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# Debian's sources, patched, as $sources/NAME. apt's own settings say from where, and nothing of them is changed.
fetch_sources() {
  local release work name apt
  release=$(. /etc/os-release && echo "$VERSION_CODENAME")
  sources=$cache/debian-$release-sources
  for name in "${libraries[@]}"; do
    [[ -d $sources/$name ]] || break
  done
  [[ -d $sources/$name ]] && return
  step "sources of ${libraries[*]}: $sources"
  command -v dpkg-source >/dev/null || fail "needs dpkg-source: install dpkg-dev"
  mkdir -p "$cache"
  work=$(mktemp -d "$cache/fetching-XXXXXX")
  mkdir -p "$work"/{parts,lists/partial,cache/archives/partial,made}
  sed -s 's/^Types:.*/Types: deb-src/' /etc/apt/sources.list.d/*.sources >"$work/parts/sources.sources" 2>/dev/null || true
  sed -nE 's/^deb /deb-src /p' /etc/apt/sources.list /etc/apt/sources.list.d/*.list >"$work/parts/sources.list" 2>/dev/null || true
  apt=(apt-get -q -o "Dir::Etc::SourceList=/dev/null" -o "Dir::Etc::SourceParts=$work/parts" -o "Dir::State::Lists=$work/lists"
    -o "Dir::Cache=$work/cache" -o "APT::Sandbox::User=$(id -un)")
  if ! { "${apt[@]}" update && cd "$work/made" && "${apt[@]}" source --download-only "${libraries[@]}"; } >"$work/log" 2>&1; then
    cat "$work/log" >&2
    rm -rf "$work"
    fail "the sources cannot be fetched"
  fi
  for name in "${libraries[@]}"; do
    dpkg-source --extract "$name"_*.dsc "$name" >>"$work/log" 2>&1 || { cat "$work/log" >&2; fail "$name cannot be unpacked"; }
  done
  cd "$OLDPWD"
  rm -rf "$sources"
  mv "$work/made" "$sources"
  rm -rf "$work"
}
