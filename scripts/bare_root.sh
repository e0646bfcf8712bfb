#!/bin/bash
# Shows that a newcomer's two commands need nothing else: makes a bare Debian 12 root, clones this
# repository into it and runs one target there. Needs root and debootstrap.
#   scripts/bare_root.sh demo|test [ROOT]      ROOT (default /tmp/digsight-bare) is made if absent, and kept
set -eu
target=${1:?usage: $0 demo|test [ROOT]}
root=${2:-/tmp/digsight-bare}
repo=$(cd "$(dirname "$0")/.." && pwd)

[ -e "$root/etc/debian_version" ] || debootstrap --variant=minbase --include=make,git,ca-certificates bookworm "$root"

mounts=()
cleanup() {
    for ((i = ${#mounts[@]} - 1; i >= 0; i--)); do umount "${mounts[i]}"; done
}
trap cleanup EXIT
bind() { # KIND-OR-SOURCE TARGET OPTIONS…
    mkdir -p "$root$2"
    mount "${@:3}" "$1" "$root$2"
    mounts+=("$root$2")
}
bind proc /proc -t proc
bind sysfs /sys -t sysfs
bind /dev /dev --bind
bind devpts /dev/pts -t devpts -o ptmxmode=666,newinstance
bind tmpfs /dev/shm -t tmpfs

# The clone goes over a bundle: nothing of this checkout but its commits is seen inside.
git -C "$repo" bundle create -q "$root/tmp/repo.bundle" HEAD
rm -rf "$root/tmp/digsight"
cp /etc/resolv.conf "$root/etc/resolv.conf"
env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM=dumb LANG=C.UTF-8 chroot "$root" /bin/sh -c \
    "cd /tmp && git clone -q repo.bundle digsight && cd digsight && make $target"
