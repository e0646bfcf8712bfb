// Threads that share the work of one step of a large world. What a member does must not depend on
// how many there are.

#ifndef DIG_OFFLINE_DEM_KERNEL_CREW_H
#define DIG_OFFLINE_DEM_KERNEL_CREW_H

#include "core/status.h"

#include <stddef.h>

struct dig_crew;

/// A crew of so many members, the caller among them; members >= 2. DIG_ENOMEM where threads or
/// memory are short.
DIG_MUST_CHECK enum dig_status dig_crew_create(size_t members, struct dig_crew **crew);

size_t dig_crew_members(const struct dig_crew *crew); // 1 for NULL

/// The first of so many items that is a member's; those up to the next member's first are its own.
size_t dig_crew_share(const struct dig_crew *crew, size_t items, size_t member);

/// Calls work(context, member) for every member, member 0 on the caller's thread, and returns when
/// all are done. NULL: the caller alone. Costs some microseconds.
void dig_crew_run(struct dig_crew *crew, void (*work)(void *context, size_t member), void *context);

/// The same with work(context, first, end) for each member's share of so many items: [first, end).
void dig_crew_each(struct dig_crew *crew, size_t                                items,
                   void (*work)(void *context, size_t first, size_t end), void *context);

/// NULL is allowed.
void dig_crew_destroy(struct dig_crew *crew);

#endif // DIG_OFFLINE_DEM_KERNEL_CREW_H
