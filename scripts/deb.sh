#!/bin/bash
# Debian packages of what git knows of this tree, built with debhelper in BUILD/deb, where they are left:
#   BUILD=build VERSION=0.1.0 scripts/deb.sh
# The bytes depend neither on the time nor on the folder: debian/changelog dates them.
set -euo pipefail
build=${BUILD:-build} version=${VERSION:?}
said=$(dpkg-parsechangelog -S Version)
[ "$said" = "$version" ] || { echo "deb: debian/changelog is of version $said, the Makefile of $version" >&2; exit 1; }

tree=$build/deb/digsight-$version
rm -rf "$build/deb"
mkdir -p "$tree"
git ls-files -z | xargs -0 cp --parents --no-dereference --target-directory="$tree"
cd "$tree"
env -u MAKEFLAGS -u MAKELEVEL DEB_BUILD_OPTIONS="noautodbgsym parallel=${JOBS:-$(nproc)}" \
    dpkg-buildpackage --build=binary --no-sign >../build.log 2>&1 || { tail -n 30 ../build.log >&2; exit 1; }
cd ..
rm -rf "digsight-$version"
ls -- *.deb
