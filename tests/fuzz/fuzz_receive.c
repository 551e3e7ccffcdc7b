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
#include <stdlib.h>
#include <string.h>

#include <chromadock/mavlink.h>

#include "fuzz.h"

/* The largest plausible frame fills the buffer, one of the camera's does not
 * fit into it. */
enum { BUFFER_BYTES = 32 * 32 * 3, MOST_STEPS = 80, MOST_FRAMES = 8 };

dock_t dock, before;
uint32_t clock_ms;
static uint8_t *buffer;
static uint8_t next_sequence;

static const uint8_t *input;
static size_t input_left;

uint8_t take8(void)
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

void take(uint8_t *to, size_t n)
{
    for (size_t i = 0; i < n; i++)
        to[i] = take8();
}

/* From a block of its own, so that a read beyond it is seen. */
void receive(const uint8_t *bytes, size_t n)
{
    uint8_t *copy = malloc(n + (n == 0));
    MUST(copy != NULL);
    memcpy(copy, bytes, n);
    dock_receive(&dock, copy, n, clock_ms);
    free(copy);
}

void flush(void)
{
    clock_ms += RECEIVER_PATIENCE_MS + 1;
    /* Each call gives up a byte at least. */
    for (int i = 0; i < RECEIVER_CAPACITY && dock.link.receiver.length > 0; i++)
        dock_receive(&dock, NULL, 0, clock_ms);
    MUST(dock.link.receiver.length == 0);
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
