// One bit of a table flipped, again and again: is it refused, or does every reader get what it got
// before?
//
//   flips TABLE.sqlite [FLIPS [SEED]]
//
// Prints how many were refused, how many changed nothing, and how many changed what readers get in
// silence, of which the first is told; exits with 1 when there is one. And where those lay that
// changed nothing: in the file's header, or in what a page has free between its rows or beside its
// pointers.

#include "tests/table_content.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static char *read_whole(const char *const path, size_t *const size)
{
    FILE *const file = fopen(path, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
        return NULL;
    }
    const long bytes = ftell(file);
    char      *whole = bytes > 0 ? malloc((size_t)bytes) : NULL;
    rewind(file);
    if (whole != NULL && fread(whole, 1, (size_t)bytes, file) != (size_t)bytes) {
        free(whole);
        whole = NULL;
    }
    *size = (size_t)bytes;
    (void)fclose(file);
    return whole;
}

static uint64_t next(uint64_t *const random)
{
    *random ^= *random << 13;
    *random ^= *random >> 7;
    *random ^= *random << 17;
    return *random;
}

int main(const int argc, char **const argv)
{
    if (argc < 2) {
        (void)fprintf(stderr, "usage: flips TABLE.sqlite [FLIPS [SEED]]\n");
        return 2;
    }
    const long  flips  = argc > 2 ? strtol(argv[2], NULL, 10) : 1000;
    uint64_t    random = 88172645463325252U ^ (argc > 3 ? strtoull(argv[3], NULL, 10) : 0);
    size_t      size   = 0;
    char *const whole  = read_whole(argv[1], &size);
    char        copy[] = "/tmp/flips_XXXXXX";
    const int   fd     = mkstemp(copy);
    uint64_t    before = 0;
    if (whole == NULL || fd < 0 || write(fd, whole, size) != (ssize_t)size ||
        !table_content(copy, &before)) {
        (void)fprintf(stderr, "flips: %s: %s\n", argv[1],
                      errno != 0 ? strerror(errno) : "is no sound table");
        return 2;
    }
    long refused = 0, header = 0, free_space = 0, silent = 0;
    for (long i = 0; i < flips; i++) {
        const uint64_t one     = next(&random);
        const off_t    at      = (off_t)((one >> 3) % size);
        const char     flipped = (char)(whole[at] ^ (1 << (one & 7)));
        uint64_t       sum     = 0;
        if (pwrite(fd, &flipped, 1, at) != 1) {
            perror("flips");
            return 2;
        }
        if (!table_content(copy, &sum)) {
            refused++;
        } else if (sum != before) {
            (void)fprintf(stderr, "flips: %s: bit %u of byte %jd: other numbers in silence\n",
                          argv[1], (unsigned)(one & 7), (intmax_t)at);
            silent++;
        } else if (at < 100) {
            header++;
        } else {
            free_space++;
        }
        if (pwrite(fd, &whole[at], 1, at) != 1) {
            perror("flips");
            return 2;
        }
    }
    (void)close(fd);
    (void)unlink(copy);
    free(whole);
    (void)printf("%s: %ld bits flipped: %ld refused, %ld without effect (%ld of the header, %ld in "
                 "free space), %ld other numbers in silence\n",
                 argv[1], flips, refused, header + free_space, header, free_space, silent);
    return silent == 0 ? 0 : 1;
}
