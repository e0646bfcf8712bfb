#include "tools/rig/bus/board.h"

#include <string.h>

bool dig_rig_board_init(struct dig_rig_board *const        board,
                        const struct dig_rig_faults *const faults)
{
    memset(board, 0, sizeof *board);
    board->faults = faults;
    if (pthread_mutex_init(&board->lock, NULL) != 0) {
        return false;
    }
    if (pthread_cond_init(&board->begun, NULL) != 0) {
        (void)pthread_mutex_destroy(&board->lock);
        return false;
    }
    return true;
}

void dig_rig_board_finish(struct dig_rig_board *const board)
{
    (void)pthread_cond_destroy(&board->begun);
    (void)pthread_mutex_destroy(&board->lock);
}

void dig_rig_board_write(struct dig_rig_board *const board,
                         const uint16_t registers[DIG_RIG_REGISTERS], const double time_s)
{
    (void)pthread_mutex_lock(&board->lock);
    memcpy(board->registers, registers, sizeof board->registers);
    board->time_s  = time_s;
    board->written = true;
    (void)pthread_cond_broadcast(&board->begun);
    (void)pthread_mutex_unlock(&board->lock);
}

double dig_rig_board_read(struct dig_rig_board *const board, uint16_t registers[DIG_RIG_REGISTERS])
{
    (void)pthread_mutex_lock(&board->lock);
    while (!board->written && !board->stop) {
        (void)pthread_cond_wait(&board->begun, &board->lock);
    }
    memcpy(registers, board->registers, sizeof board->registers);
    const double time_s = board->time_s;
    (void)pthread_mutex_unlock(&board->lock);
    return time_s;
}

void dig_rig_board_stop(struct dig_rig_board *const board)
{
    (void)pthread_mutex_lock(&board->lock);
    board->stop = true;
    (void)pthread_cond_broadcast(&board->begun);
    (void)pthread_mutex_unlock(&board->lock);
}

bool dig_rig_board_is_stopped(struct dig_rig_board *const board)
{
    (void)pthread_mutex_lock(&board->lock);
    const bool stop = board->stop;
    (void)pthread_mutex_unlock(&board->lock);
    return stop;
}
