#include "offline_dem/device/device_cuda.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define LIBRARY "libdig_cuda.so"

// What the library exports.
typedef int                version_of(void);
typedef struct dig_device *create_of(char why[], size_t size);

// A function of the library: ISO C has no cast from a pointer to data.
static bool find(void *const library, const char *const name, void *const function)
{
    void *const symbol = dlsym(library, name);
    memcpy(function, &symbol, sizeof symbol);
    return symbol != NULL;
}

// The library stays loaded: the card's context lives as long as the process.
struct dig_device *dig_device_cuda_create(struct dig_error *const error)
{
    const char *const given   = getenv("DIG_CUDA_LIBRARY");
    const char *const name    = given != NULL ? given : LIBRARY;
    void *const       library = dlopen(name, RTLD_NOW | RTLD_LOCAL);
    version_of       *version = NULL;
    create_of        *create  = NULL;
    if (library == NULL) {
        (void)dig_error_set(error, DIG_EIO,
                            "engine cuda: %.200s, expected the library of `make cuda`", dlerror());
        return NULL;
    }
    if (!find(library, "dig_cuda_version", &version) ||
        !find(library, "dig_cuda_create", &create) || version() != DIG_DEVICE_VERSION) {
        (void)dig_error_set(error, DIG_EIO,
                            "engine cuda: %.200s is not of this build, expected version %d", name,
                            DIG_DEVICE_VERSION);
        return NULL;
    }
    char                     why[120] = "";
    struct dig_device *const device   = create(why, sizeof why);
    if (device == NULL) {
        (void)dig_error_set(error, DIG_EIO, "engine cuda: %.120s", why);
    }
    return device;
}
