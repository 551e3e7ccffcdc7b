#include <string.h>

#include "link_parts.h"

/* A host that stops injecting without saying so gets the camera back. */
#define INJECTION_MS 3000

/* RGB565 travels as RAW8U, RGB888 as RAW32U: MAVLink has no better names. */
static bool format_of_type(uint8_t type, frame_format_t *format)
{
    *format =
        type == MAVLINK_DATA_STREAM_IMG_RAW32U ? FRAME_RGB888 : FRAME_RGB565;
    return type == MAVLINK_DATA_STREAM_IMG_RAW8U ||
           type == MAVLINK_DATA_STREAM_IMG_RAW32U;
}

static frame_t injected_frame(const dock_t *dock, const link_image_t *image)
{
    frame_format_t format;
    format_of_type(image->type, &format);
    return (frame_t){dock->board.buffer, image->size, image->width,
                     image->height,      format,      0};
}

void link_expire_injection(link_t *link, uint32_t now_ms)
{
    link_injection_t *injection = &link->injection;
    if (now_ms - injection->heard_ms > INJECTION_MS)
        injection->state = INJECTION_OFF;
}

/* Goes on injecting, if it did, but without a frame that is announced. */
static void forget_frame(link_injection_t *injection)
{
    if (injection->state != INJECTION_OFF)
        injection->state = INJECTION_IDLE;
}

static void refuse(link_t *link, const char *words)
{
    link_say_words(link, MAV_SEVERITY_WARNING, words);
    link_count_fault(link);
    forget_frame(&link->injection);
}

void link_on_handshake(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    link_t *link = &dock->link;
    mavlink_data_transmission_handshake_t h;
    message_read(&h, sizeof h, message);
    if (h.size == 0) { /* the host is done */
        link->injection.state = INJECTION_OFF;
        return;
    }
    frame_format_t format;
    if (!format_of_type(h.type, &format))
        return; /* another camera's, to somebody else */
    if (link_is_sending_snapshot(link)) { /* in the one buffer that there is */
        refuse(link, "injection refused: a snapshot is being sent");
        return;
    }
    if (h.size > dock->board.capacity || h.packets != link_packets_of(h.size) ||
        h.payload != PACKET) {
        refuse(link, "injection refused: size or format");
        return;
    }
    const link_image_t image = {h.size, h.width, h.height, h.type, 0};
    const frame_t frame = injected_frame(dock, &image);
    if (!frame_is_valid(&frame)) {
        refuse(link, "injection refused: length does not fit the size");
        decision_refuse(&dock->decision);
        return;
    }
    link_forget_snapshot(link);
    link->injection = (link_injection_t){INJECTION_ANNOUNCED, image, 0, now_ms};
}

static void drop_frame(link_t *link)
{
    line_t line = {{0}, 0};
    line_add(&line, "injected frame dropped: lost packet ");
    line_add_fixed(&line, link->injection.next, 0);
    link_say(link, MAV_SEVERITY_WARNING, &line);
    link_count_fault(link);
    forget_frame(&link->injection);
}

void link_on_packet(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    link_injection_t *injection = &dock->link.injection;
    mavlink_encapsulated_data_t packet;
    message_read(&packet, sizeof packet, message);
    if (injection->state < INJECTION_ANNOUNCED)
        return; /* nothing expected */
    const uint32_t at = (uint32_t)packet.seqnr * PACKET;
    if (packet.seqnr < injection->next &&
        memcmp(dock->board.buffer + at, packet.data, PACKET) == 0)
        return; /* the same once more */
    /* An earlier one is of a frame whose handshake was lost. */
    if (packet.seqnr != injection->next) {
        drop_frame(&dock->link);
        return;
    }
    const uint32_t left = injection->image.size - at;
    memcpy(dock->board.buffer + at, packet.data, left < PACKET ? left : PACKET);
    injection->heard_ms = now_ms;
    if (++injection->next < link_packets_of(injection->image.size))
        return;
    const frame_t frame = injected_frame(dock, &injection->image);
    forget_frame(injection);
    decision_frame(&dock->decision, &frame, &dock->settings, now_ms);
    /* The host waits for what came of it. */
    link_ask_for_report(&dock->link, REPORT_STATUS);
}

/* The announced frame's handshake back: the host may go on. */
bool link_send_echo(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    link_injection_t *injection = &dock->link.injection;
    if (injection->state != INJECTION_ANNOUNCED)
        return true;
    if (!link_send_handshake(sender, &injection->image))
        return false;
    injection->state = INJECTION_RECEIVING;
    return true;
}
