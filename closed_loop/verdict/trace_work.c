#include "closed_loop/verdict/trace_work.h"

enum dig_status dig_trace_batch(const struct dig_trace_work *const w,
                                struct dig_fitted *const plain, struct dig_error *const error)
{
    static const struct dig_hypothesis none                           = { .effects = 0 };
    const double                       middle[DIG_HYPOTHESIS_NUMBERS] = { 0.0 };
    enum dig_status status = dig_whitened_digs_make(w->surface, w->scatter, w->digs, w->measured,
                                                    w->fit, NULL, w->batch);
    for (int round = 0; round < 2 && status == DIG_OK; round++) {
        dig_hypothesis_fit(w->batch, w->soil, &none, middle, DIG_FIT_THOROUGH, plain);
        if (round == 0) {
            status = dig_whitened_digs_make(w->surface, w->scatter, w->digs, w->measured, w->fit,
                                            plain->number, w->batch);
        }
    }
    return status == DIG_OK
               ? status
               : dig_error_set(error, DIG_EINVAL,
                               "the digs of one trajectory have too little measured in common");
}
