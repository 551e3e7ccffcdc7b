/* The state of the MAVLink 2 link, part of dock_t: what came in half, what is
 * still to go out.  Messages are described in shared/chromadock.xml. */
#ifndef LINK_H
#define LINK_H

#include <stdbool.h>
#include <stdint.h>

#include "receiver.h"

#define LINK_TEXT_LENGTH 50
#define LINK_TEXTS 4
#define LINK_ACKS 4

typedef struct {
    uint8_t severity;
    char text[LINK_TEXT_LENGTH];
} link_text_t;

typedef struct {
    uint16_t command;
    uint8_t result;
    uint8_t system, component; /* who asked */
} link_ack_t;

/* An image in packets: a snapshot on its way out, a frame on its way in. */
typedef struct {
    uint32_t size; /* bytes; 0: no transfer */
    uint16_t next; /* packet to send, or expected */
    uint16_t width, height;
    uint8_t type;   /* MAVLINK_DATA_STREAM_TYPE */
    bool announced; /* the handshake is out */
} transfer_t;

typedef struct {
    receiver_t receiver;
    uint8_t sequence;
    uint32_t faults;                  /* messages with bad contents */
    uint32_t heartbeat_ms, status_ms; /* when last sent */
    bool heartbeat_sent, status_sent; /* once */
    bool version_due, status_due;
    uint32_t parameters_due; /* a bit each */
    link_text_t texts[LINK_TEXTS];
    uint8_t text_count;
    link_ack_t acks[LINK_ACKS];
    uint8_t ack_count;
    link_ack_t save_ack; /* answered when the board has saved */
    bool saving;
    bool snapshot_wanted;
    transfer_t snapshot, injected;
    bool injecting; /* the camera's frames are passed over */
    uint32_t injected_ms;
} link_t;

#endif
