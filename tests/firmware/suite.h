/* The entry point of a suite. */
#ifndef SUITE_H
#define SUITE_H

#include <unity.h>

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
