// Polls the rig's Modbus server for a system test: rig_poll PORT|DEVICE SECONDS
// One line per poll that brought a new alive counter: the twelve registers, comma separated. A
// reply that does not come is asked for again; a connection that ends, ends it.

#include <errno.h>
#include <modbus/modbus.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { REGISTERS = 12 };

static double now_s(void)
{
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int main(const int argc, char *argv[])
{
    if (argc != 3) {
        return 2;
    }
    const bool      line   = argv[1][0] == '/';
    modbus_t *const client = line ? modbus_new_rtu(argv[1], 115200, 'N', 8, 1)
                                  : modbus_new_tcp("127.0.0.1", (int)strtol(argv[1], NULL, 10));
    if (client == NULL || modbus_set_slave(client, 1) != 0 || modbus_connect(client) != 0) {
        (void)fprintf(stderr, "cannot connect\n");
        return 1;
    }
    (void)modbus_set_error_recovery(client, MODBUS_ERROR_RECOVERY_PROTOCOL);
    const double end_s = now_s() + strtod(argv[2], NULL);
    int          last  = -1;
    while (now_s() < end_s) {
        uint16_t registers[REGISTERS];
        if (modbus_read_input_registers(client, 0, REGISTERS, registers) != REGISTERS) {
            if (errno == ETIMEDOUT || errno > MODBUS_ENOBASE) {
                continue;
            }
            break;
        }
        if (registers[0] != last) {
            last = registers[0];
            for (int i = 0; i < REGISTERS; i++) {
                (void)printf("%s%u", i == 0 ? "" : ",", (unsigned)registers[i]);
            }
            (void)printf("\n");
        }
        const struct timespec wait = { 0, 2000000 };
        (void)nanosleep(&wait, NULL);
    }
    modbus_close(client);
    modbus_free(client);
    return 0;
}
