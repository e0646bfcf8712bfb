#include "core/model.h"

#include <stdlib.h>

void dig_model_finish(struct dig_model *const model)
{
    if (model == NULL) {
        return;
    }
    free(model->unlisted);
    *model = (struct dig_model){ 0 };
}
