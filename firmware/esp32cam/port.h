/* UART0: the link to the host, without waiting.
 *
 * The boot loader's and the camera driver's text goes out on the same wire,
 * past this file; both ends of the link find their messages among it. */
#ifndef PORT_H
#define PORT_H

#include <stddef.h>
#include <stdint.h>

void port_start(uint32_t baud);

/* Bytes that have come, as many as fit; 0: none. */
size_t port_read(uint8_t *bytes, size_t capacity);

/* How many of the bytes were taken, 0 where the line is busy. */
size_t port_write(const uint8_t *bytes, size_t n);

/* True where all that was taken is out on the wire. */
bool port_is_idle();

#endif
