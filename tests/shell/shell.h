/* The firmware's shell on a fake board, in the suite's own program. */
#ifndef SHELL_H
#define SHELL_H

#include "board.h"

/* Every source: the whole shell is in each suite, small as it is. */
#include "../../firmware/esp32cam/backoff.cpp"
#include "../../firmware/esp32cam/camera.cpp"
#include "../../firmware/esp32cam/camera_power.cpp"
#include "../../firmware/esp32cam/exposure.cpp"
#include "../../firmware/esp32cam/last_hue.cpp"
#include "../../firmware/esp32cam/lock_check.cpp"
#include "../../firmware/esp32cam/loop.cpp"
#include "../../firmware/esp32cam/mailbox.cpp"
#include "../../firmware/esp32cam/main.cpp"
#include "../../firmware/esp32cam/port.cpp"
#include "../../firmware/esp32cam/pwm.cpp"
#include "../../firmware/esp32cam/rest.cpp"
#include "../../firmware/esp32cam/sensor_lock.cpp"
#include "../../firmware/esp32cam/settings_nvs.cpp"
#include "../../firmware/esp32cam/settings_sector.cpp"
#include "../../firmware/esp32cam/settling.cpp"
#include "../../firmware/esp32cam/storage.cpp"
#include "../../firmware/esp32cam/watchdog.cpp"

#endif
