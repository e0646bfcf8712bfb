#!/bin/bash
# What `make install` puts where, and `make uninstall` takes away again, from one list:
#   PREFIX=/usr/local SYSCONFDIR=/usr/local/etc LIBDIR=/usr/local/lib DESTDIR= \
#       UNITDIR=/usr/local/lib/systemd/system BUILD=build VERSION=0.1.0 scripts/install.sh install|uninstall PROGRAM…
# A configuration that was changed is neither overwritten nor removed.
set -euo pipefail
verb=${1:?usage: $0 install|uninstall PROGRAM…}
shift
share=$PREFIX/share
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

emptied() { # FOLDER: it and those over it go, if they are ours and nothing is left in them
    local folder=$1
    while [[ ${folder#"$PREFIX"} == */digsight* ]] && rmdir "$DESTDIR$folder" 2>/dev/null; do folder=${folder%/*}; done
}

put() { # MODE FOLDER FILE…
    local mode=$1 folder=$2 file
    shift 2
    if [ "$verb" = install ]; then
        install -d "$DESTDIR$folder"
        install -m "$mode" "$@" "$DESTDIR$folder"
    else
        for file in "$@"; do rm -f "$DESTDIR$folder/${file##*/}"; done
        emptied "$folder"
    fi
}

put_tree() { # FOLDER SOURCE…: the files of a tree, where they stand in it
    local folder files
    while read -r folder; do
        mapfile -t files < <(find "$folder" -maxdepth 1 -type f)
        [ ${#files[@]} = 0 ] || put 644 "$1/$folder" "${files[@]}"
    done < <(find "${@:2}" -depth -type d)
}

put_config() { # FILE
    local file=$DESTDIR$SYSCONFDIR/digsight/${1##*/}
    if [ ! -e "$file" ] || cmp -s "$1" "$file"; then
        put 644 "$SYSCONFDIR/digsight" "$1"
    else
        echo "$file: was changed, left as it is" >&2
    fi
}

put 755 "$PREFIX/bin" "$@"
[ ! -e "$BUILD/libdig_cuda.so" ] || put 755 "$PREFIX/lib" "$BUILD/libdig_cuda.so"
for program in "$@"; do
    cp scripts/completion.bash "$work/${program##*/}"
    put 644 "$share/bash-completion/completions" "$work/${program##*/}"
done
# Pages of commands that are gone would be left behind without the build folder: they are found by their names.
case $verb in
install) for section in 1 8; do put 644 "$share/man/man$section" "$BUILD/man/man$section"/*; done ;;
*) for program in "$@"; do rm -f "$DESTDIR$share"/man/man[18]/"${program##*/}"{,-*}.[18]; done ;;
esac

sed "s|/usr/local/bin|$PREFIX/bin|; s|/etc/digsight|$SYSCONFDIR/digsight|" config/systemd/digsightd.service \
    >"$work/digsightd.service"
put 644 "$UNITDIR" "$work/digsightd.service"
sed "s|: \.\./tables/|: $share/digsight/tables/|; s|: machines/|: $share/digsight/config/machines/|
     s|: signals/|: $share/digsight/config/signals/|" config/digsightd.yaml >"$work/digsightd.yaml"
put_config "$work/digsightd.yaml"

put 644 "$share/digsight/tables" tables/*.sqlite
put_tree "$share/digsight" config/{can,grids,machines,scenes,signals}
put 644 "$share/digsight/config" config/*.yaml
put 644 "$share/digsight/python/digsight" python/digsight/*.py
put 644 "$share/doc/digsight" README.md CHANGELOG.md LICENSE
put_tree "$share/doc/digsight" docs

# For programs that read the daemon's channels: the types, and their C.
put 644 "$share/digsight/messages" messages/*.lcm
put 644 "$PREFIX/include/digsight" "$BUILD"/messages/*.h
cp "$BUILD/libdig_messages.a" "$work/libdigsight_messages.a"
put 644 "$LIBDIR" "$work/libdigsight_messages.a"
cat >"$work/digsight_messages.pc" <<PC
Name: digsight_messages
Description: LCM types of Digsight's channels
Version: $VERSION
Requires: lcm
Cflags: -I$PREFIX/include/digsight
Libs: -L$LIBDIR -ldigsight_messages
PC
put 644 "$LIBDIR/pkgconfig" "$work/digsight_messages.pc"
