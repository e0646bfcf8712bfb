#!/bin/sh
# Installs what the named jobs need and this machine lacks: scripts/setup.sh build test …
# As root, or through sudo when it asks for no password; otherwise it prints the line to type and
# stops with 1. Nothing is done when nothing is missing.
set -eu

here=$(dirname "$0")
[ $# -gt 0 ] || { echo "usage: $0 JOB… (jobs: $(awk '!/^#/ { print $1 }' "$here/packages.txt" | sort -u | tr '\n' ' '))" >&2; exit 2; }

command -v dpkg-query >/dev/null || {
    echo "setup: this is not a Debian system; install what scripts/packages.txt lists for: $*" >&2
    exit 1
}

missing=
for job in "$@"; do
    for package in $(awk -v job="$job" '$1 == job { print $2 }' "$here/packages.txt"); do
        state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
        [ "$state" = installed ] || case " $missing " in *" $package "*) ;; *) missing="$missing $package" ;; esac
    done
done
[ -n "$missing" ] || exit 0

install="apt-get install -y --no-install-recommends$missing"
if [ "$(id -u)" = 0 ]; then
    as_root=
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    as_root="sudo -n"
else
    echo "setup: these packages are missing:$missing" >&2
    echo "setup: type this, then try again:" >&2
    echo "  sudo sh -c 'apt-get update && $install'" >&2
    exit 1
fi

echo "setup: installing$missing" >&2
export DEBIAN_FRONTEND=noninteractive
log=$(mktemp)
if ! { $as_root apt-get update && $as_root env DEBIAN_FRONTEND=noninteractive $install; } >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "setup: the packages above could not be installed" >&2
    rm -f "$log"
    exit 1
fi
rm -f "$log"
