/* What the files of the link offer each other.  Handlers take a message from
 * the host; senders return false when the next message does not fit. */
#ifndef LINK_PARTS_H
#define LINK_PARTS_H

#include "dock.h"
#include "messages.h"

/* link_texts.c: one line for the person at the ground station. */
typedef struct {
    char text[LINK_TEXT_LENGTH];
    uint8_t length;
} line_t;
void line_add(line_t *line, const char *words);
void line_add_fixed(line_t *line, int64_t n, uint8_t shift); /* n / 2^shift */
void link_say(dock_t *dock, uint8_t severity, const line_t *line);
void link_say_words(dock_t *dock, uint8_t severity, const char *words);
bool link_send_texts(dock_t *dock, sender_t *sender);

/* link_commands.c */
void link_on_command(dock_t *dock, const received_t *message, uint32_t now_ms);
bool link_send_acks(dock_t *dock, sender_t *sender);
void link_acknowledge(dock_t *dock, const link_ack_t *ack);

/* link_parameters.c */
void link_on_parameter_list(dock_t *dock, const received_t *message,
                            uint32_t now_ms);
void link_on_parameter_read(dock_t *dock, const received_t *message,
                            uint32_t now_ms);
void link_on_parameter_set(dock_t *dock, const received_t *message,
                           uint32_t now_ms);
bool link_send_parameters(dock_t *dock, sender_t *sender);
void link_report_parameters(dock_t *dock); /* all of them */
/* After any change of the settings: what follows from it. */
void link_settings_changed(dock_t *dock, const dock_settings_t *before);

/* link_images.c */
void link_on_handshake(dock_t *dock, const received_t *message,
                       uint32_t now_ms);
void link_on_packet(dock_t *dock, const received_t *message, uint32_t now_ms);
bool link_can_snapshot(const dock_t *dock);
void link_take_snapshot(dock_t *dock, const frame_t *frame);
bool link_send_snapshot(dock_t *dock, sender_t *sender);

/* link_reports.c */
bool link_send_reports(dock_t *dock, sender_t *sender, uint32_t now_ms);

/* dock.c: decide on a frame wherever it comes from; false if it is not valid.
 */
bool dock_decide(dock_t *dock, const frame_t *frame, uint32_t now_ms);

/* True for a message to this dock or to all. */
static inline bool link_is_for_us(uint8_t system, uint8_t component)
{
    return (system == DOCK_ID_SYSTEM || system == 0) &&
           (component == DOCK_ID_COMPONENT || component == 0);
}

#endif
