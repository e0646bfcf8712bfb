#!/bin/sh
# A film strip of one dig, the rig's `actual` in gravel of friction .5: a slice of the bed through the
# middle of the bucket at six moments, every grain as the circle that the plane cuts of it, coloured by its
# speed. Two minutes on one core.
#   BIN=build/bin scripts/film_strip.sh docs/dig.svg
set -eu
BIN=${BIN:-build/bin}
TO=${1:?usage: film_strip.sh OUT.svg}
WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
"$BIN/digtable" dig config/scenes/rig.yaml --trajectory actual --friction .5 --rolling .5 \
    --density 2500 --vtk "$WORK" -o "$WORK/dig.csv"

# One panel, in mm from its lower left corner; z grows upwards, y of an SVG downwards.
panel() { # FRAME COLUMN ROW TITLE; frames are 0.1 s apart
    printf '<g transform="translate(%d %d)">\n' $((10 + $2 * 320)) $((225 + $3 * 230))
    printf '<path d="M0-85V0H310V-85" class="box"/><text x="6" y="-192">%.1f s: %s</text>\n' \
        "$(echo "$1" | awk '{ print $1 / 10 }')" "$4"
    awk '
        function shade(mmps) { return mmps < 2 ? 0 : mmps < 10 ? 1 : mmps < 25 ? 2 : mmps < 45 ? 3 : 4 }
        /^[A-Z]/ { what = $1 $2; k = $1 == "SCALARS" ? -1 : 0; n = $1 == "POINTS" ? $2 : n; next }
        what ~ /^POINTS/ { x[k] = $1 * 1e3; y[k] = $2 * 1e3; z[k++] = $3 * 1e3 }
        what == "LOOKUP_TABLEdefault" && !sized { r[k++] = $1 * 1e3; if (k == n) sized = 1 }
        what == "VECTORSvelocity_mps" { v[k++] = 1e3 * sqrt($1 * $1 + $2 * $2 + $3 * $3) }
        END {
            for (s = 0; s < 5; s++) {
                printf "<g class=\"s%d\">\n", s
                for (i = 0; i < n; i++)
                    if (shade(v[i]) == s && y[i] * y[i] < r[i] * r[i])
                        printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"/>\n", x[i], -z[i],
                            sqrt(r[i] * r[i] - y[i] * y[i])
                print "</g>"
            }
        }' "$WORK/grains_$(printf %04d "$1").vtk"
    # The profile, tooth first: of every two points one lies on this side plate, one on the other.
    awk '/^POINTS/ { on = 1; printf "<polyline class=\"bucket\" points=\""; next }
         /^[A-Z]/ { on = 0 }
         on && k++ % 2 == 0 { printf "%.1f,%.1f ", $1 * 1e3, -$3 * 1e3 }
         END { print "\"/>\n</g>" }' "$WORK/bucket_$(printf %04d "$1").vtk"
}

{
    cat <<'HEAD'
<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 970 490" font-family="sans-serif" font-size="13">
<style>.s0{fill:#c9bda4}.s1{fill:#e3c16f}.s2{fill:#e0913a}.s3{fill:#c4511d}.s4{fill:#7a1410}
circle{stroke:#fff;stroke-width:.3}.box,.bucket{fill:none;stroke:#333}.bucket{stroke-width:2.5}</style>
<rect width="970" height="490" fill="#fff"/>
HEAD
    panel 8 0 0 'the tooth is in'
    panel 19 1 0 'turned'
    panel 30 2 0 'pulling'
    panel 41 0 1 'pulled to the end'
    panel 51 1 1 'turning up'
    panel 67 2 1 'lifting'
    x=200
    for class in '0:below 2 mm/s' '1:2 to 10' '2:10 to 25' '3:25 to 45' '4:faster'; do
        printf '<circle class="s%s" cx="%d" cy="475" r="6"/><text x="%d" y="479">%s</text>\n' "${class%%:*}" \
            "$x" $((x + 11)) "${class#*:}"
        x=$((x + 125))
    done
    echo '</svg>'
} >"$WORK/strip.svg"
mv "$WORK/strip.svg" "$TO"
