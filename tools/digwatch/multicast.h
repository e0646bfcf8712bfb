// A socket that hears what is sent to a multicast group, as LCM's udpm networks are.

#ifndef DIG_TOOLS_DIGWATCH_MULTICAST_H
#define DIG_TOOLS_DIGWATCH_MULTICAST_H

#include "core/error.h"

/// Joins the group of a URL "udpm://ADDRESS:PORT?ttl=N&recv_buf_size=N"; what is left out is as in
/// LCM, and ttl is for senders. *fd does not block; who closes it leaves. DIG_EINVAL: no such URL.
/// DIG_EIO: no such network.
DIG_MUST_CHECK enum dig_status digwatch_multicast_open(const char *url, int *fd,
                                                       struct dig_error *error);

#endif // DIG_TOOLS_DIGWATCH_MULTICAST_H
