// A reload on the matching thread: reads table and model again and exchanges the table in use.

#ifndef DIG_FIRMWARE_HOST_MATCHING_FIT_RELOAD_H
#define DIG_FIRMWARE_HOST_MATCHING_FIT_RELOAD_H

#include "firmware_host/matching/fit.h"

/// Loads the table and the model the configuration now names, checks them, and exchanges the table.
/// The gravel stays known where the new table covers it. On failure the old table stays, and the
/// reason is logged. Only while no table is retiring.
void dig_fit_reload(struct dig_fit *fit);

#endif // DIG_FIRMWARE_HOST_MATCHING_FIT_RELOAD_H
