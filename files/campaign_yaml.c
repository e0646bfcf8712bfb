#include "files/campaign_yaml.h"

#include "core/name.h"
#include "files/yaml/yaml.h"
#include "files/yaml/yaml_schema.h"

#include <assert.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

struct recording_text {
    char          file[DIG_CAMPAIGN_PATH];
    char          trajectory[DIG_NAME_SIZE];
    enum dig_role role;
    uint32_t      pass; // 0: not given
};

struct campaign_text {
    char                  scene[DIG_CAMPAIGN_PATH];
    char                  machine[DIG_CAMPAIGN_PATH];
    struct recording_text recordings[DIG_CAMPAIGN_MAX];
    uint32_t              recordings_count;
};

static const cyaml_strval_t roles[] = {
    { "identify", DIG_ROLE_IDENTIFY },
    { "fit", DIG_ROLE_FIT },
    { "holdout", DIG_ROLE_HOLDOUT },
};

static const cyaml_schema_field_t recording_fields[] = {
    TEXT(recording_text, file),
    TEXT(recording_text, trajectory),
    CYAML_FIELD_ENUM("role", CYAML_FLAG_STRICT, struct recording_text, role, roles,
                     sizeof roles / sizeof roles[0]),
    CYAML_FIELD_UINT("pass", OPTIONAL, struct recording_text, pass),
    CYAML_FIELD_END,
};
static const cyaml_schema_value_t recording = ENTRY(recording_text, recording_fields);

static const cyaml_schema_field_t fields[] = {
    TEXT(campaign_text, scene),
    CYAML_FIELD_STRING("machine", OPTIONAL, struct campaign_text, machine, 0),
    CYAML_FIELD_SEQUENCE("recordings", REQUIRED, struct campaign_text, recordings, &recording, 1,
                         DIG_CAMPAIGN_MAX),
    SOURCE,
    CYAML_FIELD_END,
};

static const cyaml_schema_value_t schema = FILE_OF(campaign_text, fields);

// Puts the campaign's folder before a relative path. False when the result is too long, or the name
// is none.
static bool resolve(const char *const yaml, const char *const name, char path[DIG_CAMPAIGN_PATH])
{
    return dig_path_ok(name) && dig_path_beside(yaml, name, DIG_CAMPAIGN_PATH, path);
}

static enum dig_status refuse_path(const char *const yaml, const char *const key,
                                   const char *const name, struct dig_error *const error)
{
    return dig_yaml_refuse(yaml, error, "%s: \"%s\", expected " DIG_PATH_RULE " and shorter", key,
                           name);
}

// A recording comes with its campaign: a folder from elsewhere shall reach no other by "..", and a
// pipe or a device in it would never end.
static enum dig_status check_recording(const char *const yaml, const char *const key,
                                       const char *const name, const char *const path,
                                       struct dig_error *const error)
{
    if (!dig_path_stays(name)) {
        return dig_yaml_refuse(
            yaml, error,
            "%s: \"%s\" leaves the campaign's folder, expected a file in it, or an absolute path",
            key, name);
    }
    struct stat found;
    return stat(path, &found) != 0 || S_ISREG(found.st_mode)
               ? DIG_OK
               : dig_yaml_refuse(yaml, error, "%s: \"%s\" is no regular file, expected one", key,
                                 name);
}

static enum dig_status convert(const char *const yaml, const struct campaign_text *const text,
                               struct dig_campaign *const campaign, struct dig_error *const error)
{
    if (!resolve(yaml, text->scene, campaign->scene)) {
        return refuse_path(yaml, "scene", text->scene, error);
    }
    if (text->machine[0] != '\0' && !resolve(yaml, text->machine, campaign->machine)) {
        return refuse_path(yaml, "machine", text->machine, error);
    }
    campaign->recordings = text->recordings_count;
    for (size_t i = 0; i < campaign->recordings; i++) {
        const struct recording_text *const   from = &text->recordings[i];
        struct dig_campaign_recording *const to   = &campaign->recording[i];
        char                                 key[64];
        (void)snprintf(key, sizeof key, "recordings[%zu].file", i);
        if (!resolve(yaml, from->file, to->file)) {
            return refuse_path(yaml, key, from->file, error);
        }
        const enum dig_status status = check_recording(yaml, key, from->file, to->file, error);
        if (status != DIG_OK) {
            return status;
        }
        if (!dig_name_ok(from->trajectory)) {
            return dig_yaml_refuse(yaml, error,
                                   "recordings[%zu].trajectory: \"%s\", expected " DIG_NAME_RULE, i,
                                   from->trajectory);
        }
        memcpy(to->trajectory, from->trajectory, sizeof to->trajectory);
        to->role = from->role;
        to->pass = from->pass == 0 ? 1 : from->pass;
    }
    return DIG_OK;
}

bool dig_campaign_is(const char *const path)
{
    struct stat found;
    return stat(path, &found) == 0 && S_ISDIR(found.st_mode);
}

enum dig_status dig_campaign_read(const char *const folder, struct dig_campaign *const campaign,
                                  struct dig_error *const error)
{
    assert(folder != NULL && campaign != NULL);

    char      yaml[DIG_CAMPAIGN_PATH];
    const int length = snprintf(yaml, sizeof yaml, "%s/campaign.yaml", folder);
    if (length < 0 || (size_t)length >= sizeof yaml) {
        return dig_error_set(error, DIG_EINVAL, "expected a shorter path than %s", folder);
    }

    cyaml_data_t   *data   = NULL;
    enum dig_status status = dig_yaml_load(yaml, &schema, &data, error);
    if (status != DIG_OK) {
        return status;
    }
    // About a hundred kilobytes: too much for a stack that may be a thread's.
    struct dig_campaign *const loaded = calloc(1, sizeof *loaded);
    if (loaded == NULL) {
        dig_yaml_free(&schema, data);
        return dig_error_set(error, DIG_ENOMEM, "%s", yaml);
    }
    status = convert(yaml, data, loaded, error);
    if (status == DIG_OK) {
        *campaign = *loaded;
    }
    free(loaded);
    dig_yaml_free(&schema, data);
    return status;
}
