/* The task watchdog over the colour task. */
#ifndef WATCHDOG_H
#define WATCHDOG_H

/* The longest honest silence is a camera whose frames come just before the
 * driver would give up on them, every 4 s: it settles (10 s and a frame), is
 * checked (4 s and a frame), and three more frames are dropped. */
enum { WATCHDOG_SECONDS = 40 };

/* Watches the task that calls this; it resets the chip. */
void watchdog_start();

/* Only where a frame was decided on, or the want of one reported. */
void watchdog_feed();

#endif
