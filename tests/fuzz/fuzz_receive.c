/* The link under libFuzzer.
 *
 * An input is a list of steps, so that the fuzzer gets behind the checksum: it
 * gives a message's contents, the frame around them is made here.
 *
 *   0 raw     length, bytes                 the host's bytes as they are
 *   1 message kind, manner, piece, length, payload
 *   2 wait    16 bits of milliseconds
 *   3 send    16 bits of capacity
 *   4 camera  kind, red, green, blue
 *   5 board   takes a request; saves if asked to, or fails to
 *   6 lock    what the camera is set to
 *   7 flush   silence until nothing is half received
 *
 * The manner's bits: 0..2 as MANNER_..., 3 signed, 4 zeros at the end not cut
 * off, 5 contents made plausible, 6 alone on the line and its effect checked.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <chromadock/mavlink.h>

#include "dockcore.h"

#define MUST(condition)                                                     \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                        \
        }                                                                   \
    } while (0)

/* The largest plausible frame fills the buffer, one of the camera's does not
 * fit into it. */
enum {
    BUFFER_BYTES = 32 * 32 * 3,
    MOST_STEPS = 80,
    MOST_FRAMES = 8,
    PACKET = 253
};

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

static const uint16_t commands[] = {
    MAV_CMD_DOCK_LED,
    MAV_CMD_DOCK_SNAPSHOT,
    MAV_CMD_PREFLIGHT_STORAGE,
    MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN,
    MAV_CMD_REQUEST_MESSAGE,
    MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES,
    MAV_CMD_SET_MESSAGE_INTERVAL,
    MAV_CMD_GET_MESSAGE_INTERVAL,
};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static dock_t dock, before;
static uint8_t *buffer;
static uint32_t clock_ms;
static uint8_t next_sequence;

static const uint8_t *input;
static size_t input_left;

static uint8_t take8(void)
{
    if (input_left == 0)
        return 0;
    input_left--;
    return *input++;
}

static uint16_t take16(void)
{
    const uint8_t low = take8();
    return (uint16_t)(low | take8() << 8);
}

static void take(uint8_t *to, size_t n)
{
    for (size_t i = 0; i < n; i++)
        to[i] = take8();
}

/* From a block of its own, so that a read beyond it is seen. */
static void receive(const uint8_t *bytes, size_t n)
{
    uint8_t *copy = malloc(n + (n == 0));
    MUST(copy != NULL);
    memcpy(copy, bytes, n);
    dock_receive(&dock, copy, n, clock_ms);
    free(copy);
}

static void flush(void)
{
    clock_ms += RECEIVER_PATIENCE_MS + 1;
    /* Each call gives up a byte at least. */
    for (int i = 0; i < RECEIVER_CAPACITY && dock.link.receiver.length > 0; i++)
        dock_receive(&dock, NULL, 0, clock_ms);
    MUST(dock.link.receiver.length == 0);
}

/* The receiver apart: it may hold bytes, and counts what it refused. */
static void must_be_as_before(void)
{
    before.link.receiver = dock.link.receiver;
    MUST(memcmp(&before, &dock, sizeof dock) == 0);
}

static void must_be_sound(void)
{
    const link_t *link = &dock.link;
    uint16_t duty[3];
    MUST(dock_mend_settings(&dock.settings) == 0);
    MUST(dock.lamps.mode <= DOCK_LED_RAW);
    MUST(dock.lamps.hue < METHOD_HUE_RANGE);
    MUST(dock.decision.steady.shown < METHOD_HUE_RANGE);
    MUST(dock.decision.decided_hue < METHOD_HUE_RANGE);
    dock_led_duties(&dock, duty, clock_ms);
    for (int i = 0; i < 3; i++)
        MUST(duty[i] <= LED_FULL);
    MUST(link->receiver.length <= RECEIVER_CAPACITY);
    MUST(link->texts.count <= LINK_TEXTS && link->acks.count <= LINK_ACKS);
    uint32_t bits = link->parameters.refused | link->parameters.floats;
    for (int form = 0; form < VALUE_FORMS; form++)
        bits |= link->parameters.turns[form].due;
    MUST(bits >> PARAMETER_COUNT == 0);
    MUST(dock.requests.save <= SAVE_WRITING);
    const link_injection_t *injection = &link->injection;
    MUST(injection->image.size <= BUFFER_BYTES);
    if (injection->state >= INJECTION_ANNOUNCED) {
        MUST(injection->next * PACKET < injection->image.size);
        /* Both would be in the same buffer. */
        MUST(link->snapshot.state < SNAPSHOT_TAKEN);
    }
    MUST(dock.board.buffer == buffer);
}

