#include "tools/rig/bus/serve_modbus.h"

#include "tools/rig/bus/modbus_server.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

// How long a thread sleeps before it looks whether it is to end.
static const int look_up_ms = 50;

static void destroy(struct dig_rig_modbus *const server)
{
    if (server == NULL) {
        return;
    }
    for (int i = 0; i < server->clients; i++) {
        (void)close(server->client[i]);
    }
    if (server->listening >= 0) {
        (void)close(server->listening);
    }
    if (server->map != NULL) {
        modbus_mapping_free(server->map);
    }
    if (server->context != NULL) {
        if (server->open) {
            modbus_close(server->context);
        }
        modbus_free(server->context);
    }
    free(server);
}

static struct dig_rig_modbus *create(struct dig_rig_board *const board, modbus_t *const context)
{
    struct dig_rig_modbus *const server = calloc(1, sizeof *server);
    if (server != NULL) {
        server->board     = board;
        server->context   = context;
        server->listening = -1;
        server->map       = modbus_mapping_new(0, 0, DIG_RIG_REGISTERS, DIG_RIG_REGISTERS);
    }
    if (server == NULL || context == NULL || server->map == NULL) {
        if (server == NULL && context != NULL) {
            modbus_free(context);
        }
        destroy(server);
        return NULL;
    }
    return server;
}

static void drop_client(struct dig_rig_modbus *const server, const int index)
{
    (void)close(server->client[index]);
    server->client[index] = server->client[--server->clients];
}

static void accept_client(struct dig_rig_modbus *const server)
{
    const int fd = accept(server->listening, NULL, NULL);
    if (fd < 0) {
        return;
    }
    // The oldest makes room: it may be one that went away without a word.
    if (server->clients == DIG_RIG_CLIENTS_MAX) {
        drop_client(server, 0);
    }
    server->client[server->clients++] = fd;
    server->requests.clients++;
}

static void *serve_tcp(void *const argument)
{
    struct dig_rig_modbus *const server = argument;
    while (!dig_rig_board_is_stopped(server->board)) {
        struct pollfd wait[DIG_RIG_CLIENTS_MAX + 1] = { { .fd     = server->listening,
                                                          .events = POLLIN } };
        const int     clients                       = server->clients;
        for (int i = 0; i < clients; i++) {
            wait[1 + i] = (struct pollfd){ .fd = server->client[i], .events = POLLIN };
        }
        if (poll(wait, (nfds_t)clients + 1, look_up_ms) <= 0) {
            continue;
        }
        // From the last to the first, so that dropping one does not move those still to come.
        for (int i = clients - 1; i >= 0; i--) {
            if (wait[1 + i].revents == 0) {
                continue;
            }
            uint8_t request[MODBUS_TCP_MAX_ADU_LENGTH];
            (void)modbus_set_socket(server->context, server->client[i]);
            const int length = modbus_receive(server->context, request);
            if (length < 0 || (length > 0 && !dig_rig_modbus_answer(server, request, length))) {
                drop_client(server, i);
            }
        }
        if (wait[0].revents != 0) {
            accept_client(server);
        }
    }
    return NULL;
}

static bool open_line(struct dig_rig_modbus *const server)
{
    server->open = modbus_connect(server->context) == 0;
    server->requests.clients += server->open ? 1 : 0;
    return server->open;
}

static void *serve_rtu(void *const argument)
{
    struct dig_rig_modbus *const server = argument;
    while (!dig_rig_board_is_stopped(server->board)) {
        if (!server->open && !open_line(server)) {
            (void)poll(NULL, 0, look_up_ms);
            continue;
        }
        struct pollfd wait = { .fd = modbus_get_socket(server->context), .events = POLLIN };
        if (poll(&wait, 1, look_up_ms) <= 0) {
            continue;
        }
        uint8_t   request[MODBUS_RTU_MAX_ADU_LENGTH];
        const int length = modbus_receive(server->context, request);
        if (length > 0) {
            (void)dig_rig_modbus_answer(server, request, length);
        } else if (length == 0) {
            // For another slave. libmodbus takes what comes next for that slave's reply: let it
            // wait for it now, or it would swallow the next request to us where there is no such
            // slave.
            (void)modbus_receive(server->context, request);
        } else if (errno == EIO || errno == ECONNRESET || errno == EBADF) {
            // The other end of the line went away: open it again when it is back.
            modbus_close(server->context);
            server->open = false;
            (void)poll(NULL, 0, look_up_ms);
        }
    }
    return NULL;
}

