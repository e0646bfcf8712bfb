#!/bin/bash
# Builds everything for 64-bit ARM and runs the unit tests under qemu-user. Sets up what is missing: the
# cross compiler as a package of this machine, ARM's libraries unpacked beside the build, so that nothing
# of them is installed here. Skips aloud where that cannot be had.
#   BUILD=build/arm64 scripts/arm64.sh [TEST…]     TEST: names of unit tests, all when none is given
set -eu
build=${BUILD:-build/arm64}
root=$build-root # beside the build: it holds files that make would take for its own
tuple=aarch64-linux-gnu

skip() {
    echo "SKIP arm64: $1"
    [ -z "${DIG_NO_SKIP-}" ] || exit 1
    exit 0
}

# The libraries and their headers, from the package sources this machine has.
unpack_root() {
    local apt=$PWD/$root.apt
    mkdir -p "$apt"/{state/lists/partial,cache/archives/partial} "$root/usr/lib" "$root/usr/bin"
    : >"$apt/status"
    [ -e "$root/lib" ] || ln -s usr/lib "$root/lib"
    local options=(-o "Dir::State=$apt/state" -o "Dir::State::status=$apt/status" -o "Dir::Cache=$apt/cache"
        -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o APT::Sandbox::User=root -o Debug::NoLocking=1)
    apt-get "${options[@]}" -q update >"$apt/log" 2>&1 || return 1
    # shellcheck disable=SC2046 # a list of packages
    apt-get "${options[@]}" -q -y --no-install-recommends --download-only install \
        $(awk '$1 == "arm64-root" { print $2 }' scripts/packages.txt) >>"$apt/log" 2>&1 || return 1
    local deb
    for deb in "$apt"/cache/archives/*.deb; do dpkg-deb -x "$deb" "$root"; done
    # Links that begin at the system's root are to begin at this one.
    local link
    find "$root" -lname '/*' | while read -r link; do
        ln -sfn "$PWD/$root$(readlink "$link")" "$link"
    done
    rm -rf "$apt/cache/archives"
    touch "$root/.complete"
}

scripts/setup.sh build arm64 || skip "the cross compiler cannot be installed here"
[ -e "$root/.complete" ] || { echo "arm64: unpacking libraries into $root"; unpack_root; } ||
    skip "ARM's libraries cannot be fetched here; see $root.apt/log"

export PKG_CONFIG_SYSROOT_DIR=$PWD/$root
export PKG_CONFIG_LIBDIR=$PWD/$root/usr/lib/$tuple/pkgconfig:$PWD/$root/usr/share/pkgconfig
tests=("$@")
[ $# -gt 0 ] || for t in tests/*/test_*.c; do t=${t#tests/}; tests+=("${t%.c}"); done
targets=()
for t in "${tests[@]}"; do targets+=("$build/tests/$t"); done
# Debian 12's cross compiler (12.2) breaks down vectorizing a sum; loops that ask for it are vectorized all the same.
make --no-print-directory -j "$(nproc)" BUILD="$build" CC="$tuple-gcc --sysroot=$PWD/$root" CFLAGS="-O2 -g -fno-tree-loop-vectorize" AR=$tuple-ar all "${targets[@]}"

# Each test behind a line that runs it under qemu.
wrapped=()
for t in "${tests[@]}"; do
    mkdir -p "$build/run/$(dirname "$t")"
    printf '#!/bin/sh\nexec qemu-aarch64 -L "%s" "%s"\n' "$PWD/$root" "$build/tests/$t" >"$build/run/$t"
    chmod +x "$build/run/$t"
    wrapped+=("$build/run/$t")
done
DIG_TEST_QUICK=1 scripts/run_tests.sh -j "$(nproc)" "${wrapped[@]}"
