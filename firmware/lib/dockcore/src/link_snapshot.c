#include <string.h>

#include "link_parts.h"

bool link_holds_snapshot(const link_t *link)
{
    return link->snapshot.state >= SNAPSHOT_TAKEN;
}

bool link_want_snapshot(dock_t *dock)
{
    link_t *link = &dock->link;
    if (link_is_injecting(link) || link_holds_snapshot(link))
        return false;
    link->snapshot.state = SNAPSHOT_WANTED;
    return true;
}

void link_take_snapshot(dock_t *dock, const frame_t *frame)
{
    link_snapshot_t *snapshot = &dock->link.snapshot;
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
    snapshot->next = 0;
    snapshot->image = (link_image_t){
        .size = (uint32_t)frame->length,
        .width = frame->width,
        .height = frame->height,
        .type = frame->format == FRAME_RGB888 ? MAVLINK_DATA_STREAM_IMG_RAW32U
                                              : MAVLINK_DATA_STREAM_IMG_RAW8U,
    };
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
    for (; snapshot->next < link_packets_of(snapshot->image.size);
         snapshot->next++)
        if (!send_packet(dock, snapshot->next, sender))
            return false;
    snapshot->state = SNAPSHOT_NONE;
    return true;
}
