/* The state of the MAVLink 2 link, part of dock_t: what came in half, what is
 * still to go out.  Messages are described in shared/chromadock.xml.
 *
 * Each struct here is written by one file, which its comment names. */
#ifndef LINK_H
#define LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "receiver.h"

#define LINK_TEXT_LENGTH 50
#define LINK_TEXTS 4
#define LINK_ACKS 4

/* link_texts.c: lines for the person at the ground station, oldest first. */
typedef struct {
    struct {
        uint8_t severity;
        char text[LINK_TEXT_LENGTH];
    } waiting[LINK_TEXTS];
    uint8_t count;
} link_texts_t;

/* The answer to a command, and whom it goes to. */
typedef struct {
    uint16_t command;
    uint8_t result;
    uint8_t system, component;
} link_ack_t;

/* link_acks.c: answers to commands, oldest first. */
typedef struct {
    link_ack_t waiting[LINK_ACKS];
    uint8_t count;
    link_ack_t save; /* goes out when the board has saved, with its result;
                        command 0: nobody waits for that */
} link_acks_t;

/* Messages that the dock sends by the clock or when it is asked. */
typedef enum {
    REPORT_HEARTBEAT,
    REPORT_VERSION,
    REPORT_STATUS,
    REPORT_INTERVAL,
    REPORTS
} report_t;

typedef enum {
    REPORT_NEVER_SENT, /* due at once if it has a period at all */
    REPORT_SENT,       /* due one period after it was sent */
    REPORT_DUE,        /* due now, whatever its period */
} report_state_t;

#define REPORT_OFF UINT32_MAX

/* link_reports.c */
typedef struct {
    report_state_t state;
    uint32_t sent_ms;   /* when it was sent last */
    uint32_t period_ms; /* as a host wants it; 0: as the settings say it;
                           REPORT_OFF: only when it is asked for */
} link_report_t;

/* The frame that a transfer carries, as its handshake describes it. */
typedef struct {
    uint32_t size; /* bytes */
    uint16_t width, height;
    uint8_t type;   /* MAVLINK_DATA_STREAM_TYPE */
    uint8_t number; /* of a snapshot, 1 to 255; 0 of an injected frame */
} link_image_t;

typedef enum {
    SNAPSHOT_NONE,
    SNAPSHOT_WANTED,  /* waits for the camera's next good frame */
    SNAPSHOT_KEPT,    /* was sent, and is in the board's buffer yet */
    SNAPSHOT_TAKEN,   /* in the board's buffer; its handshake is due */
    SNAPSHOT_SENDING, /* its packets are due from `next` to before `end` */
} snapshot_state_t;

/* link_snapshot.c: a frame of the camera on its way out. */
typedef struct {
    snapshot_state_t state;
    link_image_t image; /* of the newest snapshot */
    uint16_t next, end;
    uint32_t asked_ms; /* when a host wanted one */
} link_snapshot_t;

typedef enum {
    INJECTION_OFF,       /* the camera's frames count */
    INJECTION_IDLE,      /* they are passed over; no frame is announced */
    INJECTION_ANNOUNCED, /* packet `next` is expected, an echo is due */
    INJECTION_RECEIVING, /* packet `next` is expected */
} injection_state_t;

/* link_injection.c: frames that the host sends in place of the camera's. */
typedef struct {
    injection_state_t state;
    link_image_t image;
    uint16_t next;
    uint32_t heard_ms; /* when the host's last handshake or packet came */
} link_injection_t;

/* The ways in which a parameter's value goes out, those first that are sent
 * first. */
typedef enum {
    VALUE_FLOAT,     /* PARAM_VALUE, a float */
    VALUE_WHOLE,     /* PARAM_VALUE, a whole number as an integer */
    VALUE_TYPED_ACK, /* PARAM_EXT_ACK, to PARAM_EXT_SET */
    VALUE_TYPED,     /* PARAM_EXT_VALUE */
    VALUE_FORMS
} value_form_t;

/* link_values.c: which parameters are to be sent, and whose turn it is. */
typedef struct {
    uint32_t due; /* a bit each */
    uint8_t next;
} link_turn_t;

/* link_parameters.c, but for the turns; a bit for each parameter. */
typedef struct {
    link_turn_t turns[VALUE_FORMS];
    uint32_t refused; /* what PARAM_EXT_ACK says of the last PARAM_EXT_SET */
    uint32_t floats;  /* MAVSDK set it as a float, and reads it as one */
} link_parameters_t;

typedef struct {
    uint8_t system;      /* dock.c: MAVLink's, until the next start */
    receiver_t receiver; /* link.c */
    uint8_t sequence;    /* link.c: number of the next message out */
    uint32_t faults;     /* link_count_fault: messages refused */
    link_parameters_t parameters;
    uint16_t interval_of; /* link_reports.c: the message whose interval a
                             host wants to know */
    link_texts_t texts;
    link_acks_t acks;
    link_report_t reports[REPORTS];
    link_snapshot_t snapshot;
    link_injection_t injection;
} link_t;

#endif
