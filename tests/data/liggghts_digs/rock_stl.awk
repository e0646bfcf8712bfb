# A rock as STL: a sphere of triangles between 12 meridians and 8 parallels.
# -v r=RADIUS -v x0=X -v z0=Z, all in m: its centre, y = 0
function point(i, j) {
    a = pi * i / 8; b = 2 * pi * j / 12
    printf "   vertex %.9g %.9g %.9g\n", x0 + r * sin(a) * cos(b), r * sin(a) * sin(b), z0 + r * cos(a) }
function facet(i, j, k, l, m, n) {
    print " facet normal 0 0 0\n  outer loop"; point(i, j); point(k, l); point(m, n)
    print "  endloop\n endfacet" }
BEGIN {
    pi = atan2(0, -1)
    print "solid rock"
    for (i = 0; i < 8; i++) for (j = 0; j < 12; j++) {
        if (i > 0) facet(i, j, i + 1, j, i, j + 1)
        if (i < 7) facet(i + 1, j, i + 1, j + 1, i, j + 1)
    }
    print "endsolid rock" }
