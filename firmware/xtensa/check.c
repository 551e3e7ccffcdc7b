#include "check.h"

#include <stddef.h>

#include "console.h"

static struct {
    const char *kind, *name;
    uint32_t number;
    uint32_t values, different; /* of this vector */
} vector;

static uint32_t vectors, all_values, all_different;

void check_begin(const char *kind, const char *name, uint32_t number)
{
    vector.kind = kind;
    vector.name = name;
    vector.number = number;
    vector.values = 0;
    vector.different = 0;
}

static void put_vector(void)
{
    put_word(vector.kind);
    if (vector.name != NULL)
        put_word(vector.name);
    else
        put_number(vector.number);
}

void check_value(const char *stage, uint32_t index, int64_t expected,
                 int64_t got)
{
    vector.values++;
    if (expected == got)
        return;
    vector.different++;
    put_word("different");
    put_vector();
    put_word(stage);
    put_number(index);
    put_word("expected");
    put_number(expected);
    put_word("got");
    put_number(got);
    put_line_end();
}

static void put_counts(uint32_t values, uint32_t different)
{
    put_word("values");
    put_number(values);
    put_word("different");
    put_number(different);
    put_line_end();
}

void check_end(void)
{
    put_word("vector");
    put_vector();
    put_counts(vector.values, vector.different);
    vectors++;
    all_values += vector.values;
    all_different += vector.different;
}

uint32_t check_close(void)
{
    put_word("vectors");
    put_number(vectors);
    put_counts(all_values, all_different);
    return all_different;
}
