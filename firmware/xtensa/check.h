/* Counts every compared value, so that a comparison of nothing is seen. */
#ifndef CHECK_H
#define CHECK_H

#include <stdint.h>

/* A vector: its kind, and its name or, with NULL, its number. */
void check_begin(const char *kind, const char *name, uint32_t number);

/* Prints the value if it differs:
 *     different KIND NAME STAGE INDEX expected N got N */
void check_value(const char *stage, uint32_t index, int64_t expected,
                 int64_t got);

/* Prints  vector KIND NAME values N different N. */
void check_end(void);

/* Prints  vectors N values N different N,  and returns how many differ. */
uint32_t check_close(void);

#endif
