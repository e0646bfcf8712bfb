// The present troubles of the daemon and its digs, and what to do about them, the worst first.

#ifndef DIG_TOOLS_DIGWATCH_TROUBLE_H
#define DIG_TOOLS_DIGWATCH_TROUBLE_H

#include "tools/digwatch/model.h"

#include <stddef.h>

#define DIGWATCH_TROUBLES_MAX 12

/// A daemon that says nothing for so long is silent: HEALTH comes once a second.
#define DIGWATCH_SILENT_s 3.0

/// A counter that grew so long ago is not trouble any more.
#define DIGWATCH_TROUBLE_ns 10000000000LL

/// Of messages, with '?' in place of control characters.
struct digwatch_trouble {
    char what[DIGWATCH_TEXT + 64], todo[DIGWATCH_TEXT];
};

/// silent_s: since the last message. Returns how many there are.
size_t digwatch_troubles(const struct digwatch_model *model, double silent_s,
                         struct digwatch_trouble trouble[DIGWATCH_TROUBLES_MAX]);

#endif // DIG_TOOLS_DIGWATCH_TROUBLE_H