static void transmit(size_t capacity)
{
    uint8_t *bytes = malloc(capacity + 1);
    MUST(bytes != NULL);
    /* The end of the block is the end of the buffer. */
    uint8_t *const start = bytes + 1;
    const size_t n = dock_transmit(&dock, start, capacity, clock_ms);
    size_t of_messages = 0;
    MUST(n <= capacity);
    for (size_t i = 0; i < n; i++) {
        mavlink_message_t message;
        mavlink_status_t status;
        const uint8_t result =
            mavlink_frame_char(MAVLINK_COMM_0, start[i], &message, &status);
        MUST(result != MAVLINK_FRAMING_BAD_CRC);
        if (result != MAVLINK_FRAMING_OK)
            continue;
        MUST(message.seq == next_sequence++);
        MUST(message.sysid == DOCK_ID_SYSTEM);
        of_messages += MAVLINK_NUM_NON_PAYLOAD_BYTES + message.len;
    }
    MUST(of_messages == n);
    if (capacity > 3000) /* room for all but images */
        MUST(dock.link.acks.count == 0 && dock.link.texts.count == 0 &&
             dock.link.parameters.turns[VALUE_FLOAT].due == 0 &&
             dock.link.parameters.turns[VALUE_WHOLE].due == 0 &&
             dock.link.reports[REPORT_STATUS].state != REPORT_DUE);
    free(bytes);
}

static void camera(void)
{
    static uint8_t pixels[40 * 30 * 3];
    uint8_t kind = take8();
    if (dock.decision.frames >= MOST_FRAMES) /* they take the most time */
        kind = 3;
    for (size_t i = 0; i < 3; i++) {
        const uint8_t level = take8();
        for (size_t at = i; at < sizeof pixels; at += 3)
            pixels[at] = (uint8_t)(level ^ (at & kind));
    }
    frame_t frame = {pixels, 12 * 9 * 3, 12, 9, FRAME_RGB888, 0};
    if (kind % 8 == 1)
        frame.length--;
    if (kind % 8 == 2)
        frame = (frame_t){pixels, 200, 10, 10, FRAME_RGB565, 0};
    if (kind % 8 == 4)
        frame = (frame_t){pixels, sizeof pixels, 40, 30, FRAME_RGB888, 0};
    const uint32_t frames = dock.decision.frames;
    const bool injecting = dock.link.injection.state != INJECTION_OFF &&
                           clock_ms - dock.link.injection.heard_ms <= 3000;
    dock_frame(&dock, kind % 8 == 3 ? NULL : &frame, clock_ms);
    if (injecting)
        MUST(dock.decision.frames == frames);
}

static void board(void)
{
    const bool written = take8() % 2;
    const dock_request_t request = dock_take_request(&dock);
    MUST(request <= DOCK_REQUEST_REBOOT);
    if (request == DOCK_REQUEST_REBOOT)
        MUST(dock.link.acks.count == 0 && dock.requests.save == SAVE_NONE);
    if (request == DOCK_REQUEST_SAVE) {
        uint8_t blob[SETTINGS_BLOB_BYTES];
        dock_settings_t read;
        settings_to_blob(&dock.settings, blob);
        MUST(settings_from_blob(&read, blob, sizeof blob) == SETTINGS_READ);
        dock_saved(&dock, written);
    }
}

/* Contents that would hardly come about by chance. */
static void make_plausible(uint32_t id, uint8_t *payload)
{
    const uint8_t seed[4] = {payload[0], payload[1], payload[2], payload[3]};
    if (id == MAVLINK_MSG_ID_PARAM_SET) {
        mavlink_param_set_t *set = (mavlink_param_set_t *)payload;
        const char *name =
            PARAMETERS[(uint8_t)set->param_id[0] % PARAMETER_COUNT].name;
        memset(set->param_id, 0, sizeof set->param_id);
        memcpy(set->param_id, name, strlen(name));
    } else if (id == MAVLINK_MSG_ID_COMMAND_LONG) {
        mavlink_command_long_t *command = (mavlink_command_long_t *)payload;
        command->param1 = (float)(int8_t)seed[0];
        command->param2 = (float)seed[1] * 2;
        command->param3 = (float)seed[2];
        command->param4 = (float)seed[3];
        command->command = commands[command->command % COUNT(commands)];
        if (command->command == MAV_CMD_REQUEST_MESSAGE)
            command->param1 = seed[0] % 2 ? MAVLINK_MSG_ID_DOCK_STATUS
                                          : MAVLINK_MSG_ID_AUTOPILOT_VERSION;
    } else if (id == MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE) {
        mavlink_data_transmission_handshake_t *h =
            (mavlink_data_transmission_handshake_t *)payload;
        const bool rgb565 = seed[0] % 2;
        h->width = (uint16_t)(1 + seed[1] % 32);
        h->height = (uint16_t)(1 + seed[2] % 32);
        h->size = (rgb565 ? 2u : 3u) * h->width * h->height;
        h->packets = (uint16_t)((h->size + PACKET - 1) / PACKET);
        h->payload = PACKET;
        h->type = rgb565 ? MAVLINK_DATA_STREAM_IMG_RAW8U
                         : MAVLINK_DATA_STREAM_IMG_RAW32U;
        if (seed[3] == 255)
            h->size = 0;
        if (seed[3] == 254)
            h->width++;
    } else if (id == MAVLINK_MSG_ID_ENCAPSULATED_DATA) {
        mavlink_encapsulated_data_t *packet =
            (mavlink_encapsulated_data_t *)payload;
        packet->seqnr = dock.link.injection.next;
    }
}

