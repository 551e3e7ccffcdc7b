#include <string.h>

#include "link_parts.h"

#define PACKET MAVLINK_MSG_ENCAPSULATED_DATA_FIELD_DATA_LEN

/* RGB565 travels as RAW8U, RGB888 as RAW32U: MAVLink has no better names. */
static bool format_of_type(uint8_t type, frame_format_t *format)
{
    *format =
        type == MAVLINK_DATA_STREAM_IMG_RAW32U ? FRAME_RGB888 : FRAME_RGB565;
    return type == MAVLINK_DATA_STREAM_IMG_RAW8U ||
           type == MAVLINK_DATA_STREAM_IMG_RAW32U;
}

static uint16_t packets_of(uint32_t size)
{
    return (uint16_t)((size + PACKET - 1) / PACKET);
}

static frame_t injected_frame(const dock_t *dock)
{
    const transfer_t *transfer = &dock->link.injected;
    frame_format_t format;
    format_of_type(transfer->type, &format);
    return (frame_t){dock->board.buffer, transfer->size, transfer->width,
                     transfer->height, format};
}

static void announce(dock_t *dock, uint8_t type, uint32_t size, uint16_t width,
                     uint16_t height)
{
    dock->link.injected = (transfer_t){
        .size = size, .width = width, .height = height, .type = type};
}

void link_on_handshake(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    link_t *link = &dock->link;
    mavlink_data_transmission_handshake_t h;
    message_read(&h, sizeof h, message);
    if (h.size == 0) { /* the host is done */
        link->injecting = false;
        link->injected.size = 0;
        return;
    }
    frame_format_t format;
    if (!format_of_type(h.type, &format) || h.size > dock->board.capacity ||
        h.packets != packets_of(h.size) || h.payload != PACKET ||
        link->snapshot.size != 0) {
        link_say_words(dock, MAV_SEVERITY_WARNING,
                       link->snapshot.size != 0
                           ? "injection refused: a snapshot is being sent"
                           : "injection refused: size or format");
        link->injected.size = 0;
        link->faults++;
        return;
    }
    announce(dock, h.type, h.size, h.width, h.height);
    const frame_t frame = injected_frame(dock);
    if (!frame_is_valid(&frame)) {
        link_say_words(dock, MAV_SEVERITY_WARNING,
                       "injection refused: length does not fit the size");
        link->faults++;
        link->injected.size = 0;
        dock->faults |= DOCK_FAULT_FRAME;
        return;
    }
    link->injecting = true;
    link->injected_ms = now_ms;
}

void link_on_packet(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    link_t *link = &dock->link;
    transfer_t *transfer = &link->injected;
    mavlink_encapsulated_data_t packet;
    message_read(&packet, sizeof packet, message);
    if (transfer->size == 0)
        return; /* nothing expected */
    const uint32_t at = (uint32_t)packet.seqnr * PACKET;
    if (packet.seqnr < transfer->next &&
        memcmp(dock->board.buffer + at, packet.data, PACKET) == 0)
        return; /* the same once more */
    /* An earlier one is of a frame whose handshake was lost. */
    if (packet.seqnr != transfer->next) {
        line_t line = {{0}, 0};
        line_add(&line, "injected frame dropped: lost packet ");
        line_add_fixed(&line, transfer->next, 0);
        link_say(dock, MAV_SEVERITY_WARNING, &line);
        transfer->size = 0;
        link->faults++;
        return;
    }
    const uint32_t left = transfer->size - at;
    memcpy(dock->board.buffer + at, packet.data, left < PACKET ? left : PACKET);
    link->injected_ms = now_ms;
    if (++transfer->next < packets_of(transfer->size))
        return;
    const frame_t frame = injected_frame(dock);
    transfer->size = 0;
    dock_decide(dock, &frame, now_ms);
    link->status_due = true; /* the host waits for what came of it */
}

bool link_can_snapshot(const dock_t *dock)
{
    return !dock->link.injecting && dock->link.snapshot.size == 0;
}

void link_take_snapshot(dock_t *dock, const frame_t *frame)
{
    link_t *link = &dock->link;
    if (!link->snapshot_wanted || !link_can_snapshot(dock))
        return;
    link->snapshot_wanted = false;
    if (frame->length > dock->board.capacity) {
        link_say_words(dock, MAV_SEVERITY_WARNING,
                       "no snapshot: the frame is too large");
        return;
    }
    memcpy(dock->board.buffer, frame->bytes, frame->length);
    link->snapshot = (transfer_t){
        .size = (uint32_t)frame->length,
        .width = frame->width,
        .height = frame->height,
        .type = frame->format == FRAME_RGB888 ? MAVLINK_DATA_STREAM_IMG_RAW32U
                                              : MAVLINK_DATA_STREAM_IMG_RAW8U,
    };
}

static bool send_handshake(const transfer_t *transfer, sender_t *sender)
{
    mavlink_data_transmission_handshake_t h;
    memset(&h, 0, sizeof h);
    h.size = transfer->size;
    h.width = transfer->width;
    h.height = transfer->height;
    h.packets = packets_of(transfer->size);
    h.type = transfer->type;
    h.payload = PACKET;
    return MESSAGE_SEND(sender, DATA_TRANSMISSION_HANDSHAKE, &h);
}

static bool send_packet(const dock_t *dock, uint16_t number, sender_t *sender)
{
    const uint32_t at = (uint32_t)number * PACKET;
    const uint32_t left = dock->link.snapshot.size - at;
    mavlink_encapsulated_data_t packet;
    memset(&packet, 0, sizeof packet);
    packet.seqnr = number;
    memcpy(packet.data, dock->board.buffer + at, left < PACKET ? left : PACKET);
    return MESSAGE_SEND(sender, ENCAPSULATED_DATA, &packet);
}

bool link_send_snapshot(dock_t *dock, sender_t *sender)
{
    transfer_t *injected = &dock->link.injected;
    if (injected->size != 0 && !injected->announced) {
        if (!send_handshake(injected, sender)) /* the echo: go on */
            return false;
        injected->announced = true;
    }
    transfer_t *transfer = &dock->link.snapshot;
    if (transfer->size == 0)
        return true;
    if (!transfer->announced && !send_handshake(transfer, sender))
        return false;
    transfer->announced = true;
    for (; transfer->next < packets_of(transfer->size); transfer->next++)
        if (!send_packet(dock, transfer->next, sender))
            return false;
    transfer->size = 0;
    return true;
}
