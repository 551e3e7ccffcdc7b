#include "link_order.h"

#include "real32.h"

#define SIGN (UINT32_C(1) << 31) /* alone: minus zero */

int64_t order_whole(const order_t *order, int argument)
{
    const uint32_t bits = order->argument[argument];
    int64_t n;
    return real32_to_fixed(bits, 0, &n) && n >= 0 &&
                   real32_from_fixed(n, 0) == (bits == SIGN ? 0 : bits)
               ? n
               : -1;
}
