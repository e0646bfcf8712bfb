// Modbus TCP and RTU through libmodbus: the blocks of registers the map names, each polled at its
// own rate, one request at a time: the one that is due longest. Only functions 3 and 4, which read;
// no call of this file can write.
//
// A block that does not answer delays the others by RESPONSE_us each time. An answer is not taken
// for the present when its last byte came later than that, whether the server was slow or this
// program did not run. A dispensable one that
// is silent while the others answer is polled only now and then.

#include "core/units.h"
#include "firmware_host/bus/input.h"
#include "firmware_host/bus/modbus_tcp.h"
#include "firmware_host/bus/signal_map.h"

#include <assert.h>
#include <errno.h>
#include <modbus/modbus.h>
#include <stdio.h>
#include <stdlib.h>

#define RESPONSE_us        200000 // a server that is slower than this is taken for gone
#define FAILURES_BORNE     5
#define DISPENSABLE_ns     DIG_NS_PER_S // between polls of a block that can be done without and fails
#define SILENCES_TOLERATED 3
#define SILENT_s           5 // between polls of one that does not even answer

struct modbus_source {
    struct dig_modbus_address    address;
    const struct dig_signal_map *map;
    modbus_t                    *bus;
    bool                         resync;      // serial: the next answer may be a late one
    uint16_t                     transaction; // TCP: of the last request
    // of each block
    int64_t next_ns[DIG_GROUPS_MAX];  // when the next poll is due
    int     failures[DIG_GROUPS_MAX]; // in a row
    int     silences[DIG_GROUPS_MAX]; // time-outs in a row, with an answer of another block between
    int64_t answers;                  // of all blocks …
    int64_t answers_at[DIG_GROUPS_MAX]; // … when the block timed out last
};

static enum dig_status refuse(const struct dig_input *const input, const char *const what,
                              struct dig_error *const error)
{
    return dig_error_set(error, DIG_EIO, "%s: %s: %s", input->name, what, modbus_strerror(errno));
}

static enum dig_status open_modbus(struct dig_input *const input, struct dig_error *const error)
{
    struct modbus_source *const            s = input->source;
    const struct dig_modbus_address *const a = &s->address;
    char                                   port[8];
    (void)snprintf(port, sizeof port, "%d", a->port);
    s->bus = a->host[0] != '\0' ? modbus_new_tcp_pi(a->host, port)
                                : modbus_new_rtu(a->device, a->baud, a->parity, 8, 1);
    if (s->bus == NULL) {
        return refuse(input, "cannot be opened", error);
    }
    if (modbus_set_slave(s->bus, a->unit) != 0 ||
        modbus_set_response_timeout(s->bus, 0, RESPONSE_us) != 0 ||
        (a->host[0] != '\0' && modbus_set_byte_timeout(s->bus, 0, 0) != 0) || // of all bytes
        modbus_connect(s->bus) != 0) {
        const enum dig_status status = refuse(input, "cannot be opened", error);
        modbus_free(s->bus);
        s->bus = NULL;
        return status;
    }
    const int64_t now_ns = dig_input_now_ns();
    for (size_t g = 0; g < s->map->groups; g++) {
        s->next_ns[g]  = now_ns;
        s->failures[g] = 0;
        s->silences[g] = 0;

        s->answers_at[g] = s->answers;
    }
    return DIG_OK;
}

static struct dig_error registers_of(const struct dig_input *const     input,
                                     const struct dig_map_group *const group,
                                     const char *const what, const char *const why)
{
    struct dig_error error = { "" };
    (void)dig_error_set(&error, DIG_EIO, "%s: registers %u … %u: %s%s", input->name,
                        group->first_register, group->first_register + group->registers - 1, what,
                        why);
    return error;
}

static bool is_dispensable(const struct dig_map_group *const group)
{
    return !group->needed || group->dispensable;
}

// A time-out. While no block answers, the server is silent, not the block.
static void count_timeout(struct dig_input *const input, const size_t block)
{
    struct modbus_source *const       s     = input->source;
    const struct dig_map_group *const group = &s->map->group[block];
    if (s->answers > s->answers_at[block]) {
        s->silences[block]++;
    }
    s->answers_at[block] = s->answers;
    if (!is_dispensable(group) || s->silences[block] < SILENCES_TOLERATED) {
        return;
    }
    if (s->silences[block] == SILENCES_TOLERATED) {
        const struct dig_error error =
            registers_of(input, group, "silent while others answer, asked every few seconds", "");
        dig_input_log(input, &error);
    }
    s->next_ns[block] = dig_input_now_ns() + SILENT_s * DIG_NS_PER_S;
}

// A poll that failed. A damaged frame, a refusal or a late answer is tolerated a few times; without
// limit for a dispensable block (optional signals, or the force's alone), which is polled less
// often then. A broken connection is not tolerated.
static enum dig_status bear(struct dig_input *const input, const size_t block,
                            struct dig_error *const error)
{
    struct modbus_source *const       s     = input->source;
    const struct dig_map_group *const group = &s->map->group[block];
    const int                         why   = errno;
    const bool                        borne = why > MODBUS_ENOBASE || why == ETIMEDOUT;
    if (why > MODBUS_ENOBASE) {
        atomic_fetch_add(&input->malformed, 1);
    } else if (why == ETIMEDOUT) {
        atomic_fetch_add(&input->timeouts, 1);
    }
    // A refusal is an answer; after a missing or damaged one, a late answer may still come.
    if (s->address.host[0] == '\0' && (why == ETIMEDOUT || why >= EMBBADCRC)) {
        s->resync = true;
    }
    const bool few = ++s->failures[block] < FAILURES_BORNE;
    if (borne && (few || is_dispensable(group))) {
        (void)modbus_flush(s->bus);
        s->next_ns[block] += few ? 0 : DISPENSABLE_ns;
        if (why == ETIMEDOUT) {
            count_timeout(input, block);
        }
        return DIG_OK;
    }
    if (error != NULL) {
        *error = registers_of(input, group, "no good answer: ", modbus_strerror(why));
    }
    return DIG_EIO;
}

