#include "core/recording.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

bool dig_recording_knows_carried(const struct dig_recording *const recording)
{
    assert(recording != NULL);
    size_t known = 0;
    while (known < recording->rows && isfinite(recording->row[known].carried_kg)) {
        known++;
    }
    return known == recording->rows;
}

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
