/* A host at the other end of the link.  Its messages are packed, and the dock's
 * are parsed, by MAVLink's own C library: another implementation of the framing
 * than dockcore's. */
#ifndef LINK_FIXTURE_H
#define LINK_FIXTURE_H

#include <chromadock/mavlink.h>
#include <unity.h>

#include "dockcore.h"

/* A message as it is on the wire. */
typedef struct {
    uint8_t bytes[MAVLINK_MAX_PACKET_LEN];
    size_t length;
} wire_t;

/* Who sends to whom; set anew by link_start. */
typedef struct {
    uint8_t system, component;
    uint8_t target_system, target_component;
    bool sign;
} host_t;

extern dock_t dock;
extern host_t host;
extern uint32_t clock_ms; /* what the dock is told */

#define BOARD_UID UINT64_C(0x0000AABBCCDDEEFF)

enum { QQVGA_BYTES = 160 * 120 * 2 };

/* A dock at time 0 with a buffer for a QQVGA frame; its first messages are out.
 */
void link_start(void);

/* Another buffer, exactly so long that AddressSanitizer sees a write beyond. */
void link_start_with(const dock_settings_t *settings, uint32_t capacity);

wire_t wire_of(const mavlink_message_t *message);
wire_t wire_parameter_list(void);
wire_t wire_parameter_read(const char *name, int16_t index);
wire_t wire_parameter_set(const char *name, float value);
/* The value's four bytes as they are, with any MAV_PARAM_TYPE. */
wire_t wire_parameter_bits(const char *name, uint32_t bits, uint8_t type);
wire_t wire_command_int(uint16_t command, float p1, float p2, float p3,
                        float p4);
wire_t wire_command(uint16_t command, float p1, float p2, float p3, float p4);
wire_t wire_handshake(const frame_t *frame);
wire_t wire_packet(const frame_t *frame, uint16_t number);
uint16_t packets_in(const frame_t *frame);

/* To the dock, all at once. */
void tell(wire_t wire);
void tell_bytes(const void *bytes, size_t n);
void tell_frame(const frame_t *frame);

/* Takes what the dock has to say now, in place of what it said before.  Fails
 * where a byte belongs to no message or a number in the sequence is left out.
 */
void hear(void);
/* Only once, into a buffer of that many bytes; adds to what it said before. */
size_t hear_once(size_t capacity);

size_t heard_in_all(void);
size_t heard_count(uint32_t id);
/* Number `n` of the messages with that id; fails where there are fewer. */
const mavlink_message_t *heard(uint32_t id, size_t n);
const mavlink_message_t *heard_at(size_t n);

/* Each hears first, then expects exactly this. */
void assert_silent(void); /* but for what the clock sends */
void assert_ack(uint16_t command, uint8_t result);
void assert_text(uint8_t severity, const char *text);
void assert_value(const char *name, float value);   /* as a float */
void assert_whole(const char *name, int32_t value); /* by its own bytes */
mavlink_dock_status_t status_now(void);             /* asks for it */

#endif
