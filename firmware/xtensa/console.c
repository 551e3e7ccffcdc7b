#include "console.h"

#include <stdbool.h>

#include "board.h"

/* A call of the emulator costs more than a line of text: lines go whole. */
static char line[160];
static size_t length;

static void put(char character)
{
    if (length == sizeof line) {
        board_write(line, length);
        length = 0;
    }
    line[length++] = character;
}

static void put_gap(void)
{
    if (length > 0)
        put(' ');
}

void put_word(const char *word)
{
    put_gap();
    while (*word != '\0')
        put(*word++);
}

void put_number(int64_t number)
{
    char digits[20];
    uint32_t n = 0;
    uint64_t rest = number < 0 ? 0 - (uint64_t)number : (uint64_t)number;
    do {
        digits[n++] = (char)('0' + rest % 10);
        rest /= 10;
    } while (rest > 0);
    put_gap();
    if (number < 0)
        put('-');
    while (n > 0)
        put(digits[--n]);
}

void put_line_end(void)
{
    put('\n');
    board_write(line, length);
    length = 0;
}
