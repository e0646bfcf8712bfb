// digtable merge.

#include "tables/merge.h"

#include "tools/digtable/commands.h"

int dig_cli_merge(const struct dig_arguments *const a)
{
    struct dig_error      error = { "" };
    const enum dig_status status =
        dig_store_merge(a->positional[0], (size_t)a->positionals - 1, &a->positional[1], &error);
    return status == DIG_OK ? EXIT_DONE : dig_cli_work_failed(status, &error);
}
