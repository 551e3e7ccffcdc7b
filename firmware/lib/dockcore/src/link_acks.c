#include <string.h>

#include "link_parts.h"

/* An answer that finds no room is dropped: the host asks again. */
void link_acknowledge(link_t *link, const link_ack_t *ack)
{
    link_acks_t *acks = &link->acks;
    if (acks->count < LINK_ACKS)
        acks->waiting[acks->count++] = *ack;
}

/* Where several hosts wait for the same save, its answer goes to all. */
void link_answer_save_later(link_t *link, const link_ack_t *ack)
{
    link_ack_t *save = &link->acks.save;
    const bool another =
        save->command != 0 &&
        (save->system != ack->system || save->component != ack->component);
    *save = *ack;
    if (another)
        save->system = save->component = 0;
}

void link_answer_save(link_t *link, bool written)
{
    link->acks.save.result = written ? MAV_RESULT_ACCEPTED : MAV_RESULT_FAILED;
    link_acknowledge(link, &link->acks.save);
    link->acks.save.command = 0;
}

bool link_has_answered(const link_t *link)
{
    return link->acks.count == 0;
}

bool link_send_acks(dock_t *dock, sender_t *sender, uint32_t now_ms)
{
    (void)now_ms;
    link_acks_t *acks = &dock->link.acks;
    while (acks->count > 0) {
        const link_ack_t *ack = &acks->waiting[0];
        mavlink_command_ack_t answer;
        memset(&answer, 0, sizeof answer);
        answer.command = ack->command;
        answer.result = ack->result;
        if (ack->result == MAV_RESULT_IN_PROGRESS)
            answer.progress = UINT8_MAX; /* how far is not known */
        answer.target_system = ack->system;
        answer.target_component = ack->component;
        if (!MESSAGE_SEND(sender, COMMAND_ACK, &answer))
            return false;
        memmove(acks->waiting, acks->waiting + 1,
                --acks->count * sizeof acks->waiting[0]);
    }
    return true;
}
