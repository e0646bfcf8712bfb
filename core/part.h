// Opens NAME.part: a file that is to appear whole or not at all is written under that name first.

#ifndef DIG_CORE_PART_H
#define DIG_CORE_PART_H

#include <stdio.h>

/// Opens a new file for writing at path. What a killed program left there is removed, and so is a
/// link, which is never followed: what it points to stays as it is. NULL with errno, also when
/// somebody else makes the file at the same time.
FILE *dig_part_open(const char *path);

#endif // DIG_CORE_PART_H
