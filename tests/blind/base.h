// Exact machine recordings of pool digs, made by `digrig record`, and where in them the dig is.

#ifndef DIG_TESTS_BLIND_BASE_H
#define DIG_TESTS_BLIND_BASE_H

#include "core/error.h"
#include "core/recording.h"

struct blind_base {
    struct dig_machine_recording recording;  // exact, evenly spaced
    double                       step_s;     // of its rows
    double                       begin_s;    // when the force recording's t = 0 is
    double                       contact_s;  // first load
    double                       released_s; // last load
};

/// Runs digrig on the force recording at path and reads what it made; the files are left in folder
/// under this name. lambda: of the machine against the rig. DIG_EUNREACHABLE: the machine cannot do
/// this dig. DIG_EIO: digrig failed otherwise.
DIG_MUST_CHECK enum dig_status blind_base_make(const char *digrig, const char *machine,
                                               const char *path, const char *folder,
                                               const char *name, double lambda,
                                               const struct dig_recording *dig,
                                               struct blind_base *base, struct dig_error *error);

void blind_base_finish(struct blind_base *base);

/// Runs a program with its output in a file; -1, or its exit status. Seconds of its processor time
/// and its peak memory in bytes, when wanted. It is ended after limit_s of processor time.
int blind_spawn(const char *const argv[], const char *output, unsigned limit_s, double *cpu_s,
                double *peak_B);

#endif // DIG_TESTS_BLIND_BASE_H
