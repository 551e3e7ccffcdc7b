#include "receiver.h"

#include <string.h>

#include "messages.h"

#define HEADER 10
#define CHECKSUM 2
#define SIGNATURE 13
#define SIGNED 0x01 /* the one incompatibility flag there is */

static void drop(receiver_t *receiver, size_t n)
{
    receiver->length = (uint16_t)(receiver->length - n);
    memmove(receiver->bytes, receiver->bytes + n, receiver->length);
}

size_t receiver_put(receiver_t *receiver, const uint8_t *bytes, size_t n,
                    uint32_t now_ms)
{
    if (receiver->length > 0 &&
        now_ms - receiver->last_ms > RECEIVER_PATIENCE_MS)
        drop(receiver, 1);
    const size_t room = RECEIVER_CAPACITY - (size_t)receiver->length;
    const size_t taken = n < room ? n : room;
    if (taken > 0) {
        memcpy(receiver->bytes + receiver->length, bytes, taken);
        receiver->length = (uint16_t)(receiver->length + taken);
        receiver->last_ms = now_ms;
    }
    return taken;
}

static size_t whole_length(const uint8_t *bytes)
{
    return HEADER + (size_t)bytes[1] + CHECKSUM +
           ((bytes[2] & SIGNED) != 0 ? SIGNATURE : 0);
}

static uint32_t id_of(const uint8_t *bytes)
{
    return bytes[7] | (uint32_t)bytes[8] << 8 | (uint32_t)bytes[9] << 16;
}

/* Brings the next byte that may start a message to the front. */
static void seek(receiver_t *receiver)
{
    const uint8_t *start =
        memchr(receiver->bytes, MAVLINK_STX, receiver->length);
    if (start == NULL)
        receiver->length = 0;
    else
        drop(receiver, (size_t)(start - receiver->bytes));
}

bool receiver_next(receiver_t *receiver, int (*crc_extra)(uint32_t id),
                   received_t *message)
{
    const uint8_t *bytes = receiver->bytes;
    for (seek(receiver); receiver->length >= HEADER; seek(receiver)) {
        const int extra = crc_extra(id_of(bytes));
        if ((bytes[2] & ~SIGNED) != 0 || extra < 0) {
            drop(receiver, 1);
            continue;
        }
        if (receiver->length < whole_length(bytes))
            return false;
        const size_t end = HEADER + (size_t)bytes[1];
        const uint16_t sum = (uint16_t)(bytes[end] | bytes[end + 1] << 8);
        if (message_checksum(bytes, end, (uint8_t)extra) == sum) {
            *message = (received_t){id_of(bytes), bytes[5], bytes[6], bytes[1],
                                    bytes + HEADER};
            return true;
        }
        receiver->rejected++;
        drop(receiver, 1);
    }
    return false;
}

void receiver_done(receiver_t *receiver)
{
    drop(receiver, whole_length(receiver->bytes));
}
