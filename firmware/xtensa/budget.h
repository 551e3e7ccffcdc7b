/* What a decision costs: instructions, stack, memory. */
#ifndef BUDGET_H
#define BUDGET_H

#include <stdbool.h>

/* Prints, for every golden frame as the dock's camera delivers it,
 *     instructions NAME STAGE N
 * False: the emulator's clock cannot count them. */
bool print_instructions(void);

/* Prints  stack FUNCTION N,  the most bytes over all golden frames.  False: the
 * stack was too small to tell. */
bool print_stack(void);

/* Prints  dock_bytes N. */
void print_memory(void);

#endif
