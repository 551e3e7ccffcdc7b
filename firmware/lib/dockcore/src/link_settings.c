/* The settings as the link changes them, whichever protocol a host speaks. */
#include <string.h>

#include "link_parts.h"
#include "parameter_table.h"

#define NAME_LENGTH 16

/* Index by name, which has no zero at its end if it is 16 letters long; or -1.
 */
static int find(const char name[NAME_LENGTH])
{
    for (int i = 0; i < PARAMETER_COUNT; i++)
        if (strncmp(PARAMETERS[i].name, name, NAME_LENGTH) == 0)
            return i;
    return -1;
}

static void add_shown(line_t *line, const parameter_t *parameter,
                      int32_t stored)
{
    line_add_fixed(line, (int64_t)stored * parameter->numerator,
                   parameter->shift);
}

/* The beginning of a text about a name that came over the link. */
static line_t line_about(const char name[NAME_LENGTH])
{
    char words[NAME_LENGTH + 1];
    memcpy(words, name, NAME_LENGTH);
    words[NAME_LENGTH] = '\0';
    line_t line = {{0}, 0};
    line_add(&line, words);
    return line;
}

static int say_unknown(link_t *link, line_t *line)
{
    line_add(line, ": no such parameter");
    link_say(link, MAV_SEVERITY_WARNING, line);
    return -1;
}

int link_find_parameter(link_t *link, const char name[NAME_LENGTH])
{
    const int index = find(name);
    line_t line = line_about(name);
    return index < 0 ? say_unknown(link, &line) : index;
}

int link_asked_parameter(link_t *link, int16_t index,
                         const char name[NAME_LENGTH])
{
    if (index < 0)
        return link_find_parameter(link, name);
    if (index < PARAMETER_COUNT)
        return index;
    line_t line = {{0}, 0};
    line_add(&line, "parameter ");
    line_add_fixed(&line, index, 0);
    return say_unknown(link, &line);
}

static void refuse_value(dock_t *dock, const parameter_t *parameter)
{
    line_t line = {{0}, 0};
    line_add(&line, parameter->name);
    line_add(&line, " refused: allowed ");
    add_shown(&line, parameter, parameter->minimum);
    line_add(&line, " to ");
    add_shown(&line, parameter, parameter->maximum);
    link_say(&dock->link, MAV_SEVERITY_WARNING, &line);
    link_count_fault(&dock->link);
}

static bool same_camera(const camera_settings_t *a, const camera_settings_t *b)
{
    return a->lock == b->lock && a->exposure == b->exposure &&
           a->gain == b->gain && a->white_balance == b->white_balance;
}

/* What follows from a change of the settings. */
static void follow_change(dock_t *dock, const dock_settings_t *before)
{
    decision_follow(&dock->decision, before, &dock->settings);
    if (!same_camera(&before->camera, &dock->settings.camera))
        requests_camera(&dock->requests);
}

/* Whoever sets one of these means it, whatever it was before: a test of the
 * LEDs ends, an interval that a host asked for gives way. */
static void follow_set(dock_t *dock, int index)
{
    if (index == PARAMETER_LED_MODE || index == PARAMETER_LED_HUE)
        lamps_follow(&dock->lamps, &dock->settings);
    if (index == PARAMETER_REPORT_HZ)
        link_set_period(&dock->link, REPORT_STATUS, 0);
}

void link_reset_settings(dock_t *dock)
{
    const dock_settings_t before = dock->settings;
    dock->settings = dock_reset_settings(&before);
    follow_change(dock, &before);
    for (int i = 0; i < PARAMETER_COUNT; i++)
        follow_set(dock, i);
}

bool link_set_parameter(dock_t *dock, int index, uint32_t bits)
{
    const dock_settings_t before = dock->settings;
    int32_t stored;
    if (!parameter_from_real32(&PARAMETERS[index], bits, &stored) ||
        !parameter_set(&PARAMETERS[index], &dock->settings, stored)) {
        refuse_value(dock, &PARAMETERS[index]);
        return false;
    }
    follow_change(dock, &before);
    follow_set(dock, index);
    return true;
}
