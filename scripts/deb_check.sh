#!/bin/bash
# What the packages of `make deb` promise: built again in another folder they are the same bytes, lintian has no word
# against them, and in a bare Debian 12 root an ordinary user uses them; upgrade, removal and purge keep what is to be
# kept. Needs root and network:  BUILD=build VERSION=0.1.0 scripts/deb_check.sh [ROOT]
# ROOT: a bare root made before (mmdebstrap --variant=minbase --include=bash-completion,man-db bookworm ROOT).
set -uo pipefail
. tests/system/check.bash
version=${VERSION:?}
debs=$(realpath "${BUILD:-build}")/deb
work=$(mktemp -d)
mounted=""
cleanup() {
    [ -z "$mounted" ] || umount "$mounted"
    rm -rf --one-file-system "$work"
}
trap cleanup EXIT
end() { # [SKIPPED]
    echo "$passed passed, $failed failed${1:+, $1 skipped}"
    [ "$failed" = 0 ]
    exit
}

again() { # the packages are built once more where folder, time zone and rights of new files are others
    (umask 027 && TZ=Asia/Tokyo BUILD=$work/elsewhere VERSION=$version scripts/deb.sh >"$work/out" 2>"$work/err") &&
        (cd "$debs" && sha256sum -- *.deb) >"$work/sums" && (cd "$work/elsewhere/deb" && sha256sum -c "$work/sums" >"$work/err")
}
[ "${DEB_CHECK_ONCE:-}" ] || check "built again elsewhere they are the same bytes" again
check "lintian has no word against them" eval 'lintian --allow-root --fail-on error,warning --tag-display-limit 0 "$debs"/*.deb >"$work/err" 2>&1'
grep -v '^N:' "$work/err"

[ "$(id -u)" = 0 ] || { echo "SKIP: no root here to make a root of Debian"; end 1; }
root=${1:-$work/root}
[ -e "$root/etc/debian_version" ] ||
    mmdebstrap --quiet --variant=minbase --include=bash-completion,man-db bookworm "$root" >"$work/out" 2>&1 ||
    { tail -n 3 "$work/out"; echo "SKIP: no bare Debian 12 root could be made, is there a network?"; end 1; }
cp /etc/resolv.conf "$root/etc/resolv.conf"
mount -t proc proc "$root/proc" && mounted=$root/proc

inside() { # COMMAND…: as root, in the root
    env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        chroot "$root" "$@" >"$work/out" 2>"$work/err" </dev/null
}
user() { # COMMAND LINE: as an ordinary user
    chroot --userspec=1000:1000 "$root" /usr/bin/env -i HOME=/tmp PATH=/usr/bin:/bin LANG=C.UTF-8 bash -c "cd /tmp && $1" \
        >"$work/out" 2>"$work/err" </dev/null
}
kept() { # FILE…: of the root, with the words that were put into them
    local file
    for file in "$@"; do grep -q "of the user's" "$root$file" || { echo "$file" >"$work/err"; return 1; }; done
}
packages="digsight-controller digsight-workstation digsight-data digsight-dev"
rm -rf "$root/debs" "$root/next"
mkdir "$root/debs" "$root/next"
cp "$debs"/*.deb "$root/debs"
install -m 644 tests/data/reference/mu0.5_mur0.5_rho2500__simpleA.csv "$root/tmp/simpleA.csv"
install -m 644 tests/data/formats/scene.yaml "$root/tmp/scene.yaml"

check "they are installed, and what they need" \
    inside sh -c 'apt-get update && apt-get install -y --no-install-recommends /debs/*.deb'
check "the daemon waits to be enabled" eval '[ -e "$root/lib/systemd/system/digsightd.service" ] &&
    [ ! -e "$root/etc/systemd/system/multi-user.target.wants/digsightd.service" ]'
check "a user shows a shipped table" user "digtable show /usr/share/digsight/tables/reference_rig.sqlite 0 --trajectory actual"
check "identifies the gravel of a recording" \
    eval 'user "digloop identify /usr/share/digsight/tables/reference_rig.sqlite simpleA.csv --json" && grep -q "\"friction\"" "$work/out"'
check "simulates a machine" \
    user "digrig record simpleA.csv --machine /usr/share/digsight/config/machines/zx200_trench.yaml -o run.csv && [ -s run.csv ]"
check "digs" user "digtable dig scene.yaml --trajectory scrape --friction .5 --rolling .2 --density 2500 -o dig.csv --quiet && [ -s dig.csv ]"
check "and has a program for logs" user "digreport --help"
check "the configuration under /etc is one that works" user "digsightd -c /etc/digsight/digsightd.yaml --check"
check "man has the pages" eval 'user "man digtable show" && grep -q "trajectory NAME" "$work/out" && user "man 8 digsightd"'
check "bash completes" eval 'user ". /usr/share/bash-completion/bash_completion; _completion_loader digloop
    COMP_LINE=\"digloop id\" COMP_POINT=10 COMP_CWORD=1; COMP_WORDS=(digloop id); _digsight; echo \${COMPREPLY[*]}" &&
    grep -qx identify "$work/out"'

# What a site has of its own: a configuration, a table and a model beside it, and what the daemon keeps.
mine="/etc/digsight/digsightd.yaml /etc/digsight/site.sqlite /etc/digsight/model.json"
state=/var/lib/private/digsight/match.json
mkdir -p "$root${state%/*}"
for file in $mine $state; do echo "# of the user's" >>"$root$file"; done
next() { # the packages as of a later version
    local deb tree=$work/tree
    for deb in "$debs"/*.deb; do
        rm -rf "$tree"
        dpkg-deb -R "$deb" "$tree" || return 1
        sed -i "s/^Version: .*/Version: $version+next/; s/(= $version)/(= $version+next)/" "$tree/DEBIAN/control"
        dpkg-deb -Znone --root-owner-group -b "$tree" "$root/next/${deb##*/}" >/dev/null || return 1
    done
}
check "a later version is there" next
check "the upgrade asks nothing" inside sh -c 'apt-get install -y --no-install-recommends /next/*.deb'
check "and has taken place" eval 'inside dpkg-query -W -f "\${Version}" digsight-controller && grep -qxF "$version+next" "$work/out"'
check "it keeps tables, models, configuration and state" kept $mine $state
check "removal does" inside apt-get remove -y $packages
check "and takes the programs" eval '[ ! -e "$root/usr/bin/digsightd" ] && [ ! -e "$root/usr/share/digsight" ]'
check "it keeps tables, models, configuration and state, too" kept $mine $state
check "purge does" inside dpkg --purge $packages
check "and takes configuration and state" eval '[ ! -e "$root/etc/digsight/digsightd.yaml" ] && [ ! -e "$root${state%/*}" ]'
check "but no file that is the user's own" kept /etc/digsight/site.sqlite /etc/digsight/model.json
rm -rf "$root/etc/digsight"
check "nothing else is left" eval '[ -z "$(find "$root/etc" "$root/usr" "$root/var/lib" "$root/lib" -name "*digsight*" |
    grep -v "/var/lib/systemd/deb-systemd" | tee "$work/err")" ]'
end
