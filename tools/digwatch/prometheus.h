// HEALTH in Prometheus' text format, for the textfile collector of node_exporter.

#ifndef DIG_TOOLS_DIGWATCH_PROMETHEUS_H
#define DIG_TOOLS_DIGWATCH_PROMETHEUS_H

#include "core/error.h"
#include "tools/digwatch/model.h"

/// Writes all of path, or leaves it as it is. silent_s: since the last message; a daemon that is
/// silent for three seconds is down. Fails as dig_out_open().
DIG_MUST_CHECK enum dig_status digwatch_prometheus(const struct digwatch_model *model,
                                                   double silent_s, const char *path,
                                                   struct dig_error *error);

#endif // DIG_TOOLS_DIGWATCH_PROMETHEUS_H
