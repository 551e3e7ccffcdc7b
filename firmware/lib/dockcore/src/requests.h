/* What only the board can do, and what became of it.
 *
 * Only requests.c writes the fields; everybody may read them. */
#ifndef REQUESTS_H
#define REQUESTS_H

#include <stdbool.h>
#include <stdint.h>

typedef enum {
    DOCK_REQUEST_NONE,
    DOCK_REQUEST_SAVE,   /* write settings_to_blob to flash, then dock_saved */
    DOCK_REQUEST_CAMERA, /* apply settings.camera */
    DOCK_REQUEST_REBOOT, /* once all bytes of dock_transmit are out */
} dock_request_t;

typedef enum {
    SAVE_NONE,    /* nothing to write */
    SAVE_WANTED,  /* a host asked; the board has not been told yet */
    SAVE_WRITING, /* the board was told and has not answered yet */
} save_t;

typedef struct {
    save_t save;
    bool camera; /* new camera settings wait for the board */
    bool reboot; /* a restart waits for the board */
    bool failed; /* whether the last save did not reach the flash */
} requests_t;

/* Asks for the settings to be written.  Asked again before that is done, it is
 * the same save. */
void requests_save(requests_t *requests);

void requests_camera(requests_t *requests);

void requests_reboot(requests_t *requests);

/* The next thing to do, and forgets it.  A restart waits for all else, and
 * until `answered` says that no host waits for an answer any more. */
dock_request_t requests_take(requests_t *requests, bool answered);

/* Takes the board's answer.  Returns false where nobody had asked. */
bool requests_saved(requests_t *requests, bool written);

#endif
