#include <string.h>

#include <chromadock/mavlink.h>

#include "fuzz.h"

static const uint16_t commands[] = {
    MAV_CMD_DOCK_LED,
    MAV_CMD_DOCK_SNAPSHOT,
    MAV_CMD_PREFLIGHT_STORAGE,
    MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN,
    MAV_CMD_REQUEST_MESSAGE,
    MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES,
    MAV_CMD_SET_MESSAGE_INTERVAL,
    MAV_CMD_GET_MESSAGE_INTERVAL,
};

void make_plausible(uint32_t id, uint8_t *payload)
{
    const uint8_t seed[4] = {payload[0], payload[1], payload[2], payload[3]};
    if (id == MAVLINK_MSG_ID_PARAM_SET) {
        mavlink_param_set_t *set = (mavlink_param_set_t *)payload;
        const char *name =
            PARAMETERS[(uint8_t)set->param_id[0] % PARAMETER_COUNT].name;
        memset(set->param_id, 0, sizeof set->param_id);
        memcpy(set->param_id, name, strlen(name));
    } else if (id == MAVLINK_MSG_ID_COMMAND_LONG) {
        mavlink_command_long_t *command = (mavlink_command_long_t *)payload;
        command->param1 = (float)(int8_t)seed[0];
        command->param2 = (float)seed[1] * 2;
        command->param3 = (float)seed[2];
        command->param4 = (float)seed[3];
        command->command = commands[command->command % COUNT(commands)];
        if (command->command == MAV_CMD_REQUEST_MESSAGE)
            command->param1 = seed[0] % 2 ? MAVLINK_MSG_ID_DOCK_STATUS
                                          : MAVLINK_MSG_ID_AUTOPILOT_VERSION;
    } else if (id == MAVLINK_MSG_ID_DATA_TRANSMISSION_HANDSHAKE) {
        mavlink_data_transmission_handshake_t *h =
            (mavlink_data_transmission_handshake_t *)payload;
        const bool rgb565 = seed[0] % 2;
        h->width = (uint16_t)(1 + seed[1] % 32);
        h->height = (uint16_t)(1 + seed[2] % 32);
        h->size = (rgb565 ? 2u : 3u) * h->width * h->height;
        h->packets = (uint16_t)((h->size + PACKET - 1) / PACKET);
        h->payload = PACKET;
        h->type = rgb565 ? MAVLINK_DATA_STREAM_IMG_RAW8U
                         : MAVLINK_DATA_STREAM_IMG_RAW32U;
        if (seed[3] == 255)
            h->size = 0;
        if (seed[3] == 254)
            h->width++;
    } else if (id == MAVLINK_MSG_ID_ENCAPSULATED_DATA) {
        mavlink_encapsulated_data_t *packet =
            (mavlink_encapsulated_data_t *)payload;
        packet->seqnr = dock.link.injection.next;
    }
}
