#!/bin/sh
# Prints the Debian packages of the named jobs whose library pkg-config does not find: scripts/missing_packages.sh build test
# Nothing when all are there. PKG_CONFIG names another pkg-config.
set -eu

here=$(dirname "$0")
pkg_config=${PKG_CONFIG:-pkg-config}
command -v "$pkg_config" >/dev/null || { echo pkg-config; exit 0; }

for job in "$@"; do
    awk -v job="$job" '$1 == job && NF == 3 { print $2, $3 }' "$here/packages.txt"
done | while read -r package name; do
    # A library that is there but needs one that is not fails too; the one to name is the one not found.
    why=$("$pkg_config" --print-errors --exists "$name" 2>&1) && continue
    case $why in *"Package $name was not found"*) echo "$package" ;; esac
done
