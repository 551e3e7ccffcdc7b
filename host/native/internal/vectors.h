/* Loops over cells as the processor at hand does them best. */
#ifndef VECTORS_H
#define VECTORS_H

/* Of the C library, which says there that it is glibc. */
#include <stdint.h>

/* Before a function: it is compiled twice, for any processor of the kind and
 * for one with vectors of eight floats, and the C library chooses once.  Both
 * give the same bits, for C11 allows no product and sum to be rounded as one.
 * A 64-bit Arm has its vectors always; elsewhere there is the one function. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && \
    !defined(__clang__)
#define WIDE_VECTORS __attribute__((target_clones("avx2", "default")))
#else
#define WIDE_VECTORS
#endif

#endif
