/* Arduino core for the ESP32, 2.0.17 and 3.3: what calls the firmware. */
#ifndef ARDUINO_H
#define ARDUINO_H

#define ARDUINO_RUNNING_CORE 1

#include <stdbool.h>
#include <stdint.h>

/* esp32-hal-cpu.h */
extern "C" bool setCpuFrequencyMhz(uint32_t cpu_freq_mhz);

/* Esp.h */
class EspClass
{
  public:
    uint64_t getEfuseMac();
};
extern EspClass ESP;

void setup(void);
void loop(void);

#endif
