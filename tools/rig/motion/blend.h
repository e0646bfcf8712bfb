// Rounds the corners of a path: what a prescribed dig does at once, a machine needs a moment for.

#ifndef DIG_TOOLS_RIG_MOTION_BLEND_H
#define DIG_TOOLS_RIG_MOTION_BLEND_H

#include "tools/rig/motion/path.h"

#include <stdbool.h>

/// Smooths the poses of *path in place as dig_rig_path_build() documents, and notes how far it
/// moved them. The ends stand still, so they are held beyond the path. False when memory is short,
/// and then the path is unchanged. O(frames).
bool dig_rig_blend(struct dig_rig_path *path);

#endif // DIG_TOOLS_RIG_MOTION_BLEND_H
