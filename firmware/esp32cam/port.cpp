#include "port.h"

#include <driver/uart.h>

#include "pins.h"

enum {
    /* 40 ms of 921,600 baud: longer than a frame takes to be decided on. */
    RECEIVE_BUFFER = 4096,
    /* None: bytes wait in the dock, which knows what is worth sending next;
     * uart_tx_chars fills the hardware's own 128 and returns. */
    TRANSMIT_BUFFER = 0,
};

static const uart_port_t PORT = UART_NUM_0;

void port_start(uint32_t baud)
{
    uart_config_t config = {};
    config.baud_rate = static_cast<int>(baud);
    config.data_bits = UART_DATA_8_BITS;
    config.parity = UART_PARITY_DISABLE;
    config.stop_bits = UART_STOP_BITS_1;
    config.flow_ctrl = UART_HW_FLOWCTRL_DISABLE;
    config.source_clk = UART_SCLK_APB;
    uart_driver_install(PORT, RECEIVE_BUFFER, TRANSMIT_BUFFER, 0, nullptr, 0);
    uart_param_config(PORT, &config);
    uart_set_pin(PORT, PIN_UART_TX, PIN_UART_RX, UART_PIN_NO_CHANGE,
                 UART_PIN_NO_CHANGE);
}

/* The driver says -1 for an error. */
static size_t count_of(int result)
{
    return result > 0 ? static_cast<size_t>(result) : 0;
}

size_t port_read(uint8_t *bytes, size_t capacity)
{
    return count_of(
        uart_read_bytes(PORT, bytes, static_cast<uint32_t>(capacity), 0));
}

size_t port_write(const uint8_t *bytes, size_t n)
{
    return count_of(uart_tx_chars(PORT, reinterpret_cast<const char *>(bytes),
                                  static_cast<uint32_t>(n)));
}

bool port_is_idle()
{
    return uart_wait_tx_done(PORT, 0) == ESP_OK;
}