/* The number that a PARAM_SET means: a float, or the bytes of an integer where
 * its type says so and no float has them. */
static double meant(const mavlink_param_set_t *set)
{
    const float value = set->param_value;
    int8_t of8;
    int16_t of16;
    int32_t of32;
    memcpy(&of8, &value, sizeof of8);
    memcpy(&of16, &value, sizeof of16);
    memcpy(&of32, &value, sizeof of32);
    if (isnormal(value) || value == 0)
        return value;
    switch (set->param_type) {
    case MAV_PARAM_TYPE_UINT8:
        return (uint8_t)of8;
    case MAV_PARAM_TYPE_INT8:
        return of8;
    case MAV_PARAM_TYPE_UINT16:
        return (uint16_t)of16;
    case MAV_PARAM_TYPE_INT16:
        return of16;
    case MAV_PARAM_TYPE_UINT32:
        return (uint32_t)of32;
    case MAV_PARAM_TYPE_INT32:
        return of32;
    default:
        return NAN;
    }
}

/* What PARAM_SET must have done, by this computer's floating point. */
static void check_parameter_set(const uint8_t *payload)
{
    mavlink_param_set_t set;
    memcpy(&set, payload, sizeof set);
    for (int i = 0; i < PARAMETER_COUNT; i++) {
        const parameter_t *p = &PARAMETERS[i];
        const int32_t was = parameter_get(p, &before.settings);
        const int32_t is = parameter_get(p, &dock.settings);
        const double scaled =
            meant(&set) / p->numerator * (double)(UINT64_C(1) << p->shift);
        const double off = fabs(scaled - is);
        if (strncmp(p->name, set.param_id, sizeof set.param_id) != 0)
            MUST(is == was);
        else if (!(scaled > p->minimum - 0.501 && scaled < p->maximum + 0.501))
            MUST(is == was);
        else if (scaled > p->minimum - 0.499 && scaled < p->maximum + 0.499)
            MUST(off < 0.501);
    }
}

/* A command that is refused has done nothing but to be counted. */
static void check_command(void)
{
    const link_acks_t *acks = &dock.link.acks;
    if (acks->count == before.link.acks.count)
        return;
    const uint8_t result = acks->waiting[acks->count - 1].result;
    if (result == MAV_RESULT_ACCEPTED || result == MAV_RESULT_IN_PROGRESS)
        return;
    before.link.acks = *acks;
    before.link.faults = dock.link.faults;
    must_be_as_before();
}

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

static void message(void)
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
        if (payload[i] == MAVLINK_STX)
            payload[i]--;
    uint8_t length = entry->max_msg_len;
    while ((manner & MANNER_UNCUT) == 0 && length > 1 &&
           payload[length - 1] == 0)
        length--;
    if (inert && length == MAVLINK_STX)
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

static void step(void)
{
    uint8_t bytes[255];
    switch (take8() % 8) {
    case 0: {
        const uint8_t n = take8();
        take(bytes, n);
        receive(bytes, n);
        break;
    }
    case 1:
        message();
        break;
    case 2:
        clock_ms += take16();
        break;
    case 3:
        transmit(take16() % 4096);
        break;
    case 4:
        camera();
        break;
    case 5:
        board();
        break;
    case 6:
        dock_set_camera(&dock, &(dock_camera_t){take16(), take8(), take8() % 2,
                                                take8() % 2, take16()});
        break;
    default:
        flush();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const dock_settings_t settings = dock_default_settings();
    input = data;
    input_left = size;
    /* Half of the runs begin shortly before the clock wraps. */
    clock_ms = take8() % 2 ? 0 : UINT32_MAX - 1500;
    next_sequence = 0;
    mavlink_reset_channel_status(MAVLINK_COMM_0);
    buffer = malloc(BUFFER_BYTES);
    MUST(buffer != NULL);
    memset(&dock, 0xA5, sizeof dock);
    dock_init(&dock, &settings);
    dock_set_board(
        &dock, &(dock_board_t){1, false, "01234567", buffer, BUFFER_BYTES, 1});
    for (int i = 0; i < MOST_STEPS && input_left > 0; i++) {
        step();
        must_be_sound();
    }
    flush();
    transmit(4095);
    must_be_sound();
    free(buffer);
    return 0;
}
