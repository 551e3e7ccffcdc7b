/* Numbers of 32 bits as little-endian bytes, and the checksum over bytes. */
#ifndef BYTES32_H
#define BYTES32_H

#include <stddef.h>
#include <stdint.h>

void put32(uint8_t to[4], uint32_t value);
uint32_t get32(const uint8_t from[4]);

/* CRC-32 of IEEE 802.3, as zlib computes it; `crc` is that of the bytes before
 * these, 0 if there are none. */
uint32_t crc32(uint32_t crc, const uint8_t *bytes, size_t n);

#endif
