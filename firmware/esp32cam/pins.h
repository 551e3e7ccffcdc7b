/* The AI-Thinker ESP32-CAM: which pin does what, and why.
 *
 * Never: 12 (high at reset starts the flash at 1.8 V, the boot fails), 16 and
 * 17 (PSRAM), 2 (held high it blocks flashing), 4 (the on-board flash lamp).
 * The LEDs share 13, 14 and 15 with the SD card: its slot stays empty. */
#ifndef PINS_H
#define PINS_H

enum {
    /* 15 is a strapping pin: held low at reset it only silences the ROM's log,
     * and a common-anode LED holds it high. */
    PIN_RED = 13,
    PIN_GREEN = 14,
    PIN_BLUE = 15,

    PIN_UART_TX = 1, /* UART0, the one that flashes the board too */
    PIN_UART_RX = 3,

    PIN_CAMERA_POWER_DOWN = 32, /* high switches the sensor off */
    PIN_CAMERA_RESET = -1,      /* not wired */
    PIN_CAMERA_XCLK = 0,        /* a strapping pin: for nothing else */
    PIN_CAMERA_SDA = 26,
    PIN_CAMERA_SCL = 27,
    PIN_CAMERA_D0 = 5,
    PIN_CAMERA_D1 = 18,
    PIN_CAMERA_D2 = 19,
    PIN_CAMERA_D3 = 21,
    PIN_CAMERA_D4 = 36, /* 34, 35, 36 and 39 can only be inputs */
    PIN_CAMERA_D5 = 39,
    PIN_CAMERA_D6 = 34,
    PIN_CAMERA_D7 = 35,
    PIN_CAMERA_VSYNC = 25,
    PIN_CAMERA_HREF = 23,
    PIN_CAMERA_PCLK = 22,
};

#endif
