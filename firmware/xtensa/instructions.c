#include "instructions.h"

#include "board.h"

/* So long that a tick more or less does not show in a count of millions. */
#define STEP UINT32_C(8000000)

static uint32_t step_ticks; /* of STEP instructions */
static uint32_t reading;    /* instructions that a reading adds */

static uint32_t counted(uint32_t ticks_passed)
{
    return (uint32_t)(((uint64_t)ticks_passed * STEP + step_ticks / 2) /
                      step_ticks);
}

bool instructions_calibrate(void)
{
    const uint32_t brief = ticks_of_loop(1);
    step_ticks = ticks_of_loop(1 + STEP / 2) - brief;
    /* Several ticks an instruction: rounding finds the number that is meant. */
    if (step_ticks < 4 * STEP)
        return false;
    reading = counted(brief) - 2;
    return counted(ticks_of_10000_nops()) - reading == 10000;
}

uint32_t instructions_between(uint32_t start, uint32_t end)
{
    return counted(end - start) - reading;
}
