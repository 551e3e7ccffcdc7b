/* The bare compiler has its own, but under another name. */
#include <stdint-gcc.h>
