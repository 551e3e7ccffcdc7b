/* ESP-IDF 4.4.7: components/freertos/include/freertos and port/xtensa;
 * 5.5: components/freertos/FreeRTOS-Kernel. Arduino runs 1000 ticks a second.
 */
#ifndef FREERTOS_H
#define FREERTOS_H

#include <stddef.h>
#include <stdint.h>

#define configTICK_RATE_HZ (1000)

typedef uint8_t StackType_t;
typedef int BaseType_t;
typedef unsigned UBaseType_t;
typedef uint32_t TickType_t;

#define portMAX_DELAY (TickType_t)0xffffffffUL

#define pdFALSE ((BaseType_t)0)
#define pdTRUE ((BaseType_t)1)
#define pdMS_TO_TICKS(xTimeInMs)                                               \
    ((TickType_t)(((TickType_t)(xTimeInMs) * (TickType_t)configTICK_RATE_HZ) / \
                  (TickType_t)1000U))

/* Opaque; larger than the vendor's. */
typedef struct {
    void *dummy[24];
} StaticQueue_t;

typedef struct {
    void *dummy[96];
} StaticTask_t;

#endif
