#!/bin/bash
# scripts/check_docs.sh [FILE.md…]: fails where a document names a file, a heading, a test or a make target
# that does not exist, in a link [text](file#heading) or in `backticks`; without a file named, for all of them
# but the changelog, which tells of files that are gone, and where a picture of a floor is not of this tree.
set -euo pipefail
cd "$(dirname "$0")/.."

given=$#
[ $# -gt 0 ] || mapfile -t < <(find . -name '*.md' -not -path './build/*' -not -path './.git/*' -not -name CHANGELOG.md |
    sed 's#^\./##' | sort)
[ $# -gt 0 ] || set -- "${MAPFILE[@]}"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

find . -not -path './build/*' -not -path './.git/*' | sed 's#^\./##' >"$work/files"
sed -n 's/^\([a-z][a-z0-9-]*\)\( [a-z][a-z0-9 -]*\)\{0,1\}:.*/\1\2/p' Makefile messages/java.mk | tr ' ' '\n' >"$work/targets"

# DOCUMENT LINE KIND NAME of all that is named; kinds: link, path, file (a bare name), test, target
awk '
    function top(word) { return word ~ /^(core|files|estimator|tables|offline_dem|closed_loop|firmware_host|tools|messages|config|tests|scripts|docs|\.ci)\// }
    FNR == 1 { fence = 0 }
    /^ *```/ { fence = !fence; next }
    {
        rest = $0
        while (!fence && match(rest, /\]\([^) ]+\)/)) {
            link = substr(rest, RSTART + 2, RLENGTH - 3)
            if (link !~ /^[a-z]+:/) print FILENAME, FNR, "link", link
            rest = substr(rest, RSTART + RLENGTH)
        }
        n = fence ? 1 : split($0, part, "`")
        if (fence) part[2] = $0
        for (i = 2; i <= n + fence; i += 2) {
            words = split(part[i], word, /[ \t]+/)
            for (w = 1; w <= words; w++) {
                name = word[w]
                gsub(/^[(]|[),.;:]+$/, "", name)
                if (name ~ /[<>$…]/ || name ~ /[A-Z][A-Z]/ && name !~ /(README|CONTRIBUTING|CHANGELOG|LICENSE)/) continue
                if (word[w] == "make" && word[w + 1] ~ /^[a-z][a-z-]*$/ && w == 1) print FILENAME, FNR, "target", word[w + 1]
                else if (name ~ /^build\/tests\/[a-z_]+\/[a-z_0-9]+$/) print FILENAME, FNR, "path", substr(name, 7) ".c"
                else if (top(name)) print FILENAME, FNR, "path", name
                else if (name ~ /^test_[a-z0-9_]+$/ && !fence) print FILENAME, FNR, "test", name
                else if (name ~ /^[a-z0-9_]+\.(c|h|cu|sh|awk)$/ && !fence) print FILENAME, FNR, "file", name
                else if (name ~ /^[a-z0-9_]+(\/[a-z0-9_]+)+\.(c|h|cu|sh)$/ && !fence) print FILENAME, FNR, "file", name
            }
        }
    }' "$@" >"$work/named"

# Headings as links name them: lower case, no punctuation, hyphens for blanks.
headings_of() { # FILE
    awk '/^ *```/ { fence = !fence } !fence && /^#+ / { sub(/^#+ /, ""); print tolower($0) }' "$1" |
        sed 's/[^a-z0-9 _-]//g; s/ /-/g'
}

exists() { # PATH, perhaps with * in it; a source may be named without its ending
    compgen -G "${1%/}" >/dev/null || compgen -G "$1.c" >/dev/null || compgen -G "$1.h" >/dev/null
}

bad=0
while read -r document line kind name; do
    case $kind in
    link)
        file=${name%%#*}
        target=$document
        [ -z "$file" ] || target=$(realpath -m --relative-to=. "$(dirname "$document")/$file")
        if [ ! -e "$target" ]; then
            found=0
        elif [ "$name" = "$file" ]; then
            found=1
        else
            found=$(headings_of "$target" | grep -cxF "${name#*#}") || true
        fi
        ;;
    path) exists "$name" && found=1 || found=0 ;;
    test) found=$(grep -cE "^tests/[a-z_]+/$name\.c$" "$work/files") || true ;;
    file) found=$(grep -cE "(^|/)${name//./\\.}$" "$work/files") || true ;;
    target) found=$(grep -cxF "$name" "$work/targets") || true ;;
    esac
    [ "$found" -gt 0 ] || { echo "$document:$line: $name: no such $kind"; bad=1; }
done <"$work/named"

if [ "$given" = 0 ]; then
    scripts/floors.sh "$work"
    for drawn in "$work"/floor*.svg; do
        cmp -s "$drawn" "docs/pictures/${drawn##*/}" || { echo "docs/pictures/${drawn##*/}: out of date, make floors"; bad=1; }
    done
fi
exit $bad
