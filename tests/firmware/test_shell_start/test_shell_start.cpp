/* From power on to the first colour, with ESP-IDF 4.4. */
#define ESP_IDF_VERSION_MAJOR 4

#include "../../shell/start_cases.h"
#include "../suite.h"

SUITE(run_start_cases)
