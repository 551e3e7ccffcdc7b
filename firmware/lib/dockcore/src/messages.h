/* mavgen's structs and numbers, and what dockcore makes of them itself: a
 * message's frame needs no tables and no static channels. */
#ifndef MESSAGES_H
#define MESSAGES_H

/* Angles, by floating point: nothing for a dock. */
#define MAVLINK_NO_CONVERSION_HELPERS
#include <chromadock/mavlink.h>

#include "receiver.h"

/* Of the `n` bytes of header and payload, the start byte left out. */
static inline uint16_t message_checksum(const uint8_t *bytes, size_t n,
                                        uint8_t crc_extra)
{
    uint16_t sum;
    crc_init(&sum);
    for (size_t i = 1; i < n; i++)
        crc_accumulate(bytes[i], &sum);
    crc_accumulate(crc_extra, &sum);
    return sum;
}

/* What the checksum of a message begins with; -1 for an id that neither
 * MAVLink's common messages nor the dock's own have. */
int message_crc_extra(uint32_t id);

/* Where messages go: a buffer that takes whole messages only. */
typedef struct {
    uint8_t *bytes;
    size_t length, capacity;
    uint8_t *sequence;
    uint8_t system; /* whose messages they are */
} sender_t;

/* False, nothing written, where it does not fit.  The payload is mavgen's
 * struct, which has the layout of the wire. */
bool message_send(sender_t *sender, uint32_t id, uint8_t crc_extra,
                  const void *payload, uint8_t length);

#define MESSAGE_SEND(sender, NAME, payload)                                  \
    message_send(sender, MAVLINK_MSG_ID_##NAME, MAVLINK_MSG_ID_##NAME##_CRC, \
                 payload, MAVLINK_MSG_ID_##NAME##_LEN)

/* The struct of a message, the zeros at its end put back. */
void message_read(void *payload, size_t size, const received_t *message);

#endif
