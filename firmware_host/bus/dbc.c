#include "firmware_host/bus/dbc.h"

#include "core/room.h"
#include "core/text.h"
#include "files/text/whole.h"

#include <assert.h>
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define EXTENDED_FLAG 0x80000000U
#define MESSAGES_MAX  8192 // each is compared with all before it
#define SIGNALS_MAX   1024 // of one message, likewise
#define SIGNALS_ALL   65536
#define LOOKUPS_MAX   65536 // lines that name a message by its id, for which all are looked through

// Position of the reader, for errors.
struct cursor {
    const char       *path;
    int               line;
    int               lookups;
    struct dig_error *error;
};

static enum dig_status refuse(const struct cursor *const cursor, const char *const found,
                              const char *const expected)
{
    return dig_error_set(cursor->error, DIG_EINVAL, "%s:%d: \"%.60s\", expected %s", cursor->path,
                         cursor->line, found, expected);
}

// BO_ 2566879720 Pressure_1: 8 Machine
static enum dig_status read_message(const struct cursor *const cursor, const char *const text,
                                    struct dig_dbc *const dbc)
{
    static const char grammar[] = "BO_ ID NAME: BYTES SENDER";

    unsigned long long id                      = 0;
    char               name[DIG_DBC_NAME_SIZE] = "";
    unsigned           bytes                   = 0;
    // NOLINTNEXTLINE(cert-err34-c): ranges are checked below
    if (sscanf(text, " BO_ %10llu %63[A-Za-z0-9_] : %4u", &id, name, &bytes) != 3) {
        return refuse(cursor, text, grammar);
    }
    const uint32_t most = (id & EXTENDED_FLAG) != 0 ? 0x1FFFFFFFU : 0x7FFU;
    // What makers' files use for signals that belong to no message: it has neither id nor length.
    const bool nowhere = strcmp(name, "VECTOR__INDEPENDENT_SIG_MSG") == 0;
    if (nowhere) {
        bytes = 64;
    } else if (id > UINT32_MAX || (id & ~(unsigned long long)EXTENDED_FLAG) > most) {
        return refuse(cursor, text, "an 11-bit id, or a 29-bit id with bit 31 set");
    }
    if (bytes > 64) {
        return refuse(cursor, text, "at most 64 bytes");
    }
    if (dbc->messages == MESSAGES_MAX) {
        return refuse(cursor, name, "at most 8192 messages");
    }
    if (dig_dbc_find(dbc, name) != NULL) {
        return refuse(cursor, name, "every message once");
    }
    struct dig_dbc_message *const grown = dig_room(dbc->message, dbc->messages, sizeof *grown);
    if (grown == NULL) {
        return dig_error_set(cursor->error, DIG_ENOMEM, "%s: no memory", cursor->path);
    }
    dbc->message                  = grown;
    dbc->message[dbc->messages++] = (struct dig_dbc_message){
        .id       = (uint32_t)(id & ~(unsigned long long)EXTENDED_FLAG),
        .extended = (id & EXTENDED_FLAG) != 0,
        .bytes    = bytes,
        .first    = dbc->signals,
    };
    memcpy(dbc->message[dbc->messages - 1].name, name, sizeof name);
    return DIG_OK;
}

// The bit after the last one the signal covers, in the order bits are numbered in a frame, or
// UINT_MAX when it begins outside.
static unsigned end_bit(const struct dig_dbc_signal *const signal)
{
    if (signal->intel) {
        return signal->start_bit + signal->bits;
    }
    // Motorola: count down from the start bit within its byte, on through the bytes that follow.
    const unsigned in_byte = signal->start_bit % 8 + 1;
    const unsigned after   = signal->bits > in_byte ? (signal->bits - in_byte + 7) / 8 : 0;
    return (signal->start_bit / 8 + 1 + after) * 8;
}

static enum dig_status check_signal(const struct cursor *const         cursor,
                                    const struct dig_dbc_signal *const signal,
                                    const struct dig_dbc *const        dbc)
{
    const struct dig_dbc_message *const message = &dbc->message[dbc->messages - 1];
    if (signal->bits < 1 || signal->bits > 64) {
        return refuse(cursor, signal->name, "1 to 64 bits");
    }
    if (end_bit(signal) > message->bytes * 8) {
        return dig_error_set(cursor->error, DIG_EINVAL,
                             "%s:%d: %s: reaches bit %u, expected to end within the %u bytes of %s",
                             cursor->path, cursor->line, signal->name, end_bit(signal),
                             message->bytes, message->name);
    }
    if (!isfinite(signal->factor) || !(fabs(signal->factor) > 0.0) || !isfinite(signal->offset)) {
        return refuse(cursor, signal->name, "a factor that is not 0 and a finite offset");
    }
    if (message->signals == SIGNALS_MAX) {
        return refuse(cursor, signal->name, "at most 1024 signals of a message");
    }
    if (dbc->signals == SIGNALS_ALL) {
        return refuse(cursor, signal->name, "at most 65536 signals");
    }
    if (dig_dbc_find_signal(dbc, message, signal->name) != NULL) {
        return refuse(cursor, signal->name, "every signal of a message once");
    }
    return DIG_OK;
}

