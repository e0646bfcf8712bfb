#include "offline_dem/kernel/crew.h"

#include <assert.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

// A member looks so often for work before it sleeps: the phases of a step follow each other
// closely.
#define LOOKS 4000

struct member {
    struct dig_crew *crew;
    size_t           number;
    pthread_t        thread;
};

struct dig_crew {
    size_t          members;
    struct member  *member; // [members], the caller's unused
    pthread_mutex_t mutex;
    pthread_cond_t  called, done;

    // The work under way. `call` counts up when it is handed out; `working` members have not yet
    // finished it.
    void (*work)(void *context, size_t member);
    void         *context;
    atomic_size_t call;
    atomic_size_t working;
    atomic_bool   dismissed;
};

static void wait_for_call(struct dig_crew *const crew, const size_t last)
{
    for (int k = 0; k < LOOKS; k++) {
        if (atomic_load(&crew->call) != last) {
            return;
        }
    }
    (void)pthread_mutex_lock(&crew->mutex);
    while (atomic_load(&crew->call) == last) {
        (void)pthread_cond_wait(&crew->called, &crew->mutex);
    }
    (void)pthread_mutex_unlock(&crew->mutex);
}

static void *serve(void *const arg)
{
    const struct member *const member = arg;
    struct dig_crew *const     crew   = member->crew;
    for (size_t last = 0;; last++) {
        wait_for_call(crew, last);
        if (atomic_load(&crew->dismissed)) {
            return NULL;
        }
        crew->work(crew->context, member->number);
        if (atomic_fetch_sub(&crew->working, 1) == 1) {
            (void)pthread_mutex_lock(&crew->mutex);
            (void)pthread_cond_signal(&crew->done);
            (void)pthread_mutex_unlock(&crew->mutex);
        }
    }
}

static void call(struct dig_crew *const crew)
{
    (void)pthread_mutex_lock(&crew->mutex);
    atomic_fetch_add(&crew->call, 1);
    (void)pthread_cond_broadcast(&crew->called);
    (void)pthread_mutex_unlock(&crew->mutex);
}

// Ends the threads of members 1 … started - 1.
static void dismiss(struct dig_crew *const crew, const size_t started)
{
    atomic_store(&crew->dismissed, true);
    call(crew);
    for (size_t m = 1; m < started; m++) {
        (void)pthread_join(crew->member[m].thread, NULL);
    }
    (void)pthread_cond_destroy(&crew->called);
    (void)pthread_cond_destroy(&crew->done);
    (void)pthread_mutex_destroy(&crew->mutex);
    free(crew->member);
    free(crew);
}

enum dig_status dig_crew_create(const size_t members, struct dig_crew **const crew)
{
    assert(members >= 2 && crew != NULL);
    struct dig_crew *const made   = calloc(1, sizeof *made);
    struct member *const   member = calloc(members, sizeof *member);
    if (made == NULL || member == NULL) {
        free(made);
        free(member);
        return DIG_ENOMEM;
    }
    made->members = members;
    made->member  = member;
    (void)pthread_mutex_init(&made->mutex, NULL);
    (void)pthread_cond_init(&made->called, NULL);
    (void)pthread_cond_init(&made->done, NULL);
    for (size_t m = 1; m < members; m++) {
        member[m] = (struct member){ .crew = made, .number = m };
        if (pthread_create(&member[m].thread, NULL, serve, &member[m]) != 0) {
            dismiss(made, m);
            return DIG_ENOMEM;
        }
    }
    *crew = made;
    return DIG_OK;
}

size_t dig_crew_members(const struct dig_crew *const crew)
{
    return crew == NULL ? 1 : crew->members;
}

size_t dig_crew_share(const struct dig_crew *const crew, const size_t items, const size_t member)
{
    return member * items / dig_crew_members(crew);
}

void dig_crew_run(struct dig_crew *const crew, void (*const work)(void *context, size_t member),
                  void *const            context)
{
    if (crew == NULL) {
        work(context, 0);
        return;
    }
    crew->work    = work;
    crew->context = context;
    atomic_store(&crew->working, crew->members - 1);
    call(crew);
    work(context, 0);
    for (int k = 0; k < LOOKS && atomic_load(&crew->working) > 0; k++) {
    }
    (void)pthread_mutex_lock(&crew->mutex);
    while (atomic_load(&crew->working) > 0) {
        (void)pthread_cond_wait(&crew->done, &crew->mutex);
    }
    (void)pthread_mutex_unlock(&crew->mutex);
}

// Work on items, as the members call it.
struct each {
    const struct dig_crew *crew;
    size_t                 items;
    void (*work)(void *context, size_t first, size_t end);
    void *context;
};

static void work_on_share(void *const context, const size_t member)
{
    const struct each *const e = context;
    e->work(e->context, dig_crew_share(e->crew, e->items, member),
            dig_crew_share(e->crew, e->items, member + 1));
}

void dig_crew_each(struct dig_crew *const crew, const size_t                                items,
                   void (*const work)(void *context, size_t first, size_t end), void *const context)
{
    struct each each = { crew, items, work, context };
    dig_crew_run(crew, work_on_share, &each);
}

void dig_crew_destroy(struct dig_crew *const crew)
{
    if (crew != NULL) {
        dismiss(crew, crew->members);
    }
}
