# The bucket of config/scenes/rig.yaml as STL: four plates across the width, two sides as fans.
# -v s=SCALE, in m a rig's m; -v tooth="X Z" where the plate that cuts ends
function point(k, y) { print "   vertex", s * x[k], s * y, s * z[k] }
function facet(a, ya, b, yb, c, yc) {
    print " facet normal 0 0 0\n  outer loop"; point(a, ya); point(b, yb); point(c, yc)
    print "  endloop\n endfacet" }
BEGIN {
    split("0 -.04 -.052 -.04 -.012", x, " "); split("-.09 -.072 -.042 -.012 0", z, " ")
    if (split(tooth, t, " ") == 2) { x[1] = t[1]; z[1] = t[2] }
    print "solid bucket"
    for (k = 1; k < 5; k++) { facet(k, -.035, k + 1, -.035, k + 1, .035); facet(k, -.035, k + 1, .035, k, .035) }
    for (k = 2; k < 5; k++) { facet(1, -.035, k, -.035, k + 1, -.035); facet(1, .035, k, .035, k + 1, .035) }
    print "endsolid bucket" }
