// A recorded dig played as if it came from a bus.

#include "core/recording.h"
#include "firmware_host/bus/input.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

struct replay {
    struct dig_machine_recording recording;
    double                       speed;
    bool                         has[DIG_SIGNALS]; // in any row
    size_t                       next;
    int64_t                      start_ns;
};

static enum dig_status open_replay(struct dig_input *const input, struct dig_error *const error)
{
    (void)error;
    struct replay *const replay = input->source;
    replay->next                = 0;
    replay->start_ns            = dig_input_now_ns();
    return DIG_OK;
}

static void give_row(struct dig_input *const input, const struct dig_sample *const row,
                     const int64_t due_ns)
{
    const struct replay *const replay  = input->source;
    struct dig_reading         reading = { .time_ns = due_ns };
    for (size_t i = 0; i < DIG_SIGNALS; i++) {
        reading.value[i] = row->value[i];
        reading.state[i] = (uint8_t)(!replay->has[i]            ? DIG_READING_ABSENT
                                     : !row->valid[i]           ? DIG_READING_NOT_AVAILABLE
                                     : !isfinite(row->value[i]) ? DIG_READING_NAN
                                                                : DIG_READING_OK);
    }
    atomic_fetch_add(&input->frames, 1);
    dig_input_put(input, &reading);
}

static enum dig_status read_replay(struct dig_input *const input, struct dig_error *const error)
{
    (void)error;
    struct replay *const                      replay    = input->source;
    const struct dig_machine_recording *const recording = &replay->recording;
    if (replay->next == recording->rows) {
        atomic_store(&input->ended, true);
        return DIG_OK;
    }
    const struct dig_sample *const row = &recording->row[replay->next];

    // The time a row is due at, not the time it was handed on at: replay has no jitter.
    const int64_t from_start_ns = row->time_ns - recording->row[0].time_ns;
    const int64_t due_ns =
        replay->start_ns + (int64_t)llround((double)from_start_ns / replay->speed);
    const int64_t left_ns = due_ns - dig_input_now_ns();
    if (left_ns > 0) {
        dig_input_pause(input, left_ns);
    }
    if (!atomic_load(input->stop)) {
        give_row(input, row, due_ns);
        replay->next++;
    }
    return DIG_OK;
}

static void finish_replay(struct dig_input *const input)
{
    dig_machine_recording_finish(&((struct replay *)input->source)->recording);
}

static const struct dig_input_ops ops = { open_replay, read_replay, NULL, finish_replay };

enum dig_status dig_input_replay_create(struct dig_input *const             input,
                                        struct dig_machine_recording *const recording,
                                        const char *const file, const double speed)
{
    assert(input != NULL && recording != NULL && file != NULL);
    if (!(speed > 0.0) || recording->rows == 0) {
        return DIG_EINVAL;
    }
    struct replay *const replay = calloc(1, sizeof *replay);
    if (replay == NULL) {
        return DIG_ENOMEM;
    }
    for (size_t i = 0; i < recording->rows; i++) {
        for (size_t s = 0; s < DIG_SIGNALS; s++) {
            replay->has[s] |= recording->row[i].valid[s];
        }
    }
    replay->recording = *recording;
    replay->speed     = speed;
    *recording        = (struct dig_machine_recording){ 0 };
    input->ops        = &ops;
    input->source     = replay;
    (void)snprintf(input->name, sizeof input->name, "replay %.150s", file);
    return DIG_OK;
}
