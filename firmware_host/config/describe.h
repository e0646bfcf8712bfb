// What a configuration and all it names turned out to be, for people and for programs.

#ifndef DIG_FIRMWARE_HOST_CONFIG_DESCRIBE_H
#define DIG_FIRMWARE_HOST_CONFIG_DESCRIBE_H

#include "firmware_host/config/load.h"

#include <stdio.h>

/// Line by line through say: table, machine, input, and what is not measured. set: the table in
/// use.
void dig_describe(const struct dig_loaded *loaded, const struct dig_curve_set *set,
                  const char *input, void (*say)(const char *line));

/// The same as a JSON object.
void dig_describe_json(const struct dig_loaded *loaded, const struct dig_curve_set *set,
                       const char *input, FILE *file);

#endif // DIG_FIRMWARE_HOST_CONFIG_DESCRIBE_H
