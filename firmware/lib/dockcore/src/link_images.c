#include <string.h>

#include "link_parts.h"

uint16_t link_packets_of(uint32_t size)
{
    return (uint16_t)((size + PACKET - 1) / PACKET);
}

bool link_send_handshake(sender_t *sender, const link_image_t *image)
{
    mavlink_data_transmission_handshake_t h;
    memset(&h, 0, sizeof h);
    h.size = image->size;
    h.width = image->width;
    h.height = image->height;
    h.packets = link_packets_of(image->size);
    h.type = image->type;
    h.payload = PACKET;
    h.jpg_quality = image->number; /* a field that raw images leave unused */
    return MESSAGE_SEND(sender, DATA_TRANSMISSION_HANDSHAKE, &h);
}
