#include "tools/rig/bus/board.h"

#include <string.h>

bool dig_rig_board_init(struct dig_rig_board *const board)
{
    memset(board, 0, sizeof *board);
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
                         const uint16_t registers[DIG_RIG_REGISTERS], const bool silent)
{
    (void)pthread_mutex_lock(&board->lock);
    memcpy(board->registers, registers, sizeof board->registers);
    board->silent  = silent;
    board->written = true;
    (void)pthread_cond_broadcast(&board->begun);
    (void)pthread_mutex_unlock(&board->lock);
}

bool dig_rig_board_read(struct dig_rig_board *const board, uint16_t registers[DIG_RIG_REGISTERS])
{
    (void)pthread_mutex_lock(&board->lock);
    while (!board->written && !board->stop) {
        (void)pthread_cond_wait(&board->begun, &board->lock);
    }
    memcpy(registers, board->registers, sizeof board->registers);
    const bool silent = board->silent;
    (void)pthread_mutex_unlock(&board->lock);
    return silent;
}

void dig_rig_board_behave(struct dig_rig_board *const        board,
                          const struct dig_rig_manner *const manner)
{
    (void)pthread_mutex_lock(&board->lock);
    board->manner = *manner;
    (void)pthread_mutex_unlock(&board->lock);
}

struct dig_rig_manner dig_rig_board_manner(struct dig_rig_board *const board)
{
    (void)pthread_mutex_lock(&board->lock);
    const struct dig_rig_manner manner = board->manner;
    (void)pthread_mutex_unlock(&board->lock);
    return manner;
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