// The block that has been due longest.
static size_t due(const struct modbus_source *const s)
{
    size_t block = 0;
    for (size_t g = 1; g < s->map->groups; g++) {
        block = s->next_ns[g] < s->next_ns[block] ? g : block;
    }
    return block;
}

static int ask_tcp(struct modbus_source *const s, const struct dig_map_group *const group,
                   uint16_t registers[const DIG_REGISTERS_MAX])
{
    const struct dig_modbus_request request = { .transaction = ++s->transaction,
                                                .unit        = (uint8_t)s->address.unit,
                                                .function    = (uint8_t)group->function,
                                                .first       = (uint16_t)group->first_register,
                                                .count       = (uint16_t)group->registers };
    return dig_modbus_tcp_read(s->bus, &request, registers);
}

// Discards what is on a serial line before a request: it cannot be its answer.
static int ask_serial(const struct modbus_source *const s, const struct dig_map_group *const group,
                      uint16_t registers[const DIG_REGISTERS_MAX])
{
    (void)modbus_flush(s->bus);
    const int first = (int)group->first_register;
    const int count = (int)group->registers;
    const int read  = group->function == 3
                          ? modbus_read_registers(s->bus, first, count, registers)
                          : modbus_read_input_registers(s->bus, first, count, registers);
    return read == count ? 0 : -1;
}

// How long a good answer takes at most: on a serial line also twice the time of its bytes and the
// request's, of 11 bits each.
static int64_t longest_ns(const struct modbus_source *const s,
                          const struct dig_map_group *const group)
{
    const int64_t bits = 22 * (8 + 5 + 2 * (int64_t)group->registers);
    return RESPONSE_us * 1000LL +
           (s->address.host[0] != '\0' ? 0 : bits * DIG_NS_PER_S / s->address.baud);
}

// 0, or -1 with errno.
static int ask(struct modbus_source *const s, const size_t block,
               uint16_t registers[const DIG_REGISTERS_MAX])
{
    const struct dig_map_group *const group    = &s->map->group[block];
    const int64_t                     asked_ns = dig_input_now_ns();
    const int                         failed =
        s->address.host[0] != '\0' ? ask_tcp(s, group, registers) : ask_serial(s, group, registers);
    if (failed == 0 && dig_input_now_ns() - asked_ns > longest_ns(s, group)) {
        errno = ETIMEDOUT;
        return -1;
    }
    return failed;
}

static enum dig_status read_modbus(struct dig_input *const input, struct dig_error *const error)
{
    struct modbus_source *const       s      = input->source;
    const size_t                      block  = due(s);
    const struct dig_map_group *const group  = &s->map->group[block];
    int64_t *const                    next   = &s->next_ns[block];
    const int64_t                     now_ns = dig_input_now_ns();
    if (*next > now_ns) {
        dig_input_pause(input, *next - now_ns);
    }
    // A late poll shifts the following ones: two polls in quick succession give nothing new.
    const double  poll_s    = group->poll_s > 0.0 ? group->poll_s : s->address.poll_s;
    const int64_t period_ns = (int64_t)(poll_s * (double)DIG_NS_PER_S);
    *next                   = (now_ns > *next + period_ns ? now_ns : *next) + period_ns;

    uint16_t registers[DIG_REGISTERS_MAX];
    if (ask(s, block, registers) != 0) {
        return bear(input, block, error);
    }
    // A serial answer does not carry the number of its request: after a failed one it may belong to
    // that.
    if (s->resync) {
        s->resync          = false;
        s->failures[block] = 0;
        atomic_fetch_add(&input->malformed, 1);
        return DIG_OK;
    }
    struct dig_reading reading;
    dig_signal_map_registers(s->map, (unsigned)block, registers, dig_input_now_ns(), &reading);
    atomic_fetch_add(&input->frames, 1);
    dig_input_put(input, &reading);
    s->failures[block] = 0;
    s->answers++;
    if (s->silences[block] >= SILENCES_TOLERATED) {
        dig_input_log(input, NULL);
    }
    s->silences[block] = 0;
    return DIG_OK;
}

static void close_modbus(struct dig_input *const input)
{
    struct modbus_source *const s = input->source;
    modbus_close(s->bus);
    modbus_free(s->bus);
    s->bus = NULL;
}

static const struct dig_input_ops ops = { open_modbus, read_modbus, close_modbus, NULL };

enum dig_status dig_input_modbus_create(struct dig_input *const                input,
                                        const struct dig_modbus_address *const address,
                                        const struct dig_signal_map *const     map)
{
    assert(input != NULL && address != NULL && map != NULL);
    if (map->kind != DIG_MAP_MODBUS || map->groups == 0 || !(address->poll_s > 0.0)) {
        return DIG_EINVAL;
    }
    struct modbus_source *const s = calloc(1, sizeof *s);
    if (s == NULL) {
        return DIG_ENOMEM;
    }
    s->address    = *address;
    s->map        = map;
    input->ops    = &ops;
    input->source = s;
    if (address->host[0] != '\0') {
        (void)snprintf(input->name, sizeof input->name, "modbus-tcp %s:%d", address->host,
                       address->port);
    } else {
        (void)snprintf(input->name, sizeof input->name, "modbus-rtu %s", address->device);
    }
    return DIG_OK;
}
