#include "closed_loop/machine/machine_check_private.h"

#include <assert.h>
#include <math.h>

struct dig_check_item *dig_check_add(struct dig_machine_air_check *const check,
                                     const enum dig_check_question question, const int of)
{
    assert(check->items < DIG_CHECK_ITEMS_MAX);
    struct dig_check_item *const item = &check->item[check->items++];
    *item                             = (struct dig_check_item){
                                    .question  = question,
                                    .of        = of,
                                    .value     = (double)NAN,
                                    .sigma     = (double)NAN,
                                    .tolerance = (double)NAN,
                                    .excess    = (double)NAN,
                                    .share     = (double)NAN,
                                    .at_rod    = (double)NAN,
                                    .answer    = of,
                                    .or_item   = -1,
    };
    return item;
}
