/* The dock's state.  Each part has one owner, the file of its name, which alone
 * writes it; the others call the owner or read.  Calls run one way:
 *
 *   dock.c -> link.c -> link_*.c -> look, decision, lamps, requests,
 *   settings */
#ifndef DOCK_STATE_H
#define DOCK_STATE_H

#include "decision.h"
#include "lamps.h"
#include "link.h"
#include "look.h"
#include "requests.h"
#include "settings.h"

/* What became of the settings that flash held. */
typedef enum {
    DOCK_STORED_WHOLE,    /* all in use; or none was ever saved */
    DOCK_STORED_RESTORED, /* one copy was damaged, the other one is in use */
    DOCK_STORED_IN_PART,  /* a value was out of range: its default is in use */
    DOCK_STORED_LOST,     /* no copy can be read: the defaults are in use */
} dock_stored_t;

/* What the board knows of itself, told once after dock_init. */
typedef struct {
    uint8_t reset_reason;   /* as the chip counts */
    dock_stored_t settings; /* whole again once they are saved */
    uint8_t git_hash[8];    /* ASCII, first letters of the commit */
    uint8_t *buffer;   /* for a snapshot or an injected frame; NULL: none */
    uint32_t capacity; /* of it, bytes; even address */
    uint64_t uid;      /* of the chip, no two alike; 0: not known */
} dock_board_t;

/* What the camera is set to now, read back from the sensor. */
typedef struct {
    uint16_t exposure;
    uint8_t gain;
    bool locked;     /* it reads back the values that were set */
    bool proven;     /* and its picture was seen to follow them */
    uint16_t sensor; /* product number of its chip; 0: none */
} dock_camera_t;

typedef struct {
    dock_settings_t settings; /* changed by link_settings.c alone */
    dock_board_t board;       /* dock.c, but for what the buffer holds */
    dock_camera_t camera;     /* dock.c */
    uint32_t camera_faults;   /* dock.c: times that the camera gave no frame */
    bool camera_lost;         /* dock.c: whether it gave none the last time */
    decision_t decision;
    look_t look;
    lamps_t lamps;
    requests_t requests;
    link_t link;
} dock_t;

#endif
