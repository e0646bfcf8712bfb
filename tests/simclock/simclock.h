// Simulated time for programs under test, shared between them through one file in memory.
//
//   preload.so   is loaded before libc into each program (LD_PRELOAD) and answers what asks for a
//                clock or waits on it: clock_gettime, clock_nanosleep, nanosleep, usleep, poll,
//                select, sigtimedwait. All clocks but the processor time of a process are this one:
//                to compute takes no time. A wait is written into a slot; it ends when the clock
//                has come to it, and what is waited for beside it (a socket, a signal) ends it as
//                ever.
//   simclock     is what a test moves the clock with. The clock goes to the next wait that ends,
//                and only when every thread of every program sleeps. Waits end one after the other,
//                those of one instant in the order in which their threads began. So no program is
//                ever late, and each run is the same, however busy the machine is; nobody waits
//                longer than the programs compute. While no simclock runs, time stands still.
//
// With DIG_SIMCLOCK_ONE_CPU, for a machine that has one and lets its programs run in real time
// (SCHED_FIFO), nobody is looked at: simclock has an ordinary priority, and runs when all of them
// sleep. ksoftirqd, to which a slow machine's kernel leaves frames, must run in real time too, or
// time passes before they are handed over. Without the variable DIG_SIMCLOCK, which names the file,
// preload.so changes nothing.
//
// The kernel's stamps of arrival are of its own clock; preload.so switches them off.
//
// Bytes in flight are seen where the kernel hands them over at once: sockets of this machine and
// pipes. A terminal's are carried by a kernel thread, so those written and not yet read are
// counted.

#ifndef DIG_TESTS_SIMCLOCK_SIMCLOCK_H
#define DIG_TESTS_SIMCLOCK_SIMCLOCK_H

#include <stdatomic.h>
#include <stdint.h>

#define SIM_SLOTS     96
#define SIM_PROGRAMS  32
#define SIM_BEGINS_ns 1000000000000LL

// Taken: whose it is is being written down; nobody may take it for a slot of the dead meanwhile.
enum sim_state { SIM_FREE, SIM_TAKEN, SIM_RUNNING, SIM_SLEEPING, SIM_POLLING };

// One thread's. A sleeper is woken through the word `state`, who polls through the pipe FILE.N of
// its number.
struct sim_slot {
    _Atomic uint32_t state;
    _Atomic int32_t  pid, tid;
    _Atomic int64_t  due_ns;
};

struct sim {
    _Atomic int64_t  now_ns;
    int64_t          utc_ns;       // what the calendar's clock is ahead of it
    _Atomic uint32_t turns;        // grows with each wait that begins
    _Atomic uint32_t wanted;       // simclock sleeps on `turns` until it is this
    _Atomic uint32_t threads;      // grows with each program and thread that begins
    _Atomic int64_t  flying_bytes; // on terminals: written, not yet read
    _Atomic int32_t  program[SIM_PROGRAMS];
    struct sim_slot  slot[SIM_SLOTS];
};

#endif
