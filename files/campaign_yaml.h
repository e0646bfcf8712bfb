// Reads a campaign: a folder with campaign.yaml that lists recordings of digs and what each may be
// used for (schema: docs/formats/trace.md).

#ifndef DIG_FILES_CAMPAIGN_YAML_H
#define DIG_FILES_CAMPAIGN_YAML_H

#include "core/curve.h"
#include "core/error.h"

#include <stdbool.h>
#include <stddef.h>

#define DIG_CAMPAIGN_MAX  64
#define DIG_CAMPAIGN_PATH 512

/// What a recording may be used for.
enum dig_role { DIG_ROLE_IDENTIFY, DIG_ROLE_FIT, DIG_ROLE_HOLDOUT };

struct dig_campaign_recording {
    char          file[DIG_CAMPAIGN_PATH];
    char          trajectory[DIG_NAME_SIZE];
    enum dig_role role;
    unsigned      pass; // how often the place was dug before, counted from 1
};

/// Paths are as the program may open them: the folder is put before relative ones.
struct dig_campaign {
    char                          scene[DIG_CAMPAIGN_PATH];
    char                          machine[DIG_CAMPAIGN_PATH]; // "" when there is none
    size_t                        recordings;
    struct dig_campaign_recording recording[DIG_CAMPAIGN_MAX];
};

/// True when path is a folder: a campaign is one, a recording is a file.
bool dig_campaign_is(const char *path);

/// Reads FOLDER/campaign.yaml. *error names file, line, key and what was expected; of the files it
/// lists one that is named twice is opened, to see whether it is a log. Writes on success only.
DIG_MUST_CHECK enum dig_status dig_campaign_read(const char *folder, struct dig_campaign *campaign,
                                                 struct dig_error *error);

#endif // DIG_FILES_CAMPAIGN_YAML_H
