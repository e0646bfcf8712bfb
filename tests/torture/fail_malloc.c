// Preloaded, it lets allocations fail: the FAIL_AT-th alone, or with FAIL_ON=1 all from it on.
// Counted are those of our programs and of the libraries that can say so; GLib ends a program that
// is out of memory, by design, and LCM rests on it. With FAIL_AT=0 none fails, and the count goes
// to the file that FAIL_COUNT names.

// dladdr() is GNU's.
#define _GNU_SOURCE // NOLINT(bugprone-reserved-identifier)

#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);

static atomic_long allocations;
static long        fail_at;
static bool        fail_on, ready;

__attribute__((constructor)) static void begin(void)
{
    const char *const at = getenv("FAIL_AT");
    fail_at              = at != NULL ? strtol(at, NULL, 10) : 0;
    fail_on              = getenv("FAIL_ON") != NULL;
    ready                = true;
}

__attribute__((destructor)) static void end(void)
{
    const char *const path = getenv("FAIL_COUNT");
    ready                  = false;
    FILE *const file       = path != NULL ? fopen(path, "w") : NULL;
    if (file != NULL) {
        (void)fprintf(file, "%ld\n", atomic_load(&allocations));
        (void)fclose(file);
    }
}

static bool fails(const void *const caller)
{
    Dl_info from;
    if (!ready || dladdr(caller, &from) == 0 || from.dli_fname == NULL ||
        strstr(from.dli_fname, "libglib") != NULL || strstr(from.dli_fname, "liblcm") != NULL ||
        strstr(from.dli_fname, "ld-linux") != NULL || strstr(from.dli_fname, "libstdc++") != NULL) {
        return false;
    }
    const long number = atomic_fetch_add(&allocations, 1) + 1;
    const bool fail   = fail_at > 0 && (number == fail_at || (fail_on && number > fail_at));
    if (fail) {
        errno = ENOMEM;
    }
    return fail;
}

void *malloc(size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_calloc(count, size);
}

void *realloc(void *memory, size_t size)
{
    return fails(__builtin_return_address(0)) ? NULL : __libc_realloc(memory, size);
}
