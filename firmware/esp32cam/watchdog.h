/* The task watchdog over the colour task. */
#ifndef WATCHDOG_H
#define WATCHDOG_H

/* The longest honest silence is a camera that settles on slow frames (10 s) and
 * then gives none (4 s) and starts anew. */
enum { WATCHDOG_SECONDS = 20 };

/* Watches the task that calls this; it resets the chip. */
void watchdog_start();

/* Only where a frame was decided on, or the want of one reported. */
void watchdog_feed();

#endif
