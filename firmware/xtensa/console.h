/* Lines of words and numbers. */
#ifndef CONSOLE_H
#define CONSOLE_H

#include <stdint.h>

/* Each writes a space first, except at the start of a line. */
void put_word(const char *word);
void put_number(int64_t number);

void put_line_end(void);

#endif
