#include "link.h"

#include "link_parts.h"

/* Every message that the dock reads. */
static const struct {
    uint32_t id;
    link_handler_t *handler;
} handlers[] = {
    {MAVLINK_MSG_ID_PARAM_REQUEST_LIST, link_on_parameter_list},
    {MAVLINK_MSG_ID_PARAM_REQUEST_READ, link_on_parameter_read},
    {MAVLINK_MSG_ID_PARAM_SET, link_on_parameter_set},
    {MAVLINK_MSG_ID_PARAM_EXT_REQUEST_LIST, link_on_parameter_list},
    {MAVLINK_MSG_ID_PARAM_EXT_REQUEST_READ, link_on_parameter_read},
    {MAVLINK_MSG_ID_PARAM_EXT_SET, link_on_typed_set},
    {MAVLINK_MSG_ID_COMMAND_LONG, link_on_command},
    {MAVLINK_MSG_ID_COMMAND_INT, link_on_command},
    {MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE, link_on_handshake},
    {MAVLINK_MSG_ID_ENCAPSULATED_DATA, link_on_packet},
};

/* Who sends first.  Where a message does not fit, those below it wait. */
static link_sender_t *const senders[] = {
    link_send_acks,     /* a host waits for its answer */
    link_send_texts,    /* and for the reason of a refusal */
    link_send_reports,  /* small, and due by the clock */
    link_send_values,   /* many, but soon over */
    link_send_echo,     /* before the image that it would wait for */
    link_send_snapshot, /* takes as long as the line needs for 39 KB */
};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static void handle(dock_t *dock, const received_t *message, uint32_t now_ms)
{
    for (size_t i = 0; i < COUNT(handlers); i++)
        if (handlers[i].id == message->id)
            handlers[i].handler(dock, message, now_ms);
}

void link_receive(dock_t *dock, const uint8_t *bytes, size_t n, uint32_t now_ms)
{
    receiver_t *receiver = &dock->link.receiver;
    do {
        const size_t taken = receiver_put(receiver, bytes, n, now_ms);
        n -= taken;
        if (n > 0)
            bytes += taken;
        received_t message;
        while (receiver_next(receiver, message_crc_extra, &message)) {
            /* Only a ground station or a vehicle talks to a dock. */
            if (message.system != dock->link.system)
                handle(dock, &message, now_ms);
            receiver_done(receiver);
        }
    } while (n > 0);
}

size_t link_transmit(dock_t *dock, uint8_t *bytes, size_t capacity,
                     uint32_t now_ms)
{
    sender_t sender = {bytes, 0, capacity, &dock->link.sequence,
                       dock->link.system};
    link_expire_snapshot(&dock->link, now_ms);
    link_expire_injection(&dock->link, now_ms);
    for (size_t i = 0; i < COUNT(senders); i++)
        if (!senders[i](dock, &sender, now_ms))
            break;
    return sender.length;
}
