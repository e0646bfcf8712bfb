#include "files/campaign_yaml.h"

#include "core/name.h"
#include "files/lcm/lcm_log.h"
#include "files/yaml/yaml.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const struct dig_yaml_word roles[] = {
    { "identify", DIG_ROLE_IDENTIFY },
    { "fit", DIG_ROLE_FIT },
    { "holdout", DIG_ROLE_HOLDOUT },
    { .word = NULL },
};

static const struct dig_yaml_field recording_fields[] = {
    TEXT(dig_campaign_recording, file),
    TEXT(dig_campaign_recording, trajectory),
    FIELD(WORD, "role", dig_campaign_recording, role, REQUIRED, .word = roles),
    FIELD(COUNT, "pass", dig_campaign_recording, pass, OPTIONAL),
    END,
};
static const struct dig_yaml_field recording = ENTRY(dig_campaign_recording, recording_fields);

static const struct dig_yaml_field fields[] = {
    TEXT(dig_campaign, scene),
    FIELD(TEXT, "machine", dig_campaign, machine, OPTIONAL, .least = 0),
    LIST("recordings", REQUIRED, dig_campaign, recording, recordings, &recording, 1),
    SOURCE,
    END,
};

static const struct dig_yaml_file schema = { .of = fields, .size = sizeof(struct dig_campaign) };

// Puts the campaign's folder before a relative path.
static void resolve(const char *const yaml, const char *const key,
                    char path[const DIG_CAMPAIGN_PATH], struct dig_conditions *const c)
{
    char name[DIG_CAMPAIGN_PATH];
    memcpy(name, path, sizeof name);
    dig_require(c, dig_path_ok(name) && dig_path_beside(yaml, name, sizeof name, path),
                "%s: \"%s\", expected " DIG_PATH_RULE " and shorter", key, name);
}

// A recording comes with its campaign: a folder from elsewhere shall reach no other by "..", and a
// pipe or a device in it would never end.
static void take_recording(const char *const yaml, const size_t i,
                           struct dig_campaign_recording *const r, struct dig_conditions *const c)
{
    char        key[64];
    char        name[DIG_CAMPAIGN_PATH];
    struct stat found;
    (void)snprintf(key, sizeof key, "recordings[%zu].file", i);
    memcpy(name, r->file, sizeof name);
    resolve(yaml, key, r->file, c);
    dig_require(
        c, dig_path_stays(name),
        "%s: \"%s\" leaves the campaign's folder, expected a file in it, or an absolute path", key,
        name);
    dig_require(c, stat(r->file, &found) != 0 || S_ISREG(found.st_mode),
                "%s: \"%s\" is no regular file, expected one", key, name);
    dig_require(c, dig_name_ok(r->trajectory),
                "recordings[%zu].trajectory: \"%s\", expected " DIG_NAME_RULE, i, r->trajectory);
    (void)snprintf(key, sizeof key, "recordings[%zu].pass", i);
    dig_require(c, r->pass > 0 || dig_yaml_line(yaml, key) == 0,
                "%s: 0, expected 1 where the place is dug for the first time, then 2 …", key);
    r->pass = r->pass == 0 ? 1 : r->pass;
}

// A dig is recorded once: named twice it would count twice, or judge what it was fitted to. A log
// holds many.
static void require_once(const struct dig_campaign *const campaign, const size_t i,
                         struct dig_conditions *const c)
{
    const struct dig_campaign_recording *const r = &campaign->recording[i];
    for (size_t k = 0; k < i; k++) {
        const struct dig_campaign_recording *const other = &campaign->recording[k];
        dig_require(c,
                    strcmp(other->file, r->file) != 0 ||
                        strcmp(other->trajectory, r->trajectory) != 0 || dig_lcm_log_is(r->file),
                    "recordings[%zu].file: that of recordings[%zu], expected a dig of its own", i,
                    k);
    }
}

static void take(const char *const yaml, void *const loaded, struct dig_conditions *const c)
{
    struct dig_campaign *const campaign = loaded;
    resolve(yaml, "scene", campaign->scene, c);
    if (campaign->machine[0] != '\0') {
        resolve(yaml, "machine", campaign->machine, c);
    }
    for (size_t i = 0; i < campaign->recordings; i++) {
        take_recording(yaml, i, &campaign->recording[i], c);
        require_once(campaign, i, c);
    }
}

bool dig_campaign_is(const char *const path)
{
    struct stat found;
    return stat(path, &found) == 0 && S_ISDIR(found.st_mode);
}

enum dig_status dig_campaign_read(const char *const folder, struct dig_campaign *const campaign,
                                  struct dig_error *const error)
{
    assert(folder != NULL);
    if (access(folder, F_OK) == 0 && !dig_campaign_is(folder)) {
        return dig_error_set(error, DIG_EINVAL, "%s: expected a folder with a campaign.yaml",
                             folder);
    }
    char      yaml[DIG_CAMPAIGN_PATH];
    const int length = snprintf(yaml, sizeof yaml, "%s/campaign.yaml", folder);
    if (length < 0 || (size_t)length >= sizeof yaml) {
        return dig_error_set(error, DIG_EINVAL, "expected a shorter path than %s", folder);
    }
    return dig_yaml_read(yaml, &schema, take, campaign, error);
}
