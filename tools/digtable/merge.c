// digtable merge.

#include "tables/merge.h"

#include "tools/digtable/commands.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

int dig_cli_merge(const struct dig_arguments *const a)
{
    struct dig_error error = { "" };
    for (int i = 1; i < a->positionals; i++) {
        if (access(a->positional[i], R_OK) != 0) {
            return dig_cli_bad_input(
                dig_error_set(&error, DIG_EIO, "%s: %s", a->positional[i], strerror(errno)),
                &error);
        }
    }
    const enum dig_status status =
        dig_store_merge(a->positional[0], (size_t)a->positionals - 1, &a->positional[1], &error);
    return status == DIG_OK ? EXIT_DONE : dig_cli_work_failed(status, &error);
}
