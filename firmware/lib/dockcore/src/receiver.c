#include "receiver.h"

#include <string.h>

#include "messages.h"

#define HEADER_1 6
#define HEADER_2 10
#define CHECKSUM 2
#define SIGNATURE 13
#define SIGNED 0x01      /* the one incompatibility flag there is */
#define MOST_IDS 0x10000 /* no dialect has a higher one; noise mostly has */

/* What the header of a message says, if it is one. */
typedef struct {
    uint32_t id;
    uint8_t system, component, flags;
    size_t header, end, whole; /* where payload, checksum, and the next begin */
} shape_t;

static bool is_start(uint8_t byte)
{
    return byte == MAVLINK_STX || byte == MAVLINK_STX_MAVLINK1;
}

static void drop(receiver_t *receiver, size_t n)
{
    receiver->length = (uint16_t)(receiver->length - n);
    memmove(receiver->bytes, receiver->bytes + n, receiver->length);
}

/* Of the message that starts at the front; false before its header is there. */
static bool read_shape(const receiver_t *receiver, shape_t *shape)
{
    const uint8_t *bytes = receiver->bytes;
    const bool second = receiver->length > 0 && bytes[0] == MAVLINK_STX;
    *shape = (shape_t){.header = second ? HEADER_2 : HEADER_1};
    if (receiver->length < shape->header)
        return false;
    shape->end = shape->header + bytes[1];
    shape->whole = shape->end + CHECKSUM;
    const uint8_t *sender = bytes + (second ? 5 : 3);
    shape->system = sender[0];
    shape->component = sender[1];
    shape->id = sender[2];
    if (!second)
        return true;
    shape->flags = bytes[2];
    shape->id |= (uint32_t)bytes[8] << 8 | (uint32_t)bytes[9] << 16;
    if ((shape->flags & SIGNED) != 0)
        shape->whole += SIGNATURE;
    return true;
}

/* What waits for its end will not get it.  One that waits only for what follows
 * is whole. */
static void give_up(receiver_t *receiver)
{
    shape_t shape;
    const bool whole =
        read_shape(receiver, &shape) && receiver->length == shape.whole;
    drop(receiver, whole ? shape.whole : 1);
}

size_t receiver_put(receiver_t *receiver, const uint8_t *bytes, size_t n,
                    uint32_t now_ms)
{
    if (receiver->length > 0 &&
        now_ms - receiver->last_ms > RECEIVER_PATIENCE_MS)
        give_up(receiver);
    const size_t room = RECEIVER_CAPACITY - (size_t)receiver->length;
    const size_t taken = n < room ? n : room;
    if (taken > 0) {
        memcpy(receiver->bytes + receiver->length, bytes, taken);
        receiver->length = (uint16_t)(receiver->length + taken);
        receiver->last_ms = now_ms;
    }
    return taken;
}

/* Brings the next byte that may start a message to the front. */
static void seek(receiver_t *receiver)
{
    size_t at = 0;
    while (at < receiver->length && !is_start(receiver->bytes[at]))
        at++;
    drop(receiver, at);
}

/* Whether the header is one that noise and halves of messages hardly make,
 * though nobody here knows the id.  Version 1 has too short a one to tell.  An
 * id beyond two bytes is in no dialect, and in most noise; one with a start
 * byte in it is of a message that was cut short, with the next one behind it.
 */
static bool is_plausible(const shape_t *shape)
{
    return shape->header == HEADER_2 && (shape->flags & ~SIGNED) == 0 &&
           shape->id < MOST_IDS && !is_start((uint8_t)shape->id) &&
           !is_start((uint8_t)(shape->id >> 8));
}

typedef enum { FRONT_OPEN, FRONT_MESSAGE, FRONT_FOREIGN, FRONT_NONE } front_t;

/* What stands at the front: a message that is to be read, a whole one that
 * nobody knows, none at all, or what the bytes so far do not tell. */
static front_t judge(const receiver_t *receiver, const shape_t *shape,
                     int extra)
{
    const uint8_t *bytes = receiver->bytes;
    if (extra < 0 && !is_plausible(shape))
        return FRONT_NONE;
    if (receiver->length < shape->whole)
        return FRONT_OPEN;
    if (extra >= 0) {
        const uint16_t sum =
            (uint16_t)(bytes[shape->end] | bytes[shape->end + 1] << 8);
        return message_checksum(bytes, shape->end, (uint8_t)extra) == sum
                   ? FRONT_MESSAGE
                   : FRONT_NONE;
    }
    if (receiver->length == shape->whole)
        return FRONT_OPEN;
    return is_start(bytes[shape->whole]) ? FRONT_FOREIGN : FRONT_NONE;
}

bool receiver_next(receiver_t *receiver, int (*crc_extra)(uint32_t id),
                   received_t *message)
{
    shape_t shape;
    for (seek(receiver); read_shape(receiver, &shape); seek(receiver)) {
        const int extra =
            (shape.flags & ~SIGNED) == 0 ? crc_extra(shape.id) : -1;
        switch (judge(receiver, &shape, extra)) {
        case FRONT_OPEN:
            return false;
        case FRONT_MESSAGE:
            *message = (received_t){shape.id, shape.system, shape.component,
                                    receiver->bytes[1],
                                    receiver->bytes + shape.header};
            return true;
        case FRONT_FOREIGN:
            drop(receiver, shape.whole);
            break;
        case FRONT_NONE:
            receiver->rejected += extra >= 0;
            drop(receiver, 1);
            break;
        }
    }
    return false;
}

void receiver_done(receiver_t *receiver)
{
    shape_t shape;
    read_shape(receiver, &shape);
    drop(receiver, shape.whole);
}
