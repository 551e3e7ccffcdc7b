/* The entry point of a suite: a program here, a sketch on a board. */
#ifndef SUITE_H
#define SUITE_H

#include <unity.h>

#if defined(ARDUINO)

#include <Arduino.h>

/* The wait lets the serial port come up, or the first lines would be lost. */
#define SUITE(run_tests) \
    void setup(void)     \
    {                    \
        delay(2000);     \
        UNITY_BEGIN();   \
        run_tests();     \
        UNITY_END();     \
    }                    \
    void loop(void)      \
    {                    \
    }

#else

/* PlatformIO reads the failures off the output, and takes a small exit status
 * for the number of a signal: 1 would be reported as SIGHUP. */
#if defined(PIO_UNIT_TESTING)
#define SUITE_STATUS(failures) ((void)(failures), 0)
#else
#define SUITE_STATUS(failures) ((failures) > 0)
#endif

#define SUITE(run_tests)                  \
    int main(void)                        \
    {                                     \
        UNITY_BEGIN();                    \
        run_tests();                      \
        const int failures = UNITY_END(); \
        return SUITE_STATUS(failures);    \
    }

#endif

#endif
