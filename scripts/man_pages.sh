#!/bin/bash
# Manual pages of programs and of each of their commands, made by help2man of what --help says, into OUT/man1 and
# OUT/man8:  scripts/man_pages.sh OUT PROGRAM…        SOURCE_DATE_EPOCH dates them.
set -euo pipefail
out=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

commands_of() { # PROGRAM
    "$1" --help | sed -n '/^Commands:$/,/^$/s/^  \([a-z]\{1,\}\)  .*/\1/p'
}

page() { # PAGE SECTION "SEE ALSO" PROGRAM [COMMAND]
    local page=$1 section=$2 see=$3
    shift 3
    printf '[see also]\n%s\n\n[examples]\n.nf\n' "$see" >"$work/more"
    # Examples are set as they are, line by line.
    "$@" --help | awk -v more="$work/more" '
        /^[^ ]/ { examples = /^Examples:$/ }
        examples { if (/^ /) { gsub(/\\/, "\\e"); gsub(/-/, "\\-"); print substr($0, 3) >>more } next }
        /^Exit status:$/ { print "*Exit status*"; next }
        { print }' >"$work/help"
    echo .fi >>"$work/more"
    # The first paragraph behind the usage, without its full stop.
    awk -v RS= 'NR == 2 { gsub(/\n/, " "); sub(/\.$/, ""); print tolower(substr($0, 1, 1)) substr($0, 2) }' "$work/help" >"$work/name"
    mkdir -p "$out/man$section"
    help2man --no-info --section="$section" --name="$(cat "$work/name")" --source="Digsight $version" \
        --manual="Digsight" --version-string="$page $version" --include="$work/more" \
        --help-option="<$work/help" --output="$out/man$section/$page.$section" cat
}

section_of() { # NAME
    case $1 in digsightd) echo 8 ;; *) echo 1 ;; esac
}

for program in "$@"; do
    name=${program##*/}
    section=$(section_of "$name")
    version=$("$program" --version)
    version=${version##* }
    see=""
    for command in $(commands_of "$program"); do
        page "$name-$command" "$section" ".BR $name ($section)" "$program" "$command"
        see="$see.BR $name-$command ($section) ,"$'\n'
    done
    for other in "$@"; do
        [ "$other" = "$program" ] || see="$see.BR ${other##*/} ($(section_of "${other##*/}")) ,"$'\n'
    done
    page "$name" "$section" "${see% ,*}" "$program"
done
