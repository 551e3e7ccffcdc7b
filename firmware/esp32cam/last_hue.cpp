#include "last_hue.h"

#include <esp_attr.h>

/* At power-on anything stands there: the second word tells whether a hue does.
 */
static RTC_NOINIT_ATTR uint32_t kept[2];

static uint32_t check_of(uint32_t hue)
{
    return ~(hue * UINT32_C(2654435761));
}

void last_hue_keep(uint16_t hue)
{
    kept[0] = hue;
    kept[1] = check_of(hue);
}

uint16_t last_hue()
{
    return kept[1] == check_of(kept[0]) && kept[0] < UINT16_MAX
               ? static_cast<uint16_t>(kept[0])
               : UINT16_MAX;
}
