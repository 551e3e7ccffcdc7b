#include "dock.h"

#include <string.h>

dock_settings_t dock_default_settings(void)
{
    return (dock_settings_t){
        .mapping = METHOD_DEFAULT_MAPPING,
        .fallback_hue = METHOD_FALLBACK_HUE,
        .window_ms = METHOD_WINDOW_MS,
        .led = led_default_settings(),
    };
}

bool dock_settings_are_valid(const dock_settings_t *settings)
{
    return settings->mapping < METHOD_MAPPING_COUNT &&
           settings->fallback_hue < METHOD_HUE_RANGE &&
           settings->window_ms >= METHOD_MIN_WINDOW_MS &&
           settings->window_ms <= METHOD_MAX_WINDOW_MS &&
           led_settings_are_valid(&settings->led);
}

void dock_init(dock_t *dock, const dock_settings_t *settings)
{
    memset(dock, 0, sizeof *dock);
    dock->settings =
        dock_settings_are_valid(settings) ? *settings : dock_default_settings();
    rolling_init(&dock->rolling);
}

static void count(uint32_t *counter)
{
    if (*counter < UINT32_MAX)
        ++*counter;
}

void dock_frame(dock_t *dock, const frame_t *frame, uint32_t now_ms)
{
    if (frame == NULL || frame->bytes == NULL) {
        count(&dock->counters.camera_faults);
        return;
    }
    if (!frame_is_valid(frame)) {
        count(&dock->counters.frame_faults);
        return;
    }
    count(&dock->counters.frames);
    working_image_from_frame(&dock->image, frame);
    working_image_smooth(&dock->image);
    background_from_image(&dock->background, &dock->image);
    dock->decided_hue = marker_hue(&dock->background, dock->settings.mapping,
                                   dock->settings.fallback_hue);
    dock->marker_hue = rolling_add(&dock->rolling, dock->decided_hue, now_ms,
                                   dock->settings.window_ms);
    dock->decided = true;
}

void dock_led_duties(const dock_t *dock, uint16_t duty[3])
{
    if (dock->decided)
        led_duties(duty, dock->marker_hue, &dock->settings.led);
    else
        led_dark(duty, &dock->settings.led);
}
