"""What dock and vehicle may cost; the tests hold the dock's, `make bench` shows them all."""

# Of one QQVGA RGB565 frame to PWM duties: 2.2 ms of the ESP32 at one instruction a cycle.
INSTRUCTIONS_QQVGA = 520_000
# The same where another grey bin than in the frame before is the fullest: it is read twice.
INSTRUCTIONS_COLD = 950_000

CODE_BYTES = 32 * 1024  # with tables
RAM_BYTES = 4 * 1024
STACK_BYTES = 1024

# Detector.process against one 5 x 5 Gaussian blur of the same frame, one thread.
BLUR_RATIO = 5  # plain water
BLUR_RATIO_WORST = 8  # the worst photograph of the test data

RESIDENT_MIB = 200  # of `chromadock detect` on VGA video
# Of one detector from its settling to the end of a long run: a few pages come and go, but
# a leak of 1 KiB a frame would be ten MiB in 10,000 frames.
GROWTH_MIB = 4
