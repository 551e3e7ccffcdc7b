/* ESP-IDF 4.4.7 and 5.5: freertos/task.h (5.5: and idf_additions.h). */
#ifndef FREERTOS_TASK_H
#define FREERTOS_TASK_H

#include "freertos/FreeRTOS.h"

extern "C" {

struct tskTaskControlBlock;
typedef struct tskTaskControlBlock *TaskHandle_t;
typedef void (*TaskFunction_t)(void *);

TaskHandle_t xTaskCreateStaticPinnedToCore(
    TaskFunction_t pxTaskCode, const char *const pcName,
    const uint32_t ulStackDepth, void *const pvParameters,
    UBaseType_t uxPriority, StackType_t *const pxStackBuffer,
    StaticTask_t *const pxTaskBuffer, const BaseType_t xCoreID);
void vTaskDelay(const TickType_t xTicksToDelay);
}

#endif
