/* One message to the dock, whole or spoilt in a manner that the fuzzer chooses.
 */
#include <string.h>

#include <chromadock/mavlink.h>

#include "fuzz.h"

enum { MANNER_BAD_CHECKSUM = 4, MANNER_TO_ANOTHER, MANNER_FROM_THE_DOCK };

#define MANNER_SIGNED 0x08
#define MANNER_UNCUT 0x10
#define MANNER_PLAUSIBLE 0x20
#define MANNER_ALONE 0x40

static const uint32_t kinds[] = {
    MAVLINK_MSG_ID_PARAM_REQUEST_LIST,
    MAVLINK_MSG_ID_PARAM_REQUEST_READ,
    MAVLINK_MSG_ID_PARAM_SET,
    MAVLINK_MSG_ID_COMMAND_LONG,
    MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE,
    MAVLINK_MSG_ID_ENCAPSULATED_DATA,
    MAVLINK_MSG_ID_HEARTBEAT, /* not for the dock */
    MAVLINK_MSG_ID_COMMAND_INT,
    MAVLINK_MSG_ID_PARAM_EXT_REQUEST_LIST,
    MAVLINK_MSG_ID_PARAM_EXT_REQUEST_READ,
    MAVLINK_MSG_ID_PARAM_EXT_SET,
};

static size_t frame_message(uint8_t *wire, uint32_t id, const uint8_t *payload,
                            uint8_t length, uint8_t manner)
{
    const mavlink_msg_entry_t *entry = mavlink_get_msg_entry(id);
    const bool is_signed = (manner & MANNER_SIGNED) != 0;
    const uint8_t header[10] = {
        MAVLINK_STX,
        length,
        is_signed,
        0,
        (uint8_t)(manner * 7),
        manner % 8 == MANNER_FROM_THE_DOCK ? DOCK_ID_SYSTEM : 255,
        190,
        (uint8_t)id,
        (uint8_t)(id >> 8),
        (uint8_t)(id >> 16),
    };
    memcpy(wire, header, sizeof header);
    memcpy(wire + 10, payload, length);
    uint16_t sum = crc_calculate(wire + 1, (uint16_t)(9 + length));
    crc_accumulate(entry->crc_extra, &sum);
    if (manner % 8 == MANNER_BAD_CHECKSUM)
        sum ^= (uint16_t)(1u << manner / 8 % 16);
    wire[10 + length] = (uint8_t)sum;
    wire[11 + length] = (uint8_t)(sum >> 8);
    memset(wire + 12 + length, 0x5A, 13);
    return 12u + length + (is_signed ? 13 : 0);
}

static bool is_start(uint8_t byte)
{
    return byte == MAVLINK_STX || byte == MAVLINK_STX_MAVLINK1;
}

void message(void)
{
    _Alignas(8) uint8_t payload[255 + sizeof(uint64_t)] = {0};
    uint8_t wire[MAVLINK_MAX_PACKET_LEN];
    const uint32_t id = kinds[take8() % COUNT(kinds)];
    const mavlink_msg_entry_t *entry = mavlink_get_msg_entry(id);
    uint8_t manner = take8();
    const uint8_t piece = take8();
    take(payload, take8() % (entry->max_msg_len + 1u));
    if ((manner & MANNER_PLAUSIBLE) != 0)
        make_plausible(id, payload);

    const bool targeted =
        (entry->flags & MAV_MSG_ENTRY_FLAG_HAVE_TARGET_SYSTEM) != 0;
    if (targeted) {
        const bool other = manner % 8 == MANNER_TO_ANOTHER;
        payload[entry->target_system_ofs] = other ? 51 : DOCK_ID_SYSTEM;
        payload[entry->target_component_ofs] = DOCK_ID_COMPONENT;
    } else if (manner % 8 == MANNER_TO_ANOTHER) {
        manner &= (uint8_t)~7u;
    }
    const bool inert = manner % 8 >= MANNER_BAD_CHECKSUM && manner % 8 != 7;
    /* What is in a message that is no message may be one: not in these. */
    for (size_t i = 0; inert && i < sizeof payload; i++)
        if (is_start(payload[i]))
            payload[i] = 0;
    uint8_t length = entry->max_msg_len;
    while ((manner & MANNER_UNCUT) == 0 && length > 1 &&
           payload[length - 1] == 0)
        length--;
    while (inert && is_start(length))
        length--;

    const bool alone = inert || (manner & MANNER_ALONE) != 0;
    if (alone) {
        flush();
        memcpy(&before, &dock, sizeof dock);
    }
    const size_t n = frame_message(wire, id, payload, length, manner);
    const size_t step = piece == 0 ? n : piece;
    for (size_t at = 0; at < n; at += step)
        receive(wire + at, n - at < step ? n - at : step);
    if (!alone)
        return;
    if (inert) {
        must_be_as_before();
        flush();
        must_be_as_before();
    } else {
        /* What is inside a message that is not for the dock may look like the
         * beginning of another one. */
        MUST(dock.link.receiver.length == 0 || id == MAVLINK_MSG_ID_HEARTBEAT);
        if (id == MAVLINK_MSG_ID_PARAM_SET)
            check_parameter_set(payload);
        if (id == MAVLINK_MSG_ID_COMMAND_LONG)
            check_command();
    }
}
