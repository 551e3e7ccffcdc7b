#include "budget.h"

#include "board.h"
#include "console.h"
#include "instructions.h"
#include "messages.h"
#include "qqvga.h"
#include "vectors.h"

#define FRAME_MS 33 /* 30 Hz: a window full of decisions */

static dock_t dock;

static void put_instructions(const char *name, const char *stage,
                             uint32_t count)
{
    put_word("instructions");
    put_word(name);
    put_word(stage);
    put_number(count);
    put_line_end();
}

/* Settings of the frame and as many decisions as the window holds, with hues
 * that lie apart: the most work.  Returns the time of the next decision. */
static uint32_t fill_window(const golden_frame_t *golden)
{
    const dock_settings_t settings = golden_settings(golden);
    uint32_t now_ms = 0;
    dock_init(&dock, &settings);
    dock.decision.decided = true;
    dock.decision.water_value = golden->background.value;
    for (uint16_t i = 0; i < METHOD_WINDOW_CAPACITY; i++) {
        steady_take(&dock.decision.steady, golden->background.meaningful, i,
                    settings.window_ms, now_ms);
        now_ms += FRAME_MS;
    }
    return now_ms;
}

/* The whole of a decision; `bin` was the fullest in the frame before. */
static void count_frame(const golden_frame_t *golden, const char *kind,
                        uint8_t bin)
{
    const frame_t frame = golden_frame(golden);
    const uint32_t now_ms = fill_window(golden);
    uint16_t duties[3];
    dock.decision.background.bin = bin;
    const uint32_t start = ticks();
    dock_frame(&dock, &frame, now_ms);
    dock_led_duties(&dock, duties, now_ms);
    put_instructions(golden->name, kind, instructions_between(start, ticks()));
}

static void take_nothing(void *context, const uint32_t row[WORKING_WIDTH])
{
    (void)context;
    (void)row;
}

static void count_stages(const golden_frame_t *golden)
{
    const frame_t frame = golden_frame(golden);
    const uint32_t now_ms = fill_window(golden);
    const dock_settings_t *settings = &dock.settings;
    background_t background;
    uint32_t row[WORKING_WIDTH];
    uint16_t duties[3];
    const uint32_t start = ticks();
    for (uint32_t y = 0; y < WORKING_HEIGHT; y++)
        qqvga_row(&frame, y, row);
    const uint32_t averaged = ticks();
    smoothed_open(&dock.decision.smoothed, &frame);
    smoothed_rows(&dock.decision.smoothed, take_nothing, NULL);
    const uint32_t smoothed = ticks();
    background_from_rows(&background, smoothed_rows, &dock.decision.smoothed,
                         golden->background.bin);
    const uint32_t summed = ticks();
    const uint16_t hue =
        marker_hue(&background, settings->mapping, settings->fallback_hue);
    const uint16_t mean = rolling_add(&dock.decision.steady.rolling, hue,
                                      now_ms, settings->window_ms);
    led_duties(duties, mean, &settings->led);
    const uint32_t decided = ticks();
    /* Each stage draws its rows from the one before. */
    const uint32_t average = instructions_between(start, averaged);
    const uint32_t smooth = instructions_between(averaged, smoothed);
    const uint32_t sum = instructions_between(smoothed, summed);
    put_instructions(golden->name, "working_image", average);
    put_instructions(golden->name, "smooth", smooth - average);
    put_instructions(golden->name, "background", sum - smooth);
    put_instructions(golden->name, "decision",
                     instructions_between(summed, decided));
}

/* The fullest bin but one: taken for the fullest, it costs the most. */
static uint8_t second_bin(const background_t *background)
{
    uint8_t second = background->bin == 0;
    for (uint8_t bin = 0; bin < METHOD_GREY_BINS; bin++)
        if (bin != background->bin &&
            background->bin_counts[bin] > background->bin_counts[second])
            second = bin;
    return second;
}

bool print_instructions(void)
{
    if (!instructions_calibrate())
        return false;
    for (size_t i = 0; i < golden_frame_count; i++) {
        const golden_frame_t *golden = &golden_frames[i];
        if (golden->format != FRAME_RGB565 || golden->width != 160 ||
            golden->height != 120)
            continue;
        count_stages(golden);
        count_frame(golden, "total", golden->background.bin);
        count_frame(golden, "cold", second_bin(&golden->background));
    }
    return true;
}

#define STACK_WORDS 2048
#define PAINT UINT32_C(0xA5C3965A)

static uint32_t stack[STACK_WORDS + 4] __attribute__((aligned(16)));

/* Bytes of stack that the call wrote to. */
static uint32_t stack_used(const stack_call_t *call)
{
    uint32_t untouched = 0;
    for (uint32_t i = 0; i < STACK_WORDS; i++)
        stack[i] = PAINT;
    stack_call(stack + STACK_WORDS, call);
    while (untouched < STACK_WORDS && stack[untouched] == PAINT)
        untouched++;
    return (STACK_WORDS - untouched) * (uint32_t)sizeof stack[0];
}

