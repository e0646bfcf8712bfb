// What a daemon wrote into a log, for the tests of its output.

#ifndef DIG_TESTS_FIRMWARE_HOST_LCM_READ_BACK_H
#define DIG_TESTS_FIRMWARE_HOST_LCM_READ_BACK_H

#include "firmware_host/publish/output.h"

#include "files/lcm/lcm_log.h"
#include "tests/scratch.h"

static inline const struct dig_curve_set *set(void)
{
    static struct dig_gravel    gravel[2] = { { { 0.3, 0.1, 1500 } }, { { 0.6, 0.2, 2500 } } };
    static struct dig_curve_set s         = { .scene_hash   = "abc123",
                                              .trajectories = 2,
                                              .trajectory = { { .name = "simpleA" }, { .name = "actual" } },
                                              .entries    = 2,
                                              .gravel     = gravel };
    return &s;
}

static inline struct dig_output *begin(const char *const name)
{
    char url[600];
    (void)snprintf(url, sizeof url, "file://%s?mode=w", scratch_path(name));
    struct dig_output *output = NULL;
    struct dig_error   error  = { "" };
    if (dig_output_create(url, &output, &error) != DIG_OK) {
        fail_msg("%s", error.text);
    }
    return output;
}

/// last_TYPE(NAME, N): the last message of a kind in that log, of N. Free with
/// digsight_TYPE_t_destroy().
#define LAST(type)                                                                                 \
    struct type##_seen {                                                                           \
        int                  n;                                                                    \
        digsight_##type##_t *last;                                                                 \
    };                                                                                             \
    static inline void keep_##type(void *const context, const int64_t time_us,                     \
                                   const digsight_##type##_t *const m)                             \
    {                                                                                              \
        struct type##_seen *const seen = context;                                                  \
        (void)time_us;                                                                             \
        if (seen->n++ > 0) {                                                                       \
            digsight_##type##_t_destroy(seen->last);                                               \
        }                                                                                          \
        seen->last = digsight_##type##_t_copy(m);                                                  \
    }                                                                                              \
    static inline digsight_##type##_t *last_##type(const char *const name, const int n)            \
    {                                                                                              \
        struct type##_seen          seen   = { 0, NULL };                                          \
        const struct dig_lcm_reader reader = { .context = &seen, .type = keep_##type };            \
        assert_int_equal(dig_lcm_log_each(scratch_path(name), &reader, NULL), DIG_OK);             \
        assert_int_equal(seen.n, n);                                                               \
        return seen.last;                                                                          \
    }
#endif // DIG_TESTS_FIRMWARE_HOST_LCM_READ_BACK_H
