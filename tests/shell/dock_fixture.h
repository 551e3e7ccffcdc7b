/* The whole firmware on the fake board: both tasks, turn by turn. */
#ifndef DOCK_FIXTURE_H
#define DOCK_FIXTURE_H

#include "camera_fixture.h"

/* Pure green water: the marker is blue. */
inline void paint_water()
{
    paint(0, 40, 0);
}

/* Power on, to the end of setup(), on the board as it has been prepared. */
inline void start_dock()
{
    camera = Camera();
    colour = Loop(&dock);
    board.while_waiting = loop;
    init_arduino();
    setup();
}

inline void start_fresh_dock()
{
    board_reset();
    paint_water();
    start_dock();
}

inline void turn_both()
{
    camera_turn();
    loop();
}

inline void run_for(int64_t ms)
{
    const int64_t end = now_ms() + ms;
    while (now_ms() < end)
        turn_both();
}

inline void run_to_first_frame()
{
    while (!dock.decision.decided && now_ms() < 60000)
        turn_both();
    TEST_ASSERT_TRUE(dock.decision.decided);
}

inline void request(dock_request_t what)
{
    if (what == DOCK_REQUEST_SAVE)
        requests_save(&dock.requests);
    else if (what == DOCK_REQUEST_CAMERA)
        requests_camera(&dock.requests);
    else
        requests_reboot(&dock.requests);
}

#endif
