#!/bin/bash
# A plain Debian package of what `make install` installs, with the systemd unit and the configuration
# under /etc/digsight, which the package manager leaves alone once it was changed.
#   BUILD=build VERSION=0.1.0 scripts/deb.sh
set -eu
build=${BUILD:-build} version=${VERSION:?}
arch=$(dpkg --print-architecture)
root=$build/deb
rm -rf "$root"
make --no-print-directory BUILD="$build" install PREFIX=/usr DESTDIR="$root" >/dev/null

mkdir -p "$root/DEBIAN" "$root/etc/digsight" "$root/usr/lib/systemd/system" "$root/usr/share/doc/digsight"
sed 's|/usr/local/bin|/usr/bin|' config/systemd/digsightd.service >"$root/usr/lib/systemd/system/digsightd.service"
sed 's|: \.\./tables/|: /usr/share/digsight/tables/|; s|: machines/|: /usr/share/digsight/config/machines/|
     s|map: signals/|map: /usr/share/digsight/config/signals/|' config/digsightd.yaml >"$root/etc/digsight/digsightd.yaml"
cp LICENSE "$root/usr/share/doc/digsight/copyright"
gzip -9n <CHANGELOG.md >"$root/usr/share/doc/digsight/changelog.gz"
echo /etc/digsight/digsightd.yaml >"$root/DEBIAN/conffiles"

# The packages that hold the libraries the programs were linked with.
depends() {
    local library path
    for library in $(objdump -p "$root"/usr/bin/* | awk '$1 == "NEEDED" { print $2 }' | sort -u); do
        path=$(ldconfig -p | awk -v name="$library" '$1 == name { print $NF; exit }')
        dpkg-query -S "$(readlink -f "$path")" "$path" 2>/dev/null | sed 's/:.*//'
    done | sort -u | paste -sd, | sed 's/,/, /g'
}
cat >"$root/DEBIAN/control" <<CONTROL
Package: digsight
Version: $version
Architecture: $arch
Maintainer: Digsight maintainers <digsight@localhost>
Installed-Size: $(du -sk "$root/usr" | cut -f 1)
Depends: $(depends)
Recommends: gnuplot-nox, iproute2
Section: science
Priority: optional
Description: tells an excavator what the ground will resist with
 A DEM of gravel digging, a table of how gravels resist, and a daemon that
 identifies the gravel from one short dig and predicts the digs that follow.
 What it publishes is advice, not a safety function.
CONTROL
find "$root" -type d -exec chmod 755 {} +
dpkg-deb --build --root-owner-group "$root" "$build/digsight_${version}_$arch.deb"
