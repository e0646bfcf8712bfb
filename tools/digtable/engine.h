// The engine that --engine names.

#ifndef DIG_TOOLS_DIGTABLE_ENGINE_H
#define DIG_TOOLS_DIGTABLE_ENGINE_H

#include "offline_dem/sweep/sweep.h"
#include "tools/digtable/arguments.h"

struct dig_engine dig_cli_engine(const struct dig_arguments *a);

#endif // DIG_TOOLS_DIGTABLE_ENGINE_H
