// A rigid flat wall.

#ifndef DIG_OFFLINE_DEM_LAW_WALL_H
#define DIG_OFFLINE_DEM_LAW_WALL_H

#define DIG_WALLS_MAX 8

/// Grains stay where normal . x >= offset_m; normal has length 1.
struct dig_wall {
    double normal[3];
    double offset_m;
};

#endif // DIG_OFFLINE_DEM_LAW_WALL_H
