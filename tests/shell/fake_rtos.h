/* Tasks and queues, of board.h. */
#ifndef FAKE_RTOS_H
#define FAKE_RTOS_H

extern "C" {

TaskHandle_t xTaskCreateStaticPinnedToCore(TaskFunction_t code, const char *,
                                           uint32_t, void *, UBaseType_t,
                                           StackType_t *, StaticTask_t *,
                                           BaseType_t core)
{
    note("xTaskCreateStaticPinnedToCore");
    board.task = code;
    board.task_core = core;
    return nullptr;
}

void vTaskDelay(TickType_t ticks)
{
    pass_ms(ticks);
}

/* A queue of one element. */
struct QueueDefinition {
    uint8_t *storage;
    size_t size;
    bool full;
};

QueueHandle_t xQueueGenericCreateStatic(UBaseType_t length, UBaseType_t size,
                                        uint8_t *storage, StaticQueue_t *state,
                                        uint8_t)
{
    static_assert(sizeof(QueueDefinition) <= sizeof(StaticQueue_t), "room");
    TEST_ASSERT_EQUAL_UINT(1, length);
    QueueHandle_t queue = reinterpret_cast<QueueHandle_t>(state);
    queue->storage = storage;
    queue->size = size;
    queue->full = false;
    return queue;
}

BaseType_t xQueueGenericSend(QueueHandle_t queue, const void *item,
                             TickType_t wait, BaseType_t position)
{
    if (queue->full && position != queueOVERWRITE) {
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, wait, "would wait for ever");
        return pdFALSE;
    }
    memcpy(queue->storage, item, queue->size);
    queue->full = true;
    return pdTRUE;
}

/* Who waits without end lets the other task work. */
inline void wait_until_full(QueueHandle_t queue, TickType_t wait)
{
    for (int turns = 0; wait == portMAX_DELAY && !queue->full; turns++) {
        TEST_ASSERT_TRUE_MESSAGE(board.while_waiting && turns < 100,
                                 "would wait for ever");
        board.while_waiting();
    }
    if (!queue->full)
        pass_ms(wait);
}

BaseType_t xQueuePeek(QueueHandle_t queue, void *item, TickType_t wait)
{
    wait_until_full(queue, wait);
    if (!queue->full)
        return pdFALSE;
    memcpy(item, queue->storage, queue->size);
    return pdTRUE;
}

BaseType_t xQueueReceive(QueueHandle_t queue, void *item, TickType_t wait)
{
    const BaseType_t got = xQueuePeek(queue, item, wait);
    queue->full = false;
    return got;
}

} /* extern "C" */

#endif
