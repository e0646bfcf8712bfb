// Starts the daemon's threads, waits for the end, stops them in order.

#include "firmware_host/daemon_private.h"
#include "firmware_host/threads/notify.h"

#include <assert.h>
#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <time.h>

#define STACK_BYTES ((size_t)2 * 1024 * 1024) // the matcher needs less than half of it
#define LINE        512

// The input's and the publisher's threads stand a little below the tick: a sample is of use only
// when it comes in and goes out.
static void enter_below(const struct dig_daemon *const d, const int below)
{
    const struct dig_rt_settings *const rt       = &d->loaded.config.realtime;
    const struct dig_rt_settings        settings = { .priority =
                                                  rt->priority > below ? rt->priority - below : 0,
                                                     .cpu = -1 };
    (void)dig_rt_enter(&settings);
}

static void *input_main(void *const context)
{
    struct dig_daemon *const d = context;
    enter_below(d, 1);
    dig_input_run(&d->input);
    return NULL;
}

static void *tick_main(void *const context)
{
    struct dig_daemon *const d = context;
    d->publisher.health.rt     = dig_rt_enter(&d->loaded.config.realtime);
    (void)sem_post(&d->granted);
    dig_loop_run(&d->loop, &d->stop);
    return NULL;
}

static void *fit_main(void *const context)
{
    struct dig_daemon *const d = context;
    dig_fit_run(&d->fit);
    return NULL;
}

static void *publish_main(void *const context)
{
    struct dig_daemon *const d = context;
    enter_below(d, 2);
    dig_publisher_run(&d->publisher);
    return NULL;
}

// A replay is over when its last reading went through the tick, and its last dig through the
// matcher.
static bool is_quiet(struct dig_daemon *const d)
{
    return atomic_load(&d->input.ended) &&
           atomic_load(&d->handoffs.readings.written) == atomic_load(&d->handoffs.readings.read) &&
           atomic_load(&d->handoffs.digs.written) == atomic_load(&d->handoffs.digs.read) &&
           !atomic_load(&d->fit.busy);
}

static void wait_for_end(struct dig_daemon *const d, const sigset_t *const signals)
{
    const struct timespec slice = { .tv_nsec = 50000000L };
    for (int quiet = 0; quiet < 5;) {
        const int signal = sigtimedwait(signals, NULL, &slice);
        if (signal == SIGHUP) {
            atomic_store(&d->fit.reload, true);
        } else if (signal > 0) {
            return;
        }
        quiet = is_quiet(d) ? quiet + 1 : 0;
    }
}

enum dig_status dig_daemon_run(struct dig_daemon *const d, void (*const say)(const char *line),
                               struct dig_error *const  error)
{
    assert(d != NULL && say != NULL);

    // Blocked before the first thread starts, so that every thread inherits it and only we see
    // them.
    sigset_t signals;
    (void)sigemptyset(&signals);
    (void)sigaddset(&signals, SIGTERM);
    (void)sigaddset(&signals, SIGINT);
    (void)sigaddset(&signals, SIGHUP);
    (void)pthread_sigmask(SIG_BLOCK, &signals, NULL);

    static void *(*const mains[])(void *) = { tick_main, publish_main, fit_main, input_main };
    pthread_t      thread[4];
    size_t         started = 0;
    pthread_attr_t attributes;
    (void)pthread_attr_init(&attributes);
    (void)pthread_attr_setstacksize(&attributes, STACK_BYTES);
    (void)sem_init(&d->granted, 0, 0);
    d->publisher.say = say;

    enum dig_status status = DIG_OK;
    for (size_t i = 0; i < sizeof mains / sizeof mains[0] && status == DIG_OK; i++) {
        const int why = pthread_create(&thread[i], &attributes, mains[i], d);
        if (why != 0) {
            errno  = why;
            status = dig_error_set(error, DIG_EIO, "a thread could not be started (error %d)", why);
            break;
        }
        started++;
        if (i == 0) {
            char line[LINE];
            while (sem_wait(&d->granted) != 0) {
            }
            dig_rt_describe(&d->loaded.config.realtime, &d->publisher.health.rt, sizeof line, line);
            say(line);
        }
    }
    (void)pthread_attr_destroy(&attributes);
    if (status == DIG_OK) {
        (void)dig_notify("READY=1");
        wait_for_end(d, &signals);
        (void)dig_notify("STOPPING=1");
    }
    atomic_store(&d->stop, true);
    for (size_t i = 0; i < started; i++) {
        if (i != 1) {
            (void)pthread_join(thread[i], NULL);
        }
    }
    atomic_store(&d->stop_publish, true);
    if (started > 1) {
        (void)pthread_join(thread[1], NULL);
    }
    (void)sem_destroy(&d->granted);
    return status;
}
