// Inputs of libFuzzer as files, for readers that take a path. The folder is $FUZZ_DIR, best one in
// memory.

#ifndef DIG_TESTS_FUZZ_AS_FILE_H
#define DIG_TESTS_FUZZ_AS_FILE_H

#include "core/error.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define AS_FILE_PATH 256

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/// The file that holds data from now on: campaign.yaml, as a campaign must be called, in a folder
/// of its own. Campaigns and models name others: none lies beside it.
static inline const char *as_file(const uint8_t *const data, const size_t size)
{
    static char path[AS_FILE_PATH];
    if (path[0] == '\0') {
        const char *const disk = getenv("FUZZ_DIR");
        const int         folder =
            snprintf(path, sizeof path, "%s/input.%d", disk != NULL ? disk : ".", (int)getpid());
        (void)mkdir(path, 0777);
        (void)snprintf(path + folder, sizeof path - (size_t)folder, "/campaign.yaml");
    }
    FILE *const file = fopen(path, "wb");
    if (file == NULL || fwrite(data, 1, size, file) != size || fclose(file) != 0) {
        perror(path);
        exit(2);
    }
    return path;
}

/// A refusal must say why.
static inline void expect_word(const enum dig_status status, const struct dig_error *const error)
{
    if (status != DIG_OK && error->text[0] == '\0') {
        (void)fprintf(stderr, "refused without a word: %s\n", dig_status_str(status));
        abort();
    }
}

#endif // DIG_TESTS_FUZZ_AS_FILE_H
