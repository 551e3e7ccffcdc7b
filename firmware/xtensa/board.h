/* The emulated board: output, end, faults, clock, a second stack (start.S). */
#ifndef BOARD_H
#define BOARD_H

#include <stddef.h>
#include <stdint.h>

void board_write(const char *text, size_t n);
_Noreturn void board_exit(int status);
_Noreturn void board_fault(uint32_t cause, uint32_t address);

typedef struct {
    uintptr_t function, argument[4];
} stack_call_t;

/* Calls on the stack that ends below `top`; top[0] and top[1] are used too. */
void stack_call(uint32_t *top, const stack_call_t *call);

/* Yardsticks for the clock: 2 instructions a round; 10,000. */
uint32_t ticks_of_loop(uint32_t rounds);
uint32_t ticks_of_10000_nops(void);

static inline uint32_t ticks(void)
{
    uint32_t count;
    __asm__ volatile("rsr %0, ccount" : "=a"(count) : : "memory");
    return count;
}

#endif
