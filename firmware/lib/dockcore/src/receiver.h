/* Finds MAVLink messages, of version 2 and 1, in a stream that may hold
 * anything else: boot text, driver text, noise, halves of messages.
 *
 * A whole message is passed over with everything in it, for what it carries may
 * look like a message: a tunnel, or the file of a log.  The checksum tells that
 * it is whole.  Of a message whose id nobody here knows it cannot be computed;
 * such a one, of version 2, counts as whole where another message or silence
 * follows right behind it.  A damaged message costs itself and nothing more:
 * the search goes on one byte after its start. */
#ifndef RECEIVER_H
#define RECEIVER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* 10 header, 255 payload, 2 checksum, 13 signature, 1 of what follows. */
#define RECEIVER_CAPACITY 281

/* What follows a false start for so long without an end was no message. */
#define RECEIVER_PATIENCE_MS 200

typedef struct {
    uint8_t bytes[RECEIVER_CAPACITY];
    uint16_t length;
    uint32_t last_ms;  /* when the newest byte came */
    uint32_t rejected; /* messages with a wrong checksum */
} receiver_t;

typedef struct {
    uint32_t id;
    uint8_t system, component; /* of the sender */
    uint8_t length;
    const uint8_t *payload; /* zeros at its end may have been cut off */
} received_t;

/* Takes as many of the `n` bytes as fit and returns how many.  To be called
 * with none, too: a message that nobody finishes is given up by the clock. */
size_t receiver_put(receiver_t *receiver, const uint8_t *bytes, size_t n,
                    uint32_t now_ms);

/* The next message, which stays until receiver_done; false where more bytes are
 * needed.  `crc_extra` returns what a message's checksum begins with, or -1 for
 * an id that it does not know. */
bool receiver_next(receiver_t *receiver, int (*crc_extra)(uint32_t id),
                   received_t *message);

/* Drops the message that receiver_next gave. */
void receiver_done(receiver_t *receiver);

#endif
