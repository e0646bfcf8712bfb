// The tracked gravel over a restart: a file in the format of `digloop identify --json`
// (files/identity_json.h), with the digs it was matched from. Its modification time is its age.

#ifndef DIG_FIRMWARE_HOST_MATCHING_GRAVEL_STATE_H
#define DIG_FIRMWARE_HOST_MATCHING_GRAVEL_STATE_H

#include "core/error.h"
#include "estimator/match/pool.h"
#include "firmware_host/matching/gravel_track.h"

/// Writes track and pool (digs along trajectories of the set). DIG_EIO: it cannot be written (no
/// room); the old file stands.
DIG_MUST_CHECK enum dig_status dig_gravel_state_write(const char                    *path,
                                                      const struct dig_gravel_track *track,
                                                      const struct dig_curve_set    *set,
                                                      const struct dig_pool         *pool,
                                                      struct dig_error              *error);

/// Reads them for a table. Writes on success only.
///   * DIG_EINVAL: not an identity, of another scene, or a gravel the table does not cover;
///   * DIG_ESTALE: older than expires_s, or more than an hour younger than now (the wall clock was
///     set back, so its age is not known);
///   * DIG_EIO: it cannot be read.
/// A file without its digs leaves the pool empty: the track stands until the next simple dig.
DIG_MUST_CHECK enum dig_status
dig_gravel_state_read(const char *path, const struct dig_curve_set *set, int64_t now_ns,
                      const struct dig_gravel_track_settings *settings,
                      struct dig_gravel_track *track, struct dig_pool *pool,
                      struct dig_error *error);

#endif // DIG_FIRMWARE_HOST_MATCHING_GRAVEL_STATE_H
