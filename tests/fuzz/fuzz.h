/* What the parts of the harness share: see fuzz_receive.c. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stdio.h>
#include <stdlib.h>

#include "dockcore.h"

#define MUST(condition)                                                     \
    do {                                                                    \
        if (!(condition)) {                                                 \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                        \
        }                                                                   \
    } while (0)

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* Bytes of an image in one message. */
enum { PACKET = 253 };

/* The dock that is fuzzed, and what it was before a message whose effect is
 * checked. */
extern dock_t dock, before;
extern uint32_t clock_ms;

/* The next bytes of the input; zeros after its end. */
uint8_t take8(void);
void take(uint8_t *to, size_t n);

/* The dock receives bytes. */
void receive(const uint8_t *bytes, size_t n);

/* Silence until nothing is half received. */
void flush(void);

/* The step "message": one message to the dock, in a frame that is made here. */
void message(void);

/* Contents that would hardly come about by chance, in a payload of max_msg_len
 * bytes. */
void make_plausible(uint32_t id, uint8_t *payload);

/* The dock is as it was ``before``. */
void must_be_as_before(void);

/* A message by itself did what it should to the dock. */
void check_parameter_set(const uint8_t *payload);
void check_command(void);

#endif
