#include "core/recording.h"

#include <stdlib.h>

void dig_recording_finish(struct dig_recording *const recording)
{
    if (recording != NULL) {
        free(recording->row);
        *recording = (struct dig_recording){ 0 };
    }
}

void dig_machine_recording_finish(struct dig_machine_recording *const recording)
{
    if (recording != NULL) {
        free(recording->row);
        *recording = (struct dig_machine_recording){ 0 };
    }
}