static bool put_stack(const char *function, uint32_t used)
{
    put_word("stack");
    put_word(function);
    put_number(used);
    put_line_end();
    return used < sizeof(uint32_t) * STACK_WORDS;
}

static void keep_larger(uint32_t *most, uint32_t value)
{
    if (value > *most)
        *most = value;
}

/* A message from a host that makes the dock call its deepest. */
static size_t host_message(uint8_t *bytes, size_t capacity, uint32_t id,
                           uint8_t crc_extra, const void *payload, uint8_t n)
{
    uint8_t sequence = 0;
    sender_t sender = {bytes, 0, capacity, &sequence, DOCK_ID_SYSTEM};
    message_send(&sender, id, crc_extra, payload, n);
    const size_t end = sender.length - 2;
    bytes[5] = 255; /* not the dock's own address */
    const uint16_t sum = message_checksum(bytes, end, crc_extra);
    bytes[end] = (uint8_t)sum;
    bytes[end + 1] = (uint8_t)(sum >> 8);
    return sender.length;
}

#define HOST_MESSAGE(bytes, NAME, payload)                    \
    host_message(bytes, sizeof(bytes), MAVLINK_MSG_ID_##NAME, \
                 MAVLINK_MSG_ID_##NAME##_CRC, payload,        \
                 MAVLINK_MSG_ID_##NAME##_LEN)

/* An injected frame of one packet, which the receiver decides on at once; then
 * everything that a dock can have to say. */
static bool print_link_stack(void)
{
    static uint8_t buffer[128], out[4096], first[RECEIVER_CAPACITY],
        second[RECEIVER_CAPACITY];
    const dock_settings_t settings = dock_default_settings();
    const dock_board_t board = {1, true, {0}, buffer, sizeof buffer, 0};
    dock_init(&dock, &settings);
    dock_set_board(&dock, &board);
    mavlink_data_transmission_handshake_t handshake = {
        .size = sizeof buffer,
        .width = 8,
        .height = 8,
        .packets = 1,
        .type = MAVLINK_DATA_STREAM_IMG_RAW8U,
        .payload = MAVLINK_MSG_ENCAPSULATED_DATA_FIELD_DATA_LEN};
    mavlink_encapsulated_data_t packet = {.seqnr = 0, .data = {1, 2, 3}};
    const uintptr_t at = (uintptr_t)&dock;
    const size_t n =
        HOST_MESSAGE(first, DATA_TRANSMISSION_HANDSHAKE, &handshake);
    const size_t m = HOST_MESSAGE(second, ENCAPSULATED_DATA, &packet);
    const stack_call_t announce = {(uintptr_t)dock_receive,
                                   {at, (uintptr_t)first, n, 0}};
    const stack_call_t deliver = {(uintptr_t)dock_receive,
                                  {at, (uintptr_t)second, m, 0}};
    const stack_call_t speak = {(uintptr_t)dock_transmit,
                                {at, (uintptr_t)out, sizeof out, 0}};
    uint32_t of_receive = stack_used(&announce);
    keep_larger(&of_receive, stack_used(&deliver));
    dock.link.reports[REPORT_VERSION].state = REPORT_DUE;
    const uint32_t of_transmit = stack_used(&speak);
    const bool decided = dock.decision.frames == 1; /* or it measured nothing */
    const bool receive_fits = put_stack("dock_receive", of_receive);
    return put_stack("dock_transmit", of_transmit) && receive_fits && decided;
}

bool print_stack(void)
{
    uint32_t of_init = 0, of_frame = 0, of_duties = 0;
    for (size_t i = 0; i < golden_frame_count; i++) {
        const frame_t frame = golden_frame(&golden_frames[i]);
        const dock_settings_t settings = golden_settings(&golden_frames[i]);
        uint16_t duties[3];
        const uintptr_t at = (uintptr_t)&dock;
        const stack_call_t init = {(uintptr_t)dock_init,
                                   {at, (uintptr_t)&settings, 0}};
        const stack_call_t decide = {(uintptr_t)dock_frame,
                                     {at, (uintptr_t)&frame, FRAME_MS}};
        const stack_call_t drive = {(uintptr_t)dock_led_duties,
                                    {at, (uintptr_t)duties, 0}};
        keep_larger(&of_init, stack_used(&init));
        keep_larger(&of_frame, stack_used(&decide));
        keep_larger(&of_duties, stack_used(&drive));
    }
    const bool init_fits = put_stack("dock_init", of_init);
    const bool frame_fits = put_stack("dock_frame", of_frame);
    const bool duties_fit = put_stack("dock_led_duties", of_duties);
    return init_fits && frame_fits && duties_fit && print_link_stack();
}

void print_memory(void)
{
    put_word("dock_bytes");
    put_number(sizeof(dock_t));
    put_line_end();
}
