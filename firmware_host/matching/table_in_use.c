#include "firmware_host/matching/table_in_use.h"

#include "tables/load.h"

#include <assert.h>

void dig_table_in_use_exchange(struct dig_table_in_use *const table,
                               struct dig_curve_set *const set, const double lambda)
{
    assert(table != NULL && set != NULL && table->retiring == NULL);
    table->retiring = table->set;
    table->set      = set;
    table->lambda   = lambda;
    table->generation++;
    dig_matcher_set_table(&table->matcher, set);
}

bool dig_table_in_use_by_tick(const struct dig_table_in_use *const table)
{
    assert(table != NULL);
    return atomic_load(table->tick_generation) == table->generation;
}

void dig_table_in_use_retire(struct dig_table_in_use *const table)
{
    assert(table != NULL);
    if (table->retiring != NULL && dig_table_in_use_by_tick(table) &&
        atomic_load(table->publisher_generation) == table->generation) {
        dig_curve_set_destroy(table->retiring);
        table->retiring = NULL;
    }
}

void dig_table_in_use_finish(struct dig_table_in_use *const table)
{
    assert(table != NULL);
    dig_matcher_finish(&table->matcher);
    dig_curve_set_destroy(table->retiring);
    dig_curve_set_destroy(table->set);
    table->retiring = NULL;
    table->set      = NULL;
}
