// A campaign and a plan of shards, which name files of others: both readers get every input.

#include "files/campaign_yaml.h"
#include "files/job_plan.h"
#include "tests/fuzz/as_file.h"

#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *const data, const size_t size)
{
    const char *const     path  = as_file(data, size);
    struct dig_error      error = { "" };
    struct dig_job_plan   plan;
    const enum dig_status as_plan = dig_job_plan_read(path, &plan, &error);
    struct dig_campaign   campaign;
    expect_word(as_plan, &error);

    struct dig_error campaign_error = { "" };
    char             folder[AS_FILE_PATH];
    memcpy(folder, path, strlen(path) + 1);
    *strrchr(folder, '/') = '\0';
    expect_word(dig_campaign_read(folder, &campaign, &campaign_error), &campaign_error);
    return 0;
}