//  SG_ name : 8|16@1+ (0.2,-10) [-10|40] "MPa" Receiver
static enum dig_status read_signal(const struct cursor *const cursor, const char *const text,
                                   struct dig_dbc *const dbc)
{
    static const char grammar[] =
        "SG_ NAME [MUX] : START|BITS@ORDER SIGN (FACTOR,OFFSET) [MIN|MAX] \"UNIT\"";

    struct dig_dbc_signal signal = { 0 };
    char                  mux[8] = "";
    char                  order  = 0;
    char                  sign   = 0;
    int                   used   = 0;
    if (dbc->messages == 0) {
        return refuse(cursor, text, "a BO_ line before the first SG_");
    }
    if (sscanf(text, " SG_ %63[A-Za-z0-9_] %n", signal.name, &used) != 1) {
        return refuse(cursor, text, grammar);
    }
    const char *rest = text + used;
    if (*rest != ':') {
        used = 0;
        if (sscanf(rest, "%7[mM0-9] %n", mux, &used) != 1) {
            return refuse(cursor, text, grammar);
        }
        signal.multiplexed = mux[0] == 'm';
        rest += used;
    }
    used = 0;
    // NOLINTNEXTLINE(cert-err34-c): ranges are checked below
    if (sscanf(rest, ": %3u | %3u @ %c %c ( %lf , %lf ) [ %*f | %*f ] %n", &signal.start_bit,
               &signal.bits, &order, &sign, &signal.factor, &signal.offset, &used) != 6 ||
        used == 0 || rest[used] != '"' || strchr(rest + used + 1, '"') == NULL) {
        return refuse(cursor, text, grammar);
    }
    (void)sscanf(rest + used, "\"%15[^\"]", signal.unit); // "" leaves it empty
    dig_text_clean(signal.unit);
    if ((order != '0' && order != '1') || (sign != '+' && sign != '-')) {
        return refuse(cursor, text, "@1 (Intel) or @0 (Motorola), then + or -");
    }
    signal.intel                 = order == '1';
    signal.is_signed             = sign == '-';
    const enum dig_status status = check_signal(cursor, &signal, dbc);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_dbc_signal *const grown = dig_room(dbc->signal, dbc->signals, sizeof *grown);
    if (grown == NULL) {
        return dig_error_set(cursor->error, DIG_ENOMEM, "%s: no memory", cursor->path);
    }
    dbc->signal                 = grown;
    dbc->signal[dbc->signals++] = signal;
    dbc->message[dbc->messages - 1].signals++;
    return DIG_OK;
}

static enum dig_status count_lookup(struct cursor *const cursor, const char *const text)
{
    return cursor->lookups++ < LOOKUPS_MAX
               ? DIG_OK
               : refuse(cursor, text, "at most 65536 SIG_VALTYPE_ and GenMsgCycleTime");
}

// SIG_VALTYPE_ 2566879720 name : 1;   1: float, 2: double
static enum dig_status read_type(struct cursor *const cursor, const char *const text,
                                 const struct dig_dbc *const dbc)
{
    unsigned long long id                      = 0;
    char               name[DIG_DBC_NAME_SIZE] = "";
    unsigned           type                    = 0;
    // NOLINTNEXTLINE(cert-err34-c): an unreadable line names no signal of ours
    if (sscanf(text, " SIG_VALTYPE_ %10llu %63[A-Za-z0-9_] : %1u", &id, name, &type) != 3) {
        return DIG_OK;
    }
    const enum dig_status status = count_lookup(cursor, text);
    for (size_t i = 0; status == DIG_OK && i < dbc->messages; i++) {
        const struct dig_dbc_message *const m  = &dbc->message[i];
        const bool                          is = (m->id | (m->extended ? EXTENDED_FLAG : 0)) == id;
        for (size_t s = m->first; is && s < m->first + m->signals; s++) {
            if (strcmp(dbc->signal[s].name, name) == 0) {
                dbc->signal[s].is_float = type != 0;
            }
        }
    }
    return status;
}

