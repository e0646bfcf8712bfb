// The verdict of a trace: what free air and the search in the soil found, put together.

#ifndef DIG_CLOSED_LOOP_VERDICT_TRACE_VERDICT_H
#define DIG_CLOSED_LOOP_VERDICT_TRACE_VERDICT_H

#include "closed_loop/machine/machine_side.h"
#include "closed_loop/verdict/trace.h"
#include "closed_loop/verdict/trace_parts.h"

/// Gives up the names of what the soil shows while free air shows a machine that no effect
/// explains: it may be the machine's.
void dig_trace_doubt_soil(const struct dig_machine_finding *air, struct dig_search *search);

/// Fills effects (the machine's first), where each is seen, the sets that cannot be told apart and
/// what is added to the prediction for an effect without a name: nothing where free air shows a
/// machine that no effect explains, because it may do otherwise to the next dig. Probabilities
/// without free air are even at most. trace->residual says where what has no name is seen.
/// DIG_ENOMEM.
DIG_MUST_CHECK enum dig_status dig_trace_fill_verdict(const struct dig_tracing         *t,
                                                      const struct dig_machine_finding *air,
                                                      struct dig_trace                 *trace);

#endif // DIG_CLOSED_LOOP_VERDICT_TRACE_VERDICT_H
