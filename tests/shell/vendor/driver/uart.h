/* ESP-IDF 4.4.7: components/driver/include/driver/uart.h and
 * components/hal/include/hal/uart_types.h; 5.5: components/esp_driver_uart,
 * where uart_sclk_t comes from soc/clk_tree_defs.h with other values. */
#ifndef DRIVER_UART_H
#define DRIVER_UART_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "esp_err.h"
#include "esp_idf_version.h"
#include "freertos/FreeRTOS.h"
#include "freertos/queue.h"

extern "C" {

#define UART_PIN_NO_CHANGE (-1)

typedef enum { UART_DATA_8_BITS = 0x3 } uart_word_length_t;
typedef enum { UART_STOP_BITS_1 = 0x1 } uart_stop_bits_t;
typedef enum { UART_PARITY_DISABLE = 0x0 } uart_parity_t;
typedef enum { UART_HW_FLOWCTRL_DISABLE = 0x0 } uart_hw_flowcontrol_t;

#if ESP_IDF_VERSION_MAJOR >= 5
typedef enum { UART_NUM_0, UART_NUM_1, UART_NUM_2 } uart_port_t;
typedef enum { UART_SCLK_APB = 4 } uart_sclk_t;
#else
#define UART_NUM_0 (0)
typedef int uart_port_t;
typedef enum { UART_SCLK_APB = 0x0 } uart_sclk_t;
#endif

typedef struct {
    int baud_rate;
    uart_word_length_t data_bits;
    uart_parity_t parity;
    uart_stop_bits_t stop_bits;
    uart_hw_flowcontrol_t flow_ctrl;
    uint8_t rx_flow_ctrl_thresh;
    union {
        uart_sclk_t source_clk;
#if ESP_IDF_VERSION_MAJOR < 5
        bool use_ref_tick __attribute__((deprecated));
#endif
    };
#if ESP_IDF_VERSION_MAJOR >= 5
    struct {
        uint32_t allow_pd : 1;
        uint32_t backup_before_sleep : 1;
    } flags;
#endif
} uart_config_t;

esp_err_t uart_driver_install(uart_port_t uart_num, int rx_buffer_size,
                              int tx_buffer_size, int queue_size,
                              QueueHandle_t *uart_queue, int intr_alloc_flags);
esp_err_t uart_param_config(uart_port_t uart_num,
                            const uart_config_t *uart_config);
esp_err_t uart_set_pin(uart_port_t uart_num, int tx_io_num, int rx_io_num,
                       int rts_io_num, int cts_io_num);
int uart_read_bytes(uart_port_t uart_num, void *buf, uint32_t length,
                    TickType_t ticks_to_wait);
int uart_tx_chars(uart_port_t uart_num, const char *buffer, uint32_t len);
esp_err_t uart_wait_tx_done(uart_port_t uart_num, TickType_t ticks_to_wait);
}

#endif