// BA_ "GenMsgCycleTime" BO_ 2566879720 10;   in ms
static enum dig_status read_cycle(struct cursor *const cursor, const char *const text,
                                  const struct dig_dbc *const dbc)
{
    unsigned long long id       = 0;
    double             cycle_ms = 0.0;
    // NOLINTNEXTLINE(cert-err34-c): an unreadable line says nothing of ours
    if (sscanf(text, " BA_ \"GenMsgCycleTime\" BO_ %10llu %lf", &id, &cycle_ms) != 2 ||
        !(cycle_ms > 0.0 && cycle_ms <= 60e3)) {
        return DIG_OK;
    }
    const enum dig_status status = count_lookup(cursor, text);
    for (size_t i = 0; status == DIG_OK && i < dbc->messages; i++) {
        struct dig_dbc_message *const m = &dbc->message[i];
        if ((m->id | (m->extended ? EXTENDED_FLAG : 0)) == id) {
            m->cycle_s = cycle_ms * 1e-3;
        }
    }
    return status;
}

static enum dig_status read_lines(const char *const path, char *const text,
                                  struct dig_dbc *const dbc, struct dig_error *const error)
{
    struct cursor cursor    = { .path = path, .line = 0, .error = error };
    bool          in_string = false; // comments and attributes may run over several lines
    for (char *line = text; line != NULL;) {
        char *const end = strchr(line, '\n');
        if (end != NULL) {
            *end = '\0';
        }
        cursor.line++;
        const char *word = line;
        while (isspace((unsigned char)*word)) {
            word++;
        }
        enum dig_status status = DIG_OK;
        if (!in_string && strncmp(word, "BO_ ", 4) == 0) {
            status = read_message(&cursor, word, dbc);
        } else if (!in_string && strncmp(word, "SG_ ", 4) == 0) {
            status = read_signal(&cursor, word, dbc);
        } else if (!in_string && strncmp(word, "SIG_VALTYPE_ ", 13) == 0) {
            status = read_type(&cursor, word, dbc);
        } else if (!in_string && strncmp(word, "BA_ ", 4) == 0) {
            status = read_cycle(&cursor, word, dbc);
        }
        if (status != DIG_OK) {
            return status;
        }
        for (const char *c = line; *c != '\0'; c++) {
            in_string = in_string != (*c == '"');
        }
        line = end != NULL ? end + 1 : NULL;
    }
    if (dbc->messages == 0) {
        return dig_error_set(error, DIG_EINVAL, "%s:%d: no BO_ line, expected a CAN database", path,
                             cursor.line);
    }
    return DIG_OK;
}

enum dig_status dig_dbc_read(const char *const path, struct dig_dbc *const dbc,
                             struct dig_error *const error)
{
    assert(path != NULL && dbc != NULL);
    char           *text   = NULL;
    size_t          size   = 0;
    enum dig_status status = dig_file_read(path, &text, &size, error);
    if (status != DIG_OK) {
        return status;
    }
    struct dig_dbc      loaded = { 0 };
    struct dig_c_locale locale = dig_c_locale_enter();
    status                     = read_lines(path, text, &loaded, error);
    dig_c_locale_leave(&locale);
    free(text);
    if (status == DIG_OK) {
        *dbc = loaded;
    } else {
        dig_dbc_finish(&loaded);
    }
    return status;
}

void dig_dbc_finish(struct dig_dbc *const dbc)
{
    if (dbc != NULL) {
        free(dbc->message);
        free(dbc->signal);
        *dbc = (struct dig_dbc){ 0 };
    }
}

const struct dig_dbc_message *dig_dbc_find(const struct dig_dbc *const dbc, const char *const name)
{
    assert(dbc != NULL && name != NULL);
    for (size_t i = 0; i < dbc->messages; i++) {
        if (strcmp(dbc->message[i].name, name) == 0) {
            return &dbc->message[i];
        }
    }
    return NULL;
}

const struct dig_dbc_signal *dig_dbc_find_signal(const struct dig_dbc *const         dbc,
                                                 const struct dig_dbc_message *const message,
                                                 const char *const                   name)
{
    assert(dbc != NULL && message != NULL && name != NULL);
    for (size_t i = message->first; i < message->first + message->signals; i++) {
        if (strcmp(dbc->signal[i].name, name) == 0) {
            return &dbc->signal[i];
        }
    }
    return NULL;
}
