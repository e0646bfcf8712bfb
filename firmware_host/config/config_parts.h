// Reading the configuration: what config.c and config_input.c share. Internal to both.

#ifndef DIG_FIRMWARE_HOST_CONFIG_CONFIG_PARTS_H
#define DIG_FIRMWARE_HOST_CONFIG_CONFIG_PARTS_H

#include "core/error.h"
#include "firmware_host/config/config.h"
#include "firmware_host/config/config_text.h"

/// What is being read, and where errors go.
struct dig_config_work {
    const char        *path;
    struct dig_config *config;
    struct dig_error  *error;
};

/// A number and its range. from: as the file has it; NULL: absent, and *to keeps its default.
struct dig_config_number {
    const char   *key;
    const double *from;
    double        least;
    double        most;
    double       *to;
};

struct dig_config_whole {
    const char *key;
    const int  *from;
    int         least;
    int         most;
    int        *to;
};

/// Each checks and copies; DIG_EINVAL with file, line, key and what was expected.
DIG_MUST_CHECK enum dig_status dig_config_take_numbers(const struct dig_config_work  *work,
                                                       size_t                         count,
                                                       const struct dig_config_number number[]);
DIG_MUST_CHECK enum dig_status dig_config_take_wholes(const struct dig_config_work *work,
                                                      size_t                        count,
                                                      const struct dig_config_whole whole[]);
DIG_MUST_CHECK enum dig_status dig_config_take_text(const struct dig_config_work *work,
                                                    const char *key, const char *from, size_t size,
                                                    char to[]);

/// A file name, relative to the configuration's folder.
DIG_MUST_CHECK enum dig_status dig_config_take_path(const struct dig_config_work *work,
                                                    const char *key, const char *from,
                                                    struct dig_file_name *to);

/// The part `input`: the bus or the recording, with its settings.
DIG_MUST_CHECK enum dig_status dig_config_take_input(const struct dig_config_work *work,
                                                     const struct dig_input_text  *text);

#endif // DIG_FIRMWARE_HOST_CONFIG_CONFIG_PARTS_H
