/* dockcore on an emulated Xtensa core: the same bits, and what they cost. */
#include "board.h"
#include "budget.h"
#include "check.h"
#include "console.h"
#include "vectors.h"

enum { AGREED, DIFFERENT, UNEVEN_CLOCK, STACK_OVERFLOW, FAULT };

void board_fault(uint32_t cause, uint32_t address)
{
    put_line_end(); /* of whatever was being written */
    put_word("fault");
    put_number(cause);
    put_word("at");
    put_number(address);
    put_line_end();
    board_exit(FAULT);
}

int main(void)
{
    check_frames();
    check_rolling();
    check_steady();
    check_leds();
    check_mappings();
    const uint32_t different = check_close();
    if (!print_instructions())
        return UNEVEN_CLOCK;
    if (!print_stack())
        return STACK_OVERFLOW;
    print_memory();
    put_word("end");
    put_line_end();
    return different == 0 ? AGREED : DIFFERENT;
}
