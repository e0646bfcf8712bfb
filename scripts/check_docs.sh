#!/bin/bash
# scripts/check_docs.sh [FILE.md…]: fails where a document names a file, a heading, a test or a make target
# that does not exist, in a link [text](file#heading) or in `backticks`; without a file named, for all of them
# but the changelog, which tells of files that are gone, and where a picture of a floor is not of this tree or a figure
# of docs/figures.toml not in its document.
set -euo pipefail
cd "$(dirname "$0")/.."

given=$#
[ $# -gt 0 ] || mapfile -t < <(find . -name '*.md' -not -path './build/*' -not -path './.git/*' -not -name CHANGELOG.md |
    sed 's#^\./##' | sort)
[ $# -gt 0 ] || set -- "${MAPFILE[@]}"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

declare -A known # "target NAME", "word NAME", "heading FILE#HEADING"
while read -r name; do known["target $name"]=1; done < <(
    sed -n 's/^\([a-z][a-z0-9-]*\)\( [a-z][a-z0-9 -]*\)\{0,1\}:.*/\1\2/p' Makefile messages/java.mk | tr ' ' '\n' | grep .)
while read -r name; do known["word $name"]=1; done < <(
    grep -rhoE '"[a-z][a-z0-9-]*"|--[a-z][a-z0-9-]*' tools firmware_host scripts tests --include='*.[ch]' --include='*.sh' |
        sed 's/^--//; s/"//g' | sort -u)

# DOCUMENT LINE KIND NAME of all that is named; kinds: link, path, file (a bare name), test, target, command and option
awk '
    function say(kind, name) { print FILENAME, FNR, kind, name }
    function is_path(name) {
        return name ~ /^(core|files|estimator|tables|offline_dem|closed_loop|firmware_host|tools|messages|config|tests|python|scripts|docs|\.ci)\//
    }
    function look_at(text,    words, word, ours, name, w) {
        words = split(text, word, /[ \t]+/)
        ours = word[1] ~ /^(build\/bin\/)?dig(table|loop|rig|report|sightd)$/
        for (w = 1; w <= words; w++) {
            name = word[w]
            gsub(/^[(]|[),.;:]+$/, "", name)
            if (name ~ /[<>$…]/ || name ~ /[A-Z][A-Z]/ && name !~ /(README|CONTRIBUTING|CHANGELOG|LICENSE)/) continue # stands for a name
            if (w == 2 && word[1] == "make" && name ~ /^[a-z][a-z0-9-]*$/) say("target", name)
            else if (w == 2 && ours && name ~ /^[a-z]+$/) say("command", name)
            else if ((w == 1 || ours) && name ~ /^--[a-z]/) { sub(/[=\]].*/, "", name); say("option", substr(name, 3)) }
            else if (name ~ /^build\/tests\/[a-z_]+\/[a-z_0-9]+$/) say("path", substr(name, 7) ".c")
            else if (is_path(name)) say("path", name)
            else if (!fence && name ~ /^test_[a-z0-9_]+$/) say("test", name)
            else if (!fence && name ~ /^[a-z0-9_]+(\/[a-z0-9_]+)*\.(c|h|cu|sh|awk)$/) say("file", name)
        }
    }
    FNR == 1 { fence = 0 }
    /^ *```/ { fence = !fence; next }
    fence { look_at($0); next }
    {
        n = split($0, part, "`")
        for (i = 2; i <= n; i += 2) look_at(part[i])
        while (match($0, /\]\([^) ]+\)/)) {
            link = substr($0, RSTART + 2, RLENGTH - 3)
            if (link !~ /^[a-z]+:/) say("link", link)
            $0 = substr($0, RSTART + RLENGTH)
        }
    }' "$@" >"$work/named"

# Headings as links name them: lower case, no punctuation, hyphens for blanks.
headings_of() { # FILE
    local heading
    [ -z "${known["headings of $1"]:-}" ] || return 0
    known["headings of $1"]=1
    while read -r heading; do known["heading $1#$heading"]=1; done < <(
        awk '/^ *```/ { fence = !fence } !fence && /^#+ / { sub(/^#+ /, ""); print tolower($0) }' "$1" |
            sed 's/[^a-z0-9 _-]//g; s/ /-/g')
}

exists() { # KIND NAME DOCUMENT
    local name=$2 file
    case $1 in
    link)
        file=${name%%#*}
        [ "${3%/*}" = "$3" ] || [ -z "$file" ] || file=${3%/*}/$file
        [ -n "$file" ] || file=$3
        [ -e "$file" ] || return 1
        [ "${name#*#}" != "$name" ] || return 0
        headings_of "$file"
        [ -n "${known["heading $file#${name#*#}"]:-}" ]
        ;;
    path) compgen -G "${name%/}" || compgen -G "$name.c" || compgen -G "$name.h" ;;
    test) compgen -G "tests/*/$name.c" ;;
    file) compgen -G "*/$name" || compgen -G "*/*/$name" || compgen -G "*/*/*/$name" ;;
    target) [ -n "${known["target $name"]:-}" ] ;;
    command | option) [ -n "${known["word $name"]:-}" ] ;;
    esac >"$work/found"
}

bad=0
while read -r document line kind name; do
    exists "$kind" "$name" "$document" || { echo "$document:$line: $name: no such $kind"; bad=1; }
done <"$work/named"

if [ "$given" = 0 ]; then
    scripts/floors.sh "$work"
    for drawn in "$work"/floor*.svg; do
        cmp -s "$drawn" "docs/pictures/${drawn##*/}" || { echo "docs/pictures/${drawn##*/}: out of date, make floors"; bad=1; }
    done
    scripts/release_check.py --ties || bad=1
fi
exit $bad
