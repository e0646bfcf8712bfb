#!/bin/bash
# scripts/floors.sh FOLDER: draws the floors of the house, FOLDER/floor1.svg to floor4.svg: each folder with its
# rooms, the first one at the bottom, and the sources of each, in grey what is private to its room. Folders, rooms,
# public headers and what a folder may include are those of scripts/check_layers.sh.
set -euo pipefail
export LC_ALL=C
to=${1:?usage: floors.sh FOLDER}
cd "$(dirname "$0")/.."
mkdir -p "$to"
eval "$(sed -n "/^may_include='/,/^'/p; /^rooms='/,/^'/p" scripts/check_layers.sh)"

sources() { # FOLDER: the names of its sources and headers, each once; behind a ~ what no other room may include
    find "$1" -maxdepth 1 -name '*.[ch]' -o -maxdepth 1 -name '*.cu' | sed 's#.*/##; s#\.[a-z]*$##' | sort -u |
        awk -v place="$1" -v rooms="$rooms" '
            BEGIN {
                n = split(rooms, line, "\n")
                for (i = 1; i <= n; i++) {
                    m = split(line[i], word, " ")
                    if (line[i] ~ /^[a-z]/) { at = word[1]; word[1] = "" }
                    for (k = 1; k <= m; k++) if (at == place) public[word[k]] = 1
                }
            }
            { printf "%s%s ", place ~ /^tools/ || $1 in public ? "" : "~", $1 }'
}

list_of() { # LIST FOLDER: what the list says of it
    awk -v folder="$2" '$1 == folder { $1 = ""; print }' <<<"$1"
}

rooms_in() { # FOLDER: ROOM SOURCE… a line, the top first
    local folder=$1 room reversed=()
    if [ "$folder" = tools ]; then
        for room in digtable digloop digreport digwatch; do
            echo "$room $room $([ ! -d tools/$room ] || sources tools/$room)"
        done
        return
    fi
    echo "- $(sources "$folder")"
    for room in $(sed -n "s#^$folder/\([a-z_]*\).*#\1#p" <<<"$rooms"); do reversed=("$room" "${reversed[@]}"); done
    for room in "${reversed[@]}"; do echo "$room $(sources "$folder/$room")"; done
}

floor() { # NUMBER TITLE FOLDER…
    local number=$1 title=$2 folder
    shift 2
    for folder in "$@"; do
        echo "folder $folder $(list_of "$may_include" "$folder" | tr ' ' '\n' | grep -vxE "$folder|build|messages" | tr '\n' ' ')"
        rooms_in "$folder" | sed 's/^/room /'
    done | awk -v title="$title" -v columns=$# '
        function text(x, y, how, what) { body = body sprintf("<text x=\"%d\" y=\"%d\"%s>%s</text>\n", x, y, how, what) }
        BEGIN { width = 960; gap = 14; wide = (width - gap * (columns + 1)) / columns; letters = int((wide - 24) / 7.4); column = -1; highest = 0 }
        $1 == "folder" {
            column++; x = gap + column * (wide + gap); y = 46
            text(x + 10, y + 18, " font-size=\"16\" font-weight=\"bold\"", $2 "/")
            below = ""; for (i = 3; i <= NF; i++) below = below (i > 3 ? ", " : "") $i
            if (NF > 6) below = "all folders"
            text(x + 10, y + 35, " fill=\"#555\"", below == "" ? "includes nothing else" : "may include " below)
            y += 44; next
        }
        {
            top = y; line = ""; length_of = -1
            y += 20
            if ($2 != "-") { text(x + 16, y - 3, " font-weight=\"bold\" fill=\"#1f5fa8\"", $2); y += 16 }
            for (i = 3; i <= NF; i++) {
                name = $i
                private = sub(/^~/, "", name)
                if (line != "" && length_of + length(name) + 1 > letters) { text(x + 16, y - 3, "", line); y += 16; line = ""; length_of = -1 }
                line = line (line == "" ? "" : " ") (private ? "<tspan fill=\"#8a8a8a\">" name "</tspan>" : name)
                length_of += length(name) + 1
            }
            if (line != "") { text(x + 16, y - 3, "", line); y += 16 }
            if (NF > 2) frame = frame sprintf("<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" rx=\"3\" fill=\"%s\" stroke=\"#c3cfdf\"/>\n", x + 8, top + 2, wide - 16, y - top - 14, $2 == "-" ? "#fbf6ea" : "#f4f7fb")
            y -= 8
            if (NF == 2) y = top
            if (y > highest) highest = y
        }
        END {
            printf "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"12.5\">\n", width, highest + 24
            printf "<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n", width, highest + 24
            printf "<text x=\"%d\" y=\"28\" font-size=\"18\" font-weight=\"bold\">%s</text>\n", gap, title
            for (c = 0; c < columns; c++) printf "<rect x=\"%d\" y=\"46\" width=\"%d\" height=\"%d\" rx=\"5\" fill=\"none\" stroke=\"#5a7396\" stroke-width=\"1.5\"/>\n", gap + c * (wide + gap), wide, highest - 36
            printf "%s%s</svg>\n", frame, body
        }' >"$to/floor$number.svg"
}

floor 1 "Floor 1: types, text files" core files
floor 2 "Floor 2: the estimator and the table" estimator tables
floor 3 "Floor 3: three wings that never include each other" offline_dem closed_loop firmware_host
floor 4 "Floor 4: programs" tools tools/rig
