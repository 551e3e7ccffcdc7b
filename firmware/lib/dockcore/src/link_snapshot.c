#include <string.h>

#include "link_parts.h"

/* For so long a wish waits for a frame: who asked has given up then, and a
 * picture that nobody expects would keep others from the buffer. */
#define WISH_MS 5000

bool link_want_snapshot(link_t *link, uint32_t now_ms)
{
    if (link_is_injecting(link))
        return false;
    link->snapshot.state = SNAPSHOT_WANTED;
    link->snapshot.asked_ms = now_ms;
    return true;
}

bool link_repeat_snapshot(link_t *link, int64_t number, int64_t first,
                          int64_t count)
{
    link_snapshot_t *snapshot = &link->snapshot;
    if (snapshot->state < SNAPSHOT_KEPT || number != snapshot->image.number ||
        first < 0 || count < 1 ||
        first + count > link_packets_of(snapshot->image.size))
        return false;
    snapshot->next = (uint16_t)first;
    snapshot->end = (uint16_t)(first + count);
    if (snapshot->state == SNAPSHOT_KEPT)
        snapshot->state = SNAPSHOT_SENDING;
    return true;
}

void link_forget_snapshot(link_t *link)
{
    if (link->snapshot.state >= SNAPSHOT_KEPT)
        link->snapshot.state = SNAPSHOT_NONE;
}

void link_expire_snapshot(link_t *link, uint32_t now_ms)
{
    link_snapshot_t *snapshot = &link->snapshot;
    if (snapshot->state != SNAPSHOT_WANTED ||
        now_ms - snapshot->asked_ms <= WISH_MS)
        return;
    snapshot->state = SNAPSHOT_NONE;
    link_say_words(link, MAV_SEVERITY_WARNING,
                   "no snapshot: the camera gave no frame for 5 s");
}

void link_take_snapshot(dock_t *dock, const frame_t *frame, uint32_t now_ms)
{
    link_snapshot_t *snapshot = &dock->link.snapshot;
    link_expire_snapshot(&dock->link, now_ms);
    if (snapshot->state != SNAPSHOT_WANTED || link_is_injecting(&dock->link))
        return;
    if (frame->length > dock->board.capacity) {
        snapshot->state = SNAPSHOT_NONE;
        link_say_words(&dock->link, MAV_SEVERITY_WARNING,
                       "no snapshot: the frame is too large");
        return;
    }
    memcpy(dock->board.buffer, frame->bytes, frame->length);
    snapshot->state = SNAPSHOT_TAKEN;
    snapshot->image = (link_image_t){
        .size = (uint32_t)frame->length,
        .width = frame->width,
        .height = frame->height,
        .type = frame->format == FRAME_RGB888 ? MAVLINK_DATA_STREAM_IMG_RAW32U
                                              : MAVLINK_DATA_STREAM_IMG_RAW8U,
        .number = (uint8_t)(snapshot->image.number % UINT8_MAX + 1),
    };
    snapshot->next = 0;
    snapshot->end = link_packets_of(snapshot->image.size);
}

static bool send_packet(const dock_t *dock, uint16_t number, sender_t *sender)
{
    const uint32_t at = (uint32_t)number * PACKET;
    const uint32_t left = dock->link.snapshot.image.size - at;
    mavlink_encapsulated_data_t packet;
    memset(&packet, 0, sizeof packet);
    packet.seqnr = number;
    memcpy(packet.data, dock->board.buffer + at, left < PACKET ? left : PACKET);
    return MESSAGE_SEND(sender, ENCAPSULATED_DATA, &packet);
}

bool link_send_snapshot(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    link_snapshot_t *snapshot = &dock->link.snapshot;
    if (snapshot->state == SNAPSHOT_TAKEN) {
        if (!link_send_handshake(sender, &snapshot->image))
            return false;
        snapshot->state = SNAPSHOT_SENDING;
    }
    if (snapshot->state != SNAPSHOT_SENDING)
        return true;
    for (; snapshot->next < snapshot->end; snapshot->next++)
        if (!send_packet(dock, snapshot->next, sender))
            return false;
    snapshot->state = SNAPSHOT_KEPT;
    return true;
}