static enum dig_status start(struct dig_rig_modbus *const server, void *(*const run)(void *),
                             const char *const address, struct dig_error *const error)
{
    // A client that stops in the middle of a request holds the others up no longer than this.
    (void)modbus_set_byte_timeout(server->context, 0, 100000);
    // How long another slave of a serial line may take to reply; shorter than masters wait.
    (void)modbus_set_response_timeout(server->context, 0, 50000);
    const int failed = pthread_create(&server->thread, NULL, run, server);
    if (failed != 0) {
        destroy(server);
        return dig_error_set(error, DIG_EIO, "%s: no thread: %s", address, strerror(failed));
    }
    return DIG_OK;
}

// What stands before the last colon, and the number behind it in [low, high]. False: not so.
static bool split(const char *const address, const size_t size, char head[], const long low,
                  const long high, long *const number)
{
    const char *const colon = strrchr(address, ':');
    if (colon == NULL || colon == address || (size_t)(colon - address) >= size) {
        return false;
    }
    char      *end   = NULL;
    const long found = strtol(colon + 1, &end, 10);
    if (end == colon + 1 || *end != '\0' || found < low || found > high) {
        return false;
    }
    memcpy(head, address, (size_t)(colon - address));
    head[colon - address] = '\0';
    *number               = found;
    return true;
}

enum dig_status dig_rig_modbus_start_tcp(const char *const           address,
                                         struct dig_rig_board *const board, const size_t size,
                                         char where[], struct dig_rig_modbus **const server,
                                         struct dig_error *const error)
{
    char           host[64];
    long           port = 0;
    struct in_addr ip;
    if (!split(address, sizeof host, host, 0, 65535, &port) || inet_pton(AF_INET, host, &ip) != 1) {
        return dig_error_set(error, DIG_EINVAL,
                             "--modbus-tcp %s: expected IPV4:PORT, as 127.0.0.1:1502", address);
    }
    struct dig_rig_modbus *const made = create(board, modbus_new_tcp(host, (int)port));
    if (made == NULL) {
        return dig_error_set(error, DIG_ENOMEM, "%s: %s", address, modbus_strerror(errno));
    }
    made->listening = modbus_tcp_listen(made->context, DIG_RIG_CLIENTS_MAX);
    struct sockaddr_in bound;
    socklen_t          length = sizeof bound;
    if (made->listening < 0 || fcntl(made->listening, F_SETFL, O_NONBLOCK) != 0 ||
        getsockname(made->listening, (struct sockaddr *)&bound, &length) != 0) {
        const int why = errno;
        destroy(made);
        return dig_error_set(error, DIG_EIO, "%s: cannot listen: %s", address,
                             modbus_strerror(why));
    }
    const enum dig_status status = start(made, serve_tcp, address, error);
    if (status == DIG_OK) {
        (void)snprintf(where, size, "Modbus TCP on %s:%u", host, (unsigned)ntohs(bound.sin_port));
        *server = made;
    }
    return status;
}

enum dig_status dig_rig_modbus_start_rtu(const char *const           address,
                                         struct dig_rig_board *const board, const size_t size,
                                         char where[], struct dig_rig_modbus **const server,
                                         struct dig_error *const error)
{
    char device[PATH_MAX];
    long baud = 115200;
    if (!split(address, sizeof device, device, 300, 4000000, &baud)) {
        // Without a baud rate, or a device name that holds a colon.
        if (snprintf(device, sizeof device, "%s", address) >= (int)sizeof device) {
            return dig_error_set(error, DIG_EINVAL, "--modbus-rtu: name too long");
        }
    }
    struct dig_rig_modbus *const made = create(board, modbus_new_rtu(device, (int)baud, 'N', 8, 1));
    if (made == NULL) {
        return dig_error_set(error, DIG_EIO, "--modbus-rtu: %s: %s", address,
                             modbus_strerror(errno));
    }
    if (modbus_set_slave(made->context, DIG_RIG_UNIT) != 0 || !open_line(made)) {
        const int why = errno;
        destroy(made);
        return dig_error_set(error, DIG_EIO, "--modbus-rtu: %s: cannot open: %s", device,
                             modbus_strerror(why));
    }
    const enum dig_status status = start(made, serve_rtu, address, error);
    if (status == DIG_OK) {
        (void)snprintf(where, size, "Modbus RTU slave %d on %s, %ld baud", DIG_RIG_UNIT, device,
                       baud);
        *server = made;
    }
    return status;
}

void dig_rig_modbus_join(struct dig_rig_modbus *const   server,
                         struct dig_rig_requests *const requests)
{
    if (server == NULL) {
        return;
    }
    (void)pthread_join(server->thread, NULL);
    for (int f = 0; f < 256; f++) {
        requests->served[f] += server->requests.served[f];
        requests->refused[f] += server->requests.refused[f];
    }
    requests->unanswered += server->requests.unanswered;
    requests->excepted += server->requests.excepted;
    requests->damaged += server->requests.damaged;
    requests->clients += server->requests.clients;
    destroy(server);
}
