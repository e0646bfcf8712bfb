#include "tools/rig/serve.h"
enum dig_status dig_rig_serve(const struct dig_machine *const     machine,
                              const struct dig_rig_options *const options,
                              const struct dig_rig_track *const   track,
                              struct dig_error *const             error)
{
    (void)machine;
    (void)options;
    (void)track;
    return dig_error_set(error, DIG_EIO, "not yet");
}
