#include "messages.h"

#include <chromadock/crc_extras.h>
#include <string.h>

#define HEADER 10

static const uint16_t ids[] = MAVLINK_CRC_IDS;
static const uint8_t extras[] = MAVLINK_CRC_EXTRAS;

int message_crc_extra(uint32_t id)
{
    size_t first = 0, end = sizeof extras;
    while (first < end) {
        const size_t middle = (first + end) / 2;
        if (ids[middle] == id)
            return extras[middle];
        if (ids[middle] < id)
            first = middle + 1;
        else
            end = middle;
    }
    return -1;
}

bool message_send(sender_t *sender, uint32_t id, uint8_t crc_extra,
                  const void *payload, uint8_t length)
{
    const uint8_t *from = payload;
    while (length > 1 && from[length - 1] == 0) /* MAVLink 2 cuts zeros off */
        length--;
    const size_t whole = HEADER + (size_t)length + 2;
    if (whole > sender->capacity - sender->length)
        return false;
    uint8_t *to = sender->bytes + sender->length;
    const uint8_t header[HEADER] = {
        MAVLINK_STX,
        length,
        0,
        0,
        (*sender->sequence)++,
        sender->system,
        DOCK_ID_COMPONENT,
        (uint8_t)id,
        (uint8_t)(id >> 8),
        (uint8_t)(id >> 16),
    };
    memcpy(to, header, HEADER);
    memcpy(to + HEADER, payload, length);
    const uint16_t sum =
        message_checksum(to, HEADER + (size_t)length, crc_extra);
    to[HEADER + length] = (uint8_t)sum;
    to[HEADER + length + 1] = (uint8_t)(sum >> 8);
    sender->length += whole;
    return true;
}

void message_read(void *payload, size_t size, const received_t *message)
{
    memset(payload, 0, size);
    memcpy(payload, message->payload,
           message->length < size ? message->length : size);
}
