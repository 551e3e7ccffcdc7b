/* What the files of the link offer each other and dock.c. */
#ifndef LINK_PARTS_H
#define LINK_PARTS_H

#include "dock_state.h"
#include "messages.h"

/* Takes a message that has come whole, whoever it is for. */
typedef void link_handler_t(dock_t *dock, const received_t *message,
                            uint32_t now_ms);

/* Sends what it has.  Returns false when its next message does not fit. */
typedef bool link_sender_t(dock_t *dock, sender_t *sender, uint32_t now_ms);

/* link.c: see dock.h */
void link_receive(dock_t *dock, const uint8_t *bytes, size_t n,
                  uint32_t now_ms);
size_t link_transmit(dock_t *dock, uint8_t *bytes, size_t capacity,
                     uint32_t now_ms);

/* link_texts.c: one line for the person at the ground station. */
typedef struct {
    char text[LINK_TEXT_LENGTH];
    uint8_t length;
} line_t;
void line_add(line_t *line, const char *words);
void line_add_fixed(line_t *line, int64_t n, uint8_t shift); /* n / 2^shift */
void link_say(link_t *link, uint8_t severity, const line_t *line);
void link_say_words(link_t *link, uint8_t severity, const char *words);
link_sender_t link_send_texts;

/* link_acks.c */
void link_acknowledge(link_t *link, const link_ack_t *ack);
void link_answer_save_later(link_t *link, const link_ack_t *ack);
void link_answer_save(link_t *link, bool written);
bool link_has_answered(const link_t *link); /* every command but a save */
link_sender_t link_send_acks;

/* link_commands.c */
link_handler_t link_on_command; /* long or int */

/* link_settings.c: both return an index, or say that there is none: -1. */
int link_find_parameter(link_t *link, const char name[16]);
int link_asked_parameter(link_t *link, int16_t index, const char name[16]);
bool link_set_parameter(dock_t *dock, int index, uint32_t real32); /* or says
                                                        why it does not */
void link_reset_settings(dock_t *dock); /* to the defaults */

/* link_parameters.c: the first two for either protocol */
link_handler_t link_on_parameter_list, link_on_parameter_read,
    link_on_parameter_set, link_on_typed_set;

/* link_values.c */
#define LINK_ALL_VALUES UINT32_MAX
void link_values_due(link_t *link, value_form_t form,
                     uint32_t which); /* a bit for each parameter */
link_sender_t link_send_values;

/* link_images.c: what snapshots and injected frames have in common. */
#define PACKET MAVLINK_MSG_ENCAPSULATED_DATA_FIELD_DATA_LEN
uint16_t link_packets_of(uint32_t size);
bool link_send_handshake(sender_t *sender, const link_image_t *image);

/* link_snapshot.c */
bool link_want_snapshot(link_t *link, uint32_t now_ms); /* false: not now */
bool link_repeat_snapshot(link_t *link, int64_t number, int64_t first,
                          int64_t count); /* false: there is no such packet */
void link_expire_snapshot(link_t *link, uint32_t now_ms); /* a wish */
void link_forget_snapshot(link_t *link); /* the buffer is taken for another */
void link_take_snapshot(dock_t *dock, const frame_t *frame,
                        uint32_t now_ms); /* if one is wanted */
link_sender_t link_send_snapshot;

/* link_injection.c */
link_handler_t link_on_handshake, link_on_packet;
void link_expire_injection(link_t *link, uint32_t now_ms); /* of a silent host
                                                            */
link_sender_t link_send_echo;

/* link_reports.c */
int link_report_of(int64_t id); /* a report_t; -1 for another message */
void link_ask_for_report(link_t *link, report_t report);
void link_ask_for_interval(link_t *link, uint16_t id);
void link_set_period(link_t *link, report_t report, uint32_t period_ms);
link_sender_t link_send_reports;

static inline void link_count_fault(link_t *link)
{
    link->faults++;
}

static inline bool link_is_sending_snapshot(const link_t *link)
{
    return link->snapshot.state >= SNAPSHOT_TAKEN;
}

static inline bool link_is_injecting(const link_t *link)
{
    return link->injection.state != INJECTION_OFF;
}

/* True for a message to this dock, or to a component of every system. */
static inline bool link_is_for_us(const link_t *link, uint8_t system,
                                  uint8_t component)
{
    return (system == link->system || system == 0) &&
           (component == DOCK_ID_COMPONENT || component == 0);
}

/* True for a message to this dock, not to every system: one that changes
 * something. */
static inline bool link_is_for_this(const link_t *link, uint8_t system,
                                    uint8_t component)
{
    return system != 0 && link_is_for_us(link, system, component);
}

#endif
